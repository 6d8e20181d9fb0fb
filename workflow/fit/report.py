"""The files of a fit: fit.json with all that is needed to repeat it, curve.csv, and a figure for a paper; all in SI."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from contact1d.analysis import plots
from contact1d.analysis.chart import BLACK, COMPRESSION, TENSION, THEORY, Axis, Chart, Panel, Series
from contact1d.analysis.theory.adhesion import MaugisDugdale
from contact1d.files import write_whole
from contact1d.workflow.body.cases import ASSUMED_RANGE
from contact1d.workflow.fit import curve as curves
from contact1d.workflow.fit import search
from contact1d.workflow.fit.comparison import BOTH, CurveFit
from contact1d.workflow.fit.determined import SOFTEST
from contact1d.workflow.fit.fit import FitResult
from contact1d.workflow.fit.fitted import UNITS, Fitted
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.subject import POINT, modulus_of
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene.problems import tables_as_toml
from contact1d.workflow.units import NUMBER, Quantity, scale_of

if TYPE_CHECKING:
    from pandas import DataFrame

RECORD, TABLE, FIGURE = "fit.json", "curve.csv", "fit.png"
COLOURS = {curves.APPROACH: COMPRESSION, curves.HOLD: "#009E73", curves.RETRACT: TENSION}
"""Colour of each segment in figures."""


def write(result: FitResult, folder: Path) -> None:
    """Write fit.json, curve.csv, scene.toml and fit.png to an existing folder, in place of earlier ones.

    Each file is written whole or not at all; all are in SI. A number that is not finite is null in fit.json.
    """
    from pandas import DataFrame, concat

    fit = result.fit
    record = json.loads(json.dumps(document(result)), parse_constant=lambda constant: None)
    write_whole(folder / RECORD, json.dumps(record, indent=2, ensure_ascii=False, allow_nan=False) + "\n")
    write_whole(folder / "scene.toml", tables_as_toml(fit.scene.tables))
    table = concat(
        DataFrame(
            {
                "line": part.curve.lines,
                "segment": [curves.SEGMENTS[kind] for kind in part.curve.kinds],
                "position [m]": part.curve.positions,
                "force [N]": part.curve.forces,
                "predicted force [N]": part.forces,
                "baseline [N]": part.baseline,
                "compared": np.where(np.isin(np.arange(part.forces.size), part.solution.problem.kept), "yes", "no"),
            }
        )
        for part in result.segments.shown
    )
    write_whole(folder / TABLE, table.to_csv(index=False, float_format="%.9g", lineterminator="\n"))
    plots.save_figure(plots.draw(chart(record, table).written(scale_of)), folder / FIGURE)


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
        "parameters": agreed(result.segments, plan.fit.parameters),
        "segments": {name: alone(part) for name, part in result.segments.fits.items() if name != BOTH}
        | {name: {"refused": reason} for name, reason in result.segments.refused.items()},
        "pull_off_force": pull_off(result),
        "fitted": modulus_words(fit),
        "contact_modulus": _modulus(fit),
        "calibrations": entries(fit, [key for key in fit.values if key not in (*plan.fit.parameters, *UNITS)]),
        **entries(fit, UNITS),
        **agreed(result.segments, [POINT]),
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
            "position": fit.subject.jumps_at(fit.solution.values)[1],
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


def agreed(fits: CurveFit, keys: Iterable[str]) -> dict[str, Any]:
    """Return {"value", "unit", "interval"} in SI by key, of the parameters of a curve; None where its segments differ.

    `keys`: names of parameters, or of the contact point; others are left out.
    """
    estimates = {key: fits.estimates[key] for key in keys if key in fits.estimates}
    return {
        key: estimate and {"value": estimate[0], "unit": fits.main.unit(key), "interval": list(estimate[1])}
        for key, estimate in estimates.items()
    }


def alone(fit: Fitted) -> dict[str, Any]:
    """Return the entry in fit.json of a segment alone: parameters, numbers of the measurement, and reduced χ²."""
    parameters = entries(fit, fit.plan.fit.parameters)
    return {"parameters": parameters, **entries(fit, UNITS), "reduced_chi_squared": fit.misfit}


def entries(fit: Fitted, keys: Iterable[str]) -> dict[str, Any]:
    """Return {"value", "unit", "interval"} in SI by key, in order, of the keys that are unknowns of a fit.

    The interval [lower, upper] is that of 95 %; a nuisance parameter other than the contact point, and a model that is
    compared only, has none. Other keys are left out.

    `keys`: dotted keys of the scene, "contact_point", "force_offset" or "instrument.stiffness".
    """
    shown = {key: {"value": fit.values[key], "unit": fit.unit(key)} for key in keys if key in fit.values}
    return {
        key: table | ({"interval": list(fit.intervals[key])} if key in fit.intervals else {})
        for key, table in shown.items()
    }


def pull_off(result: FitResult) -> dict[str, Any] | None:
    """Return {"value", "uncertainty", "unit"} of the measured pull-off force [N], without any contact model.

    None without a retraction, or where the force is not below that of bodies apart by more than its ± of 95 %.
    """
    value, uncertainty = result.segments.shown[-1].pull_off
    return {"value": value, "uncertainty": uncertainty, "unit": "N"} if value > uncertainty else None


def modulus_words(fit: Fitted) -> str:
    """Return a sentence, without a full stop, on which modulus is fitted: E*, or E with the assumed ν of its body.

    It has the number of ν, but not that of the modulus. Of several fitted moduli it is on the first one. Without any it
    says that the modulus is that of the base scene.
    """
    key = next((key for key in fit.plan.fit.parameters if key.endswith("_modulus")), None)
    if key is None:
        return "no modulus is fitted: it is that of the base scene"
    kind = ""
    if fit.subject.scene.viscoelasticity is not None:
        kind = "; it is the instantaneous modulus"
    elif not fit.subject.model.needs and [segment.name for segment in fit.curve.segments] == [curves.APPROACH]:
        kind = "; of an approach alone it is an apparent modulus, lower than the instantaneous one if the body relaxes"
    if key.endswith("contact_modulus"):
        return f"E* is fitted: no Poisson's ratio is assumed{kind}"
    ratio = getattr(fit.subject.scene.material, key.split(".")[1]).poisson_ratio
    known = "the curve determines E* alone, and another ν changes E as 1 − ν²"
    return f"E is fitted with ν = {ratio:g} assumed; {known}{kind}"


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


def chart(record: Mapping[str, Any], table: DataFrame) -> Chart:
    """Return the figure of data and fitted curve, F less its baseline [N] over z from the contact point [m].

    A second panel has the residuals, measured less predicted [N], of compared points. Outliers are marked; a note has
    the fitted parameters with half their intervals, of each segment where these differ.

    `record`: content of fit.json; `table`: that of curve.csv.
    """
    above, below, models = list[Series](), list[Series](), list[Series]()
    far = [outlier["line"] for outlier in record["outliers"]]
    for segment, rows in table.groupby("segment", sort=False):
        point = record[POINT] or record["segments"][segment][POINT]
        z, level = np.asarray(rows["position [m]"]) - point["value"], rows["baseline [N]"]
        measured, predicted = (np.asarray(rows[name] - level) for name in ("force [N]", "predicted force [N]"))
        residual = np.where(rows["compared"] == "yes", measured - predicted, math.nan)
        name, colour = curves.NOUNS[str(segment)], COLOURS[str(segment)]
        above.append(Series(z, measured, name, colour, "."))
        below += [Series(z, residual, "", colour, "."), Series(z, 0.0 * z, "", THEORY, "--")]
        models.append(Series(z, predicted, record["model"], BLACK, width=1.2))
        left_out = np.asarray(rows["line"].isin(far))
        models += [Series(z[left_out], measured[left_out], "outlier", "#CC79A7", "x")] * bool(left_out.any())
    notes = [f"{key.rpartition('.')[2].replace('_', ' ')} = {words}" for key, words in in_words(record).items()]
    note = ";\n".join(fill(note, 76) for note in notes)
    panels = [
        Panel(Axis("force", "N", zero=True), above + models, note=note, height=2.5),
        Panel(Axis("residual", "N", zero=True), below, height=1.1),
    ]
    along = "position of the piezo" if STIFFNESS in record else "displacement"
    return Chart(Axis(f"{along} from the contact point", "m"), panels, fill(record["title"], 70))


def in_words(record: Mapping[str, Any]) -> dict[str, str]:
    """Return value and half the interval of each parameter as text by key, of each segment where these differ.

    `record`: content of fit.json.
    """
    words = {}
    for key, estimate in record["parameters"].items():
        parts = {"": estimate} if estimate else {name: part["parameters"][key] for name, part in _alone(record)}
        words[key] = ", ".join(
            f"{written(part)} {curves.NOUNS.get(name, name)}".strip() for name, part in parts.items()
        )
    return words


def written(entry: Mapping[str, Any]) -> str:
    """Return the value of an entry in fit.json and half its interval as text."""
    low, high = entry["interval"]
    if low is None or high is None:
        return f"{Quantity(entry['value'], 0.0, entry['unit'])}, without a limit"
    return str(Quantity(entry["value"], 0.5 * (high - low), entry["unit"]))


def noise_in_words(deviation: float, share: float, memory: float) -> str:
    """Return the standard deviation [N] of a noise as text, with its memory [points] unless their share s is 0."""
    factor, unit = scale_of(deviation, "N")
    return f"{deviation * factor:.3g} {unit}, " + (f"memory {memory:.0f} points" if share else "white")


def _alone(record: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield name and entry of each segment that was fitted alone; `record`: content of fit.json."""
    yield from ((name, part) for name, part in record["segments"].items() if "refused" not in part)


