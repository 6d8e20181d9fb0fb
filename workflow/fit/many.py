"""Many curves under one plan: a folder of files or a map, one table with intervals, a histogram and a map."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contact1d.analysis import plots
from contact1d.files import AnyPath, whole
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.comparison import fit_curve
from contact1d.workflow.fit.data import NamedCurve, curves_of
from contact1d.workflow.fit.fit import fit_folder
from contact1d.workflow.fit.headings import DataError
from contact1d.workflow.fit.plan import AnyFit, FitPlan, read_fit
from contact1d.workflow.fit.solution import model_of
from contact1d.workflow.runs.processors import cores, pool
from contact1d.workflow.units import scale_of

if TYPE_CHECKING:
    from pandas import DataFrame

TABLE = "fits.csv"


@dataclass(frozen=True)
class Fits:
    """A finished or interrupted series of fits.

    Attributes:
        folder: with fits.csv and the figures.
        counts: number of curves by status, "done" or "refused".
    """

    folder: Path
    counts: dict[str, int]


def fit_many(source: AnyFit, folder: AnyPath, workers: int | None = None, progress: Progress | None = None) -> Fits:
    """Fit every curve of a plan's data, write fits.csv with a line for each, in order, and return folder and counts.

    A curve that cannot be read or fitted is a line of status "refused". Counts of 0 are left out. If the series is
    interrupted, the table has the curves so far.

    Args:
        source: a fit file, or its tables.
        folder: for fits.csv and the figures.
        workers: processes; None or 0: as many as there are processors.
        progress: informed of each curve; None: nobody is.

    Raises:
        SceneError: the fit file or its base scene is wrong.
        DataError: there is no file of data.
        FolderError: the folder has files of something else.
    """
    plan, progress, rows = read_fit(source), progress or Silent(), list[dict[str, Any]]()
    out = fit_folder(Path(folder))
    jobs = list(curves_of(plan))
    progress.phase("fits", len(jobs), "curve")
    try:
        with pool(workers or cores()) as executor:
            for row in executor.map(partial(attempt, plan), jobs):
                rows.append(row)
                progress.advance(1)
    finally:
        _write(plan, rows, out)
    return Fits(out, dict(Counter(row["status"] for row in rows)))


def attempt(plan: FitPlan, job: NamedCurve) -> dict[str, Any]:
    """Return the line of a curve in fits.csv by column: its fitted values and intervals in SI, or why it was refused.

    "curve", "status" ("done" or "refused") and "reason" ("" if done); in a map "x" and "y" as in the file. Of a fit,
    with its SI unit in the name, each parameter and the contact point, the "_low" and "_high" ends of its 95 % interval
    (maybe infinite for the contact point); "outliers", their number, and "reduced_chi_squared". Errors of reading, of
    the fit and of arithmetic are "refused"; any other is raised.

    `job`: name, position in a map or None, and curve or the error of reading it.
    """
    name, position, curve = job
    row: dict[str, Any] = {"curve": name, "status": "done", "reason": ""}
    if position is not None:
        row |= {"x": position[0], "y": position[1]}
    try:
        if isinstance(curve, DataError):
            raise curve
        fits = fit_curve(plan, curve, model_of(plan))
        for key in fits.estimates:
            none = {"": (math.nan, (math.nan, math.nan))}  # the column of both segments is in every table
            for segment, (value, ends) in (none | fits.by_segment(key)).items():
                name = f"{key}_{segment}" if segment else key
                for suffix, number in zip(("", "_low", "_high"), (value, *ends), strict=True):
                    row[f"{name}{suffix} [{fits.main.unit(key)}]"] = number
        row["hysteresis"] = " ".join(fits.differing) or (fits.only_described and f"only {fits.only_described}")
        row["outliers"], row["reduced_chi_squared"] = fits.main.solution.outliers.size, fits.main.misfit
    except (Contact1dError, ArithmeticError, np.linalg.LinAlgError) as error:
        row |= {"status": "refused", "reason": str(error)}
    return row


def _write(plan: FitPlan, rows: Sequence[dict[str, Any]], folder: Path) -> None:
    """Write fits.csv, and a figure of each parameter with at least two values, to a folder; nothing is returned.

    `rows`: the lines of the table in order, as dicts by column; a missing cell is empty.
    """
    from pandas import DataFrame

    table = DataFrame(rows, dtype=object)
    with whole(folder / TABLE) as path:
        table.to_csv(path, index=False, lineterminator="\n")
    for key in plan.fit.parameters:
        for name in (name for name in table if name.startswith(f"{key} [")):
            done = table[table[name].notna()]
            if len(done) > 1:
                _draw(plan, key, name, done, folder)


def _draw(plan: FitPlan, key: str, name: str, done: DataFrame, folder: Path) -> None:
    """Draw the histogram of a parameter, and its map where the curves have positions, to a PNG file in a folder.

    The file has the dotted `key` as its name. Values have an SI prefix.

    `name`: column of the parameter in the table `done`, whose rows are the curves that have it.
    """
    values = done[name].to_numpy(dtype=float)
    factor, unit = scale_of(float(np.median(values)), name.rpartition("[")[2].rstrip("]"))
    label, has_map = f"{key.rpartition('.')[2].replace('_', ' ')} ({unit})", "x" in done
    figure = plots.new_figure((10.0 if has_map else 5.0, 4.0))
    axes = figure.subplots(1, 1 + has_map, squeeze=False)[0]
    axes[0].hist(factor * values, bins="auto", color="#0072B2")
    plots.describe(axes[0], label, "curves", plan.fit.title, zero=False)
    if has_map:
        x, y = (done[column].to_numpy(dtype=float) for column in "xy")
        points = axes[1].scatter(x, y, c=factor * values, marker="s", cmap="viridis")
        axes[1].set_aspect("equal")
        plots.describe(axes[1], "x", "y", zero=False)
        figure.colorbar(points, ax=axes[1], label=label)
    plots.save_figure(figure, folder / f"{key}.png")
