"""Numbers with units in scenes: what each text means, whose units the scene then has, and that it is kept exactly."""

import tomllib
from fractions import Fraction
from typing import Any

import pint
import pytest

from contact1d import read_scene
from contact1d.workflow.units import SI, Scales
from tests.scenes import STEEL_ON_GLASS
from validation.row import tables_beside

BOLTZMANN = 1.380649e-23  # J/K, by the definition of the kelvin

SLIDE = tables_beside(__file__)
RADIUS, FORCE, MODULUS = "bodies.profile.radius", "experiment.force", "material.upper.youngs_modulus"
NEEDED: dict[str, dict[str, Any]] = {
    FORCE: {"adhesion.work_of_adhesion": 1.0},
    "interaction.repulsion.amplitude": {"interaction.repulsion.range": "1 m"},
    "damping.coefficient": {"experiment": {"kind": "path", "displacements": [0.0]}, "bodies.mass": "1 kg"},
    "noise.temperature": {"noise.seed": 1, "damping.coefficient": "auto", "plate": {}, "bodies.mass": "1 kg"},
}  # fmt: skip
"""What a key needs besides."""


def number(key: str, text: object) -> Any:
    """What a scene has at a dotted key after a text is written there."""
    lower = "particles" if key.startswith("interaction") else "rigid_plane"
    table = read_scene(STEEL_ON_GLASS).with_({"bodies.lower": lower, **NEEDED.get(key, {}), key: text}).tables
    for name in key.split("."):
        table = table[name]
    return table


@pytest.mark.parametrize(
    ("text", "key", "value"),
    [
        ("10mm", RADIUS, 0.01), (" +1.5e-3 m ", RADIUS, 1.5e-3), ("5 um", RADIUS, 5e-6),
        ("5 \u03bcm", RADIUS, 5e-6), (".5 Å", RADIUS, 5e-11), ("2 inch", RADIUS, 0.0508), ("−5 µN", FORCE, -5e-6),
        ("210e3 N/mm²", MODULUS, 210e9), ("1 bar", MODULUS, 1e5),
        ("50 mJ/m2", "adhesion.work_of_adhesion", 0.05),
        ("50 mJ m⁻²", "adhesion.work_of_adhesion", 0.05), ("72 mN/m", "adhesion.work_of_adhesion", 0.072),
        ("1 eV", "interaction.repulsion.amplitude", 1.602176634e-19),
        ("3 N·m", "interaction.repulsion.amplitude", 3.0), ("1 mN s/m", "damping.coefficient", 1e-3),
        ("1 ng", "bodies.mass", 1e-12), ("300 K", "noise.temperature", 300.0 * BOLTZMANN),
        ("27 degC", "noise.temperature", 300.15 * BOLTZMANN), ("80.33 °F", "noise.temperature", 300.0 * BOLTZMANN),
        ("30 %", "material.upper.poisson_ratio", 0.3),
    ],
)  # fmt: skip
def test_a_text_is_the_number_in_si_that_is_nearest_to_it(text: str, key: str, value: float) -> None:
    assert number(key, text) == pytest.approx(value, rel=1e-15 if "temperature" in key else 0.0)  # k_B T is rounded


def test_a_symbol_of_si_is_what_pint_says_with_every_prefix() -> None:
    registry = pint.UnitRegistry(non_int_type=Fraction)
    for symbol, key, base in (
        ("m", RADIUS, "m"), ("N", FORCE, "N"), ("Pa", MODULUS, "Pa"), ("g", "bodies.mass", "kg"),
        ("J", "interaction.repulsion.amplitude", "J"),
    ):  # fmt: skip
        for prefix in ("f", "n", "µ", "\u03bc", "m", "c", "k", "G"):
            size = registry.Quantity(Fraction(1), f"{prefix}{symbol}").to(base).magnitude
            assert number(key, f"1 {prefix}{symbol}") == float(size)
    model = pint.UnitRegistry(None)
    for definition in ("LU = [LU]", "FU = [FU]", "MU = [MU]", "TU = (MU * LU / FU) ** 0.5"):
        model.define(definition)
    in_si = {"LU": "m", "FU": "N", "MU": "kg"}
    for name, unit in SI.items():
        powers = {f"[{base}]": power for base, power in unit.powers.items()}
        assert dict(model.get_dimensionality(name.replace("·", "*").replace("²", "**2"))) == powers
        product = " * ".join(f"{in_si[base]}**{power}" for base, power in unit.powers.items())
        assert registry.Quantity(1, unit.si.replace("·", "*")).is_compatible_with(product or "1")


