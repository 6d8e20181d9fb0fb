"""The reduced model in place of LAMMPS: driven by the same script and evaluated by the same reader."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.continuation.trace import Trace, of_model
from contact1d.workflow.model.reduced import History, Path, Reduced, impact, swing
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
COARSE, FINE, ZOOMS = 100, 30, 2
"""Positions of the first look for the force maximum and of each closer one, and how many of these: none where the
curve is smooth, since the model's forces are straight between the points of a grid, whose corners would move a top."""
BETWEEN = 8
"""Intermediate positions towards a force."""
LAST = 1e-9
"""How much of the path from F = 0 to the limit point is left before it."""
NEAR = 1e-6
"""Distance over the spacing from a jump of the force at which it has jumped, or not yet."""
MOST_NUMBERS = 400_000
"""Forces that are worked out in a path with dense positions."""
UNSEEN = ""
"""Phase of states that make the history of a path and are none of it."""


class Row(NamedTuple):
    """A position of the plate: phase, leg, displacement and position along x [LU], time [TU], velocity [LU/TU]."""

    phase: str
    leg: int
    displacement: float
    along: float
    time: float
    velocity: float


class ModelBranch:
    """States of the model, with positions of the required density; they are computed together at the end.

    Attributes:
        model: the particles.
        dense: positions for each step that the scene gives.
        shift: of the displacements that it gives [LU].
    """

    def __init__(self, scene: Scene, settings: Settings, model: Reduced, dense: int, shift: float) -> None:
        """Begin apart."""
        self.scene, self.settings, self.model, self.dense, self.shift = scene, settings, model, dense, shift
        self._phase, self._leg = "", -1
        self._rises: bool | None = None
        self._given = "displacement"
        self._rows: list[Row] = []

    @property
    def scale(self) -> float:
        """The force maximum that is expected [FU]."""
        return self.settings.estimate.pull_off_force()

    def begin(self, name: str) -> None:
        """Begin a phase."""
        self._phase = name

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | Array | None = None) -> None:
        """Displacements [LU] that are known beforehand, and others between them; positions along x [LU], else 0."""
        wanted = np.asarray(positions, dtype=np.float64) + self.shift
        before = self._rows[-1].displacement if self._rows else float(wanted[0])
        self._turn(float(wanted[-1]) >= before)
        between = min(self.dense, max(1, MOST_NUMBERS // max(1, wanted.size * self.model.x.size)))
        if between == 1:
            self._add(wanted, along)
            return
        if not self._rows:
            self._add(wanted[:1])
            wanted = wanted[1:]
        ends = np.append(self._rows[-1].displacement, wanted)
        dense = [self._between(*pair, between) for pair in pairwise(ends.tolist())]
        own = self._phase
        if dense and self._rows[-1].phase == UNSEEN:  # what leads from there to the first state of a path is none of it
            self._phase = UNSEEN
            self._add(dense[0][:-1])
            dense[0] = dense[0][-1:]
        self._phase = own
        if dense:
            self._add(np.concatenate(dense))

    def _between(self, start: float, end: float, count: int) -> Array:
        """So many positions [LU] of a step, its end the last, and others on both sides of each jump."""
        near = NEAR * self.model.estimate.spacing
        beside = [at + side for at in self.model.jumps for side in (-near, near)]
        inner = [at for at in beside if min(start, end) < at < max(start, end)]
        found = np.unique([*np.linspace(start, end, count + 1)[1:], *inner])
        return found if end > start else found[::-1]

    def reach(self, force: float, scale: float) -> None:
        """Go to where a force [FU] is carried."""
        end = self.model.displacement_at(force)
        start = self._rows[-1].displacement if self._rows else min(0.0, end) - self.settings.estimate.spacing
        self._turn(end > start)
        self._add(np.linspace(start, end, BETWEEN + 1)[1:])

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """A displacement [LU], or a plate that moves under a force [FU], for a time [TU]: the first and the last state.

        A transient is that of plate and particles on the contact's own force; see `reduced.swing`.
        """
        if displacement is not None:
            self._add(np.asarray([displacement, displacement]), time=(0.0, duration))
        elif force is not None:
            start = 0.0
            if force < 0.0:
                self.reach(0.0, self.scale)
                start = self._rows[-1].displacement
            self._add(swing(self.scene, self.settings, self.model, start, force, duration), time=(0.0, duration))

    def follow(self, history: History) -> None:
        """Displacements or forces over time, and others between them."""
        history = history.denser(self.dense)
        self._leg += 1
        self._given = "force" if history.by_force else self._given
        self._add_path(history.phases, history.path(self.model))

    def fly(self, velocity: float) -> None:
        """See `reduced.impact`."""
        path = impact(self.scene, self.settings, self.model, velocity, self.dense)
        self._leg += 1
        self._add_path(["impact"] * path.time.size, path)

    def maximum(self) -> None:
        """Pass the force maximum, densely about it."""
        self._turn(False)
        zero, apart = self._rows[-1].displacement, self.model.apart
        end = zero + (1.0 - LAST) * (apart - zero)
        dense = COARSE * (2 if self.settings.snaps else 1)
        positions, step = np.linspace(zero, end, dense, retstep=True)
        found = [positions[1:]]
        for _ in range(0 if self.settings.is_smooth else ZOOMS):
            top = float(positions[int(np.argmin(self.model.held(positions)))])
            low, high = max(top - abs(step), end), min(top + abs(step), zero)
            positions, step = np.linspace(high, low, FINE, retstep=True)
            found.append(positions[1:])
        self._add(np.unique(np.concatenate(found))[::-1])

    def mark(self, name: str) -> None:
        """Nothing is written."""

    def open(self) -> None:
        """Pull the bodies apart."""
        self._add(np.asarray([self.model.apart - self.settings.estimate.spacing]))

    @property
    def path(self) -> Path:
        """All states, also those that no reader sees."""
        columns = list(zip(*self._rows, strict=True))[2:]
        d, along, time, velocity = (np.asarray(column, dtype=np.float64) for column in columns)
        return Path(d, along, time, None if np.isnan(velocity).any() else velocity)

    def trace(self, whole: bool = False) -> Trace:
        """What a reader sees; of the `whole` path also what leads to its first state."""
        phases, legs = list(zip(*self._rows, strict=True))[:2]
        path = self.path
        rule = radius_rule(self.scene, self.settings.tolerance)
        found = of_model(phases, legs, path, self.model.follow(path), rule, self.model)
        found = replace(found, given=self._given)
        return found if whole else found.chosen([i for i, name in enumerate(phases) if name != UNSEEN])

    def _turn(self, rises: bool) -> None:
        """Begin a leg where the loading turns."""
        self._leg += rises != self._rises
        self._rises = rises

    def _add(
        self, positions: Array, along: Sequence[float] | Array | None = None, time: Sequence[float] | None = None
    ) -> None:
        none = np.zeros(len(positions))
        columns = (positions, none if along is None else along, none if time is None else time)
        rows = zip(*columns, strict=True)
        self._rows += [Row(self._phase, self._leg, float(d), float(x), float(t), math.nan) for d, x, t in rows]

    def _add_path(self, phases: Sequence[str], path: Path) -> None:
        """States in time."""
        unknown = np.full(path.time.size, math.nan)
        columns = path.displacement, path.along, path.time, unknown if path.velocity is None else path.velocity
        rows = zip(*(column.tolist() for column in columns), strict=True)
        self._rows += [Row(phase, self._leg, *row) for phase, row in zip(phases, rows, strict=True)]
