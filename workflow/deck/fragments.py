"""Fragments: LAMMPS text with ${variables} whose header says what it needs and what it defines; and blocks.

Two ways of use are recognised as a variable's name: ${name} and v_name. A fragment's header and its text must agree.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files

VARIABLE_USE = re.compile(r"\$\{(\w+)\}|\bv_(\w+)")
KEYS = ("Purpose", "Formula", "Needs", "Defines")
REDEFINES = "Redefines"
"""Optional in a header: names that an earlier fragment has defined, and that are defined anew here."""


class DeckError(RuntimeError):
    """A deck that contradicts the headers of its fragments; an error in the program, never in a scene."""


@dataclass(frozen=True)
class Fragment:
    """One file of `lammps_inputs/fragments`.

    Attributes:
        name: the file's name without `.lmp`.
        text: the whole file.
        needs: names of the LAMMPS variables that must be defined before it, in the order of the header.
        defines: names of variables, and IDs of fixes, computes, dumps and groups, that it defines.
        redefines: IDs and names of earlier fragments that it defines anew.
    """

    name: str
    text: str
    needs: tuple[str, ...]
    defines: tuple[str, ...]
    redefines: tuple[str, ...] = ()

    @cached_property
    def commands(self) -> str:
        """The LAMMPS text without the lines that begin with #; cached."""
        return "".join(line for line in self.text.splitlines(keepends=True) if not line.startswith("#"))


@cache
def fragment(name: str) -> Fragment:
    """Return the fragment in `lammps_inputs/fragments/<name>.lmp`, whose header is compared with its text; cached.

    For a fragment that a deck has several times: with the name "<name>:2" ARM in the text becomes 2, and BEFORE 1.

    Raises:
        FileNotFoundError: there is no such file.
        DeckError: a header line is missing, or a variable is used that is neither needed nor defined, or named as
            needed and not used.
    """
    file, _, arm = name.partition(":")
    text = files("contact1d.lammps_inputs").joinpath("fragments", *f"{file}.lmp".split("/")).read_text(encoding="utf-8")
    if arm:
        text = text.replace("ARM", arm).replace("BEFORE", str(int(arm) - 1))
    header = {key: re.search(rf"^# {key}: (.+)$", text, re.MULTILINE) for key in (*KEYS, REDEFINES)}
    missing = [key for key in KEYS if header[key] is None]
    if missing:
        raise DeckError(f"fragment {name}: the header has no line '# {missing[0]}: …'")
    needs, defines, redefines = (_names(header[key]) for key in ("Needs", "Defines", REDEFINES))
    read = Fragment(name, text, needs, defines, redefines)
    used = used_variables(read.commands)
    for variable in sorted(used - set(needs) - set(defines)):
        raise DeckError(f"fragment {name}: uses {variable}, which its header neither needs nor defines")
    for variable in sorted(set(needs) - used):
        raise DeckError(f"fragment {name}: its header needs {variable}, which its text does not use")
    return read


def used_variables(commands: str) -> set[str]:
    """Return the names of the LAMMPS variables that a piece of LAMMPS text reads, as ${name} or v_name."""
    return {braced or prefixed for braced, prefixed in VARIABLE_USE.findall(commands)}


def _names(line: re.Match[str] | None) -> tuple[str, ...]:
    """Return the names in a header line in order, without "-" and text in brackets (…); () if the line is missing."""
    if line is None:
        return ()
    return tuple(word for word in re.sub(r"\([^)]*\)", " ", line[1]).split() if word != "-")


def indexed(variables: Mapping[str, str]) -> str:
    """Return LAMMPS lines that define variables, `variable NAME index VALUE`; "" for none."""
    return "".join(f"variable        {name} index {value}\n" for name, value in variables.items())


def deleted(names: Iterable[str]) -> str:
    """Return LAMMPS lines that delete variables of these names; "" for none."""
    return "".join(f"variable        {name} delete\n" for name in names)


def block(name: str, variables: Mapping[str, str]) -> str:
    """Return the text of a fragment, with lines that define `variables` between its header and its commands.

    Raises:
        FileNotFoundError: there is no such fragment.
        DeckError: its header and its text do not agree.
    """
    piece = fragment(name)
    header = len(KEYS) + bool(piece.redefines)
    comments = piece.text[: len(piece.text) - len(piece.text.split("\n", header)[header])]
    return comments + indexed(variables) + piece.text[len(comments) :]


def commands(names: Sequence[str]) -> str:
    """Return the commands of fragments of these names, one after the other and without comments; "" for none.

    Raises:
        FileNotFoundError: there is no such fragment.
        DeckError: the header and the text of one do not agree.
    """
    return "".join(fragment(name).commands for name in names)


def listed(name: str, texts: Sequence[str], per_line: int = 6) -> str:
    """Return LAMMPS text `variable NAME index …` with its values, `per_line` of them on each line, continued by "&".

    `texts`: the values in order, one at least.
    """
    lines = [" ".join(texts[start : start + per_line]) for start in range(0, len(texts), per_line)]
    return f"variable        {name} index " + " &\n                ".join(lines) + "\n"
