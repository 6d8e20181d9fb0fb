"""The points of a sweep: each a checked scene, named by the hash of what is in it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any

from contact1d.workflow.scene import Scene, SceneError, scene_from_dict
from contact1d.workflow.scene.read import set_values
from contact1d.workflow.sweep.axes import SweepPlan

NAME_LENGTH = 16
"""Hexadecimal digits of a point's name: of a million points two are alike with a chance of 3e-8."""
UNKNOWN = ("unknown key", "unknown table", "not a path of keys")


@dataclass(frozen=True)
class Point:
    """A point: the value of each axis, its scene, its name; or, without a scene, why it can't be one."""

    values: tuple[Any, ...]
    scene: Scene | None
    name: str
    reason: str = ""


def points(plan: SweepPlan) -> Iterator[Point]:
    """The points in order, made one by one."""
    for values in plan.values():
        try:
            scene = _scene(plan, values)
        except SceneError as error:
            yield Point(values, None, "", "; ".join(str(problem) for problem in error.problems))
        else:
            yield Point(values, scene, name_of(scene))


def require_keys(plan: SweepPlan) -> None:
    """See that each axis is a key of the scene. Raises SceneError; values that are wrong are a point's own matter."""
    try:
        _scene(plan, next(plan.values()))
    except SceneError as error:
        keys = [axis.key for axis in plan.axes]
        wrong = [
            problem
            for problem in error.problems
            if problem.path.startswith("set ") or (problem.message in UNKNOWN and _is_of_axis(problem.path, keys))
        ]
        if wrong:
            raise SceneError(wrong) from None


def name_of(scene: Scene) -> str:
    """SHA-256 of everything in the scene that is more than a title, shortened."""
    content: Mapping[str, Any] = scene.model_dump(mode="json", by_alias=True, exclude_none=True, exclude={"title"})
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:NAME_LENGTH]


def _scene(plan: SweepPlan, values: tuple[Any, ...]) -> Scene:
    tables = deepcopy(dict(plan.base))
    keys = [axis.key for axis in plan.axes]
    if problems := set_values(tables, dict(zip(keys, values, strict=True))):
        raise SceneError(problems)
    return scene_from_dict(tables, folder=plan.folder)


def _is_of_axis(path: str, keys: list[str]) -> bool:
    return any(key == path or key.startswith(f"{path}.") for key in keys)
