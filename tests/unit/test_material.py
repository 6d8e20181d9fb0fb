"""[material]: elasticity by textbook formulae, the springs and units that follow, the SI numbers of a finished run."""

from __future__ import annotations

import csv
import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest

from contact1d import Run, Scene, read_scene, run
from contact1d.workflow.runs.scales import jkr_scales, scales_of
from contact1d.workflow.scene import Elastic, Material, Problem, SceneError, scene_from_dict, scene_to_toml
from contact1d.workflow.units import Quantity, Scales
from tests.scenes import STEEL_ON_GLASS, chains

ROUND_OFF = 1e-13
"""Relative: a few operations each."""
PRINTED = {"LU": 0.05e-9, "FU": 0.05e-6}
"""Half a unit of the last printed figure of Table 1."""
STEEL = {"youngs_modulus": 210e9, "poisson_ratio": 0.3}
RUBBER = {"youngs_modulus": 2e6, "poisson_ratio": 0.5}
E_STAR = {"contact_modulus": 200e9}
UNITS = {"length_unit": 1e-9, "force_unit": 1e-6}
PULL = {"kind": "pull_off", "preload": 0.3}
PATH = {"kind": "path", "displacements": [0.0, 0.3]}


def tables(material: dict[str, Any] | None = None, experiment: dict[str, Any] = PULL, **bodies: Any) -> dict[str, Any]:
    """A scene; on a rigid plane without its interaction."""
    made = chains(100.0, bodies=bodies, experiment=experiment, material=material)
    if bodies.get("lower") == "rigid_plane":
        del made["interaction"]
    return made


# Elasticity.


def test_contact_modulus_of_two_bodies() -> None:
    material = Material(upper=Elastic(**STEEL), lower=Elastic(**RUBBER))
    by_hand = 1.0 / ((1.0 - 0.09) / 210e9 + (1.0 - 0.25) / 2e6)
    assert material.effective_modulus() == pytest.approx(by_hand, rel=ROUND_OFF)
    assert Material(upper=Elastic(**RUBBER), lower=Elastic(**STEEL)).effective_modulus() == material.effective_modulus()


@pytest.mark.parametrize("nu", [-0.9, -0.3, 0.0, 0.3, 0.5])
def test_equal_materials_have_the_contact_modulus_g_over_1_minus_nu(nu: float) -> None:
    """And G*/E* = 2(1 − ν)/(2 − ν), Cattaneo and Mindlin's."""
    body = Elastic(youngs_modulus=7.0, poisson_ratio=nu)
    material = Material(upper=body, lower=body)
    shear = 7.0 / (2.0 * (1.0 + nu))
    assert material.effective_modulus() == pytest.approx(shear / (1.0 - nu), rel=ROUND_OFF)
    assert material.tangential_share() == pytest.approx(2.0 * (1.0 - nu) / (2.0 - nu), rel=ROUND_OFF)


def test_tangential_share_of_two_bodies_is_that_of_their_compliances() -> None:
    material = Material(upper=Elastic(**STEEL), lower=Elastic(**RUBBER))
    shear = [body["youngs_modulus"] / (2.0 * (1.0 + body["poisson_ratio"])) for body in (STEEL, RUBBER)]
    g_star = 1.0 / ((2.0 - 0.3) / (4.0 * shear[0]) + (2.0 - 0.5) / (4.0 * shear[1]))
    assert material.tangential_share() == pytest.approx(g_star / material.effective_modulus(), rel=ROUND_OFF)


def test_contact_modulus_alone_makes_springs_alike_in_both_directions() -> None:
    material = Material(contact_modulus=3e9)
    assert (material.effective_modulus(), material.tangential_share()) == (3e9, 1.0)


