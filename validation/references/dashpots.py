"""A body pressed with a given force into a half-space of Kelvin and Voigt: one linear equation in each direction.

With V(d) = F_el/E* and V' = 2 a d' the force of a growing contact, F = E* (V + 2 T a d'), is

    T dV/dt + V = F/E*        (V is the mean of F/E* over the past, with the weight exp(-s/T)/T)

until V = F/E*, from which on the contact recedes, V(a) = F/E*, and the body lags behind it: d + T d' = g(a).
"""

import math
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise

from validation.references.numerics import root, smooth
from validation.references.relaxing import KelvinVoigt, Legs


@dataclass(frozen=True)
class Pressed:
    """A force that grows from 0, is held, and falls, once."""

    law: KelvinVoigt
    force: Legs

    def _grown(self, t: float) -> float:
        """V(t) [length^2] while the contact grows: exactly, leg by leg."""
        T, value = self.law.time, 0.0
        for start, stop, rate in self.force.pieces(-math.inf, t):
            x = (stop - start) / T
            begin = self.force(start)
            # of F = begin + rate s: begin (1 - e^-x) + rate T (x - 1 + e^-x)
            lag = math.expm1(-x) + x if x > 1e-4 else x * x * (0.5 - x / 6.0)
            value = value * math.exp(-x) + (-begin * math.expm1(-x) + rate * T * lag) / self.law.modulus
        return value

    @cached_property
    def turn(self) -> float:
        """When the body is deepest; the end of the force where it only sinks."""

        def lag(t: float) -> float:
            return self.force(t) / self.law.modulus - self._grown(t)

        for low, high in pairwise(self.force.times):
            if self.force(high) < self.force(low) and lag(high) < 0.0:
                return root(lag, low, high) if lag(low) > 0.0 else low
        return self.force.times[-1]

    def radius(self, t: float) -> float:
        """a [length]."""
        return self.law.body.of_volume(self._grown(t) if t <= self.turn else self.force(t) / self.law.modulus)

    def displacement(self, t: float) -> float:
        """d [length]."""
        body, T, turn = self.law.body, self.law.time, self.turn
        if t <= turn:
            return body.depth(self.radius(t))
        d = body.depth(self.radius(turn))
        for low, high in pairwise(self.force.corners(turn, t)):
            parts = max(1, min(40, math.ceil((high - low) / T)))
            for a, b in pairwise([low + (high - low) * i / parts for i in range(parts + 1)]):
                d = d * math.exp((a - b) / T) + smooth(partial(self._drawn, b), a, b, 40)
        return d

    @property
    def lost(self) -> float:
        """int F dd of a force that ends at 0 [energy]."""
        return self.force.work(self.displacement, self.turn)

    def _drawn(self, end: float, s: float) -> float:
        """What the edge at a time draws the body to, at the end [length/time]."""
        T = self.law.time
        return self.law.body.depth(self.radius(s)) * math.exp((s - end) / T) / T

    def rate(self, t: float) -> float:
        """d' [length/time] just before t."""
        a = self.radius(t)
        if t <= self.turn:
            return (self.force(t) / self.law.modulus - self._grown(t)) / (2.0 * self.law.time * a)
        return (self.law.body.depth(a) - self.displacement(t)) / self.law.time
