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

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

ACCURACY = 1e-12
"""Relative accuracy asked of each piece of a quadrature."""
SCAN = 48
"""Radii of the first search for sign changes between two kinks, and per decade beyond the last."""
DECADES = 4.0
"""Of radii that are searched on either side of the guess."""
CLOSE = 1e-9
"""Relative distance of a radius from a kink at which it counts as beyond it."""
Function = Callable[[float], float]


@dataclass(frozen=True)
class Body:
    """A body of revolution that touches at r = 0.

    Args:
        slope: f'(r) [1] for r >= 0, at a kink that of its outer side.
        bend: f''(r) [1/length] between kinks; at a kink that of the outer side.
        kinks: b_k > 0 [length], rising, where slope or bend jump.
        jumps: J_k of the slope there [1]; 0 where only the bend jumps.
        end: radius at which there is a flank (a flat punch), inf where there is none [length].
        limit: radius below which contacts are searched for, as of a sphere [length].
    """

    slope: Function
    bend: Function
    kinks: tuple[float, ...] = ()
    jumps: tuple[float, ...] = ()
    end: float = math.inf
    limit: float = math.inf

    def height(self, radius: float) -> float:
        """f(r) [length]."""
        ends = [0.0, *(b for b in self.kinks if b < radius), radius]
        return sum(_piece(self.slope, low, high) for low, high in pairwise(ends))

    def angles(self, radius: float) -> list[float]:
        """0, the angles phi of the kinks inside the radius, pi/2."""
        return [0.0, *(math.asin(b / radius) for b in self.kinks if b < radius), 0.5 * math.pi]

    def over_angles(self, function: Callable[[float, float], float], radius: float) -> float:
        """int_0^(pi/2) function(r, phi) dphi with r = radius sin phi, piece by piece."""
        ends = self.angles(radius)
        return sum(_piece(lambda phi: function(radius * math.sin(phi), phi), low, high) for low, high in pairwise(ends))

    def transformed(self, x: float) -> float:
        """g(x) [length]; x >= 0."""
        return x * self.over_angles(lambda r, _: self.slope(r), x) if x > 0.0 else 0.0

    def rise(self, x: float) -> float:
        """x g'(x) [length], infinite at a kink of the slope; x > 0."""
        jumps = sum(
            jump * b * x / math.sqrt((x - b) * (x + b)) if x > b else math.inf if x == b and jump > 0.0 else 0.0
            for b, jump in zip(self.kinks, self.jumps, strict=True)
            if x >= b
        )
        return self.transformed(x) + x * x * self.over_angles(lambda r, phi: self.bend(r) * math.sin(phi), x) + jumps

    def area(self, x: float) -> float:
        """int_0^x g dx = int_0^x f'(r) sqrt(x^2 - r^2) dr [length^2]."""
        return x * x * self.over_angles(lambda r, phi: self.slope(r) * math.cos(phi) ** 2, x) if x > 0.0 else 0.0


