"""From a material to a scene and its run: what is chosen, found and refused, against closed forms typed here.

References: Hertz, Sneddon, JKR, DMT; Maugis and Dugdale by another solver; quadrature of the law between particles.
"""

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from contact1d import Contact1dError, Run, from_material, run
from tests.command import contact1d
from tests.scenes import MODULUS as STEEL_ON_GLASS
from tests.scenes import ROOT, chains
from validation.references.maugis import LAMBDA_OVER_TABOR, marks

ROUND_OFF = 1e-12
GRID = 2e-3
"""Relative: the radius that a spacing is chosen by is looked for among 4000 of a geometric row."""
SILICA = {"youngs_modulus": "72 GPa", "poisson_ratio": 0.17}
STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
GLASS = {"youngs_modulus": 70e9, "poisson_ratio": 0.22}
BODIES: dict[str, Any] = {"upper": STEEL, "lower": GLASS, "load": "10 N", "tolerance": 1e-2}
LOADED = BODIES | {"radius": "10 mm"}
TIP: dict[str, Any] = {"radius": "10 nm", "upper": SILICA, "lower": SILICA, "surface_energy": "0.03 J/m²"}
SILICA_PAIR = 0.5 * 72e9 / (1.0 - 0.17**2)
HERTZ = math.cbrt(0.75 * 10.0 * 0.01 / STEEL_ON_GLASS)


def refused(contact: Any, folder: Path) -> str:
    with pytest.raises(Contact1dError) as caught:
        from_material(contact, folder / "run")
    assert not (folder / "run").exists()
    return str(caught.value)


# What is read.


def test_every_problem_is_told_at_once(tmp_path: Path) -> None:
    bad = {"youngs_modulus": "210 N", "poisson_ratio": 0.8}
    contact = {"radius": "10 mn", "upper": bad, "lower": GLASS, "lod": "10 N", "model": "plate"}
    assert refused(contact, tmp_path).split("\n") == [
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
        ({"load": "-1 N"}, 'load = "-1 N": must be at least 0'),
        ({"upper": "rigid", "lower": "rigid"}, 'upper = "rigid": one of the two bodies must be elastic; give its'),
        ({"surface_energy": 0.1, "work_of_adhesion": 0.2}, "surface_energy = 0.1: not together with work_of_adhesion"),
        ({"roughness": "-1 nm"}, 'roughness = "-1 nm": must be at least 0'),
        ({"model": "particles"}, 'model = "particles" is for an adhesive sphere'),
        ({"load": "1 GN"}, "the contact radius is "),
        ({"radius": None, "profile": {"kind": "table", "file": "no.csv"}}, 'profile.file = "no.csv": no.csv: no such'),
    ],
)  # fmt: skip
def test_one_mistake_is_one_sentence(change: dict[str, Any], words: str, tmp_path: Path) -> None:
    said = refused({key: value for key, value in (LOADED | change).items() if value is not None}, tmp_path)
    assert said.startswith(words)
    assert "\n" not in said


def test_a_load_of_0_is_none_with_and_without_a_unit(tmp_path: Path) -> None:
    folders = [
        tmp_path / str(i) for i, load in enumerate((0, "0 N")) if from_material(TIP | {"load": load}, tmp_path / str(i))
    ]
    assert len({(folder / "scene.toml").read_text(encoding="utf-8") for folder in folders}) == 1


def test_the_page_has_every_key(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "identify.md").read_text(encoding="utf-8")
    table = page.split("## Keys")[1].split("## ")[0]
    named = {key for row in re.findall(r"^\| (`[^|]*) \|", table, re.MULTILINE) for key in re.findall(r"`(\w+)`", row)}
    assert named == set(refused(LOADED | {"xyz": 1}, tmp_path).partition("allowed here: ")[2].split(", "))


# What is chosen.


def test_the_spacing_of_a_body_follows_from_its_contact_radius(tmp_path: Path) -> None:
    """Sneddon (1965): F = (2/π) E* a² tan, with tan the slope."""
    cone = {"profile": {"kind": "cone", "slope": 0.2}, "load": "10000 mN", "surface_energy": 0.0}
    found = from_material(BODIES | cone, tmp_path / "run")
    radius = math.sqrt(10.0 / (0.5 * math.pi * 0.2 * STEEL_ON_GLASS))
    assert found.contact_radius == pytest.approx(radius, rel=GRID)
    assert found.scene.bodies.spacing <= 1.01 * found.contact_radius / 10.0
    assert (found.scene.bodies.reduction, found.scene.bodies.lower, found.scene.effects) == ("mdr", "rigid_plane", ())
    assert (found.theories, found.doubts) == (None, {})
    result = found.run.results.contact_radius
    assert abs(result.value - radius) <= result.uncertainty + ROUND_OFF * radius


