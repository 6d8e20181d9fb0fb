"""Pull-off by prescribed displacement where F(d) is smooth: one schedule that marks F = 0 and the largest tension.

No particle snaps, so that the state at a displacement does not depend on the way to it, and the search may come back to
a place that it has passed: it compresses to F_D, goes to F = 0, pulls until the tension has passed its largest value,
comes back to where polynomials through the rows put it, and pulls the bodies apart. Each mark is approached until the
row there says what the polynomial had promised; how far the two were apart is the uncertainty of the search.
"""

from __future__ import annotations

from dataclasses import dataclass

from contact1d.analysis.curve_marks import Peak, largest_tension, smooth_crossing
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.prescribing import approach, measured, separate
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import UntrustedError

MOST_TRIES = 12
"""Rows at one mark after which the search gives up."""
PAST = 3
"""Rows beyond the largest tension that its polynomials need."""
MISPLACED = 2.0
"""Error of the place of the largest tension over the distance between those of two polynomials."""
CLOSER = (0.5, 0.25)
"""Distances over the increment at which rows are put beside a largest tension that is not placed well enough."""
MOST_PULLS = 500
"""Rows from F = 0 to the largest tension; a contact that needs more lets go nowhere near."""
LATTICE = 0.5
"""Part of a radius's uncertainty below which it is looked at no closer: interpolation between particles limits it."""

JUMPS = (
    'the force jumps there, as particles snap or slip. Use kind = "path" to see it, or stiffer springs or a longer '
    "range, with which particles do not snap"
)


@dataclass(frozen=True)
class SmoothPass:
    """The finished schedule.

    Attributes:
        phases: of the deck.
        loading: states up to F_D.
        unloading: all later ones, in order.
        zero, critical: the marked states.
        peak: the largest tension by all rows.
        missed: how far the last row at the largest tension was from what had been expected [FU].
    """

    phases: tuple[Phase, ...]
    loading: list[State]
    unloading: list[State]
    zero: State
    critical: State
    peak: Peak
    missed: float


def smooth_pass(context: RunContext, preload: float, tolerance: float) -> SmoothPass:
    """Search and schedule in one.

    Args:
        context: of a deck whose settings are smooth.
        preload: F_D [FU].
        tolerance: share of the results that the search may miss.

    Raises:
        UntrustedError: see `require_trust`; a mark is not found, or a larger tension comes after it.
    """
    with context.contact() as contact:
        contact.begin("loading")
        loading = approach(contact, preload, 0.0)
        contact.begin("unloading")
        unloaded = _to_zero(contact, loading, tolerance)
        contact.write_state()
        contact.begin("pulling")
        pulled, missed = _to_largest_tension(contact, unloaded, tolerance)
        contact.write_state()
        contact.begin("separating")
        apart = separate(contact, min(s.displacement for s in pulled), -min(s.force for s in pulled))
        contact.finish()
        phases = contact.phases
    unloading = [*unloaded, *pulled, *apart]
    peak = _peak(unloading)
    if abs(peak.smooth - _peak([*unloaded, *pulled]).smooth) > tolerance * peak.smooth:
        raise UntrustedError(
            f"the tension rises again to {peak.tension:.6g} FU after its first maximum: the contact lets go in pieces, "
            'which one pull_off can\'t mark; use kind = "path" through all of it'
        )
    return SmoothPass(phases, loading, unloading, unloaded[-1], pulled[-1], peak, missed)


def _to_zero(contact: Contact, loading: list[State], tolerance: float) -> list[State]:
    """Down from F_D to F = 0, in increments of the search; the last state is the mark."""
    at, step, states = loading[-1].displacement, contact.settings.increment(), [loading[-1]]
    scale = contact.settings.estimate.pull_off_force()
    while states[-1].force > 0.0:
        place = _zero([*loading, *states]) if loading[0].force < 0.0 or len(states) > 1 else at - step
        at = max(place, states[-1].displacement - step) if place < states[-1].displacement else at - step
        states.append(measured(contact, at))
        if len(states) > MOST_PULLS:
            raise UntrustedError("the force stays compressive: nothing holds the bodies together")
    for _ in range(MOST_TRIES):
        if abs(states[-1].force) <= tolerance * scale:
            return states[1:]
        states.append(measured(contact, _zero([*loading, *states])))
    raise UntrustedError(f"F = 0 is not found near {states[-1].displacement:.6g} LU: {JUMPS}")


