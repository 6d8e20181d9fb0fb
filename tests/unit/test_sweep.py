"""A sweep: what is run, kept and run again, and one table of all."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import contact1d.workflow.runs.many as running
from contact1d import FolderError, load_run, sweep
from contact1d.__main__ import app
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.sweep.sweep import ExecutorError
from contact1d.workflow.sweep.table import PARQUET, RECORD, TABLE
from tests.sweeps import BROKEN, FORCE, RADIUS, Here, Stub, axis, plane, rows

PATIENCE = 120.0


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


def test_what_is_done_is_not_run_again_and_values_may_be_added(tmp_path: Path) -> None:
    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, first := Here(), figures=False)
    before = (tmp_path / TABLE).read_text()
    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, again := Here(), figures=False)
    assert (len(first.given), again.given) == (2, [])
    assert (tmp_path / TABLE).read_text() == before
    sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path, more := Here(), figures=False)
    assert len(more.given) == 1
    assert [row["status"] for row in rows(tmp_path)] == ["done"] * 3


class Notes(Silent):
    """Keeps what is noted."""

    def __init__(self) -> None:
        self.notes: list[str] = []

    def note(self, text: str) -> None:
        self.notes.append(text)


SCENE = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "steel_on_glass.toml"
MODULUS = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
TWO = plane(axis(FORCE, 0.5, 1.0))


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a finished sweep, TWO; to be copied."""
    folder = tmp_path_factory.mktemp("finished")
    sweep(TWO, folder, Here(), figures=False)
    return folder


@pytest.mark.parametrize("name", BROKEN)
def test_a_run_whose_results_are_broken_is_run_again_and_no_other(name: str, finished: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(finished, tmp_path / "s")
    cut = folder / rows(folder)[1]["run"] / "results.json"
    cut.write_text(BROKEN[name](json.loads(cut.read_text())))
    sweep(TWO, folder, again := Here(), figures=False, progress=(progress := Notes()))
    assert again.given == [cut.parent.name]
    assert progress.notes == [f"{cut.parent.name}: its results.json is invalid, so it is run again"]
    assert (folder / TABLE).read_text() == (finished / TABLE).read_text()


def test_a_result_that_cannot_be_trusted_is_an_empty_cell(finished: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(finished, tmp_path / "s")
    results = folder / rows(folder)[1]["run"] / "results.json"
    document = json.loads(results.read_text())
    document["force"] |= {"value": None}
    results.write_text(json.dumps(document))
    sweep(TWO, folder, again := Here())
    assert again.given == []
    assert [bool(row["force"]) for row in rows(folder)] == [True, False]
    assert [bool(row["force_uncertainty"]) for row in rows(folder)] == [True, False]


@pytest.mark.parametrize("kept", [0, 5, 60, 300])
def test_a_record_that_was_cut_short_is_replaced(kept: int, finished: Path, tmp_path: Path) -> None:
    folder = shutil.copytree(finished, tmp_path / "s")
    whole = (folder / RECORD).read_text()
    (folder / RECORD).write_text(whole[:kept])
    page = CliRunner().invoke(app, ["report", str(folder), "--out", str(tmp_path / "page.html")])
    assert (page.exit_code, page.output.count("\n")) == (2, 1)
    assert "sweep.toml is not the record of a sweep: start the sweep again" in page.output
    sweep(TWO, folder, again := Here(), figures=False, progress=(progress := Notes()))
    assert again.given == []
    assert progress.notes == [f"{folder / RECORD} is not the record of a sweep and is replaced"]
    assert (folder / RECORD).read_text() == whole
    assert (folder / TABLE).read_text() == (finished / TABLE).read_text()


def test_a_broken_file_that_no_sweep_left_is_kept(tmp_path: Path) -> None:
    (tmp_path / RECORD).write_text("mine = [")
    with pytest.raises(FolderError, match="choose another folder"):
        sweep(TWO, tmp_path, Here())
    assert (tmp_path / RECORD).read_text() == "mine = ["


@pytest.mark.parametrize(
    "content", [b"\xff\xfe\x00", b"status\ndone", b"a" * 200_000, None], ids=["binary", "half", "a long cell", "none"]
)
def test_a_page_of_a_broken_table_says_to_start_the_sweep_again(
    content: bytes | None, finished: Path, tmp_path: Path
) -> None:
    folder = shutil.copytree(finished, tmp_path / "s")
    (folder / TABLE).unlink()
    if content is not None:
        (folder / TABLE).write_bytes(content)
    page = CliRunner().invoke(app, ["report", str(folder), "--out", str(tmp_path / "page.html")])
    assert (page.exit_code, page.output.count("\n")) == (2, 1)
    assert page.output.endswith("start the run or the sweep again\n")
    assert not (tmp_path / "page.html").exists()


def test_a_folder_of_another_sweep_or_of_other_things_is_left_alone(tmp_path: Path) -> None:
    sweep(plane(axis(FORCE, 0.5)), tmp_path / "s", Here(), figures=False)
    with pytest.raises(FolderError, match="holds another sweep"):
        sweep(plane(axis(RADIUS, 50.0)), tmp_path / "s", Here())
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "thesis.tex").write_text("precious")
    with pytest.raises(FolderError, match="do not belong to a sweep"):
        sweep(plane(axis(RADIUS, 50.0)), tmp_path / "thesis", Here())
    assert [path.name for path in (tmp_path / "thesis").iterdir()] == ["thesis.tex"]


def test_a_full_disk_ends_the_sweep_and_the_same_command_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real, count = running.run, iter(range(10))

    def run(*args: Any, **kwargs: Any) -> Any:
        if next(count) == 1:
            raise OSError(28, "No space left on device", str(tmp_path))
        return real(*args, **kwargs)

    monkeypatch.setattr(running, "run", run)
    with pytest.raises(OSError, match="No space left"):
        sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path, Here(), figures=False)
    assert [row["status"] for row in rows(tmp_path)] == ["done", "missing", "done"]
    sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path, rest := Here(), figures=False)
    assert len(rest.given) == 1
    assert [row["status"] for row in rows(tmp_path)] == ["done"] * 3


