"""A body that is drawn out of a viscoelastic surface and touches it again: springs, each with events in its own time.

In one dimension every spring at x has q = E_inf u + sum_j E_j s_j with s_j' = u' - s_j/tau_j (Kelvin and Voigt:
q = E (u + A u')). In contact u = d - g(x); it leaves where q falls through 0; free, q = 0 makes of it

    u' = sum_j E_j s_j/(tau_j E_0),    s_j' = u' - s_j/tau_j        (u = u_0 exp(-t/A))

and it is touched again where d - g = u. With d(t) linear in pieces both are sums of exponentials, exactly: times of
leaving and touching are roots, found by bisection, for each spring its own. The force is the integral of q over x.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from validation.references.numerics import Floats, Function
from validation.references.relaxing import Legs, Material

BISECTIONS = 60
LOOKS = np.unique(np.concatenate([np.linspace(0.0, 1.0, 25)[1:], np.geomspace(1e-6, 0.03, 10)]))
"""Fractions of the time that remains of a leg, at which an event is looked for."""
NEGATIVE = 1e-13
"""Of the largest q: a pressure below - this leaves at once, where the rate has jumped."""


@dataclass(frozen=True)
class Prony:
    """A Prony series, of which a state is u and s_j, one column a spring."""

    material: Material

    @property
    def arms(self) -> int:
        """How many s_j."""
        return len(self.material.terms)

    @cached_property
    def _arms(self) -> tuple[float, Floats, Floats]:
        shares, times = np.array(self.material.terms).T
        return self.material.modulus * self.material.rest, self.material.modulus * shares, times

    @cached_property
    def _modes(self) -> tuple[Floats, Floats, Floats]:
        """Rates and modes of a free surface, and the inverse of the modes; made symmetric, so that they are real."""
        _, E, tau = self._arms
        scale = np.sqrt(E / tau)
        rates, vectors = np.linalg.eigh(np.outer(scale, scale) / self.material.modulus - np.diag(1.0 / tau))
        # s = W y with W = diag(sqrt(tau/E)) makes s' = (1 (E/tau)^T/E_0 - 1/tau) s symmetric.
        shape = np.sqrt(tau / E)
        return rates, shape[:, None] * vectors, vectors.T / shape[None, :]

    def pressure(self, state: Floats, rate: float) -> Floats:
        """q."""
        rest, E, _ = self._arms
        return np.asarray(rest * state[0] + E @ state[1:])

    def held(self, state: Floats, rate: float, t: Floats) -> Floats:
        """The state after a time in contact."""
        tau = self._arms[2][:, None]
        x = -t[None] / tau
        return np.concatenate([(state[0] + rate * t)[None], state[1:] * np.exp(x) - rate * tau * np.expm1(x)])

    def free(self, state: Floats, t: Floats) -> Floats:
        """The state after a time without contact: u' from q' = 0, s_j by modes."""
        rest, E, tau = self._arms
        rates, modes, inverse = self._modes
        s = modes @ (np.exp(rates[:, None] * t[None]) * (inverse @ state[1:]))
        if rest > 0.0:
            return np.concatenate([(-(E @ s) / rest)[None], s])
        # Without a modulus at rest q = 0 says nothing of u: its rate is integrated.
        grown = np.where(rates[:, None] * t[None] != 0.0, np.expm1(rates[:, None] * t[None]), 0.0)
        slow = np.abs(rates) < 1e-13 * np.abs(rates).max(initial=1e-300)
        over = np.where(slow[:, None], t[None], grown / np.where(slow, 1.0, rates)[:, None])
        moved = (E / tau) @ (modes @ (over * (inverse @ state[1:]))) / self.material.modulus
        return np.concatenate([(state[0] + moved)[None], s])


@dataclass(frozen=True)
class Retarded:
    """Kelvin and Voigt: a state is u."""

    time: float
    modulus: float = 1.0
    arms: int = 0

    def pressure(self, state: Floats, rate: float) -> Floats:
        """q in contact."""
        return np.asarray(self.modulus * (state[0] + self.time * rate))

    def held(self, state: Floats, rate: float, t: Floats) -> Floats:
        """The state after a time in contact."""
        return np.asarray((state[0] + rate * t)[None])

    def free(self, state: Floats, t: Floats) -> Floats:
        """The state after a time without contact."""
        return np.asarray((state[0] * np.exp(-t / self.time))[None])


Law = Prony | Retarded


@dataclass
class Springs:
    """Springs under a body that moves; all begin undeformed and free.

    Args:
        law: of each.
        depth: g(x_i) [length]; the first is at x = 0.
        weight: of each in the integral over -a < x < a [length].
    """

    law: Law
    depth: Floats
    weight: Floats
    state: Floats = field(init=False)
    touching: NDArray[np.bool_] = field(init=False)
    left_at: Floats = field(init=False)
    time: float = 0.0
    first: float = math.inf
    touches: int = 0

    def __post_init__(self) -> None:
        """At rest."""
        self.state = np.zeros((1 + self.law.arms, self.depth.size))
        self.touching = np.zeros(self.depth.size, dtype=bool)
        self.left_at = np.full(self.depth.size, -math.inf)

    @property
    def last(self) -> float:
        """When the last spring was left; inf while one touches, and before."""
        latest = self.left_at.max()
        return math.inf if self.touching.any() or latest < self.first else latest

    def move(self, start: float, stop: float, duration: float) -> None:
        """Move the body from one displacement to another at a constant rate."""
        rate = (stop - start) / duration
        left = np.full(self.depth.size, duration)
        pressure = self.law.pressure(self.state, rate)
        at_once = np.flatnonzero(self.touching & (pressure < -NEGATIVE * np.abs(pressure).max()))
        self._switched(at_once, False, np.full(at_once.size, self.time))
        while (left > 0.0).any():
            for held in (True, False):
                some = np.flatnonzero((self.touching == held) & (left > 0.0))
                if some.size:
                    self._one_event(some, held, start, rate, duration, left)
        self.time += duration

    def _switched(self, some: NDArray[np.intp], touching: bool, times: Floats) -> None:
        """Springs that are touched or left, and when."""
        self.touching[some] = touching
        if not some.size:
            return
        if touching:
            self.first = min(self.first, times.min())
            self.touches += bool(some[0] == 0)
        else:
            self.left_at[some] = times

    def _one_event(
        self, some: NDArray[np.intp], held: bool, start: float, rate: float, duration: float, left: Floats
    ) -> None:
        """Go to the next event of each of some springs, or to the end."""
        rest, law = left[some], self.law
        gap = start + rate * (duration - rest) - self.depth[some]

        def after(t: Floats, few: Any = slice(None)) -> Floats:
            state = self.state[:, some[few]]
            return law.held(state, rate, t) if held else law.free(state, t)

        def off(t: Floats, few: Any = slice(None)) -> NDArray[np.bool_]:
            """Whether the pressure of springs in contact, or the gap of those without, is negative."""
            state = after(t, few)
            return (law.pressure(state, rate) if held else state[0] - (gap[few] + rate * t)) < 0.0

        low, high, found = np.zeros(some.size), rest.copy(), np.zeros(some.size, dtype=bool)
        for look in LOOKS:
            t = look * rest
            new = ~found & off(t)
            high[new], found = t[new], found | new
            low[~found] = t[~found]
        for _ in range(BISECTIONS if found.any() else 0):
            middle = 0.5 * (low[found] + high[found])
            below = off(middle, found)
            low[found], high[found] = np.where(below, low[found], middle), np.where(below, middle, high[found])
        moved = after(high)
        if not held:
            moved[0][found] = (gap + rate * high)[found]
        self.state[:, some] = moved
        left[some] = np.where(found, rest - high, 0.0)
        self._switched(some[found], not held, (self.time + duration - left[some])[found])

    def force(self, rate: float) -> float:
        """F [force] at a rate, with which a pressure that would be negative is none."""
        return float(self.weight @ np.where(self.touching, self.law.pressure(self.state, rate), 0.0).clip(0.0))


@dataclass(frozen=True)
class Followed:
    """A path of the body, at the times that were asked for.

    Attributes:
        radius: of the outermost spring that touches [length].
        work: int F dd since the start, by Simpson's rule between the times [energy].
        first, last: when the surface is first touched, and when it is left for good; inf where it is not [time].
        touches: how often the apex touches.
    """

    times: Floats
    displacement: Floats
    force: Floats
    radius: Floats
    work: Floats
    first: float
    last: float
    touches: int


def followed(law: Law, depth: Function, width: float, d: Legs, times: Sequence[float], cells: int) -> Followed:
    """Follow a path of springs in the middles of cells between 0 and `width`; the times begin where the path does.

    At a corner of the path the force is that of the leg before.
    """
    x = np.concatenate([[0.0], (np.arange(cells) + 0.5) * width / cells])
    weight = np.full(x.size, 2.0 * width / cells)
    weight[0] = 0.0
    springs = Springs(law, np.array([depth(one) for one in x]), weight, time=d.times[0])
    every = sorted({*times, *(t for t in d.times if t <= max(times))})
    rows = {every[0]: (d(every[0]), 0.0, 0.0, 0.0)}
    for t0, t1 in pairwise(every):
        d0, d1, work = d(t0), d(t1), rows[t0][3]
        middle, rate, forces = 0.5 * (d0 + d1), (d1 - d0) / (t1 - t0), []
        for start, stop in ((d0, middle), (middle, d1)):
            forces.append(springs.force(rate))
            springs.move(start, stop, 0.5 * (t1 - t0))
        forces.append(springs.force(rate))
        outermost = int(np.flatnonzero(springs.touching).max(initial=0))
        edge = x[outermost] + (0.5 * width / cells if outermost else 0.0)
        rows[t1] = d1, forces[2], edge, work + np.dot((1.0, 4.0, 1.0), forces) * (d1 - d0) / 6.0
    along, force, radius, work = np.array([rows[t] for t in times]).T
    return Followed(np.array(times), along, force, radius, work, springs.first, springs.last, springs.touches)


def evenly(d: Legs, per_leg: int) -> list[float]:
    """Times that divide each leg evenly."""
    return [a + (b - a) * i / per_leg for a, b in pairwise(d.times) for i in range(per_leg)] + [d.times[-1]]