def test_a_scene_in_si_has_numbers_in_metres_and_newtons_and_says_so() -> None:
    tables = read_scene(STEEL_ON_GLASS).tables
    assert (tables["bodies"]["spacing"], tables["bodies"]["profile"]["radius"]) == (4e-6, 0.01)
    assert tables["experiment"]["force"] == 10.0
    assert (tables["material"]["length_unit"], tables["material"]["force_unit"]) == (1.0, 1.0)
    assert "mass_unit" not in tables["material"]


def test_a_scene_with_its_units_given_takes_plain_numbers_in_them_and_texts() -> None:
    units = {"material.length_unit": "1 nm", "material.force_unit": 1e-6, "bodies.spacing": 4000.0}
    tables = read_scene(STEEL_ON_GLASS, [f"{key}={value}" for key, value in units.items()]).tables
    assert (tables["bodies"]["spacing"], tables["bodies"]["profile"]["radius"]) == (4000.0, 1e7)
    assert tables["experiment"]["force"] == 1e7


def test_times_are_in_tu_of_the_given_units() -> None:
    """TU = √(MU·LU/FU) = √(1e-25 · 1e-9/1e-9) s; 1 kg, 1 m and 1 N where none is given."""
    units = {"length_unit": 1e-9, "force_unit": "1 nN", "mass_unit": "1e-25 kg"}
    legs = {"kind": "slide", "normal_force": "1 nN", "path": [["1 m/s", "1 nm"], ["-2 m/s", "3 nm"]]}
    time = 1e-25**0.5
    for scene, TU, LU in (
        (read_scene(SLIDE | {"experiment": legs}), 1.0, 1.0),
        (read_scene(SLIDE | {"experiment": legs, "material": units}), time, 1e-9),
    ):
        tables, experiment = scene.tables, scene.experiment
        assert tables["cantilever"]["velocity"] == pytest.approx(1e-6 * TU / LU, rel=1e-14)  # round-off of the root
        assert tables["damping"]["coefficient"] == pytest.approx(1e-12 / TU, rel=1e-14)
        found = [(leg.velocity, leg.distance) for leg in experiment.legs(0.0)]
        assert found == [pytest.approx((TU / LU, 1e-9 / LU)), pytest.approx((-2.0 * TU / LU, 3e-9 / LU))]
    known = Scales(1e-9, 1e-6, mass=1e-25)
    assert known.factor("TU") == pytest.approx((1e-25 * 1e-9 / 1e-6) ** 0.5, rel=1e-14)
    with pytest.raises(KeyError):
        Scales(1e-9, 1e-6).factor("TU")


def test_lists_spans_overrides_and_changes_take_texts() -> None:
    for experiment, wanted in (
        ('{ kind = "path", displacements = ["0 nm", 0, "100 nm", "-1e-7 m"] }', [0.0, 0.0, 1e-7, -1e-7]),
        ('{ kind = "path", displacements = { from = 0, to = "1 µm", steps = 2 } }', [0.0, 5e-7, 1e-6, 5e-7, 0.0]),
    ):
        path: Any = read_scene(STEEL_ON_GLASS, [f"experiment={experiment}"]).experiment
        assert path.places() == wanted
    loads = '{ kind = "tangential", normal_force = ["10 N", "11 N"], displacements = ["0 nm", "0.2 µm"] }'
    slid = read_scene(STEEL_ON_GLASS, [f"experiment={loads}", "friction.coefficient=0.3"]).tables["experiment"]
    assert (slid["normal_force"], slid["displacements"]) == ([10.0, 11.0], [0.0, 2e-7])
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