def test_a_point_that_kills_its_process_is_a_row_and_takes_no_other_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The process of a pool that sees a force of 0.75 dies, as by a lack of memory."""
    source = "import os, contact1d.workflow.runs.many as s\nreal = s.run\n"
    source += "s.run = lambda scene, *a, **k: os._exit(1) if scene.experiment.force == 0.75 else real(scene, *a, **k)\n"
    (tmp_path / "sitecustomize.py").write_text(source)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path) + os.pathsep + os.environ.get("PYTHONPATH", ""))
    done = sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path / "s", workers=2, figures=False)
    assert [row["status"] for row in rows(tmp_path / "s")] == ["done", "failed", "done"]
    assert "killed twice" in rows(tmp_path / "s")[1]["reason"]
    assert done.counts == {"done": 2, "failed": 1}


def test_an_executor_that_is_not_there_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ExecutorError, match="no sbatch"):
        sweep(plane(axis(FORCE, 0.5)), tmp_path / "s", "slurm")
    with pytest.raises(ExecutorError, match="local or slurm"):
        sweep(plane(axis(FORCE, 0.5)), tmp_path / "s", "cloud")
    monkeypatch.setattr("contact1d.workflow.sweep.sweep.find_spec", lambda name: None)
    with pytest.raises(ExecutorError, match=r"pip install 'contact1d\[cluster\]'"):
        sweep(plane(axis(FORCE, 0.5)), tmp_path / "s", "slurm")
    assert not (tmp_path / "s").exists()


BYTES_PER_POINT = 2_000
"""Name, values, and here also an answer that no folder holds; a `Scene` alone is ten times that."""


@pytest.mark.slow
def test_many_points_take_no_memory_each(tmp_path: Path) -> None:
    """Ten times the points: what is held grows by names and values only, some hundred bytes for each."""
    import gc
    import tracemalloc

    gc.freeze()  # what other tests keep alive would put garbage collection off
    peaks = []
    for count in (200, 2000):
        span = {"key": FORCE, "from": 0.1, "to": 1.0, "steps": count - 1}
        tracemalloc.start()
        sweep(plane(span), tmp_path / str(count), Stub(), figures=False)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    gc.unfreeze()
    assert peaks[1] - peaks[0] < 1800 * BYTES_PER_POINT


def test_the_command_prints_counts_and_ends_with_3_where_a_point_failed(tmp_path: Path) -> None:
    (tmp_path / "plane.toml").write_text(
        'title = "p"\n[bodies]\nparticles = 41\nspacing = 1.0\nprofile = { kind = "parabola", radius = 100.0 }\n'
        'bulk_stiffness = 1.0\nlower = "rigid_plane"\n[experiment]\nkind = "load"\nforce = 1.0\n'
    )
    axis_text = '[[axes]]\nkey = "experiment.force"\nvalues = [0.5, 900.0]\n'
    (tmp_path / "s.toml").write_text(f'scene = "plane.toml"\n{axis_text}')
    asked = ["sweep", str(tmp_path / "s.toml"), "--out", str(tmp_path / "o"), "--workers", "1", "-q", "--parquet"]
    result = CliRunner().invoke(app, asked)
    assert result.exit_code == 3
    assert "1 done, 1 failed" in result.output
    assert (tmp_path / "o" / PARQUET).is_file()


def test_a_sweep_that_is_killed_at_any_moment_goes_on(tmp_path: Path) -> None:
    """SIGKILL at two moments; then the table is that of a sweep nobody killed, and nothing was run twice."""
    source = plane({"key": FORCE, "from": 0.1, "to": 1.0, "steps": 7})
    script = f"import contact1d\ncontact1d.sweep({source!r}, {str(tmp_path / 's')!r}, workers=1, figures=False)\n"
    for share in (2, 5):
        begun = subprocess.Popen([sys.executable, "-c", script])
        until = time.monotonic() + PATIENCE
        while len(list(tmp_path.glob("s/runs/*/results.json"))) < share and begun.poll() is None:
            assert time.monotonic() < until
            time.sleep(0.01)
        begun.send_signal(signal.SIGKILL)
        begun.wait()
    stamps = {path: path.stat().st_mtime_ns for path in tmp_path.glob("s/runs/*/results.json")}
    sweep(source, tmp_path / "s", Here(), figures=False)
    sweep(source, tmp_path / "whole", Here(), figures=False)
    assert (tmp_path / "s" / TABLE).read_text() == (tmp_path / "whole" / TABLE).read_text()
    assert all(path.stat().st_mtime_ns == stamp for path, stamp in stamps.items())


def test_the_table_is_a_data_frame_of_numbers_whose_axes_have_one_unit(tmp_path: Path) -> None:
    """A radius in mm, from a logarithmic row of texts, and forces in N."""
    radius = {"key": "bodies.profile.radius", "from": "1 mm", "to": "10 mm", "steps": 2, "scale": "log"}
    axes = [radius, {"key": "experiment.force", "values": ["1 N", "2 N"]}]
    plan = {"title": "table", "scene": str(SCENE), "axes": axes}
    table = sweep(plan, tmp_path / "s", figures=False).table()
    assert table["bodies.profile.radius"].tolist() == pytest.approx(
        np.repeat([1e-3, 1e-3 * 10.0**0.5, 1e-2], 2).tolist()
    )
    assert table["experiment.force"].tolist() == [1.0, 2.0] * 3
    assert table.attrs["units"]["bodies.profile.radius"] == "m"
    assert table.attrs["units"]["contact_radius"] == "m"
    hertz = (0.75 * table["experiment.force"] * table["bodies.profile.radius"] / MODULUS) ** (1.0 / 3.0)
    assert table["contact_radius"].tolist() == pytest.approx(hertz.tolist(), rel=3e-3)  # 5 to 27 particles in it
