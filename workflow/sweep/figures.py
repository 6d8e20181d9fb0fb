"""Each result of a sweep over its axes: the first along x, the others as lines; seeds are averaged.

Where a closed form speaks of a line, it is the line, and the runs are points on it.
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
LOG_SPAN = 20.0
"""Largest value of an axis over its smallest one from which on its scale is logarithmic."""
CONSTANT = 1e-6
"""Relative spread up to which a result counts as the same at all points."""
FINE = 200
"""Points of a closed form."""
LOOKS = ("-", "--", ":", "-.")
"""Of the closed forms, one after the other."""
DARK_TO_LIGHT = ("#440154", "#46327e", "#365c8d", "#277f8e", "#1fa187", "#4ac16d", "#7ad151", "#a0da39")
"""Viridis without its light end: colours of lines that have an order."""


def sweep_charts(folder: Path, plan: SweepPlan, units: Mapping[str, str]) -> dict[str, Chart]:
    """The chart of each result that changes, over the first axis; in base units of SI where these are known.

    Args:
        folder: of the sweep, with its table.
        plan: what it is of.
        units: the results by name, with their units.
    """
    along, _ = roles_of(plan)
    words = {} if along.numbers[0] else {float(place): str(cell) for place, cell in enumerate(along.cells)}
    x = chart.Axis(title_of(plan, along), along.numbers[1] or "1", log=_spans(along.numbers[0]), ticks=words)
    found = {}
    for name, points in _points(folder, plan, units, {word: place for place, word in words.items()}).items():
        values = points.value[points.form == ""]
        # What a scene prescribes is the same everywhere, but for a search's accuracy: there is nothing to see.
        if np.ptp(values) > CONSTANT * np.abs(values).max():
            y = chart.Axis(name.replace("_", " "), units[name], log=_spans(values))
            found[name] = Chart(x, [Panel(y, _lines(points), plan.title)])
    return found


def _points(folder: Path, plan: SweepPlan, names: Iterable[str], places: Mapping[str, float]) -> dict[str, DataFrame]:
    """What a sweep has of each result, in runs and closed forms: a row for each number, with its line and its place.

    `label` is the line, by the values of the other axes; `form` a closed form, "" of a run.
    """
    from pandas import DataFrame

    along, others = roles_of(plan)
    titles = {axis.key: title_of(plan, axis) for axis in others}
    found: dict[str, list[tuple[str, str, float, float, float]]] = {name: [] for name in names}
    for row in read_table(folder):
        label = ", ".join(f"{titles[axis.key]} = {label_in(axis, row[axis.key])}" for axis in others)
        place = float(places.get(row[along.key], row[along.key]))
        theory = document_in(folder / row["run"]).get("theory", ())
        for name in (name for name in found if row[name]):
            found[name].append((label, "", place, float(row[name]), float(row[f"{name}_uncertainty"])))
            for form in theory:
                if entry := form["values"].get(name):
                    found[name].append((label, form["name"], place, entry.get("si", entry)["value"], 0.0))
    columns = ["label", "form", "place", "value", "uncertainty"]
    return {name: DataFrame(rows, columns=columns) for name, rows in found.items() if rows}


def _lines(points: DataFrame) -> list[Series]:
    """Closed forms, and above them runs as points in the same colours, of several seeds mean and standard error."""
    labels, forms = points.label.unique().tolist(), points.form.unique().tolist()
    theories, runs = [], []
    for (label, form), line in points.groupby(["label", "form"], sort=False):
        colour = DARK_TO_LIGHT[labels.index(label) * (len(DARK_TO_LIGHT) - 1) // max(1, len(labels) - 1)]
        at = line.groupby("place")
        x, y = np.asarray([*at.groups]), at.value.mean().to_numpy()
        if form:
            look = LOOKS[forms.index(form) % len(LOOKS) - 1] if x.size > 1 else "x"
            theories.append(Series(*_dense(x, y), form, colour, look))
        else:
            error = at.value.sem().fillna(at.uncertainty.first()).to_numpy()
            runs.append(Series(x, y, label or "runs", colour, "o" if len(forms) > 1 else "o:", dy=error))
    return theories + runs


def _spans(values: Collection[float]) -> bool:
    """Whether an axis of these values is logarithmic."""
    return len(values) > 0 and max(values) >= LOG_SPAN * min(values) > 0.0


def _dense(x: Array, values: Array) -> tuple[Array, Array]:
    """A closed form between the points at which it is known: monotone cubics in powers, which powers are exactly."""
    if len(x) < 3 or min(x.min(), values.min()) <= 0.0:
        return x, values
    places = np.linspace(math.log(x[0]), math.log(x[-1]), FINE)
    return np.exp(places), np.exp(PchipInterpolator(np.log(x), np.log(values))(places))


def roles_of(plan: SweepPlan) -> tuple[Axis, list[Axis]]:
    """The axis along x, and those that tell lines apart: side by side (zip) there is one line."""
    axes = [axis for axis in plan.axes if axis.key != SEED and len(axis.values) > 1] or list(plan.axes[:1])
    return axes[0], [] if plan.combine == "zip" else axes[1:]


def label_in(axis: Axis, cell: str) -> str:
    """A value of an axis in a legend: with its unit and a prefix where it has one."""
    unit = axis.numbers[1]
    return str(Quantity(float(cell), 0.0, unit)) if unit else cell


def title_of(plan: SweepPlan, axis: Axis) -> str:
    """What the key of an axis is, by its description: `radius of curvature R at the apex`."""
    allowed, data, name = allowed_by(Scene), plan.base, ".".join(axis.key.split(".")[-2:])
    for part in axis.key.split("."):
        table = allowed.table_for(data) if isinstance(data, Mapping) else None
        key = keys_of(table).get(part) if table else None
        if key is None:
            break
        allowed, data, name = key.allowed, data.get(part, {}), key.description
    return re.split(r"[,;:(]", name)[0].strip()