def test_layer_has_the_contact_modulus_with_the_mdr_and_half_of_it_with_geike_and_popov() -> None:
    material = Material(contact_modulus=3e9)
    assert material.layer_stiffness("mdr") == 3e9
    assert material.layer_stiffness("geike_popov") == 1.5e9


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_layer_of_geike_and_popov_is_their_equation_3(nu: float) -> None:
    """c_n = G/2(1 − ν), two equal spheres."""
    body = Elastic(youngs_modulus=7.0, poisson_ratio=nu)
    by_hand = 7.0 / (2.0 * (1.0 + nu)) / (2.0 * (1.0 - nu))
    assert Material(upper=body, lower=body).layer_stiffness("geike_popov") == pytest.approx(by_hand, rel=ROUND_OFF)


# Springs and units.


@pytest.mark.parametrize("lower", ["particles", "rigid_plane"])
@pytest.mark.parametrize(("reduction", "share"), [("geike_popov", 0.5), ("mdr", 1.0)])
def test_springs_of_the_material_make_its_layer(lower: str, reduction: str, share: float) -> None:
    """In SI: the springs of all chains in series, k/χ newtons per metre each 0.5 nm, are the layer c h."""
    scene = scene_from_dict(
        tables(E_STAR | UNITS, PATH, bulk_stiffness="auto", lower=lower, reduction=reduction, spacing=0.5)
    )
    chains = 2 if lower == "particles" else 1
    assert scene.chains == chains
    spring = scene.bulk_stiffness * 1e-6 / 1e-9
    assert spring / chains == pytest.approx(share * 200e9 * 0.5e-9, rel=ROUND_OFF)
    scales = scales_of(scene, {})
    assert scales == Scales(1e-9, 1e-6)


@pytest.mark.parametrize("lower", ["particles", "rigid_plane"])
@pytest.mark.parametrize(("reduction", "share"), [("geike_popov", 0.5), ("mdr", 1.0)])
def test_force_unit_follows_from_a_given_stiffness(lower: str, reduction: str, share: float) -> None:
    given = E_STAR | {"length_unit": 1e-9}
    scene = scene_from_dict(tables(given, PATH, lower=lower, reduction=reduction, spacing=0.5))
    scales = scales_of(scene, {})
    assert scales is not None
    assert scales.length == 1e-9
    assert 0.83 * scales.force / 1e-9 / scene.chains == pytest.approx(share * 200e9 * 0.5e-9, rel=ROUND_OFF)
    assert (scales.length_uncertainty, scales.force_uncertainty) == (0.0, 0.0)
    back = scene_from_dict(
        tables(given | {"force_unit": scales.force}, PATH, lower=lower, reduction=reduction, spacing=0.5,
               bulk_stiffness="auto")
    )  # fmt: skip
    assert back.bulk_stiffness == pytest.approx(0.83, rel=ROUND_OFF)


def test_tangential_springs_are_the_materials_share_unless_given() -> None:
    both = {"upper": STEEL, "lower": STEEL, "length_unit": 1e-9}
    share = 2.0 * 0.7 / 1.7
    assert scene_from_dict(tables(both)).tangential_stiffness == pytest.approx(share * 0.83, rel=ROUND_OFF)
    automatic = scene_from_dict(tables(both | {"force_unit": 1e-6}, bulk_stiffness="auto"))
    assert automatic.tangential_stiffness == pytest.approx(share * automatic.bulk_stiffness, rel=ROUND_OFF)
    assert scene_from_dict(tables(both, bulk_stiffness_tangential=0.5)).tangential_stiffness == 0.5
    assert scene_from_dict(tables(E_STAR | {"length_unit": 1e-9})).tangential_stiffness == 0.83
    assert scene_from_dict(tables()).tangential_stiffness == 0.83


def test_no_material_has_no_scales() -> None:
    assert scales_of(scene_from_dict(tables()), {}) is None


# Units by JKR.


