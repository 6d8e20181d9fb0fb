"""Numbers out of a LAMMPS instance: values and per-atom arrays, checked to be finite, copied, sorted by atom id."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

INDEXED = re.compile(r"(?P<kind>[cfv])_(?P<base>\w+)(?:\[(?P<column>\d+)\])?")
CATEGORIES = {"c": "compute", "f": "fix", "v": "variable"}

ATOM_VARIABLE = 1
"""LMP_VAR_ATOM of `lammps.constants`, which only the worker may import."""


class RefusalError(Exception):
    """A request that cannot be answered; its text is one sentence for the user."""


def read_value(lammps: Any, name: str) -> float:
    """Return an equal-style variable by its name, or else the value of a formula, in units of the LAMMPS input.

    Raises:
        RefusalError: it is None or not finite.
        Exception: LAMMPS cannot evaluate it; quotes the name.
    """
    formula = f"v_{name}" if lammps.has_id("variable", name) else name
    try:
        number = lammps.eval(formula)
    except Exception as error:
        raise _quoting(error, name) from None
    if number is None or not np.isfinite(number):
        raise RefusalError(f"the value of {name!r} is {number}, not a finite number")
    return float(number)


def read_atoms(lammps: Any, names: Sequence[str], world: Any) -> dict[str, Any]:
    """Return copies of per-atom arrays by name, with "id" and "type", a row for each atom, in the order of the ids.

    In units of the LAMMPS input, (n,) or (n, columns); {} on ranks other than 0.

    Raises:
        RefusalError: there are no atoms at all or none on this rank, there is no such array, or a number in it is not
            finite.
        Exception: LAMMPS cannot compute it; quotes the name.
    """
    if not lammps.get_natoms():
        raise RefusalError("atoms were requested, but the box has none")
    count = lammps.extract_setting("nlocal")
    if not count:
        raise RefusalError("one of the ranks has no atoms: use fewer ranks")
    # All ranks compute all arrays before one checks them, or it would wait for a rank that failed.
    parts = world.gather({name: _rows(lammps, name, count) for name in dict.fromkeys(("id", "type", *names))})
    if parts is None:
        return {}
    table = parts[0]
    if len(parts) > 1:
        table = {name: np.concatenate([part[name] for part in parts]) for name in table}
    order = np.argsort(table["id"], kind="stable")  # which is quick on the long runs of rising ids that LAMMPS keeps
    arrays = {name: rows[order] for name, rows in table.items()}
    for name in names:
        _require_finite("position" if name == "x" else name, arrays[name], arrays["id"])
    return arrays


def require_finite_positions(lammps: Any, world: Any) -> None:
    """Raise an error for a position that is NaN or infinite: LAMMPS itself runs on with it.

    Nothing without atoms. Only rank 0 raises, for the atoms of all ranks.

    Raises:
        RefusalError: a position is not finite; names the first such atom.
    """
    count, invalid = lammps.extract_setting("nlocal"), None
    if count:
        rows = _rows(lammps, "x", count)
        if not np.isfinite(rows).all():
            invalid = rows, _rows(lammps, "id", count)
    if parts := [part for part in world.gather(invalid) or () if part]:
        _require_finite("position", *map(np.concatenate, zip(*parts, strict=True)))


def _require_finite(name: str, rows: Any, identity: Any) -> None:
    """Raise an error for an array with a number that is NaN or infinite.

    `rows`: (n,) or (n, columns); `identity`: the ids of its atoms, (n,).

    Raises:
        RefusalError: names the atom with the least id among these, and how many more there are.
    """
    if not np.isfinite(rows).all():
        bad = np.sort(identity[~np.isfinite(rows.reshape(len(rows), -1)).all(axis=1)])
        more = f" (and of {len(bad) - 1} more)" if len(bad) > 1 else ""
        raise RefusalError(f"the {name} of atom {bad[0]}{more} is not a finite number")


def _rows(lammps: Any, name: str, count: int) -> Any:
    """Return the first `count` rows of the per-atom array `name`, as LAMMPS orders them; columns of "x[2]" count from
    1.

    They may be a view of LAMMPS's memory, which the caller has to copy. `name`: a property as "x", or "c_", "f_", "v_"
    with the name of a compute, fix or atom-style variable.

    Raises:
        RefusalError: there is no such array, or it is "mass", which is by type.
        Exception: LAMMPS cannot compute it; quotes the name.
    """
    match = INDEXED.fullmatch(name)
    try:
        data = _styled_rows(lammps, **match.groupdict()) if match else lammps.numpy.extract_atom(name)
    except Exception as error:
        raise _quoting(error, name) from None
    if data is None or len(data) < count or name == "mass":  # LAMMPS lists mass, which is by type, among them
        raise RefusalError(f"LAMMPS has no per-atom array {name!r}")
    return data[:count]


def _styled_rows(lammps: Any, kind: str, base: str, column: str | None) -> Any:
    """Return the per-atom data of a compute, fix or variable `base`, (n,) or (n, columns); None if there is none.

    Args:
        lammps: the instance.
        kind: c, f or v.
        base: its name.
        column: number from 1 on, as text, of the one column that is returned; None for all. A variable has only one,
            and the number is not used.
    """
    category = CATEGORIES[kind]
    if not lammps.has_id(category, base):
        return None
    if kind == "v":
        style = lammps.lib.lammps_extract_variable_datatype(lammps.lmp, base.encode())
        return _variable_rows(lammps, base) if style == ATOM_VARIABLE else None
    # LMP_STYLE_ATOM, and LMP_TYPE_VECTOR, LMP_TYPE_ARRAY, LMP_SIZE_COLS of `lammps.constants`.
    per_atom, vector, array, size_cols = 1, 1, 2, 5
    columns = getattr(lammps, f"extract_{category}")(base, per_atom, size_cols)
    data = getattr(lammps.numpy, f"extract_{category}")(base, per_atom, array if columns else vector)
    return data if column is None else data[:, int(column) - 1]


def _variable_rows(lammps: Any, base: str) -> Any:
    """Return an atom-style variable of the atoms of this rank, (n,), a copy.

    It is copied at once: `lammps.extract_variable` takes 130 ns for each number of it.

    Raises:
        Exception: LAMMPS cannot compute it.
    """
    extract = lammps.lib.lammps_extract_variable
    extract.restype = ctypes.POINTER(ctypes.c_double)
    numbers = extract(lammps.lmp, base.encode(), b"all")
    if not numbers:
        return lammps.extract_variable(base, "all", ATOM_VARIABLE)  # which raises what LAMMPS has to say
    try:
        return np.ctypeslib.as_array(numbers, (lammps.extract_setting("nlocal"),)).copy()
    finally:
        lammps.lib.lammps_free(numbers)


def _quoting(error: Exception, request: str) -> Exception:
    """Return an error, to be raised, with the text of `error` and the line "Last input line: `request`", as LAMMPS's
    own have.
    """
    return Exception(f"{error}\nLast input line: {request}")
