"""Processes for many runs: new ones, which leave Ctrl-C to their parent and never outlive it."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from types import ModuleType
from typing import ParamSpec, TypeVar

from contact1d.workflow.engine.process import start_ahead

P = ParamSpec("P")
T = TypeVar("T")


class _Pool(ProcessPoolExecutor):
    """Its processes don't begin by running the script that runs here: a run needs nothing of it.

    Python's would, so that a script without `if __name__ == "__main__":` began anew in each, and one from a pipe ended.
    """

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """As any executor's. A process starts here, if at all, and is told of what is `__main__` meanwhile."""
        main = sys.modules["__main__"]
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            sys.modules["__main__"] = main


@contextmanager
def pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """An executor of `workers` processes. Where its block ends in an error, what they do is not finished first.

    The parent holds one end of a pipe, and nobody else: when that closes, however the parent went, the workers end.
    """
    theirs, ours = get_context("spawn").Pipe(duplex=False)
    executor = _Pool(workers, get_context("spawn"), _begin, (theirs,))
    try:
        yield executor
    except BaseException:
        ours.close()
        raise
    finally:
        executor.shutdown(cancel_futures=True)
        ours.close()
        theirs.close()


def _begin(parent: Connection) -> None:
    """Begin a worker: LAMMPS loads while the rest of the program does."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    start_ahead()

    def watch() -> None:
        with suppress(EOFError, OSError):
            parent.recv_bytes()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
