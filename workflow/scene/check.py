"""Each table of a scene by itself: every mistake pydantic finds, reported once and in the words of the scene file.

A misspelt word that can only mean one thing is reported and then read as what was meant, so that the rest of its table
and the rules across tables are checked in the same go.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from contact1d.workflow.scene.experiments import KINDS
from contact1d.workflow.scene.problems import Problem, as_toml, nearest, path_of, shown
from contact1d.workflow.scene.quantities import Allowed, Keys, OutOfRange, Table, keys_of, tables_in
from contact1d.workflow.scene.schema import statement, text_of
from contact1d.workflow.scene.tables import WHOLE, Tables

UNKNOWN, MISSING, NO_KIND, WRONG_KIND = "extra_forbidden", "missing", "union_tag_not_found", "union_tag_invalid"
"""Pydantic's names of faults."""
NOTHING = Allowed(())


@dataclass(frozen=True)
class Checked:
    """A scene's tables after the check: `scene` if all are right, the `problems`, and what the rules may rely on.

    `unsound` holds the keys at which a value is wrong.
    """

    scene: Tables | None
    problems: tuple[Problem, ...]
    unsound: frozenset[Keys]


@dataclass(frozen=True)
class _Fault:
    """A fault that pydantic found: its keys in the file, what may stand there, the table meant, and what does."""

    kind: str
    location: Keys
    keys: Keys
    allowed: Allowed
    table: type[Table] | None
    details: ErrorDetails

    @property
    def path(self) -> str:
        return path_of(self.keys)

    def value(self, data: Any, *keys: str | int) -> Any:
        return _value(data, (*self.keys, *keys))

    @property
    def must(self) -> str:
        """What belongs there; of a table with kinds, what its `kind` may be."""
        return f"must be {statement(self.allowed).removeprefix('a table with kind = ')}"


def mend_words(data: dict[str, Any], model: type[Tables]) -> list[Problem]:
    """Report and mend, in `data` (a plain dict for this `model`), every word that is misspelt or unknown."""
    problems: list[Problem] = []
    while mended := [problem for fault in _validated(data, model)[1] if (problem := _mend(data, fault))]:
        problems += mended
    return problems


def check_tables(data: dict[str, Any], model: type[Tables], reported: Collection[Keys] = ()) -> Checked:
    """Check every table of `data`, a plain dict whose words were mended, for a `model` of a scene.

    Keys that were `reported` are not reported again.
    """
    scene, faults = _validated(data, model)
    problems = (_problem(data, fault) for fault in faults if fault.keys not in reported and not _follows(data, fault))
    return Checked(scene, tuple(problems), frozenset(fault.keys for fault in faults))


def _validated(data: dict[str, Any], model: type[Tables]) -> tuple[Tables | None, list[_Fault]]:
    try:
        return model.model_validate(data), []
    except ValidationError as error:
        return None, [_Fault(d["type"], d["loc"], *_at(d["loc"]), d) for d in error.errors(include_url=False)]


def _at(location: Keys) -> tuple[Keys, Allowed, type[Table] | None]:
    """What a pydantic location means: the keys without the names of union members, what belongs there, the table."""
    keys: list[str | int] = []
    allowed = member = WHOLE
    for step in location:
        tagged = {choice.tag: choice for choice in member.choices} if len(member.choices) > 1 else {}
        if step in tagged:
            member = Allowed((tagged[str(step)],))
            continue
        if isinstance(step, int):
            allowed = member = next((choice.items for choice in member.choices if choice.items), NOTHING)
        else:
            known = keys_of(member.table) if member.table else {}
            allowed = member = known[step].allowed if step in known else NOTHING
        keys.append(step)
    return tuple(keys), allowed, member.table


def _value(data: Any, keys: Keys) -> Any:
    for key in keys:
        data = data[key]
    return data


def _follows(data: dict[str, Any], fault: _Fault) -> bool:
    """Whether a list counts as too short for its wrong items only, which are reported themselves."""
    return fault.kind == "too_short" and len(fault.value(data)) >= fault.details["ctx"]["min_length"]


