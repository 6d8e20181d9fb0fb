"""Runs of a study: every variant once, then all again, round by round, so that a slow minute hits them alike.

What an effect costs per step: the same number of timesteps with all effects and without one, turn by turn. A timestep
evaluates every force once, and so does a step of a minimiser; reading tables and setting up is left out.
"""

from __future__ import annotations

import math
import re
import shutil
from collections.abc import Iterator, Mapping
from concurrent.futures import as_completed
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median
from typing import Annotated

import numpy as np
from pydantic import Field, computed_field

from contact1d.workflow.cost.knobs import WITHOUT, Keys, changed
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.fragments import DeckError
from contact1d.workflow.deck.steps import Displace, Draw
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.process import stop_idle
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.engine.session import Engine, Session
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.model.settings import Settings, SettingsError, settings_for
from contact1d.workflow.runs.accuracy import open_results
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.processors import pool
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.units import Quantity

LONG_RUN = 4.0
"""CPU time [s] from which on a run is not repeated: what disturbs a timing is short against it."""
Prepared = tuple[Scene, Settings]
"""A variant that is ready to run."""


@dataclass(frozen=True)
class Measured:
    """The runs of one variant.

    Attributes:
        quantities: main results and all others, by name; the same in every run.
        cpu_runs: CPU time in LAMMPS of each run [s].
        steps: minimiser iterations or timesteps of a run.
        memory_mb: peak resident memory of the LAMMPS process, NaN where the system does not report it.
        failure: why there are no numbers, "" where there are.
        warnings: names of limitations of the results; "tolerance <result>" where the uncertainty of one exceeds it.
    """

    quantities: Annotated[Mapping[str, Quantity], Field(exclude=True)] = field(default_factory=dict)
    cpu_runs: tuple[float, ...] = ()
    steps: int = 0
    memory_mb: float = math.nan
    failure: str = ""
    warnings: Annotated[frozenset[str], Field(exclude=True)] = frozenset()

    @computed_field  # type: ignore[prop-decorator]  # mypy knows no decorator on a property
    @property
    def cpu_s(self) -> float:
        """Median CPU time in LAMMPS [s]."""
        return median(self.cpu_runs or (math.nan,))

    def __add__(self, later: Measured) -> Measured:
        """With the times of a later run, or its failure."""
        return later if later.failure else replace(self, cpu_runs=self.cpu_runs + later.cpu_runs)


def measure(
    variants: Mapping[str, Prepared], folder: Path, repeats: int, workers: int, progress: Progress
) -> dict[str, Measured]:
    """Run every variant `repeats` times, interleaved; run folders are removed, failures are results.

    Args:
        variants: by their labels, at least one.
        folder: for run folders.
        repeats: rounds; runs longer than LONG_RUN take part in the first one only.
        workers: runs at a time.
        progress: informed of each run that ends.
    """
    done: dict[str, Measured] = {}
    with pool(min(workers, len(variants))) as executor:
        for turn in range(repeats):
            again = [label for label in variants if turn == 0 or done[label].cpu_s < LONG_RUN]
            futures = {
                executor.submit(run_once, variants[label], folder / f"{turn}_{index}", fresh=turn == 0): label
                for index, label in enumerate(again)
            }
            for future in as_completed(futures):
                label = futures[future]
                done[label] = done[label] + future.result() if turn else future.result()
                progress.advance(1)
            progress.advance(len(variants) - len(again))
    return done


def run_once(variant: Prepared, folder: Path, fresh: bool) -> Measured:
    """Run a variant; with `fresh` in a LAMMPS process of its own, whose peak memory is measured."""
    if fresh:
        stop_idle()
    scene, settings = variant
    try:
        finished = run(scene, folder, figures=False, settings=settings)
    except (RunError, FolderError, DeckError, SettingsError) as error:
        return Measured(failure=getattr(error, "message", str(error)))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    timing, outcome = finished.timing, finished.outcome
    assert outcome is not None
    open_ = (f"tolerance {name}" for name in open_results(scene, outcome))
    return Measured(
        outcome.quantities,
        (timing["lammps_cpu_s"],),
        int(timing["steps"]),
        children_peak_mb() if fresh else math.nan,
        warnings=frozenset({*outcome.warnings, *open_}),
    )


