"""Noise of a measured force curve: white noise and noise with a memory, in shares that follow from the residuals.

    F_i = F(z_i) + σ (√(1 − s) e_i + √s m_i),    cov(m_i, m_j) = exp(−|i − j|/τ)

s is the share of the variance that has a memory, τ [points] its length: s = 0 is white noise, s = 1 a first-order
autoregression. The exact likelihood and the whitened residuals follow from a Kalman filter for m, whose gain is a
recursion of numbers, so that whitening solves one bidiagonal system. Excluded points leave a gap, whose length counts
for the memory. The memory ends with a pause between two runs; without a pause it lasts to the next run, as over the
turn of a curve, where the force is largest: two runs that share their noise tell little more of this force than one. τ,
s and a pause are unknown, too: every estimate is an average over a grid of τ and s, with and without a pause, weighted
with the restricted likelihood of the residuals (REML), in which the parameters of the curve have been integrated out.

Source: P. J. Brockwell, R. A. Davis, Time Series: Theory and Methods (1991), chapter 12; D. A. Harville, Journal of the
American Statistical Association 72 (1977) 320.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dtbtrs
from scipy.optimize import brentq
from scipy.special import softmax, stdtr

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Noise:
    """A noise of unit variance with its Kalman filter over the compared points of some runs.

    Attributes:
        share: s.
        memory: τ [points].
        decay: factor of m from the point before, (n,); 0 at the first point of a run.
        gain: gain of the filter at each point, (n,).
        deviation: standard deviation of the prediction of each point, (n,).
    """

    share: float
    memory: float
    decay: Array
    gain: Array
    deviation: Array

    def whitened(self, columns: Array) -> Array:
        """Return columns of the compared points decorrelated, (n,) or (n, m) as given, in the same unit.

        Each number is the error of its prediction from the points before, over the standard deviation of the prediction
        for noise of unit variance: noise of standard deviation σ becomes white noise of σ.
        """
        # x_i = (1 − K_i) φ_i x_{i−1} + K_i y_i is the filter's m after point i, φ_{i+1} x_i its prediction.
        band = np.stack([np.ones_like(self.gain), -np.roll((1.0 - self.gain) * self.decay, -1)])
        filtered = dtbtrs(band, (self.gain * columns.T).T, uplo="L", diag="U")[0].reshape(columns.shape).T
        predicted = self.decay * np.roll(filtered, 1, axis=-1)
        return np.asarray(((columns.T - predicted) / self.deviation).T)

    @property
    def log_determinant(self) -> float:
        """The natural logarithm of the determinant of the noise's covariance matrix (n, n), of unit variance."""
        return 2.0 * float(np.log(self.deviation).sum())


def noises(pairs: Sequence[tuple[float, float]], runs: Sequence[Indices]) -> list[Noise]:
    """Return the noise, of unit variance, of each pair (s, τ), in their order, for the compared points of some runs.

    The filter begins anew with each run.

    Args:
        pairs: s, the share of the variance with a memory, 0 … 1, and the memory τ > 0 [points].
        runs: the rising indices of the compared points of each run.
    """
    share, memory = np.array(pairs).T
    gaps = np.concatenate([np.diff(run.astype(np.float64), prepend=-math.inf) for run in runs])
    decay = np.exp(-gaps[:, None] / memory)
    gain, variance, unfiltered = np.empty_like(decay), np.empty_like(decay), share
    for i, correlated in enumerate(decay**2):
        unfiltered = correlated * unfiltered + share * (1.0 - correlated)
        variance[i] = unfiltered + 1.0 - share
        gain[i] = unfiltered / variance[i]
        unfiltered = unfiltered * (1.0 - gain[i])
    columns = zip(decay.T, gain.T, np.sqrt(variance.T), strict=True)
    return [Noise(*pair, *column) for pair, column in zip(pairs, columns, strict=True)]


@dataclass(frozen=True)
class Estimate:
    """The estimate of the parameters under a noise.

    Attributes:
        noise: the noise, of unit variance.
        deviation: its standard deviation σ, in the unit of the residuals.
        step: change of the parameters (p,) from those of the residuals to the estimate.
        covariance: of the parameters (p, p).
        weight: the noise's share of the restricted likelihood, 0 … 1.
    """

    noise: Noise
    deviation: float
    step: Array
    covariance: Array
    weight: float


