"""Run folders: what is written, what is replaced, what is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

import contact1d
from contact1d import Scene, run, write_deck
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs.campaign import prepare

MakeScene = Callable[..., Scene]
ALWAYS = {
    "results.json", "curve.csv", "profile.csv", "scene.toml", "system.data", "in.lammps", "log.lammps", "curve.txt",
}  # fmt: skip


def test_a_run_leaves_a_complete_folder(plane: MakeScene, tmp_path: Path) -> None:
    finished = run(plane(), tmp_path / "run", figures=False)
    present = {path.name for path in finished.folder.iterdir()}
    assert present >= ALWAYS
    assert not any(name.endswith(".part") for name in present)
    document = json.loads((finished.folder / "results.json").read_text())
    assert document == finished.document
    assert document["status"] == "done"
    assert document["effects"] == []
    assert document["force"].keys() == {"value", "uncertainty", "unit"}
    assert document["timing"].keys() == {"total_s", "lammps_s", "lammps_cpu_s", "rows_s", "steps"}
    assert contact1d.read_scene(finished.folder / "scene.toml") == plane()


def test_a_failed_run_has_no_numbers_and_keeps_its_files(plane: MakeScene, tmp_path: Path) -> None:
    with pytest.raises(RunError, match="end of the chain"):
        run(plane(force=30.0), tmp_path / "run", figures=False)
    document = json.loads((tmp_path / "run" / "results.json").read_text())
    assert document["status"] == "failed"
    assert document["error"]["phase"] == "loading"
    assert not any(isinstance(entry, dict) and "value" in entry for entry in document.values())
    assert (tmp_path / "run" / "in.lammps").exists()


def test_a_new_run_removes_what_an_earlier_one_left(plane: MakeScene, tmp_path: Path) -> None:
    run(plane(), tmp_path, figures=True)
    assert (tmp_path / "pressure.png").exists()
    with pytest.raises(RunError):
        run(plane(force=30.0), tmp_path, figures=False)
    assert not (tmp_path / "pressure.png").exists()
    assert not (tmp_path / "curve.csv").exists()


def test_a_folder_of_other_things_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("precious")
    with pytest.raises(FolderError, match="do not belong to a run"):
        prepare(tmp_path)
    with pytest.raises(FolderError, match="is a file"):
        prepare(tmp_path / "thesis.tex")
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_deck_is_written_without_running(plane: MakeScene, tmp_path: Path) -> None:
    folder = write_deck(plane(), tmp_path / "deck")
    assert {path.name for path in folder.iterdir()} == {"in.lammps", "scene.toml", "system.data"}
