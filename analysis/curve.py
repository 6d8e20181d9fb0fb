"""Tables of a run: curve.csv, profile.csv, friction.csv; written whole or not at all, read back to the same doubles."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile

Array = NDArray[np.float64]
Column = Sequence[float] | Sequence[str] | Array
CHUNK = 100_000
"""Rows that are turned into text at a time."""


@dataclass(frozen=True)
class Curve:
    """Measured states in the order in which they were passed; sequences of equal length.

    displacement [LU], force [FU], compression positive; contact_radius [LU] and its uncertainty, NaN where there is
    none; smallest_distance between particles of opposite bodies [LU]; branch: "loading" or "unloading".
    """

    displacement: Sequence[float]
    force: Sequence[float]
    contact_radius: Sequence[float]
    smallest_distance: Sequence[float]
    branch: Sequence[str]
    contact_radius_uncertainty: Sequence[float]

    def __post_init__(self) -> None:
        """Check lengths."""
        lengths = {len(getattr(self, field.name)) for field in fields(self)}
        if len(lengths) != 1:
            raise ValueError(f"the columns of a curve must be equally long, got lengths {sorted(lengths)}")


PROFILE_COLUMNS = ("x", "z_lower", "z_upper", "pressure", "shear")


def write_columns(path: Path, columns: Mapping[str, Column]) -> None:
    """Write a CSV file with a header; numbers with 17 digits, NaN as an empty cell."""
    part = path.with_name(path.name + ".part")
    with part.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerow(columns)
        for start in range(0, max(map(len, columns.values())), CHUNK):
            cells = [_cells(column[start : start + CHUNK]) for column in columns.values()]
            file.writelines(f"{','.join(row)}\n" for row in zip(*cells, strict=True))
    os.replace(part, path)


def curve_columns(curve: Curve) -> dict[str, Column]:
    """Return the columns of curve.csv by name."""
    return {field.name: getattr(curve, field.name) for field in fields(curve)}


def read_curve(path: Path) -> Curve:
    """Read curve.csv.

    Raises:
        ValueError: if a column is missing or a cell is no number.
    """
    columns = _read(path, [field.name for field in fields(Curve)])
    numbers = {name: [_number(cell) for cell in cells] for name, cells in columns.items() if name != "branch"}
    return Curve(**numbers, branch=columns["branch"])


def profile_columns(profiles: Mapping[str, Profile]) -> dict[str, Column]:
    """Return the columns of profile.csv: the profiles below each other, the state's name in the last column."""
    numbers = {
        name: np.concatenate([getattr(profile, name) for profile in profiles.values()]) for name in PROFILE_COLUMNS
    }
    return {**numbers, "state": [state for state, profile in profiles.items() for _ in profile.x]}


def read_profiles(path: Path) -> dict[str, Profile]:
    """Read profile.csv: profiles by the names of their states."""
    columns = _read(path, [*PROFILE_COLUMNS, "state"])
    states = list(dict.fromkeys(columns["state"]))
    chosen = np.asarray(columns["state"])
    arrays = {name: np.asarray([_number(cell) for cell in columns[name]]) for name in PROFILE_COLUMNS}
    return {state: Profile(*(arrays[name][chosen == state] for name in PROFILE_COLUMNS)) for state in states}


def _cells(column: Column) -> list[str]:
    """The cells of a column; one `%` operation for all numbers, and each different word is quoted once."""
    if len(column) and isinstance(column[0], str):
        words = {word: _quoted(str(word)) for word in dict.fromkeys(column)}
        return [words[word] for word in column]
    numbers = np.asarray(column, dtype=np.float64)
    cells = ("%.17g\n" * len(numbers) % tuple(numbers.tolist())).split()
    return ["" if cell == "nan" else cell for cell in cells] if np.isnan(numbers).any() else cells


def _quoted(word: str) -> str:
    """A word as one of several cells of a row: alone, an empty one would be quoted."""
    row = io.StringIO()
    csv.writer(row, lineterminator="\n").writerow([word, 0])
    return row.getvalue().removesuffix(",0\n")


def _number(cell: str) -> float:
    return math.nan if cell == "" else float(cell)


def _read(path: Path, names: Sequence[str]) -> dict[str, list[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    missing = [name for name in names if rows and name not in rows[0]]
    if missing or not rows:
        raise ValueError(f"{path}: {'no rows' if not rows else 'no column ' + ', '.join(missing)}")
    return {name: [row[name] for row in rows] for name in names}
