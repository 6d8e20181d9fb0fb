"""Contacts of axisymmetric bodies whose slope may jump, by quadrature of the method of dimensionality reduction.

A body is its slope f'(r) >= 0, the derivative f''(r) between the kinks, and jumps J_k >= 0 of the slope at b_k. With
t = |x| sin phi,

    g(x) = x int_0^(pi/2) f'(x sin phi) dphi
    x g'(x) = g(x) + x^2 int_0^(pi/2) f''(x sin phi) sin phi dphi + sum_k J_k b_k x/sqrt(x^2 - b_k^2)

d(a) = g(a) - Delta_l, Delta_l = sqrt(2 pi a W/E*), F(a) = 2 E* [a d - int_0^a g dx], so that

    d'(a) = 0 where a g' = Delta_l/2 (fixed grips),   F'(a) = 0 where a g' = 3 Delta_l/2 (the largest tension)

and both may lie at a kink, where g' is infinite on its outer side. The energy of a contact is
E(a) = E* int_0^a (d - g)^2 dx - pi a^2 W: a contact that is made at d = 0 loses -E(a_in), one that ends under fixed
grips E(a_fg). Everything is by adaptive quadrature between the kinks; nothing is shared with the program.
Sources: V. L. Popov, M. Hess, Method of Dimensionality Reduction (2015), chapters 3 to 5; K. L. Johnson (1985).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from validation.references.numerics import Function, integral, largest, root

SCAN, DECADES = 48, 4.0
"""Radii of the first search for sign changes, between two kinks and per decade; decades on either side of the guess."""
CLOSE = 1e-9
"""Relative distance of a radius from a kink at which it counts as beyond it."""
NO_POLE = 20.0
"""m of the substitution r = v^m under the axis, whose integrand has no pole at 0 from f' ~ r^0.05 on."""


@dataclass(frozen=True)
class Body:
    """A body of revolution that touches at r = 0.

    Args:
        slope: f'(r) [1] for r >= 0, at a kink that of its outer side.
        bend: f''(r) [1/length] between kinks; at a kink that of the outer side.
        kinks: b_k > 0 [length], rising, where slope or bend jump.
        jumps: J_k of the slope there [1]; 0 where only the bend jumps.
        end: radius at which there is a flank (a punch), inf where there is none [length].
        limit: radius below which contacts are searched for, as of a sphere [length].
    """

    slope: Function
    bend: Function
    kinks: tuple[float, ...] = ()
    jumps: tuple[float, ...] = ()
    end: float = math.inf
    limit: float = math.inf

    @property
    def widest(self) -> float:
        """Radius below which contacts are searched for [length]."""
        return min(self.limit, self.end)

    @property
    def flat(self) -> bool:
        """Whether it is a flat punch, always in contact up to its end."""
        return math.isfinite(self.end) and self.slope(self.end) == 0.0

    def corners(self, low: float, high: float) -> list[float]:
        """Two radii and the kinks between them [length]."""
        return [low, *(b for b in self.kinks if low < b < high), high]

    def height(self, radius: float) -> float:
        """f(r) [length]."""
        return integral(self.slope, *self.corners(0.0, radius))

    def over_angles(self, function: Callable[[float, float], float], radius: float, **given: float) -> float:
        """int_0^(pi/2) function(r, phi) dphi with r = radius sin phi, between the kinks, `given` as of `integral`."""
        ends = [math.asin(b / radius) for b in self.corners(0.0, radius)] if radius > 0.0 else [0.0, 0.5 * math.pi]
        return integral(lambda phi: function(radius * math.sin(phi), phi), *ends, **given)

    def transformed(self, x: float) -> float:
        """g(x) [length]; x >= 0."""
        return x * self.over_angles(lambda r, _: self.slope(r), x) if x > 0.0 else 0.0

    def rise(self, x: float) -> float:
        """x g'(x) [length], infinite at a kink of the slope; x > 0."""
        jumps = sum(
            jump * b * x / math.sqrt((x - b) * (x + b)) if x > b else math.inf
            for b, jump in zip(self.kinks, self.jumps, strict=True)
            if x >= b and jump > 0.0
        )
        return self.transformed(x) + x * x * self.over_angles(lambda r, phi: self.bend(r) * math.sin(phi), x) + jumps

    def area(self, x: float) -> float:
        """int_0^x g dx = int_0^x f'(r) sqrt(x^2 - r^2) dr [length^2]."""
        return x * x * self.over_angles(lambda r, phi: self.slope(r) * math.cos(phi) ** 2, x) if x > 0.0 else 0.0


