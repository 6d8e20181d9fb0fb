"""Every mistake inside a table is reported once, at its path, in the words of the scene file."""

from __future__ import annotations

import pickle
from typing import Any

import pytest

from contact1d import SceneError, read_scene
from contact1d.workflow.scene import Problem
from tests.materials import STEEL
from tests.scenes import chains

BASE = chains(1000.0, bodies={"particles": 200}, experiment={"kind": "pull_off", "preload": 1.0})
PLATE: dict[str, Any] = {"plate": {}, "damping": {"coefficient": 0.3}}
SLIDE = PLATE | {
    "plate": {"free": ["x", "z"]}, "horizontal": {}, "cantilever": {"stiffness": 0.5, "velocity": 0.01},
    "noise": {"temperature": 0.01, "seed": 1}, "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 5.0},
}  # fmt: skip
LISTED = {"experiment": {"kind": "path", "displacements": [0, 1]}}
SPAN = {"experiment": {"kind": "path", "displacements": {"from": 0, "to": 1, "steps": 5}}}
MATERIAL = {"material": {"upper": STEEL, "lower": STEEL, "length_unit": 1.0}}
SIZES = {
    "bodies.upper_spacing": "LU", "bodies.profile.radius": "LU", "bodies.bulk_stiffness_tangential": "FU/LU",
    "bodies.mass": "MU", "interaction.repulsion.amplitude": "FU·LU", "interaction.attraction.range": "LU",
    "neighbours.stiffness": "FU/LU", "experiment.preload": "FU",
}  # fmt: skip


def lines(*overrides: str, tables: dict[str, Any] | None = None) -> list[str]:
    """What is printed for the base scene with these changes."""
    with pytest.raises(SceneError) as caught:
        read_scene(BASE | (tables or {}), overrides)
    printed = str(caught.value)
    assert printed == "\n".join(map(str, caught.value.problems))
    for word in ("pydantic", "tuple", "literal", "Input should", "union", "discriminat", "function-"):
        assert word not in printed
    return printed.split("\n")


@pytest.mark.parametrize("path", SIZES)
def test_a_size_is_a_finite_number_greater_than_zero(path: str) -> None:
    for value in ("0", "-1.0"):
        assert lines(f"{path}={value}") == [f"{path} = {value}: must be greater than 0 ({SIZES[path]})"]
    for value in ("true", "[1.0]", "2024-01-01"):
        assert lines(f"{path}={value}") == [f"{path} = {value}: must be a number greater than 0 ({SIZES[path]})"]
    for value in ("nan", "-inf"):
        assert lines(f"{path}={value}") == [f"{path} = {value}: must be a finite number greater than 0 ({SIZES[path]})"]


ONE_MISTAKE: list[tuple[dict[str, Any], str, str, str]] = [
    ({}, 'bodies.spacing="1.0"', "bodies.spacing", 'with its unit: "10 mm"'),
    ({}, "bodies.spacing=-1", "bodies.spacing", 'greater than 0 (LU), or "auto"'),
    ({}, "bodies.spacing={ number = 2 }", "bodies.spacing", 'must be a number greater than 0 (LU), or "auto"'),
    ({}, "bodies.particles=2", "bodies.particles", "from 3 to 10000000"),
    ({}, "bodies.particles=200.0", "bodies.particles", "write 200"),
    ({}, "bodies.particles=atuo", "bodies.particles", '"auto"'),
    ({}, "bodies.particles='200'", "bodies.particles", "without quotes and unit"),
    ({}, "interaction.cutoff=far", "interaction.cutoff", 'must be a number greater than 0 (LU), or "auto"'),
    (PLATE, "plate.damping=-1", "plate.damping", 'at least 0 (FU·TU/LU), or "auto"'),
    (PLATE, 'plate.free=["x"]', "plate.free", 'must contain "z"'),
    (PLATE, 'plate.free=["z", "z"]', "plate.free", "each direction once"),
    (PLATE, 'plate.free=["z", "y"]', "plate.free[1]", '"x" or "z"'),
    (PLATE, "plate.free=[]", "plate.free", "at least one item"),
    (PLATE, "plate.free=z", "plate.free", 'a list, each item "x" or "z"'),
    (SLIDE, "noise.seed=2147483648", "noise.seed", "from 1 to 2147483647"),
    (SLIDE, "cantilever.velocity=-0.1", "cantilever.velocity", "experiment.path = [[velocity, distance], …]"),
    (SLIDE, "experiment.method=dynamic", "experiment.method", "a slide is always dynamic: remove it"),
    (MATERIAL, "material.upper.poisson_ratio=0.6", "material.upper.poisson_ratio",
     "greater than -1 and at most 0.5"),
    ({}, "accuracy.tolerance=0.2", "accuracy.tolerance", "from 1e-07 to 0.1"),
    ({}, "experiment.kind=indent", "experiment.kind", '"tangential", "hold", "history" or "impact"'),
    ({}, "experiment.kind=[1]", "experiment.kind", '"load"'),
    ({}, "experiment.kind=pull-off", "experiment.kind", 'did you mean "pull_off"?'),
    ({}, "experiment={}", "experiment.kind", "missing"),
    ({}, "experiment=load", "experiment", "write it as [experiment], its keys below"),
    ({}, "neighbours=[{ stiffness = 0.3 }]", "neighbours", "in single brackets"),
    (LISTED, "experiment.displacements=[]", "experiment.displacements", "at least one item"),
    (LISTED, "experiment.displacements=3", "experiment.displacements", "or a table with from, to, steps, return"),
    (LISTED, 'experiment.displacements=[0, "a"]', "experiment.displacements[1]", "begins with a digit"),
    (LISTED, "experiment.displacements=[0, inf]", "experiment.displacements[1]", "a finite number (LU)"),
    (SPAN, "experiment.displacements.to=0", "experiment.displacements", '"from" and "to" must differ'),
    (SPAN, "experiment.displacements.return=no", "experiment.displacements.return", "true or false"),
    (SPAN, "experiment.displacements.from_=0", "experiment.displacements.from_", 'did you mean "from"?'),
    ({}, "bodies.profile.kind=parabolic", "bodies.profile.kind", 'did you mean "parabola"?'),
    ({}, "bodies.profile={ radius = 3.0 }", "bodies.profile.kind", "missing"),
    ({}, "bodies.profile=parabola", "bodies.profile", 'a table with kind = "parabola"'),
    ({}, "bodies.lower=particle", "bodies.lower", 'did you mean "particles"?'),
    ({}, 'title="a\\nb"', "title", "one line of text"),
    ({}, "title=3", "title", "text in quotes"),
    ({}, "horizontal=true", "horizontal", "a table without keys"),
    ({}, "horizontal.x=1", "horizontal.x", "allowed here: no keys"),
    ({}, "neighbors.stiffness=0.3", "neighbors", 'unknown table; did you mean "neighbours"?'),
    ({}, "bodies.stiffness=0.3", "bodies.stiffness", 'did you mean "bulk_stiffness"?'),
    ({}, "bodies.E=0.3", "bodies.E", "allowed here: particles, spacing, profile"),
    ({}, "experiment.tolerance=1e-3", "experiment.tolerance", "it belongs in [accuracy]"),
    (LISTED, "experiment.preload=2", "experiment.preload", 'it belongs in [experiment] of kind = "pull_off"'),
]  # fmt: skip


