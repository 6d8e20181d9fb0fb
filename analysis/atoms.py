"""A finished run as ASE atoms: places [LU], bodies, and the force of the opposite body on every particle [FU]."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ase import Atoms

DUMP = "states.lammpstrj"
BODY = ("", "lower", "upper", "lower", "upper", "lower", "upper")
ROLE = ("", "particle", "particle", "anchor", "anchor", "far anchor", "far anchor")
"""What a LAMMPS atom type, from 1 on, is part of."""


def atoms(folder: str | Path, state: int = -1) -> Atoms:
    """Return one of the states that a run reported, by default the last.

    Args:
        folder: the run folder.
        state: index among the states of states.lammpstrj, in the order in which they were passed (a pull-off has the
            zero-load state and then the critical one); negative from the end.

    Returns:
        Atoms of the placeholder species X (the model has no chemistry), in the order of the LAMMPS ids, with the arrays
        "id", "type", "body" ("lower", "upper"), "role" ("particle", "anchor", "far anchor") and "opposite_force", shape
        (n, 3) [FU]; info["timestep"]. The paper's z is z; y is out of the plane.

    Raises:
        FileNotFoundError: the folder holds no states: no run, or one that failed.
        IndexError: there is no such state.
    """
    from ase import Atoms

    path = Path(folder) / DUMP
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: {folder} is no folder of a finished run")
    frames = path.read_text().split("ITEM: TIMESTEP\n")[1:]
    if not -len(frames) <= state < len(frames):
        raise IndexError(f"{path} holds {len(frames)} states, so there is no state {state}")
    head, _, body = frames[state].partition("ITEM: ATOMS ")
    names, _, rows = body.partition("\n")
    columns = dict(zip(names.split(), np.loadtxt(rows.splitlines(), ndmin=2).T, strict=True))
    kinds = columns["type"].astype(int)
    found = Atoms(f"X{len(kinds)}", positions=np.column_stack([columns[axis] for axis in "xyz"]), pbc=False)
    found.info["timestep"] = int(head.split("\n", 1)[0])
    found.arrays["id"] = columns["id"].astype(int)
    found.arrays["type"] = kinds
    found.arrays["body"] = np.asarray(BODY)[kinds]
    found.arrays["role"] = np.asarray(ROLE)[kinds]
    zero = np.zeros(len(kinds))
    found.arrays["opposite_force"] = np.column_stack([columns["opposite_fx"], zero, columns["opposite_fz"]])
    return found
