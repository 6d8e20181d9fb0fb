"""The kinds of files that commands read, and which command reads which."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextlib import suppress
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from contact1d.workflow.scene.instrument_file import ENDINGS
from contact1d.workflow.scene.problems import Problem, SceneError

COMMANDS = {"scene": "run", "fit file": "fit", "sweep file": "sweep", "material file": "identify"}
"""The command that reads each kind of file."""
RECORDS = {
    "results.json": ("a run", "contact1d report {0} shows them, contact1d run {0}/scene.toml repeats them"),
    "fit.json": ("a fit", "contact1d report {0} shows them, contact1d run {0}/scene.toml runs the fitted scene"),
    "fits.csv": ("fits", "its columns are the parameters with their intervals"),
    "sweep.toml": ("a sweep", "contact1d report {0} shows them, contact1d sweep {0}/sweep.toml repeats them"),
}
"""What a folder has the results of, and what to do with it, by the name of a file in it."""
NUMBERS = re.compile(rb"(?m)^[\s\"]*[-+]?\d[\w.,+-]*\"?[\s;,]+\"?[-+]?\d")
KEY = re.compile(rb"(?m)^\s*[\w.\"]+\s*=|^\s*\[+\w")
"""A line that begins with two numbers, and one with a key or a table in TOML."""
SHAPES, MATERIALS = {"radius", "profile"}, {"upper", "lower", "contact_modulus"}
"""Keys at the top of a material file, of which it has one each at least."""


def kind_of(tables: Mapping[str, Any]) -> str:
    """Return the kind of file, a key of `COMMANDS`, that has such names at its top; "" if none is clear."""
    keys = {*tables}
    if "axes" in keys:
        return "sweep file"
    if keys & {"data", "parameters", "instrument"}:
        return "fit file"
    if "bodies" in keys:
        return "scene"
    return "material file" if keys & SHAPES and keys & MATERIALS else ""


def require_kind(tables: Mapping[str, Any], wanted: str, source: object) -> None:
    """Refuse the tables of a file of another kind than the `wanted` one; nothing is returned.

    `source`: path of the file; anything else for tables.

    Raises:
        SceneError: with the command that reads such a file.
    """
    kind = kind_of(tables)
    if kind not in ("", wanted):
        file = fspath(source) if isinstance(source, str | PathLike) else ""
        hint = f"run it with contact1d {COMMANDS[kind]} {file}".strip()
        raise SceneError([Problem(file or "tables", f"this is a {kind}, not a {wanted}", hint=hint)])


def require_tables(path: Path) -> None:
    """Refuse a path that can't be read as TOML since it is a folder of results, or a table of numbers; else do nothing.

    Raises:
        SceneError: with what it is, and the command for it.
    """
    folder, content = path.parent if path.name in RECORDS and path.suffix != ".toml" else path, b""
    with suppress(OSError):  # its own message is better
        for name, (results, advice) in RECORDS.items():
            if (folder / name).exists():
                raise SceneError([Problem(str(path), f"has the results of {results}", hint=advice.format(folder))])
        if path.is_file():
            with path.open("rb") as file:
                content = file.peek().replace(b"\0", b"")
    is_instrument = path.suffix in ENDINGS or path.suffix.startswith(".jpk")
    if is_instrument or (NUMBERS.search(content) and not KEY.search(content)):
        hint = f'name it in a fit file, data = "{path.name}", for contact1d fit, or in the profile of a scene'
        raise SceneError([Problem(str(path), "has data, and no tables in TOML", hint=hint)])
