"""[material]: elasticity by textbook formulae, the springs and units that follow, and results in SI."""

import math
from typing import Any

import numpy as np
import pytest

from contact1d import Run, read_scene, run
from contact1d.workflow.units import Scales
from tests.materials import E_STAR, JKR, PATH, RUBBER, STEEL, UNITS, tables
from tests.scenes import read_json

ROUND_OFF = 1e-13
"""Relative: a few operations each."""
LAYER = 200e9 * 0.5e-9
"""Of E_STAR, for a spacing of 0.5 nm [N/m]."""
PLANE = tables(
    {"upper": STEEL, "lower": STEEL, "length_unit": 2e-9, "force_unit": 3e-6}, PATH, bulk_stiffness="auto",
    lower="rigid_plane",
)  # fmt: skip
SCENES = {
    "plane": PLANE,
    "sticky": tables(JKR) | {"accuracy": {"tolerance": 1e-2}},
    "bare": tables(None, PATH, lower="rigid_plane", reduction="mdr"),
}


@pytest.fixture(scope="module")
def finished() -> dict[str, Run]:
    return {name: run(data) for name, data in SCENES.items()}


@pytest.mark.parametrize(
    ("upper", "lower"),
    [(STEEL, RUBBER), *(({"youngs_modulus": 7e9, "poisson_ratio": nu},) * 2 for nu in (-0.9, 0.5))],
)
def test_springs_have_the_contact_moduli_of_both_bodies(upper: dict[str, float], lower: dict[str, float]) -> None:
    """1/E* = Σ (1 − ν²)/E and, Cattaneo's and Mindlin's, 1/G* = Σ (2 − ν)/4G with G = E/2(1 + ν)."""
    bodies = [(body["youngs_modulus"], body["poisson_ratio"]) for body in (upper, lower)]
    normal = 1.0 / sum((1.0 - nu**2) / E for E, nu in bodies)
    tangential = 1.0 / sum((2.0 - nu) * (1.0 + nu) / (2.0 * E) for E, nu in bodies)
    for pair in ({"upper": upper, "lower": lower}, {"upper": lower, "lower": upper}):
        scene = read_scene(tables(pair | UNITS, PATH, bulk_stiffness="auto", lower="rigid_plane"))
        assert scene.bulk_stiffness * 1e-6 / 1e-9 == pytest.approx(normal * 1e-9, rel=ROUND_OFF)
        assert scene.tangential_stiffness / scene.bulk_stiffness == pytest.approx(tangential / normal, rel=ROUND_OFF)
        given = read_scene(tables(pair | {"length_unit": 1e-9}))
        assert given.tangential_stiffness == pytest.approx(tangential / normal * 0.83, rel=ROUND_OFF)
    assert given.with_({"bodies.bulk_stiffness_tangential": 0.5}).tangential_stiffness == 0.5
    assert read_scene(tables()).tangential_stiffness == 0.83


@pytest.mark.parametrize("lower", ["particles", "rigid_plane"])
@pytest.mark.parametrize(("reduction", "share"), [("geike_popov", 0.5), ("mdr", 1.0)])
def test_springs_and_units_of_the_material_make_its_layer(lower: str, reduction: str, share: float) -> None:
    """In SI: the springs of all chains in series, k/χ newtons per metre each 0.5 nm, are the layer c h."""
    how = {"lower": lower, "reduction": reduction, "spacing": 0.5}
    scene = read_scene(tables(E_STAR | UNITS, PATH, bulk_stiffness="auto", **how))
    chains = 2 if lower == "particles" else 1
    assert scene.bulk_stiffness * 1e-6 / 1e-9 / chains == pytest.approx(share * LAYER, rel=ROUND_OFF)
    done = run(tables(E_STAR | {"length_unit": 1e-9}, PATH, **how) | {"accuracy": {"tolerance": 1e-2}})
    units = done.document["units"]
    assert units["LU"] == {"value": 1e-9, "uncertainty": 0.0, "unit": "m"}
    assert 0.83 * units["FU"]["value"] / 1e-9 / chains == pytest.approx(share * LAYER, rel=ROUND_OFF)
    assert (units["FU"]["uncertainty"], units["FU"]["unit"]) == (0.0, "N")


# Results.


