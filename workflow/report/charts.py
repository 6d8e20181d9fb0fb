"""Figures for a page, as plain data that plotly's script draws: traces and a layout."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import SAMPLE_TABLE, States, read_samples
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
    ("time", "Friction over time", "time (TU)", ("friction", "friction (FU)")),
    ("time", "Displacement over time", "time (TU)", ("displacement", "displacement (LU)")),
    ("tangential_displacement", "Tangential force over displacement", "displacement along x (LU)",
     ("tangential_force", "tangential force (FU)")),
)  # fmt: skip
"""Of what happens along x, or in time: column along x of a figure, its title and name, column along y and its name."""
DRAWN: dict[str, Any] = {"x": [], "y": [], "mode": "lines+markers", "marker": {"size": 4}}
"""A line that the slider fills."""


def chart(title: str, x: str, y: str, traces: Iterable[Mapping[str, Any]], **layout: Any) -> Chart:
    """A figure with its axes' names."""
    frame = {
        "title": {"text": title, "x": 0, "xanchor": "left", "font": {"size": 15}},
        "xaxis": {"title": {"text": x}, "zeroline": False, "showline": True, "ticks": "outside",
                  "automargin": True},
        "yaxis": {"title": {"text": y}, "zerolinecolor": "#888", "showline": True, "ticks": "outside",
                  "automargin": True},
        "template": "none", "margin": {"l": 70, "r": 15, "t": 45, "b": 60}, "hovermode": "closest",
        "legend": {"orientation": "h", "y": -0.22},
    }  # fmt: skip
    return {"data": list(traces), "layout": frame | layout}


def trace(x: Iterable[Any], y: Iterable[Any], name: str, colour: str, mode: str, **line: Any) -> dict[str, Any]:
    """A line, points, or both."""
    return {"x": _listed(x), "y": _listed(y), "name": name, "mode": mode, "marker": {"size": 4},
            "line": {"color": colour} | line}  # fmt: skip


def curves(runs: Mapping[str, Run]) -> list[Chart]:
    """Force over displacement and over contact radius of the runs, overlaid; of a slide friction over time."""
    found: list[Chart] = []
    for key, title, x, y in ALONG:
        every = {name: _over_time(run) for name, run in runs.items()}
        kept = {name: columns for name, columns in every.items() if {key, y[0]} <= {*columns}}
        traces = [
            trace(columns[key], columns[y[0]], name, colour, "lines")
            for (name, columns), colour in zip(kept.items(), _colours(len(kept)), strict=True)
        ]
        if traces:
            found.insert(0, chart(title, x, y[1], traces))
    moved = {name: run for name, run in runs.items() if _moves(run.curve.displacement)}
    touching = {name: run for name, run in moved.items() if np.isfinite(run.curve.contact_radius).sum() > 1}
    for column, label, some in (
        ("displacement", "displacement (LU), compression positive", moved),
        ("contact_radius", "contact radius (LU)", touching),
    ):
        if some:
            title = f"Force over {column.replace('_', ' ')}"
            found.append(chart(title, label, "force (FU)", _traces(some, column, "force")))
    return found


def _moves(places: Array) -> bool:
    """Whether a body came nearer or went away at all."""
    return len(places) > 1 and float(np.ptp(places)) > ROUND_OFF * float(np.max(np.abs(places)))


def _traces(runs: Mapping[str, Run], x: str, y: str) -> list[dict[str, Any]]:
    """A line for each branch of each run; hovering tells all columns of the state."""
    traces = []
    for (name, run), colour in zip(runs.items(), _colours(len(runs)), strict=True):
        mode = "markers" if "time" in _over_time(run) else "lines+markers"  # a motion has no one line
        branches = rows_of_branches(run.curve.branch, run.curve.displacement)
        for (branch, rows), dash in zip(branches.items(), DASHES * len(branches), strict=False):
            label = branch if len(runs) == 1 else f"{name}, {branch}"
            made = trace(getattr(run.curve, x)[rows], getattr(run.curve, y)[rows], label, colour, mode, dash=dash)
            hover = f"{x.replace('_', ' ')} %{{x:.5g}}<br>{y} %{{y:.5g}}<br>state %{{customdata}}"
            traces.append(made | {"customdata": rows.tolist(), "hovertemplate": hover})
    return traces


def pressures(runs: Mapping[str, Run]) -> Chart | None:
    """Pressure over x of the reported states that touch."""
    traces = []
    for (name, run), colour in zip(runs.items(), _colours(len(runs)), strict=True):
        for (state, profile), dash in zip(run.profiles.items(), DASHES * len(run.profiles), strict=False):
            if np.any(profile.pressure):
                label = state.replace("_", " ") if len(runs) == 1 else f"{name}, {state.replace('_', ' ')}"
                traces.append(
                    trace(profile.x, profile.pressure, label, colour, "lines+markers", dash=dash, shape="hvh")
                )
    if not traces:
        return None
    half = 1.1 * max(half_width(np.asarray(trace["x"]), np.asarray(trace["y"])) for trace in traces)
    made = chart("Pressure, line load of the chain", "x (LU)", "pressure (FU/LU), compression positive", traces)
    made["layout"]["xaxis"]["range"] = [-half, half]
    return made


