"""The profiles that a scene may have."""

from typing import Annotated

from pydantic import Discriminator

from contact1d.workflow.scene.measured import Measured
from contact1d.workflow.scene.shapes import Circle, Cone, Ellipsoid, Flat, FlatPunch, Parabola, Power

Profile = Annotated[Parabola | Circle | Ellipsoid | Cone | Flat | FlatPunch | Power | Measured, Discriminator("kind")]
"""The tables of all profiles, which their `kind` distinguishes."""
