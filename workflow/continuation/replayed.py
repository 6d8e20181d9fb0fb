"""A branch of states that depend on the loading history, since pairs snap: the schedule is run again from the start.

Each time it has the required positions in their order, more of them near the force maximum.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from contact1d.analysis.curve_marks import Peak, rivals, smooth_crossing
from contact1d.workflow.continuation.branch import READ_SHARE, Branch
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.marks import cut_short, early_loss, radius_rate
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import UntrustedError
from contact1d.workflow.deck.steps import Phase, displacements, numbered

SEPARATING = "separating"
"""Phase of the load steps beyond a force maximum."""
MOST_REPLAYS = 8
GROWTH = 1.2
"""Of moves apart: longer ones lose particles early."""
SAME = 1e-9
"""Distance of two load steps over the way that are one."""
WINDOW_ROWS, ZOOM_FACTOR, RIVAL_SHARE = 8, 0.25, 0.05
"""Of a schedule that is run again: load steps on either side of the force maximum, width of that window over the one
before, and maxima within this share of the largest that are all examined in the first one."""


@dataclass
class Stretch:
    """What a script has done on a leg, up to a position that it looked for or gave.

    Attributes:
        leg: number of the leg.
        phase: its name, without a number.
        last: number of its last state.
        force: that it reached, of the contact [FU]; NaN: it went to a displacement, or to the force maximum.
        marks: names under which its last state is reported.
    """

    leg: int
    phase: str
    last: int
    force: float = math.nan
    marks: list[str] = field(default_factory=list)


class ReplayedBranch(Branch):
    """States where pairs snap."""

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact."""
        super().__init__(context, meanwhile)
        self._passed: tuple[Phase, ...] = ()
        self._stretches: list[Stretch] = []
        self._top: Stretch | None = None

    def mark(self, name: str) -> None:
        """Report the last state; that of the force maximum is written already."""
        if self._top:
            self.marked[name] = self.states[self._top.last]
            return
        super().mark(name)
        self._stretches[-1].marks.append(name)

    def maximum(self) -> None:
        """Pull the bodies apart, then run the schedule again and again, each time finer about the force maximum.

        The numbers are those of the last schedule, which holds the positions of the forces that the script reached and
        of the force maximum; it ends when two of them agree.

        Raises:
            UntrustedError: they never do.
        """
        self._turn(rises=False)
        self._separate(self._last.displacement)
        self._came(math.nan)
        top, window = self._stretches[-1], self._unloading_step(self.leg[0].displacement)
        for number in range(MOST_REPLAYS):
            before = self.peak
            self._replay(self._about_maximum(window, first=number == 0))
            window *= ZOOM_FACTOR
            if self._agrees(before, self.states[top.last]):
                teeth = rivals(*self.unloading.lists, self.peak)
                self._found(abs(self.peak.smooth - before.smooth) + max((0.0, *teeth.values())))
                self._top = top
                return
        raise UntrustedError(
            f"the pull-off force has not converged: {before.tension:.6g} and {self.peak.tension:.6g} FU after "
            f"{MOST_REPLAYS} refinements differ by more than a tolerance of {self.settings.tolerance:g} allows. "
            "Use a larger [accuracy] tolerance, or stiffer springs or a longer range, which avoid the instability"
        )

    def open(self) -> None:
        """Nothing: a schedule that was run again has separated the bodies."""

    def _turn(self, rises: bool) -> bool:
        """See `ContactBranch`; after a force maximum a new schedule begins behind the one that is known."""
        if self._top:
            self._passed, self._stretches, self._top = self.contact.phases, [], None
        return super()._turn(rises)

    def _came(self, force: float) -> None:
        super()._came(force)
        phase = self._last.phase.partition("_")[0]
        self._stretches.append(Stretch(self._number, phase, len(self.states) - 1, force))

    def _about_maximum(self, window: float, first: bool) -> list[float]:
        """Displacements [LU] of the last leg, with a window about its force maximum [LU]."""
        way, peak = self.unloading, self.peak
        d, force = way.displacement, way.force
        half, step = max(window, early_loss(way, peak, self.settings)), window / WINDOW_ROWS
        high, low = peak.position + half, peak.position - half
        if first:  # which tooth is the highest can't be told from coarse rows
            close = d[-force >= (1.0 - RIVAL_SHARE) * peak.tension]
            high, low = max(high, float(close.max())), min(low, float(close.min()))
        fine = high - step * np.arange(round((high - low) / step) + 1)
        ends = [self._end(one) for one in self._stretches[:-1] if one.leg == self._number]
        fine = fine[fine < min(ends, default=math.inf)]
        return [*d[(d > fine[0]) | (d < fine[-1])].tolist(), *fine.tolist()]

    def _end(self, stretch: Stretch) -> float:
        """Displacement [LU] at which a stretch ends, as far as the states of its leg show it."""
        if stretch.phase == SEPARATING:
            return -math.inf
        if math.isnan(stretch.force):
            is_top = stretch is self._stretches[-1]
            return self.peak.position if is_top else self.states[stretch.last].displacement
        if stretch.leg == self._number:
            return smooth_crossing(*self.unloading.lists, stretch.force)
        return _displacement_of(self._of_leg(stretch.leg), stretch.force)

    def _of_leg(self, number: int) -> list[State]:
        """The states of a leg."""
        return [state for state, leg in zip(self.states, self.legs, strict=True) if leg == number]

    def _replay(self, falling: list[float]) -> None:
        """Run the schedule again: each leg straight to where the script was, the last one until apart."""
        passed, names = sum(len(phase.rows) for phase in self._passed), [phase.name for phase in self._passed]
        place, leg, phases = self.states[passed].displacement, -1, list[Phase]()
        same = SAME * (max(s.displacement for s in self.states) - min(falling))
        stretches = [*self._stretches, Stretch(self._number, SEPARATING, 0)]
        for one in stretches:
            every = falling if one.leg == self._number else [state.displacement for state in self._of_leg(one.leg)]
            end = self._end(one)
            way = 1.0 if end > place else -1.0
            rows = [row for row in every if way * (row - place) > same and way * (end - row) > same]
            rows += [place] * (one.leg != leg) + [end] * math.isfinite(end)
            name = numbered(one.phase, names)
            names.append(name)
            is_marked = bool(one.marks) or one is self._stretches[-1]
            phases.append(Phase(name, displacements(sorted(set(rows), key=lambda row: way * row)), state=is_marked))
            place, leg = end, one.leg
        self._open.close()
        purpose = "repeating the path with smaller steps at the force maximum"
        self.contact = self._open.enter_context(self.context.contact(purpose))
        self.states, self.legs = self.contact.replay([*self._passed, *phases]), self.legs[:passed]
        self.wanted = {number: force for number, force in self.wanted.items() if number < passed}
        for phase, one in zip(phases, stretches, strict=True):
            self.legs += [one.leg] * len(phase.rows)
            one.last = len(self.legs) - 1
            self.marked |= dict.fromkeys(one.marks, self.states[one.last])
            if not math.isnan(one.force):
                self.wanted[one.last] = one.force

    def _agrees(self, before: Peak, critical: State) -> bool:
        """Whether two schedules give the same results, and the states of the latest one are where they belong."""
        peak, way = self.peak, self.unloading
        allowed, radius = self.tolerance * peak.smooth, critical.radius_or_spot
        rate = radius_rate(way, int(np.argmin(np.abs(way.displacement - critical.displacement))))
        return (
            abs(peak.smooth - before.smooth) <= allowed
            and peak.uncertainty + cut_short(way, peak, self.settings) <= allowed
            and all(
                abs(self.states[i].force - force) <= (self.tolerance * abs(force) or allowed)
                for i, force in self.wanted.items()
            )
            and peak.smooth + critical.force <= allowed
            and abs(rate * (peak.position - critical.displacement))
            <= max(self.tolerance * radius.value, READ_SHARE * radius.uncertainty)
        )

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
