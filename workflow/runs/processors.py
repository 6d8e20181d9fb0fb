"""The processors of this machine: their number, a pool of processes for many runs, MPI ranks for one run.

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


def cores() -> int:
    """Return the number of processors that this process may use, else that of the machine, 1 where it is not known."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class _Pool(ProcessPoolExecutor):
    """A pool whose processes do not begin by running the script that runs here, which a run does not need.

    With Python's a script without `if __name__ == "__main__":` begins anew in each process, and one from a pipe ends.
    """

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Submit the call fn(*args, **kwargs) and return its future, as any executor.

        A process that starts here sees an empty `__main__`, which is then put back.
        """
        main = sys.modules["__main__"]
        sys.modules["__main__"] = ModuleType("__main__")
        try:
            return super().submit(fn, *args, **kwargs)
        finally:
            sys.modules["__main__"] = main


@contextmanager
def pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Yield an executor of `workers` spawned processes, which ignore Ctrl+C.

    At the end of the block calls that wait are cancelled and those that run are awaited; an error in the block ends the
    processes at once. Only the parent holds one end of a pipe: when that closes, however the parent ended, the workers
    end.
    """
    receiver, sender = get_context("spawn").Pipe(duplex=False)
    executor = _Pool(workers, get_context("spawn"), _begin, (receiver,))
    try:
        yield executor
    except BaseException:
        sender.close()
        raise
    finally:
        executor.shutdown(cancel_futures=True)
        sender.close()
        receiver.close()


def _begin(parent: Connection) -> None:
    """Begin a worker: it ignores Ctrl+C, loads LAMMPS ahead, and exits when the pipe from its `parent` closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    start_ahead()

    def watch() -> None:
        """Wait until the pipe closes, or has a message, and end this process with the exit code 1."""
        with suppress(EOFError, OSError):
            parent.recv_bytes()
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def require_ranks(deck: Deck, ranks: int, fewest: int = 50) -> None:
    """Check that several MPI ranks can run a deck, and are of use; nothing is returned, and one rank always passes.

    Args:
        deck: of the scene.
        ranks: number of MPI ranks.
        fewest: particles of the upper body for each rank; with fewer, communication takes longer than their forces.

    Raises:
        RanksError: why not, and what to do: with noise; on a rigid plane; with [horizontal] and springs to the bulk
            that are stiffer along x than along z; with fewer than `fewest` particles for each rank; or where mpi4py or
            a launcher of MPI is missing.
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
    if particles < fewest * ranks:
        most = particles // fewest
        raise RanksError(
            f"{ranks} ranks are too many for {particles} particles per body: use "
            + (f"at most {most}, {fewest} particles each" if most > 1 else "one")
        )
    launcher_of(ranks)
