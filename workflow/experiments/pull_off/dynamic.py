"""Pull-off as the paper does it: preload F_D, then tensions F_Z, each held until rest or separation, iterated.

A tension that breaks the contact is undone: the next one begins where it began. The first tensions are chosen by the
estimate of independent pairs, which is mostly within a tolerance of the pull-off force; what counts is the bracket of a
tension that held and one that did not. The rows of the search are the schedule: nothing is run twice.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import are_apart
from contact1d.analysis.polynomial import lowest_minimum, through, value
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.pull_off.marked import marked_outcome
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.holding import Held, Start, hold, overshoot, press
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import UntrustedError, doubts, require_no_contradiction
from contact1d.workflow.scene import PullOff
from contact1d.workflow.units import FORCE, LENGTH, Quantity

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
"""Pairs that let go together, one at each edge of the contact: by so much the tension falls after a snap."""
GROWTH = 0.25
"""Rise of a tension over the one that held, where nothing better is known."""


@dataclass
class Search:
    """Tensions tried so far.

    Attributes:
        tolerance: of the pull-off force, relative.
        guess: what is expected [FU].
        overshoot: of the plate from a tension that held (see `workflow.experiments.running.holding.overshoot`).
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
        """The largest tension that held [FU]."""
        return -self.held[-1].load

    @property
    def done(self) -> bool:
        """Whether the bracket is narrow enough."""
        return self.broken - self.best <= BRACKET * self.tolerance * self.best

    def learn(self, result: Held) -> None:
        """Take in what the latest tension led to."""
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
        top = top_of([h.last for h in self.held[-3:]])
        return self.guess if top is None else top[1]


def pull_off_dynamic(context: RunContext) -> Outcome:
    """F_A, a_cr and a₀ of a scene with `[experiment] kind = "pull_off"`, `method = "dynamic"`.

    Raises:
        UntrustedError: see `hold`.
    """
    scene = context.deck.scene
    assert isinstance(scene.experiment, PullOff)
    preload = scene.experiment.preload
    guess = context.deck.settings.estimate.pull_off_force()
    with context.contact() as contact:
        contact.begin("loading")
        loaded = press(contact, preload, max(preload, guess))
        contact.begin("unloading")
        zero = hold(contact, 0.0, max(preload, guess))
        if not (loaded.held and zero.held):
            raise UntrustedError("the contact is lost before any tension is applied: the bodies do not stick")
        contact.write_state()
        search = Search(context.deck.settings.tolerance, guess, partial(_overshoot, context.deck, guess), [zero])
        contact.begin("pulling")
        _pull(contact, search)
        contact.begin("critical")
        critical = hold(contact, -search.best, guess, Start.BACK)
        contact.write_state()
        contact.finish()
    if not critical.held:
        raise UntrustedError(
            f"the contact held {search.best:.6g} FU once and not again: a plate that still swings decides there. Leave "
            '[damping] coefficient and [plate] damping "auto" or give more of them, or take method = "quasistatic"'
        )
    return _outcome(context, search, loaded, critical, contact.phases)


def _overshoot(deck: Deck, guess: float, tension: float) -> float:
    return overshoot(deck.settings, deck.scene.bodies.mass, -tension, -guess)


def _pull(contact: Contact, search: Search) -> None:
    """Try tensions until the bracket is narrow enough."""
    start = Start.KEPT
    for _ in range(MOST_LEVELS):
        result = hold(contact, -search.next(), search.guess, start)
        start = Start.KEPT if result.held else Start.BACK
        search.learn(result)
        if search.done:
            return
    raise UntrustedError(
        f"the pull-off force was not bracketed within {MOST_LEVELS} tensions: it is above {search.best:.6g} FU"
    )


