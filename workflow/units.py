"""The unit system of the model: length LU, force FU, mass MU, time TU = √(MU·LU/FU), temperature as k_BT in FU·LU.

`SI` has every unit of the model with its powers, which all conversions use; a test compares them with pint's, whose
registry reads the units in a scene's texts. `Scales` has the sizes of LU, FU and MU in SI, where a scene gives them.
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
VELOCITY = "LU/TU"
SPIN = "1/TU"
RATE = "1/(LU·TU)"
NUMBER = "1"


class ModelUnit(NamedTuple):
    """An SI unit, and the model unit of the same dimension, LU^length FU^force MU^mass, with TU = √(MU·LU/FU).

    Attributes:
        si: the SI unit.
        length, force, mass: powers of LU, FU and MU.
    """

    si: str
    length: float = 0.0
    force: float = 0.0
    mass: float = 0.0

    @property
    def powers(self) -> dict[str, float]:
        """The exponents of LU, FU and MU, by these names, without those that are 0; {} for a number without unit.

        A time is in powers of all three: TU = √(MU·LU/FU).
        """
        return {base: power for base, power in zip(("LU", "FU", "MU"), self[1:], strict=True) if power}


SI = {
    LENGTH: ModelUnit("m", 1.0),
    FORCE: ModelUnit("N", 0.0, 1.0),
    MEAN_PRESSURE: ModelUnit("Pa", -2.0, 1.0),
    LINE_PRESSURE: ModelUnit("N/m", -1.0, 1.0),
    ENERGY: ModelUnit("J", 1.0, 1.0),
    MASS: ModelUnit("kg", 0.0, 0.0, 1.0),
    TIME: ModelUnit("s", 0.5, -0.5, 0.5),
    VELOCITY: ModelUnit("m/s", 0.5, 0.5, -0.5),
    "FU/TU": ModelUnit("N/s", -0.5, 1.5, -0.5),
    "FU·TU/LU": ModelUnit("N·s/m", -0.5, 0.5, 0.5),
    SPIN: ModelUnit("rad/s", -0.5, 0.5, -0.5),
    RATE: ModelUnit("1/(m·s)", -1.5, 0.5, -0.5),
    "MU·LU²": ModelUnit("kg·m²", 2.0, 0.0, 1.0),
    NUMBER: ModelUnit("1"),
}
"""The units of the model by their names."""
WITH_PREFIX = (*(unit.si for unit in SI.values() if unit.si not in ("kg", "kg·m²", "1/(m·s)", "1")), "J/m²")
"""SI units that take a prefix."""
PREFIXES = "yzafpnµm kMGT"
"""SI prefixes by rising powers of 1000; the blank is no prefix."""
FIRST = -PREFIXES.index(" ")
"""The power of 1000 of the first prefix."""
IN_WORDS = re.compile(
    r"([-−]?\d[\d.]*(?:e[+-]?\d+)?) (\()?([LFM]U(?:[·/][LFMT]U²?)*|TU)(?!\w)(?(2)\))|\(([LFM]U(?:[·/][LFMT]U²?)*|TU)\)"
)
"""A number with a unit of the model in a text, "1.5 FU/LU" or "1.5 (FU/LU)"; or only the unit, in brackets."""
DIGITS = 4
"""Least significant digits of a number in a text."""
EXACTNESS = 1e-8
"""Relative uncertainty below which none is printed, as for a unit that was given."""


def scale_of(value: float, unit: str) -> tuple[float, str]:
    """Return (factor, unit with its SI prefix) in which a number of the size of `value` [`unit`] is written.

    |value| × factor is from 1 to below 1000, after rounding of the value to six digits. In a compound unit (N/m) the
    first one takes the prefix, as in mN/m. The factor is 1 and the unit unchanged for 0, NaN and infinity, for a unit
    that takes no prefix (kg, "1" and units of the model), and for magnitudes below 1e-24 or from 1e15 on.
    """
    power = 0
    if value and math.isfinite(value) and unit in WITH_PREFIX:
        # The logarithm of a power of ten may fall short of it by its round-off error.
        power = math.floor(math.log10(abs(float(f"{value:.6g}"))) / 3.0 + 1e-12)
    power = power if 0 <= power - FIRST < len(PREFIXES) else 0
    return 1000.0**-power, PREFIXES[power - FIRST].strip() + unit


def prefixed(value: float, unit: str, digits: int = DIGITS) -> str:
    """Return a value [SI `unit`] as text with an SI prefix, `2.356 µN`, in format "g" with this number of digits.

    Zeros at the end are left out, and more digits before the point than `digits` give an exponent. A unit that takes no
    prefix stays as it is.
    """
    factor, name = scale_of(value, unit)
    return f"{value * factor:.{digits}g} {name}"


@cache
def registry() -> Any:
    """Return pint's registry with LU, FU, MU and TU as additional base units; the same object at each call."""
    import pint

    units: Any = pint.UnitRegistry()
    for definition in ("LU = [model_length]", "FU = [model_force]", "MU = [model_mass]", "TU = [model_time]"):
        units.define(definition)
    return units


