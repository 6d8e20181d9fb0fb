"""Adhesion that depends on the speed of the receding edge, drawn off at a constant velocity.

With F = 2 E* int_0^a (d - g) dx and the energy release rate G = E* (g(a) - d)^2/(2 pi a),

    -da/dt = v_0 (G/W - 1)^(1/n),    dd/dt = -V

from the equilibrium G = W under a preload. In the variable d that is one equation, stiff where V << v_0.
Sources: D. Maugis, M. Barquins, J. Phys. D 11 (1978) 1989; E. Barthel, J. Phys. D 41 (2008) 163001.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, minimize_scalar

from validation.references.impact import Adhesive
from validation.references.relaxing import Legs, smooth

LEAST = 1e-3
"""Radius over that of the preload at which the edge is not followed further."""


@dataclass(frozen=True)
class Receding:
    """A contact and its edge.

    Args:
        contact: of JKR at rest.
        speed: v_0 [length/time].
        exponent: n.
    """

    contact: Adhesive
    speed: float
    exponent: float

    def force(self, a: float, d: float) -> float:
        """F [force]."""
        body = self.contact.body
        return 2.0 * self.contact.modulus * a * (d - body.depth(a) / (body.exponent + 1.0))

    def excess(self, a: float, d: float) -> float:
        """G/W - 1, at least 0."""
        one = self.contact
        rate = one.modulus * (one.body.depth(a) - d) ** 2 / (2.0 * math.pi * a)
        return max(0.0, rate / one.work - 1.0) if d < one.body.depth(a) else 0.0

    def drawn(self, start: float, velocity: float) -> Any:
        """The solution a over the way that the body is drawn from the equilibrium of that radius [length]."""
        one = self.contact

        def change(drawn: float, y: Any) -> list[float]:
            return [-self.speed / velocity * self.excess(float(y[0]), top - drawn) ** (1.0 / self.exponent)]

        def small(_: float, y: Any) -> float:
            return float(y[0]) - LEAST * start

        small.terminal = True  # type: ignore[attr-defined]
        top = one.displacement(start)
        reach = 100.0 * (top - one.displacement(one.grips)) * (1.0 + (velocity / self.speed) ** self.exponent)
        accuracy = {"method": "LSODA", "rtol": 1e-12, "atol": 1e-15 * start}
        return solve_ivp(change, (0.0, reach), [start], events=small, dense_output=True, **accuracy)

    def pull_off(self, preload: float, velocity: float) -> tuple[float, float]:
        """The largest tension [force] of a body drawn off with a velocity, and the radius there [length]."""
        return self.largest(self.pressed(preload), velocity)

    def largest(self, start: float, velocity: float) -> tuple[float, float]:
        """The same from the equilibrium of a radius."""
        one = self.contact
        top, found = one.displacement(start), self.drawn(start, velocity)

        def slope(drawn: float) -> float:
            """Of F over the way that it is drawn, over 2 E*: -a - (d - g) (v_0/V) (G/W - 1)^(1/n)."""
            a, d = float(found.sol(drawn)[0]), top - drawn
            lost = self.speed / velocity * self.excess(a, d) ** (1.0 / self.exponent)
            return float(-a + (one.body.depth(a) - d) * lost)

        tensions = [-self.force(float(a), top - t) for a, t in zip(found.y[0], found.t, strict=True)]
        i = tensions.index(max(tensions))
        ends = float(found.t[max(0, i - 1)]), float(found.t[min(len(found.t) - 1, i + 1)])
        at = float(brentq(slope, *ends, xtol=1e-300, rtol=1e-14))
        radius = float(found.sol(at)[0])
        return -self.force(radius, top - at), radius

    def separated(self, start: float, velocity: float) -> tuple[float, float, float]:
        """a and d [length] where F = 0, and the work from there on [energy]."""
        top, found = self.contact.displacement(start), self.drawn(start, velocity)

        def force(t: float) -> float:
            return self.force(float(found.sol(t)[0]), top - t)

        i = next(i for i, t in enumerate(found.t) if force(float(t)) < 0.0)
        at = float(brentq(force, float(found.t[i - 1]), float(found.t[i]), xtol=1e-300, rtol=1e-14)) if i else 0.0
        ends = [at, *(float(t) for t in found.t if t > at)]
        return float(found.sol(at)[0]), top - at, -sum(smooth(force, *two, count=8) for two in pairwise(ends))

    def at(self, displacement: float) -> float:
        """The radius [length] of the equilibrium at a displacement of at least 0."""
        high = 2.0 * self.contact.touch
        while self.contact.displacement(high) < displacement:
            high *= 2.0
        low = self.contact.touch
        return float(brentq(lambda a: self.contact.displacement(a) - displacement, low, high, xtol=1e-300, rtol=1e-14))

    def pressed(self, force: float) -> float:
        """The radius [length] of JKR's contact under a force."""
        high = self.contact.touch
        while self.contact.force(high) < force:
            high *= 2.0
        low = self.contact.grips
        while self.contact.force(low) > force:
            low *= 0.5
        # Between the largest tension and high the force only rises.
        least = minimize_scalar(
            lambda a: self.contact.force(a), bounds=(0.5 * low, high), method="bounded", options={"xatol": 1e-12}
        )
        return float(brentq(lambda a: self.contact.force(a) - force, float(least.x), high, xtol=1e-300, rtol=1e-14))


