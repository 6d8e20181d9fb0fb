"""Each table of a scene by itself: every error, reported once in the terms of the scene file.

A misspelt word that can only mean one thing is reported and then read as what was meant, so that the rest of its table
and the rules across tables are checked as well.

Numbers with units in a scene, "10 mm", as numbers in the scene's own units LU, FU, MU, TU = √(MU·LU/FU).

What a field may be is read off its type, whose `Unit` is the one place that says it. What LU, FU and MU are stands in
[material]; where it gives none and no plain number of the scene needs it, it is 1 m, 1 N or 1 kg, so that the results'
model units are those of SI. It is then written into [material], and the scene that is kept says what it means.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from contact1d.workflow.scene.experiments import Kind
from contact1d.workflow.scene.problems import MOST_PROBLEMS, Problem, as_toml, nearest, path_of, plain, shown
from contact1d.workflow.scene.quantities import (
    Keys,
    Length,
    OutOfRange,
    Place,
    Stiffness,
    Table,
    allowed_by,
    keys_of,
    places,
    tables_in,
    walk,
)
from contact1d.workflow.scene.schema import statement, text_of
from contact1d.workflow.scene.si_text import UnitTextError, example, si_value
from contact1d.workflow.scene.tables import WHOLE, Tables
from contact1d.workflow.units import SI

MISSING = "missing"
"""Pydantic's name of this fault."""
OF_KINDS = "a table with kind = "
"""How `statement` begins of a table that has several; its `kind` must be what follows."""
AnyTables = TypeVar("AnyTables", bound=Tables)
BOLTZMANN = Fraction(1380649, 10**29)
"""k_B [J/K], exact since 2019."""
UNIT_KEYS = {"LU": "length_unit", "FU": "force_unit", "MU": "mass_unit"}
"""Keys of [material] that say what a unit of the model is in SI."""
ELASTIC = frozenset({"upper", "lower", "contact_modulus"})
"""Keys of [material] that say how stiff the bodies are."""
LISTED = 3
"""Places that a message names before it counts the rest."""
LENGTH = allowed_by(Length)
PROFILE = ("bodies", "profile")
FILE = (*PROFILE, "file")
LISTS = ((*PROFILE, "r"), (*PROFILE, "z"))


def mend_words(data: dict[str, Any], model: type[Tables]) -> list[Problem]:
    """Report and correct, in `data` (a plain dict for this `model`), every word that is misspelt or unknown."""
    wrong = _validated(data, model)[1]
    return [problem for place in walk(WHOLE, data) for problem in _mended(data, place)] if wrong else []


def check_tables(
    data: dict[str, Any], model: type[AnyTables], reported: Collection[Keys] = ()
) -> tuple[AnyTables | None, list[Problem], frozenset[Keys]]:
    """Check every table of `data`, a plain dict whose words were corrected, for a `model` of a scene.

    Keys that were `reported` are not reported again. Returns the scene if all tables are right, what is wrong, and the
    keys at which a value is, which the rules cannot rely on.
    """
    scene, errors = _validated(data, model)
    faults = {_keys(details, data): details for details in errors}
    found = {place.keys: place for place in walk(WHOLE, data) if place.keys in faults}
    problems = (_problem(found[keys], details) for keys, details in faults.items() if keys not in reported)
    return scene, [problem for problem in problems if problem], frozenset(faults)


def _validated(data: dict[str, Any], model: type[AnyTables]) -> tuple[AnyTables | None, list[ErrorDetails]]:
    try:
        return model.model_validate(data), []
    except ValidationError as error:
        return None, error.errors(include_url=False)


def _keys(details: ErrorDetails, value: Any) -> Keys:
    """The keys of an error of pydantic's, whose location names the kinds of tables as well."""
    keys: list[Any] = []
    for step in details["loc"]:
        with suppress(LookupError, TypeError):
            value = value[step]
            keys.append(step)
    return (*keys, *details["loc"][-1:]) if details["type"] == MISSING else tuple(keys)


