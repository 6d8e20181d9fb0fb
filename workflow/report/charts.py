"""Charts of a page as data for plotly's script: those of runs or of a sweep, and those that a slider moves."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from html import escape
from itertools import cycle
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.chart import BLACK, FILL, TENSION, THEORY, Axis, Chart, Panel, Series
from contact1d.analysis.curve import States
from contact1d.analysis.figures import half_width
from contact1d.workflow.runs.charts import main_curve, path_chart
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.units import LENGTH, LINE_PRESSURE, Quantity, scale_of

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999933")
"""The palette of Okabe and Ito, which colour-blind readers can distinguish."""
GREY = "#bbbbbb"
DASHES = {"": "solid", "-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
"""Plotly's names of line styles, by those of matplotlib."""
INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
"""A symbol with an index, such as F_A."""
UNBREAKABLE = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|[nµmkMG]?[mN]|[kMG]?Pa)\b|%)")
"""Spaces in a number with a unit, and around = before a number."""
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")
"""An exponent, such as ^2 or ^{2/3}."""
Data = dict[str, Any]
"""A chart in plotly's form: title, data and layout."""


def symbols(text: str) -> str:
    """Return `text` as HTML, escaped: `F_A` has an index, `R^{2/3}` an exponent.

    Spaces within a number with a unit, and around = before a number, are no-break: `R = 1000 LU` stays on one line.
    """
    unbroken = UNBREAKABLE.sub(lambda match: match[0].replace(" ", "\u00a0"), escape(text))
    indexed = INDEX.sub(r"<i>\1</i><sub>\2</sub>", unbroken)
    return EXPONENT.sub(lambda match: f"<sup>{match[1] or match[2]}</sup>", indexed)


def charts_of(runs: Mapping[str, Mapping[str, Chart]]) -> list[Data]:
    """Return a chart in plotly's form for each panel; those of several runs with one name, axes and scale are overlaid.

    They are in the order of their first appearance, in units with SI prefixes. A chart is not overlaid where it would
    cover less than 5 % of the common axes. Of a single run nothing is overlaid but panels with equal names and axes.

    Args:
        runs: by the name of a run its charts, written in base units.
    """
    groups: dict[tuple[str, ...], list[list[Chart]]] = {}
    for (run, charts), colour in zip(runs.items(), cycle(COLOURS), strict=False):
        for name, chart in charts.items():
            for panel in chart.panels:
                single = Chart(chart.x, [_of_a_run(panel, run, colour) if len(runs) > 1 else panel])
                shared = groups.setdefault((name, panel.title, chart.x.label, panel.y.label), [])
                for overlaid in shared:
                    if _fit([*overlaid, single]):
                        overlaid.append(single)
                        break
                else:
                    shared.append([single])
    return [drawn(_overlaid(charts, len(runs)).written(scale_of)) for shared in groups.values() for charts in shared]


def _fit(charts: Sequence[Chart], least_share: float = 0.05) -> bool:
    """Return whether each chart covers `least_share` of the common axes of all, along x and along y.

    Less would be a line or a dot. Each has one panel; axes are compared by their ends.
    """
    views = np.asarray([[chart.x.view, chart.panels[0].y.view] for chart in charts])
    return bool(np.all(np.ptp(views, axis=2) >= least_share * np.ptp(views, axis=(0, 2))))


def _overlaid(charts: Sequence[Chart], runs: int) -> Chart:
    """Return charts of one panel each as a single chart with the axes and titles of the first.

    Its note has the notes of its panels, the names of the runs, but is "" where all of several `runs` are in it.
    """
    panels = [chart.panels[0] for chart in charts]
    series = [line for panel in panels for line in panel.series]
    note = ", ".join(panel.note for panel in panels) * (not 1 < len(panels) == runs)
    return replace(charts[0], panels=[replace(panels[0], series=series, note=note)])


def _of_a_run(panel: Panel, run: str, colour: str) -> Panel:
    """Return a copy of the panel in the colour of its run, whose name is the note and begins the names of its series.

    Closed forms and black marks keep colour and name. A series without a name stays so, but for bars.
    """
    series = []
    for line in panel.series:
        if line.colour not in (THEORY, BLACK):
            bars = line.look == FILL and line.opacity == 1.0
            name = f"{run}, {line.name}" if line.name else run * bars
            line = replace(line, colour=colour, name=name, opacity=0.5 if bars else line.opacity)
        series.append(line)
    return replace(panel, series=series, note=run)


def drawn(chart: Chart) -> Data:
    """Return a written chart of one panel in plotly's form: "title", "data", a list of series, and "layout".

    Texts are HTML. A series that moves has a list of lists. Of series with one name the first is in the legend. Raises
    ValueError for a chart of several panels.
    """
    (panel,) = chart.panels
    names = " over ".join(filter(None, [panel.y.name, chart.x.name]))
    heading = ": ".join(filter(None, [names, panel.heading]))
    layout: Data = {}
    for key, axis in (("xaxis", chart.x), ("yaxis", panel.y)):
        layout[key] = {
            "title": {"text": _words(axis.label)}, "type": "log" if axis.log else "linear",
            "range": listed(np.log10(axis.view) if axis.log else axis.view),
            "zerolinecolor": BLACK if axis.zero else GREY,
        }  # fmt: skip
        if axis.ticks:
            layout[key] |= {"tickvals": [*axis.ticks], "ticktext": [*axis.ticks.values()]}
    shown, data = panel.legend, []
    for line in panel.series:
        data.append(_trace(line, chart.x, panel.y) | {"showlegend": line.name in shown})
        shown = [name for name in shown if name != line.name]
    return {"title": _words(heading[:1].upper() + heading[1:]), "data": data, "layout": layout}


