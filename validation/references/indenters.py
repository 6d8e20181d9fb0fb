"""Axisymmetric indenters z = c r^n on a half space, with adhesion or without: JKR is n = 2, c = 1/2R.

By the method of dimensionality reduction, g(a) = kappa c a^n, kappa = n int_0^(pi/2) sin^(n-1) phi dphi by quadrature,

    d(a) = g(a) - sqrt(2 pi a W/E*),    F(a) = 2 E* [a d - g(a) a/(n + 1)]

and all marks by search on F(a) and d(a), so that nothing is shared with the closed forms that users see.
Sources: Johnson, Kendall and Roberts (1971); Maugis and Barquins (1983); Popov and Hess (2015). Any consistent units.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from validation.references.numerics import Floats, integral, rising

STEP = 1e-4
"""Relative, of the difference whose root is a minimum: a stationary place is then exact to its square."""


class Marks(ABC):
    """Radii and forces of a contact that d(a) and F(a) give by search; with adhesion both fall before they rise."""

    @abstractmethod
    def displacement(self, radius: float, /) -> Floats | float:
        """d(a) [length]; a >= 0 [length]."""

    @abstractmethod
    def force(self, radius: float, /) -> Floats | float:
        """F(a) [force], positive in compression; a >= 0 [length]."""

    def critical_radius(self) -> float:
        """a of the largest tension [length], dF/da = 0."""
        return rising(lambda a: _slope(self.force, a), self.zero_load_radius())

    def fixed_grips_radius(self) -> float:
        """a at which the bodies part under a prescribed displacement [length], dd/da = 0."""
        return rising(lambda a: _slope(self.displacement, a), self.zero_load_radius())

    def zero_load_radius(self) -> float:
        """a with F(a) = 0 [length]."""
        return rising(lambda a: float(self.force(a)), 1.0)

    def radius_under(self, force: float) -> float:
        """a of the stable contact that carries a force above that of pull-off [length]."""
        return rising(lambda a: float(self.force(a)) - force, self.critical_radius())

    def snap_in_radius(self) -> float:
        """a with d(a) = 0 [length]: bodies that touch snap into this contact."""
        return rising(lambda a: float(self.displacement(a)), self.zero_load_radius())

    def pull_off_force(self) -> float:
        """F_A [force], a positive magnitude."""
        return -float(self.force(self.critical_radius()))


@dataclass(frozen=True)
class Indenter(Marks):
    """One contact.

    Args:
        coefficient: c > 0 [length^(1-n)].
        exponent: n >= 1.
        contact_modulus: E* [stress].
        work_of_adhesion: W [force/length]; 0 without adhesion.
    """

    coefficient: float
    exponent: float
    contact_modulus: float
    work_of_adhesion: float = 0.0

    @cached_property
    def rise(self) -> float:
        """kappa c."""
        n = self.exponent
        return self.coefficient * n * integral(lambda phi: math.sin(phi) ** (n - 1.0), 0.0, 0.5 * math.pi)

    def displacement(self, radius: Floats | float) -> Floats:
        """d(a) [length]; a >= 0 [length]."""
        a = np.asarray(radius)
        stretch = np.sqrt(2.0 * math.pi * a * self.work_of_adhesion / self.contact_modulus)
        return self.rise * a**self.exponent - stretch

    def force(self, radius: Floats | float) -> Floats:
        """F(a) [force], positive in compression; a >= 0 [length]."""
        a, n = np.asarray(radius), self.exponent
        return 2.0 * self.contact_modulus * a * (self.displacement(a) - self.rise * a**n / (n + 1.0))


def jkr(radius: float, contact_modulus: float, work_of_adhesion: float) -> Indenter:
    """JKR's contact of a sphere R [length]."""
    return Indenter(0.5 / radius, 2.0, contact_modulus, work_of_adhesion)


def _slope(curve: Callable[[float], Floats | float], a: float) -> float:
    """Central difference, fourth order."""
    h = STEP * a
    near, far = (float(curve(a + k * h) - curve(a - k * h)) for k in (1.0, 2.0))
    return (8.0 * near - far) / (12.0 * h)
