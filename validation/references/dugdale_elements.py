"""Dugdale's contact by boundary elements in three dimensions: neither Abel's transforms nor the MDR.

Annuli of constant pressure lie on an elastic half-space; a disc of radius b under p presses the surface down by

    u(r) = (4 p/(pi E*)) b E(r/b)  (r <= b),    (4 p/(pi E*)) r [E(b/r) - (1 - b^2/r^2) K(b/r)]  (r >= b)

with complete elliptic integrals, and an annulus is a difference of two discs. With the gap h = f - d + u, Dugdale's law
is a complementarity problem:

    h = 0, p >= -sigma_0 (r < a);    0 < h < h_0, p = -sigma_0 (a < r < c);    h > h_0, p = 0 (r > c)

`solved` has a and c at ends of annuli, and what makes them as equations: p = -sigma_0 in the last annulus in contact,
h(c) = h_0. `Solved.violation` checks the inequalities, and `contact_set` finds the annuli in contact at a prescribed d
by an active set. With annuli that shrink towards the axis, kinks and a, errors fall as the third power of their number.
Source: K. L. Johnson, Contact Mechanics (1985), section 3.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from validation.references.interaction import Floats

STEEP = 4
"""Annuli at an end of N have the width N^-STEEP: 3 leaves less than third order, 6 is lost in round-off at N = 200."""
ROUND_OFF = 1e-10
"""Gap below which annuli do not overlap, over h_0: the last one at a has no pressure over -sigma_0 to show its side."""


@dataclass(frozen=True)
class Elements:
    """A body on an elastic half-space.

    Args:
        height: f(r) [length] of an array of radii.
        modulus: E* [stress].
        stress: sigma_0 [stress].
        reach: h_0 [length].
        kinks: radii at which the slope jumps [length].
        count: annuli between two of 0, the kinks and a.
    """

    height: Callable[[Floats], Floats]
    modulus: float
    stress: float
    reach: float
    kinks: tuple[float, ...] = ()
    count: int = 100

    def solved(self, a: float) -> Solved:
        """The contact of a radius a > 0 [length]."""

        def off(s: float) -> float:
            one = self._with_zone(a, math.hypot(a, s))
            return float(one.gap(np.array([one.c]))[0]) - self.reach

        low = high = a
        while off(low) > 0.0:
            low *= 0.5
        while off(high) < 0.0:
            high *= 2.0
        return self._with_zone(a, math.hypot(a, float(brentq(off, low, high, rtol=1e-13))))

    def at(self, displacement: float, narrow: float, wide: float) -> Solved:
        """The contact at a displacement d [length], between two radii at which d is smaller and larger."""
        return self.solved(float(brentq(lambda a: self.solved(a).displacement - displacement, narrow, wide)))

    def contact_set(self, displacement: float, ends: Floats) -> NDArray[np.bool_]:
        """Which annuli touch at a displacement where all others are under -sigma_0; ends [length] from 0 to c.

        Raises:
            RuntimeError: the set does not settle.
        """
        middles, influence = self._influence(ends)
        free = self.height(middles) - displacement - self.stress * influence.sum(axis=1)  # the gap where none touches
        touching: NDArray[np.bool_] = free < 0.0
        touching[0] = True
        for _ in range(10 * middles.size):
            excess = np.zeros(middles.size)  # p + sigma_0
            excess[touching] = np.linalg.solve(influence[np.ix_(touching, touching)], -free[touching])
            gap = free + influence @ excess
            now = np.where(touching, excess > 0.0, gap < -ROUND_OFF * self.reach)
            if np.array_equal(now, touching):
                return touching
            touching = now
        raise RuntimeError("the set of touching annuli does not settle")

    def _with_zone(self, a: float, c: float) -> Solved:
        """Gap 0 in the middle of each annulus; unknown are d and all pressures but the last, which is -sigma_0."""
        ends = self._mesh(a)
        middles, influence = self._influence(ends)
        tension = influence[:, -1] + self._influence(np.array([a, c]), middles)[1][:, 0]
        matrix = np.column_stack([-influence[:, :-1], np.ones(middles.size)])
        *pressures, displacement = np.linalg.solve(matrix, self.height(middles) - self.stress * tension)
        return Solved(self, a, c, float(displacement), ends, np.array([*pressures, -self.stress]))

    def _mesh(self, a: float) -> Floats:
        """Ends of the annuli."""
        u = np.linspace(0.0, 1.0, self.count + 1)
        graded = u**STEEP / (u**STEEP + (1.0 - u) ** STEEP)
        corners = [0.0, *(b for b in self.kinks if b < a), a]
        return np.concatenate([[0.0], *(low + (high - low) * graded[1:] for low, high in pairwise(corners))])

    def _influence(self, ends: Floats, radii: Floats | None = None) -> tuple[Floats, Floats]:
        """The middles of annuli, and u(r)/p [length/stress] of each, shape (radii or middles, annuli)."""
        middles = 0.5 * (ends[1:] + ends[:-1])
        discs = pressed_down(middles if radii is None else radii, ends) / self.modulus
        return middles, np.diff(discs, axis=1)


@dataclass(frozen=True)
class Solved:
    """A solution: a, c, d [length], the ends of the annuli in contact [length] and their pressures [stress]."""

    problem: Elements
    a: float
    c: float
    displacement: float
    ends: Floats = field(repr=False)
    pressures: Floats = field(repr=False)

    @property
    def force(self) -> float:
        """F [force]."""
        annuli = math.pi * np.diff(self.ends**2)
        return float(self.pressures @ annuli) - math.pi * self.problem.stress * (self.c - self.a) * (self.c + self.a)

    def gap(self, radii: Floats) -> Floats:
        """h(r) [length]."""
        down = np.diff(pressed_down(radii, self.ends), axis=1) @ self.pressures
        down -= self.problem.stress * np.diff(pressed_down(radii, np.array([self.a, self.c])), axis=1)[:, 0]
        return np.asarray(self.problem.height(radii) - self.displacement + down / self.problem.modulus)

    def violation(self, points: int = 200) -> float:
        """The most by which an inequality does not hold [sigma_0 or h_0]; at most 0 where all hold."""
        inside = np.linspace(self.a, self.c, points + 2)[1:-1]
        outside = self.c * np.geomspace(1.0 + 1e-6, 5.0, points)
        tension = float(np.max(-self.pressures)) / self.problem.stress - 1.0
        closed, opened = self.gap(inside) / self.problem.reach, self.gap(outside) / self.problem.reach
        return max(tension, float(np.max(-closed)), float(np.max(closed)) - 1.0, 1.0 - float(np.min(opened)))


def pressed_down(radii: Floats, discs: Floats) -> Floats:
    """u E*/p [length] at radii, shape (n,), of discs of uniform pressure, shape (m,): shape (n, m)."""
    r, b = np.broadcast_arrays(radii[:, None], discs[None, :])
    inside = r <= b
    m = np.divide(np.where(inside, r, b), np.where(inside, b, r)) ** 2
    e, k = ellipe(m), ellipk(np.minimum(m, np.nextafter(1.0, 0.0)))  # (1 - m) K is 0 at the edge
    return np.asarray(4.0 / math.pi * np.where(inside, b * e, r * (e - (1.0 - m) * k)))
