"""Figures for a page, as plain data that plotly's script draws: traces and a layout."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import SAMPLE_COLUMNS, SAMPLE_TABLE, States, read_columns
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.sweep.axes import SweepPlan
from contact1d.workflow.sweep.figures import forms_of, label_of, lines_of, roles_of

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999933")
"""Okabe and Ito's, which the colour-blind can tell apart."""
ROUND_OFF = 1e-9
"""Relative distance of two places that are one."""
WIDER = 1.15
"""Half-width of a picture over that of what carries."""
DASHES = ("solid", "dash", "dot", "dashdot")
Array = NDArray[np.float64]
Chart = dict[str, Any]
ALONG = (
    ("tangential_displacement", "Tangential force over displacement", "displacement along x (LU)",
     "tangential_force", "tangential force (FU)"),
    ("time", "Displacement over time", "time (TU)", "displacement", "displacement (LU)"),
    ("time", "Friction over time", "time (TU)", "friction", "friction (FU)"),
)  # fmt: skip
"""Of what happens along x, or in time: column along x of a figure, its title and name, column along y and its name."""


@dataclass(frozen=True)
class Relation:
    """One quantity of a run over another.

    Attributes:
        title, x_name, y_name: of the figure and its axes, with units.
        x, y: columns.
        branch: of each row; None where there are none.
        mode: of plotly's traces.
    """

    title: str
    x_name: str
    y_name: str
    x: Array
    y: Array
    branch: NDArray[np.str_] | None = None
    mode: str = "lines"


def chart(title: str, x: str, y: str, traces: Iterable[Mapping[str, Any]] = (), **layout: Any) -> Chart:
    """A figure with its axes' names."""
    axis = {"showline": True, "ticks": "outside", "automargin": True}
    frame = {
        "title": {"text": title, "x": 0, "xanchor": "left", "font": {"size": 15}},
        "xaxis": {"title": {"text": x}, "zeroline": False, **axis},
        "yaxis": {"title": {"text": y}, "zerolinecolor": "#888", **axis},
        "template": "none", "margin": {"l": 70, "r": 15, "t": 45, "b": 60}, "hovermode": "closest",
        "legend": {"orientation": "h", "y": -0.22},
    }  # fmt: skip
    return {"data": list(traces), "layout": frame | layout}


def trace(x: Iterable[Any], y: Iterable[Any], name: str, colour: str, mode: str, **line: Any) -> dict[str, Any]:
    """A line, points, or both."""
    return {"x": _listed(x), "y": _listed(y), "name": name, "mode": mode, "marker": {"size": 4},
            "line": {"color": colour} | line}  # fmt: skip


def relations(run: Run) -> list[Relation]:
    """What happens along x or in time, if anything does; then force over displacement and over contact radius."""
    kept = run.folder / f"{SAMPLE_TABLE}.csv"
    columns = run.friction or (read_columns(kept, SAMPLE_COLUMNS) if kept.is_file() else {})
    mode = "markers" if "time" in columns else "lines+markers"  # a motion has no one line
    over = {"displacement": "displacement (LU), compression positive", "contact_radius": "contact radius (LU)"}
    return [
        *(
            Relation(title, x, y, columns[along], columns[column])
            for along, title, x, column, y in ALONG
            if {along, column} <= {*columns}
        ),
        *(
            Relation(
                f"Force over {name.replace('_', ' ')}", label, "force (FU)", getattr(run.curve, name), run.curve.force,
                run.curve.branch, mode,
            )
            for name, label in over.items()
        ),
    ]  # fmt: skip


def main_curve(run: Run) -> Relation:
    """The curve that the slider's mark moves on, with a row for each state."""
    branch, count = run.curve.branch, len(run.curve.force)
    for one in relations(run):
        loaded = count - len(one.x)  # a slide begins with a state under the load, before it is driven
        if 0 <= loaded <= 1:
            x, y = np.concatenate([[0.0] * loaded, one.x]), np.concatenate([[math.nan] * loaded, one.y])
            return replace(one, x=x, y=y, branch=branch)
    raise AssertionError("force over displacement has a row for each state")


