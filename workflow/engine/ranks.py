"""A worker of several MPI ranks: rank 0 communicates with the parent and the others, and all run the same commands.

    parent ──request──▶ rank 0 ──▶ the others,   all: LAMMPS,   the others' atoms ──▶ rank 0 ──answer──▶ parent

Each rank has the particles of a slice along x. A rank that fails alone, while the others wait for it in the middle of a
step, says why on its output and ends them all.
"""

from __future__ import annotations

import mmap
import os
import select
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Client
from pathlib import Path
from typing import Any

from contact1d.workflow.engine.readout import RefusalError
from contact1d.workflow.engine.worker import Runner, answer, leave, send, watch

PAUSE = 1e-4
"""Seconds between two looks of a rank without work: one that waits in MPI takes a whole processor."""
PATIENCE = 1.0
"""Seconds in which the parent ends all ranks where all have failed; then one that has failed does."""
SAID = "failed on rank"
"""What a rank begins its last words with."""


def main(socket: str, board: str) -> None:
    """Answer requests until the parent closes the socket; of ranks other than 0: until rank 0 leaves.

    Args:
        socket: address of the parent's listener, for rank 0.
        board: file of 16 bytes, see `workflow.engine.worker.Runner`.
    """
    from mpi4py import MPI  # before LAMMPS is loaded, which then has the same library

    world, launcher = MPI.COMM_WORLD, os.getppid()
    if world.rank:
        _follow(world, lambda: os.getppid() != launcher)
    with Path(board).open("r+b") as file:
        shared = mmap.mmap(file.fileno(), 16)
    connection = Client(socket, "AF_UNIX")
    runner = Runner(memoryview(shared).cast("q"), world)

    hung_up = select.poll()
    hung_up.register(connection.fileno(), getattr(select, "POLLRDHUP", select.POLLHUP))  # the former is Linux's

    def gone() -> bool:
        return bool(hung_up.poll(0)) or os.getppid() != launcher

    threading.Thread(target=watch, args=(runner, gone), daemon=True).start()
    _tell(world, ("prepare",))
    with suppress(RefusalError):  # the first `open` tells of it
        runner.prepare()
    try:
        while True:
            request = connection.recv()
            _tell(world, request)
            send(connection, answer(runner, request[0], tuple(request[1:])))
    except (EOFError, OSError):
        _tell(world, None)
        leave()


def _tell(world: Any, request: tuple[Any, ...] | None) -> None:
    for rank in range(1, world.size):
        world.send(request, rank)


def _follow(world: Any, gone: Callable[[], bool]) -> None:
    """Do what rank 0 is asked, until it leaves."""
    runner = Runner(memoryview(bytearray(16)).cast("q"), world)
    threading.Thread(target=watch, args=(runner, gone), daemon=True).start()
    while True:
        while not world.iprobe(source=0):
            time.sleep(PAUSE)
        request = world.recv(source=0)
        if request is None:
            leave()
        outcome, words, *_ = answer(runner, request[0], tuple(request[1:]))
        if outcome != "done" and request[0] != "prepare":
            time.sleep(PATIENCE)
            print(f"{SAID} {world.rank}: {words}", flush=True)
            os._exit(1)  # the launcher ends the others; after MPI's Abort it may leave without these words
