"""Particles of opposite chains, and springs on a rigid plane, which are pairs without a memory."""

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
from contact1d.workflow.laws.path import Followed, Path, legs
from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
T = TypeVar("T", bound=Law)
GRID = 4000
TOUCHING, DECADES = 1e-16, 60
"""Overlap over the largest one up to which that of a spring on a plane keeps its digits, and over how many gaps."""


@dataclass(frozen=True, eq=False)
class Independent(Law):
    """Particles that know their own spring and what is opposite, and nothing of their neighbours."""

    beside: ClassVar[tuple[str, ...]] = ("pressed", "interaction")
    exact: ClassVar[tuple[str, ...]] = ("pressed",)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Where no other does."""
        return True

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """That of Lennard-Jones surfaces with the force-free distance of an interaction."""
        law = interaction_law(scene)
        return law.force_free_distance() / LENNARD_JONES_STRESS if law and law.attraction else 0.0

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Self:
        """One-sided springs."""
        found: Self = on_plane(cls, profile, scene.bodies.spacing, scene.bulk_stiffness)
        return found

    def particles(self, x: Array, deepest: float) -> Particles:
        """See `Law`."""
        return Springs(self, x, deepest)


@dataclass(frozen=True, eq=False)
class Springs(Particles):
    """Pairs of opposite particles, and springs on a rigid plane, which are pairs without a memory."""

    @cached_property
    def heights(self) -> tuple[Array, NDArray[np.intp]]:
        """Undeformed gaps at displacement 0 [LU], each once, and which is whose."""
        gaps = self.law.rest + self.shape.height(np.abs(self.x))
        found, own = np.unique(gaps, return_inverse=True)
        return found, own

    @property
    def apart(self) -> float:
        """Where nothing is felt any more [LU]."""
        return self.law.rest - float(self.law.gap[-1])

    def held(self, displacements: Array) -> Array:
        """On the branch of joined pairs [FU]."""
        heights, own = self.heights
        each = self._forces(heights - displacements[:, None], np.ones(heights.size, dtype=bool))
        return np.asarray(each @ np.bincount(own))

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """A pair that has snapped together stays so up to where it snaps apart; see `Particles.carried`."""
        (heights, own), displacements = self.heights, columns["displacement"]
        counts = np.bincount(own)
        joined = np.zeros(heights.size, dtype=bool)
        total, memory = np.empty(displacements.size), []
        for leg in legs(displacements):
            total[leg] = self._forces(heights - displacements[leg, None], joined) @ counts
            memory += [joined] * (leg.stop - leg.start)
            last = heights - displacements[leg.stop - 1]
            joined = (joined | (last < self.law.joins)) & (last < self.law.snap[0])

        def force(state: int) -> Array:
            return np.asarray(self._forces(heights - displacements[state], memory[state])[own])

        return Followed(self.x, total, force)

    def energies(self, path: Path) -> tuple[float, float]:
        """½ k Σ u²; nothing is lost."""
        heights, own = self.heights
        pressed = np.maximum(path.displacement[-1] - heights, 0.0)
        return 0.5 * self.law.stiffness * float(pressed**2 @ np.bincount(own)), 0.0

    def _forces(self, gaps: Array, joined: NDArray[np.bool_]) -> Array:
        estimate = self.law
        inner = np.interp(gaps, estimate.gap, estimate.force, right=0.0)
        if not estimate.snaps or joined.all():
            return np.asarray(inner)
        assert estimate.outer is not None
        return np.where(joined, inner, np.interp(gaps, estimate.outer, estimate.force, right=0.0))


def interaction_law(scene: Scene) -> DoubleExponential | None:
    """The pair interaction of the scene, or None on a rigid plane."""
    if scene.interaction is None:
        return None
    terms = scene.interaction
    attraction = None if terms.attraction is None else Exponential(terms.attraction.amplitude, terms.attraction.range)
    return DoubleExponential(Exponential(terms.repulsion.amplitude, terms.repulsion.range), attraction)


def row_force(law: DoubleExponential, r: Array, spacing: float, cutoff: float) -> Array:
    """Force [FU] of a straight chain of opposite particles on the one facing it, at distances r [LU], shape (n,)."""
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
    points: int = GRID,
    chains: int = 2,
    row: float | None = None,
) -> Independent:
    """The law of particles held by springs `stiffness` [FU/LU] each, in two chains or in the upper one alone.

    `row`: spacing [LU] of the opposite row where it differs.
    """
    r, force = _row_over(law, row or spacing, cutoff, points)
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
def _row_over(law: DoubleExponential, spacing: float, cutoff: float, points: int) -> tuple[Array, Array]:
    """Distances [LU] up to the cutoff, and the `row_force` [FU] there."""
    r = np.linspace(cutoff / points, cutoff, points)
    force = row_force(law, r, spacing, cutoff)
    r.flags.writeable = force.flags.writeable = False
    return r, force


@lru_cache(maxsize=16)  # as of_pairs
def on_plane(kind: type[T], profile: Profile, spacing: float, stiffness: float, *own: Any) -> T:
    """The law of one chain on a rigid plane: one-sided springs `stiffness` [FU/LU], and numbers of its `own`."""
    return kind(*springs(spacing, stiffness), profile, spacing, stiffness, False, 0.0, None, *own)


def springs(spacing: float, stiffness: float) -> tuple[Array, Array, float]:
    """Gaps [LU], forces [FU] of a spring on a rigid plane, and the distance [LU] of apexes that touch."""
    deepest = 1e6 * spacing
    gap = np.append(-np.geomspace(deepest, TOUCHING * deepest, DECADES), 0.0)  # straight lines keep their digits
    return gap, -stiffness * gap, 0.0
