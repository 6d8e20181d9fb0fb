"""The typed tables: what they hold, what they derive, and that each field is documented."""

import math
import subprocess
import sys
from collections.abc import Iterator

import numpy as np
import pytest
from pydantic import ValidationError

from contact1d.workflow.scene import EFFECTS, Bodies, Parabola, Path, Plate, Scene, Slide, Span, Table, scene_from_dict
from contact1d.workflow.scene.quantities import annotation_of, keys_of
from contact1d.workflow.scene.wording import members, statement, table_of, unit_of
from tests.scenes import chains

BASE = chains(1000.0, bodies={"particles": 200}, experiment={"kind": "pull_off", "preload": 1.0})
DYNAMIC = ["damping.coefficient=auto", "plate={}"]
SLIDE = [
    *DYNAMIC,
    'plate.free=["z", "x"]',
    "horizontal={}",
    "cantilever={ stiffness = 0.5, velocity = 0.01 }",
    'experiment={ kind = "slide", normal_force = 1.0, distance = 5.0 }',
]


def every_field(table: type[Table] = Scene, path: str = "") -> Iterator[tuple[str, type[Table], str]]:
    """Path, table and key of every field of a scene, those of union members included."""
    for key in keys_of(table):
        yield f"{path}{key}", table, key
        for member in members(annotation_of(table, key)):
            inside = table_of(member)
            if inside:
                yield from every_field(inside, f"{path}{key}.")


@pytest.mark.parametrize(("path", "table", "key"), list(every_field()))
def test_every_field_has_a_description_and_every_number_a_unit(path: str, table: type[Table], key: str) -> None:
    assert table.model_fields[keys_of(table)[key]].description
    annotation = annotation_of(table, key)
    is_number = "number" in statement(annotation) and not table_of(annotation)
    assert (unit_of(annotation) is not None) == is_number, path


def test_the_walk_over_the_fields_reaches_the_depths() -> None:
    paths = {path for path, _, _ in every_field()}
    assert {"interaction.attraction.range", "experiment.displacements.from", "bodies.profile.radius"} <= paths


def test_units_are_those_of_the_contract() -> None:
    units = {path: unit_of(annotation_of(table, key)) for path, table, key in every_field()}
    assert units["bodies.spacing"] == units["interaction.cutoff"] == units["experiment.displacements"] == "LU"
    assert units["bodies.bulk_stiffness"] == units["cantilever.stiffness"] == "FU/LU"
    assert units["damping.coefficient"] == units["plate.damping"] == "FU·TU/LU"
    assert units["noise.temperature"] == units["interaction.repulsion.amplitude"] == "FU·LU"
    assert units["bodies.mass"] == units["plate.mass"] == "MU"
    assert units["cantilever.velocity"] == "LU/TU"
    assert units["experiment.preload"] == "FU"
    assert units["accuracy.tolerance"] == units["noise.seed"] == "1"


def test_defaults() -> None:
    scene = scene_from_dict(BASE, DYNAMIC)
    assert (scene.bodies.mass, scene.bodies.lower, scene.accuracy.tolerance) == (1.0, "particles", 1e-3)
    assert scene.plate == Plate(mass="auto", free=("z",), damping="auto")
    assert scene.interaction is not None
    assert scene.interaction.cutoff == "auto"


def test_a_whole_number_is_a_number() -> None:
    spacing = scene_from_dict(BASE, ["bodies.spacing=2"]).bodies.spacing
    assert spacing == 2.0
    assert isinstance(spacing, float)


def test_a_scene_cannot_be_changed_and_can_be_hashed() -> None:
    scene = scene_from_dict(BASE, ['experiment={ kind = "path", displacements = [0.0, 1.0] }'])
    with pytest.raises(ValidationError):
        scene.bodies.spacing = 2.0
    assert hash(scene) == hash(scene_from_dict(scene))


def test_tangential_stiffness_is_the_normal_one_unless_given() -> None:
    assert scene_from_dict(BASE).tangential_stiffness == 0.83
    given = scene_from_dict(BASE, ["bodies.bulk_stiffness_tangential=0.5"])
    assert (given.tangential_stiffness, given.bulk_stiffness) == (0.5, 0.83)


