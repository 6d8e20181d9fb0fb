"""A scene file to start from, as text: what a scene of its kind needs, and every other key behind a #.

The comments are what the tables themselves say of their keys; typed here are the values alone.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

from contact1d.workflow.scene import Scene, Table
from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import annotation_of, keys_of
from contact1d.workflow.scene.schema import meaning
from contact1d.workflow.scene.wording import kinds_of, members, table_of

WIDTH = 118
"""Characters of a line of comment."""
HEAD = (
    "A scene of contact1d: `contact1d run` and the name of this file runs it.",
    "A # with a letter or a [ right behind it begins a key or a table that is not set: take the # away to set it.",
    "Units: LU length, FU force, MU mass, TU = √(MU·LU/FU). What tables need of each other is told when it runs.",
)

BODY: dict[str, dict[str, Any]] = {
    "bodies": {
        "particles": "auto",
        "spacing": 1.0,
        "profile": {"kind": "parabola", "radius": 1000.0},
        "reduction": "geike_popov",
        "bulk_stiffness": 0.83,
    },
    "interaction": {
        "repulsion": {"amplitude": 0.18, "range": 0.13},
        "attraction": {"amplitude": 0.09, "range": 0.26},
    },
    "neighbours": {"stiffness": 0.3},
}
SCENES: dict[str, dict[str, Any]] = {
    "pull_off": BODY | {"experiment": {"kind": "pull_off", "preload": 1.0}},
    "load": BODY | {"experiment": {"kind": "load", "force": 3.0}},
    "path": BODY | {"experiment": {"kind": "path", "displacements": {"from": -1.0, "to": 2.0, "steps": 60}}},
    "slide": {
        "bodies": BODY["bodies"] | {"profile": {"kind": "parabola", "radius": 30.0}, "bulk_stiffness": 2.0},
        "interaction": {
            "repulsion": {"amplitude": 1.0, "range": 0.5},
            "attraction": {"amplitude": 0.5, "range": 1.0},
        },
        "horizontal": {},
        "damping": {"coefficient": "auto"},
        "plate": {"free": ["x", "z"]},
        "cantilever": {"stiffness": 20.0, "velocity": 0.05},
        "accuracy": {"tolerance": 2e-2},
        "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 6.0},
    },
    "tangential": {
        "bodies": BODY["bodies"] | {"reduction": "mdr", "bulk_stiffness": 1.0, "lower": "rigid_plane"},
        "friction": {"coefficient": 0.3},
        "experiment": {
            "kind": "tangential",
            "normal_force": 40.0,
            "displacements": {"from": 0.0, "to": 0.4, "steps": 40},
        },
    },
}
"""What is set in the file of each kind."""
STEEL = {"youngs_modulus": 210e9, "poisson_ratio": 0.3}
EXAMPLES: dict[str, dict[str, Any]] = {
    "interaction": BODY["interaction"],
    "bodies": {
        "bulk_stiffness_tangential": 0.83, "upper_particles": 40, "upper_spacing": 1.0, "upper_offset": 0.5,
    },
    "neighbours": {"stiffness": 0.3},
    "adhesion": {"work_of_adhesion": 0.005, "surface_energy": 0.0025, "range": 0.002},
    "friction": {"coefficient": 0.3},
    "damping": {"coefficient": "auto"},
    "noise": {"temperature": 1e-4, "seed": 1},
    "cantilever": {"stiffness": 20.0, "velocity": 0.05},
    "material": {
        "upper": STEEL, "lower": STEEL, "contact_modulus": 115e9, "length_unit": 1e-9, "force_unit": 1e-6,
        "mass_unit": 1e-12, "surface_energy": 1.0,
    },
    "output": {"states": 100},
    "experiment": {
        "method": "quasistatic", "normal_displacement": 1.0, "loading_rate": 1e-4,
        "velocity": 1e-3, "stiffness": 2.0,
        "repeats": 20, "path": [[0.05, 6.0], [-0.05, 6.0]],
    },
}  # fmt: skip
"""Values of keys that are not set and have no default."""


def starter(kind: str) -> str:
    """The text of a scene file for an experiment of this kind. Raises KeyError for an unknown kind."""
    scene = SCENES[kind]
    experiment = _table_of_kind(annotation_of(Scene, "experiment"), kind)
    lines = [line for head in HEAD for line in _comment(head)]
    lines.append(f"title = {as_toml((experiment.__doc__ or kind).strip().rstrip('.'))}")
    for key in keys_of(Scene):
        annotation = annotation_of(Scene, key)
        table = experiment if key == "experiment" else table_of(annotation)
        if table is not None:
            lines += ["", *_table(key, table, scene.get(key), annotation)]
    return "\n".join(lines) + "\n"


def _table(name: str, table: type[Table], given: Mapping[str, Any] | None, annotation: object) -> Iterator[str]:
    """A table with all its keys; behind # what is not given."""
    yield from _comment((table.__doc__ or "").strip().splitlines()[0])
    yield from _other_kinds(annotation, table)
    yield f"[{name}]" if given is not None else f"#[{name}]"
    for key, field in keys_of(table).items():
        if key != "kind":
            yield from _comment(meaning(table, key))
            yield from _inside(annotation_of(table, key), (given or {}).get(key))
        if given is not None and key in given:
            yield f"{key} = {as_toml(given[key])}"
        else:
            examples = EXAMPLES.get(name, {})
            yield f"#{key} = {as_toml(examples[key] if key in examples else table.model_fields[field].default)}"


def _inside(annotation: object, given: object) -> Iterator[str]:
    """What stands in an inline table: each key, and which other kinds of table there are."""
    for choice in members(annotation):
        table = table_of(choice)
        if table is None or (kinds_of(choice) and isinstance(given, Mapping) and given["kind"] not in kinds_of(choice)):
            continue
        for key in keys_of(table):
            if key != "kind":
                yield from _comment(f"{key}: {meaning(table, key)}", "#   ")
        yield from _other_kinds(annotation, table, "#   ")


def _other_kinds(annotation: object, chosen: type[Table], begin: str = "# ") -> Iterator[str]:
    for choice in members(annotation):
        table = table_of(choice)
        if table is None or table is chosen or not kinds_of(choice):
            continue
        keys = ", ".join(key for key in keys_of(table) if key != "kind")
        what = table.model_fields["kind"].description
        yield from _comment(f'or kind = "{kinds_of(choice)[0]}" ({what}) with {keys}', begin)


def _table_of_kind(annotation: object, kind: str) -> type[Table]:
    return next(t for choice in members(annotation) if kind in kinds_of(choice) and (t := table_of(choice)))


def _comment(text: str, begin: str = "# ") -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=begin, subsequent_indent="#" + " " * (len(begin) + 1))
