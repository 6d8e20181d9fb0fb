"""The force between two particles of opposite bodies, V(r) = A exp(-r/a) - B exp(-r/b), for the references.

This is a second, separate writing of the law; the program's own tables are not read here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

RAMP_FRACTION = 0.01
"""Width of the ramp at a cutoff over (force at the cutoff) / (softest spring)."""


@dataclass(frozen=True)
class Exponential:
    """One term, amplitude * exp(-r / range).

    Args:
        amplitude: energy at r = 0 [FU LU], positive.
        range: decay length [LU], positive.

    Raises:
        ValueError: if either is not a positive finite number.
    """

    amplitude: float
    range: float

    def __post_init__(self) -> None:
        """Check both numbers."""
        for name, value in (("amplitude", self.amplitude), ("range", self.range)):
            if not (math.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} must be positive and finite, got {value}")


@dataclass(frozen=True)
class PairInteraction:
    """V(r) = A exp(-r/a) - B exp(-r/b); without attraction the law ends at a cutoff.

    With attraction the law has no cutoff. Without it, V is shifted to be zero at the cutoff, and the force, which
    would jump there, falls to zero linearly over the last `ramp` of distance. Without the ramp a pair near the
    cutoff may have no equilibrium at all: its springs hold it just where the force jumps.

    Args:
        repulsion: A [FU LU] and a [LU].
        attraction: B [FU LU] and b [LU], or None. Must be weaker and longer: b > a and B/b < A/a.
        cutoff: [LU]; must be given without attraction and must be absent with it.
        ramp: [LU]; only with a cutoff. None: no ramp, the force jumps.

    Raises:
        ValueError: if the cutoff does not go with the attraction, or if no distance r > 0 is force-free.
    """

    repulsion: Exponential
    attraction: Exponential | None = None
    cutoff: float | None = None
    ramp: float | None = None

    def __post_init__(self) -> None:
        """Check that a force-free distance exists."""
        if self.attraction is None:
            if self.cutoff is None or not (math.isfinite(self.cutoff) and self.cutoff > 0.0):
                raise ValueError("without attraction a positive cutoff must be given: it defines touch")
            if self.ramp is not None and not 0.0 < self.ramp < self.cutoff:
                raise ValueError(f"ramp must lie between 0 and the cutoff, got {self.ramp}")
            return
        if self.cutoff is not None or self.ramp is not None:
            raise ValueError("with attraction the reference has no cutoff and no ramp")
        if self.attraction.range <= self.repulsion.range:
            raise ValueError("the attraction must reach further than the repulsion")
        if self.extremum_distance(0) <= 0.0:
            raise ValueError("the attraction is stronger than the repulsion at contact: no force-free distance")

    @property
    def shortest_range(self) -> float:
        """The range of the repulsion a [LU], the shorter of the two."""
        return self.repulsion.range

    @property
    def longest_range(self) -> float:
        """The longer of the two ranges [LU]."""
        return self.repulsion.range if self.attraction is None else self.attraction.range

    def extremum_distance(self, order: int) -> float:
        """Return the distance [LU] at which the derivative of the force of this order vanishes.

        The root of A/a^n exp(-r/a) = B/b^n exp(-r/b), n = order + 1: ln[(A/B)(b/a)^n] / (1/a - 1/b).

        Args:
            order: 0 the force-free distance, 1 the distance of the largest tension, 2 that of the steepest tension.

        Raises:
            ValueError: without attraction, where the force has no extremum.
        """
        if self.attraction is None:
            raise ValueError("a repulsion alone has no extremum of the force")
        a, b = self.repulsion.range, self.attraction.range
        ratio = self.repulsion.amplitude / self.attraction.amplitude * (b / a) ** (order + 1)
        return math.log(ratio) / (1.0 / a - 1.0 / b)

    def force_free_distance(self) -> float:
        """Return r0 [LU]: the root of the force, or the cutoff where there is no attraction."""
        if self.attraction is None:
            assert self.cutoff is not None
            return self.cutoff
        return self.extremum_distance(0)

    def energy(self, distance: Floats) -> Floats:
        """Return V [FU LU], shape of `distance` [LU]."""
        return self.evaluate(distance)[0]

    def force(self, distance: Floats) -> Floats:
        """Return f = -dV/dr [FU], positive if repulsive, shape of `distance` [LU]."""
        return self.evaluate(distance)[1]

    def force_slope(self, distance: Floats) -> Floats:
        """Return df/dr [FU/LU], shape of `distance` [LU]."""
        return self.evaluate(distance)[2]

    def evaluate(self, distance: Floats) -> tuple[Floats, Floats, Floats]:
        """Return V [FU LU], f = -dV/dr [FU] and df/dr [FU/LU], each with the shape of `distance` [LU]."""
        r = np.asarray(distance, dtype=np.float64)
        a = self.repulsion.range
        energy = self.repulsion.amplitude * np.exp(-r / a)
        force = energy / a
        slope = -force / a
        if self.attraction is None:
            return self._truncate(r, energy, force, slope)
        b = self.attraction.range
        attraction = self.attraction.amplitude * np.exp(-r / b)
        return energy - attraction, force - attraction / b, slope + attraction / b**2

    def _truncate(self, r: Floats, energy: Floats, force: Floats, slope: Floats) -> tuple[Floats, Floats, Floats]:
        """End the repulsion at the cutoff c: f = f1 (c - r)/w, V = f1 (c - r)^2/2w over the ramp of width w."""
        assert self.cutoff is not None
        width = 0.0 if self.ramp is None else self.ramp
        start_energy = self.repulsion.amplitude * math.exp(-(self.cutoff - width) / self.repulsion.range)
        start_force = start_energy / self.repulsion.range
        shifted = energy - start_energy + 0.5 * start_force * width
        inside, on_ramp = r < self.cutoff - width, (r >= self.cutoff - width) & (r < self.cutoff)
        left = np.where(on_ramp, self.cutoff - r, 0.0)
        steepness = start_force / width if width > 0.0 else 0.0
        return (
            np.where(inside, shifted, 0.5 * steepness * left**2),
            np.where(inside, force, steepness * left),
            np.where(inside, slope, np.where(on_ramp, -steepness, 0.0)),
        )

    def with_ramp(self, stiffness: float) -> PairInteraction:
        """Return the law with a ramp as narrow as a hundredth of f(cutoff)/stiffness; unchanged with attraction.

        Args:
            stiffness: of the springs that hold the particles [FU/LU]. The ramp then moves no particle by more than a
                hundredth of what the force at the cutoff does, which a sensible cutoff makes negligible itself.
        """
        if self.attraction is not None or self.ramp is not None:
            return self
        assert self.cutoff is not None
        end_force = self.repulsion.amplitude / self.repulsion.range * math.exp(-self.cutoff / self.repulsion.range)
        width = min(RAMP_FRACTION * end_force / stiffness, 0.5 * self.cutoff)
        return PairInteraction(self.repulsion, None, self.cutoff, max(width, 1e-12 * self.cutoff))
