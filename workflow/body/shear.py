"""The shear traction q(r) under the body of three dimensions that a tangential with the MDR stands for.

It is the inverse Abel transform of the line shear, zone by zone between its kinks (`analysis.shear`), in coordinates of
the body. Its error: what every second particle alone would have told.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.analysis.shear import kinks_of, shear_load
from contact1d.workflow.scene import Cone, Scene, Tangential

Array = NDArray[np.float64]
RADII = 100
"""Evenly from 0 to the contact radius, at which q is given, and at its kinks besides."""


@dataclass(frozen=True, eq=False)
class BodyShear:
    """q(r) of one state; arrays (n,).

    Attributes:
        r: from 0, where q of an apex that slips has no bound and is left out, to the contact radius [LU].
        shear: with which the plane resists a move to the right [FU/LU²].
        uncertainty: of it [FU/LU²].
        edge: the contact radius [LU].
        stick: the stick radius [LU].
    """

    r: Array
    shear: Array
    uncertainty: Array
    edge: float
    stick: float


def body_shears(
    scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array], contact_radii: Array
) -> dict[str, BodyShear]:
    """q(r) of the reported states in which the bodies touch over a width; none where there is no body for them.

    Args:
        scene: what ran.
        profiles: of the reported states, "final" or the farthest one.
        columns: of curve.csv, as in `Run.friction`.
        contact_radii: a of each row [LU], NaN where the bodies do not touch.
    """
    if not isinstance(scene.experiment, Tangential) or scene.bodies.reduction != "mdr":
        return {}
    if scene.bodies.profile.has_edge:  # a flat punch has its own singular end, with as much shear as pressure
        return {}
    sticks, edges = columns["stick_radius"], np.nan_to_num(contact_radii)
    kinks = kinks_of(sticks.tolist(), edges.tolist())
    found: dict[str, BodyShear] = {}
    for name, profile in profiles.items():
        row = row_of(name, columns)
        if edges[row] > 0.0:
            made = _shear(scene, profile, float(edges[row]), kinks[row], float(sticks[row]))
            found |= {} if made is None else {name: made}
    return found


def row_of(state: str, columns: Mapping[str, Array]) -> int:
    """Which row a reported state is: the last one, or the first of those farthest along x."""
    places = columns["tangential_displacement"]
    return len(places) - 1 if state == "final" else int(np.argmax(np.abs(places)))


def _shear(scene: Scene, profile: Profile, edge: float, kinks: Sequence[float], stick: float) -> BodyShear | None:
    """q(r) of a state; None where too few particles touch."""
    x, values, apex = profile.x, -profile.shear, isinstance(scene.bodies.profile, Cone)
    try:
        fine = shear_load(x, values, edge, kinks, apex)
    except ValueError:
        return None
    r = np.unique(np.concatenate([np.linspace(0.0, edge, RADII), kinks]))[fine.has_apex :]
    shear = fine.pressure(r)
    right = np.arange(x.size // 2, x.size)[::2]
    left = x.size - 1 - right[::-1]
    chosen = np.concatenate([left[left < right[0]], right])
    try:
        spread = np.abs(shear - shear_load(x[chosen], values[chosen], edge, kinks, apex).pressure(r))
    except ValueError:
        spread = np.abs(shear)
    return BodyShear(r, shear, spread, edge, stick)
