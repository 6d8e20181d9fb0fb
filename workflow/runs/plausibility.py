"""Values of a scene and its results outside the usual range of real contacts: most often a missing unit.

They are warnings, and nothing is refused: the model has no atoms, and gives its numbers for any size.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from contact1d.digits import apart
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.conversion import BOLTZMANN
from contact1d.workflow.scene.quantities import places
from contact1d.workflow.units import LENGTH, Quantity, Scales

SOFTEST, STIFFEST = 1e3, 2e12
"""Moduli [Pa]: of the softest gels that are pressed, and above those of diamond, 1.2e12."""
IMPLAUSIBLE = "implausible"
"""Prefix of the names of warnings about a scene's numbers, from which all results follow."""


@dataclass(frozen=True)
class Usual:
    """The usual range of a number in SI.

    Attributes:
        key: pattern of its key in a scene.
        name: its name in that of the warning.
        least, most: ends of the range, in `unit`.
        unit: in SI.
        low, high: the remark on a number below and above the range.
    """

    key: str
    name: str
    least: float
    most: float
    unit: str
    low: str
    high: str


USUAL = (
    Usual(r"bodies\.profile\.radius", "size", 3e-10, 10.0, "m", "less than the width of two atoms",
    "and no ball of such a radius is smooth"),
    Usual(r"bodies\.spacing", "size", 1e-12, 1.0, "m", "a hundredth of an atom",
          "but a particle represents a small part of a body"),
    Usual(r"interaction\.\w+\.range", "size", 1e-11, 1e-3, "m", "a tenth of an atom's radius",
          "but surface forces have ranges below a micrometre"),
    Usual(r"material\.surface_energy|adhesion\.surface_energy", "surface_energy", 1e-6, 10.0, "J/m²",
          "below that of any adhesive solid", "where 0.02 to 3 are usual"),
    Usual(r"adhesion\.work_of_adhesion", "surface_energy", 2e-6, 20.0, "J/m²",
          "below that of any adhesive solid", "where 0.04 to 6 are usual"),
    Usual(r"noise\.temperature", "temperature", 0.01, 1e4, "K", "below that of any such experiment",
    "above any melting point"),
)  # fmt: skip
"""Numbers of a scene that have a usual size, by their keys."""


def implausible(scene: Scene, scales: Scales, quantities: Mapping[str, Quantity]) -> dict[str, str]:
    """Return the warnings of implausible numbers of a scene and its results: name and message.

    Empty where there are none. Several messages of one name are joined by "; ".

    Args:
        scene: one without a [material] has no numbers that are checked.
        scales: of LU and FU in SI; where they are unknown, numbers with these units, and results, are not checked.
        quantities: the results by name, in units of the model, of which radii below 0.1 nm are reported.
    """
    warnings: dict[str, list[str]] = {}
    for name, message in (*_moduli(scene), *_numbers(scene, scales), *_radii(scales, quantities)):
        warnings.setdefault(name, []).append(message)
    return {name: "; ".join(messages) for name, messages in warnings.items()}


def _moduli(scene: Scene) -> Iterator[tuple[str, str]]:
    """Yield (name, message) of each modulus and Poisson's ratio of a material that few have; none without a material.

    These are moduli below 1 kPa, above 2 TPa only if all moduli of the material are, in one message, and Poisson's
    ratios below 0.
    """
    material = scene.material
    if material is None:
        return
    bodies = {f"material.{name}": body for name, body in material.elastic.items()}
    moduli = {f"{name}.youngs_modulus": body.youngs_modulus for name, body in bodies.items()}
    if material.contact_modulus is not None:
        moduli["material.contact_modulus"] = material.contact_modulus
    for key, modulus in moduli.items():
        if modulus < SOFTEST:
            meant = f": was {modulus:g} GPa meant?" if modulus >= 0.01 else ": check its unit"
            yield f"{IMPLAUSIBLE}_modulus", f"{key} is {modulus:g} Pa, softer than any gel{meant}"
    if moduli and min(moduli.values()) > STIFFEST:  # one of two bodies may be rigid
        least = f"{min(moduli.values()):g} Pa"
        yield f"{IMPLAUSIBLE}_modulus", f"{' and '.join(moduli)}: {least} is stiffer than diamond: check its unit"
    for name, body in bodies.items():
        if body.poisson_ratio < 0.0:
            ratio = f"{name}.poisson_ratio is {body.poisson_ratio:g}"
            yield f"{IMPLAUSIBLE}_poisson_ratio", f"{ratio}, and few materials have one below 0: check its sign"


def _numbers(scene: Scene, scales: Scales) -> Iterator[tuple[str, str]]:
    """Yield (name, message) of each number of a scene outside its usual range, ends included; none without a material.

    Only sizes, surface energies and temperatures have a usual range. A number whose unit has no known size in SI is
    left out, as is a 0.
    """
    if scene.material is None:
        return  # all numbers are the model's
    for place in places(Scene, scene.model_dump(by_alias=True, exclude_none=True)):
        key = ".".join(map(str, place.keys))
        usual = next((usual for usual in USUAL if re.fullmatch(usual.key, key)), None)
        if usual is None or not place.is_number or (place.unit.bases and not scales.known):
            continue
        value = place.value * (scales.factor(place.unit.name) if place.unit.bases else 1.0)
        value /= float(BOLTZMANN) if usual.unit == "K" else 1.0
        if not usual.least <= value <= usual.most:
            remark = usual.low if value < usual.least else usual.high
            yield f"{IMPLAUSIBLE}_{usual.name}", f"{key} is {value:.4g} {usual.unit}, {remark}: check its unit"


def _radii(scales: Scales, quantities: Mapping[str, Quantity], atom: float = 1e-10) -> Iterator[tuple[str, str]]:
    """Yield (name, message) of each result whose name ends in "radius" above 0 and below `atom` [m].

    There continuum theory fails. None where the scales are unknown.
    """
    if not scales.known:
        return
    for name, quantity in quantities.items():
        size = quantity.value * scales.length
        if name.endswith("radius") and quantity.unit == LENGTH and 0.0 < size < atom:
            radius, limit = apart(size, atom)
            yield "below_an_atom", f"the {name.replace('_', ' ')} is {radius} m, less than that of an atom, {limit} m"
