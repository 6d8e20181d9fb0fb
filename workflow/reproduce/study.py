"""A study: which runs it needs, and what it makes of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from contact1d.workflow.reproduce.check import Check
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene

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


def checker(study: str) -> partial[Check]:
    """A `Check` of that study, for the rest of its fields."""
    return partial(Check, study)
