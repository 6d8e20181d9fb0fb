"""JKR: a soft sphere that adheres to a flat, F(a) = 4 E* a^3/3R - (8 pi E* W a^3)^(1/2).

W = 2 gamma is the work of adhesion of two equal surfaces, gamma the surface energy of one of them; Geike and Popov
(2007) call gamma the work of adhesion. Forces are positive in compression. Valid for a Tabor number well above 1 and
a << R. Source: K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301. Any consistent units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contact1d.analysis.theory.adhesive_pair import AdhesivePair, Floats

CRITICAL_RADIUS_RATIO = 0.25 ** (1.0 / 3.0)
"""a_cr/a_0 where a fixed load pulls off, (1/4)^(1/3) = 0.630."""
FIXED_GRIPS_RADIUS_RATIO = (1.0 / 36.0) ** (1.0 / 3.0)
"""a_cr/a_0 where a prescribed displacement pulls off, (1/36)^(1/3) = 0.303."""
FIXED_GRIPS_FORCE_RATIO = -5.0 / 9.0
"""F/F_A where a prescribed displacement pulls off."""


def work_of_adhesion(surface_energy: float) -> float:
    """Return W = 2 gamma of two equal surfaces [force/length]; `surface_energy` gamma of one side [force/length]."""
    return 2.0 * surface_energy


@dataclass(frozen=True)
class Jkr(AdhesivePair):
    """One adhesive sphere."""

    def pull_off_force(self) -> float:
        """Return (3/2) pi W R = 3 pi gamma R, the largest tension held under a fixed load, as a magnitude [force]."""
        return 1.5 * math.pi * self.work_of_adhesion * self.radius

    def force(self, contact_radius: Floats | float) -> Floats:
        """Return F(a) = 4 E* a^3/3R - sqrt(8 pi E* W a^3) [force], shape of `contact_radius` a >= 0 [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        e, w = self.contact_modulus, self.work_of_adhesion
        return np.asarray(4.0 * e * a**3 / (3.0 * self.radius) - np.sqrt(8.0 * math.pi * e * w * a**3))

    def contact_radius(self, force: Floats | float) -> Floats:
        """Return the stable a(F): a^3 = (3R/4E*) [F + 2 F_A + sqrt(4 F_A F + 4 F_A^2)] [length].

        Args:
            force: F >= -F_A, any shape [force].

        Raises:
            ValueError: if the tension exceeds the pull-off force.
        """
        f, f_a = np.asarray(force, dtype=np.float64), self.pull_off_force()
        if np.any(f < -f_a):
            raise ValueError(f"no equilibrium: the tension exceeds the pull-off force {f_a}")
        cube = f + 2.0 * f_a + 2.0 * np.sqrt(f_a * (f + f_a))
        return np.cbrt(0.75 * self.radius / self.contact_modulus * cube)

    def displacement(self, contact_radius: Floats | float) -> Floats:
        """Return d(a) = a^2/R - sqrt(2 pi W a/E*) [length], shape of `contact_radius` a >= 0 [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        return np.asarray(
            a**2 / self.radius - np.sqrt(2.0 * math.pi * self.work_of_adhesion * a / self.contact_modulus)
        )

    def stress(self, place: Floats | float, contact_radius: float) -> Floats:
        """Return p = (2E*a/pi R) sqrt(1 - r^2/a^2) - sqrt(2E*W/pi a)/sqrt(1 - r^2/a^2) [stress], > 0 in compression.

        Hertz's pressure of this a and a flat punch's tension; its integral over the circle is F(a).

        Args:
            place: r, any shape [length].
            contact_radius: a > 0 [length].

        Raises:
            ValueError: outside 0 <= r < a: the tension has no bound at the edge.
        """
        r, a, e = np.asarray(place, dtype=np.float64), contact_radius, self.contact_modulus
        if np.any((r < 0.0) | (r >= a)):
            raise ValueError(f"the stress is asked for outside 0 <= r < a = {a}")
        root = np.sqrt(1.0 - (r / a) ** 2)
        tension = math.sqrt(2.0 * e * self.work_of_adhesion / (math.pi * a))
        return np.asarray(2.0 * e * a / (math.pi * self.radius) * root - tension / root)

    def mean_pressure(self, contact_radius: Floats | float) -> Floats:
        """Return F(a)/(pi a^2) [stress], positive in compression; shape of `contact_radius` a > 0 [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        return np.asarray(self.force(a) / (math.pi * a**2))

    def zero_load_radius(self) -> float:
        """Return a_0 = (9 pi W R^2 / 2 E*)^(1/3) [length]."""
        return math.cbrt(4.5 * math.pi * self.work_of_adhesion * self.radius**2 / self.contact_modulus)

    def critical_radius(self) -> float:
        """Return a where a fixed load pulls off, (9 pi W R^2 / 8 E*)^(1/3) [length]: dF/da = 0."""
        return CRITICAL_RADIUS_RATIO * self.zero_load_radius()

    def critical_radius_fixed_grips(self) -> float:
        """Return a where a prescribed displacement pulls off, (pi W R^2 / 8 E*)^(1/3) [length]: dd/da = 0."""
        return FIXED_GRIPS_RADIUS_RATIO * self.zero_load_radius()


def identified_surface_energy(adhesion_force: float, radius: float) -> float:
    """Return gamma = F_A/(3 pi R) [force/length]: Eq. (9) of Geike and Popov (2007), the law of JKR read backwards.

    Args:
        adhesion_force: F_A, a positive magnitude [force].
        radius: R [length].

    Raises:
        ValueError: if one of them is not positive.
    """
    if not (adhesion_force > 0.0 and radius > 0.0):
        raise ValueError(f"adhesion_force and radius must be positive, got {adhesion_force} and {radius}")
    return adhesion_force / (3.0 * math.pi * radius)


def identified_contact_modulus(adhesion_force: float, radius: float, zero_load_radius: float) -> float:
    """Return E* = 3 F_A R/a_0^3 [stress]: Eq. (9) of Geike and Popov (2007); other arguments as above.

    Args:
        adhesion_force: F_A, a positive magnitude [force].
        radius: R [length].
        zero_load_radius: a_0 [length].

    Raises:
        ValueError: if one of them is not positive.
    """
    if not (adhesion_force > 0.0 and radius > 0.0 and zero_load_radius > 0.0):
        raise ValueError(
            "adhesion_force, radius and zero_load_radius must be positive, "
            f"got {adhesion_force}, {radius} and {zero_load_radius}"
        )
    return 3.0 * adhesion_force * radius / zero_load_radius**3


def jkr_reduced_force(reduced_radius: Floats | float) -> Floats:
    """Return F/F_A = 4 x^3 - 4 x^(3/2), x = a/a_0 >= 0, shape of `reduced_radius`: free of any parameter."""
    x = np.asarray(reduced_radius, dtype=np.float64)
    return np.asarray(4.0 * x**3 - 4.0 * x**1.5)
