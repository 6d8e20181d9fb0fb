"""Thermal averages of independent pairs under a load, by quadrature of Boltzmann's factor; no dynamics.

A pair at the undeformed gap G has the energy V(r) + (k/4)(r - G)^2 as a function of its distance r (the other
coordinate of its particles is free of V and adds a constant), hence z(G) = int exp(-(V + (k/4)(r - G)^2)/kT) dr. The
plate, whose place d moves all gaps G_i = r0 + h_i - d, has under the load F the weight
w(d) = exp(F d/kT) prod_i z(G_i), so <d> = int d w / int w, and <F_contact> = F. As kT -> 0 this is the equilibrium.
"""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from validation.references.interaction import Floats, PairInteraction

SPREAD = 9.0
"""Standard deviations of a distance on its springs to either side of its gap: exp(-40)."""
FINE, MOST, GAPS = 0.6, 8000, 1500
"""Step of the distances over the narrowest thermal width, where the trapezoidal rule is exact to exp(-2 (pi/0.6)^2);
how many distances there may be; gaps at which ln z is tabulated, between which a cubic spline is exact to 1e-9."""


class BoltzmannPairs(NamedTuple):
    """Pairs with given heights at a temperature.

    Args:
        interaction: of an opposite pair.
        bulk_stiffness: k of a particle on either body [FU/LU].
        heights: of the upper particles over the apex, shape (N,) [LU].
        temperature: kT [FU LU], > 0; the colder, the more distances.
    """

    interaction: PairInteraction
    bulk_stiffness: float
    heights: Floats
    temperature: float

    def log_partition(self, gap: Floats) -> Floats:
        """Return ln z of pairs at the undeformed gaps `gap`, shape (n,) [LU]; an additive constant is left out.

        Distances down to 0 count: the core is finite, and what lies behind it is another branch.
        """
        spread = SPREAD * np.sqrt(2.0 * self.temperature / self.bulk_stiffness)
        pull = 2.0 * abs(self.interaction.force(0.0)) / self.bulk_stiffness
        low = np.maximum(gap - spread - 2.0 * self.interaction.largest_tension / self.bulk_stiffness, 0.0)
        beyond = np.maximum(-gap, 0.0) + 8.0 * self.interaction.longest_range
        high = np.maximum(gap + spread, 0.0) + np.minimum(pull, beyond)
        steepest = abs(self.interaction.force_slope(0.0)) + 0.5 * self.bulk_stiffness
        nodes = int(np.max(high - low) / (FINE * np.sqrt(self.temperature / steepest))) + 2
        if nodes > MOST:
            raise ValueError(
                f"a temperature of {self.temperature:g} needs {nodes} distances: too cold for this integral"
            )
        r = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, nodes)[None, :]
        energy = self.interaction.energy(r) + 0.25 * self.bulk_stiffness * (r - gap[:, None]) ** 2
        least = energy.min(axis=1, keepdims=True)
        weight = np.trapezoid(np.exp(-(energy - least) / self.temperature), r, axis=1)
        return np.asarray(np.log(weight) - least[:, 0] / self.temperature)

    def displacement(self, load: float, near: float, width: float) -> tuple[float, float]:
        """Return <d> and its standard deviation in time [LU].

        Args:
            load: F, compression positive [FU].
            near: middle of the displacements over which is integrated [LU].
            width: half of their interval [LU]; many standard deviations, and none beyond which the bodies part.
        """
        d = np.linspace(near - width, near + width, GAPS)
        rest = self.interaction.force_free_distance()
        ends = rest + np.array([np.min(self.heights) - d[-1], np.max(self.heights) - d[0]])
        gap = np.linspace(ends[0], ends[1], GAPS)
        table = CubicSpline(gap, self.log_partition(gap))
        log_weight = load * d / self.temperature
        for height in self.heights:
            log_weight = log_weight + table(rest + height - d)
        weight = np.exp(log_weight - log_weight.max())
        mean = np.sum(d * weight) / np.sum(weight)
        return mean, float(np.sqrt(np.sum((d - mean) ** 2 * weight) / np.sum(weight)))
