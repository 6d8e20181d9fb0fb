"""Pull-off by prescribed displacement where F(d) is smooth: one schedule that marks F = 0 and the largest tension.

No particle snaps, so that the state at a displacement does not depend on the way to it, and the search may come back to
a place that it has passed: it compresses to F_D, goes to F = 0, pulls until the tension has passed its largest value,
comes back to where polynomials through the rows put it, and pulls the bodies apart. Each mark is approached until the
row there says what the polynomial had promised, and the largest tension until rows that halve the increment beside it
leave its height and place as they were; how far these were apart is the uncertainty of the search. Polynomials of
several degrees through one coarse sample agree with each other where the maximum is sharper than the sample tells.

Just below snapping F(d) has a tooth for each pair that lets go, so that there is more than one maximum: the rows are
then denser than the teeth of the estimate, and every tooth that may be the highest is looked at more closely.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contact1d.analysis.curve_marks import Peak, largest_tension, promised, rivals, smooth_crossing
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.prescribing import approach, back_to, measured, separate, still_held
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.settings.settings import Settings

MOST_TRIES = 12
"""Rows at F = 0 after which the search gives up."""
MOST_CUTS = 60
"""The same of looks at the largest tension, each of which may halve the increment beside it: a sharp one needs some."""
ROWS_BEYOND_PEAK = 3
"""Rows beyond the largest tension that its polynomials need."""
HALVINGS_AT_PEAK = 2
"""Halvings of the increment beside the largest tension for the sake of the contact radius there."""
PLACE_FACTOR = 2.0
"""Error of the place of the largest tension over the distance between those of two polynomials."""
PER_TOOTH = 4.0
"""Rows to a tooth of the tension."""
MOST_TEETH = 400.0
"""Teeth from F = 0 to separation that the rows can tell apart; denser ones are a small part of the tension each."""
MOST_RIVALS = 200
"""Looks at teeth that may be higher than the highest row."""
MOST_PULLS = 2_000
"""Rows from F = 0 to the largest tension; a contact that needs more lets go nowhere near."""
LATTICE_SHARE = 0.5
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
    """Search and schedule in one; again, through all of the tension, where it rises anew after its first maximum.

    Args:
        context: of a deck whose settings are smooth.
        preload: F_D [FU].
        tolerance: share of the results that the search may miss.

    Raises:
        UntrustedError: see `require_trust`; a mark is not found, or a larger tension comes after it.
    """
    for through in (False, True):
        found, before = _searched(context, preload, tolerance, through)
        if abs(found.peak.smooth - before.smooth) <= tolerance * found.peak.smooth:
            return found
        context.progress.note("the tension rises again after its first maximum: once more, through all of it")
    raise UntrustedError(
        f"the tension rises again to {found.peak.tension:.6g} FU after its largest maximum was {before.smooth:.6g} FU: "
        'use kind = "path" through all of it'
    )


def _searched(context: RunContext, preload: float, tolerance: float, through: bool) -> tuple[SmoothPass, Peak]:
    """One schedule, and the largest tension as it was before the bodies were pulled apart."""
    with context.contact(meanwhile=_tooth) as contact:
        contact.begin("loading")
        loading = approach(contact, preload, 0.0)
        contact.begin("unloading")
        unloaded = _to_zero(contact, loading, tolerance)
        contact.write_state()
        contact.begin("pulling")
        pulled, missed = _to_largest_tension(contact, unloaded, tolerance, through)
        contact.write_state()
        contact.begin("separating")
        # On from where the bodies have been, yet no longer a way at once than the search for a maximum goes past it.
        nearest = pulled[-1].displacement - (ROWS_BEYOND_PEAK + 1) * contact.settings.increment()
        start = max(nearest, min(s.displacement for s in pulled))
        apart = separate(contact, start, -min(s.force for s in pulled))
        contact.finish()
        phases = contact.phases
    unloading = [*unloaded, *pulled, *apart]
    found = SmoothPass(phases, loading, unloading, unloaded[-1], pulled[-1], _peak(unloading), missed)
    return found, _peak([*unloaded, *pulled])


def _to_zero(contact: Contact, loading: list[State], tolerance: float) -> list[State]:
    """Down from F_D to F = 0, in increments of the search; the last state is the mark."""
    step, states = contact.settings.increment(), [loading[-1]]
    scale = contact.settings.estimate.pull_off_force()
    while states[-1].force > tolerance * scale:
        states.append(measured(contact, max(_zero([*loading, *states]), states[-1].displacement - step)))
        if len(states) > MOST_PULLS:
            raise UntrustedError("the force stays compressive: nothing holds the bodies together")
    if len(states) == 1:  # under next to no load the mark is where the loading has ended
        states.append(measured(contact, states[-1].displacement))
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


def _to_largest_tension(
    contact: Contact, unloaded: list[State], tolerance: float, through: bool
) -> tuple[list[State], float]:
    """Down from F = 0 past the largest tension and back to it, where the last state is. Also returns the miss [FU].

    Rows at half the distance are put on both sides of it until they leave it as it was, and, at most
    HALVINGS_AT_PEAK times more, until the contact radius there is known.
    """
    tooth = _tooth(contact.settings)
    step = _increment(contact, unloaded[-1].displacement, tooth)
    states = _pulled(contact, unloaded[-1], step, through or tooth < math.inf)
    expected, beside, cuts, changed = _peak([*unloaded, *states]), step, 0, math.inf
    for _ in range(MOST_CUTS):
        states += back_to(contact, states[-1], expected.position)
        found = _peak([*unloaded, *states])
        missed, allowed = abs(found.smooth - expected.smooth), tolerance * found.smooth
        if missed <= allowed and _near(states, found, tolerance):
            known = changed <= allowed and found.uncertainty <= allowed
            if known and (cuts > HALVINGS_AT_PEAK or _placed(states, found, tolerance)):
                before, left = len(states), _look_at_rivals(contact, unloaded, states, allowed)
                if len(states) == before:
                    return states, max(missed, changed, left, abs(found.smooth + states[-1].force))
                expected = _peak([*unloaded, *states])
                changed = max(changed, abs(expected.smooth - found.smooth))
                continue
            beside, cuts = 0.5 * beside, cuts + 1
            surprise = _halved(contact, unloaded, states, (found.position + beside, found.position - beside))
            expected = _peak([*unloaded, *states])
            changed = max(surprise, abs(expected.smooth - found.smooth))
        else:
            expected = found
    raise UntrustedError(f"the largest tension is not found near {expected.position:.6g} LU: {JUMPS}")


def _tooth(settings: Settings) -> float:
    """Least distance [LU] of two teeth of the tension, by the estimate."""
    return settings.estimate.tooth(settings.particles)


def _halved(contact: Contact, unloaded: list[State], states: list[State], places: tuple[float, float]) -> float:
    """Put rows at `places` [LU] beside the largest tension; by how much they are not what was promised there [FU]."""
    rows = _falling([*unloaded, *states])
    expected = promised([s.displacement for s in rows], [s.force for s in rows], places)
    surprise = 0.0
    for place, tension in zip(places, expected, strict=True):
        states += back_to(contact, states[-1], place)
        surprise = max(surprise, math.inf if math.isnan(tension) else abs(float(tension) + states[-1].force))
    return surprise


def _increment(contact: Contact, zero: float, tooth: float) -> float:
    """Increment [LU] from F = 0, at displacement `zero` [LU], on: that of a search, or less where teeth are denser."""
    estimate = contact.settings.estimate
    densest = (zero - estimate.rest + float(estimate.gap[-1])) / MOST_TEETH
    return min(contact.settings.increment(), max(tooth, densest) / PER_TOOTH)


def _pulled(contact: Contact, zero: State, step: float, through: bool) -> list[State]:
    """Rows down from F = 0 until ROWS_BEYOND_PEAK lie beyond the largest tension, `through`: all that may exceed it."""
    states: list[State] = []
    while not _passed([zero, *states]) or (
        through and -min(s.force for s in states) <= still_held(contact, states[-1])
    ):
        states.append(measured(contact, zero.displacement - (len(states) + 1) * step))
        if len(states) > MOST_PULLS:
            raise UntrustedError("the largest tension is never passed")
    return states


def _look_at_rivals(contact: Contact, unloaded: list[State], states: list[State], allowed: float) -> float:
    """Put rows beside the teeth that may be higher than the highest row by more than `allowed` [FU], until none may.

    Returns by how much one still may [FU].
    """
    excess = 0.0
    for _ in range(MOST_RIVALS):
        rows = _falling([*unloaded, *states])
        teeth = rivals([s.displacement for s in rows], [s.force for s in rows], _peak(rows))
        highest = max(teeth, key=lambda i: teeth[i], default=0)
        excess = max(0.0, teeth.get(highest, 0.0))
        if excess <= allowed:
            break
        at, beside = rows[highest].displacement, (rows[highest - 1].displacement, rows[highest + 1].displacement)
        for other in beside:
            states += back_to(contact, states[-1], 0.5 * (at + other))
    return excess


def _near(states: list[State], peak: Peak, tolerance: float) -> bool:
    """Whether the contact radius of the last state is that of the maximum."""
    return abs(critical_shift(states, states[-1], peak)) <= _allowed(states[-1], tolerance)


def _placed(states: list[State], peak: Peak, tolerance: float) -> bool:
    """Whether the maximum itself is placed so well that the contact radius there is known."""
    rate = abs(radius_rate(states, states[-1]))
    return PLACE_FACTOR * rate * peak.misplaced <= _allowed(states[-1], tolerance)


def _allowed(critical: State, tolerance: float) -> float:
    """Error [LU] that is left to the contact radius of the critical state."""
    radius = critical.radius_or_spot
    return max(tolerance * radius.value, LATTICE_SHARE * radius.uncertainty)


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
    largest = max(tension)
    return largest > 0.0 and tension.index(largest) < len(tension) - ROWS_BEYOND_PEAK


def _peak(states: list[State]) -> Peak:
    rows = _falling(states)
    return largest_tension([s.displacement for s in rows], [s.force for s in rows])


def _falling(states: list[State]) -> list[State]:
    """By falling displacement, each place once."""
    places = {s.displacement: s for s in states}
    return [places[d] for d in sorted(places, reverse=True)]
