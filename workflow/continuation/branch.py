"""A connected branch of states under displacement control: visit, reach a force, find the force maximum.

A state does not depend on the loading history here, so that any position can be visited at any time; `replayed` has
states that depend on it.

A leg is a part of the path between two turns of the loading, numbered from 0 on. Displacements d [LU] and forces F [FU]
are positive in compression. A snap is the instability in which a pair of opposite particles joins or separates.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache, cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import Peak, promised, rivals
from contact1d.digits import apart
from contact1d.workflow.continuation.context import ContactBranch
from contact1d.workflow.continuation.marks import POSITION_FACTOR, peak_of, radius_rate
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Search, Trace, of_states
from contact1d.workflow.deck.steps import Displace, DisplaceInTime, displacements
from contact1d.workflow.errors import TensionError, UntrustedError

Array = NDArray[np.float64]
MOST_INCREMENTS = 10_000
"""Load steps between two turns of a search; a search that needs more has no end in sight."""
SAME = 1e-12
"""Displacements nearer than this over the spacing are the same: a force that still differs has jumped."""
ROWS_BEYOND_PEAK = 3
"""Load steps beyond a force maximum, for its polynomials."""

JUMPS = (
    'the force jumps there by an instability (snap-in, snap-out or slip). Use kind = "path" to see it, or stiffer '
    "springs or a longer range, which avoid the instability"
)


class Branch(ContactBranch):
    """The states of a contact under displacement control."""

    @property
    def driver(self) -> Self:
        """This branch, which a script drives itself."""
        return self

    @property
    def tolerance(self) -> float:
        """Relative error of a force maximum that a search may leave, a share of the tolerance."""
        return 0.3 * self.settings.tolerance

    @cached_property
    def _expected(self) -> Callable[[float], float]:
        """The displacement [LU] of the reduced model under a force [FU], compression positive; cached."""
        return cache(self.model.displacement_at)

    @property
    def unloading(self) -> Trace:
        """The states since the loading last turned, as a trace by falling displacement.

        Of several at the same displacement it has the latest. Left out are those below the limit point of the reduced
        model (the largest one below the largest displacement), where the contact is lost.

        Raises:
            IndexError: there are no states yet.
        """
        return of_states(self.leg, self.model).falling()

    @property
    def peak(self) -> Peak:
        """The force maximum (largest tension) since the loading last turned: its tension, position and errors.

        Tension [FU] is positive, below 0 where all states are under compression; the position is a displacement [LU].

        Raises:
            IndexError: there are no states yet.
        """
        return peak_of(self.unloading)

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | None = None) -> None:
        """Run a load step at each displacement [LU] of `positions`, in order, and keep its state; `along` is ignored.

        They go in one direction: the last of them decides whether the loading turns. Compression is positive.

        Raises:
            UntrustedError: a state is not at rest, bodies went through each other, or the contact reaches the
                chain's end.
            EngineError: LAMMPS failed.
        """
        self._turn(not self.states or positions[-1] >= self._last.displacement)
        self._begin_phase()
        self._append(self.contact.rows(displacements(positions)))
        self._record_target(math.nan)

    def hold(self, duration: float, displacement: float | None, force: float | None, approach_steps: int = 20) -> None:
        """Move to a displacement [LU] in approach steps, then hold it for `duration` [TU]; `force` is ignored.

        Each approach step is at most the longest move and takes `approach_steps` timesteps; its states are kept, too,
        in a phase "approaching". States need not be at rest; the hold has up to 101. The displacement must not be None
        (AssertionError). It begins at displacement 0.

        Raises:
            UntrustedError: bodies went through each other, or the contact reaches the end of the chain.
        """
        assert displacement is not None
        self.moves, name = True, self._phase
        moves = max(1, math.ceil(abs(displacement) / self.settings.increments.longest_move - SAME))
        self._turn(displacement > 0.0)
        if approach := [DisplaceInTime(displacement * i / moves, approach_steps) for i in range(1, moves)]:
            self.begin("approaching")
            self._move(approach)
        self.begin(name)
        self._move([DisplaceInTime(displacement, steps) for steps in self.settings.steps_of(duration)])

    # --- a force

    def reach(self, force: float, scale: float, accuracy: float = 1e-3) -> None:
        """Search for the state in which the contact carries an external `force` [FU], compression positive.

        Load steps go on from the last state, the first one at the same displacement (0 without states), and keep
        theirs, until the force differs by at most `accuracy` times the relative tolerance times `scale` [FU], by half
        of that where F(d) is smooth.

        Raises:
            UntrustedError: a state is not at rest, bodies went through each other, the force lies before the first
                state, in a jump of F(d), or beyond 10 000 load steps.
            TensionError: the bodies separate before they have this tension.
        """
        # Where pairs snap the force at a displacement is less accurate.
        near = (0.5 if self.settings.is_smooth else 1.0) * accuracy * self.settings.tolerance * scale
        rises = not self.states or force - self._last.carried > near
        direction = 1 if rises else -1
        self._turn(rises)
        self._load_step(self._last.displacement if self.states else 0.0)

        def goes_beyond(state: State) -> bool:
            """Return whether a state carries more than the required force in loading, or less in unloading.

            Compression is positive; False where it carries just the force.
            """
            return state.carried > force if rises else state.carried < force

        before: State | None = None
        beyond: State | None = None
        while abs(self._last.carried - force) > near:
            last, states = self._last, self.leg
            if goes_beyond(last):
                beyond = last
            else:
                before = last
            before = before or next((s for s in states[::-1] if not goes_beyond(s)), None)
            if before is None:
                wanted, start = apart(force, last.carried, 4)
                raise UntrustedError(
                    f"{wanted} FU cannot be reached: the force starts at {start} FU, already "
                    f"{'above' if rises else 'below'} it. Give a force beyond that, or use "
                    'kind = "path" for the full curve'
                )
            self._require_within_reach(force, rises, before, beyond)
            step = self.settings.increment(last.smallest_distance if rises else math.inf)
            self._load_step(self._next_displacement(before, beyond, force, direction * step))
        self._record_target(force + self._last.pushed)

    def _next_displacement(
        self, before: State, beyond: State | None, force: float, step: float, margin: float = 0.05
    ) -> float:
        """Return the next displacement [LU] of a search for a force, by a secant of d over that of the reduced model.

        Without a state beyond the force, it is within one `step` from `before`, at the whole step where the secant
        points back. Else it is between both, off the ends by a share `margin` of their distance, unless the last step
        came nearer to the force by a factor of ten.

        Args:
            before: state before the force is reached.
            beyond: state beyond it; None where it is not known.
            force: that is searched for [FU], compression positive.
            step: longest increment, with the sign of the loading [LU].
            margin: relative distance from the ends of the bracket.
        """
        *_, former, last = [None, *self.leg]
        expected, rate = self._expected, 1.0
        if former and (change := expected(last.carried) - expected(former.carried)):
            rate = (last.displacement - former.displacement) / change
            margin *= abs(last.carried - force) > 0.1 * abs(former.carried - force)
        goal = last.displacement + rate * (expected(force) - expected(last.carried))
        if beyond is None:
            ahead = (goal - before.displacement) / step
            return before.displacement + (min(1.0, ahead) if ahead > 0.0 else 1.0) * step
        part = (goal - before.displacement) / (beyond.displacement - before.displacement)
        if not 0.0 < part < 1.0:  # the model does not predict these states
            part = (force - before.carried) / (beyond.carried - before.carried)
        return before.displacement + min(max(part, margin), 1.0 - margin) * (beyond.displacement - before.displacement)

    def _require_within_reach(self, force: float, rises: bool, before: State, beyond: State | None) -> None:
        """Refuse a force [FU] that F(d) jumps past, that is never reached, or that takes more than 10 000 load steps.

        Args:
            force: that is searched for, compression positive.
            rises: whether the contact is loaded, and not unloaded.
            before: state before the force is reached.
            beyond: state beyond it; None where it is not known.

        Raises:
            TensionError: in unloading, the bodies are beyond the cutoff in the last state.
            UntrustedError: both states are at the same displacement (an instability), or there are too many load
                steps.
        """
        states = self.leg
        near = SAME * self.scene.bodies.spacing
        if beyond is not None and abs(before.displacement - beyond.displacement) < near:
            raise UntrustedError(
                f"the force jumps past {force:.4g} FU at displacement {before.displacement:.6g} LU, from "
                f"{before.carried:.4g} to {beyond.carried:.4g} FU: an instability, and no state on this path has this "
                'force. Give a force outside the jump, use kind = "path" for the full curve, or stiffer '
                "springs or a longer range, which avoid the instability"
            )
        if not rises and states[-1].smallest_distance > self.settings.forces.cutoff:
            raise TensionError(force, max(-state.force for state in states))
        if len(states) > MOST_INCREMENTS:
            raise UntrustedError(
                f"{force:.4g} FU is not reached within {MOST_INCREMENTS} increments, at displacement "
                f"{states[-1].displacement:.4g} LU and {states[-1].carried:.4g} FU: the ranges of the interaction are "
                "short compared with the path. Use a force nearer to 0, longer ranges or stiffer springs"
            )

    # --- the force maximum

    def maximum(self, most_refinements: int = 60, most_halvings: int = 2) -> None:
        """Unload to the force maximum (largest tension); the last state is then at it.

        Load steps pass it, go back to it, and halve the distance on both sides until the maximum converges; all their
        states are kept. Just below snapping F(d) has a maximum for each pair that separates: each that may be the
        highest is examined. The error of the search [FU] is recorded in `searches`.

        Args:
            most_refinements: of the maximum; each may halve the increment, as a sharp maximum requires.
            most_halvings: of the increment for the contact radius at the maximum.

        Raises:
            UntrustedError: a state is not at rest or bodies went through each other; no maximum is passed, or the
                search does not converge.
        """
        increment = self._pass_maximum()
        expected, halvings, changed = self.peak, 0, math.inf
        for _ in range(most_refinements):
            self._revisit(expected.position)
            peak = self.peak
            missed, allowed = abs(peak.smooth - expected.smooth), self.tolerance * peak.smooth
            if missed > allowed or not self._has_radius_of(peak):
                expected = peak
                continue
            known = changed <= allowed and peak.uncertainty <= allowed
            if known and (halvings > most_halvings or self._is_located(peak)):
                before, excess = len(self.states), self._examine_rivals(allowed)
                if len(self.states) == before:
                    self._record_maximum(max(missed, changed, excess, abs(peak.smooth + self._last.force)))
                    return
                expected = self.peak
                changed = max(changed, abs(expected.smooth - peak.smooth))
                continue
            increment, halvings = 0.5 * increment, halvings + 1
            surprise = self._halve((peak.position + increment, peak.position - increment))
            expected = self.peak
            if (moved := abs(expected.position - peak.position)) > 2.0 * increment:
                increment = moved  # another maximum is higher: there are no load steps near it
            changed = max(surprise, abs(expected.smooth - peak.smooth))
        raise UntrustedError(f"no force maximum is found near {expected.position:.6g} LU: {JUMPS}")

    def open(self) -> None:
        """Pull the bodies apart until the tension is, and remains, below 2 % of its maximum.

        It also ends where the bodies are beyond the cutoff of the interaction.

        Raises:
            SecondMaximumError: the tension rises above the maximum that was found, by more than the tolerance.
            UntrustedError: the bodies do not separate within 10 000 load steps, or a state is not at rest.
        """
        before = self.peak
        # On from the last position, yet in a move no longer than that of the search beyond the maximum.
        nearest = self._last.displacement - (ROWS_BEYOND_PEAK + 1) * self.settings.increment()
        self._separate(max(nearest, min(s.displacement for s in self.leg)))
        after = self.peak
        if abs(after.smooth - before.smooth) > self.tolerance * after.smooth:
            raise SecondMaximumError(
                f"the tensile force rises again to {after.tension:.6g} FU after its maximum of {before.smooth:.6g} "
                'FU: use kind = "path" over the full range'
            )

    def _pass_maximum(self) -> float:
        """Unload in equal increments until the force maximum is passed; return the increment [LU] > 0.

        Passed means that three load steps lie beyond the largest tension. Where there may be several maxima, or a
        search has found a second one, it goes on until no higher tension is possible, with four load steps for each of
        up to 400 maxima; else it skips the positions long before the maximum of the reduced model.

        Raises:
            UntrustedError: the maximum is not passed within 10 000 load steps.
        """
        law, zero = self.settings.law, self._last
        period = law.maxima_distance(self.settings.chains.upper)
        densest = (zero.displacement - law.rest + float(law.gap[-1])) / 400.0
        step = min(self.settings.increment(), max(period, densest) / 4.0)
        through = period < math.inf or self.context.through
        distance = 0.0 if through else self._expected(zero.carried) - self._expected(-math.inf)
        before = 2  # load steps before the expected maximum, for its polynomials
        rows, skipped = [zero], max(0, math.floor(distance / step) - before)
        while not _is_passed(rows) or (through and -min(s.force for s in rows) <= self._remaining_tension(rows[-1])):
            rows.append(self._load_step(zero.displacement - (skipped + len(rows)) * step))
            if len(rows) > MOST_INCREMENTS:
                raise UntrustedError(
                    f"the search has not passed the force maximum after {MOST_INCREMENTS} load steps, at a displacement"
                    f" of {rows[-1].displacement:.6g} LU; a larger accuracy.tolerance has fewer and longer steps"
                )
        return step

    def _halve(self, positions: tuple[float, float]) -> float:
        """Visit two positions [LU] about the force maximum; return the error of their interpolation [FU] ≥ 0.

        It is the larger difference of the measured tension from the one that the states before let expect; infinite
        where there were too few states, or these too near to each other, for an interpolation.
        """
        expected = promised(*self.unloading.lists, positions)
        surprise = 0.0
        for position, tension in zip(positions, expected, strict=True):
            self._revisit(position)
            surprise = max(surprise, math.inf if math.isnan(tension) else abs(float(tension) + self._last.force))
        return surprise

    def _examine_rivals(self, allowed: float, most: int = 200) -> float:
        """Visit positions on both sides of other maxima that may exceed the highest one by more than `allowed` [FU].

        In each round it is the maximum that may be the highest. Return by how much a maximum may still be higher [FU],
        0 where none may; more than `allowed` only after `most` rounds.
        """
        excess = 0.0
        for _ in range(most):
            d, force = self.unloading.lists
            maxima = rivals(d, force, self.peak)
            highest = max(maxima, key=lambda i: maxima[i], default=0)
            excess = max(0.0, maxima.get(highest, 0.0))
            if excess <= allowed:
                break
            for neighbour in (d[highest - 1], d[highest + 1]):
                self._revisit(0.5 * float(d[highest] + neighbour))
        return excess

    def _has_radius_of(self, peak: Peak) -> bool:
        """Return whether the last state is so near to the force maximum that its contact radius is the one there.

        The difference of displacement times |da/dd| must be within the tolerance of the radius, or within half the
        radius's own uncertainty where that is larger.
        """
        return abs(self._radius_rate(self._last) * (peak.position - self._last.displacement)) <= self._radius_limit(
            self._last
        )

    def _is_located(self, peak: Peak) -> bool:
        """Return whether the position of the force maximum is accurate enough for the contact radius there.

        Twice its error times |da/dd| must be within the tolerance of the last state's radius, or within half the
        radius's own uncertainty where that is larger.
        """
        return POSITION_FACTOR * abs(self._radius_rate(self._last)) * peak.misplaced <= self._radius_limit(self._last)

    def _radius_rate(self, state: State) -> float:
        """Return da/dd [LU/LU] at a state since the last turn of the loading, from the nearest other one.

        0 where there is no other one. A state that is no longer in contact counts as the nearest one that is.
        """
        trace = self.unloading
        return radius_rate(trace, int(np.argmin(np.abs(trace.displacement - state.displacement))))

    def _radius_limit(self, state: State) -> float:
        """Return the allowed error of the contact radius of a state [LU] ≥ 0.

        It is the tolerance of the search times the radius or, if larger, half the uncertainty of the radius. Without
        contact the radius counts as 0 ± 1.5 spacings.
        """
        radius = state.radius_or_spot
        return max(self.tolerance * radius.value, 0.5 * radius.uncertainty)

    # --- moves

    def _load_step(self, displacement: float) -> State:
        """Run one load step at a displacement [LU], keep its state, and return it.

        Raises:
            UntrustedError: it is not at rest, bodies went through each other, or the contact reaches the end of the
                chain.
        """
        self._begin_phase()
        state = self.contact.row(Displace(displacement))
        self._append([state])
        return state

    def _record_maximum(self, error: float) -> None:
        """Record the error [FU] ≥ 0 of the search for the latest force maximum, as "sampling".

        An earlier record of the same search is replaced.
        """
        self.searches[self._number] = Search({"sampling": error})

    def _revisit(self, displacement: float) -> None:
        """Go to a displacement [LU] and keep the states on the path, the last of them at it.

        Bodies approach in moves of half the smallest distance of their particles, or of the longest move of the
        settings where that is larger; they separate in one.
        """
        while displacement - self._last.displacement > (longest := 0.5 * self._last.smallest_distance):
            longest = max(longest, self.settings.increments.longest_move)
            self._load_step(min(self._last.displacement + longest, displacement))
        self._load_step(displacement)

    def _separate(self, start: float, share: float = 0.02) -> None:
        """Unload from `start` [LU], keeping the states, until the tension is, and stays, below `share` of its maximum.

        It also ends where the bodies are beyond the cutoff of the interaction. Increments grow where the tension is
        below half its maximum.

        Raises:
            UntrustedError: the bodies do not separate within 10 000 load steps, or a state is not at rest.
        """
        largest = max((-s.force for s in self.leg), default=0.0)
        self._load_step(start)
        displacement, step = start, self._unloading_step(start)
        for _ in range(MOST_INCREMENTS):
            displacement -= step
            state = self._load_step(displacement)
            largest = max(largest, -state.force)
            if 0.0 <= -state.force < 0.5 * largest:
                step *= self._growth(state, largest)
            gone = abs(state.force) < share * largest
            if (gone and self._remaining_tension(state) < share * largest) or (
                state.smallest_distance > self.settings.forces.cutoff
            ):
                return
        raise UntrustedError(f"the bodies did not separate within {MOST_INCREMENTS} increments of the displacement")

    def _growth(self, state: State, largest: float) -> float:
        """Return 1.6, the factor of successive increments beyond the force maximum; both arguments are ignored.

        `largest`: the largest tension so far [FU].
        """
        return 1.6

    def _unloading_step(self, start: float, most: float = 1_000.0) -> float:
        """Return the first increment [LU] > 0 of an unloading from `start` [LU] until bodies are apart.

        It is that of a search, or longer, so that there are `most` equal load steps at most. Soft springs follow the
        attraction farther than they were pressed.
        """
        distance = start - self.settings.forces.rest + float(self.settings.law.gap[-1])
        return max(self.settings.increment(), distance / most)

    def _remaining_tension(self, state: State) -> float:
        """Return the largest tension [FU] ≥ 0 that bodies which move apart can have from this state on.

        It is the sum over upper particles: one beyond the force maximum of a pair keeps its tension at most, any nearer
        one may still reach that maximum. Compression counts as 0.
        """
        profile, (distance, largest) = state.profile, self.settings.strongest
        held = self.scene.bodies.spacing * np.maximum(0.0, -profile.pressure)
        near = profile.z_upper - profile.z_lower < distance
        return float(np.sum(np.where(near, np.maximum(held, largest), held)))


class SecondMaximumError(UntrustedError):
    """The tension rises again after its first maximum: further load steps are needed."""


def _is_passed(states: Sequence[State]) -> bool:
    """Return whether three states or more follow the first one of the largest tension, and that is above 0.

    `states`: one at least.
    """
    tension = [-s.force for s in states]
    largest = max(tension)
    return largest > 0.0 and tension.index(largest) < len(tension) - ROWS_BEYOND_PEAK
