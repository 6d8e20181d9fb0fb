"""A sweep: its points, what is kept and run again, and one table of all."""

from __future__ import annotations

import csv
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from concurrent.futures import Executor, Future
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import contact1d.workflow.sweep.sweep as sweeping
from contact1d import FolderError, SceneError, load_run, sweep
from contact1d.workflow.cli.app import app
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.sweep.axes import MOST_POINTS, Axis, read_sweep
from contact1d.workflow.sweep.executors import ExecutorError
from contact1d.workflow.sweep.table import PARQUET, TABLE, Answer, write_parquet

PLANE: dict[str, Any] = {
    "title": "on a plane",
    "bodies": {
        "particles": 41, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 1.0,
        "lower": "rigid_plane",
    },
    "experiment": {"kind": "load", "force": 1.0},
}  # fmt: skip
RADIUS = "bodies.profile.radius"
FORCE = "experiment.force"
PATIENCE = 120.0


def plane(*axes: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """A sweep of a quick scene."""
    return {"title": "a sweep", "base": PLANE, "axes": list(axes)} | more


def axis(key: str, *values: Any) -> dict[str, Any]:
    """An axis of a sweep file."""
    return {"key": key, "values": list(values)}


class Here(Executor):
    """Runs at once, in this process, and keeps what it was given."""

    def __init__(self) -> None:
        self.given: list[str] = []

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given += [path.name for _, path in args[0]]
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


class Stub(Here):
    """Answers without running anything."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        return super().submit(lambda tasks: [Answer("failed", "a stub")] * len(tasks), *args)


def rows(folder: Path) -> list[dict[str, str]]:
    with (folder / TABLE).open(newline="") as file:
        return list(csv.DictReader(file))


def problems(source: Mapping[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        read_sweep(source)
    return str(caught.value)


def test_a_product_has_every_value_with_every_other_the_last_axis_quickest() -> None:
    plan = read_sweep(plane(axis(RADIUS, 50.0, 100.0), axis(FORCE, 0.5, 1.0, 1.5)))
    assert len(plan) == 6
    assert list(plan.values())[:4] == [(50.0, 0.5), (50.0, 1.0), (50.0, 1.5), (100.0, 0.5)]


def test_zip_takes_values_side_by_side() -> None:
    plan = read_sweep(plane(axis(RADIUS, 50.0, 100.0), axis(FORCE, 0.5, 1.0), combine="zip"))
    assert list(plan.values()) == [(50.0, 0.5), (100.0, 1.0)]


def test_spans_have_steps_and_one_more_value_with_exact_ends() -> None:
    spans = [
        {"key": RADIUS, "from": 0.1, "to": 0.7, "steps": 6},
        {"key": FORCE, "from": 1.0, "to": 1000.0, "steps": 3, "scale": "log"},
        {"key": "noise.seed", "from": 1, "to": 3, "steps": 2},
    ]
    linear, log, seeds = (a.values for a in read_sweep(plane(*spans)).axes)
    np.testing.assert_allclose(linear, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
    np.testing.assert_allclose(log, [1.0, 10.0, 100.0, 1000.0])
    assert (linear[-1], log[-1]) == (0.7, 1000.0)
    assert seeds == (1, 2, 3)
    assert all(isinstance(seed, int) for seed in seeds)


def test_an_axis_may_have_a_unit() -> None:
    span = {"key": RADIUS, "from": "1 µm", "to": "100 µm", "steps": 2, "scale": "log"}
    (radii,) = read_sweep(plane(span)).axes
    assert radii.values == ("1.0 µm", "10.0 µm", "100.0 µm")
    assert radii.numbers() == ((1.0, 10.0, 100.0), "µm")
    assert Axis(RADIUS, ("1 µm", "1 mm")).numbers() == ((), "")
    assert Axis("bodies.lower", ("particles", "rigid_plane")).numbers() == ((), "")


@pytest.mark.parametrize(
    ("source", "sentence"),
    [
        (plane({"key": RADIUS, "from": "1 m", "to": "2 mm", "steps": 1}), "must have the same unit at both ends"),
        (plane(), "axes: missing; write [[axes]]"),
        (plane(axis(RADIUS)), "axes[0].values: is empty: the sweep would have no point"),
        (plane(axis(RADIUS, 1.0), axis(RADIUS, 2.0)), "another axis has the same key"),
        (plane({"key": RADIUS}), "axes[0]: lacks from, to, steps; give values, or from, to and steps"),
        (plane({"key": RADIUS, "form": 1.0, "to": 2.0, "steps": 2}), 'axes[0].form: unknown key; did you mean "from"?'),
        (plane({"key": RADIUS, "from": 0.0, "to": 2.0, "steps": 2, "scale": "log"}), "log needs from and to above 0"),
        (plane({"key": RADIUS, "from": 1.0, "to": 2.0, "steps": 0}), "must be a whole number from 1 to"),
        (plane({"key": RADIUS, "from": "1", "to": 2.0, "steps": 1}), 'axes[0].from = "1": must be a finite number'),
        (plane({"values": [1.0]}), "axes[0].key: missing; such as noise.seed"),
        (plane(axis(RADIUS, 1.0) | {"steps": 3}), "axes[0].values: not together with steps"),
        (plane(axis(RADIUS, 1.0), scene="a.toml"), "scene: not together with [base]"),
        ({"axes": [axis(RADIUS, 1.0)]}, "scene: missing; give a scene file"),
        ({"scene": "nowhere.toml", "axes": [axis(RADIUS, 1.0)]}, "nowhere.toml: no such file"),
        (plane(axis(RADIUS, 1.0), combine="cross"), 'combine = "cross": must be "product" or "zip"'),
        (plane(axis(RADIUS, 1.0), axis(FORCE, 1.0, 2.0), combine="zip"), '"zip" needs axes of one length'),
        (plane(axis(RADIUS, 1.0), colour="red"), "colour: unknown key; allowed here: title, scene"),
        (
            plane(*({"key": key, "from": 1.0, "to": 2.0, "steps": n} for key, n in ((RADIUS, 9999), (FORCE, 999)))),
            f"10000 × 1000 = 10000000 points are more than {MOST_POINTS}",
        ),
    ],
)  # fmt: skip
def test_a_wrong_sweep_file_is_told_in_a_sentence(source: dict[str, Any], sentence: str) -> None:
    assert sentence in problems(source)


@pytest.mark.parametrize("key", ["bodies.profile.radus", "boddies.spacing", "title.key", "interaction..range"])
def test_an_axis_that_is_no_key_of_the_scene_is_refused_before_anything_is_written(key: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError):
        sweep(plane(axis(key, 1.0, 2.0)), tmp_path / "out")
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


def test_what_is_done_is_not_run_again_and_values_may_be_added(tmp_path: Path) -> None:
    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, first := Here(), figures=False)
    before = (tmp_path / TABLE).read_text()
    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, again := Here(), figures=False)
    assert (len(first.given), again.given) == (2, [])
    assert (tmp_path / TABLE).read_text() == before
    sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path, more := Here(), figures=False)
    assert len(more.given) == 1
    assert [row["status"] for row in rows(tmp_path)] == ["done"] * 3


def test_a_run_that_was_cut_short_is_run_again_and_no_other(tmp_path: Path) -> None:
    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, Here(), figures=False)
    before = (tmp_path / TABLE).read_text()
    cut = tmp_path / rows(tmp_path)[1]["run"]
    (cut / "results.json").write_text('{"half": ')
    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, again := Here(), figures=False)
    assert again.given == [cut.name]
    assert (tmp_path / TABLE).read_text() == before


def test_a_folder_of_another_sweep_or_of_other_things_is_left_alone(tmp_path: Path) -> None:
    sweep(plane(axis(FORCE, 0.5)), tmp_path / "s", Here(), figures=False)
    with pytest.raises(FolderError, match="holds another sweep"):
        sweep(plane(axis(RADIUS, 50.0)), tmp_path / "s", Here())
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "thesis.tex").write_text("precious")
    with pytest.raises(FolderError, match="not of a sweep"):
        sweep(plane(axis(RADIUS, 50.0)), tmp_path / "thesis", Here())
    assert [path.name for path in (tmp_path / "thesis").iterdir()] == ["thesis.tex"]


def test_two_at_once_in_a_folder_exclude_each_other(tmp_path: Path) -> None:
    class Second(Here):
        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            with pytest.raises(FolderError, match="a sweep is at work in"):
                sweep(plane(axis(FORCE, 0.5)), tmp_path, Here())
            return super().submit(fn, *args, **kwargs)

    assert sweep(plane(axis(FORCE, 0.5)), tmp_path, Second(), figures=False).counts == {"done": 1}


def test_a_full_disk_ends_the_sweep_and_the_same_command_goes_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real, count = sweeping.run, iter(range(10))

    def run(*args: Any, **kwargs: Any) -> Any:
        if next(count) == 1:
            raise OSError(28, "No space left on device", str(tmp_path))
        return real(*args, **kwargs)

    monkeypatch.setattr(sweeping, "run", run)
    with pytest.raises(OSError, match="No space left"):
        sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path, Here(), figures=False)
    assert [row["status"] for row in rows(tmp_path)] == ["done", "missing", "done"]
    sweep(plane(axis(FORCE, 0.5, 0.75, 1.0)), tmp_path, rest := Here(), figures=False)
    assert len(rest.given) == 1
    assert [row["status"] for row in rows(tmp_path)] == ["done"] * 3


def test_a_point_that_kills_its_process_is_a_row_and_takes_no_other_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The process of a pool that sees a force of 0.75 dies, as for want of memory."""
    source = "import os, contact1d.workflow.sweep.sweep as s\nreal = s.run\n"
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
    monkeypatch.setattr("contact1d.workflow.sweep.executors.find_spec", lambda name: None)
    with pytest.raises(ExecutorError, match=r"pip install 'contact1d\[cluster\]'"):
        sweep(plane(axis(FORCE, 0.5)), tmp_path / "s", "slurm")
    assert not (tmp_path / "s").exists()


def test_progress_counts_points_and_tells_of_those_that_failed(tmp_path: Path) -> None:
    class Heard(Silent):
        def __init__(self) -> None:
            self.points, self.notes = 0, list[str]()

        def advance(self, steps: int) -> None:
            self.points += steps

        def note(self, text: str) -> None:
            self.notes.append(text)

    heard = Heard()
    sweep(plane(axis(FORCE, 0.5, 900.0, -1.0, 0.5)), tmp_path, Here(), figures=False, progress=heard)
    assert heard.points == 4
    assert [note.partition(": ")[2].partition(":")[0] for note in heard.notes] == ["refused", "failed"]


BYTES_PER_POINT = 2_000
"""Name, values, and here also an answer that no folder holds; a `Scene` alone is ten times that."""


def test_many_points_take_no_memory_each(tmp_path: Path) -> None:
    """Ten times the points: what is held grows by names and values only, some hundred bytes for each."""
    import tracemalloc

    peaks = []
    for count in (200, 2000):
        span = {"key": FORCE, "from": 0.1, "to": 1.0, "steps": count - 1}
        tracemalloc.start()
        sweep(plane(span), tmp_path / str(count), Stub(), figures=False)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
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


def test_parquet_says_the_same_as_the_table(tmp_path: Path) -> None:
    from pyarrow import parquet

    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, Here(), figures=False)
    write_parquet(tmp_path)
    read = parquet.read_table(tmp_path / PARQUET).to_pydict()
    assert read["displacement"] == [float(row["displacement"]) for row in rows(tmp_path)]


