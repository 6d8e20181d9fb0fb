"""Contacts of axisymmetric bodies under Dugdale's law, by quadrature: a tension W/h_0 wherever the gap is below h_0.

The zone is a < r < c. With the body's transform g, s = sqrt(c^2 - a^2), t = arccos(a/c), kappa = 2W/(E* h_0),

    d = g(a) - kappa s,    F = 2E* [a g(a) - int_0^a g dx] - (2W/h_0) (a s + t c^2)
    h_0 = (2/pi) [H + kappa (s t - c + a)],    H = int_a^c (g - g(a))/sqrt(c^2 - x^2) dx

which are the Abel transforms of the pressure and of the gap at c, with f(c) = (2/pi) int_0^c g/sqrt(c^2 - x^2) dx put
in: both terms of the gap are positive and rise with c, so that c is unique at every a. With g as an integral of f',

    H = int_0^a f'(r) [arctan(s/sqrt(a^2 - r^2)) - t a/sqrt(a^2 - r^2)] dr + (pi/2) [f(c) - f(a)]
    G = dH/dc = (c/s) int_0^a f'(r) sqrt(a^2 - r^2)/(c^2 - r^2) dr - a g(a)/(c s) + (pi/2) f'(c)

and H, G and g' give d'(a) and F'(a). Before contact the zone stands alone,

    d = f(c) - h_0 - (2 kappa/pi) c,    F = -pi c^2 W/h_0

and under fixed grips it goes on after a = 0 while d falls with c. Sources: D. Maugis (1992) for the paraboloid; V. L.
Popov, M. Hess, Method of Dimensionality Reduction (2015), chapter 3, for the transforms.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise

from validation.references.axisymmetric import Body, Contact
from validation.references.numerics import Pair, integral, rising, root

ACCURACY, ACCEPTED = 1e-11, 1e-8
"""Relative accuracy asked of each piece of a quadrature, and what one may have that round-off beside a kink stops."""
_integral = partial(integral, accuracy=ACCURACY, accepted=ACCEPTED)
SCAN, DECADES = 12, (4.0, 3.0)
"""Radii per decade of the first search, and decades below and above the guess."""
CLOSE = 1e-9
"""Relative distance from a kink at which a radius counts as beside it."""
BEYOND = 1.01
"""Radius over that without a load, inside of which limit points are."""


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
        t, c = math.atan2(s, a), math.hypot(a, s)

        inside = self._over(
            lambda r, phi: self.body.slope(r) * (math.cos(phi) * math.atan2(s, a * math.cos(phi)) - t),
            a,
            self.reach / a if a else 0.0,
        )
        outside = 0.5 * math.pi * self._rise(a, c)
        stretched = self._kappa * c * (t * math.sin(t) - 2.0 * math.sin(0.5 * t) ** 2)
        return 2.0 / math.pi * (a * inside + outside + stretched)

    def zone(self, a: float) -> float:
        """s = sqrt(c^2 - a^2) [length] of a contact; a >= 0."""
        return rising(lambda s: self.gap(a, s) - self.reach, self.guess)

    def state(self, a: float) -> State:
        """The contact of a radius a >= 0 [length]."""
        return self._state(a, self.zone(a))

    def _state(self, a: float, s: float) -> State:
        t, c, inner = math.atan2(s, a), math.hypot(a, s), self.body.transformed(a)
        pressed = 2.0 * self.modulus * (a * inner - self.body.area(a))
        return State(a, c, inner - self._kappa * s, pressed - 2.0 * self.stress * (a * s + t * c * c))

    def slopes(self, a: float) -> Pair:
        """dd/da [1] and dF/da [force/length]; a > 0, beside a kink."""
        s = self.zone(a)
        t, c = math.atan2(s, a), math.hypot(a, s)
        cos, sin, rise = a / c, s / c, self.body.rise(a) / a
        zone = self._widening(a, s)
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

    def _over(self, function: Callable[[float, float], float], a: float, scale: float) -> float:
        """int_0^(pi/2) function(r, phi) dphi, r = a sin phi, between the kinks; the scale is what it is added to."""
        return self.body.over_angles(function, a, scale=scale, accuracy=ACCURACY, accepted=ACCEPTED)

    def _rise(self, a: float, c: float) -> float:
        """f(c) - f(a) [length]."""
        return _integral(self.body.slope, *self.body.corners(a, c), scale=self.reach)

    def _widening(self, a: float, s: float) -> float:
        """G [1]."""
        c = math.hypot(a, s)

        def inside(r: float, phi: float) -> float:
            return self.body.slope(r) / (1.0 + (s / (a * math.cos(phi))) ** 2)

        part = c * self._over(inside, a, self._kappa * s / c) - a / c * self.body.transformed(a)
        return part / s + 0.5 * math.pi * self.body.slope(c)

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

        slopes = [(a, slope(a)) for a in within]
        return [
            root(slope, inner, outer, 1e-13)
            for (outer, above), (inner, below) in pairwise(slopes)
            if above > 0.0 >= below
        ]

    @cached_property
    def fold(self) -> float | None:
        """a of the outermost minimum of d [length], where a contact snaps out; None where it shrinks to a = 0."""
        found = self._turns(False, self._inside)
        return found[0] if found else None

    @cached_property
    def _inside(self) -> list[float]:
        """Radii of the search inside of the contact without a load."""
        return [a for a in self._grid if a < BEYOND * self.free.a]

    @cached_property
    def critical(self) -> State:
        """The largest tension of the contacts that fixed grips hold, and of the zone that is left of them."""
        last = self.fold
        within = self._inside if last is None else [*(a for a in self._inside if a > last), last * (1.0 + CLOSE)]
        states = [self.state(a) for a in self._turns(True, within)]
        states.append(self.state(0.0 if last is None else last))
        return min(states, key=lambda one: one.force)

    @cached_property
    def free(self) -> State:
        """The largest contact without a load."""
        return self.under(0.0)

    def under(self, force: float) -> State:
        """The largest contact that carries a force."""
        return self._outermost(lambda one: one.force - force, [0.0] if force >= 0.0 else [self.critical.a])

    def at(self, displacement: float) -> State | None:
        """The largest contact at a displacement, or the zone of bodies that have been in contact; None if parted."""
        last = self.snap_out
        if displacement < last.displacement:
            return None
        if self.fold is None and displacement < self.state(0.0).displacement:
            low, high = last.c, self.state(0.0).c
            return self.alone(root(lambda c: self.alone(c).displacement - displacement, low, high, 1e-13))
        return self._outermost(lambda one: one.displacement - displacement, [self.fold or 0.0])

    @cached_property
    def snap_out(self) -> State:
        """The last state under fixed grips."""
        if self.fold is not None:
            return self.state(self.fold)
        return self.alone(self.narrowest)

    @cached_property
    def narrowest(self) -> float:
        """c of the zone alone at the minimum of d [length]: f' falls to 2 kappa/pi, continuously or at a kink."""
        wide, wanted = self.state(0.0).c, 2.0 / math.pi * self._kappa
        if self.body.slope(wide) <= wanted:
            return wide
        for low, high in reversed(list(pairwise(self.body.corners(0.0, wide)))):
            inside, outside = low + CLOSE * (high - low), high * (1.0 - CLOSE)
            if self.body.slope(outside) < wanted:
                return high
            if self.body.slope(inside) < wanted:
                return root(lambda c: self.body.slope(c) - wanted, inside, outside, 1e-13)
        return 0.0

    def _outermost(self, function: Callable[[State], float], limits: Sequence[float]) -> State:
        """The largest a >= 0 at which a function of the state, positive far outside, falls to 0 inwards.

        A dip at one of the `limits` may be narrower than the grid.
        """
        grid = self._grid
        first = next(i for i, a in enumerate(grid) if a <= self.guess)
        while min(function(one := self.state(grid[first])), one.force) <= 0.0:
            first -= 1
            if first < 0:
                raise ValueError("the contact would cover the body")
        for outer, inner in pairwise(sorted({*grid[first:], *limits, 0.0}, reverse=True)):
            if function(self.state(inner)) <= 0.0:
                return self.state(root(lambda a: function(self.state(a)), inner, outer, 1e-13))
        raise ValueError("no contact has so little")

    def pressure(self, r: float, state: State) -> float:
        """p(r) [stress], 0 < r < a, of a body without kinks of the slope inside: Hertz's part less that of the zone."""
        pressed = Contact(self.body, self.modulus).pressure(r, state.a)
        return pressed - self._of_zone(math.sqrt((state.a - r) * (state.a + r)), state)

    def central_pressure(self, state: State) -> float:
        """p(0) [stress]; inf under a tip."""
        return Contact(self.body, self.modulus).central_pressure(state.a) - self._of_zone(state.a, state)

    def _of_zone(self, inside: float, state: State) -> float:
        return 2.0 * self.stress / math.pi * math.atan2(math.sqrt((state.c - state.a) * (state.c + state.a)), inside)

    def energy(self, state: State) -> float:
        """Elastic and of adhesion, 0 where the bodies are apart [energy].

        E* int_0^a (d - g)^2 dx - (4 sigma_0^2/E*) int_a^c (c^2 - x^2) dx + 4 sigma_0 int_a^c (g - d) sqrt(c^2 - x^2) dx
        - pi c^2 W: the springs, and W less sigma_0 h in the zone, whose gap h is the transform of g - d + q/E*.
        """
        a, c, d = state.a, state.c, state.displacement

        def density(x: float) -> float:
            g = self.body.transformed(x) - d
            if x < a:
                return self.modulus * g * g
            square = (c - x) * (c + x)
            return 4.0 * self.stress * (g * math.sqrt(square) - self.stress / self.modulus * square)

        ends = sorted({a, *self.body.corners(0.0, c)})
        return _integral(density, *ends, scale=self.work * c) - math.pi * c * c * self.work

    @cached_property
    def touched(self) -> State | None:
        """The state that bodies come into where they meet, at d = -h_0; None if they part at once."""
        return self.at(-self.reach)
