"""A study: which runs it needs, and what it makes of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene
from validation.judging.check import Check, Evidence

Scenes = dict[str, Scene]
Runs = Mapping[str, Run]


@dataclass(frozen=True)
class Findings:
    """What a study found: text, rows, figures {file name: caption}."""

    finding: str
    checks: Sequence[Check]
    figures: Mapping[str, str]


@dataclass(frozen=True)
class Study:
    """One statement of the paper, or several that belong together.

    Attributes:
        name: of the rows, the figure and `--only`.
        title: one line.
        statement: what the paper says, in our words.
        scenes: (the paper's scene) to the runs that are needed, by name. Studies may share runs.
        judge: (the paper's scene, the runs, folder for figures) to the findings.
    """

    name: str
    title: str
    statement: str
    scenes: Callable[[Scene], Scenes]
    judge: Callable[[Scene, Runs, Path], Findings]


@dataclass(frozen=True)
class Rows:
    """Makes the rows of a study, each with the runs that it rests on and their warnings."""

    study: str
    runs: Runs

    def __call__(
        self,
        name: str,
        value: float,
        uncertainty: float,
        unit: str,
        reference: float,
        source: str,
        evidence: Evidence,
        tolerance: float,
        limited_by: str,
        *,
        on: Sequence[str],
        despite: Mapping[str, str] | None = None,
        **more: Any,
    ) -> Check:
        """A `Check`; `on`: names of its runs, `despite`: why it stands beside a warning of theirs, by name."""
        found = {warning for run in on for warning in warnings(self.runs[run])}
        answers = {warning: (despite or {}).get(warning, "") for warning in sorted(found)}
        return Check(
            self.study, name, value, uncertainty, unit, reference, source, evidence, tolerance, limited_by,
            runs=tuple(on), warnings=answers, **more,
        )  # fmt: skip


def warnings(run: Run) -> tuple[str, ...]:
    """Names of a run's warnings; one that failed may have none."""
    return tuple(str(warning["name"]) for warning in run.document.get("warnings", ()))


def repeated(check: Check) -> Check:
    """The row, marked as one that says what another says."""
    return replace(check, standing="repeats")
