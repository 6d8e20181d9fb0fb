"""Each table of a scene by itself: every mistake, reported once and in the words of the scene file.

A misspelt word that can only mean one thing is reported and then read as what was meant, so that the rest of its table
and the rules across tables are checked in the same go.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from contact1d.workflow.scene.experiments import Kind
from contact1d.workflow.scene.problems import Problem, as_toml, nearest, path_of, shown
from contact1d.workflow.scene.quantities import (
    Keys,
    OutOfRange,
    Place,
    Table,
    keys_of,
    tables_in,
    walk,
)
from contact1d.workflow.scene.schema import statement, text_of
from contact1d.workflow.scene.tables import WHOLE, Tables

MISSING = "missing"
"""Pydantic's name of this fault."""
KINDS = "a table with kind = "
"""How `statement` begins of a table that has several; its `kind` must be what follows."""
AnyTables = TypeVar("AnyTables", bound=Tables)


def mend_words(data: dict[str, Any], model: type[Tables]) -> list[Problem]:
    """Report and mend, in `data` (a plain dict for this `model`), every word that is misspelt or unknown."""
    wrong = _validated(data, model)[1]
    return [problem for place in walk(WHOLE, data) for problem in _mended(data, place)] if wrong else []


def check_tables(
    data: dict[str, Any], model: type[AnyTables], reported: Collection[Keys] = ()
) -> tuple[AnyTables | None, list[Problem], frozenset[Keys]]:
    """Check every table of `data`, a plain dict whose words were mended, for a `model` of a scene.

    Keys that were `reported` are not reported again. Returns the scene if all tables are right, what is wrong, and the
    keys at which a value is, which the rules cannot rely on.
    """
    scene, errors = _validated(data, model)
    faults = {_keys(details, data): details for details in errors}
    found = {place.keys: place for place in walk(WHOLE, data) if place.keys in faults}
    problems = (_problem(found[keys], details) for keys, details in faults.items() if keys not in reported)
    return scene, [problem for problem in problems if problem], frozenset(faults)


def _validated(data: dict[str, Any], model: type[AnyTables]) -> tuple[AnyTables | None, list[ErrorDetails]]:
    try:
        return model.model_validate(data), []
    except ValidationError as error:
        return None, error.errors(include_url=False)


def _keys(details: ErrorDetails, value: Any) -> Keys:
    """The keys of an error of pydantic's, whose location names the kinds of tables as well."""
    keys: list[Any] = []
    for step in details["loc"]:
        if step in (range(len(value)) if isinstance(value, list) else value if isinstance(value, dict) else ()):
            keys.append(step)
            value = value[step]
    return (*keys, *details["loc"][-1:]) if details["type"] == MISSING else tuple(keys)


def _mended(data: dict[str, Any], place: Place) -> Iterator[Problem]:
    """Report and mend, in `data`, the words of a place: of a table its kind and its keys."""
    value, kinds = place.value, place.allowed.kinds
    yield from _mended_word(data, place, place.allowed.words)
    if not isinstance(value, dict):
        return
    similar = next((key for key in value if nearest(key, ["kind"])), None)
    if kinds and "kind" not in value and similar:
        value["kind"] = value.pop(similar)
        yield Problem(path_of((*place.keys, similar)), "unknown key", hint='did you mean "kind"?')
    if kinds:
        yield from _mended_word(data, Place((*place.keys, "kind"), value.get("kind"), place.allowed), tuple(kinds))
    table = place.allowed.table_for(value)
    for key in [key for key in value if table and key not in keys_of(table)]:
        yield _mended_key(place, table or Table, key)


def _mended_word(data: dict[str, Any], place: Place, words: tuple[str, ...]) -> Iterator[Problem]:
    wrong = isinstance(place.value, str) and place.value not in words
    if wrong and (meant := nearest(place.value, words)):
        place.put(data, meant)
        must = f"must be {statement(place.allowed).removeprefix(KINDS)}"
        hint = f'did you mean "{meant}"?' if len(words) > 1 else ""
        yield Problem(path_of(place.keys), must, shown(place.value), hint)


