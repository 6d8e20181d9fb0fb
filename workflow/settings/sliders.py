"""Friction on a rigid plane before LAMMPS runs: independent springs, each with a slider that gives at μ f.

    f_i = k_n max(0, d − h(x_i)),   s_i ← clip(s_i + k_t Δu, ±μ f_i)

It says which displacement carries a load, where on a straight way particles begin or end to touch, and how results
change with the place of the contact's centre between particles; every result is LAMMPS's own.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius
from contact1d.analysis.slip import slip, stick_radius
from contact1d.workflow.scene import Scene, Tangential

Array = NDArray[np.float64]
CLEAR = 1e-9
"""Gap over the body's height in which it stands clear of the plane."""
MOST_SIZED = 200
"""Particles of which an energy is told within a percent or two."""
Stop = tuple[float, float]
"""Displacement and place along x [LU]."""


@dataclass(frozen=True)
class Sliders:
    """Springs with sliders.

    Attributes:
        x, heights: of the particles [LU], (n,).
        normal, tangential: stiffnesses of one [FU/LU].
        coefficient: μ.
    """

    x: Array
    heights: Array
    normal: float
    tangential: float
    coefficient: float

    def normal_forces(self, displacement: float) -> Array:
        """f_i [FU], (n,)."""
        return self.normal * np.maximum(displacement - self.heights, 0.0)

    def displacement_under(self, force: float) -> float:
        """The displacement [LU] that carries a force [FU] ≥ 0; for none, just short of the first touch."""
        heights = np.sort(self.heights)
        if force == 0.0:
            return float(heights[0] - CLEAR * (heights[-1] - heights[0] or 1.0))
        count = np.arange(1, len(heights) + 1)
        below = np.cumsum(heights)
        # F where the next particle begins to touch; from the last one on it has no end.
        carried = self.normal * (count[:-1] * heights[1:] - below[:-1])
        touching = int(np.searchsorted(carried, force, side="left"))
        return float((force / self.normal + below[touching]) / count[touching])

    def touches(self, before: float, after: float) -> list[float]:
        """Displacements [LU] between two, in order, at which a particle begins or ends to touch."""
        low, high = min(before, after), max(before, after)
        between = np.unique(self.heights[(self.heights > low) & (self.heights < high)])
        return [float(height) for height in (between if after > before else between[::-1])]

    def at_end(self, stops: Sequence[Stop]) -> dict[str, float]:
        """Tangential force, stick radius, dissipated energy and load after a way through all stops, and the radii.

        Particles that touch on a part of a straight stretch only are moved along for that part of it.
        """
        profile, work, stuck = self._after(stops)
        return {
            "tangential_force": -float(profile.shear.sum()),
            "stick_radius": stuck.value,
            "dissipated_energy": work,
            "normal_force": float(profile.pressure.sum()),
        }

    def read_off(self, stops: Sequence[Stop]) -> dict[str, float]:
        """How uncertain [LU] the radii of contact and of the zone that sticks are, as they are read off particles."""
        profile, _, stuck = self._after(stops)
        return {"contact_radius": compressive_radius(profile).uncertainty, "stick_radius": stuck.uncertainty}

    def _after(self, stops: Sequence[Stop]) -> tuple[Profile, float, ContactRadius]:
        """Forces of the particles in place of pressures, dissipated energy, and the zone that sticks."""
        force, work, direction = np.zeros_like(self.heights), 0.0, 0
        for (before, start), (after, place) in pairwise(without_rests(stops)):
            old, new = (np.maximum(depth - self.heights, 0.0) for depth in (before, after))
            touched = np.where(old > 0.0, 1.0, 0.0) if after == before else (new - old) / (after - before)
            limit, next_limit = (self.coefficient * self.normal * overlap for overlap in (old, new))
            row = slip(force, self.tangential * (place - start) * touched, limit, next_limit, self.tangential)
            force, work = row.force, work + float(row.work.sum())
            direction = int(np.sign(place - start)) or direction
        none = np.zeros_like(self.x)
        profile = Profile(self.x, none, none, self.normal_forces(stops[-1][0]), -force)
        return profile, work, stick_radius(profile, self.coefficient, direction)

    def sizes(self, stops: Sequence[Stop]) -> dict[str, float]:
        """What errors are held against: Σ |s_i| of tangential forces at most, and the work of that, Σ |s_i| |Δu|.

        Of MOST_SIZED particles at most, each of which stands for its neighbours.
        """
        every = math.ceil(len(self.x) / MOST_SIZED)
        some = Sliders(self.x[::every], self.heights[::every], self.normal, self.tangential, self.coefficient)
        force, before, work, largest = np.zeros_like(some.heights), 0.0, 0.0, 0.0
        for (old, start), (new, place) in pairwise(stops):
            limit, next_limit = (self.coefficient * some.normal_forces(depth) for depth in (old, new))
            pushed: Array = np.where(limit > 0.0, some.tangential * (place - start), 0.0)
            force = slip(force, pushed, limit, next_limit, some.tangential).force
            after = float(np.abs(force).sum())
            work += 0.5 * (before + after) * abs(place - start)
            before, largest = after, max(largest, after)
        return {"tangential_force": every * largest, "dissipated_energy": every * work}


def without_rests(way: Sequence[Stop]) -> list[Stop]:
    """The way without stops from which it goes straight on under the same displacement: they change nothing."""
    kept = list(way[:2])
    for stop in way[2:]:
        (depth, start), (next_depth, place) = kept[-2:]
        onwards = (place - start) * (stop[1] - place) >= 0.0 and place != start
        if onwards and depth == next_depth == stop[0]:
            kept.pop()
        kept.append(stop)
    return kept


def sliders_of(scene: Scene, x: Array) -> Sliders:
    """The sliders of a scene with [friction], at places `x` [LU] from the apex."""
    assert scene.friction is not None
    heights = np.asarray(scene.bodies.height(x), dtype=np.float64)
    return Sliders(x, heights, scene.bulk_stiffness, scene.tangential_stiffness, scene.friction.coefficient)


def stops(experiment: Tangential, sliders: Sliders) -> list[Stop]:
    """Where each row of an experiment ends; before the first one the load is brought on at the place 0."""
    normal = experiment.places()
    if not normal:
        found: dict[float, float] = {}
        for force in experiment.normal_forces():
            if force not in found:
                found[force] = sliders.displacement_under(force)
            normal.append(found[force])
    return [(normal[0], 0.0), *zip(normal, experiment.along(), strict=True)]