def children_peak_mb() -> float:
    """Largest peak resident memory [MB] of the living child processes, from /proc; NaN where this is not available."""
    try:
        children = [child for task in Path("/proc/self/task").glob("*/children") for child in task.read_text().split()]
        texts = [Path(f"/proc/{child}/status").read_text() for child in children]
        return max(int(peak) for text in texts for peak in re.findall(r"VmHWM:\s+(\d+) kB", text)) / 1024.0
    except (OSError, ValueError):
        return math.nan


STEPS = 2_000
TURNS = 7
MEDIAN_ERROR = 1.25
"""Standard error of a median over that of a mean."""


@dataclass(frozen=True)
class EffectCost:
    """What an effect costs per timestep, or per force evaluation of a minimiser, which is the same work.

    Attributes:
        name: the effect.
        with_us, without_us: CPU time of a step with all effects, and without this one [µs]; medians, NaN where it
            cannot be left out.
        ratio, ratio_error: of the two, median over turns, and its standard error.
    """

    name: str
    with_us: float
    without_us: float
    ratio: float
    ratio_error: float


def without_effects(scene: Scene) -> dict[str, Keys]:
    """How to leave out each optional effect, by its name."""
    has_one = scene.experiment.motion_is_result or scene.experiment.goes_along
    method = () if has_one else (f"experiment.method={scene.method}",)
    found = {}
    for effect in scene.effects:
        with suppress(SceneError):
            changed(scene, keys := (*method, WITHOUT + effect))
            found[effect] = keys
    return found


def effect_costs(scene: Scene, folder: Path) -> tuple[EffectCost, ...]:
    """CPU time of a step with and without each effect; medians over TURNS blocks of STEPS steps.

    What a slide could not run without, but take steps, is left out with the settings of the whole scene, so that its
    particles, its cutoff and its table are the same; a plate that is pulled is measured beside a deck without
    cantilever, with and without it.
    """
    settings = settings_for(scene)
    decks = {"": Deck(scene, settings)}
    for effect, keys in without_effects(scene).items():
        other = changed(scene, keys)
        decks[effect] = Deck(other, settings_for(other))
    if scene.experiment.motion_is_result:
        gone = {"cantilever": ["cantilever"], "plate": ["cantilever", "plate"]}
        gone |= {} if scene.noise is not None else {"damping": ["damping"]}
        for effect in gone.keys() & set(scene.effects):
            decks[effect] = Deck(scene.model_copy(update=dict.fromkeys(gone[effect])), settings)
    times = _interleaved(decks, folder)
    found = []
    for effect in scene.effects:
        beside = times["cantilever" if effect == "plate" and scene.experiment.motion_is_result else ""]
        without = times.get(effect, [math.nan] * TURNS)
        ratios = [both / without for both, without in zip(beside, without, strict=True)]
        error = MEDIAN_ERROR * float(np.std(ratios, ddof=1)) / math.sqrt(TURNS)
        found.append(EffectCost(effect, median(beside), median(without), median(ratios), error))
    return tuple(found)


def _interleaved(decks: Mapping[str, Deck], folder: Path) -> dict[str, list[float]]:
    """CPU time of a step [µs] in each turn of each deck; the first block warms up."""
    blocks: dict[str, list[float]] = {effect: [] for effect in decks}
    with ExitStack() as stack:
        sessions = {name: stack.enter_context(opened(deck, folder / f"step_{name}")) for name, deck in decks.items()}
        for _ in range(TURNS + 1):
            for effect, session in sessions.items():
                before = session.lammps_cpu_seconds
                session.execute(_steps(decks[effect]))
                blocks[effect].append(1e6 * (session.lammps_cpu_seconds - before) / STEPS)
    return {effect: times[1:] for effect, times in blocks.items()}


@contextmanager
def opened(deck: Deck, folder: Path) -> Iterator[Session]:
    """A session with the scene of the deck at displacement 0, ready for timesteps."""
    folder.mkdir(parents=True)
    write_system(deck, folder)
    with Engine.session(folder) as session:
        session.execute(deck.head + deck.begin("standing"), phase="setting up")
        yield session


def _steps(deck: Deck) -> str:
    """STEPS steps: of time, or where nothing has to come to rest as many rows."""
    row = Draw(0.0, 0.0) if deck.scene.experiment.goes_along else Displace(0.0)
    return deck.in_one_run((row,) * STEPS) if deck.stepped else f"run {STEPS}"
