"""Rigid axisymmetric indenters on an elastic half space, F(a), d(a), a(d) and U(d) in closed form, with dU/dd = F.

Without adhesion the contact radius a is that where the pressure ends at zero. Power-law profile z = c r^n:
d = kappa_n c a^n, F = (2n/(n+1)) E* a d, kappa_n = (sqrt(pi)/2) n Gamma(n/2)/Gamma((n+1)/2); n = 1 the cone, n = 2 the
paraboloid of Hertz. With adhesion (W) a flat punch's tension is added at the same a, sqrt(8 pi E* W a^3): Kendall's
punch, and the cone of Maugis and Barquins. Valid for small slopes and a frictionless half space. Sources: I. N.
Sneddon, Int. J. Engng Sci. 3 (1965) 47; L. A. Galin (1953); K. Kendall, J. Phys. D 4 (1971) 1186; D. Maugis,
M. Barquins, J. Phys. Lett. 42 (1981) L95. Any consistent units; E* is the contact modulus [stress].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contact1d.analysis.theory.adhesive_pair import Floats

ROOT = 4.0 * np.finfo(np.float64).eps
"""Relative tolerance of a root: the least that the root finder takes."""


def _check_positive(**values: float) -> None:
    """Raise ValueError, with its name, for a value that is not positive and finite."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be positive and finite, got {value}")


def galin_factor(exponent: float) -> float:
    """Return kappa_n = (sqrt(pi)/2) n Gamma(n/2)/Gamma((n+1)/2): pi/2 for a cone, 2 for a paraboloid; `exponent` n."""
    n = exponent
    return 0.5 * math.sqrt(math.pi) * n * math.exp(math.lgamma(0.5 * n) - math.lgamma(0.5 * (n + 1.0)))


