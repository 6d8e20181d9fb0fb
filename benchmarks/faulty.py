"""A copy of this folder with a fault in it: which of its tests is the first to notice.

Each run is a fork of a process that has loaded what the tests need and nothing of this program.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[1]
FAILED = ".failed"
"""File of a copy that the first failing test's name is written to."""
HANGS = "they take too long"
LOADED = (
    "numpy",
    "scipy.optimize",
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.stats",
    "pydantic",
    "matplotlib.figure",
)


def load() -> None:
    """Import what the tests need, once for all forks."""
    for name in LOADED:
        __import__(name)
    assert "contact1d" not in sys.modules, "a fork would test what is loaded, and not its copy"


def copy_of_this(folder: Path) -> Path:
    """A copy of this folder in `folder`, without what was made by running it."""

    def made(parent: str, names: list[str]) -> list[str]:
        runs = ("runs", "reproduced") if Path(parent) == ROOT else ()
        return [name for name in names if name.startswith(".") or name in ("__pycache__", *runs)]

    shutil.copytree(ROOT, folder, symlinks=True, ignore=made)
    return folder


def first_failure(folder: Path, tests: Sequence[str], patience: float) -> str:
    """The first test that fails in that copy, HANGS after so many seconds; empty where all pass."""
    noted = folder / FAILED
    noted.unlink(missing_ok=True)
    child = os.fork()
    if child == 0:
        os.setsid()
        quiet = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(quiet, stream)
        os.chdir(folder)
        sys.path[:0] = [str(folder / "src"), str(folder)]
        for name in [name for name in sys.modules if name.split(".")[0] == "benchmarks"]:
            del sys.modules[name]  # that is the whole one's
        sys.dont_write_bytecode = True  # two mutants of one second and size would be taken for each other
        os.environ |= {"PYTHONPATH": f"{folder}/src", "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
        os.environ["PATIENCE"] = "20"  # what fails is to fail by its fault, whatever else the machine does
        code = 70
        try:
            import pytest

            class Notes:
                @staticmethod
                def pytest_runtest_logreport(report: pytest.TestReport | pytest.CollectReport) -> None:
                    if report.failed and not noted.exists():
                        noted.write_text(report.nodeid, encoding="utf-8")

                pytest_collectreport = pytest_runtest_logreport

            options = ["-x", "-q", "-p", "no:cacheprovider", "--rootdir", str(folder)]
            code = int(pytest.main([*options, *tests], [Notes()]))
        finally:
            os._exit(code)
    end = time.monotonic() + patience
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            if os.waitstatus_to_exitcode(status) == 0:
                return ""
            return noted.read_text(encoding="utf-8") if noted.exists() else "they do not run"
        time.sleep(0.02)
    os.killpg(child, signal.SIGKILL)
    os.waitpid(child, 0)
    return HANGS
