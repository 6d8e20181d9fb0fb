"""The minimum between samples: that of a polynomial, dP/dx = 0, with its uncertainty.

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

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import divided, fitting, lowest_minimum
from contact1d.analysis.pressure import Array, spacing_of

INTERPOLANT_SIZES = (7, 5)
"""Samples under the interpolating polynomial, and under the lower one that it is compared with."""
SIDEWAYS_COST = 3.0
"""A stencil one sample off the middle has to be smoother by this factor to be preferred."""
FIT_DEGREE = 4
"""Degree of the least-squares polynomial where noise hides which sample is lowest."""
SIDE_COUNTS = (3, 5, 10)
"""Samples on each side of the lowest one under the polynomials of growing degree."""
SMOOTH_ORDERS = (2, 4, 6, 8)
"""Orders of the differences that show whether samples are smooth."""
DECAY_OF_DIFFERENCES = 0.6
"""Differences of one even order over those of the order before, each over that of a sawtooth of height 1, up to which
samples count as smooth: across a jump, and of noise, the ratio is near 1."""
LEAST_CONVERGENCE = 0.2
"""Least part of a position's change from one polynomial to the next that is believed to be left at the one after."""
CLAIM_FACTOR = 2.0
"""Uncertainty of a position over that. The cases without snaps are covered in 99 %, with noise or without."""
STEEPNESS_FACTOR = 2.0
"""Least uncertainty of an interpolated position over the spacing and the steepness of the dip: what the lowest sample's
higher neighbour has risen, over the depth below the lower shoulder. A dip of one sample may lie anywhere up to the
samples beside it, and polynomials through it agree by chance. Of skewed dips it covers 95 %, with 1 it would be 89 % of
those nearly a spacing wide, with 0 61 %."""
CANDIDATE_SIGMAS = 5.0
"""Samples within this many standard deviations of the lowest one may be the lowest one."""
BRIDGED_SAMPLES = 5
"""Up to this many samples that noise do not determine it apart are bridged by interpolation."""
NOISE_REACH = 20
"""Samples on each side from which the noise is estimated."""
NOISE_ORDER = 12
"""Highest difference of samples that is examined for noise: of a smooth function it is the least."""
MEDIAN_TO_SIGMA = 0.6745
"""Median of |n| over the standard deviation of a normal n."""


@dataclass(frozen=True)
class Place:
    """A position with its estimated uncertainty; at_end: at the first or last sample, the true one may be beyond."""

    position: float
    uncertainty: float
    at_end: bool = False


def place_of_minimum(x: Array, y: Array, candidates: NDArray[np.intp]) -> Place:
    """Return where y(x) is least near the lowest of the candidate samples.

    x: positions, ascending, (n,), n >= 3; y: values, (n,); candidates: indices, ascending, in which to look.
    The uncertainty covers the error in at least 95 % of random closed-form cases (see the module), without noise and
    with white noise of up to 1 % of the depth, and of skewed dips from 0.3 spacings wide on;
    where y jumps, the minimum is anywhere between two samples.
    """
    last = len(x) - 1
    index = int(candidates[np.argmin(y[candidates])])
    if index in (0, last):
        return Place(float(x[index]), spacing_of(x), True)
    noise = _noise(y, index)
    likely = candidates[y[candidates] <= y[index] + CANDIDATE_SIGMAS * noise]
    first, final = int(likely[0]), int(likely[-1])
    extent = float(x[final] - x[first])
    if final - first < BRIDGED_SAMPLES - 1:
        place = _converging(x, y, index, noise) or _interpolated(x, y, index, noise)
    else:
        place = _fitted(x, y, first, final, noise)
    open_towards_others = (first == candidates[0] and first > 0) or (final == candidates[-1] and final < last)
    inside = 0.25 * extent if final - first > 1 else 0.0  # two neighbours that tie are what interpolation is for
    spread = extent if open_towards_others else inside
    return Place(place.position, max(place.uncertainty, spread), first == 0 or final == last)


