"""The allowed values of a key of a scene, as text and as a JSON schema for editors, from the types of the tables.

The schema knows each table by itself; what tables need of each other is checked by the program alone. Written without
references and in the words of draft 7, which editors of TOML read (taplo, and with it Even Better TOML in VS Code).
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import astuple
from typing import Any

from annotated_types import Ge, Gt, Le, Lt, MinLen
from pydantic_core import PydanticUndefined

from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import Allowed, Table, keys_of
from contact1d.workflow.scene.si_text import example
from contact1d.workflow.scene.tables import Tables

DIALECT = "http://json-schema.org/draft-07/schema#"
SIMPLE = {bool: "true or false", str: "text in quotes", int: "a whole number", float: "a number"}
TYPES = {bool: "boolean", str: "string", int: "integer", float: "number"}
RANGES = {Gt: "exclusiveMinimum", Ge: "minimum", Le: "maximum", Lt: "exclusiveMaximum"}
IN_WORDS = {
    "exclusiveMinimum": "greater than",
    "minimum": "of at least",
    "maximum": "at most",
    "exclusiveMaximum": "less than",
}
LENGTHS = {MinLen: "minItems"}
TEXT_PATTERN = r"^[ \t]*[+\-−]?[0-9]*\.?[0-9]+.*[A-Za-zµμÅ°%]"
"""The pattern of a text that is a number with a unit."""
Node = dict[str, Any]


def statement(allowed: Allowed) -> str:
    """Return the allowed values as text that follows "must be": 'a number greater than 0 (LU), or "auto"'.

    "" where nothing is allowed.
    """
    parts = []
    if allowed.type:
        unit = allowed.unit
        parts += [SIMPLE[allowed.type] + _range(allowed) + (f" ({unit.name})" if unit and unit.name != "1" else "")]
    if allowed.items:
        parts += [f"a list, each item {statement(allowed.items)}"]
    if allowed.kinds:
        parts += [f"a table with kind = {_either((*allowed.kinds,))}"]
    elif table := allowed.tables.get(""):
        keys = ", ".join(keys_of(table))
        name = f", or a name such as {as_toml(next(iter(table.by_name)))}" if table.by_name else ""
        parts += [
            f"a list [{keys}]" if table.as_list else f"a table {f'with {keys}' if keys else 'without keys'}{name}"
        ]
    if allowed.words:
        parts += [_either(allowed.words)]
    return ", or ".join(parts)


def text_of(allowed: Allowed) -> str:
    """Return an example of a text with a unit in place of a number, "10 mm"; "" where the value has no dimension.

    Of a list the example is for an item.
    """
    unit = allowed.quantity or (allowed.items and allowed.items.quantity)
    return example(unit.texts[0]) if unit and unit.name != "1" else ""


def described(allowed: Allowed) -> str:
    """Return the allowed values as text that follows "must be": 'a number (LU), or text such as "10 mm"'.

    The example of text is for a number with a unit alone.
    """
    text = text_of(allowed)
    return statement(allowed) + (f", or text such as {as_toml(text)}" if text else "")


def meaning(table: type[Table], name: str) -> str:
    """Return description and allowed values of a key: "displacement of the driven end; must be a number greater …".

    Raises:
        KeyError: the table has no such key.
    """
    key = keys_of(table)[name]
    return f"{key.description}; must be {described(key.allowed)}"


def schema_text() -> str:
    """Return the JSON schema (draft 7) of a scene file, without references, indented, with a line break at the end."""
    named = {"title": "contact1d scene", "description": "A scene of contact1d."}
    return json.dumps({"$schema": DIALECT} | _table(Tables) | named, indent=1, ensure_ascii=False) + "\n"


def _nodes(allowed: Allowed) -> Node:
    """Return the JSON schema of the values that a key allows, as a dict: {"anyOf": […]} where types are several.

    A number with a unit may also be a text.
    """
    nodes = [_table(table) for table in allowed.tables.values()]
    if allowed.items:
        nodes.insert(0, {"type": "array", "items": _nodes(allowed.items)} | _bounds(allowed, LENGTHS))
    if allowed.type:
        number = {"type": TYPES[allowed.type]} | _bounds(allowed, RANGES)
        text = {"type": "string", "pattern": TEXT_PATTERN}
        nodes.insert(0, {"anyOf": [number, text]} if allowed.quantity and text_of(allowed) else number)
    if allowed.words:
        nodes.append({"type": "string", "enum": [*allowed.words]})
    return nodes[0] if len(nodes) == 1 else {"anyOf": nodes}


def _bounds(allowed: Allowed, names: Mapping[Any, str]) -> Node:
    """Return the bounds of a value by the names of the JSON schema, {"minimum": 0}; empty without any.

    `names`: these names by the type of the mark that gives a bound; marks of other types are ignored.
    """
    return {names[type(mark)]: next(iter(astuple(mark))) for mark in allowed.marks if type(mark) in names}


def _table(table: type[Table]) -> Node:
    """Return the JSON schema of a table, as a dict; {"anyOf": […]} where it may also be a name or list of values."""
    keys, properties = keys_of(table), {}
    for name, key in keys.items():
        properties[name] = _nodes(key.allowed) | {"description": meaning(table, name)}
        if isinstance(key.default, str | float | bool | tuple):
            properties[name]["default"] = [*key.default] if isinstance(key.default, tuple) else key.default
    required = [name for name, key in keys.items() if key.default is PydanticUndefined]
    node = {
        "description": table.__doc__, "type": "object",
        "properties": properties, "required": required, "additionalProperties": False,
    }  # fmt: skip
    if table.by_name:  # the first is there for editors, which complete it
        return {"anyOf": [{"type": "string", "enum": [*table.by_name]}, {"type": "string"}, node]}
    if not table.as_list:
        return node
    items = {"anyOf": [_nodes(key.allowed) for key in keys.values()]}
    return {"anyOf": [{"type": "array", "items": items, "minItems": len(keys), "maxItems": len(keys)}, node]}


def _either(words: tuple[str, ...]) -> str:
    """Return words as a text, '"a", "b" or "c"'; a single one alone; ValueError without any."""
    *first, last = (as_toml(word) for word in words)
    return f"{', '.join(first)} or {last}" if first else last


def _range(allowed: Allowed) -> str:
    """Return the range of a number as text with a blank before it, " from 0 to 1" or " greater than 0"; "" without."""
    bounds = _bounds(allowed, RANGES)
    if {"minimum", "maximum"} <= bounds.keys():
        return f" from {bounds['minimum']:.10g} to {bounds['maximum']:.10g}"
    return " and".join(f" {IN_WORDS[name]} {bound:.10g}" for name, bound in bounds.items())
