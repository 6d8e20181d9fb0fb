"""Pull-off under noise: the load is retracted at a steady rate until the bodies part, once for each seed, side by side.

The detachment force is the tension when the plate last leaves the position of the force maximum: it scatters, and
grows with the rate, since a slow pull waits longer for a fluctuation that separates the bodies.

Displacements d [LU] are positive in compression, tensions [FU] in tension.
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
from contact1d.workflow.continuation.trust import doubts, require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import DrawnOff, Phase, Row, UnderLoad
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import LOG
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.experiments.series import Series, measured, recorded
from contact1d.workflow.experiments.thermal import RUN_IN_SAMPLES, run_in, sample_columns
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Noise, PullOff, Scene
from contact1d.workflow.units import FORCE

MOST_TENSION = 10.0
"""Tension over the predicted pull-off force at which the bodies must have separated."""
FOLDER = ".pulls"
"""Subfolder of the run folder for the pulls with other seeds than the scene's, while they run."""


@dataclass(frozen=True)
class Detachment:
    """Force, time and states of one pull up to the separation.

    Attributes:
        force: tension [FU], positive, when the plate last left the position of the force maximum.
        time: time since the pull began [TU], until then.
        phases: the schedule; empty but for the scene's own seed.
        states: the states of all load steps; empty but for the scene's own seed.
        held: the last state before the separation.
    """

    force: float
    time: float
    phases: tuple[Phase, ...]
    states: tuple[State, ...]
    held: State


@dataclass(frozen=True)
class Ramp:
    """The load ramp: a staircase, of which each load step adds an increment to the tension.

    With a spring the increment is that of its force on a plate at rest: its far end moves by rise/spring.

    Attributes:
        steps, time: timesteps and duration [TU] of a load step.
        rise: increment of the tension [FU], positive.
        largest: pull-off force F_A of the predictor [FU].
        barrier, separated: displacements below which the tension is less than 99 % and 1 % of F_A [LU].
        escape_energy: energy that no thermal fluctuation gives to the plate [FU·LU].
        spring: stiffness [FU/LU]; 0 where a load pulls.
        slack: displacement at which the spring is slack at the start [LU].
    """

    steps: int
    time: float
    rise: float
    largest: float
    barrier: float
    separated: float
    escape_energy: float
    spring: float
    slack: float

    def row(self, number: int) -> Row:
        """Return the load step of a number, counted from 1: `DrawnOff` by the spring, or without one `UnderLoad`.

        The tension on a plate that stays where it began is then `number` increments.
        """
        if self.spring:
            return DrawnOff(self.spring, self.slack - number * self.rise / self.spring, self.steps)
        return UnderLoad(-number * self.rise, self.steps)

    def tension(self, number: float, displacement: float) -> float:
        """Return the tension [FU], compression negative, on a plate at a displacement [LU] after `number` load steps.

        Without a spring it does not depend on the displacement; the number may be a fraction.
        """
        return number * self.rise - self.spring * (self.slack - displacement)

    def until(self, tension: float) -> int:
        """Return the number of load steps after which a plate at the barrier feels a tension [FU], rounded up.

        `barrier` is the displacement beyond the force maximum. 0 or less where it feels that from the start.
        """
        return math.ceil((tension - self.tension(0.0, self.barrier)) / self.rise)

    @property
    def escape_work(self) -> float:
        """Work [FU·LU] ≥ 0 of the load after which a plate cannot come back: more than fluctuations and attraction do.

        The attraction does F_A (d_A − d_0) at most, d_A the displacement of the barrier and d_0 the one below which the
        tension is next to 0.
        """
        return self.largest * (self.barrier - self.separated) + self.escape_energy

    @property
    def most(self) -> int:
        """Number of load steps after which the bodies must have separated.

        A plate at the barrier then feels ten times the pull-off force, and more with a spring, which slackens as the
        plate moves away.
        """
        far = self.spring * (self.barrier - self.separated) + math.sqrt(2.0 * self.spring * self.escape_work)
        return self.until(MOST_TENSION * self.largest + 2.0 * far)

    def has_separated(self, number: int, displacement: float) -> bool:
        """Return whether a plate at a displacement [LU] after `number` load steps cannot return.

        There is next to no attraction, and the load did more work than `escape_work` since the plate passed the
        barrier.
        """
        mean = 0.5 * (self.tension(number, self.barrier) + self.tension(number, displacement))
        return displacement < self.separated and mean * (self.barrier - displacement) > self.escape_work


