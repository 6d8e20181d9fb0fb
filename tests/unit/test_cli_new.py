"""`contact1d new` and `schema`: a scene file that runs as it stands and names every key, and what an editor needs."""

from __future__ import annotations

import json
import re
import tomllib
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from contact1d import Scene, read_scene
from contact1d.workflow.cli.app import Kind, app
from contact1d.workflow.cli.starter import DATA, starter, starter_scene
from contact1d.workflow.scene.quantities import keys_of, places
from contact1d.workflow.scene.schema import meaning, schema_text

KINDS = [kind.value for kind in Kind]


def contact1d(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [*map(str, arguments)])


def everything(kind: str) -> dict[str, Any]:
    """The scene file with the # taken away from every key and table that is not set."""
    return tomllib.loads(re.sub(r"^#(?=[a-z\[])", "", starter(kind), flags=re.MULTILINE))


def test_there_is_a_file_for_each_experiment() -> None:
    assert set(KINDS) == set(DATA["scenes"]) == set(keys_of(Scene)["experiment"].allowed.kinds)


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_scene_is_right_as_it_stands(kind: str, tmp_path: Path) -> None:
    done = contact1d("new", tmp_path / "my", "--kind", kind)
    assert done.exit_code == 0, done.output
    set_ = tomllib.loads((tmp_path / "my.toml").read_text(encoding="utf-8"))
    assert read_scene(tmp_path / "my.toml").experiment.kind == kind
    assert set_.pop("title")
    assert set_ == starter_scene(kind)


ON_THE_PLANE = zip([kind for kind in KINDS if kind != "slide"], cycle(("flat_punch", "parabola", "cone")), strict=False)


@pytest.mark.parametrize(("kind", "profile"), [*ON_THE_PLANE, ("load", "power"), ("load", "circle"), ("slide", None)])
def test_a_new_scene_runs_without_a_warning(kind: str, profile: str | None, tmp_path: Path) -> None:
    options = ["--profile", profile, "--material", "rubber/PMMA"] if profile else []
    assert contact1d("new", tmp_path / "my.toml", "--kind", kind, *options).exit_code == 0
    done = contact1d("run", tmp_path / "my.toml", "--out", tmp_path / "run", "--no-figures", "-q")
    assert done.exit_code == 0, done.output
    assert json.loads((tmp_path / "run" / "results.json").read_text(encoding="utf-8"))["warnings"] == []


def test_materials_are_those_of_the_option() -> None:
    material = read_scene(starter("load", "cone", "rubber/PMMA")).material
    assert material is not None
    assert material.upper is not None
    assert material.lower is not None
    assert (material.upper.youngs_modulus, material.lower.poisson_ratio) == (2e6, 0.35)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--material", "stel/glass"), 'material.upper = "stel": must be a table with'),
        (("--kind", "slide", "--profile", "cone"), "its two bodies are particles that an interaction holds"),
        (("--kind", "slide", "--material", "steel/glass"), "leave both out"),
    ],
)
def test_what_makes_no_scene_is_refused_and_not_written(options: tuple[str, ...], words: str, tmp_path: Path) -> None:
    done = contact1d("new", tmp_path / "my.toml", *options)
    assert done.exit_code == 2
    assert words in " ".join(done.output.split())
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("kind", KINDS)
def test_every_quantity_has_a_unit_behind_a_sign_too(kind: str) -> None:
    plain = [
        place.keys
        for place in places(Scene, everything(kind))
        if not place.absent and place.unit.name != "1" and isinstance(place.value, float | int)
    ]
    assert plain == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_of_every_table_is_there_with_its_meaning(kind: str) -> None:
    document, text, keys = everything(kind), re.sub(r"\n#   *", " ", starter(kind)), keys_of(Scene)
    assert document.keys() == keys.keys()
    for name, given in document.items():
        if isinstance(given, dict):
            table = keys[name].allowed.table_for(given)
            assert table is not None
            assert given.keys() == keys_of(table).keys()
            assert all(meaning(table, key) in text for key in given if key != "kind")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("there", "there.toml exists and is not"),
        ("there.toml", "there.toml exists and is not"),
        ("no/such/my", "there is no folder no/such; make it first: mkdir -p no/such"),
        (".", ". is a folder; give the file a name"),
        ("there.toml/my", "there.toml is a file; a folder is needed"),
    ],
)
def test_nothing_is_overwritten_and_no_folder_made(
    name: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.toml").write_text("mine")
    done = contact1d("new", name)
    assert (done.exit_code, done.stdout) == (2, "")
    assert words in done.stderr
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("there.toml", "mine")]


def test_the_schema_is_printed_or_written(tmp_path: Path) -> None:
    assert contact1d("schema").stdout == schema_text()
    done = contact1d("schema", "--out", tmp_path / "scene.schema.json")
    assert "#:schema scene.schema.json" in done.stdout
    assert (tmp_path / "scene.schema.json").read_text(encoding="utf-8") == schema_text()
    again = contact1d("schema", "--out", tmp_path / "scene.schema.json")
    assert (again.exit_code, again.stdout) == (2, "")