def _mend(data: dict[str, Any], fault: _Fault) -> Problem | None:
    """Report and mend, in `data`, a word that is misspelt or unknown; None where the fault is something else."""
    if fault.kind == UNKNOWN:
        return _mend_unknown_key(data, fault)
    if fault.kind == NO_KIND:
        table = fault.value(data)
        similar = next((key for key in table if nearest(key, ["kind"])), None)
        if similar is None:
            return None
        table["kind"] = table.pop(similar)
        return Problem(path_of((*fault.keys, similar)), "unknown key", hint='did you mean "kind"?')
    wrong_kind = fault.kind == WRONG_KIND
    keys = (*fault.keys, "kind") if wrong_kind else fault.keys
    words = tuple(fault.allowed.kinds) if wrong_kind else fault.allowed.words
    given = _value(data, keys) if words and fault.kind != MISSING else None
    meant = nearest(given, words) if isinstance(given, str) else None
    if meant is None:
        return None
    _value(data, keys[:-1])[keys[-1]] = meant
    return Problem(path_of(keys), fault.must, shown(given), f'did you mean "{meant}"?' if len(words) > 1 else "")


def _mend_unknown_key(data: dict[str, Any], fault: _Fault) -> Problem:
    around, _, inside = _at(fault.location[:-1])
    key, known = str(fault.location[-1]), list(keys_of(inside or Tables))
    table = _value(data, around)
    value = table.pop(key)
    what = "unknown table" if isinstance(value, dict) else "unknown key"
    meant = nearest(key, known)
    homes = [] if meant else _homes(key)
    method = KINDS[table["kind"]].only_method if around == ("experiment",) and key == "method" else None
    if meant is not None:
        table.setdefault(meant, value)
        hint = f'did you mean "{meant}"? '
    elif method is not None:
        hint = f"a {table['kind']} is always {method}: remove it; "
    else:
        hint = f"it belongs in {' or '.join(homes)}; " if homes else ""
    return Problem(fault.path, what, hint=f"{hint}allowed here: {', '.join(known) or 'no keys'}")


def _homes(key: str) -> list[str]:
    """The tables of a scene that know the key `key`, as they are written in a file."""
    found = []
    for path, choice in tables_in(Tables):
        if choice.table and key in keys_of(choice.table):
            kind = f' of kind = "{choice.kind}"' if choice.kind else ""
            found.append(f"[{path}]{kind}" if path else "the lines above the first table")
    return found


def _problem(data: dict[str, Any], fault: _Fault) -> Problem:
    """What a fault of pydantic's means for the person who wrote the scene."""
    path, kind, allowed = fault.path, fault.kind, statement(fault.allowed)
    if kind == MISSING:
        top = (fault.table is not None and len(fault.keys) == 1) or fault.keys == ("experiment",)
        return Problem(path, "missing", hint="required table" if top else f"must be {allowed}")
    if kind == NO_KIND:
        return Problem(f"{path}.kind", "missing", hint=fault.must)
    if kind == WRONG_KIND:
        return Problem(f"{path}.kind", fault.must, shown(fault.value(data, "kind")))
    given = fault.value(data)
    if kind == "scene":
        return Problem(path, fault.details["msg"], shown(given))
    if kind == "too_short":
        least = fault.details["ctx"]["min_length"]
        return Problem(path, f"must have at least {'one item' if least == 1 else f'{least} items'}", shown(given))
    if kind.startswith(("greater_than", "less_than")):
        allowed = allowed.removeprefix("a number ").removeprefix("of ")
        marks = (mark for choice in fault.allowed.choices for mark in choice.marks)
        if hint := next((mark.hint for mark in marks if isinstance(mark, OutOfRange)), ""):
            return Problem(path, f"must be {allowed}", shown(given), hint)
    if kind == "finite_number":
        allowed = allowed.replace("a number", "a finite number", 1)
    return Problem(path, f"must be {allowed}", shown(given), _hint(fault, given))


def _hint(fault: _Fault, given: object) -> str:
    """What to do about a value of the wrong type, where that can be known."""
    allowed, text = statement(fault.allowed), text_of(fault.allowed)
    if isinstance(given, str) and allowed.startswith(("a number", "a whole number")):
        if any(map(str.isdigit, given)):
            return "a number stands without quotes" + (f", or with its unit: {as_toml(text)}" if text else " and unit")
        if text and not fault.allowed.words:
            return f"a number with its unit begins with a digit: {as_toml(text)}"
    if isinstance(given, float) and given.is_integer() and "whole number" in allowed:
        return f"write {int(given)}"
    if len(fault.keys) == 1 and "a table" in allowed:
        brackets = " in single brackets" if isinstance(given, list) else ""
        return f"write it as [{fault.keys[0]}]{brackets}, its keys below"
    return ""