def _outcome(context: RunContext, search: Search, loaded: Held, critical: Held, phases: tuple[Phase, ...]) -> Outcome:
    scene, settings = context.deck.scene, context.deck.settings
    zero = search.held[0].last
    adhesion = 0.5 * (search.best + search.broken)
    half = 0.5 * (search.broken - search.best) + critical.unbalance + missed_teeth(context.deck, search)
    rest = (*(h.last for h in search.held[:-1]), critical.last)
    zero_radius = zero.radius_or_spot
    if settings.is_toothed:
        critical_radius, spread = _radius_between_snaps(context, critical.last, zero_radius.value, half / adhesion)
    else:
        critical_radius, spread = _critical_radius(rest)
    slope = abs(critical_radius.value - zero_radius.value) / adhesion
    at_zero = abs(zero.force)
    if settings.is_toothed:
        swung = overshoot(settings, scene.bodies.mass, loaded.last.force, 0.0) * loaded.last.force
        at_zero += min(swung, adhesion)  # beyond the largest tension the plate would not have come back
    quantities = {
        "adhesion_force": Quantity(adhesion, half, FORCE),
        "critical_radius": critical_radius,
        "zero_load_radius": Quantity(zero_radius.value, zero_radius.uncertainty + slope * at_zero, LENGTH),
        "preload": Quantity(loaded.last.force, loaded.unbalance, FORCE),
    }
    require_no_contradiction(settings, quantities, rest)
    marked = {"zero_load": zero, "critical": critical.last}
    by_spacing = {"critical_radius": spread, "zero_load_radius": zero_radius.uncertainty}
    states = (loaded.last, *rest)
    return marked_outcome(quantities, states, marked, phases, doubts(scene, settings, states), by_spacing)


def missed_teeth(deck: Deck, search: Search) -> float:
    """Tension [FU] that a plate may miss which swings past a tooth of the tension, where pairs let go one by one."""
    settings = deck.settings
    lost = (settings.estimate.snap[1] or settings.strongest[1]) if settings.is_toothed else 0.0
    return EDGES * lost * search.overshoot(search.best)


def _radius_between_snaps(
    context: RunContext, critical: State, zero_radius: float, missed: float
) -> tuple[Quantity, float]:
    """Radius of the last state that held, where pairs let go one by one: a tooth has no smooth top to go on to.

    The pull-off may be at the next tooth, with one particle less at each edge, and further off where up to twice the
    share `missed` of the tension is left to it: the teeth's tops lie near F = F_A (1 − y²), y = (a − a_cr)/(a₀ − a_cr).
    Also the part of the uncertainty [LU] that the spacing leaves.
    """
    radius = critical.radius_or_spot
    spread = radius.uncertainty + context.deck.scene.bodies.spacing
    beyond = abs(zero_radius - radius.value) * math.sqrt(2.0 * missed)
    return Quantity(radius.value, spread + beyond, LENGTH), spread


def top_of(states: Sequence[State]) -> tuple[float, float] | None:
    """(displacement [LU], tension [FU]) of the largest tension of the polynomial through states at rest.

    None where it has none within LONGEST_EXTRAPOLATION of the states. Their own forces count, not the loads that
    they balance within a threshold.
    """
    place = np.asarray([state.displacement for state in states])
    if not are_apart(place):
        return None
    width = float(np.ptp(place))
    loss = through((place - place[-1]) / width, np.asarray([state.force for state in states]))
    top, _ = lowest_minimum(loss, -LONGEST_EXTRAPOLATION, LONGEST_EXTRAPOLATION)
    return None if math.isnan(top) else (float(place[-1]) + width * top, -value(loss, top))


def _critical_radius(held: Sequence[State]) -> tuple[Quantity, float]:
    """Radius at the pull-off itself, which force control never sees: extrapolated over the displacement.

    The largest tension is that of a cubic through the last four states at rest, the radius goes there as a parabola
    through the last three; the largest tension of a parabola through those three says how far both can be trusted.
    Also the part of the uncertainty [LU] that the spacing leaves.
    """
    radii = [state.radius for state in held[1 - FEWEST_HELD :]]
    last = radii[-1]
    if last is None:
        raise UntrustedError("no contact radius: no particle is in tension")
    tops = [top_of(held[-count:]) for count in (FEWEST_HELD, FEWEST_HELD - 1)]
    values = [radius.value for radius in radii if radius is not None]
    if len(values) < FEWEST_HELD - 1 or len(held) < FEWEST_HELD or tops[0] is None or tops[1] is None:
        return Quantity(last.value, last.value, LENGTH), last.uncertainty
    places = np.asarray([state.displacement for state in held[1 - FEWEST_HELD :]])
    value, other = (float(_weights(places, top[0]) @ values) for top in tops if top is not None)
    uncertainties = [radius.uncertainty for radius in radii if radius is not None]
    spread = float(np.abs(_weights(places, tops[0][0])) @ uncertainties)
    return Quantity(value, spread + SPREAD * abs(value - other), LENGTH), spread


def _weights(places: NDArray[np.float64], place: float) -> NDArray[np.float64]:
    """Weights of the values at `places` [LU] in the value at `place` of the polynomial through all of them."""
    return np.asarray(through((places - place) / float(np.ptp(places)), np.eye(len(places)))[0])
