"""Friction on a rigid plane before LAMMPS runs: Jenkins elements, springs with a slider that slips at μ f.

    f_i = k_n max(0, d − h(x_i)),   s_i ← clip(s_i + k_t Δu, ±μ f_i)

This gives the displacement that carries a load, and the displacements at which particles begin or end to touch; every
result is LAMMPS's own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from contact1d.analysis.shear import Slip, slip
from contact1d.workflow.laws.numerics import ROUND_OFF
from contact1d.workflow.laws.pairs import Independent, Springs, on_plane
from contact1d.workflow.laws.particles import MORE_PHASES
from contact1d.workflow.laws.path import Array, Followed, Path
from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Friction, Scene, Tangential

Stop = tuple[float, float]
"""Displacement and position along x [LU]."""


@dataclass(frozen=True)
class JenkinsElements:
    """The Jenkins elements of particles: springs in series with a slider.

    Attributes:
        heights: undeformed heights of the particles [LU], (n,).
        normal, tangential: stiffnesses of one element [FU/LU].
        coefficient: coefficient of friction μ.
    """

    heights: Array
    normal: float
    tangential: float
    coefficient: float

    def displacement_under(self, force: float) -> float:
        """Return the displacement [LU] that carries a normal force [FU] ≥ 0.

        For 0 it is short of the first touch, by 1e-9 of the range of heights, of a flat body by 1e-9 LU.
        """
        heights = np.sort(self.heights)
        if force == 0.0:
            return float(heights[0] - ROUND_OFF * (heights[-1] - heights[0] or 1.0))
        count = np.arange(1, len(heights) + 1)
        below = np.cumsum(heights)
        # F where the next particle begins to touch; beyond the last one F is unbounded.
        carried = self.normal * (count[:-1] * heights[1:] - below[:-1])
        touching = int(np.searchsorted(carried, force, side="left"))
        return float((force / self.normal + below[touching]) / count[touching])

    def touches(self, before: float, after: float) -> list[float]:
        """Return the displacements [LU] strictly between two, in order, at which a particle begins or ends to touch,
        each once.

        `before`, `after`: displacements [LU]; where `after` is below `before` the order is falling. Empty without any.
        """
        low, high = min(before, after), max(before, after)
        between = np.unique(self.heights[(self.heights > low) & (self.heights < high)])
        return [float(height) for height in (between if after > before else between[::-1])]


def without_stops(path: Sequence[Stop]) -> list[Stop]:
    """Return a path without stops between others of a straight tangential line at constant displacement.

    Such stops have no effect. The first and the last stop are always kept. `path`: (displacement, position along x)
    [LU] of each stop; it is not changed.
    """
    kept = list(path[:2])
    for stop in path[2:]:
        (depth, start), (next_depth, position) = kept[-2:]
        onwards = (position - start) * (stop[1] - position) >= 0.0 and position != start
        if onwards and depth == next_depth == stop[0]:
            kept.pop()
        kept.append(stop)
    return kept


def elements_of(scene: Scene, x: Array) -> JenkinsElements:
    """Return the Jenkins elements of a scene with [friction], at positions x, (n,) [LU], relative to the apex."""
    stiffnesses = scene.bulk_stiffness, scene.tangential_stiffness
    return JenkinsElements(scene.bodies.height(x), *stiffnesses, scene.the(Friction).coefficient)


def stops(experiment: Tangential, elements: JenkinsElements) -> list[Stop]:
    """Return (normal displacement, position along x) [LU] of the start, and of the end of each load step, in order.

    The start has the displacement of the first load step, at position 0. Where the experiment prescribes normal forces,
    `elements` give the displacements that carry them.
    """
    normal = experiment.places()
    if not normal:
        depths: dict[float, float] = {}
        for force in experiment.normal_forces():
            if force not in depths:
                depths[force] = elements.displacement_under(force)
            normal.append(depths[force])
    return [(normal[0], 0.0), *zip(normal, experiment.along(), strict=True)]


@dataclass(frozen=True, eq=False)
class Frictional(Independent):
    """Contact with friction: one Jenkins element for each particle.

    Attributes:
        ratio: tangential over normal stiffness, dimensionless.
        coefficient: coefficient of friction μ.
    """

    closed_forms = ("pressed", "along", "oblique")
    exact = ("pressed", "along")

    ratio: float = 1.0
    coefficient: float = 0.0

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Return whether the scene has [friction]."""
        return scene.friction is not None

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Self:
        """Return the law of springs on a rigid plane, with the stiffnesses and coefficient of friction of a scene.

        Equal arguments give the same instance.
        """
        spring, coefficient = scene.bulk_stiffness, scene.the(Friction).coefficient
        law: Self = on_plane(
            cls, profile, scene.bodies.spacing, spring, scene.tangential_stiffness / spring, coefficient
        )
        return law

    def particles(self, x: Array, deepest: float) -> SlidingSprings:
        """Return the springs with their sliders at positions x, (n,) [LU].

        `deepest`: largest expected displacement [LU].
        """
        return SlidingSprings(self, x, deepest)


