"""Dugdale's contact by boundary elements in three dimensions: neither Abel's transforms nor the MDR.

Annuli of constant pressure lie on an elastic half-space; a disc of radius b under p presses the surface down by

    u(r) = (4 p/(pi E*)) b E(r/b)  (r <= b),    (4 p/(pi E*)) r [E(b/r) - (1 - b^2/r^2) K(b/r)]  (r >= b)

with complete elliptic integrals, and an annulus is a difference of two discs. With the gap h = f - d + u, Dugdale's law
is a complementarity problem:

    h = 0, p >= -sigma_0 (r < a);    0 < h < h_0, p = -sigma_0 (a < r < c);    h > h_0, p = 0 (r > c)

`solved` has a and c at ends of annuli, and what makes them as equations: p = -sigma_0 in the last annulus in contact,
h(c) = h_0. `Solved.violation` checks the inequalities. With annuli that
shrink towards the axis, kinks and a, errors fall as the third power of their number.
Source: K. L. Johnson, Contact Mechanics (1985), section 3.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from validation.references.numerics import Floats, rising, root
from validation.references.rings import pressed_down

STEEP = 4
"""Annuli at an end of N have the width N^-STEEP: 3 leaves less than third order, 6 is lost in round-off at N = 200."""


VIEWED = 200
"""Radii in the zone, and as many beyond it, at which the inequalities are looked at."""


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

        return self._with_zone(a, math.hypot(a, rising(off, a)))

    def at(self, displacement: float, narrow: float, wide: float) -> Solved:
        """The contact at a displacement d [length], between two radii at which d is smaller and larger."""
        return self.solved(root(lambda a: self.solved(a).displacement - displacement, narrow, wide))

    def _with_zone(self, a: float, c: float) -> Solved:
        """Gap 0 in the middle of each annulus; unknown are d and all pressures but the last, which is -sigma_0."""
        u = np.linspace(0.0, 1.0, self.count + 1)
        graded = u**STEEP / (u**STEEP + (1.0 - u) ** STEEP)
        corners = [0.0, *(b for b in self.kinks if b < a), a]
        ends = np.concatenate([[0.0], *(low + (high - low) * graded[1:] for low, high in pairwise(corners))])
        middles = 0.5 * (ends[1:] + ends[:-1])
        influence, zone = (self.pressed(middles, edges) for edges in (ends, np.array([a, c])))
        tension = influence[:, -1] + zone[:, 0]
        matrix = np.column_stack([-influence[:, :-1], np.ones(middles.size)])
        *pressures, displacement = np.linalg.solve(matrix, self.height(middles) - self.stress * tension)
        return Solved(self, a, c, float(displacement), ends, np.array([*pressures, -self.stress]))

    def pressed(self, radii: Floats, ends: Floats) -> Floats:
        """u(r)/p [length/stress] of annuli, shape (radii, annuli)."""
        return np.diff(pressed_down(radii, ends), axis=1) / self.modulus


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
        one, zone = self.problem, np.array([self.a, self.c])
        down = one.pressed(radii, self.ends) @ self.pressures - one.stress * one.pressed(radii, zone)[:, 0]
        return one.height(radii) - self.displacement + down

    def violation(self) -> float:
        """The most by which an inequality does not hold [sigma_0 or h_0]; at most 0 where all hold."""
        inside = np.linspace(self.a, self.c, VIEWED + 2)[1:-1]
        outside = self.c * np.geomspace(1.0 + 1e-6, 5.0, VIEWED)
        tension = float(np.max(-self.pressures)) / self.problem.stress - 1.0
        closed, opened = self.gap(inside) / self.problem.reach, self.gap(outside) / self.problem.reach
        return max(tension, float(np.max(-closed)), float(np.max(closed)) - 1.0, 1.0 - float(np.min(opened)))
