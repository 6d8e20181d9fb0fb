"""[material] beside the other tables: what a scene may not have together, told at its path."""

from __future__ import annotations

import tomllib
from typing import Any

import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.scene import Problem, SceneError, scene_from_dict, scene_to_toml
from tests.materials import E_STAR, JKR, PATH, RUBBER, STEEL, UNITS, tables
from tests.scenes import STEEL_ON_GLASS

BOTH = {"upper": STEEL, "lower": RUBBER}
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
