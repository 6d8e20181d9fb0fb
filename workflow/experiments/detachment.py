"""Pull-off under noise: the load is retracted at a steady rate until the bodies part, once for each seed, side by side.

The detachment force is the tension when the plate last leaves the position of the force maximum: it scatters, and
grows with the rate, since a slow pull waits longer for a fluctuation that separates the bodies.
"""

from __future__ import annotations

import math
import os
import shutil
import threading
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from contact1d.analysis.curve import DETACHMENTS, SAMPLE_TABLE
from contact1d.workflow.continuation.contact import BATCH
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import DrawnOff, Phase, Row, UnderLoad
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import LOG
from contact1d.workflow.experiments.series import Series, begun, measured, recorded
from contact1d.workflow.experiments.thermal import SETTLING_LOOKS, run_in, sample_columns
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Noise, PullOff, Scene
from contact1d.workflow.units import FORCE

INCREMENTS = 400
"""Load steps up to the force maximum of the predictor: the load is a staircase of so many steps."""
FEWEST_STEPS = 10
MOST_TENSION = 10.0
"""Tension over that of the predictor at which the bodies must have separated."""
BARRIER = 0.99
"""Share of the force maximum that has its position beyond the barrier."""
GONE, SURELY = 0.01, 50.0
"""Share of the force maximum that counts as zero, and the energy over k_BT that a plate would need to return."""
WAITING_STEPS = 800
"""Timesteps of load steps that go to LAMMPS together: waking two processes takes as long as a hundred of them."""
FOLDER = ".pulls"
"""Of the pulls with other seeds than the scene's, in the run folder, while they run."""
LAGGING = 0.1
"""Increase of the load while drag delays the separation, over F_A, from which on it is reported."""
FARTHEST = 1.1
"""Tension over that of the predictor at which a planned pull ends."""


@dataclass(frozen=True)
class Detachment:
    """How one pull ended.

    Attributes:
        force: the tension [FU] when the plate last left the position of the largest one.
        time: since the pull began [TU].
        phases: the schedule.
        states: of all load steps.
        held: the last one that was held.
    """

    force: float
    time: float
    phases: tuple[Phase, ...]
    states: tuple[State, ...]
    held: State


@dataclass(frozen=True)
class Ramp:
    """The load ramp: a staircase, of which each load step adds an increment to the load.

    With a spring the increment is that of its force on a plate at rest: its far end goes on by rise/spring.

    Attributes:
        steps, time: of a load step, the latter [TU].
        rise: increment [FU].
        largest: tension that the contact holds by the predictor [FU].
        barrier, gone: displacements beyond which it holds less, and next to nothing [LU].
        surely: energy that no fluctuation gives to the plate [FU·LU].
        spring: stiffness [FU/LU]; 0 where a load pulls.
        slack: displacement at which the spring is slack at the start [LU].
    """

    steps: int
    time: float
    rise: float
    largest: float
    barrier: float
    gone: float
    surely: float
    spring: float
    slack: float

    def row(self, number: int) -> Row:
        """The load step of that number, from 1 on."""
        if self.spring:
            return DrawnOff(self.spring, self.slack - number * self.rise / self.spring, self.steps)
        return UnderLoad(-number * self.rise, self.steps)

    def tension(self, number: float, place: float) -> float:
        """On a plate at a displacement [LU] after this number of load steps [FU]."""
        return number * self.rise - self.spring * (self.slack - place)

    def until(self, tension: float) -> int:
        """Load steps after which it is as large [FU] on a plate at the barrier."""
        return math.ceil((tension - self.tension(0.0, self.barrier)) / self.rise)

    @property
    def needed(self) -> float:
        """Work [FU·LU] that keeps a plate from coming back: more than heat and attraction give it on its path.

        The latter is F_A (d_A − d_0) at most, d_0 the position beyond which there is none.
        """
        return self.largest * (self.barrier - self.gone) + self.surely

    @property
    def most(self) -> int:
        """Load steps after which the bodies must have separated."""
        far = self.spring * (self.barrier - self.gone) + math.sqrt(2.0 * self.spring * self.needed)
        return self.until(MOST_TENSION * self.largest + 2.0 * far)

    def is_over(self, number: int, place: float) -> bool:
        """Whether a plate at a displacement [LU] cannot return: there is no attraction, and the load is tensile."""
        mean = 0.5 * (self.tension(number, self.barrier) + self.tension(number, place))
        return place < self.gone and mean * (self.barrier - place) > self.needed


