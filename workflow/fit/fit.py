"""A fit from its file to its folder: the curve under its contact model and others, and the scene on LAMMPS."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from contact1d.files import AnyPath
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import Contact1dError, FolderError
from contact1d.workflow.fit.comparison import BAD, CurveFit, fit_curve
from contact1d.workflow.fit.curve import APPROACH, NOUNS, RETRACT, ForceCurve
from contact1d.workflow.fit.data import DataError, curves_of, files_of
from contact1d.workflow.fit.fitted import Fitted
from contact1d.workflow.fit.forward import LAWS
from contact1d.workflow.fit.plan import STIFFNESS, AnyFit, FitPlan, read_fit
from contact1d.workflow.fit.relaxing import relaxed
from contact1d.workflow.fit.solution import compared, model_of
from contact1d.workflow.fit.subject import POINT
from contact1d.workflow.runs.advised import run
from contact1d.workflow.scene import AnyScene, Scene
from contact1d.workflow.scene.read import plain_data
from contact1d.workflow.units import Quantity


@dataclass
class FitResult:
    """The results of a fit as far as it came.

    Attributes:
        file: the data.
        segments: the fits of the contact model of the base scene, to both segments together and to each alone.
        alternatives: the fits of other contact models to the same points, by the name of the model.
        difference: largest difference [N] between the forces on LAMMPS and those of the contact model; NaN without the
            run.
        allowed: largest 95 % half-width [N] of the fitted force; NaN without the run.
        warnings: messages, by the name of the warning.
        seconds: duration of the fit [s].
        finished: whether all steps were done.
    """

    file: Path
    segments: CurveFit
    alternatives: dict[str, Fitted] = field(default_factory=dict)
    difference: float = math.nan
    allowed: float = math.nan
    warnings: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0
    finished: bool = False

    @property
    def fit(self) -> Fitted:
        """The fit of both segments together; where they differ, of the retraction, or without adhesion the approach."""
        return self.segments.main

    @property
    def models(self) -> dict[str, Fitted]:
        """The fits of all contact models by name, that of the base scene included, in a new dict.

        The most likely one, of least Bayesian information criterion, is first. Models whose fit failed are missing.
        """
        fits = {self.fit.model: self.fit, **self.alternatives}
        return dict(sorted(fits.items(), key=lambda pair: pair[1].criterion))

    @property
    def bracket(self) -> tuple[float, float]:
        """The positions z of the piezo [m] at the last point before and the first after the snap-out, lower one first.

        (NaN, NaN) where the force of the retraction has no jump.
        """
        curve = self.segments.curve
        for segment in curve.segments:
            if segment.name == RETRACT and segment.jump is not None:
                low, high = sorted(float(curve.positions[segment.points[i]]) for i in segment.jump)
                return low, high
        return math.nan, math.nan

    @property
    def scene(self) -> Scene:
        """The base scene with the fitted values of its parameters and of its numbers with ±, unchecked.

        Without [adhesion] where the fitted contact model has none.
        """
        return self.fit.scene


def fit(
    data: AnyFit | AnyPath,
    base: AnyScene | Mapping[str, Any] | None = None,
    folder: AnyPath | None = None,
    progress: Progress | None = None,
    **keys: Any,
) -> FitResult:
    """Fit a measured force curve, and return the results of all contact models and of a run of the fitted scene.

        contact1d.fit("fit.toml", folder="fits/pdms")
        contact1d.fit("curve.csv", base, parameters=["adhesion.work_of_adhesion"], instrument={"stiffness": "0.2 N/m"})

    A run that fails is a warning, and another contact model that fails is left out. With a folder the results of an
    interrupted fit are written, too.

    Args:
        data: a fit file or its tables; with a `base` the curve's CSV file.
        base: the scene, or its tables without an experiment.
        folder: for fit.json, the tables and the figure; None: nothing is written.
        progress: informed of phases; None: nobody is.
        keys: of a fit file, such as parameters and instrument; they replace those of the file.

    Raises:
        SceneError: the fit file or its base scene is wrong.
        DataError: the data are no force curve, or more than one.
        FolderError: the folder has files of something else.
        UndeterminedError: the curve does not determine the parameters; with a suggested fix.
    """
    if base is None:
        plan = read_fit(data, **keys)
    else:
        given = base.given if isinstance(base, Scene) else plain_data(base)
        plan = read_fit({**keys, "data": str(Path(str(data)).absolute()), "base": given})
    read, progress = [*islice(curves_of(plan), 2)], progress or Silent()
    if len(read) != 1:
        raise DataError(f"{plan.fit.data} has several curves: contact1d fit makes a table of them, fit_many in Python")
    curve = read[0][2]
    if isinstance(curve, DataError):
        raise curve
    from contact1d.workflow.fit.report import write

    out = None if folder is None else fit_folder(Path(folder))
    begin, result = time.perf_counter(), None
    try:
        for result in _steps(plan, files_of(plan)[0], curve, progress):
            result.seconds = time.perf_counter() - begin
    finally:
        if out is not None and result is not None:
            write(result, out)
    assert result is not None
    return result


def _steps(plan: FitPlan, file: Path, curve: ForceCurve, progress: Progress) -> Iterator[FitResult]:
    """Yield one and the same result three times: after the fit, after other contact models, and after a run on LAMMPS.

    It grows in place, so that an interrupted fit is not lost. Other models are those that the base scene has the
    numbers for and that depend on a parameter; one whose fit fails is left out. A run that fails is the warning "run".

    Raises:
        UndeterminedError: the curve does not determine the parameters.
    """
    base_model = model_of(plan)
    progress.phase("fit", 1 + len(LAWS), "model")
    result = FitResult(file, fit_curve(plan, curve, base_model))
    _warn_of_fit(result)
    progress.advance(1)
    yield result
    for law in LAWS.values():
        if law != base_model and law.applies(plan.base) and any(map(law.depends_on, plan.fit.parameters)):
            with suppress(Contact1dError, ArithmeticError, np.linalg.LinAlgError):  # it does not describe the curve
                result.alternatives[law.name] = compared(result.fit, law)
        progress.advance(1)
    _warn_of_models(result)
    yield result
    progress.phase("run of the fitted scene")
    try:
        _run(result)
    except Contact1dError as error:
        result.warnings["run"] = f"the fitted scene does not run on LAMMPS: {error}"
    result.finished = True
    yield result


def _warn_of_fit(result: FitResult) -> None:
    """Add warnings to the result, by name, as far as they apply.

    "hysteresis": the segments differ. "snap_out": a predicted snap-out farther outside the two points of the measured
    one than their distance. "misfit": a reduced χ² above 3. "baseline": no points of bodies apart. "contact_point": one
    outside the curve. "prior": parameters with a ± in the base scene.
    """
    base_fit, fits, curve = result.fit, result.segments, result.segments.curve
    if fits.differing:
        result.warnings["hysteresis"] = differences(fits)
    elif name := fits.only_described:
        missing, why = next(
            iter(fits.refused.items()), (RETRACT if name == APPROACH else APPROACH, "its misfit is large")
        )
        result.warnings["hysteresis"] = (
            f"{base_fit.model} describes the {NOUNS[name]} alone, and has these numbers; of the {NOUNS[missing]}: {why}"
        )
    snap, (low, high) = float(base_fit.subject.jumps_at(base_fit.solution.values)[1]), result.bracket
    if math.isfinite(low) and not 2.0 * low - high <= snap <= 2.0 * high - low:
        result.warnings["snap_out"] = (
            f"the contact is lost between z = {low:.4g} and {high:.4g} m, and {base_fit.model} loses it at "
            f"{snap:.4g} m: compare the contact models"
        )
    misfit = max(fit.misfit for fit in fits.shown)
    if misfit > BAD:
        result.warnings["misfit"] = (
            f"residuals in contact have {misfit:.2g} times the mean square of those apart: {base_fit.model} "
            "or the profile does not describe the contact; compare the contact models and look at the residuals"
        )
    if not curve.positions.min() < base_fit.values[POINT] < curve.positions.max():
        result.warnings[POINT] = "the contact point is outside the curve: the baseline is not in it"
    if (cost := base_fit.cost_of_baseline) > 1.0:
        result.warnings["baseline"] = (
            f"the curve has no baseline: an unknown level of the force makes the widest interval {cost:.2g} times as "
            "wide; record more of the approach before the bodies touch"
        )
    uncertain = [key for key in base_fit.plan.fit.parameters if key in base_fit.plan.known]
    if uncertain:
        result.warnings["prior"] = (
            f"{', '.join(uncertain)}: the ± in the base scene counts as a measurement in addition to the curve"
        )


def differences(fits: CurveFit) -> str:
    """Return a sentence with the parameters in which the segments of a curve differ, and what that means."""
    fit, parts = fits.main, []
    for name in fits.differing:
        texts = (
            f"{Quantity(value, 0.5 * (high - low), fit.unit(name))} on {NOUNS[segment]}"
            for segment, (value, (low, high)) in fits.by_segment(name).items()
        )
        parts.append(f"{name} is {', '.join(texts)}")
    if fit.subject.model.needs:
        cause = "bodies that adhere more while they separate, or relax, do so"
    else:
        cause = (
            "bodies that relax or yield do so, and E of the approach is an apparent modulus; with a column t the "
            'terms of [viscoelasticity] can be fitted, such as parameters = ["viscoelasticity.terms[0].share"]'
        )
        pulled, uncertainty = fits.shown[-1].pull_off
        if pulled > uncertainty:
            cause += (
                f"; a pull-off force of {Quantity(pulled, uncertainty, 'N')} is that of adhesion: give [base.adhesion]"
            )
    return f"approach and retraction differ by more than their intervals: {'; '.join(parts)}: {cause}"


def _warn_of_models(result: FitResult, decisive: float = 10.0) -> None:
    """Add the warnings "model" and "adhesion" to the result, as far as they apply.

    "model": another contact model has a criterion lower by more than `decisive`. "adhesion": that of Hertz, as an
    alternative, is not higher by as much. A difference of 10 is very strong (R. E. Kass, A. E. Raftery, J. Am. Stat.
    Assoc. 90 (1995) 773).
    """
    best, *_ = result.models
    non_adhesive = [fit for fit in result.alternatives.values() if not fit.subject.model.needs]
    if any(fit.criterion < result.fit.criterion + decisive for fit in non_adhesive):
        result.warnings["adhesion"] = (
            "contact without adhesion describes the curve about as well (criteria under models): W may be 0, which its "
            "interval excludes; fit without [base.adhesion], too, and average more curves"
        )
    ahead = result.fit.criterion - result.models[best].criterion
    if best != result.fit.model and ahead > decisive:
        result.warnings["model"] = (
            f"{best} is more likely than {result.fit.model} (criterion lower by {ahead:.0f}): its values are in "
            "fit.json under models"
        )


def _run(result: FitResult, load_steps: int = 15) -> None:
    """Run the fitted scenes on LAMMPS along the displacements of the fit, and compare its forces with the model's.

    There is one scene for each fit that describes points of the curve. The `load_steps` go down from the largest fitted
    force to just before the instability. Sets `difference` and `allowed` [N] of the result to the largest ones, and
    adds the warning "run" where a difference is larger than allowed.

    Raises:
        Contact1dError: a scene does not run; both stay as they are.
    """
    rows = []
    for fit in result.segments.shown:
        if fit.plan.base.viscoelasticity is not None:
            rows.append((_difference_in_time(fit, load_steps), float(fit.spread().max())))
            continue
        F, d = fit.branch.forces, fit.branch.displacements
        least = max(int(np.argmin(fit.branch.positions(fit.values.get(STIFFNESS, math.inf)))), int(np.argmin(d)))
        top = float(np.interp((fit.forces - fit.baseline).max(), F[least:], d[least:]))
        displacements = np.linspace(top, d[least] + (top - d[least]) / load_steps, load_steps)
        scene = fit.scene.with_({"experiment": {"kind": "path", "displacements": displacements.tolist()}})
        with TemporaryDirectory(prefix="contact1d-fit-") as folder:
            curve = run(scene, Path(folder) / "run", figures=False).curve
            predicted = fit.branch.forces_at(np.asarray(curve["displacement"]), math.inf, held=True)
            rows.append((float(np.abs(np.asarray(curve["force"]) - predicted).max()), float(fit.spread().max())))
    result.difference, result.allowed = (max(column) for column in zip(*rows, strict=True))
    for difference, allowed in rows:
        if difference > allowed:
            result.warnings["run"] = (
                f"LAMMPS differs from the fit's model by up to {difference:.3g} N, more than the fit's own "
                f"uncertainty, {allowed:.3g} N: lower accuracy.tolerance in [base]"
            )


def _difference_in_time(fit: Fitted, load_steps: int) -> float:
    """Return the largest difference [N] of a run on LAMMPS from the model, of a fit of bodies that relax.

    The history has as many points of the fitted displacements as `load_steps`, with straight lines between.

    Raises:
        Contact1dError: the scene does not run.
    """
    curve, values = fit.curve, fit.solution.values
    branch, stiffness, point = fit.subject.parts(values)
    assert curve.times is not None
    d = curve.positions - point - (fit.forces - fit.baseline) / stiffness
    first = max(0, int(np.argmax(d > 0.0)) - 1)
    corners = np.unique(np.linspace(first, d.size - 1, load_steps).astype(int))
    times, d = curve.times[corners] - curve.times[first], np.append(min(0.0, d[first]), d[corners[1:]])
    history = {"kind": "history", "displacement": np.column_stack([times, d]).tolist()}
    with TemporaryDirectory(prefix="contact1d-fit-") as folder:
        table = run(fit.scene.with_({"experiment": history}), Path(folder) / "run", figures=False).curve
    t = np.asarray(table["time"])
    fine = np.union1d(np.linspace(0.0, times[-1], 4000), t)
    predicted, _ = relaxed(branch, fit.subject.terms(values), fine, np.interp(fine, times, d))
    return float(np.abs(np.asarray(table["force"]) - np.interp(t, fine, predicted)).max())


def fit_folder(folder: Path) -> Path:
    """Make the folder of a fit, or accept an empty one or that of an earlier fit, and return its path as given.

    Raises:
        FolderError: it is a file, or has files but neither fit.json nor fits.csv.
        OSError: it cannot be made.
    """
    if folder.is_file():
        raise FolderError(f"{folder} is a file; a fit needs a folder")
    records = ("fit.json", "fits.csv")
    if folder.is_dir() and any(folder.iterdir()) and not any((folder / name).exists() for name in records):
        raise FolderError(f"{folder} has files that do not belong to a fit; choose another folder")
    folder.mkdir(parents=True, exist_ok=True)
    return folder