@dataclass(frozen=True, eq=False)
class SlidingSprings(Springs):
    """Springs with a slider each, on a rigid plane, along paths of normal and tangential displacements."""

    law: Frictional

    phases = MORE_PHASES

    @property
    def chain(self) -> JenkinsElements:
        """Jenkins elements of these particles."""
        heights = self.shape.height(np.abs(self.x))
        normal = self.law.stiffness
        return JenkinsElements(heights, normal, self.law.ratio * normal, self.law.coefficient)

    def energies(self, path: Path) -> tuple[float, float]:
        """Return (elastic energy at the end of a path, dissipated work of slip along it), both [FU·LU].

        The elastic energy is ½ Σ (k u² + s²/k_t) with the tangential force s of each particle [FU]; the path begins
        without a tangential force.
        """
        normal, tangential, slipped = (float(column[-1]) for column in self.booked(path))
        return normal + tangential, slipped

    def booked(self, path: Path) -> tuple[Array, Array, Array]:
        """Return (½ Σ k u², ½ Σ s²/k_t, work of slip since the start) in each state of a path, (m,) [FU·LU] each."""
        normal, steps = self._slid(path)
        chain, shears = self.chain, np.pad(steps.force, ((1, 0), (0, 0)))
        stored = [0.5 * np.sum(f**2, axis=1) / k for f, k in ((normal, chain.normal), (shears, chain.tangential))]
        return *stored, np.append(0.0, np.cumsum(steps.work.sum(axis=1)))

    def force_in_time(self) -> Callable[[float, float, float], float]:
        """Return a function of F = k Σ max(0, d − h) [FU], called with (displacement d [LU], time, velocity)."""
        heights, normal = self.chain.heights, self.law.stiffness
        return lambda displacement, time, velocity: normal * float(np.maximum(displacement - heights, 0.0).sum())

    def shear_in_time(self) -> Callable[[float, float], float]:
        """Return a function of the tangential force Σ s [FU] that resists a motion of the body along +x.

        It is called state by state with (next displacement, next position along x) [LU], and remembers the state. A
        particle that begins or ends to touch moves along for the part of the step in which it touches.
        """
        chain, depth, place = self.chain, 0.0, 0.0
        overlap, shear = np.zeros_like(chain.heights), np.zeros_like(chain.heights)

        def force(displacement: float, along: float) -> float:
            """Return Σ s [FU] at a displacement and a position along x [LU]."""
            nonlocal depth, place, overlap, shear
            pressed, moved = np.maximum(displacement - chain.heights, 0.0), displacement - depth
            touched = (pressed - overlap) / moved if moved else np.sign(pressed)
            limit = chain.coefficient * chain.normal * pressed
            pushed = shear + chain.tangential * (along - place) * touched
            shear = np.minimum(np.maximum(pushed, -limit), limit)
            depth, place, overlap = displacement, along, pressed
            return float(shear.sum())

        return force

    def prescribed(self, path: Path) -> dict[str, Array]:
        """Return the columns {"displacement": normal displacement d, "place": position along x} of a path, (m,) [LU]
        each.
        """
        return {"displacement": path.displacement, "place": path.along}

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the normal and tangential forces of load steps by their columns "displacement" and "place", (m,) [LU].

        They are the sums of the normal forces, (m,) [FU], and functions of the index of a load step that give the
        normal and the tangential force of each particle, (n,) [FU]. Displacement and position along x change in
        proportion within a step. Normal forces are positive in compression; tangential ones are those of the plane on
        the particles, along +x, and negative after a motion along +x. The first state has no tangential force.
        """
        depths, positions = columns["displacement"], columns["place"]
        normal, steps = self._slid(Path(depths, positions, np.zeros_like(depths)))
        shears = np.pad(steps.force, ((1, 0), (0, 0)))
        return Followed(self.x, normal.sum(axis=1), normal.__getitem__, lambda state: -shears[state])

    def _slid(self, path: Path) -> tuple[Array, Slip]:
        """Return (normal forces in each state, (m, n) [FU] ≥ 0; slip of each load step, (m − 1, n)) along a path.

        A slip has the tangential force at the end of the step [FU] and the work dissipated [FU·LU]. The force is
        that of the springs, positive after a motion along +x; it begins with 0 in the first state.
        """
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
