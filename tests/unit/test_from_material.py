"""From a material to a scene: what is chosen, what is refused and in which words, against closed forms typed here."""

from __future__ import annotations

import math
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from contact1d import SceneError
from contact1d.workflow.identify import IdentifyError
from contact1d.workflow.identify.choice import choose, theories_of
from contact1d.workflow.identify.contact import KEYS, read_contact
from validation.references.maugis import LAMBDA_OVER_TABOR, marks

ROUND_OFF = 1e-12
GRID = 2e-3
"""Relative: the radius that a spacing is chosen by is looked for among 4000 of a geometric row."""
SILICA = {"youngs_modulus": "72 GPa", "poisson_ratio": 0.17}
STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
GLASS = {"youngs_modulus": 70e9, "poisson_ratio": 0.22}
LOADED: dict[str, Any] = {"radius": "10 mm", "upper": STEEL, "lower": GLASS, "load": "10 N"}
TIP: dict[str, Any] = {
    "radius": "10 nm",
    "upper": SILICA,
    "lower": SILICA,
    "surface_energy": "0.03 J/m²",
    "range": "0.3 nm",
}
STEEL_ON_GLASS = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)


def refused(**contact: Any) -> str:
    with pytest.raises(IdentifyError) as caught:
        choose(read_contact(contact))
    return str(caught.value)


def problems(**contact: Any) -> list[str]:
    with pytest.raises(SceneError) as caught:
        read_contact(contact)
    return [str(problem) for problem in caught.value.problems]


# What is read.


def test_texts_and_numbers_are_one() -> None:
    contact = read_contact({"radius": 0.01, "upper": STEEL, "lower": GLASS, "load": "10000 mN", "roughness": "1 nm"})
    assert contact.contact_modulus == pytest.approx(STEEL_ON_GLASS, rel=ROUND_OFF)
    assert (contact.radius, contact.load, contact.roughness) == (0.01, 10.0, 1e-9)
    assert (contact.work_of_adhesion, contact.model) == (0.0, "plane")


def test_surface_energy_is_half_the_work_of_adhesion() -> None:
    by_energy = read_contact({"radius": "1 um", "contact_modulus": "1 GPa", "surface_energy": "50 mJ/m²"})
    by_work = read_contact({"radius": "1 um", "contact_modulus": "1 GPa", "work_of_adhesion": "0.1 J/m^2"})
    assert by_energy.work_of_adhesion == pytest.approx(by_work.work_of_adhesion, rel=ROUND_OFF) == 0.1


def test_range_that_nobody_gave_is_the_usual_one() -> None:
    known = {"radius": "1 um", "contact_modulus": "1 GPa", "surface_energy": 0.05}
    assert read_contact(known).range == 0.3e-9
    assert read_contact(known | {"range": "0.2 nm"}).range == pytest.approx(0.2e-9, rel=ROUND_OFF)


def test_every_problem_is_told_at_once() -> None:
    bad = {"youngs_modulus": "210 N", "poisson_ratio": 0.8}
    assert problems(radius="10 mn", upper=bad, lower=GLASS, lod="10 N", model="plate") == [
        'lod: unknown key; did you mean "load"?',
        'radius = "10 mn": must be a length, such as 10 mm; 10 mn has an unknown unit, mn',
        'upper.youngs_modulus = "210 N": must be a pressure, such as 210 GPa; 210 N is a force',
        "upper.poisson_ratio = 0.8: must be greater than -1 and at most 0.5",
        "load: missing; without attraction a load alone makes a contact; or give surface_energy or work_of_adhesion: "
        'load = "10 N"',
        'model = "plate": must be "plane" or "particles"',
    ]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"radius": None}, "radius: give either a radius or a profile"),
        ({"profile": {"kind": "cone", "slope": 0.1}}, "radius: give either a radius or a profile"),
        ({"radius": -1.0}, "radius = -1.0: must be greater than 0 (m)"),
        ({"load": "-1 N"}, 'load = "-1 N": must be at least 0'),
        ({"lower": None}, "lower: missing"),
        ({"lower": "stiff"},
         'lower = "stiff": must be a table with youngs_modulus, poisson_ratio, yield_strength, or a name such as '
         '"steel", or "rigid"; names: steel, stainless_steel, '),
        ({"lower": "rigid", "upper": "stel"}, 'upper = "stel": must be a table'),
        ({"upper": "rigid", "lower": "rigid"}, "upper: one of the two bodies must be elastic"),
        ({"contact_modulus": "1 GPa"}, "contact_modulus: not together with upper or lower"),
        ({"surface_energy": 0.1, "work_of_adhesion": 0.2}, "surface_energy: not together with work_of_adhesion"),
        ({"surface_energy": "50 mN"}, 'surface_energy = "50 mN": must be an energy per area'),
        ({"radius": True}, "radius = true: must be a number greater than 0 (m)"),
        ({"title": ""}, 'title = "": must be one line of text'),
    ],
)  # fmt: skip
def test_one_mistake_is_one_sentence(change: dict[str, Any], words: str) -> None:
    (problem,) = problems(**{key: value for key, value in (LOADED | change).items() if value is not None})
    assert problem.startswith(words)


