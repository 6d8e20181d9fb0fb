"""Files of a run: curve.csv, profile.csv, friction.csv, states.npz; written atomically, with all digits."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Array, Profile
from contact1d.files import whole

Column = Sequence[float] | Sequence[str] | Array
CHUNK = 100_000
"""Rows that are turned into text at a time."""


@dataclass(frozen=True, eq=False)
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

    def __post_init__(self) -> None:
        """Check the lengths. Raises ValueError for unequal ones."""
        lengths = {len(column) for column in vars(self).values()}
        if len(lengths) != 1:
            raise ValueError(f"the columns of a curve must be equally long, got lengths {sorted(lengths)}")


PROFILE_COLUMNS = tuple(field.name for field in fields(Profile))
FRICTION_COLUMNS = (
    "time", "drive", "plate_x", "plate_z", "friction", "normal_force", "cantilever_force", "cantilever_work",
)  # fmt: skip
"""Of a slide: times [TU], positions [LU], forces [FU], work [FU·LU]."""
DETACHMENTS = "detachments"
"""Name of the table, and of the figure, of a thermal pull-off."""
DETACHMENT_COLUMNS = ("seed", "force", "time")
"""Of it, one row for each pull: tension when the bodies separate [FU], time since the pull began [TU]."""
SAMPLE_TABLE = "samples"
"""Name of the table, and of the figure, of a contact with noise."""
SAMPLE_COLUMNS = ("time", "load", "displacement", "force", "contact_radius")
"""Of it, one row for each row of the curve: time since the start [TU], forces [FU], positions [LU]."""
TANGENTIAL_COLUMNS = (
    "tangential_displacement", "tangential_force", "normal_force", "stick_radius", "stick_radius_uncertainty",
    "dissipated_energy",
)  # fmt: skip
"""Of a tangential, in curve.csv: positions [LU], forces [FU], the energy dissipated so far [FU·LU]."""


def write_columns(path: Path, columns: Mapping[str, Column]) -> None:
    """Write a CSV file with a header; numbers with 17 digits, NaN as an empty cell."""
    with whole(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for start in range(0, max(map(len, columns.values())), CHUNK):
            cells = [_cells(column[start : start + CHUNK]) for column in columns.values()]
            writer.writerows(zip(*cells, strict=True))


def _cells(column: Column) -> Sequence[str]:
    """The cells of a column; one `%` operation for all numbers."""
    if len(column) and isinstance(column[0], str):
        return [str(word) for word in column]
    numbers = np.asarray(column, dtype=np.float64).tolist()
    cells = ("%.17g\n" * len(numbers) % tuple(numbers)).split()
    return ["" if cell == "nan" else cell for cell in cells]


def read_columns(path: Path, names: Iterable[str]) -> dict[str, Array]:
    """Read columns of numbers, as `write_columns` has them, by name.

    Raises:
        ValueError: if a column is missing or a cell is no number.
    """
    return {name: _numbers(cells) for name, cells in _read(path, names).items()}


def read_curve(path: Path) -> Curve:
    """Read curve.csv. Raises ValueError as `read_columns`."""
    columns = _read(path, [field.name for field in fields(Curve)])
    branch = np.asarray(columns.pop("branch"))
    return Curve(**{name: _numbers(cells) for name, cells in columns.items()}, branch=branch)


def profile_columns(profiles: Mapping[str, Profile]) -> dict[str, Column]:
    """Return the columns of profile.csv: the profiles below each other, the state's name in the last column."""
    numbers = {
        name: np.concatenate([getattr(profile, name) for profile in profiles.values()]) for name in PROFILE_COLUMNS
    }
    return {**numbers, "state": [state for state, profile in profiles.items() for _ in profile.x]}


def read_profiles(path: Path) -> dict[str, Profile]:
    """Read profile.csv: profiles by the names of their states. Raises ValueError as `read_columns`."""
    columns = _read(path, [*PROFILE_COLUMNS, "state"])
    states = np.asarray(columns.pop("state"))
    numbers = [_numbers(cells) for cells in columns.values()]
    return {
        state: Profile(*(column[states == state] for column in numbers)) for state in dict.fromkeys(states.tolist())
    }


def _numbers(cells: Sequence[str]) -> Array:
    return np.asarray([float(cell or "nan") for cell in cells])


def _read(path: Path, names: Iterable[str]) -> dict[str, Sequence[str]]:
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = [*csv.reader(file)] or [[]]
    if not rows:
        raise ValueError(f"{path}: no rows")
    if missing := [name for name in names if name not in header]:
        raise ValueError(f"{path}: no column {', '.join(missing)}")
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
        for name in PROFILE_COLUMNS
    }
    return States(rows=rows, **columns)


def _spread(count: int, most: int) -> NDArray[np.int64]:
    """At most `most` of the indices below `count`, evenly, both ends among them."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.int64))


def write_states(path: Path, states: States) -> None:
    """Write states.npz."""
    with whole(path) as part, part.open("wb") as file:
        np.savez(file, allow_pickle=False, **vars(states))


def read_states(path: Path) -> States:
    """Read states.npz. Raises OSError or ValueError where it is not one."""
    with np.load(path, allow_pickle=False) as kept:
        missing = [field.name for field in fields(States) if field.name not in kept]
        if missing:
            raise ValueError(f"{path}: no {', '.join(missing)}")
        return States(**{field.name: kept[field.name] for field in fields(States)})
