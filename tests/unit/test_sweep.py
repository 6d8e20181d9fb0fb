"""A sweep: its points, what is run, kept and run again, one table of all, and figures with the closed forms."""

import json
import os
import resource
import shutil
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from contact1d import Contact1dError, FolderError, SceneError, load_run, run, sweep
from tests.command import contact1d
from tests.pages import figures_on
from tests.scenes import MODULUS, SCENES, read_json
from tests.sweeps import BROKEN, FORCE, PLANE, RADIUS, RADIUS_IN_WORDS, Here, Lost, Stated, axis, plane, rows

SCENE = SCENES / "steel_on_glass.toml"
TWO = plane(axis(FORCE, 0.5, 1.0))


def points(folder: Path, *axes: Mapping[str, Any], **more: Any) -> list[tuple[float, ...]]:
    """The values of each point of a sweep that does not run, in order."""
    sweep(plane(*axes, **more), folder, Lost(), figures=False)
    return [tuple(map(float, list(row.values())[: len(axes)])) for row in rows(folder)]


def page_of(folder: Path) -> Path:
    page = folder / "page.html"
    done = contact1d("report", folder, "--out", page)
    assert done.exit_code == 0, done.output
    return page


def test_a_product_has_every_value_with_every_other_and_zip_takes_them_side_by_side(tmp_path: Path) -> None:
    radii, forces = axis(RADIUS, 50.0, 100.0), axis(FORCE, 0.5, 1.0, 1.5)
    expected = [(radius, force) for radius in (50.0, 100.0) for force in (0.5, 1.0, 1.5)]
    assert points(tmp_path / "product", radii, forces) == expected
    assert points(tmp_path / "zip", radii, axis(FORCE, 0.5, 1.0), combine="zip") == [(50.0, 0.5), (100.0, 1.0)]


@pytest.mark.parametrize(
    ("span", "values"),
    [
        ({"from": 0.1, "to": 0.7, "steps": 6}, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]),
        ({"from": 1.0, "to": 1000.0, "steps": 3, "scale": "log"}, [1.0, 10.0, 100.0, 1000.0]),
        ({"from": "1 µm", "to": "100 µm", "steps": 2, "scale": "log"}, [1e-6, 1e-5, 1e-4]),
    ],
)
def test_a_span_has_steps_and_one_more_value(span: dict[str, Any], values: list[float], tmp_path: Path) -> None:
    found = points(tmp_path, {"key": RADIUS, **span})
    assert found == [(value,) for value in values]