def ramp_of(scene: Scene, settings: Settings, experiment: PullOff) -> Ramp:
    """The staircase: its steps are a share of the tension, or more where they would have too few timesteps."""
    estimate, step = settings.law, settings.motion.time_step
    spring = (experiment.stiffness or estimate.stiffness_under(0.0)) if experiment.draws_off else 0.0
    rate = experiment.loading_rate or spring * (experiment.velocity or 0.0)
    largest = estimate.pull_off_force()
    steps = max(FEWEST_STEPS, round(largest / INCREMENTS / rate / step))
    surely = SURELY * scene.temperature
    places = estimate.parted(BARRIER), estimate.parted(GONE)
    slack = estimate.displacement_at(0.0)
    return Ramp(steps, steps * step, rate * steps * step, largest, *places, surely, spring, slack)


def planned_detachment(scene: Scene, settings: Settings, experiment: PullOff) -> tuple[Phase, Phase, Phase]:
    """The schedule up to a tension that the predictor does not hold."""
    ramp = ramp_of(scene, settings, experiment)
    rows = tuple(ramp.row(number) for number in range(1, ramp.until(FARTHEST * ramp.largest) + 1))
    before = run_in("loading", settings, experiment.preload), run_in("settling", settings, 0.0)
    return *before, Phase("pulling", rows, state=True)


def pulls(context: RunContext, experiment: PullOff) -> list[Detachment]:
    """The pulls, with the scene's seed and those after it, `context.workers` of them at a time.

    The files of the run folder are those of the scene's own seed, and only its states are kept.

    Raises:
        EngineError, UntrustedError: of the first pull that failed; the log in the run folder is then its own.
    """
    count, stop = experiment.repeats or 1, threading.Event()
    if count == 1:
        return [_pull(context, experiment, stop)]
    context.progress.phase("pulling", count, "pull")
    with ThreadPoolExecutor(min(count, context.workers)) as executor:
        tasks = [executor.submit(_apart, context, experiment, number, stop) for number in range(count)]
        try:
            for task in as_completed(tasks):
                task.result()
                context.progress.advance(1)
        finally:
            stop.set()
            executor.shutdown(cancel_futures=True)
            shutil.rmtree(context.folder / FOLDER, ignore_errors=True)
    return [task.result() for task in tasks]


def _apart(context: RunContext, experiment: PullOff, number: int, stop: threading.Event) -> Detachment:
    """The pull of the seed that is `number` after the scene's, in a folder of its own."""
    scene, folder = context.deck.scene, context.folder / FOLDER / str(number) if number else context.folder
    noise = scene.the(Noise)
    seeded = scene.model_copy(update={"noise": noise.model_copy(update={"seed": noise.seed + number})})
    own = replace(context, deck=Deck(seeded, context.deck.settings), folder=folder, progress=Silent(), ranks=1)
    if number:
        folder.mkdir(parents=True, exist_ok=True)
        write_system(own.deck, folder)
    try:
        found = _pull(own, experiment, stop)
    except Exception:
        if not stop.is_set():
            context.phase, context.timestep = own.phase, own.timestep
            with suppress(OSError):
                os.replace(folder / LOG, context.folder / LOG)
        raise
    finally:
        context.add_time_of(own)
    return replace(found, phases=(), states=()) if number else found


