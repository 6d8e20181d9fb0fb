"""Rigid bodies f(r) = c r^n on a viscoelastic half-space: Lee and Radok, Ting, creep, punch, Kelvin and Voigt.

The plane-strain modulus relaxes by a Prony series of the instantaneous one, at constant Poisson's ratio,

    E(t) = E_0 [1 - sum_j p_j (1 - exp(-t/tau_j))],    int_0^t E(t - s) dC(s) = 1

with the creep compliance C. In the elastic contact of radius a: d = g(a) = kappa_n c a^n and
F = 2 E* n/(n + 1) kappa_n c a^(n + 1), kappa_n = (sqrt(pi)/2) n Gamma(n/2)/Gamma((n + 1)/2). The surface at x
is touched at the time t_0(x), d(t_0) = g(x). While a grows (Lee and Radok)

    F(t) = 2 int_0^a(t) E(t - t_0(x)) x g'(x) dx,    2 n/(n + 1) kappa_n c a^(n + 1) = int_0^t C(t - s) dF(s)

While it shrinks, a(t) = a(t_1) with the time t_1 < t_m before the maximum (Ting), where

    int_(t_1)^t E(t - s) d'(s) ds = 0,    F(t) = 2 int_0^(t_1) E(t - s) a(s) d'(s) ds

so that contact ends where t_1 = 0. Under a given F the second equation has t_1, and the first one d(t), by C.
Kelvin-Voigt, E* and a retardation time A: F = F_el(d) + 2 E* A a d' while d grows, F_el(max(0, d + A d')) while it
falls. Everything is by quadrature and root finding; nothing is shared with the program.
Sources: E. H. Lee, J. R. M. Radok, J. Appl. Mech. 27 (1960) 438; T. C. T. Ting, J. Appl. Mech. 33 (1966) 845.
"""

import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TypeVar

import numpy as np

from validation.references import numerics
from validation.references.numerics import Floats, Function, Pair, root, smooth

Number = TypeVar("Number", float, Floats)
NO_REST = 1e-12
"""Share of the modulus that remains below which nothing does."""
SCAN = 60
"""Points of a leg at which a maximum or a turn is first searched for."""
LAYERS = (1.0, 5.0, 25.0, 125.0)
"""Times over a relaxation time, within which forces change by themselves after a corner, or a past is felt."""


@dataclass(frozen=True)
class Material:
    """A Prony series of the instantaneous plane-strain modulus.

    Args:
        terms: (share p_j [1], time tau_j [time]) of each arm.
        modulus: E_0 [stress].
    """

    terms: tuple[Pair, ...]
    modulus: float = 1.0

    @property
    def rest(self) -> float:
        """E(inf)/E_0."""
        remaining = 1.0 - sum(share for share, _ in self.terms)
        return remaining if abs(remaining) > NO_REST else 0.0

    def relaxed(self, t: float) -> float:
        """E(t) [stress]."""
        return self.modulus * (self.rest + sum(p * math.exp(-t / tau) for p, tau in self.terms))

    def impulse(self, t: float) -> float:
        """int_0^t E [stress time]."""
        return self.modulus * (self.rest * t - sum(p * tau * math.expm1(-t / tau) for p, tau in self.terms))

    @cached_property
    def retarded(self) -> tuple[float, float, list[Pair]]:
        """C(0), the rate of its flow, and (compliance, rate) of each retardation: by inversion of its transform.

        s times the transform of E is N(s)/D(s), D = prod_j (1 + s tau_j); that of C is D/(s N).
        """
        factors = [np.poly1d([tau, 1.0]) for _, tau in self.terms]
        D = math.prod(factors, start=np.poly1d([1.0]))
        N = self.rest * D
        for j, (p, tau) in enumerate(self.terms):
            N += math.prod(factors[:j] + factors[j + 1 :], start=np.poly1d([p * tau, 0.0]))
        N *= self.modulus
        flow, poles = 0.0, N
        if self.rest == 0.0 and self.terms:
            poles = np.poly1d(N.coeffs[:-1])
            flow = float(1.0 / poles(0.0))
        rates = np.roots(poles.coeffs).real.tolist()
        slope = np.polyder(N)
        return 1.0 / self.modulus, flow, [(float(D(s) / (s * slope(s))), s) for s in rates]

    def creep(self, t: float) -> float:
        """C(t) [1/stress]."""
        at_once, flow, arms = self.retarded
        return at_once + flow * t + sum(c * math.expm1(s * t) for c, s in arms)

    def creep_rate(self, t: float) -> float:
        """dC/dt [1/(stress time)]."""
        _, flow, arms = self.retarded
        return flow + sum(c * s * math.exp(s * t) for c, s in arms)

    def yielded(self, t: Number) -> Number:
        """int_0^t C [time/stress]."""
        at_once, flow, arms = self.retarded
        slow: Number = sum((c * (np.expm1(s * t) / s - t) for c, s in arms), 0.0 * t)
        return at_once * t + 0.5 * flow * t * t + slow


