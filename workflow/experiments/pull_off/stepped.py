"""Pull-off from a rigid plane: nothing has to come to rest, so that rows are many and known beforehand.

A contact that is held is in one state at each displacement, whatever the way to it. Rows lead down to F_D, to F = 0,
past the largest tension to just before fixed grips let go, back to the largest tension, and apart.
"""

from __future__ import annotations

import numpy as np

from contact1d.analysis.curve_marks import Peak, largest_tension, smooth_crossing
from contact1d.workflow.deck.steps import displacements
from contact1d.workflow.experiments.pull_off.smooth import MOST_TRIES, SmoothPass
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.prescribing import LOADING_STEPS, approach
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import DigitsError, UntrustedError, require_trust
from contact1d.workflow.settings.cells import CLOSER, LAST, PULLING_STEPS, pulling_rows

APART = 1.05
"""End of the way over where fixed grips let go."""


def stepped_pass(context: RunContext, preload: float, tolerance: float) -> SmoothPass:
    """The whole schedule; F = 0 is within `tolerance` of the largest tension.

    Raises:
        UntrustedError: see `require_trust`; F = 0 is not found.
    """
    with context.contact() as contact:
        estimate = contact.settings.estimate
        contact.begin("loading")
        loading = approach(contact, preload, 0.0)
        contact.begin("unloading")
        unloaded = _to_zero(contact, loading[-1].displacement, tolerance * estimate.pull_off_force())
        contact.write_state()
        contact.begin("pulling")
        zero, last = unloaded[-1].displacement, estimate.parted(0.0)
        pulled = _rows(contact, pulling_rows(zero, last))
        before = _peak([*unloaded, *pulled])
        step = (zero - last) / PULLING_STEPS
        beside = np.clip(before.position + step * np.asarray(CLOSER), pulled[-1].displacement, zero)
        pulled += _rows(contact, beside)
        contact.write_state()
        contact.begin("separating")
        apart = _rows(contact, np.linspace(pulled[-1].displacement, APART * last, LOADING_STEPS + 1)[1:])
        contact.finish()
        phases = contact.phases
    peak = _peak([*unloaded, *pulled])
    digits = pulled[-1].residual * contact.settings.particles
    if peak.smooth <= digits:
        raise DigitsError(
            f"the largest tension, about {estimate.pull_off_force():.2g} FU, is nothing beside {digits:.2g} FU, which "
            "the last digits of places make of the contact's force",
            "take a larger adhesion.work_of_adhesion, or a smaller preload",
        )
    unloading = [*unloaded, *pulled, *apart]
    return SmoothPass(phases, loading, unloading, unloaded[-1], pulled[-1], peak, abs(peak.smooth - before.smooth))


def _to_zero(contact: Contact, deepest: float, near: float) -> list[State]:
    """Rows up to where the estimate has F = 0, and on to where it is within `near` [FU]."""
    expected = contact.settings.estimate.displacement_at(0.0)
    states = _rows(contact, np.linspace(deepest, expected, LOADING_STEPS + 1)[1:])
    step = (deepest - expected) / LOADING_STEPS
    for _ in range(MOST_TRIES):
        if abs(states[-1].force) <= near:
            return states
        rows = sorted(states, key=lambda s: -s.displacement)
        try:
            place = smooth_crossing([s.displacement for s in rows], [s.force for s in rows], 0.0)
        except ValueError:
            place = min(s.displacement for s in states) - step
        states += _rows(contact, np.asarray([place]))
    raise UntrustedError(f"F = 0 is not found near {states[-1].displacement:.6g} LU: take a finer bodies.spacing")


def _rows(contact: Contact, places: np.ndarray) -> list[State]:
    states = contact.rows(displacements(places.tolist()))
    for state in states:
        require_trust(contact.scene, contact.settings, state)
    return states


def _peak(states: list[State]) -> Peak:
    """The largest tension by falling displacement; at the last place before fixed grips let go it is what it is."""
    places = {s.displacement: s for s in states}
    falling = [places[d] for d in sorted(places, reverse=True)]
    found = largest_tension([s.displacement for s in falling], [s.force for s in falling])
    if found.index < len(falling) - 1:
        return found
    return Peak(found.index, found.tension, LAST * found.tension, found.tension, found.position, 0.0)
