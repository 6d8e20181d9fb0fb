"""The child process in which LAMMPS lives: reads requests from a pipe, runs them, answers; the only `import lammps`.

    request (verb, arguments) ──▶ LAMMPS ──▶ (outcome, payload, timestep, steps, wall [s], cpu [s])

A worker is one MPI rank, or several (`ranks`). It is independent of the current folder and the user's script: `process`
starts it.
"""

from __future__ import annotations

import ctypes
import mmap
import os
import pickle
import re
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from contact1d.workflow.engine.readout import RefusalError, read_atoms, read_value, require_finite_positions

T = TypeVar("T")
LOG = "log.lammps"
ABORTS = "MPIAbortException"
"""Name of the exception that LAMMPS raises on one of several ranks; where all fail it is a plain one."""
MPI_LIBRARY = "libmpi.so.12"

# Commands after which the timestep is no longer the number of steps done so far; `jump` may reach any of them.
MOVES_THE_CLOCK = re.compile(r"\b(reset_timestep|clear|read_data|read_restart|read_dump|rerun|jump|include)\b")
# The command that frees the clock itself, which then must not be looked at from outside.
FREES_THE_CLOCK = re.compile(r"\bclear\b")
LOOP = re.compile(rb"^Loop time of .* for (\d+) steps", re.MULTILINE)


def mpi_candidates() -> Iterator[str]:
    """Yield paths of the MPI library, the likeliest first: of the interpreter, the mpich wheel, its mere name for the
    system.

    They need not exist.
    """
    yield str(Path(sys.prefix) / "lib" / MPI_LIBRARY)
    from importlib import metadata  # an import of 20 ms that the first place mostly spares

    try:
        files = metadata.files("mpich") or []
    except metadata.PackageNotFoundError:
        files = []
    yield from (str(file.locate()) for file in files if file.name == MPI_LIBRARY)
    yield MPI_LIBRARY


def load_lammps() -> tuple[Any, str]:
    """Return (the class `lammps.lammps`, the MPI library that was loaded for it).

    The library is a path or name, "that of mpi4py" where that is imported, or "" where none was found. LAMMPS does not
    find the MPI library of its own wheel: this is loaded first, with global symbols. A later import of mpi4py is
    blocked, unless it is imported already.

    Raises:
        RefusalError: LAMMPS is not installed.
    """
    # With one rank mpi4py would only load a second MPI library.
    loaded = "that of mpi4py" if sys.modules.setdefault("mpi4py", None) else ""  # type: ignore[arg-type]  # None: no import
    for candidate in () if loaded else mpi_candidates():
        try:
            ctypes.CDLL(candidate, mode=ctypes.RTLD_GLOBAL)
        except OSError:
            continue
        loaded = candidate
        break
    try:
        from lammps import lammps
    except ImportError as error:
        raise RefusalError(f"LAMMPS is not installed ({error}); install it with: pip install 'lammps[mpi]'") from None
    return lammps, loaded


class Alone:
    """The communicator of a worker with one rank, with the methods of mpi4py that are used."""

    rank, size = 0, 1

    def gather(self, part: T) -> list[T]:
        """Return the objects of all ranks in a list, here that of the only one."""
        return [part]


