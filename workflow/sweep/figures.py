"""Charts of the results of a sweep: the first axis along x, a line for each value of the others, seeds averaged.

A line for which there is a closed form shows that form, with the runs as points.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from contact1d.analysis import chart
from contact1d.analysis.chart import Chart, Panel, Series
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.quantities import allowed_by, keys_of
from contact1d.workflow.sweep.axes import Axis, SweepPlan
from contact1d.workflow.sweep.table import document_in, read_table
from contact1d.workflow.units import Quantity

if TYPE_CHECKING:
    from pandas import DataFrame

Array = NDArray[np.float64]
SEED = "noise.seed"
LINE_STYLES = ("-", "--", ":", "-.")
"""Line styles of the closed forms, in turn."""
DARK_TO_LIGHT = ("#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#7ad151", "#a0da39")
"""Viridis without its light end: colours of lines that have an order."""


def sweep_charts(folder: Path, plan: SweepPlan, units: Mapping[str, str]) -> dict[str, Chart]:
    """Return a chart by result name, over the first axis with several values that is not the seed.

    They are in SI base units where these are known, else in units of the model. A result that changes by at most 1e-6
    of its largest magnitude, or that no run has, has no chart. An axis of a chart is logarithmic if its values are
    above 0 and span a factor of 20 or more.

    Args:
        folder: folder of the sweep, with its table; FileNotFoundError without it.
        plan: the sweep.
        units: the unit of each result of the table, by name; others have no chart.
    """
    negligible_change = 1e-6  # relative: a result that a scene prescribes changes only by the accuracy of a search
    along, _ = roles_of(plan)
    words = {} if along.numbers[0] else {float(place): str(cell) for place, cell in enumerate(along.cells)}
    x = chart.Axis(title_of(plan, along), along.numbers[1] or "1", log=_spans(along.numbers[0]), ticks=words)
    charts = {}
    points_of_all = _points(folder, plan, units, {word: place for place, word in words.items()})
    for name, points in points_of_all.groupby("result", sort=False):
        values = points.value[points.form == ""]
        if np.ptp(values) > negligible_change * np.abs(values).max():
            y = chart.Axis(name.replace("_", " "), units[name], log=_spans(values))
            charts[name] = Chart(x, [Panel(y, _lines(points))], plan.title)
    return charts


def _points(folder: Path, plan: SweepPlan, names: Iterable[str], places: Mapping[str, float]) -> DataFrame:
    """Return a table with a row for each result of each run that has a value, and for that of each closed form of it.

    Column `result` has the name of the result, `label` the values of the axes that distinguish lines ("" without any),
    `form` the name of the closed form ("" of a run), `place` the abscissa: a number of the axis along x, or the
    position of a word in it. `value` and `uncertainty` are in the units of the sweep's table; of a closed form the
    uncertainty is 0.

    Args:
        folder: folder of the sweep, with its table.
        plan: the sweep.
        names: results, each a column of the sweep's table, else KeyError.
        places: position of each word of the axis along x; empty where that has numbers.
    """
    from pandas import DataFrame

    along, series_axes = roles_of(plan)
    titles = {axis.key: title_of(plan, axis) for axis in series_axes}
    points: list[tuple[str, str, str, float, float, float]] = []
    for row in read_table(folder):
        label = ", ".join(f"{titles[axis.key]} = {label_in(axis, row[axis.key])}" for axis in series_axes)
        place = float(places.get(row[along.key], row[along.key]))
        theory = document_in(folder / row["run"]).get("theory", ())
        for name in (name for name in names if row[name]):
            points.append((name, label, "", place, float(row[name]), float(row[f"{name}_uncertainty"])))
            for form in theory:
                if entry := form["values"].get(name):
                    points.append((name, label, form["name"], place, entry.get("si", entry)["value"], 0.0))
    return DataFrame(points, columns=["result", "label", "form", "place", "value", "uncertainty"])


def _lines(points: DataFrame) -> list[Series]:
    """Return a line for each label and closed form, then a series of points for each label, the runs, in its colour.

    Values are in the unit of the table, over rising abscissas. Runs of one label and abscissa (they differ by their
    seed) are one point, the mean with its standard error; a single one has its uncertainty. A line has 200 points where
    it has three abscissas or more, and all these and its values are above 0, else those of the runs; one alone is a
    cross.
    """
    labels, forms = points.label.unique().tolist(), points.form.unique().tolist()
    theories, runs = [], []
    for (label, form), line in points.groupby(["label", "form"], sort=False):
        colour = DARK_TO_LIGHT[labels.index(label) * (len(DARK_TO_LIGHT) - 1) // max(1, len(labels) - 1)]
        at_place = line.groupby("place")
        x, y = np.asarray([*at_place.groups]), at_place.value.mean().to_numpy()
        if form:
            look = LINE_STYLES[forms.index(form) % len(LINE_STYLES) - 1] if x.size > 1 else "x"
            theories.append(Series(*_dense(x, y), form, colour, look))
        else:
            error = at_place.value.sem().fillna(at_place.uncertainty.first()).to_numpy()
            runs.append(Series(x, y, label or "runs", colour, "o" if len(forms) > 1 else "o:", dy=error))
    return theories + runs


def _spans(values: Collection[float], least_ratio: float = 20.0) -> bool:
    """Return whether values are all above 0 and span a factor of `least_ratio` or more, so that an axis is logarithmic.

    False without values.
    """
    return len(values) > 0 and max(values) >= least_ratio * min(values) > 0.0


def _dense(x: Array, values: Array, points: int = 200) -> tuple[Array, Array]:
    """Return (x, values) of a closed form at `points` abscissas in equal ratios, by monotone cubics of logarithms.

    With fewer than three abscissas, or one of x and values not above 0, these are returned as they are. `x` is rising.
    """
    if len(x) < 3 or min(x.min(), values.min()) <= 0.0:
        return x, values
    log_x = np.linspace(math.log(x[0]), math.log(x[-1]), points)
    return np.exp(log_x), np.exp(PchipInterpolator(np.log(x), np.log(values))(log_x))


def roles_of(plan: SweepPlan) -> tuple[Axis, list[Axis]]:
    """Return (the axis along x, the axes that distinguish lines, [] for none).

    Along x is the first axis that has several values and is not the seed (noise.seed), or without any the first axis of
    all. The others of these distinguish lines, in order; none does side by side (zip).
    """
    axes = [axis for axis in plan.axes if axis.key != SEED and len(axis.values) > 1] or list(plan.axes[:1])
    return axes[0], [] if plan.combine == "zip" else axes[1:]


def label_in(axis: Axis, cell: str) -> str:
    """Return the text of a table's cell in a legend: unchanged, or of an axis with one unit "2.5 µm", with a prefix.

    `cell` is then a number in base units of SI, of which five digits are written; ValueError if it is none.
    """
    unit = axis.numbers[1]
    return str(Quantity(float(cell), 0.0, unit)) if unit else cell


def title_of(plan: SweepPlan, axis: Axis) -> str:
    """Return the title of an axis from the description of its key, such as `radius of curvature R at the apex`.

    It ends before the first comma, semicolon, colon or bracket. Where the base scene does not know the key, it is the
    description of the last table on its path that it knows, or the last two parts of the key.
    """
    allowed, data, name = allowed_by(Scene), plan.base, ".".join(axis.key.split(".")[-2:])
    for part in axis.key.split("."):
        table = allowed.table_for(data) if isinstance(data, Mapping) else None
        key = keys_of(table).get(part) if table else None
        if key is None:
            break
        allowed, data, name = key.allowed, data.get(part, {}), key.description
    return re.split(r"[,;:(]", name)[0].strip()
