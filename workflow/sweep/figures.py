"""Each result of a sweep over its axes: the first along x, the others as lines; seeds are averaged.

Where a closed form speaks of a line, it is the line, and the runs are points on it.
"""

from __future__ import annotations

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from contact1d.analysis.plots import THEORY, describe, in_si, legend, panels, save_figure
from contact1d.workflow.runs.report import FORMATS
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.quantities import allowed_by, keys_of
from contact1d.workflow.sweep.axes import Axis, SweepPlan
from contact1d.workflow.sweep.table import cell, document_in, read_table
from contact1d.workflow.units import UNKNOWN, Quantity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
SEED = "noise.seed"
MOST_LINES = 8
"""Lines that a legend names; more are distinguished by colour along the second axis."""
LOG_SPAN = 20.0
"""Largest value of an axis over its smallest one from which on its scale is logarithmic."""
CONSTANT = 1e-6
"""Relative spread up to which a result counts as the same at all points."""
FINE = 200
"""Points of a closed form."""
STYLES = ("-", "--", ":", "-.")
"""Of the closed forms, one after the other."""


@dataclass(frozen=True)
class Line:
    """One result along the first axis of a sweep.

    Attributes:
        labels: values of the other axes.
        x: places on the first axis, rising.
        values, errors: there; of several seeds mean and standard error, of one value and uncertainty.
        forms: what closed forms say beside it, by their names: places, and values there.
    """

    labels: tuple[str, ...]
    x: Array
    values: Array
    errors: Array
    forms: Mapping[str, tuple[Array, Array]]


def draw(folder: Path, plan: SweepPlan, units: Mapping[str, str], form: str = FORMATS[0]) -> None:
    """A figure <quantity>.png for each result, in the sweep's folder.

    Args:
        folder: of the sweep, with its table.
        plan: what it is of.
        units: the results by name, with their units.
        form: png, svg or pdf.
    """
    for name, figure in sweep_figures(folder, plan, units):
        save_figure(in_si(figure, UNKNOWN), folder / f"{name}.{form}")


def sweep_figures(folder: Path, plan: SweepPlan, units: Mapping[str, str]) -> Iterator[tuple[str, Figure]]:
    """The name and the figure of each result, in base units of SI where these are known; arguments as of `draw`."""
    for name, lines in lines_of(folder, plan, units).items():
        values = np.concatenate([line.values for line in lines])
        # What a scene prescribes is the same everywhere, but for a search's accuracy: there is nothing to see.
        if np.ptp(values) > CONSTANT * np.abs(values).max():
            yield name, sweep_figure(plan, name, units[name], lines)


def lines_of(folder: Path, plan: SweepPlan, names: Iterable[str]) -> dict[str, list[Line]]:
    """The lines of each result in a sweep's table that has a value anywhere; seeds say the same of closed forms."""
    along, others = roles_of(plan)
    words = {} if along.numbers[0] else {str(cell(value)): place for place, value in enumerate(along.values)}
    known: dict[str, Any] = {name: defaultdict(lambda: defaultdict(list)) for name in names}
    said: dict[str, Any] = defaultdict(lambda: defaultdict(lambda: defaultdict(dict)))
    for row in read_table(folder):
        labels = tuple(label_in(other, row[other.key]) for other in others)
        place = float(words.get(row[along.key], row[along.key]))
        for name in known:
            if row[name]:
                known[name][labels][place].append((float(row[name]), float(row[f"{name}_uncertainty"])))
        for form in document_in(folder / row["run"]).get("theory", ()):
            for name, entry in form["values"].items():
                said[name][labels][form["name"]][place] = entry.get("si", entry)["value"]
    return {
        name: [_line(labels, seeds, said[name][labels]) for labels, seeds in lines.items()]
        for name, lines in known.items()
        if lines
    }


def _line(
    labels: tuple[str, ...], seeds: Mapping[float, list[tuple[float, float]]], said: Mapping[str, dict[float, float]]
) -> Line:
    x, means = sorted(seeds), []
    for place in x:
        values, uncertainties = np.transpose(seeds[place])
        one = len(values) == 1
        means.append((values.mean(), uncertainties[0] if one else values.std(ddof=1) / math.sqrt(len(values))))
    forms = {form: tuple(np.transpose(sorted(values.items()))) for form, values in said.items()}
    values, errors = np.transpose(means)
    return Line(labels, np.asarray(x), values, errors, forms)


def forms_of(lines: Iterable[Line]) -> list[str]:
    """The closed forms beside any of the lines."""
    return list(dict.fromkeys(form for line in lines for form in line.forms))


