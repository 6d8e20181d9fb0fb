"""The one unit system: length LU, force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU.

`SI` has every unit of the model with its powers, which all conversions use; a test compares them with pint's, whose
registry reads the units in a scene's texts. `Scales` is what LU, FU and MU represent in SI, where a scene says so.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from operator import add, mul, pow, sub, truediv
from typing import Any, NamedTuple

LENGTH = "LU"
FORCE = "FU"
MEAN_PRESSURE = "FU/LU²"
LINE_PRESSURE = "FU/LU"
ENERGY = "FU·LU"
MASS = "MU"
TIME = "TU"
NUMBER = "1"


class ModelUnit(NamedTuple):
    """A unit of SI, and that of the model for the same dimension: LU^length FU^force MU^mass, with TU = √(MU·LU/FU)."""

    si: str
    length: float = 0.0
    force: float = 0.0
    mass: float = 0.0

    @property
    def powers(self) -> dict[str, float]:
        """The powers that are not 0, by LU, FU and MU, which must be known for its size in SI."""
        return {base: power for base, power in zip(("LU", "FU", "MU"), self[1:], strict=True) if power}


SI = {
    LENGTH: ModelUnit("m", 1.0),
    FORCE: ModelUnit("N", 0.0, 1.0),
    MEAN_PRESSURE: ModelUnit("Pa", -2.0, 1.0),
    LINE_PRESSURE: ModelUnit("N/m", -1.0, 1.0),
    ENERGY: ModelUnit("J", 1.0, 1.0),
    MASS: ModelUnit("kg", 0.0, 0.0, 1.0),
    TIME: ModelUnit("s", 0.5, -0.5, 0.5),
    "LU/TU": ModelUnit("m/s", 0.5, 0.5, -0.5),
    "FU/TU": ModelUnit("N/s", -0.5, 1.5, -0.5),
    "FU·TU/LU": ModelUnit("N·s/m", -0.5, 0.5, 0.5),
    NUMBER: ModelUnit("1"),
}
"""The units of the model by their names."""
WITH_PREFIX = (*(own.si for own in SI.values() if own.si not in ("kg", "1")), "J/m²")
"""Units of SI that take a prefix."""
EXACT = 1e-12
"""By which the logarithm of a power of ten may fall short of it."""
PREFIXES = "yzafpnµm kMGT"
"""Of SI units, by powers of 1000 from the first on."""
FIRST = -8
"""The power of the first prefix."""
IN_WORDS = re.compile(
    r"([-−]?\d[\d.]*(?:e[+-]?\d+)?) (\()?([LFM]U(?:[·/][LFMT]U²?)*|TU)(?!\w)(?(2)\))|\(([LFM]U(?:[·/][LFMT]U²?)*|TU)\)"
)
"""A number with a unit of the model in a text, "1.5 FU/LU" or "1.5 (FU/LU)"; or that unit alone, in brackets."""
DIGITS = 4
"""Of a number in a text, at least."""
EXACTNESS = 1e-8
"""A relative uncertainty below it, as of a unit that was given, is left out."""


def scale_of(value: float, unit: str) -> tuple[float, str]:
    """The factor, and the unit with its prefix, for a number of this size in an SI `unit`.

    Of a compound unit (N/m) the first has the prefix, as in mN/m.
    """
    power = math.floor(math.log10(abs(float(f"{value:.6g}"))) / 3.0 + EXACT) if value and math.isfinite(value) else 0
    power = power if 0 <= power - FIRST < len(PREFIXES) and unit in WITH_PREFIX else 0
    return 1000.0**-power, PREFIXES[power - FIRST].strip() + unit


def prefixed(value: float, unit: str, digits: int = DIGITS) -> str:
    """A value [`unit` of SI] with so many digits and a prefix: `2.356 µN`."""
    factor, name = scale_of(value, unit)
    return f"{value * factor:.{digits}g} {name}"


@cache
def registry() -> Any:
    """Pint's units and those of the model, in which quantities calculate."""
    import pint

    units: Any = pint.UnitRegistry()
    for definition in ("LU = [model_length]", "FU = [model_force]", "MU = [model_mass]", "TU = [model_time]"):
        units.define(definition)
    return units


def _calculated(operation: Callable[[Any, Any], Any]) -> Callable[[Quantity, Any], Quantity]:
    """The operator of quantities that does this with pint's, between a quantity and another one or a number."""

    def calculate(self: Quantity, other: Any) -> Quantity:
        other = other if isinstance(other, Quantity) else Quantity(float(other), 0.0, NUMBER)

        def result(one: float, two: float) -> Any:
            return operation(registry().Quantity(one, self.unit), registry().Quantity(two, other.unit))

        found = result(self.value, other.value)
        found = found.to(next((name for name in WITH_PREFIX if found.check(name)), found.to_base_units().units))
        moved = result(self.value + self.uncertainty, other.value), result(self.value, other.value + other.uncertainty)
        spread = sum(abs((one - found).to(found.units).magnitude) for one in moved)
        return Quantity(float(found.magnitude), float(spread), f"{found.units:~P}".replace("Δ", "") or NUMBER)

    return calculate


