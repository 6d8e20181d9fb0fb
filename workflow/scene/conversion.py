"""Numbers with units in a scene, "10 mm", as numbers in the scene's own units LU, FU, MU, TU = √(MU·LU/FU).

[material] gives the sizes of LU, FU and MU; where it does not, and no plain number of the scene needs one, they are
1 m, 1 N and 1 kg, so that the results' model units are those of SI. They are then written into [material], so that the
scene that is kept has them.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Mapping
from copy import copy
from fractions import Fraction

from contact1d.workflow.scene.draft import Draft
from contact1d.workflow.scene.quantities import Place, numbers_in
from contact1d.workflow.scene.si_text import UnitTextError, example, si_value
from contact1d.workflow.units import SI

BOLTZMANN = Fraction(1380649, 10**29)
"""k_B [J/K], exact since 2019."""
UNIT_KEYS = {"LU": "length_unit", "FU": "force_unit", "MU": "mass_unit"}
"""Keys of [material] that give the size of a unit of the model in SI."""


def convert(scene: Place) -> bool:
    """Replace the texts with units of a scene by numbers in LU, FU, MU and TU, or in units of SI where keys have these.

    That is done in place. Return whether the scene has such texts, right or wrong, at keys without an error reported
    before. Sizes of LU, FU and MU that texts need and [material] lacks are put into it as 1. Errors are
    reported; their keys, and those whose numbers are then unknown, are marked as wrong and keep their texts.
    """
    texts = [place for place in numbers_in(scene) if place.is_text and place.sound]
    read = {}
    for place in texts:
        try:
            value, dimension = si_value(place.value, *place.unit.texts)
        except UnitTextError as error:
            place.fault(str(error))
        else:
            read[place] = value * BOLTZMANN if dimension == "K" else value  # a temperature as k_B T [J]
    for place, value in read.items():
        if not place.unit.bases:  # these give the sizes of LU, FU and MU
            _put_number(place, value)
    in_model_units = [place for place in texts if place.unit.bases]
    scales = _scales(scene, in_model_units) if in_model_units else {}
    for place in in_model_units:
        if scales is None:
            place.doubt()
        elif place in read:
            _put_number(place, read[place] / size(place.unit.name, scales))
    return bool(texts)


def _put_number(place: Place, value: Fraction) -> None:
    """Replace a text by its number in the scene, nearest float, in place; the text stays known for messages.

    A number beyond the range of floats is reported, and the text remains.
    """
    text = copy(place)
    try:
        place.put(float(value))
    except OverflowError:
        place.fault("exceeds the range of floating-point numbers")
    place.source = place.source or text


def _scales(scene: Place, texts: list[Place]) -> dict[str, Fraction] | None:
    """Return the exact sizes of LU [m], FU [N] and MU [kg] by name, at least those that `texts` need; None if unknown.

    Unknown sizes are reported here, or where tables are checked if [material] or a size in it is wrong. An absent
    [material], and sizes that it lacks, as 1, are added to the scene. `texts`: texts with units, at least one.
    """
    material = scene.inside["material"]
    if material.absent:
        material.put({})
    if not isinstance(material.value, dict):
        return None  # reported where tables are checked
    first, draft = texts[0], Draft(scene)
    if "material.surface_energy" in draft:
        message = "LU and FU follow from the run (material.surface_energy), so that units are not known before it"
        first.fault(message, f"write a number in {first.unit.name}")
        return None
    return _chosen_scales(draft, texts)


def _chosen_scales(draft: Draft, texts: list[Place]) -> dict[str, Fraction] | None:
    """Return the exact sizes of LU [m], FU [N] and MU [kg] by name: LU and FU, and MU if `texts` need it.

    Those that the scene lacks are 1, and are put into it. With a number as bulk_stiffness beside elastic moduli, from
    which FU follows, it is those alone that `texts` need, with MU all three, and FU is not put in. None, and reported,
    where the scene has numbers without units in LU, FU or MU whose size it does not give, or where FU is needed
    although it follows. None also where a given size is no positive number.
    """
    given, elastic = draft.scene.find("bodies.bulk_stiffness"), draft.holds("elastic")
    stiffness = given if given and given.value != "auto" and elastic else None  # FU follows from it and the moduli
    needed = {base for place in texts for base in place.unit.bases}
    if not stiffness or "MU" in needed:
        needed |= {"LU", "FU"}
    units = {base: draft.scene.inside["material"].inside[UNIT_KEYS[base]] for base in sorted(needed)}
    chosen = [base for base, unit in units.items() if unit.absent]
    plain = _plain_numbers(draft, chosen)
    if stiffness and "FU" in chosen:
        chosen.remove("FU")
        if stiffness.sound:
            stiffness.report("follows from the material here", 'write "auto"')
    elif plain:
        _report_mixed(plain, texts[0], chosen, elastic)
    for base in chosen:  # in spite of a problem, so that the rules across tables don't report its consequences
        units[base].put(1.0)
    scales = {base: Fraction(repr(unit.value)) for base, unit in units.items() if is_positive(unit)}
    return scales if scales.keys() == needed and not plain else None


def _plain_numbers(draft: Draft, bases: Collection[str]) -> list[Place]:
    """Return the places of numbers other than 0 without a unit, also by default, in units made of `bases` (LU, FU, MU).

    A mass of particles that has no effect, as in a quasi-static scene, is not among them. In the order of the scene.
    """
    in_time = draft.experiment.only_method == "dynamic" or draft.facts["in_time"]
    without = "" if in_time and not draft.experiment.is_massless else "bodies.mass"
    numbers = (place for place in numbers_in(draft.scene) if place.is_number and place.path != without)
    return [place for place in numbers if place.unit.bases & {*bases}]


def _report_mixed(plain: list[Place], text: Place, chosen: Collection[str], elastic: bool) -> None:
    """Report plain numbers beside a number with a unit, where the sizes of LU, FU or MU are unknown, as one problem.

    Args:
        plain: the numbers without a unit, one at least; the problem is at the first, and names three at most.
        text: one with a unit, which the message names.
        chosen: of LU, FU and MU those that the scene does not give.
        elastic: whether the scene has elastic moduli.
    """
    first = plain[0]
    unknown = {base for place in plain for base in place.unit.bases} | (set() if elastic else {"LU", "FU"})
    bases = [base for base in UNIT_KEYS if base in unknown and base in chosen]
    meaning = f"what {' and '.join(bases)} stand{'s' * (len(bases) == 1)} for"
    listed = 3  # keys that a message names before it counts the rest
    further = ", ".join(place.path for place in plain[1:listed])
    more = f" and {len(plain) - listed} more" if len(plain) > listed else ""
    unit = f'give it a unit as well, such as "{example(first.unit.texts[0])}"'
    if first.source and first.source.key == "file":
        unit = 'name its columns with their units, r [µm], z [µm], or write scale = "1 µm", or units = ["µm", "nm"]'
    first.report(
        f"is {'by default ' if first.absent else ''}in {first.unit.name}, while {text.path} = {text.given} has a unit, "
        f"and nothing says {meaning}",
        f"{unit}{f'; so too {further}{more}' if further else ''}; "
        f"or give {' and '.join(f'material.{UNIT_KEYS[base]}' for base in bases)}",
    )


def is_positive(place: Place) -> bool:
    """Return whether a key has a finite number (int or float, no boolean) greater than 0."""
    return place.is_number and 0.0 < place.value <= sys.float_info.max


def size(unit: str, scales: Mapping[str, Fraction]) -> Fraction:
    """Return the size of a model `unit`, such as "FU/LU", in its unit of SI, exactly where it is a fraction.

    `scales`: sizes of LU [m], FU [N] and MU [kg]. An irrational size, as that of a time, is the nearest float.

    Raises:
        KeyError: `unit` is none of the model, or a size that it needs is not in `scales`.
    """
    square = math.prod((scales[base] ** int(2 * power) for base, power in SI[unit].powers.items()), start=Fraction(1))
    root = Fraction(math.isqrt(square.numerator), math.isqrt(square.denominator))
    return root if root**2 == square else Fraction(math.sqrt(square))