def load_ramp(scene: Scene, settings: Settings, experiment: PullOff, increments: int = 400) -> Ramp:
    """Return the load ramp of a pull-off under noise: by a spring where the scene gives a velocity, else by a load.

    The spring has the stiffness of the scene, or that of the contact at F = 0; the tension rises at that times the
    velocity, or at the scene's loading rate. The ramp has `increments` load steps up to the predicted pull-off force,
    or fewer where each would have less than 10 timesteps.
    """
    estimate, step = settings.law, settings.motion.time_step
    spring = (experiment.stiffness or estimate.stiffness_under(0.0)) if experiment.is_retracted else 0.0
    rate = experiment.loading_rate or spring * (experiment.velocity or 0.0)
    largest = estimate.pull_off_force()
    steps = max(10, round(largest / increments / rate / step))
    escape_energy = 50.0 * scene.temperature  # a fluctuation of 50 k_BT has a probability of e⁻⁵⁰
    barrier, separated = estimate.parted(0.99), estimate.parted(0.01)  # with 99 % and 1 % of the force maximum
    slack = estimate.displacement_at(0.0)
    return Ramp(steps, steps * step, rate * steps * step, largest, barrier, separated, escape_energy, spring, slack)


def planned_detachment(scene: Scene, settings: Settings, experiment: PullOff) -> tuple[Phase, Phase, Phase]:
    """Return the planned phases "loading" under the preload, "settling" without a load, and "pulling".

    The first two have 40 load steps each, the last one is a ramp up to 1.1 times the predicted pull-off force; a run
    goes on until the bodies separate.
    """
    ramp = load_ramp(scene, settings, experiment)
    rows = tuple(ramp.row(number) for number in range(1, ramp.until(1.1 * ramp.largest) + 1))
    before = run_in("loading", settings, experiment.preload), run_in("settling", settings, 0.0)
    return *before, Phase("pulling", rows, state=True)


def run_pulls(context: RunContext, experiment: PullOff) -> list[Detachment]:
    """Run the pulls with the scene's seed and the seeds after it, and return their detachments in this order.

    `context.workers` of them run at a time. The files of the run folder belong to the pull with the scene's seed, and
    only its states and schedule are kept.

    Raises:
        EngineError, UntrustedError: the first pull that failed; its log is then in the run folder.
    """
    count, stop = experiment.repeats or 1, threading.Event()
    if count == 1:
        return [_pull(context, experiment, stop)]
    context.progress.phase("pulling", count, "pull")
    with ThreadPoolExecutor(min(count, context.workers)) as executor:
        tasks = [executor.submit(_seeded_pull, context, experiment, number, stop) for number in range(count)]
        try:
            for task in as_completed(tasks):
                task.result()
                context.progress.advance(1)
        finally:
            stop.set()
            executor.shutdown(cancel_futures=True)
            shutil.rmtree(context.folder / FOLDER, ignore_errors=True)
    return [task.result() for task in tasks]


def _seeded_pull(context: RunContext, experiment: PullOff, number: int, stop: threading.Event) -> Detachment:
    """Run the pull whose seed is `number` after the scene's, in a separate folder, and return its detachment.

    Number 0 is run in the run folder; all others return no states and no schedule. Any error is raised again; its log
    is moved to the run folder before, unless `stop` is set.
    """
    scene, folder = context.deck.scene, context.folder / FOLDER / str(number) if number else context.folder
    noise = scene.the(Noise)
    seeded = scene.model_copy(update={"noise": noise.model_copy(update={"seed": noise.seed + number})})
    repeat = replace(context, deck=Deck(seeded, context.deck.settings), folder=folder, progress=Silent(), ranks=1)
    if number:
        folder.mkdir(parents=True, exist_ok=True)
        write_system(repeat.deck, folder)
    try:
        detachment = _pull(repeat, experiment, stop)
    except Exception:
        if not stop.is_set():
            context.phase, context.timestep = repeat.phase, repeat.timestep
            with suppress(OSError):
                os.replace(folder / LOG, context.folder / LOG)
        raise
    finally:
        context.clock.add(repeat.clock.times)
    return replace(detachment, phases=(), states=()) if number else detachment


