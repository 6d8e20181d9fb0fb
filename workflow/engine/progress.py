"""The progress of a run: a bar on a terminal, a few plain lines elsewhere, or nothing.

phase(name, expected_steps) ──▶ advance(steps) … ──▶ close()
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, TextIO

Meanwhile = Callable[[], object] | None
"""What to do while LAMMPS works; None: nothing."""


class Progress:
    """A listener to a run, which shows nothing by itself."""

    def phase(self, name: str, expected_steps: int | None = None, counted: str = "step") -> None:
        """Begin a phase called `name`, of `expected_steps` steps; None where the number is unknown.

        `counted`: singular noun for what is counted in place of steps.
        """

    def advance(self, steps: int) -> None:
        """Note that this number of further steps of the phase is done."""

    def note(self, text: str) -> None:
        """Show one line of text."""

    def close(self) -> None:
        """End the display of the run."""


class Silent(Progress):
    """A listener that shows nothing."""


class Lines(Progress):
    """Plain lines for a log file or a pipe: one at the start of a phase, then at most one every few seconds.

    To close it does nothing: the stream belongs to the caller.

    Args:
        stream: where to write.
        quiet: least time between two lines of a phase [s].
    """

    def __init__(self, stream: TextIO, quiet: float = 5.0) -> None:
        """Store the stream; the first phase writes the first line."""
        self._stream, self._quiet = stream, quiet
        self._name, self._expected, self._done, self._counted = "", None, 0, "step"
        self._start = self._last = time.monotonic()

    _expected: int | None

    def phase(self, name: str, expected_steps: int | None = None, counted: str = "step") -> None:
        """Write one line at once: the name, and the number of steps if known, "name: 100 steps"; `counted` replaces
        "step".
        """
        self._name, self._expected, self._done, self._counted = name, expected_steps, 0, counted
        self._start = self._last = time.monotonic()
        self.note(name if expected_steps is None else f"{name}: {expected_steps} {counted}s")

    def advance(self, steps: int) -> None:
        """Count further steps; write a line if the last one of the phase, notes excepted, is `quiet` seconds old.

        It has the count, and where the number of steps is known and not exceeded also that number, the mean rate of the
        phase [1/s] and the expected time left [s].
        """
        self._done += steps
        now = time.monotonic()
        if now - self._last < self._quiet:
            return
        self._last = now
        share = ""
        if self._expected and 0 < self._done <= self._expected:
            rate = self._done / (now - self._start)
            share = (
                f" of {self._expected}, {rate:.3g} a second, about {(self._expected - self._done) / rate:.0f} s left"
            )
        self.note(f"{self._name}: {self._counted} {self._done}{share}")

    def note(self, text: str) -> None:
        """Write the line at once, however new the last one is."""
        print(text, file=self._stream, flush=True)


class Bar(Progress):
    """A bar on a terminal: phase, steps, their rate, expected remaining time.

    Args:
        stream: the terminal.
    """

    def __init__(self, stream: TextIO) -> None:
        """Load rich and show nothing yet."""
        from rich.console import Console
        from rich.progress import (
            BarColumn,
            MofNCompleteColumn,
            Progress,
            ProgressColumn,
            TextColumn,
            TimeRemainingColumn,
        )
        from rich.text import Text

        class Rate(ProgressColumn):
            """The rate of the counted steps, per second."""

            def render(self, task: Any) -> Text:
                """Return the rate as text, "12.3/s"; empty where it is not known yet."""
                return Text("" if task.speed is None else f"{task.speed:.3g}/s")

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), Rate(), TimeRemainingColumn())
        self._rich = Progress(*columns, console=Console(file=stream), transient=True)
        self._task: Any = None

    def phase(self, name: str, expected_steps: int | None = None, counted: str = "step") -> None:
        """Replace the bar by that of the new phase; without a known number of steps it has no end. `counted` is not
        used.
        """
        self._drop()
        self._rich.start()
        self._task = self._rich.add_task(name, total=expected_steps)

    def advance(self, steps: int) -> None:
        """Move the bar by this number of steps; nothing before the first phase and after `close`."""
        if self._task is not None:
            self._rich.advance(self._task, steps)

    def note(self, text: str) -> None:
        """Print a line above the bar."""
        self._rich.console.print(text, markup=False, highlight=False)

    def close(self) -> None:
        """Remove the bar and give the terminal back; a later phase would show a bar again."""
        self._drop()
        self._rich.stop()

    def _drop(self) -> None:
        """Remove the bar of the phase, if there is one."""
        if self._task is not None:
            self._rich.remove_task(self._task)
            self._task = None


def choose_progress(stream: TextIO | None = None) -> Progress:
    """Return a `Bar` if the stream is a terminal, otherwise `Lines` of plain text; None stands for standard error."""
    stream = stream or sys.stderr
    return Bar(stream) if stream.isatty() else Lines(stream)
