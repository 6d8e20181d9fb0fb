"""The parameters that fit a curve: starts over decades, least squares under the noise, and the profile likelihood.

Unknowns are u = log(p/p₀) of a positive parameter p, and lengths or forces over that of the data for the contact point
and the offset of the force. A calibration of a parameter (a value with its ±) is a further row of the least squares.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution, least_squares

from contact1d.workflow.fit.noise import AveragedEstimate, Estimate, Indices, Noise, Resting, averaged, noises

Array = NDArray[np.float64]
LIMIT = 3.0 * math.log(10.0)
"""Largest |u| of a positive parameter: it is sought over three decades to both sides of the value in the scene."""
STARTS = 4
"""Points of the global search that are starts of a least-squares fit, if far apart."""
OUTLIER = 5.0
"""Whitened residual over its standard deviation beyond which a point is an outlier: one in 1.7 million."""
LEVEL, TWO_SIDED = 0.95, 1.959964
"""Coverage of an interval, and its half-width over the standard deviation of a normal distribution."""


@dataclass(frozen=True)
class Unknown:
    """A number that a fit may change.

    Attributes:
        name: a dotted key of the scene, or a name of the measurement.
        scale: value of a positive unknown at u = 0; of any other at u = 1; in the unit of the parameter.
        positive: whether p = scale·exp(u), else p = scale·u.
        known: mean and standard deviation of its calibration, in the unit of the parameter; None without one.
        fitted: whether it is a parameter of the fit; else a nuisance parameter.
        most: largest value that is allowed.
    """

    name: str
    scale: float
    positive: bool = True
    known: tuple[float, float] | None = None
    fitted: bool = False
    most: float = math.inf

    @property
    def limits(self) -> tuple[float, float]:
        """The least and largest u: of a positive parameter three decades to both sides of its scale, to `most`."""
        return (-LIMIT, min(LIMIT, math.log(self.most / self.scale))) if self.positive else (-math.inf, math.inf)

    def value(self, u: float) -> float:
        """Return the parameter p in its unit: scale·exp(u) of a positive one, with u limited to ±50, else scale·u."""
        return self.scale * (math.exp(min(max(u, -50.0), 50.0)) if self.positive else u)

    def inverse(self, value: float) -> float:
        """Return u of a value of the parameter in its unit; −∞ of a positive parameter's 0 or less."""
        if self.positive:
            return math.log(value / self.scale) if value > 0.0 else -math.inf
        return value / self.scale

    def slope(self, u: float) -> float:
        """Return the derivative ∂p/∂u of the parameter, in its unit: p itself of a positive one, else its scale."""
        return self.value(u) if self.positive else self.scale


Model = Callable[[Sequence[float]], Array]
"""From the values of all unknowns to the forces at all points (n,)."""


