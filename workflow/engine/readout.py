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
    """Return an equal-style variable by its name, or a formula, in units of the deck.

    Raises:
        RefusalError: it is not finite.
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

    In units of the deck; {} on ranks other than 0.

    Raises:
        RefusalError: there are no atoms, no such array, or a number in it is not finite.
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
    """Refuse to go on with a position that is NaN or infinite: LAMMPS itself runs on with it.

    Raises:
        RefusalError: a position is not finite.
    """
    count, invalid = lammps.extract_setting("nlocal"), None
    if count:
        rows = _rows(lammps, "x", count)
        if not np.isfinite(rows).all():
            invalid = rows, _rows(lammps, "id", count)
    if parts := [part for part in world.gather(invalid) or () if part]:
        _require_finite("position", *map(np.concatenate, zip(*parts, strict=True)))


def _require_finite(name: str, rows: Any, identity: Any) -> None:
    """Refuse an array with a number that is NaN or infinite; `identity`: the ids of its atoms, (n,).

    Raises:
        RefusalError: names the first such atom.
    """
    if not np.isfinite(rows).all():
        bad = np.sort(identity[~np.isfinite(rows.reshape(len(rows), -1)).all(axis=1)])
        more = f" (and of {len(bad) - 1} more)" if len(bad) > 1 else ""
        raise RefusalError(f"the {name} of atom {bad[0]}{more} is not a finite number")


def _rows(lammps: Any, name: str, count: int) -> Any:
    """Return the first `count` rows of the per-atom array `name`, as LAMMPS orders them (a view: copy it).

    Raises:
        RefusalError: there is no such array.
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
    """Return the per-atom data of compute, fix or variable `base`, one column of it (from 1) if asked, None if unknown.

    `kind`: c, f or v.
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
    """Return an error in the form of LAMMPS's other errors, which quote the failed command; to be raised."""
    return Exception(f"{error}\nLast input line: {request}")