def test_each_quantity_stands_in_si_beside_its_model_units(finished: dict[str, Run]) -> None:
    results = finished["plane"].document
    assert read_json(finished["plane"].folder / "results.json") == results
    for name, factor, unit in (("largest_force", 3e-6, "N"), ("largest_radius", 2e-9, "m")):
        entry = results[name]
        assert set(entry) == {"value", "uncertainty", "unit", "si"}
        assert entry["si"]["unit"] == unit
        assert entry["si"]["value"] == pytest.approx(factor * entry["value"], rel=ROUND_OFF)
        assert entry["si"]["uncertainty"] == pytest.approx(factor * entry["uncertainty"], rel=ROUND_OFF)
    assert (results["units"]["LU"]["value"], results["units"]["FU"]["value"]) == (2e-9, 3e-6)
    bare = finished["bare"]
    assert set(bare.document["largest_force"]) == {"value", "uncertainty", "unit"}
    assert not {"units", "material"} & {*bare.document, *bare.document["scene"]}
    assert "[" not in (bare.folder / "curve.csv").read_text(encoding="utf-8")


def test_units_by_jkr_make_the_run_jkrs_contact_of_the_material(finished: dict[str, Run]) -> None:
    """γ = F_A/3πR and E* = 3F_A R/a₀³, so that LU ∝ a₀⁻³ and FU ∝ a₀⁻³ F_A⁻¹; their uncertainties reach the results."""
    results = finished["sticky"].document
    force, radius, units = results["adhesion_force"], results["zero_load_radius"], results["units"]
    curvature = 100.0 * units["LU"]["value"]
    assert force["si"]["value"] / (3.0 * math.pi * curvature) == pytest.approx(1.0, rel=ROUND_OFF)
    assert 3.0 * force["si"]["value"] * curvature / radius["si"]["value"] ** 3 == pytest.approx(200e9, rel=ROUND_OFF)

    def share(entry: dict[str, Any]) -> float:
        return float(entry["uncertainty"] / entry["value"])

    assert share(units["LU"]) == pytest.approx(3.0 * share(radius), rel=ROUND_OFF)
    assert share(units["FU"]) == pytest.approx(3.0 * share(radius) + share(force), rel=ROUND_OFF)
    for entry in (radius, results["critical_radius"]):
        assert share(entry["si"]) == pytest.approx(share(entry) + share(units["LU"]), rel=ROUND_OFF)
    for entry in (force, results["preload"]):
        assert share(entry["si"]) == pytest.approx(share(entry) + share(units["FU"]), rel=ROUND_OFF)


@pytest.mark.parametrize("name", ["plane", "sticky"])
def test_columns_are_in_si_and_model_units_come_back(finished: dict[str, Run], name: str) -> None:
    done, units = finished[name], finished[name].document["units"]
    length, force = units["LU"]["value"], units["FU"]["value"]
    for table, key, unit, factor in (
        ("curve", "displacement", "m", length), ("curve", "force", "N", force),
        ("profile", "x", "m", length), ("profile", "pressure", "N/m", force / length),
    ):  # fmt: skip
        assert f"{key} [{unit}]" in (done.folder / f"{table}.csv").read_text(encoding="utf-8").partition("\n")[0]
        assert done.tables[table].units[key] == unit
        np.testing.assert_allclose(done.model.tables[table][key] * factor, done.tables[table][key], rtol=ROUND_OFF)
    assert done.outcome is not None
    np.testing.assert_allclose(done.model.curve.force, [state.force for state in done.outcome.states], rtol=ROUND_OFF)


def test_a_run_without_both_results_has_no_units_by_jkr() -> None:
    """The radius of so sharp a parabola may be 0; a path need not find F_A."""
    sharp = tables(JKR, {"kind": "pull_off", "preload": 0.01}, profile={"kind": "parabola", "radius": 0.05})
    for data, missing in ((sharp, "zero_load_radius above 0"), (tables(JKR, PATH), "adhesion_force")):
        done = run(data | {"accuracy": {"tolerance": 1e-2}})
        assert done.warnings["no_units"].startswith(f"the run found no {missing}")
        assert "units" not in done.document


def test_each_unit_in_si_has_the_uncertainty_of_the_scales() -> None:
    """1 % of LU, 3 % of FU; powers of them add up, and a negative value has no negative uncertainty."""
    scales = Scales(2e-9, 3e-6, 0.01 * 2e-9, 0.03 * 3e-6)
    for unit, factor, name, share in (
        ("LU", 2e-9, "m", 0.01), ("FU", 3e-6, "N", 0.03), ("FU/LU", 1.5e3, "N/m", 0.04), ("FU/LU²", 75e10, "Pa", 0.05),
    ):  # fmt: skip
        assert scales.in_si(-4.0, 0.1, unit) == {
            "value": pytest.approx(-4.0 * factor), "uncertainty": pytest.approx((0.1 + 4.0 * share) * factor),
            "unit": name,
        }  # fmt: skip