def _mended(data: dict[str, Any], place: Place) -> Iterator[Problem]:
    """Report and correct, in `data`, the words of a place: of a table its kind and its keys."""
    value, kinds = place.value, place.allowed.kinds
    yield from _mended_word(data, place, place.allowed.words)
    if isinstance(value, str) and place.allowed.table and (known := place.allowed.table.by_name):
        meant = nearest(value, known)
        place.put(data, dict(known.get(plain(value)) or known[meant or next(iter(known))]))
        if plain(value) not in known:
            hint = (f'did you mean "{meant}"? ' if meant else "") + f"names: {', '.join(known)}"
            yield Problem(path_of(place.keys), f"must be {statement(place.allowed)}", shown(value), hint)
    if not isinstance(value, dict):
        return
    if kinds and "kind" not in value and (similar := next((key for key in value if nearest(key, ["kind"])), None)):
        value["kind"] = value.pop(similar)
        yield Problem(path_of((*place.keys, similar)), "unknown key", hint='did you mean "kind"?')
    if kinds:
        yield from _mended_word(data, Place((*place.keys, "kind"), value.get("kind"), place.allowed), tuple(kinds))
    table = place.allowed.table_for(value)
    unknown = [key for key in value if table and key not in keys_of(table)]
    for key in unknown[:MOST_PROBLEMS]:
        yield _mended_key(place, table or Table, key)
    for key in unknown[MOST_PROBLEMS:]:
        del value[key]
        yield Problem(path_of((*place.keys, key)), "unknown key")


def _mended_word(data: dict[str, Any], place: Place, words: tuple[str, ...]) -> Iterator[Problem]:
    wrong = isinstance(place.value, str) and place.value not in words
    if wrong and (meant := nearest(place.value, words)):
        place.put(data, meant)
        must = f"must be {statement(place.allowed).removeprefix(OF_KINDS)}"
        hint = f'did you mean "{meant}"?' if len(words) > 1 else ""
        yield Problem(path_of(place.keys), must, shown(place.value), hint)


def _mended_key(place: Place, table: type[Table], key: str) -> Problem:
    """Report a key that the `table` does not know, and take it away or put it where it was meant to be."""
    known, value = list(keys_of(table)), place.value.pop(key)
    meant = nearest(key, known)
    homes = [] if meant else _homes(key)
    method = table.only_method if key == "method" and issubclass(table, Kind) else None
    if meant is not None:
        place.value.setdefault(meant, value)
        hint = f'did you mean "{meant}"? '
    elif method is not None:
        hint = f"a {place.value['kind']} is always {method}: remove it; "
    else:
        hint = f"it belongs in {' or '.join(homes)}; " if homes else ""
    what = "unknown table" if isinstance(value, dict) else "unknown key"
    return Problem(path_of((*place.keys, key)), what, hint=f"{hint}allowed here: {', '.join(known) or 'no keys'}")


def _homes(key: str) -> list[str]:
    """The tables of a scene that know the key `key`, as they are written in a file."""
    found = []
    for path, choice in tables_in(Tables):
        if choice.table and key in keys_of(choice.table):
            kind = f' of kind = "{choice.kind}"' if choice.kind else ""
            found.append(f"[{path}]{kind}" if path else "the lines above the first table")
    return found


def _problem(place: Place, details: ErrorDetails) -> Problem | None:
    """What an error of pydantic's at a place means for the person who wrote the scene."""
    path, kind, given, allowed = path_of(place.keys), details["type"], place.value, statement(place.allowed)
    must, of_kind = f"must be {allowed}", f"must be {allowed.removeprefix(OF_KINDS)}"
    if kind == MISSING:
        top = len(place.keys) == 1 and any(choice.table for choice in place.allowed.choices)
        return Problem(path, "missing", hint="required table" if top else must)
    if kind == "union_tag_not_found":
        return Problem(f"{path}.kind", "missing", hint=of_kind)
    if kind == "union_tag_invalid":
        return Problem(f"{path}.kind", of_kind, shown(given["kind"]))
    if kind == "scene":
        return Problem(path, details["msg"], shown(given))
    if kind == "too_short":
        least = details["ctx"]["min_length"]
        message = f"must have at least {'one item' if least == 1 else f'{least} items'}"
        # a list counts as too short for its wrong items only, too, which are reported themselves
        return Problem(path, message, shown(given)) if len(given) < least else None
    hint = _hint(place)
    if kind.startswith(("greater_than", "less_than")):
        must = must.replace("be a number ", "be ", 1).replace("be of ", "be ", 1)
        marks = (mark for choice in place.allowed.choices for mark in choice.marks)
        hint = next((mark.hint for mark in marks if isinstance(mark, OutOfRange)), "")
    if kind == "finite_number":
        must = must.replace("a number", "a finite number", 1)
    return Problem(path, must, shown(given), hint)


