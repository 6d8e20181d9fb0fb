"""The text of a scene file to start from: what a scene of its kind needs, and every other key behind a #.

The comments are the descriptions of the keys in their tables; `starter.toml` has the values.
"""

from __future__ import annotations

import textwrap
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from contact1d.workflow.scene import Problem, Scene, SceneError, Table, read_scene
from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import Allowed, keys_of
from contact1d.workflow.scene.schema import meaning

HEAD = (
    "A scene of contact1d; run it with: contact1d run FILE.",
    "Remove the # before a key or a table to set it. Combinations of tables are checked at the start of a run.",
    "Quantities have units of SI; numbers without units are in units of the model: LU, FU, MU, TU = √(MU·LU/FU).",
)

DATA: dict[str, Any] = tomllib.loads(Path(__file__).with_name("starter.toml").read_text(encoding="utf-8"))
"""The values in the file of each experiment, and examples for keys that are not set."""


def starter_scene(kind: str, profile: str | None = None, material: str | None = None) -> dict[str, Any]:
    """Return the tables of a scene of an experiment, to start from, by name; values are as in a scene file.

    The tables in them are shared by all calls: the caller must not change them.

    Args:
        kind: experiment.
        profile: profile of the upper body; None: a parabola.
        material: upper and lower body, such as "steel/glass", or one name for both; None: steel on glass. It is not
            checked.

    Raises:
        SceneError: the bodies of this experiment are fixed, and a profile or a material is given.
        KeyError: there is no such experiment or profile.
    """
    scene = dict(DATA["scenes"][kind])
    bodies = scene.get("bodies", {})
    if "profile" in bodies:
        if profile or material:
            message = "has no --profile and no --material: its two bodies are particles that an interaction holds"
            raise SceneError([Problem(f"--kind {kind}", message, hint="leave both out, and change the file")])
        return scene
    upper, _, lower = (material or "steel/glass").partition("/")
    scene["bodies"] = DATA["bodies"] | bodies | {"profile": DATA["profiles"][profile or "parabola"]}
    return scene | {"material": {"upper": upper, "lower": lower or upper}}


def starter(kind: str, profile: str | None = None, material: str | None = None) -> str:
    """Return the text of a scene file for an experiment, with every key; those that are not set are behind #.

    Args:
        kind: experiment.
        profile: profile of the upper body; None: a parabola.
        material: upper and lower body, such as "steel/glass", or one name for both; None: steel on glass.

    Raises:
        SceneError: the bodies of this experiment are fixed, and a profile or a material is given, or a material has no
            such name.
        KeyError: there is no such experiment or profile.
    """
    scene, keys = starter_scene(kind, profile, material), keys_of(Scene)
    read_scene({"title": kind, **scene})  # so that a material without a name is reported before there is a file
    experiment = keys["experiment"].allowed.kinds[kind]
    lines = [line for head in HEAD for line in _comment(head)]
    lines.append(f"title = {as_toml((experiment.__doc__ or kind).strip().rstrip('.'))}")
    for name, key in keys.items():
        table = experiment if name == "experiment" else key.allowed.table
        if table is not None:
            lines += ["", *_table(name, table, scene.get(name), key.allowed)]
    return "\n".join(lines) + "\n"


def _table(name: str, table: type[Table], given: Mapping[str, Any] | None, allowed: Allowed) -> Iterator[str]:
    """Yield the lines of a table of a scene file with all its keys, each after its meaning; those not given behind #.

    Args:
        name: of the table in the file.
        table: its class.
        given: its values; None: the whole table is behind #.
        allowed: what the scene allows in its place.
    """
    yield from _comment((table.__doc__ or "").strip().splitlines()[0])
    yield from _other_kinds(allowed, table)
    yield f"[{name}]" if given is not None else f"#[{name}]"
    values, examples = given or {}, DATA["examples"].get(name, {})
    for word, key in keys_of(table).items():
        if word != "kind":
            yield from _comment(meaning(table, word))
            yield from _inside(key.allowed, values.get(word))
        value = values.get(word, examples.get(word, key.default))
        yield f"{'' if word in values else '#'}{word} = {as_toml(value)}"


def _inside(allowed: Allowed, given: object) -> Iterator[str]:
    """Yield the comments of an inline table: its keys, and the other kinds of table that may stand there.

    Nothing for a key that allows no table. Where `given` has a kind, only the keys of that kind; else those of all
    kinds.
    """
    for kind, table in allowed.tables.items():
        if isinstance(given, Mapping) and kind not in ("", given.get("kind")):
            continue
        for word in keys_of(table):
            if word != "kind":
                yield from _comment(f"{word}: {meaning(table, word)}", "#   ")
        yield from _other_kinds(allowed, table, "#   ")


def _other_kinds(allowed: Allowed, chosen: type[Table], begin: str = "# ") -> Iterator[str]:
    """Yield the comments on the other kinds of table that may stand in place of the `chosen` one, with their keys.

    Nothing where there is one kind only.
    """
    for kind, table in allowed.kinds.items():
        if table is not chosen:
            keys = keys_of(table)
            parameters = ", ".join(word for word in keys if word != "kind")
            extra = f" with {parameters}" if parameters else ""
            yield from _comment(f'or kind = "{kind}" ({keys["kind"].description}){extra}', begin)


def _comment(text: str, begin: str = "# ", width: int = 118) -> list[str]:
    """Return a text as lines of a comment, wrapped to `width` characters, the first of which begins with `begin`.

    The others begin with # and are indented further. [] for an empty text.
    """
    return textwrap.wrap(text, width, initial_indent=begin, subsequent_indent="#" + " " * (len(begin) + 1))
