"""A sweep of a quick scene, and executors that keep what they are given."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

from contact1d.workflow.sweep.table import TABLE, Answer

PLANE: dict[str, Any] = {
    "title": "on a plane",
    "bodies": {
        "particles": 41, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 1.0,
        "lower": "rigid_plane",
    },
    "experiment": {"kind": "load", "force": 1.0},
}  # fmt: skip
RADIUS = "bodies.profile.radius"
FORCE = "experiment.force"


def plane(*axes: Mapping[str, Any], **more: Any) -> dict[str, Any]:
    """A sweep of a quick scene."""
    return {"title": "a sweep", "base": PLANE, "axes": list(axes)} | more


def axis(key: str, *values: Any) -> dict[str, Any]:
    """An axis of a sweep file."""
    return {"key": key, "values": list(values)}


class Here(Executor):
    """Runs at once, in this process, and keeps what it was given."""

    def __init__(self) -> None:
        self.given: list[str] = []

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given += [path.name for _, path in args[0]]
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


class Stub(Here):
    """Answers without running anything."""

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        return super().submit(lambda tasks: [Answer("failed", "a stub")] * len(tasks), *args)


def rows(folder: Path) -> list[dict[str, str]]:
    """The table of a sweep."""
    with (folder / TABLE).open(newline="") as file:
        return list(csv.DictReader(file))
