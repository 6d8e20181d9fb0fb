"""Pull-off under heat: the load is drawn off at a steady rate until the bodies part, once for each seed.

The detachment force is the tension when the plate last leaves the place of the largest tension: it scatters, and grows
with the rate, since a slow pull waits longer for a fluctuation that lets go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps
from contact1d.workflow.experiments.running.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.scene import PullOff, Scene
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import FORCE, Quantity

INCREMENTS = 400
"""Rows on the way to the largest tension of the estimate: the load is a staircase of so many steps."""
FEWEST_STEPS = 10
MOST_TENSION = 3.0
"""Tension over that of the estimate at which the bodies must have parted."""
BARRIER = 0.99
"""Share of the largest tension that has its place beyond the barrier."""


@dataclass(frozen=True)
class Detachment:
    """How one pull ended: seed, tension [FU] and time since the pull began [TU]; the schedule and its states."""

    seed: int
    force: float
    time: float
    phases: tuple[Phase, ...]
    states: tuple[State, ...]


def pull_off_thermal(context: RunContext) -> Outcome:
    """Detachment force, mean and spread over the seeds, of a pull-off with [noise].

    Raises:
        UntrustedError: bodies that do not part, or see `require_trust`.
    """
    deck = context.deck
    scene, settings = deck.scene, deck.settings
    experiment, noise = scene.experiment, scene.noise
    assert isinstance(experiment, PullOff)
    assert noise is not None
    count = experiment.repeats or 1
    found = []
    for number in reversed(range(count)):  # the scene's own seed last, so that the folder is that of its deck
        seeded = scene.model_copy(update={"noise": noise.model_copy(update={"seed": noise.seed + number})})
        context.deck = Deck(seeded, settings) if number else deck
        found.append(_detachment(context, f"pull {count - number} of {count}"))
    found.reverse()
    forces = np.asarray([one.force for one in found])
    step = rise(scene, settings) / math.sqrt(12.0)
    spread = float(forces.std(ddof=1)) if count > 1 else math.nan
    quantities = {}
    if count > 1:
        error = math.hypot(spread / math.sqrt(count), step / math.sqrt(count))
        quantities["detachment_force_spread"] = Quantity(spread, spread / math.sqrt(2.0 * (count - 1)), FORCE)
    else:
        error = float(abs(forces[0]))  # one pull says nothing of how they scatter
    quantities = {"detachment_force": Quantity(float(forces.mean()), error, FORCE)} | quantities
    own = found[0]
    return Outcome(
        quantities,
        own.states,
        {"last_held": own.states[-1].profile},
        {"last_held": math.nan},
        own.phases,
        doubts(scene, settings, own.states),
        tables={
            "detachments": {
                "seed": tuple(float(one.seed) for one in found),
                "force": tuple(one.force for one in found),
                "time": tuple(one.time for one in found),
            }
        },
    )


def rise(scene: Scene, settings: Settings) -> float:
    """Step [FU] of the staircase: a share of the tension, or more where a step would have too few timesteps."""
    assert isinstance(scene.experiment, PullOff)
    assert scene.experiment.loading_rate is not None
    least = scene.experiment.loading_rate * FEWEST_STEPS * settings.time_step
    return max(settings.estimate.pull_off_force() / INCREMENTS, least)


def row_steps(scene: Scene, settings: Settings) -> int:
    """Timesteps of a step of the staircase."""
    assert isinstance(scene.experiment, PullOff)
    assert scene.experiment.loading_rate is not None
    return max(FEWEST_STEPS, round(rise(scene, settings) / scene.experiment.loading_rate / settings.time_step))


def _detachment(context: RunContext, purpose: str) -> Detachment:
    scene, settings = context.deck.scene, context.deck.settings
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    assert scene.noise is not None
    assert experiment.loading_rate is not None
    steps, look = row_steps(scene, settings), chunk_steps(settings)
    step = experiment.loading_rate * steps * settings.time_step
    most = math.ceil(MOST_TENSION * settings.estimate.pull_off_force() / step)
    barrier, apart = settings.estimate.parted(BARRIER), settings.rest - settings.cutoff
    with context.contact(purpose) as contact:
        states = []
        for name, load in (("loading", experiment.preload), ("settling", 0.0)):
            contact.begin(name, expected_steps=SETTLING_LOOKS * look)
            states += [contact.row(UnderLoad(load, look)) for _ in range(SETTLING_LOOKS)]
        require_trust(scene, settings, states[-1])
        contact.begin("pulling", expected_steps=most * steps)
        start, held = states[-1].step, 0
        for number in range(1, most + 1):
            state = contact.row(UnderLoad(-number * step, steps))
            states.append(state)
            if state.displacement > barrier:
                held = number
            if state.displacement < apart or state.smallest_distance > settings.cutoff:
                break
        else:
            raise UntrustedError(
                f"the bodies did not part up to a tension of {most * step:.4g} FU, {MOST_TENSION:g} times what holds "
                "them by the estimate: they were pulled faster than they move. Take a smaller experiment.loading_rate"
            )
        contact.write_state()
        contact.finish()
    last = states[-1]
    time = (states[-1 - (number - held)].step - start) * settings.time_step
    return Detachment(scene.noise.seed, (held + 0.5) * step, time, contact.phases, (*states[:-1], last))


def planned_thermal(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule up to a tension that the estimate does not hold."""
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    assert experiment.loading_rate is not None
    steps, look = row_steps(scene, settings), chunk_steps(settings)
    step = experiment.loading_rate * steps * settings.time_step
    rows = math.ceil(1.1 * settings.estimate.pull_off_force() / step)
    return (
        Phase("loading", (UnderLoad(experiment.preload, look),) * SETTLING_LOOKS),
        Phase("settling", (UnderLoad(0.0, look),) * SETTLING_LOOKS),
        Phase("pulling", tuple(UnderLoad(-n * step, steps) for n in range(1, rows + 1)), state=True),
    )
