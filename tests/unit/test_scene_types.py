"""The tables of a scene: what they hold and derive, and that each key has a meaning, a unit and a text in SI."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Iterator

import pytest
from pydantic import ValidationError

from contact1d import Scene, read_scene
from contact1d.workflow.scene import EFFECTS, Path, Plate, Span
from contact1d.workflow.scene.experiments import Hold
from contact1d.workflow.scene.quantities import Key, Table, keys_of, places, tables_in
from contact1d.workflow.scene.schema import statement, text_of
from contact1d.workflow.scene.si_text import UnitTextError, in_words, si_value
from contact1d.workflow.units import SI
from tests.scenes import STEEL_ON_GLASS, chains

BASE = chains(1000.0, bodies={"particles": 200}, experiment={"kind": "pull_off", "preload": 1.0})
DYNAMIC = ["damping.coefficient=auto", "plate={}"]
SLIDE = [
    *DYNAMIC, 'plate.free=["z", "x"]', "horizontal={}", "cantilever={ stiffness = 0.5, velocity = 0.01 }",
    'experiment={ kind = "slide", normal_force = 1.0, distance = 5.0 }',
]  # fmt: skip


def every_key() -> Iterator[tuple[str, type[Table], str, Key]]:
    """Path, table, name and record of every key of a scene, those of all kinds and of an experiment to come."""
    for path, _, table in (*tables_in(Scene), *tables_in(Hold, "experiment")):
        for name, key in keys_of(table).items():
            yield f"{path}.{name}".lstrip("."), table, name, key


KEYS = list(every_key())


@pytest.mark.parametrize(("path", "table", "name", "key"), KEYS, ids=[path for path, *_ in KEYS])
def test_every_key_has_a_meaning_and_every_number_a_unit_and_a_text(
    path: str, table: type[Table], name: str, key: Key
) -> None:
    assert key.description not in ("", "None")
    words = statement(key.allowed)
    assert (key.allowed.unit is not None) == ("number" in words and key.allowed.table is None), path
    if key.allowed.unit is None or key.allowed.unit.name == "1":
        return
    assert "a quantity" not in in_words(key.allowed.unit.name)
    text = text_of(key.allowed)
    data = {name: [text] if words.startswith("a list") else text}
    assert [place.value for place in places(table, data) if place.is_text] == [text]
    with pytest.raises(UnitTextError, match="is an electric charge"):
        si_value("1 C", key.allowed.unit.name)


def test_units_are_those_of_the_contract() -> None:
    units = {path: key.allowed.unit.name for path, _, _, key in KEYS if key.allowed.unit}
    for unit, paths in {
        "LU": "bodies.spacing interaction.cutoff experiment.displacements experiment.displacements.from",
        "FU/LU": "bodies.bulk_stiffness cantilever.stiffness",
        "FU·TU/LU": "damping.coefficient plate.damping",
        "FU·LU": "noise.temperature interaction.attraction.amplitude",
        "MU": "bodies.mass plate.mass",
        "LU/TU": "cantilever.velocity",
        "FU": "experiment.preload",
        "TU": "experiment.duration",
        "1": "accuracy.tolerance noise.seed",
    }.items():
        assert {units[path] for path in paths.split()} == {unit}


@pytest.mark.parametrize("name", SI)
def test_units_of_the_model_have_the_powers_that_pint_gives_them(name: str) -> None:
    """With LU, FU and MU as its base units, TU = √(MU·LU/FU)."""
    import pint

    registry = pint.UnitRegistry(None)
    for base in ("LU = [LU]", "FU = [FU]", "MU = [MU]", "TU = (MU * LU / FU) ** 0.5"):
        registry.define(base)
    found = registry.parse_units("" if name == "1" else name.replace("·", "*").replace("²", "**2")).dimensionality
    unit = SI[name]
    own = {f"[{base}]": power for base, power in unit.powers.items()}
    assert dict(found) == own
    if name != "1":
        quantity = pint.UnitRegistry()(unit.si.replace("·", "*"))
        in_si = {"[LU]": "m", "[FU]": "N", "[MU]": "kg"}
        product = " * ".join(f"{in_si[base]}**{power}" for base, power in own.items())
        assert quantity.is_compatible_with(product)
        assert quantity.to_base_units().magnitude == 1.0


def test_defaults() -> None:
    scene = read_scene(BASE, DYNAMIC)
    assert (scene.bodies.mass, scene.bodies.lower, scene.accuracy.tolerance) == (1.0, "particles", 1e-3)
    assert scene.plate == Plate(mass="auto", free=("z",), damping="auto")
    assert scene.interaction is not None
    assert scene.interaction.cutoff == "auto"


def test_a_whole_number_is_a_number() -> None:
    spacing = read_scene(BASE, ["bodies.spacing=2"]).bodies.spacing
    assert (spacing, type(spacing)) == (2.0, float)


def test_a_scene_cannot_be_changed_and_can_be_hashed() -> None:
    scene = read_scene(BASE, ['experiment={ kind = "path", displacements = [0.0, 1.0] }'])
    with pytest.raises(ValidationError):
        scene.bodies.spacing = 2.0
    assert hash(scene) == hash(read_scene(scene))


def test_tangential_stiffness_is_the_normal_one_unless_given() -> None:
    assert read_scene(BASE).tangential_stiffness == 0.83
    assert read_scene(BASE, ["bodies.bulk_stiffness_tangential=0.5"]).tangential_stiffness == 0.5


def test_effects_come_in_deck_order_and_free_directions_in_one() -> None:
    names = ["neighbours.stiffness=0.3", "noise={ temperature = 0.01, seed = 1 }"]
    scene = read_scene(BASE, [*names[::-1], *SLIDE])
    assert scene.effects == tuple(name for name in EFFECTS if name not in ("adhesion", "friction", "viscoelasticity"))
    assert scene.plate is not None
    assert scene.plate.free == ("x", "z")


@pytest.mark.parametrize(
    ("overrides", "method"),
    [
        ([], "quasistatic"),
        (["experiment.method=quasistatic"], "quasistatic"),
        (DYNAMIC, "dynamic"),
        (["damping.coefficient=0.3", 'experiment={ kind = "path", displacements = [1.0] }'], "dynamic"),
        (["neighbours.stiffness=1", "horizontal={}"], "quasistatic"),
        (SLIDE, "dynamic"),
    ],
)
def test_method_is_the_given_one_else_follows_from_the_tables(overrides: list[str], method: str) -> None:
    assert read_scene(BASE, overrides).method == method


@pytest.mark.parametrize("steps", [1, 3, 7, 49, 1000])
def test_a_span_meets_its_ends_exactly_and_comes_back_the_same_way(steps: int) -> None:
    values = Span.model_validate({"from": -0.1, "to": 0.7, "steps": steps}).values()
    assert (values[0], values[steps], values[-1]) == (-0.1, 0.7, -0.1)
    assert (values, len(values)) == (values[::-1], 2 * steps + 1)
    assert all(math.isfinite(value) for value in values)


def test_a_path_has_the_displacements_that_it_was_given() -> None:
    for given, listed in (
        ("[0, 2.5, -1]", [0.0, 2.5, -1.0]),
        ("{ from = -1, to = 2, steps = 3 }", [-1.0, 0.0, 1.0, 2.0, 1.0, 0.0, -1.0]),
        ("{ from = 0, to = 1, steps = 2, return = false }", [0.0, 0.5, 1.0]),
    ):
        path = read_scene(BASE, [f'experiment={{ kind = "path", displacements = {given} }}']).experiment
        assert isinstance(path, Path)
        assert path.places() == listed


def test_a_hold_is_dynamic_and_holds_what_is_given() -> None:
    held = Hold(kind="hold", displacement=0.5, duration=2.0)
    assert (held.given_method, held.places(), held.compression) == ("dynamic", [0.5], None)
    assert Hold(kind="hold", force=3.0, duration=2.0).compression == 3.0


def test_lists_and_tables_on_a_plane_take_texts() -> None:
    given = 'normal_force = ["10 N", "11 N"], displacements = ["0 nm", "0.2 µm"]'
    scene = read_scene(STEEL_ON_GLASS, [f'experiment={{ kind = "tangential", {given} }}', "friction.coefficient=0.3"])
    assert scene.experiment.compression == 11.0
    assert scene.experiment.excursion == 2e-7
    adhesive = read_scene(STEEL_ON_GLASS, ["adhesion.surface_energy=50 mJ/m²"]).adhesion
    assert adhesive is not None
    assert adhesive.work == 0.1


def test_legs_of_a_slide_take_texts() -> None:
    legs = 'experiment={ kind = "slide", normal_force = 1.0, path = [["1 m/s", "1 nm"], ["-2 m/s", "3 nm"]] }'
    units = "material={ length_unit = 1e-9, force_unit = 1e-9, mass_unit = 1e-27 }"  # TU = √(MU·LU/FU) = 3.2e-14 s
    experiment = read_scene(BASE, [*SLIDE, legs, units]).experiment
    assert experiment.kind == "slide"
    assert [leg.distance for leg in experiment.legs(0.0)] == [1.0, 3.0]
    time = math.sqrt(1e-27)
    assert [leg.velocity for leg in experiment.legs(0.0)] == pytest.approx([time / 1e-9, -2.0 * time / 1e-9])


def test_reading_a_scene_does_not_load_numpy() -> None:
    code = "import sys, contact1d.workflow.scene; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