def _pull(context: RunContext, experiment: PullOff, stop: threading.Event) -> Detachment:
    scene, settings = context.deck.scene, context.deck.settings
    ramp = ramp_of(scene, settings, experiment)
    *before, pulling = planned_detachment(scene, settings, experiment)
    with context.contact() as contact:
        states = [state for phase in before for state in contact.rows(begun(contact, phase), trusted=False)]
        require_trust(scene, settings, states[-1])
        if min(one.displacement for one in states) < ramp.gone:
            raise UntrustedError(
                "thermal fluctuations separate the bodies before the load decreases: use a lower noise.temperature, "
                "or a stronger interaction.attraction"
            )
        contact.begin(pulling.name, expected_steps=ramp.most * ramp.steps)
        settled, done = len(states), 0
        while not ramp.is_over(done, states[-1].displacement):
            if stop.is_set():
                raise UntrustedError("another repeat failed")
            if done == ramp.most:
                raise UntrustedError(
                    f"the bodies did not separate up to a tensile force of {ramp.tension(done, ramp.barrier):.4g} FU, "
                    f"more than {MOST_TENSION:g} times the predicted pull-off force: the load changes faster than they "
                    f"move. Use a smaller experiment.{'velocity' if ramp.spring else 'loading_rate'}"
                )
            at_once = min(BATCH, max(1, WAITING_STEPS // ramp.steps), ramp.most - done)
            states += contact.rows([ramp.row(done + i) for i in range(1, at_once + 1)], trusted=False)
            done += at_once
        contact.write_state()
        contact.finish()
    held = max((n for n, one in enumerate(states[settled:], 1) if one.displacement > ramp.barrier), default=0)
    force = ramp.tension(held + 0.5, ramp.barrier)
    return Detachment(force, (held + 0.5) * ramp.time, contact.phases, tuple(states), states[settled + held - 1])


def pull_off_thermal(context: RunContext, experiment: PullOff) -> Outcome:
    """Detachment force, mean and spread over the seeds, of a pull-off with [noise].

    Raises:
        UntrustedError: bodies that do not separate, or see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    found, ramp = pulls(context, experiment), ramp_of(scene, settings, experiment)
    seeds = scene.the(Noise).seed + np.arange(float(len(found)))
    each = Series({"seed": seeds} | recorded(found, ("force", "time")))

    def read(each: Series) -> dict[str, Reading]:
        """A force is known to be within a load step."""
        count, force = len(each), float(each.mean("force"))
        found = {"detachment_force": Reading(force, FORCE, {"sampling": ramp.rise / math.sqrt(12.0 * count)})}
        if count > 1:
            spread = float(each["force"].std(ddof=1))
            errors = {"statistics": spread / math.sqrt(2.0 * (count - 1))}
            found["detachment_force_spread"] = Reading(spread, FORCE, errors)
        return found

    states, own = found[0].states, found[0]
    loads = [experiment.preload] * SETTLING_LOOKS + [0.0] * SETTLING_LOOKS
    loads += [-ramp.tension(number, one.displacement) for number, one in enumerate(states[len(loads) :], 1)]
    tables = {DETACHMENTS: each.table(), SAMPLE_TABLE: sample_columns(states, loads, settings)}
    warnings = doubts(scene, settings, states) | _lagging(settings, ramp, experiment)
    return Outcome(measured(each, read), states, {"last_held": own.held}, own.phases, warnings, tables=tables)


def _lagging(settings: Settings, ramp: Ramp, experiment: PullOff) -> dict[str, str]:
    """A warning where the load grows by a share of F_A while drag Γ lets F_A move the plate by the range: Γ b Ḟ/F_A."""
    share = settings.drag() * settings.forces.range * ramp.rise / ramp.time / ramp.largest**2
    if share < LAGGING:
        return {}
    key, unit = ("velocity", "LU/TU") if ramp.spring else ("loading_rate", "FU/TU")
    given = experiment.velocity or experiment.loading_rate or 0.0
    return {
        "lagging": (
            f"viscous drag delays the separation, and the load meanwhile grows by {share:.2g} of the pull-off force: "
            f"detachment_force contains drag. Use an experiment.{key} below {given * LAGGING / share:.2g} {unit} "
            "to avoid it"
        )
    }
