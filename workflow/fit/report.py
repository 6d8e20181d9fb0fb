"""The files of a fit: fit.json with all that is needed to repeat it, curve.csv, and a figure for a paper; all in SI."""

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
from contact1d.workflow.fit.fit import FitResult
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.solution import SOFTEST, Fitted
from contact1d.workflow.fit.subject import OFFSET, POINT, modulus_of
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene.problems import tables_as_toml
from contact1d.workflow.units import Quantity, scale_of

RECORD, TABLE, FIGURE = "fit.json", "curve.csv", "fit.png"
UNITS = {POINT: "m", OFFSET: "N", STIFFNESS: "N/m"}


def write(result: FitResult, folder: Path) -> None:
    """Write fit.json, curve.csv, scene.toml and fit.png to an existing folder, in place of earlier ones.

    Each file is written whole or not at all; all are in SI. A number that is not finite is null in fit.json.
    """
    from pandas import DataFrame

    fit = result.fit
    finite = json.loads(json.dumps(document(result)), parse_constant=lambda constant: None)
    write_whole(folder / RECORD, json.dumps(finite, indent=2, ensure_ascii=False, allow_nan=False) + "\n")
    write_whole(folder / "scene.toml", tables_as_toml(fit.scene.tables))
    points = np.arange(fit.forces.size)
    table = DataFrame(
        {
            "line": fit.curve.lines,
            "segment": [curves.SEGMENTS[kind] for kind in fit.curve.kinds],
            "position [m]": fit.curve.positions,
            "force [N]": fit.curve.forces,
            "predicted force [N]": fit.forces,
            "compared": np.where(np.isin(points, fit.solution.problem.kept), "yes", "no"),
        }
    )
    write_whole(folder / TABLE, table.to_csv(index=False, float_format="%.9g", lineterminator="\n"))
    plots.save_figure(plots.draw(chart(result).written(scale_of)), folder / FIGURE)


def document(result: FitResult) -> dict[str, Any]:
    """Return the content of fit.json, in SI, as far as the fit came; its result is not changed.

    "run" is None before the run on LAMMPS, and has NaN where that failed; the "bracket" of the snap-out is None without
    a jump, and "tabor_parameter" without adhesion or a radius.
    """
    fit, plan, curve = result.fit, result.fit.plan, result.fit.curve
    best, kept, outliers = fit.solution.best, fit.solution.problem.kept, fit.solution.outliers
    z, F = curve.positions[kept], curve.forces[kept]
    least = next(iter(result.models.values())).criterion
    return {
        "title": plan.fit.title,
        "status": "done" if result.finished else "interrupted",
        "data": str(result.file),
        "model": fit.model,
        "parameters": entries(fit, plan.fit.parameters),
        "fitted": modulus_words(fit),
        "contact_modulus": _modulus(fit),
        "calibrations": entries(fit, [key for key in fit.values if key not in (*plan.fit.parameters, *UNITS)]),
        **entries(fit, UNITS),
        "noise": {
            "value": best.deviation, "unit": "N", "share_with_memory": best.noise.share, "memory": best.noise.memory,
        },
        "correlation": {"names": fit.subject.names, "matrix": np.round(fit.correlation, 4).tolist()},
        "reduced_chi_squared": fit.misfit,
        "points": {"in_file": curve.positions.size, "compared": kept.size},
        "fitted_range": {"position": [z.min(), z.max()], "force": [F.min(), F.max()], "units": ["m", "N"]},
        "outliers": [
            {"line": int(curve.lines[i]), "position": curve.positions[i], "force": curve.forces[i]} for i in outliers
        ],
        "snap_out": {
            "position": fit.jumps_at(fit.solution.values)[1],
            "bracket": None if math.isnan(result.bracket[0]) else result.bracket,
            "unit": "m",
        },
        "models": {
            name: {
                "criterion_above_least": model_fit.criterion - least,
                "reduced_chi_squared": model_fit.misfit,
                "parameters": entries(model_fit, plan.fit.parameters),
            }
            for name, model_fit in result.models.items()
        },
        "tabor_parameter": _tabor(fit),
        "run": {"difference": result.difference, "allowed": result.allowed, "unit": "N"} if result.finished else None,
        "settings": {
            "coverage": search.LEVEL, "jump": curves.JUMP, "left_out_beside_a_jump": curves.BESIDE_JUMP,
            "outlier": search.OUTLIER, "starts": search.STARTS, "softest_cantilever": SOFTEST,
        },
        "fit": plan.fit.model_dump(exclude_none=True),
        "base": plan.base.tables,
        "known": dict(plan.known),
        "versions": {name: version(name) for name in ("contact1d", "lammps", "numpy", "scipy")},
        "seconds": result.seconds,
        "warnings": [{"name": name, "message": message} for name, message in result.warnings.items()],
    }  # fmt: skip


def entry(fit: Fitted, key: str) -> dict[str, Any]:
    """Return {"value", "unit", "interval"} of an unknown of a fit, in SI: the interval [lower, upper] is that of 95 %.

    Without "interval" where it has none: a nuisance parameter other than the contact point, or a model that is compared
    only. `key`: a dotted key of the scene, "contact_point", "force_offset" or "instrument.stiffness".

    Raises:
        KeyError: the fit has no such unknown.
    """
    table: dict[str, Any] = {"value": fit.values[key], "unit": UNITS.get(key) or fit.plan.unit(key)}
    return table | ({"interval": list(fit.intervals[key])} if key in fit.intervals else {})


def entries(fit: Fitted, keys: Iterable[str]) -> dict[str, Any]:
    """Return {"value", "unit", "interval"} in SI by key, in order, of the keys that are unknowns of a fit.

    Other keys are left out, and "interval" where an unknown has none.
    """
    return {key: entry(fit, key) for key in keys if key in fit.values}


