"""DMT: a stiff sphere that adheres to a flat, F(a) = 4 E* a^3/3R - 2 pi W R: Hertz, pressed by attraction from outside.

W = 2 gamma is the work of adhesion of two equal surfaces. Forces are positive in compression. Valid where the
attraction does not deform the sphere, Tabor number below about 0.1, and a << R; `tabor` says which theory holds.
Source: B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314, in the form of
D. Maugis, J. Colloid Interface Sci. 150 (1992) 243. Any consistent units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contact1d.analysis.theory.adhesive_pair import AdhesivePair, Floats


@dataclass(frozen=True)
class Dmt(AdhesivePair):
    """One adhesive sphere."""

    def pull_off_force(self) -> float:
        """Return 2 pi W R, held at a = 0, as a magnitude [force]: that of rigid spheres (Bradley 1932)."""
        return 2.0 * math.pi * self.work_of_adhesion * self.radius

    def force(self, contact_radius: Floats | float) -> Floats:
        """Return F(a) = 4 E* a^3/3R - 2 pi W R [force], shape of `contact_radius` a >= 0 [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        return np.asarray(4.0 * self.contact_modulus * a**3 / (3.0 * self.radius) - self.pull_off_force())

    def contact_radius(self, force: Floats | float) -> Floats:
        """Return a(F) = [(3R/4E*)(F + 2 pi W R)]^(1/3) [length].

        Args:
            force: F >= -F_A, any shape [force].

        Raises:
            ValueError: if the tension exceeds the pull-off force.
        """
        f, f_a = np.asarray(force, dtype=np.float64), self.pull_off_force()
        if np.any(f < -f_a):
            raise ValueError(f"no equilibrium: the tension exceeds the pull-off force {f_a}")
        return np.cbrt(0.75 * self.radius / self.contact_modulus * (f + f_a))

    def displacement(self, contact_radius: Floats | float) -> Floats:
        """Return d(a) = a^2/R [length], that of Hertz; shape of `contact_radius` a >= 0 [length]."""
        return np.asarray(np.asarray(contact_radius, dtype=np.float64) ** 2 / self.radius)

    def zero_load_radius(self) -> float:
        """Return a_0 = (3 pi W R^2 / 2 E*)^(1/3) [length], 3^(-1/3) of JKR's."""
        return math.cbrt(1.5 * math.pi * self.work_of_adhesion * self.radius**2 / self.contact_modulus)


def dmt_reduced_force(reduced_radius: Floats | float) -> Floats:
    """Return F/F_A = x^3 - 1, x = a/a_0 >= 0, shape of `reduced_radius`: free of any parameter."""
    return np.asarray(np.asarray(reduced_radius, dtype=np.float64) ** 3 - 1.0)
