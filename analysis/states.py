"""Profiles of the states that a run passed, for looking at its whole way: states.npz, whole or not at all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.files import whole

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
