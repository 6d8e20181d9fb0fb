"""A sweep file: a base scene and axes of values; its points are their product, or the axes side by side (zip).

Each point is a checked scene, named by the hash of what is in it.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.digits import cleaned
from contact1d.workflow.scene import Problem, Scene, SceneError, read_tables, scene_from_dict
from contact1d.workflow.scene.problems import nearest, shown
from contact1d.workflow.scene.read import plain_data, set_values
from contact1d.workflow.scene.si_text import UnitTextError, si_base

AnySweep = str | PathLike[str] | Mapping[str, Any]
"""What `read_sweep` makes a sweep of."""
KEYS = ("title", "scene", "base", "combine", "axes")
SPAN_KEYS = ("from", "to", "steps", "scale")
COMBINATIONS = ("product", "zip")
SCALES = ("linear", "log")
MOST_POINTS = 1_000_000
"""Points of a sweep: a day and a half of the quickest scenes."""


@dataclass(frozen=True)
class Axis:
    """A key of a scene, dotted, and its values, in order."""

    key: str
    values: tuple[Any, ...]

    @cached_property
    def numbers(self) -> tuple[tuple[float, ...], str]:
        """The values as numbers, of texts in SI, and the one unit of these; no numbers where some are words."""
        if all(map(_is_number, self.values)):
            return tuple(map(float, self.values)), ""
        try:
            numbers, units = zip(*(si_base(value) for value in self.values), strict=True)
        except (UnitTextError, AttributeError):
            return (), ""
        return (numbers, units[0]) if len(set(units)) == 1 else ((), "")


@dataclass(frozen=True)
class SweepPlan:
    """What a sweep file asks for.

    Attributes:
        title: of the sweep.
        base: tables of the base scene, unchecked: an axis may bring what it lacks.
        folder: where files that the base scene names are searched.
        axes: at least one.
        combine: "product": every value with every other, the last axis quickest; "zip": the first values together, the
            second ones, and so on.
    """

    title: str
    base: Mapping[str, Any]
    folder: Path
    axes: tuple[Axis, ...]
    combine: str

    def __len__(self) -> int:
        """How many points there are."""
        lengths = [len(axis.values) for axis in self.axes]
        return math.prod(lengths) if self.combine == "product" else lengths[0]

    def values(self) -> Iterator[tuple[Any, ...]]:
        """The values of each point, one for each axis."""
        columns = [axis.values for axis in self.axes]
        return itertools.product(*columns) if self.combine == "product" else iter(zip(*columns, strict=True))


Rule = tuple[bool, str, str, object, str]
"""A row of a table of rules: whether it is broken, where, what must be, what is given (None: nothing), what to do."""


def _broken(rules: Iterable[Rule]) -> list[Problem]:
    return [
        Problem(path, message, None if given is None else shown(given), hint)
        for broken, path, message, given, hint in rules
        if broken
    ]


def _unknown(table: Mapping[str, Any], allowed: Sequence[str], where: str = "") -> Iterator[Rule]:
    for key in table:
        meant = nearest(key, allowed)
        hint = f'did you mean "{meant}"? ' if meant else ""
        yield key not in allowed, where + key, "unknown key", None, f"{hint}allowed here: {', '.join(allowed)}"


def read_sweep(source: AnySweep) -> SweepPlan:
    """The sweep that a TOML file, its path given, or a mapping with the same keys describes.

    Raises:
        SceneError: every problem of the sweep file; or those of the base scene's file, if it can't be read.
    """
    tables = plain_data(source) if isinstance(source, Mapping) else read_tables(source)
    folder = Path.cwd() if isinstance(source, Mapping) else Path(source).parent
    title, combine, given = tables.get("title", ""), tables.get("combine", "product"), tables.get("axes")
    scene, base = tables.get("scene"), tables.get("base")
    listed = isinstance(given, Sequence) and not isinstance(given, str)
    problems = _broken(
        [
            *_unknown(tables, KEYS),
            (not isinstance(title, str), "title", "must be text", title, ""),
            (combine not in COMBINATIONS, "combine", 'must be "product" or "zip"', combine, ""),
            (given is None or given == [], "axes", "missing", None,
             'write [[axes]] with key = "bodies.profile.radius" and values'),
            (given is not None and not listed, "axes", "must be written as [[axes]], in double brackets, one for each",
             given, ""),
            (scene is not None and base is not None, "scene", "not together with [base]", None,
             "give a scene file, or the scene's tables under [base]"),
            (scene is None and base is None, "scene", "missing", None,
             "give a scene file, or the scene's tables under [base]"),
            (not isinstance(scene, str | None), "scene", "must be the name of a scene file", scene, ""),
            (not isinstance(base, Mapping | None), "base", "must be a table of a scene's tables", base,
             "write [base.bodies], …"),
        ]
    )  # fmt: skip
    axes = [_axis(table, f"axes[{i}]", problems) for i, table in enumerate(given if listed and given else ())]
    problems += _broken(_shape(axes, combine)) if not problems else []
    if problems:
        raise SceneError(problems)
    if isinstance(scene, str):
        base, folder = read_tables(folder / scene), (folder / scene).parent
    assert base is not None
    return SweepPlan(title, base, folder, tuple(axes), combine)


def _shape(axes: Sequence[Axis], combine: str) -> Iterator[Rule]:
    """What must hold of the axes together."""
    keys, lengths = [axis.key for axis in axes], [len(axis.values) for axis in axes]
    for i, key in enumerate(keys):
        yield key in keys[:i], f"axes[{i}].key", "another axis has the same key", key, ""
    words = ", ".join(map(str, lengths))
    uneven = combine == "zip" and len(set(lengths)) > 1
    yield uneven, "combine", f'"zip" needs axes of one length, they have {words} values', None, ""
    count, product = math.prod(lengths), " × ".join(map(str, lengths))
    many = combine == "product" and count > MOST_POINTS
    yield many, "axes", f"{product} = {count} points are more than {MOST_POINTS}", None, "use fewer values"


def _axis(table: Any, where: str, problems: list[Problem]) -> Axis:
    """An axis, and what is wrong with it; without values then."""
    if not isinstance(table, Mapping):
        problems += _broken([(True, where, "must be a table with key and values", table, "")])
        return Axis("", ())
    key, named = table.get("key"), [name for name in SPAN_KEYS if name in table]
    values: Any = table.get("values")
    values = values.tolist() if hasattr(values, "tolist") else values
    listed = isinstance(values, Sequence) and not isinstance(values, str)
    must = "missing" if key is None else "must be a key of the scene"
    missing = [name for name in ("from", "to", "steps") if name not in table]
    at = f"{where}.values"
    found = _broken(
        [
            *_unknown(table, ("key", "values", *SPAN_KEYS), f"{where}."),
            (not isinstance(key, str) or not key, f"{where}.key", must, key, "such as noise.seed"),
            (values is not None and bool(named), at, f"not together with {', '.join(named)}", None, "give the one"),
            (values is not None and not listed, at, "must be a list", values, ""),
            (listed and not values, at, "is empty: the sweep would have no point", None, ""),
            (values is None and bool(missing), where, f"lacks {', '.join(missing)}", None,
             "give values, or from, to and steps"),
        ]
    )  # fmt: skip
    if not found and values is None:
        values = _span(table, where, found)
    problems += found
    return Axis(str(key), tuple(values) if values is not None and not found else ())


def _span(table: Mapping[str, Any], where: str, problems: list[Problem]) -> tuple[Any, ...]:
    """steps + 1 values, both ends exact; whole numbers where all of a linear span are; texts where the ends are."""
    given, steps, scale = (table["from"], table["to"]), table["steps"], table.get("scale", "linear")
    ends, unit = Axis("", given).numbers
    texts = all(isinstance(end, str) for end in given)
    must = (
        'must have the same dimension at both ends, such as "500 µm" and "5 mm"' if texts else "must be a finite number"
    )
    whole = isinstance(steps, int) and not isinstance(steps, bool) and 1 <= steps < MOST_POINTS
    problems += _broken(
        [
            *((not ends and not _is_number(end), f"{where}.{name}", must, end, "")
              for name, end in zip(("from", "to"), given, strict=True)),
            (not whole, f"{where}.steps", f"must be a whole number from 1 to {MOST_POINTS - 1}", steps, ""),
            (scale not in SCALES, f"{where}.scale", 'must be "linear" or "log"', scale, ""),
            (scale == "log" and min(ends, default=1.0) <= 0.0, f"{where}.scale", "log needs from and to above 0",
             scale, ""),
        ]
    )  # fmt: skip
    if problems:
        return ()
    start, end = ends if unit else given
    if scale == "linear" and isinstance(start, int) and isinstance(end, int) and (end - start) % steps == 0:
        return tuple(start + i * ((end - start) // steps) for i in range(steps + 1))
    inner = map(cleaned, (np.linspace if scale == "linear" else np.geomspace)(start, end, steps + 1)[1:-1])
    if unit:
        return given[0], *(f"{value!r} {unit}" for value in inner), given[1]
    return float(start), *inner, float(end)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


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
            yield Point(values, None, "", str(error).replace("\n", "; "))
        else:
            yield Point(values, scene, name_of(scene))


def require_keys(plan: SweepPlan) -> None:
    """Check that each axis is a key of the scene. Raises SceneError; wrong values are errors of their points."""
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
    content = {name: table for name, table in scene.tables.items() if name != "title"}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:NAME_LENGTH]


def _scene(plan: SweepPlan, values: tuple[Any, ...]) -> Scene:
    tables = deepcopy(dict(plan.base))
    keys = [axis.key for axis in plan.axes]
    if problems := set_values(tables, dict(zip(keys, values, strict=True))):
        raise SceneError(problems)
    return scene_from_dict(tables, folder=plan.folder)


def _is_of_axis(path: str, keys: list[str]) -> bool:
    return any(key == path or key.startswith(f"{path}.") for key in keys)
