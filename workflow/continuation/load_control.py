"""A branch of states under load control, in time, as in the paper: loads, each held until equilibrium or separation.

A tension that separates the bodies is undone: the next one starts from the state before. The reduced model, which
is mostly within a tolerance of the pull-off force, chooses the first loads; the result is the bracket of a load that
is sustained and one that is not. The load steps of the search are the schedule: nothing is run twice.

Loads are positive in compression, tensions in tension [FU]. A leg is a part of the loading between two of its turns.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

import numpy as np

from contact1d.analysis.curve_marks import are_apart
from contact1d.analysis.polynomial import Array, lowest_minimum, through, value
from contact1d.workflow.continuation.context import ContactBranch
from contact1d.workflow.continuation.holding import Held, Start, hold, overshoot, press
from contact1d.workflow.continuation.trace import Search
from contact1d.workflow.deck.steps import UnderLoad
from contact1d.workflow.errors import ThroughError, UntrustedError

FIRST_RISE = 2.0
"""Rise of the tension that is tried first over the tolerance: rest, table and cutoff use up to one of it themselves."""


@dataclass
class LoadSearch:
    """Tensions tried so far, positive [FU].

    Attributes:
        tolerance: of the pull-off force, relative.
        guess: the expected pull-off force [FU].
        overshoot: function of a tension that held [FU]: by how much of its path, 0 … 1, a plate overshoots that goes
            from there to the expected pull-off force.
        held: the outcomes of tensions that held, rising, the first of them F = 0.
        lost: the smallest tension that broke the contact [FU]; infinite before one did.
        broken: no larger tension holds [FU]; above `lost` by the momentum of the plate that it set going.
    """

    tolerance: float
    guess: float
    overshoot: Callable[[float], float]
    held: list[Held]
    lost: float = math.inf
    broken: float = math.inf

    @property
    def best(self) -> float:
        """The largest tensile force that was sustained [FU], the last one in `held`: positive, 0 after F = 0."""
        return -self.held[-1].load

    @property
    def done(self) -> bool:
        """Whether the bracket of the pull-off force, from `best` to `broken`, is at most `tolerance` times `best`.

        False while no tension has broken the contact.
        """
        return self.broken - self.best <= self.tolerance * self.best

    def learn(self, result: Held) -> None:
        """Record the outcome of the latest tensile load: in `held`, or else lower `lost` and `broken` to it.

        `lost` is the smallest tension that was not held; `broken` is raised by the overshoot of the plate from `best`.
        """
        if result.held:
            self.held.append(result)
            return
        self.lost = min(self.lost, -result.load)
        self.broken = min(self.broken, -result.load + self.overshoot(self.best) * (-result.load - self.best))

    def next(self, largest_share: float = 0.8, growth: float = 0.25) -> float:
        """Return the tension to try next, positive [FU], above `best`.

        It is just below the expected pull-off force, less where the momentum of the plate would carry it past that;
        else just above. Where neither is clearly between `best` and the smallest tension that was not held, it is
        inside the bracket, or while no tension has broken the contact (1 + `growth`) times `best`.

        Args:
            largest_share: of the distance to the expected pull-off force, so that the last states lie near it.
            growth: relative rise of a tension that held, where nothing better is known.
        """
        low, high, past = self.best, self.broken, self.overshoot(self.best)
        expected = self._expected()
        margin = 0.45 * self.tolerance * expected  # tensions so far on both sides bracket it within the tolerance
        gentle = min((expected + past * low) / (1.0 + past), low + largest_share * (expected - low))
        for tension in (min(expected - margin, gentle), expected + margin):
            if low + 0.1 * margin < tension < self.lost - 0.1 * margin:
                return tension
        return low + 0.5 * (high - low) / (1.0 + past) if high < math.inf else (1.0 + growth) * low

    def _expected(self) -> float:
        """Return the expected pull-off force, positive [FU]: the first guess, while it is in the bracket.

        Out of the bracket it is, after three tensions that hold, that of the parabola through the last three states,
        and the guess where this has no maximum nearby or there are fewer states.
        """
        if len(self.held) < 3 or self.best < self.guess < self.broken:
            return self.guess
        last = [h.last for h in self.held[-3:]]
        top = top_of(np.asarray([state.displacement for state in last]), np.asarray([state.force for state in last]))
        return self.guess if top is None else top[1]


class LoadBranch(ContactBranch):
    """States at rest under load control.

    Attributes:
        unbalance: unbalanced force of the last state [FU].
        given: "load".
    """

    unbalance, given = 0.0, "load"
    _held: Held | None = None

    @property
    def driver(self) -> Self:
        """This branch, which a script drives itself."""
        return self

    def reach(self, force: float, scale: float) -> None:
        """Hold a force [FU], compression positive, at rest within a tenth of the tolerance of `scale` [FU].

        Of the states only the last one under each load is kept. A compressive force is applied at once, in a search
        that restarted in smaller steps in equal parts; a tension is approached from the last load, or after a loading
        from 0, in steps so small that the momentum of the plate breaks no pair.

        Raises:
            UntrustedError: the contact does not hold the force, does not come to rest, or bodies went through each
                other.
        """
        least_step = 1e-3 * self.scale  # nearer to a tensile load, the load itself is tried
        self._turn(self._held is None or force > self._held.load)
        self._begin_phase()
        if self._turned and self._direction > 0:
            self._take(press(self.contact, max(force, 0.0), scale))
        elif force >= 0.0:
            self._take(hold(self.contact, force, scale))
        while (held := self._latest).held and held.load > force:
            if self._turn(rises=False):
                self.begin("unloading")
                self._begin_phase()
            past = overshoot(self.settings, self.scene.bodies.mass, held.load, -self.scale)
            gentle = (past * held.load - self.scale) / (1.0 + past)
            close = gentle >= held.load - least_step
            self._take(hold(self.contact, force if close else max(force, gentle), scale))
        if not self._latest.held:
            raise UntrustedError(f"the contact does not sustain {self._latest.load:.4g} FU: the bodies separate")
        self._record_target(force + self._last.pushed)

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a force [FU], compression positive, for a time [TU]; states need not be at rest.

        A tension is applied to a contact at rest at F = 0, whose state is kept in a phase "approaching". The hold has
        up to 101 states. `displacement` is ignored; `force` must not be None (AssertionError).

        Raises:
            UntrustedError: bodies went through each other, the contact reaches the end of the chain, or before a
                tension it does not come to rest.
        """
        assert force is not None
        self.moves, name = True, self._phase
        if force < 0.0:
            self.begin("approaching")
            self.reach(0.0, self.scale)
        self.begin(name)
        self._turn(rises=force >= 0.0)
        self._move([UnderLoad(force, steps) for steps in self.settings.steps_of(duration)])

    def holds_more(self, force: float, doubtful_share: float = 0.9) -> bool:
        """Return whether a tension larger by two tolerances than that of `force` [FU] < 0 is sustained, too.

        It is tried on a new contact; this one is not changed. False also where that contact does not come to rest.
        True, without a trial, of a tension below `doubtful_share` of the expected pull-off force. A contact at rest
        balances its load within a share of the tolerance, and near the limit point it creeps: on which side of it a
        load is cannot be resolved further.

        Raises:
            ThroughError: the bodies went through each other.
        """
        if force > -doubtful_share * self.scale:
            return True
        try:
            with LoadBranch(self.context) as branch:
                branch.begin("loading")
                larger = force * (1.0 + FIRST_RISE * self.settings.tolerance)
                branch.reach(larger, max(-larger, self.settings.forces.scale))
        except ThroughError:
            raise
        except UntrustedError:
            return False
        return True

    def maximum(self, most_loads: int = 60) -> None:
        """Try rising tensions until the pull-off force is bracketed within the tolerance; hold the lower end again.

        A force must have been reached before (`reach`). Tensions that the contact carries add states; the last state is
        that at the lower end, in the phase "critical". `searches` gets the bracket [FU], both positive: the largest
        tension that was carried, and the smallest that was not, raised by the momentum of the plate.

        Raises:
            UntrustedError: the bracket is still too wide after `most_loads` tensions; the lower end is not held
                again; a load does not come to rest, or bodies went through each other.
        """
        self._begin_phase()
        settings, mass, guess = self.settings, self.scene.bodies.mass, self.scale
        search = LoadSearch(
            settings.tolerance, guess, lambda held: overshoot(settings, mass, -held, -guess), [self._latest]
        )
        start = Start.KEPT
        for _ in range(most_loads):
            result = hold(self.contact, -search.next(), search.guess, start)
            start = Start.KEPT if result.held else Start.BACK
            if result.held:
                self._append([result.last])
            search.learn(result)
            if search.done:
                break
        else:
            raise UntrustedError(
                f"the pull-off force was not bracketed within {most_loads} loads: it is above {search.best:.6g} FU"
            )
        self.begin("critical")
        self._begin_phase()
        critical = hold(self.contact, -search.best, search.guess, Start.BACK)
        if not critical.held:
            raise UntrustedError(
                f"the contact sustained {search.best:.6g} FU in one trial and not in the next: the plate oscillates. "
                'Use "auto" or larger values for [damping] coefficient and [plate] damping, or method = '
                '"quasistatic"'
            )
        self.states[-1] = critical.last
        self._held, self.unbalance = critical, critical.unbalance
        doubt = {"instability": self._missed_maxima(search)}
        self.searches[self._number] = Search(doubt, (search.best, search.broken))

    def open(self) -> None:
        """Do nothing: the bodies stay in contact, and the last state stays that of the pull-off force."""

    def _missed_maxima(self, search: LoadSearch) -> float:
        """Return the tension [FU] ≥ 0 that an oscillating plate may miss, where pairs separate one by one; else 0.

        It is twice the tension that a pair loses, one at each contact edge, times the overshoot of the plate from the
        largest tension that was carried.
        """
        settings = self.settings
        lost = (settings.law.snap[1] or settings.strongest[1]) if settings.has_several_maxima else 0.0
        return 2.0 * lost * search.overshoot(search.best)

    @property
    def _latest(self) -> Held:
        """The outcome of the latest load; AssertionError where there was none."""
        assert self._held is not None
        return self._held

    def _take(self, held: Held) -> None:
        """Keep an outcome as the latest, with its unbalanced force, and add only its last state to the states."""
        self._held, self.unbalance = held, held.unbalance
        self._append([held.last])


def top_of(displacement: Array, force: Array, longest: float = 5.0) -> tuple[float, float] | None:
    """Return (displacement [LU], tension [FU]) of the force maximum of the polynomial through all states at rest.

    None where it has none within `longest` times the width of the states from the last one, or where two of these are
    nearer than 1e-5 of that width.

    Args:
        displacement: of the states, (m,) [LU].
        force: of the contact, not the load that it balances, (m,) [FU], compression positive.
        longest: largest distance of the maximum from the last state over the width of the states.
    """
    if not are_apart(displacement):
        return None
    width = float(np.ptp(displacement))
    loss = through((displacement - displacement[-1]) / width, force)
    top, _ = lowest_minimum(loss, -longest, longest)
    return None if math.isnan(top) else (float(displacement[-1]) + width * top, -value(loss, top))
