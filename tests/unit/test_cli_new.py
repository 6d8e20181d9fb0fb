"""`contact1d new` and `schema`: a scene file that runs as it stands and names every key, and what an editor needs."""

import json
import re
import tomllib
from itertools import cycle
from pathlib import Path
from typing import Any

import pytest

from contact1d import read_scene
from tests.command import contact1d
from tests.scenes import read_json

Schema = dict[str, Any]


SCHEMA: Schema = json.loads(contact1d("schema").stdout)


def kinds_of(schema: Schema) -> dict[str, Schema]:
    """The tables that a key may be, by their kind; "" of one without a kind."""
    tables = [table for table in schema.get("anyOf", [schema]) if "properties" in table]
    return {table["properties"].get("kind", {}).get("enum", [""])[0]: table for table in tables}


KINDS = list(kinds_of(SCHEMA["properties"]["experiment"]))


def new(folder: Path, kind: str, *options: str) -> str:
    done = contact1d("new", folder / "my", "--kind", kind, *options)
    assert done.exit_code == 0, done.output
    return (folder / "my.toml").read_text(encoding="utf-8")


PROFILES = zip([kind for kind in KINDS if kind != "slide"], cycle(("flat_punch", "parabola", "cone")), strict=False)


@pytest.mark.parametrize(("kind", "profile"), [*PROFILES, ("slide", None)])
def test_a_new_scene_runs_without_a_warning(kind: str, profile: str | None, tmp_path: Path) -> None:
    new(tmp_path, kind, *(["--profile", profile, "--material", "rubber/PMMA"] if profile else []))
    scene = read_scene(tmp_path / "my.toml")
    assert scene.experiment.kind == kind
    if profile is not None:
        assert scene.bodies.profile.kind == profile
        assert scene.material is not None
        assert scene.material.upper is not None
        assert scene.material.lower is not None
        assert (scene.material.upper.youngs_modulus, scene.material.lower.poisson_ratio) == (2e6, 0.35)
    done = contact1d("run", tmp_path / "my.toml", "--out", tmp_path / "run", "--no-figures", "-q")
    assert done.exit_code == 0, done.output
    assert read_json(tmp_path / "run" / "results.json")["warnings"] == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_of_the_schema_is_there_with_its_meaning_and_unit(kind: str, tmp_path: Path) -> None:
    """Also behind the # before each key and table that is not set."""
    text = new(tmp_path, kind)
    everything, told = (
        tomllib.loads(re.sub(r"^#(?=[a-z\[])", "", text, flags=re.MULTILINE)),
        re.sub(r"\n# +", " ", text),
    )
    assert everything.keys() == SCHEMA["properties"].keys()
    for name, table in everything.items():
        if name == "title":
            continue
        schema = kinds_of(SCHEMA["properties"][name])[table.get("kind", "")]
        assert table.keys() == schema["properties"].keys()
        for key, value in table.items():
            means = schema["properties"][key]
            assert key == "kind" or means["description"].partition("; must be")[0] in told
            has_unit = any("pattern" in form for form in means.get("anyOf", []))
            assert not (has_unit and isinstance(value, int | float)), key


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


def test_nothing_is_overwritten_and_no_folder_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "there.toml").write_text("mine")
    for asked, words in (
        (("new", "there"), "there.toml exists and is not"),
        (("new", "no/such/my"), "there is no folder no/such; make it first: mkdir -p no/such"),
        (("new", "."), ". is a folder; give the file a name"),
        (("new", "there.toml/my"), "there.toml is a file; a folder is needed"),
        (("schema", "--out", "there.toml"), "there.toml exists and is not"),
    ):
        done = contact1d(*asked)
        assert (done.exit_code, done.stdout) == (2, "")
        assert words in done.stderr
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("there.toml", "mine")]


def test_the_schema_is_written(tmp_path: Path) -> None:
    done = contact1d("schema", "--out", tmp_path / "scene.schema.json")
    assert "#:schema scene.schema.json" in done.stdout
    assert read_json(tmp_path / "scene.schema.json") == SCHEMA