def lines(result: FitResult) -> list[str]:
    """Return the lines of a fit's results for a terminal, in SI with prefixes, numbers with four digits at most.

    These are the title, each number that has a 95 % interval (parameters and contact point) with its two ends, the
    fitted modulus in words, the noise with reduced χ² and number of outliers, and the contact models by criterion, less
    the least one, the most likely first.
    """
    fit, best = result.fit, result.fit.solution.best
    noise = noise_in_words(best.deviation, best.noise.share, best.noise.memory)
    shown = [fit.plan.fit.title]
    for key in result.segments.estimates:
        for segment, (value, ends) in result.segments.by_segment(key).items():
            factor, unit = scale_of(value, fit.unit(key))
            low, high = (end * factor for end in ends)
            # As many digits as show the interval, four at least.
            share = abs(high - low) / max(abs(value * factor), 1e-300)
            digits = max(4, 2 - math.floor(math.log10(share))) if 0.0 < share < math.inf else 4
            name = f"{key} of {curves.NOUNS[segment]}" if segment else key
            behind = "" if unit == NUMBER else f" {unit}"
            text = f"{value * factor:.{digits}g}{behind}, 95 %: {low:.{digits}g} to {high:.{digits}g}{behind}"
            shown.append(f"  {name:<44}{text}")
    measured = pull_off(result)
    if measured:
        shown.append(f"  {'measured pull-off force':<44}{Quantity(measured['value'], measured['uncertainty'], 'N')}")
    least = next(iter(result.models.values())).criterion
    above = {name: float(f"{model_fit.criterion - least:.2g}") for name, model_fit in result.models.items()}
    ranked = ", ".join(f"{name} +{difference:.0f}" for name, difference in above.items())
    return [
        *shown,
        f"  {modulus_words(fit)}",
        f"  noise {noise}; reduced χ² {fit.misfit:.2f}; outliers: {fit.solution.outliers.size}",
        f"  contact models by criterion (BIC): {ranked}",
    ]
