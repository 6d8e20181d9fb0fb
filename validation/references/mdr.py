"""The method of dimensionality reduction by quadrature: a 3D axisymmetric contact as a 1D row of independent springs.

g(x) = |x| int_0^|x| f'(r)/sqrt(x^2-r^2) dr is pressed by d into springs of stiffness E* per length:
F = 2 E* int_0^a (d-g) dx, U = E* int_0^a (d-g)^2 dx (the springs of -a..a hold (E*/2)(d-g)^2 per length), and with
adhesion the springs at the edge are stretched by Delta_l(a) = sqrt(2 pi a W/E*), the rule of Hess: d = g(a) - Delta_l.
Exact for any profile f(r) with a compact circular contact, f' >= 0. Sources: V. L. Popov, M. Hess, Method of
Dimensionality Reduction in Contact Mechanics and Friction (2015), chapters 3 and 4; M. Hess (2011). Any consistent
units. Geike and Popov (2007) is the older reduction, with another g and stiffness: see `winkler`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from scipy.integrate import quad
from scipy.optimize import brentq

from validation.references.indenters import Marks

ACCURACY = 1e-12
"""Relative accuracy asked of F, U and g."""
PRESSURE_ACCURACY = 1e-9
"""Relative accuracy asked of the pressure away from the edge."""
PRESSURE_ROUND_OFF = 1e-11
"""Its accuracy near the edge over a^2/(a^2 - r^2): the integrand has a difference of nearly equal values."""
ROOT = 20.0
"""m of the substitution in the pressure on the axis: no pole at 0 from n = 1.05 on."""
DOUBLINGS = 200
"""How often the search for a contact radius may double or halve its first guess."""


def _integral(function: Callable[[float], float], low: float, high: float, accuracy: float = ACCURACY) -> float:
    """Return the integral of `function` over low..high, adaptively to the relative `accuracy`."""
    return float(quad(function, low, high, epsrel=accuracy, epsabs=0.0, limit=200)[0]) if high > low else 0.0


def equivalent_profile(slope: Callable[[float], float], place: float) -> float:
    """Return g(x) = |x| int_0^(pi/2) f'(|x| sin phi) d phi, which is the definition with r = |x| sin phi [length].

    Args:
        slope: f'(r) of the 3D profile, for r >= 0 [1].
        place: x of any sign [length].
    """
    x = abs(place)
    return x * _integral(lambda phi: slope(x * math.sin(phi)), 0.0, 0.5 * math.pi)


def edge_elongation(contact_radius: float, contact_modulus: float, work_of_adhesion: float) -> float:
    """Return Delta_l(a) = sqrt(2 pi a W/E*) [length], the rule of Hess; a [length], E* [stress], W [force/length]."""
    return math.sqrt(2.0 * math.pi * contact_radius * work_of_adhesion / contact_modulus)


@dataclass(frozen=True)
class ReducedContact(Marks):
    """One axisymmetric contact, reduced. A flat punch is the slope 0 at its own radius a.

    Args:
        slope: f'(r) >= 0 of the 3D profile, for r >= 0 [1]. `contact_radius` also asks for it at up to twice the radius
            that it returns.
        contact_modulus: E* > 0 [stress].
        work_of_adhesion: W >= 0 [force/length]; 0 is the contact without adhesion.
    """

    slope: Callable[[float], float]
    contact_modulus: float
    work_of_adhesion: float = 0.0

    def profile(self, place: float) -> float:
        """Return g(x) [length] at `place` x [length]."""
        return equivalent_profile(self.slope, place)

    def displacement(self, contact_radius: float) -> float:
        """Return d(a) = g(a) - Delta_l(a) [length] at `contact_radius` a >= 0 [length]."""
        stretch = edge_elongation(contact_radius, self.contact_modulus, self.work_of_adhesion)
        return self.profile(contact_radius) - stretch

    def force(self, contact_radius: float) -> float:
        """Return F(a) = 2 E* int_0^a (d - g) dx [force], positive in compression; a >= 0 [length].

        int_0^a g dx = int_0^a f'(r) sqrt(a^2-r^2) dr by a change of the order, here with r = a sin phi.
        """
        a, d = contact_radius, self.displacement(contact_radius)
        area = a**2 * _integral(lambda phi: self.slope(a * math.sin(phi)) * math.cos(phi) ** 2, 0.0, 0.5 * math.pi)
        return 2.0 * self.contact_modulus * (a * d - area)

    def energy(self, contact_radius: float) -> float:
        """Return the elastic U(a) = E* int_0^a (d - g)^2 dx [force length], without -pi a^2 W; a >= 0 [length]."""
        d = self.displacement(contact_radius)
        return self.contact_modulus * _integral(lambda x: (d - self.profile(x)) ** 2, 0.0, contact_radius)

    def contact_radius(self, displacement: float) -> float:
        """Return the root a of g(a) = d, the contact without adhesion [length]; 0 where d <= 0.

        Args:
            displacement: d [length].

        Raises:
            ValueError: with adhesion, where a(d) has two branches, or if the profile never rises to d.
        """
        if self.work_of_adhesion > 0.0:
            raise ValueError("with adhesion a displacement has two contact radii: take displacement(a)")
        if displacement <= 0.0:
            return 0.0
        low, high = self._bracket(displacement)
        return float(brentq(lambda a: self.profile(a) - displacement, low, high, xtol=1e-300, rtol=1e-14))

    def _bracket(self, displacement: float) -> tuple[float, float]:
        """Return two radii, one twice the other, with g below and above d > 0; the first guess is d itself."""
        a = displacement
        for _ in range(DOUBLINGS):
            below, above = self.profile(a) <= displacement, self.profile(2.0 * a) >= displacement
            if below and above:
                return a, 2.0 * a
            a = 2.0 * a if below else 0.5 * a
        raise ValueError(f"the profile never rises to the displacement {displacement}")

    def pressure(self, place: float, contact_radius: float) -> float:
        """Return p(r) = -(1/pi) int_r^inf q'(x)/sqrt(x^2-r^2) dx, q = E* (d - g) the force of the springs [stress].

        q' is -E* g' inside and, with adhesion, a jump by E* Delta_l at the edge. By parts, with x^2 = r^2 + t^2 and
        s^2 = a^2 - r^2, g' goes away: p = (E*/pi) [(g(a)-g(r)-Delta_l)/s + int_0^s (g(x)-g(r))/t^2 dt].

        Args:
            place: r, 0 < r < a [length]: a cone's pressure has no limit at 0, with adhesion no pressure has one at a.
            contact_radius: a [length].
        """
        r, a = place, contact_radius
        s, g_r = math.sqrt(a**2 - r**2), self.profile(r)
        stretch = edge_elongation(a, self.contact_modulus, self.work_of_adhesion)
        ends = (self.profile(a) - g_r - stretch) / s
        accuracy = max(PRESSURE_ACCURACY, PRESSURE_ROUND_OFF * (a / s) ** 2)
        inside = _integral(lambda t: (self.profile(math.hypot(r, t)) - g_r) / t**2, 0.0, s, accuracy)
        return self.contact_modulus / math.pi * (ends + inside)

    def central_pressure(self, contact_radius: float) -> float:
        """Return p(0) [stress] at `contact_radius` a [length], the limit of `pressure`; a cone has none.

        The integral is over v, t = a v^m: its integrand is v^(m (n-1) - 1) where the slope begins as r^(n-1).
        """
        a = contact_radius
        stretch = edge_elongation(a, self.contact_modulus, self.work_of_adhesion)
        ends = (self.profile(a) - stretch) / a
        inside = _integral(lambda v: ROOT / v * self.profile(a * v**ROOT) / (a * v**ROOT), 0.0, 1.0, PRESSURE_ACCURACY)
        return self.contact_modulus / math.pi * (ends + inside)


def with_zero_load_radius(slope: Callable[[float], float], contact_modulus: float, radius: float) -> ReducedContact:
    """Return the contact of that slope [1] and E* [stress] whose radius without a load is `radius` [length].

    At F = 0 the stretch of the edge takes all that carries the contact without adhesion, 2 E* a Delta_l = F.
    """
    pressed = ReducedContact(slope, contact_modulus)
    stretch = pressed.force(radius) / (2.0 * contact_modulus * radius)
    return replace(pressed, work_of_adhesion=stretch**2 * contact_modulus / (2.0 * math.pi * radius))
