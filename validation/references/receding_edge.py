"""Adhesion that depends on the speed of the receding edge, drawn off at a constant velocity.

With F = 2 E* int_0^a (d - g) dx and the energy release rate G = E* (g(a) - d)^2/(2 pi a),

    -da/dt = v_0 (G/W - 1)^(1/n),    dd/dt = -V

from the equilibrium G = W under a preload. In the variable d that is one equation, stiff where V << v_0.
Sources: D. Maugis, M. Barquins, J. Phys. D 11 (1978) 1989; E. Barthel, J. Phys. D 41 (2008) 163001.
"""

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from scipy.integrate import solve_ivp

from validation.references.impact import Adhesive
from validation.references.numerics import Pair, integral, root
from validation.references.relaxing import Legs

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

    def followed(self, a: float, d: float, rate: float, until: float, settling: bool = False) -> Any:
        """The solution (a, int F dd) over the time since an edge at a recedes, at a displacement d + rate t.

        It ends where next to nothing touches, and where the edge comes to rest at G = W if it is `settling`.
        """
        contact = self.contact

        def change(t: float, y: Any) -> list[float]:
            radius, place = y[0], d + rate * t
            return [-self.speed * self.excess(radius, place) ** (1.0 / self.exponent), rate * self.force(radius, place)]

        def small(_: float, y: Any) -> float:
            return float(y[0]) - LEAST * a

        def settled(t: float, y: Any) -> float:
            g = contact.body.depth(y[0]) - d - rate * t
            return float(contact.modulus * g * abs(g) / (2.0 * math.pi * y[0] * contact.work)) - 1.0

        small.terminal = True  # type: ignore[attr-defined]  # scipy reads it off the function
        settled.terminal, settled.direction = settling, -1.0  # type: ignore[attr-defined]  # as above
        accuracy = {"method": "LSODA", "rtol": 1e-12, "atol": [1e-15 * a, 1e-14 * abs(contact.lost)]}
        return solve_ivp(change, (0.0, until), [a, 0.0], events=(small, settled), dense_output=True, **accuracy)

    def drawn(self, start: float, velocity: float) -> Any:
        """The same over the way that a body is drawn from the equilibrium of that radius [length], until it is off."""
        one = self.contact
        reach = 100.0 * (one.displacement(start) - one.displacement(one.grips))
        each = replace(self, speed=self.speed / velocity)
        reach *= 1.0 + (velocity / self.speed) ** self.exponent
        return each.followed(start, one.displacement(start), -1.0, reach)

    def pull_off(self, preload: float, velocity: float) -> Pair:
        """The largest tension [force] of a body drawn off with a velocity, and the radius there [length]."""
        return self.largest(self.pressed(preload), velocity)

    def largest(self, start: float, velocity: float) -> Pair:
        """The same from the equilibrium of a radius."""
        one, found = self.contact, self.drawn(start, velocity)

        def state(way: float) -> Pair:
            return float(found.sol(way)[0]), one.displacement(start) - way

        def slope(way: float) -> float:
            """Of F over the way that it is drawn, over 2 E*: -a - (d - g) (v_0/V) (G/W - 1)^(1/n)."""
            a, d = state(way)
            lost: float = self.speed / velocity * self.excess(a, d) ** (1.0 / self.exponent)
            return -a + (one.body.depth(a) - d) * lost

        tensions = [-self.force(*state(way)) for way in found.t]
        i = tensions.index(max(tensions))
        at = root(slope, found.t[max(0, i - 1)], found.t[min(len(found.t) - 1, i + 1)])
        return -self.force(*state(at)), state(at)[0]

    def separated(self, start: float, velocity: float) -> tuple[float, float, float]:
        """a and d [length] where F = 0, and the work from there on [energy]."""
        top, found = self.contact.displacement(start), self.drawn(start, velocity)

        def force(way: float) -> float:
            return self.force(found.sol(way)[0], top - way)

        i = next(i for i, way in enumerate(found.t) if force(way) < 0.0)
        at = root(force, found.t[i - 1], found.t[i]) if i else 0.0
        radius, work = map(float, found.sol(at))
        return radius, top - at, found.y[1, -1] - work

    def pressed(self, force: float) -> float:
        """The radius [length] of JKR's contact under a force."""
        return self.contact.radius_under(force)


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
    contact, here, work = one.contact, d(start), 0.0
    limit = contact.displacement(contact.grips)

    def at_rest(last: float) -> float:
        return integral(lambda x: contact.force(x) * contact.slope(x), *sorted((a, last))) * (1.0 if last > a else -1.0)

    if math.isinf(one.speed) and rate < 0.0 and here + rate * (stop - start) < limit:
        return 0.0, at_rest(contact.grips), start + (limit - here) / rate
    if math.isfinite(one.speed) and (one.excess(a, here) > 0.0 or rate < 0.0):
        found, first = one.followed(a, here, rate, stop - start, rate > 0.0), a
        states += [(start + t, here + rate * t, x, one.force(x, here + rate * t))
                   for t, x in zip(found.t, found.y[0], strict=True)]  # fmt: skip
        start, a, work = start + found.t[-1], found.y[0, -1], found.y[1, -1]
        if a <= 1.001 * LEAST * first:
            return 0.0, work, start
    if math.isinf(one.speed) or (rate > 0.0 and start < stop):
        last = contact.radius_at(d(stop))
        work, a = work + at_rest(last), last
    return a, work, math.inf
