"""Pairs of particles of opposite chains, and springs on a rigid plane, which are pairs without a memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, ClassVar, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.theory.adhesion import LENNARD_JONES_STRESS
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.laws.law import Law
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, Followed, Path, legs
from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Scene

T = TypeVar("T", bound=Law)


@dataclass(frozen=True, eq=False)
class Independent(Law):
    """Particles without neighbours: each has its own spring and the opposite chain or a rigid plane."""

    closed_forms: ClassVar[tuple[str, ...]] = ("pressed", "interaction")
    exact: ClassVar[tuple[str, ...]] = ("pressed",)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Return True: this law is the last one, of every scene without another."""
        return True

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """Return the range [LU] of Lennard-Jones surfaces with the same force-free distance as the interaction.

        0 on a rigid plane and without attraction; `assumed` is not used.
        """
        law = interaction_law(scene)
        return law.force_free_distance() / LENNARD_JONES_STRESS if law and law.attraction else 0.0

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Self:
        """Return the law of one-sided springs on a rigid plane, without attraction, with spacing and stiffness of a
        scene.

        `profile`: shape of the upper body. Equal arguments give the same instance.
        """
        law: Self = on_plane(cls, profile, scene.bodies.spacing, scene.bulk_stiffness)
        return law

    def particles(self, x: Array, deepest: float) -> Particles:
        """Return the springs at positions x, (n,) [LU]; `deepest`: largest expected displacement [LU]."""
        return Springs(self, x, deepest)


