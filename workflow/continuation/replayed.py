"""A branch of states that depend on the loading history, since pairs snap: the schedule is run again from the start.

Each time it has the required positions in their order, more of them near the force maximum.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from contact1d.analysis.curve_marks import Peak, rivals, smooth_crossing
from contact1d.workflow.continuation.branch import READ_SHARE, Branch
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.marks import cut_short, early_loss, radius_rate
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import UntrustedError
from contact1d.workflow.deck.steps import Phase, displacements, numbered

MOST_REPLAYS = 8
GROWTH = 1.2
"""Of moves apart: longer ones lose particles early."""
SAME = 1e-9
"""Distance of two load steps over the way that are one."""
WINDOW_ROWS, ZOOM_FACTOR, RIVAL_SHARE = 8, 0.25, 0.05
"""Of a schedule that is run again: load steps on either side of the force maximum, width of that window over the one
before, and maxima within this share of the largest that are all examined in the first one."""


class ReplayedBranch(Branch):
    """States where pairs snap."""

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact."""
        super().__init__(context, meanwhile)
        self._is_replayed = False
        self._passed: tuple[Phase, ...] = ()
        self._targets: dict[bool, float] = {}

    def reach(self, force: float, scale: float) -> None:
        """See `Branch.reach`; a leg of rising displacement begins a new schedule behind the one that is known."""
        phases, leg = self.contact.phases, self._number
        super().reach(force, scale)
        rises = self._direction > 0
        if rises and self._number != leg:
            self._passed, self._is_replayed = phases, False
        self._targets[rises] = force

    def mark(self, name: str) -> None:
        """Report the last state; a schedule that was run again has its marks."""
        if not self._is_replayed:
            super().mark(name)

    def maximum(self) -> None:
        """Pull the bodies apart, then run the schedule again and again, each time finer about the force maximum.

        The numbers are those of the last schedule, which holds the positions of F_D, F = 0 and the force maximum; it
        ends when two of them agree.

        Raises:
            UntrustedError: they never do.
        """
        self._separate(self._last.displacement)
        window = self._unloading_step(self._loading[-1].displacement)
        for number in range(MOST_REPLAYS):
            before = self.peak
            self._replay(window, first=number == 0)
            window *= ZOOM_FACTOR
            if self._agrees(before):
                teeth = rivals(*self.unloading.lists, self.peak)
                self._found(abs(self.peak.smooth - before.smooth) + max((0.0, *teeth.values())))
                self._is_replayed = True
                return
        raise UntrustedError(
            f"the pull-off force has not converged: {before.tension:.6g} and {self.peak.tension:.6g} FU after "
            f"{MOST_REPLAYS} refinements differ by more than a tolerance of {self.settings.tolerance:g} allows. "
            "Use a larger [accuracy] tolerance, or stiffer springs or a longer range, which avoid the instability"
        )

    def _replay(self, window: float, first: bool) -> None:
        """Run the schedule again from the start, with the marks of the one before and a window about its peak [LU]."""
        preload, before = self._targets[True], self._loading
        deepest = _displacement_of(before, preload)
        way, peak = self.unloading, self.peak
        d, force = way.displacement, way.force
        same = SAME * (deepest - d[-1])
        climbed = sorted({s.displacement for s in before[:-1] if s.force < preload})
        zero = smooth_crossing(*way.lists, self._targets[False])
        half, step = max(window, early_loss(way, peak, self.settings)), window / WINDOW_ROWS
        high, low = peak.position + half, peak.position - half
        if first:  # which tooth is the highest can't be told from coarse rows
            close = d[-force >= (1.0 - RIVAL_SHARE) * peak.tension]
            high, low = max(high, float(close.max())), min(low, float(close.min()))
        fine = high - step * np.arange(round((high - low) / step) + 1)
        fine = fine[fine < zero - same]
        rows = {deepest, zero, peak.position, *d[(d > fine[0]) | (d < fine[-1])].tolist(), *fine.tolist()}
        falling = sorted((row for row in rows if row <= deepest), reverse=True)
        parts = {
            "unloading": [row for row in falling if row >= zero],
            "pulling": [row for row in falling if peak.position <= row < zero],
            "separating": [row for row in falling if row < peak.position],
        }
        parts = {"loading": [row for row in climbed if row < deepest - same] + [deepest]} | parts
        taken = [phase.name for phase in self._passed]
        phases = [
            Phase(numbered(name, taken), displacements(rows), state=name in ("unloading", "pulling"))
            for name, rows in parts.items()
        ]
        self._open.close()
        purpose = "repeating the path with smaller steps at the force maximum"
        self.contact = self._open.enter_context(self.context.contact(purpose))
        self.states = self.contact.replay([*self._passed, *phases])
        number, rising, held = self._number, len(parts["loading"]), len(parts["unloading"])
        whole = sum(map(len, parts.values()))
        self.legs = self.legs[: len(self.states) - whole] + [number - 1] * rising + [number] * (whole - rising)
        marks = (self.leg[held - 1], self.leg[held + len(parts["pulling"]) - 1])
        self.marked = dict(zip(("zero_load", "critical"), marks, strict=True))

    def _agrees(self, before: Peak) -> bool:
        """Whether two schedules give the same results, and the marks of the latest one are where they belong."""
        peak, critical = self.peak, self.marked["critical"]
        allowed, radius = self.tolerance * peak.smooth, critical.radius_or_spot
        way = self.unloading
        rate = radius_rate(way, int(np.argmin(np.abs(way.displacement - critical.displacement))))
        preload = self._targets[True]
        return (
            abs(peak.smooth - before.smooth) <= allowed
            and peak.uncertainty + cut_short(way, peak, self.settings) <= allowed
            and abs(self._loading[-1].force - preload) <= self.tolerance * preload
            and abs(self.marked["zero_load"].force) <= allowed
            and peak.smooth + critical.force <= allowed
            and abs(rate * (peak.position - critical.displacement))
            <= max(self.tolerance * radius.value, READ_SHARE * radius.uncertainty)
        )

    @property
    def _loading(self) -> list[State]:
        """The states of the leg before."""
        return [state for state, leg in zip(self.states, self.legs, strict=True) if leg == self._number - 1]

    def open(self) -> None:
        """Nothing: a schedule that was run again has separated the bodies."""

    def _growth(self, state: State, largest: float) -> float:
        """They grow only where no maximum can be higher any more."""
        return GROWTH if self._still_held(state) < largest else 1.0


def _displacement_of(states: Sequence[State], force: float) -> float:
    """Displacement [LU] of a force [FU] on a rising branch, through its two nearest load steps."""
    near = sorted(states, key=lambda s: abs(s.force - force))[:2]
    if len(near) < 2 or near[0].force == near[1].force:
        return near[0].displacement
    part = (force - near[0].force) / (near[1].force - near[0].force)
    return near[0].displacement + part * (near[1].displacement - near[0].displacement)
