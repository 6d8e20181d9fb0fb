"""Each result of a sweep over its axes: the first along x, the others as lines; seeds are averaged.

Where a closed form speaks of a line, it is the line, and the runs are points on it.
"""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contact1d.analysis.plots import SIZE, THEORY, new_figure, save_figure
from contact1d.workflow.runs.report import FORMATS, RESULTS
from contact1d.workflow.sweep.axes import Axis, SweepPlan
from contact1d.workflow.sweep.table import cell, read_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SEED = "noise.seed"
MOST_LINES = 8
"""Lines that a legend names; more are told apart by colour along the second axis."""
LOG_SPAN = 20.0
"""Largest value of an axis over its smallest one from which on its scale is logarithmic."""
CONSTANT = 1e-6
"""Relative spread up to which a result counts as the same at all points."""

STYLES = ("-", "--", ":", "-.")
"""Of the closed forms, one after the other."""
Labels = tuple[str, ...]
Line = dict[float, list[tuple[float, float]]]
"""By place on the first axis, values and uncertainties: one for each seed."""
Theory = dict[str, dict[Labels, dict[float, float]]]
"""What closed forms say of one result: by their names, the labels of a line, and the place on the first axis."""


def draw(folder: Path, plan: SweepPlan, units: Mapping[str, str], form: str = FORMATS[0]) -> None:
    """A figure <quantity>.png for each result, in the sweep's folder.

    Args:
        folder: of the sweep, with its table.
        plan: what it is of.
        units: the results by name, with their units.
        form: png, svg or pdf.
    """
    beside = theories_of(folder, plan)
    for name, unit in units.items():
        lines = lines_of(folder, plan, name)
        if _varies(lines):
            save_figure(sweep_figure(plan, name, unit, lines, beside.get(name, {})), folder / f"{name}.{form}")


def sweep_figure(
    plan: SweepPlan, name: str, unit: str, lines: Mapping[Labels, Line], beside: Theory | None = None
) -> Figure:
    """One result over the first axis, a line for each combination of the others; closed forms in the lines' colours."""
    along, others = roles_of(plan)
    figure = new_figure(SIZE)
    axis = figure.subplots()
    colours = _colours(len(lines))
    for (labels, line), colour in zip(lines.items(), colours, strict=True):
        places = sorted(line)
        means, errors = np.transpose([mean_of(line[place]) for place in places])
        covered = any(labels in said for said in (beside or {}).values())
        words = [f"{short(other.key)} = {label}" for other, label in zip(others, labels, strict=True)]
        axis.errorbar(
            places, means, errors, marker="o", markersize=4, capsize=2, linewidth=1.2, color=colour,
            linestyle="none" if covered else "-", label=", ".join(words) or ("runs" if beside else None),
        )  # fmt: skip
        for said, style in zip((beside or {}).values(), STYLES * len(beside or {}), strict=False):
            at = sorted(said.get(labels, {}))
            mark = "x" if len(at) == 1 else ""
            axis.plot(
                at, [said[labels][place] for place in at], style, marker=mark, color=colour, linewidth=1.6, zorder=1
            )
    named = [
        axis.plot([], [], style, color=THEORY, linewidth=1.6, label=form)[0]
        for form, style in zip(beside or {}, STYLES * len(beside or {}), strict=False)
    ]
    _scale(axis, along)
    along_unit = along.numbers()[1]
    axis.set_xlabel(f"{along.key} ({along_unit})" if along_unit else along.key)
    axis.set_ylabel(f"{name.replace('_', ' ')} ({unit})" if unit != "1" else name.replace("_", " "))
    axis.set_title(plan.title, loc="left", fontsize=10)
    if (others or beside) and len(lines) <= MOST_LINES:
        axis.legend(frameon=False, fontsize=8)
    elif others:
        if named:
            axis.legend(handles=named, frameon=False, fontsize=8)
        first, last = (", ".join(labels) for labels in (next(iter(lines)), list(lines)[-1]))
        names = ", ".join(short(other.key) for other in others)
        axis.text(
            0.99, 1.01, f"{names}: {first} (dark) … {last} (light)", transform=axis.transAxes, ha="right", fontsize=8
        )
    return figure


def roles_of(plan: SweepPlan) -> tuple[Axis, list[Axis]]:
    """The axis along x, and those that tell lines apart: side by side (zip) there is one line."""
    axes = [axis for axis in plan.axes if axis.key != SEED and len(axis.values) > 1] or list(plan.axes[:1])
    return axes[0], [] if plan.combine == "zip" else axes[1:]


def lines_of(folder: Path, plan: SweepPlan, name: str) -> dict[tuple[str, ...], Line]:
    """The rows of a sweep's table that have a result, by the labels of the other axes and the place on the first."""
    along, others = roles_of(plan)
    lines: dict[tuple[str, ...], Line] = defaultdict(lambda: defaultdict(list))
    places = _places(along)
    for row in read_table(folder):
        if row[name] == "":
            continue
        value, uncertainty = float(row[name]), float(row[f"{name}_uncertainty"])
        lines[tuple(row[other.key] for other in others)][places[row[along.key]]].append((value, uncertainty))
    return lines


def theories_of(folder: Path, plan: SweepPlan) -> dict[str, Theory]:
    """What the closed forms beside the runs of a sweep say, by the names of results; seeds say the same."""
    along, others = roles_of(plan)
    places = _places(along)
    found: dict[str, Theory] = {}
    for row in read_table(folder):
        labels, place = tuple(row[other.key] for other in others), places[row[along.key]]
        for form in _beside(folder, row):
            for name, said in form["values"].items():
                found.setdefault(name, {}).setdefault(form["name"], {}).setdefault(labels, {})[place] = said["value"]
    return found


def _beside(folder: Path, row: Mapping[str, str]) -> list[dict[str, Any]]:
    """The closed forms of the run of a row of the table."""
    if row["status"] != "done":
        return []
    try:
        document = json.loads((folder / row["run"] / RESULTS).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []
    return list(document.get("theory", ()))


def _varies(lines: Mapping[tuple[str, ...], Line]) -> bool:
    """Whether there is anything to see: what a scene prescribes is the same everywhere, but for a search's accuracy."""
    values = [value for line in lines.values() for seeds in line.values() for value, _ in seeds]
    return len(values) > 1 and max(values) - min(values) > CONSTANT * max(map(abs, values))


def _places(axis: Axis) -> dict[str, float]:
    """Where each value of an axis is drawn: numbers at their place, words one after the other."""
    numbers = axis.numbers()[0] or tuple(map(float, range(len(axis.values))))
    return {str(cell(value)): place for value, place in zip(axis.values, numbers, strict=True)}


def mean_of(known: list[tuple[float, float]]) -> tuple[float, float]:
    """Mean and standard error of several seeds; value and uncertainty of one."""
    values, uncertainties = np.transpose(known)
    if len(values) == 1:
        return float(values[0]), float(uncertainties[0])
    return float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values)))


def _scale(axis: Axes, along: Axis) -> None:
    """Logarithmic where the values span much; words under their places."""
    numbers, _ = along.numbers()
    if not numbers:
        axis.set_xticks(range(len(along.values)), [str(cell(value)) for value in along.values])
    elif min(numbers) > 0.0 and max(numbers) >= LOG_SPAN * min(numbers):
        axis.set_xscale("log")


def _colours(count: int) -> list[Any]:
    from matplotlib import colormaps

    return list(colormaps["viridis"](np.linspace(0.0, 0.85, count)))


def short(key: str) -> str:
    """The last two words of a dotted key: `attraction.range`."""
    return ".".join(key.split(".")[-2:])
