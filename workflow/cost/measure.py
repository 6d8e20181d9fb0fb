"""Runs of a study: every variant once, then all again, round by round, so that a slow minute hits them alike."""

from __future__ import annotations

import os
import shutil
from collections.abc import Mapping, Sequence
from concurrent.futures import as_completed
from dataclasses import dataclass, field, replace
from pathlib import Path
from statistics import median

from contact1d.workflow.deck.fragments import DeckError
from contact1d.workflow.engine.process import stop_idle
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs.report import open_results
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.pool import pool
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings, SettingsError
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
