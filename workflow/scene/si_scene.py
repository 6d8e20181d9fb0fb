"""Numbers with units in a scene, "10 mm", as numbers in the scene's own units LU, FU, MU, TU = √(MU·LU/FU).

What a field may be is read off its type, whose `Unit` is the one place that says it. What LU, FU and MU are stands in
[material]; where it gives none and no plain number of the scene needs it, it is 1 m, 1 N or 1 kg, so that the results'
model units are those of SI. It is then written into [material], and the scene that is kept says what it means.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from contact1d.workflow.scene.places import Keys, Place, places, powers
from contact1d.workflow.scene.problems import Problem, path_of, shown
from contact1d.workflow.scene.quantities import Table
from contact1d.workflow.scene.si_text import UnitTextError, example, si_value
from contact1d.workflow.scene.tables import Scene

BOLTZMANN = Fraction(1380649, 10**29)
"""k_B [J/K], exact since 2019."""
UNIT_KEYS = {"LU": "length_unit", "FU": "force_unit", "MU": "mass_unit"}
"""Keys of [material] that say what a unit of the model is in SI."""
ELASTIC = frozenset({"upper", "lower", "contact_modulus"})
"""Keys of [material] that say how stiff the bodies are."""
LISTED = 3
"""Places that a message names before it counts the rest."""


@dataclass
class Converted:
    """What came of a scene's texts: `problems`, the keys where these are, and the texts that were read, by path."""

    problems: list[Problem] = field(default_factory=list)
    told: set[Keys] = field(default_factory=set)
    texts: dict[str, str] = field(default_factory=dict)


def convert_texts(data: dict[str, Any], root: type[Table] = Scene) -> Converted:
    """Put numbers in the place of all texts with units in `data`, a plain dict of tables of `root`."""
    result = Converted()
    texts = [place for place in places(root, data) if place.is_text]
    if not texts:
        return result
    si = {}
    for place in texts:
        try:
            si[place.keys] = _si(place)
        except UnitTextError as error:
            result.problems.append(Problem(path_of(place.keys), str(error), shown(place.value)))
            result.told.add(place.keys)
    for place in texts:  # those of [material] first, since they say what LU and FU are
        if place.keys in si and not place.bases:
            _put(data, place, si[place.keys], result)
    needed = frozenset().union(*(place.bases for place in texts))
    scales = _scales(data, root, needed, texts, result) if needed else {}
    for place in texts:
        if place.keys not in si or not place.bases:
            continue
        if scales is None:
            result.told.add(place.keys)
            continue
        _put(data, place, si[place.keys] / _model_unit(place.unit.name, scales), result)
    return result


def _si(place: Place) -> Fraction:
    """The quantity that the text says, in SI, a temperature as k_B T."""
    value, dimension = si_value(place.value, *place.unit.texts)
    return value * BOLTZMANN if dimension == "K" and place.unit.name != "K" else value


def _put(data: dict[str, Any], place: Place, value: Fraction, result: Converted) -> None:
    """Put the number in the text's place."""
    try:
        number = float(value)
    except OverflowError:
        problem = Problem(path_of(place.keys), "is larger than any number that a computer holds", shown(place.value))
        result.problems.append(problem)
        result.told.add(place.keys)
        return
    table: Any = data
    for key in place.keys[:-1]:
        table = table[key]
    table[place.keys[-1]] = number
    result.texts[path_of(place.keys)] = place.value


def _scales(
    data: dict[str, Any], root: type[Table], needed: frozenset[str], texts: list[Place], result: Converted
) -> dict[str, Fraction] | None:
    """What LU, FU and MU are in SI, those of `needed`; chosen and written into `data` where they are open.

    None, and a problem in `result`, where they cannot be known.
    """
    material = data.get("material", {})
    if not isinstance(material, dict):
        return None  # told where tables are checked
    if "surface_energy" in material:
        problem = Problem(
            path_of(texts[0].keys),
            "LU and FU follow from the run (material.surface_energy), so that units have no size before it",
            shown(texts[0].value),
            f"write a number in {texts[0].unit.name}",
        )
        result.problems.append(problem)
        return None
    bodies = data.get("bodies")
    if isinstance(bodies, dict) and bodies.get("bulk_stiffness") == "auto":
        needed |= {"LU", "FU"}
    given = {base: _positive(material.get(key)) for base, key in UNIT_KEYS.items() if key in material}
    if None in given.values():
        return None
    chosen = needed - given.keys()
    stiffness = bodies.get("bulk_stiffness") if isinstance(bodies, dict) else None
    if "FU" in chosen and stiffness not in (None, "auto") and ELASTIC & material.keys():
        message = "not a stiffness of its own where the material gives it and numbers have units"
        problem = Problem(
            "bodies.bulk_stiffness", message, shown(stiffness), 'write "auto": it follows from the material'
        )
        result.problems.append(problem)
        return None
    if plain := [place for place in places(root, data) if place.bases & chosen and place.is_number]:
        result.problems.append(_mixed(plain, texts, chosen))
        return None
    for base in sorted(chosen):
        material[UNIT_KEYS[base]] = 1.0
    data["material"] = material
    return {base: value for base, value in given.items() if value} | dict.fromkeys(chosen, Fraction(1))


def _mixed(plain: list[Place], texts: list[Place], chosen: frozenset[str]) -> Problem:
    """Plain numbers beside a number with a unit, and nothing says what the units of the model are."""
    first, text = plain[0], next(place for place in texts if place.bases & chosen)
    bases = [base for base in UNIT_KEYS if base in chosen and any(base in place.bases for place in plain)]
    keys = " and ".join(f"material.{UNIT_KEYS[base]}" for base in bases)
    what = f"what {' and '.join(bases)} stand{'s' * (len(bases) == 1)} for"
    others = ", ".join(path_of(place.keys) for place in plain[1:LISTED])
    others = (
        f"; so too {others}" + (f" and {len(plain) - LISTED} more" if len(plain) > LISTED else "") if others else ""
    )
    return Problem(
        path_of(first.keys),
        f"is {'by default ' if first.absent else ''}in {first.unit.name}, while {path_of(text.keys)} = "
        f"{shown(text.value)} has a unit, and nothing says {what}",
        shown(first.value),
        f'give it a unit as well, such as "{example(first.unit.texts[0])}"{others}; or give {keys}',
    )


def _positive(value: Any) -> Fraction | None:
    """A number of [material] as the exact decimal that stands there; None for what is none, which is told elsewhere."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value < math.inf:
        return None
    return Fraction(repr(value))


def _model_unit(name: str, scales: Mapping[str, Fraction]) -> Fraction:
    """One unit of the model, "FU·TU/LU", in SI."""
    size = Fraction(1)
    for base, power in powers(name).items():
        if base == "TU":
            square = scales["MU"] * scales["LU"] / scales["FU"]
            size *= square ** (power // 2) * (Fraction(math.sqrt(square)) if power % 2 else 1)
        elif base in scales:
            size *= scales[base] ** power
    return size