def _estimates(
    grid: Sequence[Noise], residuals: Array, slopes: Array, prior: Array, widest: float = 1e6
) -> tuple[list[Estimate], Array]:
    """Return (the estimate under each of m noises, with weight 0; natural logarithms of their likelihoods, (m,)).

    The likelihoods are restricted ones, but for a common constant. The residuals (n,) change by −slopes·step, slopes
    (n, p); `prior` (q, p + 1) has a row for each calibration of the parameters, its last column the misfit, in standard
    deviations. `widest`: standard deviation of a parameter of which neither says anything.
    """
    columns = np.column_stack([slopes, residuals])
    # R of J = QR has the precision that JᵀJ loses; its last column is Qᵀr, and the norm of the residual of the fit.
    R: Array = np.asarray(np.linalg.qr([noise.whitened(columns) for noise in grid], mode="r"))
    J, r, rest = R[:, :-1, :-1], R[:, :-1, -1:], R[:, -1, -1]
    P, misfit = (np.broadcast_to(part, (len(grid), *part.shape)) for part in (prior[:, :-1], prior[:, -1:]))
    freedom = max(1.0, residuals.size - float(J.shape[2] - prior.shape[0]))
    deviation = np.sqrt((np.sum(r**2, axis=(1, 2)) + rest**2) / freedom)
    weak = np.broadcast_to(np.eye(J.shape[2]) / widest, (len(grid), *[J.shape[2]] * 2))
    rest_of_step = np.zeros((len(grid), J.shape[2], 1))
    for _ in range(3):  # σ weighs the data against the calibrations
        scale = deviation[:, None, None]
        q, triangle = np.linalg.qr(np.concatenate([J / scale, P, weak], axis=1))
        step = np.linalg.solve(triangle, q.mT @ np.concatenate([r / scale, misfit, rest_of_step], axis=1))
        deviation = np.sqrt((np.sum((r - J @ step) ** 2, axis=(1, 2)) + rest**2) / freedom)
    logs = -0.5 * np.asarray([noise.log_determinant for noise in grid]) - residuals.size * np.log(deviation)
    logs -= 0.5 * np.sum((misfit - P @ step) ** 2, axis=(1, 2))
    logs -= np.log(np.abs(np.diagonal(triangle, axis1=1, axis2=2))).sum(axis=1)
    root = np.linalg.inv(triangle)
    rows = zip(grid, deviation.tolist(), step[:, :, 0], root @ root.mT, strict=True)
    return [Estimate(*row, 0.0) for row in rows], logs


@dataclass(frozen=True)
class AveragedEstimate:
    """The estimates of the parameters of a curve under all noises of a grid, with their weights.

    Attributes:
        estimates: the estimate under each noise.
        freedom: degrees of freedom of each σ.
    """

    estimates: tuple[Estimate, ...]
    freedom: float

    @property
    def best(self) -> Estimate:
        """The estimate under the most likely noise, that of the largest weight; the first one of equals."""
        return max(self.estimates, key=lambda estimate: estimate.weight)

    @property
    def covariance(self) -> Array:
        """The covariance of the parameters, (p, p): its mean over the noises, and that of the estimates' scatter."""
        weights = np.array([estimate.weight for estimate in self.estimates])
        steps = np.array([estimate.step for estimate in self.estimates])
        off = steps - weights @ steps
        mean = np.einsum("k,kij->ij", weights, [estimate.covariance for estimate in self.estimates])
        return np.asarray(mean + off.T @ (weights[:, None] * off))

    def ends(self, index: int, coverage: float) -> Array:
        """Return (lower, upper) end of an interval of a parameter, less its best estimate, (2,).

        Its unit is that of the parameters of the least squares: log p of a positive parameter p. The distribution is
        the average of Student's t under each noise, and half of what is not covered is on each side.

        Args:
            index: of the parameter.
            coverage: probability of the interval, between 0 and 1, exclusive.
        """
        weights = np.array([estimate.weight for estimate in self.estimates])
        centres = np.array([estimate.step[index] for estimate in self.estimates]) - self.best.step[index]
        scales = np.sqrt([estimate.covariance[index, index] for estimate in self.estimates])

        def excess(value: float, level: float) -> float:
            """Return the probability of a smaller value less `level`, so that it is 0 at the quantile."""
            return float(weights @ stdtr(self.freedom, (value - centres) / scales)) - level

        reach = 60.0 * float(scales.max()) + float(np.abs(centres).max())
        levels = 0.5 * (1.0 - coverage), 0.5 * (1.0 + coverage)
        return np.array([brentq(excess, -reach, reach, (level,), 1e-9 * reach, 1e-6) for level in levels])


