"""The scene file for editors: a JSON schema made from the tables, and what every key means in one sentence.

It knows each table by itself; what tables need of each other is told by the program alone. Written without references
and in the words of draft 7, which editors of TOML read (taplo, and with it Even Better TOML in VS Code).
"""

from __future__ import annotations

import json
from typing import Any

from contact1d.workflow.scene.quantities import Table, annotation_of, keys_of
from contact1d.workflow.scene.tables import Scene
from contact1d.workflow.scene.wording import described, members, table_of

DIALECT = "http://json-schema.org/draft-07/schema#"
Node = dict[str, Any]


def scene_schema() -> Node:
    """The JSON schema of a scene file."""
    whole = Scene.model_json_schema(by_alias=True)
    node: Node = _plain(whole, whole.pop("$defs"))
    _describe(Scene, node)
    return {"$schema": DIALECT} | node | {"title": "contact1d scene", "description": "A scene of contact1d."}


def schema_text() -> str:
    """The JSON schema of a scene file, as text."""
    return json.dumps(scene_schema(), indent=1, ensure_ascii=False) + "\n"


def meaning(table: type[Table], key: str) -> str:
    """What the key `key` of `table` is and must be: "way of the driven end; must be a number greater than 0 …"."""
    what = table.model_fields[keys_of(table)[key]].description
    return f"{what}; must be {described(annotation_of(table, key))}"


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
    for key, inner in node["properties"].items():
        annotation = annotation_of(table, key)
        inner["description"] = meaning(table, key)
        for choice, place in zip(members(annotation), inner.get("oneOf", [inner]), strict=True):
            if inside := table_of(choice):
                _describe(inside, place)
