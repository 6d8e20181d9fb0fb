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
from contact1d.workflow.fit.curve import ForceCurve
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
    "curve": ("curve", "index", "kurve", "courbe"),
    "x": ("x",),
    "y": ("y",),
}
"""Names of columns, in small letters."""
KNOWN = {word: name for name, words in COLUMNS.items() for word in words}
WORDS, PLACE = ("segment", "curve"), ("x", "y")
"""Columns that are no numbers, and those of a map's curve."""
UNITS = {"z": "m", "d": "m", "F": "N"}
PATTERN = "*.csv"
"""Curves in a folder."""
FORM = "name the columns with their units, z [nm] (or d [nm]) and F [nN]"
APPROACH = ("approach", "trace", "extend", "loading", "annähern", "anfahren", "0")
RETRACT = ("retract", "retrace", "withdraw", "unloading", "rückzug", "1")
LARGEST = 400_000_000
"""Bytes of a file: a map of 1000 curves has a tenth of them."""
MOST_POINTS = 20_000
"""Points of one curve: a fit takes seconds. More are one every few nanometres in any experiment."""
FEWEST = 40
HEAD_LINES = 200
"""Lines in which the names of columns are looked for."""
SATURATED = 6
"""Points of equal force at an end of it that are no measurement."""
FLAT_PART = 1e-4
"""Range of a force over the largest within which it counts as equal."""
APART = 0.05
"""Distance of an end of the force from that of bodies apart over its range, from which on it may be saturated."""
BLOCKS, RISE = 20, 2.0
"""Parts of a curve whose mean forces differ by so many times its noise, if it has a contact."""
GAP = 8.0
"""Distance of neighbouring positions over the usual one that is a gap."""


class DataError(Contact1dError, ValueError):
    """A file that is no force curve; the message says where, why and what to do."""


NamedCurve = tuple[str, tuple[float, float] | None, ForceCurve | DataError]
"""Name of a curve, its place (x, y) in a map, and the curve, or why it is none."""


def files_of(plan: FitPlan) -> list[Path]:
    """The files of data: one, all of a folder, or those of a pattern. Raises DataError where there is none."""
    place = plan.folder / plan.fit.data
    if place.is_dir():
        found = sorted(place.glob(PATTERN))
    elif any(sign in plan.fit.data for sign in "*?["):
        found = sorted(plan.folder / name for name in glob(plan.fit.data, root_dir=plan.folder, recursive=True))
    else:
        found = [place]
    if not found or not all(map(Path.is_file, found)):
        raise DataError(f"{place}: no such file, and no folder with {PATTERN}; data is looked up beside the fit file")
    return found


def curves_of(plan: FitPlan) -> Iterator[NamedCurve]:
    """All curves of a plan; what is wrong with a file stands for its curve. Raises DataError as `files_of`."""
    for file in files_of(plan):
        try:
            yield from curves(file, plan)
        except DataError as error:
            yield file.stem, None, error


def is_series(plan: FitPlan) -> bool:
    """Whether the data of a plan are more than one curve."""
    return len([*islice(curves_of(plan), 2)]) > 1


def curves(path: Path, plan: FitPlan) -> Iterator[NamedCurve]:
    """The curves of a file: name, place (x, y) of a map, and the curve, or why it is none.

    Raises:
        DataError: nothing in the file can be read.
    """
    head = _head(path)
    try:
        table, units = _table(path, head)
        along = "z" if "z" in table else "d"
        if not {along, "F"} <= {*table}:
            raise DataError(f"its columns are not known; {FORM}")
        if along == "z" and not math.isfinite(plan.stiffness):
            raise DataError(
                "z is the position of the piezo, of which the instrument takes a part: give [instrument] stiffness, or "
                "a column d, the indentation"
            )
        if without := [name for name in (along, "F") if not units.get(name)]:
            raise DataError(f"{' and '.join(without)} without a unit; {FORM}")
    except ValueError as error:
        raise DataError(f"{path}: {error}") from None
    maps = table.groupby((table["curve"] != table["curve"].shift()).cumsum()) if "curve" in table else [(1, table)]
    for _, part in maps:
        name = part["curve"].iloc[0] if "curve" in part else path.stem
        place = next(part[[*PLACE]].itertuples(index=False, name=None), None) if {*PLACE} <= {*part} else None
        try:
            yield name, place, _curve(part, along, units, plan)
        except DataError as error:
            yield name, place, DataError(f"{path}: {error}")


