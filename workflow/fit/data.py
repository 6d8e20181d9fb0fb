"""Measured force curves in CSV files: their columns, units and signs, read or refused with the remedy."""

from __future__ import annotations

import math
from collections.abc import Iterator
from glob import glob
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.curve import APPROACH, HOLD, RETRACT, SEGMENTS, ForceCurve
from contact1d.workflow.fit.plan import FitPlan
from contact1d.workflow.scene.profile_file import NAME, require_names, rows_in, units_of
from contact1d.workflow.scene.si_text import UnitTextError, si_value

if TYPE_CHECKING:
    from pandas import DataFrame, Series

Array = NDArray[np.float64]
COLUMNS = {
    "z": ("z", "piezo", "zpiezo", "z_piezo", "height", "position", "hub", "höhe", "hauteur"),
    "d": ("d", "indentation", "displacement", "depth", "eindringtiefe", "weg", "déplacement"),
    "F": ("f", "force", "load", "kraft", "last", "deflection_force"),
    "segment": ("segment", "richtung", "direction"),
    "t": ("t", "time", "zeit", "temps"),
    "curve": ("curve", "index", "kurve", "courbe"),
    "x": ("x",),
    "y": ("y",),
}
"""Allowed headings of each column, in lower case."""
COLUMN_OF = {heading: name for name, headings in COLUMNS.items() for heading in headings}
TEXT_COLUMNS, MAP_COLUMNS = ("segment", "curve"), ("x", "y")
"""Columns of text, and those of the position of a curve in a map."""
UNITS = {"z": "m", "d": "m", "F": "N", "t": "s"}
PATTERN = "*.csv"
"""Names of the files of curves in a folder."""
FORM = "name the columns with their units, z [nm] (or d [nm]) and F [nN]"
WORDS = {
    APPROACH: ("approach", "trace", "extend", "loading", "annähern", "anfahren", "0"),
    HOLD: ("hold", "pause", "dwell"),
    RETRACT: ("retract", "retrace", "withdraw", "unloading", "rückzug", "1"),
}
"""Words in the column `segment` for each segment of a curve, in lower case."""
LARGEST = 400_000_000
"""Largest size of a file [bytes]: a map of 1000 curves has a tenth of it."""
FEWEST_POINTS, MOST_POINTS = 40, 20_000
"""Least and largest number of points of a curve: a fit of the largest takes seconds, and has a point every few
nanometres in any experiment."""


class DataError(Contact1dError, ValueError):
    """Data that are no force curve; the message says where, why and what to do."""


NamedCurve = tuple[str, tuple[float, float] | None, ForceCurve | DataError]
"""Name of a curve, its position (x, y) in a map or None, and the curve, or the error of reading it."""


def files_of(plan: FitPlan) -> list[Path]:
    """Return the paths of a plan's data files, sorted: one file, all *.csv of a folder, or the matches of a pattern.

    The path or pattern (`*`, `?`, `[`, with `**` for subfolders) is relative to the plan's folder.

    Raises:
        DataError: there is no such file, or one of them is no regular file.
    """
    path = plan.folder / plan.fit.data
    if path.is_dir():
        files = sorted(path.glob(PATTERN))
    elif any(sign in plan.fit.data for sign in "*?["):
        files = sorted(plan.folder / name for name in glob(plan.fit.data, root_dir=plan.folder, recursive=True))
    else:
        files = [path]
    if not files or not all(map(Path.is_file, files)):
        raise DataError(
            f"{path}: no such file, and no folder with {PATTERN}; data is relative to the fit file's folder"
        )
    return files


def curves_of(plan: FitPlan) -> Iterator[NamedCurve]:
    """Yield (name, position (x, y) in a map or None, curve or the error of reading it) of all curves of a plan.

    Curves are in the order of the sorted files and of their lines. A file that cannot be read as a whole gives one
    item: its name without suffix, None and the DataError.

    Raises:
        DataError: at the first item; there is no file.
    """
    for file in files_of(plan):
        try:
            yield from curves(file, plan)
        except DataError as error:
            yield file.stem, None, error


def is_series(plan: FitPlan) -> bool:
    """Return whether the data of a plan are more than one curve; a curve or file that cannot be read counts as one.

    Raises:
        DataError: there is no file.
    """
    return len([*islice(curves_of(plan), 2)]) > 1


