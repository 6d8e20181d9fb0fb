"""A number with a unit as text, "10 mm": exact in SI, its dimension in words, and a sentence where it is none.

Numbers and factors are fractions, so that "10 mm" is the float nearest to 0.01 and no other. Units with symbols of SI
alone are read here, as pint reads them, and all others by pint, whose registry takes longer to load than a run.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from contact1d.workflow.units import FIRST, SI
from contact1d.workflow.units import PREFIXES as BY_THOUSANDS

DIMENSIONS = {
    "m": "a length",
    "N": "a force",
    "Pa": "a pressure",
    "kg": "a mass",
    "s": "a time",
    "K": "a temperature",
    "J": "an energy",
    "N/m": "a force per length or energy per area",
    "J/m²": "an energy per area",
    "m/s": "a velocity",
    "N·s/m": "a drag coefficient",
    "N/s": "a force per time",
    "m²": "an area",
    "m³": "a volume",
    "m/s²": "an acceleration",
    "kg/m³": "a density",
    "W": "a power",
    "Hz": "a frequency",
    "Pa·s": "a viscosity",
    "V": "a voltage",
    "A": "a current",
    "mol": "an amount of substance",
    "C": "an electric charge",
    "1": "a number without a unit",
    "rad": "an angle",
}
"""Each dimension in words, by its unit in SI."""
EXAMPLES = {
    "m": "10 mm",
    "N": "10 N",
    "Pa": "210 GPa",
    "kg": "1 ng",
    "s": "1 µs",
    "K": "300 K",
    "J": "1 aJ",
    "N/m": "100 N/m",
    "J/m²": "50 mJ/m²",
    "m/s": "1 µm/s",
    "N·s/m": "1 mN·s/m",
    "N/s": "1 mN/s",
    "1": "0.3",
    "rad": "80°",
}
"""A text of those that a scene has."""
COMMON = (
    "m", "mm", "µm", "nm", "pm", "cm", "Å", "N", "kN", "mN", "µN", "nN", "Pa", "kPa", "MPa", "GPa", "J", "J/m²",
    "mJ/m²", "N/m", "mN/m", "kg", "g", "mg", "K", "s", "ms", "µs", "ns", "m/s", "mm/s", "µm/s", "nm/s",
)  # fmt: skip
"""Units among which a misspelt one is looked for."""
OFFSET = frozenset({"degree_Celsius", "degree_Fahrenheit"})
"""Units of temperature whose zero is not the absolute one, by pint's name."""
ANGLES = frozenset({"radian", "degree", "turn", "gradian", "arcminute", "arcsecond", "steradian"})
NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+(?![.\d]))?")
NAME = re.compile(r"[^\W\d_]+|°[CF]?|%|deg[CF]|delta_deg[CF]")
DERIVED = {
    "N": "kg·m/s²", "Pa": "N/m²", "J": "N·m", "W": "J/s", "Hz": "W/J", "V": "W/A", "C": "A·s",
}  # fmt: skip
"""Symbols of SI that are made of base units."""
PREFIXES = {"c": -2, "u": -6, "μ": -6} | {one.strip(): 3 * power for power, one in enumerate(BY_THOUSANDS, FIRST)}
"""Powers of ten."""
POWER = re.compile(r"(\*\*|\^)?[-+⁻]?[\d⁰¹²³⁴⁵⁶⁷⁸⁹]+")
LONGEST = 60
"""Characters of a text that may be a number with a unit."""
MODEL_UNITS = "is in units of the model"
NO_UNIT = {
    r"$": "has no unit",
    r",": "has a comma in its number: write a decimal point, and no thousands separators",
    r"[eE](?![^\W\d_])": "has an exponent that is not an integer",
    r"[.'_\d]": "has text after the number {number} that is not a unit",
    r"(LU|FU|MU|TU)\b": f"{MODEL_UNITS}: write {{number}} without quotes and unit",
}
"""How what follows a number begins where it is no unit, and what it is."""
LARGEST = 1e300
"""Its products with units and with other numbers of a scene are finite mostly."""


class UnitTextError(ValueError):
    """A text that is no quantity of the wanted dimension; the message continues "must be …" or stands for itself."""


