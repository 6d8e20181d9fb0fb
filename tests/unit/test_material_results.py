"""[material] in a finished run: its files in SI beside model units."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, read_scene, run
from contact1d.analysis.curve import read_columns
from tests.materials import JKR, PATH, STEEL, tables

ROUND_OFF = 1e-13
"""Relative: a few operations each."""
PLANE = tables(
    {"upper": STEEL, "lower": STEEL, "length_unit": 2e-9, "force_unit": 3e-6}, PATH, bulk_stiffness="auto",
    lower="rigid_plane",
)  # fmt: skip
STICKY = tables(JKR) | {"accuracy": {"tolerance": 1e-2}}
PRESSED = {
    "largest_force", "largest_radius", "mean_pressure", "central_pressure", "peak_pressure", "contact_stiffness",
}  # fmt: skip
BARE = tables(None, PATH, lower="rigid_plane", reduction="mdr")
FRAME = {
    "theory", "validity",
    "scene", "experiment", "method", "reduction", "effects", "status", "warnings", "timing", "versions",
    "accuracy", "consistency",
}  # fmt: skip


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Run]:
    scenes = {"plane": PLANE, "sticky": STICKY, "bare": BARE}
    return {name: run(read_scene(data), tmp_path_factory.mktemp(name), figures=False) for name, data in scenes.items()}


def document(finished: Run) -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads((finished.folder / "results.json").read_text(encoding="utf-8"))
    assert loaded == finished.document
    return loaded


def columns(finished: Run, name: str) -> dict[str, list[str]]:
    with (finished.folder / name).open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: [row[key] for row in rows] for key in rows[0]}


def test_each_quantity_stands_in_si_beside_its_model_units(finished: dict[str, Run]) -> None:
    results = document(finished["plane"])
    assert set(results) == FRAME | PRESSED | {"units"}
    force, radius = results["largest_force"], results["largest_radius"]
    for entry, factor, unit in ((force, 3e-6, "N"), (radius, 2e-9, "m")):
        assert set(entry) == {"value", "uncertainty", "unit", "si"}
        assert entry["si"]["unit"] == unit
        assert entry["si"]["value"] == pytest.approx(factor * entry["value"], rel=ROUND_OFF)
        assert entry["si"]["uncertainty"] == pytest.approx(factor * entry["uncertainty"], rel=ROUND_OFF)
    assert results["units"] == {
        "LU": {"value": 2e-9, "uncertainty": 0.0, "unit": "m"},
        "FU": {"value": 3e-6, "uncertainty": 0.0, "unit": "N"},
    }
    assert results["reduction"] == "mdr"  # with a material it is, unless the scene says otherwise


def test_units_by_jkr_stand_in_the_results_with_their_uncertainty(finished: dict[str, Run]) -> None:
    """γ and E* come back from F_A, a₀ and R in SI."""
    results = document(finished["sticky"])
    force, radius = results["adhesion_force"], results["zero_load_radius"]
    curvature = 100.0 * results["units"]["LU"]["value"]
    assert force["si"]["value"] / (3.0 * math.pi * curvature) == pytest.approx(1.0, rel=ROUND_OFF)
    assert 3.0 * force["si"]["value"] * curvature / radius["si"]["value"] ** 3 == pytest.approx(200e9, rel=ROUND_OFF)
    relative = results["units"]["LU"]["uncertainty"] / results["units"]["LU"]["value"]
    assert relative == pytest.approx(3.0 * radius["uncertainty"] / radius["value"], rel=ROUND_OFF)
    for entry in (force, radius, results["critical_radius"], results["preload"]):
        own = entry["uncertainty"] / entry["value"]
        assert entry["si"]["uncertainty"] / entry["si"]["value"] > own + 0.9 * relative


@pytest.mark.parametrize("name", ["plane", "sticky"])
def test_columns_are_in_si_with_the_unit_in_the_header_and_model_units_come_back(
    finished: dict[str, Run], name: str
) -> None:
    run, units = finished[name], document(finished[name])["units"]
    length, force = units["LU"]["value"], units["FU"]["value"]
    factors = {"m": length, "N": force, "N/m": force / length}
    expected = {
        "curve": {"displacement": "m", "force": "N", "contact_radius": "m", "smallest_distance": "m"},
        "profile": {"x": "m", "z_lower": "m", "z_upper": "m", "pressure": "N/m", "shear": "N/m"},
    }
    for table, wanted in expected.items():
        read = read_columns(run.folder / f"{table}.csv")
        for key, unit in wanted.items():
            assert (read.units[key], run.tables[table].units[key]) == (unit, unit)
            np.testing.assert_array_equal(read[key], run.tables[table][key])
            np.testing.assert_allclose(run.model.tables[table][key] * factors[unit], read[key], rtol=ROUND_OFF)
    assert run.outcome is not None
    np.testing.assert_allclose(run.model.curve.force, [s.force for s in run.outcome.states], rtol=ROUND_OFF)
    assert (run.results.adhesion_force if name == "sticky" else run.results.largest_force).unit == "N"


def test_without_a_material_nothing_is_in_si(finished: dict[str, Run]) -> None:
    results = document(finished["bare"])
    assert set(results) == FRAME | PRESSED
    assert set(results["largest_force"]) == {"value", "uncertainty", "unit"}
    assert results["reduction"] == "mdr"
    assert "material" not in results["scene"]
    for file in ("curve.csv", "profile.csv"):
        assert not [key for key in columns(finished["bare"], file) if "[" in key]


def test_contact_of_one_pair_has_no_units_by_jkr(tmp_path: Path) -> None:
    """The radius of so sharp a parabola may be 0."""
    sharp = tables(JKR, {"kind": "pull_off", "preload": 0.01}, profile={"kind": "parabola", "radius": 0.05})
    results = run(read_scene(sharp), tmp_path / "run", figures=False).document
    assert "units" not in results
    limited, doubt = (one for one in results["warnings"] if one["name"] not in ("lattice", "tolerance"))
    assert limited["name"] == "unknown"
    assert "critical_radius" in limited["message"]
    assert doubt["name"] == "no_units"
    assert doubt["message"].startswith("the run found no zero_load_radius above 0")


def test_path_that_finds_no_units_runs_and_has_none(tmp_path: Path) -> None:
    done = run(read_scene(tables(JKR, PATH) | {"accuracy": {"tolerance": 1e-2}}), tmp_path / "run", figures=False)
    results = document(done)
    assert results["status"] == "done"
    assert "units" not in results
    assert results["warnings"][-1]["name"] == "no_units"
    assert not any("si" in entry for entry in results.values() if isinstance(entry, dict))
