"""Headings of the columns of a force curve: the quantity, the unit and the segment that each of them names."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.curve import APPROACH, HOLD, RETRACT
from contact1d.workflow.scene.si_text import UnitTextError, si_value

QUANTITIES = {
    "z": "z piezo zpiezo zsensor zsnsr height ramp position hub höhe hauteur",
    "d": "d indentation displacement disp depth penetration separation tip eindringtiefe weg déplacement enfoncement",
    "F": "f fn fz force load deflection defl kraft last",
    "deflection": "deflection defl",
    "segment": "segment direction richtung",
    "t": "t time zeit temps",
    "curve": "curve index kurve courbe",
    "x": "x",
    "y": "y",
}
"""Words that name each column, in lower case."""
UNITS = {"z": "m", "d": "m", "F": "N", "deflection": "m", "t": "s"}
"""SI units of the columns that need a unit."""
SEGMENT_WORDS = {
    APPROACH: "approach appr extend ext ex trace forward load loading annähern annäherung anfahren belastung approche",
    HOLD: "hold holding pause dwell halten maintien",
    RETRACT: "retract retraction retr ret rt retrace backward withdraw unload unloading rückzug entlastung retrait",
}
"""Words for each segment of a curve, in lower case."""
FORM = "name the columns with their units, z [nm] (or d [nm]) and F [nN]"
ENCLOSED = re.compile(r"[\[(]([^\[\]()]*)[\])]|(?:/|\bin\b)\s*(\S+)\s*$", re.IGNORECASE)
"""A unit in brackets, or at the end behind "/" or "in"."""
BARE = re.compile(r"[fpnuµμmck]?[mN]|[nuµμm]?s|min|Å|microns?|\w*V")
"""A unit that is a word of a heading; words that end with V name a voltage."""


class DataError(Contact1dError, ValueError):
    """Data that are no force curve; the message says where, why and what to do."""


@dataclass(frozen=True)
class Column:
    """A column of a file.

    Attributes:
        name: what it has, a key of `QUANTITIES`.
        index: of its cells in a line, from 0.
        heading: as in the file.
        unit: as in the file; "" without one.
        segment: that the heading names; "" for none.
    """

    name: str
    index: int
    heading: str
    unit: str
    segment: str

    @property
    def fits(self) -> bool:
        """Whether the column has a unit of the dimension that its name needs, if any."""
        return self.name in "xy" or UNITS.get(self.name, "") == dimension(self.unit)


@cache
def dimension(unit: str) -> str:
    """Return "m", "N", "s" or "V", the SI unit of the dimension of a unit as text; "" for any other text; cached."""
    try:
        return si_value(f"1 {unit}", "m", "N", "s", "V")[1]
    except UnitTextError:
        return ""


def words_in(text: str) -> list[str]:
    """Return the words of a text in lower case, in order: "z", "low" and "v" of "Z_LowV", without digits."""
    return re.findall(r"[^\W\d_]+", re.sub(r"(?<=[a-zà-ÿ])(?=[A-Z])", " ", text).lower())


def meanings(words: Sequence[str], known: Mapping[str, str]) -> list[str]:
    """Return what each of `words` means, in their order: the keys of `known` among whose words it is, maybe none."""
    return [name for word in words for name, synonyms in known.items() if word in synonyms.split()]


def unit_in(heading: str) -> str:
    """Return the unit of a heading as text: "nm" of "z [nm]", "z (nm)", "z/nm", "z in nm" and "z_nm"; "" without one.

    Of a word that ends with V, as in "Piezo_LowV", it is "V".
    """
    enclosed = ["".join(groups).strip() for groups in ENCLOSED.findall(heading)]
    words = [word for word in re.split(r"[\s_,]+", heading)[1:] if BARE.fullmatch(word)]
    units = [*enclosed[::-1], *("V" if word.endswith("V") else word for word in words[::-1])]
    return next(filter(dimension, units), "")


def known_columns(headings: Sequence[str], units: Sequence[str] = ()) -> list[Column]:
    """Return the columns of a line of headings that are known: measured ones first, and those of few words.

    A heading means what its first word with a fitting unit does, else its first known word.

    Args:
        headings: names of all columns of the file, with units or without.
        units: of the columns, in a line of their own; () without one.
    """
    columns = []
    for i, heading in enumerate(headings):
        words = words_in(heading)
        names = meanings(words, QUANTITIES)
        unit = (unit_in(heading) if names else "") or "".join(units[i : i + 1])
        unnamed = [word for word in words if not meanings([word], QUANTITIES)]
        segment = next(iter(meanings(unnamed, SEGMENT_WORDS)), "")
        named = [Column(name, i, heading, unit, segment) for name in names]
        columns += [column for column in named if column.fits][:1] or named[:1]
    return sorted(columns, key=lambda column: ("measured" not in column.heading.lower(), len(words_in(column.heading))))


def chosen_columns(headings: Sequence[str], columns: Sequence[Column], is_rigid: bool) -> dict[str, dict[str, Column]]:
    """Return one column of positions, one of forces, and optional ones, by the segment of headings and by their name.

    The segment is "" where no heading of a position or force names one; columns whose heading names none belong to all
    segments. Where the instrument has a stiffness, z has priority over d, and a deflection may replace the force.

    Args:
        headings: of all columns.
        columns: the known ones.
        is_rigid: whether the instrument has no stiffness.

    Raises:
        DataError: positions or forces are missing, without a unit or with one of another dimension, or need a
            stiffness, or two columns have one heading.
    """
    needed = [["d"], ["F"]] if is_rigid else [["z", "d"], ["F", "deflection"]]
    chosen: dict[str, dict[str, Column]] = {}
    for segment in sorted({column.segment for column in columns if column.name in UNITS} - {""} or {""}):
        chosen[segment] = {}
        for names in (*needed, ["segment"], ["t"], ["curve"], ["x"], ["y"]):
            fitting = [c for name in names for c in columns if c.name == name and c.segment in ("", segment) and c.fits]
            if fitting:
                chosen[segment][fitting[0].name] = fitting[0]
            elif names in needed:
                raise DataError(_fault(names, columns, headings, is_rigid))
    for column in chosen[segment].values():
        if headings.count(column.heading) > 1:
            raise DataError(
                f'two columns have the heading "{column.heading}": add their segments, as in "approach '
                f'{column.heading}", or rename one of them'
            )
    return chosen


def _fault(names: Sequence[str], columns: Sequence[Column], headings: Sequence[str], is_rigid: bool) -> str:
    """Return the message on a missing column, for which no column of these names has a fitting unit.

    Args:
        names: of the column.
        columns: the known ones.
        headings: of all columns.
        is_rigid: whether the instrument has no stiffness.
    """
    if is_rigid and any(column.name == "z" and column.fits for column in columns):
        return (
            "z is the position of the piezo, to which the instrument's deflection contributes: give [instrument] "
            "stiffness, or a column d, the indentation"
        )
    is_named = any(column.name in names for column in columns)
    volts = [heading for heading in headings if dimension(unit_in(heading)) == "V"]
    if volts:
        fault = f"column {names[0]} is {'in volts' if is_named else 'missing'}; {' and '.join(volts)} in volts"
        return f"{fault}: multiply by the sensitivity, and for a force by the stiffness of the cantilever, too"
    fault = "a unit that is known" if is_named else "a column"
    words = "; ".join(f"{name}: {', '.join(QUANTITIES[name].split())}" for name in names)
    return f"{' or '.join(names)} without {fault} among {[*headings]}; {FORM}; known words are {words}"
