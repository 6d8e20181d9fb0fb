"""A measured profile from a CSV file: the columns r and z, as comma, semicolon, tab or blanks part them."""

from __future__ import annotations

import math
import re
import sys
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from contact1d.workflow.scene.profiles import FEWEST_POINTS
from contact1d.workflow.scene.si_text import UnitTextError, si_value

RADII = ("r", "radius", "radii", "rho", "ρ")
SIDES = ("x",)
"""Names of a place from one side to the other, which is read where no radius is there."""
HEIGHTS = ("z", "h", "height", "heights")
NAME = re.compile(r"([^\W_]+)\s*(?:\[(.*)\]|\((.*)\)|/\s*(.+)|_(\w+)|\sin\s+(.+)|)$")
MODEL = "LU"
FORM = "name the radius r and the height z, with units if they have any (r [µm], z [µm])"
PLACE_DIFFERENCE = 1e-3
"""Places left and right count as the same up to this share of the mean step."""
HEIGHT_DIFFERENCE = 0.05
"""Largest difference of both sides of a profile that are averaged, over its height."""


class ProfileFileError(ValueError):
    """A file that is no profile; the message says in which line and what is wrong."""


class ScaleError(ValueError):
    """A scale that is none for this file; the message says why."""


@dataclass(frozen=True)
class Points:
    """Radii and heights, and the unit of each as the file has it ("1 µm"; None: none is given)."""

    r: list[float]
    z: list[float]
    r_unit: str | None = None
    z_unit: str | None = None

    def scaled(self, scale: object) -> tuple[dict[str, list[float]], dict[str, str | None]]:
        """The lists r and z, and the unit of each (None: LU), by the scene's `scale`: None, a number, or "1 µm".

        Raises:
            ScaleError: a scale that is no size, too large, or beside units of the file's own.
        """
        lists, units = {"r": self.r, "z": self.z}, {"r": self.r_unit, "z": self.z_unit}
        if scale is None:
            return lists, units
        if any(units.values()):
            raise ScaleError("not together with units in the file's names; remove it")
        if isinstance(scale, str):
            try:
                si_value(scale, "LU")
            except UnitTextError as error:
                raise ScaleError(str(error)) from None
            return lists, dict.fromkeys(units, scale)
        if isinstance(scale, bool) or not isinstance(scale, int | float) or not 0.0 < scale <= sys.float_info.max:
            raise ScaleError("must be a number greater than 0 (LU), or text with a unit")
        scaled = {key: [scale * value for value in values] for key, values in lists.items()}
        if not all(map(math.isfinite, scaled["r"] + scaled["z"])):
            raise ScaleError("is too large for the numbers of the file")
        return scaled, units


def read_profile(path: Path) -> Points:
    """The points of a measured profile, from the axis out.

    Messages name lines and never quote them: a path in a scene may point at any file.

    Lines that begin with # and empty ones are skipped; the first other line may be names. Columns of other names are
    ignored. Points may come from the edge in; those from −x to x are folded into the mean of both sides.

    Raises:
        ProfileFileError: if there is no such file, a cell is empty or no number, a line has one column, there are
            fewer than FEWEST_POINTS points, names are not known, or the two sides of a profile are not the same.
    """
    rows = _rows(path)
    header, rows = _header(path, rows)
    if not rows:
        raise ProfileFileError(f"{path} has no points")
    points = [_point(path, place, line, (header.radius, header.height)) for place, line in rows]
    if all(after[0] < before[0] for before, after in pairwise(points)):
        points.reverse()
    r, z = [r for r, _ in points], [z for _, z in points]
    if len(r) > 1 and not _rising(r) and (_rising(z) or _rising(z[::-1])):
        raise ProfileFileError(
            f"{path.name}: its radii do not rise and its heights do, as if the columns were swapped; name them r and z"
        )
    if r[0] < 0.0 and _rising(r):
        r, z = _folded(path, r, z)
    if len(r) < FEWEST_POINTS:
        raise ProfileFileError(f"{path} must have at least {FEWEST_POINTS} points from the axis out, not {len(r)}")
    return Points(r, z, header.radius_unit, header.height_unit)


def _rows(path: Path) -> list[tuple[int, str]]:
    """The lines that say something, with their numbers."""
    try:
        lines = path.read_bytes().decode("utf-8-sig").splitlines()
    except FileNotFoundError:
        raise ProfileFileError(f"there is no file {path}") from None
    except UnicodeDecodeError:
        raise ProfileFileError(f"{path} is no text (UTF-8); save it as CSV in UTF-8") from None
    except OSError as error:
        raise ProfileFileError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError:
        raise ProfileFileError("is no name that a file can have") from None
    rows = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    return rows[1:] if rows and re.fullmatch(r"sep=.", rows[0][1].strip()) else rows


def _header(path: Path, rows: list[tuple[int, str]]) -> tuple[Header, list[tuple[int, str]]]:
    """What the line of names says, if there is one, and the rows below it."""
    if not rows:
        return Header(), rows
    first = _cells(rows[0][1])
    if any(_number(cell) is not None for cell in first):
        many = len([cell for cell in first if cell.strip()])
        if many > 2:
            raise ProfileFileError(f"{path.name} has {many} columns without names; {FORM}")
        return Header(), rows
    below = _cells(rows[1][1]) if len(rows) > 1 else None
    if below is not None and any(not cell.strip() or any(map(str.isdigit, cell)) for cell in below):
        below = None
    try:
        header, beneath = header_of(first, below)
    except HeaderError as error:
        raise ProfileFileError(f"{path.name}, line {rows[0][0]}: {error}") from None
    return header, rows[2:] if beneath else rows[1:]


