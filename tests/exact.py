"""A contact whose states are computed here and not by LAMMPS: independent pairs, each at its own equilibrium.

A pair at the undeformed gap G = r₀ + h − d has r − 2 f(r)/k = G; where that has several roots, the pair keeps the one
that it came to, until its branch ends. What an experiment makes of such states can be held against the exact curve, in
hundreds of cases: that is how a claimed uncertainty is judged.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from contact1d.analysis.pressure import Profile
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace, Hold, Row
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import Session
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.scene import Parabola, Scene
from contact1d.workflow.settings.settings import Settings, settings_for

Array = NDArray[np.float64]
NODES = 4_001
"""Distances among which the ends of a branch are looked for, and a pair's first guess."""
STEPS, FLAT = 3, 1e-3
"""Steps of Newton's method from there, and the slope of G(r) below which none is taken, as at the end of a branch."""
AWAY = 1.0
"""Speed of a plate that has parted [LU/TU]."""


@dataclass(frozen=True)
class Pairs:
    """Pairs under a parabola, all in contact as after a compression."""

    law: PairInteraction
    stiffness: float
    radius: float
    places: Array

    @classmethod
    def of(cls, scene: Scene, settings: Settings) -> Pairs:
        """The scene's; particles lie about the apex alike."""
        terms, profile = scene.interaction, scene.bodies.profile
        assert terms is not None
        assert terms.attraction is not None
        assert isinstance(profile, Parabola)
        law = PairInteraction(*(Exponential(t.amplitude, t.range) for t in (terms.repulsion, terms.attraction)))
        places = (np.arange(settings.particles) - 0.5 * (settings.particles - 1)) * scene.bodies.spacing
        return cls(law, scene.bulk_stiffness, profile.radius, places)

    def undeformed(self, r: Array) -> Array:
        """G(r) [LU]."""
        return np.asarray(r - 2.0 * self.law.force(r) / self.stiffness)

    @cached_property
    def folds(self) -> tuple[float, float]:
        """Distances between which no pair stays: G(r) falls there; one and the same place where it rises everywhere."""
        r = np.linspace(0.0, self.law.force_free_distance() + 20.0 * self.law.longest_range, NODES)
        falls = np.flatnonzero(np.diff(self.undeformed(r)) < 0.0)
        middle = self.law.extremum_distance(1)
        return (float(r[falls[0]]), float(r[falls[-1] + 1])) if falls.size else (middle, middle)

    @cached_property
    def _branches(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """(gaps, distances) of both branches, between which Newton's method begins."""
        end = float(self.places[-1] ** 2 / self.radius) + 40.0 * self.law.longest_range
        inner, outer = (
            np.linspace(0.0, self.folds[0], NODES),
            self.folds[1] + np.geomspace(1e-6 * self.law.longest_range, end, NODES),
        )
        return (self.undeformed(inner), inner), (self.undeformed(outer), outer)

    @property
    def dip(self) -> float:
        """Undeformed gap of the largest tension [LU]; where pairs snap, the one at which they let go."""
        return float(self.undeformed(np.asarray(min(self.folds[0], self.law.extremum_distance(1)))))

    def distances(self, displacement: float, stuck: NDArray[np.bool_] | None = None) -> Array:
        """r of each pair [LU], on the inner branch as far as that goes, or for those that are not `stuck` no more."""
        gap = self.law.force_free_distance() + self.places**2 / (2.0 * self.radius) - displacement
        inner = gap <= self.undeformed(np.asarray(self.folds[0]))
        inner = inner if stuck is None else inner & (stuck | (gap < self.undeformed(np.asarray(self.folds[1]))))
        r = np.where(inner, np.interp(gap, *self._branches[0]), np.interp(gap, *self._branches[1]))
        for _ in range(STEPS):
            slope = 1.0 - 2.0 * self.law.force_slope(r) / self.stiffness
            r = np.where(slope > FLAT, r - (self.undeformed(r) - gap) / np.maximum(slope, FLAT), r)
        return np.asarray(r)

    def force(self, displacement: float) -> float:
        """F(d) [FU] while unloading."""
        return float(self.law.force(self.distances(displacement)).sum())

    def largest_tension(self, low: float, high: float, points: int = 400) -> tuple[float, float]:
        """(displacement [LU], tension [FU]) of the largest tension between two displacements [LU]."""
        d = np.linspace(low, high, points)
        top = int(np.argmin([self.force(x) for x in d]))
        ends = float(d[max(top - 1, 0)]), float(d[min(top + 1, points - 1)])
        found = minimize_scalar(
            self.force, bounds=ends, method="bounded", options={"xatol": 1e-12 * self.law.longest_range}
        )
        return float(found.x), -float(found.fun)

    def displacement(self, force: float, low: float, high: float) -> float:
        """d [LU] of a force [FU] between two displacements [LU]."""
        return float(brentq(lambda d: self.force(d) - force, low, high, xtol=1e-13 * self.law.longest_range))

    def contact_radius(self, displacement: float) -> float:
        """Place of the largest tension of a pair [LU]: x²/2R = G_m − G₀."""
        depth = self.dip - self.law.force_free_distance() + displacement
        return float(np.sqrt(2.0 * self.radius * max(depth, 0.0)))


class Nobody:
    """A session that does nothing and leaves nothing."""

    folder = Path("nowhere")

    def execute(self, text: str, **_: Any) -> None:
        """Do nothing."""


class ExactContact(Contact):
    """The contact: a displacement, or a load that is held at rest up to the largest tension and no further."""

    def __init__(self, deck: Deck, largest_tension: tuple[float, float] | None = None) -> None:
        """`largest_tension`: its displacement and itself, for rows that hold a load."""
        super().__init__(deck, cast(Session, Nobody()))
        self.pairs = Pairs.of(deck.scene, deck.settings)
        self._stuck: NDArray[np.bool_] = np.zeros(deck.settings.particles, dtype=bool)
        self._top = largest_tension

    def rows(self, rows: Sequence[Row]) -> list[State]:
        """One after the other."""
        return [self.row(row) for row in rows]

    def row(self, row: Row) -> State:
        """The exact state."""
        if isinstance(row, Displace):
            return self.state(row.displacement)
        assert isinstance(row, Hold)
        assert self._top is not None
        place, tension = self._top
        if -row.load > tension:
            return self.state(row.parted - 1e-6 * self.pairs.law.longest_range, velocity=-AWAY)
        return self.state(self.pairs.displacement(row.load, place, self.settings.largest_displacement * 1.5))

    def state(self, displacement: float, velocity: float = 0.0) -> State:
        """At a displacement [LU]."""
        r = self.pairs.distances(displacement, self._stuck)
        self._stuck = r <= self.pairs.folds[0]
        force = self.pairs.law.force(r)
        spacing = self.scene.bodies.spacing
        lower = force / -self.pairs.stiffness
        profile = Profile(self.pairs.places, lower, lower + r, force / spacing, np.zeros_like(r))
        phase = self._phases[-1].name
        closest = float(r.min())
        return State(
            phase, displacement, float(force.sum()), profile, closest, 0.0, 0.0, self._rule, plate_velocity=velocity
        )


class ExactContext(RunContext):
    """Opens such contacts."""

    largest_tension: tuple[float, float] | None = None

    @contextmanager
    def contact(self, purpose: str = "", meanwhile: Callable[[Settings], object] | None = None) -> Iterator[Contact]:
        """One contact after the other, each from the start."""
        if meanwhile:
            meanwhile(self.deck.settings)
        yield ExactContact(self.deck, self.largest_tension)


def exact_context(scene: Scene, settings: Settings | None = None) -> ExactContext:
    """For the experiment's own functions: `pull_off_quasistatic(exact_context(scene))`."""
    return ExactContext(Deck(scene, settings or settings_for(scene)), None, Silent(), 1.0)
