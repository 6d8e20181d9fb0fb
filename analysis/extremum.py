"""The minimum between samples, that of a polynomial, dP/dx = 0, with its uncertainty.

Measured on the closed form of independent pairs, p(x) = f(r), x^2 / 2R + G_0 = r - 2 f(r) / k, f two exponentials, with
R = 1000, ranges 0.2 … 2, radii to 80 and random lattice offsets (542 cases without, 578 with particles that snap; error
in spacings, rms / median):
    parabola, 3 particles                0.084 / 4e-2    with snaps 0.42 / 0.20
    polynomial, 5 particles              0.063 / 2e-3               0.48 / 0.30
    cubic spline                         0.109 / 7e-4               0.51 / 0.37
    modified Akima                       0.078 / 6e-2               0.21 / 0.09
    monotone cubic                       0.29  / 2e-1               0.32 / 0.24
    smoothest 7 of 13 particles          0.033 / 3e-4               0.14 / 0.04
Of 1500 other such cases each, with the polynomial of growing degree about the lowest particle where that converges:
    smoothest 7 of 13 particles          0.057 / 1e-4               0.137 / 0.044
    11 or 21 particles, else those 7     0.057 / 1e-5  (here)       0.137 / 0.044
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import islice
from statistics import median

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import divided, fitting, lowest_minimum
from contact1d.analysis.pressure import Array, spacing_of

SIDE_COUNTS = (3, 5, 10)
"""Samples on each side of the lowest one under the polynomials of growing degree."""


@dataclass(frozen=True)
class EstimatedPosition:
    """A position with its estimated uncertainty, both in the unit of the positions that it is made of.

    Attributes:
        position: the estimate.
        uncertainty: it covers the error in at least 95 % of random cases; ≥ 0.
    """

    position: float
    uncertainty: float


def position_of_minimum(x: Array, y: Array, candidates: NDArray[np.intp]) -> EstimatedPosition:
    """Return the position of the minimum of y(x) near the lowest of the candidate samples, with its uncertainty.

    Where the lowest (of equal ones the first) is the first or the last sample of x it is that sample, uncertain by a
    spacing. The uncertainty covers the error in at least 95 % of random closed-form cases (see the module), without
    noise and with white noise of up to 1 % of the depth, and of skewed dips at least 0.3 spacings wide; where y jumps,
    the minimum is anywhere between two samples.

    Args:
        x: positions, ascending, (n,), n >= 3.
        y: values, (n,).
        candidates: indices of samples, ascending, one at least.
    """
    last = len(x) - 1
    index = int(candidates[np.argmin(y[candidates])])
    if index in (0, last):
        return EstimatedPosition(float(x[index]), spacing_of(x))
    noise = _noise(y, index)
    likely = candidates[y[candidates] <= y[index] + 5.0 * noise]  # each of these may be the lowest one, but for noise
    first, final = int(likely[0]), int(likely[-1])
    extent = float(x[final] - x[first])
    if final - first < 4:  # interpolation bridges up to five samples
        minimum = _converging(x, y, index, noise) or _interpolated(x, y, index, noise)
    else:
        minimum = _fitted(x, y, first, final, noise)
    open_towards_others = (first == candidates[0] and first > 0) or (final == candidates[-1] and final < last)
    inside = 0.25 * extent if final - first > 1 else 0.0  # interpolation resolves two neighbours that tie
    spread = extent if open_towards_others else inside
    return EstimatedPosition(minimum.position, max(minimum.uncertainty, spread))


def _noise(y: Array, index: int, reach: int = 20, highest_order: int = 12) -> float:
    """Return the standard deviation of the noise, in the unit of y, in up to `reach` samples on each side of `index`.

    The d-th difference of white noise has the variance (2d over d) sigma^2; that of a smooth function falls with d. The
    smallest estimate, of the orders from 2 up to the highest, has least of the signal. With fewer than three samples it
    is 0.
    """
    difference, median_to_sigma = y[max(0, index - reach) : index + reach + 1], 0.6745  # of |n|, n normal
    least = math.inf
    for d in range(1, min(highest_order + 1, len(difference))):
        difference = difference[1:] - difference[:-1]
        if d > 1:
            least = min(least, median(np.abs(difference).tolist()) / (median_to_sigma * math.sqrt(math.comb(2 * d, d))))
    return least if least < math.inf else 0.0


def _smoothest(x: Array, y: Array, index: int, size: int) -> list[slice]:
    """Return the slices of `size` samples that contain `index`, smoothest first, by their highest divided difference.

    `size` is at most n. Where y jumps, a polynomial across the jump oscillates (the choice of essentially
    non-oscillatory schemes). A slice one sample off the middle has to be smoother by a factor of three to be preferred,
    of two samples by nine, and so on.
    """
    lows = range(max(0, index - size + 1), min(index, len(x) - size) + 1)
    near = slice(lows[0], lows[-1] + size)
    *_, difference = islice(divided(x[near], y[near]), size - 1)
    costs = [
        abs(slope) * 3.0 ** abs(low + size // 2 - index) for low, slope in zip(lows, difference.tolist(), strict=True)
    ]
    return [slice(lows[i], lows[i] + size) for i in np.argsort(costs, kind="stable")]


def _converging(x: Array, y: Array, index: int, noise: float) -> EstimatedPosition | None:
    """Return the minimum of the polynomial through as many samples on each side of `index` as reduce its uncertainty.

    They are 3, 5 or 10. On even samples of a smooth function it converges with the degree; those of lower degree show
    how fast. None where the samples are not smooth, fewer than 5 on a side, or where the polynomial through 3 or that
    through 5 on each side has no minimum between the neighbours of `index`.

    Args:
        x, y: positions, ascending, and values, (n,).
        index: of the lowest sample.
        noise: standard deviation of the noise in y.
    """
    room = min(index, len(x) - 1 - index)
    if room < SIDE_COUNTS[1] or not _is_smooth(x, y, index, noise):
        return None
    low, high = float(x[index - 1]), float(x[index + 1])
    best: EstimatedPosition | None = None
    before: float | None = None
    change = 0.0
    for count in (count for count in SIDE_COUNTS if count <= room):
        position, shift = _minimum(x, y, slice(index - count, index + count + 1), low, high)
        if math.isnan(position):
            break
        if before is not None:
            change = max(abs(position - before), 0.2 * change)  # no faster convergence than that is assumed
            # Twice the change covers 99 % of the cases without snaps, with noise or without.
            minimum = EstimatedPosition(position, 2.0 * change + 2.0 * noise * shift)
            if best is not None and minimum.uncertainty >= best.uncertainty:
                break
            best = minimum
        before = position
    return best


def _is_smooth(x: Array, y: Array, index: int, noise: float, decay: float = 0.6, highest_order: int = 8) -> bool:
    """Return whether the differences of samples about `index` fall to `decay`, up to noise, with every even order.

    Each is taken over that of a sawtooth of height 1: across a jump, and of noise, the ratio of two orders is near 1.

    Args:
        x, y: positions, ascending, and values, (n,); up to 10 on each side count.
        index: of the lowest sample.
        noise: standard deviation of the noise in y.
        decay: largest ratio of two even orders in turn.
        highest_order: of the differences.
    """
    near = slice(max(0, index - SIDE_COUNTS[-1]), index + SIDE_COUNTS[-1] + 1)
    spacing, before = spacing_of(x[near]), math.inf
    for order, difference in zip(range(1, highest_order + 1), divided(x[near], y[near]), strict=False):
        if order % 2 == 0:
            undivided = math.factorial(order) * spacing**order * float(np.abs(difference).max())
            rough = undivided / math.comb(order, order // 2)
            if rough > max(decay * before, 2.0 * noise):
                return False
            before = rough
    return True


def _interpolated(x: Array, y: Array, index: int, noise: float) -> EstimatedPosition:
    """Return the minimum of the polynomial through seven samples about `index`, compared with two others.

    These go through five samples, and through the seven that are next in smoothness; the larger difference from them,
    with the noise, is the uncertainty, and more where the dip is hardly wider than a sample. Where y jumps, so that the
    first has no minimum, it is halfway across the larger of both steps next to the lowest sample, within half the
    distance of its neighbours.

    Args:
        x, y: positions, ascending, and values, (n,).
        index: of the lowest sample, neither the first nor the last.
        noise: standard deviation of the noise in y.
    """
    low, high = float(x[index - 1]), float(x[index + 1])
    seven, five = (_smoothest(x, y, index, min(size, len(x)))[:2] for size in (7, 5))
    best, *compared = (_minimum(x, y, under, low, high) for under in (seven[0], five[0], *seven[1:]))
    position, shift = best
    if math.isnan(position):  # y jumps: halfway across the larger of the two steps next to the lowest sample
        side = index + (1 if abs(y[index + 1] - y[index]) > abs(y[index - 1] - y[index]) else -1)
        return EstimatedPosition(0.5 * float(x[index] + x[side]), 0.5 * (high - low))
    differences = [high - low if math.isnan(minimum) else abs(position - minimum) for minimum, _ in compared]
    # A dip of one sample may lie anywhere up to its neighbours, and polynomials through it agree by chance. Of skewed
    # dips twice the steepness covers 95 %; once would be 89 % of those nearly a spacing wide, without it 61 %.
    unresolved = _steepness(y, index) * (high - low)
    unresolved = min(unresolved, max(high - position, position - low))
    return EstimatedPosition(position, max(max(differences) + 2.0 * noise * shift, unresolved))


def _steepness(y: Array, index: int) -> float:
    """Return the rise from the lowest sample to its higher neighbour over the depth below the lower shoulder, ≤ 1.

    A shoulder is the largest value on one side of `index`, which is neither the first nor the last; without a depth the
    steepness is 1. It is dimensionless.
    """
    depth = min(float(y[:index].max()), float(y[index:].max())) - float(y[index])
    rise = max(float(y[index - 1]), float(y[index + 1])) - float(y[index])
    return min(1.0, rise / depth) if depth > 0.0 else 1.0


def _fitted(x: Array, y: Array, first: int, last: int, noise: float, degree: int = 4) -> EstimatedPosition:
    """Return the minimum of a least-squares quartic over samples first … last, any of which may be the lowest.

    Of three windows (wider to the right, to both sides, to the left) it is the one that fits best. Without a minimum it
    is halfway between the two samples, within half their distance.

    Args:
        x, y: positions, ascending, and values, (n,).
        first, last: indices of the first and the last sample that may be the lowest.
        noise: standard deviation of the noise in y; a misfit above twice that makes the distance of the two samples the
            uncertainty at least.
        degree: of the polynomial; one of a degree less estimates its error.
    """
    margin = max(2, (last - first + 1) // 2)
    windows = []
    for before in (0, margin, 2 * margin):
        low = max(0, first - before)
        windows.append(slice(low, min(len(x), last + 1 + 2 * margin - before)))
    misfits = [_misfit(x, y, window, degree) for window in windows]
    best = int(np.argmin(misfits))
    window, low_x, high_x = windows[best], float(x[first]), float(x[last])
    position, shift = _minimum(x, y, window, low_x, high_x, degree)
    lower, _ = _minimum(x, y, window, low_x, high_x, degree - 1)
    extent = high_x - low_x
    if math.isnan(position):
        return EstimatedPosition(0.5 * (low_x + high_x), 0.5 * extent)
    difference = 0.5 * extent if math.isnan(lower) else abs(position - lower)
    jump = extent if misfits[best] > 2.0 * noise else 0.0
    return EstimatedPosition(position, max(difference + 2.0 * noise * shift, jump))


def _misfit(x: Array, y: Array, window: slice, degree: int) -> float:
    """Return the residual of a least-squares polynomial of a degree over the samples in a window, in the unit of y.

    It is the root of the sum of squares per degree of freedom, of which there is 1 at least.
    """
    points, values = x[window], y[window]
    t = (points - points[0]) / float(np.ptp(points))
    coefficients = fitting(t, degree) @ values
    residual = values - np.vander(t, len(coefficients), increasing=True) @ coefficients
    return math.sqrt(float(np.sum(residual**2)) / max(1, len(t) - degree - 1))


def _minimum(
    x: Array, y: Array, under: slice, low: float, high: float, degree: int | None = None
) -> tuple[float, float]:
    """Return the position of the lowest minimum, between low and high, of the polynomial over samples, and its shift.

    The shift, ≥ 0, is the standard deviation of the position under noise of standard deviation 1 in y. Both are NaN
    without a minimum, or where all values are 0.

    Args:
        x, y: positions, ascending, and values, (n,).
        under: the samples of the polynomial.
        low, high: ends of the interval, in the unit of x.
        degree: of a least-squares polynomial; None: it goes through all samples.
    """
    points, values = x[under], y[under]
    origin, width, depth = float(points.sum()) / len(points), float(np.ptp(points)), float(np.abs(values).max())
    if depth == 0.0:
        return math.nan, math.nan
    matrix = fitting((points - origin) / width, degree or len(points) - 1)
    t, bend = lowest_minimum(matrix @ (values / depth), (low - origin) / width, (high - origin) / width)
    powers = np.arange(1, len(matrix))
    slope = float(np.linalg.norm((powers * t ** (powers - 1)) @ matrix[1:]))
    return origin + t * width, slope * width / (bend * depth)
