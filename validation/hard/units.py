"""How a scene in units of its model, with E* = 1 FU/LU², is written: as it is, with the units' sizes, or in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

Scene = dict[str, Any]
KEYS = {
    "m": ("radius", "height", "spacing", "from", "to", "amplitude", "r", "z", "range", "displacement", "displacements",
          "normal_displacement"),
    "N": ("force", "preload", "normal_force"), "s": ("time", "retardation_time"), "m/s": ("velocity",),
    "kg": ("mass",), "J/m²": ("work_of_adhesion",), "N/m": ("bulk_stiffness", "bulk_stiffness_tangential"),
    "J": ("energy",),
}  # fmt: skip
"""Keys of the numbers that have a unit; the amplitude of an interaction is an energy."""
INTERACTION = ("repulsion", "attraction")
UNIT_OF = {key: unit for unit, keys in KEYS.items() for key in keys}
DECADES = ((-9.0, -3.0), (3.0, 12.0), (-9.0, 7.0))
"""Of random units of length [m], stress [Pa] and time [s]."""


@dataclass(frozen=True)
class Units:
    """What a unit of the model is in SI.

    Attributes:
        length, stress, time: [m], [Pa], [s].
        texts: whether numbers are written with units, and results are in SI.
        automatic: whether the spacing is the program's own.
        scaled: whether numbers are written for other units of the model, which are these.
    """

    length: float = 1e-6
    stress: float = 1e9
    time: float = 1e-3
    texts: bool = False
    automatic: bool = False
    scaled: bool = False

    @cached_property
    def sizes(self) -> dict[str, float]:
        """A unit of the model in each SI unit, and in those of a scaled model."""
        L, P, T = self.length, self.stress, self.time
        found = {"1": 1.0, "m": L, "s": T, "m/s": L / T, "Pa": P, "N": P * L * L, "N/m": P * L, "J/m²": P * L,
                 "J": P * L**3, "kg": P * L * T * T}  # fmt: skip
        return found | {"LU": found["m"], "FU": found["N"], "FU·LU": found["J"]}

    def size(self, unit: str) -> float:
        """What a number of a run in that unit is to be divided by."""
        return self.sizes[unit] if self.texts or self.scaled else 1.0

    def written(self, scene: Scene) -> Scene:
        """The scene that is run."""
        if self.scaled:
            return self._written(scene)
        if not (self.texts or self.automatic):
            return scene
        bodies = dict(scene["bodies"])
        stiffness, along = (bodies.pop(key, None) for key in ("bulk_stiffness", "bulk_stiffness_tangential"))
        bodies |= {"spacing": "auto"} if self.automatic else {}
        scene = scene | {"bodies": bodies}
        if not self.texts:
            force = self.sizes["N"]
            sizes = {"contact_modulus": self.stress, "length_unit": self.length, "force_unit": force}
            return scene | {"material": sizes}
        material = {"contact_modulus": f"{self.stress!r} Pa"} if along is None else self._elastic(along / stiffness)
        return self._written(scene | {"material": material})

    def _written(self, scene: Scene) -> Scene:
        return {name: self._number(table, name) for name, table in scene.items()}

    def _number(self, node: Any, key: str) -> Any:
        if isinstance(node, Mapping):
            names = {name: "energy" if key in INTERACTION and name == "amplitude" else name for name in node}
            return {name: self._number(value, names[name]) for name, value in node.items()}
        if isinstance(node, list):
            timed = node and isinstance(node[0], list)
            return [[self._number(one[0], "time"), self._number(one[1], key)] if timed else self._number(one, key)
                    for one in node]  # fmt: skip
        if not (isinstance(node, float) and key in UNIT_OF):
            return node
        number = node * self.sizes[UNIT_OF[key]]
        return f"{number!r} {UNIT_OF[key]}" if self.texts else number

    def _elastic(self, ratio: float) -> Scene:
        """Two equal bodies of that E* and G*/E* = 2 (1 − ν)/(2 − ν)."""
        poisson = (2.0 - 2.0 * ratio) / (2.0 - ratio)
        young = 2.0 * self.stress * (1.0 - poisson**2)
        one = {"youngs_modulus": f"{young!r} Pa", "poisson_ratio": poisson}
        return {"upper": one, "lower": dict(one)}


MODEL = Units()


def random_units(rng: np.random.Generator, automatic: float = 0.25, texts: float = 0.4) -> Units:
    """Units of a scene, a share of which leaves the spacing to the program, and of which is written in SI."""
    length, stress, time = (float(10.0 ** rng.uniform(*decades)) for decades in DECADES)
    free = bool(rng.random() < automatic)
    return Units(length, stress, time, True, free) if rng.random() < texts else Units(automatic=free)
