"""The polynomial P(t) = Σ cₖ tᵏ of a few samples: its coefficients, its real roots and its lowest minimum.

Positions t are of the order of 1 and counted from a sample, or the coefficients are those of round-off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache, lru_cache

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

IMAGINARY_ROUND_OFF = 1e-9
"""Imaginary part up to which a root counts as real."""
SAME_ROOT = 1e-6
"""Farther than this no root is moved: beside a double one a step of Newton's is round-off over round-off."""
NEWTON = 20
"""Steps in which Newton's method has found a minimum that is near, or will not."""
ROOT = 1e-12
"""Its last step: the next one would be round-off."""


def fitting(t: Array, degree: int) -> Array:
    """The matrix M, (degree + 1, n), that makes coefficients c = M y of values y at n different positions t.

    P goes through all values where degree = n - 1; for a lower degree it is that of least squares.
    """
    return _fitting(np.ascontiguousarray(t).tobytes(), degree)


@lru_cache(maxsize=512)  # particles that move up and down only are under the same polynomial in every state
def _fitting(places: bytes, degree: int) -> Array:
    t = np.frombuffer(places)
    matrix = _lagrange(t) if len(t) == degree + 1 else np.linalg.pinv(t[:, None] ** np.arange(degree + 1))
    matrix.flags.writeable = False
    return np.asarray(matrix, dtype=np.float64)


def _lagrange(t: Array) -> Array:
    """The inverse of the powers of t, whose column j has the coefficients of Πₖ (t − tₖ) / (tⱼ − tₖ), k ≠ j.

    The products keep all digits of the coefficients; of 21 positions an inverse by elimination keeps nine.
    """
    c = np.zeros((len(t), len(t)))
    c[0] = 1.0
    for k in np.argsort(np.abs(t), kind="stable"):
        j = np.arange(len(t)) != k
        grown = -t[k] * c
        grown[1:] += c[:-1]
        c[:, j] = grown[:, j] / (t[j] - t[k])
    return c


def through(t: Array, y: Array) -> Array:
    """Coefficients of degree n - 1 of the polynomial through n values y at different positions t.

    Of several sets of values, (n, m), the coefficients of each, (n, m). It has less round-off than `fitting`.
    """
    return np.asarray(np.linalg.solve(np.vander(t, increasing=True), y), dtype=np.float64)


def divided(t: Array, y: Array) -> Iterator[Array]:
    """Divided differences of orders 1, 2 … n − 1 of values y at positions t, (n,) or (n, m): Newton's coefficients."""
    for order in range(1, len(t)):
        y = (y[1:] - y[:-1]) / (t[order:] - t[:-order])
        yield y


def value(c: Array, t: float) -> float:
    """P(t)."""
    return float(c @ t ** np.arange(len(c)))


def real_roots(c: Array, low: float, high: float) -> Array:
    """Positions between low and high where P is 0.

    They are eigenvalues of the companion matrix; `numpy.polynomial` does the same in twice the time. Of the matrix as
    it stands in books a highest coefficient of mere round-off would take the roots of the others with it. Roots far
    off leave errors in those at hand, which a step of Newton's takes away.
    """
    while len(c) and c[-1] == 0.0:
        c = c[:-1]
    if len(c) < 2:
        return np.empty(0)
    companion = np.eye(len(c) - 1, k=-1)
    companion[:, -1] -= c[:-1] / c[-1]
    roots = np.asarray(np.linalg.eigvals(companion[::-1, ::-1]), dtype=np.complex128)
    real = roots.real[np.abs(roots.imag) < IMAGINARY_ROUND_OFF]
    real = real[(real >= low - SAME_ROOT) & (real <= high + SAME_ROOT)]
    powers = real[:, None] ** np.arange(len(c))
    slope = powers[:, :-1] @ (c[1:] * np.arange(1, len(c)))
    step = np.divide(powers @ c, slope, out=np.zeros_like(real), where=slope != 0.0)
    real = np.where(np.abs(step) < SAME_ROOT, real - step, real)
    return real[(real >= low) & (real <= high)]


def lowest_minimum(c: Array, low: float, high: float, near: float | None = None) -> tuple[float, float]:
    """(t, P″(t)) of the lowest minimum of P between low and high, NaN where it has none.

    A minimum that is known to be `near` some position is found from there, by Newton's method, where |t| < 1.
    """
    powers = np.arange(len(c))
    first = c[1:] * powers[1:]
    second = first[1:] * powers[1:-1]
    places = real_roots(first, low, high) if near is None else _newton(first, second, low, high, near)
    at_places = places[:, None] ** powers
    bends = at_places[:, :-2] @ second
    if not (low_ones := np.flatnonzero(bends > 0.0)).size:
        return math.nan, math.nan
    lowest = low_ones[np.argmin(at_places[low_ones] @ c)]
    return float(places[lowest]), float(bends[lowest])


def _newton(first: Array, second: Array, low: float, high: float, t: float) -> Array:
    """The root near t of P′, with the coefficients `first`; `second` are those of P″. None where it runs away."""
    exponents = np.arange(len(first))
    for _ in range(NEWTON):
        powers = t**exponents
        slope = float(second @ powers[:-1])
        step = float(first @ powers) / slope if slope > 0.0 else math.nan
        t -= step
        if abs(step) <= ROOT:
            return np.asarray([t] if low <= t <= high else [])
        if not abs(t) < 1.0:
            break
    return np.empty(0)


@cache
def gauss(count: int) -> tuple[Array, Array]:
    """Nodes and weights of Gauss and Legendre's quadrature over −1..1, (count,) each, kept: they are roots."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights
