"""Finished runs that rows rest on: the one that is there already, and a result of it."""

from __future__ import annotations

from pathlib import Path

from contact1d.workflow.errors import FolderError
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.runs.report import versions
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity

NOTHING = Quantity(float("nan"), float("nan"), "")
"""Stands for a result of a run that failed."""


def found(run: Run, name: str) -> Quantity:
    """A result; NaN where the run has none, since it failed."""
    return run.results.get(name, NOTHING)


def there(scene: Scene, folder: Path) -> Run | None:
    """The run in `folder`, if it is of this scene and of these versions, and whole."""
    try:
        run = read_run(folder)
    except FolderError:
        return None
    return run if run.scene == scene and run.document.get("versions") == versions() else None