@dataclass(frozen=True)
class Problem:
    """A least-squares problem under a noise.

    Attributes:
        unknowns: the unknowns, (p,).
        model: function of their values that returns the forces at all points.
        forces: measured forces at all points, (n,).
        runs: indices of the points that are compared, one array for each run.
        resting: function of the values of all unknowns and of runs that returns the forces of bodies apart in these.
        excess: function of the values of all unknowns that returns by how much each of some bounds is exceeded, over
            what is tolerated, (b,), ≥ 0.
    """

    unknowns: tuple[Unknown, ...]
    model: Model
    forces: Array
    runs: tuple[Indices, ...]
    resting: Callable[[Sequence[float], Sequence[Indices]], Resting | None]
    excess: Model

    @property
    def kept(self) -> Indices:
        """The indices in the curve of all compared points, run after run, rising in each."""
        return np.concatenate(self.runs)

    def without(self, points: Indices) -> Problem:
        """Return a copy of the problem in which the points of these indices in the curve are not compared."""
        return replace(self, runs=tuple(run[~np.isin(run, points)] for run in self.runs))

    def values(self, u: Array) -> list[float]:
        """Return the values of the unknowns in their order, each in its unit: scale·exp(u) if positive, or scale·u.

        `u`: logarithm of the ratio of each positive unknown to its scale, the ratio of any other, (p,).
        """
        return [unknown.value(float(x)) for unknown, x in zip(self.unknowns, u, strict=True)]

    def residuals(self, u: Array) -> Array:
        """Return the measured less the predicted force [FU], compression positive, of the compared points, (n,).

        The points are in the order of the runs. `u`: logarithm of the ratio of each positive unknown to its scale, the
        ratio of any other, (p,).
        """
        return (self.forces - self.model(self.values(u)))[self.kept]

    def slopes(self, u: Array, free: Sequence[int] | None = None) -> Array:
        """Return ∂(predicted force)/∂u [FU] of the n compared points, a column for each unknown in `free`.

        By central differences. `u`: logarithm of the ratio of each positive unknown to its scale, the ratio of any
        other, (p,). `free`: indices of unknowns; None: all.
        """
        return self.derivative(self.model, u, free)[self.kept]

    def derivative(self, of: Model, u: Array, free: Sequence[int] | None = None, step: float = 1e-4) -> Array:
        """Return ∂/∂u of a function of the unknowns' values, (n, number of unknowns), by central differences.

        Its columns are those of the `free` unknowns, in their order.

        Args:
            of: function of the values of all unknowns that returns an array (n,).
            u: logarithm of the ratio of each positive unknown to its scale, the ratio of any other, (p,).
            free: indices of unknowns, one at least; None: all.
            step: of u, to both sides.
        """
        steps = step * np.eye(u.size)
        columns = [
            (of(self.values(u + steps[i])) - of(self.values(u - steps[i]))) / (2.0 * step)
            for i in (range(u.size) if free is None else free)
        ]
        return np.column_stack(columns)

    def prior(self, u: Array) -> Array:
        """Return a row for each calibrated unknown and each bound, (q, p + 1): derivatives by u and, last, its misfit.

        Those of a calibration are of the value over its standard deviation; the misfit is the calibrated mean less the
        value at u. Those of a bound are of its excess, which should be 0. Calibrations come first, in the order of the
        unknowns.

        `u`: logarithm of the ratio of each positive unknown to its scale, the ratio of any other, (p,).
        """
        rows = []
        for i, unknown in enumerate(self.unknowns):
            if unknown.known is not None:
                mean, spread = unknown.known
                row = np.zeros(u.size + 1)
                row[i], row[-1] = unknown.slope(float(u[i])) / spread, (mean - unknown.value(float(u[i]))) / spread
                rows.append(row)
        excess = self.excess(self.values(u))
        slopes = self.derivative(self.excess, u) if excess.any() else np.zeros((excess.size, u.size))
        return np.concatenate([np.array(rows).reshape(-1, u.size + 1), np.column_stack([slopes, -excess])])

    def least(
        self, u: Array, noise: Noise, deviation: float, fixed: int | None = None, robust: bool = False
    ) -> tuple[Array, float]:
        """Return (u of all unknowns (p,) at the least sum of squares, that sum, dimensionless), from a start on.

        u is the logarithm of the ratio of a positive unknown to its scale, the ratio of any other. The sum is that of
        residuals and of misfits of calibrations in standard deviations; if `robust`, of their soft-L1 loss. Positive
        unknowns stay within three decades of their scale. After 60 evaluations it is the latest, converged or not. The
        argument u is not changed.

        Args:
            u: start, (p,).
            noise: that whitens the residuals.
            deviation: its standard deviation [FU].
            fixed: index of an unknown that is not changed; None: all are.
            robust: whether large residuals count linearly.
        """
        free = [i for i in range(u.size) if i != fixed]

        def completed(free_u: Array) -> Array:
            """Return all unknowns u, (p,), a copy of the start with the free ones replaced."""
            full = u.copy()
            full[free] = free_u
            return full

        def rows(free_u: Array) -> Array:
            """Return whitened residuals (n,), then misfits of calibrations (q,), in standard deviations, (n + q,)."""
            full = completed(free_u)
            return np.concatenate([noise.whitened(self.residuals(full)) / deviation, self.prior(full)[:, -1]])

        def jacobian(free_u: Array) -> Array:
            """Return the derivatives of the n residuals and q misfits by the free unknowns, one column for each."""
            full = completed(free_u)
            return -np.concatenate(
                [noise.whitened(self.slopes(full, free)) / deviation, self.prior(full)[:, :-1][:, free]]
            )

        low, high = np.array([unknown.limits for unknown in self.unknowns])[free].T
        start, margin = np.clip(u[free], low, high), 1e-3  # a start must be inside the bounds
        bounds = low - margin, high + margin
        options: dict[str, Any] = dict.fromkeys(("xtol", "ftol"), 1e-6) | {"gtol": 1e-12, "max_nfev": 60}
        options |= {"loss": "soft_l1", "f_scale": 2.0} if robust else {}
        fit = least_squares(rows, start, jacobian, bounds, x_scale="jac", **options)
        return completed(fit.x), 2.0 * float(fit.cost)


