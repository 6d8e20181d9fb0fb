"""Charts of a page, as plain data that plotly's script draws: the figures of runs or of a sweep, interactive."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import escape
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import States
from contact1d.analysis.plots import THEORY, UNIT
from contact1d.workflow.runs.finished import Run, legs_of, main_curve
from contact1d.workflow.units import LENGTH, LINE_PRESSURE, NUMBER, Quantity, Scales, scale_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLACK = "#000000"
"""Of axes and marks, which no run has for its own."""
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999933")
"""Okabe and Ito's, which the colour-blind can tell apart."""
WIDER = 1.15
"""Half-width of a picture over that of what carries."""
GAP = (math.nan, math.nan)
"""Between the parts of a line."""
DASHES = {"-": "solid", "--": "dash", ":": "dot", "-.": "dashdot"}
"""Plotly's names of line styles."""
INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
TOGETHER = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|[nµmkMG]?[mN]|[kMG]?Pa)\b|%)")
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")
Array = NDArray[np.float64]
Chart = dict[str, Any]


def symbols(text: str) -> str:
    """Return `text` as HTML, escaped: `F_A` has an index, `R^{2/3}` an exponent, no line ends inside `R = 1000 LU`."""
    whole = TOGETHER.sub(lambda found: found[0].replace(" ", "\u00a0"), escape(text))
    indexed = INDEX.sub(r"<i>\1</i><sub>\2</sub>", whole)
    return EXPONENT.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", indexed)


def charts_of(drawn: Mapping[str, tuple[Mapping[str, Figure], Scales]]) -> list[Chart]:
    """A chart for each panel of each figure; figures of the same name and units are overlaid.

    Args:
        drawn: by the name of a run its figures, in units of the model or of SI, and what the former stand for.
    """
    found: dict[tuple[str, ...], Chart] = {}
    for (run, (figures, scales)), colour in zip(drawn.items(), cycle(COLOURS), strict=False):
        for figure_name, figure in figures.items():
            for axes in figure.axes:
                labels = [axes.get_xlabel() or figure.axes[-1].get_xlabel(), axes.get_ylabel()]
                units = [one[1] if (one := UNIT.search(label)) else NUMBER for label in labels]
                factors, shown = zip(*(scales.base(unit) for unit in units), strict=True)
                names = [label.replace(f"({u})", f"({s})") for label, u, s in zip(labels, units, shown, strict=True)]
                title = scales.in_words(axes.get_title(loc="left"))
                title = title.partition(",")[0] if len(drawn) > 1 else title
                made = found.setdefault(
                    (figure_name, title, *names),
                    _chart(names, [], title=title, types=(axes.get_xscale(), axes.get_yscale())) | {"units": shown},
                )
                ends = np.asarray([axes.get_xlim(), axes.get_ylim()]) * np.transpose([factors])
                made.setdefault("ends", []).append(ends)
                for trace in _traces(axes, factors, scales.in_words):
                    own = _of_a_run(trace, run, colour) if len(drawn) > 1 else trace
                    named = [other["name"] for other in made["data"]]
                    made["data"].append(own | {"showlegend": bool(own["name"]) and own["name"] not in named})
    return [_with_prefixes(made) for made in found.values()]


def _of_a_run(trace: Chart, run: str, colour: str) -> Chart:
    """The trace among those of other runs: in the colour and name of its run; theories as they are."""
    if trace["line"]["color"] in (THEORY, BLACK):
        return trace
    bars = trace.get("opacity") == 1.0
    name = f"{run}, {trace['name']}" if trace["name"] else run * bars
    own = {"name": name, "line": trace["line"] | {"color": colour}, "fillcolor": colour}
    return trace | own | ({"opacity": 0.5} if bars else {})