def curves(path: Path, plan: FitPlan) -> Iterator[NamedCurve]:
    """Yield (name, position (x, y) in a map or None, curve or the error of reading it) of each curve of a file.

    A curve is a sequence of lines with one entry in the column `curve`, whose name it is, in lower case; without that
    column it is the whole file, with the file's name without suffix. The position has the numbers of its first line as
    they are, maybe NaN.

    Raises:
        DataError: at the first item; the file cannot be read, lacks a column or unit, or has z without a stiffness.
    """
    head = _head(path)
    try:
        table, units = _table(path, head)
        along = "z" if "z" in table else "d"
        if not {along, "F"} <= {*table}:
            raise DataError(f"lacks a column z or d, or F; {FORM}")
        if along == "z" and not math.isfinite(plan.stiffness):
            raise DataError(
                "z is the position of the piezo, to which the instrument's deflection contributes: give [instrument] "
                "stiffness, or a column d, the indentation"
            )
        if unitless := [name for name in (along, "F") if not units.get(name)]:
            raise DataError(f"{' and '.join(unitless)} without a unit; {FORM}")
    except ValueError as error:
        raise DataError(f"{path}: {error}") from None
    groups = table.groupby((table["curve"] != table["curve"].shift()).cumsum()) if "curve" in table else [(1, table)]
    is_map = {*MAP_COLUMNS} <= {*table}
    for _, rows in groups:
        name = rows["curve"].iloc[0] if "curve" in rows else path.stem
        position = next(rows[[*MAP_COLUMNS]].itertuples(index=False, name=None), None) if is_map else None
        try:
            yield name, position, _curve(rows, along, units, plan)
        except DataError as error:
            yield name, position, DataError(f"{path}: {error}")


def _head(path: Path, count: int = 200) -> list[str]:
    """Return the first `count` lines of a file, or all if there are fewer, without line ends and byte-order mark.

    Raises:
        DataError: the file cannot be read, has more than 400 MB, or is no UTF-8 text.
    """
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise DataError(
                f"{path} must have at most {LARGEST} bytes; it has {size}: average neighbouring points, or split the "
                "map into several files"
            )
        with path.open(encoding="utf-8-sig") as file:
            return [line.rstrip("\r\n") for line in islice(file, count)]
    except UnicodeDecodeError:
        raise DataError(f"{path} is not UTF-8 text; export the curve as CSV") from None
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}") from None


def _table(path: Path, head: list[str]) -> tuple[DataFrame, dict[str, str]]:
    """Return (known columns of a file by their standard names, unit of each by name, "" for none).

    Names are z, d, F, segment, curve, x and y, in the order of the file. Rows are indexed by the line in the file, from
    1; empty ones are left out. Numbers are in the units of the file, not finite only in x and y; `segment` and `curve`
    are text in lower case.

    Args:
        path: the file.
        head: its first lines.

    Raises:
        ValueError: no line names F and another column, no line is below it, or a cell is empty or no finite number; the
            message lacks the file's name.
    """
    from pandas import to_numeric

    rows = rows_in(head)
    columns = [_indices(cells) for _, cells in rows]
    start = next((i for i, indices in enumerate(columns) if "F" in indices and len(indices) > 1), None)
    if start is None:
        raise DataError(f"{'is empty' if not rows else 'no line has names of columns that are allowed'}; {FORM}")
    (line, names), (next_line, below), indices = rows[start], (*rows[start + 1 :], (0, []))[0], columns[start]
    require_names(next_line, below, names)
    units, are_below = units_of(names, below, [*indices.values()])
    table = _rows(path, head, line, next_line if are_below else line, [*indices.values()])
    table = table.set_axis([*indices], axis="columns").dropna(how="all")
    for name in indices:
        if name in TEXT_COLUMNS:
            table[name] = table[name].astype(str).str.strip().str.lower()
            continue
        table[name] = to_numeric(table[name], errors="coerce")
        bad = table.index[~np.isfinite(table[name])]
        if bad.size and name not in MAP_COLUMNS:
            raise DataError(f"line {bad[0]}: {name} is empty or no number; leave such lines out ({bad.size} in all)")
    return table, dict(zip(indices, units, strict=True))


