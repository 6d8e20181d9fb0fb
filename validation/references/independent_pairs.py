"""The particle model in closed form where pairs are independent: F(G0) = (sqrt(2R)/s) int f(G) (G - G0)^(-1/2) dG.

Without neighbour springs, and where a particle feels only its opposite, the undeformed gap G and the distance r of a
pair obey G = r - 2 f(r)/k (a repulsion f shortens both springs by f/k). A parabola has G(x) = G0 + x^2/2R, so the sum
over particles s apart is, in the limit of many, F = (1/s) int f dx = (2 sqrt(2R)/s) int_0^inf f(G0 + y^2) dy with
y^2 = G - G0. The displacement is d = r0 - G0, and the tension is largest at a = sqrt(2R (G_m - G0)), G_m the gap of
the largest tension of one pair: a pure property of the pair, so F_A and a_0 both go as sqrt(R).

The trapezoidal rule is used for the integral: the integrand is even and smooth, where it converges exponentially. So
does the sum over particles itself, which is why it may stand for the integral once the edge spans a few particles.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from validation.references.interaction import Floats, PairInteraction

TAIL = 40.0
"""The integral ends where the undeformed gap exceeds the force-free one by this many ranges: exp(-40) = 4e-18."""
NODES = 800
"""Points of the trapezoidal rule."""
INVERSION_STEPS = 200
"""Limit on the bisection for the distance of a pair; the interval is at the round-off after about 60."""
EDGE = 1e-9
"""Distance from that gap over the longest range: round-off must not step over it."""
SCAN = 100
"""Points of the first search for the largest tension."""


@dataclass(frozen=True)
class IndependentPairs:
    """Two chains of independent pairs with attraction, parabola against flat, in the limit of many particles.

    Args:
        interaction: of an opposite pair.
        bulk_stiffness: k of a particle on either body [FU/LU].
        radius: R of the parabola x^2/2R [LU].
        spacing: s [LU].

    Raises:
        ValueError: where a pair snaps: its force falls more steeply than k/2, the springs in
            series, so r(G) folds back and loading and unloading differ.
    """

    interaction: PairInteraction
    bulk_stiffness: float
    radius: float
    spacing: float = 1.0

    def __post_init__(self) -> None:
        """Check that the pair law is one to one."""
        steepest = self.interaction.steepest_rise
        if steepest >= 0.5 * self.bulk_stiffness:
            raise ValueError(f"pairs snap: steepest tension {steepest:.4g} FU/LU >= k/2")

    def undeformed_gap(self, distance: Floats | float) -> Floats:
        """Return G = r - 2 f(r)/k [LU], shape of `distance` r [LU]."""
        r = np.asarray(distance)
        return r - 2.0 * self.interaction.force(r) / self.bulk_stiffness

    def pair_distance(self, gap: Floats | float) -> Floats:
        """Return r(G) >= 0 by bisection to round-off [LU].

        Args:
            gap: undeformed gap G, any shape [LU].

        Raises:
            ValueError: if G < -2 f(0)/k, where the pair is pushed through its finite core.
        """
        g = np.asarray(gap, dtype=np.float64)
        if np.any(g < self.undeformed_gap(0.0)):
            raise ValueError("the gap is so small that the particles are pushed through each other")
        low = np.maximum(0.0, g - 2.0 * self.interaction.largest_tension / self.bulk_stiffness)
        high = np.maximum(g, self.interaction.force_free_distance())
        for _ in range(INVERSION_STEPS):
            middle = 0.5 * (low + high)
            if np.all((middle == low) | (middle == high)):
                break
            below = self.undeformed_gap(middle) < g
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return 0.5 * (low + high)

    def force(self, displacement: float) -> float:
        """Return F(d) [FU], compression positive; `displacement` d [LU], zero where the apexes are r0 apart."""
        return self._integral(displacement, self.interaction.force)

    def stiffness(self, displacement: float) -> float:
        """Return dF/dd [FU/LU] from df/dG = f'(r) / (1 - 2 f'(r)/k); `displacement` d [LU]."""

        def slope(r: Floats) -> Floats:
            steepness = self.interaction.force_slope(r)
            return steepness / (1.0 - 2.0 * steepness / self.bulk_stiffness)

        return -self._integral(displacement, slope)

    def contact_radius(self, displacement: float) -> float:
        """Return a = sqrt(2R (G_m - G0)) [LU]; 0 where even the apexes are beyond G_m; `displacement` d [LU]."""
        largest_tension = float(self.undeformed_gap(self.interaction.extremum_distance(1)))
        depth = largest_tension - (self.interaction.force_free_distance() - displacement)
        return math.sqrt(2.0 * self.radius * max(depth, 0.0))

    def critical_displacement(self) -> float:
        """Return the d of the largest tension [LU], the root of dF/dd there."""
        reach = 10.0 * self.interaction.longest_range
        grid = np.linspace(-reach, min(reach, self._deepest()), SCAN)
        lowest = int(np.argmin([self.force(d) for d in grid]))
        lowest = min(max(lowest, 1), SCAN - 2)
        return float(brentq(self.stiffness, grid[lowest - 1], grid[lowest + 1], xtol=1e-14))

    def adhesion_force(self) -> float:
        """Return F_A = -min F(d), a positive magnitude [FU]; proportional to sqrt(R)."""
        return -self.force(self.critical_displacement())

    def critical_radius(self) -> float:
        """Return a at the largest tension [LU]; proportional to sqrt(R)."""
        return self.contact_radius(self.critical_displacement())

    def zero_load_displacement(self) -> float:
        """Return the d at which F = 0 in contact [LU].

        Raises:
            ValueError: if the force stays a tension until particles are pushed through each other.
        """
        high = self._deepest()
        if self.force(high) <= 0.0:
            raise ValueError("the finite core gives way before the force is compressive")
        return float(brentq(self.force, self.critical_displacement(), high, xtol=1e-14))

    def zero_load_radius(self) -> float:
        """Return a_0, the radius of maximum tensile stress at F = 0 [LU]; proportional to sqrt(R)."""
        return self.contact_radius(self.zero_load_displacement())

    def _deepest(self) -> float:
        """Return the d at which the apexes are all but pushed through their finite core [LU]."""
        gap = float(self.undeformed_gap(0.0)) + EDGE * self.interaction.longest_range
        return self.interaction.force_free_distance() - gap

    def _integral(self, displacement: float, integrand: Callable[[Floats], Floats]) -> float:
        """Return (2 sqrt(2R)/s) int_0^inf h(r(G0 + y^2)) dy by the trapezoidal rule."""
        apex_gap = self.interaction.force_free_distance() - displacement
        end = self.interaction.force_free_distance() + TAIL * self.interaction.longest_range
        y = np.linspace(0.0, math.sqrt(max(end - apex_gap, self.interaction.longest_range)), NODES)
        values = integrand(self.pair_distance(apex_gap + y**2))
        return 2.0 * math.sqrt(2.0 * self.radius) / self.spacing * float(np.trapezoid(values, y))
