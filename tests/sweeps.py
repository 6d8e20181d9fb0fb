"""A sweep of a quick scene, executors that keep what they are given, and what is no results.json of a run."""

import csv
import json
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

from tests.scenes import chains

PLANE = chains(
    100.0, 1.0, title="on a plane", interaction=None, bodies={"particles": 41, "lower": "rigid_plane"},
    experiment={"kind": "load", "force": 1.0},
)  # fmt: skip
RADIUS = "bodies.profile.radius"
FORCE = "experiment.force"
RADIUS_IN_WORDS = "radius of curvature R at the apex"


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
            future.set_result(self.run(fn, *args))
        except Exception as error:
            future.set_exception(error)
        return future

    def run(self, fn: Any, tasks: Any) -> Any:
        """Run tasks, each a scene and a folder."""
        return fn(tasks)


class Lost(Here):
    """Runs nothing, as a node of a cluster that is lost."""

    def run(self, fn: Any, tasks: Any) -> Any:
        raise RuntimeError("the node is lost")


class Stated(Here):
    """Leaves runs with stated displacements [LU] and uncertainties, in turn, beside the other results of a run."""

    def __init__(self, document: Mapping[str, Any], stated: Iterable[tuple[float, float]]) -> None:
        super().__init__()
        self.document, self.stated = document, iter(stated)

    def run(self, fn: Any, tasks: Any) -> Any:
        for (_, folder), (value, uncertainty) in zip(tasks, self.stated, strict=False):
            entry = {"value": value, "uncertainty": uncertainty, "unit": "LU"}
            folder.mkdir(parents=True)
            (folder / "results.json").write_text(json.dumps(self.document | {"displacement": entry, "theory": []}))
        raise RuntimeError("the job ended without its answer")


def rows(folder: Path) -> list[dict[str, str]]:
    """The table of a sweep."""
    with (folder / "results.csv").open(newline="", encoding="utf-8") as file:
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
    "empty": lambda _: "", "half": lambda whole: json.dumps(whole)[:-200],
    "a list": lambda _: "[1, 2]", "nested": lambda _: "[" * 5000 + "]" * 5000, "digits": with_force(value=10**400),
    "NaN": with_force(value=float("nan")), "Infinity": with_force(uncertainty=float("inf")),
    "truth for a number": with_force(value=True), "no uncertainty": changed(force={"value": 1.0, "unit": "FU"}),
    "no unit": with_force(unit=None), "another status": changed(status="well"), "no error": changed(status="failed"),
    "an error without words": changed(status="failed", error={}), "no scene": lacking("scene"),
    "no warnings": lacking("warnings"), "other warnings": changed(warnings=[3]), "other times": changed(timing=3),
    "a theory without values": changed(theory=[{"name": "Hertz"}]), "an accuracy in words": changed(accuracy="high"),
}  # fmt: skip
"""What is no results.json of a run, made of one that is."""
