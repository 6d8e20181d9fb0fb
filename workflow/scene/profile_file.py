"""A measured profile from a CSV file: the columns r and z, separated by comma, semicolon, tab or blanks."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, pairwise
from pathlib import Path

from contact1d.files import read_text
from contact1d.workflow.scene.conversion import positive, size
from contact1d.workflow.scene.problems import Problem
from contact1d.workflow.scene.profiles import FEWEST_POINTS
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.schema import described
from contact1d.workflow.scene.si_text import UnitTextError, si_value

RADII = ("r", "radius", "radii", "rho", "ρ")
SIDES = ("x",)
"""Names of a place from one side to the other, which is read where no radius is there."""
HEIGHTS = ("z", "h", "height", "heights")
NAME = re.compile(r"([^\W_]+)\s*(?:\[(.*)\]|\((.*)\)|/\s*(.+)|_(\w+)|\sin\s+(.+)|)$")
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


class ProfileFile:
    """The file that the profile of a scene names, if it does; its scale is a quantity of the scene like any other.

    Attributes:
        profile: its place in the scene.
        lists, units: as `read_profile` gives them; none without a file that could be read.
        problems: what is wrong with it.
    """

    def __init__(self, scene: Place, folder: Path) -> None:
        """Read it, looked up in `folder`. Without a scale of the scene's the unit of the radii stands there."""
        self.profile = scene.at("bodies", "profile")
        self.lists: dict[str, list[float]] = {}
        self.units: dict[str, str | None] = {}
        self.problems: list[Problem] = []
        if not self.profile or not self.profile.at("file"):
            return
        file, scale = (self.profile.inside[key] for key in ("file", "scale"))
        listed = not {"r", "z"}.isdisjoint(self.profile.value)
        wrong = file
        if isinstance(file.value, str) and not listed:
            try:
                self.lists, self.units = read_profile(folder / file.value)
                wrong = scale
                if scale.absent:
                    scale.put(self.units["r"] or 1.0)
                    scale.source = file
                elif any(self.units.values()):
                    raise ValueError("not together with units in the file's names; remove it")
                elif isinstance(scale.value, str):
                    si_value(scale.value, MODEL)
                elif not positive(scale.value):
                    raise ValueError(f"must be {described(scale.allowed)}")
            except ValueError as error:
                self.problems = [wrong.fault(str(error))]
        elif isinstance(file.value, str):
            self.problems = [file.fault("not together with the lists r and z", "give one of the two")]
        elif listed and not scale.absent:
            beside = "not together with the lists r and z, which have units of their own"
            self.problems = [scale.problem(beside, "it belongs to a file: remove it")]
        if self.problems:
            self._replace({})

    def put(self, scales: Mapping[str, Fraction] | None) -> None:
        """Put its points in its place, in LU; `scales` has the size of that in SI, where a unit is there."""
        if not self.lists or not self.profile or not self.profile.sound:
            return
        scale = self.profile.inside["scale"]
        sizes = {
            key: float(si_value(unit, MODEL)[0] / size(MODEL, scales)) if unit and scales else scale.value
            for key, unit in self.units.items()
        }
        lists = {key: [sizes[key] * value for value in values] for key, values in self.lists.items()}
        if not all(map(math.isfinite, chain(*lists.values()))):
            self.problems = [scale.fault("is too large for the numbers of the file")]
        self.profile.source = self.profile.inside["file"]
        self._replace({} if self.problems else lists)

    def _replace(self, lists: Mapping[str, list[float]]) -> None:
        """Put the lists in the place of the file."""
        assert self.profile is not None
        kept = {key: value for key, value in self.profile.value.items() if key not in ("file", "scale")}
        self.profile.put(kept | lists)


def read_profile(path: Path) -> tuple[dict[str, list[float]], dict[str, str | None]]:
    """The lists r and z of a measured profile, from the axis out, and the unit of each, "1 µm"; None: in LU.

    Messages name lines and never quote them: a path in a scene may point at any file.

    Lines that begin with # and empty ones are skipped; the first other line may be names. Columns of other names are
    ignored. Points may come from the edge in; those from −x to x are folded into the mean of both sides.

    Raises:
        UnreadableError: if there is no such file, or it is no text.
        ProfileFileError: if it has more than MOST_LINES, a cell is empty or no number, a line has one column, there
            are fewer than FEWEST_POINTS points, names are not known, or the two sides of a profile are not the same.
    """
    header, rows = _header(path.name, _rows(path))
    if not rows:
        raise ProfileFileError(f"{path} has no points")
    points = [_point(f"{path.name}, line {line}", cells, header.columns) for line, cells in rows]
    if all(after[0] < before[0] for before, after in pairwise(points)):
        points.reverse()
    r, z = ([*column] for column in zip(*points, strict=True))
    if len(r) > 1 and not _rising(r) and (_rising(z) or _rising(z[::-1])):
        raise ProfileFileError(
            f"{path.name}: its heights increase and its radii do not: the columns may be swapped; name them r and z"
        )
    if r[0] < 0.0 and _rising(r):
        r, z = _folded(path, r, z)
    if len(r) < FEWEST_POINTS:
        raise ProfileFileError(f"{path} must have at least {FEWEST_POINTS} points from the axis out, not {len(r)}")
    return {"r": r, "z": z}, dict(zip("rz", header.units, strict=True))