class Runner:
    """One LAMMPS instance at a time, in the folder of the current session.

    Attributes:
        board: two int64 shared with the parent, the timestep and the steps done in this session, which the parent may
            read at any time, also after this process was killed.
        world: the communicator of the ranks, mpi4py's or `Alone`.
        steps: timesteps and iterations done in this session.
        wall, cpu: time in LAMMPS in this session, by the clock and on the processor [s].
    """

    def __init__(self, board: memoryview, world: Any) -> None:
        """Store `board`, two int64 shared with the parent, and the communicator `world`; no LAMMPS instance is made
        yet.
        """
        self.board, self.world = board, world
        self.library: tuple[Any, str] | None = None
        self.lammps: Any = None
        self.log = Path(LOG)
        self.clock: ctypes.c_int64 | None = None
        self.clock_start = 0
        self.steps = 0
        self.wall = self.cpu = 0.0

    def open(self, folder: str) -> None:
        """Open a fresh instance that logs into the folder, make this the current one, and set times and steps to 0.

        Raises:
            RefusalError: LAMMPS or its MPI library is not installed.
            OSError: there is no such folder.
        """
        os.chdir(folder)
        self.log = Path(folder) / LOG
        self.steps, self.clock = 0, None
        self.wall = self.cpu = 0.0
        self.board[0] = self.board[1] = 0
        self.lammps = self._instance(LOG)
        self._find_clock()

    def prepare(self) -> None:
        """Load LAMMPS, and open and close an instance: with MPI, the first one of a process takes a tenth of a second.

        Raises:
            RefusalError: LAMMPS or its MPI library is not installed.
        """
        self._instance("none").close()

    def _instance(self, log: str) -> Any:
        """Return a new LAMMPS instance that logs into a file of this name, "none" for no log.

        Raises:
            RefusalError: LAMMPS or its MPI library is not installed.
        """
        self.library = self.library or load_lammps()
        try:
            instance = self.library[0](cmdargs=["-log", log, "-screen", "none", "-nocite"])
        except OSError as error:
            advice = "install it with: pip install 'lammps[mpi]' (it brings the mpich wheel)"
            missing = MPI_LIBRARY in str(error)
            cause = f"the MPI library {MPI_LIBRARY} was not found" if missing else f"LAMMPS does not load ({error})"
            raise RefusalError(f"{cause}; {advice}") from None
        # The file is mapped already and no other rank needs its name: without one, nothing is left behind by a crash.
        for segment in Path("/dev/shm").glob(f"mpich_shm_{os.getpid():x}_*"):
            segment.unlink(missing_ok=True)
        return instance

    def close(self) -> None:
        """Close the instance, if there is one, and make "/" the current folder: the run folder may then be removed."""
        self.clock = None
        if self.lammps is not None:
            self.lammps.close()
            self.lammps = None
        os.chdir("/")

    def measure(self, text: str, values: Sequence[str], atoms: Sequence[str]) -> Any:
        """Run the commands of `text`, then return ([numbers of `values`], {name: array} of `atoms`).

        In units of the LAMMPS input. Without names of `atoms` the arrays are {}, with some "id" and "type" are among
        them, and on ranks other than 0 they are {}. With "" for `text` nothing is run. The shared timestep and steps
        are updated in any case.

        Raises:
            RefusalError: a position or a requested number is not finite, or there is no such array.
            Exception: LAMMPS failed.
        """
        try:
            if text:
                self._execute(text)
                if "x" not in atoms:
                    require_finite_positions(self.lammps, self.world)
            arrays = read_atoms(self.lammps, atoms, self.world) if atoms else {}
            return [read_value(self.lammps, name) for name in values], arrays
        finally:
            self.publish()

    def measure_rows(self, texts: Sequence[str], values: Sequence[str], atoms: Sequence[str]) -> list[Any]:
        """Return a list with ([numbers of `values`], {name: array} of `atoms`) after each of the texts of LAMMPS
        commands.

        In units of the LAMMPS input; the arrays are {} without names of `atoms`.

        Raises:
            RefusalError: a position or a requested number is not finite, or there is no such array.
            Exception: LAMMPS failed.
        """
        return [self.measure(text, values, atoms) for text in texts]

    def about(self, styles: Sequence[tuple[str, str]]) -> dict[str, Any]:
        """Return {"version": as YYYYMMDD, "packages": list, "mpi": MPI library or "", "missing": the `styles` that
        LAMMPS lacks}.

        `styles`: pairs (category, style).
        """
        return {
            "version": int(self.lammps.version()),
            "packages": list(self.lammps.installed_packages),
            "mpi": self.library[1] if self.library else "",
            "missing": [pair for pair in styles if not self.lammps.has_style(*pair)],
        }

    def publish(self) -> None:
        """Write the timestep and the steps done in the session to the memory shared with the parent; nothing without an
        instance.

        Nothing is written either while a command `clear` may free the instance.
        """
        clock = self.clock
        if clock is not None:
            self.board[0] = clock.value
            self.board[1] = self.steps + max(0, clock.value - self.clock_start)

    def _find_clock(self) -> None:
        """Find LAMMPS's timestep in its memory, to be read while it runs."""
        self.lammps.lib.lammps_extract_global.restype = ctypes.c_void_p
        address = self.lammps.lib.lammps_extract_global(self.lammps.lmp, b"ntimestep")
        self.clock = ctypes.c_int64.from_address(address)
        self.clock_start = self.clock.value

    def _execute(self, text: str) -> None:
        """Run the commands of `text`, and add their time and steps to those of the session.

        Time and steps are added also where LAMMPS fails.

        Raises:
            Exception: LAMMPS failed.
        """
        mark = None
        moves = MOVES_THE_CLOCK.search(text)
        if moves and not self.world.rank:  # which alone has a log
            self.lammps.flush_buffers()
            mark = self.log.stat().st_size
        self.clock_start = self.clock.value if self.clock else 0
        if moves and FREES_THE_CLOCK.search(text):
            self.clock = None
        wall, cpu = time.perf_counter(), time.process_time()
        try:
            self.lammps.commands_string(text)
        finally:
            self.wall += time.perf_counter() - wall
            self.cpu += time.process_time() - cpu
            start = self.clock_start
            self._find_clock()
            self.steps += max(0, self.clock_start - start) if mark is None else self._logged_steps(mark)

    def _logged_steps(self, mark: int) -> int:
        """Return the sum of the steps of all runs and minimisations that LAMMPS's log reports after its first `mark`
        bytes.
        """
        self.lammps.flush_buffers()
        with self.log.open("rb") as log:
            log.seek(mark)
            return sum(int(steps) for steps in LOOP.findall(log.read()))


