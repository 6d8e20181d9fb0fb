"""Claim: a test that hangs fails, wherever it waits."""

import signal
import time
from collections.abc import Callable

import pytest

from tests.limits import time_limit


def endless_loop() -> None:
    while True:
        pass


def endless_wait() -> None:
    time.sleep(600.0)


@pytest.mark.parametrize("hangs", [endless_loop, endless_wait])
def test_what_hangs_fails(hangs: Callable[[], None]) -> None:
    with pytest.raises(pytest.fail.Exception, match=r"it hangs: not done after 0\.1 s"), time_limit(0.1):
        hangs()


def test_every_test_has_a_limit() -> None:
    """The alarm of this one is set."""
    assert signal.getitimer(signal.ITIMER_REAL)[0] > 0.0
