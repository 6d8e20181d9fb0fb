"""Runs of a study: every variant once, then all again, round by round, so that a slow minute hits them alike.

What an effect costs per step: the same number of timesteps with all effects and without one, turn by turn. A timestep
evaluates every force once, and so does a step of a minimiser; reading tables and setting up is left out.
"""

from __future__ import annotations

import math
import os
import shutil
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import as_completed
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median, stdev

from contact1d.workflow.cost.knobs import Change
from contact1d.workflow.cost.report import EffectCost
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.fragments import DeckError
from contact1d.workflow.deck.steps import Displace, Draw
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.process import stop_idle
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.engine.session import Engine, Session
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.model.settings import Settings, SettingsError, settings_for
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.processors import pool
from contact1d.workflow.runs.report import open_results
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.units import Quantity

LONG_RUN = 4.0
"""Wall time [s] from which on a run is not repeated: what disturbs a timing is short against it."""


@dataclass(frozen=True)
class Prepared:
    """A variant that is ready to run."""

    label: str
    scene: Scene
    settings: Settings


@dataclass(frozen=True)
class Measured:
    """The runs of one variant.

    Attributes:
        quantities: main results and all others, by name; the same in every run.
        cpu_runs, total_runs: CPU time in LAMMPS and wall time of each run [s].
        steps: of a run.
        warnings: names of what limits the results; "tolerance <result>" where one is known less well than asked for.
        memory_mb: peak resident memory of the LAMMPS process, NaN where the system does not tell.
        failure: why there are no numbers, "" where there are.
    """

    quantities: Mapping[str, Quantity] = field(default_factory=dict)
    cpu_runs: tuple[float, ...] = ()
    total_runs: tuple[float, ...] = ()
    steps: int = 0
    memory_mb: float = float("nan")
    failure: str = ""
    warnings: frozenset[str] = frozenset()

    @property
    def cpu_s(self) -> float:
        """Median CPU time in LAMMPS [s]."""
        return median(self.cpu_runs) if self.cpu_runs else float("nan")

    @property
    def total_s(self) -> float:
        """Median wall time [s]."""
        return median(self.total_runs) if self.total_runs else float("nan")


def measure(
    variants: Sequence[Prepared], folder: Path, repeats: int, workers: int, progress: Progress
) -> dict[str, Measured]:
    """Run every variant `repeats` times, interleaved; run folders are removed, failures are results.

    Args:
        variants: with labels of their own.
        folder: for run folders.
        repeats: rounds; runs longer than LONG_RUN take part in the first one only.
        workers: runs at a time.
        progress: is told of each run that ends.
    """
    done: dict[str, Measured] = {}
    with pool(min(workers, len(variants))) as executor:
        for turn in range(repeats):
            again = [one for one in variants if turn == 0 or _worth_repeating(done[one.label])]
            futures = {
                executor.submit(run_once, one, folder / f"{turn}_{index}", turn == 0): one.label
                for index, one in enumerate(again)
            }
            for future in as_completed(futures):
                label = futures[future]
                done[label] = _together(done.get(label), future.result())
                progress.advance(1)
            progress.advance(len(variants) - len(again))
    return done


def run_once(variant: Prepared, folder: Path, fresh: bool) -> Measured:
    """Run a variant; with `fresh` in a LAMMPS process of its own, whose peak memory is its."""
    if fresh:
        stop_idle()
    try:
        finished = run(variant.scene, folder, figures=False, settings=variant.settings)
    except (RunError, FolderError, DeckError, SettingsError) as error:
        return Measured(failure=getattr(error, "message", str(error)))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    timing, outcome = finished.timing, finished.outcome
    assert outcome is not None
    open_ = open_results(variant.scene, outcome)
    return Measured(
        outcome.quantities,
        (timing["lammps_cpu_s"],),
        (timing["total_s"],),
        int(timing["steps"]),
        children_peak_mb() if fresh else float("nan"),
        warnings=frozenset({*outcome.warnings, *(f"tolerance {name}" for name in open_)}),
    )


def children_peak_mb() -> float:
    """Largest peak resident memory [MB] of the living child processes, as /proc has it; NaN where there is no such."""
    try:
        tasks = Path(f"/proc/{os.getpid()}/task").glob("*/children")
        children = [child for task in tasks for child in task.read_text().split()]
        lines = [line for child in children for line in Path(f"/proc/{child}/status").read_text().splitlines()]
        return max(int(line.split()[1]) for line in lines if line.startswith("VmHWM:")) / 1024.0
    except (OSError, ValueError):
        return float("nan")


def _worth_repeating(measured: Measured) -> bool:
    return not measured.failure and measured.total_s < LONG_RUN


