"""The parent's side of a worker: start it, send requests, detect its end, keep it for the next session.

ask(request, deadline) ──▶ worker ──▶ answer, or `WorkerLostError` with the cause in one sentence
"""

from __future__ import annotations

import atexit
import mmap
import os
import pickle
import select
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import accumulate, pairwise
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import IO, Any

from contact1d.workflow.engine.launcher import Listener, cause_among_ranks, launcher_of, on_one_node
from contact1d.workflow.engine.progress import Meanwhile

BOOT = """
import sys, types
for depth, name in enumerate(("contact1d", "contact1d.workflow", "contact1d.workflow.engine")):
    package = types.ModuleType(name)
    package.__path__ = [sys.argv[1 + depth]]
    sys.modules[name] = package
"""
"""The start of a worker's program. It imports contact1d from the folders of this installation, whatever the current
folder and the user's script are, and only the modules that it needs: the packages' `__init__.py` do not run."""
ALONE = "from contact1d.workflow.engine.worker import main\nmain(*map(int, sys.argv[4:]))"
RANKS = "from contact1d.workflow.engine.ranks import main\nmain(*sys.argv[4:])"

LAUNCHER_PREFIXES = ("PMI_", "PMIX_", "MPI_LOCAL")
"""Environment variables that mpiexec or srun set for their ranks: a worker must not take itself for one of them."""


class WorkerLostError(Exception):
    """The worker died or was killed; the text is the cause, one clause."""


class OutOfTimeError(WorkerLostError):
    """The worker was killed at the deadline."""


def worker_environment(environ: Mapping[str, str]) -> dict[str, str]:
    """Return a new environment for a worker: one thread, without the variables that mpiexec and srun set for their
    ranks.

    Args:
        environ: the environment of the parent, which is not changed. A `UCX_TLS` in it is kept; without one, MPI may
            use only memory (`self,sm`) unless Slurm says that the step has several nodes.
    """
    environment = {key: text for key, text in environ.items() if not key.startswith(LAUNCHER_PREFIXES)}
    if on_one_node(environ):
        environment.setdefault("UCX_TLS", "self,sm")
    return environment | {"OMP_NUM_THREADS": "1", "PYTHONSAFEPATH": "1"}


def receive(connection: Connection) -> Any:
    """Return the object that `workflow.engine.worker.send` sent, reading each array into its final memory; waits for
    it.

    Raises:
        EOFError: the other end is gone.
        ConnectionError: the connection was lost.
    """
    head, sizes = connection.recv()
    arrays = memoryview(bytearray(sum(sizes)))
    left = arrays
    while left:
        count = os.readv(connection.fileno(), [left])
        if not count:
            raise EOFError
        left = left[count:]
    ends = list(accumulate(sizes, initial=0))
    return pickle.loads(head, buffers=[arrays[start:end] for start, end in pairwise(ends)])


