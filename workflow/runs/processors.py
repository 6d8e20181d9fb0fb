"""The processors of this machine: how many there are, a pool of processes for many runs, MPI ranks for one run.

Each rank has the particles of a slice along x (`processors * 1 1`). Sums over the bodies are then added up in another
order: forces differ in their last digits, and what a search or a minimiser makes of them stays within their thresholds.
"""

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
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from contact1d.workflow.engine.launcher import RanksError, launcher_of
from contact1d.workflow.engine.process import start_ahead

if TYPE_CHECKING:
    from contact1d.workflow.deck.deck import Deck

P = ParamSpec("P")
T = TypeVar("T")
FEWEST = 50
"""Particles of a body for each rank: with fewer, telling the neighbours of them takes longer than they do."""


def cores() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Pool(ProcessPoolExecutor):
    """Its processes don't begin by running the script that runs here: a run needs nothing of it.

    Python's would, so that a script without `if __name__ == "__main__":` began anew in each, and one from a pipe ended.
    """

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """As any executor's. A process starts here, if at all, and gets another `__main__` meanwhile."""
        main = sys.modules["__main__"]
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            sys.modules["__main__"] = main


@contextmanager
def pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """An executor of `workers` processes. After an error in its block their work is not awaited.

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


def require_ranks(deck: Deck, ranks: int) -> None:
    """Refuse more ranks than one where they can't, or are no use.

    Raises:
        RanksError: why, and what to do.
    """
    if ranks == 1:
        return
    scene, particles = deck.scene, deck.settings.chains.upper
    if scene.noise:
        raise RanksError(
            "with [noise] each rank draws its own random forces, so that the results depend on the number of ranks: "
            "use one rank, and run several seeds in parallel (contact1d sweep over noise.seed)"
        )
    if scene.bodies.lower == "rigid_plane":
        raise RanksError(
            "on a rigid plane there are no forces between particles but neighbour springs, so that LAMMPS exchanges no "
            "particles between ranks: use one rank"
        )
    if deck.settings.chains.far > 0.0 and scene.tangential_stiffness > scene.bulk_stiffness:
        raise RanksError(
            "bulk springs that are stiffer along x have distant anchors, on other ranks: use one rank, or a "
            "bodies.bulk_stiffness_tangential of at most bulk_stiffness"
        )
    if particles < FEWEST * ranks:
        most = particles // FEWEST
        raise RanksError(
            f"{ranks} ranks are too many for {particles} particles per body: use "
            + (f"at most {most}, {FEWEST} particles each" if most > 1 else "one")
        )
    launcher_of(ranks)
