"""Axisymmetric bodies pressed into a half-space in three dimensions: rings of constant pressure, contact on one side.

A disc of radius b under a pressure p moves the surface of an elastic half-space by (Johnson 1985, section 3.4; K, E of
k = r/b inside, b/r outside)

    w(r) = (4 p b/(pi E*)) E(k),  r < b;      w(r) = (4 p r/(pi E*)) [E(k) - (1 - k^2) K(k)],  r > b

and a ring is the difference of two discs. At a constant Poisson's ratio a body that relaxes has, at every r by itself,

    A p = E_inf w + sum_j E_j s_j,  s_j' = w' - s_j/tau_j     (Kelvin and Voigt: A p = E (w + T w'))

with A of E* = 1, so that a step in time in which w is linear is A p = G w + h: 0 <= p, 0 <= w - (d - f), one of them 0.
Nothing of it knows the reduction to one dimension.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.special import ellipe, ellipk

from validation.references.numerics import Floats, Function, Pair

ROUNDS = 200


def pressed_down(radii: Floats, discs: Floats) -> Floats:
    """Return w E*/p [length] at radii, shape (n,), of discs of uniform pressure, shape (m,): shape (n, m)."""
    r, b = np.broadcast_arrays(radii[:, None], discs[None, :])
    inside = r <= b
    m = np.divide(np.where(inside, r, b), np.where(inside, b, r)) ** 2
    e, k = ellipe(m), ellipk(np.minimum(m, np.nextafter(1.0, 0.0)))  # (1 - m) K is 0 at the edge
    return np.asarray(4.0 / math.pi * np.where(inside, b * e, r * (e - (1.0 - m) * k)))


@dataclass
class Rings:
    """A half-space whose surface begins undeformed, and the body f(r) over it.

    Args:
        edges: of the rings, from 0 [length].
        profile: f(r), inf where there is no body [length].
        terms: (share, time) of each arm of a Prony series.
        retardation: T of Kelvin and Voigt [time].
        modulus: E* at once [stress].
    """

    edges: Floats
    profile: Callable[[Floats], Floats]
    terms: Sequence[Pair] = ()
    retardation: float = 0.0
    modulus: float = 1.0
    surface: Floats = field(init=False)
    pressure: Floats = field(init=False)

    def __post_init__(self) -> None:
        """At rest; a ring is looked at where half of its area is inside."""
        inner, outer = self.edges[:-1], self.edges[1:]
        self.r = np.sqrt(0.5 * (inner**2 + outer**2))
        self.r[0] = 0.5 * outer[0]
        self.area = math.pi * (outer**2 - inner**2)
        self._A = np.diff(pressed_down(self.r, self.edges), axis=1)
        self._f = self.profile(self.r)
        self._shares, self._times = (np.array([one[i] for one in self.terms]) for i in (0, 1))
        self._arms = np.zeros((len(self.terms), self.r.size))
        self.surface, self.pressure = np.zeros(self.r.size), np.zeros(self.r.size)

    def step(self, d: float, duration: float) -> None:
        """Move the body to a displacement in which the surface moves evenly; at once with a duration of 0."""
        if self.retardation:
            gain = 1.0 + self.retardation / duration
            history = -self.retardation / duration * self.surface
        else:
            x = duration / self._times
            fade, mean = np.exp(-x), -np.expm1(-x) / np.where(x > 0.0, x, 1.0) + (x == 0.0)
            gain = 1.0 - self._shares.sum() + float(self._shares @ mean)
            kept = self._arms * fade[:, None] - mean[:, None] * self.surface
            history = self._shares @ kept
        p = self._solved(gain * (d - self._f) + history)
        w = (self._A @ p - history) / gain
        if not self.retardation and self._times.size:
            self._arms = self._arms * fade[:, None] + mean[:, None] * (w - self.surface)
        self.surface, self.pressure = w, self.modulus * p

    def _solved(self, load: Floats) -> Floats:
        """p >= 0 where A p = load, and A p >= load where p = 0: by the set of rings that touch."""
        touching = (self.pressure > 0.0) | (load > 0.0) & ~self.pressure.any()
        for _ in range(ROUNDS):
            p = np.zeros(load.size)
            some = np.flatnonzero(touching)
            if some.size:
                p[some] = np.linalg.solve(self._A[np.ix_(some, some)], load[some])
            now = np.where(touching, p > 0.0, self._A @ p < load)
            if (now == touching).all():
                return p
            touching = now
        raise RuntimeError("the rings that touch do not settle")

    @property
    def force(self) -> float:
        """F [force]."""
        return float(self.area @ self.pressure)

    @property
    def radius(self) -> float:
        """The edge of the outermost ring that touches [length]."""
        some = np.flatnonzero(self.pressure > 0.0)
        return float(self.edges[some[-1] + 1]) if some.size else 0.0

    def follow(self, d: Function, times: Sequence[float]) -> list[float]:
        """F at rising times from the second on; at the first one the surface is at rest."""
        found = []
        for before, after in pairwise(times):
            self.step(d(after), after - before)
            found.append(self.force)
        return found
