"""Noise in the residual of a fit, and least squares with bounds: their solution and its uncertainty.

The noise may be correlated: n points are worth n/τ independent ones, τ = 1 + 2 Σ ρ_k of the residual's autocorrelation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Noise:
    """The noise of a residual.

    Attributes:
        deviation: its standard deviation, in the unit of the residual.
        together: τ, the number of correlated points that are worth one; 1 without correlation.
    """

    deviation: float
    together: float

    @property
    def power(self) -> float:
        """The variance of a mean of n points, times n: σ²τ, in the unit of the residual squared.

        σ is the standard deviation of a point, τ the number of correlated points that are worth one.
        """
        return self.deviation**2 * self.together

    def price(self, points: int, choices: int) -> float:
        """Return by how much a parameter must reduce the squared residual of n points, in the residual's unit squared.

        It is σ²τ (ln max(2, n/τ) + 2 ln `choices`), by the extended Bayesian information criterion.

        Args:
            points: n.
            choices: number of parameters of which this one is chosen.
        """
        return self.power * (math.log(max(2.0, points / self.together)) + 2.0 * math.log(choices))


def autocovariance(residual: Array) -> Array:
    """Return the autocovariance of a residual, Σ e_i e_{i+k}/n, (n,), k from 0 on, in the unit of e squared.

    The mean of the residual is not subtracted.
    """
    power = np.abs(np.fft.rfft(residual, 2 * len(residual))) ** 2
    return np.fft.irfft(power)[: len(residual)] / len(residual)


def noise_in(residual: Array) -> Noise:
    """Return the noise of a residual, (n,): its deviation is the root mean square; the mean is not subtracted.

    τ = 1 + 2 Σ of its autocorrelations, by those up to the first one below 2/√n. Deviation 0 and τ = 1 where it is 0.
    """
    return noise_by(autocovariance(residual), len(residual))


def noise_by(covariance: Array, points: int) -> Noise:
    """Return the noise by its autocovariance: τ = 1 + 2 Σ of correlations up to the first one below chance, 2/√n.

    That one is not included; all are where none is below. The sum is divided by 1 − 2/√n, at least 0.5, the share of an
    exponential correlation that is above chance. The deviation is the root of the first value, in the unit of
    the residual. It has deviation 0 and τ = 1 where the variance is 0 or negative.

    Args:
        covariance: Σ e_i e_{i+k}/n, for k from 0 on.
        points: n.
    """
    if covariance[0] <= 0.0:
        return Noise(0.0, 1.0)
    rho = covariance[1:] / covariance[0]
    chance = 2.0 / math.sqrt(points)
    end = int(np.argmax(np.append(rho, -1.0) < chance))
    return Noise(math.sqrt(covariance[0]), 1.0 + 2.0 * float(rho[:end].sum()) / (1.0 - min(0.5, chance)))


def bounded(columns: Array, target: Array, least: Array) -> Array:
    """Return the parameters p, (k,), of the least squares of columns p − target; the first of p are bounded from below.

    Raises RuntimeError where the search for the active bounds does not converge.

    Args:
        columns: (n, k).
        target: (n,).
        least: lower bounds of the first parameters, (m,), m ≤ k; the others are free.
    """
    size = np.linalg.norm(columns, axis=0)
    size[size == 0.0] = 1.0
    first, free = np.split(columns / size, [len(least)], axis=1)
    q, _ = np.linalg.qr(free)
    target = target - columns[:, : len(least)] @ least
    from scipy.optimize import nnls

    most = 100 * len(least)  # steps of the search for the active bounds
    above, _ = nnls(first - q @ (q.T @ first), target - q @ (q.T @ target), maxiter=most)
    rest = np.linalg.lstsq(free, target - first @ above)[0]
    return np.asarray(np.concatenate([least, 0.0 * rest]) + np.concatenate([above, rest]) / size)


def drawn(columns: Array, exact: Array, least: Array, deviation: float, draws: int = 300) -> Array:
    """Return errors of bounded least squares, (draws, k), with exact parameters and noise from a fixed seed.

    An error is the parameter with noise less the exact one; each call has the same noise. A flat part, whose slope is
    0, is more certain than by the normal equations, since bounds cut its errors. A standard deviation is uncertain by 4
    % after 300 draws.

    Args:
        columns: derivatives by the parameters, (n, k).
        exact: exact parameters, (k,).
        least: lower bounds of the first of them, (m,).
        deviation: standard deviation of the noise.
        draws: number of samples of the noise.
    """
    _, upper = np.linalg.qr(columns)
    noise = deviation * np.random.default_rng(1).standard_normal((draws, len(exact)))
    return np.stack([bounded(upper, upper @ exact + error, least) - exact for error in noise])


def independent(off: Array, heights: Array) -> Array:
    """Return pairs of errors of k parameters, (m, 2, k), whose halved differences are independent standard deviations.

    They are along the principal components of the heights: the means of the sample on either side of 0 along each,
    widened from the mean to the standard deviation, so that they respect the bounds of the sample; 0 on a side without
    errors. A component with less than 1e-4 of the variance is left out, so that m is at most k.

    Args:
        off: sample of the errors, (n, k).
        heights: derivatives of heights by the parameters, (j, k).
    """
    _, sizes, along = np.linalg.svd(heights @ off.T, full_matrices=False)
    modes = along[sizes**2 > 1e-4 * np.sum(sizes**2)]
    wider = np.sqrt(np.mean(modes**2, axis=1)) / np.mean(np.abs(modes), axis=1)
    sides = np.stack([modes > 0.0, modes < 0.0], axis=1)
    means = (sides @ off) / np.maximum(sides.sum(axis=2), 1)[:, :, None]
    return np.asarray(wider[:, None, None] * means)
