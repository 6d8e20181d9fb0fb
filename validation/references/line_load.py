"""The pressure p(r) of a contact by quadrature of the line load q(x) of independent springs, with a jump at its edge.

    p(r) = (1/pi) [q(e)/sqrt(e^2 - r^2) - int_r^e q'(x)/sqrt(x^2 - r^2) dx],    F = 2 int_0^e q dx

with q linear between the springs (on the axis q(0) - c x^n), so that the integral is a sum of arcosh. The edge e
lies where q falls to 0, or where the gap does: there Kelvin and Voigt's q jumps to E (u + T u'), u = d - g(e); at the
end of a body q jumps, too. The springs are those of `recovering`, each with events in its own time; `rings` has the
same pressures without any springs.
"""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize_scalar

from validation.references.numerics import Floats, Function
from validation.references.recovering import Law, Prony, Springs
from validation.references.relaxing import Legs

PARTS, CELLS = 96, 4000
"""Pieces of a path in which events are looked for; springs."""
LOOKED = np.sin(np.linspace(0.0, 0.5 * math.pi, 161))[:-1]
"""Radii over e at which the largest pressure is looked for."""


class Line(NamedTuple):
    """q [force/length] at x from 0 to the edge [length], both empty where nothing touches; f(r) ~ r^n beside the apex.

    `flow` is -dF/dt [force/time] of arms alone while the body is held.
    """

    x: Floats
    q: Floats
    exponent: float = 2.0
    flow: float = 0.0

    @property
    def edge(self) -> float:
        """e [length]."""
        return float(self.x[-1]) if self.x.size else 0.0

    @property
    def force(self) -> float:
        """F [force]."""
        return 2.0 * float(np.trapezoid(self.q, self.x))

    def pressure(self, r: float) -> float:
        """p(r) [stress]; inf under a tip."""
        x, q, e, n = self.x, self.q, self.edge, self.exponent
        if r >= e:
            return 0.0
        slope = np.diff(q) / np.diff(x)
        if r == 0.0:
            if n <= 1.0:
                return math.inf if slope[0] else (q[-1] / e - slope[1:] @ np.log(x[2:] / x[1:-1])) / math.pi
            # q - c x^n between the springs, too: straight lines miss 1e-4 of a blunt cone.
            inner = n / (n - 1.0) * np.diff(q) @ (np.diff(x ** (n - 1.0)) / np.diff(x**n))
        else:
            inner = slope @ np.diff(np.arccosh(np.maximum(x / r, 1.0)))
        return float(q[-1] / math.sqrt((e - r) * (e + r)) - inner) / math.pi

    @property
    def peak(self) -> float:
        """The largest p(r) [stress]; inf under a tip and at an edge where q jumps."""
        if self.q[-1] > 0.0:
            return math.inf
        radii = (self.edge * LOOKED).tolist()
        values = [self.pressure(r) for r in radii]
        i = int(np.argmax(values))
        if i == 0:
            return values[0]
        ends = radii[i - 1], radii[min(i + 1, LOOKED.size - 1)]
        found = minimize_scalar(lambda r: -self.pressure(r), bounds=ends, method="bounded")
        return max(values[i], -float(found.fun))


def line_of(springs: Springs, x: Floats, d: float, rate: float, exponent: float = 2.0) -> Line:
    """Of springs at x under a body at a displacement that moves at a rate."""
    touching = np.flatnonzero(springs.touching)
    if touching.size < 4:
        return Line(np.zeros(0), np.zeros(0))
    last, law = int(touching[-1]), springs.law
    near, q = x[: last + 1], law.pressure(springs.state, rate)[: last + 1].clip(0.0)
    if last + 1 == x.size:
        edge, jump = x[last], q[-1]
        near, q = near[:-1], q[:-1]
    else:
        edge, jump = _edge(springs, x, d, last, q)
    near, q = np.append(near, edge), np.append(q, jump)
    flow = 0.0
    if isinstance(law, Prony):
        shares, times = np.array(law.material.terms).T
        arms = law.material.modulus * (shares / times) @ springs.state[1:, : last + 1]
        flow = 2.0 * np.trapezoid(np.append(arms, arms[-1])[: near.size], near)
    return Line(near, q, exponent, flow)


def _edge(springs: Springs, x: Floats, d: float, last: int, q: Floats) -> tuple[float, float]:
    """e [length] between the last spring that touches and the next one, and q there."""
    here, there = x[last] * (1.0 + 1e-12), x[last + 1]
    fall = (q[-1] - q[-2]) / (x[last] - x[last - 1])
    zero = x[last] - q[-1] / fall if fall < 0.0 else math.inf
    if zero < there or last + 2 >= x.size:
        return max(here, min(zero, there)), 0.0
    gap = springs.state[0] - (d - springs.depth)
    opens = (gap[last + 2] - gap[last + 1]) / (x[last + 2] - x[last + 1])
    edge = min(max(there - gap[last + 1] / opens, here), there) if opens > 0.0 else there
    return edge, 0.0 if isinstance(springs.law, Prony) else max(0.0, q[-1] + fall * (edge - x[last]))


def lines(
    law: Law, depth: Function, width: float, d: Legs, times: Sequence[float], exponent: float = 2.0,
    cells: int = CELLS,
) -> list[Line]:  # fmt: skip
    """The line loads of a path at rising times, at a corner those of the leg before; springs up to `width`."""
    x = width * np.linspace(0.0, 1.0, cells + 1) ** 2
    springs = Springs(law, np.array([depth(one) for one in x]), np.gradient(x), time=d.times[0])
    each = max(1, PARTS // len(d.times))
    parts = [a + (b - a) * i / each for a, b in pairwise(d.times) for i in range(each)]
    found = []
    for before, after in pairwise(sorted({*parts, *times, d.times[-1]})):
        springs.move(d(before), d(after), after - before)
        if after in times:
            found.append(line_of(springs, x, d(after), (d(after) - d(before)) / (after - before), exponent))
    return found
