"""Every place of a number in a scene, with its unit, read off the types of the tables."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, get_args, get_origin

from contact1d.workflow.scene.quantities import Table, Unit, annotation_of, keys_of
from contact1d.workflow.scene.wording import kinds_of, members, table_of, unwrapped, words_of

Keys = tuple[str | int, ...]
BASES = ("LU", "FU", "MU", "TU")
"""The units of the model; TU follows from the others."""


@dataclass(frozen=True)
class Place:
    """A number's place in a scene: its `keys`, what stands there (or follows from a default), and its unit."""

    keys: Keys
    value: Any
    unit: Unit
    words: tuple[str, ...] = ()
    absent: bool = False

    @property
    def is_text(self) -> bool:
        """Whether it is a text that can only have meant a number with a unit: one with digits, and no plain number."""
        if not isinstance(self.value, str) or self.value in self.words or not any(map(str.isdigit, self.value)):
            return False
        try:
            float(self.value)
        except ValueError:
            return True
        return False

    @property
    def is_number(self) -> bool:
        """Whether it is a number other than 0, which is the same in all units."""
        return isinstance(self.value, int | float) and not isinstance(self.value, bool) and self.value != 0

    @property
    def bases(self) -> frozenset[str]:
        """Which of LU, FU and MU must be known to turn a text here into a number."""
        found = set(powers(self.unit.name))
        return frozenset(found - {"TU"} | ({"MU", "LU", "FU"} if "TU" in found else set()))


def places(table: type[Table], data: Mapping[str, Any], keys: Keys = ()) -> Iterator[Place]:
    """Every place of a number in `data`, a table of this type with the keys of a scene file; absent keys by default."""
    for key, name in keys_of(table).items():
        annotation = annotation_of(table, key)
        if key in data:
            yield from _inside(annotation, data[key], (*keys, key))
        elif isinstance(default := table.model_fields[name].default, float):
            for unit in _units(annotation):
                yield Place((*keys, key), default, unit, absent=True)


def _inside(annotation: object, value: Any, keys: Keys) -> Iterator[Place]:
    choices = members(annotation)
    if isinstance(value, Mapping):
        tables = [table for choice in choices if (table := table_of(choice))]
        kind = value.get("kind")
        fitting = [table for table in tables if len(tables) == 1 or kind in kinds_of(table)]
        for table in fitting[:1]:
            yield from places(table, value, keys)
    elif isinstance(value, list):
        for choice in choices:
            inner = unwrapped(choice)[0]
            if get_origin(inner) is tuple:
                kinds = get_args(inner)
                for i, item in enumerate(value):
                    same = len(kinds) == 2 and kinds[1] is Ellipsis
                    if same or i < len(kinds):
                        yield from _inside(kinds[0] if same else kinds[i], item, (*keys, i))
    else:
        for unit in _units(annotation):
            yield Place(keys, value, unit, words_of(annotation))


def _units(annotation: object) -> list[Unit]:
    """The unit of a number of this type, or nothing."""
    marks = [unwrapped(member) for member in members(annotation)]
    return [mark for inner, all_marks in marks if inner is float for mark in all_marks if isinstance(mark, Unit)][:1]


@cache
def powers(unit: str) -> dict[str, int]:
    """Powers of LU, FU, MU and TU in the name of a unit: {"FU": 1, "TU": 1, "LU": -1} of FU·TU/LU."""
    found: dict[str, int] = {}
    above, _, below = unit.partition("/")
    for names, sign in ((above, 1), (below, -1)):
        for name in filter(None, names.split("·")):
            base = name.rstrip("²³")
            found[base] = found.get(base, 0) + sign * {"²": 2, "³": 3}.get(name[len(base) :], 1)
    return {base: power for base, power in found.items() if base in BASES and power}
