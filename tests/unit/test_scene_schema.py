"""The JSON schema of scenes takes what the program takes, and marks what one table can have wrong.

docs/scene.schema.json is a copy; renew it with WRITE_DOCS=1 pytest tests/unit/test_scene_schema.py.
"""

from __future__ import annotations

import json
import os
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

from contact1d import SceneError, read_scene
from contact1d.workflow.scene.read import apply_overrides
from contact1d.workflow.scene.schema import scene_schema, schema_text

ROOT = Path(__file__).parents[2]
COPY = ROOT / "docs" / "scene.schema.json"
SHIPPED = sorted((ROOT / "lammps_inputs" / "scenes").glob("*.toml"))
SCHEMA = scene_schema()

TYPES = {"object": dict, "array": list, "string": str, "boolean": bool, "integer": int, "number": (int, float)}
BOUNDS = {
    "minimum": lambda value, bound: value >= bound,
    "maximum": lambda value, bound: value <= bound,
    "exclusiveMinimum": lambda value, bound: value > bound,
    "minItems": lambda value, bound: len(value) >= bound,
    "const": lambda value, wanted: value == wanted,
    "enum": lambda value, words: value in words,
    "pattern": lambda value, pattern: re.search(pattern, value) is not None,
}
WORDS = {"$schema", "title", "description", "default", "type", "properties", "required", "additionalProperties"}
WORDS |= {"oneOf", "anyOf", "items", *BOUNDS}


def valid(value: Any, schema: dict[str, Any]) -> bool:
    """Whether `value` is what `schema` describes, by the words of draft 7 that the schema uses; it may use no other."""
    assert schema.keys() <= WORDS
    if "oneOf" in schema:
        return sum(valid(value, choice) for choice in schema["oneOf"]) == 1
    if "anyOf" in schema:
        return any(valid(value, choice) for choice in schema["anyOf"])
    wanted = schema["type"]
    if not isinstance(value, TYPES[wanted]) or isinstance(value, bool) != (wanted == "boolean"):
        return False
    if not all(BOUNDS[word](value, bound) for word, bound in schema.items() if word in BOUNDS):
        return False
    if wanted == "array":
        return all(valid(item, schema["items"]) for item in value)
    if wanted == "object":
        assert schema["additionalProperties"] is False
        known = schema["properties"]
        there = value.keys() <= known.keys() and value.keys() >= set(schema.get("required", ()))
        return there and all(valid(item, known[key]) for key, item in value.items())
    return True


def shipped(name: str, *overrides: str) -> dict[str, Any]:
    data = tomllib.loads((ROOT / "lammps_inputs" / "scenes" / f"{name}.toml").read_text(encoding="utf-8"))
    assert apply_overrides(data, overrides) == []
    return data


def test_the_kept_copy_is_what_the_tables_say() -> None:
    if os.environ.get("WRITE_DOCS"):
        COPY.write_text(schema_text(), encoding="utf-8")
    assert json.loads(COPY.read_text(encoding="utf-8")) == SCHEMA


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_every_shipped_scene_is_valid(path: Path) -> None:
    assert valid(tomllib.loads(path.read_text(encoding="utf-8")), SCHEMA)


@pytest.mark.parametrize(
    "override",
    [
        "bodies.spacing=2",
        "bodies.profile={kind='cone', slope=0.1}",
        "bodies.profile={kind='table', file='tip.csv', scale=2.0}",
        "interaction.cutoff=3.0",
        "interaction.cutoff='3 nm'",
        "bodies.spacing='.5 µm'",
        "experiment={kind='path', displacements=['-1.5e-3 mm', 0, '1 Å']}",
        "experiment={kind='path', displacements={from='0 nm', to='1 nm', steps=5}}",
        "material={upper={youngs_modulus='210 GPa', poisson_ratio=0.5}, contact_modulus='1 Pa', force_unit='1 N'}",
        "experiment={kind='path', displacements=[0.0, 1, -1.0]}",
        "experiment={kind='path', displacements={from=0.0, to=1.0, steps=5}}",
        "material={upper={youngs_modulus=1e9, poisson_ratio=0.5}, contact_modulus=1.0, surface_energy=1}",
        "plate={free=['x', 'z'], mass='auto'}",
    ],
)
def test_what_a_table_may_hold_is_valid(override: str) -> None:
    assert valid(shipped("pull_off", override), SCHEMA)


@pytest.mark.parametrize(
    "override",
    [
        "colour='red'",
        "title=1",
        "bodies.spacing=-1.0",
        "bodies.spacing='1'",
        "bodies.spacing='nm'",
        "bodies.particles='30 nm'",
        "bodies.mass=true",
        "bodies.particles=2",
        "bodies.particles=30.5",
        "bodies.particles='many'",
        "bodies.lower='plane'",
        "bodies.profile={kind='sphere', radius=1.0}",
        "bodies.profile={kind='cone', radius=1.0}",
        "bodies.profile={kind='table', r=[0.0], z=[0.0]}",
        "interaction={attraction={amplitude=1.0, range=1.0}}",
        "interaction.repulsion={amplitude=1.0}",
        "horizontal.stiffness=1.0",
        "noise={temperature=1e-4, seed=0}",
        "plate={free=['y']}",
        "material={upper={youngs_modulus=1e9, poisson_ratio=0.6}}",
        "accuracy.tolerance=0.5",
        "experiment={kind='pull'}",
        "experiment={kind='slide', normal_force=1.0, distance=5.0, method='dynamic'}",
        "experiment={kind='path', displacements=[]}",
        "experiment={kind='path', displacements={from=0.0, to=1.0}}",
    ],
)
def test_a_mistake_in_a_table_is_marked_as_the_program_tells_it(override: str) -> None:
    wrong = shipped("pull_off", override)
    assert not valid(wrong, SCHEMA)
    with pytest.raises(SceneError):
        read_scene(wrong)


def test_a_required_table_that_is_missing_is_marked() -> None:
    whole = shipped("pull_off")
    for name in ("title", "bodies", "experiment"):
        assert not valid({key: table for key, table in whole.items() if key != name}, SCHEMA)


def test_every_key_has_a_description_with_what_it_must_be() -> None:
    def described(schema: dict[str, Any]) -> bool:
        keys = schema.get("properties", {}).values()
        inside = [*keys, *schema.get("oneOf", ())]
        return all("; must be " in key["description"] for key in keys) and all(map(described, inside))

    assert described(SCHEMA)
    repulsion = SCHEMA["properties"]["interaction"]["properties"]["repulsion"]
    assert "(FU·LU)" in repulsion["properties"]["amplitude"]["description"]