def _head(path: Path) -> list[str]:
    """The first lines of a file. Raises DataError where it is none."""
    try:
        size = path.stat().st_size
        if size > LARGEST:
            raise DataError(
                f"{path} has {size} bytes, and at most {LARGEST} are read: average neighbouring points, or split the "
                "map into files"
            )
        with path.open(encoding="utf-8-sig") as file:
            return [line.rstrip("\r\n") for line in islice(file, HEAD_LINES)]
    except UnicodeDecodeError:
        raise DataError(f"{path} is not UTF-8 text; export the curve as CSV") from None
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}") from None


def _table(path: Path, head: list[str]) -> tuple[DataFrame, dict[str, str]]:
    """The columns that are known, by our names, each row by its line in the file, and their units.

    Raises ValueError.
    """
    from pandas import to_numeric

    rows = rows_in(head)
    start = next((i for i, (_, cells) in enumerate(rows) if "F" in (found := _known(cells)) and len(found) > 1), None)
    if start is None:
        raise DataError(f"{'is empty' if not rows else 'no line has names of columns that are known'}; {FORM}")
    (line, names), (last, below) = rows[start], (*rows[start + 1 :], (0, []))[0]
    known = _known(names)
    require_names(last, below, names)
    units, are_below = units_of(names, below, [*known.values()])
    table = _rows(path, head, line, last if are_below else line, [*known.values()])
    table = table.set_axis([*known], axis="columns").dropna(how="all")
    for name in known:
        if name in WORDS:
            table[name] = table[name].astype(str).str.strip().str.lower()
            continue
        table[name] = to_numeric(table[name], errors="coerce")
        bad = table.index[~np.isfinite(table[name])]
        if bad.size and name not in PLACE:
            raise DataError(f"line {bad[0]}: {name} is empty or no number; leave such lines out ({bad.size} in all)")
    return table, dict(zip(known, units, strict=True))


def _rows(path: Path, head: list[str], names: int, skip: int, columns: list[int]) -> DataFrame:
    """The cells of some columns, by their line in the file, below line `skip`; that of the names is `names`.

    Raises DataError.
    """
    from pandas import read_csv

    while skip < len(head) and not head[skip].strip():  # the first line says how many columns there are
        skip += 1
    separator = next((one for one in ";\t," if one in head[names - 1]), r"\s+")
    decimal = "," if separator != "," and any("," in one and "." not in one for one in head[skip : skip + 5]) else "."
    try:
        rows = read_csv(
            path, sep=separator, decimal=decimal, skiprows=skip, header=None, usecols=columns, comment="#",
            skip_blank_lines=False, encoding="utf-8-sig", low_memory=False,
        )  # fmt: skip
    except ValueError:  # of pandas: no line at all, or lines of several lengths
        raise DataError(f"the lines below the names have not as many cells as these; {FORM}") from None
    with path.open(encoding="utf-8-sig") as file:
        lines = np.fromiter((i for i, one in enumerate(file, 1) if i > skip and not one.startswith("#")), int)
    return rows[columns].set_axis(lines[: len(rows)], axis="index")


def _known(cells: list[str]) -> dict[str, int]:
    """Where the columns are whose names are known; of several of one name the first."""
    found: dict[str, int] = {}
    for i, cell in enumerate(cells):
        match = NAME.match(cell.strip('" '))
        name = KNOWN.get(match[1].lower()) if match else None
        if name is not None:
            found.setdefault(name, i)
    return found


