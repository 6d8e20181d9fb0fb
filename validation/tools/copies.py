"""A copy of this checkout with a fault in it: which of its tests is the first to notice.

Each run is a fork of a process that has loaded what the tests need and nothing of this program.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
MADE = ("runs", "reproduced", "stability", "speed", "__pycache__")
"""What is made by running, and is not copied from the top."""
HANGS = "they take too long"
QUICK = ("-q", "--assert=plain", "-p", "no:cacheprovider")
LOADED = (
    "numpy",
    "scipy.optimize",
    "scipy.interpolate",
    "scipy.stats",
    "pydantic",
    "matplotlib.figure",
    "pytest",
    "pint",
)


def load() -> None:
    """Import what the tests need, once for all forks."""
    for name in LOADED:
        __import__(name)
    assert "contact1d" not in sys.modules, "a fork would test what is loaded, and not its copy"


def copy_of_this(folder: Path) -> Path:
    """A copy of this checkout."""

    def made(parent: str, names: list[str]) -> list[str]:
        at_top = Path(parent) == ROOT
        return [name for name in names if name.startswith(".") or name == MADE[-1] or (at_top and name in MADE)]

    shutil.copytree(ROOT, folder, symlinks=True, ignore=made)
    return folder


def in_copy(folder: Path, run: Callable[[], int], patience: float) -> int | None:
    """What `run` returns in a fork that takes `folder` for the checkout; None after so many seconds."""
    child = os.fork()
    if child == 0:
        os.setsid()
        quiet = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(quiet, stream)
        os.chdir(folder)
        sys.path[:0] = [str(folder / "src"), str(folder)]
        for name in [name for name in sys.modules if name.split(".")[0] == "validation"]:
            del sys.modules[name]  # that is the whole one's
        sys.dont_write_bytecode = True
        os.environ |= {"PYTHONPATH": f"{folder}/src", "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
        code = 70
        try:
            code = run()
        finally:
            os._exit(code)
    end = time.monotonic() + patience
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return None


def run_tests(folder: Path, tests: Sequence[str], plugin: Any, patience: float) -> int | None:
    """Pytest's exit code for tests of a copy, with a plugin."""

    def run() -> int:
        import pytest

        return int(pytest.main([*QUICK, "--rootdir", str(folder), *tests], [plugin]))

    return in_copy(folder, run, patience)


def first_failure(folder: Path, tests: Sequence[str], patience: float) -> str:
    """The first test that fails in that copy, HANGS after so many seconds; empty where all pass."""
    noted = folder / ".failed"
    noted.unlink(missing_ok=True)

    class Notes:
        @staticmethod
        def pytest_runtest_logreport(report: Any) -> None:
            if report.failed and not noted.exists():
                noted.write_text(report.nodeid, encoding="utf-8")

        pytest_collectreport = pytest_runtest_logreport

    code = run_tests(folder, ["-x", *tests], Notes(), patience)
    if code is None:
        return HANGS
    if code in (0, pytest.ExitCode.NO_TESTS_COLLECTED):  # none that ran failed
        return ""
    return noted.read_text(encoding="utf-8") if noted.exists() else "they do not run"
