"""Whatever goes wrong in a command, it ends in words and with its exit code, and the progress is closed before."""

from __future__ import annotations

import errno
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from contact1d import EngineError, SceneError
from contact1d.__main__ import app
from contact1d.workflow.cli import ending
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.errors import FolderError, RunError, SettingsError
from contact1d.workflow.identify import IdentifyError
from contact1d.workflow.scene import Problem

CONTACT1D = [sys.executable, "-m", "contact1d"]
SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
NOWHERE = Path("/nowhere/at/all")
SMALL = 2000
"""Bytes that a file may have: fewer than the deck and the scene file that `new` writes."""


def contact1d(
    *arguments: str | Path, cwd: Path, before: Callable[[], None] | None = None
) -> subprocess.CompletedProcess[str]:
    command = [*CONTACT1D, *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=120, check=False, preexec_fn=before)


class Watched(Silent):
    """Progress that knows whether it was closed."""

    closed = False

    def close(self) -> None:
        self.closed = True


def full(place: str | None = None) -> OSError:
    return OSError(errno.ENOSPC, "No space left on device", place)


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (SceneError([Problem("bodies.mass", "must be 1"), Problem("title", "missing")]), 2, "the scene: 2 problems\n"),
        (SettingsError("no such chain"), 2, "no such chain\n"),
        (FolderError("it is taken"), 2, "it is taken\n"),
        (IdentifyError("out of reach"), 2, "out of reach\n"),
        (RunError("atoms flew apart", NOWHERE), 3, "the run failed: atoms flew apart\n"),
        (EngineError("it crashed", "loading", 7, NOWHERE, ""), 3, "the run failed: it crashed\n"),
        (BrokenProcessPool("died"), 3, "the run failed: one of its processes was killed, most often because the"),
        (MemoryError(), 3, "the run failed: the machine is out of memory; go on\n"),
        (full(), 3, "the run failed: the disk is full; go on\n"),
        (full("big.png"), 3, "the run failed: the disk is full (big.png); go on\n"),
        (OSError(errno.EMFILE, "Too many open files"), 3, "the run failed: Too many open files; go on\n"),
        (PermissionError(errno.EACCES, "Permission denied", "out"), 2, "out cannot be written: Permission denied\n"),
        (KeyboardInterrupt(), 130, "interrupted; go on\n"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else "",
)
def test_an_error_becomes_a_sentence_and_an_exit_code(
    error: BaseException, code: int, words: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    progress = Watched()
    monkeypatch.setattr("contact1d.workflow.engine.progress.choose_progress", lambda: progress)
    with pytest.raises(SystemExit) as ended, ending.command("the run", kept="go on"):
        raise error
    assert (ended.value.code, progress.closed) == (code, True)
    assert capsys.readouterr().err.startswith(words)


@pytest.mark.parametrize("error", [ZeroDivisionError(), typer.Exit(4), BrokenPipeError(errno.EPIPE, "Broken pipe")])
def test_a_defect_of_the_program_and_an_end_of_typers_pass(error: Exception) -> None:
    with pytest.raises(type(error)), ending.command("the run", quiet=True):
        raise error


def test_files_are_named_where_they_are_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for folder, words in ((tmp_path, f"files are kept in {tmp_path}"), (tmp_path / "not_there", "interrupted\n")):
        with pytest.raises(SystemExit), ending.command("the run", folder, quiet=True):
            raise KeyboardInterrupt
        assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [("run", SCENES / "load.toml", "--out", "out"), ("deck", SCENES / "load.toml", "--out", "out"), ("new", "out")],
    ids=lambda arguments: arguments[0],
)
def test_a_file_that_finds_no_place_is_told_with_exit_code_3(arguments: tuple[str | Path, ...], tmp_path: Path) -> None:
    done = contact1d(*arguments, cwd=tmp_path, before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (SMALL, SMALL)))
    assert (done.returncode, done.stdout) == (3, "")
    assert "failed: a file would be larger than is allowed" in done.stderr
    assert ("files are kept in out" in done.stderr) == (arguments[0] != "new")
    assert not (tmp_path / "out.toml").exists()
    assert "Traceback" not in done.stderr


def test_a_full_disk_behind_the_standard_output_is_told(tmp_path: Path) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([*CONTACT1D, "schema"], stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
    assert (done.returncode, done.stderr) == (3, "contact1d failed: the disk is full\n")


@pytest.mark.parametrize("arguments", [["run", str(SCENES / "load.toml")], ["doctor"]], ids=lambda words: words[0])
def test_a_package_that_is_missing_is_told_with_exit_code_1(arguments: list[str], tmp_path: Path) -> None:
    code = "import sys; sys.modules['numpy'] = None; from contact1d.workflow.cli.app import main; main()"
    command = [sys.executable, "-c", code, *arguments]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert "numpy" in (done.stderr if arguments[0] == "run" else done.stdout)
    assert "Traceback" not in done.stderr


def test_an_interrupted_run_says_what_is_left(tmp_path: Path) -> None:
    command = [*CONTACT1D, "run", str(SCENES / "pull_off_dynamic.toml"), "--out", "out"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True) as process:
        assert process.stderr is not None
        while "loading" not in process.stderr.readline():
            assert process.poll() is None
        os.killpg(process.pid, signal.SIGINT)  # as a terminal does
        last = process.stderr.read().splitlines()[-1]
    assert (process.returncode, last) == (130, "interrupted; no numbers were written; files are kept in out")


@pytest.mark.parametrize("command", ["run", "deck", "cost"])
def test_every_command_reads_a_scene_in_the_same_way(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    scene = str(SCENES / "load.toml")
    wrong = ["--out", "out", "--set", "experiment.forc=1", "--without", "nois"]
    done = CliRunner().invoke(app, [command, scene, *wrong])
    assert (done.exit_code, done.stdout) == (2, "")
    first, *problems = done.stderr.splitlines()
    assert first == f"{scene}: 2 problems"
    assert "did you mean" in problems[0]
    missing = CliRunner().invoke(app, [command, "nope.toml", "--out", "out"])
    assert (missing.exit_code, missing.stderr) == (2, "nope.toml: 1 problem\n  nope.toml: no such file\n")
    assert not list(tmp_path.iterdir())
    (tmp_path / "taken").write_text("mine")
    for out, words in (("taken", "taken is a file"), ("taken/in", "cannot be written"), ("n" * 300, "name too long")):
        done = CliRunner().invoke(app, [command, scene, "--out", out])
        assert done.exit_code == 2, done.stderr
        assert words in done.stderr