def sweep_figure(plan: SweepPlan, name: str, unit: str, lines: Sequence[Line]) -> Figure:
    """One result over the first axis, a line for each combination of the others; closed forms in the lines' colours."""
    from matplotlib import colormaps

    along, others = roles_of(plan)
    figure, (axis,) = panels()
    styles = dict(zip(forms_of(lines), cycle(STYLES), strict=False))
    for line, colour in zip(lines, colormaps["viridis"](np.linspace(0.0, 0.85, len(lines))), strict=True):
        axis.errorbar(
            line.x, line.values, line.errors, marker="o", markersize=4, capsize=2, linewidth=1.2, color=colour,
            linestyle="none" if line.forms else ":", label=label_of(plan, line) or ("runs" if styles else None),
        )  # fmt: skip
        for form, (x, values) in line.forms.items():
            axis.plot(*_dense(x, values), styles[form], marker="x" if len(x) == 1 else "", color=colour, zorder=1)
    named = [axis.plot([], [], style, color=THEORY, linewidth=1.6, label=form)[0] for form, style in styles.items()]
    _scale(axis, along, np.concatenate([line.values for line in lines]))
    words = name.replace("_", " ")
    describe(
        axis,
        title_of(plan, along, along.numbers[1]),
        words if unit == "1" else f"{words} ({unit})",
        plan.title,
        zero=False,
    )
    if (others or styles) and len(lines) <= MOST_LINES:
        legend(axis, size=8)
    elif others:
        if named:
            axis.legend(handles=named, frameon=False, fontsize=8)
        first, last = (", ".join(lines[end].labels) for end in (0, -1))
        text = f"{', '.join(_short(other.key) for other in others)}: {first} (dark) … {last} (light)"
        axis.text(0.99, 1.01, text, transform=axis.transAxes, ha="right", fontsize=8)
    return figure


def _dense(x: Array, values: Array) -> tuple[Array, Array]:
    """A closed form between the points at which it is known: monotone cubics in powers, which powers are exactly."""
    if len(x) < 3 or min(x.min(), values.min()) <= 0.0:
        return x, values
    places = np.linspace(math.log(x[0]), math.log(x[-1]), FINE)
    return np.exp(places), np.exp(PchipInterpolator(np.log(x), np.log(values))(places))


def label_of(plan: SweepPlan, line: Line) -> str:
    """What tells a line from the others: `attraction.range = 0.3`; "" where there is one only."""
    others = roles_of(plan)[1]
    return ", ".join(f"{title_of(plan, other, '')} = {label}" for other, label in zip(others, line.labels, strict=True))


def roles_of(plan: SweepPlan) -> tuple[Axis, list[Axis]]:
    """The axis along x, and those that tell lines apart: side by side (zip) there is one line."""
    axes = [axis for axis in plan.axes if axis.key != SEED and len(axis.values) > 1] or list(plan.axes[:1])
    return axes[0], [] if plan.combine == "zip" else axes[1:]


def label_in(axis: Axis, cell: str) -> str:
    """A value of an axis in a legend: with its unit and a prefix where it has one."""
    unit = axis.numbers[1]
    return str(Quantity(float(cell), 0.0, unit)) if unit else cell


def title_of(plan: SweepPlan, axis: Axis, unit: str) -> str:
    """What the key of an axis is, by its description, with its unit: `radius of curvature R at the apex (m)`."""
    allowed, data, name = allowed_by(Scene), plan.base, _short(axis.key)
    for part in axis.key.split("."):
        table = allowed.table_for(data) if isinstance(data, Mapping) else None
        key = keys_of(table).get(part) if table else None
        if key is None:
            break
        allowed, data, name = key.allowed, data.get(part, {}), key.description
    name = re.split(r"[,;:(]", name)[0].strip()
    return f"{name} ({unit})" if unit else name


def _scale(axis: Axes, along: Axis, values: Array) -> None:
    """Logarithmic where the values span much; words under their places."""
    numbers, _ = along.numbers
    if not numbers:
        axis.set_xticks(range(len(along.values)), [str(cell(value)) for value in along.values])
    elif min(numbers) > 0.0 and max(numbers) >= LOG_SPAN * min(numbers):
        axis.set_xscale("log")
    if values.min() > 0.0 and values.max() >= LOG_SPAN * values.min():
        axis.set_yscale("log")


def _short(key: str) -> str:
    """The last two words of a dotted key: `attraction.range`."""
    return ".".join(key.split(".")[-2:])
