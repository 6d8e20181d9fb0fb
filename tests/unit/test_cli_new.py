"""`contact1d new` and `schema`: a scene file that runs as it stands and names every key, and what an editor needs."""

from __future__ import annotations

import json
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from contact1d.workflow.cli.app import Kind, app
from contact1d.workflow.cli.starter import SCENES, starter
from contact1d.workflow.scene import Scene, read_scene
from contact1d.workflow.scene.quantities import keys_of
from contact1d.workflow.scene.schema import meaning, schema_text

KINDS = [kind.value for kind in Kind]


def contact1d(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [*map(str, arguments)])


def everything(kind: str) -> dict[str, Any]:
    """The scene file with the # taken away from every key and table that is not set."""
    return tomllib.loads(re.sub(r"^#(?=[a-z\[])", "", starter(kind), flags=re.MULTILINE))


def test_there_is_a_file_for_each_experiment() -> None:
    assert set(KINDS) == set(SCENES) == set(keys_of(Scene)["experiment"].allowed.kinds)


@pytest.mark.parametrize("kind", KINDS)
def test_a_new_scene_is_right_as_it_stands(kind: str, tmp_path: Path) -> None:
    done = contact1d("new", tmp_path / "my", "--kind", kind)
    assert done.exit_code == 0, done.output
    scene = read_scene(tmp_path / "my.toml")
    assert scene.experiment.kind == kind
    set_ = scene.model_dump(by_alias=True, exclude_unset=True, exclude={"title"}, mode="json")
    assert set_ == SCENES[kind]


def test_a_new_scene_runs(tmp_path: Path) -> None:
    assert contact1d("new", tmp_path / "my.toml", "--kind", "load").exit_code == 0
    done = contact1d("run", tmp_path / "my.toml", "--out", tmp_path / "run", "--no-figures", "-q")
    assert done.exit_code == 0, done.output
    assert json.loads((tmp_path / "run" / "results.json").read_text(encoding="utf-8"))["warnings"] == []


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