def _piece(function: Function, low: float, high: float) -> float:
    """The integral between two kinks."""
    return (
        float(quad(function, low, high, epsrel=ACCURACY, epsabs=0.0, limit=400, full_output=1)[0])
        if high > low
        else 0.0
    )


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

    def energy(self, a: float, d: float | None = None) -> float:
        """E(a) [energy]."""
        depth = self.displacement(a) if d is None else d
        ends = [0.0, *(b for b in self.body.kinks if b < a), a]
        elastic = sum(
            float(
                quad(
                    lambda x: (depth - self.body.transformed(x)) ** 2, low, high, epsrel=1e-10, limit=200, full_output=1
                )[0]
            )
            for low, high in pairwise(ends)
        )
        return self.modulus * elastic - math.pi * a * a * self.work

    def pressed_radius(self, force: float, guess: float) -> float:
        """The largest a with F(a) = force, from beyond [length]."""
        return self._down(lambda a: self.force(a) - force, guess)

    def radius_at(self, displacement: float, guess: float) -> float:
        """The largest a with d(a) = displacement [length]."""
        return self._down(lambda a: self.displacement(a) - displacement, guess)

    def _down(self, function: Function, guess: float) -> float:
        """The largest root of a function that is positive far outside."""
        if math.isfinite(self.body.end):
            return self.body.end
        high = guess
        while function(high) <= 0.0:
            high *= 1.5
            if high > self.body.limit:
                raise ValueError("the contact would cover the body")
        # A dip beside a limit point may be narrower than the grid.
        for closer in (False, self.work > 0.0):
            last, added = high, [self.fixed_grips(guess), self.critical(guess)] if closer else []
            for low in sorted({*self._grid(high), *added}, reverse=True):
                if low < last and function(low) <= 0.0:
                    return float(brentq(function, low, last, xtol=1e-300, rtol=1e-14))
                last = min(last, low)
        raise ValueError("no contact carries so little")

    def _grid(self, guess: float) -> list[float]:
        low, high = guess * 10.0**-DECADES, min(guess * 10.0 ** (0.5 * DECADES), self.body.limit)
        pieces = [low, *(b for b in self.body.kinks if low < b < high), high]
        points: list[float] = []
        for start, stop in pairwise(pieces):
            count = max(SCAN, round(SCAN * math.log10(stop / start)))
            points += [start * (stop / start) ** (i / count) for i in range(count)]
        return [*points, high]

    def _turns(self, share: float, guess: float) -> list[float]:
        """Radii at which a g' rises through share Delta_l: minima of d (1/2) or F (3/2)."""
        if math.isfinite(self.body.end):
            return [self.body.end]

        def excess(a: float) -> float:
            return self.body.rise(a) - share * self.stretch(a)

        found, grid = [], self._grid(guess)
        kinks = set(self.body.kinks)
        for low, high in pairwise(grid):
            inside = low * (1.0 + CLOSE) if low in kinks else low
            below, above = excess(inside), excess(high * (1.0 - CLOSE) if high in kinks else high)
            if below < 0.0 <= above:
                found.append(float(brentq(excess, inside, high * (1.0 - CLOSE) if high in kinks else high, rtol=1e-14)))
            if high in kinks and excess(high * (1.0 - CLOSE)) < 0.0 < excess(high * (1.0 + CLOSE)):
                found.append(high)
        return found

    def fixed_grips(self, guess: float) -> float:
        """a at the least d, where bodies part under fixed grips [length]."""
        return min(self._turns(0.5, guess), key=self.displacement)

    def has_one_edge(self, guess: float) -> bool:
        """Whether d(a) only rises beyond its least value, so that the edge recedes without a jump."""
        least = self.fixed_grips(guess)
        return max(self._turns(0.5, guess)) == least

    def critical(self, guess: float) -> float:
        """a at the largest tension of the contacts that fixed grips hold [length]."""
        least = self.fixed_grips(guess)
        return min([least, *(a for a in self._turns(1.5, guess) if a > least)], key=self.force)

    def softest_outer(self, guess: float) -> float:
        """a of the outermost force maximum, where a load that falls ends the contact [length]."""
        return max([self.fixed_grips(guess), *self._turns(1.5, guess)])

    def touch_radius(self, guess: float) -> float:
        """a of the contact that forms at d = 0: the first at which d(a) rises to 0 [length]."""
        if math.isfinite(self.body.end):
            return self.body.end
        grid = [a for a in self._grid(guess) if self.displacement(a) < 0.0]
        low = grid[0]
        for a in self._grid(guess):
            if a > low and self.displacement(a) >= 0.0:
                return float(brentq(self.displacement, low, a, rtol=1e-14))
            low = max(low, a)
        raise ValueError("no contact at d = 0")

    def pressure(self, r: float, a: float, d: float | None = None) -> float:
        """p(r) [stress] of a body without kinks of the slope, 0 < r < a.

        p = (E*/pi) [int_0^s g'(x)/x dt - (g(a) - d... the jump at the edge)/s], x^2 = r^2 + t^2, s^2 = a^2 - r^2.
        """
        s = math.sqrt((a - r) * (a + r))
        jump = self.body.transformed(a) - (self.displacement(a) if d is None else d)

        def inner(t: float) -> float:
            x = math.hypot(r, t)
            return self.body.rise(x) / (x * x)

        ends = [0.0, *(math.sqrt((b - r) * (b + r)) for b in self.body.kinks if r < b < a), s]
        inside = sum(
            float(quad(inner, low, high, epsrel=1e-9, epsabs=0.0, limit=200, full_output=1)[0])
            for low, high in pairwise(ends)
        )
        return self.modulus / math.pi * (inside - jump / s)

    def central_pressure(self, a: float, d: float | None = None) -> float:
        """p(0) [stress]; inf under a tip.

        p(0) = (E*/pi) [int_0^a f'(r) (1/sqrt(a^2 - r^2) + arccos(r/a)/r) dr - jump/a].
        """
        if self.body.slope(0.0) > 0.0:
            return math.inf
        jump = self.body.transformed(a) - (self.displacement(a) if d is None else d)
        ends = [0.0, *(b for b in self.body.kinks if b < a), a]
        inside = sum(
            _piece(lambda v: _log_substituted(self.body.slope, a, v), math.log(max(low, 1e-300 * a)), math.log(high))
            if low > 0.0 else _root(self.body.slope, a, high)
            for low, high in pairwise(ends)
        )  # fmt: skip
        return self.modulus / math.pi * (inside + self.body.transformed(a) / a - jump / a)

    def peak_pressure(self, a: float, d: float | None = None) -> float:
        """The largest p(r) [stress]; inf under a tip or where the slope jumps inside."""
        if any(jump > 0.0 and b < a for b, jump in zip(self.body.kinks, self.body.jumps, strict=True)):
            return math.inf
        middle = self.central_pressure(a, d)
        if math.isinf(middle):
            return middle
        places = [a * (i + 0.5) / 24.0 for i in range(23)]
        values = [self.pressure(r, a, d) for r in places]
        best = int(np.argmax(values))
        if best == 0 and middle >= values[0]:
            return middle
        low, high = (places[max(0, best - 1)] if best else 1e-6 * a), places[min(best + 1, len(places) - 1)]
        if best == len(places) - 1:
            high = a * (1.0 - 1e-9)
        found = minimize_scalar(lambda r: -self.pressure(r, a, d), bounds=(low, high), method="bounded",
                                options={"xatol": 1e-9 * a})  # fmt: skip
        return max(middle, -float(found.fun))