def test_a_measured_profile_is_read_from_beside_its_contact_and_by_its_units(tmp_path: Path) -> None:
    """z = r²/2R with R = 10 mm, in µm, up to 0.4 mm."""
    rows = [f"{20 * i},{(20e-6 * i) ** 2 / 0.02 * 1e6:.12g}" for i in range(21)]
    points, material = tmp_path / "tip.csv", tmp_path / "tip.toml"
    material.write_text(
        'upper = "steel"\nlower = "glass"\nload = "10 N"\nprofile = { kind = "table", file = "tip.csv" }'
    )
    points.write_text("\n".join(rows), encoding="utf-8")
    assert "profile.scale: missing: the file has no unit; write scale" in refused(material, tmp_path)
    points.write_text("\n".join(["r [µm],z [µm]", *rows]), encoding="utf-8")
    assert from_material(material, tmp_path / "run").contact_radius == pytest.approx(HERTZ, rel=GRID)


# What theories say, and where no chain can represent a contact.


def test_theories_are_closed_forms_and_rough_surfaces_refused_with_the_roughness_that_is_not(tmp_path: Path) -> None:
    asked = TIP | {"radius": "5 um", "load": "1 uN", "range": "0.3 nm", "tolerance": 1e-2}
    said = refused(asked | {"roughness": "1 nm"}, tmp_path)
    assert said.startswith("the surfaces are too rough for the adhesion of a smooth sphere: asperities of 1 nm")
    most = said.split("up to a roughness of ")[1].split(" m")[0]
    assert "up to a roughness of" in refused(asked | {"roughness": 1.02 * float(most)}, tmp_path)
    found = from_material(asked | {"roughness": f"{most} m"}, tmp_path / "run")
    theories = found.theories
    assert theories is not None
    assert set(found.doubts) == {"roughness"}
    W, R, E, F = 0.06, 5e-6, SILICA_PAIR, 1e-6
    assert theories.tabor == pytest.approx(math.cbrt(R * W**2 / (E**2 * 0.3e-9**3)), rel=ROUND_OFF)
    jkr, dmt, maugis = (theories.values[name] for name in ("JKR", "DMT", "Maugis-Dugdale"))
    assert jkr["adhesion_force"] == pytest.approx(1.5 * math.pi * W * R, rel=ROUND_OFF)
    assert jkr["zero_load_radius"] == pytest.approx(math.cbrt(4.5 * math.pi * W * R**2 / E), rel=ROUND_OFF)
    assert dmt["adhesion_force"] == pytest.approx(2.0 * math.pi * W * R, rel=ROUND_OFF)
    assert dmt["loaded_radius"] == pytest.approx(math.cbrt(0.75 * R / E * (F + 2.0 * math.pi * W * R)), rel=ROUND_OFF)
    assert jkr["adhesion_force"] < maugis["adhesion_force"] < dmt["adhesion_force"]
    assert theories.holding == "Maugis-Dugdale"


@pytest.mark.parametrize(
    ("radius", "energy", "tabor", "holds"), [("1 nm", 0.03, "0.046", "DMT"), ("10 nm", 0.1, "0.22", "Maugis-Dugdale")]
)
def test_a_scene_of_a_stiff_tip_says_which_theory_holds(
    radius: str, energy: float, tabor: str, holds: str, tmp_path: Path
) -> None:
    """E* = 37 GPa and the usual h₀ = 0.3 nm; F_A of Maugis and Dugdale by another solver."""
    found = from_material(TIP | {"radius": radius, "surface_energy": energy, "tolerance": 1e-2}, tmp_path / "run")
    assert found.theories is not None
    assert found.theories.holding == holds
    missing = 1.0 - 1.5 / marks(LAMBDA_OVER_TABOR * found.theories.tabor)[1]
    words = found.doubts["tabor"]
    assert words.startswith(f"the Tabor parameter is {tabor} with an assumed range of the attraction of 300 pm")
    assert f", where {holds} holds, and JKR above 5: " in words
    assert f"the results are JKR's, whose pull-off force is {missing:.1%} smaller" in words
    small = "the contact is narrower than an atom: DMT has a zero-load radius of 196.8 pm"
    assert found.doubts.get("below_an_atom", "").startswith(small) == (radius == "1 nm")