def _rows(path: Path) -> list[Row]:
    """The lines that have content, each with its number, as cells."""
    lines = read_text(path).splitlines()
    if len(lines) > MOST_LINES:
        raise ProfileFileError(f"{path} has {len(lines)} lines, at most {MOST_LINES} are allowed; use fewer points")
    full = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    if full and re.fullmatch(r"sep=.", full[0][1].strip()):
        del full[0]
    separators = ((i, line, next((one for one in ";,\t" if one in line), None)) for i, line in full)
    return [(i, line.split(one) if one else line.split()) for i, line, one in separators]


@dataclass(frozen=True)
class Header:
    """Places of the columns of radius and height, and their units as sizes, "1 µm"; None: none is given."""

    columns: tuple[int, int] = (0, 1)
    units: tuple[str | None, str | None] = (None, None)


def _header(file: str, rows: list[Row]) -> tuple[Header, list[Row]]:
    """What the line of names says, or of names and of units below it, if there is one, and the rows below it."""
    if not rows:
        return Header(), rows
    line, names = rows[0]
    if any(_number(cell) is not None for cell in names):
        many = sum(bool(cell.strip()) for cell in names)
        if many > 2:
            raise ProfileFileError(f"{file} has {many} columns without names; {FORM}")
        return Header(), rows
    at, bare = f"{file}, line {line}", [name.strip().strip('"') for name in names]
    words = [match[1] if (match := NAME.match(name.lower())) else "" for name in bare]
    radius, height = _only(at, words, RADII if set(words) & set(RADII) else SIDES), _only(at, words, HEIGHTS)
    if radius is None or height is None:
        raise ProfileFileError(f"{at}: the names of its {len(names)} columns are not known; {FORM}, or leave them out")
    matches = (NAME.match(bare[radius]), NAME.match(bare[height]))
    units = [next((unit.strip() for unit in match.groups()[1:] if unit), "") if match else "" for match in matches]
    below = rows[1][1] if len(rows) > 1 else []
    beneath = len(below) == len(names) and not any(units)
    beneath = beneath and not any(not cell.strip() or any(map(str.isdigit, cell)) for cell in below)
    if beneath:
        units = [below[column].strip().strip('[]()"') for column in (radius, height)]
    if any(units) != all(units):
        raise ProfileFileError(
            f"{at}: only one of radius and height has a unit; give both the same way, r [µm], z [µm]"
        )
    sizes = (_size(at, units[0]), _size(at, units[1]))
    return Header((radius, height), sizes), rows[2:] if beneath else rows[1:]


def _only(at: str, words: list[str], allowed: tuple[str, ...]) -> int | None:
    """Where the one column of an allowed name is; None where there is none."""
    found = [i for i, word in enumerate(words) if word in allowed]
    if len(found) > 1:
        raise ProfileFileError(f"{at}: {len(found)} columns match {allowed[0]}; give this name to one of them")
    return found[0] if found else None


def _size(at: str, unit: str) -> str | None:
    if unit in ("", MODEL):
        return None
    try:
        si_value(f"1 {unit}", MODEL)
    except UnitTextError:
        raise ProfileFileError(f"{at}: the unit in the names is not a known length, such as µm; {FORM}") from None
    return f"1 {unit}"


def _rising(values: list[float]) -> bool:
    return all(after > before for before, after in pairwise(values))


def _folded(path: Path, x: list[float], z: list[float]) -> tuple[list[float], list[float]]:
    """The mean of both sides of a profile from −x to x. Raises ProfileFileError where they are not the same."""
    n = len(x)
    step = (x[-1] - x[0]) / (n - 1)
    if any(abs(x[i] + x[n - 1 - i]) > PLACE_DIFFERENCE * step for i in range(n)):
        raise ProfileFileError(
            f"{path.name} has both sides of 0, and their positions differ; shift it so that "
            "the apex is at 0, or give one side, r from 0 on"
        )
    height = max(z) - min(z)
    apart = max(abs(z[i] - z[n - 1 - i]) for i in range(n))
    if apart > HEIGHT_DIFFERENCE * height:
        raise ProfileFileError(
            f"{path.name} has both sides of 0, and these differ by {apart / height:.0%} of its height, but the model "
            "is a body of revolution; shift it so that the apex is at 0, or give one side, r from 0 on"
        )
    kept = range(n // 2, n)
    return [0.5 * (x[i] - x[n - 1 - i]) for i in kept], [0.5 * (z[i] + z[n - 1 - i]) for i in kept]


def _point(at: str, cells: list[str], columns: tuple[int, int]) -> list[float]:
    """Radius and height of one line."""
    if len(cells) <= max(columns):
        many = "has one column" if len(cells) == 1 else f"has {len(cells)} columns"
        raise ProfileFileError(f"{at}: {many}; r and z are needed")
    values = []
    for name, cell in zip("rz", (cells[column] for column in columns), strict=True):
        value, what, hint = _number(cell), "is empty", "leave out a line that has no value, or interpolate it"
        if cell.strip():
            what = "is not a number" if value is None else f"is {value}"
        if _number(cell.replace(",", ".")) is not None:
            hint = "leave out a line that has no value" if value is not None else "write it with a decimal point"
        if value is None or not math.isfinite(value):
            raise ProfileFileError(f"{at}: {name} {what}; {hint}")
        values.append(value)
    return values


def _number(cell: str) -> float | None:
    try:
        return float(cell.strip().strip('"'))
    except ValueError:
        return None
