"""Measured force curves in files: text of any layout and encoding, and files of instruments, read or refused."""

from __future__ import annotations

import codecs
import math
import re
from collections.abc import Iterator
from functools import partial
from glob import glob
from io import StringIO
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from contact1d.workflow.fit.curve import APPROACH, RETRACT, ForceCurve
from contact1d.workflow.fit.headings import FORM, UNITS, Column, chosen_columns, dimension, known_columns
from contact1d.workflow.fit.headings import DataError as DataError
from contact1d.workflow.fit.instrument_curves import ENDINGS, NamedTable, instrument_curves
from contact1d.workflow.fit.plan import STIFFNESS, FitPlan
from contact1d.workflow.fit.points import averaged, in_time, require_signs, require_whole, told_kinds
from contact1d.workflow.scene.profile_file import require_names, rows_in
from contact1d.workflow.scene.si_text import si_value

if TYPE_CHECKING:
    from pandas import DataFrame

PATTERN = "*.csv"
"""Names of the files of curves in a folder."""
NUMBER = re.compile(r'"?[-+]?[\d.,]*\d(e[-+]?\d+)?"?|nan', re.IGNORECASE)
REMARK = re.compile(r"^\s*[#%]+\s*(?:\w+:\s+)?")
"""Beginning of a line of remarks, maybe with a label, "# columns: "."""
FEWEST_POINTS = 40
"""Least number of points of a curve; a segment has a quarter of it."""

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
            f"{path}: no such file, and no folder with {PATTERN}; data is relative to the fit file's folder, and may "
            f'be a pattern, such as "{plan.fit.data}/*.txt"'
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

    A curve of a text file is a sequence of lines with one entry in the column `curve`, whose name it is, in lower case;
    without that column it is the whole file, with the file's name without suffix. The position has the numbers of its
    first line as they are, maybe NaN.

    Raises:
        DataError: at the first item; the file cannot be read, lacks a column or unit, or has z without a stiffness.
    """
    try:
        tables = instrument_curves(path, plan) if path.name.lower().endswith(ENDINGS) else _text_curves(path, plan)
        for name, position, table in tables:
            try:
                yield name, position, _curve(table(), plan)
            except DataError as error:
                yield name, position, DataError(f"{path}: {error}")
    except (ValueError, OSError) as error:
        raise DataError(f"{path}: {getattr(error, 'strerror', None) or error}") from None


def _lines(path: Path, largest: int = 400_000_000) -> list[str]:
    """Return the lines of a text file in UTF-16 or UTF-8, or else Windows' code page 1252, without line ends.

    Args:
        path: the file.
        largest: most bytes that it may have: a map of 1000 curves has a tenth of it.

    Raises:
        DataError: it has more bytes, or is no text.
        OSError: it cannot be read.
    """
    if path.stat().st_size > largest:
        raise DataError(f"has more than {largest} bytes: split the map into several files")
    content = path.read_bytes()
    is_wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    if b"\0" in content and not is_wide:
        raise DataError(
            f"is no text, nor a file of an instrument that is known ({', '.join(ENDINGS)}): unpack an archive, or "
            "export the curve as CSV"
        )
    try:
        return content.decode("utf-16" if is_wide else "utf-8-sig").splitlines()
    except UnicodeDecodeError:
        return content.decode("cp1252", "replace").splitlines()


def _text_curves(path: Path, plan: FitPlan) -> Iterator[NamedTable]:
    """Yield (name, position in a map or None, function that reads the columns in SI) of each curve of a text file.

    Raises:
        ValueError: the file cannot be read as a whole; the message lacks its name.
        OSError: it cannot be opened.
    """
    from pandas import Series

    lines = _lines(path)
    first, headings, units = _header(lines)
    columns = chosen_columns(headings, known_columns(headings, units), not math.isfinite(plan.stiffness))
    rows, shared = _rows(lines, first, columns), next(iter(columns.values()))
    names = Series(path.stem, rows.index)
    if "curve" in shared:
        cells = rows[shared["curve"].index].astype(str).str.strip().str.lower()
        names = names if cells.is_unique else cells  # unique ones count the points
    for _, part in names.groupby((names != names.shift()).cumsum()):
        line = rows.loc[part.index[0]]
        x, y = (float(line[shared[axis].index]) if axis in shared else math.nan for axis in "xy")
        yield part.iloc[0], (x, y) if "y" in shared else None, partial(_columns, rows.loc[part.index], columns)


def _header(lines: list[str], most: int = 2000) -> tuple[int, list[str], list[str]]:
    """Return (index of the first line of numbers, headings of the columns, their units in a line of their own or []).

    Numbers begin in the first of three lines with two numbers or more. The headings are in the line above, maybe one of
    remarks, that names positions and forces; the nearest one, if there are several.

    `most`: number of lines in which the numbers begin.

    Raises:
        ValueError: there is no such line.
    """
    rows = rows_in(lines[:most])
    numeric = [sum(bool(NUMBER.fullmatch(cell)) for cell in cells) > 1 for _, cells in rows]
    start = next((i for i in range(len(rows)) if all(numeric[i : i + 3])), None)
    if start is None:
        raise DataError(f"{'has no lines with two numbers or more' if rows else 'is empty'}; {FORM}")
    first, cells = rows[start]
    above = [*map(_cells, lines[: first - 1])] or [[]]
    line = max(range(len(above)), key=lambda i: (len(known_columns(above[i])), i))
    require_names(first, cells, above[line] or cells)
    below = ([cell.strip("[]()") for cell in cells] for cells in above[line + 1 :])
    units = next((units for units in below if sum(map(bool, map(dimension, units))) > 1), [])
    return first - 1, above[line], units


def _cells(line: str) -> list[str]:
    """Return the cells of a line of headings, without a sign of remarks and a label before them.

    They are separated by semicolon, tab or comma, else in quotes, else by two blanks or one; units remain behind names.
    """
    text = REMARK.sub("", line)
    separator = next((sign for sign in ";\t," if sign in text), None)
    if separator is None and '"' in text:
        return re.findall(r'"([^"]*)"', text)
    if separator is None:
        text, separator = text.strip(), r"\s{2,}" if "  " in text.strip() else r"(?<!/)\s+(?![\[(/])"
    return [cell.strip('" ') for cell in re.split(separator, text)]


def _rows(lines: list[str], first: int, columns: dict[str, dict[str, Column]]) -> DataFrame:
    """Return the cells of columns below the headings by their index, indexed by the line in the file, from 1.

    Remarks (#) and empty lines are left out; missing cells are NaN. Cells of a column that has no numbers alone are
    texts.

    Args:
        lines: of the file.
        first: index of the first line of cells.
        columns: by segment and by name.

    Raises:
        DataError: the lines have fewer cells than the headings, or more than the first line.
    """
    from pandas import read_csv

    count = len(rows_in([lines[first]])[0][1])
    separator = next(sign for sign in (";", "\t", ",", r"\s+") if len(re.split(sign, lines[first].strip())) == count)
    is_comma = separator != "," and any("," in line and "." not in line for line in lines[first : first + 5])
    full = [i for i in range(first, len(lines)) if lines[i].strip() and not lines[i].startswith("#")]
    try:
        rows = read_csv(
            StringIO("\n".join(lines[i] for i in full)), sep=separator, decimal="," if is_comma else ".", header=None,
            usecols=sorted({column.index for known in columns.values() for column in known.values()}), low_memory=False,
        )  # fmt: skip
    except ValueError:  # of pandas: lines of several lengths
        raise DataError(f"the lines below the names have not as many cells as these; {FORM}") from None
    return rows.set_axis(np.array(full) + 1, axis="index")


def _columns(rows: DataFrame, columns: dict[str, dict[str, Column]]) -> DataFrame:
    """Return the columns of a curve by name, in SI, segment after segment, indexed by the line in the file.

    Segments that are side by side in the file have the same lines.

    Args:
        rows: cells by the index of their column.
        columns: by segment ("" for none) and by name.

    Raises:
        DataError: a cell is empty or no finite number.
    """
    from pandas import concat, to_numeric

    shared = set.intersection(*({*known.values()} for known in columns.values()))
    sides = []
    for side, known in columns.items():
        part = rows[[column.index for column in known.values()]].set_axis([*known], axis="columns")
        unshared = [name for name, column in known.items() if column not in shared]
        part = part.dropna(how="all", subset=unshared or [*known])
        for name in filter(UNITS.get, known):
            numbers = to_numeric(part[name], errors="coerce")
            bad = part.index[~np.isfinite(numbers)]
            if bad.size:
                raise DataError(
                    f"line {bad[0]}: {name} is empty or no number; leave such lines out ({bad.size} in all)"
                )
            part[name] = float(si_value(f"1 {known[name].unit}", UNITS[name])[0]) * numbers
        sides.append(part.assign(segment=side) if side else part)
    return concat(sides)


def _curve(table: DataFrame, plan: FitPlan) -> ForceCurve:
    """Return the curve in a table of columns, in SI: positions z of the piezo [m] and forces [N], compression positive.

    Columns named by `reverse` in the plan change their sign. An indentation d becomes z = d + F/k_c, or z = d for a
    rigid instrument; a deflection becomes the force k_c times it. Of a curve of which the plan fits one segment, that
    segment alone; of one of more than 20 000 points means of neighbours.

    Args:
        table: the columns of one curve, in SI, indexed by the line in the file.
        plan: with the instrument.

    Raises:
        DataError: fewer than 40 points, a missing segment, a wrong sign, no contact, a saturated force, or a gap in the
            positions; or a deflection whose stiffness has a ±, in which all forces would change together.
    """
    along, kinds = "z" if "z" in table else "d", told_kinds(table["segment"]) if "segment" in table else None
    if kinds is not None:
        table, kinds = table[kinds >= 0], kinds[kinds >= 0]
    if len(table) < FEWEST_POINTS:
        raise DataError(
            f"has {len(table)} points, and at least {FEWEST_POINTS} are needed: approach and retraction at full rate"
        )
    if "deflection" in table:
        if plan.known.get(STIFFNESS):
            raise DataError(
                "F is a deflection times the stiffness, which has a ±: write the stiffness without it; its relative ± "
                "adds to those of moduli and works of adhesion, which are proportional to it"
            )
        table = table.assign(F=plan.stiffness * table["deflection"])
    reverse = {str(name) for name in plan.fit.reverse or ()} & {along, "F"}
    z, F = (table[name].to_numpy(dtype=float) for name in (along, "F"))
    require_signs(along, z, F, reverse)
    z, F = (-x if name in reverse else x for name, x in ((along, z), ("F", F)))
    order, kinds = in_time(along, z, F, kinds, "t" not in table and not table.index.is_unique)
    z, F, lines = z[order], F[order], table.index.to_numpy(dtype=int)[order]
    if math.isfinite(plan.stiffness) and along == "d":
        z = z + F / plan.stiffness
    t = table["t"].to_numpy(dtype=float) if "t" in table and table["t"].is_monotonic_increasing else None
    curve = averaged(ForceCurve(z, F, kinds, lines, t))
    if plan.fit.segment in (APPROACH, RETRACT):
        curve = curve.only(plan.fit.segment)
    _require_segments(curve, plan)
    require_whole(curve, along)
    return curve


def _require_segments(curve: ForceCurve, plan: FitPlan) -> None:
    """Check that a curve has the segments that a plan fits, with ten points each; nothing is returned.

    Raises:
        DataError: a segment is missing, or shorter.
    """
    counts, fewest = {name: curve.of(name).size for name in (APPROACH, RETRACT)}, FEWEST_POINTS // 4
    wanted = [*counts] if plan.fit.segment == "both" else [plan.fit.segment]
    for name, count in counts.items():
        if count < fewest and (count or name in wanted):
            raise DataError(
                f"segment {name} has {count} points, and at least {fewest} are needed; of a curve of one "
                'segment write segment = "approach" or "retract"'
            )