@pytest.mark.parametrize(
    ("radius", "a_0", "f_a", "length", "force"),
    [
        (1000.0, 28.53, 1.47, 6.1e-9, 39.0e-6),
        (1600.0, 36.14, 1.87, 7.7e-9, 61.8e-6),
        (2000.0, 40.36, 2.09, 8.6e-9, 77.6e-6),
    ],
)
def test_table_1_of_the_paper(radius: float, a_0: float, f_a: float, length: float, force: float) -> None:
    """E* = 200 GPa, γ = 1 N/m; γ = F_A/3πR and E* = 3F_A R/a₀³ (Eq. 9), here solved for the units by hand."""
    scales = jkr_scales(Quantity(f_a, 0.0, "FU"), Quantity(a_0, 0.0, "LU"), radius, 200e9, 1.0)
    gamma, modulus = f_a / (3.0 * math.pi * radius), 3.0 * f_a * radius / a_0**3
    by_hand = (modulus / gamma) * 1.0 / 200e9
    assert scales.length == pytest.approx(by_hand, rel=ROUND_OFF)
    assert scales.force == pytest.approx(by_hand * 1.0 / gamma, rel=ROUND_OFF)
    assert scales.length == pytest.approx(length, abs=PRINTED["LU"])
    assert scales.force == pytest.approx(force, abs=PRINTED["FU"])


def test_units_by_jkr_turn_the_run_into_the_material() -> None:
    """In SI, the run's F_A and a₀ are 3πγR and (9πγR²/E*)^{1/3} of the sphere of R metres."""
    scales = jkr_scales(Quantity(1.3, 0.0, "FU"), Quantity(25.0, 0.0, "LU"), 800.0, 5e6, 0.03)
    radius = 800.0 * scales.length
    assert 1.3 * scales.force == pytest.approx(3.0 * math.pi * 0.03 * radius, rel=ROUND_OFF)
    assert 25.0 * scales.length == pytest.approx(math.cbrt(9.0 * math.pi * 0.03 * radius**2 / 5e6), rel=ROUND_OFF)


def test_uncertainty_of_the_units_is_that_of_the_run() -> None:
    """LU ∝ a₀⁻³ and FU ∝ a₀⁻³ F_A⁻¹, by finite differences of the scales themselves."""

    def of(f_a: float, a_0: float) -> Scales:
        return jkr_scales(Quantity(f_a, 1e-5, "FU"), Quantity(a_0, 2e-4, "LU"), 800.0, 5e6, 0.03)

    middle = of(1.3, 25.0)
    by_force, by_radius = of(1.3 + 1e-5, 25.0), of(1.3, 25.0 + 2e-4)
    length = abs(by_force.length - middle.length) + abs(by_radius.length - middle.length)
    force = abs(by_force.force - middle.force) + abs(by_radius.force - middle.force)
    assert middle.length_uncertainty == pytest.approx(length, rel=1e-4)
    assert middle.force_uncertainty == pytest.approx(force, rel=1e-4)


@pytest.mark.parametrize("found", [{}, {"adhesion_force": 1.0}, {"zero_load_radius": 1.0}])
def test_path_without_f_a_or_a_0_has_no_units(found: dict[str, float]) -> None:
    scene = scene_from_dict(tables(E_STAR | {"surface_energy": 1.0}, PATH))
    assert scales_of(scene, {name: Quantity(value, 0.0, "") for name, value in found.items()}) is None


# One quantity in SI.


@pytest.mark.parametrize(
    ("unit", "factor", "name"),
    [("LU", 2e-9, "m"), ("FU", 3e-6, "N"), ("FU/LU", 1.5e3, "N/m"), ("FU/LU²", 0.75e12, "Pa")],
)
def test_each_unit_in_si(unit: str, factor: float, name: str) -> None:
    exact = Scales(2e-9, 3e-6)
    assert exact.factor(unit) == pytest.approx(factor, rel=ROUND_OFF)
    entry = exact.in_si(-4.0, 0.1, unit)
    assert entry["unit"] == name
    assert entry["value"] == pytest.approx(-4.0 * factor, rel=ROUND_OFF)
    assert entry["uncertainty"] == pytest.approx(0.1 * factor, rel=ROUND_OFF)


