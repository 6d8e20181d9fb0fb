"""Charts of a page, as plain data that plotly's script draws: of runs or of a sweep, and those that a slider moves."""

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
"""Okabe and Ito's, which the colour-blind can tell apart."""
GREY = "#bbbbbb"
DASHES = {"": "solid", "-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
"""Plotly's names of line styles."""
INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
TOGETHER = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|[nµmkMG]?[mN]|[kMG]?Pa)\b|%)")
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")
LEAST_SHARE = 0.05
"""Of both axes of a panel that a run needs: a smaller curve beside those of other runs would be a line or a dot."""
Data = dict[str, Any]
"""What plotly draws."""


def symbols(text: str) -> str:
    """Return `text` as HTML, escaped: `F_A` has an index, `R^{2/3}` an exponent, no line ends inside `R = 1000 LU`."""
    whole = TOGETHER.sub(lambda found: found[0].replace(" ", "\u00a0"), escape(text))
    indexed = INDEX.sub(r"<i>\1</i><sub>\2</sub>", whole)
    return EXPONENT.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", indexed)


def charts_of(runs: Mapping[str, Mapping[str, Chart]]) -> list[Data]:
    """A chart for each panel of each chart; those of the same name, axes and scale are overlaid.

    Args:
        runs: by the name of a run its charts, written in base units.
    """
    found: dict[tuple[str, ...], list[list[Chart]]] = {}
    for (run, charts), colour in zip(runs.items(), cycle(COLOURS), strict=False):
        for name, chart in charts.items():
            for panel in chart.panels:
                own = Chart(chart.x, [_of_a_run(panel, run, colour) if len(runs) > 1 else panel])
                shared = found.setdefault((name, panel.title, chart.x.label, panel.y.label), [])
                for overlaid in shared:
                    if _fit([*overlaid, own]):
                        overlaid.append(own)
                        break
                else:
                    shared.append([own])
    return [drawn(_overlaid(charts, len(runs)).written(scale_of)) for shared in found.values() for charts in shared]


def _fit(charts: Sequence[Chart]) -> bool:
    """Whether each chart of one panel has LEAST_SHARE of the axes that are common to them."""
    views = np.asarray([[chart.x.view, chart.panels[0].y.view] for chart in charts])
    return bool(np.all(np.ptp(views, axis=2) >= LEAST_SHARE * np.ptp(views, axis=(0, 2))))


def _overlaid(charts: Sequence[Chart], runs: int) -> Chart:
    """Charts of one panel in one; that of all runs needs no note of whose it is."""
    panels = [chart.panels[0] for chart in charts]
    series = [one for panel in panels for one in panel.series]
    note = ", ".join(panel.note for panel in panels) * (not 1 < len(panels) == runs)
    return replace(charts[0], panels=[replace(panels[0], series=series, note=note)])


def _of_a_run(panel: Panel, run: str, colour: str) -> Panel:
    """The panel among those of other runs: in the colour of its run, whose name is the note; theories as they are."""
    series = []
    for one in panel.series:
        if one.colour not in (THEORY, BLACK):
            bars = one.look == FILL and one.opacity == 1.0
            name = f"{run}, {one.name}" if one.name else run * bars
            one = replace(one, colour=colour, name=name, opacity=0.5 if bars else one.opacity)
        series.append(one)
    return replace(panel, series=series, note=run)


def drawn(chart: Chart) -> Data:
    """A written chart of one panel for plotly; a series that moves has a list for each state."""
    (panel,) = chart.panels
    heading = ": ".join(filter(None, [f"{panel.y.name} over {chart.x.name}", panel.heading]))
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
    for one in panel.series:
        data.append(_trace(one, chart.x, panel.y) | {"showlegend": one.name in shown})
        shown = [name for name in shown if name != one.name]
    return {"title": _words(heading[:1].upper() + heading[1:]), "data": data, "layout": layout}


def _trace(one: Series, x: Axis, y: Axis) -> Data:
    look = one.look.lstrip("o.x")
    trace: Data = {
        "x": listed(x.ended(one.x)), "y": listed(y.ended(one.y)), "name": _words(one.name), "legendgroup": one.name,
        "opacity": one.opacity, "line": {"color": one.colour, "width": 1.4 * one.width, "dash": DASHES.get(look)},
    }  # fmt: skip
    if one.look == FILL:
        filled = {"mode": "lines", "fill": "toself", "fillcolor": one.colour, "hoverinfo": "skip"}
        return trace | filled | {"line": {"width": 0, "color": one.colour}}
    for key, spread in (("error_x", one.dx), ("error_y", one.dy)):
        if np.any(spread):
            trace[key] = {"array": listed(spread), "thickness": 1, "width": 0, "color": one.colour}
    mode = "+".join(["lines"] * bool(look) + ["markers"] * (look != one.look))
    return trace | {"mode": mode, "marker": {"size": 4.0 + one.width / 2.0}}


def moving(run: Run, states: States) -> list[Chart]:
    """What a slider moves: a mark on the main curve, line loads and bodies; their series have a row for each state."""
    main = path_chart(run.model)
    panel, (x, y, *_) = main.panels[0], main_curve(run.model).values()
    along, up = (replace(axis, remark="") for axis in (main.x, panel.y))
    mark = Series(x[states.rows, None], y[states.rows, None], "state", TENSION, "o", 16.0)
    view = np.abs(states.x).min(axis=0) <= half_width(states.x, states.pressure)
    places = states.x[:, view]
    places = places if np.ptp(places, axis=0).any() else places[0]

    def over_x(y: Axis, **lines: NDArray[np.float32]) -> Chart:
        series = [
            Series(places, values[:, view], name, colour, "o-")
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
    """The charts that the slider moves, what each state is in words, and where it begins: at the largest force."""
    charts = moving(run, states)
    curve = charts[0].panels[0]
    mark, radii, unit = curve.series[-1], run.curve.contact_radius, run.curve.units.get("contact_radius", LENGTH)
    words = []
    for row, x, y in zip(states.rows, mark.x[:, 0], mark.y[:, 0], strict=True):
        place = f"{charts[0].x.name} {x:.5g} {charts[0].x.unit}, {curve.y.name} {y:.5g} {curve.y.unit}"
        radius = "" if math.isnan(radii[row]) else f", contact radius {Quantity(radii[row], 0.0, unit)}"
        words.append(f"{place}, {run.curve.branch[row]}{radius}")
    start = int(np.nanargmax(np.abs(mark.y)))
    return {"words": words, "start": start, "charts": [drawn(chart) for chart in charts]}


def listed(values: Any) -> list[Any]:
    """Numbers for JSON, in seven digits; None where there is none."""
    numbers = np.asarray(values, dtype=np.float64)
    size = np.where(np.isfinite(numbers) & (numbers != 0.0), np.abs(numbers), 1.0)
    digits = 10.0 ** (6.0 - np.floor(np.log10(size)))
    found = (np.round(numbers * digits) / digits).astype(object)
    found[~np.isfinite(numbers)] = None
    return list(found.tolist())


def _words(text: str) -> str:
    """A text with marks of TeX as HTML."""
    return symbols(text.replace("$", ""))
