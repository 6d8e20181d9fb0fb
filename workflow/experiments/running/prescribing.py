"""Prescribed displacement: approach a force from below, and unload until the bodies separate."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace, displacements
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import TensionError, ThroughError, UntrustedError, require_trust
from contact1d.workflow.settings.settings import Settings

MOST_INCREMENTS = 10_000
"""Rows of one branch of a search; a search that needs more has no end in sight."""
SEPARATION_ROWS = 1_000.0
"""Rows in which an unloading comes from any displacement to where nothing is felt any more."""
FORCE_ACCURACY = 1e-3
"""How near to a wanted force a search must come, over the tolerance."""
SEPARATION_SHARE = 0.02
"""Tension over the largest one at which bodies that move apart count as separated."""
GROWTH_SHARE = 0.5
"""Tension over the largest one below which increments may grow."""
GROWTH, SMOOTH_GROWTH = 1.2, 1.6
OVERSHOOT = 1.02
"""Secant steps aim a little beyond, so that a bracket forms instead of a slow approach from one side."""
RETURN_SHARE = 0.5
"""Move of a search that comes back to where the bodies have been, over their particles' smallest distance."""
SAME_PLACE = 1e-12
"""Displacements nearer than this over the spacing are the same place: a force that still differs has jumped."""
EXPECTED = 1.02
"""End of the rows that are known beforehand over the displacement that the estimate has for the force."""
LOADING_STEPS = 24
"""Rows of a planned way down, where a run would search, and of one that needs no search."""
CURVE_STEPS, CURVE_NUMBERS = 100, 200_000
"""Increments of a load where rows are steps of one run, for the sake of its curve: they cost some tens of microseconds
each. Of long chains there are so many that places times rows stay below the second."""
RETRY_SHARES = (1 / 4, 1 / 16)
"""Parts of the increments that are tried where bodies went through each other: a body that moves by much of its
particles' distance from the opposite ones, or by which their force changes much, lets the minimiser put one beyond.
Where pairs snap together a minimiser moves particles by more than their distance whatever the increment: a relaxation
then goes downhill in short moves. In time it is a load applied at once that drives a plate past its place, and what a
snap sets free that drives a particle through its opposite: loads then come in such parts, and drag takes it up."""


def in_smaller_steps(search: Callable[[RunContext], Outcome]) -> Callable[[RunContext], Outcome]:
    """The same search, which begins anew in smaller steps where the bodies went through each other.

    The context's deck is then the one with these steps: it is what in.lammps must hold.

    Raises:
        ThroughError: they do so in the smallest steps, too, so that it is the load and not the way there.
    """

    def searched(context: RunContext) -> Outcome:
        deck = context.deck
        try:
            return search(context)
        except ThroughError as error:
            if deck.scene.noise is not None or not context.retries:  # it is the noise that drives particles through
                raise
            latest = error
        for part in RETRY_SHARES:
            context.progress.note(f"the bodies went through each other: again from the start in steps of {part:g}")
            context.deck = Deck(deck.scene, deck.settings.in_smaller_steps(part))
            try:
                return search(context)
            except ThroughError as error:
                latest = error
        context.deck = deck
        smaller = f"Steps {1 / RETRY_SHARES[-1]:g} times smaller did not help"
        raise ThroughError(f"{latest.message}. {smaller}", latest.advice)

    return searched


