"""Errors in a scene: one line for each, in the terms of the scene file."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import Any

from contact1d.workflow.errors import Contact1dError, SceneEdit

SHOWN_LENGTH = 60
"""Largest number of characters of a given value in a message."""
BARE = re.compile(r"[A-Za-z0-9_-]+")
"""A key that TOML writes without quotes."""
MOST_PROBLEMS = 20
"""Largest number of problems that are listed; the number of the others is added."""


@dataclass(frozen=True)
class Problem:
    """One error: where (`path`), what was `given` (as TOML, or None), what is allowed, and what to do (`hint`).

    `ways`: sets of values by dotted keys, each of which makes the scene valid, where the program knows them.
    """

    path: str
    message: str
    given: str | None = None
    hint: str = ""
    ways: tuple[Mapping[str, object], ...] = field(default=(), compare=False)

    def __str__(self) -> str:
        """Return the problem as one line: `path = given: message; hint`, without the parts that it lacks.

        The path is cut to 1000 characters, the last of which is then "…"; the other parts have any length.
        """
        given = "" if self.given is None else f" = {self.given}"
        hint = f"; {self.hint}" if self.hint else ""
        path = _cut(self.path, 1000)  # a key of a scene has any length
        return f"{path}{given}: {self.message}{hint}"


class SceneError(Contact1dError):
    """A scene cannot be used; `problems` has every mistake found, in the order of the scene's tables."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        """Store `problems` as a tuple; as the only argument, so that the error survives pickling between processes."""
        self.problems = tuple(problems)
        super().__init__(self.problems)

    @property
    def changes(self) -> tuple[SceneEdit, ...]:
        """One edit of the scene for each fix of the first problem, with the first fix of every other problem added.

        A key of several problems has the value of the last one. Empty where any problem has no fix; ValueError without
        problems.
        """
        if not all(problem.ways for problem in self.problems):
            return ()
        first, *rest = self.problems
        common = {key: value for problem in rest for key, value in problem.ways[0].items()}
        return tuple(SceneEdit({**values, **common}) for values in first.ways)

    def __str__(self) -> str:
        """Return the first 20 problems, one on each line; of more, "and N more" on a last line; "" without any."""
        more = len(self.problems) - MOST_PROBLEMS
        return "\n".join([*map(str, self.problems[:MOST_PROBLEMS]), *[f"and {more} more"][: max(more, 0)]])


def as_toml(value: object) -> str:
    """Return `value` as TOML text on one line: text, numbers, booleans, lists, tuples and tables (inline).

    Text is in double quotes, with escapes. Anything else, None for instance, which a scene cannot hold, is written by
    `str`.

    Raises:
        ValueError: an integer has more digits than Python writes (4300).
        RecursionError: lists or tables are nested too deep.
    """
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return '"' + "".join(_escaped(c) for c in value) + '"'
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, list | tuple):
        return "[" + ", ".join(as_toml(item) for item in value) + "]"
    if isinstance(value, Mapping):
        inside = ", ".join(f"{as_key(str(key))} = {as_toml(item)}" for key, item in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    return str(value)


def shown(value: object) -> str:
    """Return `value` as TOML, shortened to at most 60 characters, for messages; "…" for one that cannot be written.

    A longer text ends with "…". An integer of thousands of digits and nesting that is too deep cannot be written.
    """
    try:
        text = as_toml(value)
    except (ValueError, RecursionError):  # an integer of thousands of digits; nesting without end
        return "…"
    return _cut(text, SHOWN_LENGTH)


def _cut(text: str, most: int) -> str:
    """Return a text, shortened to `most` characters, the last of which is then "…"; unchanged if it has no more."""
    return text if len(text) <= most else text[: most - 1] + "…"


def as_key(key: str) -> str:
    """Return `key` as TOML writes it: unchanged if it has ASCII letters, digits, "_" and "-" alone, else in quotes.

    An empty key is in quotes, too.
    """
    return key if BARE.fullmatch(key) else as_toml(key)


def tables_as_toml(tables: Mapping[str, Any]) -> str:
    """Return the `tables` of a scene as the text of a TOML file: one [table] for each dict, those in it inline.

    Keys above the first table, such as the title, come first, wherever they are in `tables`; a blank line precedes each
    table. What TOML lacks, None for instance, is written by `str`. "" without any.
    """
    inside = {f"[{name}]\n": table for name, table in tables.items() if isinstance(table, dict)}
    above = {key: value for key, value in tables.items() if not isinstance(value, dict)}
    return "\n".join(
        head + "".join(f"{as_key(key)} = {as_toml(value)}\n" for key, value in table.items())
        for head, table in {"": above, **inside}.items()
    )


def path_of(keys: Iterable[str | int]) -> str:
    """Return the dotted path of nested `keys`, indices in brackets: `experiment.displacements[2]`; "" without keys.

    A key that TOML must quote is in quotes.
    """
    path = ""
    for key in keys:
        path += f"[{key}]" if isinstance(key, int) else ("." if path else "") + as_key(key)
    return path


def keys_in(path: str) -> list[str | int]:
    """Return the keys of a dotted path in order: "experiment.displacements[2]" as ["experiment", "displacements", 2].

    Indices in brackets, and keys of digits alone, are int. Quotes are not read: they stay in the key, and a dot between
    them splits it. [""] for an empty path.
    """
    return [int(key) if key.isdecimal() else key for key in re.sub(r"\[(\d+)\]", r".\1", path).split(".")]


def nearest(word: str, allowed: Iterable[str]) -> str | None:
    """Return the word out of `allowed` that a person who wrote `word` most likely meant; None where none is similar.

    It is the only one that begins with `word`, of three letters at least, else the one with the most similar spelling,
    a `difflib` ratio of 0.7 or more; so a word in `allowed` is itself returned. `word` is compared in lower case with
    "_" in place of "-" and blanks. Of more than 60 characters it is compared by its beginning alone.
    """
    known, meant = list(allowed), plain(word)
    starting = [name for name in known if len(meant) > 2 and name.startswith(meant)]
    if len(starting) == 1 or len(meant) > SHOWN_LENGTH:
        return next(iter(starting), None)
    return next(iter(get_close_matches(meant, known, n=1, cutoff=0.7)), None)


def suggestion(word: str, known: Collection[str], label: str = "allowed here") -> str:
    """Return what to write in place of an unknown `word`: 'did you mean "…"? allowed here: …'.

    All that are `known` are listed in their order, "no keys" where there are none; without a similar word the question
    is left out. `label`: the words before the list.
    """
    meant = nearest(word, known)
    begin = f'did you mean "{meant}"? ' if meant else ""
    return f"{begin}{label}: {', '.join(known) or 'no keys'}"


def plain(word: str) -> str:
    """Return `word` as keys are written: lower case, "_" in place of "-" and blanks, none around it."""
    return word.strip().lower().replace("-", "_").replace(" ", "_")


def _escaped(character: str) -> str:
    """Return a character as a text in TOML has it: with a backslash where it is a quote, a backslash or not printable.

    Any other character is returned unchanged.
    """
    if character in '"\\':
        return "\\" + character
    if character.isprintable():
        return character
    named = {"\n": "\\n", "\t": "\\t", "\r": "\\r"}
    code = ord(character)
    return named.get(character) or (f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}")
