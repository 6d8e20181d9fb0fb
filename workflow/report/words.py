"""A scene in words, for somebody who has not seen its file: from the tables' own descriptions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from contact1d.workflow.scene import Scene, Table
from contact1d.workflow.scene.quantities import keys_of

MOST_ITEMS = 6
"""Items of a list that are shown; of more, the ends."""


@dataclass(frozen=True)
class Said:
    """A table of the scene: its name, what it stands for, and its values: what each is, and the value with its unit."""

    name: str
    meaning: str
    values: tuple[tuple[str, str], ...]


def scene_in_words(scene: Scene) -> list[Said]:
    """Every table that the scene has, in the order of a scene file."""
    tables = ((name, getattr(scene, name)) for name in Scene.model_fields)
    return [
        Said(name.replace("_", " "), _meaning(table), tuple(_values(table)))
        for name, table in tables
        if isinstance(table, Table)
    ]


def _meaning(table: Table) -> str:
    text = (type(table).__doc__ or "").partition("\n")[0].removeprefix("Effect: ")
    return text[:1].upper() + text[1:]


def _values(table: Table, within: str = "") -> Iterator[tuple[str, str]]:
    for name, key in keys_of(type(table)).items():
        value = getattr(table, key.field)
        label = name.replace("_", " ")
        if isinstance(value, Table):
            yield from _values(value, f"{within}{label}: ")
        elif value is not None:
            unit = key.allowed.unit
            named = unit is not None and unit.name != "1" and value != "auto"
            yield within + label, _shown(value) + (f" {unit.name}" if unit and named else "")


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple | list):
        items = [_shown(item) for item in value]
        few = items if len(items) <= MOST_ITEMS else [*items[: MOST_ITEMS // 2], "…", *items[-MOST_ITEMS // 2 :]]
        return ", ".join(few) + (f" ({len(items)} in all)" if few != items else "")
    return str(value)
