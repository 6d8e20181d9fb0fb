"""A measured profile from a text file: the columns r or x, and z, separated by semicolon, tab, comma or blanks.

Instruments write lines of their own before the table, names in their user's language, and a comma for the point.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import chain, pairwise
from pathlib import Path

from contact1d.files import read_text
from contact1d.workflow.scene.conversion import is_positive
from contact1d.workflow.scene.instrument_file import ENDINGS, ProfileFileError, read_line
from contact1d.workflow.scene.measured import SCAN_KEYS, is_scan
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.schema import described
from contact1d.workflow.scene.shapes import FEWEST_POINTS
from contact1d.workflow.scene.si_text import UnitTextError, si_value

COLUMNS = {
    "r": "r, radius, radii, rho, ρ, rayon, raggio, radio",
    "x": "x, position, distance, lateral, weg, abstand, strecke, posizione, distanza, posición, distancia",
    "z": "z, h, height, heights, höhe, hoehe, hauteur, altezza, altura",
}
"""Headings of each column in lower case, without units: x, from one side to the other, is read if there is no r."""
NAME = re.compile(r"([^\W_]+)(?:\s*(?:_?[\[(/]|_)\s*|\sin\s+|\s*$)([^])]*)[])]?$", re.IGNORECASE)
"""Name and unit of a column: r, r [µm], r (µm), r_(µm), r/µm, r_um, r in µm."""
MODEL = "LU"
COMMA = re.compile(r"^([+-]?\d*),(\d+(?:[eE][+-]?\d+)?)$")
"""A number with a decimal comma."""
LABEL = re.compile(r":(\s|$)")
"""A label of a line that an instrument adds, as in Date: 1.2.2026."""
FORM = "name the radius r and the height z, with units if they have any (r [µm], z [µm])"


def by_heading(columns: Mapping[str, str]) -> dict[str, str]:
    """Return the name of a column by each of its headings; `columns`: headings between commas, by that name."""
    return {heading: name for name, headings in columns.items() for heading in headings.split(", ")}


NAMES = by_heading(COLUMNS)
Row = tuple[int, list[str]]
"""A line of a file: its number and its cells."""


def take_points(scene: Place, folder: Path) -> dict[str, list[float]]:
    """Return the lists r and z, or x and z, of the file in `folder` that the profile of a scene names.

    Both are in one unit, which is put into the scene as the profile's `scale` where none is given: a text, "1 µm", of
    the file's names or of the key `units`, or without units 1, one LU. Empty where the profile names no file; where it
    has lists of its own beside it, and where the file, its units or the scale are wrong, which is reported. Of a
    profile with such an error only its kind remains in the scene.
    """
    profile = scene.find("bodies.profile")
    if not profile or "file" not in profile.inside or not isinstance(profile.inside["file"].value, str):
        return {}
    wrong = file = profile.inside["file"]
    scale, given = profile.inside["scale"], profile.inside["units"]
    if not {"r", "x", "z"}.isdisjoint(profile.value):
        file.doubt()  # a rule reports it
        return {}
    try:
        lists, units = read_profile(folder / file.value, is_scan(profile.value))
        wrong = scale
        sizes = _sizes(units) if units else None
        if not given.absent:
            wrong = given
            if not scale.absent:
                raise ValueError("not together with scale; remove it")
            along, up = _sizes(given.value)
            if sizes and sizes != (along, abs(up)):
                raise ValueError("not together with other units in the file's names; remove it")
            units, sizes = given.value, (along, up)
        if scale.absent:
            scale.put(f"1 {units[0]}" if units else 1.0)
            scale.source = file
        elif units:
            raise ValueError("not together with units in the file's names; remove it")
        elif isinstance(scale.value, str):
            si_value(scale.value, MODEL)
        elif not is_positive(scale):
            raise ValueError(f"must be {described(scale.allowed)}")
        if sizes:
            lists["z"] = [float(sizes[1] / sizes[0]) * value for value in lists["z"]]
        wrong = file
        if units and is_scan(profile.value):
            _require_rising(lists, units)
    except ValueError as error:
        wrong.fault(str(error))
        profile.put({"kind": profile.value["kind"]})
        return {}
    return lists


def _require_rising(lists: dict[str, list[float]], units: Sequence[str]) -> None:
    """Raise ValueError where the heights of a scan decrease outwards, with the key `units` that changes their sign.

    `lists`: "x" and "z"; `units`: of positions and heights, which may have a minus.
    """
    import numpy as np  # which other scenes can do without

    from contact1d.analysis.scan import ScanError, require_rising

    along, up = units
    opposite = up.lstrip("-−") if up[0] in "-−" else f"-{up}"
    try:
        require_rising(np.asarray(lists["x"]), np.asarray(lists["z"]))
    except ScanError as error:
        raise ValueError(f'{error}, or of its unit: units = ["{along}", "{opposite}"]') from None


def _sizes(units: object) -> tuple[Fraction, Fraction]:
    """Return the exact sizes [m] of the units of positions and heights, the latter negative where it has a minus.

    Raises:
        ValueError: they are not the units of two lengths.
    """
    try:
        along, up = map(str, units)  # type: ignore[call-overload]
        length, height = (si_value(f"1 {unit}", MODEL)[0] for unit in (along, up.lstrip("-−")))
    except (ValueError, TypeError):
        raise ValueError('must be the two units of position and height, such as ["µm", "nm"]') from None
    return length, -height if up[0] in "-−" else height


def put_points(scene: Place, lists: dict[str, list[float]]) -> None:
    """Replace, in place, the table bodies.profile of a scene that names a file by one with the file's points.

    It then has its kind, those of the keys centre, level, smooth and fit that it had, and the `lists` by their names, r
    or x, and z, each number times the profile's scale [LU]; file, scale and units are gone. The scale must be a number
    by then. Nothing is done if `lists` is empty or the profile has an error. Where a product is too large for a float,
    that is reported at the scale, and the profile remains as it is.
    """
    profile = scene.find("bodies.profile")
    if not lists or not profile or not profile.sound:
        return
    scale = profile.inside["scale"]
    scaled = {key: [scale.value * value for value in values] for key, values in lists.items()}
    if all(map(math.isfinite, chain(*scaled.values()))):
        profile.source = profile.inside["file"]
        kept = {key: profile.value[key] for key in ("kind", *SCAN_KEYS) if key in profile.value}
        profile.put({**kept, **scaled})
    else:
        scale.fault("is too large for the numbers of the file")


def read_profile(path: Path, scan: bool) -> tuple[dict[str, list[float]], Sequence[str]]:
    """Return (lists of a measured profile by name, units of positions and heights, such as ["µm", "nm"]).

    The lists are "r" and "z", rising from the axis out, where points may begin at the edge, and those from −x to x are
    folded into the mean of both sides. Of a `scan`, and of an instrument's file, they are "x" and "z", all points in
    their order. Numbers are as in the file, heights in their own unit. Without units, which stands for LU, the second
    is empty. Messages name lines and never quote them. Lines that begin with #, empty lines and lines before the table
    are skipped, columns of other names ignored.

    Raises:
        UnreadableError: there is no such file, or it is no text, or has more than 8 MB.
        ProfileFileError: it has more than 100000 lines or no points, a cell is empty or no finite number, a line has
            one column, names or units are not known, or an instrument's file cannot be read. Unless it is a scan, also
            for fewer than four points, heights that rise or fall where radii do not, or two sides that differ.
    """
    if path.suffix.lower() in ENDINGS:
        x, z, unit = read_line(path)
        return {"x": x, "z": z}, (unit, unit)
    rows = rows_in(read_text(path).splitlines())
    columns, units = _header(rows)
    points = [_radius_and_height(f"line {line}", cells, columns) for line, cells in rows]
    if not points:
        raise ProfileFileError("has no points")
    x, z = ([*column] for column in zip(*points, strict=True))
    return {"x": x, "z": z} if scan else _from_the_axis(x, z), units


def _from_the_axis(r: list[float], z: list[float]) -> dict[str, list[float]]:
    """Return {"r": radii, "z": heights} of points that are one side of a profile, or both.

    One side is returned from the axis out, also where it begins at the edge; of both sides, with rising radii from
    below 0, it is their mean. Radii that neither rise nor fall throughout are returned as they are.

    Raises:
        ProfileFileError: the columns seem to be swapped (heights rise or fall throughout, radii do not), both sides
            differ, or there are fewer than four points.
    """
    if _rising(r[::-1]):
        r, z = r[::-1], z[::-1]
    if not _rising(r) and (_rising(z) or _rising(z[::-1])):
        raise ProfileFileError(
            "its heights increase and its radii do not: the columns may be swapped; name them r and z"
        )
    if r[0] < 0.0 and _rising(r) and len(r) >= FEWEST_POINTS:
        r, z = _folded(r, z)
    if len(r) < FEWEST_POINTS:
        raise ProfileFileError(f"must have at least {FEWEST_POINTS} points from the axis out, not {len(r)}")
    return {"r": r, "z": z}


def rows_in(lines: list[str], most: int = 100_000) -> list[Row]:
    """Return (line number from 1, cells as text) of each line of a file that has content.

    Lines that begin with # are left out, and a first line that names a separator, "sep=;". Where no number of the file
    has a decimal point, decimal commas become points.

    Args:
        lines: of the file.
        most: lines that are allowed, with those that are left out; a scene with as many points takes ten seconds to
            run.

    Raises:
        ProfileFileError: there are more lines.
    """
    if len(lines) > most:
        raise ProfileFileError(f"has {len(lines)} lines, at most {most} are allowed; use fewer points")
    full = [(i, line) for i, line in enumerate(lines, 1) if line.strip()[:1] not in ("", "#")]
    if full and re.fullmatch(r"sep=.", full[0][1].strip()):
        del full[0]
    rows = [(i, _cells(line)) for i, line in full]
    if not any("." in cell for _, cells in rows for cell in cells if _number(cell) is not None):
        rows = [(i, [COMMA.sub(r"\1.\2", cell) for cell in cells]) for i, cells in rows]
    return rows


def _cells(line: str) -> list[str]:
    """Return the cells of a line without blanks around them, separated by semicolon, tab, comma or blanks.

    The first of these that it has separates them. If that is a comma, and all of two or more words between blanks are
    numbers with a decimal comma, blanks do.
    """
    separator = next((character for character in ";\t," if character in line), None)
    if separator == "," and len(words := line.split()) > 1 and all(map(COMMA.fullmatch, words)):
        return words
    return [cell.strip() for cell in line.split(separator)]


def _without_preamble(rows: list[Row]) -> None:
    """Remove, in place, the rows before the names of the columns, or before the numbers of a table without names.

    Numbers begin in the first row that has two or more. Names are the last row before it with a known name of heights,
    else the first one with as many cells as the numbers and without a label such as "Date:", whether its names are
    known or not. Without any row of numbers nothing is removed.
    """
    start = next((i for i, (_, cells) in enumerate(rows) if sum(_number(cell) is not None for cell in cells) > 1), 0)
    above = [cells for _, cells in rows[:start]]
    names = [i for i, cells in enumerate(above) if "z" in map(_name, cells) and len(cells) > 1]
    alike = [i for i, cells in enumerate(above) if len(cells) == len(rows[start][1]) and not LABEL.search(cells[0])]
    del rows[: [*names[-1:], *alike, start][0]]


def _name(heading: str) -> str:
    """Return the name in `COLUMNS` of a column, by its heading; "" for one that is not known."""
    match = NAME.match(heading.strip('" '))
    return NAMES.get(match[1].lower(), "") if match else ""


def _header(rows: list[Row]) -> tuple[Sequence[int], Sequence[str]]:
    """Return ((column of radii or positions, column of heights), their units, such as ["µm", "nm"]).

    Columns are indices, (0, 1) without names. Without units, or with LU, the second is empty. The lines of names and
    units, and all lines before them, are removed from `rows`, in place. Units are in the names, or in the next line if
    that has a cell for each name, none of them empty or with a digit.

    Raises:
        ProfileFileError: names or units are not known, only one of the two columns has a unit, there are more than two
            columns without names, or numbers with a decimal comma are separated by commas.
    """
    _without_preamble(rows)
    line, names = rows[0] if rows else (0, ["0"])
    if any(_number(name) is not None for name in names):
        count = sum(map(bool, names))
        if count > 2:
            raise ProfileFileError(f"has {count} columns without names; {FORM}")
        return (0, 1), ()
    del rows[0]
    if rows:
        require_names(*rows[0], names)
    known, below = [*map(_name, names)], rows[0][1] if rows else []
    columns = [_column_of(line, known, name) for name in ("r" if "r" in known else "x", "z")]
    units = [NAME.sub(r"\2", names[column].strip('" ')).strip() for column in columns]
    if not any(units) and len(below) == len(names) and all(below) and not any(map(str.isdigit, "".join(below))):
        units = [below[column].strip('[]()" ') for column in columns]
        del rows[0]
    units = [unit for unit in units if unit not in ("", MODEL)]
    for unit in units:
        try:
            si_value(f"1 {unit}", MODEL)
        except UnitTextError:
            problem = "the unit in the names is not a known length, such as µm"
            raise ProfileFileError(f"line {line}: {problem}; {FORM}; convert volts to lengths first") from None
    if len(units) == 1:
        problem = "only one of radius and height has a unit"
        raise ProfileFileError(f"line {line}: {problem}; give both the same way, r [µm], z [µm]")
    return columns, units


def require_names(line: int, cells: list[str], names: list[str]) -> None:
    """Refuse more whole numbers than names above them: decimal commas between commas that separate columns.

    Nothing is returned. A line is accepted where any cell has something else than a whole number; empty cells do not
    count.

    Args:
        line: number of the line, for the message.
        cells: of this line.
        names: of the columns.

    Raises:
        ProfileFileError: with both counts.
    """
    count = sum(bool(cell) for cell in cells)
    if count > len(names) and all(re.fullmatch(r"[+-]?\d*", cell) for cell in cells):
        raise ProfileFileError(
            f"line {line}: has {count} numbers under {len(names)} names; where numbers have a decimal comma, separate "
            "the columns by a semicolon"
        )


def _column_of(line: int, known: list[str], name: str) -> int:
    """Return the index of the only column of a name, "r", "x" or "z".

    `line`: number of the line, for messages; `known`: names of the columns, "" for one that is not known.

    Raises:
        ProfileFileError: no column or several have the name.
    """
    count = known.count(name)
    if count == 1:
        return known.index(name)
    problem = f"{count} columns match {name}; give this name to one of them"
    if not count:
        problem = f"the names of its {len(known)} columns are not known; {FORM}, or leave them out"
    raise ProfileFileError(f"line {line}: {problem}")


def _rising(values: list[float]) -> bool:
    """Return whether each value exceeds the one before it, so that equal ones do not rise; True of fewer than two."""
    return all(after > before for before, after in pairwise(values))


def _folded(x: list[float], z: list[float]) -> tuple[list[float], list[float]]:
    """Return (radii, heights): the mean of both sides of a profile with rising positions x from −x to x.

    Radii rise from 0, also of an even number of points, without one on the axis: the height there is that of the
    parabola through the three nearest radii, whose slope there may differ from 0, as a cone's. At least two points are
    needed, else ZeroDivisionError.

    Raises:
        ProfileFileError: the two sides differ: positions by more than 0.001 of a mean step, or heights by more than 5 %
            of the highest over the lowest.
    """
    positions, heights = (list(zip(values, values[::-1], strict=True))[len(x) // 2 :] for values in (x, z))
    difference, height, problem = max(abs(right - left) for right, left in heights), max(z) - min(z), ""
    mean_step = (x[-1] - x[0]) / (len(x) - 1)
    if max(abs(right + left) for right, left in positions) > 1e-3 * mean_step:  # less counts as equal
        problem = "their positions differ"
    elif difference > 0.05 * height:  # sides that differ by less are averaged
        problem = f"these differ by {difference / height:.0%} of its height, but the model is a body of revolution"
    if problem:
        raise ProfileFileError(
            f"has both sides of 0, and {problem}; shift it so that the apex is at 0, or give one side, r from 0 on; of "
            'a scan, write centre = "auto" with smooth = "auto" or a fit, and level = true where it is tilted'
        )
    r, z = [0.5 * (right - left) for right, left in positions], [0.5 * (right + left) for right, left in heights]
    if len(x) % 2 == 0 and len(r) >= FEWEST_POINTS:
        slopes = [(z[i] - z[0]) / (r[i] - r[0]) for i in (1, 2)]
        bend = (slopes[1] - slopes[0]) / (r[2] - r[1])
        r, z = [0.0, *r], [z[0] - r[0] * (slopes[0] - bend * r[1]), *z]
    return r, z


def _radius_and_height(line: str, cells: list[str], columns: Sequence[int]) -> list[float]:
    """Return [radius, height] out of the cells of a line by the indices of both columns.

    `line`: its name in messages, "line 3".

    Raises:
        ProfileFileError: the line has too few cells, or one is empty or no finite number.
    """
    if len(cells) <= max(columns):
        count = "has one column" if len(cells) == 1 else f"has {len(cells)} columns"
        raise ProfileFileError(f"{line}: {count}; r and z are needed")
    values = []
    for name, cell in zip("rz", (cells[column] for column in columns), strict=True):
        value, hint = _number(cell), "leave out a line that has no value, or interpolate it"
        if value is None and _number(cell.replace(",", ".")) is not None:
            hint = "write it with a decimal point"
        if value is None or not math.isfinite(value):
            problem = "empty" if not cell.strip() else "not a number" if value is None else value
            raise ProfileFileError(f"{line}: {name} is {problem}; {hint}")
        values.append(value)
    return values


def _number(cell: str) -> float | None:
    """Return the number that a cell has, in double quotes or without, by Python's `float`; None where it is none.

    Infinity and NaN are numbers.
    """
    try:
        return float(cell.strip().strip('"'))
    except ValueError:
        return None