@pytest.mark.parametrize(("unit", "share"), [("LU", 0.01), ("FU", 0.03), ("FU/LU", 0.04), ("FU/LU²", 0.05)])
def test_uncertainty_of_the_scales_is_added(unit: str, share: float) -> None:
    """1 % of LU, 3 % of FU; powers of them add up, and a negative value has no negative uncertainty."""
    scales = Scales(2e-9, 3e-6, 0.01 * 2e-9, 0.03 * 3e-6)
    factor = scales.factor(unit)
    assert scales.in_si(-4.0, 0.1, unit)["uncertainty"] == pytest.approx((0.1 + 4.0 * share) * factor, rel=ROUND_OFF)
    assert scales.in_si(0.0, 0.0, unit)["uncertainty"] == 0.0


def test_units_of_time_are_not_made_of_lu_and_fu() -> None:
    with pytest.raises(KeyError):
        Scales(1.0, 1.0).factor("TU")


# Rules across tables: what is broken, and the words at the paths.

BOTH = {"upper": STEEL, "lower": RUBBER}
JKR = E_STAR | {"surface_energy": 1.0}
LOAD = {"kind": "load", "force": 1.0}
PUNCH = {"kind": "flat_punch", "radius": 10.0}

BAD: dict[str, tuple[dict[str, Any], dict[str, str]]] = {
    "automatic stiffness of nothing": (
        tables(None, bulk_stiffness="auto"),
        {"bodies.bulk_stiffness": "nothing to take it from; give the stiffness (FU/LU), or [material]"},
    ),
    "two elasticities": (
        tables(BOTH | E_STAR | {"length_unit": 1.0}),
        {"material.contact_modulus": "not together with upper"},
    ),
    "one and a half": (
        tables({"upper": STEEL} | E_STAR | {"length_unit": 1.0}),
        {"material.contact_modulus": "not together with upper"},
    ),
    "no elasticity": (tables({"length_unit": 1.0}), {"material.upper": "missing; write upper and lower"}),
    "no lower body": (tables({"upper": STEEL, "length_unit": 1.0}), {"material.lower": "or contact_modulus"}),
    "no upper body": (tables({"lower": STEEL, "length_unit": 1.0}), {"material.upper": "each with youngs_modulus and"}),
    "no length unit": (tables(E_STAR), {"material.length_unit": "missing; give one LU in metres, or surface_energy"}),
    "no unit at all": (
        tables(E_STAR, bulk_stiffness="auto"),
        {
            "material.length_unit": "missing",
            "material.force_unit": 'needed by bulk_stiffness = "auto"; give one FU in newtons',
        },
    ),
    "force unit beside a stiffness": (
        tables(E_STAR | UNITS),
        {"material.force_unit": "not together with a given bulk_stiffness; write bodies.bulk_stiffness"},
    ),
    "units beside the surface energy": (
        tables(JKR | UNITS),
        {"material.length_unit": "not together with surface_energy", "material.force_unit": "remove one of the two"},
    ),
    "automatic stiffness before the units": (
        tables(JKR, bulk_stiffness="auto"),
        {"bodies.bulk_stiffness": "no units to take it by before the run"},
    ),
    "surface energy of a load": (
        tables(JKR, LOAD),
        {"material.surface_energy": "not in a load, which finds no F_A and a₀"},
    ),
    "surface energy of a cone": (
        tables(JKR, profile={"kind": "cone", "slope": 0.1}),
        {"material.surface_energy": "JKR is for a sphere"},
    ),
    "surface energy on a plane": (
        tables(BOTH | {"surface_energy": 1.0}, PATH, lower="rigid_plane"),
        {"material.surface_energy": "nothing attracts, so there is no F_A and no a₀; use length_unit"},
    ),
    "surface energy without attraction": (
        tables(JKR, PATH) | {"interaction": {"repulsion": {"amplitude": 1.0, "range": 0.1}}},
        {"material.surface_energy": "nothing attracts"},
    ),
    "surface energy of nothing else": (tables({"surface_energy": 1.0}), {"material.upper": "missing"}),
    "an empty table": (tables({}), {"material.upper": "missing", "material.length_unit": "missing"}),
    "a punch between two counts": (
        tables(profile={"kind": "flat_punch", "radius": 10.2}),
        {"bodies.profile.radius": "a whole number of half spacings: the nearest is 10 (LU)"},
    ),
    "a punch of two particles": (
        tables(profile={"kind": "flat_punch", "radius": 1.0}),
        {"bodies.profile.radius": "the nearest is 1.5 (LU)"},
    ),
    "a punch of another length than its chain": (
        tables(profile=PUNCH, particles=21),
        {"bodies.particles": "must be 20, the radius times 2 over the spacing; change it"},
    ),
    "Poisson's ratio": (
        tables({"upper": STEEL | {"poisson_ratio": 0.51}, "lower": STEEL, "length_unit": 1.0}),
        {"material.upper.poisson_ratio": "at most 0.5"},
    ),
    "signs": (
        tables({"contact_modulus": -1.0, "length_unit": 0.0}),
        {
            "material.contact_modulus": "must be greater than 0 (Pa)",
            "material.length_unit": "must be greater than 0 (m)",
        },
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_broken_rule_is_told_at_its_path(name: str) -> None:
    data, words = BAD[name]
    found = problems(data)
    assert set(found) == set(words)
    for path, part in words.items():
        assert part in str(found[path])


def problems(data: dict[str, Any]) -> dict[str, Problem]:
    """By path; a path may have one only."""
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data)
    by_path = {problem.path: problem for problem in caught.value.problems}
    assert len(by_path) == len(caught.value.problems)
    return by_path


def test_range_of_poissons_ratio_is_told_in_english() -> None:
    found = problems(tables({"upper": STEEL | {"poisson_ratio": 0.51}, "lower": STEEL, "length_unit": 1.0}))
    assert "greater than -1 of" not in str(found["material.upper.poisson_ratio"])


def test_surface_energy_of_a_slide_is_refused() -> None:
    slide = {"kind": "slide", "normal_force": 1.0, "distance": 5.0}
    timed = {"horizontal": {}, "damping": {"coefficient": "auto"}, "plate": {"free": ["x", "z"]},
             "cantilever": {"stiffness": 1.0, "velocity": 0.1}}  # fmt: skip
    found = problems(tables(JKR, slide) | timed)
    assert list(found) == ["material.surface_energy"]
    assert "not in a slide" in str(found["material.surface_energy"])


GOOD = {
    "both bodies": tables(BOTH | {"length_unit": 1e-9}),
    "modulus": tables(E_STAR | {"length_unit": 1e-9}),
    "automatic stiffness": tables(E_STAR | UNITS, bulk_stiffness="auto"),
    "surface energy": tables(JKR),
    "surface energy of a circle": tables(JKR, profile={"kind": "circle", "radius": 100.0}),
    "surface energy of a path": tables(BOTH | {"surface_energy": 1.0}, PATH),
    "cone with units": tables(E_STAR | {"length_unit": 1e-9}, profile={"kind": "cone", "slope": 0.1}),
    "load": tables(E_STAR | {"length_unit": 1e-9}, LOAD),
    "Poisson's ratio one half": tables({"upper": RUBBER, "lower": RUBBER, "length_unit": 1e-9}),
    "punch": tables(profile=PUNCH, particles=20),
    "punch of half a spacing": tables(profile={"kind": "flat_punch", "radius": 10.5}),
    "punch by a spacing with round-off": tables(profile={"kind": "flat_punch", "radius": 0.3}, spacing=0.1),
}


@pytest.mark.parametrize("name", GOOD)
def test_scene_that_keeps_the_rules_reads_back_from_its_text(name: str) -> None:
    scene = scene_from_dict(GOOD[name])
    assert scene_from_dict(tomllib.loads(scene_to_toml(scene))) == scene


def test_a_punch_of_more_particles_than_a_number_holds_is_a_problem_of_the_scene() -> None:
    problems(tables(profile={"kind": "flat_punch", "radius": 1e308}, spacing=1e-10))


# The files of a finished run.

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
    "theory", "scene", "experiment", "method", "reduction", "effects", "status", "warnings", "timing", "versions",
    "accuracy",
}  # fmt: skip


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Run]:
    scenes = {"plane": PLANE, "sticky": STICKY, "bare": BARE}
    return {
        name: run(scene_from_dict(data), tmp_path_factory.mktemp(name), figures=False) for name, data in scenes.items()
    }


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
def test_si_columns_stand_to_the_right_of_those_in_model_units(finished: dict[str, Run], name: str) -> None:
    units = document(finished[name])["units"]
    length, force = units["LU"]["value"], units["FU"]["value"]
    factors = {"_m": length, "_N": force, "_N_per_m": force / length}
    expected = {
        "curve.csv": {"displacement": "_m", "force": "_N", "contact_radius": "_m", "smallest_distance": "_m"},
        "profile.csv": {"x": "_m", "z_lower": "_m", "z_upper": "_m", "pressure": "_N_per_m", "shear": "_N_per_m"},
    }
    for file, endings in expected.items():
        found = columns(finished[name], file)
        names = list(found)
        own = [key for key in names if not key.endswith(tuple(factors))]
        assert names[: len(own)] == own
        for key, ending in endings.items():
            assert key in own
            for model, si in zip(found[key], found[key + ending], strict=True):
                if model == "":
                    assert si == ""
                else:
                    assert float(si) == pytest.approx(factors[ending] * float(model), rel=ROUND_OFF)