@pytest.mark.parametrize(
    ("source", "sentence"),
    [
        (plane({"key": RADIUS, "from": "1 m", "to": "2 N", "steps": 1}), "must have the same dimension at"),
        (plane(axis(RADIUS, 1.0), axis(RADIUS, 2.0)), "another axis has the same key"),
        (plane({"key": RADIUS}), "axes[0]: lacks from, to, steps; give values, or from, to and steps"),
        (plane({"key": RADIUS, "form": 1.0, "to": 2.0, "steps": 2}), 'axes[0].form: unknown key; did you mean "from"?'),
        (plane({"key": RADIUS, "from": 0.0, "to": 2.0, "steps": 2, "scale": "log"}), "log needs from and to above 0"),
        (plane(axis(RADIUS, 1.0), axis(FORCE, 1.0, 2.0), combine="zip"), '"zip" needs axes of one length'),
        (plane(axis("bodies.profile.radus", 1.0)), "radus: unknown key"),
        (
            plane(*({"key": key, "from": 1.0, "to": 2.0, "steps": n} for key, n in ((RADIUS, 9999), (FORCE, 100)))),
            "10000 × 101 = 1010000 points are more than 1000000",
        ),
    ],
)
def test_a_wrong_sweep_is_told_in_a_sentence_before_anything_is_written(
    source: dict[str, Any], sentence: str, tmp_path: Path
) -> None:
    with pytest.raises(SceneError) as caught:
        sweep(source, tmp_path / "out", Lost())
    assert sentence in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_each_point_has_a_row_whatever_became_of_it(tmp_path: Path) -> None:
    """Done, failed (too narrow for its load), refused (a radius below 0); duplicates run once."""
    executor = Here()
    done = sweep(plane(axis(FORCE, 1.0, 900.0, -2.0, 1.0), axis(RADIUS, 100.0)), tmp_path / "s", executor)
    table = rows(tmp_path / "s")
    assert [row["status"] for row in table] == ["done", "failed", "refused", "done"]
    assert done.counts == {"done": 2, "failed": 1, "refused": 1}
    assert "end of the chain" in table[1]["reason"]
    assert FORCE in table[2]["reason"]
    assert table[0]["run"] == table[3]["run"]
    assert len(executor.given) == 2
    found = load_run(tmp_path / "s" / table[0]["run"]).results
    for name, quantity in found.items():
        assert float(table[0][name]) == quantity.value
        assert float(table[0][f"{name}_uncertainty"]) == quantity.uncertainty
    assert set(done.quantities) == set(found)
    assert table[1]["displacement"] == ""


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished sweep, TWO; to be copied."""
    folder = tmp_path_factory.mktemp("finished")
    sweep(TWO, folder, Here(), figures=False)
    return folder


def test_only_what_is_new_or_broken_runs_again(finished: Path, tmp_path: Path) -> None:
    """Two broken results and a record that was cut short; then a value is added, and a result cannot be trusted."""
    folder = shutil.copytree(finished, tmp_path / "s")
    table, record = ((folder / name).read_text() for name in ("results.csv", "sweep.toml"))
    files = [folder / row["run"] / "results.json" for row in rows(folder)]
    for file, kind in zip(files, ("half", "NaN"), strict=True):
        file.write_text(BROKEN[kind](read_json(file)))
    (folder / "sweep.toml").write_text(record[:60])
    sweep(TWO, folder, again := Here(), figures=False, progress=(progress := Mock()))
    assert again.given == [file.parent.name for file in files]
    first, *others = [call.args[0] for call in progress.note.mock_calls]
    assert first == f"{folder / 'sweep.toml'} is not the record of a sweep and is replaced"
    assert others == [f"{file.parent.name}: its results.json is invalid, so it is run again" for file in files]
    assert [(folder / name).read_text() for name in ("results.csv", "sweep.toml")] == [table, record]
    document = read_json(files[1])
    files[1].write_text(json.dumps(document | {"force": document["force"] | {"value": None}}))
    sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), folder, more := Here(), figures=False)
    assert len(more.given) == 1
    assert [bool(row["force"]) for row in rows(folder)] == [True, True, False]
    assert [bool(row["force_uncertainty"]) for row in rows(folder)] == [True, True, False]


def test_a_folder_of_another_sweep_or_of_other_things_is_left_alone(finished: Path, tmp_path: Path) -> None:
    other = plane(axis(RADIUS, 50.0))
    with pytest.raises(FolderError, match="holds another sweep"):
        sweep(other, finished, Lost())
    for name, words in (("thesis.tex", "do not belong to a sweep"), ("sweep.toml", "choose another folder")):
        folder = tmp_path / name[:3]
        folder.mkdir()
        (folder / name).write_text("mine = [")
        with pytest.raises(FolderError, match=words):
            sweep(other, folder, Lost())
        assert [(path.name, path.read_text()) for path in folder.iterdir()] == [(name, "mine = [")]


def test_a_page_of_a_broken_table_says_to_start_the_sweep_again(finished: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(finished, tmp_path / "s")
    for content in (b"\xff\xfe\x00", b"status\ndone"):
        (folder / "results.csv").write_bytes(content)
        page = contact1d("report", folder, "--out", tmp_path / "page.html")
        assert (page.exit_code, page.output.count("\n")) == (2, 1)
        assert page.output.endswith("start the run or the sweep again\n")
    both = contact1d("report", finished, folder, "--out", tmp_path / "page.html")
    assert "a page shows one of them, or runs" in both.output
    assert not (tmp_path / "page.html").exists()


class FullDisk(Here):
    """For the second run the disk has no place for its states."""

    def run(self, fn: Any, tasks: Any) -> Any:
        soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
        if len(self.given) == 2:
            resource.setrlimit(resource.RLIMIT_FSIZE, (7000, hard))
        try:
            return fn(tasks)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_full_disk_ends_the_sweep_and_the_same_command_goes_on(tmp_path: Path) -> None:
    three = plane(axis(FORCE, 0.5, 0.75, 1.0))
    with pytest.raises(OSError, match="File too large"):
        sweep(three, tmp_path, FullDisk(), workers=1, figures=False)
    assert [row["status"] for row in rows(tmp_path)] == ["done", "missing", "done"]
    sweep(three, tmp_path, rest := Here(), figures=False)
    assert len(rest.given) == 1
    assert [row["status"] for row in rows(tmp_path)] == ["done"] * 3


def test_a_point_that_kills_its_process_is_a_row_and_takes_no_other_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A process of the pool dies as it makes the folder of the second run, as by a lack of memory."""
    three = plane(axis(FORCE, 0.5, 0.75, 1.0))
    sweep(three, tmp_path / "names", names := Lost(), figures=False)
    deadly = f"lambda event, given: event == 'os.mkdir' and {names.given[1]!r} in str(given) and os._exit(1)"
    (tmp_path / "sitecustomize.py").write_text(f"import os, sys\nsys.addaudithook({deadly})\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path) + os.pathsep + os.environ.get("PYTHONPATH", ""))
    done = sweep(three, tmp_path / "s", workers=1, figures=False)
    assert [row["status"] for row in rows(tmp_path / "s")] == ["done", "failed", "done"]
    assert "killed twice" in rows(tmp_path / "s")[1]["reason"]
    assert done.counts == {"done": 2, "failed": 1}


def test_an_executor_that_is_not_there_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(Contact1dError, match="no sbatch"):
        sweep(TWO, tmp_path / "s", "slurm")
    with pytest.raises(Contact1dError, match="local or slurm"):
        sweep(TWO, tmp_path / "s", "cloud")
    monkeypatch.setitem(sys.modules, "executorlib", None)
    with pytest.raises(Contact1dError, match=r"pip install 'contact1d\[cluster\]'"):
        sweep(TWO, tmp_path / "s", "slurm")
    assert not (tmp_path / "s").exists()


def test_the_command_prints_counts_and_ends_with_3_where_a_point_failed(finished: Path, tmp_path: Path) -> None:
    """Of a finished sweep to which a point is added; Parquet has the same numbers, the page rows and figures."""
    from pyarrow import parquet

    out = shutil.copytree(finished, tmp_path / "o")
    text = (finished / "sweep.toml").read_text().replace("0.5, 1.0", "0.5, 1.0, 900.0")
    (tmp_path / "s.toml").write_text(text)
    asked = ["sweep", str(tmp_path / "s.toml"), "--out", str(out), "--workers", "1", "-q", "--parquet"]
    result = contact1d(*asked, "--format", "svg")
    assert result.exit_code == 3
    assert "2 done, 1 failed" in result.output
    assert (out / "displacement.svg").is_file()
    read = parquet.read_table(out / "results.parquet").to_pydict()
    assert read["displacement"][:2] == [float(row["displacement"]) for row in rows(out)[:2]]
    page = page_of(out)
    assert page.read_text().count("<td>done</td>") == 2
    charts = {chart["title"].partition(" over ")[0] for chart in figures_on(page)["charts"]}
    assert {"Displacement", "Contact radius"} <= charts


def test_the_table_has_numbers_in_one_unit_and_the_page_their_closed_forms(tmp_path: Path) -> None:
    """Radii in mm, from a logarithmic row of texts, and forces in N: Hertz, a³ = 3FR/4E* and d = a²/R."""
    radius = {"key": RADIUS, "from": "1 mm", "to": "10 mm", "steps": 2, "scale": "log"}
    forces = np.array([1.0, 2.0, 4.0])
    axes = [axis(FORCE, "1 N", "2 N", "4 N"), radius]
    done = sweep({"title": "table", "scene": str(SCENE), "axes": axes}, tmp_path, Here(), figures=False)
    table = done.table()
    radii = 1e-3 * 10.0 ** np.array([0.0, 0.5, 1.0])
    assert table[RADIUS].tolist() == pytest.approx(np.tile(radii, 3).tolist())
    assert table[FORCE].tolist() == np.repeat(forces, 3).tolist()
    assert (table.attrs["units"][RADIUS], table.attrs["units"]["contact_radius"]) == ("m", "m")
    hertz = (0.75 * table[FORCE] * table[RADIUS] / MODULUS) ** (1.0 / 3.0)
    assert table["contact_radius"].tolist() == pytest.approx(hertz.tolist(), rel=3e-3)  # 5 to 27 particles in it
    page = page_of(tmp_path)
    assert '<th scope="col">displacement (µm)</th>' in page.read_text(encoding="utf-8")
    chart = next(chart for chart in figures_on(page)["charts"] if chart["title"].startswith("Displacement"))
    assert ": table" not in chart["title"]
    names = [f"{RADIUS_IN_WORDS} = {text}" for text in ("1 mm", "3.1623 mm", "10 mm")]
    assert shown(chart) == ["Hertz", *names]
    assert chart["layout"]["xaxis"]["type"] == "linear"
    lines, markers = ([trace for trace in chart["data"] if trace["mode"] == kind] for kind in ("lines", "markers"))
    assert len({trace["line"]["color"] for trace in markers}) == len(radii)
    dense = [trace for trace in lines if len(trace["x"]) > 10 * len(forces)]
    for R, line, dots in zip(radii, dense, markers, strict=True):
        assert line["line"]["color"] == dots["line"]["color"]
        d = (0.75 * np.asarray(line["x"]) / MODULUS / R**0.5) ** (2.0 / 3.0)
        assert np.asarray(line["y"]) / np.asarray(line["y"])[0] == pytest.approx(d / d[0], rel=1e-3)


def shown(chart: Mapping[str, Any]) -> list[str]:
    """The legend of a chart."""
    return [trace["name"].replace("\u00a0", " ") for trace in chart["data"] if trace["showlegend"]]


def one_chart(source: Mapping[str, Any], stated: Iterable[tuple[float, float]], folder: Path) -> dict[str, Any]:
    """The figure of a sweep whose points have stated displacements, in turn."""
    document = run(PLANE, folder / "one", figures=False).document
    sweep(source, folder / "s", Stated(document, stated), figures=False)
    found = {chart["title"].partition(" over ")[0]: chart for chart in figures_on(page_of(folder / "s"))["charts"]}
    chart: dict[str, Any] = found["Displacement"]
    return chart


def test_seeds_are_averaged_and_lines_told_apart(tmp_path: Path) -> None:
    """With the standard error of the mean."""
    noise = PLANE | {"noise": {"temperature": 1e-3}, "damping": {"coefficient": "auto"}, "plate": {"mass": "auto"}}
    source = plane(axis(FORCE, 0.5, 1.0), axis(RADIUS, 50.0, 100.0), axis("noise.seed", 1, 2)) | {"base": noise}
    stated = [(1.0, 0.1), (3.0, 0.1), (5.0, 0.1), (5.0, 0.1), (4.0, 0.2), (4.0, 0.2), (9.0, 0.2), (6.0, 0.2)]
    chart = one_chart(source, stated, tmp_path)
    first, second = chart["data"]
    assert shown(chart) == [f"{RADIUS_IN_WORDS} = 50.0", f"{RADIUS_IN_WORDS} = 100.0"]
    assert (first["y"], second["y"]) == ([2.0, 4.0], [5.0, 7.5])
    assert (first["error_y"]["array"], second["error_y"]["array"]) == ([1.0, 0.0], [0.0, 1.5])


def test_many_lines_are_named_by_their_ends_and_words_stand_at_their_places(tmp_path: Path) -> None:
    radii = [100.0 * i for i in range(1, 13)]
    source = plane(axis("bodies.reduction", "mdr", "geike_popov"), axis(RADIUS, *radii))
    chart = one_chart(source, [(1.0 + i, 0.1) for i in range(24)], tmp_path)
    assert shown(chart) == [f"{RADIUS_IN_WORDS} = {radius}" for radius in (*radii[:3], *radii[-3:])]
    assert [trace["error_y"]["array"] for trace in chart["data"]] == [[0.1, 0.1]] * len(radii)
    assert chart["layout"]["xaxis"]["ticktext"] == ["mdr", "geike_popov"]
