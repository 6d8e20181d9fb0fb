"""What a key of a scene may hold, in words and as a JSON schema for editors, from the types of the tables alone.

The schema knows each table by itself; what tables need of each other is checked by the program alone. Written without
references and in the words of draft 7, which editors of TOML read (taplo, and with it Even Better TOML in VS Code).
"""

from __future__ import annotations

import json
from typing import Any

from annotated_types import Ge, Gt, Le

from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import Allowed, Table, keys_of
from contact1d.workflow.scene.si_text import example
from contact1d.workflow.scene.tables import Tables

DIALECT = "http://json-schema.org/draft-07/schema#"
SIMPLE = {bool: "true or false", str: "text in quotes", int: "a whole number", float: "a number"}
Node = dict[str, Any]


def statement(allowed: Allowed) -> str:
    """What a value must be, in words: "a number greater than 0 (LU), or "auto"", continues "must be"."""
    if len(allowed.choices) > 1:
        if len(allowed.kinds) == len(allowed.choices):
            return f"a table with kind = {_either(tuple(allowed.kinds))}"
        return ", or ".join(statement(Allowed((choice,))) for choice in allowed.choices)
    choice = allowed.choices[0]
    if choice.words:
        return _either(choice.words)
    if choice.items:
        return f"a list, each item {statement(choice.items)}"
    if choice.table:
        keys = ", ".join(keys_of(choice.table))
        return f"a list [{keys}]" if choice.table.as_list else f"a table {f'with {keys}' if keys else 'without keys'}"
    unit = f" ({choice.unit.name})" if choice.unit and choice.unit.name != "1" else ""
    return SIMPLE[choice.type] + _range(choice.marks) + unit


def text_of(allowed: Allowed) -> str:
    """An example of a text with a unit that a number may be, "10 mm"; nothing where it has no unit."""
    unit = allowed.quantity or next((choice.items.quantity for choice in allowed.choices if choice.items), None)
    return example(unit.texts[0]) if unit and unit.name != "1" else ""


def described(allowed: Allowed) -> str:
    """`statement`, and for a number that has a unit that it may as well be text: "…, or text such as "10 mm""."""
    text = text_of(allowed)
    return statement(allowed) + (f", or text such as {as_toml(text)}" if text else "")


def meaning(table: type[Table], name: str) -> str:
    """What a key of `table` is and must be: "displacement of the driven end; must be a number greater than 0 …"."""
    key = keys_of(table)[name]
    return f"{key.description}; must be {described(key.allowed)}"


def scene_schema() -> Node:
    """The JSON schema of a scene file."""
    whole = Tables.model_json_schema(by_alias=True)
    node: Node = _plain(whole, whole.pop("$defs"))
    _describe(Tables, node)
    return {"$schema": DIALECT} | node | {"title": "contact1d scene", "description": "A scene of contact1d."}


def schema_text() -> str:
    """The JSON schema of a scene file, as text."""
    return json.dumps(scene_schema(), indent=1, ensure_ascii=False) + "\n"


def _plain(node: Any, definitions: Node) -> Any:
    """`node` with definitions in place of references, without null (which TOML has not) and names that say nothing."""
    if isinstance(node, list):
        return [_plain(item, definitions) for item in node]
    if not isinstance(node, dict):
        return node
    if "$ref" in node:
        return _plain(definitions[node["$ref"].rpartition("/")[2]] | _without(node, "$ref"), definitions)
    choices = [one for one in node.get("anyOf", ()) if one != {"type": "null"}]
    if len(choices) == 1:
        return _plain(choices[0] | _without(node, "anyOf", "default"), definitions)
    kept = _without(node, "discriminator", *(["title"] if isinstance(node.get("title"), str) else []))
    return {key: _plain(item, definitions) for key, item in kept.items()}


def _without(node: Node, *keys: str) -> Node:
    return {key: item for key, item in node.items() if key not in keys}


def _describe(table: type[Table], node: Node) -> None:
    """Give every key in `node`, the schema of `table`, its meaning, and so on in the tables inside."""
    for name, inner in node["properties"].items():
        inner["description"] = meaning(table, name)
        choices = keys_of(table)[name].allowed.choices
        for choice, place in zip(choices, inner.get("oneOf", [inner]), strict=True):
            if choice.table:
                _describe(choice.table, place)


def _either(words: tuple[str, ...]) -> str:
    *others, last = (as_toml(word) for word in words)
    return f"{', '.join(others)} or {last}" if others else last


def _range(marks: tuple[Any, ...]) -> str:
    above = [f"greater than {mark.gt:g}" for mark in marks if isinstance(mark, Gt)]
    least = [f"{mark.ge:.10g}" for mark in marks if isinstance(mark, Ge)]
    most = [f"{mark.le:.10g}" for mark in marks if isinstance(mark, Le)]
    if least and most:
        return f" from {least[0]} to {most[0]}"
    parts = [*above, *(f"of at least {bound}" for bound in least)]
    parts += [f"at most {bound}" if parts else f"of at most {bound}" for bound in most]
    return f" {' and '.join(parts)}" if parts else ""
