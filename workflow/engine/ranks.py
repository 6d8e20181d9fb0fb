"""A worker of several MPI ranks: rank 0 communicates with the parent and the others, and all run the same commands.

    parent ──request──▶ rank 0 ──▶ the others,   all: LAMMPS,   the others' atoms ──▶ rank 0 ──answer──▶ parent

Each rank has the particles of a slice along x. A rank that fails alone, while the others wait for it in the middle of a
step, prints the cause and ends them all.
"""

from __future__ import annotations

import mmap
import os
import select
import threading
import time
from collections.abc import Callable
from multiprocessing.connection import Client
from pathlib import Path
from typing import Any

from contact1d.workflow.engine.worker import Runner, answer, leave, serve, watch


def main(socket: str, board: str) -> None:
    """Answer requests until the parent closes the socket; ranks other than 0 until rank 0 leaves; never return.

    Args:
        socket: address of the parent's listener, for rank 0.
        board: file of 16 bytes, the timestep and the steps done in the session, which the parent may read at any time.
    """
    from mpi4py import MPI  # before LAMMPS is loaded, which then has the same library

    world, launcher = MPI.COMM_WORLD, os.getppid()
    if world.rank:
        _follow(world, lambda: os.getppid() != launcher)
    with Path(board).open("r+b") as file:
        shared = mmap.mmap(file.fileno(), 0)
    connection = Client(socket, "AF_UNIX")
    runner = Runner(memoryview(shared).cast("q"), world)

    hung_up = select.poll()
    hung_up.register(connection.fileno(), getattr(select, "POLLRDHUP", select.POLLHUP))  # the former is Linux's

    def gone() -> bool:
        """Return whether the parent has closed the socket, or the launcher has ended."""
        return bool(hung_up.poll(0)) or os.getppid() != launcher

    def broadcast(request: tuple[Any, ...] | None) -> None:
        """Send a request, (verb, arguments…), to all other ranks; None: they are to leave."""
        for rank in range(1, world.size):
            world.send(request, rank)

    serve(connection, runner, gone, broadcast)


def _follow(world: Any, gone: Callable[[], bool]) -> None:
    """Run the requests of rank 0 on another rank, until rank 0 leaves; never return.

    A request that fails, but for "prepare", is printed and ends the process after a second. `gone`: whether the
    launcher has ended.
    """
    runner = Runner(memoryview(bytearray(16)).cast("q"), world)
    threading.Thread(target=watch, args=(runner, gone), daemon=True).start()
    while True:
        while not world.iprobe(source=0):
            time.sleep(1e-4)  # a rank that waits in MPI takes a whole processor
        request = world.recv(source=0)
        if request is None:
            leave()
        outcome, words, *_ = answer(runner, request)
        if outcome != "done" and request[0] != "prepare":
            time.sleep(1.0)  # in which the parent ends all ranks, if all have failed
            print(f"failed on rank {world.rank}: {words}", flush=True)  # `launcher.cause_among_ranks` reads it
            os._exit(1)  # the launcher ends the others; after MPI's Abort it may leave without these words
