"""The one unit system: length LU, force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU.

`SI` has every unit of the model with its powers, which all conversions use; a test compares them with pint's, whose
registry reads the units in a scene's texts. `Scales` is what LU, FU and MU represent in SI, where a scene says so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
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
EXACT = 1e-12
"""By which the logarithm of a power of ten may fall short of it."""
PREFIXES = {-6: "a", -5: "f", -4: "p", -3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G", 4: "T"}
"""Of SI units, by powers of 1000."""


def scale_of(value: float, unit: str) -> tuple[float, str]:
    """The factor, and the unit with its prefix, for a number of this size in an SI `unit`.

    Of a compound unit (N/m) the first has the prefix, as in mN/m.
    """
    power = math.floor(math.log10(abs(value)) / 3.0 + EXACT) if value and math.isfinite(value) else 0
    power = power if power in PREFIXES else 0
    return 1000.0**-power, PREFIXES[power] + unit


def prefixed(value: float, unit: str) -> str:
    """A value [`unit` of SI] with four digits and a prefix: `2.356 µN`."""
    factor, name = scale_of(value, unit)
    return f"{value * factor:.4g} {name}"


@dataclass(frozen=True)
class Quantity:
    """A number with its uncertainty, both in `unit`; `si`: the same in SI, where the scene has a [material]."""

    value: float
    uncertainty: float
    unit: str
    si: Quantity | None = None

    def __float__(self) -> float:
        """The value."""
        return self.value

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Quantity:
        """The quantity that `entry` wrote."""
        si = entry.get("si")
        return cls(entry["value"], entry["uncertainty"], entry["unit"], None if si is None else cls.of(si))

    def entry(self) -> dict[str, Any]:
        """What results.json holds of it."""
        own = {"value": self.value, "uncertainty": self.uncertainty, "unit": self.unit}
        return own if self.si is None else own | {"si": self.si.entry()}

    def __str__(self) -> str:
        """`1.483400 ± 0.000029 FU`."""
        return f"{rounded(self.value, self.uncertainty)} {self.unit}"


def rounded(value: float, uncertainty: float) -> str:
    """`value ± uncertainty`, the uncertainty with two digits and the value to the same place."""
    if not math.isfinite(uncertainty) or uncertainty <= 0.0:
        return f"{value:.10g} ± {uncertainty:.2g}"
    place = 1 - math.floor(math.log10(uncertainty))
    if -3 <= place < 0:
        return f"{round(value, place):.0f} ± {round(uncertainty, place):.0f}"
    if not 0 <= place <= 10:
        return f"{value:.6g} ± {uncertainty:.2g}"
    return f"{value:.{place}f} ± {uncertainty:.{place}f}"


@dataclass(frozen=True)
class Scales:
    """The model units in SI.

    Attributes:
        length, force: one LU [m], one FU [N].
        mass: one MU [kg]; None: not known, and with it no time.
        length_uncertainty, force_uncertainty: of these; 0 where they are given.
    """

    length: float
    force: float
    length_uncertainty: float = 0.0
    force_uncertainty: float = 0.0
    mass: float | None = None

    def know(self, unit: str) -> bool:
        """Whether one `unit` is known in SI."""
        return unit in SI and (self.mass is not None or not SI[unit].mass)

    def factor(self, unit: str) -> float:
        """SI value of one `unit`. Raises KeyError for a unit that is not known."""
        if not self.know(unit):
            raise KeyError(unit)
        own = SI[unit]
        return float(self.length**own.length * self.force**own.force * (self.mass or 1.0) ** own.mass)

    def written(self, value: float, unit: str) -> tuple[float, str]:
        """The factor from a model `unit` to the SI unit with which a number of this size is written, and that unit."""
        factor, name = scale_of(value * self.factor(unit), SI[unit].si)
        return factor * self.factor(unit), name

    def in_si(self, value: float, uncertainty: float, unit: str) -> dict[str, float | str]:
        """The quantity in SI: value, uncertainty, unit. Relative uncertainties of the scales are added to its own."""
        factor, own = self.factor(unit), SI[unit]
        scales = abs(own.length) * self.length_uncertainty / self.length
        scales += abs(own.force) * self.force_uncertainty / self.force
        spread = uncertainty * factor + abs(value * factor) * scales
        return {"value": value * factor, "uncertainty": spread, "unit": own.si}