def test_without_a_material_nothing_is_in_si(finished: dict[str, Run]) -> None:
    results = document(finished["bare"])
    assert set(results) == FRAME | PRESSED
    assert set(results["largest_force"]) == {"value", "uncertainty", "unit"}
    assert results["reduction"] == "mdr"
    assert "material" not in results["scene"]
    for file in ("curve.csv", "profile.csv"):
        assert not [key for key in columns(finished["bare"], file) if key.endswith(("_m", "_N"))]


def test_contact_of_one_pair_has_no_units_by_jkr(tmp_path: Path) -> None:
    """The radius of so sharp a parabola cannot be told from 0."""
    sharp = tables(JKR, {"kind": "pull_off", "preload": 0.01}, profile={"kind": "parabola", "radius": 0.05})
    results = run(scene_from_dict(sharp), tmp_path / "run", figures=False).document
    assert "units" not in results
    limited, doubt = (warning for warning in results["warnings"] if warning["name"] != "lattice")
    assert limited["name"] == "tolerance"
    assert limited["message"].startswith("critical_radius cannot be told from 0")
    assert doubt["name"] == "no_units"
    assert doubt["message"].startswith("the run found no zero_load_radius above 0")


def test_path_that_finds_no_units_runs_and_has_none(tmp_path: Path) -> None:
    done = run(scene_from_dict(tables(JKR, PATH) | {"accuracy": {"tolerance": 1e-2}}), tmp_path / "run", figures=False)
    results = document(done)
    assert results["status"] == "done"
    assert "units" not in results
    assert results["warnings"][-1]["name"] == "no_units"
    assert not any("si" in entry for entry in results.values() if isinstance(entry, dict))


def test_with_a_material_the_stiffness_need_not_be_named() -> None:
    """As with bulk_stiffness = "auto"; without a material it is missing, and the message says both ways."""
    named = read_scene(STEEL_ON_GLASS)
    unnamed = read_scene(STEEL_ON_GLASS.replace('bulk_stiffness = "auto"\n', ""))
    assert unnamed == named
    with pytest.raises(SceneError, match=r"bodies.bulk_stiffness: missing; give the stiffness .* or \[material\]"):
        read_scene(named.model_dump(by_alias=True) | {"material": None, "bodies": unnamed_bodies(named)})


def unnamed_bodies(scene: Scene) -> dict[str, Any]:
    """The [bodies] of a scene without its stiffness."""
    return {key: value for key, value in scene.bodies.model_dump().items() if key != "bulk_stiffness"}