def answer(runner: Runner, request: tuple[Any, ...]) -> tuple[Any, ...]:
    """Run a request (method of the runner, arguments…); return (outcome, payload, timestep, steps, wall [s], cpu [s]).

    The outcome is "done", with what the method returned as payload, or "refused" or "lammps", with why as text: by the
    program, or in the words of LAMMPS. No `Exception` is raised.
    """
    outcome, (verb, *arguments) = "done", request
    try:
        payload = getattr(runner, verb)(*arguments)
    except RefusalError as error:
        outcome, payload = "refused", str(error)
    except Exception as error:
        outcome, payload = "lammps", str(getattr(error, "message", error))
        if type(error) is not Exception and type(error).__name__ != ABORTS:  # LAMMPS's own errors are these
            outcome, payload = "refused", f"the engine could not do {verb!r} ({error!r})"
    if outcome != "done" and runner.lammps is not None:
        runner.lammps.flush_buffers()
    return outcome, payload, runner.board[0], runner.steps, runner.wall, runner.cpu


def send(connection: Connection, reply: tuple[Any, ...]) -> None:
    """Send a reply, head and array sizes first, then the arrays byte by byte without a copy; `process.receive` reads
    it.
    """
    arrays: list[pickle.PickleBuffer] = []
    head = pickle.dumps(reply, protocol=5, buffer_callback=arrays.append)
    parts = [array.raw() for array in arrays]
    connection.send((head, [part.nbytes for part in parts]))
    while parts:
        count = os.writev(connection.fileno(), parts)
        while parts and parts[0].nbytes <= count:
            count -= parts.pop(0).nbytes
        if parts:
            parts[0] = parts[0][count:]


def watch(runner: Runner, gone: Callable[[], bool], interval: float = 0.2) -> None:
    """Update the shared timestep and steps and the log file every `interval` [s], until the parent is gone.

    Then end the process with code 1.
    """
    buffers = ctypes.CDLL(None)
    while not gone():
        time.sleep(interval)
        runner.publish()
        buffers.fflush(None)  # so that a run that is killed leaves its log
    os._exit(1)


def leave() -> NoReturn:
    """End the process at once with code 0: the kernel frees all that it has, and MPI's own finalisation can hang."""
    ctypes.CDLL(None).fflush(None)
    os._exit(0)


def serve(
    connection: Connection,
    runner: Runner,
    gone: Callable[[], bool],
    broadcast: Callable[[tuple[Any, ...] | None], object] = lambda request: None,
) -> NoReturn:
    """Prepare LAMMPS, answer requests until the connection closes, and end the process; never return.

    Args:
        connection: to the parent.
        runner: of this rank.
        gone: whether the parent has ended, or a launcher between the two.
        broadcast: called with each request before it is run, for other ranks, at the end with None.
    """
    threading.Thread(target=watch, args=(runner, gone), daemon=True).start()
    broadcast(("prepare",))
    with suppress(RefusalError):  # which the first `open` reports
        runner.prepare()
    try:
        while True:
            request = connection.recv()
            broadcast(request)
            send(connection, answer(runner, request))
    except (EOFError, OSError):
        broadcast(None)
        leave()


def main(connection_fd: int, board_fd: int, parent: int) -> None:
    """Answer requests until the pipe closes, and end the process; never return.

    `connection_fd`, `board_fd`: file descriptors of the pipe and of a shared file of 16 bytes for timestep and steps;
    `parent`: id of the process whose end is also the worker's.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches the whole terminal group; the parent decides
    runner = Runner(memoryview(mmap.mmap(board_fd, 0)).cast("q"), Alone())
    serve(Connection(connection_fd), runner, lambda: os.getppid() != parent)
