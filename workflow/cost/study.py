"""A cost study: every variant of a scene runs through `run`, its true error against one reference that is finer in all.

The tolerance of the reference falls by ten, with all else finer, too, until a run takes long or fails. A main result of
it is uncertain by what that run states and by its change since the reference before.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import repeat
from pathlib import Path
from tempfile import TemporaryDirectory

from contact1d.workflow.continuation.outcome import MODEL, Result, unmet
from contact1d.workflow.cost.report import CostRecord, Error, Measured, Row
from contact1d.workflow.cost.variants import finer, variants_of
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import Contact1dError, RunError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.processors import pool
from contact1d.workflow.runs.report import versions
from contact1d.workflow.scene import Scene

LONG_RUN, LONG_REFERENCE = 4.0, 10.0
"""CPU times [s]: of a run that is not repeated, since it is long against what disturbs a timing; of a reference after
which there is no finer one."""
LEVELS = 4
"""References, each finer than the one before."""
CERTAIN = 0.1
"""Uncertainty over an error up to which the error is a number; beyond it there is an upper bound."""
Prepared = tuple[Scene, Settings | None]
"""What is run: a scene, and settings in place of those that `run` chooses and refines."""


def measured(prepared: Prepared, folder: Path) -> Measured:
    """Run a scene once, in a folder of this process in `folder`; a failure is a result."""
    scene, settings = prepared
    began = time.process_time()
    try:
        done = run(scene, folder / str(os.getpid()), figures=False, settings=settings, workers=1)
    except Contact1dError as error:
        return Measured(failure=" ".join(getattr(error, "message", str(error)).split()))
    assert done.outcome is not None
    results, spent = done.outcome.results, time.process_time() - began + done.timing["lammps_cpu_s"]
    warnings = *done.warnings, *unmet(results, scene.accuracy.tolerance, (MODEL,))
    return Measured(results, (spent,), warnings)


def measure(
    variants: Sequence[Prepared], folder: Path, repeats: int, workers: int, progress: Progress
) -> list[Measured]:
    """Run every variant `repeats` times: once all, then all again, so that a slow minute hits them alike.

    Args:
        variants: at least one.
        folder: for run folders.
        repeats: rounds; runs longer than LONG_RUN take part in the first one only.
        workers: runs at a time.
        progress: informed of each run that ends.
    """
    done = [Measured()] * len(variants)
    progress.phase("runs", repeats * len(done), "run")
    with pool(min(workers, len(done))) as executor:
        for _ in range(repeats):
            again = [i for i, one in enumerate(done) if not one.failure and not one.cpu_s > LONG_RUN]
            found = executor.map(measured, [variants[i] for i in again], repeat(folder))
            for i, one in zip(again, found, strict=True):
                done[i] = replace(one, cpu_runs=done[i].cpu_runs + one.cpu_runs)
                progress.advance(1)
            progress.advance(len(done) - len(again))
    return done


def cost_of(scene: Scene, name: str, folder: Path, repeats: int, workers: int, progress: Progress) -> CostRecord:
    """True error and CPU time of a scene and of its variants.

    Args:
        scene: to be studied.
        name: of it, for the record.
        folder: where run folders may be for a while; it exists.
        repeats: rounds of measurement.
        workers: runs at a time.
        progress: informed of what begins, and of each run that ends.

    Raises:
        RunError: no reference could be computed.
    """
    with TemporaryDirectory(prefix=".cost-", dir=folder) as place:
        progress.phase("reference")
        finest, reference = reference_of(scene, Path(place))
        variants = [one for one in variants_of(scene) if one[1].accuracy.tolerance > finest or not one[0].options]
        done = measure([(other, None) for _, other in variants], Path(place), repeats, workers, progress)
    rows = tuple(judged(row, one, reference) for (row, _), one in zip(variants, done, strict=True))
    return CostRecord(scene.title, name, scene.accuracy.tolerance, finest, reference, rows, versions())


def reference_of(scene: Scene, folder: Path) -> tuple[float, Mapping[str, Result]]:
    """Tolerance and main results of the reference, these with the change since the one before as an error, too.

    Raises:
        RunError: none finer than the scene works.
    """
    finest, last, other = math.inf, dict[str, Result](), scene
    for _ in range(LEVELS):
        other = finer(other)
        one = measured((other, None), folder)
        if not (main := main_results(other, one.results)):
            break
        changes = {name: abs(new.value - last.get(name, new).value) for name, new in main.items()}
        finest, last = other.accuracy.tolerance, main
        if one.cpu_s > LONG_REFERENCE:
            break
    if not last:
        reason = one.failure or "no main result differs from 0"
        raise RunError(f"no reference of higher accuracy could be computed: {reason}", folder, kept=False)
    return finest, {name: replace(best, errors={**best.errors, MODEL: changes[name]}) for name, best in last.items()}


def main_results(scene: Scene, results: Mapping[str, Result]) -> dict[str, Result]:
    """The results by which errors are judged: neither prescribed nor without a size."""
    found = {name: results[name] for name in kind_of(scene).main_results if name in results}
    load = scene.experiment.load_key
    return {name: one for name, one in found.items() if one.size and not one.prescribed and name != load}


def judged(row: Row, done: Measured, reference: Mapping[str, Result]) -> Row:
    """The row with what was measured; one that lacks a main result has failed."""
    row = replace(row, **vars(done))
    if missing := [name for name in reference if name not in row.results]:
        return replace(row, failure=row.failure or f"no {' and no '.join(missing)}")
    errors = {name: _error(row.results[name], best) for name, best in reference.items()}
    worst = max(errors, key=errors.__getitem__)
    budget = row.results[worst].errors
    return replace(row, errors=errors, dominant=f"{max(budget, key=budget.__getitem__)} of {worst}")


def _error(one: Result, best: Result) -> Error:
    """The error of a result; an upper bound where the reference, or chance, leaves open more than a tenth of it."""
    error, unsure = abs(one.value - best.value), best.uncertainty + one.errors.get("statistics", 0.0)
    is_bound = unsure > CERTAIN * error
    return Error((error + is_bound * unsure) / best.size, is_bound)