def _calculated(operation: Callable[[Any, Any], Any]) -> Callable[[Quantity, Any], Quantity]:
    """Return the function of a binary operator of `Quantity` that applies one of pint's, `operation`.

    It takes the left quantity and another one, or a number, which counts as exact and without unit. Its result is in
    the first SI unit of `WITH_PREFIX` of the right dimension (m, N, Pa, N/m, J, s, …), else in base units. Its
    uncertainty is the sum of the absolute changes of the result as one operand after the other is raised by its
    uncertainty.
    """

    def calculate(self: Quantity, operand: Any) -> Quantity:
        """Return the result of the operation on `self` and `operand`, a quantity or an exact number without unit.

        It is in the first SI unit of `WITH_PREFIX` of its dimension, else in base units; its uncertainty is the sum of
        the absolute changes as one operand after the other is raised by its uncertainty.

        Raises:
            pint.DimensionalityError: the dimensions do not allow the operation, as m + N.
        """
        right = operand if isinstance(operand, Quantity) else Quantity(float(operand), 0.0, NUMBER)

        def applied(left_value: float, right_value: float) -> Any:
            """Return pint's quantity for the operation on two numbers, in the units of left and right operand."""
            return operation(registry().Quantity(left_value, self.unit), registry().Quantity(right_value, right.unit))

        result = applied(self.value, right.value)
        result = result.to(next((name for name in WITH_PREFIX if result.check(name)), result.to_base_units().units))
        moved = (
            applied(self.value + self.uncertainty, right.value),
            applied(self.value, right.value + right.uncertainty),
        )
        spread = sum(abs((changed - result).to(result.units).magnitude) for changed in moved)
        return Quantity(float(result.magnitude), float(spread), f"{result.units:~P}".replace("Δ", "") or NUMBER)

    return calculate


@dataclass(frozen=True)
class Quantity:
    """A number with its uncertainty, both in `unit`: of SI, or of the model where a scene has no units.

    The operators +, −, ·, / and powers take quantities and numbers. Units are pint's; the uncertainty is the sum of the
    changes due to the uncertainty of each operand, since these may depend on each other.
    """

    value: float
    uncertainty: float
    unit: str

    def __float__(self) -> float:
        """Return the value, in `unit`; the uncertainty is dropped."""
        return self.value

    @classmethod
    def of(cls, entry: Mapping[str, Any], in_si: bool = True) -> Quantity:
        """Return the quantity of an entry in results.json, by its "value", "uncertainty" and "unit".

        In SI where the entry has a part "si"; without `in_si`, and where it has none, in the entry's own unit, of the
        model.

        Raises:
            KeyError: one of the three is missing.
        """
        entry = entry.get("si", entry) if in_si else entry
        return cls(entry["value"], entry["uncertainty"], entry["unit"])

    def entry(self) -> dict[str, Any]:
        """Return the entry of this quantity in results.json, a new dict with "value", "uncertainty" and "unit"."""
        return vars(self).copy()

    def to(self, unit: str) -> Quantity:
        """Return a new quantity with value and uncertainty converted to another unit, "mN" for instance.

        Raises:
            pint.DimensionalityError: the unit has another dimension, as one of SI for a quantity in units of the
                model.
            pint.UndefinedUnitError: pint does not know the unit.
        """
        factor = registry().Quantity(1.0, self.unit).to(unit).magnitude
        return Quantity(self.value * factor, self.uncertainty * factor, unit)

    __add__ = _calculated(add)
    __sub__ = _calculated(sub)
    __mul__ = __rmul__ = _calculated(mul)
    __truediv__ = _calculated(truediv)
    __rtruediv__ = _calculated(lambda divisor, number: number / divisor)
    __pow__ = _calculated(pow)

    def __str__(self) -> str:
        """Return `402.7 ± 1.3 MPa`: the uncertainty with two digits, the value with the same decimals.

        An SI unit has the prefix of the larger one of |value| and uncertainty, a unit of the model none; "1" is left
        out. With an uncertainty of at most 1e-8 of |value| it is the value alone, with up to five digits.
        """
        factor, unit = scale_of(max(abs(self.value), self.uncertainty), self.unit)
        if 0.0 <= self.uncertainty <= EXACTNESS * abs(self.value):
            number = f"{self.value * factor:.5g}"
        else:
            number = rounded(self.value * factor, self.uncertainty * factor)
        return f"{number} {unit}" if unit != NUMBER else number


