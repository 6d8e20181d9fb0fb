"""A cost study: every variant of a scene runs through `run`, its true error against one reference that is finer in all.

References follow one another, each with a tenth of the tolerance and everything else finer, too, until a run takes long
or fails. The uncertainty of a main result is that of the last run, plus its change from the run before.
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
from contact1d.workflow.cost.report import CostRecord, Error, VariantRuns
from contact1d.workflow.cost.variants import finer, variants_of
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import Contact1dError, RunError
from contact1d.workflow.runs.accuracy import main_results
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.processors import pool
from contact1d.workflow.scene import Scene


def run_once(scene: Scene, folder: Path) -> VariantRuns:
    """Return the results [model units], CPU time [s] and warnings of one run of a scene, or the reason why it failed.

    Warnings are followed by the names of results that miss the tolerance. A run that ends with a Contact1dError has a
    `failure`, and no results and time; other errors are raised. It runs in a folder of this process in `folder`.
    """
    began = time.process_time()
    try:
        done = run(scene, folder / str(os.getpid()), figures=False, workers=1)
    except Contact1dError as error:
        return VariantRuns(failure=error.message)
    assert done.outcome is not None
    results, spent = done.outcome.results, time.process_time() - began + done.timing["lammps_cpu_s"]
    warnings = *done.warnings, *unmet(results, scene.accuracy.tolerance, (MODEL,))
    return VariantRuns(results, (spent,), warnings)


def measure(
    scenes: Sequence[Scene], folder: Path, repeats: int, workers: int, progress: Progress, longest_s: float = 60.0
) -> list[VariantRuns]:
    """Return the runs of each scene, in order, from rounds in which all run, so that a slow machine slows all of them.

    CPU times are those of all rounds, results, warnings and failure those of the last one. Without a round, for
    `repeats` of 0, they are empty.

    Args:
        scenes: at least one.
        folder: where run folders are made.
        repeats: number of rounds at most.
        workers: runs at a time.
        progress: informed of each run that ends.
        longest_s: CPU time of all runs [s] after which no round begins: such runs are long compared with what disturbs
            a timing.
    """
    done = [VariantRuns()] * len(scenes)
    progress.phase("runs", repeats * len(done), "run")
    with pool(workers) as executor:
        while repeats and sum(sum(runs.cpu_runs) for runs in done) < longest_s:
            repeats -= 1
            for i, runs in enumerate(executor.map(run_once, scenes, repeat(folder))):
                done[i] = replace(runs, cpu_runs=done[i].cpu_runs + runs.cpu_runs)
                progress.advance(1)
    return done


def cost_of(scene: Scene, folder: Path, repeats: int, workers: int, progress: Progress) -> CostRecord:
    """Return the true errors and CPU times of a scene and of its variants, from runs of all.

    Variants with a tolerance as small as that of the reference, or smaller, are left out, but not the scene itself. A
    variant that fails has a row, without errors.

    Args:
        scene: the scene of the study.
        folder: an existing folder, for temporary run folders, which are removed.
        repeats: rounds of measurement.
        workers: runs at a time.
        progress: informed of what begins, and of each run that ends.

    Raises:
        RunError: no reference could be computed.
    """
    with TemporaryDirectory(prefix=".cost-", dir=folder) as temporary:
        progress.phase("reference")
        finest, reference = reference_of(scene, Path(temporary))
        variants = [
            (edit, variant)
            for edit, variant in variants_of(scene)
            if variant.accuracy.tolerance > finest or variant == scene
        ]
        done = measure([variant for _, variant in variants], Path(temporary), repeats, workers, progress)
    rows = (with_errors(replace(runs, edit=edit), reference) for (edit, _), runs in zip(variants, done, strict=True))
    return CostRecord(scene.title, scene.accuracy.tolerance, finest, reference, tuple(rows))


def reference_of(
    scene: Scene, folder: Path, levels: int = 4, longest_s: float = 10.0
) -> tuple[float, Mapping[str, Result]]:
    """Return (accuracy.tolerance, main results by name [model units]) of the finest reference that has numbers.

    Results of size 0 are left out. The change from the reference before is the error `model` of a result, 0 in the
    first one.

    Args:
        scene: the scene of the study.
        folder: where run folders are made.
        levels: number of references at most, each finer than the one before.
        longest_s: CPU time of a reference [s] after which no finer one is run.

    Raises:
        RunError: no reference that is finer than the scene gives numbers other than 0.
    """
    finest, last, refined = math.inf, dict[str, Result](), scene
    for _ in range(levels):
        refined = finer(refined)
        runs = run_once(refined, folder)
        main = {
            name: replace(best, errors={**best.errors, MODEL: abs(best.value - last.get(name, best).value)})
            for name, best in main_results(refined, runs.results).items()
            if best.size
        }
        if not main:
            break
        finest, last = refined.accuracy.tolerance, main
        if runs.cpu_s > longest_s:
            break
    if not last:
        reason = runs.failure or "its main results are all 0"
        raise RunError(f"a reference that is finer than the scene gives no numbers: {reason}", folder, kept=False)
    return finest, last


def with_errors(runs: VariantRuns, reference: Mapping[str, Result]) -> VariantRuns:
    """Return a copy of the runs with relative errors against the reference, and the dominant source of the largest.

    The errors are of the results of the reference, by name; the source is a text, "solver of contact_radius". Where the
    runs lack a result of the reference, the copy has a `failure`, that of the runs or "no <name>", and no errors.
    """
    if missing := [name for name in reference if name not in runs.results]:
        return replace(runs, failure=runs.failure or f"no {missing[0]}")
    errors = {name: _error(runs.results[name], best) for name, best in reference.items()}
    worst = max(errors, key=errors.__getitem__)
    budget = dict(runs.results[worst].errors)
    if "input" in budget:  # a number with ± is the same in the reference
        budget["input"] -= runs.results[worst].given
    return replace(runs, errors=errors, dominant=f"{max(budget, key=budget.__getitem__)} of {worst}")


def _error(result: Result, best: Result, largest_share: float = 0.1) -> Error:
    """Return the relative error of a result against its reference, ≥ 0, over the size of the latter.

    Where the uncertainty of the reference and the statistical error of the result together exceed `largest_share` of
    the error, they are added to it, and it is an upper bound. The part of the uncertainty by numbers with ± in the
    scene does not count. ZeroDivisionError for a reference of size 0.
    """
    error = abs(result.value - best.value)
    uncertainty = best.uncertainty - best.given + result.errors.get("statistics", 0.0)
    is_bound = uncertainty > largest_share * error
    return Error((error + is_bound * uncertainty) / best.size, is_bound)
