"""Maugis and Dugdale in reduced form, by m = c/a: A = a (K/pi W R^2)^(1/3), N = F/(pi W R), K = 4E*/3.

    (lambda A^2/2) [r + (m^2 - 2) t] + (4 lambda^2 A/3) [r t - m + 1] = 1,    N = A^3 - lambda A^2 [r + m^2 t]

with r = sqrt(m^2 - 1), t = arcsec m. The first equation is a quadratic in A, so that a curve is written out over m.
Source: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from validation.references.interaction import Floats

LAMBDA_OVER_TABOR = 2.0 * math.cbrt(9.0 / (16.0 * math.pi))
"""For the stress W/h_0 (Maugis 1992)."""
LEAST, MOST, POINTS = 1e-7, 1e4, 4_000
"""m - 1 of the curve: from a wide contact to one that is all cohesive zone."""


def curve(parameter: float) -> tuple[Floats, Floats]:
    """A and N over m, A falling; `parameter` lambda."""
    x = np.geomspace(LEAST, MOST, POINTS)
    m = 1.0 + x
    r = np.sqrt(x * (x + 2.0))
    t = np.arctan2(r, 1.0)
    square = 0.5 * parameter * (r + (m**2 - 2.0) * t)
    linear = 4.0 / 3.0 * parameter**2 * (r * t - x)
    a = 2.0 / (linear + np.sqrt(linear**2 + 4.0 * square))
    return a, a**3 - parameter * a**2 * (r + m**2 * t)


def marks(parameter: float) -> tuple[float, float]:
    """a_cr/a_0, and F_A/(pi W R), of the largest tension."""
    a, load = curve(parameter)
    rising = CubicSpline(a[::-1], load[::-1])
    lowest = int(np.argmin(load))
    near = [x for x in rising.derivative().roots(extrapolate=False) if a[lowest + 1] <= x <= a[lowest - 1]]
    critical = float(near[0])
    zero = next(float(x) for x in rising.roots(extrapolate=False) if x > critical)
    return critical / zero, -float(rising(critical))


def tabor_of(ratio: float, parameters: tuple[float, float]) -> tuple[float, float]:
    """Tabor's mu, and F_A/(pi W R), where a_cr/a_0 is `ratio`; NaN where that is outside of `parameters` (lambda)."""
    low, high = map(math.log, parameters)

    def off(logarithm: float) -> float:
        return marks(math.exp(logarithm))[0] - ratio

    if off(low) * off(high) > 0.0:
        return math.nan, math.nan
    parameter = math.exp(float(brentq(off, low, high)))
    return parameter / LAMBDA_OVER_TABOR, marks(parameter)[1]
