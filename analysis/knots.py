"""Smooth curves with other knots, drawn as often as they are likely under the noise: what a scan shows of a shape.

The slope of a curve is linear between knots, which are any of many candidate radii. Which, is drawn by Metropolis steps
with the probability ω^k exp(−χ²/2), up to a factor, k being their number, ω the odds of a knot at a candidate, and χ²
the squared residual of the best curve with them over the power of the noise (I. DiMatteo, C. R. Genovese, R. E. Kass,
Biometrika 88 (2001) 1055). Each curve is then fitted to the heights with further noise. A corner is two neighbouring
knots. So the scatter of the curves is the uncertainty due to the noise and to the choice of the knots and corners, also
of those that the noise conceals.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Curves:
    """Curves that are drawn for a scan, with any of its candidate radii as knots.

    Attributes:
        knots: radii, from 0, (m + 1,), those that curves have, fewer where they are rare.
        slopes: of n curves at the knots but 0, (n, m), dimensionless.
        nuisance: their other parameters, (n, p).
        mean: of slopes and other parameters without further noise, (m + p,), which bounds bias less.
        counts: numbers of knots of each, (n,).
        shares: share of the curves that have each knot, (m + 1,).
        convex: whether the slope of no curve falls.
        last: radii of the knots of the last curve.
    """

    knots: Array
    slopes: Array
    nuisance: Array
    mean: Array
    counts: NDArray[np.int_]
    shares: Array
    convex: bool
    last: Array

    def deviations(self, gradient: Array) -> Array:
        """Return pairs of slopes, (j, 2, m), whose halved differences are independent uncertainties at 95 %.

        They are along the principal components of the heights, but for those with less than 1e-3 of the variance: the
        means of the farthest curves on either side, which rise as these do, drawn back to 1.96 standard deviations.

        Args:
            gradient: derivatives of heights by the slopes, (i, m).
        """
        tail = round(0.058 * len(self.slopes))  # of a normal distribution with a mean of 1.96 standard deviations
        mean = self.slopes.mean(axis=0)
        modes, sizes, _ = np.linalg.svd((self.slopes - mean) @ gradient.T, full_matrices=False)
        modes = modes[:, sizes**2 > 1e-3 * np.sum(sizes**2)]
        rising, order = np.sort(modes, axis=0), np.argsort(modes, axis=0)
        far = 0.5 * (rising[-tail:].mean(axis=0) - rising[:tail].mean(axis=0))
        back = np.minimum(1.0, 1.96 * modes.std(axis=0) / far)[:, None]
        ends = [self.slopes[order[-tail:]].mean(axis=0), self.slopes[order[:tail]].mean(axis=0)]
        return np.stack([mean + back * (end - mean) for end in ends], axis=1)


@dataclass(frozen=True)
class Candidates:
    """Candidate radii of knots, and the least squares of curves with any of them.

    Attributes:
        knots: radii, from 0 to the end of the scan, (m + 1,).
        columns: derivatives of the heights by other parameters, by the change of the slope's rate at each knot, and the
            heights, after an orthogonal transformation, (q, p + m + 2).
        count: p.
        power: variance of a mean of heights, times their number.
    """

    knots: Array
    columns: Array
    count: int
    power: float

    @classmethod
    def of(cls, knots: Array, radii: Array, heights: Array, nuisance: Array, power: float) -> Candidates:
        """Return the candidates for the heights of a scan.

        Args:
            knots: candidate radii, rising from 0, (m + 1,).
            radii, heights: of the points, (n,) each.
            nuisance: derivatives of heights by other parameters, (n, p).
            power: variance of a mean of heights, times their number.
        """
        columns = [nuisance, 0.5 * np.maximum(radii[:, None] - knots, 0.0) ** 2, heights]
        _, upper = np.linalg.qr(np.column_stack(columns))
        return cls(knots, upper, nuisance.shape[1], power)

    def design(self, chosen: Mask, convex: bool) -> Array:
        """Return the derivatives, (q, k), of the heights by the slopes at chosen knots but 0; if `convex`, by their
        increments.
        """
        columns, knots = self.columns[:, self.count : -1][:, chosen], self.knots[chosen]
        design = (columns[:, :-1] - columns[:, 1:]) / (knots[1:] - knots[:-1])
        if not convex:
            design[:, :-1] -= design[:, 1:]
        return np.asarray(design)

    def likelihood(self, chosen: Mask, convex: bool, odds: float = 0.03) -> float:
        """Return the logarithm of the probability of chosen knots, and of a curve that is convex or not.

        Args:
            chosen: which radii are knots.
            convex: whether the slope rises from knot to knot.
            odds: ω. Of 0.0005, 0.003, 0.01, 0.03 and 0.2, measured on shallow lands and parabolas, smaller ones miss
                lands that the noise conceals, larger ones widen the uncertainties.
        """
        from scipy.optimize import nnls

        design = self.design(chosen, convex)[self.count :]
        residual = nnls(design, self.columns[self.count :, -1])[1]
        return float(-0.5 * residual**2 / self.power + math.log(odds) * design.shape[1] * (1 + 2 * (not convex)))

    def fitted(self, chosen: Mask, convex: bool, heights: Array) -> tuple[Array, Array]:
        """Return (slopes at all knots but 0, (m,), other parameters, (p,)) of the best curve with chosen knots.

        `heights`: after the transformation, (q,).
        """
        from scipy.optimize import nnls

        design, count = self.design(chosen, convex), self.count
        theta = nnls(design[count:], heights[count:])[0]
        slopes = np.append(0.0, np.cumsum(theta) if convex else theta)
        nuisance = np.linalg.lstsq(self.columns[:count, :count], (heights - design @ theta)[:count])[0]
        return np.interp(self.knots[1:], self.knots[chosen], slopes), nuisance

    def drawn(self, start: Mask, seed: int, draws: int, most: int = 40) -> Curves:
        """Return curves along a Metropolis chain, from half of its steps on; each call has the same random numbers.

        Args:
            start: knots to begin with.
            seed: of the random numbers.
            draws: number of curves, half of that of the steps.
            most: number of knots of a curve at most, and of those of all curves that are kept.
        """
        rng, chosen, convex, rising = np.random.default_rng(seed), start, True, True
        likelihood = self.likelihood(chosen, convex)
        curves, best, masks = list[tuple[Array, Array]](), list[tuple[Array, Array]](), list[Mask]()
        for step in range(-2 * draws, 2 * draws):
            trial, rises = _proposed(chosen, convex, rng)
            if trial.sum() <= max(most, chosen.sum()):
                level = self.likelihood(trial, rises)
                if math.log(1.0 - rng.random()) < level - likelihood:
                    chosen, convex, likelihood = trial, rises, level
            if step >= 0 and step % 2 == 0:
                heights = self.columns[:, -1]
                noise = math.sqrt(self.power) * rng.standard_normal(len(heights))
                curves.append(self.fitted(chosen, convex, heights + noise))
                best.append(self.fitted(chosen, convex, heights))
                masks.append(chosen)
                rising &= convex
        slopes, nuisance = (np.stack(parts) for parts in zip(*curves, strict=True))
        shares, counts = np.mean(masks, axis=0), np.sum(masks, axis=1)
        kept = np.diff(np.floor(most * np.cumsum(shares) / shares.sum()), prepend=-1.0) > 0.0
        mean = [np.mean(parts, axis=0) for parts in zip(*best, strict=True)]
        mean[0], slopes = mean[0][kept[1:]], slopes[:, kept[1:]]
        return Curves(
            self.knots[kept], slopes, nuisance, np.concatenate(mean), counts, shares[kept], rising, self.knots[chosen]
        )


def _proposed(chosen: Mask, convex: bool, rng: np.random.Generator) -> tuple[Mask, bool]:
    """Return chosen knots, (m + 1,), and whether the curve is convex, after a random change as likely as its opposite.

    One candidate, or two neighbours, become knots or cease to be; or a knot moves by any number of candidates, more
    often by few, and where it cannot, the convexity changes. The first and the last knot stay.
    """
    trial, last, inner = chosen.copy(), len(chosen) - 1, np.flatnonzero(chosen[1:-1]) + 1
    if rng.random() < 0.5:
        first = rng.integers(1, last)
        trial[first : min(last, first + 1 + rng.integers(2))] ^= True
        return trial, convex
    knot = rng.choice(inner) if len(inner) else 0
    place = knot + (2 * rng.integers(2) - 1) * int(last ** rng.random())
    if not knot or not 0 < place < last or chosen[place]:
        return trial, not convex
    trial[knot], trial[place] = False, True
    return trial, convex
