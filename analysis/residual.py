"""Noise in the residual of a fit, and least squares with bounds: their solution, and by how much it may be off.

The noise may be correlated: n points are worth n/τ independent ones, τ = 1 + 2 Σ ρ_k of the residual's autocorrelation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PATIENCE = 100
"""Steps of a search for the active bounds, over their number, at most."""
DRAWS = 300
"""Of the noise: a standard deviation is then known to 4 %."""
KEPT = 1e-4
"""Variance of a deviation over that of all below which it is left out."""


@dataclass(frozen=True)
class Noise:
    """Standard deviation of the residual, and how many points τ are worth one."""

    deviation: float
    together: float

    @property
    def power(self) -> float:
        """σ²τ: variance of a mean of n points, times n."""
        return self.deviation**2 * self.together

    def price(self, points: int, choices: int) -> float:
        """By how much a parameter must lower the squares of the residual of n points, one of so many choices."""
        return self.power * (math.log(max(2.0, points / self.together)) + 2.0 * math.log(choices))


def autocovariance(residual: Array) -> Array:
    """Mean of e_i e_{i+k}, k from 0, (n,)."""
    power = np.abs(np.fft.rfft(residual, 2 * len(residual))) ** 2
    return np.asarray(np.fft.irfft(power)[: len(residual)] / len(residual))


def noise_in(residual: Array) -> Noise:
    """The noise of a residual."""
    return noise_by(autocovariance(residual), len(residual))


def noise_by(covariance: Array, points: int) -> Noise:
    """The noise by its autocovariance: correlations add up to the first one that is no more than chance, 2/√n."""
    if covariance[0] <= 0.0:
        return Noise(0.0, 1.0)
    rho = covariance[1:] / covariance[0]
    end = int(np.argmax(np.append(rho, -1.0) < 2.0 / math.sqrt(points)))
    return Noise(math.sqrt(covariance[0]), 1.0 + 2.0 * float(rho[:end].sum()))


def bounded(columns: Array, target: Array, least: Array) -> Array:
    """Least squares (n, k) p = (n,), the first ones of p ≥ `least`."""
    size = np.linalg.norm(columns, axis=0)
    size[size == 0.0] = 1.0
    first, free = np.split(columns / size, [len(least)], axis=1)
    q, _ = np.linalg.qr(free)
    target = target - columns[:, : len(least)] @ least
    from scipy.optimize import nnls

    above, _ = nnls(first - q @ (q.T @ first), target - q @ (q.T @ target), maxiter=PATIENCE * len(least))
    rest = np.linalg.lstsq(free, target - first @ above)[0]
    return np.asarray(np.concatenate([least, 0.0 * rest]) + np.concatenate([above, rest]) / size)


def drawn(columns: Array, found: Array, least: Array, deviation: float) -> Array:
    """By how much bounded least squares are off, (DRAWS, k), where p, (k,), is true, and the noise is drawn.

    The first parameters have the bounds: a land, whose slope is 0, is known better than the normal equations say.
    """
    _, upper = np.linalg.qr(columns)
    noise = deviation * np.random.default_rng(1).standard_normal((DRAWS, len(found)))
    return np.stack([bounded(upper, upper @ found + one, least) - found for one in noise])


def independent(off: Array, heights: Array) -> Array:
    """Pairs (m, 2, k) of a sample (n, k) whose halved differences are its independent standard deviations.

    Principal ones of the heights by θ, (j, k): the means of those that are on either side of 0 along each, widened from
    the mean to the standard deviation, so that they are within the bounds of the sample. What moves next to nothing is
    left out.
    """
    _, sizes, along = np.linalg.svd(heights @ off.T, full_matrices=False)
    modes = along[sizes**2 > KEPT * np.sum(sizes**2)]
    wider = np.sqrt(np.mean(modes**2, axis=1)) / np.mean(np.abs(modes), axis=1)
    ways = [[off[side * one > 0.0].mean(axis=0) for side in (1.0, -1.0)] for one in modes]
    return np.asarray(wider[:, None, None] * np.reshape(ways, (len(modes), 2, off.shape[1])))
