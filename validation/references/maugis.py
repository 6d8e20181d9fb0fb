"""Maugis's contact of a paraboloid under Dugdale's law, by t = arcsec(c/a) in 0 < t <= pi/2 (a = 0).

In reduced form A = a/a_1, C = c/a_1, N = F/(pi W R), D = d R/a_1^2 with a_1^3 = 3 pi W R^2/(4E*),
lambda = (2W/h_0) (9R/(16 pi W E*^2))^(1/3), his two equations are those of a quadratic in C:

    (lambda/2) P C^2 + (4/3) lambda^2 Q C = 1,    P = sin t cos t - t cos 2t,    Q = t sin t + cos t - 1
    N = A^3 - lambda [A S + t C^2],    D = A^2 - (4/3) lambda S,    A = C cos t,    S = C sin t

P = 2 t^2 j_1(2t) and Q = t sin t - 2 sin^2(t/2) lose nothing at either end, where c/a - 1 is 0 (JKR) or infinite (DMT).
With a = 0 the zone goes on alone: N = -(pi/2) lambda C^2, D = C^2/2 - (8 lambda/3 pi) C - 2/(pi lambda).
Source: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Generic, TypeVar

import numpy as np
from scipy.special import spherical_jn

from validation.references.numerics import Floats, Pair, root

LAMBDA_OVER_TABOR = 2.0 * math.cbrt(9.0 / (16.0 * math.pi))
"""For the stress W/h_0 (Maugis 1992)."""
JKR_SIDE, DMT_SIDE = 1e-3, 1e-7
"""t (1 + lambda) of a contact much wider than one without a load; pi/2 - t, over lambda below 1, of one much narrower
than that of the largest tension."""
HALVINGS = 60
"""Of 0 < t < pi/2, down to round-off."""
Number = TypeVar("Number", float, Floats)


@dataclass(frozen=True)
class States(Generic[Number]):
    """A, C, N, D in reduced form, of one state or of many."""

    a: Number
    c: Number
    load: Number
    displacement: Number


State = States[float]


@dataclass(frozen=True)
class Reduced:
    """The contact of one lambda."""

    parameter: float

    @property
    def ends(self) -> Pair:
        """Angles of a wide and of a narrow contact."""
        return JKR_SIDE / (1.0 + self.parameter), 0.5 * math.pi - DMT_SIDE * min(1.0, self.parameter)

    def _width(self, t: Number) -> tuple[Number, Number]:
        """C, dC/dt."""
        square = self.parameter * t * t * spherical_jn(1, 2.0 * t)
        linear = 4.0 / 3.0 * self.parameter**2 * (t * np.sin(t) - 2.0 * np.sin(0.5 * t) ** 2)
        c = 2.0 / (linear + np.sqrt(linear**2 + 4.0 * square))
        rise = self.parameter * t * (np.sin(2.0 * t) * c + 4.0 / 3.0 * self.parameter * np.cos(t))
        return c, -c * rise / (2.0 * square * c + linear)

    def state(self, t: Number) -> States[Number]:
        """In contact."""
        c, _ = self._width(t)
        a, s = c * np.cos(t), c * np.sin(t)
        return States(a, c, a**3 - self.parameter * (a * s + t * c * c), a * a - 4.0 / 3.0 * self.parameter * s)

    def slopes(self, t: float) -> Pair:
        """dN/dt, dD/dt."""
        c, rise = self._width(t)
        cos, sin = math.cos(t), math.sin(t)
        a, da = c * cos, rise * cos - c * sin
        dn = 3.0 * a * a * da - 2.0 * self.parameter * c * (rise * (sin * cos + t) + c * cos * cos)
        return dn, 2.0 * a * da - 4.0 / 3.0 * self.parameter * (rise * sin + c * cos)

    def alone(self, c: Number) -> States[Number]:
        """Before contact."""
        zone = 0.5 * c * c - 8.0 / (3.0 * math.pi) * self.parameter * c - 2.0 / (math.pi * self.parameter)
        return States(0.0 * c, c, -0.5 * math.pi * self.parameter * c * c, zone)

    def of_radii(self, a: Floats) -> States[Floats]:
        """The contacts of those A > 0, by bisection."""
        low, high = np.zeros_like(a), np.full_like(a, 0.5 * math.pi)
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            wider = self.state(middle).a > a
            low, high = np.where(wider, middle, low), np.where(wider, high, middle)
        return self.state(0.5 * (low + high))

    def of_radius(self, a: float) -> State:
        """The contact of that A >= 0."""
        if a == 0.0:
            return self.state(0.5 * math.pi)
        low, high = self.ends
        while self.state(low).a < a:
            low *= 0.1
        high = high if self.state(high).a < a else 0.5 * math.pi
        return self.state(root(lambda t: self.state(t).a - a, low, high))

    @cached_property
    def critical(self) -> State:
        """Of the largest tension."""
        return self.state(root(lambda t: self.slopes(t)[0], *self.ends))

    @cached_property
    def free(self) -> State:
        """Without a load."""
        return self.state(root(lambda t: self.state(t).load, *self.ends))

    @property
    def has_fold(self) -> bool:
        """Whether a contact snaps out; otherwise it shrinks to a = 0, and the zone alone snaps out later."""
        return self.slopes(self.ends[1])[1] > 0.0

    @cached_property
    def snap_out(self) -> State:
        """The last state under fixed grips."""
        if self.has_fold:
            return self.state(root(lambda t: self.slopes(t)[1], *self.ends))
        return self.alone(8.0 / (3.0 * math.pi) * self.parameter)


@dataclass(frozen=True)
class Paraboloid:
    """The contact in any consistent units.

    Args:
        radius: R [length].
        modulus: E* [stress].
        work: W [force/length].
        reach: h_0 of Dugdale's law [length].
    """

    radius: float
    modulus: float
    work: float
    reach: float

    @property
    def unit_radius(self) -> float:
        """a_1 [length]."""
        return math.cbrt(0.75 * math.pi * self.work * self.radius**2 / self.modulus)

    @property
    def unit_force(self) -> float:
        """pi W R [force]."""
        return math.pi * self.work * self.radius

    @property
    def tabor(self) -> float:
        """mu of the range."""
        return math.cbrt(self.radius * (self.work / self.modulus) ** 2) / self.reach

    @property
    def reduced(self) -> Reduced:
        """In reduced form."""
        return Reduced(LAMBDA_OVER_TABOR * self.tabor)

    def state(self, reduced: State) -> State:
        """a, c [length], F [force], d [length]."""
        a = self.unit_radius
        return State(
            a * reduced.a, a * reduced.c, self.unit_force * reduced.load, a * a / self.radius * reduced.displacement
        )


def of_tabor(mu: float, radius: float = 1.0, modulus: float = 1.0, work: float = 1.0) -> Paraboloid:
    """The contact of a Tabor parameter of Dugdale's range."""
    return Paraboloid(radius, modulus, work, math.cbrt(radius * (work / modulus) ** 2) / mu)


def marks(parameter: float) -> Pair:
    """a_cr/a_0, and F_A/(pi W R), of the largest tension."""
    one = Reduced(parameter)
    return one.critical.a / one.free.a, -one.critical.load


def tabor_of(ratio: float, parameters: Pair) -> Pair:
    """Tabor's mu, and F_A/(pi W R), where a_cr/a_0 is `ratio`; NaN where that is outside of `parameters` (lambda)."""
    low, high = map(math.log, parameters)

    def off(logarithm: float) -> float:
        return marks(math.exp(logarithm))[0] - ratio

    if off(low) * off(high) > 0.0:
        return math.nan, math.nan
    parameter = math.exp(root(off, low, high))
    return parameter / LAMBDA_OVER_TABOR, marks(parameter)[1]