@pytest.mark.parametrize(("tables", "override", "path", "words"), ONE_MISTAKE)
def test_one_mistake_is_one_line(tables: dict[str, Any], override: str, path: str, words: str) -> None:
    (line,) = lines(override, tables=tables)
    assert line.startswith((f"{path}: ", f"{path} = "))
    assert words in line


def test_a_wrong_table_of_cycles_is_not_taken_for_displacements() -> None:
    tangential = {"kind": "tangential", "normal_force": 1.0, "displacements": {"from": 0, "to": 1, "steps": 5}}
    bodies = BASE["bodies"] | {"lower": "rigid_plane"}
    tables = {"bodies": bodies, "interaction": None, "friction": {"coefficient": 0.3}, "experiment": tangential}
    assert [line.partition("; ")[0] for line in lines("experiment.cycles=3", tables=tables)] == [
        "experiment.cycles = 3: must be a table with amplitude, number, points",
        "experiment.cycles = 3: not together with displacements",
    ]


def test_missing_tables_and_keys() -> None:
    with pytest.raises(SceneError) as caught:
        read_scene({})
    assert [problem.path for problem in caught.value.problems] == ["title", "bodies", "experiment"]
    assert lines("interaction.repulsion={ range = 0.1 }") == [
        "interaction.repulsion.amplitude: missing; must be a number greater than 0 (FU·LU)"
    ]


def test_a_misspelt_word_counts_as_what_was_meant() -> None:
    """So that what stands beside it, and the rules across tables, are checked in the same go."""
    for overrides, paths in (
        (["experiment={ knid = 'pulloff', preload = -1, x = 2 }"],
         ["experiment.knid", "experiment.kind", "experiment.x", "experiment.preload"]),
        (["dampnig.coefficient=-1", "plate={}"], ["damping.coefficient", "dampnig"]),
    ):  # fmt: skip
        with pytest.raises(SceneError) as caught:
            read_scene(BASE, overrides)
        assert [problem.path for problem in caught.value.problems] == paths


def test_all_mistakes_are_reported_at_once_in_the_order_of_the_scene() -> None:
    printed = lines(
        "bodies.particles=2", "bodies.bulk_stiffness='0.83'", "interaction.attraction.range=0.1",
        "neighbors.stiffness=0.3", "cantilever={ stiffness = 1, velocity = 1 }", "experiment.preload=-1",
    )  # fmt: skip
    assert [line.partition(":")[0].partition(" ")[0] for line in printed] == [
        "bodies.particles", "bodies.bulk_stiffness", "interaction.attraction.range", "cantilever",
        "experiment.preload", "neighbors",
    ]  # fmt: skip


def test_the_error_survives_the_way_between_processes() -> None:
    error = SceneError([Problem("bodies", "missing", hint="required table")])
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.problems, str(copy)) == (error.problems, "bodies: missing; required table")


def test_a_value_is_shown_as_toml_and_shortened() -> None:
    (line,) = lines(tables={"title": {"a b": [True, 'q"\\\n\x01'], "c": {}}})
    assert line.startswith('title = { "a b" = [true, "q\\"\\\\\\n\\u0001"], c = {} }: ')
    (long,) = lines(tables={"title": ["x" * 1000]})
    assert len(long) < 120
    assert "…" in lines(tables={"title": 10**5000})[0]