@dataclass(frozen=True)
class PowerLaw:
    """The indenter z = c r^n.

    Args:
        coefficient: c > 0 [length^(1-n)]: the slope of a cone (n = 1), 1/2R of a paraboloid (n = 2).
        exponent: n >= 1, any real number.
        contact_modulus: E* [stress].

    Raises:
        ValueError: if c or E* is not positive, or n < 1.
    """

    coefficient: float
    exponent: float
    contact_modulus: float

    def __post_init__(self) -> None:
        """Check the ranges."""
        _check_positive(coefficient=self.coefficient, exponent=self.exponent, contact_modulus=self.contact_modulus)
        if self.exponent < 1.0:
            raise ValueError(f"exponent must be at least 1, got {self.exponent}")

    def displacement(self, contact_radius: Floats | float) -> Floats:
        """Return d = kappa_n c a^n [length], shape of `contact_radius` a >= 0 [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        return np.asarray(galin_factor(self.exponent) * self.coefficient * a**self.exponent)

    def force(self, contact_radius: Floats | float) -> Floats:
        """Return F = (2n/(n+1)) E* a d(a) [force], shape of `contact_radius` a >= 0 [length]."""
        a, n = np.asarray(contact_radius, dtype=np.float64), self.exponent
        return np.asarray(2.0 * n / (n + 1.0) * self.contact_modulus * a * self.displacement(a))

    def contact_radius(self, displacement: Floats | float) -> Floats:
        """Return a = (d/(kappa_n c))^(1/n) [length], zero where d < 0; shape of `displacement` d [length]."""
        d = np.maximum(np.asarray(displacement, dtype=np.float64), 0.0)
        return np.asarray((d / (galin_factor(self.exponent) * self.coefficient)) ** (1.0 / self.exponent))

    def energy(self, displacement: Floats | float) -> Floats:
        """Return U = n/(2n+1) F d [force length], zero where d < 0; shape of `displacement` d [length]."""
        d, n = np.maximum(np.asarray(displacement, dtype=np.float64), 0.0), self.exponent
        return np.asarray(n / (2.0 * n + 1.0) * self.force(self.contact_radius(d)) * d)


def cone(slope: float, contact_modulus: float) -> PowerLaw:
    """Return the cone z = slope * r: d = (pi/2) slope a, F = (pi/2) E* slope a^2; `slope` [1], E* [stress]."""
    return PowerLaw(slope, 1.0, contact_modulus)


def paraboloid(radius: float, contact_modulus: float) -> PowerLaw:
    """Return the paraboloid z = r^2/2R, which is Hertz: d = a^2/R, F = 4E*a^3/3R; `radius` R [length], E* [stress]."""
    return PowerLaw(0.5 / radius, 2.0, contact_modulus)


def cone_pressure(place: Floats | float, contact_radius: float, slope: float, contact_modulus: float) -> Floats:
    """Return p(r) = (E* slope/2) arcosh(a/r) [stress], zero for r >= a; infinite, as a logarithm, at the tip.

    Args:
        place: r > 0 [length], any shape.
        contact_radius: a [length].
        slope: of z = slope * r [1].
        contact_modulus: E* [stress].
    """
    ratio = np.maximum(contact_radius / np.asarray(place, dtype=np.float64), 1.0)
    return np.asarray(0.5 * contact_modulus * slope * np.arccosh(ratio))


@dataclass(frozen=True)
class FlatPunch:
    """A flat-ended cylinder: the contact radius is given, so force and energy are functions of the displacement.

    Args:
        radius: a [length].
        contact_modulus: E* [stress].

    Raises:
        ValueError: if one of them is not positive.
    """

    radius: float
    contact_modulus: float

    def __post_init__(self) -> None:
        """Check the signs."""
        _check_positive(radius=self.radius, contact_modulus=self.contact_modulus)

    def force(self, displacement: Floats | float) -> Floats:
        """Return F = 2 E* a d [force], tension where d < 0; shape of `displacement` d [length]."""
        return np.asarray(2.0 * self.contact_modulus * self.radius * np.asarray(displacement, dtype=np.float64))

    def energy(self, displacement: Floats | float) -> Floats:
        """Return U = E* a d^2 [force length], shape of `displacement` d [length]."""
        return np.asarray(self.contact_modulus * self.radius * np.asarray(displacement, dtype=np.float64) ** 2)

    def pressure(self, place: Floats | float, displacement: float) -> Floats:
        """Return p(r) = (E* d/pi) (a^2 - r^2)^(-1/2) [stress], shape of `place` 0 <= r < a [length]; d [length]."""
        r = np.asarray(place, dtype=np.float64)
        return np.asarray(self.contact_modulus * displacement / (math.pi * np.sqrt(self.radius**2 - r**2)))

    def pull_off_force(self, work_of_adhesion: float) -> float:
        """Return Kendall's sqrt(8 pi E* W a^3), a positive magnitude [force]; `work_of_adhesion` W [force/length]."""
        return math.sqrt(8.0 * math.pi * self.contact_modulus * work_of_adhesion * self.radius**3)


