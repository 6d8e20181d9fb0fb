"""Contact radius from a pressure profile: with tension |dp/dx| = 0 at a, where p is least; without it p(a) = 0."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from analysis.pressure import Profile

Array = NDArray[np.float64]

INTERPOLANT_SIZES = (7, 5)
"""Particles under the interpolating polynomial, and under the lower one that it is compared with."""
SIDEWAYS_COST = 3.0
"""A stencil one particle off the middle has to be smoother by this factor to be preferred."""
FIT_SIZES = (9, 13, 17, 25, 33)
"""Particles under a least-squares quartic, tried in turn where the pressure is noisy."""
NOISE_TOLERANCE = 0.1
"""A wider fit is sought while noise moves the extremum by more than this share of the spacing."""
NEGLIGIBLE = 1e-12
"""Tension below this share of the largest pressure is round-off."""


@dataclass(frozen=True)
class ContactRadius:
    """Half the distance between the edges of a contact [LU].

    value = (right - left) / 2; uncertainty: estimated, meant to cover the error in at least 95 % of cases;
    left, right: positions of the edges [LU]; reaches_end: an edge is at the chain's end, so the chain is too short.
    """

    value: float
    uncertainty: float
    left: float
    right: float
    reaches_end: bool


@dataclass(frozen=True)
class _Edge:
    position: float
    uncertainty: float
    reaches_end: bool


@dataclass(frozen=True)
class _Stencil:
    """Particles low … low + size under a polynomial of this degree."""

    low: int
    size: int
    degree: int


def _radius(left: _Edge, right: _Edge) -> ContactRadius:
    value = max(0.0, 0.5 * (right.position - left.position))
    uncertainty = 0.5 * (left.uncertainty + right.uncertainty)
    return ContactRadius(
        value, uncertainty, left.position, right.position, left.reaches_end or right.reaches_end
    )


def _smoothest(x: Array, p: Array, index: int, size: int) -> list[_Stencil]:
    """Stencils of `size` particles around `index`, smoothest first: their highest divided difference is least.

    At a particle's snap the pressure jumps; a polynomial across the jump swings (essentially non-oscillatory choice).
    """
    difference = p
    for k in range(1, size):
        difference = np.diff(difference) / (x[k:] - x[:-k])
    lows = range(max(0, index - size + 1), min(index, len(x) - size) + 1)
    costs = [abs(difference[low]) * SIDEWAYS_COST ** abs(low + size // 2 - index) for low in lows]
    return [_Stencil(lows[i], size, size - 1) for i in np.argsort(costs, kind="stable")]


def _minimum(x: Array, p: Array, stencil: _Stencil, low: float, high: float) -> tuple[float, float]:
    """Position of the polynomial's lowest minimum between low and high, and its shift per unit of noise in p.

    Without a minimum there, (NaN, NaN): the pressure jumps.
    """
    window = slice(stencil.low, stencil.low + stencil.size)
    origin, width = float(np.mean(x[window])), float(np.ptp(x[window]))
    depth = float(np.max(np.abs(p[window])))
    vandermonde = polynomial.polyvander((x[window] - origin) / width, stencil.degree)
    inverse = np.linalg.pinv(vandermonde)
    coefficients = inverse @ p[window] / depth
    curvature = polynomial.polyder(coefficients, 2)
    roots = polynomial.polyroots(polynomial.polyder(coefficients))
    real = np.real(roots[np.abs(np.imag(roots)) < 1e-9])
    real = real[(real >= (low - origin) / width) & (real <= (high - origin) / width)]
    real = real[polynomial.polyval(real, curvature) > 0.0]
    if real.size == 0:
        return math.nan, math.nan
    root = float(real[np.argmin(polynomial.polyval(real, coefficients))])
    powers = np.arange(1, stencil.degree + 1)
    slope_of_noise = np.linalg.norm((powers * root ** (powers - 1)) @ inverse[1:])
    return origin + root * width, float(slope_of_noise / (polynomial.polyval(root, curvature) * depth) * width)


def _noise(p: Array, index: int) -> float:
    """Standard deviation of the noise about particle `index`, from differences of the order that sees least signal.

    The d-th difference of white noise has the variance (2d over d) sigma^2; that of a smooth profile falls with d.
    """
    window = p[max(0, index - 20) : index + 21]
    orders = range(2, min(9, len(window)))
    medians = (np.median(np.abs(np.diff(window, d))) / (0.6745 * math.sqrt(math.comb(2 * d, d))) for d in orders)
    return float(min(medians, default=0.0))


def _interpolated(x: Array, p: Array, index: int, noise: float) -> _Edge:
    """Minimum of the polynomial through the particles about `index`; error: how far polynomials disagree."""
    low, high = float(x[index - 1]), float(x[index + 1])
    trials = [_smoothest(x, p, index, min(size, len(x)))[:2] for size in INTERPOLANT_SIZES]
    found = [_minimum(x, p, s, low, high) for s in (trials[0][0], trials[1][0], *trials[0][1:])]
    position, shift = found[0]
    if math.isnan(position):
        side = index + (1 if abs(p[index + 1] - p[index]) > abs(p[index - 1] - p[index]) else -1)
        return _Edge(0.5 * float(x[index] + x[side]), 0.5 * (high - low), False)
    others = [other for other, _ in found[1:] if not math.isnan(other)]
    return _Edge(position, max((abs(position - other) for other in others), default=high - low) + 2.0 * noise * shift, False)


def _fitted(x: Array, p: Array, first: int, last: int, noise: float) -> _Edge:
    """Minimum of the least-squares quartic over the particles first … last, any of which noise may have made lowest."""
    spare = max(2, (last - first + 1) // 2)
    best: tuple[float, _Edge] | None = None
    for before in (0, spare, 2 * spare):
        low = max(0, first - before)
        size = min(len(x), last + 1 + 2 * spare - before) - low
        window = slice(low, low + size)
        t = (x[window] - x[low]) / (x[window][-1] - x[low])
        residual = p[window] - polynomial.polyval(t, polynomial.polyfit(t, p[window], 4))
        rms = math.sqrt(float(np.sum(residual**2)) / max(1, size - 5))
        (position, shift), (other, _) = (
            _minimum(x, p, _Stencil(low, size, degree), float(x[first]), float(x[last])) for degree in (4, 3)
        )
        extent = 0.5 * float(x[last] - x[first])
        if math.isnan(position):
            edge = _Edge(0.5 * float(x[first] + x[last]), extent, False)
        else:
            edge = _Edge(position, (extent if math.isnan(other) else abs(position - other)) + 2.0 * noise * shift, False)
        edge=_Edge(edge.position, max(edge.uncertainty, (1.0 if rms > 2.0 * noise else 0.5) * extent), False)
        if best is None or rms < best[0]:
            best = rms, edge
    assert best is not None
    return best[1]


def _tensile_edge(x: Array, p: Array, candidates) -> _Edge:
    """The minimum of the pressure about the most tensile particle `index` of one side."""
    last = len(x) - 1
    index=int(candidates[np.argmin(p[candidates])])
    spacing = float(x[last] - x[0]) / last
    if index in (0, last):
        return _Edge(float(x[index]), spacing, True)
    noise = _noise(p, index)
    low = candidates[p[candidates] <= p[index] + LIKELY * noise]
    if low[-1] - low[0] < 4:
        return _interpolated(x, p, index, noise)
    edge = _fitted(x, p, int(low[0]), int(low[-1]), noise)
    if min(abs(low[0]-candidates[-1]),abs(low[-1]-candidates[0]))<=2: edge=_Edge(edge.position,max(edge.uncertainty,abs(x[low[-1]]-x[low[0]])),False)
    return edge

LIKELY = 5.0

def tensile_radius(profile: Profile) -> ContactRadius:
    x, p = profile.x, profile.pressure
    weight = np.abs(p)
    centre = float(np.sum(weight * x) / np.sum(weight))
    half = 0.5 * float(x[-1] - x[0]) / (len(x) - 1)
    left = np.flatnonzero(x <= centre + half)
    right = np.flatnonzero(x >= centre - half)
    return _radius(_tensile_edge(x, p, left), _tensile_edge(x, p, right))
