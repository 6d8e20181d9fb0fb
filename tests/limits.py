"""A time limit for what may hang. It is no measure of speed: far above what anything takes on a slow machine."""

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

import pytest

PATIENCE = float(os.environ.get("PATIENCE", "1"))
"""More where the machine does much other work."""
LIMIT, SLOW_LIMIT = PATIENCE * 300.0, PATIENCE * 6 * 3600.0
"""Seconds of a test, and of one that is marked slow; the longest take 60 and 3000 on two cores."""
AGAIN = 20.0
"""Seconds after which what caught the failure, or hangs while it tidies up, is interrupted once more."""


@contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Fail what is inside, wherever it waits, after so many seconds. In other threads than the main one: no limit."""

    def fail(_: int, frame: FrameType | None) -> None:
        place = "" if frame is None else f", in {frame.f_code.co_filename}:{frame.f_lineno}"
        pytest.fail(f"it hangs: not done after {seconds:g} s{place}")

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = signal.signal(signal.SIGALRM, fail)
    before, _ = signal.setitimer(signal.ITIMER_REAL, seconds, AGAIN)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, before)
        signal.signal(signal.SIGALRM, handler)
