"""A rigid body of mass m and velocity v that hits a half-space: elastic, of Kelvin and Voigt, relaxing, or adhesive.

m d'' = -F with F of `relaxing`: elastic F_el(d); Kelvin and Voigt; a Prony series by Lee and Radok while d grows,
whose arms S_j' = 2 a(d) d' - S_j/tau_j make a motion of few variables of it,

    F = E_inf F_el(d)/E* + sum_j E_j S_j,

and Ting after the largest d, F(t) = E_inf F_el(d_1)/E* + sum_j E_j S_j(t_1) exp(-(t - t_1)/tau_j), where t_1 < t_m is
the root of int_(t_1)^t E(t - s) dd(s) = 0; contact ends where t_1 = 0.

With adhesion (Johnson, Kendall and Roberts) and E(a) = E* int_0^a (d - g)^2 dx - pi a^2 W, d = g(a) - Delta_l, the
body touches at d = 0 at the larger radius with that d, and parts at fixed grips, a g'(a) = Delta_l/2:

    e^2 = 1 - (v_s/v)^2,    m v_s^2/2 = E(a_fg) - E(a_touch)

Nothing is shared with the program. Sources: K. L. Johnson, H. M. Pollock, J. Adhesion Sci. Technol. 8 (1994) 1323;
C. Thornton, Z. Ning, Powder Technol. 99 (1998) 154.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from validation.references.numerics import Function, largest, root, smooth
from validation.references.relaxing import KelvinVoigt, Material, Power

EXACT = {"method": "DOP853", "rtol": 1e-11, "dense_output": True}
SMALL = 1e-14
"""Absolute error of a motion over the largest elastic displacement, velocity and force."""
LOOKS = 400
"""Times of a motion at which its largest force is looked for."""
SHARE = 50.0
"""Elastic durations after which nothing is waited for."""


@dataclass(frozen=True)
class Bounce:
    """What an impact has: e [1], the duration [time], the largest F [force], d and a [length]."""

    restitution: float
    contact_time: float
    peak_force: float
    peak_displacement: float
    peak_contact_radius: float

    def lost(self, mass: float, velocity: float) -> float:
        """m v^2 (1 - e^2)/2 [energy]."""
        return 0.5 * mass * velocity**2 * (1.0 - self.restitution**2)


def deepest(body: Power, modulus: float, mass: float, velocity: float) -> float:
    """The largest d [length] of an elastic impact: E* int_0^d F_el dd = m v^2/2, where F_el ~ d^(1 + 1/n)."""
    at_one = modulus * body.volume(body.radius(1.0))
    power = 2.0 + 1.0 / body.exponent
    return float((0.5 * mass * velocity**2 * power / at_one) ** (1.0 / power))


def motion(
    change: Callable[..., Any], start: list[float], scale: float, until: float, event: Callable[..., float]
) -> Any:
    """The solution of y' = change(t, y) until an event falls through 0, with an absolute error of SMALL scale."""
    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]  # scipy reads them off the function
    return solve_ivp(change, (0.0, until), start, atol=SMALL * scale, events=event, **EXACT)


def turned(_: float, y: Any) -> float:
    """The velocity of the body."""
    return float(y[1])


def peak(function: Function, end: float) -> float:
    """The largest value from the time 0 to an end."""
    return largest(function, [end * i / LOOKS for i in range(LOOKS + 1)])[1]


def kelvin_voigt(one: KelvinVoigt, mass: float, velocity: float) -> Bounce:
    """Of a half-space of Kelvin and Voigt; elastic with a retardation time of 0."""
    depth = deepest(one.body, one.modulus, mass, velocity)
    until, scale = SHARE * depth / velocity * (1.0 + one.time * velocity / depth), min(depth, velocity)

    def change(_: float, y: Any) -> list[float]:
        return [y[1], -one.force(y[0], y[1]) / mass]

    def parted(_: float, y: Any) -> float:
        return float(y[0] + one.time * y[1])

    inwards = motion(change, [0.0, velocity], scale, until, turned)
    top, end = inwards.y[0, -1], inwards.t[-1]
    outwards = motion(change, [top, 0.0], scale, until, parted)

    def force(t: float) -> float:
        d, rate = inwards.sol(t)
        return one.force(max(0.0, d), max(0.0, rate))

    radii = max(one.radius(d, v) for d, v in inwards.y.T)
    return Bounce(-outwards.y[1, -1] / velocity, end + outwards.t[-1], peak(force, end), top, radii)


def elastic(body: Power, modulus: float, mass: float, velocity: float) -> Bounce:
    """e = 1, by energy; d_max/v times 2 int_0^1 dy/sqrt(1 - y^p) lasts it, p = 2 + 1/n."""
    depth, power = deepest(body, modulus, mass, velocity), 2.0 + 1.0 / body.exponent
    a = body.radius(depth)
    lasts = 2.0 * smooth(lambda y: 1.0 / math.sqrt(1.0 - y**power), 0.0, 1.0)
    return Bounce(1.0, lasts * depth / velocity, modulus * body.volume(a), depth, a)


