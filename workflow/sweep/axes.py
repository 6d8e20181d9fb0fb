"""A sweep file: a base scene and axes of values; its points are their product, or the axes side by side (zip)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.workflow.scene import Problem, SceneError, read_tables
from contact1d.workflow.scene.problems import nearest, shown
from contact1d.workflow.scene.si_text import UnitTextError, split

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
    """A key of a scene, dotted, and the values that it takes, in order."""

    key: str
    values: tuple[Any, ...]

    def numbers(self) -> tuple[tuple[float, ...], str]:
        """The values as numbers, and the one unit that they have as texts; no numbers where some are words."""
        if all(isinstance(value, int | float) for value in self.values):
            return tuple(map(float, self.values)), ""
        try:
            parts = [split(value) for value in self.values]
        except (UnitTextError, AttributeError):
            return (), ""
        units = {unit for _, unit in parts}
        return (tuple(float(number) for number, _ in parts), units.pop()) if len(units) == 1 else ((), "")


@dataclass(frozen=True)
class SweepPlan:
    """What a sweep file asks for.

    Attributes:
        title: of the sweep.
        base: tables of the base scene, unchecked: an axis may bring what it lacks.
        folder: where files that the base scene names are looked for.
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


def read_sweep(source: AnySweep) -> SweepPlan:
    """The sweep that a TOML file, its path given, or a mapping with the same keys describes.

    Raises:
        SceneError: every problem of the sweep file; or those of the base scene's file, if it can't be read.
    """
    tables = dict(source) if isinstance(source, Mapping) else read_tables(source)
    folder = Path.cwd() if isinstance(source, Mapping) else Path(source).parent
    problems = [_unknown(key, KEYS) for key in tables if key not in KEYS]
    title, combine = tables.get("title", ""), tables.get("combine", "product")
    if not isinstance(title, str):
        problems.append(Problem("title", "must be text", shown(title)))
    if combine not in COMBINATIONS:
        problems.append(Problem("combine", 'must be "product" or "zip"', shown(combine)))
    axes = list(_axes(tables.get("axes"), problems))
    if not problems:
        problems += _shape(axes, combine)
    base, home = _base(tables, folder, problems)
    if problems:
        raise SceneError(problems)
    return SweepPlan(title, base, home, tuple(axes), combine)


def _unknown(key: str, allowed: Sequence[str], where: str = "") -> Problem:
    meant = nearest(key, allowed)
    hint = f'did you mean "{meant}"? ' if meant else ""
    return Problem(where + key, "unknown key", hint=f"{hint}allowed here: {', '.join(allowed)}")


def _base(tables: Mapping[str, Any], folder: Path, problems: list[Problem]) -> tuple[Mapping[str, Any], Path]:
    """Tables of the base scene, and the folder that its files are looked for in."""
    scene, base = tables.get("scene"), tables.get("base")
    if (scene is None) == (base is None):
        both = "not together with [base]" if scene is not None else "missing"
        problems.append(Problem("scene", both, hint="give a scene file, or the scene's tables under [base]"))
    elif base is not None:
        if isinstance(base, Mapping):
            return base, folder
        problems.append(Problem("base", "must be a table of a scene's tables", shown(base), "write [base.bodies], …"))
    elif isinstance(scene, str):
        return read_tables(folder / scene), (folder / scene).parent
    else:
        problems.append(Problem("scene", "must be the name of a scene file", shown(scene)))
    return {}, folder


def _axes(given: Any, problems: list[Problem]) -> Iterator[Axis]:
    if given is None or given == []:
        problems.append(Problem("axes", "missing", hint='write [[axes]] with key = "bodies.profile.radius" and values'))
        return
    if not isinstance(given, Sequence) or isinstance(given, str):
        problems.append(Problem("axes", "must be written as [[axes]], in double brackets, once for each", shown(given)))
        return
    for number, table in enumerate(given):
        where = f"axes[{number}]"
        if not isinstance(table, Mapping):
            problems.append(Problem(where, "must be a table with key and values", shown(table)))
            continue
        found = [
            _unknown(key, ("key", "values", *SPAN_KEYS), f"{where}.")
            for key in table
            if key not in ("key", "values", *SPAN_KEYS)
        ]
        key = table.get("key")
        if not isinstance(key, str) or not key:
            what = "missing" if key is None else "must be a key of the scene"
            found.append(Problem(f"{where}.key", what, None if key is None else shown(key), "such as noise.seed"))
        values = _values(table, where, found)
        problems += found
        if not found:
            yield Axis(str(key), values)


