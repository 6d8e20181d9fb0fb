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
from contact1d.workflow.continuation.outcome import Outcome, Result
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import DrawnOff, Phase, Row, UnderLoad
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import LOG
from contact1d.workflow.experiments.thermal import SETTLING_LOOKS, chunk_steps, sample_columns
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import PullOff, Scene
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
        seed: of its heat.
        force: the tension [FU] when the plate last left the position of the largest one.
        time: since the pull began [TU].
        phases: the schedule.
        states: of all load steps, none where only the numbers are kept.
        held: index of the last one that was held.
    """

    seed: int
    force: float
    time: float
    phases: tuple[Phase, ...]
    states: tuple[State, ...]
    held: int


@dataclass(frozen=True)
class Ramp:
    """The load ramp: `steps` timesteps in each load step, an increment `rise` [FU], up to load step `most`.

    With a `spring` [FU/LU], slack at the displacement `slack` [LU], its far end goes on by rise/spring.
    """

    steps: int
    rise: float
    most: int
    spring: float = 0.0
    slack: float = 0.0

    def row(self, number: int) -> Row:
        """The load step of that number, from 1 on."""
        if self.spring:
            return DrawnOff(self.spring, self.slack - number * self.rise / self.spring, self.steps)
        return UnderLoad(-number * self.rise, self.steps)

    def tension(self, number: float, place: float) -> float:
        """On a plate at a displacement [LU] after this number of load steps [FU]."""
        return number * self.rise - (self.spring * (self.slack - place) if self.spring else 0.0)

    def until(self, tension: float, place: float) -> int:
        """Load steps after which it is as large [FU] on a plate at that displacement [LU]."""
        return math.ceil((tension - self.tension(0.0, place)) / self.rise)

    def work(self, number: float, place: float, barrier: float) -> float:
        """Work to move the plate from a displacement back to the barrier, or gained on that path [FU·LU]."""
        return 0.5 * (self.tension(number, barrier) + self.tension(number, place)) * (barrier - place)


def spring_of(scene: Scene, settings: Settings) -> float:
    """Of the spring that retracts the plate [FU/LU]; 0 where a load does."""
    assert isinstance(scene.experiment, PullOff)
    if scene.experiment.velocity is None:
        return 0.0
    return scene.experiment.stiffness or settings.estimate.stiffness_under(0.0)


def rate_of(scene: Scene, settings: Settings) -> float:
    """At which the load grows, or that of the spring on a plate at rest [FU/TU]."""
    assert isinstance(scene.experiment, PullOff)
    if scene.experiment.velocity is not None:
        return scene.experiment.velocity * spring_of(scene, settings)
    assert scene.experiment.loading_rate is not None
    return scene.experiment.loading_rate


def ramp_of(scene: Scene, settings: Settings) -> Ramp:
    """The staircase: its steps are a share of the tension, or more where they would have too few timesteps."""
    estimate, spring = settings.estimate, spring_of(scene, settings)
    rate, tension = rate_of(scene, settings), settings.estimate.pull_off_force()
    wanted = max(tension / INCREMENTS, rate * FEWEST_STEPS * settings.motion.time_step)
    steps = max(FEWEST_STEPS, round(wanted / rate / settings.motion.time_step))
    slack = estimate.displacement_at(0.0) if spring else 0.0
    ramp = Ramp(steps, rate * steps * settings.motion.time_step, 0, spring, slack)
    barrier, none = estimate.parted(BARRIER), estimate.parted(GONE)
    far = spring * (barrier - none) + math.sqrt(2.0 * spring * _needed(scene, settings))
    return replace(ramp, most=ramp.until(MOST_TENSION * tension + 2.0 * far, barrier))


def pulls(context: RunContext, count: int) -> list[Detachment]:
    """So many pulls, with the scene's seed and those after it, `context.workers` of them at a time.

    The files of the run folder are those of the scene's own seed, and only its states are kept.

    Raises:
        EngineError, UntrustedError: of the first pull that failed; the log in the run folder is then its own.
    """
    if count == 1:
        return [_pull(context, threading.Event())]
    stop, found = threading.Event(), []
    context.progress.phase("pulling", count, "pull")
    with ThreadPoolExecutor(min(count, context.workers)) as executor:
        tasks = {executor.submit(_apart, context, number, stop): number for number in range(count)}
        try:
            for task in as_completed(tasks):
                found.append(task.result())
                context.progress.advance(1)
        except BaseException:
            stop.set()
            executor.shutdown(cancel_futures=True)
            raise
        finally:
            shutil.rmtree(context.folder / FOLDER, ignore_errors=True)
    return sorted(found, key=lambda one: one.seed)


def _apart(context: RunContext, number: int, stop: threading.Event) -> Detachment:
    """The pull of the seed that is `number` after the scene's, in a folder of its own."""
    scene, settings = context.deck.scene, context.deck.settings
    assert scene.noise is not None
    seeded = scene.model_copy(update={"noise": scene.noise.model_copy(update={"seed": scene.noise.seed + number})})
    folder = context.folder / FOLDER / str(number) if number else context.folder
    own = RunContext(Deck(seeded, settings), folder, Silent(), context.time_limit, context.retries)
    if number:
        folder.mkdir(parents=True, exist_ok=True)
        write_system(own.deck, folder)
    try:
        found = _pull(own, stop)
    except Exception:
        if not stop.is_set():
            context.phase, context.timestep = own.phase, own.timestep
            with suppress(OSError):
                os.replace(folder / LOG, context.folder / LOG)
        raise
    finally:
        context.add_time_of(own)
    return replace(found, phases=(), states=()) if number else found


