"""A connected branch of states under displacement control: visit, reach a force, find the force maximum.

Here a state does not depend on the path, so that any position can be visited at any time; `replayed` has states that
depend on it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import Peak, promised, rivals
from contact1d.digits import apart
from contact1d.workflow.continuation.context import ContactBranch, RunContext
from contact1d.workflow.continuation.marks import PLACE_FACTOR, peak_of, radius_rate
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Search, Trace, of_states
from contact1d.workflow.continuation.trust import TensionError, UntrustedError
from contact1d.workflow.deck.steps import Displace, DisplaceInTime, displacements

Array = NDArray[np.float64]
MOST_INCREMENTS = 10_000
"""Load steps of one stretch of a search; a search that needs more has no end in sight."""
MOST_ROUNDS = 60
"""Refinements of a force maximum, each of which may halve the increment beside it: a sharp one needs some."""
SEPARATION_ROWS = 1_000.0
"""Load steps in which an unloading comes from any displacement to where nothing is felt any more."""
FORCE_ACCURACY = 1e-3
"""How near to a wanted force a search must come, over the tolerance."""
EDGE, CONVERGING = 0.05, 0.1
"""How near to the ends of a bracket a search looks, over it; where it misses its force by less than this share of what
it missed before, it looks anywhere."""
SEARCH_SHARE = 0.3
"""Part of the tolerance that a search may use up."""
SEPARATION_SHARE = 0.02
"""Tension over the largest one at which bodies that move apart count as separated."""
GROWTH_SHARE = 0.5
"""Tension over the largest one below which increments may grow."""
GROWTH = 1.6
RETURN_SHARE = 0.5
"""Move of a search back to a previous position, over the smallest distance of particles there."""
SAME = 1e-12
"""Displacements nearer than this over the spacing are the same: a force that still differs has jumped."""
APPROACH_STEPS = 20
"""Timesteps of a move towards a displacement that is held for a time."""
ROWS_BEFORE_PEAK, ROWS_BEYOND_PEAK = 2, 3
"""Load steps before the force maximum that the model expects, and beyond the one found, for its polynomials."""
HALVINGS_AT_PEAK = 2
"""Halvings of the increment beside the force maximum for the sake of the contact radius there."""
PER_TOOTH, MOST_TEETH = 4.0, 400.0
"""Load steps to a maximum of the force, and maxima that they resolve; of more, each is a small part of the force."""
MOST_RIVALS = 200
"""Examinations of maxima that may be higher than the highest load step."""
READ_SHARE = 0.5
"""Part of a radius's uncertainty below which it is examined no closer: reading between particles limits it."""

JUMPS = (
    'the force jumps there by an instability (snap-in, snap-out or slip). Use kind = "path" to see it, or stiffer '
    "springs or a longer range, which avoid the instability"
)