def _mended_key(place: Place, table: type[Table], key: str) -> Problem:
    """Report a key that the `table` does not know, and take it away or put it where it was meant to be."""
    known, value = list(keys_of(table)), place.value.pop(key)
    meant = nearest(key, known)
    homes = [] if meant else _homes(key)
    method = table.only_method if key == "method" and issubclass(table, Kind) else None
    if meant is not None:
        place.value.setdefault(meant, value)
        hint = f'did you mean "{meant}"? '
    elif method is not None:
        hint = f"a {place.value['kind']} is always {method}: remove it; "
    else:
        hint = f"it belongs in {' or '.join(homes)}; " if homes else ""
    what = "unknown table" if isinstance(value, dict) else "unknown key"
    return Problem(path_of((*place.keys, key)), what, hint=f"{hint}allowed here: {', '.join(known) or 'no keys'}")


def _homes(key: str) -> list[str]:
    """The tables of a scene that know the key `key`, as they are written in a file."""
    found = []
    for path, choice in tables_in(Tables):
        if choice.table and key in keys_of(choice.table):
            kind = f' of kind = "{choice.kind}"' if choice.kind else ""
            found.append(f"[{path}]{kind}" if path else "the lines above the first table")
    return found


def _problem(place: Place, details: ErrorDetails) -> Problem | None:
    """What an error of pydantic's at a place means for the person who wrote the scene."""
    path, kind, given, allowed = path_of(place.keys), details["type"], place.value, statement(place.allowed)
    must, of_kind = f"must be {allowed}", f"must be {allowed.removeprefix(KINDS)}"
    if kind == MISSING:
        top = len(place.keys) == 1 and any(choice.table for choice in place.allowed.choices)
        return Problem(path, "missing", hint="required table" if top else must)
    if kind == "union_tag_not_found":
        return Problem(f"{path}.kind", "missing", hint=of_kind)
    if kind == "union_tag_invalid":
        return Problem(f"{path}.kind", of_kind, shown(given["kind"]))
    if kind == "scene":
        return Problem(path, details["msg"], shown(given))
    if kind == "too_short":
        least = details["ctx"]["min_length"]
        message = f"must have at least {'one item' if least == 1 else f'{least} items'}"
        # a list counts as too short for its wrong items only, too, which are reported themselves
        return Problem(path, message, shown(given)) if len(given) < least else None
    hint = _hint(place)
    if kind.startswith(("greater_than", "less_than")):
        must = must.replace("be a number ", "be ", 1).replace("be of ", "be ", 1)
        marks = (mark for choice in place.allowed.choices for mark in choice.marks)
        hint = next((mark.hint for mark in marks if isinstance(mark, OutOfRange)), "")
    if kind == "finite_number":
        must = must.replace("a number", "a finite number", 1)
    return Problem(path, must, shown(given), hint)


def _hint(place: Place) -> str:
    """What to do about a value of the wrong type, where that can be known."""
    given, allowed, text = place.value, statement(place.allowed), text_of(place.allowed)
    if isinstance(given, str) and allowed.startswith(("a number", "a whole number")):
        if any(map(str.isdigit, given)):
            return "a number stands without quotes" + (f", or with its unit: {as_toml(text)}" if text else " and unit")
        if text and not place.allowed.words:
            return f"a number with its unit begins with a digit: {as_toml(text)}"
    if isinstance(given, float) and given.is_integer() and "whole number" in allowed:
        return f"write {int(given)}"
    if len(place.keys) == 1 and "a table" in allowed:
        brackets = " in single brackets" if isinstance(given, list) else ""
        return f"write it as [{place.keys[0]}]{brackets}, its keys below"
    return ""
