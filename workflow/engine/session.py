"""LAMMPS for the rest of the program: one session per run folder, in a process of its own.

    with Engine.session(folder) as session:
        session.execute(text, phase="loading")
        (force,) = session.values("force")

Whatever LAMMPS does (stop with an error, lose an atom, crash, hang, compute NaN), the caller gets an `EngineError` that
says what, in which phase and at which step; the files of the folder stay, and the next session has a new process.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from contact1d.workflow.engine.failure import EngineError, plain_message
from contact1d.workflow.engine.process import OutOfTimeError, WorkerLostError, WorkerProcess, borrow, give_back
from contact1d.workflow.engine.progress import Meanwhile, Progress, Silent

LOG = "log.lammps"

Array = NDArray[Any]

__all__ = ["Engine", "EngineError", "Installation", "Reading", "Session"]


@dataclass(frozen=True)
class Reading:
    """Requested values of LAMMPS at one time, in units of the deck.

    Attributes:
        values: one number per name, in the order of the names.
        atoms: per-atom arrays by name, rows in the order of the atoms' ids, (n,) or (n, columns).
    """

    values: tuple[float, ...]
    atoms: dict[str, Array]


@dataclass(frozen=True)
class Installation:
    """The LAMMPS that runs.

    Attributes:
        version: as YYYYMMDD.
        packages: their names.
        mpi: path or name of the MPI library that was loaded, "that of mpi4py" on several ranks; "" for none.
        missing: pairs (category, name) of those required styles that it lacks, in the order in which they were given.
    """

    version: int
    packages: tuple[str, ...]
    mpi: str
    missing: tuple[tuple[str, str], ...]


class Session:
    """One LAMMPS instance in one run folder; made by `Engine.session`.

    Attributes:
        folder: the run folder, the current one for every file name in a command.
        pid: process id of the worker.
        phase: the phase that runs or ran last.
        timestep: LAMMPS's step counter after the last request.
        steps: timesteps run and minimiser iterations, summed over the session.
        lammps_seconds: wall time spent inside LAMMPS [s].
        lammps_cpu_seconds: processor time spent there [s].
    """

    def __init__(self, worker: WorkerProcess, folder: Path, time_limit: float, progress: Progress) -> None:
        """Open a fresh instance in the folder. Use `Engine.session`, which also closes it.

        `time_limit`: wall time from now on after which LAMMPS is killed [s].

        Raises:
            EngineError: LAMMPS does not start.
        """
        self.folder, self.pid, self.phase = folder, worker.pid, "start"
        self.timestep = self.steps = 0
        self.lammps_seconds = self.lammps_cpu_seconds = 0.0
        self._worker, self._progress = worker, progress
        self._time_limit, self._deadline = time_limit, time.monotonic() + time_limit
        self._reported_steps, self._end_reason, self._commands = 0, "", ""
        self._ask("open", str(folder))

    def execute(
        self,
        text: str,
        phase: str | None = None,
        expected_steps: int | None = None,
        meanwhile: Meanwhile = None,
    ) -> None:
        """Run LAMMPS commands in the folder of the session.

        Args:
            text: any number of lines; `&` continues one, triple quotes may span several. `label`, `next` and
                `jump SELF` work in a file that it includes. "": begin the phase only.
            phase: name of what they do, for errors and progress; kept until the next one. None: as before.
            expected_steps: steps of the whole phase, for the progress; None where unknown.
            meanwhile: called once while LAMMPS runs, and takes no further time where LAMMPS takes longer; not for a
                text "".

        Raises:
            EngineError: LAMMPS failed, ran out of time or left a position that is not finite, or the session is over.
        """
        self._enter(phase, expected_steps)
        if text:
            self.measure(text, meanwhile=meanwhile)

    def values(self, *names: str) -> tuple[float, ...]:
        """Return several numbers, in the order of `names`, in units of the LAMMPS input, in one round trip.

        A name is that of an equal-style variable, or a LAMMPS formula.

        Raises:
            EngineError: one is unknown or not finite, or the session is over.
        """
        return self.measure("", names).values

    def measure(
        self,
        text: str,
        values: Sequence[str] = (),
        atoms: Sequence[str] = (),
        meanwhile: Meanwhile = None,
    ) -> Reading:
        """Run commands and return values and per-atom arrays, all in one round trip: one point of a curve.

        Args:
            text: LAMMPS commands; "" for none.
            values: names of equal-style variables, or LAMMPS formulas.
            atoms: names of per-atom arrays: properties ("x", "v", "f", "molecule"), computes ("c_opposite",
                "c_opposite[1]"), fixes ("f_…") and atom-style variables ("v_…"); "id" and "type" come with any, and
                without any the reading has none.
            meanwhile: called once while LAMMPS runs, and takes no further time where LAMMPS takes longer.

        Raises:
            EngineError: LAMMPS failed, ran out of time or left a position that is not finite; a number or array that
                was requested is unknown or not finite; the session is over.
        """
        self._commands = text
        numbers, arrays = self._ask("measure", text, tuple(values), tuple(atoms), meanwhile=meanwhile)
        return Reading(tuple(numbers), arrays)

    def measure_rows(
        self,
        texts: Sequence[str],
        values: Sequence[str] = (),
        atoms: Sequence[str] = (),
        meanwhile: Meanwhile = None,
    ) -> list[Reading]:
        """Return several points of a curve in one round trip: a reading after each text of LAMMPS commands, in this
        order.

        `values`, `atoms`: names of numbers and per-atom arrays, the same after each; `meanwhile` is called once while
        LAMMPS runs.

        Raises:
            EngineError: LAMMPS failed, ran out of time or left a position that is not finite; a number or array that
                was requested is unknown or not finite; the session is over. No reading is returned then.
        """
        self._commands = "".join(texts)
        answers = self._ask("measure_rows", tuple(texts), tuple(values), tuple(atoms), meanwhile=meanwhile)
        return [Reading(tuple(numbers), arrays) for numbers, arrays in answers]

    def about(self, styles: Sequence[tuple[str, str]] = ()) -> Installation:
        """Return version, packages and MPI library of LAMMPS, and which of the `styles` it lacks.

        `styles`: pairs of category and name such as ("fix", "rigid"); by default none are checked.

        Raises:
            EngineError: LAMMPS failed, or the session is over.
        """
        facts = self._ask("about", tuple(styles))
        return Installation(facts["version"], tuple(facts["packages"]), facts["mpi"], tuple(facts["missing"]))

    @property
    def taken(self) -> dict[str, float]:
        """Times in LAMMPS so far, "lammps_s" by the clock and "lammps_cpu_s" of its processors [s], and its "steps"."""
        return {"lammps_s": self.lammps_seconds, "lammps_cpu_s": self.lammps_cpu_seconds, "steps": self.steps}

    def close(self) -> None:
        """Close the instance and keep the process for the next session; nothing where the session failed or was closed.

        It may take 5 s past the time limit.

        Raises:
            EngineError: LAMMPS failed while it closed.
        """
        if not self._end_reason:
            self._deadline = max(self._deadline, time.monotonic() + 5.0)  # to close past the time limit, if need be
            self._ask("close")
            self._end_reason = "it was closed"
            give_back(self._worker)

    def _enter(self, phase: str | None, expected_steps: int | None) -> None:
        """Begin a phase of this name, and report it as progress.

        Nothing for None, and for the name of the phase that goes on without a number of `expected_steps`.
        """
        if phase is not None and (phase != self.phase or expected_steps is not None):
            self.phase = phase
            self._progress.phase(phase, expected_steps)

    def _ask(self, *request: Any, meanwhile: Meanwhile = None) -> Any:
        """Send a request to the worker and return its answer; any failure ends the session and kills the worker.

        An exception that is raised meanwhile, KeyboardInterrupt for instance, passes on and does the same.

        Raises:
            EngineError: LAMMPS failed, the worker died, the time limit passed, or the session is over.
        """
        if self._end_reason:
            raise EngineError(f"the session is over: {self._end_reason}", self.phase, self.timestep, self.folder, "")
        try:
            reply = self._worker.ask(request, self._deadline, self._tick, meanwhile)
        except WorkerLostError as lost:
            late = f"the run took longer than its time limit of {self._time_limit:g} s"
            self.timestep, self.steps = self._worker.board()
            raise self._failure(late if isinstance(lost, OutOfTimeError) else str(lost)) from None
        except BaseException as error:
            self._end_reason = f"it was interrupted by {type(error).__name__}"
            raise
        outcome, payload, self.timestep, self.steps, self.lammps_seconds, self.lammps_cpu_seconds = reply
        self._advance(self.steps)
        if outcome == "done":
            return payload
        self._worker.kill()
        raise self._failure(plain_message(payload, self._log(), self._commands) if outcome == "lammps" else payload)

    def _tick(self) -> None:
        """Report the steps of the session so far as progress, from the memory that the worker shares, while LAMMPS
        runs.
        """
        self._advance(self._worker.board()[1])

    def _advance(self, steps: int) -> None:
        """Report those of `steps`, the steps of the session so far, that are not yet reported as progress; nothing
        without any.
        """
        if steps > self._reported_steps:
            self._progress.advance(steps - self._reported_steps)
            self._reported_steps = steps

    def _failure(self, message: str, log_lines: int = 25) -> EngineError:
        """End the session for the reason `message`, and return the error to be raised.

        It has the last `log_lines` lines of the log, and up to 4000 bytes of the output of a worker that ended.
        """
        self._end_reason = message
        lines = self._log().splitlines()[-log_lines:] + self._worker.last_output.splitlines()
        tail = "\n".join(lines)
        return EngineError(message, self.phase, self.timestep, self.folder, tail)

    def _log(self, longest: int = 1_000_000) -> str:
        """Return the end of LAMMPS's log as text, at most `longest` bytes of it.

        "" where there is no log, and before the first phase, when the log may be that of an older run.
        """
        log = self.folder / LOG
        if self.phase == "start" or not log.is_file():  # before the start a log is an older run's
            return ""
        with log.open("rb") as file:
            file.seek(max(0, log.stat().st_size - longest))
            return file.read().decode(errors="replace")


class Engine:
    """The interface to LAMMPS. Worker processes are kept for later sessions and end with the program."""

    @staticmethod
    @contextmanager
    def session(
        folder: Path, time_limit: float = 3600.0, progress: Progress | None = None, ranks: int = 1
    ) -> Iterator[Session]:
        """Open a LAMMPS instance in a run folder for the length of a `with` block, which gets the session.

        It is closed at the end, and its process kept for later sessions.

        Args:
            folder: an existing folder; LAMMPS writes `log.lammps` there.
            time_limit: wall time from now on after which LAMMPS is killed [s].
            progress: informed of phases and steps; none by default. It is not closed here.
            ranks: number of MPI ranks, which share the bodies in slices along x.

        Raises:
            RanksError: several ranks, and what they need isn't installed.
            NotADirectoryError: there is no such folder.
            EngineError: LAMMPS does not start, or fails later.
        """
        folder = Path(folder).resolve()
        if not folder.is_dir():
            raise NotADirectoryError(f"the run folder {folder} does not exist")
        session = Session(borrow(ranks), folder, time_limit, progress or Silent())
        try:
            yield session
        except BaseException:
            with suppress(EngineError):
                session.close()
            raise
        session.close()
