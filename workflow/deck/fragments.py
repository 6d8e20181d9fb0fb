"""Fragments: LAMMPS text with ${variables} whose header says what it needs and what it defines.

Two ways of use are recognised as a variable's name: ${name} and v_name. A fragment's header and its text must agree.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

VARIABLE_USE = re.compile(r"\$\{(\w+)\}|\bv_(\w+)")
KEYS = ("Purpose", "Formula", "Needs", "Defines")


class DeckError(RuntimeError):
    """A deck that is not what its own headers say; a mistake in the program, never in a scene."""


@dataclass(frozen=True)
class Fragment:
    """One file of `lammps_inputs/fragments`.

    Attributes:
        name: the file's name without `.lmp`.
        text: the whole file.
        needs: names of the LAMMPS variables that must be defined before it.
        defines: IDs and names that it defines.
    """

    name: str
    text: str
    needs: tuple[str, ...]
    defines: tuple[str, ...]

    @property
    def commands(self) -> str:
        """The text without its comments."""
        return "".join(line for line in self.text.splitlines(keepends=True) if not line.startswith("#"))


@cache
def fragment(name: str) -> Fragment:
    """Read `lammps_inputs/fragments/<name>.lmp` and hold its header against its text.

    Raises:
        DeckError: if a header line is missing, or a variable is used that is neither needed nor defined, or named as
            needed and not used.
    """
    text = files("contact1d.lammps_inputs").joinpath("fragments", *f"{name}.lmp".split("/")).read_text(encoding="utf-8")
    header = {key: re.search(rf"^# {key}: (.+)$", text, re.MULTILINE) for key in KEYS}
    missing = [key for key, found in header.items() if found is None]
    if missing:
        raise DeckError(f"fragment {name}: the header has no line '# {missing[0]}: …'")
    needs = _names(header["Needs"])
    defines = _names(header["Defines"])
    read = Fragment(name, text, needs, defines)
    used = used_variables(read.commands)
    for variable in sorted(used - set(needs) - set(defines)):
        if not _shared(variable):
            raise DeckError(f"fragment {name}: uses {variable}, which its header neither needs nor defines")
    for variable in sorted(set(needs) - used):
        raise DeckError(f"fragment {name}: its header needs {variable}, which its text does not use")
    return read


def used_variables(commands: str) -> set[str]:
    """Names of the LAMMPS variables that a piece of LAMMPS text reads."""
    return {a or b for a, b in VARIABLE_USE.findall(commands)}


def _names(found: re.Match[str] | None) -> tuple[str, ...]:
    assert found is not None
    return tuple(word for word in re.sub(r"\([^)]*\)", " ", found[1]).split() if word != "-")


def _shared(variable: str) -> bool:
    """Variables that the two lower bodies or the plate define and every step may read."""
    return variable in {"opposite_x", "opposite_z", "plate_rest", "plate_displacement"}
