"""Rigid axisymmetric indenters on an elastic half space in closed form, with adhesion of zero range or without.

A contact of radius a has, with the power-law profile z = c r^n and kappa_n = (sqrt(pi)/2) n Gamma(n/2)/Gamma((n+1)/2),

    d = kappa_n c a^n - sqrt(2 pi W a/E*),    F = 2n/(n+1) kappa_n c E* a^(n+1) - sqrt(8 pi E* W a^3)

For n = 2, c = 1/2R that is Hertz and, with the work of adhesion W, JKR; for n = 1 Sneddon's cone, with W that of Maugis
and Barquins. W adds the tension of a flat punch of the same a. W = 2 gamma is the work of adhesion of two equal
surfaces, gamma the surface energy of one of them; Geike and Popov (2007) call gamma the work of adhesion. Forces are
positive in compression. Valid for small slopes, a frictionless half space and, with W, a Tabor parameter well above 1.
Sources: I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47; L. A. Galin (1953); K. L. Johnson, K. Kendall, A. D. Roberts,
Proc. R. Soc. A 324 (1971) 301; K. Kendall, J. Phys. D 4 (1971) 1186; D. Maugis, M. Barquins, J. Phys. Lett. 42 (1981)
L95; V. L. Popov, M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction (2015), section 4.4. Any
consistent units; E* is the contact modulus [stress].
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import gauss

Floats = NDArray[np.float64]


@cache
def galin_factor(exponent: float) -> float:
    """Return kappa_n = (sqrt(pi)/2) n Gamma(n/2)/Gamma((n+1)/2), dimensionless, for the `exponent` n > 0 of z = c r^n.

    It is pi/2 for a cone (n = 1), 2 for a paraboloid (n = 2). The result is cached.
    """
    n = exponent
    return 0.5 * math.sqrt(math.pi) * n * math.exp(math.lgamma(0.5 * n) - math.lgamma(0.5 * (n + 1.0)))


def require_positive(**values: float) -> None:
    """Raise ValueError, with its name, for the first value that is not positive and finite; nothing is returned."""
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} must be positive and finite, got {value}")


def require_work(work_of_adhesion: float) -> None:
    """Raise ValueError for a work of adhesion [energy/area] that is negative or NaN; nothing is returned.

    0 and infinity pass.
    """
    if not work_of_adhesion >= 0.0:
        raise ValueError(f"work_of_adhesion must not be negative, got {work_of_adhesion}")


class Contact(ABC):
    """A contact in closed form: force and displacement over the contact radius a, and results derived from them.

    Under a fixed load it pulls off where F(a) is lowest, under fixed grips where d(a) is. Both rise with larger a.
    """

    @abstractmethod
    def force(self, contact_radius: float) -> float:
        """Return F(a) [force], positive in compression; a >= 0 [length]. With adhesion it is negative for small a."""

    @abstractmethod
    def displacement(self, contact_radius: float) -> float:
        """Return d(a) [length], positive in approach; a >= 0 [length].

        With adhesion it is negative for small a, but not of DMT.
        """

    @property
    def reach(self) -> float:
        """The largest contact radius for which the contact is defined [length].

        Infinite; only of an ellipsoid finite, next to its rim.
        """
        return math.inf

    def critical_radius(self) -> float:
        """Return a where a fixed load pulls off, F(a) lowest [length]: 0 here, as of DMT; other subclasses find it."""
        return 0.0

    def fixed_grips_radius(self) -> float:
        """Return a where a prescribed displacement pulls off, d(a) lowest [length].

        0 here, as of DMT; other subclasses find it.
        """
        return 0.0

    def pull_off_force(self) -> float:
        """Return F_A, the largest tension under a fixed load, a positive magnitude [force]; 0 without adhesion."""
        return -self.force(self.critical_radius())

    def zero_load_radius(self) -> float:
        """Return a_0, the stable contact radius without a load, F(a_0) = 0 [length]; 0 without adhesion."""
        return self.contact_radius(0.0)

    def contact_radius(self, force: float) -> float:
        """Return the stable contact radius a [length] with F(a) = `force`, positive in compression [force].

        At the pull-off force it is the critical radius. Where F(a) stays below `force` up to `reach` it is `reach`.

        Raises:
            ValueError: if the tension exceeds the pull-off force.
        """
        low = self.critical_radius()
        if force < self.force(low):
            raise ValueError(f"no equilibrium: the tension exceeds the pull-off force {self.pull_off_force()}")
        return self._where(self.force, force, low)

    def radius_at(self, displacement: float) -> float:
        """Return the stable contact radius a [length] under fixed grips with d(a) = `displacement` [length].

        At the lowest d it is the radius there. Where d(a) stays below `displacement` up to `reach` it is `reach`.

        Raises:
            ValueError: if `displacement` is below the lowest d(a), at which the bodies separate.
        """
        low = self.fixed_grips_radius()
        if displacement < self.displacement(low):
            raise ValueError(f"the bodies separate at the displacement {self.displacement(low)}")
        return self._where(self.displacement, displacement, low)

    def curve(self, least: float, largest: float, points: int = 400) -> Floats:
        """Return a [length], d(a) [length] and F(a) [force] at evenly spaced radii between two, shape (3, points).

        Both ends are included. Displacement is positive in approach, force in compression.

        Args:
            least, largest: first and last contact radius [length].
            points: number of radii.
        """
        return np.asarray([(a, self.displacement(a), self.force(a)) for a in np.linspace(least, largest, points)]).T

    def _where(self, curve: Callable[[float], float], wanted: float, low: float) -> float:
        """Return the radius [length] at which a rising curve is `wanted`, to the last digit.

        It is `low` where the curve is not below that there, and `reach` where it does not get there.

        Args:
            curve: returns force or displacement of a contact radius.
            wanted: value of the curve, in its unit.
            low: radius to begin with [length].
        """
        if not wanted > curve(low):
            return low
        high = min(2.0 * low or 1.0, self.reach)
        while curve(high) < wanted and high < self.reach:
            high = min(2.0 * high, self.reach)
        while low < (middle := 0.5 * (low + high)) < high:
            low, high = (middle, high) if curve(middle) < wanted else (low, middle)
        return high


def punch_tension(contact_modulus: float, work_of_adhesion: float, contact_radius: float) -> float:
    """Return Kendall's F = sqrt(8 pi E* W a^3), a positive magnitude [force]: the largest tension of a flat punch.

    Args:
        contact_modulus: E* [stress].
        work_of_adhesion: W [force/length].
        contact_radius: a [length].
    """
    return math.sqrt(8.0 * math.pi * contact_modulus * work_of_adhesion * contact_radius**3)


class Indenter(Contact):
    """A body whose contact without adhesion is known; adhesion of zero range adds a punch's tension at the same a.

        d = g(a) - sqrt(2 pi W a/E*),    F = P(a) - sqrt(8 pi E* W a^3)

    with g and P those without adhesion. Derivatives by a vanish where g'(a) sqrt(a) is 3/4 or 1/4 of sqrt(8 pi W/E*).
    """

    contact_modulus: float
    work_of_adhesion: float

    @abstractmethod
    def transformed(self, contact_radius: float) -> float:
        """Return g(a) [length], d without adhesion; a >= 0 [length]."""

    @abstractmethod
    def pressed(self, contact_radius: float) -> float:
        """Return P(a) [force], F without adhesion; a >= 0 [length]."""

    @abstractmethod
    def _steep(self, wanted: float) -> float:
        """Return the radius a at which g'(a) sqrt(a) is `wanted` [length]; wanted > 0 [length^(1/2)]."""

    def displacement(self, contact_radius: float) -> float:
        """Return d = g(a) - sqrt(2 pi W a/E*) [length], positive in approach; a >= 0 [length]."""
        stretch = math.sqrt(2.0 * math.pi * self.work_of_adhesion * contact_radius / self.contact_modulus)
        return self.transformed(contact_radius) - stretch

    def force(self, contact_radius: float) -> float:
        """Return F = P(a) - sqrt(8 pi E* W a^3) [force], positive in compression; a >= 0 [length]."""
        tension = punch_tension(self.contact_modulus, self.work_of_adhesion, contact_radius)
        return self.pressed(contact_radius) - tension

    def critical_radius(self) -> float:
        """Return a where a fixed load pulls off [length]; of JKR (9 pi W R^2/8E*)^(1/3). 0 without adhesion."""
        return self._edge(0.75)

    def fixed_grips_radius(self) -> float:
        """Return a where a prescribed displacement pulls off [length]; of JKR (pi W R^2/8E*)^(1/3).

        0 without adhesion.
        """
        return self._edge(0.25)

    def _edge(self, share: float) -> float:
        """Return the radius a at which g'(a) sqrt(a) is `share` of sqrt(8 pi W/E*) [length]; 0 without adhesion."""
        wanted = share * math.sqrt(8.0 * math.pi * self.work_of_adhesion / self.contact_modulus)
        return self._steep(wanted) if wanted else 0.0

    def _tension(self, contact_radius: float) -> float:
        """Return the tension of adhesion on the axis, sqrt(2 E* W/pi a) [stress], a positive magnitude; 0 at a = 0."""
        a = contact_radius
        return math.sqrt(2.0 * self.contact_modulus * self.work_of_adhesion / (math.pi * a)) if a else 0.0