def _rows(path: Path, head: list[str], names: int, skip: int, columns: list[int]) -> DataFrame:
    """Return the cells of some columns below a line, in their order, indexed by the line in the file, from 1.

    Comment lines (#) are left out; empty lines are rows of NaN, as are missing cells. Further cells of a line are
    ignored. Cells of a column that has no numbers alone are texts.

    Args:
        path: the file.
        head: its first lines.
        names: the line with the names of the columns, from 1.
        skip: the last line above the cells, from 1.
        columns: the indices of the columns, from 0.

    Raises:
        DataError: there is no line, or the first one has fewer cells than the names.
    """
    from pandas import read_csv

    while skip < len(head) and not head[skip].strip():  # the first line says how many columns there are
        skip += 1
    separator = next((sign for sign in ";\t," if sign in head[names - 1]), r"\s+")
    first = head[skip : skip + 5]
    decimal = "," if separator != "," and any("," in line and "." not in line for line in first) else "."
    try:
        rows = read_csv(
            path, sep=separator, decimal=decimal, skiprows=skip, header=None, usecols=columns, comment="#",
            skip_blank_lines=False, encoding="utf-8-sig", low_memory=False,
        )  # fmt: skip
    except ValueError:  # of pandas: no line at all, or lines of several lengths
        raise DataError(f"the lines below the names have not as many cells as these; {FORM}") from None
    with path.open(encoding="utf-8-sig") as file:
        lines = np.fromiter((i for i, line in enumerate(file, 1) if i > skip and not line.startswith("#")), int)
    return rows[columns].set_axis(lines[: len(rows)], axis="index")


def _indices(cells: list[str]) -> dict[str, int]:
    """Return the index, from 0, of each known column among the cells of a line by its standard name.

    Standard names are z, d, F, segment, curve, x and y; of several cells with one name the first counts. {} where no
    cell is an allowed heading.
    """
    indices: dict[str, int] = {}
    for i, cell in enumerate(cells):
        match = NAME.match(cell.strip('" '))
        name = COLUMN_OF.get(match[1].lower()) if match else None
        if name is not None:
            indices.setdefault(name, i)
    return indices


def _curve(table: DataFrame, along: str, units: dict[str, str], plan: FitPlan) -> ForceCurve:
    """Return the curve in a table of columns, in SI: positions z of the piezo [m] and forces [N], compression positive.

    Columns named by `reverse` in the plan change their sign. An indentation d becomes z = d + F/k_c, or z = d for a
    rigid instrument. Of a curve of which the plan fits one segment, that segment alone.

    Args:
        table: the columns of one curve, in `units`, indexed by the line in the file.
        along: column of the positions, "z" or "d".
        units: of the columns.
        plan: with the instrument.

    Raises:
        DataError: a unit of another dimension, fewer than 40 or more than 20 000 points, a missing segment, a wrong
            sign, no contact, a saturated force, or a gap in the positions.
    """
    reverse = plan.fit.reverse or ()
    columns = {}
    for name in (along, "F", *(["t"] if units.get("t") else [])):
        try:
            factor = float(si_value(f"1 {units[name]}", UNITS[name])[0])
        except UnitTextError as error:
            volts = units[name].endswith("V")
            fault = "is in volts: multiply it by sensitivity and stiffness of the cantilever" if volts else f"{error}"
            raise DataError(f"column {name} {fault}") from None
        sign = -1.0 if name in reverse else 1.0
        columns[name] = sign * factor * np.asarray(table[name], dtype=float)
    z, F = columns[along], columns["F"]
    if z.size < FEWEST_POINTS:
        raise DataError(
            f"has {z.size} points, and at least {FEWEST_POINTS} are needed: approach and retraction at full rate"
        )
    if z.size > MOST_POINTS:
        raise DataError(f"has {z.size} points, and at most {MOST_POINTS} are compared: average neighbouring points")
    kinds = _kinds(z, F, table.get("segment"))
    if math.isfinite(plan.stiffness) and along == "d":
        z = z + F / plan.stiffness
    curve = ForceCurve(z, F, kinds, np.asarray(table.index, dtype=int), columns.get("t"))
    if plan.fit.segment in (APPROACH, RETRACT):
        curve = curve.only(plan.fit.segment)
    _require_segments(curve, plan)
    _require_signs(curve)
    _require_whole(curve, along)
    return curve


