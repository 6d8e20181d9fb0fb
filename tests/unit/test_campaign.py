"""Run folders: what is written, what is replaced, what is refused; and many runs through an executor."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import contact1d
from contact1d.workflow.runs.campaign import FolderError, RunError, prepare, run, run_many, write_deck
from contact1d.workflow.scene import Scene, scene_from_dict
from tests.scenes import chains

ALWAYS = {
    "results.json", "curve.csv", "profile.csv", "scene.toml", "system.data", "in.lammps", "log.lammps", "curve.txt",
}  # fmt: skip


def plane(**experiment: object) -> Scene:
    """Some particles on a rigid plane: the quickest run there is."""
    load = {"kind": "load", "force": 0.5} | experiment
    bodies = {"particles": 21, "lower": "rigid_plane"}
    return scene_from_dict(chains(50.0, 0.5, bodies=bodies, interaction=None, experiment=load))


def test_a_run_leaves_a_complete_folder(tmp_path: Path) -> None:
    finished = run(plane(), tmp_path / "run", figures=False)
    present = {path.name for path in finished.folder.iterdir()}
    assert present >= ALWAYS
    assert not any(name.endswith(".part") for name in present)
    document = json.loads((finished.folder / "results.json").read_text())
    assert document == finished.results
    assert document["status"] == "done"
    assert document["effects"] == []
    assert document["force"].keys() == {"value", "uncertainty", "unit"}
    assert document["timing"].keys() == {"total_s", "lammps_s", "lammps_cpu_s", "steps"}
    assert contact1d.read_scene(finished.folder / "scene.toml") == plane()


def test_a_failed_run_has_no_numbers_and_keeps_its_files(tmp_path: Path) -> None:
    with pytest.raises(RunError, match="end of the chain"):
        run(plane(force=30.0), tmp_path / "run", figures=False)
    document = json.loads((tmp_path / "run" / "results.json").read_text())
    assert document["status"] == "failed"
    assert document["error"]["phase"] == "loading"
    assert not any(isinstance(entry, dict) and "value" in entry for entry in document.values())
    assert (tmp_path / "run" / "in.lammps").exists()


def test_a_new_run_removes_what_an_earlier_one_left(tmp_path: Path) -> None:
    run(plane(), tmp_path, figures=True)
    assert (tmp_path / "pressure.png").exists()
    with pytest.raises(RunError):
        run(plane(force=30.0), tmp_path, figures=False)
    assert not (tmp_path / "pressure.png").exists()
    assert not (tmp_path / "curve.csv").exists()


def test_a_folder_of_other_things_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("precious")
    with pytest.raises(FolderError, match="not of a run"):
        prepare(tmp_path)
    with pytest.raises(FolderError, match="is a file"):
        prepare(tmp_path / "thesis.tex")
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_deck_is_written_without_running(tmp_path: Path) -> None:
    folder = write_deck(plane(), tmp_path / "deck")
    assert {path.name for path in folder.iterdir()} == {"in.lammps", "scene.toml", "system.data"}


def test_many_runs_come_back_in_order_with_failures_among_them(tmp_path: Path) -> None:
    pairs = [(plane(force=force), tmp_path / str(i)) for i, force in enumerate((0.5, 30.0, 0.25))]
    with ThreadPoolExecutor(2) as executor:
        first, second, third = run_many(pairs, executor)
    assert isinstance(second, RunError)
    assert not isinstance(first, RunError)
    assert not isinstance(third, RunError)
    assert first.results["force"]["value"] > third.results["force"]["value"]


def test_a_run_error_survives_the_way_between_processes() -> None:
    import pickle

    error = pickle.loads(pickle.dumps(RunError("why", Path("somewhere"))))
    assert (error.message, error.folder) == ("why", Path("somewhere"))


def test_public_names_are_there_and_others_are_not() -> None:
    assert all(getattr(contact1d, name) is not None for name in contact1d.__all__)
    with pytest.raises(AttributeError, match="no attribute 'missing'"):
        _ = contact1d.missing
