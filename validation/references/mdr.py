"""The contact of a body that is known by its slope alone, with the names of `indenters`: `axisymmetric` without kinks.

F = 2 E* int_0^a (d-g) dx, U = E* int_0^a (d-g)^2 dx (the springs of -a..a hold (E*/2)(d-g)^2 per length), and with
adhesion the springs at the edge are stretched by Delta_l(a) = sqrt(2 pi a W/E*), the rule of Hess: d = g(a) - Delta_l.
Exact for any profile f(r) with a compact circular contact, f' >= 0. Sources: V. L. Popov, M. Hess, Method of
Dimensionality Reduction in Contact Mechanics and Friction (2015), chapters 3 and 4; M. Hess (2011). Any consistent
units. Geike and Popov (2007) is the older reduction, with another g and stiffness: see `winkler`.
"""

import math

from validation.references.axisymmetric import Body, Contact, with_rest_radius
from validation.references.indenters import Marks
from validation.references.numerics import Function, integral, rising

PRESSURE_ACCURACY = 1e-9
"""Relative accuracy asked of the pressure away from the edge."""
PRESSURE_ROUND_OFF = 1e-11
"""Its accuracy near the edge over a^2/(a^2 - r^2): the integrand has a difference of nearly equal values."""


def _of_slope(slope: Function) -> Body:
    return Body(slope, lambda _: math.nan)


class ReducedContact(Contact, Marks):
    """One axisymmetric contact, reduced. A flat punch is the slope 0 at its own radius a."""

    def __init__(self, slope: Function, modulus: float, work: float = 0.0) -> None:
        """Know the body by its slope.

        Args:
            slope: f'(r) >= 0 of the 3D profile, for r >= 0 [1]. `contact_radius` also asks for it at up to twice the
                radius that it returns.
            modulus: E* > 0 [stress].
            work: W >= 0 [force/length]; 0 is the contact without adhesion.
        """
        super().__init__(_of_slope(slope), modulus, work)

    def profile(self, place: float) -> float:
        """Return g(x) [length] at `place` x [length]."""
        return self.body.transformed(abs(place))

    def contact_radius(self, displacement: float) -> float:
        """Return the root a of g(a) = d, the contact without adhesion [length]; 0 where d <= 0.

        Args:
            displacement: d [length].

        Raises:
            ValueError: with adhesion, where a(d) has two branches, or if the profile never rises to d.
        """
        if self.work > 0.0:
            raise ValueError("with adhesion a displacement has two contact radii: take displacement(a)")
        if displacement <= 0.0:
            return 0.0
        try:
            return rising(lambda a: self.profile(a) - displacement, displacement)
        except ValueError:
            raise ValueError(f"the profile never rises to the displacement {displacement}") from None

    def pressure(self, r: float, a: float, d: float | None = None) -> float:
        """Return p(r) = -(1/pi) int_r^inf q'(x)/sqrt(x^2-r^2) dx, q = E* (d - g) the force of the springs [stress].

        q' is -E* g' inside and, with adhesion, a jump by E* Delta_l at the edge. By parts, with x^2 = r^2 + t^2 and
        s^2 = a^2 - r^2, g' goes away: p = (E*/pi) [(d - g(r))/s + int_0^s (g(x)-g(r))/t^2 dt].

        Args:
            r: 0 < r < a [length]: a cone's pressure has no limit at 0, with adhesion no pressure has one at a.
            a: contact radius [length].
            d: displacement [length]; None: d(a).
        """
        s, g_r = math.sqrt(a**2 - r**2), self.profile(r)
        accuracy = max(PRESSURE_ACCURACY, PRESSURE_ROUND_OFF * (a / s) ** 2)
        inside = integral(lambda t: (self.profile(math.hypot(r, t)) - g_r) / t**2, 0.0, s, accuracy=accuracy)
        return self.modulus / math.pi * (((self.displacement(a) if d is None else d) - g_r) / s + inside)


def with_zero_load_radius(slope: Function, modulus: float, radius: float) -> ReducedContact:
    """Return the contact of that slope [1] and E* [stress] whose radius without a load is `radius` [length]."""
    return ReducedContact(slope, modulus, with_rest_radius(_of_slope(slope), modulus, radius).work)
