"""The polynomial through neighbouring samples, and where it is least."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

REAL = 1e-9
"""Imaginary part up to which a root counts as real, over the width of the samples."""
NEWTON = 20
"""Steps in which Newton's method has found a minimum that is near, or will not."""
ROOT = 1e-12
"""Its last step over the width of the samples: the next one would be round-off."""


@dataclass(frozen=True)
class Stencil:
    """Samples low … low + size - 1 (indices) under a polynomial of this degree."""

    low: int
    size: int
    degree: int

    def of(self, values: Array) -> Array:
        """Those of all samples that are under it, (size,)."""
        return values[self.low : self.low + self.size]


def polynomial_minimum(
    x: Array, y: Array, stencil: Stencil, low: float, high: float, near: float | None = None
) -> tuple[float, float]:
    """Position of the polynomial's lowest minimum between low and high, and its shift per unit of noise in y.

    x: places, ascending, (n,); y: values, (n,); low, high, near and the position in the unit of x. Without a minimum
    there (NaN, NaN). Where one is known to be `near`, it is found by Newton's method.
    """
    points, values = stencil.of(x), stencil.of(y)
    origin, width, depth = float(points.sum()) / len(points), float(points[-1] - points[0]), float(np.abs(values).max())
    powers = np.arange(stencil.degree + 1)
    matrix = ((points - origin) / width)[:, None] ** powers
    inverse = np.linalg.inv(matrix) if stencil.size == stencil.degree + 1 else np.linalg.pinv(matrix)
    coefficients = inverse @ (values / depth)
    first = coefficients[1:] * powers[1:]
    second = first[1:] * powers[1:-1]
    if near is None:
        roots = _roots(first)
        real = roots.real[np.abs(roots.imag) < REAL]
    else:
        real = np.atleast_1d(_newton(first, second, (near - origin) / width))
    real = real[(real >= (low - origin) / width) & (real <= (high - origin) / width)]
    at_roots = real[:, None] ** powers
    bends = at_roots[:, :-2] @ second
    if not (bends > 0.0).any():
        return math.nan, math.nan
    lowest = int(np.argmin(np.where(bends > 0.0, at_roots @ coefficients, math.inf)))
    slope = float(np.linalg.norm((powers[1:] * at_roots[lowest, :-1]) @ inverse[1:]))
    return origin + float(real[lowest]) * width, slope * width / (float(bends[lowest]) * depth)


def _newton(first: Array, second: Array, t: float) -> float:
    """Root near t of Σ cₖ tᵏ, c the coefficients `first`; `second` those of the derivative. NaN where it runs away."""
    for _ in range(NEWTON):
        powers = t ** np.arange(len(first))
        slope = float(second @ powers[:-1])
        step = float(first @ powers) / slope if slope > 0.0 else math.nan
        t -= step
        if not (abs(step) > ROOT and abs(t) < 1.0):
            break
    return t if abs(step) <= ROOT else math.nan


def _roots(coefficients: Array) -> NDArray[np.complex128]:
    """Roots of Σ cₖ tᵏ: eigenvalues of the companion matrix. `numpy.polynomial` does the same in twice the time."""
    lead = coefficients[-1] or np.finfo(np.float64).eps * float(np.abs(coefficients).max())
    if lead == 0.0:
        return np.empty(0, dtype=np.complex128)
    companion = np.eye(len(coefficients) - 1, k=-1)
    companion[:, -1] -= coefficients[:-1] / lead
    return np.asarray(np.linalg.eigvals(companion), dtype=np.complex128)