def test_seeds_are_averaged_and_lines_told_apart(tmp_path: Path) -> None:
    from contact1d.workflow.sweep.figures import sweep_figure

    plan = read_sweep(plane(axis(FORCE, 0.5, 1.0), axis(RADIUS, 50.0, 100.0), axis("noise.seed", 1, 2)))
    lines = {("50.0",): {0.5: [(1.0, 0.1), (3.0, 0.1)], 1.0: [(4.0, 0.2)]}, ("100.0",): {0.5: [(5.0, 0.1)]}}
    figure = sweep_figure(plan, "displacement", "LU", lines)
    first, second = figure.axes[0].containers
    np.testing.assert_allclose(first[0].get_ydata(), [2.0, 4.0])
    np.testing.assert_allclose(second[0].get_ydata(), [5.0])
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == [
        "profile.radius = 50.0", "profile.radius = 100.0",
    ]  # fmt: skip
    assert figure.axes[0].get_ylabel() == "displacement (LU)"


def test_a_sweep_that_is_killed_at_any_moment_goes_on(tmp_path: Path) -> None:
    """SIGKILL at three moments; then the table is that of a sweep nobody killed, and nothing was run twice."""
    source = plane({"key": FORCE, "from": 0.1, "to": 1.0, "steps": 11})
    script = f"import contact1d\ncontact1d.sweep({source!r}, {str(tmp_path / 's')!r}, workers=1, figures=False)\n"
    for share in (2, 5, 8):
        begun = subprocess.Popen([sys.executable, "-c", script])
        until = time.monotonic() + PATIENCE
        while len(list(tmp_path.glob("s/runs/*/results.json"))) < share and begun.poll() is None:
            assert time.monotonic() < until
            time.sleep(0.01)
        begun.send_signal(signal.SIGKILL)
        begun.wait()
    stamps = {path: path.stat().st_mtime_ns for path in tmp_path.glob("s/runs/*/results.json")}
    sweep(source, tmp_path / "s", workers=1, figures=False)
    sweep(source, tmp_path / "whole", workers=1, figures=False)
    assert (tmp_path / "s" / TABLE).read_text() == (tmp_path / "whole" / TABLE).read_text()
    assert all(path.stat().st_mtime_ns == stamp for path, stamp in stamps.items())