@dataclass(frozen=True)
class Contact:
    """A body pressed on a plane, E* [stress], W [force/length]."""

    body: Body
    modulus: float = 1.0
    work: float = 0.0

    def stretch(self, a: float) -> float:
        """Delta_l(a) [length]."""
        return math.sqrt(2.0 * math.pi * a * self.work / self.modulus)

    def displacement(self, a: float) -> float:
        """d(a) [length]."""
        return self.body.transformed(a) - self.stretch(a)

    def force(self, a: float) -> float:
        """F(a) [force]."""
        return self.force_at(a, self.displacement(a))

    def force_at(self, a: float, d: float) -> float:
        """F of a contact of radius a at a displacement d, which differ by a punch's own."""
        return 2.0 * self.modulus * (a * d - self.body.area(a))

    def elastic_energy(self, a: float, d: float | None = None) -> float:
        """E* int_0^a (d - g)^2 dx [energy]."""
        depth = self.displacement(a) if d is None else d
        ends = self.body.corners(0.0, a)
        return self.modulus * integral(lambda x: (depth - self.body.transformed(x)) ** 2, *ends, accuracy=1e-10)

    def energy(self, a: float, d: float | None = None) -> float:
        """E(a) [energy]."""
        return self.elastic_energy(a, d) - math.pi * a * a * self.work

    def pressed_radius(self, force: float, guess: float) -> float:
        """The largest a with F(a) = force, from beyond [length]."""
        return self._down(lambda a: self.force(a) - force, guess)

    def under(self, force: float, guess: float) -> tuple[float, float]:
        """a and d of the contact with the largest a that carries a force; up to the end of a body d follows from it."""
        a = self.pressed_radius(force, guess)
        if a == self.body.end:
            return a, (0.5 * force / self.modulus + self.body.area(a)) / a
        return a, self.displacement(a)

    def radius_at(self, displacement: float, guess: float) -> float:
        """The largest a with d(a) = displacement [length]."""
        return self._down(lambda a: self.displacement(a) - displacement, guess)

    def _down(self, function: Function, guess: float) -> float:
        """The largest root of a function that is positive far outside, or the end of a body where it is below 0."""
        if self.body.flat or (math.isfinite(self.body.end) and function(self.body.end) <= 0.0):
            return self.body.end
        high = min(guess, self.body.end)
        while function(high) <= 0.0:
            high *= 1.5
            if high > self.body.widest:
                raise ValueError("the contact would cover the body")
        # A dip beside a limit point may be narrower than the grid.
        for closer in (False, self.work > 0.0):
            last, added = high, [self.fixed_grips(guess), self.critical(guess)] if closer else []
            for low in sorted({*self._grid(high), *added}, reverse=True):
                if low < last and function(low) <= 0.0:
                    return root(function, low, last)
                last = min(last, low)
        raise ValueError("no contact carries so little")

    def _grid(self, guess: float) -> list[float]:
        low, high = guess * 10.0**-DECADES, min(guess * 10.0 ** (0.5 * DECADES), self.body.widest)
        points = []
        for start, stop in pairwise(self.body.corners(low, high)):
            count = max(SCAN, round(SCAN * math.log10(stop / start)))
            points += [start * (stop / start) ** (i / count) for i in range(count)]
        return [*points, high]

    def _turns(self, share: float, guess: float) -> list[float]:
        """Radii at which a g' rises through share Delta_l: minima of d (1/2) or F (3/2); the end, if it falls there."""
        if self.body.flat:
            return [self.body.end]

        def excess(a: float) -> float:
            return self.body.rise(a) - share * self.stretch(a)

        def beside(a: float, side: float) -> float:
            return a * (1.0 + side * CLOSE) if a in self.body.kinks else a

        found = []
        for low, high in pairwise(self._grid(guess)):
            inside, outside = beside(low, 1.0), beside(high, -1.0)
            below, above = excess(inside), excess(outside)
            if below < 0.0 <= above:
                found.append(root(excess, inside, outside))
            if outside < high and above < 0.0 < excess(beside(high, 1.0)):
                found.append(high)
        if math.isfinite(self.body.end) and excess(self.body.end) < 0.0:
            found.append(self.body.end)
        return found

    def fixed_grips(self, guess: float) -> float:
        """a at the least d, where bodies part under fixed grips [length]."""
        return min(self._turns(0.5, guess), key=self.displacement)

    def has_one_edge(self, guess: float) -> bool:
        """Whether d(a) only rises beyond its least value, so that the edge recedes without a jump."""
        return max(self._turns(0.5, guess)) == self.fixed_grips(guess)

    def critical(self, guess: float) -> float:
        """a at the largest tension of the contacts that fixed grips hold [length]."""
        least = self.fixed_grips(guess)
        return min([least, *(a for a in self._turns(1.5, guess) if a > least)], key=self.force)

    def touch_radius(self, guess: float) -> float:
        """a of the contact that forms at d = 0: the first at which d(a) rises to 0 [length], or the end of a body."""
        if self.body.flat or (math.isfinite(self.body.end) and self.displacement(self.body.end) < 0.0):
            return self.body.end
        for low, high in pairwise(self._grid(guess)):
            if self.displacement(low) < 0.0 <= self.displacement(high):
                return root(self.displacement, low, high)
        raise ValueError("no contact at d = 0")

    def pressure(self, r: float, a: float, d: float | None = None) -> float:
        """p(r) [stress] of a body without kinks of the slope, 0 < r < a.

        p = (E*/pi) [int_0^s g'(x)/x dt - (g(a) - d... the jump at the edge)/s], x^2 = r^2 + t^2, s^2 = a^2 - r^2.
        """

        def inner(t: float) -> float:
            x = math.hypot(r, t)
            return self.body.rise(x) / (x * x)

        ends = [math.sqrt((b - r) * (b + r)) for b in self.body.corners(r, a)]
        return self.modulus / math.pi * (integral(inner, *ends, accuracy=1e-9) - self._jump(a, d) / ends[-1])

    def _jump(self, a: float, d: float | None) -> float:
        return self.body.transformed(a) - (self.displacement(a) if d is None else d)

    def central_pressure(self, a: float, d: float | None = None) -> float:
        """p(0) [stress]; inf under a tip.

        p(0) = (E*/pi) [int_0^a f'(r) (1/sqrt(a^2 - r^2) + arccos(r/a)/r) dr - jump/a], with r = b v^m up to each kink.
        """
        if self.body.slope(0.0) > 0.0:
            return math.inf
        inside = 0.0
        for low, high in pairwise(self.body.corners(0.0, a)):

            def by_power(v: float, high: float = high) -> float:
                r = high * v**NO_POLE
                return NO_POLE / v * self.body.slope(r) * math.acos(min(1.0, r / a))

            inside += integral(by_power, max(1e-6, (low / high) ** (1.0 / NO_POLE)), 1.0)
        return self.modulus / math.pi * (inside + (self.body.transformed(a) - self._jump(a, d)) / a)

    def peak_pressure(self, a: float, d: float | None = None) -> float:
        """The largest p(r) [stress]; inf under a tip or where the slope jumps inside."""
        if any(jump > 0.0 and b < a for b, jump in zip(self.body.kinks, self.body.jumps, strict=True)):
            return math.inf
        middle = self.central_pressure(a, d)
        if math.isinf(middle):
            return middle
        places = [1e-6 * a, *(a * (i + 0.5) / 24.0 for i in range(23)), a * (1.0 - 1e-9)]
        return max(middle, largest(lambda r: self.pressure(r, a, d), places)[1])


