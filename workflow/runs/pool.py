"""Processes for many runs: new ones, which leave Ctrl-C to their parent and never outlive it."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection


@contextmanager
def pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """An executor of `workers` processes. Where its block ends in an error, what they do is not finished first.

    The parent holds one end of a pipe, and nobody else: when that closes, however the parent went, the workers end.
    """
    theirs, ours = get_context("spawn").Pipe(duplex=False)
    executor = ProcessPoolExecutor(workers, get_context("spawn"), _begin, (theirs,))
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
    """Begin a worker."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def watch() -> None:
        with suppress(EOFError, OSError):
            parent.recv_bytes()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
