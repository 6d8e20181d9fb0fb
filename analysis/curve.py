"""Files of a run: curve.csv, profile.csv, friction.csv, states.npz; written whole or not at all, all digits kept."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact1d.analysis.pressure import Profile
from contact1d.files import whole

Array = NDArray[np.float64]
Column = Sequence[float] | Sequence[str] | Array
CHUNK = 100_000
"""Rows that are turned into text at a time."""


@dataclass(frozen=True, eq=False, init=False)
class Curve:
    """Measured states in the order in which they were passed; arrays (n,). Two are equal if they are the same object.

    displacement [LU], force [FU], compression positive; contact_radius [LU] and its uncertainty, NaN where there is
    none; smallest_distance between particles of opposite bodies [LU]; branch: "loading" or "unloading".
    """

    displacement: Array
    force: Array
    contact_radius: Array
    smallest_distance: Array
    branch: NDArray[np.str_]
    contact_radius_uncertainty: Array

    def __init__(
        self,
        displacement: ArrayLike,
        force: ArrayLike,
        contact_radius: ArrayLike,
        smallest_distance: ArrayLike,
        branch: ArrayLike,
        contact_radius_uncertainty: ArrayLike,
    ) -> None:
        """Keep the columns as arrays. Raises ValueError for unequal lengths."""
        columns = (displacement, force, contact_radius, smallest_distance, branch, contact_radius_uncertainty)
        for field, column in zip(fields(self), columns, strict=True):
            kind = np.str_ if field.name == "branch" else np.float64
            object.__setattr__(self, field.name, np.asarray(column, dtype=kind))
        lengths = {len(getattr(self, field.name)) for field in fields(self)}
        if len(lengths) != 1:
            raise ValueError(f"the columns of a curve must be equally long, got lengths {sorted(lengths)}")


PROFILE_COLUMNS = ("x", "z_lower", "z_upper", "pressure", "shear")
FRICTION_COLUMNS = (
    "time", "drive", "plate_x", "plate_z", "friction", "normal_force", "cantilever_force", "cantilever_work",
)  # fmt: skip
"""Of a slide: times [TU], places [LU], forces [FU], work [FU·LU]."""
DETACHMENTS = "detachments"
"""Name of the table, and of the figure, of a thermal pull-off."""
DETACHMENT_COLUMNS = ("seed", "force", "time")
"""Of it, one row for each pull: tension when the bodies part [FU], time since the pull began [TU]."""
SAMPLE_TABLE = "samples"
"""Name of the table, and of the figure, of a contact under heat."""
SAMPLE_COLUMNS = ("time", "load", "displacement", "force", "contact_radius")
"""Of it, one row for each row of the curve: time since the start [TU], forces [FU], places [LU]."""
TANGENTIAL_COLUMNS = (
    "tangential_displacement", "tangential_force", "normal_force", "stick_radius", "stick_radius_uncertainty",
    "dissipated_energy",
)  # fmt: skip
"""Of a tangential, in curve.csv: places [LU], forces [FU], the energy dissipated so far [FU·LU]."""


def write_columns(path: Path, columns: Mapping[str, Column]) -> None:
    """Write a CSV file with a header; numbers with 17 digits, NaN as an empty cell."""
    with whole(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerow(columns)
        for start in range(0, max(map(len, columns.values())), CHUNK):
            cells = [_cells(column[start : start + CHUNK]) for column in columns.values()]
            file.writelines(f"{','.join(row)}\n" for row in zip(*cells, strict=True))


def curve_columns(curve: Curve) -> dict[str, Column]:
    """Return the columns of curve.csv by name."""
    return {field.name: getattr(curve, field.name) for field in fields(curve)}


def read_curve(path: Path) -> Curve:
    """Read curve.csv.

    Raises:
        ValueError: if a column is missing or a cell is no number.
    """
    columns = _read(path, [field.name for field in fields(Curve)])
    numbers = {name: _numbers(cells) for name, cells in columns.items() if name != "branch"}
    return Curve(**numbers, branch=columns["branch"])


def read_friction(path: Path) -> dict[str, Array]:
    """Read friction.csv: FRICTION_COLUMNS by name. Raises ValueError as `read_curve`."""
    return {name: _numbers(cells) for name, cells in _read(path, FRICTION_COLUMNS).items()}


def read_tangential(path: Path) -> dict[str, Array]:
    """Read the TANGENTIAL_COLUMNS of a curve.csv by name. Raises ValueError as `read_curve`."""
    return {name: _numbers(cells) for name, cells in _read(path, TANGENTIAL_COLUMNS).items()}


def read_detachments(path: Path) -> dict[str, Array]:
    """Read detachments.csv: DETACHMENT_COLUMNS by name. Raises ValueError as `read_curve`."""
    return {name: _numbers(cells) for name, cells in _read(path, DETACHMENT_COLUMNS).items()}


def read_samples(path: Path) -> dict[str, Array]:
    """Read samples.csv: SAMPLE_COLUMNS by name. Raises ValueError as `read_curve`."""
    return {name: _numbers(cells) for name, cells in _read(path, SAMPLE_COLUMNS).items()}


def profile_columns(profiles: Mapping[str, Profile]) -> dict[str, Column]:
    """Return the columns of profile.csv: the profiles below each other, the state's name in the last column."""
    numbers = {
        name: np.concatenate([getattr(profile, name) for profile in profiles.values()]) for name in PROFILE_COLUMNS
    }
    return {**numbers, "state": [state for state, profile in profiles.items() for _ in profile.x]}


