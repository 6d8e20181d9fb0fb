"""A contact in a line of Python, beside closed forms written out here; sizes that no laboratory has are named."""

import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import contact1d
from contact1d import Run, SceneError

RUBBER, GLASS = {"youngs_modulus": "3 MPa", "poisson_ratio": 0.5}, {"youngs_modulus": "70 GPa", "poisson_ratio": 0.22}
STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3}
PAIR = {"upper": RUBBER, "lower": GLASS, "tolerance": 1e-2}
MODULUS = 1.0 / ((1 - 0.5**2) / 3e6 + (1 - 0.22**2) / 70e9)
R, W = 2e-3, 0.08


def near(run: Run, name: str, value: float, unit: str) -> None:
    found = run.results[name]
    assert found.unit == unit
    assert abs(found.value - value) <= max(found.uncertainty, 1e-6 * abs(value)), name


def test_a_sphere_pulls_off_as_jkr_has_it() -> None:
    ball = contact1d.sphere("2 mm", work_of_adhesion="80 mJ/m²", **PAIR)
    run = ball.pull_off()
    near(run, "adhesion_force", 1.5 * math.pi * W * R, "N")
    near(run, "zero_load_radius", (4.5 * math.pi * W * R**2 / MODULUS) ** (1 / 3), "m")
    assert run.curve.units["force"] == "N"
    assert float(-run.curve.force.min()) == pytest.approx(run.results.adhesion_force.value, rel=1e-2)
    assert ball.scene("pull_off").experiment == run.scene.experiment
    assert ball.scene("pull_off", preload="1 mN").experiment.compression == 1e-3


def test_a_list_of_loads_as_texts_or_numbers_is_a_run_for_each(tmp_path: Path) -> None:
    """Of a ball in a cup, 1/R = 1/R₁ − 1/R₂."""
    runs = contact1d.sphere(R, counter_radius=-2.2e-3, **PAIR).load(["1 mN", 2e-3], tmp_path)
    assert [run.scene.experiment.compression for run in runs] == [1e-3, 2e-3]
    assert [run.folder for run in runs] == [tmp_path / "1", tmp_path / "2"]
    for run, load in zip(runs, (1e-3, 2e-3), strict=True):
        near(run, "contact_radius", (0.75 * load * R * 2.2e-3 / (2.2e-3 - R) / MODULUS) ** (1 / 3), "m")