@dataclass(frozen=True, eq=False)
class Springs(Particles):
    """Pairs of opposite particles, and springs on a rigid plane, which are pairs without a memory."""

    @cached_property
    def heights(self) -> tuple[Array, NDArray[np.intp]]:
        """Undeformed gaps at displacement 0, (k,) [LU], rising and different, and the index of each particle's gap,
        (n,).
        """
        gaps = self.law.rest + self.shape.height(np.abs(self.x))
        heights, indices = np.unique(gaps, return_inverse=True)
        return heights, indices

    @property
    def apart(self) -> float:
        """Displacement [LU] below which no pair has a force; 0 on a rigid plane."""
        return self.law.rest - self.law.cutoff_gap

    def held(self, displacements: Array) -> Array:
        """Return F, (m,) [FU], compression positive, at displacements (m,) [LU], with all pairs snapped in, as in
        unloading.

        0 where no pair has a force; on a rigid plane there is no tension.
        """
        heights, indices = self.heights
        forces = self._forces(heights - displacements[:, None], np.ones(heights.size, dtype=bool))
        return forces @ np.bincount(indices)

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the normal forces of load steps at the column "displacement", (m,) [LU]; other columns are not used.

        They are the sums over the particles, (m,) [FU], compression positive, and a function of the index of a load
        step that gives those of each particle. The path begins with separated bodies. A pair that has snapped in stays
        so up to its snap-out; this is decided where the direction of the displacement turns.
        """
        (heights, indices), displacements = self.heights, columns["displacement"]
        counts = np.bincount(indices)
        joined = np.zeros(heights.size, dtype=bool)
        total, memory = np.empty(displacements.size), []
        for leg in legs(displacements):
            total[leg] = self._forces(heights - displacements[leg, None], joined) @ counts
            memory += [joined] * (leg.stop - leg.start)
            last = heights - displacements[leg.stop - 1]
            joined = (joined | (last < self.law.joins)) & (last < self.law.snap[0])

        def force(state: int) -> Array:
            """Return the force of each particle, (n,) [FU], compression positive, in the state of index `state`."""
            return self._forces(heights - displacements[state], memory[state])[indices]

        return Followed(self.x, total, force)

    def energies(self, path: Path) -> tuple[float, float]:
        """Return (elastic energy ½ k Σ u² at the end of a path, dissipated energy 0), both [FU·LU].

        It is that of one-sided springs on a rigid plane, at the normal displacement; an interaction of pairs is not
        included.
        """
        heights, indices = self.heights
        pressed = np.maximum(path.displacement[-1] - heights, 0.0)
        return 0.5 * self.law.stiffness * float(pressed**2 @ np.bincount(indices)), 0.0

    def _forces(self, gaps: Array, joined: NDArray[np.bool_]) -> Array:
        """Return the forces, (…, n) [FU], compression positive, of pairs at undeformed gaps, (…, n) [LU]; 0 beyond the
        cutoff.

        `joined`: whether each pair has snapped in, (n,); without effect where none snaps. A gap below the least one of
        the law's grid has the force there.
        """
        law = self.law
        inner = np.interp(gaps, law.gap, law.force, right=0.0)
        if not law.snaps or joined.all():
            return inner
        assert law.outer is not None
        return np.where(joined, inner, np.interp(gaps, law.outer, law.force, right=0.0))


def interaction_law(scene: Scene) -> DoubleExponential | None:
    """Return the interaction of a pair of opposite particles of a scene, without its cutoff; None on a rigid plane.

    Where the scene gives no attraction it is purely repulsive.
    """
    if scene.interaction is None:
        return None
    terms = scene.interaction
    attraction = None if terms.attraction is None else Exponential(terms.attraction.amplitude, terms.attraction.range)
    return DoubleExponential(Exponential(terms.repulsion.amplitude, terms.repulsion.range), attraction)


def row_force(law: DoubleExponential, r: Array, spacing: float, cutoff: float) -> Array:
    """Return the force of a straight chain on a particle opposite to one of its own, (n,) [FU], repulsion positive.

    It is the component normal to the chain, which is infinitely long.

    Args:
        law: interaction of a pair.
        r: distances > 0 of the particle from the chain, (n,) [LU].
        spacing: of the chain [LU].
        cutoff: distance [LU] beyond which a pair has no force.
    """
    offsets = spacing * np.arange(int(cutoff / spacing) + 1)
    distance = np.hypot(r[:, None], offsets[None, :])
    forces = np.where(distance <= cutoff, law.force(distance), 0.0) * r[:, None] / distance
    return np.asarray(np.concatenate([forces[:, :0:-1], forces], axis=1).sum(axis=1))


@lru_cache(maxsize=16)  # scenes run one after the other mostly share bodies and law
def of_pairs(
    law: DoubleExponential,
    profile: Profile,
    spacing: float,
    stiffness: float,
    cutoff: float,
    rest: float,
    points: int = 4000,
    chains: int = 2,
    row: float | None = None,
) -> Independent:
    """Return the law of particles on springs of a `stiffness` [FU/LU] each, in two chains or in the upper one alone.

    It is cached: equal arguments give the same instance.

    Args:
        law: interaction of a pair.
        profile: shape of the upper body.
        spacing: distance of neighbouring particles of the upper body [LU].
        stiffness: of one spring [FU/LU].
        cutoff: distance [LU] at which the interaction ends.
        rest: distance of the apexes at displacement 0 [LU].
        points: number of distances up to the cutoff in the grid of gaps and forces.
        chains: how many chains have springs, 1 or 2.
        row: spacing [LU] of the opposite chain where it differs.
    """
    r, force = _force_table(law, row or spacing, cutoff, points)
    undeformed = r - chains * force / stiffness
    rising = np.arange(points) * 1e-12 * cutoff
    gap = np.maximum.accumulate(undeformed) + rising
    falls = np.diff(undeformed) < 0.0
    outer = np.minimum.accumulate(undeformed[::-1])[::-1] + rising if falls.any() else None
    first = max(int(falls.argmax()) - 1, 0)
    bend = abs(float(np.diff(undeformed, 2)[first])) / (cutoff / points) ** 2 if falls.any() else 0.0
    gap.flags.writeable = False
    return Independent(gap, force, rest, profile, spacing, stiffness / chains, bool(falls.any()), bend, outer)


@lru_cache(maxsize=16)  # a law is mostly that of several bodies
def _force_table(law: DoubleExponential, spacing: float, cutoff: float, points: int) -> tuple[Array, Array]:
    """Return (distances r [LU], forces [FU]), (points,) each, of a particle opposite to one of a straight chain.

    Distances rise in equal steps to the cutoff, without 0; repulsion is positive. `spacing`: of the chain [LU]. Both
    are cached and read-only.
    """
    r = np.linspace(cutoff / points, cutoff, points)
    force = row_force(law, r, spacing, cutoff)
    r.flags.writeable = force.flags.writeable = False
    return r, force


@lru_cache(maxsize=16)  # as of_pairs
def on_plane(kind: type[T], profile: Profile, spacing: float, stiffness: float, *parameters: Any) -> T:
    """Return the law of one chain on a rigid plane: one-sided springs of a `stiffness` [FU/LU] each.

    It is cached: equal arguments give the same instance.

    Args:
        kind: class of the law.
        profile: shape of the upper body.
        spacing: of the particles [LU].
        stiffness: of one spring [FU/LU].
        parameters: the fields that the class adds to those of `Law`, in their order.
    """
    return kind(*springs(spacing, stiffness), profile, spacing, stiffness, False, 0.0, None, *parameters)


def springs(spacing: float, stiffness: float) -> tuple[Array, Array, float]:
    """Return (gaps [LU], forces [FU] of a one-sided spring on a rigid plane at these undeformed gaps, 0).

    Gaps (61,) rise from −10⁶ spacings to 0, in geometric progression; a force is −`stiffness` [FU/LU] times the gap, ≥
    0. The third is the distance [LU] of the apexes at displacement 0.
    """
    deepest = 1e6 * spacing
    # Straight lines between gaps in geometric progression keep the digits of an overlap, however small.
    gap = np.append(-np.geomspace(deepest, 1e-16 * deepest, 60), 0.0)
    return gap, -stiffness * gap, 0.0
