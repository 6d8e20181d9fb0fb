"""Adhesion that depends on the speed of the receding edge, drawn off at a constant velocity.

With F = 2 E* int_0^a (d - g) dx and the energy release rate G = E* (g(a) - d)^2/(2 pi a),

    -da/dt = v_0 (G/W - 1)^(1/n),    dd/dt = -V

from the equilibrium G = W under a preload. In the variable d that is one equation, stiff where V << v_0.
Sources: D. Maugis, M. Barquins, J. Phys. D 11 (1978) 1989; E. Barthel, J. Phys. D 41 (2008) 163001.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

from validation.references.impact import Adhesive

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
        return self.largest(self._pressed(preload), velocity)

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

    def at(self, displacement: float) -> float:
        """The radius [length] of the equilibrium at a displacement of at least 0."""
        high = 2.0 * self.contact.touch
        while self.contact.displacement(high) < displacement:
            high *= 2.0
        low = self.contact.touch
        return float(brentq(lambda a: self.contact.displacement(a) - displacement, low, high, xtol=1e-300, rtol=1e-14))

    def _pressed(self, force: float) -> float:
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