def _curve(table: DataFrame, along: str, units: dict[str, str], plan: FitPlan) -> ForceCurve:
    """One curve. Raises DataError."""
    reverse = plan.fit.reverse or ()
    columns = []
    for name in (along, "F"):
        try:
            factor = float(si_value(f"1 {units[name]}", UNITS[name])[0])
        except UnitTextError as error:
            volts = units[name].endswith("V")
            what = "is in volts: multiply it by sensitivity and stiffness of the cantilever" if volts else f"{error}"
            raise DataError(f"column {name} {what}") from None
        sign = -1.0 if name in reverse else 1.0
        columns.append(sign * factor * np.asarray(table[name], dtype=float))
    z, F = columns
    if z.size < FEWEST:
        raise DataError(f"has {z.size} points, and at least {FEWEST} are needed: approach and retraction at full rate")
    if z.size > MOST_POINTS:
        raise DataError(f"has {z.size} points, and at most {MOST_POINTS} are compared: average neighbouring points")
    turn = _turn(z, table.get("segment"))
    if math.isfinite(plan.stiffness) and along == "d":
        z = z + F / plan.stiffness
    curve = ForceCurve(z, F, turn, np.asarray(table.index, dtype=int))
    _require_signs(curve)
    _require_whole(curve, along)
    return curve


def _turn(z: Array, segment: Series | None) -> int:
    """How many points approach; they come first. Raises DataError where a segment is missing."""
    if segment is not None:
        approaches = np.isin(segment, APPROACH)
        unknown = ~approaches & ~np.isin(segment, RETRACT)
        if unknown.any():
            raise DataError("column segment has words other than approach and retract")
        turn = int(approaches.sum())
        if not approaches[:turn].all():
            raise DataError("column segment: the approach must come before the retraction")
    else:
        turn, low = (int(extreme(z)) + 1 for extreme in (np.argmax, np.argmin))
        if not FEWEST // 4 <= turn <= z.size - FEWEST // 4 and FEWEST // 4 <= low <= z.size - FEWEST // 4:
            raise DataError('z is reversed, since the approach lowers it: write reverse = ["z"]')
    if not FEWEST // 4 <= turn <= z.size - FEWEST // 4:
        raise DataError(
            f"has one segment only ({turn} points approach, {z.size - turn} retract): give both, the approach first"
        )
    return turn


def _require_signs(curve: ForceCurve) -> None:
    """Refuse what would be a contact with other signs only."""
    z, F = curve.positions, curve.forces
    low, high = (
        F[np.argsort(z[: curve.turn])[part]].mean()
        for part in (slice(0, curve.turn // 10 + 1), slice(-(curve.turn // 10 + 1), None))
    )
    span = float(np.ptp(F))
    if high - low < -0.2 * span:
        raise DataError('the force falls towards the sample: tension is positive here; write reverse = ["F"]')
    if z[curve.turn - 1] < z[0]:
        raise DataError('z falls on the approach: it must grow towards the sample; write reverse = ["z"]')
    blocks = [float(part.mean()) for part in np.array_split(F, BLOCKS)]
    if np.ptp(blocks) < RISE * float(np.std(np.diff(F))):
        raise DataError("the force does not leave its noise: no contact is in the curve, or z and F are swapped")


def _require_whole(curve: ForceCurve, along: str) -> None:
    """Refuse a force that is cut at an end of its range, and positions with gaps."""
    F, span = curve.forces, float(np.ptp(curve.forces))
    for end, what in ((float(F.max()), "largest"), (float(F.min()), "least")):
        flat = int((np.abs(F - end) <= FLAT_PART * span).sum())
        if flat >= SATURATED and abs(end - curve.baseline) > APART * span:
            raise DataError(
                f"the force is saturated: {flat} points have its {what} value; lower the trigger force or the gain, or "
                "leave these lines out"
            )
    for points in (slice(0, curve.turn), slice(curve.turn, None)):
        steps = np.abs(np.diff(curve.positions[points]))
        usual = float(np.median(steps))
        at = int(np.argmax(steps))
        if steps[at] > GAP * usual and steps[at] > 0.1 * curve.depth:
            line = curve.lines[points][at]
            raise DataError(
                f"has a gap in {along} after line {line}: give the points between, or the curve up to there"
            )