@pytest.mark.slow
def test_a_sweep_killed_at_ten_random_moments_loses_nothing(tmp_path: Path) -> None:
    """Two workers, moments by the clock: whenever they come, the table is that of a sweep nobody killed."""
    forces, radii = {"key": FORCE, "from": 0.1, "to": 1.0, "steps": 39}, axis(RADIUS, 50.0, 100.0, 200.0)
    source, folder = plane(forces, radii), tmp_path / "s"
    script = f"import contact1d\ncontact1d.sweep({source!r}, {str(folder)!r}, workers=2, figures=False)\n"
    delays, known = random.Random(7), dict[str, int]()
    for _ in range(10):
        begun = subprocess.Popen([sys.executable, "-c", script])
        with suppress(subprocess.TimeoutExpired):
            begun.wait(delays.uniform(0.5, 6.0))
        begun.kill()
        begun.wait()
        found = {path.parent.name: path.stat().st_mtime_ns for path in folder.glob("runs/*/results.json")}
        assert all(found[name] == stamp for name, stamp in known.items())
        known = found
    sweep(source, folder, workers=2, figures=False)
    sweep(source, tmp_path / "whole", workers=2, figures=False)
    assert (folder / TABLE).read_text() == (tmp_path / "whole" / TABLE).read_text()
    assert all((folder / "runs" / name / "results.json").stat().st_mtime_ns == stamp for name, stamp in known.items())


