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
from contact1d.workflow.fit.curve import ForceCurve
from contact1d.workflow.fit.data import DataError, curves_of, files_of
from contact1d.workflow.fit.forward import LAWS
from contact1d.workflow.fit.plan import STIFFNESS, AnyFit, FitPlan, read_fit
from contact1d.workflow.fit.solution import Fitted, compared, fitted, model_of
from contact1d.workflow.fit.subject import OFFSET, POINT
from contact1d.workflow.runs.advised import run
from contact1d.workflow.scene import AnyScene, Scene
from contact1d.workflow.scene.read import plain_data

LOAD_STEPS = 15
"""Of the run that the found scene is compared with."""


@dataclass
class Found:
    """A fit as far as it came.

    Attributes:
        file: the data.
        fit: the curve under the contact model of the base scene.
        others: by name, other contact models on the same points.
        difference, allowed: largest one of the forces on LAMMPS from the model's, and the fit's own uncertainty [N].
        warnings: by name.
        seconds: that it took.
        finished: whether all was done.
    """

    file: Path
    fit: Fitted
    others: dict[str, Fitted] = field(default_factory=dict)
    difference: float = math.nan
    allowed: float = math.nan
    warnings: dict[str, str] = field(default_factory=dict)
    seconds: float = 0.0
    finished: bool = False

    @property
    def models(self) -> dict[str, Fitted]:
        """All contact models, the most likely one first."""
        known = {self.fit.model: self.fit, **self.others}
        return dict(sorted(known.items(), key=lambda pair: pair[1].criterion))

    @property
    def bracket(self) -> tuple[float, float]:
        """Positions z [m] between which the contact is lost; NaN where the force does not jump."""
        segment = self.fit.curve.segments[1]
        if segment.jump is None:
            return math.nan, math.nan
        low, high = sorted(float(self.fit.curve.positions[segment.points[i]]) for i in segment.jump)
        return low, high

    @property
    def scene(self) -> Scene:
        """See `Fitted.scene`."""
        return self.fit.scene


