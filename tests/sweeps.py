"""A sweep of a quick scene, and executors that keep what they are given."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable, Mapping
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


Document = dict[str, Any]


def changed(**keys: Any) -> Callable[[Document], str]:
    """Makes of what results.json holds its text with other keys."""
    return lambda whole: json.dumps(whole | keys)


def with_force(**keys: Any) -> Callable[[Document], str]:
    """Makes of what results.json holds its text with other keys of the force."""
    return lambda whole: json.dumps(whole | {"force": whole["force"] | keys})


def lacking(key: str) -> Callable[[Document], str]:
    """Makes of what results.json holds its text without a key."""
    return lambda whole: json.dumps({name: value for name, value in whole.items() if name != key})


BROKEN: dict[str, Callable[[Document], str]] = {
    "empty": lambda _: "", "half": lambda whole: json.dumps(whole)[:-200], "words": lambda _: "results",
    "a table": lambda _: "{}", "a list": lambda _: "[1, 2]", "null": lambda _: "null", "a text": lambda _: '"done"',
    "nested": lambda _: "[" * 5000 + "]" * 5000, "digits": with_force(value=10**400),
    "NaN": with_force(value=float("nan")), "Infinity": with_force(uncertainty=float("inf")),
    "words for a number": with_force(value="1.0"), "truth for a number": with_force(value=True),
    "no uncertainty": changed(force={"value": 1.0, "unit": "FU"}), "no unit": with_force(unit=None),
    "no status": lacking("status"), "another status": changed(status="well"), "no error": changed(status="failed"),
    "an error without words": changed(status="failed", error={}), "no scene": lacking("scene"),
    "no warnings": lacking("warnings"), "other warnings": changed(warnings=[3]), "other times": changed(timing=3),
    "a theory without values": changed(theory=[{"name": "Hertz"}]), "an accuracy in words": changed(accuracy="high"),
}  # fmt: skip
"""What is no results.json of a run, made of one that is."""