def way(run: Run, states: States) -> dict[str, Any]:
    """What the slider moves through: for each kept state its place on the curve, profile, bodies and words."""
    curve, rows = run.curve, states.rows
    half, view = window(states)
    kept = {name: getattr(states, name)[:, view] for name in ("x", "z_lower", "z_upper", "pressure", "shear")}
    title, name_x, name_y, x, y = main_curve(run)
    words = []
    for row in rows:
        radius = curve.contact_radius[row]
        touching = "" if math.isnan(radius) else f", contact radius {radius:.4g} LU"
        words.append(f"{_with_value(name_x, x[row])}, {_with_value(name_y, y[row])}, {curve.branch[row]}{touching}")
    force = chart(title, name_x, name_y, [
        {**_branches(x, y, curve.branch), "mode": "lines", "line": {"color": "#999999"}},
        {"x": [], "y": [], "mode": "markers", "marker": {"size": 12, "color": COLOURS[1]}},
    ], showlegend=False)  # fmt: skip
    sheared = bool(np.any(kept["shear"]))
    load = chart("Pressure", "x (LU)", "pressure (FU/LU)", [
        DRAWN | {"name": "pressure", "line": {"color": COLOURS[0], "shape": "hvh"}},
        DRAWN | {"name": "shear", "line": {"color": COLOURS[1], "shape": "hvh"}, "visible": sheared},
    ])  # fmt: skip
    bodies = chart("Bodies, heights drawn larger", "x (LU)", "z (LU)", [
        DRAWN | {"name": "upper", "line": {"color": COLOURS[0]}},
        DRAWN | {"name": "lower", "line": {"color": COLOURS[2]}},
    ])  # fmt: skip
    for made, columns in ((load, ("pressure", "shear")), (bodies, ("z_lower", "z_upper"))):
        made["layout"]["xaxis"]["range"] = [-half, half]
        made["layout"]["yaxis"]["range"] = _range(*(kept[name] for name in columns))
    return {
        "along": _listed(x[rows]), "against": _listed(y[rows]), "words": words,
        "start": int(np.nanargmax(np.abs(y[rows]))),
        "charts": [force, load, bodies], **{name: [_listed(row) for row in array] for name, array in kept.items()},
    }  # fmt: skip


def _with_value(name: str, value: float) -> str:
    """`force (FU)` and a number: `force 1.2 FU`."""
    quantity, _, unit = name.partition(" (")
    return f"{quantity} {value:.5g} {unit.rstrip(')')}"


def _branches(x: Array, y: Array, branch: NDArray[np.str_]) -> dict[str, list[Any]]:
    """A line through the states, branch after branch, with a gap between them."""
    places: list[float] = []
    values: list[float] = []
    for rows in rows_of_branches(branch, x).values():
        places += [*x[rows], math.nan]
        values += [*y[rows], math.nan]
    return {"x": _listed(places), "y": _listed(values)}


def rows_of_branches(branch: NDArray[np.str_], along: Array) -> dict[str, NDArray[np.int64]]:
    """The rows of each branch, by name, in the order of the places `along`: a search goes to and fro."""
    found = {}
    for name in dict.fromkeys(branch.tolist()):
        rows = np.flatnonzero(branch == name)
        found[name] = rows[np.argsort(along[rows], kind="stable")]
    return found


def window(states: States) -> tuple[float, NDArray[np.bool_]]:
    """Half-width [LU] of what there is to be seen in all states, and which particles are."""
    half = WIDER * max(half_width(x, p) for x, p in zip(states.x, states.pressure, strict=True))
    return half, np.abs(states.x).min(axis=0) <= half


def main_curve(run: Run) -> tuple[str, str, str, Array, Array]:
    """The curve that the slider's mark moves on: title, names of the axes, and the columns, a row for each state."""
    count, columns = len(run.curve.force), _over_time(run)
    for key, title, x, (column, y) in ALONG:
        if {key, column} <= {*columns} and 0 <= count - len(columns[key]) <= 1:
            loaded = count - len(columns[key])  # a slide begins with a state under the load, before it is driven
            along, against = (
                np.concatenate([[first] * loaded, columns[name]]) for name, first in ((key, 0.0), (column, math.nan))
            )
            return title, x, y, along, against
    return "Force over displacement", "displacement (LU)", "force (FU)", run.curve.displacement, run.curve.force


def _over_time(run: Run) -> Mapping[str, Array]:
    """What a run has besides its curve, row by row: friction, or samples under heat."""
    kept = run.folder / f"{SAMPLE_TABLE}.csv"
    return run.friction or (read_samples(kept) if kept.is_file() else {})


def over_axes(folder: Path, plan: SweepPlan, units: Mapping[str, str]) -> list[Chart]:
    """Each result of a sweep over its axes; where a closed form speaks of a line, the runs are points on it."""
    found = []
    for name, lines in lines_of(folder, plan, units).items():
        forms, colours = dict(zip(forms_of(lines), cycle(DASHES), strict=False)), _colours(len(lines))
        traces = []
        for line, colour in zip(lines, colours, strict=True):
            mode = "markers" if line.forms else "lines+markers"
            errors = {"type": "data", "array": _listed(line.errors), "thickness": 1}
            made = trace(line.x, line.values, label_of(plan, line) or "runs", colour, mode)
            traces.append(made | {"marker": {"size": 7}, "error_y": errors})
        for form, dash in forms.items():
            beside = [
                (*line.forms[form], colour) for line, colour in zip(lines, colours, strict=True) if form in line.forms
            ]
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


def _range(*columns: np.ndarray[Any, Any]) -> list[float]:
    low, high = min(float(c.min()) for c in columns), max(float(c.max()) for c in columns)
    margin = 0.06 * (high - low) or 1e-12
    return [low - margin, high + margin]


def _colours(count: int) -> list[str]:
    return [COLOURS[place % len(COLOURS)] for place in range(count)]


def _listed(values: Iterable[Any]) -> list[Any]:
    """Numbers for JSON, in seven digits; None where there is none."""
    return [float(f"{float(v):.7g}") if math.isfinite(float(v)) else None for v in values]