@dataclass(frozen=True)
class PowerLaw(Indenter):
    """The indenter z = c r^n.

    Args:
        coefficient: c > 0 [length^(1-n)]: the slope of a cone (n = 1), 1/2R of a paraboloid (n = 2).
        exponent: n >= 1, any real number.
        contact_modulus: E* [stress].
        work_of_adhesion: W >= 0 [force/length].

    Raises:
        ValueError: if one of them is out of its range.
    """

    coefficient: float
    exponent: float
    contact_modulus: float
    work_of_adhesion: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for c or E* that is not positive and finite, W that is negative or NaN, or n below 1."""
        require_positive(coefficient=self.coefficient, contact_modulus=self.contact_modulus)
        require_work(self.work_of_adhesion)
        if not self.exponent >= 1.0:
            raise ValueError(f"exponent must be at least 1, got {self.exponent}")

    @classmethod
    def sphere(cls, radius: float, contact_modulus: float, work_of_adhesion: float = 0.0) -> PowerLaw:
        """Return the paraboloid z = r^2/2R, the contact of Hertz, or with W > 0 of JKR.

        Args:
            radius: R > 0 [length].
            contact_modulus: E* > 0 [stress].
            work_of_adhesion: W >= 0 [force/length].

        Raises:
            ValueError: if one of them is out of its range.
        """
        require_positive(radius=radius)
        return cls(0.5 / radius, 2.0, contact_modulus, work_of_adhesion)

    @property
    def _rise(self) -> float:
        """The factor kappa_n c of g(a) = kappa_n c a^n [length^(1-n)]."""
        return galin_factor(self.exponent) * self.coefficient

    def transformed(self, contact_radius: float) -> float:
        """Return g(a) = kappa_n c a^n [length]; a >= 0 [length]."""
        return float(self._rise * contact_radius**self.exponent)

    def pressed(self, contact_radius: float) -> float:
        """Return P(a) = 2n/(n+1) kappa_n c E* a^(n+1) [force]; a >= 0 [length]."""
        n = self.exponent
        return float(2.0 * n / (n + 1.0) * self._rise * self.contact_modulus * contact_radius ** (n + 1.0))

    def _steep(self, wanted: float) -> float:
        """Return a = [wanted/(n kappa_n c)]^(1/(n - 1/2)), where g'(a) sqrt(a) is `wanted` [length]."""
        return float((wanted / (self.exponent * self._rise)) ** (1.0 / (self.exponent - 0.5)))

    def central_pressure(self, contact_radius: float) -> float:
        """Return p(0) = E* kappa_n c n a^(n-1)/(pi (n-1)) - sqrt(2 E* W/(pi a)) [stress], positive in compression.

        Infinite at a cone's tip (n = 1), whatever a and W are; 0 at a = 0 of any other body.
        """
        n, a = self.exponent, contact_radius
        if n == 1.0:
            return math.inf
        pressed = self.contact_modulus * self._rise * a ** (n - 1.0) * n / (math.pi * (n - 1.0))
        return float(pressed - self._tension(a))

    def peak_pressure(self, contact_radius: float) -> float:
        """Return the largest p under a contact radius a [length], positive in compression [stress]: for n <= 2 p(0).

        For n > 2 it is off the axis, and has no closed form: NaN. Infinite at a cone's tip (n = 1); 0 at a = 0 for 1 <
        n <= 2.
        """
        return self.central_pressure(contact_radius) if self.exponent <= 2.0 else math.nan

    def pressure(self, r: Floats, contact_radius: float) -> Floats:
        """Return p(r) [stress], positive in compression, of a cone or a paraboloid; 0 from the edge on.

        (E* c/2) arcosh(a/r) or (2 E* a/pi R) sqrt(1 - r^2/a^2), less sqrt(2 E* W/pi a)/sqrt(1 - r^2/a^2). Infinite at r
        = 0 of a cone.

        Args:
            r: distances from the axis >= 0 [length], an array of any shape, which p has, too.
            contact_radius: a >= 0 [length].

        Raises:
            ValueError: an exponent other than 1 and 2.
        """
        if self.exponent not in (1.0, 2.0):
            raise ValueError(f"p(r) has this form for the exponents 1 and 2, and not for {self.exponent:g}")
        pressure, inside = np.zeros_like(r), r < contact_radius
        ratio, scale = r[inside] / contact_radius, self.contact_modulus * self.coefficient
        root = np.sqrt(1.0 - ratio**2)
        with np.errstate(divide="ignore"):
            cone = 0.5 * scale * np.arccosh(1.0 / ratio)
        pressed = cone if self.exponent == 1.0 else 4.0 * scale * contact_radius / math.pi * root
        pressure[inside] = pressed - self._tension(contact_radius) / root
        return pressure