@dataclass(frozen=True)
class Resting:
    """The measured forces of bodies apart, which show the noise without any contact model.

    Attributes:
        runs: indices of the points of each run.
        forces: at these points, (n,).
        columns: of the line through them, (n, q): a level for each run, and perhaps a slope.
    """

    runs: tuple[Indices, ...]
    forces: Array
    columns: Array

    def line(self, looks: int = 2) -> AveragedEstimate:
        """Return the estimates of the line's levels and slope, (q,), under all noises, from a line of 0 on.

        `looks`: number of grids, as in `averaged`.
        """
        return averaged(self.runs, self.forces, self.columns, np.zeros((0, self.columns.shape[1] + 1)), looks)

    def likelihoods(self, pairs: Sequence[tuple[float, float]]) -> Array:
        """Return the natural logarithms of the restricted likelihoods of noises (s, τ), (m,), but for a constant."""
        prior = np.zeros((0, self.columns.shape[1] + 1))
        return _estimates(noises(pairs, self.runs), self.forces, self.columns, prior)[1]


def averaged(
    runs: Sequence[Indices],
    residuals: Array,
    slopes: Array,
    prior: Array,
    looks: int,
    resting: Resting | None = None,
    excluded: float = 6.9,
) -> AveragedEstimate:
    """Return the estimates under all noises of a grid over s and τ, with weights by likelihood whose sum is 1.

    s is the share of the variance with a memory, τ the memory [points]. Of several runs each pair has two noises, as
    likely before the residuals are known: one with a pause after each run, in which the memory ends, and one whose
    memory lasts to the next run. Each further grid is finer around the likely pairs; the estimates are those of the
    last one. Noises that the resting forces exclude have the weight 0: what a contact model misses in contact must not
    pass for a memory of the noise.

    Args:
        runs: indices of the compared points of each run, in the order of time.
        residuals: (n,) of all runs.
        slopes: (n, p), −∂residuals/∂parameters.
        prior: (q, p + 1), a row for each calibration of a parameter; the last column is its misfit in standard
            deviations.
        looks: number of grids, at least 1, which is enough for the most likely noise.
        resting: forces of bodies apart; None: there are too few.
        excluded: natural logarithm of the likelihood of the resting forces below the largest one from which on a noise
            is excluded: 99.9 % of the χ² distribution with two degrees of freedom, those of s and τ.
    """
    shares: Array = np.array([0.0, 0.05, 0.15, 0.35, 0.6, 0.8, 0.93, 1.0])
    # A memory shorter than 0.7 points is white noise; the variance of one longer than a quarter of a run is unknown.
    memories: Array = np.geomspace(0.7, max(4.0, 0.25 * max(run.size for run in runs)), 12)
    records = [[*runs], [np.concatenate([*runs])]][: len(runs)]  # with a pause after each run, and without
    highest = -math.inf
    for _ in range(looks):
        pairs = [(float(s), float(m)) for s in shares for m in (memories if s > 0.0 else memories[:1])]
        grid = [noise for record in records for noise in noises(pairs, record)]
        estimates, logs = _estimates(grid, residuals, slopes, prior)
        if resting is not None:
            shown = resting.likelihoods(pairs)
            highest = max(highest, float(shown.max()))
            logs[np.tile(shown < min(highest - excluded, shown.max()), len(records))] = -math.inf
        # White noise stands once for all memories.
        weights = softmax(logs + np.log([1.0 if noise.share > 0.0 else memories.size for noise in grid]))
        tried = zip(pairs * len(records), weights, strict=True)
        likely = [pair for pair, weight in tried if weight > 1e-5 * weights.max()]
        likely_shares, likely_memories = map(np.array, zip(*likely, strict=True))
        shares = _finer(likely_shares, shares, np.linspace)
        memories = _finer(likely_memories, memories, np.geomspace)
    freedom = max(1.0, residuals.size - float(slopes.shape[1] - prior.shape[0]))
    weighted = (replace(estimate, weight=float(weight)) for estimate, weight in zip(estimates, weights, strict=True))
    return AveragedEstimate(tuple(weighted), freedom)


def _finer(likely: Array, grid: Array, spaced: Callable[..., Array]) -> Array:
    """Return a rising grid (n,) as large as `grid`, from the neighbour below to that above its `likely` points.

    `spaced` makes it from (first, last, n), such as np.linspace. `grid` itself is returned where these neighbours leave
    out one of its intervals at most.
    """
    low = max(0, int(np.searchsorted(grid, likely.min())) - 1)
    high = min(grid.size - 1, int(np.searchsorted(grid, likely.max())) + 1)
    return grid if high - low >= grid.size - 2 else spaced(grid[low], grid[high], grid.size)