# What is chosen.


def test_steel_on_glass_has_thirty_particles_in_hertzs_radius() -> None:
    choice = choose(read_contact(LOADED))
    radius = math.cbrt(0.75 * 10.0 * 0.01 / STEEL_ON_GLASS)
    assert choice.contact_radius == pytest.approx(radius, rel=GRID)
    scene = choice.scene
    assert scene.material is not None
    assert (scene.material.length_unit, scene.material.force_unit) == (1.0, 1.0)
    assert scene.bodies.spacing == pytest.approx(choice.contact_radius / 30.0, rel=GRID)
    assert scene.bodies.profile.curvature_radius == pytest.approx(0.01, rel=ROUND_OFF)
    assert (scene.bodies.reduction, scene.bodies.lower, scene.effects) == ("mdr", "rigid_plane", ())
    assert scene.experiment.kind == "load"
    assert scene.experiment.compression == pytest.approx(10.0, rel=ROUND_OFF)
    assert (choice.theories, choice.doubts) == (None, {})


@pytest.mark.parametrize(
    ("profile", "radius"),
    [  # Sneddon (1965): F = (2/π) E* a² tan, with tan the slope; a punch's radius is its own
        ({"kind": "cone", "slope": 0.2}, math.sqrt(10.0 / (0.5 * math.pi * 0.2 * STEEL_ON_GLASS))),
        ({"kind": "flat_punch", "radius": "2 mm"}, 2e-3),
        ({"kind": "circle", "radius": "10 mm"}, math.cbrt(0.75 * 10.0 * 0.01 / STEEL_ON_GLASS)),
        ({"kind": "power", "exponent": 2.0, "radius": "1 mm", "height": "0.05 mm"}, None),
    ],
)
def test_spacing_of_other_bodies_follows_from_their_radius(profile: dict[str, Any], radius: float | None) -> None:
    contact = {key: value for key, value in LOADED.items() if key != "radius"} | {"profile": profile}
    choice = choose(read_contact(contact))
    wanted = radius or math.cbrt(0.75 * 10.0 * 0.01 / STEEL_ON_GLASS)  # z = r²/2R, R = 10 mm
    assert choice.contact_radius == pytest.approx(wanted, rel=GRID)
    assert choice.scene.bodies.profile.kind == profile["kind"]


def test_measured_profile_is_read_from_beside_its_contact_and_by_its_units(tmp_path: Path) -> None:
    """z = r²/2R with R = 10 mm, in µm, up to 0.4 mm."""
    rows = [f"{20 * i},{(20e-6 * i) ** 2 / 0.02 * 1e6:.12g}" for i in range(21)]
    known = 'upper = "rigid"\nlower = { youngs_modulus = "210 GPa", poisson_ratio = 0.3 }\nload = "10 N"\n'
    radius = math.cbrt(0.75 * 10.0 * 0.01 * (1.0 - 0.3**2) / 210e9)
    for names, scale, good in (("r [µm],z [µm]", "", True), ("r,z", ', scale = "1 um"', True), ("r,z", "", False)):
        (tmp_path / "tip.csv").write_text("\n".join([names, *rows]), encoding="utf-8")
        (tmp_path / "tip.toml").write_text(f'{known}profile = {{ kind = "table", file = "tip.csv"{scale} }}\n')
        if good:
            assert choose(read_contact(tmp_path / "tip.toml")).contact_radius == pytest.approx(radius, rel=GRID)
        else:
            with pytest.raises(SceneError, match=r"profile\.scale: missing: the file has no unit; write scale"):
                read_contact(tmp_path / "tip.toml")


@pytest.mark.parametrize(("name", "reason"), [("nowhere.csv", "no such file"), ("tip.x3p", "SurfaceTopography")])
def test_a_profile_that_cannot_be_read_is_an_error_of_its_contact(name: str, reason: str) -> None:
    contact = {"upper": "rigid", "lower": STEEL, "load": "10 N", "profile": {"kind": "table", "file": name}}
    with pytest.raises(SceneError, match=rf"^profile\.file = \"{name}\".*{reason}"):
        read_contact(contact)


def test_two_chains_are_chosen_where_they_are_asked_for() -> None:
    choice = choose(read_contact(TIP | {"radius": "5 um", "model": "particles"}))
    assert choice.target is not None
    assert choice.scene.bodies.lower == "particles"
    assert choice.scene.effects == ("interaction",)
    assert set(choice.doubts) == {"tabor", "image"}
    words = refused(**LOADED, model="particles")
    assert words.startswith('model = "particles" is for an adhesive sphere')


