"""A branch of states under load control, in time, as in the paper: loads, each held until equilibrium or separation.

A tension that separates the bodies is undone: the next one starts from the state before. The reduced model, which
is mostly within a tolerance of the pull-off force, chooses the first loads; the result is the bracket of a load that
is sustained and one that is not. The load steps of the search are the schedule: nothing is run twice.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import are_apart
from contact1d.analysis.polynomial import lowest_minimum, through, value
from contact1d.workflow.continuation.context import ContactBranch, RunContext
from contact1d.workflow.continuation.holding import Held, Start, hold, overshoot, press
from contact1d.workflow.continuation.trace import Search
from contact1d.workflow.continuation.trust import ThroughError, UntrustedError
from contact1d.workflow.deck.steps import UnderLoad

Array = NDArray[np.float64]
MOST_LEVELS = 60
BRACKET = 1.0
"""Width of the final bracket of the tension over the tolerance."""
BRACKET_AIM = 0.45
"""Distance from the expected pull-off force at which both sides are tried, over the tolerance."""
FEWEST_HELD = 4
"""States at rest from which the critical radius is extrapolated."""
LONGEST_EXTRAPOLATION = 5.0
"""Farthest extrapolation over the width of the states that it starts from."""
SPREAD = 2.0
"""Uncertainty of the extrapolation over the difference that one state less makes."""
STRIDE = 0.8
"""Rise of a tension over what is left to the expected pull-off force at most, so that the last states lie near it."""
EDGES = 2
"""Pairs that separate together, one at each contact edge: by so much the tensile force falls after a snap-out."""
GROWTH = 0.25
"""Rise of a tension over the one that held, where nothing better is known."""
FIRST_RISE = 2.0
"""Rise of the tension that is tried first over the tolerance: rest, table and cutoff use up to one of it themselves."""
DOUBTFUL_SHARE = 0.9
"""Tension over the expected largest one from which on it may be the pull-off force."""
LEAST_STEP = 1e-3
"""Distance to a tensile load, over the expected force maximum, below which the load itself is tried."""


@dataclass
class LoadSearch:
    """Tensions tried so far.

    Attributes:
        tolerance: of the pull-off force, relative.
        guess: what is expected [FU].
        overshoot: of the plate from a tension that held (see `holding.overshoot`).
        held: the tensions that held, rising, the first of them F = 0.
        lost: the smallest tension that broke the contact [FU].
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
        """The largest tensile force sustained [FU]."""
        return -self.held[-1].load

    @property
    def done(self) -> bool:
        """Whether the bracket is narrow enough."""
        return self.broken - self.best <= BRACKET * self.tolerance * self.best

    def learn(self, result: Held) -> None:
        """Record the outcome of the latest tensile load."""
        if result.held:
            self.held.append(result)
            return
        self.lost = min(self.lost, -result.load)
        self.broken = min(self.broken, -result.load + self.overshoot(self.best) * (-result.load - self.best))

    def next(self) -> float:
        """The tension to try next [FU]; the plate's momentum is not to carry it beyond the expected pull-off force."""
        low, high, past = self.best, self.broken, self.overshoot(self.best)
        expected = self._expected()
        margin = BRACKET_AIM * self.tolerance * expected
        gentle = min((expected + past * low) / (1.0 + past), low + STRIDE * (expected - low))
        for tension in (min(expected - margin, gentle), expected + margin):
            if low + 0.1 * margin < tension < self.lost - 0.1 * margin:
                return tension
        return low + 0.5 * (high - low) / (1.0 + past) if high < math.inf else (1.0 + GROWTH) * low

    def _expected(self) -> float:
        """The guess while nothing speaks against it, then the top of a parabola through the last three held states."""
        if len(self.held) < 3 or self.best < self.guess < self.broken:
            return self.guess
        last = [h.last for h in self.held[-3:]]
        top = top_of(*(np.asarray([getattr(s, name) for s in last]) for name in ("displacement", "force")))
        return self.guess if top is None else top[1]