def modulus_words(fit: Fitted) -> str:
    """Return a sentence, without a full stop, on which modulus is fitted: E*, or E with the assumed ν of its body.

    It has the number of ν, but not that of the modulus. Of several fitted moduli it is on the first one. Without any it
    says that the modulus is that of the base scene.
    """
    key = next((key for key in fit.plan.fit.parameters if key.endswith("_modulus")), None)
    if key is None:
        return "no modulus is fitted: it is that of the base scene"
    if key.endswith("contact_modulus"):
        return "E* is fitted: no Poisson's ratio is assumed"
    ratio = getattr(fit.subject.scene.material, key.split(".")[1]).poisson_ratio
    return f"E is fitted with ν = {ratio:g} assumed; the curve determines E* alone, and another ν changes E as 1 − ν²"


def _modulus(fit: Fitted) -> dict[str, Any]:
    """Return {"value", "unit", "interval"} of the contact modulus E* of the fitted scene [Pa].

    "interval", [lower, upper] of 95 %, is there only if exactly one number of the material has one.
    """
    keys, scene = [key for key in fit.intervals if key.startswith("material.")], fit.scene
    ends = fit.intervals[keys[0]] if len(keys) == 1 else ()
    interval = sorted(modulus_of(scene.moved(keys[0], end / fit.values[keys[0]])) for end in ends)
    return {"value": modulus_of(scene), "unit": "Pa"} | ({"interval": interval} if interval else {})


def _tabor(fit: Fitted) -> dict[str, Any] | None:
    """Return {"value", "range", "assumed"} of the Tabor parameter µ = (R W²/(E*² h₀³))^(1/3) of the fitted scene.

    The value µ is dimensionless, the range h₀ is in [m]; "assumed" is True where the scene gives no range and 0.3 nm is
    taken. None without adhesion or a radius R at the apex.
    """
    scene, radius = fit.scene, fit.scene.bodies.profile.curvature_radius
    if not scene.work_of_adhesion or radius is None:
        return None
    given, reach = (law_of(scene).range_of(scene, assumed) for assumed in (0.0, ASSUMED_RANGE))
    value = MaugisDugdale(radius, modulus_of(scene), scene.work_of_adhesion, reach).tabor
    return {"value": value, "range": reach, "assumed": not given}


def chart(result: FitResult) -> Chart:
    """Return the figure of data and fitted curve, F less its offset [N] over z from the contact point [m].

    A second panel has the residuals, measured less predicted [N], of compared points. Outliers are marked; a note has
    the fitted parameters with half their intervals.
    """
    fit, far = result.fit, result.fit.solution.outliers
    z = fit.curve.positions - fit.values[POINT]
    measured, predicted = fit.curve.forces - fit.values[OFFSET], fit.forces - fit.values[OFFSET]
    residual = np.full_like(z, math.nan)
    kept = fit.solution.problem.kept
    residual[kept] = (measured - predicted)[kept]
    above, below = list[Series](), [Series(z, 0.0 * z, "", THEORY, "--")]
    approach, retraction = fit.curve.of(curves.APPROACH), fit.curve.of(curves.RETRACT)
    for segment, name, colour in ((approach, "approach", COMPRESSION), (retraction, "retraction", TENSION)):
        above.append(Series(z[segment], measured[segment], name, colour, "."))
        below.append(Series(z[segment], residual[segment], "", colour, "."))
    for segment in (approach, retraction):
        above.append(Series(z[segment], predicted[segment], fit.model, BLACK, width=1.2))
    above += [Series(z[far], measured[far], "outlier", "#CC79A7", "x")] if far.size else []
    notes = []
    for key, (low, high) in fit.intervals.items():
        quantity = Quantity(fit.values[key], 0.5 * (high - low), entry(fit, key)["unit"])
        notes += [f"{key.rpartition('.')[2].replace('_', ' ')} = {quantity}"] if key != POINT else []
    panels = [
        Panel(Axis("force", "N", zero=True), above, note=", ".join(notes), height=2.7),
        Panel(Axis("residual", "N", zero=True), below, height=1.2),
    ]
    return Chart(Axis("position of the piezo from the contact point", "m"), panels, fit.plan.fit.title)


def lines(result: FitResult) -> list[str]:
    """Return the lines of a fit's results for a terminal, in SI with prefixes, numbers with four digits at most.

    These are the title, each number that has a 95 % interval (parameters and contact point) with its two ends, the
    fitted modulus in words, the noise with reduced χ² and number of outliers, and the contact models by criterion, less
    the least one, the most likely first.
    """
    fit, best = result.fit, result.fit.solution.best
    shown = [fit.plan.fit.title]
    for key, ends in fit.intervals.items():
        factor, unit = scale_of(fit.values[key], entry(fit, key)["unit"])
        low, high = (end * factor for end in ends)
        shown.append(f"  {key:<34}{fit.values[key] * factor:.4g} {unit}, 95 %: {low:.4g} to {high:.4g} {unit}")
    factor, unit = scale_of(best.deviation, "N")
    memory = f"memory {best.noise.memory:.0f} points" if best.noise.share else "white"
    noise = f"{best.deviation * factor:.3g} {unit}, {memory}"
    least = next(iter(result.models.values())).criterion
    ranked = ", ".join(f"{name} +{model_fit.criterion - least:.0f}" for name, model_fit in result.models.items())
    return [
        *shown,
        f"  {modulus_words(fit)}",
        f"  noise {noise}; reduced χ² {fit.misfit:.2f}; outliers: {fit.solution.outliers.size}",
        f"  contact models by criterion (BIC): {ranked}",
    ]