def curves(runs: Mapping[str, Run]) -> list[Chart]:
    """What the runs have of `relations`, overlaid: a line for each branch of each run."""
    found: dict[str, Chart] = {}
    for (name, run), colour in zip(runs.items(), cycle(COLOURS), strict=False):
        for one in relations(run):
            if one.branch is not None and not (_moves(run) and np.isfinite(one.x).sum() > 1):
                continue
            traces = found.setdefault(one.title, chart(one.title, one.x_name, one.y_name))["data"]
            if one.branch is None:
                traces.append(trace(one.x, one.y, name, colour, one.mode))
                continue
            dashes = dict(zip(dict.fromkeys(one.branch.tolist()), cycle(DASHES), strict=False))
            for i, (branch, rows) in enumerate(legs_of(run, one.x)):
                label = branch if len(runs) == 1 else f"{name}, {branch}"
                made = trace(one.x[rows], one.y[rows], label, colour, one.mode, dash=dashes[branch])
                made |= {"legendgroup": label, "showlegend": i < len(dashes)}
                hover = f"{_with_value(one.x_name, '%{x:.5g}')}<br>force %{{y:.5g}} FU<br>state %{{customdata}}"
                traces.append(made | {"customdata": rows.tolist(), "hovertemplate": hover})
    return list(found.values())


def _moves(run: Run) -> bool:
    """Whether a body came nearer or went away at all."""
    places = run.curve.displacement
    return len(places) > 1 and float(np.ptp(places)) > ROUND_OFF * float(np.max(np.abs(places)))


def pressures(runs: Mapping[str, Run]) -> Chart | None:
    """Pressure over x of the reported states that touch."""
    traces, half = [], 0.0
    for (name, run), colour in zip(runs.items(), cycle(COLOURS), strict=False):
        for (state, profile), dash in zip(run.profiles.items(), cycle(DASHES), strict=False):
            if np.any(profile.pressure):
                label = state.replace("_", " ") if len(runs) == 1 else f"{name}, {state.replace('_', ' ')}"
                half = max(half, 1.1 * half_width(profile.x, profile.pressure))
                line = {"dash": dash, "shape": "hvh"}
                traces.append(trace(profile.x, profile.pressure, label, colour, "lines+markers", **line))
    words = "Pressure, line load of the chain", "x (LU)", "pressure (FU/LU), compression positive"
    return within(chart(*words, traces), half) if traces else None


def way(run: Run, states: States) -> dict[str, Any]:
    """What the slider moves through: for each kept state its place on the curve, profile, bodies and words."""
    curve, rows, main = run.curve, states.rows, main_curve(run)
    half, view = window(states)
    kept = {name: getattr(states, name)[:, view] for name in ("x", "z_lower", "z_upper", "pressure", "shear")}
    words = []
    for row in rows:
        radius, x, y = curve.contact_radius[row], f"{main.x[row]:.5g}", f"{main.y[row]:.5g}"
        touching = "" if math.isnan(radius) else f", contact radius {radius:.4g} LU"
        place = f"{_with_value(main.x_name, x)}, {_with_value(main.y_name, y)}"
        words.append(f"{place}, {curve.branch[row]}{touching}")
    order = np.concatenate([[*rows, -1] for _, rows in legs_of(run, main.x)])
    line = trace(np.append(main.x, math.nan)[order], np.append(main.y, math.nan)[order], "", "#999999", "lines")
    mark = {"x": [], "y": [], "mode": "markers", "marker": {"size": 12, "color": COLOURS[1]}}
    load = [_filled("pressure", COLOURS[0], shape="hvh"), _filled("shear", COLOURS[1], shape="hvh")]
    load[1]["visible"] = bool(np.any(kept["shear"]))
    bodies = [_filled("upper", COLOURS[0]), _filled("lower", COLOURS[2])]
    heights = kept["z_lower"], kept["z_upper"]
    return {
        "along": _listed(main.x[rows]), "against": _listed(main.y[rows]), "words": words,
        "start": int(np.nanargmax(np.abs(main.y[rows]))),
        "charts": [
            chart(main.title, main.x_name, main.y_name, [line, mark], showlegend=False),
            within(chart("Pressure", "x (LU)", "pressure (FU/LU)", load), half, kept["pressure"], kept["shear"]),
            within(chart("Bodies, heights drawn larger", "x (LU)", "z (LU)", bodies), half, *heights),
        ],
        **{name: [_listed(row) for row in array] for name, array in kept.items()},
    }  # fmt: skip