def _values(table: Mapping[str, Any], where: str, problems: list[Problem]) -> tuple[Any, ...]:
    span = [key for key in SPAN_KEYS if key in table]
    if "values" in table:
        values = table["values"].tolist() if hasattr(table["values"], "tolist") else table["values"]
        if span:
            problems.append(Problem(f"{where}.values", f"not together with {', '.join(span)}", hint="give the one"))
        elif not isinstance(values, Sequence) or isinstance(values, str):
            problems.append(Problem(f"{where}.values", "must be a list", shown(values)))
        elif not values:
            problems.append(Problem(f"{where}.values", "is empty: the sweep would have no point"))
        else:
            return tuple(values)
        return ()
    if missing := [key for key in ("from", "to", "steps") if key not in table]:
        problems.append(Problem(f"{where}", f"lacks {', '.join(missing)}", hint="give values, or from, to and steps"))
        return ()
    start, end, unit = _without_unit(table["from"], table["to"])
    steps = table["steps"]
    scale = table.get("scale", "linear")
    wrong = [name for name, number in (("from", start), ("to", end)) if not _is_number(number)]
    problems += [Problem(f"{where}.{name}", _must(start, end), shown(table[name])) for name in wrong]
    if isinstance(steps, bool) or not isinstance(steps, int) or not 1 <= steps < MOST_POINTS:
        problems.append(Problem(f"{where}.steps", f"must be a whole number from 1 to {MOST_POINTS - 1}", shown(steps)))
        return ()
    if scale not in SCALES:
        problems.append(Problem(f"{where}.scale", 'must be "linear" or "log"', shown(scale)))
    elif scale == "log" and not wrong and min(start, end) <= 0.0:
        problems.append(Problem(f"{where}.scale", "log needs from and to above 0", shown(scale)))
    elif not wrong:
        found = _span(start, end, steps, scale)
        return tuple(f"{value!r} {unit}" for value in found) if unit else found
    return ()


def _must(start: Any, end: Any) -> str:
    """What the ends of a span must be."""
    if isinstance(start, str) and isinstance(end, str):
        return 'must have the same unit at both ends, such as "1 mm" and "5 mm"'
    return "must be a finite number"


def _without_unit(start: Any, end: Any) -> tuple[Any, Any, str]:
    """The ends of a span as numbers, where both are texts with the same unit, and that unit."""
    if not (isinstance(start, str) and isinstance(end, str)):
        return start, end, ""
    try:
        (first, unit), (last, other) = split(start), split(end)
    except UnitTextError:
        return start, end, ""
    return (float(first), float(last), unit) if unit == other else (start, end, "")


def _span(start: float, end: float, steps: int, scale: str) -> tuple[Any, ...]:
    """steps + 1 values, both ends exact; whole numbers where all of a linear span are."""
    if scale == "linear" and isinstance(start, int) and isinstance(end, int) and (end - start) % steps == 0:
        return tuple(start + i * ((end - start) // steps) for i in range(steps + 1))
    make = np.linspace if scale == "linear" else np.geomspace
    inner = make(start, end, steps + 1)[1:-1]
    return (float(start), *inner.tolist(), float(end))


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _shape(axes: Sequence[Axis], combine: str) -> Iterator[Problem]:
    """What is wrong with the axes together."""
    for number, axis in enumerate(axes):
        if axis.key in [other.key for other in axes[:number]]:
            yield Problem(f"axes[{number}].key", "another axis has the same key", shown(axis.key))
    lengths = [len(axis.values) for axis in axes]
    if combine == "zip" and len(set(lengths)) > 1:
        yield Problem("combine", f'"zip" needs axes of one length, they have {", ".join(map(str, lengths))} values')
    elif combine == "product" and (count := math.prod(lengths)) > MOST_POINTS:
        product = " × ".join(map(str, lengths))
        yield Problem("axes", f"{product} = {count} points are more than {MOST_POINTS}", hint="take coarser axes")
