"""Adhesive contact of z = c r^n on an elastic half space in closed form: JKR for n = 2, the cone of Maugis and Barquins
for n = 1.

    d = kappa_n c a^n - sqrt(2 pi W a/E*),    F = 2n/(n+1) kappa_n c E* a^(n+1) - sqrt(8 pi E* W a^3)

Under a fixed load the tension is largest, and under fixed grips d least, where the derivative by a vanishes; both are
powers of W. Valid for a short range of the attraction and small slopes. Sources: D. Maugis, M. Barquins, J. Phys. Lett.
42 (1981) L95; V. L. Popov, M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction (2015),
section 4.4. Any consistent units.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

HALVINGS = 200
"""Of the bracket of a radius: below round-off."""


@dataclass(frozen=True)
class AdhesivePower:
    """One indenter.

    Args:
        coefficient: c > 0 [length^(1-n)]: 1/2R of a paraboloid.
        exponent: n >= 1.
        contact_modulus: E* > 0 [stress].
        work_of_adhesion: W > 0 [force/length].

    Raises:
        ValueError: if one of them is out of its range.
    """

    coefficient: float
    exponent: float
    contact_modulus: float
    work_of_adhesion: float

    def __post_init__(self) -> None:
        """Check the ranges."""
        if not min(self.coefficient, self.contact_modulus, self.work_of_adhesion) > 0.0 or self.exponent < 1.0:
            raise ValueError(
                "coefficient, contact_modulus and work_of_adhesion must be positive, the exponent at least 1"
            )

    @classmethod
    def with_zero_load_radius(
        cls, coefficient: float, exponent: float, contact_modulus: float, radius: float
    ) -> AdhesivePower:
        """The indenter with the work of adhesion with which a contact without load has this radius > 0 [length].

        That radius is a power of W: W^(1/(2n - 1)).
        """
        unit = cls(coefficient, exponent, contact_modulus, 1.0).zero_load_radius()
        work = (radius / unit) ** (2.0 * exponent - 1.0)
        return cls(coefficient, exponent, contact_modulus, work)

    @property
    def _rise(self) -> float:
        """kappa_n c, kappa_n = (sqrt(pi)/2) n Gamma(n/2)/Gamma((n+1)/2)."""
        n = self.exponent
        kappa = 0.5 * math.sqrt(math.pi) * n * math.exp(math.lgamma(0.5 * n) - math.lgamma(0.5 * (n + 1.0)))
        return kappa * self.coefficient

    def displacement(self, contact_radius: float) -> float:
        """Return d(a) [length]; a >= 0 [length]."""
        a = contact_radius
        stretch = math.sqrt(2.0 * math.pi * self.work_of_adhesion * a / self.contact_modulus)
        return float(self._rise * a**self.exponent - stretch)

    def force(self, contact_radius: float) -> float:
        """Return F(a) [force], positive in compression; a >= 0 [length]."""
        a, n, e = contact_radius, self.exponent, self.contact_modulus
        pressed = 2.0 * n / (n + 1.0) * self._rise * e * a ** (n + 1.0)
        return float(pressed - math.sqrt(8.0 * math.pi * e * self.work_of_adhesion * a**3))

    def critical_radius(self) -> float:
        """Return a where a fixed load pulls off [length]: dF/da = 0."""
        return self._power(1.5 / (2.0 * self.exponent))

    def zero_load_radius(self) -> float:
        """Return a with F(a) = 0 [length]."""
        return self._power((self.exponent + 1.0) / (2.0 * self.exponent))

    def fixed_grips_radius(self) -> float:
        """Return a where a prescribed displacement pulls off [length]: dd/da = 0."""
        return self._power(0.25 / self.exponent)

    def pull_off_force(self) -> float:
        """Return F_A [force], a positive magnitude."""
        return -self.force(self.critical_radius())

    def contact_radius(self, force: float) -> float:
        """Return the stable a with F(a) = `force` [length].

        Raises:
            ValueError: if the tension exceeds the pull-off force.
        """
        low = self.critical_radius()
        if force < self.force(low):
            raise ValueError(f"no equilibrium: the tension exceeds the pull-off force {self.pull_off_force()}")
        return self._where(self.force, force, low)

    def radius_at(self, displacement: float) -> float:
        """Return the stable a with d(a) = `displacement` under fixed grips [length].

        Raises:
            ValueError: if the bodies have parted before.
        """
        low = self.fixed_grips_radius()
        if displacement < self.displacement(low):
            raise ValueError(f"the bodies part at the displacement {self.displacement(low)}")
        return self._where(self.displacement, displacement, low)

    def _power(self, factor: float) -> float:
        """a with kappa_n c a^(n-1/2) = factor sqrt(8 pi W/E*)."""
        rise = factor * math.sqrt(8.0 * math.pi * self.work_of_adhesion / self.contact_modulus)
        return float((rise / self._rise) ** (1.0 / (self.exponent - 0.5)))

    def _where(self, curve: Callable[[float], float], wanted: float, low: float) -> float:
        high = 2.0 * low
        while curve(high) < wanted:
            high *= 2.0
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if curve(middle) < wanted else (low, middle)
        return 0.5 * (low + high)