def _pull(context: RunContext, stop: threading.Event) -> Detachment:
    scene, settings = context.deck.scene, context.deck.settings
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    assert scene.noise is not None
    ramp, look = ramp_of(scene, settings), chunk_steps(settings)
    barrier = settings.estimate.parted(BARRIER)
    with context.contact() as contact:
        states: list[State] = []
        for name, load in (("loading", experiment.preload), ("settling", 0.0)):
            contact.begin(name, expected_steps=SETTLING_LOOKS * look)
            states += contact.rows((UnderLoad(load, look),) * SETTLING_LOOKS, trusted=False)
        require_trust(scene, settings, states[-1])
        if min(one.displacement for one in states) < settings.estimate.parted(GONE):
            raise UntrustedError(
                "thermal fluctuations separate the bodies before the load decreases: use a lower noise.temperature, "
                "or a stronger interaction.attraction"
            )
        contact.begin("pulling", expected_steps=ramp.most * ramp.steps)
        settled = len(states)
        at_once = min(BATCH, max(1, WAITING_STEPS // ramp.steps))
        for first in range(1, ramp.most + 1, at_once):
            if stop.is_set():
                raise UntrustedError("another repeat failed")
            numbers = range(first, min(first + at_once, ramp.most + 1))
            states += contact.rows([ramp.row(n) for n in numbers], trusted=False)
            if _has_parted(scene, settings, ramp, numbers[-1], states[-1]):
                break
        else:
            raise UntrustedError(
                f"the bodies did not separate up to a tensile force of {ramp.tension(ramp.most, barrier):.4g} FU, more "
                f"than {MOST_TENSION:g} times the predicted pull-off force: the load changes faster than they move. "
                f"Use a smaller experiment.{'velocity' if ramp.spring else 'loading_rate'}"
            )
        contact.write_state()
        contact.finish()
    held = max((n for n, one in enumerate(states[settled:], 1) if one.displacement > barrier), default=0)
    time = (held + 0.5) * ramp.steps * settings.motion.time_step
    force = ramp.tension(held + 0.5, barrier)
    return Detachment(scene.noise.seed, force, time, contact.phases, tuple(states), settled + held - 1)


def _has_parted(scene: Scene, settings: Settings, ramp: Ramp, number: int, state: State) -> bool:
    """Whether the plate cannot return: there is no attraction, and the load is tensile."""
    barrier, none = settings.estimate.parted(BARRIER), settings.estimate.parted(GONE)
    gone = state.displacement < none
    return gone and ramp.work(number, state.displacement, barrier) > _needed(scene, settings)


def _needed(scene: Scene, settings: Settings) -> float:
    """Work [FU·LU] that keeps a plate from coming back: SURELY kT, and more than attraction gives it on its path.

    That is F_A (d_A − d_0) at most, d_0 the position beyond which there is none.
    """
    assert scene.noise is not None
    estimate = settings.estimate
    given = estimate.pull_off_force() * (estimate.parted(BARRIER) - estimate.parted(GONE))
    return given + SURELY * scene.noise.temperature


def pull_off_thermal(context: RunContext) -> Outcome:
    """Detachment force, mean and spread over the seeds, of a pull-off with [noise].

    Raises:
        UntrustedError: bodies that do not separate, or see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    assert isinstance(scene.experiment, PullOff)
    count = scene.experiment.repeats or 1
    found = pulls(context, count)
    forces = np.asarray([one.force for one in found])
    step = ramp_of(scene, settings).rise / math.sqrt(12.0)
    spread = float(forces.std(ddof=1)) if count > 1 else math.nan
    # One pull says nothing of how they scatter.
    error = math.hypot(spread, step) / math.sqrt(count) if count > 1 else float(abs(forces[0]))
    results = {"detachment_force": Result(float(forces.mean()), FORCE, {"statistics": error})}
    if count > 1:
        of_spread = {"statistics": spread / math.sqrt(2.0 * (count - 1))}
        results["detachment_force_spread"] = Result(spread, FORCE, of_spread)
    own = found[0]
    rows = [row for phase in own.phases for row in phase.rows]
    loads = [_load(rows[state.number], state) for state in own.states]
    tables = {
        DETACHMENTS: {
            "seed": tuple(float(one.seed) for one in found),
            "force": tuple(one.force for one in found),
            "time": tuple(one.time for one in found),
        },
        SAMPLE_TABLE: sample_columns(own.states, loads, settings),
    }
    warnings = doubts(scene, settings, own.states) | _lagging(scene, settings)
    return Outcome(results, own.states, {"last_held": own.states[own.held]}, own.phases, warnings, tables=tables)


def _load(row: Row, state: State) -> float:
    """On the plate in a row [FU], compression positive: given, or the spring's at the load step's end."""
    if isinstance(row, DrawnOff):
        return -row.spring * (state.displacement - row.end)
    assert isinstance(row, UnderLoad)
    return row.load


def _lagging(scene: Scene, settings: Settings) -> dict[str, str]:
    """A warning where the load grows by a share of F_A while drag Γ lets F_A move the plate by the range: Γ b Ḟ/F_A."""
    assert isinstance(scene.experiment, PullOff)
    assert settings.forces.law is not None
    drag, largest = settings.drag(), settings.estimate.pull_off_force()
    share = drag * settings.forces.law.longest_range * rate_of(scene, settings) / largest**2
    if share < LAGGING:
        return {}
    key, unit = ("velocity", "LU/TU") if scene.experiment.velocity else ("loading_rate", "FU/TU")
    given = scene.experiment.velocity or scene.experiment.loading_rate or 0.0
    return {
        "lagging": (
            f"viscous drag delays the separation, and the load meanwhile grows by {share:.2g} of the pull-off force: "
            f"detachment_force contains drag. Use an experiment.{key} below {given * LAGGING / share:.2g} {unit} "
            "to avoid it"
        )
    }


def planned_detachment(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule up to a tension that the predictor does not hold."""
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    ramp, look = ramp_of(scene, settings), chunk_steps(settings)
    rows = ramp.until(FARTHEST * settings.estimate.pull_off_force(), settings.estimate.parted(BARRIER))
    return (
        Phase("loading", (UnderLoad(experiment.preload, look),) * SETTLING_LOOKS),
        Phase("settling", (UnderLoad(0.0, look),) * SETTLING_LOOKS),
        Phase("pulling", tuple(ramp.row(n) for n in range(1, rows + 1)), state=True),
    )
