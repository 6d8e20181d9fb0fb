"""A run and its folder: what is written, replaced and refused; a finished run from memory and from its folder."""

import csv
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import contact1d
from contact1d import Contact1dError, FolderError, Quantity, Run, RunError, Scene, load_run, read_scene, run, write_deck
from tests.scenes import chains, read_json
from tests.sweeps import BROKEN

MakeScene = Callable[..., Scene]
ALWAYS = {
    "results.json", "curve.csv", "profile.csv", "scene.toml", "system.data", "in.lammps", "log.lammps", "curve.txt",
}  # fmt: skip
STEEL = {"youngs_modulus": 210e9, "poisson_ratio": 0.3}
SHORT = 1300
"""Characters that a run shows of itself, sentences of warnings among them; it has hundreds of thousands of numbers."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Run:
    """A pull-off with a title that HTML would trip over, and with SI units."""
    scene = chains(
        50.0, title="a <b> & c", bodies={"particles": 40}, accuracy={"tolerance": 1e-2},
        material={"upper": STEEL, "lower": STEEL, "length_unit": 2e-9},
        experiment={"kind": "pull_off", "preload": 0.2},
    )  # fmt: skip
    return run(scene, tmp_path_factory.mktemp("run") / "small")


def test_results_are_quantities_by_name_and_as_attributes(finished: Run) -> None:
    entry = read_json(finished.folder / "results.json")["adhesion_force"]
    force = finished.results["adhesion_force"]
    assert (force.value, force.uncertainty, force.unit) == (entry["si"]["value"], entry["si"]["uncertainty"], "N")
    assert float(force) == force.value
    own = finished.model.results["adhesion_force"]
    assert (own.value, own.uncertainty, own.unit) == (entry["value"], entry["uncertainty"], "FU")
    assert finished.results.adhesion_force is force
    assert "adhesion_force" in dir(finished.results)
    found = {"adhesion_force", "critical_radius", "zero_load_radius", "preload", "work_of_separation"}
    body = {"central_pressure", "peak_pressure", "adhesion_energy"}
    assert set(finished.results) == found | body | {"separation_energy", "work_of_adhesion"}
    with pytest.raises(KeyError, match="no pull_off_force, it has adhesion_force"):
        finished.results["pull_off_force"]
    with pytest.raises(AttributeError, match="no pull_off_force, it has adhesion_force"):
        _ = finished.results.pull_off_force


def test_a_run_shows_itself_in_a_few_lines(finished: Run) -> None:
    shown = repr(finished)
    assert len(shown) < SHORT
    first, *rest = shown.splitlines()
    assert "a <b> & c" in first
    assert "done" in first
    assert str(finished.folder) in first
    assert any("adhesion_force" in line and str(finished.results.adhesion_force) in line for line in rest)
    assert finished.warnings
    assert all(f"warning {name}: {message}" in shown for name, message in finished.warnings.items())
    assert "a &lt;b&gt; &amp; c: done" in finished._repr_html_()
    assert "<b>" not in finished._repr_html_()


def test_a_run_draws_its_figures_and_gives_its_atoms(finished: Run) -> None:
    files = {path.stem for path in finished.folder.glob("*.png")}
    assert files == {"force_displacement", "force_radius", "pressure", "pressure_3d"}
    loaded = load_run(finished.folder)
    assert [axis.get_xlabel() for axis in loaded.plot().axes] == ["displacement (nm), compression positive"]
    assert loaded.plot().get_suptitle().startswith(loaded.scene.title)
    there = "force_displacement, force_radius, pressure, pressure_3d"
    with pytest.raises(ValueError, match=f"no figure 'friction', it has {there}"):
        loaded.plot("friction")
    np.testing.assert_array_equal(finished.atoms().positions, contact1d.atoms(finished.folder).positions)
    assert len(loaded.atoms(0)) == 160


def test_results_and_tables_go_to_other_programs(finished: Run, tmp_path: Path) -> None:
    force = finished.results.adhesion_force
    assert finished.to_json(tmp_path / "a.json") == (finished.folder / "results.json").read_text()
    assert (tmp_path / "a.json").read_text() == finished.to_json()
    assert finished.to_csv(table="curve") == (finished.folder / "curve.csv").read_text()
    assert finished.to_csv(tmp_path / "a.csv").startswith("name,value,uncertainty,unit\nadhesion_force,")
    with (tmp_path / "a.csv").open(newline="") as file:
        (row,) = (row for row in csv.DictReader(file) if row["name"] == "adhesion_force")
    assert (float(row["value"]), float(row["uncertainty"]), row["unit"]) == (force.value, force.uncertainty, "N")
    with pytest.raises(ValueError, match="no table 'kurve', it has results, curve, profile, pressure_3d"):
        finished.to_csv(table="kurve")


def test_results_are_a_table_of_latex(finished: Run) -> None:
    given = {"adhesion_force": Quantity(1.234e-7, 1.2e-9, "N"), "pressure": Quantity(2e-14, 0.0, "FU/LU²"),
             "ratio": Quantity(0.5, 0.1, "1")}  # fmt: skip
    own = replace(finished)
    vars(own)["results"] = given
    assert own.to_latex().splitlines() == [
        r"\begin{tabular}{ll}",
        r"adhesion force & $123.4 \pm 1.2\,\mathrm{nN}$ \\",
        r"pressure & $2\cdot 10^{-14}\,\mathrm{FU}/\mathrm{LU}^2$ \\",
        r"ratio & $0.50 \pm 0.10$ \\",
        r"\end{tabular}",
    ]


def test_a_dataset_says_what_to_install(finished: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(Contact1dError, match=r"needs xarray: install it with pip install 'contact1d\[tables\]'"):
        finished.to_xarray()


def test_a_run_leaves_a_complete_folder_and_a_new_one_takes_it_away(plane: MakeScene, tmp_path: Path) -> None:
    """Numbers are there before the figures; one that fails has none and raises its own message again."""
    seen: list[Run] = []

    def printed(run: Run) -> None:
        assert read_json(run.folder / "results.json")["status"] == "done"
        assert not [*run.folder.glob("*.png")]
        seen.append(run)

    folder = tmp_path / "run"
    done = run(plane(), folder, printed=printed)
    assert seen == [done]
    present = {path.name for path in folder.iterdir()}
    assert present >= ALWAYS | {"pressure.png"}
    assert not any(name.endswith(".part") for name in present)
    document = read_json(folder / "results.json")
    assert document == done.document
    assert (document["status"], document["effects"]) == ("done", [])
    assert document["force"].keys() == {"value", "uncertainty", "unit"}
    assert document["timing"].keys() == {"total_s", "lammps_s", "lammps_cpu_s", "rows_s", "steps"}
    assert read_scene(folder / "scene.toml") == plane()
    with pytest.raises(RunError, match="end of the chain") as failed:
        run(plane(force=30.0), folder, figures=False)
    document = read_json(folder / "results.json")
    assert (document["status"], document["error"]["phase"]) == ("failed", "loading")
    assert not any(isinstance(entry, dict) and "value" in entry for entry in document.values())
    assert (folder / "in.lammps").exists()
    assert not {"pressure.png", "curve.csv"} & {path.name for path in folder.iterdir()}
    with pytest.raises(RunError) as loaded:
        load_run(folder)
    assert loaded.value.message in failed.value.message
    assert loaded.value.folder == failed.value.folder == folder


def test_a_folder_of_other_things_is_left_alone(plane: MakeScene, tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("precious")
    for folder, words in ((tmp_path, "do not belong to a run"), (tmp_path / "thesis.tex", "is a file")):
        with pytest.raises(FolderError, match=words):
            write_deck(plane(), folder)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]
    deck = write_deck(plane(), tmp_path / "deck")
    assert {path.name for path in deck.iterdir()} == {"in.lammps", "scene.toml", "system.data"}


def test_a_folder_without_a_run_is_refused_in_words(plane: MakeScene, tmp_path: Path) -> None:
    with pytest.raises(FolderError, match="give the folder of a finished run"):
        load_run(tmp_path / "nowhere")
    folder = run(plane(), tmp_path / "run", figures=False).folder
    results = folder / "results.json"
    whole = read_json(results)
    table = (folder / "curve.csv").read_text()
    results.write_text(json.dumps(whole | {"scene": whole["scene"] | {"law": "other"}}))
    with pytest.raises(FolderError, match="law: unknown"):
        load_run(folder)
    for text in BROKEN.values():
        results.write_text(text(whole))
        with pytest.raises(FolderError, match=r"is not the results\.json of a run; .* run its scene again$"):
            load_run(folder)
    results.write_text(json.dumps(whole))
    (folder / "curve.csv").write_text(table[: len(table) // 2].rpartition(",")[0])
    with pytest.raises(FolderError, match="readable by this version"):
        load_run(folder)
    (folder / "curve.csv").unlink()
    with pytest.raises(FolderError, match=r"curve\.csv"):
        load_run(folder)