class Branch(ContactBranch):
    """States under displacement control; `tolerance` is what a search may use up, relative."""

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact."""
        super().__init__(context, meanwhile)
        self.tolerance = SEARCH_SHARE * self.settings.tolerance
        self._expected = cache(self.model.displacement_at)

    @property
    def unloading(self) -> Trace:
        """The states of the leg under way that are held, by falling displacement."""
        return of_states(self.leg, self.model).falling()

    @property
    def peak(self) -> Peak:
        """The force maximum of the states that were held while unloading."""
        return peak_of(self.unloading)

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | None = None) -> None:
        """Load steps at displacements [LU] that are known beforehand, of one direction."""
        self._turn(not self.states or positions[-1] >= self._last.displacement)
        self._visit(positions)
        self._came(math.nan)

    def _visit(self, positions: Sequence[float] | Array) -> None:
        """The same on the leg under way, to and fro."""
        self._enter()
        self._keep(self.contact.rows(displacements([float(position) for position in positions])))

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a displacement [LU] for a time [TU], in which particles move."""
        assert displacement is not None
        self.moves, name = True, self._phase
        moves = max(1, math.ceil(abs(displacement) / self.settings.increments.longest_move - SAME))
        self._turn(displacement > 0.0)
        if approach := [DisplaceInTime(displacement * i / moves, APPROACH_STEPS) for i in range(1, moves)]:
            self.begin("approaching")
            self._move(approach)
        self.begin(name)
        self._move([DisplaceInTime(displacement, steps) for steps in self.settings.steps_of(duration)])

    def _move(self, rows: Sequence[DisplaceInTime]) -> None:
        self._enter()
        self._keep(self.contact.rows(rows, moving=True))

    # --- a force

    def reach(self, force: float, scale: float) -> None:
        """Go on until the contact carries a force [FU], within FORCE_ACCURACY of the tolerance of `scale` [FU].

        Raises:
            UntrustedError: see `require_trust`; also where the force cannot be held.
        """
        # Where pairs snap the force at a displacement is known no better.
        near = (0.5 if self.settings.is_smooth else 1.0) * FORCE_ACCURACY * self.settings.tolerance * scale
        rises = not self.states or force - self._last.carried > near
        direction = 1 if rises else -1
        self._turn(rises)
        self._at(self._last.displacement if self.states else 0.0)

        def goes_beyond(state: State) -> bool:
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
            self._at(self._towards(before, beyond, force, direction * step))
        self._came(force + self._last.pushed)

    def _towards(self, before: State, beyond: State | None, force: float, step: float) -> float:
        """The next displacement [LU]: a secant over what the model has under these forces, which is nearly straight.

        It is kept inside the bracket, off its ends by EDGE of it where the search does not converge, or within a step.
        """
        *_, former, last = [None, *self.leg]
        expected, rate, margin = self._expected, 1.0, EDGE
        if former and (change := expected(last.carried) - expected(former.carried)):
            rate = (last.displacement - former.displacement) / change
            margin *= abs(last.carried - force) > CONVERGING * abs(former.carried - force)
        goal = last.displacement + rate * (expected(force) - expected(last.carried))
        if beyond is None:
            ahead = (goal - before.displacement) / step
            return before.displacement + (min(1.0, ahead) if ahead > 0.0 else 1.0) * step
        part = (goal - before.displacement) / (beyond.displacement - before.displacement)
        if not 0.0 < part < 1.0:  # the model knows nothing of these states
            part = (force - before.carried) / (beyond.carried - before.carried)
        return before.displacement + min(max(part, margin), 1.0 - margin) * (beyond.displacement - before.displacement)

    def _require_within_reach(self, force: float, rises: bool, before: State, beyond: State | None) -> None:
        """Refuse a force that the branch jumps past, never reaches, or does not reach in a practicable time."""
        states = self.leg
        if beyond is not None and self._is_same(before, beyond):
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

    def _is_same(self, one: State, other: State) -> bool:
        """Whether two states are at one displacement but for round-off."""
        return abs(one.displacement - other.displacement) < SAME * self.scene.bodies.spacing

    # --- the largest tension

    def maximum(self) -> None:
        """Find the force maximum of the unloading; the last state is then at it.

        Rows past it, back to it, and at half the distance beside it until they change nothing. Just below snapping F(d)
        has a maximum for each pair that separates: every one that may be the highest is examined.

        Raises:
            UntrustedError: see `require_trust`; it is not found.
        """
        beside = self._pass_maximum()
        expected, cuts, changed = self.peak, 0, math.inf
        for _ in range(MOST_ROUNDS):
            self._back_to(expected.position)
            found = self.peak
            missed, allowed = abs(found.smooth - expected.smooth), self.tolerance * found.smooth
            if missed > allowed or not self._is_at(found):
                expected = found
                continue
            known = changed <= allowed and found.uncertainty <= allowed
            if known and (cuts > HALVINGS_AT_PEAK or self._is_placed(found)):
                before, left = len(self.states), self._look_at_rivals(allowed)
                if len(self.states) == before:
                    self._found(max(missed, changed, left, abs(found.smooth + self._last.force)))
                    return
                expected = self.peak
                changed = max(changed, abs(expected.smooth - found.smooth))
                continue
            beside, cuts = 0.5 * beside, cuts + 1
            surprise = self._halve((found.position + beside, found.position - beside))
            expected = self.peak
            if (moved := abs(expected.position - found.position)) > 2.0 * beside:
                beside = moved  # another maximum is higher: nothing is known beside it
            changed = max(surprise, abs(expected.smooth - found.smooth))
        raise UntrustedError(f"no force maximum is found near {expected.position:.6g} LU: {JUMPS}")

    def open(self) -> None:
        """Pull the bodies apart.

        Raises:
            UntrustedError: a larger tension comes after the one that was found.
        """
        before = self.peak
        # On from where the bodies have been, yet no longer a way at once than the search for a maximum goes past it.
        nearest = self._last.displacement - (ROWS_BEYOND_PEAK + 1) * self.settings.increment()
        self._separate(max(nearest, min(s.displacement for s in self.leg)))
        after = self.peak
        if abs(after.smooth - before.smooth) > self.tolerance * after.smooth:
            raise SecondMaximumError(
                f"the tensile force rises again to {after.tension:.6g} FU after its maximum of {before.smooth:.6g} "
                'FU: use kind = "path" over the full range'
            )

    def _pass_maximum(self) -> float:
        """Unload until the force maximum is passed; where there are several, all that may exceed it.

        Returns the increment [LU].
        """
        estimate, zero = self.settings.law, self._last
        tooth = estimate.maxima_distance(self.settings.chains.upper)
        densest = (zero.displacement - estimate.rest + float(estimate.gap[-1])) / MOST_TEETH
        step = min(self.settings.increment(), max(tooth, densest) / PER_TOOTH)
        through = tooth < math.inf or self.context.through
        way = 0.0 if through else self._expected(zero.carried) - self._expected(-math.inf)
        rows, skipped = [zero], max(0, math.floor(way / step) - ROWS_BEFORE_PEAK)
        while not _is_passed(rows) or (through and -min(s.force for s in rows) <= self._still_held(rows[-1])):
            rows.append(self._at(zero.displacement - (skipped + len(rows)) * step))
            if len(rows) > MOST_INCREMENTS:
                raise UntrustedError("the search does not pass the force maximum")
        return step

    def _halve(self, positions: tuple[float, float]) -> float:
        """Visit positions [LU] beside the force maximum; by how much they are not what was promised there [FU]."""
        expected = promised(*self.unloading.lists, positions)
        surprise = 0.0
        for position, tension in zip(positions, expected, strict=True):
            self._back_to(position)
            surprise = max(surprise, math.inf if math.isnan(tension) else abs(float(tension) + self._last.force))
        return surprise

    def _look_at_rivals(self, allowed: float) -> float:
        """Visit positions near maxima that may be higher than the highest load step by more than `allowed` [FU].

        Returns by how much one still may [FU].
        """
        excess = 0.0
        for _ in range(MOST_RIVALS):
            d, force = self.unloading.lists
            teeth = rivals(d, force, self.peak)
            highest = max(teeth, key=lambda i: teeth[i], default=0)
            excess = max(0.0, teeth.get(highest, 0.0))
            if excess <= allowed:
                break
            for other in (d[highest - 1], d[highest + 1]):
                self._back_to(0.5 * float(d[highest] + other))
        return excess

    def _is_at(self, peak: Peak) -> bool:
        """Whether the contact radius of the last state is that of the maximum."""
        return abs(self._rate() * (peak.position - self._last.displacement)) <= self._radius_allowed()

    def _is_placed(self, peak: Peak) -> bool:
        """Whether the maximum itself is placed so well that the contact radius there is known."""
        return PLACE_FACTOR * abs(self._rate()) * peak.misplaced <= self._radius_allowed()

    def _rate(self) -> float:
        """da/dd at the last state, from the nearest other one."""
        way = self.unloading
        return radius_rate(way, int(np.argmin(np.abs(way.displacement - self._last.displacement))))

    def _radius_allowed(self) -> float:
        radius = self._last.radius_or_spot
        return max(self.tolerance * radius.value, READ_SHARE * radius.uncertainty)

    # --- moves

    def _at(self, displacement: float) -> State:
        """One load step at a displacement [LU]."""
        self._enter()
        state = self.contact.row(Displace(displacement))
        self._keep([state])
        return state

    def _found(self, missed: float) -> None:
        """A force maximum, with the error of the search for it [FU]."""
        self.searches[self._number] = Search({"sampling": missed})

    def _back_to(self, displacement: float) -> None:
        """Visit a displacement [LU]; bodies come nearer by RETURN_SHARE of their particles' distance at a time."""
        while displacement - self._last.displacement > (longest := RETURN_SHARE * self._last.smallest_distance):
            longest = max(longest, self.settings.increments.longest_move)
            self._at(min(self._last.displacement + longest, displacement))
        self._at(displacement)

    def _separate(self, start: float) -> None:
        """Rows of falling displacement from `start` [LU] until the tension has passed its largest value and is gone."""
        largest = max((-s.force for s in self.leg), default=0.0)
        self._at(start)
        displacement, step = start, self._unloading_step(start)
        for _ in range(MOST_INCREMENTS):
            displacement -= step
            state = self._at(displacement)
            largest = max(largest, -state.force)
            if 0.0 <= -state.force < GROWTH_SHARE * largest:
                step *= self._growth(state, largest)
            gone = abs(state.force) < SEPARATION_SHARE * largest
            if (gone and self._still_held(state) < SEPARATION_SHARE * largest) or (
                state.smallest_distance > self.settings.forces.cutoff
            ):
                return
        raise UntrustedError(f"the bodies did not separate within {MOST_INCREMENTS} increments of the displacement")

    def _growth(self, state: State, largest: float) -> float:
        """Of moves apart beyond the `largest` tension [FU]."""
        return GROWTH

    def _unloading_step(self, start: float) -> float:
        """First increment [LU] of an unloading: soft springs follow the attraction farther than they were pressed."""
        way = start - self.settings.forces.rest + float(self.settings.law.gap[-1])
        return max(self.settings.increment(), way / SEPARATION_ROWS)

    def _still_held(self, state: State) -> float:
        """Tension [FU] that bodies which move apart can have at most from this state on.

        A particle that has passed the force maximum of its law only loses what it has; any other, wherever it is, may
        come to hold that.
        """
        profile, (distance, largest) = state.profile, self.settings.strongest
        held = self.scene.bodies.spacing * np.maximum(0.0, -profile.pressure)
        near = profile.z_upper - profile.z_lower < distance
        return float(np.sum(np.where(near, np.maximum(held, largest), held)))


class SecondMaximumError(UntrustedError):
    """The tension rises again after its first maximum: further load steps are needed."""


def _is_passed(states: Sequence[State]) -> bool:
    """Whether the last load steps lie beyond a force maximum."""
    tension = [-s.force for s in states]
    largest = max(tension)
    return largest > 0.0 and tension.index(largest) < len(tension) - ROWS_BEYOND_PEAK
