"""What a class of hard cases is: a question, and a measurement that answers it with rows (`Check`) and one figure.

A bound never comes from the program itself. A row whose number is an error over what the run claims passes at 1 or
less; a case that the program refuses in words has no number and is counted by a row of its own.
"""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import SceneError, scene_from_dict
from contact1d.workflow.settings.settings import SettingsError
from validation.judging.check import Check, Evidence
from validation.judging.runs import found as result
from validation.judging.runs import there

LONGEST = 160
"""Characters of a refusal in a row."""
PATIENCE, FULL_PATIENCE = 180, 3600
"""Seconds of a run, LAMMPS and all else: what hangs has failed. The long form goes on beside other work for hours."""


class LateError(Exception):
    """A run took too long."""


@contextmanager
def at_most_seconds(seconds: float, of_processor: bool = False) -> Iterator[None]:
    """Raise LateError after so many seconds of the clock, or of the work of this process alone.

    For the main thread of a process, which alone hears of signals.
    """

    def late(*_: object) -> None:
        raise LateError

    timer, heard = (signal.ITIMER_PROF, signal.SIGPROF) if of_processor else (signal.ITIMER_REAL, signal.SIGALRM)
    before = signal.signal(heard, late)
    signal.setitimer(timer, seconds)
    try:
        yield
    finally:
        signal.setitimer(timer, 0.0)
        signal.signal(heard, before)


@dataclass(frozen=True)
class Refused:
    """A run that gave no number: why, in the program's words, and whether before anything ran (exit 2, not 3)."""

    words: str
    before: bool


@dataclass(frozen=True)
class Bench:
    """Where a class measures.

    Attributes:
        folder: of its run folders.
        full: whether the long form is asked for.
        patience: wall time of a run [s].
    """

    folder: Path
    full: bool
    patience: int = PATIENCE

    def run(self, name: str, scene: dict[str, Any]) -> Run | Refused:
        """The finished run of a scene, made now or there already, or the words with which it was refused."""
        folder = self.folder / name
        try:
            with at_most_seconds(self.patience):
                return self._run(name, scene, folder)
        except LateError:
            return Refused(f"nothing was said for {self.patience} s", before=False)

    def _run(self, name: str, scene: dict[str, Any], folder: Path) -> Run | Refused:
        try:
            checked = scene_from_dict({"title": name} | scene)
            found = there(checked, folder)
            if found is None:
                run(checked, folder, figures=False, progress=Silent(), time_limit=float(self.patience))
                found = there(checked, folder)
        except (SceneError, SettingsError, FolderError) as error:
            return Refused(str(error), before=True)
        except RunError as error:
            return Refused(error.message, before=False)
        assert found is not None
        return found if found.status == "done" else Refused(str(found.document["error"]["message"]), before=False)


@dataclass(frozen=True)
class Findings:
    """The rows of a class, its figure (file beside stability.json) and what the figure shows."""

    checks: Sequence[Check]
    figure: str
    caption: str


@dataclass(frozen=True)
class Class:
    """One kind of hard case.

    Attributes:
        name: of its rows, its figure and `--only`.
        title: one line.
        question: what goes wrong here in a program that is not careful.
        measure: (where to run, folder of the figure) to what was found.
    """

    name: str
    title: str
    question: str
    measure: Callable[[Bench, Path], Findings]


def said(limited_by: str, found: Run | Refused) -> str:
    """What a row says about its limit: that of its number, or the words of a refusal in its place."""
    if not isinstance(found, Refused):
        return limited_by
    return f"refused {'before anything ran' if found.before else 'in the run'}: {found.words[:LONGEST]}"


def warned(finished: Run) -> set[str]:
    """Names of a run's warnings."""
    return set(finished.warnings)


def over_claim(finished: Run, name: str, exact: float, slack: float = 0.0) -> float:
    """|value − exact| over the claimed uncertainty; NaN where the run has no such quantity.

    `slack`: relative error of the reference, which is taken off.
    """
    error = max(0.0, abs(result(finished, name).value - exact) - slack * abs(exact))
    claimed = result(finished, name).uncertainty
    if math.isnan(error) or math.isnan(claimed):
        return math.nan
    return error / claimed if claimed > 0.0 else (0.0 if error == 0.0 else math.inf)


def over_tolerance(finished: Run, name: str, exact: float, tolerance: float, slack: float = 0.0) -> float:
    """The same over the tolerance that was asked for; 0 where the run says that it is not reached."""
    if "tolerance" in warned(finished):
        return 0.0
    return max(0.0, abs(result(finished, name).value / exact - 1.0) - slack) / tolerance


def worst(values: Iterable[float]) -> float:
    """The largest; NaN, which fails, where one is NaN or there is none. An infinite error is NaN too: JSON has none."""
    listed = list(values)
    if not listed or not all(map(math.isfinite, listed)):
        return math.nan
    return max(listed)


def at_most(
    name: str,
    case: str,
    value: float,
    bound: float,
    source: str,
    limited_by: str,
    evidence: Evidence = "closed form",
    unit: str = "1",
) -> Check:
    """A row that passes where `value` ≤ `bound`."""
    return Check(name, case, value, 0.0, unit, bound, source, evidence, 0.0, limited_by, "at most")
