"""Claim: a test that hangs fails, wherever it waits."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.limits import time_limit

ROOT = Path(__file__).parents[2]
HANGS = """
import time
import pytest
from tests.limits import time_limit

@pytest.fixture
def endless():
    with time_limit(0.2):
        while True:
            try:
                time.sleep(60)
            except Exception:
                pass

def test_one(endless): ...
def test_two(): ...
"""


def endless_loop() -> None:
    while True:
        pass


def endless_wait() -> None:
    time.sleep(600.0)


def endless_read() -> None:
    end, _ = os.pipe()
    os.read(end, 1)


@pytest.mark.parametrize("hangs", [endless_loop, endless_wait, endless_read])
def test_what_hangs_fails(hangs: object) -> None:
    assert callable(hangs)
    with pytest.raises(pytest.fail.Exception, match=r"it hangs: not done after 0\.1 s"), time_limit(0.1):
        hangs()


def test_the_tests_after_it_run(tmp_path: Path) -> None:
    """Also where the test catches every error."""
    (tmp_path / "test_hangs.py").write_text(HANGS)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path / "test_hangs.py")]
    environ = os.environ | {"PYTHONPATH": f"{ROOT}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"}
    done = subprocess.run(command, cwd=tmp_path, env=environ, capture_output=True, text=True, check=False)
    assert "1 passed, 1 error" in done.stdout


def test_every_test_has_a_limit() -> None:
    """The alarm of this one is set."""
    import signal

    left, _ = signal.getitimer(signal.ITIMER_REAL)
    assert left > 0.0
