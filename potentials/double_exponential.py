"""A pair potential with a finite core, V(r) = A exp(−r/a) − B exp(−r/b) (Geike and Popov 2007, Section 3.1)."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class PairPotential(ABC):
    """V(r) of two particles, with its derivatives."""

    @abstractmethod
    def derivative(self, order: int, r: ArrayLike) -> Array:
        """Return (−1)ⁿ dⁿV/drⁿ [FU·LU/LUⁿ] of the `order` n ≥ 0 at distances r ≥ 0 [LU]; same shape as r."""

    def energy(self, r: ArrayLike) -> Array:
        """Return V(r) [FU·LU] at distances r ≥ 0 [LU]; same shape as r."""
        return self.derivative(0, r)

    def force(self, r: ArrayLike) -> Array:
        """Return f(r) = −V′(r) [FU] at distances r ≥ 0 [LU]; same shape as r.

        It is positive where the particles repel each other.
        """
        return self.derivative(1, r)

    def stiffness(self, r: ArrayLike) -> Array:
        """Return V″(r) = −f′(r) [FU/LU] at distances r ≥ 0 [LU]; same shape as r.

        It is negative where a pair can become unstable.
        """
        return self.derivative(2, r)


@dataclass(frozen=True)
class Exponential(PairPotential):
    """One term of the potential, amplitude·exp(−r/range).

    Attributes:
        amplitude: energy A at r = 0 [FU·LU], > 0.
        range: decay length a [LU], > 0.
    """

    amplitude: float
    range: float

    def derivative(self, order: int, r: ArrayLike) -> Array:
        """Return (−1)ⁿ dⁿV/drⁿ = (A/aⁿ) exp(−r/a) [FU·LU/LUⁿ] of the `order` n at distances r [LU]; same shape as r."""
        return np.asarray(self.amplitude * np.exp(-np.asarray(r, dtype=float) / self.range)) / self.range**order


@dataclass(frozen=True)
class DoubleExponential(PairPotential):
    """V(r) = repulsion − attraction; without an attraction it is purely repulsive.

    Args:
        repulsion: the term A exp(−r/a).
        attraction: the term B exp(−r/b), or None. With it the potential must repel at r = 0 (A/a > B/b) and
            attract far away (b > a), so that exactly one distance is force-free.

    Raises:
        ValueError: if the two terms leave no force-free distance.
    """

    repulsion: Exponential
    attraction: Exponential | None = None

    def __post_init__(self) -> None:
        """Check that exactly one distance is force-free; nothing without an attraction.

        Raises:
            ValueError: the attraction does not reach further than the repulsion, or the repulsion does not prevail at r
                = 0.
        """
        if self.attraction is None:
            return
        if self.attraction.range <= self.repulsion.range:
            raise ValueError("the attraction must reach further than the repulsion (b > a)")
        if self.attraction.force(0.0) >= self.repulsion.force(0.0):
            raise ValueError("the repulsion must prevail at r = 0 (A/a > B/b)")

    def derivative(self, order: int, r: ArrayLike) -> Array:
        """Return (−1)ⁿ dⁿV/drⁿ [FU·LU/LUⁿ] of the `order` n at distances r [LU]; same shape as r.

        It is the derivative of the repulsion minus that of the attraction.
        """
        repulsion = self.repulsion.derivative(order, r)
        return repulsion if self.attraction is None else repulsion - self.attraction.derivative(order, r)

    @property
    def formula(self) -> str:
        """V(r) as text, "A exp(-r/a) - B exp(-r/b)" with numbers to 17 significant digits in place of these letters.

        Amplitudes A and B are in FU·LU, ranges a and b in LU; without an attraction it is "A exp(-r/a)".
        """
        terms = f"{self.repulsion.amplitude:.17g} exp(-r/{self.repulsion.range:.17g})"
        if self.attraction is not None:
            terms += f" - {self.attraction.amplitude:.17g} exp(-r/{self.attraction.range:.17g})"
        return terms

    @property
    def longest_range(self) -> float:
        """Decay length [LU] of the term that dominates at large distance: of the attraction, or of the repulsion
        without one.
        """
        return self.repulsion.range if self.attraction is None else self.attraction.range

    def force_free_distance(self) -> float:
        """Return the distance r₀ [LU] > 0 with f(r₀) = 0: r₀ = ln[(A/a)/(B/b)] / (1/a − 1/b).

        Raises:
            ValueError: the potential has no attraction, and so is force-free nowhere.
        """
        if self.attraction is None:
            raise ValueError("an interaction without attraction has no force-free distance")
        ratio = float(self.repulsion.force(0.0) / self.attraction.force(0.0))
        return math.log(ratio) / (1.0 / self.repulsion.range - 1.0 / self.attraction.range)

    def cutoff_for(self, share: float) -> float:
        """Return the distance r₀ + b ln(1/share) [LU], beyond which the force is small.

        There it is about `share` (relative, > 0) of the force that the attraction alone, of range b, has at the
        force-free distance r₀. Without attraction r₀ is 0, and b the range of the repulsion. A share above 1 gives less
        than r₀.
        """
        start = self.force_free_distance() if self.attraction is not None else 0.0
        return start + self.longest_range * math.log(1.0 / share)