# Two chains: the interaction with which they have a force and a radius.

MODULUS, RADIUS, A_0 = 200e9, 6.1e-6, 174e-9
LAYER = MODULUS * A_0**3 / (0.5 * RADIUS)
"""c a₀³/R₁ with the springs of the MDR, c = E* and R₁ = R/2: F_A is 1/6 of it for JKR's sphere."""
TOLERANCE = 1e-2
"""Of the scene that is searched for, loose so that its runs are quick; the search ends at 0.3 of it."""
TRAPEZOID = 1e-4
"""Relative: the estimate's grid has 4000 steps to the cutoff."""


def identify(force: float, a_0: float, *options: str | float) -> Any:
    given = {"contact-modulus": MODULUS, "radius": RADIUS, "adhesion-force": force, "zero-load-radius": a_0}
    arguments = [str(part) for name, value in given.items() for part in (f"--{name}", value)]
    return contact1d("identify", *arguments, *options)


def row_work(done: Run) -> float:
    """∫ −f dr from the force-free distance on, f that of a row of opposite particles, by quadrature of the law."""
    law, spacing = done.scene.tables["interaction"], done.scene.bodies.spacing
    A, a, B, b = (law[term][key] for term in ("repulsion", "attraction") for key in ("amplitude", "range"))

    def force(r: float) -> float:
        distances = np.hypot(r, spacing * np.arange(-40, 41))
        pair = A / a * np.exp(-distances / a) - B / b * np.exp(-distances / b)
        return float(np.sum(pair * r / distances))

    rest = brentq(force, 0.1 * b, 10.0 * b)
    return -quad(force, rest, 80.0 * b, epsabs=1e-13, limit=400)[0]


def test_what_springs_cannot_hold_is_refused_with_the_nearest_values_and_these_are_not() -> None:
    """The brittle limit 4/(9√3), of which 95 % are tried; what passes here ends at its coarse length unit."""
    border = 0.95 * 4.0 / (9.0 * math.sqrt(3.0)) * LAYER

    def said(force: float, a_0: float) -> str:
        return str(identify(force, a_0, "--length-unit", 50e-9).output).replace("\n", " ")

    above = said(1.001 * border, A_0)
    found = re.search(
        r"a radius of at least ([\d.e+-]+) m, or the same radius with a force of at most ([\d.e+-]+)", above
    )
    assert found is not None
    a_0, force = float(found[1]), float(found[2])
    for held in (said(0.999 * border, A_0), said(1.001 * border, a_0), said(force, A_0)):
        assert "a length unit of 5e-08 m gives 3.5 particles" in held
    for refusal in (above, said(1.001 * border, 0.9999 * a_0), said(1.0001 * force, A_0)):
        assert "is not possible with springs of this stiffness" in refusal


@pytest.mark.parametrize(("spacing", "reduction", "share"), [(0.5, "mdr", 1.0), (1.0, "geike_popov", 4.0)])
def test_what_the_law_implies_is_its_work_to_part_a_row_at_the_edge(
    spacing: float, reduction: str, share: float
) -> None:
    """w/s of chain, and the ring of the surface that parts with it, W = w/(π s a); of two equal spheres four times."""
    scene = chains(
        200.0, law=(0.4, 0.25, 0.2, 0.5), bodies={"spacing": spacing, "reduction": reduction},
        accuracy={"tolerance": TOLERANCE}, experiment={"kind": "pull_off", "preload": 0.5},
    )  # fmt: skip
    done = run(scene)
    energy, work = done.results["separation_energy"], done.results["work_of_adhesion"]
    assert (energy.unit, work.unit) == ("FU", "FU/LU")
    assert energy.value == pytest.approx(row_work(done) / spacing, rel=TRAPEZOID)
    assert abs(energy.value - row_work(done) / spacing) <= 2.0 * energy.uncertainty
    assert work.value == pytest.approx(
        share * energy.value / (math.pi * done.results.zero_load_radius.value), rel=ROUND_OFF
    )
    effective = 200.0 * (1.0 if reduction == "mdr" else 0.5)
    jkr = done.results.adhesion_force.value / (1.5 * math.pi * effective)
    assert abs(work.value - jkr) <= work.uncertainty <= 1.1 * abs(work.value - jkr) + 0.01 * jkr
    assert set(done.document["formulas"]) == {"separation_energy", "work_of_adhesion"}