@dataclass(frozen=True)
class Power:
    """f(r) = c r^n: a paraboloid of n = 2, c = 1/(2R), a cone of n = 1."""

    exponent: float
    factor: float

    @property
    def reduced(self) -> float:
        """kappa_n c."""
        n = self.exponent
        return self.factor * 0.5 * math.sqrt(math.pi) * n * math.gamma(0.5 * n) / math.gamma(0.5 * (n + 1.0))

    def depth(self, a: Number) -> Number:
        """g(a) [length]."""
        depth: Number = self.reduced * a**self.exponent
        return depth

    def radius(self, d: float) -> float:
        """a [length] of an elastic contact at d."""
        return float((max(0.0, d) / self.reduced) ** (1.0 / self.exponent))

    def volume(self, a: float) -> float:
        """F/E* [length^2] of an elastic contact of that radius."""
        return 2.0 * self.exponent / (self.exponent + 1.0) * self.depth(a) * a

    def of_volume(self, volume: Number) -> Number:
        """The radius [length] where F/E* is that."""
        n = self.exponent
        radius: Number = np.maximum(0.0, volume * (n + 1.0) / (2.0 * n * self.reduced)) ** (1.0 / (n + 1.0))
        return radius


@dataclass(frozen=True)
class Flat:
    """The flat end of a punch, for springs: a body 0 r^2 of no depth that ends at its radius [length]."""

    end: float
    exponent: float = 2.0
    factor: float = 0.0

    def depth(self, a: float) -> float:
        """g(a) [length]."""
        return 0.0


def sphere(radius: float) -> Power:
    """The paraboloid of that R."""
    return Power(2.0, 0.5 / radius)


@dataclass(frozen=True)
class Legs:
    """A function of time that is linear between points (t, value); as at its ends beyond."""

    points: tuple[Pair, ...]

    @property
    def times(self) -> list[float]:
        """Of the points."""
        return [t for t, _ in self.points]

    @property
    def values(self) -> list[float]:
        """At the points."""
        return [value for _, value in self.points]

    def __call__(self, t: float) -> float:
        """The value at t."""
        return float(np.interp(t, self.times, self.values))

    def rate(self, t: float) -> float:
        """Of the leg that begins at or before t, 0 outside."""
        i = bisect_right(self.times, t)
        return self._slopes[i - 1] if 0 < i < len(self.points) else 0.0

    @cached_property
    def _slopes(self) -> list[float]:
        return [(y1 - y0) / (t1 - t0) for (t0, y0), (t1, y1) in pairwise(self.points)]

    def pieces(self, low: float, high: float) -> list[tuple[float, float, float]]:
        """(from, to, rate) of each leg between two times."""
        legs = zip(pairwise(self.times), self._slopes, strict=True)
        parts = ((max(a, low), min(b, high), rate) for (a, b), rate in legs)
        return [part for part in parts if part[1] > part[0]]

    def hereditary(self, impulse: Function, t: float, low: float = -math.inf) -> float:
        """int_low^t kernel(t - s) d value(s), from the integral of the kernel; a first value that is not 0 is a jump
        that is not counted."""
        return sum(rate * (impulse(t - start) - impulse(t - stop)) for start, stop, rate in self.pieces(low, t))

    def corners(self, low: float, high: float) -> list[float]:
        """Two times and those of the points between them."""
        return [low, *(t for t in self.times if low < t < high), high]

    def work(self, displacement: Function, turn: float) -> float:
        """int F dx of a force that begins and ends at 0, -int x dF; x(t) is smooth but at the points and at a turn."""
        return -sum(
            self.rate(0.5 * (low + high)) * smooth(displacement, low, high, 24)
            for low, high in pairwise(sorted({*self.times, turn}))
        )

    def touched(self, depth: float) -> float:
        """The first time at which the value is so large; inf if it never is."""
        for (t0, y0), (t1, y1) in pairwise(self.points):
            if y0 >= depth:
                return t0
            if y1 >= depth:
                return t0 + (t1 - t0) * (depth - y0) / (y1 - y0)
        return math.inf


def has_one_maximum(d: Legs) -> bool:
    """Whether it grows, is held, and falls at one rate."""
    signs = [(y > x) - (y < x) for x, y in pairwise(d.values)]
    falls = signs.index(-1) if -1 in signs else len(signs)
    return len(signs) - falls <= 1


