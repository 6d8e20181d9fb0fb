"""The polynomial P(t) = Σ cₖ tᵏ of a few samples: its coefficients, its real roots and its lowest minimum.

Positions t are of the order of 1 and counted from a sample, or the coefficients are mostly round-off.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache, lru_cache

import numpy as np
from numpy.polynomial.polynomial import polycompanion, polytrim
from numpy.typing import NDArray

Array = NDArray[np.float64]


def fitting(t: Array, degree: int) -> Array:
    """Return the matrix M, (degree + 1, n), of the coefficients c = M y for values y at n different positions t.

    The lowest power comes first. P goes through all values where degree = n - 1; of a lower degree it is that of least
    squares. M is cached and cannot be written to.
    """
    return _fitting(np.ascontiguousarray(t).tobytes(), degree)


@lru_cache(maxsize=512)  # particles that move only along z have the same polynomial in every state
def _fitting(positions: bytes, degree: int) -> Array:
    """Return the matrix, (degree + 1, n), that maps n values to the coefficients of a polynomial, lowest power first.

    It interpolates where degree = n − 1, else it is that of least squares. It is cached and read-only.

    Args:
        positions: those of the values, as the bytes of an array of float64.
        degree: of the polynomial.
    """
    t = np.frombuffer(positions)
    matrix = _lagrange(t) if len(t) == degree + 1 else np.linalg.pinv(t[:, None] ** np.arange(degree + 1))
    matrix.flags.writeable = False
    return np.asarray(matrix, dtype=np.float64)


def _lagrange(t: Array) -> Array:
    """Return the inverse of the matrix of the powers of t, (n, n), for n different positions t, (n,).

    Column j has the coefficients, lowest power first, of Πₖ (t − tₖ) / (tⱼ − tₖ), k ≠ j. The products keep all digits
    of the coefficients; of 21 positions an inverse by elimination keeps nine.
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
    """Return the coefficients, (n,), lowest power first, of the polynomial through n values y at different t, (n,).

    For several sets of values, (n, m), they are (n, m). Raises numpy's LinAlgError where two positions are equal.
    """
    return np.asarray(np.linalg.solve(np.vander(t, increasing=True), y), dtype=np.float64)


def divided(t: Array, y: Array) -> Iterator[Array]:
    """Yield Newton's divided differences of orders 1 … n − 1, in this order, of values y at different positions t.

    Those of order k are (n − k,) of values (n,), or (n − k, m) of m sets of values (n, m). Nothing for a single value.
    """
    for order in range(1, len(t)):
        y = (y[1:] - y[:-1]) / (t[order:] - t[:-order])
        yield y


def value(c: Array, t: float) -> float:
    """Return P(t) = Σ cₖ tᵏ, the value at t of the polynomial with the coefficients c, lowest power first."""
    return float(c @ t ** np.arange(len(c)))


def real_roots(c: Array, low: float, high: float) -> Array:
    """Return the positions between low and high where P is 0, in no order; empty for a constant P, also for P = 0.

    A double root appears twice, or is missing where round-off makes it complex. They are eigenvalues of the companion
    matrix, in the order of rows in which a highest coefficient of mere round-off spoils no other root. Roots far off
    leave errors in those between low and high, which a Newton step removes. A longer one than 1e-6 is not made: next to
    a double root it is round-off over round-off.

    Args:
        c: coefficients of P, (n,), one at least, lowest power first.
        low, high: ends of the interval, both included.
    """
    round_off, longest_step = 1e-9, 1e-6
    trimmed = polytrim(c)
    if len(trimmed) < 2:
        return np.empty(0)
    roots = np.asarray(np.linalg.eigvals(polycompanion(trimmed)[::-1, ::-1]), dtype=np.complex128)
    real = roots.real[np.abs(roots.imag) < round_off]
    real = real[(real >= low - longest_step) & (real <= high + longest_step)]
    powers = real[:, None] ** np.arange(len(c))
    slope = powers[:, :-1] @ (c[1:] * np.arange(1, len(c)))
    step = np.divide(powers @ c, slope, out=np.zeros_like(real), where=slope != 0.0)
    real = np.where(np.abs(step) < longest_step, real - step, real)
    return real[(real >= low) & (real <= high)]


def lowest_minimum(c: Array, low: float, high: float) -> tuple[float, float]:
    """Return t and P″(t) of the lowest minimum of P between low and high; (NaN, NaN) where it has none.

    A minimum at an end of the interval, where P′ is not 0, does not count, nor one without P″ > 0.

    Args:
        c: coefficients of P, (n,), two at least, lowest power first.
        low, high: ends of the interval.
    """
    powers = np.arange(len(c))
    first = c[1:] * powers[1:]
    second = first[1:] * powers[1:-1]
    extrema = real_roots(first, low, high)
    at_extrema = extrema[:, None] ** powers
    bends = at_extrema[:, :-2] @ second
    if not (minima := np.flatnonzero(bends > 0.0)).size:
        return math.nan, math.nan
    lowest = minima[np.argmin(at_extrema[minima] @ c)]
    return float(extrema[lowest]), float(bends[lowest])


@cache
def gauss(count: int) -> tuple[Array, Array]:
    """Return nodes, rising, and weights of the Gauss-Legendre quadrature over −1 … 1, (count,) each.

    They are cached: the caller must not change them.
    """
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights
