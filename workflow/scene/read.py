"""A scene from a TOML file or a dict: either a `Scene` whose tables fit together, or every problem at once."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from os import PathLike, fspath
from pathlib import Path as FilePath
from typing import Any

from pydantic import ConfigDict, PrivateAttr, ValidationError

from contact1d.files import UnreadableError, read_text
from contact1d.workflow.scene.check import mend_words, report_faults
from contact1d.workflow.scene.columns import put_terms
from contact1d.workflow.scene.conversion import UNIT_KEYS, convert
from contact1d.workflow.scene.draft import Draft
from contact1d.workflow.scene.file_kinds import require_kind, require_tables
from contact1d.workflow.scene.problems import BARE, Problem, SceneError, keys_in, shown, suggestion, tables_as_toml
from contact1d.workflow.scene.profile_file import put_points, take_points
from contact1d.workflow.scene.quantities import Place, Table, keys_of
from contact1d.workflow.scene.rules import check_fit
from contact1d.workflow.scene.shapes import Shape
from contact1d.workflow.scene.si_text import MODEL_UNITS
from contact1d.workflow.scene.tables import EFFECTS, WHOLE, Tables
from contact1d.workflow.scene.uncertain import moved, take_shares, with_shares
from contact1d.workflow.units import Scales

DEEPEST = 100
"""Largest number of levels of tables and lists in a scene."""
TOO_DEEP = f"tables or lists are nested more than {DEEPEST} deep; check for an extra dot or bracket"
LONG_KEY = re.compile(rf"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')\s*+\.\s*+){{{DEEPEST}}}""")
"""A dotted key with more levels: tomllib takes minutes for it."""
MEANING = {
    "Cannot overwrite a value": "this key is given twice",
    "Cannot declare": "this table is given twice",
    "Invalid value": "this is not a value",
    "Expected newline or end of document": "unexpected text after the value",
    "Unclosed array": "a list is not closed",
    "Expected '=' after a key": "a key needs = and a value",
    "Invalid statement": "this is neither key = value nor a [table]",
    "Invalid initial character for a key part": "this is neither key = value nor a [table]",
    "Expected ']' at the end of a table declaration": "the name of a table is not closed with ]",
    "Unterminated string": "the text is not closed with a quote",
    "Illegal character '\\n'": "the text is not closed with a quote",
    "Unclosed inline table": "an inline table { … } must be closed on the same line",
    "Exceeds the limit": "a whole number has thousands of digits",
}
"""Messages for the user by the beginnings of those of tomllib."""

HINTS = {
    "Unclosed inline table": 'a number with a unit stands in quotes, "10 mm"',
    "Invalid value": "write text in quotes, a number with digits around its point, true and false in lower case",
    "Expected newline or end of document": (
        'write one key = value per line, decimals after a point, a number with a unit in quotes, "10 mm"'
    ),
}