def _pull(context: RunContext, experiment: PullOff, stop: threading.Event) -> Detachment:
    """Run one pull in the context's folder until the bodies separate, and return its detachment.

    The detachment force is the tension at the barrier half a load step after the last state that has not passed it.

    Raises:
        UntrustedError: the bodies separate before the pull, or not at ten times the predicted pull-off force; before
            the pull they have passed through each other, or their contact reaches the end of its chain; or `stop` is
            set.
        EngineError: LAMMPS failed.
    """
    scene, settings = context.inputs
    ramp = load_ramp(scene, settings, experiment)
    *before, pulling = planned_detachment(scene, settings, experiment)
    with context.contact() as contact:
        states = [state for phase in before for state in contact.rows(contact.begin_phase(phase), trusted=False)]
        require_trust(scene, settings, states[-1])
        if min(state.displacement for state in states) < ramp.separated:
            raise UntrustedError(
                "thermal fluctuations separate the bodies before the load decreases: use a lower noise.temperature, "
                "or a stronger interaction.attraction"
            )
        contact.begin(pulling.name, expected_steps=ramp.most * ramp.steps)
        settled, done = len(states), 0
        while not ramp.has_separated(done, states[-1].displacement):
            if stop.is_set():
                raise UntrustedError("another repeat failed")
            if done == ramp.most:
                raise UntrustedError(
                    f"the bodies did not separate up to a tensile force of {ramp.tension(done, ramp.barrier):.4g} FU, "
                    f"more than {MOST_TENSION:g} times the predicted pull-off force: the load changes faster than they "
                    f"move. Use a smaller experiment.{'velocity' if ramp.spring else 'loading_rate'}"
                )
            # 800 timesteps go to LAMMPS together: waking two processes takes as long as a hundred of them.
            at_once = min(BATCH, max(1, 800 // ramp.steps), ramp.most - done)
            states += contact.rows([ramp.row(done + i) for i in range(1, at_once + 1)], trusted=False)
            done += at_once
        contact.write_state()
        contact.finish()
    held = max((n for n, state in enumerate(states[settled:], 1) if state.displacement > ramp.barrier), default=0)
    force = ramp.tension(held + 0.5, ramp.barrier)
    return Detachment(force, (held + 0.5) * ramp.time, contact.phases, tuple(states), states[settled + held - 1])


def pull_off_thermal(context: RunContext, experiment: PullOff) -> Outcome:
    """Run the pulls of a pull-off with [noise] and return their outcome: "detachment_force" [FU], a mean over seeds.

    It is a positive tension. Of several pulls there is also their standard deviation, "detachment_force_spread" [FU].
    The table "detachments" has seed, force [FU] and time [TU] of each pull, "samples" the states of the first one,
    whose last state before the separation is marked "last_held".

    Raises:
        UntrustedError: the bodies separate before the pull or not at all, or have passed through each other before it,
            or the contact then reaches the end of its chain.
        EngineError: LAMMPS failed.
    """
    scene, settings = context.inputs
    detachments, ramp = run_pulls(context, experiment), load_ramp(scene, settings, experiment)
    seeds = scene.the(Noise).seed + np.arange(float(len(detachments)))
    series = Series({"seed": seeds} | recorded(detachments, ("force", "time")))

    def read(series: Series) -> dict[str, Reading]:
        """Return mean and, of several pulls, standard deviation of the detachment forces [FU], by name, with errors.

        Each force is uniformly distributed in a load step: that is the sampling error of the mean.
        """
        count, force = len(series), float(series.mean("force"))
        results = {"detachment_force": Reading(force, FORCE, {"sampling": ramp.rise / math.sqrt(12.0 * count)})}
        if count > 1:
            spread = float(series["force"].std(ddof=1))
            errors = {"statistics": spread / math.sqrt(2.0 * (count - 1))}
            results["detachment_force_spread"] = Reading(spread, FORCE, errors)
        return results

    first = detachments[0]
    states = first.states
    loads = [experiment.preload] * RUN_IN_SAMPLES + [0.0] * RUN_IN_SAMPLES
    loads += [-ramp.tension(number, state.displacement) for number, state in enumerate(states[len(loads) :], 1)]
    tables = {DETACHMENTS: series.table(), SAMPLE_TABLE: sample_columns(states, loads, settings)}
    warnings = doubts(scene, settings, states) | _lagging(settings, ramp, experiment)
    return Outcome(measured(series, read), states, {"last_held": first.held}, first.phases, warnings, tables=tables)


def _lagging(settings: Settings, ramp: Ramp, experiment: PullOff, most: float = 0.1) -> dict[str, str]:
    """Return {"lagging": warning} where drag delays the separation while the load rises by `most` F_A or more, else {}.

    With a drag Γ, F_A moves the plate by the range b in a time Γ b/F_A.
    """
    share = settings.drag() * settings.forces.range * ramp.rise / ramp.time / ramp.largest**2
    if share < most:
        return {}
    key, unit = ("velocity", "LU/TU") if ramp.spring else ("loading_rate", "FU/TU")
    given = experiment.velocity or experiment.loading_rate or 0.0
    return {
        "lagging": (
            f"viscous drag delays the separation, and the load meanwhile grows by {share:.2g} of the pull-off force: "
            f"detachment_force contains drag. Use an experiment.{key} below {given * most / share:.2g} {unit} "
            "to avoid it"
        )
    }