def with_rest_radius(body: Body, modulus: float, radius: float) -> Contact:
    """The contact whose largest radius without a load is about `radius` [length]: F = 0 there."""
    pressed = Contact(body, modulus)
    stretch = pressed.force(radius) / (2.0 * modulus * radius)
    return replace(pressed, work=stretch**2 * modulus / (2.0 * math.pi * radius))


def lost_on_path(contact: Contact, points: Sequence[float], start: str, guess: float) -> tuple[float, int, bool, bool]:
    """What jumps lose along displacements, how many there are, and whether bodies touch first and last.

    Bodies touch from d = 0 on, and part at the least d of fixed grips.
    """
    last = contact.fixed_grips(guess)
    limit = contact.displacement(last)
    jumps = {False: -contact.energy(contact.touch_radius(guess), 0.0), True: contact.energy(last)}
    first = touching = points[0] > (limit if start == "contact" else 0.0)
    lost, count = 0.0, 0
    for point in points[1:]:
        if point < limit if touching else point > 0.0:
            lost, count, touching = lost + jumps[touching], count + 1, not touching
    return lost, count, first, touching


@dataclass(frozen=True)
class Slipping:
    """A pressed contact drawn along x: T(u) = mu (F - F(c)), u = mu (E*/G*) (d - d(c)) (Ciavarella, Jaeger).

    Args:
        contact: without adhesion.
        radius: a [length].
        friction: mu.
        ratio: G*/E*.
    """

    contact: Contact
    radius: float
    friction: float
    ratio: float

    @property
    def sliding(self) -> float:
        """u* [length]."""
        return self.friction / self.ratio * self.contact.displacement(self.radius)

    def stick(self, u: float) -> float:
        """c [length] after the first loading to u."""
        if u >= self.sliding:
            return 0.0
        depth = self.contact.displacement(self.radius) - u * self.ratio / self.friction
        return root(lambda c: self.contact.displacement(c) - depth, 0.0, self.radius)

    def force(self, u: float) -> float:
        """T(u) [force] on the first loading."""
        return self.friction * (self.contact.force(self.radius) - self.contact.force(self.stick(u)))

    def loss(self, u: float) -> float:
        """Energy dissipated on the first loading: 2 int_c^a q (u - q/G*) dx, q = mu E* (d - g)."""
        depth, shear = self.contact.displacement(self.radius), self.ratio * self.contact.modulus

        def density(x: float) -> float:
            limit = self.friction * self.contact.modulus * (depth - self.contact.body.transformed(x))
            return limit * (u - limit / shear)

        return 2.0 * integral(density, *self.contact.body.corners(self.stick(u), self.radius), accuracy=1e-10)