class Scene(Tables):
    """A whole scene, whose tables fit together: `read_scene` makes it."""

    model_config = ConfigDict(defer_build=False)  # with all its tables, once
    _shares: dict[str, float] = PrivateAttr(default_factory=dict)

    @property
    def shares(self) -> Mapping[str, float]:
        """The 95 % half-width over the value (relative) of each number that has ±, by dotted key; empty without any."""
        return self._shares

    @property
    def tables(self) -> dict[str, Any]:
        """The tables of the scene file by name, a new dict with defaults and ±, which reads back as an equal scene.

        Keys that are absent and have no default are left out. A reduction is there also where it follows from other
        keys.
        """
        return with_shares(self.model_dump(mode="json", by_alias=True, exclude_none=True), self._shares)

    @property
    def given(self) -> dict[str, Any]:
        """The tables of the scene file by name, a new dict with defaults and ±.

        Without a reduction that the file does not give: it follows from other keys, and may then change with them.
        """
        return with_shares(plain_data(self), self._shares)

    def __str__(self) -> str:
        """Return the scene as the text of a TOML file, with defaults, ± and its reduction."""
        return tables_as_toml(self.tables)

    def moved(self, key: str, factor: float) -> Scene:
        """Return a copy of the scene with the number at a dotted key times a factor, unchecked; its ± are unchanged.

        A flat punch keeps its number of particles: with its radius a given spacing, and with that a given normal
        stiffness, change by the same factor.

        Raises:
            KeyError: there is no such key.
        """
        bodies = self.bodies
        scene: Scene = moved(self, keys_in(key), factor)
        if key == "bodies.profile.radius" and bodies.profile.has_edge and bodies.given_spacing != "auto":
            scene = moved(scene, ["bodies", "spacing"], factor)
            if bodies.bulk_stiffness != "auto":
                scene = moved(scene, ["bodies", "bulk_stiffness"], factor)
        return scene

    def with_(self, changes: Mapping[str, Any] | None = None, *, without: Iterable[str] = (), **keywords: Any) -> Scene:
        """Return a new scene with values changed, checked as a whole; this one is unchanged.

            scene.with_({"bodies.profile.radius": 2000.0, "accuracy.tolerance": 1e-4}, without="neighbours")
            scene.with_(bodies__profile__radius=2000.0, accuracy__tolerance=1e-4)

        Values that follow from others, such as a reduction that was not given, follow anew.

        Args:
            changes: values by dotted keys, as in a scene file; a table is a dict, None removes a key or table.
            without: effects whose tables are removed after the changes.
            keywords: more changes, the keys' dots written as two underscores; they have priority.

        Raises:
            SceneError: the changed scene is not valid, or an effect to remove is absent, with every problem at once; or
                `changes` is no mapping.
        """
        given: object = {} if changes is None else changes
        if not isinstance(given, Mapping):
            form = 'write {"bodies.profile.radius": 2000.0}'
            raise SceneError([Problem("changes", "must be a mapping of dotted keys to values", shown(given), form)])
        named = {key.replace("__", "."): value for key, value in keywords.items()}
        data = self.given
        problems = set_values(data, {**given, **named})
        problems += remove_effects(data, _listed(without))
        return _checked(plain_data(data), problems, FilePath())

    def with_profile(self, profile: Shape) -> Scene:
        """Return a copy of the scene with another shape of the upper body, which is not checked."""
        return self.model_copy(update={"bodies": self.bodies.model_copy(update={"profile": profile})})


AnyScene = Scene | str | PathLike[str] | Mapping[str, Any]
"""The types of a source from which `read_scene` makes a scene."""


def read_scene(
    source: AnyScene,
    overrides: Iterable[str] = (),
    without: Iterable[str] = (),
    folder: str | PathLike[str] | None = None,
) -> Scene:
    """Return the scene that `source` describes, checked; `source` is not changed.

    Args:
        source: a TOML file, by its path; or TOML text, which is a `str` with a line break or "=" in it; or a mapping of
            tables with the keys of a scene file, where None counts as absent; or a `Scene`.
        overrides: strings "table.key=value", applied in order, the value read as TOML or else as bare text; a single
            string is one of them.
        without: names of effects whose tables are removed after that; a single string is one name.
        folder: where a file with the points of a profile is looked for; None: the folder of `source`, if that is a
            file, or the current one. The points are read into the scene, which does not need the file afterwards.

    Raises:
        SceneError: with every problem at once, also for a file that is missing, unreadable, not UTF-8, not TOML or that
            of another command, and for an effect to remove that is absent.
    """
    if isinstance(source, Scene):
        plain: Any = source.given
    elif isinstance(source, Mapping):
        plain = plain_data(source)
    else:
        plain = read_tables(source)
        folder = folder or (None if _is_text(source) else FilePath(source).parent)
    require_kind(plain, "scene", source)
    problems = apply_overrides(plain, _listed(overrides)) + remove_effects(plain, _listed(without))
    return _checked(plain, problems, FilePath(folder or "."))


def read_tables(source: str | PathLike[str]) -> dict[str, Any]:
    """Return the tables of a TOML file, by its path, or of TOML text (a `str` with a line break or "="), unchecked.

    Raises:
        SceneError: with one problem: no such file, one that is unreadable or not UTF-8, no TOML, too deep, data or a
            folder of results, or `source` is neither path nor text.
    """
    if not isinstance(source, str | PathLike):
        given = type(source).__name__
        raise SceneError([Problem("scene", f"must be a path, TOML text, tables or a Scene, not {given}")])
    if _is_text(source):
        return _tables(str(source), "scene")
    try:
        return _tables(read_text(FilePath(source)), fspath(source))
    except (UnreadableError, SceneError) as error:
        require_tables(FilePath(source))
        raise SceneError(getattr(error, "problems", None) or [Problem(*error.args)]) from error


