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
    "m": "a length, such as 10 mm",
    "N": "a force, such as 10 N",
    "Pa": "a pressure, such as 210 GPa",
    "kg": "a mass, such as 1 ng",
    "s": "a time, such as 1 µs",
    "K": "a temperature, such as 300 K",
    "J": "an energy, such as 1 aJ",
    "N/m": "a force per length or energy per area, such as 100 N/m",
    "J/m²": "an energy per area, such as 50 mJ/m²",
    "m/s": "a velocity, such as 1 µm/s",
    "N·s/m": "a drag coefficient, such as 1 mN·s/m",
    "N/s": "a force per time, such as 1 mN/s",
    "kg·m²": "a moment of inertia, such as 1 g·mm²",
    "m²": "an area",
    "m³": "a volume",
    "m/s²": "an acceleration",
    "kg/m³": "a density",
    "W": "a power",
    "Hz": "a frequency, such as 10 Hz",
    "rad/s": "an angular frequency or velocity, such as 10 rad/s",
    "Pa·s": "a viscosity",
    "V": "a voltage",
    "A": "a current",
    "mol": "an amount of substance",
    "C": "an electric charge",
    "1": "a number without a unit, such as 0.3",
    "rad": "an angle, such as 80°",
}
"""Each dimension in words, most with an example, by its unit in SI."""
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
PREFIXES = {"c": -2, "u": -6, "μ": -6} | {prefix.strip(): 3 * power for power, prefix in enumerate(BY_THOUSANDS, FIRST)}
"""SI prefixes with their powers of ten."""
POWER = re.compile(r"(\*\*|\^)?[-+⁻]?[\d⁰¹²³⁴⁵⁶⁷⁸⁹]+")
LONGEST = 60
"""Largest number of characters of a text that may be a number with a unit."""
MODEL_UNITS = "is in units of the model"
NO_UNIT = {
    r"$": "has no unit",
    r",": "has a comma in its number: write a decimal point, and no thousands separators",
    r"[eE](?![^\W\d_])": "has an exponent that is not an integer",
    r"[.'_\d]": "has text after the number {number} that is not a unit",
    r"(LU|FU|MU|TU)\b": f"{MODEL_UNITS}: write {{number}} without quotes and unit",
}
"""Beginnings of a text after a number that is no unit, and the error of each."""


class UnitTextError(ValueError):
    """A text that is no quantity of the wanted dimension; the message begins "must be …" or stands alone."""


@dataclass(frozen=True)
class Unit:
    """A unit as read.

    Attributes:
        text: as written.
        factor: its size in base units of SI.
        dimension: powers of base dimensions by pint's names.
        zero: its zero in base units of SI: 273.15 (K) of °C, else 0.
        angular: whether it measures angles.
    """

    text: str
    factor: Fraction
    dimension: Mapping[str, Any]
    zero: Fraction = Fraction(0)
    angular: bool = False

    def measures(self, unit: str) -> bool:
        """Return whether this unit has the dimension of `unit`, a unit of SI: "1" for a number, "rad" for an angle.

        An angle is no number without dimension, and the other way round.

        Raises:
            UnitTextError: `unit` is none.
        """
        return self.dimension == _dimension(unit) and self.angular == unit.startswith("rad")


BASES = {
    symbol: Unit(symbol, Fraction(1, 1000 if symbol == "g" else 1), {dimension: 1})
    for symbol, dimension in {
        "m": "[length]", "g": "[mass]", "s": "[time]", "K": "[temperature]", "A": "[current]", "mol": "[substance]",
    }.items()
}  # fmt: skip
"""Symbols of SI; dimensions by pint's names."""
FACTOR = re.compile(rf"({'|'.join(PREFIXES)})({'|'.join(BASES | DERIVED)})([²³]?)")


def in_words(unit: str) -> str:
    """Return what a quantity in `unit` (of SI or of the model) is, mostly with an example: "a force, such as 10 N".

    Raises:
        KeyError: no name is known of this dimension.
    """
    return DIMENSIONS[in_si(unit)]


def example(unit: str) -> str:
    """Return an example of a quantity in `unit` (of SI or of the model) as text: "10 mm"; "" where none is known.

    Raises:
        KeyError: no name is known of this dimension.
    """
    return in_words(unit).partition(", such as ")[2]