@dataclass(frozen=True)
class Solution:
    """The converged solution of a problem.

    Attributes:
        problem: the problem without the outliers.
        u: the unknowns of the least sum of squares, (p,).
        best: the estimate under the most likely noise, which weighs that sum.
        average: the estimates under all noises.
        squares: the least sum of squares over the variance of the most likely noise (dimensionless).
        outliers: indices of the excluded points, rising.
    """

    problem: Problem
    u: Array
    best: Estimate
    average: AveragedEstimate
    squares: float
    outliers: Indices

    @property
    def values(self) -> list[float]:
        """The values of all unknowns at the least sum of squares, each in its unit, in the order of the problem."""
        return self.problem.values(self.u)


def global_search(
    problem: Problem,
    sought: Sequence[int],
    complete: Callable[[Array], Array],
    generations: int = 40,
    size: int = 16,
    step: float = 0.125,
) -> list[Array]:
    """Return starts u (p,) of a fit, six at most and the best first, from a search over the sought unknowns.

    u is the logarithm of the ratio of a positive unknown to its value in the scene, and is searched over three decades
    to either side. The valley of a good fit is some percent wide, in a plane of decades: a population is evolved, which
    takes some thousand curves, and its best members are starts. Most often these have met in one minimum: that is one
    start, and further minima along its valley follow, of the residuals under their likeliest noise. Equal arguments
    give equal starts. Where nothing is sought, the one start is `complete` of 0.

    Args:
        problem: what is fitted.
        sought: indices of the unknowns that the search changes.
        complete: function that returns u with the unknowns set which follow from these.
        generations: most generations of the population.
        size: of the population, for each sought unknown.
        step: least distance of two starts in the sought unknowns, and step along the valley.
    """

    def completed(member: Array) -> Array:
        """Return all unknowns u, (p,): the sought ones as given, others 0 or as `complete` sets them."""
        u = np.zeros(len(problem.unknowns))
        u[list(sought)] = member
        return complete(u)

    if not sought:
        return [completed(np.zeros(0))]

    def misfit(member: Array) -> float:
        """Return Σ |residual| [FU] of the compared points for the sought unknowns; 1e100 where it is NaN or larger."""
        total = float(np.abs(problem.residuals(completed(member))).sum())
        return min(1e100, total)  # of NaN, too; and the square of it is a number

    population = differential_evolution(
        misfit, [problem.unknowns[i].limits for i in sought], rng=1, maxiter=generations, popsize=size, tol=0.02,
        init="sobol", polish=False, x0=np.zeros(len(sought)),
    )  # fmt: skip
    members = population.population[np.argsort(population.population_energies)[:STARTS]]
    likeliest = _estimate(problem, completed(members[0]), looks=1).best.noise

    def white(member: Array) -> Array:
        """Return the whitened residuals [FU] of the compared points, (n,), for the sought unknowns."""
        return likeliest.whitened(problem.residuals(completed(member)))

    starts: list[Array] = []
    for member in [*members, *_further_minima(white, members[0], step)]:
        if all(np.linalg.norm(member - start) > step for start in starts):
            starts.append(member)
    return [completed(start) for start in starts]


