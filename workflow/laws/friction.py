"""Friction on a rigid plane before LAMMPS runs: Jenkins elements, springs with a slider that slips at μ f.

    f_i = k_n max(0, d − h(x_i)),   s_i ← clip(s_i + k_t Δu, ±μ f_i)

It says which displacement carries a load, and where on a straight way particles begin or end to touch; every result is
LAMMPS's own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.shear import Slip, slip
from contact1d.workflow.laws.pairs import Independent, Springs, on_plane
from contact1d.workflow.laws.particles import MORE_PHASES
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.shape import Profile
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


@dataclass(frozen=True, eq=False)
class Frictional(Independent):
    """Springs with a slider each.

    Attributes:
        ratio: tangential over normal stiffness.
        coefficient: μ.
    """

    beside = ("pressed", "along")
    exact = beside

    ratio: float = 1.0
    coefficient: float = 0.0

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Of [friction]."""
        return scene.friction is not None

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Self:
        """See `Law`."""
        spring, coefficient = scene.bulk_stiffness, scene.the(Friction).coefficient
        found: Self = on_plane(
            cls, profile, scene.bodies.spacing, spring, scene.tangential_stiffness / spring, coefficient
        )
        return found

    def particles(self, x: Array, deepest: float) -> SlidingSprings:
        """See `Law`."""
        return SlidingSprings(self, x, deepest)


@dataclass(frozen=True, eq=False)
class SlidingSprings(Springs):
    """Springs with a slider each, on a rigid plane; a path is of displacements and positions along x."""

    law: Frictional

    phases = MORE_PHASES

    @property
    def chain(self) -> Sliders:
        """The sliders of these particles."""
        heights = np.asarray(self.shape.height(np.abs(self.x)), dtype=np.float64)
        normal = self.law.stiffness
        return Sliders(self.x, heights, normal, self.law.ratio * normal, self.law.coefficient)

    def energies(self, path: Path) -> tuple[float, float]:
        """½ Σ (k u² + s²/k_t); the work of slip."""
        _, rows = self._slid(path)
        stored = 0.5 * float(np.sum(rows.force[-1:] ** 2)) / self.chain.tangential
        return super().energies(path)[0] + stored, float(rows.work.sum())

    def prescribed(self, path: Path) -> dict[str, Array]:
        """With positions along x."""
        return {"displacement": path.displacement, "place": path.along}

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Straight from one state to the next; see `Particles.carried`."""
        depths, places = columns["displacement"], columns["place"]
        normal, rows = self._slid(Path(depths, places, np.zeros_like(depths)))
        shears = np.pad(rows.force, ((1, 0), (0, 0)))
        return Followed(self.x, normal.sum(axis=1), normal.__getitem__, lambda state: -shears[state])

    def _slid(self, path: Path) -> tuple[Array, Slip]:
        """Normal forces of the particles in each state, (m, n) [FU], and what each load step does, (m − 1, n)."""
        chain = self.chain
        overlap = np.maximum(path.displacement[:, None] - chain.heights, 0.0)
        moved, pressed = np.diff(path.displacement)[:, None], np.diff(overlap, axis=0)
        touched = np.divide(pressed, moved, out=np.sign(overlap[:-1]), where=moved != 0.0)
        pushed = chain.tangential * np.diff(path.along)[:, None] * touched
        normal = chain.normal * overlap
        limits, before, force = chain.coefficient * normal, np.zeros_like(pushed), np.zeros_like(chain.heights)
        for i, (push, limit) in enumerate(zip(pushed, limits[1:], strict=True)):
            before[i], force = force, np.minimum(np.maximum(force + push, -limit), limit)
        return normal, slip(before, pushed, limits[:-1], limits[1:], chain.tangential)