def fit(
    data: AnyFit | AnyPath,
    base: AnyScene | Mapping[str, Any] | None = None,
    folder: AnyPath | None = None,
    progress: Progress | None = None,
    **keys: Any,
) -> Found:
    """Fit a measured force curve.

        contact1d.fit("fit.toml", folder="fits/pdms")
        contact1d.fit("curve.csv", base, parameters=["adhesion.work_of_adhesion"], instrument={"stiffness": "0.2 N/m"})

    Args:
        data: a fit file or its tables; with a `base` the curve's CSV file.
        base: the scene, or its tables without an experiment.
        folder: for fit.json, the tables and the figure; None: nothing is written.
        progress: informed of phases.
        keys: of a fit file, such as parameters and instrument.

    Raises:
        SceneError: the fit file or its base scene is wrong.
        DataError: the curve is none.
        UndeterminedError: it does not tell what was asked for; what would help.
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

    out = None if folder is None else own_folder(Path(folder))
    begin, found = time.perf_counter(), None
    try:
        for found in _steps(plan, files_of(plan)[0], curve, progress):
            found.seconds = time.perf_counter() - begin
    finally:
        if out is not None and found is not None:
            write(found, out)
    assert found is not None
    return found


def _steps(plan: FitPlan, file: Path, curve: ForceCurve, progress: Progress) -> Iterator[Found]:
    """The fit after each of its steps, so that what is known is there when it is broken off."""
    own = model_of(plan)
    progress.phase("fit", 1 + len(LAWS), "model")
    found = Found(file, fitted(plan, curve, own))
    _judge(found)
    progress.advance(1)
    yield found
    for law in LAWS.values():
        if law != own and law.applies(plan.base) and any(map(law.depends_on, plan.fit.parameters)):
            with suppress(Contact1dError, ArithmeticError, np.linalg.LinAlgError):  # it does not describe the curve
                found.others[law.name] = compared(found.fit, law)
        progress.advance(1)
    _judge_models(found)
    yield found
    progress.phase("run of the found scene")
    try:
        _run(found)
    except Contact1dError as error:
        found.warnings["run"] = f"the found scene does not run on LAMMPS: {error}"
    found.finished = True
    yield found


def _judge(found: Found) -> None:
    """Warn of what the fit itself shows."""
    one = found.fit
    segment, snap = one.curve.segments[1], float(one.jumps_at(one.solution.values)[1])
    if segment.jump is not None:
        low, high = found.bracket
        if not 2.0 * low - high <= snap <= 2.0 * high - low:
            found.warnings["snap_out"] = (
                f"the contact is lost between z = {low:.4g} and {high:.4g} m, and {one.model} loses it at {snap:.4g} "
                "m: compare the contact models"
            )
    if one.misfit > MISFIT:
        found.warnings["misfit"] = (
            f"residuals in contact have {one.misfit:.2g} times the mean square of those apart: {one.model} or the "
            "profile does not describe the contact; compare the contact models and look at the residuals"
        )
    if not one.curve.positions.min() < one.values[POINT] < one.curve.positions.max():
        found.warnings[POINT] = "the contact point is outside the curve: the baseline is not in it"
    shared = [key for key in one.plan.fit.parameters if key in one.plan.known]
    if shared:
        found.warnings["prior"] = (
            f"{', '.join(shared)}: the ± in the base scene counts as a measurement beside the curve"
        )


MISFIT = 3.0
"""Particles χ² of a warning: with a memory of 20 in 1000 points that of the right model is below 2."""
DECISIVE = 10.0
"""Difference of criteria that counts as very strong (Kass and Raftery)."""


def _judge_models(found: Found) -> None:
    best, *_ = found.models
    free = [one for one in found.others.values() if not one.subject.model.needs]
    if any(one.criterion < found.fit.criterion + DECISIVE for one in free):
        found.warnings["adhesion"] = (
            "contact without adhesion describes the curve about as well (criteria under models): W may be 0, which its "
            "interval leaves out; fit without [base.adhesion], too, and average more curves"
        )
    ahead = found.fit.criterion - found.models[best].criterion
    if best != found.fit.model and ahead > DECISIVE:
        found.warnings["model"] = (
            f"{best} is more likely than {found.fit.model} (criterion lower by {ahead:.0f}): its values are in "
            "fit.json under models"
        )


def _run(found: Found) -> None:
    """The found scene on LAMMPS along the displacements of the fit, beside the model."""
    one, branch = found.fit, found.fit.branch
    F, d = branch.forces, branch.displacements
    least = max(int(np.argmin(branch.positions(one.values.get(STIFFNESS, math.inf)))), int(np.argmin(d)))
    top = float(np.interp(one.forces.max() - one.values[OFFSET], F[least:], d[least:]))
    places = np.linspace(top, d[least] + (top - d[least]) / LOAD_STEPS, LOAD_STEPS)
    scene = found.scene.with_({"experiment": {"kind": "path", "displacements": places.tolist()}})
    with TemporaryDirectory(prefix="contact1d-fit-") as folder:
        curve = run(scene, Path(folder) / "run", figures=False).curve
        predicted = branch.at(np.asarray(curve["displacement"]), math.inf, held=True)
        found.difference = float(np.abs(np.asarray(curve["force"]) - predicted).max())
    found.allowed = float(one.spread().max())
    if found.difference > found.allowed:
        found.warnings["run"] = (
            f"LAMMPS differs from the fit's model by up to {found.difference:.3g} N, more than the fit's own "
            f"uncertainty, {found.allowed:.3g} N: lower accuracy.tolerance in [base]"
        )


def own_folder(folder: Path) -> Path:
    """Make the folder, or see that it is that of a fit. Raises FolderError."""
    if folder.is_file():
        raise FolderError(f"{folder} is a file; a fit needs a folder")
    known = ("fit.json", "fits.csv")
    if folder.is_dir() and any(folder.iterdir()) and not any((folder / name).exists() for name in known):
        raise FolderError(f"{folder} has files that do not belong to a fit; choose another folder")
    folder.mkdir(parents=True, exist_ok=True)
    return folder
