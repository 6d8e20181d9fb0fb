"""Many runs through any executor: an entry for each, in order; and processes that never outlive their parent."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest

from contact1d import Run, RunError, Scene, load_run, run_many

MakeScene = Callable[..., Scene]
EXECUTORS: dict[str, Callable[[], Executor]] = {
    "threads": lambda: ThreadPoolExecutor(2),
    "processes": lambda: ProcessPoolExecutor(2, get_context("spawn")),
}
LONG = 600.0
"""Seconds that a task sleeps which is not waited for: a test that did would fail by its patience."""
PATIENCE = 120.0


class Deadly:
    """Ends the process that unpickles it, as a lack of memory would."""

    def __reduce__(self) -> Any:
        return os._exit, (1,)


def pairs(plane: MakeScene, folder: Path) -> list[tuple[Any, Path]]:
    """Two that run, between them every way of going wrong."""
    (folder / "thesis").mkdir()
    (folder / "thesis" / "thesis.tex").write_text("precious")
    (folder / "file").write_text("")
    impossible = plane().with_({"bodies.profile": {"kind": "circle", "radius": 0.5}, "bodies.particles": "auto"})
    scenes = [plane(), plane(force=30.0), impossible, {"title": "half a scene"}, "nowhere.toml", plane(), plane(), 7]
    places = ["good", "failed", "settings", "scene", "nowhere", "thesis", "file/run", "seven"]
    return [*zip(scenes, [folder / place for place in places], strict=True), (plane(force=0.25), folder / "last")]


def checked(entries: list[Run | RunError], folder: Path) -> None:
    """That `pairs` came back as they should."""
    words = [
        "end of the chain", "too narrow", "bodies: missing", "no such file", "has files that do not belong to a run",
        "cannot be written", "must be a path",
    ]  # fmt: skip
    first, *failed, last = entries
    assert isinstance(first, Run)
    assert isinstance(last, Run)
    assert first.results.force.value > last.results.force.value
    assert load_run(folder / "good") == first
    for entry, text in zip(failed, words, strict=True):
        assert isinstance(entry, RunError)
        assert text in entry.message
        assert text in str(entry)
    places = ["failed", "settings", "scene", "nowhere", "thesis", "file/run", "seven"]
    assert [entry.folder for entry in failed] == [folder / place for place in places]
    assert [entry.kept for entry in failed if isinstance(entry, RunError)] == [True] + [False] * 6


@pytest.mark.parametrize("kind", EXECUTORS)
def test_a_failure_is_an_entry_for_every_executor(kind: str, plane: MakeScene, tmp_path: Path) -> None:
    with EXECUTORS[kind]() as executor:
        checked(run_many(pairs(plane, tmp_path), executor), tmp_path)


def test_without_an_executor_the_runs_go_to_processes_of_this_machine(plane: MakeScene, tmp_path: Path) -> None:
    checked(run_many(pairs(plane, tmp_path), workers=2), tmp_path)
    assert run_many([]) == []


def test_a_process_that_is_killed_leaves_the_entries_that_were_done(plane: MakeScene, tmp_path: Path) -> None:
    wanted: list[tuple[Any, Path]] = [
        (plane(), tmp_path / "0"), (Deadly(), tmp_path / "1"), (plane(), tmp_path / "2"),
    ]  # fmt: skip
    first, *lost = run_many(wanted, workers=1)
    assert isinstance(first, Run)
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        again, *others = run_many([(plane(), tmp_path / "3"), *wanted[1:]], executor)
        later = run_many([(plane(), tmp_path / "4")], executor)
    assert isinstance(again, Run)
    for entry in (*lost, *others, *later):
        assert isinstance(entry, RunError)
        assert "was killed" in entry.message
    assert [entry.folder.name for entry in lost] == ["1", "2"]


@pytest.mark.parametrize("way", ["file", "pipe"])
def test_a_script_needs_no_guard(way: str, plane: MakeScene, tmp_path: Path) -> None:
    """It is run once, whether Python reads it from a file or from a pipe."""
    (tmp_path / "scene.toml").write_text(str(plane()))
    script = "import contact1d; (one,) = contact1d.run_many([('scene.toml', 'run')]); print(one.status)\n"
    (tmp_path / "script.py").write_text(script)
    command = [sys.executable, "script.py" if way == "file" else "-"]
    done = subprocess.run(command, input=script, cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE)
    assert (done.stdout, done.stderr) == ("done\n", "")


def test_two_runs_never_share_a_folder(plane: MakeScene, tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as executor:
        first, second = run_many([(plane(), tmp_path / "run"), (plane(), str(tmp_path / "." / "run"))], executor)
    assert isinstance(first, Run)
    assert isinstance(second, RunError)
    assert "same folder" in second.message


def test_processes_end_with_a_parent_that_is_killed() -> None:
    """Nobody is left to hold the output open."""
    code = (
        "import os, signal, time; from contact1d.workflow.runs.processors import pool\n"
        "with pool(1) as executor:\n"
        "    print(executor.submit(os.getpid).result(), flush=True)\n"
        f"    executor.submit(time.sleep, {LONG})\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert int(done.stdout) > 0, done.stderr
