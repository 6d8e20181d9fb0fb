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
from contact1d.workflow.cost.report import CostRecord, Error, Measured
from contact1d.workflow.cost.variants import finer, variants_of
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import Contact1dError, RunError
from contact1d.workflow.runs.accuracy import main_results
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.processors import pool
from contact1d.workflow.scene import Scene

LONG_REFERENCE, LONG_STUDY = 10.0, 60.0
"""CPU times [s]: of a reference, after which there is no finer one; of all runs, after which none is repeated, since
they are long against what disturbs a timing."""
LEVELS = 4
"""References, each finer than the one before."""
CERTAIN = 0.1
"""Uncertainty over an error up to which the error is a number; beyond it there is an upper bound."""


def measured(scene: Scene, folder: Path) -> Measured:
    """Run a scene once, in a folder of this process in `folder`; a failure is a result."""
    began = time.process_time()
    try:
        done = run(scene, folder / str(os.getpid()), figures=False, workers=1)
    except Contact1dError as error:
        return Measured(failure=error.message)
    assert done.outcome is not None
    results, spent = done.outcome.results, time.process_time() - began + done.timing["lammps_cpu_s"]
    warnings = *done.warnings, *unmet(results, scene.accuracy.tolerance, (MODEL,))
    return Measured(results, (spent,), warnings)


def measure(scenes: Sequence[Scene], folder: Path, repeats: int, workers: int, progress: Progress) -> list[Measured]:
    """Run every scene in turn, and all again, so that a slow minute hits them alike.

    Args:
        scenes: at least one.
        folder: for run folders.
        repeats: rounds; none begins after LONG_STUDY.
        workers: runs at a time.
        progress: informed of each run that ends.
    """
    done = [Measured()] * len(scenes)
    progress.phase("runs", repeats * len(done), "run")
    with pool(workers) as executor:
        while repeats and sum(sum(one.cpu_runs) for one in done) < LONG_STUDY:
            repeats -= 1
            for i, one in enumerate(executor.map(measured, scenes, repeat(folder))):
                done[i] = replace(one, cpu_runs=done[i].cpu_runs + one.cpu_runs)
                progress.advance(1)
    return done


def cost_of(scene: Scene, folder: Path, repeats: int, workers: int, progress: Progress) -> CostRecord:
    """True error and CPU time of a scene and of its variants.

    Args:
        scene: to be studied.
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
        variants = [one for one in variants_of(scene) if one[1].accuracy.tolerance > finest or one[1] == scene]
        done = measure([other for _, other in variants], Path(place), repeats, workers, progress)
    rows = tuple(judged(replace(one, edit=edit), reference) for (edit, _), one in zip(variants, done, strict=True))
    return CostRecord(scene.title, scene.accuracy.tolerance, finest, reference, rows)


def reference_of(scene: Scene, folder: Path) -> tuple[float, Mapping[str, Result]]:
    """Tolerance and main results of the reference, these with the change since the one before as an error, too.

    Raises:
        RunError: none finer than the scene works.
    """
    finest, last, other = math.inf, dict[str, Result](), scene
    for _ in range(LEVELS):
        other = finer(other)
        one = measured(other, folder)
        main = {
            name: replace(best, errors={**best.errors, MODEL: abs(best.value - last.get(name, best).value)})
            for name, best in main_results(other, one.results).items()
            if best.size
        }
        if not main:
            break
        finest, last = other.accuracy.tolerance, main
        if one.cpu_s > LONG_REFERENCE:
            break
    if not last:
        reason = one.failure or "its main results are all 0"
        raise RunError(f"a reference that is finer than the scene gives no numbers: {reason}", folder, kept=False)
    return finest, last


def judged(one: Measured, reference: Mapping[str, Result]) -> Measured:
    """The runs of a variant with their errors; one that lacks a main result has failed."""
    if missing := [name for name in reference if name not in one.results]:
        return replace(one, failure=one.failure or f"no {missing[0]}")
    errors = {name: _error(one.results[name], best) for name, best in reference.items()}
    worst = max(errors, key=errors.__getitem__)
    budget = dict(one.results[worst].errors)
    if "input" in budget:  # a number with ± is the same in the reference
        budget["input"] -= one.results[worst].given
    return replace(one, errors=errors, dominant=f"{max(budget, key=budget.__getitem__)} of {worst}")


def _error(one: Result, best: Result) -> Error:
    """The error of a result; an upper bound where the reference, or chance, leaves open more than a tenth of it."""
    error, unsure = abs(one.value - best.value), best.uncertainty - best.given + one.errors.get("statistics", 0.0)
    is_bound = unsure > CERTAIN * error
    return Error((error + is_bound * unsure) / best.size, is_bound)
