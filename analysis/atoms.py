"""A finished run as ASE atoms: positions [LU], bodies, and the force of the opposite body on every particle [FU]."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ase import Atoms

DUMP = "states.lammpstrj"
BODY = ("", "lower", "upper", "lower", "upper", "lower", "upper", "upper")
ROLE = ("", "particle", "particle", "anchor", "anchor", "far anchor", "far anchor", "driver")
"""Body and role of each LAMMPS atom type, from 1 on."""
COLUMNS = ("id", "type", "x", "y", "z", "opposite_fx", "opposite_fz")
"""Columns of the dump that are read."""


def atoms(folder: str | Path, state: int = -1) -> Atoms:
    """Return one of the states that a run reported, by default the last.

    Args:
        folder: the run folder.
        state: index among the states of states.lammpstrj, in the order of the loading (a pull-off has the zero-load
            state and then the critical one, or with `[output] states` all of its states); negative from the end.

    Returns:
        Atoms of the placeholder species X (the model has no chemistry), in the order of the LAMMPS ids, with positions
            [LU], without cell and periodicity, and with the arrays "id", "type", "body" ("lower", "upper"), "role"
            ("particle", "anchor", "far anchor", "driver": the far end of a cantilever) and "opposite_force", shape (n,
            3) [FU], that of the opposite body on each; info["timestep"]. The paper's z is z; y is out of the plane.

    Raises:
        FileNotFoundError: the folder holds no states: no run, or one that failed.
        IndexError: there is no such state.
        ValueError: the state is cut short or lacks a column.
    """
    from ase import Atoms

    path = Path(folder) / DUMP
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: {folder} is no folder of a finished run")
    frames = path.read_text().split("ITEM: TIMESTEP\n")[1:]
    if not -len(frames) <= state < len(frames):
        raise IndexError(f"{path} holds {len(frames)} states, so there is no state {state}")
    timestep, columns = _frame(frames[state], f"{path}, state {state}")
    kinds = columns["type"].astype(int)
    frame = Atoms(f"X{len(kinds)}", positions=np.column_stack([columns[axis] for axis in "xyz"]), pbc=False)
    frame.info["timestep"] = timestep
    frame.arrays["id"] = columns["id"].astype(int)
    frame.arrays["type"] = kinds
    frame.arrays["body"] = np.asarray(BODY)[kinds]
    frame.arrays["role"] = np.asarray(ROLE)[kinds]
    zero = np.zeros(len(kinds))
    frame.arrays["opposite_force"] = np.column_stack([columns["opposite_fx"], zero, columns["opposite_fz"]])
    return frame


def _frame(text: str, where: str) -> tuple[int, dict[str, NDArray[np.float64]]]:
    """Return timestep and columns of one frame of a dump by name, (n,) each, sorted by the atoms' id.

    The columns are id, type, x, y, z [LU], opposite_fx and opposite_fz [FU], all as float64; others are left out.

    Args:
        text: of the frame, after ITEM: TIMESTEP.
        where: file and state, for a message.

    Raises:
        ValueError: the frame is cut short, or lacks a column.
    """
    head, _, body = text.partition("ITEM: ATOMS ")
    names, _, rows = body.partition("\n")
    words, lines = head.split(), rows.splitlines()
    promised = int(words[words.index("ATOMS") + 1]) if "BOUNDS" in words else None
    if len(lines) != promised or not rows.endswith("\n"):
        raise ValueError(f"{where}: the dump is cut short, the run did not finish writing it")
    if "fy" in names.split():  # where all states are kept, forces have the names that viewers of atoms know
        names = names.replace("fx", "opposite_fx").replace("fz", "opposite_fz")
    header = names.split()
    if missing := [name for name in COLUMNS if name not in header]:
        raise ValueError(f"{where}: no column {', '.join(missing)}")
    values = np.loadtxt(lines, usecols=[header.index(name) for name in COLUMNS], ndmin=2)
    return int(words[0]), dict(zip(COLUMNS, values[np.argsort(values[:, 0])].T, strict=True))