def _is_text(source: object) -> bool:
    """Return whether a source is TOML text and no path: a `str` with a line break or "=" in it."""
    return isinstance(source, str) and ("\n" in source or "=" in source)


def _checked(plain: dict[str, Any], problems: list[Problem], folder: FilePath) -> Scene:
    """Return the scene of the tables `plain`, which is corrected in place; texts with units in it become numbers.

    Args:
        plain: tables by name.
        problems: those that are known already; the others are added to it.
        folder: where the file of a profile is looked for.

    Raises:
        SceneError: with every problem at once.
    """
    tables = Place(plain, WHOLE)
    mend_words(tables)
    points, lines = take_points(tables, folder), put_terms(tables, folder)
    shares = take_shares(tables)
    has_texts = convert(tables)
    put_points(tables, points)
    scene = None
    try:
        scene = Scene.model_validate(plain)
    except ValidationError as error:
        report_faults(tables, error)
    check_fit(tables)
    if scene is not None and shares:
        scene._shares.update(shares)
        if scene.noise or scene.experiment.motion_is_result:
            path = next(iter(shares))
            message = "a result over time has no uncertainty from its inputs: write the value alone"
            tables.problems.append(Problem(path, message))
        if not tables.problems:
            tables.problems += _at_ends(scene)
    problems += sorted(_in_si(tables, has_texts), key=_rank)
    problems = [replace(problem, path=lines.get(problem.path, problem.path)) for problem in problems]
    if problems or scene is None:
        raise SceneError(problems)
    return scene


def _at_ends(scene: Scene) -> Iterator[Problem]:
    """Yield the problems that a scene has with a number in a list at an end of its ±, such as times that do not rise.

    The first problem of each end, with the key of the number. Numbers that are in no list are not moved.
    """
    for path, share in scene.shares.items():
        for factor in (1.0 - share, 1.0 + share) if "[" in path else ():
            end = Place(plain_data(scene.moved(path, factor)), WHOLE)
            check_fit(end)
            for problem in end.problems[:1]:
                yield Problem(path, f"at an end of its ±: {problem.message}", hint=problem.hint)


def _in_si(tables: Place, has_texts: bool) -> list[Problem]:
    """Return the problems of a scene, with SI in place of LU, FU and MU in messages and fixes.

    They remain as they are where the sizes of LU and FU are unknown, and where the scene has no text with a unit
    (`has_texts`), unless one LU is 1 m and one FU 1 N; so do problems about units of the model.
    """
    draft = Draft(tables)
    length, force, mass = (draft[f"material.{key}"] for key in UNIT_KEYS.values())
    if not (length and force and (has_texts or length == force == 1.0)):
        return tables.problems
    words = Scales(length, force, mass=mass).in_words
    return [
        problem
        if MODEL_UNITS in problem.message
        else replace(problem, message=words(problem.message), hint=words(problem.hint))
        for problem in tables.problems
    ]


def apply_overrides(data: dict[str, Any], overrides: Iterable[str]) -> list[Problem]:
    """Set each of `overrides`, "table.key=value", in `data`, in place, and return the problems of invalid ones.

    They are set in order. A value is read as TOML, or as bare text where it is not TOML; absent tables are added. Empty
    where all are valid.
    """
    form = "write table.key=value, for example experiment.method=dynamic"
    problems = []
    for override in overrides:
        path, _, text = override.partition("=")
        where = f"set {shown(override)}"
        if text.strip():
            problems += set_values(data, {path: _toml_value(text.strip())}, where, form)
        else:
            problems.append(Problem(where, "no value", hint=form))
    return problems


def set_values(
    data: dict[str, Any],
    values: Mapping[str, Any],
    where: str = "",
    form: str = "write table.key, for example experiment.method",
) -> list[Problem]:
    """Set the value of each dotted key in `data`, in place, and return the problems of keys that cannot be set.

    Such keys are no path of names, or lead through a value that is no table, or to an item that a list does not have.
    None is set as well, and such a key counts as absent. Absent tables are added.

    Args:
        data: tables by name.
        values: by dotted key, items of lists by index: "viscoelasticity.terms[0].share".
        where: origin of the values in messages; "": the key.
        form: the suggested fix for a path that is not a path of keys.
    """
    problems = []
    for path, value in values.items():
        part: Any = data
        origin, keys = where or f"set {path}", keys_in("".join(str(path).split()))
        if len(keys) > DEEPEST or not all(BARE.fullmatch(str(key)) for key in keys):
            problems.append(Problem(origin, "not a path of keys", hint=form))
            continue
        *above, last = keys
        try:
            for key in above:
                part = part.setdefault(str(key), {}) if isinstance(part, dict) else part[key]
            part[str(last) if isinstance(part, dict) else last] = value
        except (LookupError, TypeError):
            problems.append(Problem(origin, f"there is no such key in {shown(part)}", hint="set it as a whole"))
    return problems


