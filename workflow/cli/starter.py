"""A scene file to start from, as text: what a scene of its kind needs, and every other key behind a #.

The comments are what the tables themselves say of their keys; typed here are the values alone.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping
from typing import Any

from contact1d.workflow.scene import Scene, Table
from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import Allowed, keys_of
from contact1d.workflow.scene.schema import meaning

WIDTH = 118
"""Characters of a line of comment."""
HEAD = (
    "A scene of contact1d: `contact1d run` and the name of this file runs it.",
    "A # with a letter or a [ right behind it begins a key or a table that is not set: take the # away to set it.",
    "Units: LU length, FU force, MU mass, TU = √(MU·LU/FU). What tables need of each other is checked when it runs.",
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
    "hold": BODY
    | {
        "damping": {"coefficient": "auto"},
        "experiment": {"kind": "hold", "displacement": 0.5, "duration": 100.0},
    },
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
        "method": "quasistatic", "normal_displacement": 1.0, "force": 3.0, "loading_rate": 1e-4,
        "velocity": 1e-3, "stiffness": 2.0,
        "repeats": 20, "path": [[0.05, 6.0], [-0.05, 6.0]], "cycles": {"amplitude": 0.2, "number": 3, "points": 40},
    },
}  # fmt: skip
"""Values of keys that are not set and have no default."""


def starter(kind: str) -> str:
    """The text of a scene file for an experiment of this kind. Raises KeyError for an unknown kind."""
    scene, keys = SCENES[kind], keys_of(Scene)
    experiment = keys["experiment"].allowed.kinds[kind]
    lines = [line for head in HEAD for line in _comment(head)]
    lines.append(f"title = {as_toml((experiment.__doc__ or kind).strip().rstrip('.'))}")
    for name, key in keys.items():
        table = experiment if name == "experiment" else key.allowed.table
        if table is not None:
            lines += ["", *_table(name, table, scene.get(name), key.allowed)]
    return "\n".join(lines) + "\n"


def _table(name: str, table: type[Table], given: Mapping[str, Any] | None, allowed: Allowed) -> Iterator[str]:
    """A table with all its keys; behind # what is not given."""
    yield from _comment((table.__doc__ or "").strip().splitlines()[0])
    yield from _other_kinds(allowed, table)
    yield f"[{name}]" if given is not None else f"#[{name}]"
    here, examples = given or {}, EXAMPLES.get(name, {})
    for word, key in keys_of(table).items():
        if word != "kind":
            yield from _comment(meaning(table, word))
            yield from _inside(key.allowed, here.get(word))
        value = here.get(word, examples.get(word, key.default))
        yield f"{'' if word in here else '#'}{word} = {as_toml(value)}"


def _inside(allowed: Allowed, given: object) -> Iterator[str]:
    """What stands in an inline table: each key, and which other kinds of table there are."""
    for choice in allowed.choices:
        if choice.table is None or (isinstance(given, Mapping) and choice.kind not in (None, given.get("kind"))):
            continue
        for word in keys_of(choice.table):
            if word != "kind":
                yield from _comment(f"{word}: {meaning(choice.table, word)}", "#   ")
        yield from _other_kinds(allowed, choice.table, "#   ")


def _other_kinds(allowed: Allowed, chosen: type[Table], begin: str = "# ") -> Iterator[str]:
    for kind, table in allowed.kinds.items():
        if table is not chosen:
            keys = keys_of(table)
            what, others = keys["kind"].description, ", ".join(word for word in keys if word != "kind")
            yield from _comment(f'or kind = "{kind}" ({what}) with {others}', begin)


def _comment(text: str, begin: str = "# ") -> list[str]:
    return textwrap.wrap(text, WIDTH, initial_indent=begin, subsequent_indent="#" + " " * (len(begin) + 1))
