"""The force between two particles of opposite bodies, V(r) = A exp(-r/a) - B exp(-r/b), for the references.

This is a second, separate writing of the law; the program's own tables are not read here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from validation.references.numerics import Floats as Floats

LawNumbers = tuple[float, float, float, float]
"""A [FU LU], a [LU], B [FU LU], b [LU]."""


@dataclass(frozen=True)
class Exponential:
    """One term, amplitude * exp(-r / range).

    Args:
        amplitude: energy at r = 0 [FU LU], positive.
        range: decay length [LU], positive.
    """

    amplitude: float
    range: float


@dataclass(frozen=True)
class PairInteraction:
    """V(r) = A exp(-r/a) - B exp(-r/b), without a cutoff.

    Args:
        repulsion: A [FU LU] and a [LU].
        attraction: B [FU LU] and b [LU]. Must be weaker and longer: b > a and B/b < A/a.

    Raises:
        ValueError: if no distance r > 0 is force-free.
    """

    repulsion: Exponential
    attraction: Exponential

    def __post_init__(self) -> None:
        """Check that a force-free distance exists."""
        if self.attraction.range <= self.repulsion.range:
            raise ValueError("the attraction must reach further than the repulsion")
        if self.force_free_distance() <= 0.0:
            raise ValueError("the attraction is stronger than the repulsion at contact: no force-free distance")

    @classmethod
    def of(cls, A: float, a: float, B: float, b: float) -> PairInteraction:
        """The law of A [FU LU], a [LU], B [FU LU], b [LU]."""
        return cls(Exponential(A, a), Exponential(B, b))

    @property
    def shortest_range(self) -> float:
        """The range of the repulsion a [LU], the shorter of the two."""
        return self.repulsion.range

    @property
    def longest_range(self) -> float:
        """The longer of the two ranges [LU]."""
        return self.attraction.range

    def extremum_distance(self, order: int) -> float:
        """Return the distance [LU] at which the derivative of the force of this order vanishes.

        The root of A/a^n exp(-r/a) = B/b^n exp(-r/b), n = order + 1: ln[(A/B)(b/a)^n] / (1/a - 1/b).

        Args:
            order: 0 the force-free distance, 1 the distance of the largest tension, 2 that of the steepest tension.
        """
        a, b = self.repulsion.range, self.attraction.range
        ratio = self.repulsion.amplitude / self.attraction.amplitude * (b / a) ** (order + 1)
        return math.log(ratio) / (1.0 / a - 1.0 / b)

    def force_free_distance(self) -> float:
        """Return r0 [LU]: the root of the force."""
        return self.extremum_distance(0)

    @property
    def largest_tension(self) -> float:
        """The largest -f [FU], positive."""
        return -float(self.force(self.extremum_distance(1)))

    @property
    def steepest_rise(self) -> float:
        """The largest df/dr at r >= 0 [FU/LU]."""
        return float(self.force_slope(max(self.extremum_distance(2), 0.0)))

    def energy(self, distance: Floats | float) -> Floats:
        """Return V [FU LU], shape of `distance` [LU]."""
        return self.evaluate(distance)[0]

    def force(self, distance: Floats | float) -> Floats:
        """Return f = -dV/dr [FU], positive if repulsive, shape of `distance` [LU]."""
        return self.evaluate(distance)[1]

    def force_slope(self, distance: Floats | float) -> Floats:
        """Return df/dr [FU/LU], shape of `distance` [LU]."""
        return self.evaluate(distance)[2]

    def evaluate(self, distance: Floats | float) -> tuple[Floats, Floats, Floats]:
        """Return V [FU LU], f = -dV/dr [FU] and df/dr [FU/LU], each with the shape of `distance` [LU]."""
        r = np.asarray(distance)
        a = self.repulsion.range
        energy = self.repulsion.amplitude * np.exp(-r / a)
        force = energy / a
        slope = -force / a
        b = self.attraction.range
        attraction = self.attraction.amplitude * np.exp(-r / b)
        return energy - attraction, force - attraction / b, slope + attraction / b**2