def _noise(y: Array, index: int) -> float:
    """Standard deviation of the noise about sample `index`, from differences of the order that sees least signal.

    The d-th difference of white noise has the variance (2d over d) sigma^2; that of a smooth function falls with d.
    """
    difference = y[max(0, index - NOISE_REACH) : index + NOISE_REACH + 1]
    least = math.inf
    for d in range(1, min(NOISE_ORDER + 1, len(difference))):
        difference = difference[1:] - difference[:-1]
        if d > 1:
            least = min(least, _median(np.abs(difference)) / (MEDIAN_TO_SIGMA * math.sqrt(math.comb(2 * d, d))))
    return least if least < math.inf else 0.0


def _median(values: Array) -> float:
    """The middle of a few finite values: `numpy.median` takes five times as long for what it makes sure of first."""
    ordered = np.sort(values)
    return 0.5 * float(ordered[(len(ordered) - 1) // 2] + ordered[len(ordered) // 2])


def _smoothest(x: Array, y: Array, index: int, size: int) -> list[slice]:
    """Slices of `size` samples around `index`, smoothest first: their highest divided difference is least.

    Where y jumps, a polynomial across the jump oscillates (the choice of essentially non-oscillatory schemes).
    """
    lows = range(max(0, index - size + 1), min(index, len(x) - size) + 1)
    near = slice(lows[0], lows[-1] + size)
    *_, difference = islice(divided(x[near], y[near]), size - 1)
    costs = [
        abs(slope) * SIDEWAYS_COST ** abs(low + size // 2 - index)
        for low, slope in zip(lows, difference.tolist(), strict=True)
    ]
    return [slice(lows[i], lows[i] + size) for i in np.argsort(costs, kind="stable")]


def _converging(x: Array, y: Array, index: int, noise: float) -> Place | None:
    """Minimum of the polynomial through as many samples on each side of `index` as make it more certain.

    On even samples of a smooth function it converges with the degree; those of lower degree say how fast. None where
    the samples are not smooth, or too few.
    """
    room = min(index, len(x) - 1 - index)
    if room < SIDE_COUNTS[1] or not _is_smooth(x, y, index, noise):
        return None
    low, high = float(x[index - 1]), float(x[index + 1])
    best: Place | None = None
    before: float | None = None
    change = 0.0
    for beside in (b for b in SIDE_COUNTS if b <= room):
        position, shift = _minimum(x, y, slice(index - beside, index + beside + 1), low, high, near=before)
        if math.isnan(position):
            break
        if before is not None:
            change = max(abs(position - before), LEAST_CONVERGENCE * change)
            place = Place(position, CLAIM_FACTOR * change + 2.0 * noise * shift)
            if best is not None and place.uncertainty >= best.uncertainty:
                break
            best = place
        before = position
    return best


def _is_smooth(x: Array, y: Array, index: int, noise: float) -> bool:
    """Whether, up to noise, the differences about a sample are DECAY_OF_DIFFERENCES with every even order."""
    near = slice(max(0, index - SIDE_COUNTS[-1]), index + SIDE_COUNTS[-1] + 1)
    spacing, before = spacing_of(x[near]), math.inf
    for order, difference in zip(range(1, SMOOTH_ORDERS[-1] + 1), divided(x[near], y[near]), strict=False):
        if order in SMOOTH_ORDERS:
            undivided = math.factorial(order) * spacing**order * float(np.abs(difference).max())
            rough = undivided / math.comb(order, order // 2)
            if rough > max(DECAY_OF_DIFFERENCES * before, 2.0 * noise):
                return False
            before = rough
    return True


def _interpolated(x: Array, y: Array, index: int, noise: float) -> Place:
    """Minimum of the polynomial through the samples about `index`, compared with three through other samples."""
    low, high = float(x[index - 1]), float(x[index + 1])
    trials = [_smoothest(x, y, index, min(size, len(x)))[:2] for size in INTERPOLANT_SIZES]
    best, *others = (_minimum(x, y, under, low, high) for under in (trials[0][0], trials[1][0], *trials[0][1:]))
    position, shift = best
    if math.isnan(position):  # y jumps: halfway across the larger of the two steps beside the lowest sample
        side = index + (1 if abs(y[index + 1] - y[index]) > abs(y[index - 1] - y[index]) else -1)
        return Place(0.5 * float(x[index] + x[side]), 0.5 * (high - low))
    differences = [high - low if math.isnan(other) else abs(position - other) for other, _ in others]
    unresolved = 0.5 * STEEPNESS_FACTOR * _steepness(y, index) * (high - low)
    unresolved = min(unresolved, max(high - position, position - low))
    return Place(position, max(max(differences) + 2.0 * noise * shift, unresolved))


def _steepness(y: Array, index: int) -> float:
    """Rise from the lowest sample to the higher one beside it over the depth below the lower shoulder, at most 1."""
    depth = min(float(y[:index].max()), float(y[index:].max())) - float(y[index])
    rise = max(float(y[index - 1]), float(y[index + 1])) - float(y[index])
    return min(1.0, rise / depth) if depth > 0.0 else 1.0


def _fitted(x: Array, y: Array, first: int, last: int, noise: float) -> Place:
    """Minimum of a least-squares quartic over samples first … last, any of which noise may have made the lowest.

    Of three windows (wider to the right, to both sides, to the left) the one that fits best.
    """
    margin = max(2, (last - first + 1) // 2)
    windows = []
    for before in (0, margin, 2 * margin):
        low = max(0, first - before)
        windows.append(slice(low, min(len(x), last + 1 + 2 * margin - before)))
    misfits = [_misfit(x, y, window) for window in windows]
    best = int(np.argmin(misfits))
    window, low_x, high_x = windows[best], float(x[first]), float(x[last])
    position, shift = _minimum(x, y, window, low_x, high_x, FIT_DEGREE)
    other, _ = _minimum(x, y, window, low_x, high_x, FIT_DEGREE - 1)
    extent = high_x - low_x
    if math.isnan(position):
        return Place(0.5 * (low_x + high_x), 0.5 * extent)
    difference = 0.5 * extent if math.isnan(other) else abs(position - other)
    jump = extent if misfits[best] > 2.0 * noise else 0.0
    return Place(position, max(difference + 2.0 * noise * shift, jump))


def _misfit(x: Array, y: Array, window: slice) -> float:
    """Root mean square of what the polynomial leaves, per degree of freedom."""
    points, values = x[window], y[window]
    t = (points - points[0]) / float(np.ptp(points))
    coefficients = fitting(t, FIT_DEGREE) @ values
    residual = values - np.vander(t, len(coefficients), increasing=True) @ coefficients
    return math.sqrt(float(np.sum(residual**2)) / max(1, len(t) - FIT_DEGREE - 1))


def _minimum(
    x: Array, y: Array, under: slice, low: float, high: float, degree: int | None = None, near: float | None = None
) -> tuple[float, float]:
    """Position of the lowest minimum between low and high of the polynomial over samples, its shift per noise in y.

    It goes through all of them unless its `degree` is less. Without a minimum there (NaN, NaN); where one is
    expected `near` a position, it is found from there.
    """
    points, values = x[under], y[under]
    origin, width, depth = float(points.sum()) / len(points), float(np.ptp(points)), float(np.abs(values).max())
    if depth == 0.0:
        return math.nan, math.nan
    matrix = fitting((points - origin) / width, degree or len(points) - 1)
    start = None if near is None else (near - origin) / width
    t, bend = lowest_minimum(matrix @ (values / depth), (low - origin) / width, (high - origin) / width, start)
    powers = np.arange(1, len(matrix))
    slope = float(np.linalg.norm((powers * t ** (powers - 1)) @ matrix[1:]))
    return origin + t * width, slope * width / (bend * depth)