@dataclass(frozen=True)
class Ellipsoid(Indenter):
    """An ellipsoid up to its rim, z = b (1 - sqrt(1 - r^2/c^2)), a sphere of b/c times the height; a << c gives Hertz.

    Linear elasticity holds for small slopes only, so its use near a = c is to test methods. F loses the digits
    (c/a)^2 to cancellation: for a > 1e-3 c it is good to 1e-10.

    Args:
        radius: c [length].
        half_axis: b [length]; of a sphere c.
        contact_modulus: E* [stress].
        work_of_adhesion: W >= 0 [force/length]; the tension at the edge is JKR's, whatever the profile.

    Raises:
        ValueError: if one of them is out of its range.
    """

    radius: float
    half_axis: float
    contact_modulus: float
    work_of_adhesion: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for a parameter that is not positive and finite, or a negative work of adhesion."""
        require_positive(radius=self.radius, half_axis=self.half_axis, contact_modulus=self.contact_modulus)
        require_work(self.work_of_adhesion)

    @property
    def reach(self) -> float:
        """The largest contact radius, (1 - 1e-12) c [length], next to the rim of the body, where F has no bound."""
        return (1.0 - 1e-12) * self.radius

    def transformed(self, contact_radius: float) -> float:
        """Return g(a) = (b/c) a artanh(a/c) [length]; 0 <= a < c [length]."""
        return self.half_axis / self.radius * contact_radius * math.atanh(contact_radius / self.radius)

    def pressed(self, contact_radius: float) -> float:
        """Return P(a) = (b/c) E* [(c^2 + a^2) artanh(a/c) - a c] [force]; 0 <= a < c [length]."""
        a, c = contact_radius, self.radius
        return self.half_axis / c * self.contact_modulus * ((c**2 + a**2) * math.atanh(a / c) - a * c)

    def _steep(self, wanted: float) -> float:
        """Return the radius a at which g'(a) sqrt(a) is `wanted` [length], by bisection; at most (1 - 1e-12) c."""
        return self._where(lambda a: self._rate(a) * math.sqrt(a), wanted, 0.0)

    def _rate(self, position: float) -> float:
        """Return g'(x) = (b/c) [artanh(x/c) + x c/(c^2 - x^2)], dimensionless; 0 <= x < c [length]."""
        x, c = position, self.radius
        return self.half_axis / c * (math.atanh(x / c) + x * c / (c**2 - x**2))

    def central_pressure(self, contact_radius: float) -> float:
        """Return p(0) = (E*/pi) int_0^a g'/x dx - sqrt(2 E* W/pi a) [stress], positive in compression; 0 at a = 0.

        0 <= a < c [length]. By quadrature: the integral has no elementary form. `peak_pressure` is this number, too:
        the largest pressure, but for a above some 0.9 c, where that is off the axis.
        """
        if not contact_radius:
            return 0.0
        nodes, weights = gauss(200)  # with an error below round-off for a smooth function
        half = 0.5 * contact_radius
        positions = half * (nodes + 1.0)
        rate = float(weights @ [self._rate(float(x)) / x for x in positions])
        return self.contact_modulus / math.pi * half * rate - self._tension(contact_radius)

    peak_pressure = central_pressure


