"""Each table of a scene by itself: every error, reported once in the terms of the scene file.

A misspelt word that can only mean one thing is reported and then read as what was meant, so that the rest of its table
and the rules across tables are checked as well.
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import chain
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from contact1d.workflow.scene.kinds import Kind, with_article
from contact1d.workflow.scene.problems import MOST_PROBLEMS, Problem, as_toml, nearest, path_of, plain, suggestion
from contact1d.workflow.scene.quantities import OutOfRange, Place, keys_of, tables_in
from contact1d.workflow.scene.schema import statement, text_of
from contact1d.workflow.scene.tables import Tables


def mend_words(scene: Place) -> None:
    """Report (in `scene.problems`) and correct, in place, every misspelt or unknown word of a scene; return nothing.

    A key that is similar to an allowed one is moved there, unless that has a value; other unknown keys are removed.
    Texts become the allowed word or table of that name that they are similar to, and remain where there is none. A list
    in place of a table that may be one, [velocity, distance], becomes the table if it has a value for each key.
    """
    for place in chain((scene,), scene):
        _mend_word(place)
        value, table = place.value, place.allowed.table
        if isinstance(value, dict):
            _mend_keys(place, value)
        elif table and table.as_list and isinstance(value, list) and len(value) == len(keys_of(table)):
            place.put(dict(zip(keys_of(table), value, strict=True)))


def _mend_keys(place: Place, value: dict[str, Any]) -> None:
    """Report and correct the misspelt or unknown keys of a table `value`, and its kind, in place.

    A key that is similar to an allowed one is moved there, unless that has a value; others are removed. The first 20
    are reported with a suggestion, more without, and these are all removed. Where the kind remains unknown, only the
    key "kind" itself is looked for.
    """
    if place.allowed.kinds:
        for similar in [key for key in value if "kind" not in value and nearest(key, ["kind"])][:1]:
            _mend_key(place, ["kind"], similar)
        _mend_word(place.kind)
    table = place.allowed.table_for(value)
    unknown = [key for key in value if key not in keys_of(table)] if table else []
    for key in unknown[:MOST_PROBLEMS]:
        _mend_key(place, keys_of(table), key)
    for key in unknown[MOST_PROBLEMS:]:  # these are only counted
        del value[key]
        place.problems.append(Problem(path_of((*place.keys, key)), "unknown key"))


def _mend_word(place: Place) -> None:
    """Correct the text at a place, in place, to the allowed word or the name of a table that it most likely means.

    A misspelt one, also by its case alone, is reported. The name of a table is replaced by a copy of the table, without
    a problem where only case, "-" or blanks differ. An allowed word, a text that is similar to nothing, and what is no
    text remain as they are.
    """
    value, allowed = place.value, place.allowed
    names = allowed.table.by_name if allowed.table else {}
    meant = nearest(value, (*allowed.words, *names)) if isinstance(value, str) and value not in allowed.words else None
    if meant:
        if plain(value) not in names:
            place.report(f"must be {statement(allowed)}", f'did you mean "{meant}"?{_names(place)}')
        place.put(dict(names[meant]) if meant in names else meant)


def _names(place: Place) -> str:
    """Return " names: …", the names that a table may have, for a message; "" where it has none."""
    table = place.allowed.table
    return f" names: {', '.join(table.by_name)}" if table and table.by_name else ""


def _mend_key(place: Place, known: Collection[str], key: str) -> None:
    """Report an unknown key of a table, and remove it or move its value to the `known` key that was meant, in place.

    A value that this key already has is kept, and then that of `key` is lost.
    """
    value, table, begin = place.value.pop(key), place.allowed.table_for(place.value), ""
    method = table.only_method if key == "method" and table and issubclass(table, Kind) else None
    if meant := nearest(key, known):
        place.value.setdefault(meant, value)
    elif method is not None:
        begin = f"{with_article(place.value['kind'])} is always {method}: remove it; "
    elif homes := _homes(key):
        begin = f"it belongs in {' or '.join(homes)}; "
    message = "unknown table" if isinstance(value, dict) else "unknown key"
    place.problems.append(Problem(path_of((*place.keys, key)), message, hint=begin + suggestion(key, known)))


def _homes(key: str) -> list[str]:
    """Return the tables of a scene that have the key `key`, as written in a scene file: "[plate]"; empty without any.

    A table with a kind is '[bodies.profile] of kind = "cone"', the scene itself "the lines above the first table".
    Tables that are items of lists are left out.
    """
    return [
        f"[{path}]" + (f' of kind = "{kind}"' if kind else "") if path else "the lines above the first table"
        for path, kind, table in tables_in(Tables)
        if key in keys_of(table)
    ]


def report_faults(scene: Place, error: ValidationError) -> None:
    """Report each error of a validation by pydantic once, except at keys whose values already have a reported error.

    Errors of inner keys are first, and mark all tables around them: an error of such a table is then not reported.
    """
    faults = [(_place(scene, details), details) for details in error.errors(include_url=False)]
    # a value that may be of several types has an error for each type: errors inside come first, a wrong type last
    faults.sort(key=lambda fault: (-len(fault[0].keys), fault[1]["type"].endswith("_type")))
    for place, details in faults:
        if place.sound:
            _report(place, details)


def _place(scene: Place, details: ErrorDetails) -> Place:
    """Return the innermost key of the scene to which an error of pydantic's belongs; the whole scene where none does.

    The location that pydantic gives has names of types as well, which are skipped. An error of the kind of a table is
    that of its key "kind".
    """
    place = scene
    for step in (*details["loc"], "kind" if details["type"].startswith("union_tag") else ""):
        place = place.inside.get(step, place)
    return place


def _report(place: Place, details: ErrorDetails) -> None:
    """Report an error of pydantic's at a key in the terms of the scene file: what is allowed, and the suggested fix.

    The key, and all tables that contain it, are then marked as wrong.
    """
    kind, must, hint = details["type"], f"must be {statement(place.allowed)}", _hint(place)
    if place.absent:
        must, hint = "missing", must
    elif kind == "scene":
        must = details["msg"]
    elif kind == "too_short":
        least = details["ctx"]["min_length"]
        must = f"must have at least {'one item' if least == 1 else f'{least} items'}"
    elif kind.startswith(("greater_than", "less_than")):
        must = must.replace("be a number ", "be ", 1).replace("be of ", "be ", 1)
        hint = next((mark.hint for mark in place.allowed.marks if isinstance(mark, OutOfRange)), "")
    elif kind == "finite_number":
        must = must.replace("a number", "a finite number", 1)
    place.fault(must, hint)


def _hint(place: Place) -> str:
    """Return the suggested fix for a value of the wrong type; "" where none is known.

    It is for a text in place of a number ("write a number without quotes"), for 2.0 in place of 2, and for a table of
    the scene, "write it as [plate], its keys below"; else "names: …" with the names that a table may have.
    """
    given, allowed, text = place.value, place.allowed, text_of(place.allowed)
    if isinstance(given, str) and allowed.type in (int, float):
        if any(map(str.isdigit, given)):
            return "write a number without quotes" + (f", or with its unit: {as_toml(text)}" if text else " and unit")
        if text and not allowed.words:
            return f"a number with its unit begins with a digit: {as_toml(text)}"
    if isinstance(given, float) and given.is_integer() and allowed.type is int:
        return f"write {int(given)}"
    if len(place.keys) == 1 and allowed.tables:
        brackets = " in single brackets" if isinstance(given, list) else ""
        return f"write it as [{place.keys[0]}]{brackets}, its keys below"
    return _names(place).strip()