@dataclass(frozen=True)
class Unit:
    """A unit as read: its text, size in base units of SI, dimension, where its zero is, and whether it is of angles."""

    text: str
    factor: Fraction
    dimension: Mapping[str, Any]
    zero: Fraction = Fraction(0)
    angular: bool = False

    def measures(self, unit: str) -> bool:
        """Whether it is of the dimension of this unit of SI; an angle is no number."""
        return self.dimension == _dimension(unit) and self.angular == (unit == "rad")


BASES = {
    symbol: Unit(symbol, Fraction(1, 1000 if symbol == "g" else 1), {dimension: 1})
    for symbol, dimension in {
        "m": "[length]", "g": "[mass]", "s": "[time]", "K": "[temperature]", "A": "[current]", "mol": "[substance]",
    }.items()
}  # fmt: skip
"""Symbols of SI; dimensions by pint's names."""
FACTOR = re.compile(rf"({'|'.join(PREFIXES)})({'|'.join(BASES | DERIVED)})([²³]?)")


def in_words(unit: str) -> str:
    """What a quantity in `unit` (of SI or of the model) is, with an example: "a force, such as 10 N"."""
    return f"{DIMENSIONS[in_si(unit)]}, such as {example(unit)}"


def example(unit: str) -> str:
    """A text that a quantity in `unit` may be: "10 mm"."""
    return EXAMPLES[in_si(unit)]


def in_si(unit: str) -> str:
    """The unit in SI of the same dimension: N·s/m for FU·TU/LU."""
    return SI[unit].si if unit in SI else unit


def split(text: str) -> tuple[str, str]:
    """The number and the unit of "10 mm", each as text. Raises UnitTextError where there is no number or no unit."""
    plain = text.strip().replace("−", "-")
    found = NUMBER.match(plain)
    if found is None or len(plain) > LONGEST:
        raise UnitTextError("does not begin with a number")
    number, unit = found[0], plain[found.end() :].strip()
    for begin, message in NO_UNIT.items():
        if re.match(begin, unit):
            raise UnitTextError(message.format(number=number))
    return number, unit


def quantity(text: str) -> tuple[Fraction, Unit]:
    """The value in SI of a text such as "10 mm", exactly, and its unit. Raises UnitTextError: "has no unit"."""
    number, given = split(text)
    unit, size = _unit(given), float(number)
    if not -LARGEST < size < LARGEST:
        finite = f"is beyond {LARGEST:g}, the largest number that is calculated with"
        raise UnitTextError(finite if math.isfinite(size) else "exceeds the range of floating-point numbers")
    exact = Fraction(number) if size else Fraction(0)  # 1e-999999999 is 0, and no fraction of so many digits
    return exact * unit.factor + unit.zero, unit


def si_value(text: str, unit: str, *also: str) -> tuple[Fraction, str]:
    """The quantity `text` in SI, and that of `unit` and `also` whose dimension it has.

    Args:
        text: such as "10 mm".
        unit: wanted dimension, as a unit of SI or of the model; "1" for a number without dimension.
        also: further dimensions that are taken, as units of SI.

    Raises:
        UnitTextError: with a sentence that begins "must be …".
    """
    try:
        value, found = quantity(text)
        for name in (unit, *also):
            if found.measures(in_si(name)):
                return value, name
        what = next((words for name, words in DIMENSIONS.items() if found.measures(name)), "another quantity")
        if found.angular and in_si(unit) == "1":
            slope = math.tan(value)
            half = math.degrees(math.atan2(1.0, slope))
            what += f': its tangent is {slope:.6g}; a cone may have half_angle = "{half:.6g}°" in place of this slope'
        raise UnitTextError(f"is {what}")
    except UnitTextError as error:
        raise UnitTextError(f"must be {in_words(unit)}; {_quoted(text)} {error}{_meant(text, unit)}") from None


def si_base(text: str) -> tuple[float, str]:
    """The number of a text in the unit of SI of its dimension, and that unit: 0.01 and m of "10 mm".

    Of N/m and J/m², which are one, that which the text has; an angle keeps its unit. Raises UnitTextError.
    """
    value, found = quantity(text)
    names = [name for name in DIMENSIONS if found.measures(name)]
    if found.angular or not names:
        return float((value - found.zero) / found.factor), found.text
    return float(value), max(names, key=lambda name: name[0] in found.text)