@dataclass(frozen=True)
class Indentation:
    """A body pushed in by a displacement that grows to one maximum and then falls at one rate, until contact ends.

    Raises ValueError where the displacement falls before it has its maximum, grows thereafter, or falls at several
    rates: a surface that recovers faster than the body recedes would make the contact larger again.
    """

    body: Power
    material: Material
    d: Legs

    def __post_init__(self) -> None:
        """Refuse several maxima."""
        if not has_one_maximum(self.d):
            raise ValueError("the displacement has several maxima, or falls at several rates")

    @property
    def turn(self) -> float:
        """When the displacement first begins to fall."""
        return max(t for t, y in self.d.points if y == max(self.d.values))

    @property
    def start(self) -> float:
        """When the surface is first touched."""
        return self.d.touched(0.0)

    @cached_property
    def end(self) -> float:
        """When contact ends; inf where it lasts."""
        last = self.d.times[-1]
        if last <= self.turn or self._carried(last, self.start) > 0.0:
            return math.inf
        return root(lambda t: self._carried(t, self.start), self.turn, last)

    def _carried(self, t: float, since: float) -> float:
        """int_since^t E(t - s) dd(s): the pressure in one dimension where touched at `since`."""
        return self.d.hereditary(self.material.impulse, t, since)

    def before(self, t: float) -> float:
        """t_1(t), at which the contact had the same radius; t itself while it grows."""
        if t <= self.turn:
            return t
        if t >= self.end:
            return self.start
        return root(lambda s: self._carried(t, s), self.start, self.turn)

    def radius(self, t: float) -> float:
        """a(t) [length]."""
        return self.body.radius(self.d(self.before(t))) if t < self.end else 0.0

    def force(self, t: float) -> float:
        """F(t) [force]."""
        if t >= self.end or t <= self.start:
            return 0.0
        total, n = 0.0, self.body.exponent
        for start, stop, rate in self.d.pieces(self.start, self.before(t)):
            low, high = (self.body.radius(self.d(s)) for s in (start, stop))

            def carried(x: float, start: float = start, low: float = low, rate: float = rate) -> float:
                touched = start + (self.body.depth(x) - self.body.depth(low)) / rate
                return self.material.relaxed(max(0.0, t - touched)) * n * self.body.depth(x)

            layers = [t - times * tau for _, tau in self.material.terms for times in LAYERS]
            ends = sorted({low, high, *(self.body.radius(self.d(s)) for s in layers if start < s < stop)})
            total += numerics.integral(carried, *ends, accuracy=1e-11) if rate > 0.0 else 0.0
        return 2.0 * total

    @cached_property
    def peak(self) -> Pair:
        """When the force is largest, and that force."""
        return largest(self.force, [t for t in self.d.times if t < self.end])

    @cached_property
    def work(self) -> float:
        """int F dd to the end of the history or of contact [energy]."""
        stop, total = min(self.end, self.d.times[-1]), 0.0
        for low, high, rate in self.d.pieces(self.start, stop):
            layers = [low + times * tau for _, tau in self.material.terms for times in LAYERS]
            ends = sorted({low, high, *(end for end in layers if end < high)})
            total += rate * sum(smooth(self.force, *ends) for ends in pairwise(ends)) if rate else 0.0
        return total


def largest(function: Function, corners: Sequence[float]) -> Pair:
    """Where a function that is smooth between corners is largest, and its value there."""
    points = [a + (b - a) * i / SCAN for a, b in pairwise(corners) for i in range(SCAN)]
    return numerics.largest(function, [*points, corners[-1]])


@dataclass(frozen=True)
class Punch:
    """A flat punch of a radius, in contact throughout."""

    radius: float
    material: Material

    def force(self, d: Legs, t: float) -> float:
        """F(t) [force] of d(t)."""
        return 2.0 * self.radius * d.hereditary(self.material.impulse, t)

    def displacement(self, force: Legs, t: float) -> float:
        """d(t) [length] of F(t)."""
        return force.hereditary(self.material.yielded, t) / (2.0 * self.radius)


@dataclass(frozen=True)
class KelvinVoigt:
    """A body on a half-space of Kelvin and Voigt, pushed in and drawn out once.

    Args:
        body: its profile.
        time: A, of retardation [time].
        modulus: E* [stress].
    """

    body: Power
    time: float
    modulus: float = 1.0

    def radius(self, d: float, rate: float) -> float:
        """a [length]."""
        return self.body.radius(d if rate >= 0.0 else d + self.time * rate)

    def force(self, d: float, rate: float) -> float:
        """F [force] of displacement and rate."""
        a = self.radius(d, rate)
        return self.modulus * (self.body.volume(a) + (2.0 * self.time * a * rate if rate > 0.0 else 0.0))
