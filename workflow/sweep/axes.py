"""A sweep file: a base scene and axes of values; its points are their product, or the axes side by side (zip).

Each point is a checked scene, named by the hash of its content.
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
from contact1d.workflow.scene import Problem, Scene, SceneError, read_scene, read_tables
from contact1d.workflow.scene.file_kinds import require_kind
from contact1d.workflow.scene.problems import as_toml, shown, suggestion
from contact1d.workflow.scene.read import plain_data, set_values
from contact1d.workflow.scene.si_text import UnitTextError, si_base

AnySweep = str | PathLike[str] | Mapping[str, Any]
"""A sweep file, by its path, or its tables."""
KEYS = ("title", "scene", "base", "combine", "axes")
SPAN_KEYS = ("from", "to", "steps", "scale")
COMBINATIONS = ("product", "zip")
SCALES = ("linear", "log")
MOST_POINTS = 1_000_000
"""Largest number of points of a sweep: a day and a half of the quickest scenes."""


@dataclass(frozen=True)
class Axis:
    """An axis of a sweep.

    Attributes:
        key: of a scene, dotted.
        values: of that key, in order: numbers, texts with units, words, tables or lists.
    """

    key: str
    values: tuple[Any, ...]

    @cached_property
    def numbers(self) -> tuple[tuple[float, ...], str]:
        """The values as (numbers, their common unit), ((0.001, 2e-06), "m") of "1 mm" and "2 µm"; cached.

        Numbers stay, with the unit "". Texts with units are converted to the unit of SI of their dimension ("m", "N",
        "J"; "1" of a percentage), so that mm and µm do not differ; but angles, and dimensions without a name in
        `si_text`, keep number and unit, 80.0 and "°". ((), "") if a value is neither a finite number nor a text with a
        unit, if numbers and texts are mixed, or if the units so obtained differ, as ° and rad.
        """
        if all(map(_is_number, self.values)):
            return tuple(map(float, self.values)), ""
        try:
            numbers, units = zip(*(si_base(value) for value in self.values), strict=True)
        except (UnitTextError, AttributeError):
            return (), ""
        return (numbers, units[0]) if len(set(units)) == 1 else ((), "")

    @cached_property
    def cells(self) -> tuple[Any, ...]:
        """The values as cells of the table: floats, in base units of SI if they are texts with units; cached.

        That is where all are finite numbers, or all are texts with one unit in SI. Else numbers and texts, also with
        units, are left as they are, and others (True, False, tables, lists) become text in TOML.
        """
        return self.numbers[0] or tuple(
            value if isinstance(value, str | int | float) and not isinstance(value, bool) else as_toml(value)
            for value in self.values
        )


@dataclass(frozen=True)
class SweepPlan:
    """The points that a sweep file describes.

    Attributes:
        title: title of the sweep.
        base: tables of the base scene, unchecked: an axis may add what they lack.
        folder: folder to which paths in the base scene are relative.
        axes: at least one axis.
        combine: "product": every value with every other, the last axis quickest; "zip": the first values together, the
            second ones, and so on.
    """

    title: str
    base: Mapping[str, Any]
    folder: Path
    axes: tuple[Axis, ...]
    combine: str

    def __len__(self) -> int:
        """Return the number of points: the product of the numbers of values, or zipped that of the first axis."""
        lengths = [len(axis.values) for axis in self.axes]
        return math.prod(lengths) if self.combine == "product" else lengths[0]

    def values(self) -> Iterator[tuple[Any, ...]]:
        """Yield the values of each point in order, a tuple with one for each axis, as the sweep file has them."""
        return self._combined(axis.values for axis in self.axes)

    def cells(self) -> Iterator[tuple[Any, ...]]:
        """Yield the values of each point in order as cells of the table, a tuple with one for each axis.

        Those of an axis of numbers are floats; those of an axis of texts with one unit in SI are floats in base units
        of SI. Other numbers and texts are as they are, tables, lists, True and False as text in TOML.
        """
        return self._combined(axis.cells for axis in self.axes)

    def _combined(self, columns: Iterable[tuple[Any, ...]]) -> Iterator[tuple[Any, ...]]:
        """Yield a tuple of one item of each column for each point: all combinations, the last column quickest, or zip.

        Raises:
            ValueError: side by side (zip), at the end of the shortest column, where the columns have different lengths.
        """
        return itertools.product(*columns) if self.combine == "product" else zip(*columns, strict=True)


Rule = tuple[bool, str, str, object, str]
"""A rule of a sweep file: whether it is broken, the key, the message, what is given (None: nothing), the fix."""


def _broken(rules: Iterable[Rule]) -> list[Problem]:
    """Return a `Problem` for each rule that is broken, in their order, with the given value in TOML; [] without any."""
    return [
        Problem(path, message, None if given is None else shown(given), hint)
        for broken, path, message, given, hint in rules
        if broken
    ]


def read_sweep(source: AnySweep) -> SweepPlan:
    """Return the sweep that a TOML file, by its path, or a mapping with the keys of such a file describes.

    The base scene is not checked. Paths in it are relative to the folder of the sweep file, for a mapping to the
    current one; where the sweep names a scene file, to the folder of that.

    Raises:
        SceneError: all problems of the sweep file; or those of the base scene's file, if it can't be read.
    """
    tables = plain_data(source) if isinstance(source, Mapping) else read_tables(source)
    require_kind(tables, "sweep file", source)
    folder = Path.cwd() if isinstance(source, Mapping) else Path(source).parent
    problems = _broken(_of_file(tables))
    given: Any = tables.get("axes") if _is_list(tables.get("axes")) else ()
    combine = tables.get("combine", "product")
    for i, table in enumerate(given):
        problems += _broken(_of_axis(table, f"axes[{i}]"))
    if not problems:
        axes = [Axis(table["key"], tuple(table.get("values") or _span(table))) for table in given]
        problems = _broken(_of_axes(axes, combine))
    if problems:
        raise SceneError(problems)
    base = tables.get("base")
    if base is None:
        file = folder / tables["scene"]
        base, folder = read_tables(file), file.parent
    return SweepPlan(tables.get("title", ""), base, folder, tuple(axes), combine)


def _of_file(tables: Mapping[str, Any]) -> Iterator[Rule]:
    """Yield each rule of the keys at the top of a sweep file, broken or not; none of the content of an axis.

    A rule is (whether it is broken, key, what is wrong, value given or None, suggested fix).
    """
    title, combine, axes = tables.get("title", ""), tables.get("combine", "product"), tables.get("axes")
    scene, base = tables.get("scene"), tables.get("base")
    one_base = "give a scene file, or the scene's tables under [base]"
    yield from _unknown(tables, KEYS)
    yield not isinstance(title, str), "title", "must be text", title, ""
    yield combine not in COMBINATIONS, "combine", 'must be "product" or "zip"', combine, ""
    write_axes = 'write [[axes]] with key = "bodies.profile.radius" and values'
    yield axes is None or axes == [], "axes", "missing", None, write_axes
    double = "must be written as [[axes]], in double brackets, one for each"
    yield axes is not None and not _is_list(axes), "axes", double, axes, ""
    yield scene is not None and base is not None, "scene", "not together with [base]", None, one_base
    yield scene is None and base is None, "scene", "missing", None, one_base
    yield not isinstance(scene, str | None), "scene", "must be the name of a scene file", scene, ""
    form = "write [base.bodies], …"
    yield not isinstance(base, Mapping | None), "base", "must be a table of a scene's tables", base, form


def _unknown(table: Mapping[str, Any], allowed: Sequence[str], where: str = "") -> Iterator[Rule]:
    """Yield a rule for each key of a table, broken where the key is not among the `allowed` ones.

    A rule is (whether it is broken, key, what is wrong, None, suggested fix). `where` precedes the name of the key in
    its path, such as "axes[0].".
    """
    for key in table:
        yield key not in allowed, where + key, "unknown key", None, suggestion(key, allowed)


def _of_axis(table: Any, where: str) -> Iterator[Rule]:
    """Yield each rule of the table of one axis, broken or not; only one, broken, where it is no table.

    A rule is (whether it is broken, key, what is wrong, value given or None, suggested fix). Those of the ends (from,
    to, steps, scale) are yielded only without `values`, and one broken rule in place of them where an end or steps is
    missing. `where`: its path in the sweep file, such as axes[0].
    """
    if not isinstance(table, Mapping):
        yield True, where, "must be a table with key and values", table, ""
        return
    key, values = table.get("key"), table.get("values")
    yield from _unknown(table, ("key", "values", *SPAN_KEYS), f"{where}.")
    must = "missing" if key is None else "must be a key of the scene"
    yield not isinstance(key, str) or not key, f"{where}.key", must, key, "such as noise.seed"
    named = [name for name in SPAN_KEYS if name in table]
    missing = [name for name in SPAN_KEYS[:3] if name not in table]
    if values is not None:
        path = f"{where}.values"
        yield bool(named), path, f"not together with {', '.join(named)}", None, "give one of the two"
        yield not _is_list(values), path, "must be a list", values, ""
        yield _is_list(values) and not values, path, "is empty: the sweep would have no point", None, ""
    elif missing:
        yield True, where, f"lacks {', '.join(missing)}", None, "give values, or from, to and steps"
    else:
        yield from _of_span(table, where)


def _of_span(table: Mapping[str, Any], where: str) -> Iterator[Rule]:
    """Yield each rule of an axis that is given by its ends, broken or not.

    A rule is (whether it is broken, key, what is wrong, value given, suggested fix). `table` has the keys from, to and
    steps, else KeyError; scale is "linear" where it is absent. `where`: its path in the sweep file, such as axes[0].
    """
    given, steps, scale = (table["from"], table["to"]), table["steps"], table.get("scale", "linear")
    ends, _ = Axis("", given).numbers
    must = "must be a finite number"
    if all(isinstance(end, str) for end in given):
        must = 'must have the same dimension at both ends, such as "500 µm" and "5 mm"'
    for name, end in zip(("from", "to"), given, strict=True):
        yield not ends and not _is_number(end), f"{where}.{name}", must, end, ""
    whole = type(steps) is int and 1 <= steps < MOST_POINTS
    yield not whole, f"{where}.steps", f"must be a whole number from 1 to {MOST_POINTS - 1}", steps, ""
    path = f"{where}.scale"
    yield scale not in SCALES, path, 'must be "linear" or "log"', scale, ""
    yield scale == "log" and min(ends, default=1.0) <= 0.0, path, "log needs from and to above 0", scale, ""


def _of_axes(axes: Sequence[Axis], combine: str) -> Iterator[Rule]:
    """Yield each rule of all axes together, broken or not: different keys, lengths, number of points.

    A rule is (whether it is broken, key, what is wrong, value given or None, suggested fix). Lengths must be equal only
    side by side (zip), and the number of points is limited to a million only in a product.
    """
    keys, lengths = [axis.key for axis in axes], [len(axis.values) for axis in axes]
    for i, key in enumerate(keys):
        yield key in keys[:i], f"axes[{i}].key", "another axis has the same key", key, ""
    words = ", ".join(map(str, lengths))
    uneven = combine == "zip" and len(set(lengths)) > 1
    yield uneven, "combine", f'"zip" needs axes of one length, they have {words} values', None, ""
    count, product = math.prod(lengths), " × ".join(map(str, lengths))
    many = combine == "product" and count > MOST_POINTS
    yield many, "axes", f"{product} = {count} points are more than {MOST_POINTS}", None, "use fewer values"


def _span(table: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the steps + 1 values of an axis given by its ends: evenly spaced, or with scale "log" in equal ratios.

    They are int if the ends are int and all values of a linear axis are whole; texts if the ends are, both as given and
    those between in base units of SI; else floats. The ends are exact, values between are rounded to 12 digits.
    """
    given, steps, scale = (table["from"], table["to"]), table["steps"], table.get("scale", "linear")
    ends, unit = Axis("", given).numbers
    start, end = ends if unit else given
    if scale == "linear" and isinstance(start, int) and isinstance(end, int) and (end - start) % steps == 0:
        return tuple(start + i * ((end - start) // steps) for i in range(steps + 1))
    inner = map(cleaned, (np.linspace if scale == "linear" else np.geomspace)(start, end, steps + 1)[1:-1])
    if unit:
        return given[0], *(f"{value!r} {unit}" for value in inner), given[1]
    return float(start), *inner, float(end)


def _is_list(value: object) -> bool:
    """Return whether a value is a list or tuple, or another sequence but a text."""
    return isinstance(value, Sequence) and not isinstance(value, str)


def _is_number(value: object) -> bool:
    """Return whether a value is a finite int or float; True and False are none, nor are texts."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


UNKNOWN_KEY = ("unknown key", "unknown table")
"""Messages of problems with a key that is no key of a scene."""


def require_keys(plan: SweepPlan) -> None:
    """Check, with the first point, that each axis is a key of the scene; nothing is returned.

    Wrong values pass, since they are errors of their points.

    Raises:
        SceneError: an axis names no key of the scene.
    """
    try:
        scene_of(plan, next(plan.values()))
    except SceneError as error:
        keys = [f"{axis.key}." for axis in plan.axes]
        wrong = [
            problem
            for problem in error.problems
            if problem.path.startswith("set ")  # a problem of the key itself
            or (problem.message in UNKNOWN_KEY and any(key.startswith(f"{problem.path}.") for key in keys))
        ]
        if wrong:
            raise SceneError(wrong) from None


def name_of(scene: Scene) -> str:
    """Return the first 16 hexadecimal digits of the SHA-256 of the scene, with its defaults and without its title.

    Among a million points two names agree with a probability of 3e-8.
    """
    content = {name: table for name, table in scene.tables.items() if name != "title"}
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()[:16]


def scene_of(plan: SweepPlan, values: tuple[Any, ...]) -> Scene:
    """Return the checked scene of a point, by its values in the order of the axes.

    Raises:
        SceneError: the values give no valid scene.
    """
    tables = deepcopy(dict(plan.base))
    keys = [axis.key for axis in plan.axes]
    if problems := set_values(tables, dict(zip(keys, values, strict=True))):
        raise SceneError(problems)
    return read_scene(tables, folder=plan.folder)