@dataclass(frozen=True)
class Path:
    """What a displacement over time has: states (time, d, a, F), at corners and between; int F dd; when it is lost."""

    states: list[tuple[float, float, float, float]]
    work: float
    touched: float
    lost: float


def path(one: Receding, d: Legs) -> Path:
    """Follow the edge: it is at G = W while the body sinks, unless it still recedes; with an infinite v_0 always.

    Apart, bodies touch from d = 0 on.
    """
    contact, a, work, touched, lost = one.contact, 0.0, 0.0, math.inf, math.inf
    states = [(d.times[0], d.values[0], 0.0, 0.0)]
    if d.values[0] == 0.0 < d.values[1]:
        a, touched = contact.touch, d.times[0]
        states = [(d.times[0], 0.0, a, contact.force(a))]
    for (t0, d0), (t1, d1) in pairwise(d.points):
        rate, start = (d1 - d0) / (t1 - t0), t0
        if a == 0.0 and d1 > 0.0 and math.isinf(lost):
            start, a = t0 + (t1 - t0) * max(0.0, -d0) / (d1 - d0), contact.touch
            touched = start
        if a > 0.0:
            a, part, end = _leg(one, a, d, start, t1, rate, states)
            work, lost = work + part, min(lost, end)
        states.append((t1, d1, a, one.force(a, d1) if a > 0.0 else 0.0))
    return Path(states, work, touched, lost)


def _leg(
    one: Receding, a: float, d: Legs, start: float, stop: float, rate: float, states: list[Any]
) -> tuple[float, float, float]:
    """a at the end, int F dd, and when the contact is lost."""
    contact, work = one.contact, 0.0
    begun, first = start, a

    def at(t: float) -> float:
        return d(begun) + rate * (t - begun)

    if math.isinf(one.speed):
        limit = contact.displacement(contact.grips)
        end = begun + (limit - at(begun)) / rate if rate < 0.0 and at(stop) < limit else stop
        last = contact.grips if end < stop else equilibrium(contact, at(end))
        part = float(quad(lambda x: contact.force(x) * contact.slope(x), a, last, epsrel=1e-12)[0])
        return (0.0, part, end) if end < stop else (last, part, math.inf)
    if one.excess(a, at(begun)) > 0.0 or rate < 0.0:

        def change(t: float, y: Any) -> list[float]:
            return [-one.speed * one.excess(float(y[0]), at(t)) ** (1.0 / one.exponent), rate * one.force(y[0], at(t))]

        def small(_: float, y: Any) -> float:
            return float(y[0]) - LEAST * first

        def settled(t: float, y: Any) -> float:
            g = contact.body.depth(float(y[0])) - at(t)
            return contact.modulus * g * abs(g) / (2.0 * math.pi * float(y[0]) * contact.work) - 1.0

        small.terminal = True  # type: ignore[attr-defined]
        settled.terminal, settled.direction = rate > 0.0, -1.0  # type: ignore[attr-defined]
        accuracy = {"method": "LSODA", "rtol": 1e-11, "atol": [1e-15 * a, 1e-14 * abs(contact.lost)]}
        found = solve_ivp(change, (begun, stop), [a, 0.0], events=(small, settled), **accuracy)
        states += [(t, at(t), x, one.force(x, at(t))) for t, x in zip(found.t, found.y[0], strict=True)]
        begun, a, work = float(found.t[-1]), float(found.y[0, -1]), float(found.y[1, -1])
        if a <= 1.001 * LEAST * first:
            return 0.0, work, begun
    if rate > 0.0 and begun < stop:
        last = equilibrium(contact, d(stop))
        work += float(quad(lambda x: contact.force(x) * contact.slope(x), a, last, epsrel=1e-12)[0])
        a = last
    return a, work, math.inf


def equilibrium(contact: Adhesive, displacement: float) -> float:
    """The radius [length] of the outer equilibrium at a displacement."""
    high = 2.0 * contact.touch
    while contact.displacement(high) < displacement:
        high *= 2.0
    return float(brentq(lambda a: contact.displacement(a) - displacement, contact.grips, high, xtol=1e-300, rtol=1e-14))