def in_si(unit: str) -> str:
    """Return the unit of SI with the dimension of the model's `unit`: N·s/m for FU·TU/LU; any other text unchanged."""
    return SI[unit].si if unit in SI else unit


def split(text: str) -> tuple[str, str]:
    """Return number and unit of "10 mm", each as text without blanks around it, a sign "−" of the number as "-".

    Whether such a unit exists is not checked.

    Raises:
        UnitTextError: the text has more than 60 characters, does not begin with a number, or what follows is no unit:
            nothing, a comma, another digit or point, an exponent that is not an integer, or LU, FU, MU or TU.
    """
    plain = text.strip().replace("−", "-")
    match = NUMBER.match(plain)
    if match is None or len(plain) > LONGEST:
        raise UnitTextError("does not begin with a number")
    number, unit = match[0], plain[match.end() :].strip()
    for begin, message in NO_UNIT.items():
        if re.match(begin, unit):
            raise UnitTextError(message.format(number=number))
    return number, unit


def quantity(text: str, largest: float = 1e300) -> tuple[Fraction, Unit]:
    """Return the exact value of a text such as "10 mm" in base units of SI (m, kg, s, K, A, mol; rad), and its unit.

    A number too small for a float counts as 0.

    Args:
        text: of the quantity.
        largest: the magnitude of its number must be less, so that products with units are mostly finite.

    Raises:
        UnitTextError: "has no unit", or another sentence without a subject; also for a number of `largest` or more.
    """
    number, given = split(text)
    unit, size = _unit(given), float(number)
    if not -largest < size < largest:
        finite = f"is beyond {largest:g}, the largest number that is calculated with"
        raise UnitTextError(finite if math.isfinite(size) else "exceeds the range of floating-point numbers")
    exact = Fraction(number) if size else Fraction(0)  # 1e-999999999 is 0, and no fraction of so many digits
    return exact * unit.factor + unit.zero, unit


def si_value(text: str, unit: str, *also: str) -> tuple[Fraction, str]:
    """Return (exact value of the text in SI, the first one out of `unit` and `also` that has its dimension, as given).

    Args:
        text: such as "10 mm".
        unit: wanted dimension, as a unit of SI or of the model; "1" for a number without dimension.
        also: further dimensions that are allowed, as units of SI or of the model.

    Raises:
        UnitTextError: with a sentence that begins "must be …": the text is no quantity, or one of another dimension.
    """
    try:
        value, given = quantity(text)
        for name in (unit, *also):
            if given.measures(in_si(name)):
                return value, name
        names = (words.partition(",")[0] for name, words in DIMENSIONS.items() if given.measures(name))
        words = next(names, "another quantity")
        if given.angular and in_si(unit) == "1":
            slope = math.tan(value)
            half = math.degrees(math.atan2(1.0, slope))
            words += f': its tangent is {slope:.6g}; a cone may have half_angle = "{half:.6g}°" in place of this slope'
        raise UnitTextError(f"is {words}")
    except UnitTextError as error:
        raise UnitTextError(f"must be {in_words(unit)}; {_quoted(text)} {error}{_other_unit(text, unit)}") from None


def si_base(text: str) -> tuple[float, str]:
    """Return the number of a text in the unit of SI of its dimension, and that unit: 0.01 and "m" of "10 mm".

    Of N/m and J/m², which have one dimension, it is the one whose first letter is in the text's unit, else N/m. An
    angle, and a dimension without a name here, keep their number and unit.

    Raises:
        UnitTextError: the text is no quantity.
    """
    value, unit = quantity(text)
    names = [name for name in DIMENSIONS if unit.measures(name)]
    if unit.angular or not names:
        return float((value - unit.zero) / unit.factor), unit.text
    return float(value), max(names, key=lambda name: name[0] in unit.text)


def _quoted(text: str) -> str:
    """Return a text for a message, without quotes: at most 60 characters, "?" for each that is not printable.

    A longer one ends with "…". "an empty text" for one of blanks alone or without characters.
    """
    short = text if len(text) <= LONGEST else text[: LONGEST - 1] + "…"
    return "".join(c if c.isprintable() else "?" for c in short).strip() or "an empty text"


