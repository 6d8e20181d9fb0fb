"""The line of names of a profile's file: which columns are radius and height, and in which units.

Messages never quote the file: a path in a scene may point at any file, and they go to whoever sent the scene.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from contact1d.workflow.scene.si_text import UnitTextError, si_value

RADII = ("r", "radius", "radii", "rho", "ρ")
SIDES = ("x",)
"""Names of a place from one side to the other, which is read where no radius is there."""
HEIGHTS = ("z", "h", "height", "heights")
NAME = re.compile(r"([^\W_]+)\s*(?:\[(.*)\]|\((.*)\)|/\s*(.+)|_(\w+)|\sin\s+(.+)|)$")
MODEL = "LU"
FORM = "name the radius r and the height z, with units if they have any (r [µm], z [µm])"


class HeaderError(ValueError):
    """Names that say nothing or too much; the message says what is wrong."""


@dataclass(frozen=True)
class Header:
    """Places of the two columns, and their units as sizes, "1 µm"; None: none is given."""

    radius: int = 0
    height: int = 1
    radius_unit: str | None = None
    height_unit: str | None = None


def header_of(names: list[str], below: list[str] | None) -> tuple[Header, bool]:
    """What the cells of the line of names say; `below`: those of the next line, and whether these are its units.

    Raises:
        HeaderError: no radius or no height, two of them, or a unit that is no length.
    """
    found = [NAME.match(name.strip().strip('"').lower()) for name in names]
    words = [match[1] if match else "" for match in found]
    places = [_only(words, RADII) if set(words) & set(RADII) else _only(words, SIDES), _only(words, HEIGHTS)]
    if None in places:
        raise HeaderError(f"the names of its {len(names)} columns are not known; {FORM}, or leave the names out")
    radius, height = (place for place in places if place is not None)
    own = [_unit(names[place]) for place in (radius, height)]
    beneath = below is not None and len(below) == len(names) and not any(own)
    if beneath and below is not None:
        own = [below[place].strip().strip('[]()"') for place in (radius, height)]
    if any(own) != all(own):
        raise HeaderError("only one of radius and height has a unit; give both the same way, r [µm], z [µm]")
    units = [_size(unit) for unit in own]
    return Header(radius, height, *units), beneath


def _only(words: list[str], allowed: tuple[str, ...]) -> int | None:
    """Where the one column of an allowed name is; None where there is none."""
    found = [i for i, word in enumerate(words) if word in allowed]
    if len(found) > 1:
        raise HeaderError(f"{len(found)} columns could be meant by {allowed[0]}; name only one so")
    return found[0] if found else None


def _unit(name: str) -> str:
    """The unit in a column's name, or nothing."""
    match = NAME.match(name.strip().strip('"'))
    return next((unit.strip() for unit in match.groups()[1:] if unit), "") if match else ""


def _size(unit: str) -> str | None:
    if unit in ("", MODEL):
        return None
    try:
        si_value(f"1 {unit}", MODEL)
    except UnitTextError:
        raise HeaderError(f"the unit in the names is no length that is known, such as µm; {FORM}") from None
    return f"1 {unit}"