def curve_steps(settings: Settings) -> int:
    """Increments of a load's curve where rows are steps of one run."""
    return max(LOADING_STEPS, min(CURVE_STEPS, CURVE_NUMBERS // settings.particles))


def approach(
    contact: Contact, force: float, start: float, direction: int = 1, steps: int = LOADING_STEPS
) -> list[State]:
    """Rows of growing displacement (direction 1; falling: −1) from `start` [LU] until the force is `force` [FU].

    Increments are those of the settings at most and follow the secant of the last two rows near the end. The last
    state's force is within FORCE_ACCURACY·tolerance of the wanted one. Where rows are steps of one run, the way to the
    place where the force is expected has `steps` of them.

    Raises:
        UntrustedError: see `require_trust`; also where the wanted force cannot be held.
    """
    scale, falls = max(abs(force), contact.settings.force_scale), direction == -1
    near, spacing = FORCE_ACCURACY * contact.settings.tolerance * scale, contact.scene.bodies.spacing
    states = _first(contact, start, force, direction, steps)
    before, beyond = _around(states, force, direction)
    while abs(states[-1].carried - force) > near:
        last = states[-1]
        if direction * (last.carried - force) > 0:
            beyond = last
        else:
            before = last
        if before is None:
            raise UntrustedError(
                f"{force:.4g} FU cannot be approached: the force starts at {last.carried:.4g} FU, "
                f"{'below' if falls else 'above'} it already. Take a force beyond that, or "
                'kind = "path" to see the curve'
            )
        if beyond is not None and abs(beyond.displacement - before.displacement) < SAME_PLACE * spacing:
            raise UntrustedError(
                f"the force jumps past {force:.4g} FU at displacement {before.displacement:.6g} LU, from "
                f"{before.carried:.4g} to {beyond.carried:.4g} FU: particles snap or slip there, and no state on this "
                'way has the force. Take a force outside of the jump, kind = "path" to see all of it, or stiffer '
                "springs or a longer range, with which particles do not snap"
            )
        if falls and last.smallest_distance > contact.settings.cutoff:
            most = max(-state.force for state in states)
            raise TensionError(force, most)
        if len(states) > MOST_INCREMENTS:
            raise UntrustedError(
                f"{force:.4g} FU is not reached within {MOST_INCREMENTS} increments, at displacement "
                f"{last.displacement:.4g} LU and {last.carried:.4g} FU: the ranges of the interaction are short beside "
                "the way. Take a force that is nearer to 0, longer ranges or stiffer springs"
            )
        step = contact.settings.increment(math.inf if falls else last.smallest_distance)
        states.append(measured(contact, _next(before, beyond, states, force, direction * step)))
    return states


def _first(contact: Contact, start: float, force: float, direction: int, steps: int) -> list[State]:
    """The first rows of a way: where nothing has to come to rest, in one run past where the force is expected.

    Raises:
        UntrustedError: see `require_trust`; also where no contact holds the force.
    """
    if not contact.deck.stepped:
        return [measured(contact, start)]
    settings = contact.settings
    expected, held = (
        settings.estimate.displacement_at(force),
        settings.estimate.parted(0.0) if force < 0.0 else -math.inf,
    )
    end = max(start + EXPECTED * (expected - start), 0.5 * (expected + held))
    if direction * (end - start) <= 0.0:
        return [measured(contact, start)]
    states = contact.rows(displacements(np.linspace(start, end, steps + 1).tolist()))
    for state in states:
        require_trust(contact.scene, settings, state)
    if direction == -1 and min(state.carried for state in states) > force:
        most = settings.estimate.pull_off_force()
        raise TensionError(force, most)
    return states


def _around(states: list[State], force: float, direction: int) -> tuple[State | None, State | None]:
    """Of states on a way the last that is short of the force, and the one after it; None for none."""
    if len(states) == 1:
        return None, None
    short = [i for i, state in enumerate(states) if direction * (state.carried - force) <= 0.0]
    last = short[-1] if short else -1
    return states[last] if short else None, states[last + 1] if last + 1 < len(states) else None


def _next(before: State, beyond: State | None, states: list[State], force: float, step: float) -> float:
    """The secant's place, kept inside the bracket or within one step."""
    if beyond is not None:
        part = (force - before.carried) / (beyond.carried - before.carried)
        return before.displacement + min(max(part, 0.05), 0.95) * (beyond.displacement - before.displacement)
    ahead = 1.0
    if len(states) > 1 and states[-1].carried != states[-2].carried:
        slope = (states[-1].carried - states[-2].carried) / (states[-1].displacement - states[-2].displacement)
        needed = OVERSHOOT * (force - before.carried) / slope / step
        ahead = min(1.0, needed) if needed > 0 else 1.0
    return before.displacement + ahead * step


def separate(contact: Contact, start: float, largest: float = 0.0) -> list[State]:
    """Rows of falling displacement from `start` [LU] until the tension has passed its largest value and is gone.

    `largest` is what the tension has been before [FU].
    """
    displacement, states = start, [measured(contact, start)]
    step = unloading_step(contact.settings, start)
    growth = SMOOTH_GROWTH if contact.settings.is_smooth else GROWTH
    for _ in range(MOST_INCREMENTS):
        displacement -= step
        state = measured(contact, displacement)
        states.append(state)
        largest = max(largest, -state.force)
        past = 0.0 <= -state.force < GROWTH_SHARE * largest
        if past and (contact.settings.is_smooth or still_held(contact, state) < largest):
            step *= growth  # longer moves let go of particles early: only where no tooth can be higher any more
        if _apart(contact, state, largest):
            return states
    raise UntrustedError(f"the bodies did not separate within {MOST_INCREMENTS} increments of the displacement")


def unloading_step(settings: Settings, start: float) -> float:
    """First increment [LU] of an unloading from `start` [LU]: that of a search, the bodies apart in SEPARATION_ROWS.

    Soft springs follow the attraction far beyond what the bodies were pressed together.
    """
    way = start - settings.rest + float(settings.estimate.gap[-1])
    return max(settings.increment(), way / SEPARATION_ROWS)


def still_held(contact: Contact, state: State) -> float:
    """Tension [FU] that bodies which move apart can have at most from this state on.

    A particle that has passed the largest tension of its law only loses what it has; any other, wherever it is, may
    come to hold that.
    """
    profile, (distance, largest) = state.profile, contact.settings.strongest
    held = contact.scene.bodies.spacing * np.maximum(0.0, -profile.pressure)
    near = profile.z_upper - profile.z_lower < distance
    return float(np.sum(np.where(near, np.maximum(held, largest), held)))


def _apart(contact: Contact, state: State, largest: float) -> bool:
    """Whether the bodies are out of reach, or can't hold more than a small part of the largest tension any more.

    Where particles snap, the force passes 0 between one that lets go and the next.
    """
    gone = abs(state.force) < SEPARATION_SHARE * largest and still_held(contact, state) < SEPARATION_SHARE * largest
    return gone or state.smallest_distance > contact.settings.cutoff


def back_to(contact: Contact, last: State, displacement: float) -> list[State]:
    """The state at a displacement [LU] after those that the way there needs from the `last` one.

    Bodies that come nearer do so by RETURN_SHARE of their particles' smallest distance at a time.
    """
    states = [last]
    while displacement - states[-1].displacement > (longest := RETURN_SHARE * states[-1].smallest_distance):
        longest = max(longest, contact.settings.longest_move)
        states.append(measured(contact, min(states[-1].displacement + longest, displacement)))
    return [*states[1:], measured(contact, displacement)]


def measured(contact: Contact, displacement: float) -> State:
    """One row at a displacement [LU]. Raises UntrustedError, see `require_trust`."""
    state = contact.row(Displace(displacement))
    require_trust(contact.scene, contact.settings, state)
    return state
