"""A rigid body z = c rⁿ pressed into a viscoelastic half-space, and retracted once.

    F(t) = ∫₀^{t₁} φ(t − s) dP(d(s)),    ∫_{t₁}^{t} φ(t − s) d′(s) ds = 0,    φ(t) = 1 − Σ g (1 − e^(−t/τ))

P(d) ∝ d^((n+1)/n) is the instantaneous, elastic force. While the contact grows t₁ = t (E. H. Lee, J. R. M. Radok,
J. Appl. Mech. 27 (1960) 438); when it shrinks, t₁ is when it was as wide before (T. C. T. Ting, J. Appl. Mech. 33
(1966) 845).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Indented:
    """The history of an indentation.

    Attributes:
        times, displacements: its points, joined by straight lines [time], [length]; the first at most 0, one maximum.
        force: P at the largest displacement [force].
        exponent: n of the body.
        terms: (g, τ) of the material, g of the instantaneous modulus [1], [time].
    """

    times: tuple[float, ...]
    displacements: tuple[float, ...]
    force: float
    exponent: float
    terms: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        """Raise ValueError where the displacements begin above 0, never exceed 0, or have more than one maximum.

        A maximum may last, and the whole path may rise.
        """
        signs = np.sign(np.diff(self.displacements))
        if self.displacements[0] > 0.0 or (np.diff(signs[signs != 0.0]) > 0.0).any() or max(self.displacements) <= 0.0:
            raise ValueError("displacements must begin at 0 or below and have one maximum")

    @property
    def touched(self) -> float:
        """The time at which the displacement first passes 0, linear between points: the bodies first touch [time]."""
        d = np.asarray(self.displacements)
        first = int(np.argmax(d > 0.0))
        return float(np.interp(0.0, d[first - 1 : first + 1], self.times[first - 1 : first + 1]))

    @property
    def deepest(self) -> float:
        """The last of the given times at which the displacement is largest [time]: from then on it falls."""
        return self.times[len(self.times) - 1 - int(np.argmax(self.displacements[::-1]))]

    def _relaxed(self, time: Array) -> Array:
        """Return φ(t) = 1 − Σ g (1 − e^(−t/τ)), dimensionless, at times t ≥ 0 since a load step, (m,) [time]."""
        phi = np.ones_like(time)
        for g, tau in self.terms:
            phi += g * np.expm1(-time / tau)
        return phi

    def _balance(self, start: float, time: float) -> float:
        """Return ∫ φ(t − s) d′(s) ds from `start` to `time` [length]; φ = 1 − Σ g (1 − e^(−t/τ)), d by straight lines.

        After the maximum it is positive where the contact is wider than it was at `start`, and 0 where it is as wide.
        """
        ends = np.unique(np.clip([start, *self.times, time], start, time))
        d = np.interp(ends, self.times, self.displacements)
        kept = 1.0 - sum(g for g, _ in self.terms)
        integral = kept * (d[-1] - d[0])
        for g, tau in self.terms:
            age, spans = (time - ends) / tau, np.diff(ends) / tau  # a difference would lose the digits at long times
            integral -= g * float(np.diff(d) / spans @ (np.exp(-age[1:]) * np.expm1(-spans)))
        return float(integral)

    def lost(self, end: float) -> float | None:
        """Return the time after the maximum at which the contact is lost [time]; None where it is not before `end`.

        `end`: a time after the first touch [time].
        """
        from scipy.optimize import brentq

        if self._balance(self.touched, end) > 0.0:
            return None
        return float(brentq(lambda time: self._balance(self.touched, time), self.deepest, end))

    def forces(self, times: Sequence[float], parts: int = 4000) -> Array:
        """Return F at times within the history, (m,), compression positive [force].

        0 before the first touch and from the loss of the contact on. The loading has `parts` points, each part with φ
        at its middle: the error is some 1e-7 of F.

        Args:
            times: of the force, (m,) [time].
            parts: number of points.
        """
        from scipy.optimize import brentq

        force, first, deepest = np.zeros(len(times)), self.touched, self.deepest
        largest, power = max(self.displacements), (self.exponent + 1.0) / self.exponent
        for i, time in enumerate(times):
            if time <= first or (time > deepest and self._balance(first, time) <= 0.0):
                continue
            end = time if time <= deepest else brentq(self._balance, first, deepest, args=(time,))
            moments = np.union1d(np.linspace(first, end, parts), [turn for turn in self.times if first < turn < end])
            d = np.maximum(np.interp(moments, self.times, self.displacements), 0.0)
            rise = np.diff(self.force * (d / largest) ** power)
            force[i] = rise @ self._relaxed(time - 0.5 * (moments[1:] + moments[:-1]))
        return force