def test_parabola_has_the_height_of_its_formula() -> None:
    x = np.array([-20.0, 0.0, 10.0])
    height = Parabola(kind="parabola", radius=50.0).height(x)
    assert height.tolist() == [4.0, 0.0, 1.0]
    assert np.array_equal(x, [-20.0, 0.0, 10.0])


def test_effects_come_in_deck_order() -> None:
    names = ["neighbours.stiffness=0.3", "noise={ temperature = 0.01, seed = 1 }"]
    on_planes = ("adhesion", "friction")
    assert scene_from_dict(BASE, [*names[::-1], *SLIDE]).effects == tuple(n for n in EFFECTS if n not in on_planes)
    assert scene_from_dict(BASE).effects == ("interaction",)
    plane = scene_from_dict(BASE, ["bodies.lower=rigid_plane", 'experiment={kind="load", force=1}'], ["interaction"])
    assert plane.effects == ()


@pytest.mark.parametrize(
    ("overrides", "method"),
    [
        ([], "quasistatic"),
        (["experiment.method=quasistatic"], "quasistatic"),
        (DYNAMIC, "dynamic"),
        ([*DYNAMIC, "experiment.method=dynamic"], "dynamic"),
        (["damping.coefficient=0.3", 'experiment={ kind = "path", displacements = [1.0] }'], "dynamic"),
        (["neighbours.stiffness=1", "horizontal={}"], "quasistatic"),
        (SLIDE, "dynamic"),
    ],
)
def test_method_is_the_given_one_else_follows_from_the_tables(overrides: list[str], method: str) -> None:
    assert scene_from_dict(BASE, overrides).method == method


def test_free_directions_have_one_order() -> None:
    scene = scene_from_dict(BASE, SLIDE)
    assert scene.plate is not None
    assert scene.plate.free == ("x", "z")
    assert isinstance(scene.experiment, Slide)


def test_path_lists_what_it_was_given() -> None:
    path = scene_from_dict(BASE, ['experiment={ kind = "path", displacements = [0, 2.5, -1] }']).experiment
    assert isinstance(path, Path)
    assert path.places() == [0.0, 2.5, -1.0]


def test_span_goes_there_and_back_with_the_turning_point_once() -> None:
    span = {"from": -1.0, "to": 2.0, "steps": 3}
    assert Span.model_validate(span).values() == [-1.0, 0.0, 1.0, 2.0, 1.0, 0.0, -1.0]
    assert Span.model_validate(span | {"return": False}).values() == [-1.0, 0.0, 1.0, 2.0]
    assert Span.model_validate({"from": 3.0, "to": 1.0, "steps": 1}).values() == [3.0, 1.0, 3.0]


@pytest.mark.parametrize("steps", [1, 3, 7, 49, 1000])
def test_span_meets_its_ends_exactly_and_comes_back_the_same_way(steps: int) -> None:
    values = Span.model_validate({"from": -0.1, "to": 0.7, "steps": steps}).values()
    assert (values[0], values[steps], values[-1]) == (-0.1, 0.7, -0.1)
    assert values == values[::-1]
    assert len(values) == 2 * steps + 1
    assert all(math.isfinite(value) for value in values)


def test_path_of_a_span_has_the_values_of_the_span() -> None:
    path = scene_from_dict(BASE, ['experiment={kind="path", displacements={from=0, to=1, steps=2}}']).experiment
    assert isinstance(path, Path)
    assert isinstance(path.displacements, Span)
    assert path.places() == path.displacements.values() == [0.0, 0.5, 1.0, 0.5, 0.0]


def test_the_scene_has_a_json_schema() -> None:
    schema = Scene.model_json_schema()
    assert set(schema["required"]) == {"title", "bodies", "experiment"}
    assert set(Bodies.model_json_schema()["properties"]) == set(keys_of(Bodies))


def test_reading_a_scene_does_not_load_numpy() -> None:
    code = "import sys, contact1d.workflow.scene; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