def _log_substituted(slope: Function, a: float, v: float) -> float:
    r = math.exp(v)
    return slope(r) * math.acos(min(1.0, r / a))


def _root(slope: Function, a: float, high: float) -> float:
    """int_0^high f'(r) arccos(r/a)/r dr with r = high v^20: no pole at 0."""
    return _piece(lambda v: 20.0 / v * slope(high * v**20) * math.acos(min(1.0, high * v**20 / a)), 1e-6, 1.0)


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
    limit, touching = contact.displacement(last), points[0] > 0.0
    into = contact.touch_radius(guess)
    gained, kept = -contact.energy(into, 0.0), contact.energy(last)
    if start == "contact":
        touching = points[0] > limit
    first, lost, jumps = touching, 0.0, 0
    for point in points[1:]:
        if touching and point < limit:
            lost, jumps, touching = lost + kept, jumps + 1, False
        elif not touching and point > 0.0:
            lost, jumps, touching = lost + gained, jumps + 1, True
    return lost, jumps, first, touching


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
        return float(brentq(lambda c: self.contact.displacement(c) - depth, 0.0, self.radius, xtol=1e-300, rtol=1e-14))

    def force(self, u: float) -> float:
        """T(u) [force] on the first loading."""
        return self.friction * (self.contact.force(self.radius) - self.contact.force(self.stick(u)))

    def loss(self, u: float) -> float:
        """Energy dissipated on the first loading: 2 int_c^a q (u - q/G*) dx, q = mu E* (d - g)."""
        depth, shear = self.contact.displacement(self.radius), self.ratio * self.contact.modulus
        c = self.stick(u)

        def density(x: float) -> float:
            limit = self.friction * self.contact.modulus * (depth - self.contact.body.transformed(x))
            return limit * (u - limit / shear)

        ends = [c, *(b for b in self.contact.body.kinks if c < b < self.radius), self.radius]
        return 2.0 * sum(
            float(quad(density, low, high, epsrel=1e-10, epsabs=0.0, limit=200, full_output=1)[0])
            for low, high in pairwise(ends)
        )