def _rising(values: list[float]) -> bool:
    return all(after > before for before, after in pairwise(values))


def _folded(path: Path, x: list[float], z: list[float]) -> tuple[list[float], list[float]]:
    """The mean of both sides of a profile from −x to x. Raises ProfileFileError where they are not the same."""
    n = len(x)
    step = (x[-1] - x[0]) / (n - 1)
    if any(abs(x[i] + x[n - 1 - i]) > PLACE_DIFFERENCE * step for i in range(n)):
        raise ProfileFileError(
            f"{path.name} goes to both sides of 0, and its places left and right are not the same; shift it so that "
            "the apex is at 0, or give one side, r from 0 on"
        )
    height = max(z) - min(z)
    apart = max(abs(z[i] - z[n - 1 - i]) for i in range(n))
    if apart > HEIGHT_DIFFERENCE * height:
        raise ProfileFileError(
            f"{path.name} goes to both sides of 0, and these differ by {apart / height:.0%} of its height, where the "
            "model has one body of revolution; shift it so that the apex is at 0, or give one side, r from 0 on"
        )
    kept = range(n // 2, n)
    return [0.5 * (x[i] - x[n - 1 - i]) for i in kept], [0.5 * (z[i] + z[n - 1 - i]) for i in kept]


def _point(path: Path, place: int, line: str, columns: tuple[int, int]) -> tuple[float, float]:
    cells = _cells(line)
    at = f"{path.name}, line {place}"
    if len(cells) <= max(columns):
        many = "has one column" if len(cells) == 1 else f"has {len(cells)} columns"
        raise ProfileFileError(f"{at}: {many}; r and z are needed")
    values = []
    for name, cell in zip("rz", (cells[column] for column in columns), strict=True):
        value = _number(cell)
        if value is None:
            what = "is no number" if cell.strip() else "is empty"
            hint = "leave out a line that has no value, or interpolate it"
            if _number(cell.replace(",", ".")) is not None:
                hint = "write it with a decimal point"
            raise ProfileFileError(f"{at}: {name} {what}; {hint}")
        if not math.isfinite(value):
            raise ProfileFileError(f"{at}: {name} is {value}; leave out a line that has no value")
        values.append(value)
    return values[0], values[1]


def _cells(line: str) -> list[str]:
    parting = ";" if ";" in line else "," if "," in line else "\t" if "\t" in line else None
    return line.split(parting) if parting else re.split(r"\s+", line.strip())


def _number(cell: str) -> float | None:
    try:
        return float(cell.strip().strip('"'))
    except ValueError:
        return None


class HeaderError(ValueError):
    """Names that say nothing or too much; the message says what is wrong."""


@dataclass(frozen=True)
class Header:
    """Places of the two columns, and their units as sizes, "1 µm"; None: none is given."""

    radius: int = 0
    height: int = 1
    radius_unit: str | None = None
    height_unit: str | None = None


def header_of(names: list[str], below: list[str] | None) -> tuple[Header, bool]:
    """What the cells of the line of names say; `below`: those of the next line, and whether these are its units.

    Raises:
        HeaderError: no radius or no height, two of them, or a unit that is no length.
    """
    found = [NAME.match(name.strip().strip('"').lower()) for name in names]
    words = [match[1] if match else "" for match in found]
    places = [_only(words, RADII) if set(words) & set(RADII) else _only(words, SIDES), _only(words, HEIGHTS)]
    if None in places:
        raise HeaderError(f"the names of its {len(names)} columns are not known; {FORM}, or leave the names out")
    radius, height = (place for place in places if place is not None)
    own = [_unit(names[place]) for place in (radius, height)]
    beneath = below is not None and len(below) == len(names) and not any(own)
    if beneath and below is not None:
        own = [below[place].strip().strip('[]()"') for place in (radius, height)]
    if any(own) != all(own):
        raise HeaderError("only one of radius and height has a unit; give both the same way, r [µm], z [µm]")
    units = [_size(unit) for unit in own]
    return Header(radius, height, *units), beneath


def _only(words: list[str], allowed: tuple[str, ...]) -> int | None:
    """Where the one column of an allowed name is; None where there is none."""
    found = [i for i, word in enumerate(words) if word in allowed]
    if len(found) > 1:
        raise HeaderError(f"{len(found)} columns could be meant by {allowed[0]}; name only one so")
    return found[0] if found else None


def _unit(name: str) -> str:
    """The unit in a column's name, or nothing."""
    match = NAME.match(name.strip().strip('"'))
    return next((unit.strip() for unit in match.groups()[1:] if unit), "") if match else ""


def _size(unit: str) -> str | None:
    if unit in ("", MODEL):
        return None
    try:
        si_value(f"1 {unit}", MODEL)
    except UnitTextError:
        raise HeaderError(f"the unit in the names is no length that is known, such as µm; {FORM}") from None
    return f"1 {unit}"