def _filled(name: str, colour: str, **line: Any) -> dict[str, Any]:
    """A line that the slider fills."""
    return trace((), (), name, colour, "lines+markers", **line)


def _with_value(name: str, value: str) -> str:
    """`force (FU)` and a number: `force 1.2 FU`."""
    quantity, _, rest = name.partition(" (")
    return f"{quantity} {value} {rest.partition(')')[0]}"


def legs_of(run: Run, along: Array) -> list[tuple[str, NDArray[np.int64]]]:
    """Name and rows of each leg of a prescribed path, which begins where the one before it ends.

    Otherwise of each branch, in the order of the positions `along`: a search goes to and fro.
    """
    branch, kind = run.curve.branch, run.scene.experiment
    if not (kind.way_is_given or kind.goes_along):
        rows = [np.flatnonzero(branch == name) for name in dict.fromkeys(branch.tolist())]
        return [(str(branch[part[0]]), part[np.argsort(along[part], kind="stable")]) for part in rows]
    parts = np.split(np.arange(branch.size), np.flatnonzero(branch[1:] != branch[:-1]) + 1)
    return [(str(branch[part[0]]), np.arange(max(part[0] - 1, 0), part[-1] + 1)) for part in parts]


def window(states: States) -> tuple[float, NDArray[np.bool_]]:
    """Half-width [LU] of what there is to be seen in all states, and which particles are."""
    half = WIDER * max(half_width(x, p) for x, p in zip(states.x, states.pressure, strict=True))
    return half, np.abs(states.x).min(axis=0) <= half


def within(made: Chart, half: float, *columns: Array) -> Chart:
    """The figure from -half to half [LU], and as high as what is drawn in it."""
    made["layout"]["xaxis"]["range"] = [-half, half]
    if columns:
        low, high = float(np.min(columns)), float(np.max(columns))
        margin = 0.06 * (high - low) or 1e-12
        made["layout"]["yaxis"]["range"] = [low - margin, high + margin]
    return made


def over_axes(folder: Path, plan: SweepPlan, units: Mapping[str, str]) -> list[Chart]:
    """Each result of a sweep over its axes; where a closed form speaks of a line, the runs are points on it."""
    found = []
    for name, lines in lines_of(folder, plan, units).items():
        forms = dict(zip(forms_of(lines), cycle(DASHES), strict=False))
        coloured = list(zip(lines, cycle(COLOURS), strict=False))
        traces = []
        for line, colour in coloured:
            mode = "markers" if line.forms else "lines+markers"
            errors = {"type": "data", "array": _listed(line.errors), "thickness": 1}
            made = trace(line.x, line.values, label_of(plan, line) or "runs", colour, mode)
            traces.append(made | {"marker": {"size": 7}, "error_y": errors})
        for form, dash in forms.items():
            beside = [(*line.forms[form], colour) for line, colour in coloured if form in line.forms]
            for number, (x, values, colour) in enumerate(beside):
                made = trace(x, values, form, colour, "lines" if len(x) > 1 else "markers", dash=dash)
                hover = f"{form} %{{y:.5g}}<extra></extra>"
                traces.append(made | {"legendgroup": form, "showlegend": number == 0, "hovertemplate": hover})
        along, others = roles_of(plan)
        words = name.replace("_", " ")
        shown = bool(others or forms)
        found.append(chart(words, along.title, f"{words} ({units[name]})", traces, showlegend=shown))
    return found


def half_width(x: np.ndarray[Any, Any], pressure: np.ndarray[Any, Any]) -> float:
    """Largest |x| at which there is pressure to be seen; a tenth of the body where there is none."""
    carrying = np.abs(pressure) > 0.01 * np.max(np.abs(pressure), initial=0.0)
    return float(np.max(np.abs(x[carrying]))) if carrying.any() else 0.1 * float(np.max(np.abs(x)))


def _listed(values: Iterable[Any]) -> list[Any]:
    """Numbers for JSON, in seven digits; None where there is none."""
    return [float(f"{float(v):.7g}") if math.isfinite(float(v)) else None for v in values]