def _further_minima(residuals: Callable[[Array], Array], best: Array, step: float) -> list[Array]:
    """Return further minima of Σ |residual|, as points (s,), two at most, along the valley through a minimum.

    The force softens or stiffens where the contact edge passes a kink of the tip. Another work of adhesion, with
    modulus and contact point to it, moves this place, so that the sum may have several minima. The valley is followed
    to both sides from the minimum, along the direction in which the residuals change least; on each side the least
    minimum beyond a rise of the sum is returned.

    Args:
        residuals: function of a point (s,), logarithms of positive parameters, that returns the residuals (n,).
        best: the minimum, (s,).
        step: along the valley.
    """
    slopes = _slopes(residuals, best, residuals(best), np.eye(best.size))
    if not np.isfinite(slopes).all():
        return []
    weakest = np.linalg.svd(slopes)[2][-1]
    minima = []
    for direction in (-weakest, weakest):
        sums, points = _valley(residuals, best, direction, step)
        low = [k for k in range(1, len(sums) - 1) if sums[k - 1] > sums[k] <= sums[k + 1]]
        minima += [points[k] for k in sorted(low, key=sums.__getitem__)[:1]]
    return minima


def _valley(
    residuals: Callable[[Array], Array], best: Array, direction: Array, step: float
) -> tuple[list[float], list[Array]]:
    """Return Σ |residual|, (k,), at k points (s,) along a valley of it, from a minimum on.

    Each step goes on in the direction of the last one, and then at right angles to it by a step of Gauss and Newton,
    which weighs a residual r with 1/(|r| + their mean magnitude): of large ones the magnitudes count. The valley ends
    where the sum is twice the least one, or after a length of 2.

    Args:
        residuals: function of a point (s,), logarithms of positive parameters, that returns the residuals (n,).
        best: the minimum, (s,).
        direction: of the first step, (s,), of length 1.
        step: its length, and the largest one in each direction at right angles.
    """
    magnitudes = np.abs(residuals(best))
    sums, points, mean = [float(magnitudes.sum())], [best], float(magnitudes.mean()) or 1.0
    while len(points) * step <= 2.0 and sums[-1] < 2.0 * min(sums):
        point, across = points[-1] + step * direction, np.linalg.svd(direction[None])[2][1:]
        r = residuals(point)
        slopes = _slopes(residuals, point, r, across)
        if not np.isfinite(slopes).all():
            break
        root = 1.0 / np.sqrt(np.abs(r) + mean)
        point -= np.clip(np.linalg.lstsq(root[:, None] * slopes, root * r)[0], -step, step) @ across
        direction = (point - points[-1]) / np.linalg.norm(point - points[-1])
        sums.append(float(np.abs(residuals(point)).sum()))
        points.append(point)
    return sums, points


def _slopes(
    residuals: Callable[[Array], Array], point: Array, r: Array, directions: Array, step: float = 0.02
) -> Array:
    """Return the derivatives of residuals along some directions, (n, m), by their differences over a step.

    Args:
        residuals: function of a point (s,) that returns the residuals (n,).
        point: where, (s,).
        r: the residuals there, (n,).
        directions: (m, s), maybe none.
        step: in each direction.
    """
    rises = [residuals(point + step * direction) - r for direction in directions]
    return np.array(rises).reshape(-1, r.size).T / step


def solved(problem: Problem, starts: Sequence[Array], rejects: bool = True, most_rounds: int = 12) -> Solution:
    """Return the least-squares fit from the best of several starts, under the noise that its residuals have.

    The best start has the largest likelihood after a robust fit, each under its most likely noise: residuals with a
    memory may have a smaller sum in a wrong minimum. Noise, outliers and fit then alternate; after `most_rounds`
    without convergence the latest one is returned.

    Args:
        problem: what is fitted.
        starts: unknowns u (p,) of each start, one at least.
        rejects: whether outliers are excluded.
        most_rounds: largest number of rounds.
    """
    (white,) = noises([(0.0, 1.0)], problem.runs)
    fits = []
    for start in starts:
        spread = float(np.median(np.abs(problem.residuals(start)))) or 1.0
        fits.append(problem.least(start, white, spread, robust=True)[0])
    u = fits[0] if len(fits) == 1 else min(fits, key=lambda u: _unlikelihood(problem, u))
    outliers: list[int] = []
    for _ in range(most_rounds):
        best = _estimate(problem, u, looks=1).best
        fresh = _outliers(problem, u, best) if rejects else problem.kept[:0]
        if not fresh.size:
            before, (u, _) = u, problem.least(u, best.noise, best.deviation)
            if (np.abs(u - before) < 0.02 * np.sqrt(np.diag(best.covariance))).all():
                break
        outliers += fresh.tolist()
        problem = problem.without(fresh)
    average = _estimate(problem, u)
    u, squares = problem.least(u, average.best.noise, average.best.deviation)
    return Solution(problem, u, average.best, average, squares, np.array(sorted(outliers), dtype=np.intp))