def _trace(line: Series, x: Axis, y: Axis) -> Data:
    """Return a series in plotly's form; ±∞ are the ends of the axes, uncertainties other than 0 are bars.

    An area is filled, without a line. Numbers have seven digits, and None for NaN.
    """
    style = line.look.lstrip("o.x")
    trace: Data = {
        "x": listed(x.ended(line.x)), "y": listed(y.ended(line.y)), "name": _words(line.name),
        "legendgroup": line.name, "opacity": line.opacity,
        "line": {"color": line.colour, "width": 1.4 * line.width, "dash": DASHES.get(style)},
    }  # fmt: skip
    if line.look == FILL:
        filled = {"mode": "lines", "fill": "toself", "fillcolor": line.colour, "hoverinfo": "skip"}
        return trace | filled | {"line": {"width": 0, "color": line.colour}}
    for key, spread in (("error_x", line.dx), ("error_y", line.dy)):
        if np.any(spread):
            trace[key] = {"array": listed(spread), "thickness": 1, "width": 0, "color": line.colour}
    mode = "+".join(["lines"] * bool(style) + ["markers"] * (style != line.look))
    return trace | {"mode": mode, "marker": {"size": 4.0 + line.width / 2.0}}


def moving(run: Run, states: States) -> list[Chart]:
    """Return the charts that a slider moves: the main curve with a mark, line loads [N/m], bodies [m], with prefixes.

    The main curve is mostly force over displacement, the bodies are their heights over x. Without units of the scene
    they are in LU and FU. Each has one panel. Their series that move have a row for each state; x of particles that do
    not move along it has one row. Line load is compression positive; a shear other than 0 is drawn beside it, as it
    acts on the lower body. Particles far from the contact in all states are left out.

    Args:
        run: a finished one.
        states: its states.
    """
    main = path_chart(run.model)
    panel, (x, y, *_) = main.panels[0], main_curve(run.model).values()
    along, up = (replace(axis, remark="") for axis in (main.x, panel.y))
    mark = Series(x[states.rows, None], y[states.rows, None], "state", TENSION, "o", 16.0)
    view = np.abs(states.x).min(axis=0) <= half_width(states.x, states.pressure)
    positions = states.x[:, view]
    positions = positions if np.ptp(positions, axis=0).any() else positions[0]

    def over_x(y: Axis, **lines: NDArray[np.float32]) -> Chart:
        """Return the chart of lines by name, (states, particles) in units of the model, over x, with the axis `y`."""
        series = [
            Series(positions, values[:, view], name, colour, "o-")
            for (name, values), colour in zip(lines.items(), COLOURS, strict=False)
        ]
        return Chart(Axis("x", LENGTH), [Panel(y, series)])

    shear = {"shear": -states.shear} if states.shear.any() else {}
    charts = [
        Chart(along, [replace(panel, y=up, series=[*panel.series, mark])]),
        over_x(Axis("line load", LINE_PRESSURE), normal=states.pressure, **shear),
        over_x(Axis("z", LENGTH, ", magnified"), upper=states.z_upper, lower=states.z_lower),
    ]
    return [chart.written(run.scales.written) for chart in charts]


def path_of(run: Run, states: States) -> Data:
    """Return what a slider needs, by name: `words`, a text for each state, `start`, and `charts` in plotly's form.

    The main curve is mostly force over displacement. `words` have the position on it in five digits, the branch, and
    the contact radius where there is one. `start` is the index among `states` of the one that is shown first, that of
    the largest |y| of the main curve. `charts` are the main curve with a mark, the line load and the bodies.
    """
    charts = moving(run, states)
    curve = charts[0].panels[0]
    mark, radii, unit = curve.series[-1], run.curve.contact_radius, run.curve.units.get("contact_radius", LENGTH)
    words = []
    for row, x, y in zip(states.rows, mark.x[:, 0], mark.y[:, 0], strict=True):
        point = f"{charts[0].x.name} {x:.5g} {charts[0].x.unit}, {curve.y.name} {y:.5g} {curve.y.unit}"
        radius = "" if math.isnan(radii[row]) else f", contact radius {Quantity(radii[row], 0.0, unit)}"
        words.append(f"{point}, {run.curve.branch[row]}{radius}")
    start = int(np.nanargmax(np.abs(mark.y)))
    return {"words": words, "start": start, "charts": [drawn(chart) for chart in charts]}


def listed(values: Any) -> list[Any]:
    """Return numbers as nested lists for JSON, rounded to seven significant digits; None for those that are not finite.

    Raises TypeError for a single number.
    """
    numbers = np.asarray(values, dtype=np.float64)
    size = np.where(np.isfinite(numbers) & (numbers != 0.0), np.abs(numbers), 1.0)
    digits = 10.0 ** (6.0 - np.floor(np.log10(size)))
    rounded = (np.round(numbers * digits) / digits).astype(object)
    rounded[~np.isfinite(numbers)] = None
    return list(rounded.tolist())


def _words(text: str) -> str:
    """Return a text as HTML, escaped, with indices and exponents, without the $ of TeX: `F_A` has an index A."""
    return symbols(text.replace("$", ""))