def _quoted(text: str) -> str:
    short = text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
    return "".join(c if c.isprintable() else "?" for c in short).strip() or "an empty text"


def _meant(text: str, unit: str) -> str:
    """The question whether another unit was meant: 10 GPa where it says 10 gpa."""
    try:
        number, given = split(text)
    except UnitTextError:
        return ""
    same = [one for one in COMMON if one.lower() == given.lower() and one != given and _unit(one).measures(in_si(unit))]
    if given.replace("·", "").replace(" ", "") == "Nm" and in_si(unit) == "J":
        same = ["N·m"]
    return f"; did you mean {number} {same[0]}?" if same else ""


@cache
def _registry() -> Any:
    """Pint's units, with exact factors."""
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


def _dimension(unit: str) -> Mapping[str, Any]:
    return {} if unit in ("1", "rad") else _unit(unit).dimension


def _for_pint(unit: str) -> str:
    """`unit` as pint reads it: J/m2 and J/m^2 are J/m**2."""
    plain = unit.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")).replace("·", "*").replace("×", "*")
    plain = re.sub(r"(\*\*|\^)", "", plain)
    return re.sub(r"(?<=[^\W\d_])(-?\d+)", r"**\1", plain)


@cache
def _unit(text: str) -> Unit:
    """What the text of a unit means. Raises UnitTextError."""
    return _of_si(text) or _of_pint(text)


def _of_si(text: str) -> Unit | None:
    """A unit of symbols of SI with their prefixes, products and quotients; None where it has others."""
    factor, powers = Fraction(1), Counter[str]()
    for sign, name in re.findall("([·/])([^·/]*)", f"·{text}"):
        found = FACTOR.fullmatch(name)
        if found is None:
            return None
        prefix, symbol, raised = found.groups()
        power = (-1 if sign == "/" else 1) * (int(unicodedata.digit(raised)) if raised else 1)
        own = BASES[symbol] if symbol in BASES else _unit(DERIVED[symbol])
        factor *= (own.factor * Fraction(10) ** PREFIXES[prefix]) ** power
        powers.update({base: power * raised for base, raised in own.dimension.items()})
    return Unit(text, factor, {base: power for base, power in powers.items() if power})


def _of_pint(text: str) -> Unit:
    """Any other unit. Raises UnitTextError."""
    unit = re.sub("°(?![CF])", "deg", text)  # pint's parser knows the sign, and its names don't
    names = [part for part in re.split(r"[\s·*×/()]+", POWER.sub("", unit)) if part]
    unknown = [name for name in names if not NAME.fullmatch(name) or not _is_known(name)]
    if unknown or not names:
        raise UnitTextError(f"has an unknown unit, {_quoted((unknown or [unit])[0])}")
    if re.search(r"\d{2}", unit):
        raise UnitTextError("has an invalid power of a unit")
    registry = _registry()
    try:
        known = {registry.get_name(name) for name in names}
        found = registry.parse_units(_for_pint(unit))
        factor, _ = registry.get_base_units(found, check_nonmult=False)
        plain = registry.get_base_units(found, check_nonmult=True)[0] is not None
    except Exception as error:  # pint's parser meets nonsense with errors of many kinds that have no class in common
        raise UnitTextError("has a unit that cannot be read") from error
    relative = not plain or any(name.startswith(("degree_", "delta_")) for name in known - ANGLES)
    if relative and (unit not in names or known.isdisjoint(OFFSET)):
        raise UnitTextError("is a relative scale: give a temperature in K or °C; levels (dB) are not allowed")
    zero = registry.Quantity(Fraction(0), found).to("K").magnitude if relative else Fraction(0)
    return Unit(text, Fraction(factor), dict(found.dimensionality), zero, not known.isdisjoint(ANGLES))


def _is_known(name: str) -> bool:
    from pint import PintError

    try:
        return name.lower() not in ("nan", "inf") and name in _registry()
    except PintError:  # a prefix before what takes none, such as a level
        return False
