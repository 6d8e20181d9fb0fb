"""A copy of this folder with a fault in it: which of its tests is the first to notice.

Each run is a fork of a process that has loaded what the tests need and nothing of this program.
"""

from __future__ import annotations

import compileall
import os
import py_compile
import shutil
import signal
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
FAILED = ".failed"
"""File of a copy that the first failing test's name is written to."""
HANGS, CRASHES = "they take too long", "they crash"
QUICK = ("-q", "--assert=plain", "-p", "no:cacheprovider")
"""pytest without what takes time only."""
LOADED = (
    "numpy",
    "scipy.optimize",
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.stats",
    "pydantic",
    "matplotlib.figure",
    "pytest",
    "hypothesis.strategies",
    "hypothesis.extra.numpy",
    "scipy.integrate",
    "jinja2",
    "typer",
    "rich.progress",
    "pint",
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
    # by what is in a file, not by its time: two mutants of one second and size would be taken for each other
    compileall.compile_dir(folder, quiet=2, invalidation_mode=py_compile.PycInvalidationMode.CHECKED_HASH)
    return folder


def in_copy(folder: Path, run: Callable[[], int], patience: float) -> int | None:
    """What `run` returns in a fork that takes `folder` for this folder; None after so many seconds."""
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
        sys.dont_write_bytecode = True
        os.environ |= {"PYTHONPATH": f"{folder}/src", "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
        os.environ["PATIENCE"] = "20"  # what fails is to fail by its fault, whatever else the machine does
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


def first_failure(folder: Path, tests: Sequence[str], patience: float) -> str:
    """The first test that fails in that copy, HANGS after so many seconds; empty where all pass."""
    noted = folder / FAILED
    noted.unlink(missing_ok=True)

    def run() -> int:
        import pytest

        class Notes:
            @staticmethod
            def pytest_runtest_logreport(report: pytest.TestReport | pytest.CollectReport) -> None:
                if report.failed and not noted.exists():
                    noted.write_text(report.nodeid, encoding="utf-8")

            pytest_collectreport = pytest_runtest_logreport

        return int(pytest.main(["-x", *QUICK, "--rootdir", str(folder), *tests], [Notes()]))

    code = in_copy(folder, run, patience)
    if code == 0:
        return ""
    if code is None:
        return HANGS
    return noted.read_text(encoding="utf-8") if noted.exists() else "they do not run"