def _kinds(z: Array, F: Array, segment: Series | None) -> NDArray[np.int_]:
    """Return the index in `SEGMENTS` of each point of a curve, (n,): by the column `segment`, else by its largest z.

    Without that column the points up to the largest z are the approach, the others the retraction. A curve whose
    largest z is within five points of its first or last one has one segment alone.

    Args:
        z, F: positions, rising towards the sample, and forces, (n,).
        segment: words of the points in lower case, such as "approach", "hold" and "retract"; None: no such column.

    Raises:
        DataError: the words are unknown, segments are in another order, or z is reversed.
    """
    if segment is not None:
        index = {word: SEGMENTS.index(name) for name, words in WORDS.items() for word in words}
        kinds = segment.map(index)
        if kinds.isna().any():
            raise DataError(f"column segment has the word {segment[kinds.isna()].iloc[0]!r}; allowed are {[*index]}")
        found = np.asarray(kinds, dtype=int)
        if (np.diff(found) < 0).any():
            raise DataError("column segment: the approach must come before the retraction")
        return found
    turn, low = (int(extreme(z)) + 1 for extreme in (np.argmax, np.argmin))
    if FEWEST_POINTS // 4 <= low <= z.size - FEWEST_POINTS // 4:
        raise DataError('z is reversed, since the approach lowers it: write reverse = ["z"]')
    least = 5
    turn = z.size if turn > z.size - least else 0 if turn <= least else turn
    return np.where(np.arange(z.size) < turn, 0, 2)


def _require_segments(curve: ForceCurve, plan: FitPlan) -> None:
    """Check that a curve has the segments that a plan fits, with ten points each; nothing is returned.

    Raises:
        DataError: a segment is missing, or shorter.
    """
    counts = {name: curve.of(name).size for name in (APPROACH, RETRACT)}
    wanted = [*counts] if plan.fit.segment == "both" else [plan.fit.segment]
    for name, count in counts.items():
        if count < FEWEST_POINTS // 4 and (count or name in wanted):
            raise DataError(
                f"segment {name} has {count} points, and at least {FEWEST_POINTS // 4} are needed; of a curve of one "
                'segment write segment = "approach" or "retract"'
            )


def _require_signs(curve: ForceCurve) -> None:
    """Check that a curve has a contact, and that positions and forces rise towards the sample; nothing is returned.

    Raises:
        DataError: a column has the opposite sign, with the key that reverses it; or the force does not exceed its
            noise.
    """
    z, F = curve.positions, curve.forces
    first = curve.segments[0].points
    tenth = first.size // 10 + 1
    inwards = F[first][np.argsort(z[first])]
    if inwards[-tenth:].mean() - inwards[:tenth].mean() < -0.2 * float(np.ptp(F)):
        raise DataError('the force falls towards the sample: tension is positive here; write reverse = ["F"]')
    if (z[first[-1]] > z[first[0]]) != (curve.segments[0].name == APPROACH):
        raise DataError('z falls on the approach: it must grow towards the sample; write reverse = ["z"]')
    means = [float(block.mean()) for block in np.array_split(F, 20)]
    if np.ptp(means) < 2.0 * float(np.std(np.diff(F))):  # a contact changes the mean by more than the noise
        raise DataError("the force does not exceed its noise: the curve has no contact, or z and F are swapped")


def _require_whole(curve: ForceCurve, along: str, saturated: int = 6, gap: float = 8.0) -> None:
    """Check that a force is not cut at an end of its range, and that positions have no gaps; nothing is returned.

    Args:
        curve: as it was read.
        along: the column of its positions, for the message.
        saturated: number of points of equal force, within 1e-4 of the range, at an end of it that are no measurement,
            unless that end is the baseline.
        gap: distance of neighbouring positions over its median that is a gap, where it also exceeds a tenth of the
            range of positions.

    Raises:
        DataError: with the number of points, or the line before the gap.
    """
    F, span = curve.forces, float(np.ptp(curve.forces))
    for end, name in ((float(F.max()), "largest"), (float(F.min()), "least")):
        flat = int((np.abs(F - end) <= 1e-4 * span).sum())
        if flat >= saturated and abs(end - curve.baseline) > 0.05 * span:  # bodies apart may have equal forces
            raise DataError(
                f"the force is saturated: {flat} points have its {name} value; lower the trigger force or the gain, or "
                "leave these lines out"
            )
    for points in (segment.points for segment in curve.segments):
        steps = np.abs(np.diff(curve.positions[points]))
        widest = int(np.argmax(steps))
        if steps[widest] > max(gap * float(np.median(steps)), 0.1 * curve.depth):
            line = curve.lines[points][widest]
            raise DataError(
                f"has a gap in {along} after line {line}: give the points between, or the curve up to there"
            )