def _zero(states: list[State]) -> float:
    rows = _falling(states)
    try:
        return smooth_crossing([s.displacement for s in rows], [s.force for s in rows], 0.0)
    except ValueError:
        return -float("inf")


def _to_largest_tension(contact: Contact, unloaded: list[State], tolerance: float) -> tuple[list[State], float]:
    """Down from F = 0 past the largest tension and back to it, where the last state is. Also returns the miss [FU]."""
    step = contact.settings.increment()
    states: list[State] = []
    at = unloaded[-1].displacement
    while not _passed([unloaded[-1], *states]):
        at -= step
        states.append(measured(contact, at))
        if len(states) > MOST_PULLS:
            raise UntrustedError("the largest tension is never passed")
    expected, closer = _peak([*unloaded, *states]), iter(CLOSER)
    for _ in range(MOST_TRIES):
        states.append(measured(contact, expected.position))
        found = _peak([*unloaded, *states])
        missed = abs(found.smooth - expected.smooth)
        if missed <= tolerance * found.smooth and _near(states, found, tolerance):
            beside = None if _placed(states, found, tolerance) else next(closer, None)
            if beside is None:
                return states, max(missed, abs(found.smooth + states[-1].force))
            states += [measured(contact, found.position + side * beside * step) for side in (1.0, -1.0)]
            found = _peak([*unloaded, *states])
        expected = found
    raise UntrustedError(f"the largest tension is not found near {expected.position:.6g} LU: {JUMPS}")


def _near(states: list[State], peak: Peak, tolerance: float) -> bool:
    """Whether the contact radius of the last state is that of the maximum."""
    return abs(critical_shift(states, states[-1], peak)) <= _allowed(states[-1], tolerance)


def _placed(states: list[State], peak: Peak, tolerance: float) -> bool:
    """Whether the maximum itself is placed so well that the contact radius there is known."""
    rate = abs(radius_rate(states, states[-1]))
    return MISPLACED * rate * peak.misplaced <= _allowed(states[-1], tolerance)


def _allowed(critical: State, tolerance: float) -> float:
    """Error [LU] that is left to the contact radius of the critical state."""
    radius = critical.radius_or_spot
    return max(tolerance * radius.value, LATTICE * radius.uncertainty)


def critical_shift(states: list[State], critical: State, peak: Peak) -> float:
    """By how much a changes from the critical state to where the curve has its maximum [LU]."""
    return radius_rate(states, critical) * (peak.position - critical.displacement)


def radius_rate(states: list[State], critical: State) -> float:
    """da/dd at the critical state, from the nearest other row."""
    others = (s for s in states if s.displacement != critical.displacement)
    near = min(others, key=lambda s: abs(s.displacement - critical.displacement))
    change = near.radius_or_spot.value - critical.radius_or_spot.value
    return change / (near.displacement - critical.displacement)


def _passed(states: list[State]) -> bool:
    """Whether the last rows lie beyond a largest tension."""
    tension = [-s.force for s in states]
    return len(tension) > PAST and max(tension) > 0.0 and tension.index(max(tension)) < len(tension) - PAST


def _peak(states: list[State]) -> Peak:
    rows = _falling(states)
    return largest_tension([s.displacement for s in rows], [s.force for s in rows])


def _falling(states: list[State]) -> list[State]:
    """By falling displacement, each place once."""
    places = {s.displacement: s for s in states}
    return [places[d] for d in sorted(places, reverse=True)]