def rounded(value: float, uncertainty: float) -> str:
    """Return `value ± uncertainty`, without unit: the uncertainty with two digits, the value with the same decimals.

    For an uncertainty below 1e-9 or from 1e5 on both have a common exponent, `(1.23 ± 0.45)e+06`. Where the uncertainty
    is not finite, or at most 1e-11 of |value|, the value has up to ten digits instead.
    """
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
        mass: one MU [kg]; None where it is unknown, and then so are times.
        length_uncertainty, force_uncertainty: uncertainties of one LU [m] and one FU [N]; 0 where the scene gives both.
        known: whether the scene has units; otherwise see UNKNOWN.
        ends: for each number with ± on which the scales depend, the scales at both ends of its range.
    """

    length: float
    force: float
    length_uncertainty: float = 0.0
    force_uncertainty: float = 0.0
    mass: float | None = None
    known: bool = True
    ends: tuple[tuple[Scales, ...], ...] = ()

    def know(self, unit: str) -> bool:
        """Return whether the size of one `unit` of the model, "FU/LU" for instance, in SI is known.

        False without units in the scene, for a name that is not in `SI`, and, where the mass unit is not known, for
        units that contain it, times among them.
        """
        return self.known and unit in SI and (self.mass is not None or not SI[unit].mass)

    def factor(self, unit: str) -> float:
        """Return the size of one `unit` of the model in its SI unit: 1e-9 where one "FU" is 1 nN.

        Raises:
            KeyError: the size is unknown, or `unit` is none of the units in `SI`.
        """
        if not self.know(unit):
            raise KeyError(unit)
        powers = SI[unit]
        return float(self.length**powers.length * self.force**powers.force * (self.mass or 1.0) ** powers.mass)

    def base(self, unit: str) -> tuple[float, str]:
        """Return (factor, unit) with which a number in a model `unit` is shown: factor × number [unit].

        It is the SI unit without prefix where its size is known, else the model unit itself with the factor 1.
        """
        return (self.factor(unit), SI[unit].si) if self.know(unit) else (1.0, unit)

    def written(self, value: float, unit: str) -> tuple[float, str]:
        """Return (factor, unit) to show numbers of the size of `value` in a model `unit`: factor × number [unit].

        It is the SI unit with the prefix for this size, where its size is known; else the model unit itself with the
        factor 1.
        """
        factor, name = self.base(unit)
        prefix, name = scale_of(value * factor, name)
        return factor * prefix, name

    def in_words(self, text: str) -> str:
        """Return a text with its numbers in SI units instead of units of the model: `1.5 nN` for `1.5e-09 FU`.

        Numbers have up to four significant digits, or as many as before if that is more, and a prefix; of 0 only the
        unit is replaced. A unit in brackets without a number becomes the SI unit without prefix. Where the size of a
        unit in SI is unknown, unit and number stay.
        """

        def shown(match: re.Match[str]) -> str:
            """Return the text for a match: the number with SI unit and prefix, or for a unit in brackets its SI unit.

            For 0 only the unit is replaced. Where its size in SI is unknown, the text is unchanged.
            """
            number, _, unit, alone = match.groups()
            if alone or not self.know(unit):
                return f"({self.base(alone)[1]})" if alone else match[0]
            value = float(number.replace("−", "-"))
            if not value:
                return match[0].replace(unit, self.base(unit)[1])
            factor, name = self.written(value, unit)
            digits = len(re.sub(r"e.*|\D", "", number).lstrip("0"))
            return f"{value * factor:.{max(DIGITS, digits)}g} {name}"

        return IN_WORDS.sub(shown, text)

    def in_si(self, value: float, uncertainty: float, unit: str) -> dict[str, float | str]:
        """Return {"value", "uncertainty", "unit"} in the SI unit, without prefix, of a quantity in a model `unit`.

        `uncertainty` is given in the model unit. That of the scales is added to it: |value| times the sum of the
        relative uncertainties of LU and FU, each times the magnitude of its power in the unit, and of √(Σ change²) over
        the inputs with ± on which the scales depend, of each the larger relative change of the unit at the ends of its
        range.

        Raises:
            KeyError: the size of the unit in SI is unknown.
        """
        factor, model_unit = self.factor(unit), SI[unit]
        relative = abs(model_unit.length) * self.length_uncertainty / self.length
        relative += abs(model_unit.force) * self.force_uncertainty / self.force
        relative += math.hypot(*(max(abs(scales.factor(unit) / factor - 1.0) for scales in pair) for pair in self.ends))
        spread = uncertainty * factor + abs(value * factor) * relative
        return {"value": value * factor, "uncertainty": spread, "unit": model_unit.si}


UNKNOWN = Scales(1.0, 1.0, known=False)
"""The scales of a scene without units, whose numbers stay in units of the model."""
