"""Friction on a rigid plane before LAMMPS runs: Jenkins elements, springs with a slider that slips at μ f.

    f_i = k_n max(0, d − h(x_i)),   s_i ← clip(s_i + k_t Δu, ±μ f_i)

It says which displacement carries a load, and where on a straight way particles begin or end to touch; every result is
LAMMPS's own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.scene import Friction, Scene, Tangential

Array = NDArray[np.float64]
CLEAR = 1e-9
"""Gap over the body's height in which it stands clear of the plane."""
Stop = tuple[float, float]
"""Displacement and position along x [LU]."""


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


def without_rests(way: Sequence[Stop]) -> list[Stop]:
    """The path without intermediate stops on a straight line at constant displacement, which have no effect."""
    kept = list(way[:2])
    for stop in way[2:]:
        (depth, start), (next_depth, place) = kept[-2:]
        onwards = (place - start) * (stop[1] - place) >= 0.0 and place != start
        if onwards and depth == next_depth == stop[0]:
            kept.pop()
        kept.append(stop)
    return kept


def sliders_of(scene: Scene, x: Array) -> Sliders:
    """The sliders of a scene with [friction], at positions `x` [LU] from the apex."""
    heights = np.asarray(scene.bodies.height(x), dtype=np.float64)
    return Sliders(x, heights, scene.bulk_stiffness, scene.tangential_stiffness, scene.the(Friction).coefficient)


def stops(experiment: Tangential, sliders: Sliders) -> list[Stop]:
    """The end of each load step of an experiment; before the first one the load is applied at position 0."""
    normal = experiment.places()
    if not normal:
        found: dict[float, float] = {}
        for force in experiment.normal_forces():
            if force not in found:
                found[force] = sliders.displacement_under(force)
            normal.append(found[force])
    return [(normal[0], 0.0), *zip(normal, experiment.along(), strict=True)]