class WorkerProcess:
    """A running worker. After any failure it is dead, and stays so.

    Attributes:
        ranks: number of its MPI ranks.
        pid: its process id; that of the launcher for several ranks.
        last_output: the last 4000 bytes of its output, as text, once its end was found; "" before.
    """

    def __init__(self, ranks: int) -> None:
        """Start a worker with this number of MPI ranks, which loads LAMMPS.

        Raises:
            RanksError: several ranks, and what they need isn't installed.
        """
        self.ranks = ranks
        self._output = tempfile.TemporaryFile()  # noqa: SIM115 (open as long as the worker lives)
        self._start() if ranks == 1 else self._start_ranks()
        self._board = memoryview(self._board_map).cast("q")
        self._ready = select.poll()
        self._ready.register(self._connection.fileno(), select.POLLIN)
        self.pid = self._process.pid
        self.last_output, self._last_board = "", (0, 0)

    def _start(self) -> None:
        """Start a worker of one rank, which inherits its pipe and the shared memory for the timestep and the steps
        done.
        """
        self._connection, worker_end = Pipe()
        with tempfile.TemporaryFile() as file:
            self._share_board(file)
            self._run([], ALONE, (worker_end.fileno(), file.fileno(), os.getpid()), worker_end.fileno(), file.fileno())
        worker_end.close()

    def _start_ranks(self) -> None:
        """Start the ranks by a launcher, maybe on other machines: they inherit no open files."""
        launcher = launcher_of(self.ranks)
        with tempfile.TemporaryDirectory() as folder, (Path(folder) / "board").open("w+b") as file:
            self._share_board(file)
            with Listener(Path(folder) / "socket") as listener:
                self._run(launcher, RANKS, (listener.address, file.name))
                self._connection = listener.connection_to(self._process)

    def _share_board(self, file: IO[bytes]) -> None:
        """Map an empty file of 16 bytes, in which the worker writes the timestep and the steps done."""
        file.truncate(16)
        self._board_map = mmap.mmap(file.fileno(), 0)

    def _run(self, launcher: Sequence[str], entry: str, arguments: tuple[object, ...], *files: int) -> None:
        """Start the process with a program `entry`, its arguments and the open `files` that it inherits."""
        packages = (str(parent) for parent in reversed(Path(__file__).parents[:3]))
        self._process = subprocess.Popen(
            [*launcher, sys.executable, "-c", BOOT + entry, *packages, *map(str, arguments)],
            pass_fds=files,
            stdin=subprocess.DEVNULL,
            stdout=self._output,
            stderr=subprocess.STDOUT,
            env=worker_environment(os.environ),
            start_new_session=bool(launcher),  # Ctrl-C reaches the whole terminal group; the parent decides
        )

    @property
    def alive(self) -> bool:
        """Whether the worker accepts requests: its process runs and the connection is open on this side."""
        return not self._connection.closed and self._process.poll() is None

    def board(self) -> tuple[int, int]:
        """Return (timestep, steps of the session), as of the last fifth of a second or of the worker's death.

        Both are 0 before the first session.
        """
        return self._last_board if self._board_map.closed else (self._board[0], self._board[1])

    def ask(
        self,
        request: tuple[Any, ...],
        deadline: float,
        tick: Callable[[], None] | None = None,
        meanwhile: Meanwhile = None,
        interval: float = 0.2,
    ) -> Any:
        """Send a request and return the answer; any exception before that, also of a callback, kills the worker.

        The answer is (outcome, payload, timestep, steps, wall [s], cpu [s]); the outcome "done", or with the reason as
        payload "refused" or "lammps": those are returned, too, and nothing is killed.

        Args:
            request: (verb, argument, …).
            deadline: on the clock `time.monotonic` [s].
            tick: called every `interval` while waiting; not where the answer comes sooner.
            meanwhile: called once, while the worker is busy.
            interval: time between two checks of the deadline [s].

        Raises:
            OutOfTimeError: the deadline passed.
            WorkerLostError: it died; the text is the cause.
        """
        try:
            self._connection.send(request)
            if meanwhile:
                meanwhile()
            while not self._ready.poll(1e3 * max(0.0, min(interval, deadline - time.monotonic()))):
                if time.monotonic() >= deadline:
                    raise OutOfTimeError("it ran out of time")
                if tick:
                    tick()
            return receive(self._connection)
        except (EOFError, ConnectionError):
            raise WorkerLostError(self._cause_of_end()) from None
        except BaseException:
            self.kill()
            raise

    def kill(self) -> None:
        """Kill the worker at once and release its files and memory."""
        self._end()
        self._release()

    def stop(self) -> None:
        """Close the pipe, on which the worker ends by itself; kill it after a second; release its files and memory."""
        self._connection.close()
        try:
            self._process.wait(1.0)
        except subprocess.TimeoutExpired:
            self._end()
        self._release()

    def forget(self) -> None:
        """Close the files of the worker in a forked child, without ending it: it belongs to the parent."""
        self._connection.close()
        self._output.close()
        self._process.returncode = 0

    def _end(self) -> None:
        """Kill the worker; a launcher is terminated first, so that it ends its ranks, on other machines too."""
        if self.ranks > 1:
            self._process.terminate()
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(1.0)
        self._process.kill()

    def _release(self) -> None:
        """Wait for the end of the worker, and release its files and memory; a second call only waits.

        The last 4000 bytes of its output and its last timestep and steps are kept.
        """
        self._process.wait()
        self._connection.close()
        if not self._board_map.closed:
            self._output.seek(max(0, self._output.seek(0, os.SEEK_END) - 4000))
            self.last_output = self._output.read().decode(errors="replace").strip()
            self._last_board = self._board[0], self._board[1]
            self._board.release()
            self._board_map.close()
            self._output.close()

    def _cause_of_end(self) -> str:
        """Return why the worker ended, in one clause, and release its files and memory.

        It waits for the end, and kills the worker after 5 s.
        """
        try:
            self._process.wait(5.0)
        except subprocess.TimeoutExpired:
            self._end()
        self._release()
        code = self._process.returncode
        if self.ranks > 1 and (cause := cause_among_ranks(self.ranks, self.last_output)):
            return cause
        if code >= 0:
            words = self.last_output.splitlines()[-1:] or ["no message"]
            return f"the LAMMPS process ended by itself with exit code {code} ({words[0]})"
        name = signal.Signals(-code).name
        if name == "SIGKILL":
            return "the LAMMPS process was killed (SIGKILL), most often because the machine was out of memory"
        return f"the LAMMPS process crashed ({name})"


_idle: list[WorkerProcess] = []
_lock = threading.Lock()


def borrow(ranks: int = 1) -> WorkerProcess:
    """Return a free worker of this number of ranks: the idle one that was used last if it lives, otherwise a new one.

    The caller has it alone until it gives it back. Idle ones that died are removed.

    Raises:
        RanksError: several ranks, and what they need isn't installed.
    """
    with _lock:
        while fitting := [worker for worker in _idle if worker.ranks == ranks]:
            worker = fitting[-1]
            _idle.remove(worker)
            if worker.alive:
                return worker
            worker.kill()
    return WorkerProcess(ranks)


def start_ahead() -> None:
    """Start a worker of one rank for the next `borrow`, so that LAMMPS loads while the caller prepares.

    Nothing is started where an idle one of one rank lives.
    """
    give_back(borrow())


def give_back(worker: WorkerProcess) -> None:
    """Keep a worker without an open session for the next `borrow`; nothing checks that it lives."""
    with _lock:
        _idle.append(worker)


def stop_idle() -> None:
    """Stop all workers that wait for a session, of any number of ranks; also runs when the interpreter exits."""
    with _lock:
        workers, _idle[:] = _idle[:], []
    for worker in workers:
        worker.stop()


def _forget_idle() -> None:
    """Remove the idle workers in a forked child and close their files there; they go on, and belong to the parent."""
    global _lock
    _lock = threading.Lock()
    for worker in _idle:
        worker.forget()
    _idle.clear()


atexit.register(stop_idle)
os.register_at_fork(after_in_child=_forget_idle)