@dataclass(frozen=True)
class Quantity:
    """A number with its uncertainty, both in `unit`: of SI, or of the model where a scene has no units.

    Quantities and numbers calculate with each other, +, −, ·, / and powers: units by pint, and the uncertainty is the
    sum of the changes that those of the operands make, since these may depend on each other.
    """

    value: float
    uncertainty: float
    unit: str

    def __float__(self) -> float:
        """The value."""
        return self.value

    @classmethod
    def of(cls, entry: Mapping[str, Any], in_si: bool = True) -> Quantity:
        """The quantity of an entry in results.json, in SI where that is known and wanted."""
        entry = entry.get("si", entry) if in_si else entry
        return cls(entry["value"], entry["uncertainty"], entry["unit"])

    @property
    def si(self) -> Quantity | None:
        """This quantity where its unit is one of SI; None where the scene has no units."""
        return None if self.unit in SI and self.unit != NUMBER else self

    def entry(self) -> dict[str, Any]:
        """What results.json holds of it."""
        return vars(self).copy()

    def to(self, unit: str) -> Quantity:
        """The same in another unit, "mN" for instance. Raises pint.DimensionalityError for another dimension."""
        factor = registry().Quantity(1.0, self.unit).to(unit).magnitude
        return Quantity(self.value * factor, self.uncertainty * factor, unit)

    __add__ = _calculated(add)
    __sub__ = _calculated(sub)
    __mul__ = __rmul__ = _calculated(mul)
    __truediv__ = _calculated(truediv)
    __rtruediv__ = _calculated(lambda divisor, number: number / divisor)
    __pow__ = _calculated(pow)

    def __str__(self) -> str:
        """`402.7 ± 1.3 MPa`: the uncertainty with two digits, units of SI with a prefix."""
        factor, unit = (
            (1.0, self.unit) if self.si is None else scale_of(max(abs(self.value), self.uncertainty), self.unit)
        )
        if 0.0 <= self.uncertainty <= EXACTNESS * abs(self.value):
            number = f"{self.value * factor:.5g}"
        else:
            number = rounded(self.value * factor, self.uncertainty * factor)
        return f"{number} {unit}" if unit != NUMBER else number


def rounded(value: float, uncertainty: float) -> str:
    """`value ± uncertainty`, the uncertainty with two digits and the value to the same place, in one notation."""
    if not math.isfinite(uncertainty) or uncertainty <= 1e-3 * EXACTNESS * abs(value):
        return f"{value:.10g} ± {uncertainty:.2g}"
    place, power = 1 - math.floor(math.log10(uncertainty)), 0
    if -3 <= place < 0:
        return f"{round(value, place) + 0.0:.0f} ± {round(uncertainty, place):.0f}"
    if not 0 <= place <= 10:
        power = math.floor(math.log10(max(abs(value), uncertainty)))
    value, uncertainty = (round(number / 10.0**power, place + power) + 0.0 for number in (value, uncertainty))
    text = f"{value:.{place + power}f} ± {uncertainty:.{place + power}f}"
    return f"({text})e{power:+03d}" if power else text


@dataclass(frozen=True)
class Scales:
    """The model units in SI.

    Attributes:
        length, force: one LU [m], one FU [N].
        mass: one MU [kg]; None: not known, and with it no time.
        length_uncertainty, force_uncertainty: of these; 0 where they are given.
        known: whether they stand for anything; see UNKNOWN.
        ends: pairs of what they may be instead, one for each number with ± that they are made of.
    """

    length: float
    force: float
    length_uncertainty: float = 0.0
    force_uncertainty: float = 0.0
    mass: float | None = None
    known: bool = True
    ends: tuple[tuple[Scales, ...], ...] = ()

    def know(self, unit: str) -> bool:
        """Whether one `unit` is known in SI."""
        return self.known and unit in SI and (self.mass is not None or not SI[unit].mass)

    def factor(self, unit: str) -> float:
        """SI value of one `unit`. Raises KeyError for a unit that is not known."""
        if not self.know(unit):
            raise KeyError(unit)
        own = SI[unit]
        return float(self.length**own.length * self.force**own.force * (self.mass or 1.0) ** own.mass)

    def base(self, unit: str) -> tuple[float, str]:
        """The factor from a model `unit` to the base unit in which its numbers are shown, and that unit.

        Of SI where it is known, else the unit itself.
        """
        return (self.factor(unit), SI[unit].si) if self.know(unit) else (1.0, unit)

    def written(self, value: float, unit: str) -> tuple[float, str]:
        """As `base`, with the prefix with which a number of this size is written."""
        factor, name = self.base(unit)
        prefix, name = scale_of(value * factor, name)
        return factor * prefix, name

    def in_words(self, text: str) -> str:
        """A text whose numbers and units of the model are in SI, where they are known: `1.5 nN` for `1.5e-09 FU`."""

        def shown(found: re.Match[str]) -> str:
            number, _, unit, alone = found.groups()
            if alone or not self.know(unit):
                return f"({self.base(alone)[1]})" if alone else found[0]
            value = float(number.replace("−", "-"))
            if not value:
                return found[0].replace(unit, self.base(unit)[1])
            factor, name = self.written(value, unit)
            digits = len(re.sub(r"e.*|\D", "", number).lstrip("0"))
            return f"{value * factor:.{max(DIGITS, digits)}g} {name}"

        return IN_WORDS.sub(shown, text)

    def in_si(self, value: float, uncertainty: float, unit: str) -> dict[str, float | str]:
        """The quantity in SI: value, uncertainty, unit. Relative uncertainties of the scales are added to its own.

        Independent changes of a scale add up in squares.
        """
        factor, own = self.factor(unit), SI[unit]
        scales = abs(own.length) * self.length_uncertainty / self.length
        scales += abs(own.force) * self.force_uncertainty / self.force
        scales += math.hypot(*(max(abs(one.factor(unit) / factor - 1.0) for one in both) for both in self.ends))
        spread = uncertainty * factor + abs(value * factor) * scales
        return {"value": value * factor, "uncertainty": spread, "unit": own.si}


UNKNOWN = Scales(1.0, 1.0, known=False)
"""Of a scene without units: all numbers stay in those of the model."""
