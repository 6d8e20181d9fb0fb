"""How a scene in units of its model, with E* = 1 FU/LU², is written: as it is, with the units' sizes, or in SI."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from validation.row import tables_beside

Scene = dict[str, Any]
UNIT_OF = {key: unit for unit, keys in tables_beside(__file__).items() for key in keys}
"""By the keys of the numbers that have a unit."""
DECADES = ((-9.0, -3.0), (3.0, 12.0), (-9.0, 7.0))
"""Of random units of length [m], stress [Pa] and time [s]."""


@dataclass(frozen=True)
class Units:
    """What a unit of the model is in SI.

    Attributes:
        length, stress, time: [m], [Pa], [s].
        texts: whether numbers are written with units, and results are in SI.
        automatic: whether the spacing is the program's own.
    """

    length: float = 1e-6
    stress: float = 1e9
    time: float = 1e-3
    texts: bool = False
    automatic: bool = False

    @cached_property
    def sizes(self) -> dict[str, float]:
        """A unit of the model in each SI unit."""
        L, P, T = self.length, self.stress, self.time
        return {"1": 1.0, "m": L, "s": T, "m/s": L / T, "Pa": P, "N": P * L * L, "N/m": P * L, "J/m²": P * L,
                "J": P * L**3, "kg": P * L * T * T}  # fmt: skip

    def size(self, unit: str) -> float:
        """What a number of a run in that unit is to be divided by."""
        return self.sizes[unit] if self.texts else 1.0

    def written(self, scene: Scene) -> Scene:
        """The scene that is run."""
        if not (self.texts or self.automatic):
            return scene
        bodies = dict(scene["bodies"])
        stiffness, along = (bodies.pop(key, None) for key in ("bulk_stiffness", "bulk_stiffness_tangential"))
        bodies |= {"spacing": "auto"} if self.automatic else {}
        scene = scene | {"bodies": bodies}
        if not self.texts:
            sizes = {"contact_modulus": self.stress, "length_unit": self.length, "force_unit": self.sizes["N"]}
            return scene | {"material": sizes}
        material = {"contact_modulus": f"{self.stress!r} Pa"} if along is None else self._elastic(along / stiffness)
        return self._written(scene | {"material": material})

    def _written(self, tables: Mapping[str, Any]) -> Scene:
        return {name: self._number(table, name) for name, table in tables.items()}

    def _number(self, node: Any, key: str) -> Any:
        if isinstance(node, Mapping):
            return self._written(node)
        if isinstance(node, list):
            timed = node and isinstance(node[0], list)
            return [[self._number(one[0], "time"), self._number(one[1], key)] if timed else self._number(one, key)
                    for one in node]  # fmt: skip
        if not (isinstance(node, float) and key in UNIT_OF):
            return node
        unit = UNIT_OF[key]
        return f"{node * self.sizes[unit]!r} {unit}"

    def _elastic(self, ratio: float) -> Scene:
        """Two equal bodies of that E* and G*/E* = 2 (1 − ν)/(2 − ν)."""
        poisson = (2.0 - 2.0 * ratio) / (2.0 - ratio)
        young = 2.0 * self.stress * (1.0 - poisson**2)
        one = {"youngs_modulus": f"{young!r} Pa", "poisson_ratio": poisson}
        return {"upper": one, "lower": dict(one)}


MODEL = Units()


def random_units(rng: np.random.Generator) -> Units:
    """Units of a scene: one in four leaves the spacing to the program, and two in five are written in SI."""
    length, stress, time = (float(10.0 ** rng.uniform(*decades)) for decades in DECADES)
    free = rng.random() < 0.25
    return Units(length, stress, time, True, free) if rng.random() < 0.4 else Units(automatic=free)