def relaxing(body: Power, material: Material, mass: float, velocity: float) -> Bounce:
    """Of a half-space that relaxes by a Prony series."""
    rest = material.modulus * material.rest
    E = material.modulus * np.array([p for p, _ in material.terms])
    tau = np.array([time for _, time in material.terms])
    arms = len(E)
    depth = deepest(body, material.modulus, mass, velocity)
    until = SHARE * depth / velocity

    def held(y: Any) -> float:
        return float(rest * body.volume(body.radius(y[0])) + E @ y[2 : 2 + arms])

    def grow(_: float, y: Any) -> Any:
        flow = 2.0 * body.radius(y[0]) * y[1]
        return np.concatenate([[y[1], -held(y) / mass], flow - y[2 : 2 + arms] / tau, y[1] - y[2 + arms :] / tau])

    scale = min(depth, velocity, 1.0) * min(1.0, body.radius(depth))
    inwards = motion(grow, [0.0, velocity] + [0.0] * (2 * arms), scale, until, turned)
    top, turn = inwards.y[:, -1], float(inwards.t[-1])

    def carried(since: float, t: float, y: Any) -> float:
        """int_since^t E(t - s) dd(s), with the arms of the apex in y."""
        before = inwards.sol(since)
        gone = np.exp(-(t - since) / tau) * before[2 + arms :]
        return rest * float(y[0] - before[0]) + float(E @ (y[2:] - gone))

    def before(t: float, y: Any) -> float:
        if carried(0.0, t, y) <= 0.0:
            return 0.0
        if carried(turn, t, y) >= 0.0:
            return turn
        return root(lambda s: carried(s, t, y), 0.0, turn, 1e-13)

    def shrink(t: float, y: Any) -> Any:
        earlier = before(turn + t, y)
        state = inwards.sol(earlier)
        fade = np.exp(-(turn + t - earlier) / tau)
        force = rest * body.volume(body.radius(state[0])) + float(E @ (state[2 : 2 + arms] * fade))
        return np.concatenate([[y[1], -(force if earlier > 0.0 else 0.0) / mass], y[1] - y[2:] / tau])

    def parted(t: float, y: Any) -> float:
        return float(rest * y[0] + E @ y[2:])

    outwards = motion(shrink, [top[0], 0.0, *top[2 + arms :]], scale, until, parted)
    return Bounce(
        -outwards.y[1, -1] / velocity,
        turn + outwards.t[-1],
        peak(lambda t: held(inwards.sol(t)), turn),
        float(top[0]),
        body.radius(top[0]),
    )


@dataclass(frozen=True)
class Adhesive:
    """An elastic half-space with a work of adhesion.

    Args:
        body: its profile.
        work: W [force/length].
        modulus: E* [stress].
    """

    body: Power
    work: float
    modulus: float = 1.0

    def stretch(self, a: float) -> float:
        """Delta_l(a) [length]."""
        return math.sqrt(2.0 * math.pi * a * self.work / self.modulus)

    def displacement(self, a: float) -> float:
        """d(a) [length]."""
        return self.body.depth(a) - self.stretch(a)

    def slope(self, a: float) -> float:
        """d'(a)."""
        return (self.body.exponent * self.body.depth(a) - 0.5 * self.stretch(a)) / a

    def force(self, a: float) -> float:
        """F(a) [force]."""
        return self.modulus * (self.body.volume(a) - 2.0 * a * self.stretch(a))

    def energy(self, a: float) -> float:
        """E(a) [energy]."""
        n, g, d = self.body.exponent, self.body.depth(a), self.displacement(a)
        inside = a * (d * d - 2.0 * d * g / (n + 1.0) + g * g / (2.0 * n + 1.0))
        return self.modulus * inside - math.pi * a * a * self.work

    def _radius(self, share: float) -> float:
        """Where kappa_n c a^n = share Delta_l(a)."""
        factor = share * math.sqrt(2.0 * math.pi * self.work / self.modulus) / self.body.reduced
        return float(factor ** (1.0 / (self.body.exponent - 0.5)))

    @cached_property
    def touch(self) -> float:
        """a at d = 0."""
        return self._radius(1.0)

    @cached_property
    def grips(self) -> float:
        """a at the least d."""
        return self._radius(0.5 / self.body.exponent)

    @cached_property
    def critical(self) -> float:
        """a of the largest tension."""
        return self._radius(1.5 / self.body.exponent)

    def radius_at(self, displacement: float) -> float:
        """a [length] of the outer equilibrium at a displacement."""
        return _beyond(lambda a: self.displacement(a) - displacement, self.grips)

    def radius_under(self, force: float) -> float:
        """a [length] of the equilibrium that carries a force and is not lost when it falls."""
        return _beyond(lambda a: self.force(a) - force, self.critical)

    def force_at(self, displacement: float) -> float:
        """F [force] at a displacement, as long as fixed grips hold it; 0 beyond."""
        held = displacement >= self.displacement(self.grips)
        return self.force(self.radius_at(displacement)) if held else 0.0

    def lost_to(self, a: float) -> float:
        """Energy lost by bodies that touch at d = 0 and part at a radius a."""
        return self.energy(a) - self.energy(self.touch)

    @cached_property
    def lost(self) -> float:
        """m v_s^2/2 [energy]."""
        return self.lost_to(self.grips)

    def sticking_velocity(self, mass: float) -> float:
        """v_s."""
        return math.sqrt(2.0 * self.lost / mass)

    def impact(self, mass: float, velocity: float) -> Bounce:
        """Faster than v_s."""
        kinetic, touch = 0.5 * mass * velocity**2, self.touch

        def left(a: float) -> float:
            return kinetic + self.energy(touch) - self.energy(a)

        a = _beyond(lambda a: -left(a), touch)

        def slowness(x: float) -> float:
            return self.slope(x) / math.sqrt(2.0 * max(left(x), 1e-300) / mass)

        lasts = smooth(slowness, touch, a, 200) + smooth(slowness, self.grips, a, 200)
        return Bounce(math.sqrt(1.0 - self.lost / kinetic), lasts, self.force(a), self.displacement(a), a)


def _beyond(function: Function, low: float) -> float:
    """The root of a function that rises from a place on."""
    high = 2.0 * low
    while function(high) <= 0.0:
        high *= 2.0
    return root(function, low, high)