@dataclass(frozen=True)
class Sphere:
    """The whole sphere, z = R - sqrt(R^2 - r^2), not its paraboloid; a << R gives Hertz.

    Linear elasticity holds for small slopes only, so its use near a = R is to test methods. F loses the digits
    (R/a)^2 to cancellation: for a > 1e-3 R it is good to 1e-10.

    Args:
        radius: R [length].
        contact_modulus: E* [stress].

    Raises:
        ValueError: if one of them is not positive.
    """

    radius: float
    contact_modulus: float

    def __post_init__(self) -> None:
        """Check the signs."""
        _check_positive(radius=self.radius, contact_modulus=self.contact_modulus)

    def displacement(self, contact_radius: Floats | float) -> Floats:
        """Return d = (a/2) ln((R+a)/(R-a)) = a artanh(a/R) [length], shape of `contact_radius` 0 <= a < R [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        return np.asarray(a * np.arctanh(a / self.radius))

    def force(self, contact_radius: Floats | float) -> Floats:
        """Return F = E* [(R^2+a^2)/2 ln((R+a)/(R-a)) - a R] [force], shape of `contact_radius` 0 <= a < R [length]."""
        a, r = np.asarray(contact_radius, dtype=np.float64), self.radius
        return np.asarray(self.contact_modulus * ((r**2 + a**2) * np.arctanh(a / r) - a * r))

    def contact_radius(self, displacement: Floats | float) -> Floats:
        """Return the root a of d = a artanh(a/R) [length], zero where d < 0; shape of `displacement` d [length].

        With t = artanh(a/R) and y = d/R it is t tanh t = y, which lies between sqrt y and sqrt y + y.
        """
        y = np.maximum(np.asarray(displacement, dtype=np.float64), 0.0) / self.radius
        roots = [_root_of_t_tanh_t(float(value)) for value in y.ravel()]
        return np.asarray(self.radius * np.tanh(np.asarray(roots, dtype=np.float64))).reshape(y.shape)

    def energy(self, displacement: Floats | float) -> Floats:
        """Return U = int_0^d F dd [force length], zero where d < 0, by quadrature; shape of `displacement` d [length].

        The integral over a, dd/da = artanh(a/R) + a R/(R^2 - a^2), has no elementary form.
        """
        edges = self.contact_radius(displacement)
        return np.asarray([self._energy_at(float(a)) for a in edges.ravel()]).reshape(edges.shape)

    def _energy_at(self, contact_radius: float) -> float:
        """Return U of one contact radius a [force length]."""
        from scipy.integrate import quad  # here, since a small run would wait for its import

        r = self.radius

        def rate(a: float) -> float:
            return float(self.force(a)) * (math.atanh(a / r) + a * r / (r**2 - a**2))

        return float(quad(rate, 0.0, contact_radius, epsrel=1e-12, epsabs=0.0)[0]) if contact_radius > 0.0 else 0.0


def _root_of_t_tanh_t(value: float) -> float:
    """Return t >= 0 with t tanh t = `value` >= 0."""
    from scipy.optimize import brentq

    low = math.sqrt(value)
    return float(brentq(lambda t: t * math.tanh(t) - value, low, low + value, xtol=1e-300, rtol=ROOT)) if low else 0.0


@dataclass(frozen=True)
class AdhesiveCone:
    """The cone z = slope * r with adhesion: F = (pi/2) E* slope a^2 - sqrt(8 pi E* W a^3), by Maugis and Barquins.

    Args:
        slope: tan of the angle between the cone and the plane [1].
        contact_modulus: E* [stress].
        work_of_adhesion: W [force/length].

    Raises:
        ValueError: if one of them is not positive.
    """

    slope: float
    contact_modulus: float
    work_of_adhesion: float

    def __post_init__(self) -> None:
        """Check the signs."""
        _check_positive(slope=self.slope, contact_modulus=self.contact_modulus, work_of_adhesion=self.work_of_adhesion)

    def force(self, contact_radius: Floats | float) -> Floats:
        """Return F = (pi/2) E* slope a^2 - sqrt(8 pi E* W a^3) [force], shape of `contact_radius` a >= 0 [length]."""
        a, e = np.asarray(contact_radius, dtype=np.float64), self.contact_modulus
        pull = np.sqrt(8.0 * math.pi * e * self.work_of_adhesion * a**3)
        return np.asarray(0.5 * math.pi * e * self.slope * a**2 - pull)

    def displacement(self, contact_radius: Floats | float) -> Floats:
        """Return d(a) = (pi/2) slope a - sqrt(2 pi W a/E*) [length], shape of `contact_radius` a >= 0 [length]."""
        a = np.asarray(contact_radius, dtype=np.float64)
        stretch = np.sqrt(2.0 * math.pi * self.work_of_adhesion * a / self.contact_modulus)
        return np.asarray(0.5 * math.pi * self.slope * a - stretch)

    def critical_radius(self) -> float:
        """Return a where a fixed load pulls off, 18 W/(pi E* slope^2) [length]: dF/da = 0."""
        return 18.0 * self.work_of_adhesion / (math.pi * self.contact_modulus * self.slope**2)

    def pull_off_force(self) -> float:
        """Return 54 W^2/(pi E* slope^3), the largest tension under a fixed load, a positive magnitude [force]."""
        return 54.0 * self.work_of_adhesion**2 / (math.pi * self.contact_modulus * self.slope**3)
