"""Contacts of axisymmetric bodies under Dugdale's law, by quadrature: a tension W/h_0 wherever the gap is below h_0.

The zone is a < r < c. With the body's transform g, s = sqrt(c^2 - a^2), t = arccos(a/c), kappa = 2W/(E* h_0),

    d = g(a) - kappa s,    F = 2E* [a g(a) - int_0^a g dx] - (2W/h_0) (a s + t c^2)
    h_0 = (2/pi) [int_0^t (g(c cos phi) - g(a)) dphi + kappa (s t - c + a)]

which are the Abel transforms of the pressure and of the gap at c, with f(c) = (2/pi) int_0^c g/sqrt(c^2 - x^2) dx put
in: every term of the gap is positive, so that nothing is lost for c -> a. c rises with h_0 at every a. With
G = int_0^t g'(c cos phi) cos phi dphi the same two equations give d'(a) and F'(a). Before contact the zone stands alone,

    d = f(c) - h_0 - (2 kappa/pi) c,    F = -pi c^2 W/h_0

and under fixed grips it goes on after a = 0 while d falls with c. Sources: D. Maugis (1992) for the paraboloid; V. L.
Popov, M. Hess, Method of Dimensionality Reduction (2015), chapter 3, for the transforms.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from scipy.integrate import quad
from scipy.optimize import brentq

from validation.references.axisymmetric import Body, Contact

ACCURACY = 1e-11
"""Relative accuracy asked of each piece of a quadrature."""
SCAN, DECADES = 12, (4.0, 3.0)
"""Radii per decade of the first search, and decades below and above the guess."""
CLOSE = 1e-9
"""Relative distance from a kink at which a radius counts as beside it."""
DOUBLINGS = 600
"""How often a search may double or halve its first guess."""


@dataclass(frozen=True)
class State:
    """An equilibrium: a, c, d [length], F [force]."""

    a: float
    c: float
    displacement: float
    force: float


@dataclass(frozen=True)
class Cohesive:
    """A body on a plane.

    Args:
        body: the body of revolution, without a flank.
        modulus: E* [stress].
        work: W [force/length].
        reach: h_0 [length].
        guess: about the contact radius without a load [length].
    """

    body: Body
    modulus: float
    work: float
    reach: float
    guess: float

    @property
    def stress(self) -> float:
        """sigma_0 [stress]."""
        return self.work / self.reach

    @property
    def _kappa(self) -> float:
        return 2.0 * self.stress / self.modulus

    def gap(self, a: float, s: float) -> float:
        """The gap at c [length] of a contact with sqrt(c^2 - a^2) = s."""
        t, c, inner = math.atan2(s, a), math.hypot(a, s), self.body.transformed(a)
        opened = self._over(lambda x, _: self.body.transformed(x) - inner, a, c, t)
        return 2.0 / math.pi * (opened + self._kappa * c * (t * math.sin(t) - 2.0 * math.sin(0.5 * t) ** 2))

    def zone(self, a: float) -> float:
        """s = sqrt(c^2 - a^2) [length] of a contact; a >= 0."""
        return _rising(lambda s: self.gap(a, s) - self.reach, self.guess)

    def state(self, a: float) -> State:
        """The contact of a radius a >= 0 [length]."""
        return self._state(a, self.zone(a))

    def _state(self, a: float, s: float) -> State:
        t, c, inner = math.atan2(s, a), math.hypot(a, s), self.body.transformed(a)
        pressed = 2.0 * self.modulus * (a * inner - self.body.area(a))
        return State(a, c, inner - self._kappa * s, pressed - 2.0 * self.stress * (a * s + t * c * c))

    def slopes(self, a: float) -> tuple[float, float]:
        """dd/da [1] and dF/da [force/length]; a > 0, beside a kink."""
        s = self.zone(a)
        t, c = math.atan2(s, a), math.hypot(a, s)
        cos, sin, rise = a / c, s / c, self.body.rise(a) / a
        zone = self._over(lambda x, phi: self.body.rise(x) / x * math.cos(phi), a, c, t)
        of_a = cos * zone - t * rise - self._kappa * cos * 2.0 * math.sin(0.5 * t) ** 2
        of_s = sin * zone + self._kappa * (t - sin * (1.0 - cos))
        widening = -of_a / of_s
        dd = rise - self._kappa * widening
        # of a s + t c^2, with t_a = -s/c^2 and t_s = a/c^2
        area = 2.0 * t * a + (2.0 * a + 2.0 * t * s) * widening
        return dd, 2.0 * self.modulus * a * rise - 2.0 * self.stress * area

    def alone(self, c: float) -> State:
        """The zone before contact, of radius c [length]."""
        d = self.body.height(c) - self.reach - 2.0 / math.pi * self._kappa * c
        return State(0.0, c, d, -math.pi * c * c * self.stress)

    def _over(self, function: Callable[[float, float], float], a: float, c: float, t: float) -> float:
        """int_0^t function(c cos phi, phi) dphi between the kinks; x = c cos phi stays above a."""
        ends = [0.0, *(math.acos(b / c) for b in reversed(self.body.kinks) if a < b < c), t]
        return sum(
            float(quad(lambda phi: function(max(a, c * math.cos(phi)), phi), low, high,
                       epsrel=ACCURACY, epsabs=1e-300, limit=200)[0])
            for low, high in pairwise(ends)
        )  # fmt: skip

    @cached_property
    def _grid(self) -> list[float]:
        """Radii of the search, falling."""
        low, high = self.guess * 10.0 ** -DECADES[0], min(self.guess * 10.0 ** DECADES[1], 0.5 * self.body.limit)
        count = round(SCAN * math.log10(high / low))
        spread = [low * (high / low) ** (i / count) for i in range(count + 1)]
        beside = [b * (1.0 + side) for b in self.body.kinks for side in (-CLOSE, CLOSE) if low < b < high]
        return sorted({*spread, *beside}, reverse=True)

    def _turns(self, of_force: bool, within: Sequence[float]) -> list[float]:
        """Radii at which F or d has a minimum over a, from the outermost."""

        def slope(a: float) -> float:
            return self.slopes(a)[int(of_force)]

        found, values = [], [slope(a) for a in within]
        for (outer, above), (inner, below) in pairwise(zip(within, values, strict=True)):
            if above > 0.0 >= below:
                found.append(float(brentq(slope, inner, outer, xtol=1e-300, rtol=1e-13)))
        return found

    @cached_property
    def fold(self) -> float | None:
        """a of the outermost minimum of d [length], where a contact snaps out; None where it shrinks to a = 0."""
        found = self._turns(False, self._near)
        return found[0] if found else None

    @cached_property
    def _near(self) -> list[float]:
        """Radii of the search below twice the guess."""
        return [a for a in self._grid if a < 2.0 * self.guess]

    @cached_property
    def critical(self) -> State:
        """The largest tension of the contacts that fixed grips hold, and of the zone that is left of them."""
        last = self.fold
        within = [a for a in self._near if last is None or a > last]
        states = [self.state(a) for a in self._turns(True, within)]
        states.append(self.state(0.0 if last is None else last))
        return min(states, key=lambda one: one.force)

    @cached_property
    def free(self) -> State:
        """The largest contact without a load."""
        return self.under(0.0)

    def under(self, force: float) -> State:
        """The largest contact that carries a force."""
        return self._outermost(lambda one: one.force - force)

    def at(self, displacement: float) -> State | None:
        """The largest contact at a displacement, or the zone of bodies that have been in contact; None if parted."""
        last = self.snap_out
        if displacement < last.displacement:
            return None
        if self.fold is None and displacement < self.state(0.0).displacement:
            low, high = last.c, self.state(0.0).c
            return self.alone(_root(lambda c: self.alone(c).displacement - displacement, low, high))
        return self._outermost(lambda one: one.displacement - displacement)

    @cached_property
    def snap_out(self) -> State:
        """The last state under fixed grips."""
        if self.fold is not None:
            return self.state(self.fold)
        return self.alone(self.narrowest)

    @cached_property
    def narrowest(self) -> float:
        """c of the zone alone at which d has its minimum, f'(c) = 2 kappa/pi [length]; at a kink where f' jumps over it."""
        wide, wanted = self.state(0.0).c, 2.0 / math.pi * self._kappa
        if self.body.slope(wide) < wanted:
            return wide
        low = wide
        while self.body.slope(low) >= wanted:
            low *= 0.5
            if low < 1e-12 * wide:
                return 0.0
        for b in self.body.kinks:
            if low < b < wide and self.body.slope(b * (1.0 - CLOSE)) < wanted <= self.body.slope(b):
                return b
        return _root(lambda c: self.body.slope(c) - wanted, low, wide)

    def _outermost(self, function: Callable[[State], float]) -> State:
        """The largest a >= 0 at which a function of the state falls to 0 inwards; positive far outside."""
        grid, outer = self._grid, 0.0
        values = iter(grid)
        start = next((i for i, a in enumerate(grid) if a <= 1.3 * self.guess), 0)
        while start > 0 and function(self.state(grid[start])) <= 0.0:
            start -= 1
        if start == 0 and function(self.state(grid[0])) <= 0.0:
            raise ValueError("the contact would cover the body")
        del values
        outer = grid[start]
        for inner in [*grid[start + 1 :], 0.0]:
            if function(self.state(inner)) <= 0.0:
                return self.state(_root(lambda a: function(self.state(a)), inner, outer))
            outer = inner
        raise ValueError("no contact has so little")

    def pressure(self, r: float, a: float) -> float:
        """p(r) [stress], 0 < r < a, of a body without kinks of the slope inside: Hertz's part less that of the zone."""
        s = self.zone(a)
        pressed = Contact(self.body, self.modulus).pressure(r, a)
        return pressed - 2.0 * self.stress / math.pi * math.atan2(s, math.sqrt((a - r) * (a + r)))

    def central_pressure(self, a: float) -> float:
        """p(0) [stress]; inf under a tip."""
        return Contact(self.body, self.modulus).central_pressure(a) - 2.0 * self.stress / math.pi * math.atan2(
            self.zone(a), a
        )

    def work_along(self, outer: float, inner: float) -> float:
        """-int F dd [energy] from a contact of radius `outer` to one of `inner`: the change of the energy."""
        ends = [outer, *(b for b in reversed(self.body.kinks) if inner < b < outer), inner]
        return -sum(
            float(quad(lambda a: self.state(a).force * self.slopes(a)[0], low, high, epsrel=1e-8, limit=100)[0])
            for high, low in pairwise(ends)
        ) * -1.0  # fmt: skip


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    return float(brentq(function, low, high, xtol=1e-300, rtol=1e-13))


def _rising(function: Callable[[float], float], guess: float) -> float:
    """The root of a rising function of a positive number."""
    low = high = guess
    for _ in range(DOUBLINGS):
        if function(low) < 0.0:
            break
        low, high = 0.5 * low, low
    for _ in range(DOUBLINGS):
        if function(high) > 0.0:
            break
        low, high = high, 2.0 * high
    return _root(function, low, high)