def test_figures_are_drawn_when_they_are_asked_for() -> None:
    code = (
        "import sys, contact1d;"
        f"run = contact1d.sphere('2 mm', **{PAIR}).load('1 mN');"
        "assert not [*run.folder.glob('*.png')];"
        "assert not {'matplotlib', 'pint'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
    run = contact1d.sphere("2 mm", **PAIR).load("1 mN")
    assert run.plot()._repr_png_().startswith(b"\x89PNG")


def test_a_stiff_tip_has_one_answer_at_both_doors(tmp_path: Path) -> None:
    """R = 20 nm, E* = 70 GPa: JKR's F_A, the sentence that it does not hold, and DMT's value beside it, 2πWR."""
    tip = {"radius": "20 nm", "contact_modulus": "70 GPa", "work_of_adhesion": "50 mJ/m²"}
    run = contact1d.sphere(**tip).pull_off()
    asked = contact1d.from_material(tip, tmp_path / "tip")
    near(run, "adhesion_force", 1.5 * math.pi * 20e-9 * 0.05, "N")
    near(asked.run, "adhesion_force", 1.5 * math.pi * 20e-9 * 0.05, "N")
    assert asked.doubts["tabor"] == asked.run.warnings["tabor"] == run.warnings["tabor"]
    assert "where DMT holds" in run.warnings["tabor"]
    for text in (repr(run), repr(asked.run)):
        (line,) = (line for line in text.splitlines() if "DMT 6.2832 nN (-25 %)" in line)
        assert "JKR 4.7124 nN" in line
        assert "Maugis and Dugdale (μ = 0.0723) 6.1662 nN" in line


def test_a_cone_is_sneddon_s_and_a_punch_kendall_s() -> None:
    cone = contact1d.cone("85°", **PAIR).path(["0 µm", "10 µm"])
    near(cone, "largest_force", 2.0 / math.pi * MODULUS * 1e-10 * math.tan(math.radians(85.0)), "N")
    punch = contact1d.punch("1 mm", work_of_adhesion=W, **PAIR).pull_off()
    near(punch, "adhesion_force", math.sqrt(8.0 * math.pi * MODULUS * W * 1e-9), "N")


def test_a_profile_of_lists_and_a_tangential_displacement() -> None:
    r = [1e-5 * i for i in range(61)]
    ball = contact1d.profile(r=r, z=[x**2 / 2 / R for x in r], **PAIR).tangential("1 mN", 0.3, displacements=["1 nm"])
    near(ball, "contact_radius", (0.75 * 1e-3 * R / MODULUS) ** (1 / 3), "m")
    assert set(ball.curve) >= {"displacement", "force", "tangential_force", "stick_radius", "dissipated_energy"}


@pytest.mark.parametrize(
    ("contact", "words"),
    [
        ({"upper": RUBBER}, "lower: missing"),
        (dict(PAIR, work_of_adhesion="80 mJ"), "must be an energy per area"),
        (dict(PAIR, radus=1), "unknown key"),
    ],
)
def test_a_mistake_is_one_sentence(contact: dict[str, Any], words: str) -> None:
    with pytest.raises(SceneError, match=words):
        contact1d.sphere("2 mm", **contact)


def test_completion_names_keys_and_results_and_nothing_of_pydantic() -> None:
    names = dir(contact1d.sphere("2 mm", **PAIR).scene("load", force="1 mN"))
    assert {"bodies", "material", "experiment", "with_", "effects"} <= set(names)
    assert not [name for name in names if "model_" in name or name in ("dict", "json", "copy", "schema")]


def told(material: dict[str, Any], force: str = "10 mN", **bodies: Any) -> Run:
    """A coarse run on a rigid plane."""
    own = {"particles": "auto", "spacing": "10 µm", "bulk_stiffness": "auto", "lower": "rigid_plane"}
    own["profile"] = {"kind": "parabola", "radius": "10 mm"}
    tables = {"title": "t", "accuracy": {"tolerance": 0.1}, "experiment": {"kind": "load", "force": force}}
    return contact1d.run(tables | {"bodies": own | bodies, "material": material})


@pytest.mark.parametrize(
    ("material", "bodies", "words"),
    [
        ({"contact_modulus": "210e6 GPa"}, {"spacing": "0.1 µm"}, "modulus: .*2.1e\\+17 Pa is stiffer than diamond"),
        ({"upper": STEEL, "lower": STEEL | {"poisson_ratio": -0.3}}, {},
         "poisson_ratio: material.lower.poisson_ratio is -0.3, and few materials have one below 0: check its sign"),
    ],
)  # fmt: skip
def test_what_is_implausible_comes_first(material: dict[str, Any], bodies: dict[str, Any], words: str) -> None:
    run = told(material, **bodies)
    first = repr(run).splitlines()[1]
    assert re.search(f"warning implausible_{words}", first)
    assert run._repr_html_().index("warning: implausible") < run._repr_html_().index("displacement")


def test_ordinary_materials_and_a_rigid_one_are_not_told_and_a_contact_below_an_atom_is() -> None:
    rigid = {"youngs_modulus": 1e30, "poisson_ratio": 0.0}
    assert not [name for name in told({"upper": STEEL, "lower": rigid}).warnings if "implausible" in name]
    tiny = contact1d.sphere("1 nm", contact_modulus="1 TPa").load("1e-14 N")
    assert "less than that of an atom, 1e-10 m" in tiny.warnings["below_an_atom"]