def _chart(
    names: Sequence[str], data: list[Any], *ends: Any, title: str = "", types: Sequence[str] = ("linear", "linear")
) -> Chart:
    """A chart of these axes, which says what is over what; `ends`: numbers that each axis is to show."""
    what = " over ".join(name.partition(" (")[0] for name in reversed(names))
    axis = {"showline": True, "ticks": "outside", "automargin": True, "zerolinecolor": "#888"}
    heading = symbols(f"{what[:1].upper()}{what[1:]}{': ' if title else ''}{title}".replace("$", ""))
    layout: Chart = {
        **{f"{key}axis": {"title": {"text": symbols(name.replace("$", ""))}, "type": kind, **axis}
           for key, name, kind in zip("xy", names, types, strict=True)},
        "template": "none", "margin": {"l": 70, "r": 15, "t": 30, "b": 65}, "hovermode": "closest",
        "legend": {"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom"},
    }  # fmt: skip
    for key, values in zip("xy", ends, strict=False):
        low, high = float(np.min(values)), float(np.max(values))
        margin = 0.06 * (high - low) * (key == "y")
        layout[f"{key}axis"]["range"] = [low - margin, high + margin]
    return {"title": heading, "data": data, "layout": layout}


def _traces(axes: Axes, factors: Sequence[float], in_words: Callable[[str], str]) -> Iterator[dict[str, Any]]:
    """What is drawn in a panel: lines, bars and bands."""
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.colors import to_hex
    from matplotlib.container import ErrorbarContainer

    labels = {
        container[0]: container.get_label() for container in axes.containers if isinstance(container, ErrorbarContainer)
    }

    def trace(artist: Any, transform: Any, parts: Iterable[Any], colour: Any, **more: Any) -> dict[str, Any]:
        separate = [np.vstack([np.asarray(part, dtype=float), GAP]) for part in parts]
        points = np.concatenate(separate)[:-1]
        for column, (limits, within) in enumerate(
            ((axes.get_xlim(), axes.get_yaxis_transform()), (axes.get_ylim(), axes.get_xaxis_transform()))
        ):
            if transform == within:  # a line across the panel: a share of its width or height
                points[:, column] = limits[0] + points[:, column] * (limits[1] - limits[0])
        label = in_words(str(labels.get(artist, artist.get_label())))
        return {
            "x": points[:, 0] * factors[0], "y": points[:, 1] * factors[1], "mode": "lines",
            "name": "" if label.startswith("_") else symbols(label.replace("$", "")),
            "line": {"color": to_hex(colour), "dash": "solid", "simplify": False},
        } | more  # fmt: skip

    filled = {"fill": "toself", "hoverinfo": "skip"}
    for patch in axes.patches:
        corners = patch.get_patch_transform().transform(patch.get_path().vertices)
        fill = {"fillcolor": to_hex(patch.get_facecolor()), "opacity": patch.get_alpha() or 1.0}
        yield trace(patch, patch.get_data_transform(), [corners], patch.get_facecolor()) | filled | fill
    for one in axes.collections:
        if isinstance(one, LineCollection) and one.get_segments():
            yield trace(one, one.get_transform(), one.get_segments(), one.get_colors()[0])
        elif isinstance(one, PolyCollection) and one.get_paths():
            colour = np.atleast_2d(one.get_facecolor())[0]
            fill = {"fillcolor": to_hex(colour), "opacity": one.get_alpha() or 1.0}
            yield trace(one, one.get_transform(), [path.vertices for path in one.get_paths()], colour) | filled | fill
    for line in axes.lines:
        marks = ["markers"] * (line.get_marker() in ("o", ".", "x"))
        mode = "+".join(["lines"] * (line.get_linestyle() in DASHES) + marks)
        points = np.column_stack(line.get_data())
        if mode and points.size:
            made = trace(line, line.get_transform(), [points], line.get_color(), mode=mode)
            made["line"]["dash"] = DASHES.get(str(line.get_linestyle()), "solid")
            yield made | {"marker": {"size": 5}}


def _with_prefixes(made: Chart) -> Chart:
    """The chart with prefixes of SI by the size of its numbers, as lists; its axes show what all its figures do."""
    ends = np.asarray(made.pop("ends"))
    for key, unit, low, high in zip("xy", made.pop("units"), ends.min(axis=(0, 2)), ends.max(axis=(0, 2)), strict=True):
        factor, name = scale_of(max(abs(low), abs(high)), unit)
        axis = made["layout"][f"{key}axis"]
        axis["title"]["text"] = axis["title"]["text"].replace(f"({unit})", f"({name})")
        logarithmic = axis["type"] == "log"
        axis["range"] = [math.log10(end * factor) if logarithmic else end * factor for end in (low, high)]
        for trace in made["data"]:
            trace[key] = listed(trace[key] * factor)
    return made