def remove_effects(data: dict[str, Any], names: Iterable[str]) -> list[Problem]:
    """Remove from `data`, in place, the table of each effect in `names`; a name given twice counts once.

    Return the problems of those that are not there or are no effects; empty without any.
    """
    problems = []
    for name in dict.fromkeys(names):
        present = [effect for effect in EFFECTS if effect in data]
        if name in present:
            del data[name]
        elif name in EFFECTS:
            hint = f"effects there: {', '.join(present) or 'none'}"
            problems.append(Problem(f"without {name}", "the scene has no such table", hint=hint))
        else:
            hint = suggestion(name, EFFECTS, "effects")
            problems.append(Problem(f"without {name}", "not an effect that can be removed", hint=hint))
    return problems


def _toml_value(text: str) -> Any:
    """Return the value that a text means in TOML; the text itself where it is no value, or more than one."""
    try:
        values = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return values["value"] if len(values) == 1 else text


def _listed(words: Iterable[str]) -> list[str]:
    """Return `words` as a new list; a single string is one word."""
    return [words] if isinstance(words, str) else list(words)


def plain_data(value: Any, levels: int = DEEPEST) -> Any:
    """Return a copy of `value` in dicts, lists and plain values, without keys that are None.

    Numpy's arrays become lists, tables dicts by the keys of a scene file, with their defaults. A reduction is left out
    if the file did not give it. None in a list remains.

    Args:
        value: a table, a mapping, a list, or a plain value, which is returned as it is.
        levels: most levels of tables and lists.

    Raises:
        SceneError: there are more levels.
    """
    if not levels:
        raise SceneError([Problem("scene", TOO_DEEP)])
    if isinstance(value, Table):
        chosen = {"reduction"} - value.model_fields_set  # chosen again, since changes of a scene may change it
        value = {name: getattr(value, key.field) for name, key in keys_of(type(value)).items() if name not in chosen}
    if isinstance(value, Mapping):
        return {str(key): plain_data(item, levels - 1) for key, item in value.items() if item is not None}
    if isinstance(value, list | tuple):
        return [plain_data(item, levels - 1) for item in value]
    if hasattr(value, "tolist"):  # numpy's arrays and numbers
        return plain_data(value.tolist(), levels)
    return value


def _rank(problem: Problem) -> int:
    """Return the position of a problem in a report, from 0: the tables in the order of a scene, then unknown ones."""
    order, table = list(Scene.model_fields), keys_in(problem.path)[0]
    return order.index(table) if table in order else len(order)


def _tables(text: str, path: str) -> dict[str, Any]:
    """Return TOML text as a new dict; `path` is its origin, for messages.

    Raises:
        SceneError: with one problem: the text is no TOML, or nested more than 100 deep.
    """
    try:
        if not LONG_KEY.search(text):
            return dict(plain_data(tomllib.loads(text)))
    except ValueError as error:
        raise SceneError([_syntax_problem(path, text, str(error))]) from error
    except RecursionError:
        pass
    raise SceneError([Problem(path, TOO_DEEP)])


def _syntax_problem(path: str, text: str, reason: str) -> Problem:
    """Return an error in the TOML itself as a problem, with the line, up to 80 characters of it, and the suggested fix.

    Without line and fix where `reason` names no line; without fix where none is known.

    Args:
        path: of the file.
        text: its content.
        reason: message of tomllib.
    """
    begin = next((begin for begin in MEANING if reason.startswith(begin)), "")
    message = MEANING.get(begin, reason)
    match = re.search(r"\(at line (\d+), column (\d+)\)$", reason)
    if match is None:
        return Problem(f"{path}, at its end" if "end of document" in reason else path, message)
    line = text.split("\n")[int(match[1]) - 1].strip()
    if line.count("{") > line.count("}"):
        message = MEANING["Unclosed inline table"]
    return Problem(f"{path}, line {match[1]}, column {match[2]}", f"{message}: {line[:80]}", hint=HINTS.get(begin, ""))