@dataclass(frozen=True)
class FlatPunch:
    """A flat-ended cylinder with the contact radius a, F = 2 E* a d.

    Args:
        radius: a [length].
        contact_modulus: E* [stress].
        work_of_adhesion: W >= 0 [force/length].

    Raises:
        ValueError: if one of them is out of its range.
    """

    radius: float
    contact_modulus: float
    work_of_adhesion: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for a parameter that is not positive and finite, or a negative work of adhesion."""
        require_positive(radius=self.radius, contact_modulus=self.contact_modulus)
        require_work(self.work_of_adhesion)

    @property
    def stiffness(self) -> float:
        """The contact stiffness F/d = 2 E* a [force/length]."""
        return 2.0 * self.contact_modulus * self.radius

    def pressure(self, r: Floats | float, displacement: float) -> Floats:
        """Return p(r) = (E* d/pi) (a^2 - r^2)^(-1/2) [stress], of the shape of r, with the sign of d; without adhesion.

        Infinite at r = a, NaN beyond.

        Args:
            r: distances from the axis, 0 <= r < a [length], any shape.
            displacement: d, positive in approach [length].
        """
        root = np.sqrt(self.radius**2 - np.asarray(r, dtype=np.float64) ** 2)
        return np.asarray(self.contact_modulus * displacement / (math.pi * root))

    def pull_off_force(self) -> float:
        """Return Kendall's F_A = sqrt(8 pi E* W a^3), a positive magnitude [force]; 0 without adhesion."""
        return punch_tension(self.contact_modulus, self.work_of_adhesion, self.radius)