def _hint(place: Place) -> str:
    """What to do about a value of the wrong type, where that can be known."""
    given, allowed, text = place.value, statement(place.allowed), text_of(place.allowed)
    if isinstance(given, str) and allowed.startswith(("a number", "a whole number")):
        if any(map(str.isdigit, given)):
            return "write a number without quotes" + (f", or with its unit: {as_toml(text)}" if text else " and unit")
        if text and not place.allowed.words:
            return f"a number with its unit begins with a digit: {as_toml(text)}"
    if isinstance(given, float) and given.is_integer() and "whole number" in allowed:
        return f"write {int(given)}"
    if len(place.keys) == 1 and "a table" in allowed:
        brackets = " in single brackets" if isinstance(given, list) else ""
        return f"write it as [{place.keys[0]}]{brackets}, its keys below"
    return ""


@dataclass(frozen=True)
class PointsFile:
    """The file that a profile's lists are from: its name, and the unit of each list, "1 µm", or None where it is LU.

    It has no lists where it could not be read: the numbers in their place say nothing.
    """

    name: str
    units: Mapping[str, str | None]

    @property
    def place(self) -> Place:
        """Where a scene names it."""
        return Place(FILE, self.name, LENGTH)


@dataclass
class Conversion:
    """The texts with units of one scene, as its numbers.

    Attributes:
        data: the scene, a plain dict, in which numbers take the place of texts.
        source: the file that the lists of the profile were read from, if one was.
        problems: what is wrong with the texts.
        reported: the keys where these problems are, or where a number is unknown because of another one.
        texts: the texts that were read, by path.
    """

    data: dict[str, Any]
    source: PointsFile | None
    problems: list[Problem] = field(default_factory=list)
    reported: set[Keys] = field(default_factory=set)
    texts: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Convert them: those in SI first, since they say what LU, FU and MU are."""
        found = [place for place in places(Tables, self.data) if place.is_text]
        units = self.source.units if self.source else {}
        found += [Place((*PROFILE, key), unit, LENGTH) for key, unit in units.items() if unit]
        read = [(place, value) for place in found if (value := self._si(place)) is not None]
        for place, value in read:
            if not place.unit.bases:
                self._put(place, value)
        in_model_units = [place for place in found if place.unit.bases]
        scales = self._scales(in_model_units) if in_model_units else {}
        for place, value in read:
            if place.unit.bases and scales is None:
                self.reported.add(place.keys)
            elif place.unit.bases and scales is not None:
                self._put(place, value / _size(place.unit.name, scales))

    def _si(self, place: Place) -> Fraction | None:
        """The quantity that the text says, in SI, a temperature as k_B T; None, and reported, where it is none."""
        try:
            value, dimension = si_value(place.value, *place.unit.texts)
        except UnitTextError as error:
            self._report(place, str(error))
            return None
        return value * BOLTZMANN if dimension == "K" and place.unit.name != "K" else value

    def _report(self, place: Place, message: str, hint: str = "") -> None:
        self.problems.append(Problem(path_of(place.keys), message, shown(place.value), hint))
        self.reported.add(place.keys)

    def _put(self, place: Place, value: Fraction) -> None:
        """Put the number in the text's place, or the numbers of a file's list in theirs."""
        try:
            number = float(value)
        except OverflowError:
            self._report(place, "exceeds the range of floating-point numbers")
            return
        if place.keys in LISTS:
            place.put(self.data, [number * item for item in self.data["bodies"]["profile"][place.keys[-1]]])
        else:
            place.put(self.data, number)
            self.texts[path_of(place.keys)] = place.value

    def _scales(self, texts: list[Place]) -> dict[str, Fraction] | None:
        """What LU, FU and MU are in SI, those that `texts` need; chosen and put into the scene where they are open.

        None, and reported, where they cannot be known.
        """
        material, bodies = self.data.get("material", {}), self.data.get("bodies", {})
        if not isinstance(material, dict) or not isinstance(bodies, dict):
            return None  # reported where tables are checked
        first, stiffness = texts[0], bodies.get("bulk_stiffness", "auto")
        if "surface_energy" in material:
            message = "LU and FU follow from the run (material.surface_energy), so that units are not known before it"
            self._report(first, message, f"write a number in {first.unit.name}")
            return None
        needed = frozenset[str]().union(*(place.unit.bases for place in texts))
        elastic = bool(ELASTIC & material.keys())
        if stiffness == "auto" or not elastic or "MU" in needed:
            needed |= {"LU", "FU"}
        given = {base: _positive(material[key]) for base, key in UNIT_KEYS.items() if key in material}
        known = {base: value for base, value in given.items() if value is not None}
        chosen = needed - given.keys()
        own = ("bodies", "bulk_stiffness")
        fixed = "FU" in chosen and elastic and stiffness != "auto"
        plain = [place for place in self._plain() if place.unit.bases & chosen]
        if fixed and own not in self.reported:
            self._report(Place(own, stiffness, allowed_by(Stiffness)), "follows from the material here", 'write "auto"')
        elif plain and not fixed:
            self.problems.append(self._mixed(plain, first, chosen))
        # also where a problem was reported, so that the rules across tables don't report its consequences
        self.data["material"] = material | {
            UNIT_KEYS[base]: 1.0 for base in sorted(chosen) if not (fixed and base == "FU")
        }
        return None if plain or fixed or len(known) < len(given) else known | dict.fromkeys(chosen, Fraction(1))

    def _plain(self) -> list[Place]:
        """The places of numbers without a unit; those from a file are one."""
        found: dict[Keys, Place] = {}
        for place in places(Tables, self.data):
            source = self.source if place.keys[:-1] in LISTS else None
            if place.is_number and (source is None or None in source.units.values()):
                plain = source.place if source else place
                found.setdefault(plain.keys, plain)
        return list(found.values())

    def _mixed(self, plain: list[Place], text: Place, chosen: frozenset[str]) -> Problem:
        """Plain numbers beside numbers with a unit, and nothing says what the units of the model are."""
        first = plain[0]
        if self.source and text.keys in LISTS:
            text = self.source.place
        open_ = {base for place in plain for base in place.unit.bases} & chosen
        if not ELASTIC & self.data.get("material", {}).keys():
            open_ |= {"LU", "FU"} & chosen
        bases = [base for base in UNIT_KEYS if base in open_]
        what = f"what {' and '.join(bases)} stand{'s' * (len(bases) == 1)} for"
        others = ", ".join(path_of(place.keys) for place in plain[1:LISTED])
        more = f" and {len(plain) - LISTED} more" if len(plain) > LISTED else ""
        unit = f'give it a unit as well, such as "{example(first.unit.texts[0])}"'
        if first.keys == FILE:
            unit = 'name its columns with their units, r [µm], z [µm], or write scale = "1 µm"'
        return Problem(
            path_of(first.keys),
            f"is {'by default ' if first.absent else ''}in {first.unit.name}, while {path_of(text.keys)} = "
            f"{shown(text.value)} has a unit, and nothing says {what}",
            shown(first.value),
            f"{unit}{f'; so too {others}{more}' if others else ''}; "
            f"or give {' and '.join(f'material.{UNIT_KEYS[base]}' for base in bases)}",
        )


def _positive(value: Any) -> Fraction | None:
    """A number of [material] as the exact decimal given; None for what is none, which is reported elsewhere."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < math.inf:
        return None
    return Fraction(repr(value))


def _size(name: str, scales: Mapping[str, Fraction]) -> Fraction:
    """One unit of the model in SI; exact but for the root in a unit of time."""
    powers = SI[name].powers
    if all(power.is_integer() for power in powers.values()):
        return math.prod((scales[base] ** int(power) for base, power in powers.items()), start=Fraction(1))
    return Fraction(math.sqrt(math.prod(scales[base] ** int(2 * power) for base, power in powers.items())))
