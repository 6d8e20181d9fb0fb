"""Files of a run: curve.csv, profile.csv, friction.csv, states.npz; written atomically, with all digits."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.named import Named
from contact1d.analysis.pressure import Array, Profile
from contact1d.files import whole

Column = Sequence[float] | Sequence[str] | Array


class Columns(Named[Any]):
    """The columns of a table by name, arrays (n,); each is also an attribute: `curve.force` is `curve["force"]`.

    Attributes:
        units: of the columns that are in SI, by name; without these, numbers are in units of the model.
    """

    def __init__(self, columns: Mapping[str, Column], units: Mapping[str, str] | None = None) -> None:
        """Make arrays of the columns. Raises ValueError for columns of unequal lengths.

        Args:
            columns: by name.
            units: SI units by column name; None: no column has one.
        """
        super().__init__({name: np.asarray(column) for name, column in columns.items()})
        self.units = dict(units or {})
        if len(lengths := {len(column) for column in self.values()}) > 1:
            raise ValueError(f"the columns of a table must be equally long, got lengths {sorted(lengths)}")


PROFILE_COLUMNS = tuple(field.name for field in fields(Profile))
DETACHMENTS = "detachments"
"""Name of the table, and of the figure, of a thermal pull-off."""
SAMPLE_TABLE = "samples"
"""Name of the table, and of the figure, of a contact with noise."""
HEADER = re.compile(r"(.+) \[(.+)\]")
"""The header of a column with a unit, `force [N]`."""
WORDS = ("branch", "state", "input")
"""Columns of texts."""
FIRST = "=+@\t\r\n\uff1d\uff0b\uff0d\uff20-"
"""Characters at the beginning of a text that a spreadsheet takes for a formula; four are wide ones of Asian fonts."""
FORMULA = re.compile(rf"(?![+-][\d.]+(?:[eE][+-]?\d+)?$)'*[{FIRST}]")
"""A text that begins so, after any apostrophes, and is no number."""
MARKED = f"^'('*[{FIRST}])"
"""Such a text as a cell: with one apostrophe more, which marks it as a text for a spreadsheet."""


def write_columns(path: Path, columns: Mapping[str, Column], units: Mapping[str, str] | None = None) -> None:
    """Write a CSV file, whole or not at all: numbers with 17 digits, NaN as "", ∞ as "inf".

    Texts that a spreadsheet would take for a formula have an apostrophe before. An existing file is replaced.

    Args:
        path: of the file.
        columns: by name, equally long.
        units: SI units of columns, which the header has as in `force [N]`; None: none has one.

    Raises:
        ValueError: columns of unequal lengths.
    """
    with whole(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        put_columns(file, columns, units or {})


def put_columns(file: TextIO, columns: Mapping[str, Column], units: Mapping[str, str]) -> None:
    """Write columns to an open file as CSV: the header, then a line for each index.

    Numbers have 17 digits, NaN is "", texts that a spreadsheet would take for a formula have an apostrophe before.

    Args:
        file: open for text.
        columns: by name, equally long.
        units: of columns by name, written in the header as in `force [N]`.

    Raises:
        ValueError: columns of unequal lengths; a part of them may have been written.
    """
    writer, chunk = csv.writer(file, lineterminator="\n"), 100_000  # rows that are turned into text at a time
    writer.writerow(headed(columns, units))
    for start in range(0, max(map(len, columns.values()), default=0), chunk):
        cells = [_cells(column[start : start + chunk]) for column in columns.values()]
        writer.writerows(zip(*cells, strict=True))


def headed(names: Iterable[str], units: Mapping[str, str]) -> list[str]:
    """Return the names of columns, each with its unit, as in `force [N]`, if `units` has one."""
    return [f"{name} [{units[name]}]" if name in units else name for name in names]


def as_text(cell: Any) -> Any:
    """Return a text that a spreadsheet would take for a formula with an apostrophe before it, `'=1+1`.

    Such a text begins, also after apostrophes, with =, +, -, @, a wide form of these, a tab or the end of a line. A
    number with a sign is no formula. Other cells, texts or not, are returned as they are.
    """
    return f"'{cell}" if isinstance(cell, str) and FORMULA.match(cell) else cell


def plain(cell: str) -> str:
    """Return the text of a cell without the one apostrophe that marks a formula, `=1+1` for `'=1+1`.

    Other cells as they are: an apostrophe goes only where, after any further ones, a character follows with which a
    formula begins.
    """
    return re.sub(MARKED, r"\1", cell)


def _cells(column: Column) -> Sequence[str]:
    """Return the cells of a column as text: numbers with 17 digits, NaN as "", formulas with an apostrophe before.

    The first cell decides whether they are texts or numbers.
    """
    if len(column) and isinstance(column[0], str):
        return [*map(cache(as_text), map(str, column))]  # a few words, over and over
    numbers = np.asarray(column, dtype=np.float64).tolist()
    cells = ("%.17g\n" * len(numbers) % tuple(numbers)).split()
    return ["" if cell == "nan" else cell for cell in cells]


def read_columns(path: Path, needed: Iterable[str] = ()) -> Columns:
    """Return the columns of a table in a CSV file by name, arrays of float64, with NaN for an empty cell, or of texts.

    Texts are the columns `branch`, `state` and `input`, without the apostrophe before a formula. A unit in the header,
    `force [N]`, is put into `units` and no part of the name. A table without rows has empty columns, an empty file
    none.

    Args:
        path: of the CSV file.
        needed: names of columns that the table must have; it then needs a row, too.

    Raises:
        ValueError: if one of those `needed` is missing, a cell is no number, or a row is longer or shorter than the
            others.
        OSError: the file cannot be read.
    """
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = [*csv.reader(file)] or [[]]
    if needed and not rows:
        raise ValueError(f"{path}: no rows")
    parts = [match.groups() if (match := HEADER.fullmatch(name)) else (name, "") for name in header]
    if missing := sorted({*needed} - {name for name, _ in parts}):
        raise ValueError(f"{path}: no column {', '.join(missing)}")
    columns = zip((name for name, _ in parts), zip(*rows, strict=True) if rows else [()] * len(header), strict=True)
    return Columns(
        {
            name: [*map(plain, cells)] if name in WORDS else [float(cell or "nan") for cell in cells]
            for name, cells in columns
        },
        {name: unit for name, unit in parts if unit},
    )


def profile_columns(profiles: Mapping[str, Profile]) -> dict[str, Any]:
    """Return the columns of profile.csv by name: the profiles of one or more states below each other.

    They are `x`, `z_lower`, `z_upper` [LU], `pressure` and `shear` [FU/LU], arrays, and last `state`, a list of the
    state's name for each row. Raises ValueError without a profile.
    """
    numbers = {
        name: np.concatenate([getattr(profile, name) for profile in profiles.values()]) for name in PROFILE_COLUMNS
    }
    return {**numbers, "state": [state for state, profile in profiles.items() for _ in profile.x]}


def by_state(columns: Columns) -> dict[str, Columns]:
    """Return the columns of each state, by the names in the column `state`, without that column.

    The states are in the order of their first rows. Empty if the column is absent.
    """
    if "state" not in columns:
        return {}
    states, numbers = columns.state, {name: column for name, column in columns.items() if name != "state"}
    return {
        name: Columns({key: column[states == name] for key, column in numbers.items()}, columns.units)
        for name in dict.fromkeys(states.tolist())
    }


Floats = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class States:
    """Profiles of m states at n particles, in seven digits (float32), for animations.

    Attributes:
        rows: which row of curve.csv each state is, (m,).
        x, z_lower, z_upper: positions and heights of both surfaces [LU], (m, n).
        pressure, shear: compression positive, and along x [FU/LU], (m, n).
    """

    rows: NDArray[np.int64]
    x: Floats
    z_lower: Floats
    z_upper: Floats
    pressure: Floats
    shear: Floats


def states_of(profiles: Sequence[Profile], kept: Sequence[int] | None = None, most_numbers: int = 200_000) -> States:
    """Return the states of a curve: those of `kept`, else all, thinned evenly with the first and the last one.

    Particles are thinned evenly beyond half of `most_numbers`, with both outer ones. Numbers are float32.

    Args:
        profiles: of each row of the curve, one at least, all with the same number of particles.
        kept: the rows whose states are kept, however many they are; None: as many as most_numbers allows.
        most_numbers: numbers of one kind that are kept: 100 states of 2000 particles.
    """
    particles = _spread(len(profiles[0].x), most_numbers // 2)
    rows = _spread(len(profiles), most_numbers // len(particles)) if kept is None else np.asarray(kept, dtype=np.int64)
    columns = {
        name: np.asarray([getattr(profiles[row], name)[particles] for row in rows], dtype=np.float32)
        for name in PROFILE_COLUMNS
    }
    return States(rows=rows, **columns)


def _spread(count: int, most: int) -> NDArray[np.int64]:
    """Return indices from 0 to count − 1, evenly spread, with both ends: all of them, or `most` where they are more.

    Of `most` = 1 it is 0 alone.
    """
    return np.linspace(0, count - 1, min(count, most)).round().astype(np.int64)


def write_states(path: Path, states: States) -> None:
    """Write the arrays of the states to the file at `path`, whole or not at all; an existing file is replaced."""
    with whole(path) as part, part.open("wb") as file:
        np.savez(file, allow_pickle=False, **vars(states))


def read_states(path: Path) -> States:
    """Return the states in the file states.npz at `path`, arrays as they were written.

    Raises OSError or ValueError where it is no such file, or lacks an array, zipfile.BadZipFile where it is cut short.
    """
    with np.load(path, allow_pickle=False) as kept:
        missing = [field.name for field in fields(States) if field.name not in kept]
        if missing:
            raise ValueError(f"{path}: no {', '.join(missing)}")
        return States(**{field.name: kept[field.name] for field in fields(States)})
