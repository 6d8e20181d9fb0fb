"""A measured profile from a CSV file: the columns r and z, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from itertools import chain, pairwise
from pathlib import Path

from contact1d.files import read_text
from contact1d.workflow.scene.conversion import is_positive
from contact1d.workflow.scene.profiles import FEWEST_POINTS
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.schema import described
from contact1d.workflow.scene.si_text import UnitTextError, si_value

RADII = ("r", "radius", "radii", "rho", "ρ")
SIDES = ("x",)
"""Names of a place from one side to the other, which is read where no radius is there."""
HEIGHTS = ("z", "h", "height", "heights")
NAME = re.compile(r"([^\W_]+)(?:\s*[\[(/_]\s*|\sin\s+|\s*$)([^])]*)[])]?$", re.IGNORECASE)
"""Name and unit of a column: r, r [µm], r (µm), r/µm, r_um, r in µm."""
MODEL = "LU"
MOST_LINES = 100_000
"""Lines of a file: a scene with as many points takes ten seconds to run."""
FORM = "name the radius r and the height z, with units if they have any (r [µm], z [µm])"
PLACE_DIFFERENCE = 1e-3
"""Places left and right count as the same up to this share of the mean step."""
HEIGHT_DIFFERENCE = 0.05
"""Largest difference of both sides of a profile that are averaged, over its height."""

Row = tuple[int, list[str]]
"""A line of a file: its number and its cells."""


class ProfileFileError(ValueError):
    """A file that is not a profile; the message has the line and the error."""


def take_points(scene: Place, folder: Path) -> dict[str, list[float]]:
    """The points of the file, looked up in `folder`, that the profile of a scene names; none without one, or reported.

    Its scale is a quantity of the scene like any other: where none is given, the unit of the numbers stands there.
    """
    profile, file, scale = (scene.at(f"bodies.profile{key}") for key in ("", ".file", ".scale"))
    if not profile or not file or not scale or not isinstance(file.value, str):
        return {}
    if not {"r", "z"}.isdisjoint(profile.value):
        file.doubt()  # a rule reports it
        return {}
    wrong = file
    try:
        lists, unit = read_profile(folder / file.value)
        wrong = scale
        if scale.absent:
            scale.put(unit or 1.0)
            scale.source = file
        elif unit:
            raise ValueError("not together with units in the file's names; remove it")
        elif isinstance(scale.value, str):
            si_value(scale.value, MODEL)
        elif not is_positive(scale):
            raise ValueError(f"must be {described(scale.allowed)}")
    except ValueError as error:
        wrong.fault(str(error))
        profile.put({"kind": profile.value["kind"]})
        return {}
    return lists


def put_points(scene: Place, lists: dict[str, list[float]]) -> None:
    """Put the points of a file in its place in a scene, whose scale is a number by now."""
    profile = scene.at("bodies.profile")
    if not lists or not profile or not profile.sound:
        return
    scale = profile.inside["scale"]
    scaled = {key: [scale.value * value for value in values] for key, values in lists.items()}
    if all(map(math.isfinite, chain(*scaled.values()))):
        profile.source = profile.inside["file"]
        profile.put({"kind": profile.value["kind"], **scaled})
    else:
        scale.fault("is too large for the numbers of the file")


def read_profile(path: Path) -> tuple[dict[str, list[float]], str | None]:
    """The lists r and z of a measured profile, from the axis out, and the unit of their numbers, "1 µm"; None: LU.

    Messages name lines and never quote them: a path in a scene may point at any file.

    Lines that begin with # and empty ones are skipped; the first other line may be names. Columns of other names are
    ignored. Points may come from the edge in; those from −x to x are folded into the mean of both sides.

    Raises:
        UnreadableError: if there is no such file, or it is no text.
        ProfileFileError: if it has more than MOST_LINES, a cell is empty or no number, a line has one column, there
            are fewer than FEWEST_POINTS points, names are not known, or the two sides of a profile are not the same.
    """
    rows = _rows(path)
    columns, unit, ratio = _header(rows)
    points = [_point(f"line {line}", cells, columns) for line, cells in rows]
    if not points:
        raise ProfileFileError("has no points")
    if all(after[0] < before[0] for before, after in pairwise(points)):
        points.reverse()
    r, z = ([*column] for column in zip(*points, strict=True))
    if len(r) > 1 and not _rising(r) and (_rising(z) or _rising(z[::-1])):
        raise ProfileFileError(
            "its heights increase and its radii do not: the columns may be swapped; name them r and z"
        )
    if r[0] < 0.0 and _rising(r):
        r, z = _folded(r, z)
    if len(r) < FEWEST_POINTS:
        raise ProfileFileError(f"must have at least {FEWEST_POINTS} points from the axis out, not {len(r)}")
    return {"r": r, "z": [ratio * value for value in z]}, unit


def _rows(path: Path) -> list[Row]:
    """The lines that have content, each with its number, as cells."""
    return rows_in(read_text(path).splitlines())


def rows_in(lines: list[str]) -> list[Row]:
    """The same of lines of text."""
    if len(lines) > MOST_LINES:
        raise ProfileFileError(f"has {len(lines)} lines, at most {MOST_LINES} are allowed; use fewer points")
    full = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    if full and re.fullmatch(r"sep=.", full[0][1].strip()):
        del full[0]
    return [(i, line.split(next((one for one in ";,\t" if one in line), None))) for i, line in full]


def _header(rows: list[Row]) -> tuple[Sequence[int], str | None, float]:
    """The columns of radius and height, the unit of the radii, and that of the heights over it, where there are units.

    Takes the lines of names and units from the rows.
    """
    line, names = rows[0] if rows else (0, ["0"])
    if any(_number(name) is not None for name in names):
        many = sum(bool(cell.strip()) for cell in names)
        if many > 2:
            raise ProfileFileError(f"has {many} columns without names; {FORM}")
        return (0, 1), None, 1.0
    del rows[0]
    found = [NAME.match(name.strip().strip('"')) for name in names]
    words = [match[1].lower() if match else "" for match in found]
    sides = RADII if set(words) & set(RADII) else SIDES
    columns = [_only(line, words, allowed) for allowed in (sides, HEIGHTS)]
    units = [match[2].strip() for column in columns if (match := found[column])]
    below = rows[0][1] if rows and not any(units) and len(rows[0][1]) == len(names) else [""]
    if all(cell.strip() and not any(map(str.isdigit, cell)) for cell in below):
        units = [below[column].strip().strip('[]()"') for column in columns]
        del rows[0]
    sizes = []
    for unit in units:
        if unit not in ("", MODEL):
            try:
                sizes.append(si_value(f"1 {unit}", MODEL)[0])
            except UnitTextError:
                what = "the unit in the names is not a known length, such as µm"
                raise ProfileFileError(f"line {line}: {what}; {FORM}") from None
    if len(sizes) == 1:
        what = "only one of radius and height has a unit"
        raise ProfileFileError(f"line {line}: {what}; give both the same way, r [µm], z [µm]")
    return columns, *((f"1 {units[0]}", float(sizes[1] / sizes[0])) if sizes else (None, 1.0))


def _only(line: int, words: list[str], allowed: tuple[str, ...]) -> int:
    """Where the one column of an allowed name is."""
    found = [i for i, word in enumerate(words) if word in allowed]
    if len(found) == 1:
        return found[0]
    what = f"{len(found)} columns match {allowed[0]}; give this name to one of them"
    if not found:
        what = f"the names of its {len(words)} columns are not known; {FORM}, or leave them out"
    raise ProfileFileError(f"line {line}: {what}")


def _rising(values: list[float]) -> bool:
    return all(after > before for before, after in pairwise(values))


def _folded(x: list[float], z: list[float]) -> tuple[list[float], list[float]]:
    """The mean of both sides of a profile from −x to x. Raises ProfileFileError where they are not the same."""
    places, heights = (list(zip(values, values[::-1], strict=True))[len(x) // 2 :] for values in (x, z))
    apart, height, what = max(abs(right - left) for right, left in heights), max(z) - min(z), ""
    if max(abs(right + left) for right, left in places) > PLACE_DIFFERENCE * (x[-1] - x[0]) / (len(x) - 1):
        what = "their positions differ"
    elif apart > HEIGHT_DIFFERENCE * height:
        what = f"these differ by {apart / height:.0%} of its height, but the model is a body of revolution"
    if what:
        raise ProfileFileError(
            f"has both sides of 0, and {what}; shift it so that the apex is at 0, or give one side, r from 0 on"
        )
    return [0.5 * (right - left) for right, left in places], [0.5 * (right + left) for right, left in heights]


def _point(at: str, cells: list[str], columns: Sequence[int]) -> list[float]:
    """Radius and height of one line."""
    if len(cells) <= max(columns):
        many = "has one column" if len(cells) == 1 else f"has {len(cells)} columns"
        raise ProfileFileError(f"{at}: {many}; r and z are needed")
    values = []
    for name, cell in zip("rz", (cells[column] for column in columns), strict=True):
        value, hint = _number(cell), "leave out a line that has no value, or interpolate it"
        if value is None and _number(cell.replace(",", ".")) is not None:
            hint = "write it with a decimal point"
        if value is None or not math.isfinite(value):
            what = "empty" if not cell.strip() else "not a number" if value is None else value
            raise ProfileFileError(f"{at}: {name} is {what}; {hint}")
        values.append(value)
    return values


def _number(cell: str) -> float | None:
    try:
        return float(cell.strip().strip('"'))
    except ValueError:
        return None