class LoadBranch(ContactBranch):
    """States at rest under loads; as `Branch`, but under load control.

    Attributes:
        unbalance: force [FU] that the last state leaves unbalanced.
    """

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact."""
        super().__init__(context, meanwhile)
        self.unbalance, self.given = 0.0, "load"
        self._held: Held | None = None

    def reach(self, force: float, scale: float) -> None:
        """Hold a force [FU] to a share of the tolerance of `scale` [FU]; a tension is approached from F = 0, so
        gently that the plate's momentum breaks nothing.

        Raises:
            UntrustedError: see `hold`; the contact can't hold the force.
        """
        self._turn(self._held is None or force > self._held.load)
        self._enter()
        if self._turned and self._direction > 0:
            self._take(press(self.contact, max(force, 0.0), scale))
        elif force >= 0.0:
            self._take(hold(self.contact, force, scale))
        while (held := self._latest).held and held.load > force:
            if self._turn(rises=False):
                self.begin("unloading")
                self._enter()
            past = overshoot(self.settings, self.scene.bodies.mass, held.load, -self.scale)
            gentle = (past * held.load - self.scale) / (1.0 + past)
            close = gentle >= held.load - LEAST_STEP * self.scale
            self._take(hold(self.contact, force if close else max(force, gentle), scale))
        if not self._latest.held:
            raise UntrustedError(f"the contact does not sustain {self._latest.load:.4g} FU: the bodies separate")
        self._came(force + self._last.pushed)

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a force [FU] for a time [TU]; a tension from F = 0 on."""
        assert force is not None
        self.moves, name = True, self._phase
        if force < 0.0:
            self.begin("approaching")
            self.reach(0.0, self.scale)
        self.begin(name)
        self._enter()
        self._turn(rises=force >= 0.0)
        rows = [UnderLoad(force, steps) for steps in self.settings.steps_of(duration)]
        self._keep(self.contact.rows(rows, moving=True))

    def holds_more(self, force: float) -> bool:
        """Whether a tensile load larger by FIRST_RISE tolerances is sustained, too, tried with a contact of its own.

        A contact at rest balances its load within a share of the tolerance, and near the limit point it creeps: on
        which side of it a load is cannot be resolved further.
        """
        if force > -DOUBTFUL_SHARE * self.scale:
            return True
        try:
            with LoadBranch(self.context) as other:
                other.begin("loading")
                larger = force * (1.0 + FIRST_RISE * self.settings.tolerance)
                other.reach(larger, max(-larger, self.settings.forces.scale))
        except ThroughError:
            raise
        except UntrustedError:
            return False
        return True

    def maximum(self) -> None:
        """Try tensions until the bracket of the largest one is narrow enough, then hold the largest that was held.

        Raises:
            UntrustedError: see `hold`; the force maximum is not bracketed, or not held again.
        """
        self._enter()
        search = LoadSearch(self.settings.tolerance, self.scale, partial(_overshoot, self), [self._latest])
        start = Start.KEPT
        for _ in range(MOST_LEVELS):
            result = hold(self.contact, -search.next(), search.guess, start)
            start = Start.KEPT if result.held else Start.BACK
            if result.held:
                self._keep([result.last])
            search.learn(result)
            if search.done:
                break
        else:
            raise UntrustedError(
                f"the pull-off force was not bracketed within {MOST_LEVELS} loads: it is above {search.best:.6g} FU"
            )
        self.begin("critical")
        self._enter()
        critical = hold(self.contact, -search.best, search.guess, Start.BACK)
        if not critical.held:
            raise UntrustedError(
                f"the contact sustained {search.best:.6g} FU in one trial and not in the next: the plate oscillates. "
                'Use "auto" or larger values for [damping] coefficient and [plate] damping, or method = '
                '"quasistatic"'
            )
        self.states[-1] = critical.last
        self._held, self.unbalance = critical, critical.unbalance
        doubt = {"instability": self._missed_teeth(search)}
        self.searches[self._number] = Search(doubt, (search.best, search.broken))

    def open(self) -> None:
        """Nothing: a tension that was not held has separated the bodies."""

    def _missed_teeth(self, search: LoadSearch) -> float:
        """Tension [FU] that a plate may miss which oscillates past a force maximum, where pairs are lost one by one."""
        settings = self.settings
        lost = (settings.law.snap[1] or settings.strongest[1]) if settings.has_several_maxima else 0.0
        return EDGES * lost * search.overshoot(search.best)

    @property
    def _latest(self) -> Held:
        assert self._held is not None
        return self._held

    def _take(self, held: Held) -> None:
        self._held, self.unbalance = held, held.unbalance
        self._keep([held.last])


def _overshoot(branch: LoadBranch, tension: float) -> float:
    return overshoot(branch.settings, branch.scene.bodies.mass, -tension, -branch.scale)


def top_of(displacement: Array, force: Array) -> tuple[float, float] | None:
    """(displacement [LU], tension [FU]) of the force maximum of the polynomial through states at rest.

    None where it has none within LONGEST_EXTRAPOLATION of the states. Their own forces count, not the loads that
    they balance within a threshold.
    """
    if not are_apart(displacement):
        return None
    width = float(np.ptp(displacement))
    loss = through((displacement - displacement[-1]) / width, force)
    top, _ = lowest_minimum(loss, -LONGEST_EXTRAPOLATION, LONGEST_EXTRAPOLATION)
    return None if math.isnan(top) else (float(displacement[-1]) + width * top, -value(loss, top))
