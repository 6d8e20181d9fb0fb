"""The JSON schema that `contact1d schema` prints is kept in docs/scene.schema.json, and docs/scene.md is made of it.

Renew both with WRITE_DOCS=1 pytest tests/unit/test_scene_schema.py.
"""

import json
import os
import re
from collections.abc import Iterator
from typing import Any

from contact1d import Quantity
from contact1d.workflow.units import SI
from tests.command import contact1d
from tests.scenes import ROOT, STEEL_ON_GLASS, refused

COPY, PAGE = ROOT / "docs" / "scene.schema.json", ROOT / "docs" / "scene.md"
PRINTED = contact1d("schema").output
SCHEMA = json.loads(PRINTED)
Node = dict[str, Any]


def tables(node: Node) -> Iterator[Node]:
    """The tables that a key may be, or each item of its list."""
    for choice in node.get("anyOf", [node]):
        if "anyOf" in choice or "items" in choice:
            yield from tables(choice.get("items", choice))
        elif "properties" in choice:
            yield choice


def table_of(heading: str) -> Node:
    """That of a heading of the page: "experiment, kind load", "experiment.cycles", "viscoelasticity.terms, each"."""
    path, _, kind = heading.partition(", kind ")
    found = [SCHEMA]
    for key in path.partition(",")[0].split("."):
        keys = [table["properties"][key] for table in found if key in table["properties"]]
        found = [table for one in keys for table in tables(one)]
    if path.endswith(("each", "table")):  # a list of tables comes before a table in place of it
        found = [found[0 if path.endswith("each") else -1]]
    table, *others = (one for one in found if not kind or one["properties"]["kind"]["enum"] == [kind])
    assert all(other == table for other in others)
    return table


def section(heading: str, summary: str) -> str:
    table, lines = table_of(heading), [f"\n## [{heading}]\n", f"{summary}\n"]
    if table["properties"]:
        lines.append("| key | what | must be | where absent |\n| --- | --- | --- | --- |")
    for word, key in table["properties"].items():
        what, _, allowed = key["description"].partition("; must be ")
        what, _, default = what.partition("; absent: ")
        default = default or "none"
        if "default" in key:
            text = key["default"] if isinstance(key["default"], str) else json.dumps(key["default"])
            default = f"`{text}`"
        absent = "required" if word in table["required"] else default
        lines.append(f"| `{word}` | {what} | {allowed} | {absent} |".replace("|x|", "\\|x\\|"))
    return "\n".join(lines) + "\n"


def test_the_page_of_all_keys_and_the_copy_are_what_the_schema_says() -> None:
    page = PAGE.read_text(encoding="utf-8")
    begin, end = page.index("\n## ["), page.index("\n# What results.json holds")
    headings = dict(re.findall(r"^## \[(.*)\]\n\n(.*)$", page, re.MULTILINE))
    made = page[:begin] + "".join(section(*one) for one in headings.items()) + page[end:]
    if os.environ.get("WRITE_DOCS"):
        PAGE.write_text(made, encoding="utf-8")
        COPY.write_text(PRINTED, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == made
    assert COPY.read_text(encoding="utf-8") == PRINTED
    assert {one.split(",")[0].split(".")[0] for one in headings} | {"title"} == SCHEMA["properties"].keys()
    for name in ("bodies.profile", "experiment"):
        kinds = set(re.findall(rf"^## \[{name}, kind (\w+)\]$", page, re.MULTILINE))
        said = str(refused(STEEL_ON_GLASS, [f"{name}.kind=x"]))
        assert kinds == set(re.findall(r'"(\w+)"', said.partition("must be ")[2]))


def described(node: Node) -> Iterator[str]:
    for table in tables(node):
        for key in table["properties"].values():
            yield key["description"]
            yield from described(key)


def test_every_key_has_a_meaning_and_every_number_a_text_in_a_unit_of_its_dimension() -> None:
    page, keys = PAGE.read_text(encoding="utf-8"), list(described(SCHEMA))
    rows = re.findall(r'^\| (\S+) \| .* \| `"\S+ (.*)"` \|$', page, re.MULTILINE)
    numbers = [found for one in keys for found in re.findall(r'\((\S+)\).* text such as "\S+ (.*)"', one)]
    assert len(rows) == 10
    assert len(numbers) == sum("text such as" in one for one in keys) > 50
    for unit, written in (*rows, *numbers):
        if written != "K":  # k_BT
            Quantity(1.0, 0.0, SI[unit].si if unit in SI else unit).to(written)
    assert all(what and allowed for what, _, allowed in (one.partition("; must be ") for one in keys))