def read_profiles(path: Path) -> dict[str, Profile]:
    """Read profile.csv: profiles by the names of their states. Raises ValueError as `read_curve`."""
    columns = _read(path, [*PROFILE_COLUMNS, "state"])
    states = list(dict.fromkeys(columns["state"]))
    chosen = np.asarray(columns["state"])
    arrays = {name: _numbers(columns[name]) for name in PROFILE_COLUMNS}
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


def _numbers(cells: Sequence[str]) -> Array:
    return np.asarray([math.nan if cell == "" else float(cell) for cell in cells])


def _read(path: Path, names: Sequence[str]) -> dict[str, Sequence[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = [*csv.reader(file)] or [[]]
    missing = [name for name in names if rows and name not in header]
    if missing or not rows:
        raise ValueError(f"{path}: {'no rows' if not rows else 'no column ' + ', '.join(missing)}")
    columns = dict(zip(header, zip(*rows, strict=True), strict=True))
    return {name: columns[name] for name in names}


Floats = NDArray[np.float32]
MOST_NUMBERS = 200_000
"""Numbers of one kind that are kept: 100 states of 2000 particles. More are thinned, evenly."""


@dataclass(frozen=True, eq=False)
class States:
    """Profiles of m states at n particles, in seven digits: for the eye.

    rows: which row of curve.csv each state is, (m,); x, z_lower, z_upper [LU], pressure and shear [FU/LU], (m, n).
    """

    rows: NDArray[np.int64]
    x: Floats
    z_lower: Floats
    z_upper: Floats
    pressure: Floats
    shear: Floats


def states_of(profiles: Sequence[Profile], kept: Sequence[int] | None = None) -> States:
    """The states of a curve, thinned where they are too many; the first and the last one stay, and the outer particles.

    Args:
        profiles: of each row of the curve, all with the same number of particles.
        kept: the rows whose states are wanted, however many they are; None: as many as is sensible.
    """
    particles = _spread(len(profiles[0].x), MOST_NUMBERS // 2)
    rows = _spread(len(profiles), MOST_NUMBERS // len(particles)) if kept is None else np.asarray(kept, dtype=np.int64)
    columns = {
        name: np.asarray([getattr(profiles[row], name)[particles] for row in rows], dtype=np.float32)
        for name in ("x", "z_lower", "z_upper", "pressure", "shear")
    }
    return States(rows=rows, **columns)


def _spread(count: int, most: int) -> NDArray[np.int64]:
    """At most `most` of the indices below `count`, evenly, both ends among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def write_states(path: Path, states: States) -> None:
    """Write states.npz."""
    with whole(path) as part, part.open("wb") as file:
        np.savez(file, allow_pickle=False, **{field.name: getattr(states, field.name) for field in fields(states)})


def read_states(path: Path) -> States:
    """Read states.npz. Raises OSError or ValueError where it is not one."""
    with np.load(path, allow_pickle=False) as kept:
        missing = [field.name for field in fields(States) if field.name not in kept]
        if missing:
            raise ValueError(f"{path}: no {', '.join(missing)}")
        return States(**{field.name: kept[field.name] for field in fields(States)})
