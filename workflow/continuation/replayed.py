"""A branch of states that depend on the loading history, since pairs snap: the schedule is repeated from the start.

Each time it has the required positions in order, more of them near the force maximum.

A leg is a part of the path between two turns of the loading, numbered from 0 on. Displacements d [LU] and forces F [FU]
are positive in compression.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from contact1d.analysis.curve_marks import Peak, rivals, smooth_crossing
from contact1d.workflow.continuation.branch import Branch
from contact1d.workflow.continuation.marks import early_detachment, missed_tension
from contact1d.workflow.continuation.state import State
from contact1d.workflow.deck.steps import Phase, displacements, numbered
from contact1d.workflow.errors import UntrustedError

SEPARATING = "separating"
"""Phase of the load steps beyond a force maximum."""


@dataclass
class Stretch:
    """A part of a leg, up to a position that the script gave or searched for.

    Attributes:
        leg: number of the leg.
        phase: name of its phase, without a number.
        last: number of its last state.
        force: of the contact at its end [FU]; NaN: it ends at a displacement, or at the force maximum.
        marks: names under which its last state is reported.
    """

    leg: int
    phase: str
    last: int
    force: float = math.nan
    marks: list[str] = field(default_factory=list)


class ReplayedBranch(Branch):
    """The states of a contact whose pairs snap."""

    _passed: tuple[Phase, ...] = ()
    _stretches: tuple[Stretch, ...] = ()
    _top: Stretch | None = None

    def mark(self, name: str) -> None:
        """Report the last state under a name, and have its atoms written to states.lammpstrj.

        After the search for a force maximum, and before the loading turns again, it is the state at the maximum, whose
        atoms are written already.
        """
        if self._top:
            self.marked[name] = self.states[self._top.last]
            return
        super().mark(name)
        self._stretches[-1].marks.append(name)

    def maximum(self, most_replays: int = 8, zoom: float = 0.25) -> None:
        """Pull the bodies apart, then repeat all load steps from the start, each time smaller ones at the maximum.

        States, marks and targets become those of the last repetition, which contains the positions of the forces that
        the script reached and of the force maximum. The search ends when two in succession agree; its error [FU] is
        recorded in `searches`. The last state is that of separated bodies.

        Args:
            most_replays: of the load steps.
            zoom: width of the window about the force maximum over that of the repetition before.

        Raises:
            UntrustedError: no two repetitions agree, or a state is no result.
        """
        self._turn(rises=False)
        self._separate(self._last.displacement)
        self._record_target(math.nan)
        top, window = self._stretches[-1], self._unloading_step(self.leg[0].displacement)
        for number in range(most_replays):
            before = self.peak
            self._replay(self._about_maximum(window, first=number == 0))
            window *= zoom
            if self._agrees(before, self.states[top.last]):
                excess = rivals(*self.unloading.lists, self.peak)
                self._record_maximum(abs(self.peak.smooth - before.smooth) + max((0.0, *excess.values())))
                self._top = top
                return
        raise UntrustedError(
            f"the pull-off force has not converged: {before.tension:.6g} and {self.peak.tension:.6g} FU after "
            f"{most_replays} refinements differ by more than a tolerance of {self.settings.tolerance:g} allows. "
            "Use a larger [accuracy] tolerance, or stiffer springs or a longer range, which avoid the instability"
        )

    def open(self) -> None:
        """Do nothing: the search for the force maximum has separated the bodies, and ends in that state."""

    def _turn(self, rises: bool) -> bool:
        """Record the direction of the next load steps; return whether it differs from the one before, True at first.

        After a force maximum the load steps so far are kept as a fixed beginning, which later repetitions do not
        change.
        """
        if self._top:
            self._passed, self._stretches, self._top = self.contact.phases, (), None
        return super()._turn(rises)

    def _record_target(self, force: float) -> None:
        """Record that the last state ends a part of the path, at a force [FU] that it was to carry.

        NaN: it ends at a displacement or at the force maximum. The force, compression positive, also goes to `wanted`,
        NaN does not.
        """
        super()._record_target(force)
        phase = self._last.phase.partition("_")[0]
        self._stretches += (Stretch(self._number, phase, len(self.states) - 1, force),)

    def _about_maximum(self, window: float, first: bool, count: int = 8) -> list[float]:
        """Return displacements [LU] of the unloading: of the present states, and in a window about its force maximum.

        First those of the states on both sides of the window, falling, then those in it, falling in steps of
        `window`/`count` [LU]. It extends by `window` [LU], or as far as a pair may separate early, to either side; none
        in it is above the end of an earlier part of the unloading. `first`: whether the states are those of the first
        search; then all positions with at least 95 % of the maximum are in the window.
        """
        trace, peak = self.unloading, self.peak
        d, force = trace.displacement, trace.force
        half, step = max(window, early_detachment(trace, peak, self.settings)), window / count
        high, low = peak.position + half, peak.position - half
        if first:  # coarse load steps do not show which of the maxima within 5 % is the highest
            close = d[-force >= 0.95 * peak.tension]
            high, low = max(high, float(close.max())), min(low, float(close.min()))
        fine = high - step * np.arange(round((high - low) / step) + 1)
        ends = [self._end(stretch) for stretch in self._stretches[:-1] if stretch.leg == self._number]
        fine = fine[fine < min(ends, default=math.inf)]
        return [*d[(d > fine[0]) | (d < fine[-1])].tolist(), *fine.tolist()]

    def _end(self, stretch: Stretch) -> float:
        """Return the displacement [LU], compression positive, at which a part of the path ends.

        −inf for the separation of the bodies. Of a part with a force it is where F(d) has that force, interpolated:
        since the last turn of the loading at the first crossing, before it on the line through the two states nearest
        in force. Without a force (NaN) it is the position of the force maximum for the last part, and that of its last
        state for another.

        Raises:
            ValueError: since the last turn, F(d) never has the force.
        """
        if stretch.phase == SEPARATING:
            return -math.inf
        if math.isnan(stretch.force):
            is_top = stretch is self._stretches[-1]
            return self.peak.position if is_top else self.states[stretch.last].displacement
        if stretch.leg == self._number:
            return smooth_crossing(*self.unloading.lists, stretch.force)
        return _displacement_of(self.of_leg(stretch.leg), stretch.force)

    def _replay(self, falling: list[float]) -> None:
        """Close the contact and repeat its load steps in a new one, the last unloading at displacements `falling` [LU].

        These may be in any order, and are run from the largest to the smallest.

        Each part of the path goes straight to its end, the last until the bodies part. Replaces the states, and updates
        marks and targets and the numbers of parts in place.

        Raises:
            UntrustedError: a state is no result.
        """
        passed, names = sum(len(phase.rows) for phase in self._passed), [phase.name for phase in self._passed]
        start, leg, phases = self.states[passed].displacement, -1, list[Phase]()
        near = 1e-9 * (max(s.displacement for s in self.states) - min(falling))  # nearer load steps are one
        stretches = [*self._stretches, Stretch(self._number, SEPARATING, 0)]
        for stretch in stretches:
            is_last = stretch.leg == self._number
            positions = falling if is_last else [state.displacement for state in self.of_leg(stretch.leg)]
            end = self._end(stretch)
            sign = 1.0 if end > start else -1.0
            rows = [d for d in positions if sign * (d - start) > near and sign * (end - d) > near]
            rows += [start] * (stretch.leg != leg) + [end] * math.isfinite(end)
            name = numbered(stretch.phase, names)
            names.append(name)
            is_marked = bool(stretch.marks) or stretch is self._stretches[-1]
            phases.append(Phase(name, displacements(sorted(set(rows), key=lambda d: sign * d)), state=is_marked))
            start, leg = end, stretch.leg
        self._open.close()
        purpose = "repeating the path with smaller steps at the force maximum"
        self.contact = self._open.enter_context(self.context.contact(purpose))
        self.states, self.legs = self.contact.replay([*self._passed, *phases]), self.legs[:passed]
        self.wanted = {number: force for number, force in self.wanted.items() if number < passed}
        for phase, stretch in zip(phases, stretches, strict=True):
            self.legs += [stretch.leg] * len(phase.rows)
            stretch.last = len(self.legs) - 1
            self.marked |= dict.fromkeys(stretch.marks, self.states[stretch.last])
            if not math.isnan(stretch.force):
                self.wanted[stretch.last] = stretch.force

    def _agrees(self, before: Peak, critical: State) -> bool:
        """Return whether two repetitions have the same force maximum, and the latest has the required states.

        At most the tolerance of the search, relative to the maximum, may be: its change, its own error, and what the
        tension of `critical` lacks of it; relative to each required force (of 0, to the maximum): the difference from
        it; relative to the contact radius, or half its uncertainty: its change from `critical` to the maximum.
        `before`: the maximum of the former repetition; `critical`: the state at that of the latest.
        """
        peak = self.peak
        allowed = self.tolerance * peak.smooth
        missed = abs(self._radius_rate(critical) * (peak.position - critical.displacement))  # of the contact radius
        return (
            abs(peak.smooth - before.smooth) <= allowed
            and peak.uncertainty + missed_tension(self.unloading, peak, self.settings) <= allowed
            and all(
                abs(self.states[i].force - force) <= (self.tolerance * abs(force) or allowed)
                for i, force in self.wanted.items()
            )
            and peak.smooth + critical.force <= allowed
            and missed <= self._radius_limit(critical)
        )

    def _growth(self, state: State, largest: float) -> float:
        """Return the factor of successive increments: 1.2 where no maximum can exceed `largest` [FU] any more, else 1.

        `largest`: the largest tension so far, positive. Pairs of longer moves detach prematurely.
        """
        return 1.2 if self._remaining_tension(state) < largest else 1.0


def _displacement_of(states: Sequence[State], force: float) -> float:
    """Return the displacement [LU] of a force [FU] on a rising F(d), by a straight line through two states.

    They are those of nearest force, so that it may be extrapolated. With one state, or where both have the same force,
    that of the nearest.

    Raises:
        IndexError: there are no states.
    """
    near = sorted(states, key=lambda s: abs(s.force - force))[:2]
    if len(near) < 2 or near[0].force == near[1].force:
        return near[0].displacement
    part = (force - near[0].force) / (near[1].force - near[0].force)
    return near[0].displacement + part * (near[1].displacement - near[0].displacement)
