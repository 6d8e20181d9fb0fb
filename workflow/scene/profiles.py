"""The profiles that a scene may have."""

from typing import Annotated

from pydantic import Discriminator

from contact1d.workflow.scene.measured import Measured
from contact1d.workflow.scene.pieces import BluntCone, Hyperboloid, RoundedPunch, TruncatedCone, TruncatedParabola
from contact1d.workflow.scene.shapes import CappedPunch, Circle, Cone, Ellipsoid, Flat, FlatPunch, Parabola, Power

Profile = Annotated[
    Parabola | Circle | Ellipsoid | Cone | Flat | FlatPunch | CappedPunch | Power | BluntCone | TruncatedCone
    | TruncatedParabola | RoundedPunch | Hyperboloid | Measured,
    Discriminator("kind"),
]  # fmt: skip
"""The tables of all profiles, which their `kind` distinguishes."""
