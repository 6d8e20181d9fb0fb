"""Noise of a measured force curve: white noise and noise with a memory, as one covariance that the residuals decide.

    F_i = F(z_i) + σ (√(1 − s) e_i + √s m_i),    cov(m_i, m_j) = exp(−|i − j|/τ)

s is the share of the variance that has a memory, τ [points] its length: s = 0 is white noise, s = 1 a first-order
autoregression. The exact likelihood and the whitened residuals follow from a Kalman filter for m, whose gain is a
recursion of numbers, so that whitening solves one bidiagonal system. Points that were left out leave a gap: τ counts
them. τ and s are never taken for known: everything is averaged over a grid of both, each with the restricted likelihood
of its residuals (REML), in which the parameters of the curve have been integrated out.

Source: P. J. Brockwell, R. A. Davis, Time Series: Theory and Methods (1991), chapter 12; D. A. Harville, Journal of the
American Statistical Association 72 (1977) 320.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded
from scipy.optimize import brentq
from scipy.special import softmax, stdtr

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
SHARES = (0.0, 0.05, 0.15, 0.35, 0.6, 0.8, 0.93, 1.0)
"""Shares s of a first look; `finer` goes between them."""
SHORTEST, MEMORIES = 0.7, 12
"""Shortest memory [points] that differs from white noise, and how many lengths a first look has."""
LONGEST_SHARE = 0.25
"""Longest memory over the points of the longest run: of a longer one no curve knows its size."""
UNLIKELY = 1e-5
"""Weight over the largest one below which a place of the grid is left out of a finer one."""


@dataclass(frozen=True)
class Noise:
    """One noise of unit variance, ready to whiten the kept points of some runs.

    Attributes:
        share, memory: s and τ [points].
        decay: of m from the point before, (n,); 0 at the first point of a run.
        gain, deviation: of each point's prediction, and its standard deviation, (n,).
    """

    share: float
    memory: float
    decay: Array
    gain: Array
    deviation: Array

    def whitened(self, columns: Array) -> Array:
        """A column (n,) or columns (n, m) [any unit] of all kept points, as independent numbers of that unit."""
        # x_i = (1 − K_i) φ_i x_{i−1} + K_i y_i is what is known of m after point i, φ_{i+1} x_i its prediction.
        band = np.stack([np.ones_like(self.gain), -np.roll((1.0 - self.gain) * self.decay, -1)])
        known = solve_banded((1, 0), band, (self.gain * columns.T).T, check_finite=False).T
        predicted = self.decay * np.roll(known, 1, axis=-1)
        return np.asarray(((columns.T - predicted) / self.deviation).T)

    @property
    def log_determinant(self) -> float:
        """log |V|, V of unit variance."""
        return 2.0 * float(np.log(self.deviation).sum())


def noises(pairs: Sequence[tuple[float, float]], runs: Sequence[Indices]) -> list[Noise]:
    """The noises of pairs (s, τ) for runs of kept points, each given by the indices of its points."""
    share, memory = np.array(pairs).T
    gaps = np.concatenate([np.diff(run.astype(np.float64), prepend=-math.inf) for run in runs])
    decay = np.exp(-gaps[:, None] / memory)
    gain, variance, left = np.empty_like(decay), np.empty_like(decay), share
    for i, kept in enumerate(decay**2):
        left = kept * left + share * (1.0 - kept)
        variance[i] = left + 1.0 - share
        gain[i] = left / variance[i]
        left = left * (1.0 - gain[i])
    columns = zip(decay.T, gain.T, np.sqrt(variance.T), strict=True)
    return [Noise(*pair, *column) for pair, column in zip(pairs, columns, strict=True)]


@dataclass(frozen=True)
class Judged:
    """What the residuals say under one noise.

    Attributes:
        noise: that one.
        deviation: σ [unit of the residuals].
        step: change of the parameters (p,) that this noise asks for.
        covariance: of the parameters (p, p).
        weight: its share of the restricted likelihood.
    """

    noise: Noise
    deviation: float
    step: Array
    covariance: Array
    weight: float


def _judged(found: Sequence[Noise], residuals: Array, slopes: Array, prior: Array) -> tuple[list[Judged], Array]:
    """What the residuals say under each noise, without its weight, and the logarithms of the likelihoods, (m,).

    The residuals change by −slopes·step; `prior` (q, p + 1) has rows of what is known of the parameters, its last
    column the misfit, in standard deviations.
    """
    columns = np.column_stack([slopes, residuals])
    # R of J = QR has the precision that JᵀJ loses; its last column is Qᵀr, and the norm of the residual of the fit.
    whole: Array = np.asarray(np.linalg.qr([noise.whitened(columns) for noise in found], mode="r"))
    J, r, rest = whole[:, :-1, :-1], whole[:, :-1, -1:], whole[:, -1, -1]
    P, known = (np.broadcast_to(one, (len(found), *one.shape)) for one in (prior[:, :-1], prior[:, -1:]))
    freedom = max(1.0, residuals.size - float(J.shape[2] - prior.shape[0]))
    deviation = np.sqrt((np.sum(r**2, axis=(1, 2)) + rest**2) / freedom)
    for _ in range(3):  # σ weighs the data against what is known of the parameters
        scale = deviation[:, None, None]
        q, triangle = np.linalg.qr(np.concatenate([J / scale, P], axis=1))
        step = np.linalg.solve(triangle, q.mT @ np.concatenate([r / scale, known], axis=1))
        deviation = np.sqrt((np.sum((r - J @ step) ** 2, axis=(1, 2)) + rest**2) / freedom)
    logs = -0.5 * np.asarray([noise.log_determinant for noise in found]) - residuals.size * np.log(deviation)
    logs -= 0.5 * np.sum((known - P @ step) ** 2, axis=(1, 2))
    logs -= np.log(np.abs(np.diagonal(triangle, axis1=1, axis2=2))).sum(axis=1)
    root = np.linalg.inv(triangle)
    each = zip(found, deviation.tolist(), step[:, :, 0], root @ root.mT, strict=True)
    return [Judged(*one, 0.0) for one in each], logs


@dataclass(frozen=True)
class Uncertain:
    """The parameters of a curve under all noises that its residuals allow.

    Attributes:
        judged: each noise with its weight.
        freedom: degrees of freedom of each σ.
    """

    judged: tuple[Judged, ...]
    freedom: float

    @property
    def best(self) -> Judged:
        """The most likely one."""
        return max(self.judged, key=lambda one: one.weight)

    def quantile(self, index: int, level: float) -> float:
        """Above its value under the most likely noise a parameter is by at most this much, with a probability `level`.

        Student's t under each noise, averaged: no noise is taken for known.
        """
        weights = np.array([one.weight for one in self.judged])
        centres = np.array([one.step[index] for one in self.judged]) - self.best.step[index]
        scales = np.sqrt([one.covariance[index, index] for one in self.judged])

        def excess(value: float) -> float:
            return float(weights @ stdtr(self.freedom, (value - centres) / scales)) - level

        reach = 60.0 * float(scales.max()) + float(np.abs(centres).max())
        return float(brentq(excess, -reach, reach, rtol=1e-6, xtol=1e-9 * reach))


def uncertain(runs: Sequence[Indices], residuals: Array, slopes: Array, prior: Array, looks: int) -> Uncertain:
    """All noises with their weights: a first look over s and τ, and a finer one where it is likely.

    Args:
        runs: indices of the kept points of each run; whitening begins anew with each.
        residuals: (n,) of all runs.
        slopes: (n, p), −∂residuals/∂parameters.
        prior: (q, p + 1), see `_judged`.
        looks: 1 where the most likely noise is enough.
    """
    longest = max(4.0, LONGEST_SHARE * max(run.size for run in runs))
    memories: Array = np.geomspace(SHORTEST, longest, MEMORIES)
    shares: Array = np.array(SHARES)
    for _ in range(looks):
        pairs = [(float(s), float(m)) for s in shares for m in (memories if s > 0.0 else memories[:1])]
        found, logs = _judged(noises(pairs, runs), residuals, slopes, prior)
        # White noise stands once for all memories.
        weights = softmax(logs + np.log([1.0 if s > 0.0 else memories.size for s, _ in pairs]))
        likely = [pair for pair, weight in zip(pairs, weights, strict=True) if weight > UNLIKELY * weights.max()]
        of_shares, of_memories = map(np.array, zip(*likely, strict=True))
        shares, memories = _finer(of_shares, shares, np.linspace), _finer(of_memories, memories, np.geomspace)
    freedom = max(1.0, residuals.size - float(slopes.shape[1] - prior.shape[0]))
    judged = (replace(one, weight=float(weight)) for one, weight in zip(found, weights, strict=True))
    return Uncertain(tuple(judged), freedom)


def _finer(likely: Array, grid: Array, spaced: Callable[..., Array]) -> Array:
    """As many places as before, so spaced, between the neighbours of those that are likely."""
    low = max(0, int(np.searchsorted(grid, likely.min())) - 1)
    high = min(grid.size - 1, int(np.searchsorted(grid, likely.max())) + 1)
    return grid if high - low >= grid.size - 2 else spaced(grid[low], grid[high], grid.size)
