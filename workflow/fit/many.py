"""Many curves under one plan: a folder of files or a map, one table with intervals, a histogram and a map."""

from __future__ import annotations

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
from contact1d.workflow.fit.data import DataError, NamedCurve, curves_of
from contact1d.workflow.fit.fit import own_folder
from contact1d.workflow.fit.plan import AnyFit, FitPlan, read_fit
from contact1d.workflow.fit.report import entry
from contact1d.workflow.fit.solution import fitted, model_of
from contact1d.workflow.runs.processors import cores, pool
from contact1d.workflow.units import scale_of

if TYPE_CHECKING:
    from pandas import DataFrame

TABLE = "fits.csv"


@dataclass(frozen=True)
class Fits:
    """A finished or interrupted series: its folder, and how many curves ended as done or refused."""

    folder: Path
    counts: dict[str, int]


def fit_many(source: AnyFit, folder: AnyPath, workers: int | None = None, progress: Progress | None = None) -> Fits:
    """Fit every curve that a plan's data name; DIR/fits.csv has a line for each, in their order.

    Args:
        source: a fit file, or its tables.
        folder: for fits.csv and the figures.
        workers: processes; None: as many as there are processors.
        progress: informed of each curve.
    """
    plan, progress, rows = read_fit(source), progress or Silent(), list[dict[str, Any]]()
    out = own_folder(Path(folder))
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
    """The line of the table of one curve: what it says, or why it says nothing."""
    name, place, curve = job
    row: dict[str, Any] = {"curve": name, "status": "done", "reason": ""}
    if place is not None:
        row |= {"x": place[0], "y": place[1]}
    try:
        if isinstance(curve, DataError):
            raise curve
        found = fitted(plan, curve, model_of(plan))
        for key, ends in found.intervals.items():
            label = f"[{entry(found, key)['unit']}]"
            for part, value in zip(("", "_low", "_high"), (found.values[key], *ends), strict=True):
                row[f"{key}{part} {label}"] = value
        row["outliers"], row["reduced_chi_squared"] = found.solution.outliers.size, found.misfit
    except (Contact1dError, ArithmeticError, np.linalg.LinAlgError) as error:
        row |= {"status": "refused", "reason": str(error)}
    return row


def _write(plan: FitPlan, rows: Sequence[dict[str, Any]], folder: Path) -> None:
    """The table and the figures."""
    from pandas import DataFrame

    table = DataFrame(rows, dtype=object)
    with whole(folder / TABLE) as part:
        table.to_csv(part, index=False, lineterminator="\n")
    for key in plan.fit.parameters:
        for name in (name for name in table if name.startswith(f"{key} [")):
            done = table[table[name].notna()]
            if len(done) > 1:
                _draw(plan, key, name, done, folder)


def _draw(plan: FitPlan, key: str, name: str, done: DataFrame, folder: Path) -> None:
    """Histogram of a parameter, and beside it its map where the curves have places."""
    values = done[name].to_numpy(dtype=float)
    factor, unit = scale_of(float(np.median(values)), name.rpartition("[")[2].rstrip("]"))
    label, has_map = f"{key.rpartition('.')[2].replace('_', ' ')} ({unit})", "x" in done
    figure = plots.new_figure((10.0 if has_map else 5.0, 4.0))
    axes = figure.subplots(1, 1 + has_map, squeeze=False)[0]
    axes[0].hist(factor * values, bins="auto", color="#0072B2")
    plots.describe(axes[0], label, "curves", plan.fit.title, zero=False)
    if has_map:
        x, y = (done[place].to_numpy(dtype=float) for place in "xy")
        shown = axes[1].scatter(x, y, c=factor * values, marker="s", cmap="viridis")
        axes[1].set_aspect("equal")
        plots.describe(axes[1], "x", "y", zero=False)
        figure.colorbar(shown, ax=axes[1], label=label)
    plots.save_figure(figure, folder / f"{key.rpartition('.')[2]}.png")
