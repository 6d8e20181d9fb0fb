"""A combination's run in any units: its numbers in units of its own, and what it says about itself."""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from contact1d import Run, RunError, run
from tests.contracts.members import MODEL, Combination, Q, Units, scene_of

POWERS = {
    "LU": (1, 0, 0), "FU": (0, 1, 0), "TU": (0, 0, 1), "MU": (-1, 1, 2),
    "m": (1, 0, 0), "N": (0, 1, 0), "s": (0, 0, 1), "kg": (-1, 1, 2), "J": (1, 1, 0), "Pa": (-2, 1, 0),
    "rad": (0, 0, 0),
}  # fmt: skip
"""Of length, force and time, of each unit of the model and of SI."""
SUPERSCRIPTS = {"": 1, "²": 2, "³": 3}


def dimension(unit: str) -> Q:
    """One of a unit as results have it, "FU/LU²"."""
    powers = [0.0, 0.0, 0.0]
    for sign, name, raised in re.findall(r"(/?)·?([A-Za-z]+)([²³]?)", unit.replace("√", "")):
        for i, power in enumerate(POWERS[name]):
            powers[i] += (-1 if sign else 1) * power * SUPERSCRIPTS[raised]
    return Q(1.0, *powers)


@dataclass
class Found:
    """A run, or why there is none.

    Attributes:
        numbers: value and uncertainty of each result that has one, in model units of `MODEL`.
    """

    combination: Combination
    numbers: dict[str, tuple[float, float]] = field(default_factory=dict)
    consistency: dict[str, Any] = field(default_factory=dict)
    failure: str = ""
    done: Run | None = None


def in_model_units(done: Run, units: Units) -> dict[str, tuple[float, float]]:
    """The results as if the scene had been written in `MODEL`; the texts of all other units are of the same bodies."""
    found = {}
    for name, one in done.results.items():
        if one.value is None:
            continue
        size = units.size(dimension(one.unit)) if units.names is None else SI.size(dimension(one.unit))
        found[name] = (one.value / size, one.uncertainty / size)
    return found


SI = Units(1e-6, 1e-6, 1e-3)


class Runs:
    """Runs of a session, each once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.kept: dict[tuple[Combination, Units], Found] = {}

    def __call__(self, one: Combination, units: Units = MODEL) -> Found:
        if (one, units) not in self.kept:
            self.kept[one, units] = self._made(one, units)
        return self.kept[one, units]

    def _made(self, one: Combination, units: Units) -> Found:
        try:
            done = run(scene_of(one, units), self.folder / str(len(self.kept)), figures=False)
        except RunError as error:
            return Found(one, failure=str(error))
        return Found(one, in_model_units(done, units), done.document["consistency"], done=done)
