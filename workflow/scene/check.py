"""Each table of a scene by itself: every mistake pydantic finds, said once and in the words of the scene file.

A misspelt word that can only mean one thing is reported and then read as what was meant, so that the rest of its table
and the rules across tables are checked in the same go.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from contact1d.workflow.scene.problems import Problem, as_toml, nearest, path_of, shown
from contact1d.workflow.scene.quantities import OutOfRange, Table, annotation_of, keys_of
from contact1d.workflow.scene.tables import Scene
from contact1d.workflow.scene.wording import (
    branches,
    kinds_of,
    members,
    statement,
    table_of,
    text_of,
    unwrapped,
    words_of,
)

Keys = tuple[str | int, ...]

UNKNOWN, MISSING, NO_KIND, WRONG_KIND = "extra_forbidden", "missing", "union_tag_not_found", "union_tag_invalid"


@dataclass(frozen=True)
class Checked:
    """A scene's tables after the check: `scene` if all are right, the `problems`, and what the rules may rely on.

    `unsound` holds the keys at which a value is wrong.
    """

    scene: Scene | None
    problems: tuple[Problem, ...]
    unsound: frozenset[Keys]


@dataclass(frozen=True)
class _Spot:
    """A place in a scene: its keys in the file, the type of what belongs there (None: unknown), the table meant."""

    keys: Keys
    annotation: Any
    table: type[Table] | None


def mend_words(data: dict[str, Any]) -> list[Problem]:
    """Report and mend, in `data` (a plain dict), every word that is misspelt or unknown."""
    problems: list[Problem] = []
    while mended := [problem for fault in _validated(data)[1] if (problem := _mend(data, fault))]:
        problems += mended
    return problems


def check_tables(data: dict[str, Any], told: Collection[Keys] = ()) -> Checked:
    """Check every table of `data`, a plain dict whose words were mended; what is wrong at the keys `told` was told."""
    scene, faults = _validated(data)
    new = (fault for fault in faults if not _follows(data, fault) and _spot(fault["loc"]).keys not in told)
    problems = tuple(_problem(data, fault) for fault in new)
    return Checked(scene, problems, frozenset(_spot(fault["loc"]).keys for fault in faults))


def _validated(data: dict[str, Any]) -> tuple[Scene | None, list[ErrorDetails]]:
    try:
        return Scene.model_validate(data), []
    except ValidationError as error:
        return None, error.errors(include_url=False)


def _follows(data: dict[str, Any], fault: ErrorDetails) -> bool:
    """Whether a list is told to be too short for its wrong items only, which are told themselves."""
    return fault["type"] == "too_short" and len(_value(data, _spot(fault["loc"]).keys)) >= fault["ctx"]["min_length"]


def _spot(location: tuple[int | str, ...]) -> _Spot:
    """The place that a pydantic location means: the same keys without the names of union branches."""
    keys: list[str | int] = []
    annotation: Any = Scene
    branch: Any = Scene
    for step in location:
        tagged = branches(annotation) if branch is annotation else {}
        if step in tagged:
            branch = tagged[str(step)]
            continue
        table = None if branch is None else table_of(branch)
        if isinstance(step, int):
            annotation = get_args(unwrapped(members(branch)[0])[0])[0]
        else:
            annotation = annotation_of(table, step) if table and step in keys_of(table) else None
        branch = annotation
        keys.append(step)
    return _Spot(tuple(keys), annotation, None if branch is None else table_of(branch))


def _value(data: dict[str, Any], keys: Keys) -> Any:
    value: Any = data
    for key in keys:
        value = value[key]
    return value


def _mend(data: dict[str, Any], fault: ErrorDetails) -> Problem | None:
    """Report and mend, in `data`, a word that is misspelt or unknown; None where the fault is something else."""
    if fault["type"] == UNKNOWN:
        return _mend_unknown_key(data, fault["loc"])
    spot = _spot(fault["loc"])
    if fault["type"] == NO_KIND:
        table = _value(data, spot.keys)
        similar = next((key for key in table if nearest(key, ["kind"])), None)
        if similar is None:
            return None
        table["kind"] = table.pop(similar)
        return Problem(path_of((*spot.keys, similar)), "unknown key", hint='did you mean "kind"?')
    keys, words = spot.keys, words_of(spot.annotation)
    if fault["type"] == WRONG_KIND:
        keys, words = (*keys, "kind"), kinds_of(spot.annotation)
    given = _value(data, keys) if words and fault["type"] != MISSING else None
    meant = nearest(given, words) if isinstance(given, str) else None
    if meant is None:
        return None
    _value(data, keys[:-1])[keys[-1]] = meant
    must = f"must be {_allowed(spot)}"
    return Problem(path_of(keys), must, shown(given), f'did you mean "{meant}"?' if len(words) > 1 else "")


def _mend_unknown_key(data: dict[str, Any], location: tuple[int | str, ...]) -> Problem:
    keys, key = _spot(location).keys, str(location[-1])
    around = _spot(location[:-1])
    allowed = list(keys_of(around.table or Scene))
    table = _value(data, around.keys)
    value = table.pop(key)
    what = "unknown table" if isinstance(value, dict) else "unknown key"
    meant = nearest(key, allowed)
    elsewhere = [] if meant else list(_homes(key, Scene))
    if meant is not None:
        table.setdefault(meant, value)
        hint = f'did you mean "{meant}"? '
    elif around.keys == ("experiment",) and key == "method":
        always = "always dynamic" if table.get("kind") == "slide" else "without time in it"
        hint = f"a {table.get('kind')} is {always}: remove it; "
    else:
        hint = f"it belongs in {' or '.join(elsewhere)}; " if elsewhere else ""
    return Problem(path_of(keys), what, hint=f"{hint}allowed here: {', '.join(allowed) or 'no keys'}")


def _homes(key: str, table: type[Table], path: str = "") -> Iterator[str]:
    """The tables of a scene that know the key `key`, as they are written in a file."""
    if key in keys_of(table):
        yield f"[{path}]" if path else "the lines above the first table"
    for name in keys_of(table):
        choices = members(annotation_of(table, name))
        for choice in choices:
            inside = table_of(choice)
            inner = f"{path}.{name}" if path else name
            for home in _homes(key, inside, inner) if inside else ():
                kind = f' of kind = "{kinds_of(choice)[0]}"' if len(choices) > 1 and kinds_of(choice) else ""
                yield home + kind


def _problem(data: dict[str, Any], fault: ErrorDetails) -> Problem:
    """What a fault of pydantic's means for the person who wrote the scene."""
    spot = _spot(fault["loc"])
    path, kind = path_of(spot.keys), fault["type"]
    if kind == MISSING:
        top = (spot.table is not None and len(spot.keys) == 1) or spot.keys == ("experiment",)
        return Problem(path, "missing", hint="required table" if top else f"must be {statement(spot.annotation)}")
    if kind == NO_KIND:
        return Problem(f"{path}.kind", "missing", hint=f"must be {_allowed(spot)}")
    if kind == WRONG_KIND:
        return Problem(f"{path}.kind", f"must be {_allowed(spot)}", shown(_value(data, (*spot.keys, "kind"))))
    given = _value(data, spot.keys)
    if kind == "scene":
        return Problem(path, fault["msg"], shown(given))
    if kind == "too_short":
        least = fault["ctx"]["min_length"]
        return Problem(path, f"must have at least {'one item' if least == 1 else f'{least} items'}", shown(given))
    allowed = statement(spot.annotation)
    if kind.startswith(("greater_than", "less_than")):
        allowed = allowed.removeprefix("a number ").removeprefix("of ")
        if hints := [mark.hint for mark in unwrapped(spot.annotation)[1] if isinstance(mark, OutOfRange)]:
            return Problem(path, f"must be {allowed}", shown(given), hints[0])
    if kind == "finite_number":
        allowed = allowed.replace("a number", "a finite number", 1)
    return Problem(path, f"must be {allowed}", shown(given), _hint(spot, given))


def _allowed(spot: _Spot) -> str:
    """What belongs at `spot`; of a table with kinds, what its `kind` may be."""
    return statement(spot.annotation).removeprefix("a table with kind = ")


def _hint(spot: _Spot, given: object) -> str:
    """What to do about a value of the wrong type, where that can be told."""
    allowed = statement(spot.annotation)
    number = allowed.startswith(("a number", "a whole number"))
    if number and isinstance(given, str) and any(character.isdigit() for character in given):
        text = text_of(spot.annotation)
        return "a number stands without quotes" + (f", or with its unit: {as_toml(text)}" if text else " and unit")
    if number and isinstance(given, str) and (text := text_of(spot.annotation)) and not words_of(spot.annotation):
        return f"a number with its unit begins with a digit: {as_toml(text)}"
    if isinstance(given, float) and given.is_integer() and "whole number" in allowed:
        return f"write {int(given)}"
    if len(spot.keys) == 1 and "a table" in allowed:
        brackets = " in single brackets" if isinstance(given, list) else ""
        return f"write it as [{spot.keys[0]}]{brackets}, its keys below"
    return ""
