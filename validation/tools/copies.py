"""A copy of this checkout with a fault in it: which of its tests is the first to notice.

Each run is a fork of a process that has loaded what the tests need and nothing of this program.
"""

import os
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
MADE = ("runs", "reproduced", "stability", "speed", "__pycache__")
"""What is made by running, and is not copied from the top."""
HANGS, BROKEN = "they take too long", "they do not run"
HANGING = "it hangs: not done after"
"""What a test says that reaches its own limit, in `tests/limits.py`."""
LIMIT = 300.0
"""Time limit of a test in `tests/limits.py` [s]; the environment's PATIENCE multiplies it."""
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


@contextmanager
def copy_of_this() -> Iterator[Path]:
    """A copy of this checkout, for a while."""

    def made(parent: str, names: list[str]) -> list[str]:
        at_top = Path(parent) == ROOT
        return [name for name in names if name.startswith(".") or name == MADE[-1] or (at_top and name in MADE)]

    with tempfile.TemporaryDirectory() as temporary:
        yield Path(shutil.copytree(ROOT, Path(temporary) / "copy", symlinks=True, ignore=made))


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
    end, found = time.monotonic() + patience, None
    while found is None and time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        found = os.waitstatus_to_exitcode(status) if done else None
        time.sleep(0.02)
    with suppress(ProcessLookupError):  # what it started may live on
        os.killpg(child, signal.SIGKILL)
    if found is None:
        os.waitpid(child, 0)
    return found


def run_tests(folder: Path, tests: Sequence[str], plugin: Any, patience: float, longest: float = LIMIT) -> int | None:
    """Pytest's exit code for tests of a copy, each within `longest` [s], all within `patience` [s], with a plugin."""

    def run() -> int:
        os.environ["PATIENCE"] = str(longest / LIMIT)
        return int(pytest.main([*QUICK, "--rootdir", str(folder), *tests], [plugin]))

    return in_copy(folder, run, patience)


def first_failure(folder: Path, tests: Sequence[str], patience: float, longest: float = LIMIT) -> str:
    """The first test that fails in that copy, HANGS after `patience`; empty where all pass. Times as in `run_tests`."""
    noted = folder / ".failed"
    noted.unlink(missing_ok=True)

    class Notes:
        @staticmethod
        def pytest_runtest_logreport(report: Any) -> None:
            if report.failed and not noted.exists():
                limit = HANGING in str(report.longrepr)
                noted.write_text(HANGS if limit else report.nodeid, encoding="utf-8")

        pytest_collectreport = pytest_runtest_logreport

    code = run_tests(folder, ["-x", *tests], Notes(), patience, longest)
    if code is None:
        return HANGS
    if code in (0, pytest.ExitCode.NO_TESTS_COLLECTED):  # none that ran failed
        return ""
    return noted.read_text(encoding="utf-8") if noted.exists() else BROKEN