def _estimate(problem: Problem, u: Array, looks: int = 2) -> AveragedEstimate:
    """Return the estimates of the parameters from those at u on, under all noises of a grid, with their weights.

    `u`: logarithm of the ratio of each positive unknown to its scale, the ratio of any other, (p,). `looks`: number of
    grids, each finer around the likely noises; those of the last one are returned.
    """
    resting = problem.resting(problem.values(u), problem.runs)
    return averaged(problem.runs, problem.residuals(u), problem.slopes(u), problem.prior(u), looks, resting)


def _unlikelihood(problem: Problem, u: Array) -> float:
    """Return the negative logarithm of the likelihood of u under its likeliest noise, but for a constant.

    It is n log σ + ½ log |V| + ½ Σ m² of n residuals with the covariance σ²V and misfits m of calibrations and bounds.

    `u`: logarithm of the ratio of each positive unknown to its scale, the ratio of any other, (p,).
    """
    best = _estimate(problem, u, looks=1).best
    known = float(np.sum(problem.prior(u)[:, -1] ** 2))
    return problem.kept.size * math.log(best.deviation) + 0.5 * (best.noise.log_determinant + known)


def _outliers(problem: Problem, u: Array, estimate: Estimate) -> Indices:
    """Return the indices in the curve of compared points whose whitened residual exceeds five standard deviations.

    Of those within two compared points of each other only the largest. Empty without any. `u`: logarithm of the ratio
    of each positive unknown to its scale, the ratio of any other, (p,).
    """
    white = np.abs(estimate.noise.whitened(problem.residuals(u))) / estimate.deviation
    kept = problem.kept
    far = np.flatnonzero(white > OUTLIER)
    return np.array([kept[i] for i in far if white[i] >= white[max(0, i - 2) : i + 3].max()], dtype=np.intp)


def interval(solution: Solution, index: int, farthest: float = 4.0) -> tuple[float, float]:
    """Return the (lower, upper) end of the 95 % interval of an unknown, in units of u, by its profile likelihood.

    u is log p of a positive parameter p over its scale, else p over its scale. All other unknowns are fitted again at
    each value. At an end the root of the rise of the sum of squares is the distance of the 2.5 % or 97.5 % quantile
    over all noises from the estimate, in standard deviations. An end is −∞ or ∞ where it does not rise so far within
    `farthest`; after 12 steps it is the latest.

    Args:
        solution: the converged fit.
        index: of the unknown.
        farthest: largest distance from the estimate, in units of u.
    """
    problem, best = solution.problem, solution.best
    spread = math.sqrt(best.covariance[index, index])
    along = best.covariance[index] / best.covariance[index, index]  # how the other unknowns follow
    ends = []
    for side, quantile in zip((-1.0, 1.0), np.abs(solution.average.ends(index, LEVEL)).tolist(), strict=True):
        wanted = quantile / spread  # standard deviations
        u, low, high = solution.u.copy(), (0.0, 0.0), None
        change = quantile
        for _ in range(12):
            start = u + (side * change - (u[index] - solution.u[index])) * along
            u, squares = problem.least(start, best.noise, best.deviation, fixed=index)
            reached = math.sqrt(max(0.0, squares - solution.squares))
            if abs(reached - wanted) < 0.01 * wanted:
                break
            if reached < wanted:
                low = change, reached
            else:
                high = change, reached
            if high is None:
                change = min(3.0 * change, max(1.05 * change, change * wanted / max(reached, 1e-3)))
                if change > farthest:
                    change = math.inf
                    break
            else:
                change = low[0] + (high[0] - low[0]) * (wanted - low[1]) / (high[1] - low[1])
        ends.append(float(solution.u[index] + side * change))
    unknown = problem.unknowns[index]
    most = unknown.limits[1] if math.isfinite(unknown.most) else math.inf
    return ends[0], min(ends[1], most)
