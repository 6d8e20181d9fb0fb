"""The parameters that fit a curve: starts over decades, least squares under the noise, and the profile likelihood.

Unknowns are u = log(p/p₀) of a positive parameter p, and lengths or forces over that of the data for the contact point
and the offset of the force. What is known of a parameter beforehand (a calibration with its ±) is a row of its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import differential_evolution, least_squares

from contact1d.workflow.fit.noise import Indices, Judged, Noise, Uncertain, noises, uncertain

Array = NDArray[np.float64]
STEP = 1e-4
"""Of the central differences, in u."""
DECADES = 3.0
"""A parameter is sought so many decades to both sides of the value that the scene gives."""
GENERATIONS, POPULATION, STARTS, SEED = 40, 16, 4, 1
"""Of the first look, which takes some thousand curves; places of it that are starts of a fit; its random numbers."""
OUTLIER = 5.0
"""Whitened residual over its standard deviation beyond which a point is no part of the noise: one in 1.7 million."""
LEVEL = 0.95
TWO_SIDED = 1.959964
"""Standard deviations of a 95 % uncertainty."""
LIMIT, EDGE = DECADES * math.log(10.0), 1e-3
"""Of u of a positive parameter in a fit, and how far inside a start must be."""
MOST_ROUNDS, SETTLED = 12, 0.02
"""Of fit, noise and outliers in turn; and change of the unknowns over their standard deviation that ends them."""
FARTHEST = 4.0
"""Change of log p at which the end of an interval counts as open."""


@dataclass(frozen=True)
class Unknown:
    """A number that the fit may change.

    Attributes:
        name: a dotted key, or what it is.
        scale: the value at u = 0 of a positive one; else of which u is the multiple.
        positive: whether it is p = scale·exp(u), else p = scale·u.
        known: mean and standard deviation of what is known of it; None: nothing.
        fitted: whether it was asked for; else it is a nuisance.
    """

    name: str
    scale: float
    positive: bool = True
    known: tuple[float, float] | None = None
    fitted: bool = False

    def value(self, u: float) -> float:
        """p."""
        return self.scale * (math.exp(min(max(u, -50.0), 50.0)) if self.positive else u)

    def slope(self, u: float) -> float:
        """∂p/∂u."""
        return self.value(u) if self.positive else self.scale


Model = Callable[[Sequence[float]], Array]
"""From the values of all unknowns to the forces at all points (n,)."""


@dataclass(frozen=True)
class Problem:
    """Data, unknowns and the model between them.

    Attributes:
        unknowns: (p,).
        model: forces at all points.
        forces: that were measured, (n,).
        runs: indices of the points that are compared, run after run.
    """

    unknowns: tuple[Unknown, ...]
    model: Model
    forces: Array
    runs: tuple[Indices, ...]

    @property
    def kept(self) -> Indices:
        """All compared points."""
        return np.concatenate(self.runs)

    def without(self, points: Indices) -> Problem:
        """The same without some points."""
        return replace(self, runs=tuple(run[~np.isin(run, points)] for run in self.runs))

    def values(self, u: Array) -> list[float]:
        """The values of the unknowns."""
        return [one.value(float(part)) for one, part in zip(self.unknowns, u, strict=True)]

    def residuals(self, u: Array) -> Array:
        """Measured less predicted force of the compared points."""
        return (self.forces - self.model(self.values(u)))[self.kept]

    def slopes(self, u: Array, free: Sequence[int] | None = None) -> Array:
        """∂(predicted force)/∂u of the compared points, (n, p)."""
        return self.derivative(self.model, u, free)[self.kept]

    def derivative(self, of: Model, u: Array, free: Sequence[int] | None = None) -> Array:
        """∂/∂u of what follows from the values of the unknowns, (n, p), by central differences."""
        steps = STEP * np.eye(u.size)
        columns = [
            (of(self.values(u + steps[i])) - of(self.values(u - steps[i]))) / (2.0 * STEP)
            for i in (range(u.size) if free is None else free)
        ]
        return np.column_stack(columns)

    def prior(self, u: Array) -> Array:
        """Rows of what is known, (q, p + 1), the last column the misfit."""
        rows = []
        for i, one in enumerate(self.unknowns):
            if one.known is not None:
                mean, spread = one.known
                row = np.zeros(u.size + 1)
                row[i], row[-1] = one.slope(float(u[i])) / spread, (mean - one.value(float(u[i]))) / spread
                rows.append(row)
        return np.array(rows).reshape(-1, u.size + 1)

    def least(
        self, u: Array, noise: Noise, deviation: float, fixed: int | None = None, robust: bool = False
    ) -> tuple[Array, float]:
        """The least sum of squares from u on, and where; `fixed` is the index of an unknown that stays."""
        free = [i for i in range(u.size) if i != fixed]

        def whole(part: Array) -> Array:
            full = u.copy()
            full[free] = part
            return full

        def rows(part: Array) -> Array:
            full = whole(part)
            return np.concatenate([noise.whitened(self.residuals(full)) / deviation, self.prior(full)[:, -1]])

        def jacobian(part: Array) -> Array:
            full = whole(part)
            return -np.concatenate(
                [noise.whitened(self.slopes(full, free)) / deviation, self.prior(full)[:, :-1][:, free]]
            )

        ends = np.array([LIMIT if one.positive else math.inf for one in self.unknowns])[free]
        options: dict[str, Any] = {"xtol": 1e-6, "ftol": 1e-6, "gtol": 1e-12, "max_nfev": 60}
        options |= {"loss": "soft_l1", "f_scale": 2.0} if robust else {}
        found = least_squares(
            rows, np.clip(u[free], -ends, ends), jacobian, (-ends - EDGE, ends + EDGE), x_scale="jac", **options
        )
        return whole(found.x), 2.0 * float(found.cost)


@dataclass(frozen=True)
class Solution:
    """A fit that has settled.

    Attributes:
        problem: with the points that were compared.
        u: the unknowns.
        best: what the residuals say under the most likely noise, with which u is the least.
        noise: the same under all noises that they allow.
        squares: the least sum of squares under the most likely one, over its variance.
        outliers: indices of points that were taken out.
    """

    problem: Problem
    u: Array
    best: Judged
    noise: Uncertain
    squares: float
    outliers: Indices

    @property
    def values(self) -> list[float]:
        """Of all unknowns."""
        return self.problem.values(self.u)


def first_look(problem: Problem, sought: Sequence[int], complete: Callable[[Array], Array]) -> list[Array]:
    """Promising places over decades of the sought unknowns; `complete` sets those that follow from them.

    The valley of a good fit is some percent wide, in a plane of decades: a population of places is evolved, and the
    best of it are the starts.
    """

    def whole(place: Array) -> Array:
        u = np.zeros(len(problem.unknowns))
        u[list(sought)] = place
        return complete(u)

    if not sought:
        return [whole(np.zeros(0))]

    def misfit(place: Array) -> float:
        total = float(np.abs(problem.residuals(whole(place))).sum())
        return total if total < 1e100 else 1e100  # of NaN, too; and the square of it is a number

    reach = DECADES * math.log(10.0)
    found = differential_evolution(
        misfit, [(-reach, reach)] * len(sought), rng=SEED, maxiter=GENERATIONS, popsize=POPULATION, tol=0.02,
        init="sobol", polish=False, x0=np.zeros(len(sought)),
    )  # fmt: skip
    order = np.argsort(found.population_energies)[:STARTS]
    return [whole(found.population[i]) for i in order]


def solved(problem: Problem, starts: Sequence[Array], judges: bool = True) -> Solution:
    """The best of least-squares fits from several starts, under the noise that its residuals have.

    Args:
        problem: what is solved.
        starts: places.
        judges: whether points far outside the noise are taken out.
    """
    tries, (white,) = [], noises([(0.0, 1.0)], problem.runs)
    for start in starts:
        spread = float(np.median(np.abs(problem.residuals(start)))) or 1.0
        u, _ = problem.least(start, white, spread, robust=True)
        tries.append((float(np.abs(problem.residuals(u)).sum()), u))
    _, u = min(tries, key=lambda one: one[0])
    outliers: list[int] = []
    for _ in range(MOST_ROUNDS):
        best = _noise_at(problem, u, looks=1).best
        fresh = _outliers(problem, u, best) if judges else problem.kept[:0]
        if not fresh.size:
            before, (u, _) = u, problem.least(u, best.noise, best.deviation)
            if (np.abs(u - before) < SETTLED * np.sqrt(np.diag(best.covariance))).all():
                break
        outliers += fresh.tolist()
        problem = problem.without(fresh)
    noise = _noise_at(problem, u)
    u, squares = problem.least(u, noise.best.noise, noise.best.deviation)
    return Solution(problem, u, noise.best, noise, squares, np.array(sorted(outliers), dtype=np.intp))


def _noise_at(problem: Problem, u: Array, looks: int = 2) -> Uncertain:
    return uncertain(problem.runs, problem.residuals(u), problem.slopes(u), problem.prior(u), looks)


def _outliers(problem: Problem, u: Array, judged: Judged) -> Indices:
    """Points far outside the noise, the largest of neighbours only."""
    white = np.abs(judged.noise.whitened(problem.residuals(u))) / judged.deviation
    kept = problem.kept
    far = np.flatnonzero(white > OUTLIER)
    return np.array([kept[i] for i in far if white[i] >= white[max(0, i - 2) : i + 3].max()], dtype=np.intp)


def interval(solution: Solution, index: int) -> tuple[float, float]:
    """The two ends of an unknown's interval of 95 %, in u: its profile likelihood at the noise's own quantiles.

    Everything else is fitted again at each value. An end is infinite where the likelihood does not fall far enough.
    """
    problem, best = solution.problem, solution.best
    spread = math.sqrt(best.covariance[index, index])
    along = best.covariance[index] / best.covariance[index, index]  # how the others follow
    ends = []
    for side in (-1.0, 1.0):
        quantile = abs(solution.noise.quantile(index, 0.5 * (1.0 + side * LEVEL)))
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
                if change > FARTHEST:
                    change = math.inf
                    break
            else:
                change = low[0] + (high[0] - low[0]) * (wanted - low[1]) / (high[1] - low[1])
        ends.append(float(solution.u[index] + side * change))
    return ends[0], ends[1]