# What theories say, and where no chain can represent a contact.


def test_theories_are_those_of_the_closed_forms() -> None:
    contact = read_contact(TIP | {"radius": "5 um", "load": "1 uN"})
    theories = theories_of(contact)
    assert theories is not None
    W, R, E, F = 0.06, 5e-6, contact.contact_modulus, 1e-6
    assert theories.tabor == pytest.approx(math.cbrt(R * W**2 / (E**2 * 0.3e-9**3)), rel=ROUND_OFF)
    jkr, dmt, maugis = (theories.values[name] for name in ("JKR", "DMT", "Maugis-Dugdale"))
    assert jkr["adhesion_force"] == pytest.approx(1.5 * math.pi * W * R, rel=ROUND_OFF)
    assert jkr["zero_load_radius"] == pytest.approx(math.cbrt(4.5 * math.pi * W * R**2 / E), rel=ROUND_OFF)
    pulled = 3.0 * math.pi * W * R
    cube = 0.75 * R / E * (F + pulled + math.sqrt(2.0 * pulled * F + pulled**2))
    assert jkr["loaded_radius"] == pytest.approx(math.cbrt(cube), rel=ROUND_OFF)
    assert dmt["adhesion_force"] == pytest.approx(2.0 * math.pi * W * R, rel=ROUND_OFF)
    assert dmt["loaded_radius"] == pytest.approx(math.cbrt(0.75 * R / E * (F + 2.0 * math.pi * W * R)), rel=ROUND_OFF)
    assert jkr["adhesion_force"] < maugis["adhesion_force"] < dmt["adhesion_force"]
    assert dmt["zero_load_radius"] < maugis["zero_load_radius"] < jkr["zero_load_radius"]
    assert theories.holding == "Maugis-Dugdale"


@pytest.mark.parametrize(("energy", "tabor", "holds"), [(0.03, "0.099", "DMT"), (0.1, "0.22", "Maugis-Dugdale")])
@pytest.mark.parametrize("model", ["plane", "particles"])
def test_a_scene_of_a_stiff_tip_says_which_theory_holds(model: str, energy: float, tabor: str, holds: str) -> None:
    """R = 10 nm, E* = 37 GPa, h₀ = 0.3 nm; F_A of Maugis and Dugdale by another solver."""
    choice = choose(read_contact(TIP | {"surface_energy": energy, "model": model}))
    assert choice.theories is not None
    assert choice.theories.holding == holds
    if model == "plane":
        assert "tabor" not in choice.doubts
        assert choice.scene.adhesion is not None
        assert choice.scene.adhesion.range == 0.3e-9
        return
    missing = 1.0 - 1.5 / marks(LAMBDA_OVER_TABOR * choice.theories.tabor)[1]
    words = choice.doubts["tabor"]
    assert words.startswith(f"the Tabor parameter is {tabor}, where {holds} holds, and JKR above 5")
    assert f"the results are JKR's, whose pull-off force is {missing:.1%} smaller" in words


def test_rough_surfaces_are_refused_with_the_roughness_that_is_not() -> None:
    smooth = TIP | {"radius": "5 um"}
    words = refused(**smooth, roughness="1 nm")
    assert words.startswith("the surfaces are too rough for the adhesion of a smooth sphere: asperities of 1 nm")
    most = words.split("up to a roughness of ")[1].split(" m")[0]
    assert float(most) < 1e-9
    contact = read_contact(smooth | {"roughness": f"{most} m", "model": "particles"})
    assert "roughness" in choose(contact).doubts


def test_contact_as_wide_as_its_sphere_is_refused() -> None:
    words = refused(**LOADED | {"load": "1 GN"})
    assert "of the sphere's: the theory is for a << R" in words


# What is written about it.


def test_page_has_every_key_and_its_examples_are_contacts() -> None:
    page = (Path(__file__).parents[2] / "docs" / "identify.md").read_text(encoding="utf-8")
    examples = re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
    assert len(examples) == 2
    for example in examples:
        assert read_contact(tomllib.loads(example)).contact_modulus > 0.0
    table = page.split("## Keys")[1].split("## ")[0]
    named = {key for row in re.findall(r"^\| (`[^|]*) \|", table, re.MULTILINE) for key in re.findall(r"`(\w+)`", row)}
    assert named == set(KEYS)


def test_contact_under_an_atom_is_doubted() -> None:
    words = choose(read_contact(TIP | {"radius": "1 nm"})).doubts["below_an_atom"]
    assert words.startswith("the contact is narrower than an atom: DMT has a zero-load radius of 196.8 pm")