def test_closed_forms_are_the_lines_of_a_sweeps_figures_and_the_runs_points_on_them(tmp_path: Path) -> None:
    """Hertz over the force for two radii: in the figure and on the page, in the colours of the runs beside them."""
    from contact1d.workflow.report.charts import over_axes
    from contact1d.workflow.sweep.figures import lines_of, sweep_figure, theories_of

    bodies = {
        "particles": "auto", "spacing": 1.0, "lower": "rigid_plane", "reduction": "mdr", "bulk_stiffness": 0.5,
        "profile": {"kind": "parabola", "radius": 1000.0},
    }  # fmt: skip
    base = {"title": "load", "bodies": bodies, "experiment": {"kind": "load", "force": 1.0}}
    forces, radii = [10.0, 20.0, 40.0], [500.0, 1000.0]
    axes = [{"key": "experiment.force", "values": forces}, {"key": "bodies.profile.radius", "values": radii}]
    tables = {"title": "Hertz", "base": base, "axes": axes}
    done = sweep(tables, tmp_path / "s", workers=1, figures="svg")
    assert (done.folder / "displacement.svg").is_file()
    plan = read_sweep(tables)
    said = theories_of(done.folder, plan)["displacement"]["Hertz"]
    for radius in radii:
        hertz = [(0.75 * force / 0.5 / radius**0.5) ** (2.0 / 3.0) for force in forces]
        assert [said[(str(radius),)][force] for force in forces] == pytest.approx(hertz, rel=1e-12)
    figure = sweep_figure(
        plan,
        "displacement",
        "LU",
        lines_of(done.folder, plan, "displacement"),
        theories_of(done.folder, plan)["displacement"],
    )
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["Hertz", "profile.radius = 500.0", "profile.radius = 1000.0"]
    chart = next(
        c for c in over_axes(done.folder, plan, done.quantities) if c["layout"]["title"]["text"] == "displacement"
    )
    kinds = [(trace["mode"], trace["line"]["color"]) for trace in chart["data"]]
    assert [mode for mode, _ in kinds] == ["markers", "markers", "lines", "lines"]
    assert [colour for _, colour in kinds[:2]] == [colour for _, colour in kinds[2:]]
