"""Many runs through any executor: an entry for each, in order; and processes that never outlive their parent."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import pytest

from contact1d import Run, RunError, Scene, load_run, run_many
from tests.scenes import SCENES

MakeScene = Callable[..., Scene]
LONG = SCENES / "pull_off_dynamic.toml"
PATIENCE = 120.0


class Deadly:
    """Ends the process that unpickles it, as a lack of memory would."""

    def __reduce__(self) -> Any:
        return os._exit, (1,)


def pairs(plane: MakeScene, folder: Path) -> list[tuple[Any, Path]]:
    """Two that run, between them every way of going wrong."""
    (folder / "file").write_text("")
    impossible = plane().with_({"bodies.profile": {"kind": "circle", "radius": 0.5}, "bodies.particles": "auto"})
    scenes = [plane(), plane(force=30.0), impossible, {"title": "half a scene"}, "nowhere.toml", plane(), 7]
    places = ["good", "failed", "settings", "scene", "nowhere", "file/run", "seven"]
    return [*zip(scenes, [folder / place for place in places], strict=True), (plane(force=0.25), folder / "last")]


def checked(entries: list[Run | RunError], folder: Path) -> None:
    """That `pairs` came back as they should."""
    words = [
        "end of the chain", "too narrow", "bodies: missing", "no such file", 
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
    places = ["failed", "settings", "scene", "nowhere", "file/run", "seven"]
    assert [entry.folder for entry in failed] == [folder / place for place in places]
    assert [entry.kept for entry in failed if isinstance(entry, RunError)] == [True] + [False] * 5


@pytest.mark.parametrize("threads", [True, False])
def test_a_failure_is_an_entry_for_any_executor(threads: bool, plane: MakeScene, tmp_path: Path) -> None:
    """Threads that are given, and processes of this machine."""
    with ThreadPoolExecutor(2) as executor:
        checked(run_many(pairs(plane, tmp_path), executor if threads else None, workers=1), tmp_path)
    assert run_many([]) == []


def test_a_process_that_is_killed_leaves_the_entries_that_were_done(plane: MakeScene, tmp_path: Path) -> None:
    wanted: list[tuple[Any, Path]] = [
        (plane(), tmp_path / "0"), (Deadly(), tmp_path / "1"), (plane(), tmp_path / "2"),
    ]  # fmt: skip
    with ProcessPoolExecutor(1, get_context("spawn")) as executor:
        first, *lost = run_many(wanted, executor)
        lost += run_many([(plane(), tmp_path / "3")], executor)
    assert isinstance(first, Run)
    for entry in lost:
        assert isinstance(entry, RunError)
        assert "was killed" in entry.message
    assert [entry.folder.name for entry in lost] == ["1", "2", "3"]


def test_a_script_needs_no_guard(plane: MakeScene, tmp_path: Path) -> None:
    """It is run once."""
    (tmp_path / "scene.toml").write_text(str(plane()))
    script = "import contact1d; (one,) = contact1d.run_many([('scene.toml', 'run')]); print(one.status)\n"
    (tmp_path / "script.py").write_text(script)
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=PATIENCE)
    assert (done.stdout, done.stderr) == ("done\n", "")


def test_two_runs_never_share_a_folder(plane: MakeScene, tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as executor:
        first, second = run_many([(plane(), tmp_path / "run"), (plane(), str(tmp_path / "." / "run"))], executor)
    assert isinstance(first, Run)
    assert isinstance(second, RunError)
    assert "same folder" in second.message


def test_processes_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    """Nobody is left to hold the output open, or to go on with the run."""
    code = (
        "import os, signal, threading, time, contact1d\n"
        "def kill():\n"
        "    while not os.path.exists('run/in.lammps'):\n"
        "        time.sleep(0.01)\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
        "threading.Thread(target=kill).start()\n"
        f"contact1d.run_many([({str(LONG)!r}, 'run')], workers=1)\n"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, timeout=PATIENCE, check=False)
    assert done.returncode == -signal.SIGKILL
    assert not (tmp_path / "run" / "results.json").exists()
