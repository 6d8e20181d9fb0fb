"""Roots, integrals and largest values that the references have in common: scipy's, at the accuracies that are asked."""

import math
from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

Floats = NDArray[np.float64]
Function = Callable[[float], float]
Pair = tuple[float, float]
BESIDE = 1e-13
"""Accuracy asked of an integral beside what it is added to."""


def root(function: Function, low: float, high: float, accuracy: float = 1e-14) -> float:
    """Return the root of a function between two places where its signs differ, to a relative accuracy."""
    return float(brentq(function, low, high, xtol=1e-300, rtol=accuracy, maxiter=500))


def rising(function: Function, guess: float) -> float:
    """Return the root of a function of a positive number that is negative below it and positive above.

    Raises:
        ValueError: there is none within 600 doublings or halvings of the guess.
    """
    low = next((x for x in (guess * 0.5**i for i in range(600)) if function(x) < 0.0), None)
    high = next((x for x in (guess * 2.0**i for i in range(600)) if function(x) > 0.0), None)
    if low is None or high is None:
        raise ValueError(f"no root within 600 doublings of {guess:g}")
    return root(function, low, high)


def integral(
    function: Function, *ends: float, accuracy: float = 1e-12, scale: float = 0.0, accepted: float = math.inf
) -> float:
    """Return the integral from the first end to the last, adaptively between each two of them.

    Args:
        function: smooth between the ends.
        ends: places, rising.
        accuracy: relative, asked of each piece.
        scale: what the integral is added to.
        accepted: relative error that a piece may have, beside the scale.

    Raises:
        ArithmeticError: a piece has a larger error.
    """
    total = 0.0
    for low, high in pairwise(ends):
        if high > low:
            value, error, *_ = quad(
                function, low, high, epsrel=accuracy, epsabs=BESIDE * scale, limit=400, full_output=1
            )
            if error > accepted * max(abs(value), scale):
                raise ArithmeticError(f"an integral of {value:g} is off by {error:g}")
            total += float(value)
    return total


@cache
def rule(count: int) -> tuple[Floats, Floats]:
    """Return places and weights of Gauss's rule on 0 to 1, closer at its ends."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    angle = 0.25 * math.pi * (1.0 + nodes)
    return np.sin(angle) ** 2, 0.25 * math.pi * np.sin(2.0 * angle) * weights


def smooth(function: Function, low: float, high: float, count: int = 60) -> float:
    """Return the integral, by one rule of Gauss, of a function that is smooth but at its ends."""
    places, weights = rule(count)
    return (high - low) * float(weights @ np.array([function(low + (high - low) * float(x)) for x in places]))


def largest(function: Function, points: Sequence[float]) -> Pair:
    """Return where a function that is smooth between rising points is largest, and its value there."""
    values = [function(x) for x in points]
    i = int(np.argmax(values))
    best = points[i], values[i]
    for low, high in pairwise(points[max(0, i - 1) : i + 2]):
        found = minimize_scalar(
            lambda x: -function(float(x)), bounds=(low, high), method="bounded", options={"xatol": 1e-9 * (high - low)}
        )
        best = max(best, (float(found.x), -float(found.fun)), key=lambda pair: pair[1])
    return best