def _other_unit(text: str, unit: str) -> str:
    """Return the question whether another unit was meant, "; did you mean 10 GPa?" of "10 gpa"; "" if none is likely.

    Likely is a common unit of the dimension of `unit` that differs in case alone, and N·m for "Nm" as an energy.
    """
    try:
        number, given = split(text)
    except UnitTextError:
        return ""
    alike = [name for name in COMMON if name.lower() == given.lower() and name != given]
    meant = [name for name in alike if _unit(name).measures(in_si(unit))]
    if given.replace("·", "").replace(" ", "") == "Nm" and in_si(unit) == "J":
        meant = ["N·m"]
    return f"; did you mean {number} {meant[0]}?" if meant else ""


@cache
def _registry() -> Any:
    """Return pint's registry of units of SI, with factors as fractions; cached, and imported with the first call."""
    import pint

    return pint.UnitRegistry(non_int_type=Fraction)


def _dimension(unit: str) -> Mapping[str, Any]:
    """Return the dimension of a unit of SI, as powers by pint's names ("[length]": 1); empty for "1" and "rad".

    Raises:
        UnitTextError: there is no such unit.
    """
    return {} if unit in ("1", "rad") else _unit(unit).dimension


def _for_pint(unit: str) -> str:
    """Return `unit` in the notation of pint, unchecked: "J/m**2" for J/m2, J/m^2 and J/m², "*" for "·" and "×"."""
    plain = re.sub(r"\*\*|\^", "", unit.translate(str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻·×", "0123456789-**")))
    return re.sub(r"(?<=[^\W\d_])(-?\d+)", r"**\1", plain)


@cache
def _unit(text: str) -> Unit:
    """Return the unit of a text such as "mm" or "N/m"; cached.

    Raises:
        UnitTextError: there is no such unit.
    """
    return _si_unit(text) or _pint_unit(text)


def _si_unit(text: str) -> Unit | None:
    """Return the unit of a text of SI symbols with prefixes, products by "·" and quotients by "/", such as "mN·s/m²".

    None where it has anything else: other symbols, blanks, or powers other than ² and ³.
    """
    factor, powers = Fraction(1), Counter[str]()
    for sign, name in re.findall("([·/])([^·/]*)", f"·{text}"):
        match = FACTOR.fullmatch(name)
        if match is None:
            return None
        prefix, symbol, raised = match.groups()
        power = (-1 if sign == "/" else 1) * (int(unicodedata.digit(raised)) if raised else 1)
        unit = BASES[symbol] if symbol in BASES else _unit(DERIVED[symbol])
        factor *= (unit.factor * Fraction(10) ** PREFIXES[prefix]) ** power
        powers.update({base: power * raised for base, raised in unit.dimension.items()})
    return Unit(text, factor, {base: power for base, power in powers.items() if power})


def _pint_unit(text: str) -> Unit:
    """Return a unit with symbols that pint alone knows.

    Raises:
        UnitTextError: the unit is unknown, cannot be read, or is a relative scale other than °C or °F alone.
    """
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
        parsed = registry.parse_units(_for_pint(unit))
        factor, _ = registry.get_base_units(parsed, check_nonmult=False)
        plain = registry.get_base_units(parsed, check_nonmult=True)[0] is not None
    except Exception as error:  # pint's parser meets nonsense with errors of many kinds that have no class in common
        raise UnitTextError("has a unit that cannot be read") from error
    relative = not plain or any(name.startswith(("degree_", "delta_")) for name in known - ANGLES)
    if relative and (unit not in names or known.isdisjoint(OFFSET)):
        raise UnitTextError("is a relative scale: give a temperature in K or °C; levels (dB) are not allowed")
    zero = registry.Quantity(Fraction(0), parsed).to("K").magnitude if relative else Fraction(0)
    return Unit(text, Fraction(factor), dict(parsed.dimensionality), zero, not known.isdisjoint(ANGLES))


def _is_known(name: str) -> bool:
    """Return whether pint knows the name of a unit, with a prefix or without; False for "nan" and "inf" in any case."""
    from pint import PintError

    try:
        return name.lower() not in ("nan", "inf") and name in _registry()
    except PintError:  # a prefix before what takes none, such as a level
        return False