def path_of(run: Run, states: States) -> dict[str, Any]:
    """What the slider moves through: for each kept state its place on the main curve, profile, bodies and words."""

    def shown(unit: str, *arrays: Any) -> tuple[str, list[Any]]:
        factor, name = run.scales.written(max(float(np.nanmax(np.abs(array))) for array in arrays), unit)
        return name, [array * factor for array in arrays]

    columns, rows = main_curve(run.model), states.rows
    half, view = window(states)
    length, (x, ends) = shown(LENGTH, states.x[:, view], np.asarray([-half, half]))
    height, bodies = shown(LENGTH, states.z_upper[:, view], states.z_lower[:, view])
    load, loads = shown(LINE_PRESSURE, states.pressure[:, view], -states.shear[:, view])
    names, curve = [], []
    for name, (unit, column) in columns.items():
        unit, (values,) = shown(unit, column)
        names.append(f"{name} ({unit})")
        curve.append(values)
    words = []
    for row in rows:
        place = ", ".join(_with_value(name, values[row]) for name, values in zip(names, curve, strict=True))
        radius = Quantity(run.curve.contact_radius[row], 0.0, run.curve.units.get("contact_radius", LENGTH))
        words.append(
            f"{place}, {run.curve.branch[row]}{'' if math.isnan(radius.value) else f', contact radius {radius}'}"
        )
    order = np.concatenate([[*at, -1] for _, at in legs_of(run, curve[0])])
    line = [listed(np.append(values, math.nan)[order]) for values in curve]
    mark = _line("", COLOURS[1]) | {"mode": "markers", "marker": {"size": 12}}
    along = f"x ({length})"
    return {
        "along": listed(curve[0][rows]), "against": listed(curve[1][rows]), "words": words,
        "start": int(np.nanargmax(np.abs(curve[1][rows]))),
        "charts": [
            _chart(names, [_line("", "#999999") | dict(zip("xy", line, strict=True)), mark]),
            _chart([along, f"line load ({load})"],
                   [_line("normal"), _line("shear", COLOURS[1], bool(loads[1].any()))], ends, loads),
            _chart([along, f"z ({height}), magnified"], [_line("upper"), _line("lower", COLOURS[2])], ends, bodies),
        ],
        "x": [listed(row) for row in x],
        "loads": [[listed(row) for row in one] for one in loads],
        "bodies": [[listed(row) for row in one] for one in bodies],
    }  # fmt: skip


def _with_value(name: str, value: float) -> str:
    """`force (FU)` and a number: `force 1.2 FU`."""
    quantity, _, unit = name.partition(" (")
    return f"{quantity} {value:.5g} {unit[:-1]}"


def _line(name: str, colour: str = COLOURS[0], shown: bool = True) -> Chart:
    """A line that the slider fills."""
    return {"x": [], "y": [], "name": name, "mode": "lines+markers", "visible": shown, "marker": {"size": 4},
            "line": {"color": colour}, "showlegend": bool(name)}  # fmt: skip


def window(states: States) -> tuple[float, NDArray[np.bool_]]:
    """Half-width [LU] of what there is to be seen in all states, and which particles are."""
    half = WIDER * max(half_width(x, p) for x, p in zip(states.x, states.pressure, strict=True))
    return half, np.abs(states.x).min(axis=0) <= half


def half_width(x: np.ndarray[Any, Any], pressure: np.ndarray[Any, Any]) -> float:
    """Largest |x| at which there is pressure to be seen; a tenth of the body where there is none."""
    carrying = np.abs(pressure) > 0.01 * np.max(np.abs(pressure), initial=0.0)
    return float(np.max(np.abs(x[carrying]))) if carrying.any() else 0.1 * float(np.max(np.abs(x)))


def listed(values: Iterable[Any]) -> list[Any]:
    """Numbers for JSON, in seven digits; None where there is none."""
    return [float(f"{float(v):.7g}") if math.isfinite(float(v)) else None for v in values]