def _together(before: Measured | None, latest: Measured) -> Measured:
    if before is None or latest.failure:
        return latest
    runs, totals = before.cpu_runs + latest.cpu_runs, before.total_runs + latest.total_runs
    return replace(before, cpu_runs=runs, total_runs=totals)


STEPS = 2_000
TURNS = 7
MEDIAN_ERROR = 1.25
"""Standard error of a median over that of a mean."""


def without_effects(scene: Scene) -> tuple[dict[str, Change], dict[str, str]]:
    """How to leave out each effect that can be, by its name; and why others cannot."""
    has_one = scene.experiment.motion_is_result or scene.experiment.goes_along
    method = () if has_one else (f"experiment.method={scene.method}",)
    changes, reasons = {}, {}
    for effect in scene.effects:
        change = Change(method, (effect,))
        try:
            change.scene(scene)
        except SceneError as error:
            reasons[effect] = "; ".join(f"{problem.path} {problem.message}" for problem in error.problems)
        else:
            changes[effect] = change
    return changes, reasons


def standing_without(scene: Scene) -> dict[str, Deck]:
    """Decks of a slide without what it could not run without, but take steps: by the effect, and "" where none pulls.

    With the settings of the whole scene, so that they have its particles, its cutoff and its table.
    """
    if not scene.experiment.motion_is_result:
        return {}
    gone: dict[str, tuple[str, ...]] = {"cantilever": ("cantilever",), "plate": ("cantilever", "plate")}
    if scene.noise is None:
        gone["damping"] = ("damping",)
    settings = settings_for(scene)
    return {
        effect: Deck(scene.model_copy(update=dict.fromkeys(names)), settings)
        for effect, names in gone.items()
        if effect in scene.effects
    }


def effect_costs(scene: Scene, folder: Path, turns: int = TURNS) -> tuple[EffectCost, ...]:
    """CPU time of a step with and without each effect; medians over `turns` (at least 2) blocks of STEPS steps.

    A plate that is pulled is measured beside a deck without cantilever, with and without it.
    """
    changes, reasons = without_effects(scene)
    scenes = {"": scene} | {effect: change.scene(scene) for effect, change in changes.items()}
    with ExitStack() as stack:
        decks = {effect: Deck(changed, settings_for(changed)) for effect, changed in scenes.items()}
        decks |= (standing := standing_without(scene))
        sessions = {
            effect: stack.enter_context(opened(deck, folder / f"step_{effect}")) for effect, deck in decks.items()
        }
        times = _interleaved(sessions, {effect: _steps(deck) for effect, deck in decks.items()}, turns)
    particles = settings_for(scene).particles * scene.chains
    return tuple(
        _cost(effect, times, particles, "cantilever" if effect == "plate" and effect in standing else "")
        if effect in decks
        else _cost_of_all(effect, times, particles, reasons)
        for effect in scene.effects
    )


def _cost(effect: str, times: Mapping[str, list[float]], particles: int, beside: str) -> EffectCost:
    ratios = [both / without for both, without in zip(times[beside], times[effect], strict=True)]
    error = MEDIAN_ERROR * stdev(ratios) / math.sqrt(len(ratios))
    return EffectCost(effect, median(times[beside]), median(times[effect]), median(ratios), error, particles)


def _cost_of_all(
    effect: str, times: Mapping[str, list[float]], particles: int, reasons: Mapping[str, str]
) -> EffectCost:
    none = math.nan
    return EffectCost(effect, median(times[""]), none, none, none, particles, reasons[effect])


@contextmanager
def opened(deck: Deck, folder: Path) -> Iterator[Session]:
    """A session in which the deck's scene stands at displacement 0, ready for timesteps."""
    folder.mkdir(parents=True)
    write_system(deck, folder)
    with Engine.session(folder) as session:
        session.execute(deck.head + deck.begin("standing"), phase="setting up")
        yield session


def _steps(deck: Deck) -> str:
    """STEPS steps: of time, or where nothing has to come to rest as many rows."""
    row = Draw(0.0, 0.0) if deck.scene.experiment.goes_along else Displace(0.0)
    return deck.in_one_run((row,) * STEPS) if deck.stepped else f"run {STEPS}"


def _interleaved(sessions: Mapping[str, Session], texts: Mapping[str, str], turns: int) -> dict[str, list[float]]:
    """CPU time of a step [µs] in each turn of each session; the first block warms up."""
    blocks: dict[str, list[float]] = {effect: [] for effect in sessions}
    for _ in range(turns + 1):
        for effect, session in sessions.items():
            before = session.lammps_cpu_seconds
            session.execute(texts[effect])
            blocks[effect].append(1e6 * (session.lammps_cpu_seconds - before) / STEPS)
    return {effect: times[1:] for effect, times in blocks.items()}
