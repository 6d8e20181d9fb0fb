"""Rigid bodies on a viscoelastic half-space under a force that grows, is held and falls: Lee, Radok, Ting (`relaxing`).

While the radius grows 2 n/(n + 1) kappa_n c a^(n + 1) = int C(t - s) dF(s), and d = g(a). After its largest value
a(t) = a(t_1) with F(t) = 2 int_0^(t_1) E(t - s) a(s) dd(s), and d follows from int_(t_1)^t E(t - s) dd(s) = 0, by C.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from validation.references.numerics import Floats, root, rule, smooth
from validation.references.relaxing import Legs, Material, Number, Power, largest

NODES = 24
"""Of a rule for the approach after the largest radius."""
PLACES, PARTS = rule(80)
"""Of a rule for a past, on 0 to 1."""


@dataclass(frozen=True)
class Creeping:
    """A body under a force that grows, is held, and falls, so that the radius has one maximum."""

    body: Power
    material: Material
    force: Legs

    def _volume(self, t: Number) -> Number:
        """int C dF [length^2] at one time or many."""
        yielded = self.material.yielded
        pieces = self.force.pieces(-math.inf, math.inf)
        past = (s * (yielded(np.maximum(t - a, 0.0)) - yielded(np.maximum(t - b, 0.0))) for a, b, s in pieces)
        volume: Number = sum(past, 0.0 * t)
        return volume

    @cached_property
    def turn(self) -> float:
        """When the radius is largest."""
        turn, _ = largest(self._volume, self.force.times)

        def rate(t: float) -> float:
            creep = self.material.creep
            return sum(
                s * (creep(t - a) - (creep(t - b) if b < t else 0.0)) for a, b, s in self.force.pieces(-math.inf, t)
            )

        for low, high in pairwise(self.force.times):
            if low < turn < high and rate(low) > 0.0 > rate(high):
                return root(rate, low, high)
        return turn

    def grown(self, t: Number) -> Number:
        """a(t) [length] while the radius grows."""
        return self.body.of_volume(self._volume(t))

    def _approach(self, t: Number) -> Number:
        """d(t) [length] while the radius grows."""
        return self.body.depth(self.grown(t))

    def before(self, t: float) -> float:
        """t_1(t)."""
        if t <= self.turn:
            return t
        target = self.force(t)

        start = self.force.touched(0.0)

        def off(s: float) -> float:
            return self._past(self._volume, start, s, t) - target

        if target <= 0.0 or off(self.turn) <= 0.0:  # at the turn itself by round-off
            return start if target <= 0.0 else self.turn
        return root(off, start, self.turn, 1e-13)

    def _past(self, values: Callable[[Floats], Floats], low: float, high: float, t: float) -> float:
        """int_low^high E(t - s) d values(s), by parts: the values have a steep start, and no derivative there."""
        total = 0.0
        for start, stop in pairwise(self.force.corners(low, high)):
            s = start + (stop - start) * PLACES
            fading = sum(p / tau * np.exp((s - t) / tau) for p, tau in self.material.terms)
            total += (stop - start) * float(PARTS @ (values(s) * fading))
        first, last = values(np.array([low, high])).tolist()
        relaxed = self.material.relaxed
        return float(relaxed(t - high) * last - relaxed(t - low) * first - self.material.modulus * total)

    def _lost(self, t: float) -> float:
        """int_(t_1)^(t_m) E(t - s) dd(s)."""
        return self._past(self._approach, self.before(t), self.turn, t)

    def radius(self, t: float) -> float:
        """a(t) [length]."""
        return self.grown(self.before(t))

    def displacement(self, t: float) -> float:
        """d(t) [length]."""
        if t <= self.turn:
            return self._approach(t)
        lost, turn = self._lost, self.turn
        past = sum(
            smooth(lambda s: self.material.creep_rate(t - s) * lost(s), low, high, NODES)
            for low, high in pairwise(self.force.corners(turn, t))
        )
        return self._approach(turn) - self.material.retarded[0] * lost(t) - past

    @cached_property
    def peak_displacement(self) -> float:
        """The largest d(t) [length]."""
        times = [t for t in self.force.times if t < self.turn]
        return largest(self._approach, [*times, self.turn])[1]
