"""Problems of the Handbook of Contact Mechanics, each a scene with its closed form; docs/gallery.py makes the page.

The list is the TOML file of this name. Its closed forms are Python with the functions of numpy and of `numerics`.
"""

import tomllib
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

import contact1d
from validation.references.numerics import Function, integral, largest, root
from validation.row import tables_beside


def least(function: Function, low: float, high: float) -> float:
    """The least value of a function between two arguments."""
    return -largest(lambda x: -function(x), np.linspace(low, high, 200).tolist())[1]


@dataclass(frozen=True)
class Problem:
    """A scene, the name of a result, its closed form in TeX and as Python, and the axes of its panel."""

    name: str
    quantity: str
    axes: list[str]
    formula: str
    closed: str
    scene: str

    @cached_property
    def exact(self) -> dict[str, Any]:
        """`value` of the closed form, and x and y of the line of its panel, in SI."""
        names = vars(np) | {"integral": integral, "solved": root, "least": least}
        exec(self.closed, names)
        return names

    @cached_property
    def run(self) -> contact1d.Run:
        """The run of the scene."""
        return contact1d.run({"title": self.name} | tomllib.loads(self.scene))

    @property
    def over(self) -> float:
        """|result − closed form| over ±."""
        result = self.run.results[self.quantity]
        return float(abs(result.value - self.exact["value"]) / result.uncertainty)


CHAPTERS: list[dict[str, Any]] = tables_beside(__file__)["chapters"]
PROBLEMS = [Problem(**problem) for chapter in CHAPTERS for problem in chapter["problems"]]
