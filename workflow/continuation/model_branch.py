"""The reduced model in place of LAMMPS: driven by the same script and evaluated by the same reader."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.continuation.trace import Trace, of_model
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import History, Path
from contact1d.workflow.model.free import impact, swing
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
COARSE, DENSE, FINE, ZOOMS = 24, 100, 30, 2
"""Positions of the first look for the force maximum, on a rigid plane and between particles, and of each closer one,
and how many of these: none where the curve is smooth, since the model's forces are straight between the points of a
grid, whose corners would move a top."""
BESIDE = 32.0
"""Part of the distance of two positions in which those beside a force maximum are, three on either side."""
OPENED = np.asarray([1e-4, 0.05])
"""States beyond where nothing is felt any more, over all of the way."""
BETWEEN = 8
"""Intermediate positions towards a force."""
LAST = 1e-9
"""How much of the path from F = 0 to the limit point is left before it."""
NEAR = 1e-6
"""Distance over the spacing from a jump of the force at which it has jumped, or not yet."""
NEAREST = 3
"""Last states before a limit point, of which that with the largest tension is the force maximum."""
MOST_NUMBERS = 2_000_000
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
        marks: names under which states are reported, by the number of the state.
    """

    def __init__(self, scene: Scene, settings: Settings, model: Particles, dense: int, shift: float) -> None:
        """Begin apart."""
        self.scene, self.settings, self.model, self.dense, self.shift = scene, settings, model, dense, shift
        self._phase, self._leg = "", -1
        self._rises: bool | None = None
        self._given = "displacement"
        self._rows: list[Row] = []
        self._beyond = np.empty(0)
        self.marks: dict[int, list[str]] = {}

    @property
    def scale(self) -> float:
        """The force maximum that is expected [FU]."""
        return self.settings.law.pull_off_force()

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
        dense, leading = self._between(np.append(self._rows[-1].displacement, wanted), between)
        own = self._phase
        if self._rows[-1].phase == UNSEEN:  # what leads from there to the first state of a path is none of it
            self._phase = UNSEEN
            self._add(dense[:leading])
            dense = dense[leading:]
        self._phase = own
        self._add(dense)

    def _between(self, ends: Array, count: int) -> tuple[Array, int]:
        """So many positions [LU] of each step, its end the last, and those on both sides of a jump.

        And how many there are before the end of the first step.
        """
        near = NEAR * self.model.law.spacing
        jumps = np.asarray([at + side for at in self.model.jumps for side in (-near, near)])
        steps, step = np.arange(ends.size), np.diff(ends)
        passed = np.divide(
            jumps - ends[:-1, None], step[:, None], out=np.zeros((step.size, jumps.size)), where=step[:, None] != 0.0
        )
        inside = (passed > 0.0) & (passed < 1.0)
        at = np.union1d(np.arange(1, count * step.size + 1) / count, (steps[:-1, None] + passed)[inside])
        return np.interp(at, steps, ends), int(np.count_nonzero(at < 1.0))

    def reach(self, force: float, scale: float) -> None:
        """Go to where a force [FU] is carried; under a tension from where the bodies touch on."""
        end, begun = self.model.displacement_at(force), bool(self._rows)
        start = self._rows[-1].displacement if begun else 0.0
        self._turn(end > start)
        self._add(np.linspace(start, end, BETWEEN + 1)[begun:])

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """A displacement [LU], or a plate that moves under a force [FU], for a time [TU]: the first and the last state.

        A transient is that of plate and particles on the contact's own force; see `free.swing`.
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
        """Displacements or forces over time, and others between them; phases are reported at their ends."""
        history = history.denser(self.dense)
        self._leg += 1
        self._given = "force" if history.by_force else self._given
        self._add_path(history.phases, history.path(self.model))
        for i, (one, other) in enumerate(pairwise([*history.phases, ""])):
            if one != other and one in history.marks:
                self.marks.setdefault(i, []).append(history.marks[one])

    def fly(self, velocity: float) -> None:
        """A flight at an approach velocity [LU/TU] onto the contact and off it again; see `free.impact`."""
        path = impact(self.scene, self.settings, self.model, velocity, self.dense)
        self._leg += 1
        self._add_path(["impact"] * path.time.size, path)

    def maximum(self) -> None:
        """Go to the force maximum, densely about it; `open` goes on from there."""
        self._turn(False)
        zero, apart = self._rows[-1].displacement, self.model.apart
        end = zero + (1.0 - LAST) * (apart - zero)
        if self.settings.forces.range:
            found = np.linspace(zero, end, DENSE * (2 if self.settings.snaps else 1))[1:]
        else:
            found = self.model.unloading(zero, end, COARSE)
        every = np.append(zero, found)
        top = int(np.argmin(self.model.held(every)))
        low, high = float(every[min(top + 1, every.size - 1)]), float(every[max(top - 1, 0)])
        step, place = 0.5 * (high - low) / BESIDE, float(every[top])
        known = self.model.critical_displacement
        for _ in range(0 if self.settings.is_smooth or known is not None else ZOOMS):
            closer, width = np.linspace(high, low, FINE, retstep=True)
            place = float(closer[int(np.argmin(self.model.held(closer)))])
            low, high = max(place - abs(width), end), min(place + abs(width), zero)
        place = min(max(known, end), zero) if known is not None else place
        beside = place + step * np.arange(-3.0, 4.0)
        found = np.unique(np.append(found, np.clip(beside, end, zero)))[::-1]
        found = found[found < zero]
        last = int(np.count_nonzero(found > place - 0.5 * step)) if place < zero else 0
        if (near := found[max(last - NEAREST, 0) : last]).size:
            tensions = -self.model.held(near)  # a chain may lose a part at its limit point, the top that a law knows
            if known is None or tensions[-1] < (1.0 - self.settings.tolerance) * tensions.max():
                last -= near.size - 1 - int(np.argmax(tensions))
        self._add(found[:last])
        self._beyond = found[last:]

    def mark(self, name: str) -> None:
        """Report the last state."""
        self.marks.setdefault(self.last, []).append(name)

    def open(self) -> None:
        """Pull the bodies apart."""
        apart, deepest = self.model.apart, max(row.displacement for row in self._rows)
        self._add(np.append(self._beyond, apart - OPENED * (deepest - apart)))
        self._beyond = np.empty(0)

    @property
    def last(self) -> int:
        """Number of the last state."""
        return len(self._rows) - 1

    @property
    def held(self) -> float:
        """F [FU] of the last state, of a contact that is unloaded from deeper."""
        return float(self.model.held(np.asarray([self._rows[-1].displacement]))[0])

    @property
    def phases(self) -> list[str]:
        """Names of the phases of all states."""
        return [row.phase for row in self._rows]

    @property
    def legs(self) -> list[int]:
        """Numbers of the legs of all states."""
        return [row.leg for row in self._rows]

    @property
    def path(self) -> Path:
        """All states, also those that no reader sees."""
        columns = list(zip(*self._rows, strict=True))[2:]
        d, along, time, velocity = (np.asarray(column, dtype=np.float64) for column in columns)
        return Path(d, along, time, None if np.isnan(velocity).any() else velocity)

    def trace(self, whole: bool = False) -> Trace:
        """What a reader sees; of the `whole` path also what leads to its first state."""
        phases, legs, path = self.phases, self.legs, self.path
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
        columns = (none if one is None else np.asarray(one) for one in (along, time))
        self._add_path([self._phase] * none.size, Path(positions, *columns))

    def _add_path(self, phases: Sequence[str], path: Path) -> None:
        """States in time."""
        unknown = np.full(path.time.size, math.nan)
        columns = path.displacement, path.along, path.time, unknown if path.velocity is None else path.velocity
        rows = zip(*(column.tolist() for column in columns), strict=True)
        self._rows += [Row(phase, self._leg, *row) for phase, row in zip(phases, rows, strict=True)]


Script = Callable[[ModelBranch], object]
"""What moves a contact."""
