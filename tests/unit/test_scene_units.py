"""Numbers with units in scenes: what each text means, whose units the scene then has, and that it is kept exactly."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from fractions import Fraction
from pathlib import Path

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact1d import SceneError, read_scene
from contact1d.workflow.scene.si_text import UnitTextError, quantity, si_value
from contact1d.workflow.units import Scales
from tests.scenes import STEEL_ON_GLASS

SHIPPED = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
BOLTZMANN = 1.380649e-23  # J/K, by the definition of the kelvin

SLIDE = {
    "title": "slide",
    "bodies": {
        "particles": 20, "spacing": "1 nm", "profile": {"kind": "parabola", "radius": "100 nm"},
        "bulk_stiffness": "10 N/m", "bulk_stiffness_tangential": "8 mN/mm", "mass": "1e-25 kg",
    },
    "interaction": {
        "repulsion": {"amplitude": "1 eV", "range": "5 Å"}, "attraction": {"amplitude": "0.5 eV", "range": "1 nm"},
    },
    "horizontal": {},
    "damping": {"coefficient": "1e-12 kg/s"},
    "noise": {"temperature": "27 °C", "seed": 1},
    "plate": {"free": ["x", "z"]},
    "cantilever": {"stiffness": "1 N/m", "velocity": "1 µm/s"},
    "experiment": {"kind": "slide", "normal_force": "1 nN", "distance": "10 nm"},
}  # fmt: skip


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("10 mm", "LU", 0.01), ("10mm", "m", 0.01), (" +1.5e-3 m ", "LU", 1.5e-3), ("−5 µm", "LU", -5e-6),
        ("5 um", "LU", 5e-6), ("5 \u03bcm", "LU", 5e-6), (".5 Å", "LU", 5e-11), ("2 inch", "LU", 0.0508),
        ("210 GPa", "Pa", 210e9), ("210e3 N/mm²", "Pa", 210e9), ("210e3 N/mm^2", "Pa", 210e9), ("1 bar", "FU/LU²", 1e5),
        ("50 mJ/m²", "J/m²", 0.05), ("50 mJ/m2", "FU/LU", 0.05), ("50 mJ m⁻²", "FU/LU", 0.05),
        ("72 mN/m", "J/m²", 0.072),
        ("0.05 N/m", "FU/LU", 0.05), ("3 N·m", "FU·LU", 3.0), ("1 eV", "FU·LU", 1.602176634e-19),
        ("1 mN s/m", "FU·TU/LU", 1e-3), ("1 mN/s", "FU/TU", 1e-3), ("3.6 km/h", "LU/TU", 1.0), ("1 ng", "MU", 1e-12),
        ("300 K", "K", 300.0), ("27 °C", "K", 300.15), ("27 degC", "K", 300.15), ("80.33 °F", "K", 300.0),
        ("30 %", "1", 0.3), ("1e-999999999 m", "LU", 0.0),
    ],
)  # fmt: skip
def test_a_text_is_the_number_in_si_that_is_nearest_to_it(text: str, unit: str, value: float) -> None:
    assert float(si_value(text, unit)[0]) == value


@pytest.mark.parametrize("symbol", ["m", "g", "s", "K", "N", "Pa", "J", "W", "Hz", "V", "A", "C", "mol"])
def test_a_symbol_of_si_is_what_pint_says_with_every_prefix(symbol: str) -> None:
    registry = pint.UnitRegistry(non_int_type=Fraction)
    base = {"g": "kg"}.get(symbol, symbol)
    for prefix in ("", "f", "p", "n", "u", "µ", "\u03bc", "m", "c", "k", "M", "G"):
        for name, power in ((f"{prefix}{symbol}", 1), (f"{prefix}{symbol}²/m·s", 2)):
            wanted = base if power == 1 else f"{base}²/m·s"
            size = registry.Quantity(Fraction(1), f"{prefix}{symbol}").to(base).magnitude
            assert quantity(f"1 {name}")[0] == size**power
            assert quantity(f"1 {name}")[1].measures(wanted)


def test_a_scene_in_si_has_numbers_in_metres_and_newtons_and_says_so() -> None:
    scene = read_scene(STEEL_ON_GLASS)
    assert (scene.bodies.spacing, scene.bodies.profile.reach) == (4e-6, float("inf"))
    assert scene.bodies.profile.curvature_radius == 0.01
    assert scene.experiment.compression == 10.0
    assert scene.material is not None
    assert (scene.material.length_unit, scene.material.force_unit) == (1.0, 1.0)
    assert scene.material.mass_unit is None
    assert scene.material.upper is not None
    assert scene.material.upper.youngs_modulus == 210e9
    assert "length_unit = 1.0" in str(scene)


def test_a_scene_with_its_units_given_takes_plain_numbers_in_them_and_texts() -> None:
    units = {"length_unit": "1 nm", "force_unit": 1e-6}
    data = tomllib.loads(STEEL_ON_GLASS)
    data["material"] |= units
    data["bodies"]["spacing"] = 4000.0
    scene = read_scene(data)
    assert scene.bodies.profile.curvature_radius == 1e7
    assert scene.experiment.compression == 1e7
    assert scene.bodies.spacing == 4000.0


def test_every_table_has_texts_and_times_follow_from_the_mass() -> None:
    scene = read_scene(SLIDE)
    assert scene.noise is not None
    assert scene.noise.temperature == pytest.approx(300.15 * BOLTZMANN, rel=1e-15)  # one rounding of the expectation
    assert scene.cantilever is not None
    assert scene.cantilever.velocity == 1e-6
    assert scene.damping is not None
    assert scene.damping.coefficient == 1e-12
    assert scene.bodies.bulk_stiffness_tangential == 8.0
    assert scene.material is not None
    assert scene.material.mass_unit == 1.0


def test_times_are_in_tu_of_the_given_units() -> None:
    # TU = √(MU·LU/FU) = √(1e-25 · 1e-9/1e-9) s
    units = {"length_unit": 1e-9, "force_unit": "1 nN", "mass_unit": "1e-25 kg"}
    bodies = {key: value for key, value in SLIDE["bodies"].items() if key != "mass"}
    scene = read_scene(SLIDE | {"bodies": bodies, "material": units})
    time = 1e-25**0.5
    assert scene.cantilever is not None
    assert scene.cantilever.velocity == pytest.approx(1e-6 * time / 1e-9, rel=1e-14)  # round-off of the root
    assert scene.damping is not None
    assert scene.damping.coefficient == pytest.approx(1e-12 * 1e-9 / (1e-9 * time), rel=1e-14)
    assert scene.bodies.mass == 1.0


def test_a_time_is_in_seconds_where_the_mass_is_known() -> None:
    known = Scales(1e-9, 1e-6, mass=1e-25)
    assert known.factor("TU") == pytest.approx((1e-25 * 1e-9 / 1e-6) ** 0.5, rel=1e-14)  # round-off of three roots
    assert (known.factor("MU"), known.in_si(2.0, 0.0, "MU")["unit"]) == (1e-25, "kg")
    assert not Scales(1e-9, 1e-6).know("TU")
    with pytest.raises(KeyError):
        Scales(1e-9, 1e-6).factor("TU")


def test_lists_spans_overrides_and_changes_take_texts() -> None:
    data = tomllib.loads(STEEL_ON_GLASS)
    path = {"kind": "path", "displacements": ["0 nm", 0, "100 nm", "-1e-7 m"]}
    span = {"kind": "path", "displacements": {"from": 0, "to": "1 µm", "steps": 4}}
    listed = read_scene(data | {"experiment": path})
    assert listed.experiment.places() == [0.0, 0.0, 1e-7, -1e-7]
    assert read_scene(data | {"experiment": span}).experiment.compression is None
    scene = read_scene(STEEL_ON_GLASS, ["bodies.profile.radius=20 mm", 'experiment.force="5 N"'])
    assert (scene.bodies.profile.curvature_radius, scene.experiment.compression) == (0.02, 5.0)
    changed = scene.with_({"bodies.profile.radius": "30 mm"}, experiment__force="2 kN")
    assert (changed.bodies.profile.curvature_radius, changed.experiment.compression) == (0.03, 2000.0)


def test_with_no_elasticity_the_material_is_units_alone() -> None:
    data = tomllib.loads(STEEL_ON_GLASS)
    del data["material"]
    data["bodies"]["bulk_stiffness"] = "0.46 MN/m"
    scene = read_scene(data)
    assert scene.bulk_stiffness == scene.tangential_stiffness == 0.46e6
    assert scene.material is not None
    assert scene.material.model_dump(exclude_none=True) == {"length_unit": 1.0, "force_unit": 1.0}


IN_MODEL_UNITS = [path for path in sorted(SHIPPED.glob("*.toml")) if path.stem != "steel_on_glass"]


@pytest.mark.parametrize("path", IN_MODEL_UNITS, ids=lambda path: path.stem)
def test_a_scene_without_texts_is_as_it_was(path: Path) -> None:
    assert str(read_scene(path)).count("_unit") == path.read_text(encoding="utf-8").count("_unit")


sizes = st.floats(1e-3, 1e3)
prefixes = st.sampled_from(["p", "n", "µ", "m", "", "k"])


@given(radius=sizes, force=sizes, prefix=prefixes, other=prefixes, unit=st.sampled_from([None, 1e-9, 3.7e-7]))
def test_a_scene_that_is_written_back_means_the_same(
    radius: float, force: float, prefix: str, other: str, unit: float | None
) -> None:
    data = tomllib.loads(STEEL_ON_GLASS)
    data["bodies"]["profile"]["radius"] = f"{radius!r} {prefix}m"
    data["experiment"]["force"] = f"{force!r} {other}N"
    if unit is not None:
        data["material"]["length_unit"] = unit
    scene = read_scene(data)
    assert read_scene(tomllib.loads(str(scene))) == scene
    assert scene.with_(title="other").with_(title=scene.title) == scene


def test_a_scene_without_texts_does_not_load_the_units() -> None:
    code = (
        f"import sys; from contact1d import read_scene; read_scene({str(SHIPPED / 'pull_off.toml')!r});"
        "print('pint' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


UNIT_PARTS = [
    "m", "µ", "k", "N", "K", "degC", "°C", "dB", "rad", "e", "nan", "in", "and", "%", "·", "/", "**", "²", "⁻¹", "(",
    ")", " ", "1", "-", ".", "_", "\n", "\0", "中", "'", "[",
]  # fmt: skip


@given(
    number=st.sampled_from(["1", "-2.5", "1e3", ".5", "1e-400", "9" * 30, "1e", "", "x"]),
    unit=st.lists(st.sampled_from(UNIT_PARTS), max_size=5).map("".join) | st.text(max_size=5),
    wanted=st.sampled_from(["LU", "FU", "K", "1"]),
)
def test_any_text_is_a_number_or_one_sentence(number: str, unit: str, wanted: str) -> None:
    try:
        assert isinstance(si_value(number + unit, wanted)[0], Fraction)
    except UnitTextError as error:
        assert "\n" not in str(error)
        assert str(error).startswith("must be a ")


def test_a_wrong_text_is_one_line_and_the_rest_is_still_checked() -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(STEEL_ON_GLASS, ["bodies.profile.radius=10 N", "bodies.spacing=-4 µm", "accuracy.tolerance=2"])
    assert [str(problem) for problem in caught.value.problems] == [
        'bodies.profile.radius = "10 N": must be a length, such as 10 mm; 10 N is a force',
        'bodies.spacing = "-4 µm": must be greater than 0 (m), or "auto"',
        "accuracy.tolerance = 2: must be from 1e-07 to 0.1",
    ]
