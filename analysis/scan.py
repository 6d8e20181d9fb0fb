"""A scan of a body of revolution: its points in one direction, and what the profile fitted to them gives.

Lengths have any one unit.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from contact1d.analysis.form import Array

ASPERITY = 2.0
"""Standard deviations of the noise above the lowest point up to which patches are counted."""


class ScanError(ValueError):
    """An error for points that are no profile; the message says why, and what to do."""


@dataclass(frozen=True)
class Taken:
    """The fitted profile of a scan; lengths in the unit of the scan.

    Attributes:
        shape: "smooth", or the name of the fitted shape.
        parameters: θ, (k,): 1/R; h and n of h (r/w)ⁿ, w the width of the scan; or the slopes at the knots but 0.
        knots: of a smooth curve, (k + 1,), from 0; of a named shape empty.
        counts: smallest and largest number of knots of the curves whose mean a smooth curve is; twice the number of
            given knots; 0 of a named shape.
        deviations: pairs of θ, (m, 2, k): half of the difference of a result between the two of a pair is its
            uncertainty at 95 %, independent of the other pairs.
        centre, tilt, offset: position of the apex, slope and height there; each with its uncertainty at 95 %, 0 where
            it was given.
        reach: largest distance of a point from the apex.
        noise, correlation: standard deviation of the residual, and its correlation length, Σ ρ_k of the points' pitch.
        x: positions of the points from the apex, rising, (n,).
        heights, residual: without tilt and offset, and without the curve, too, (n,).
        autocorrelation: ρ_k of the residual, k from 0 to a quarter of n, (n // 4,); 0 without any residual.
        patches: number of parts in which the measured points would touch a plane 2 σ above the lowest one.
        missed: RMS residual of a named shape beyond the noise; 0 of a smooth curve.
    """

    shape: str
    parameters: Array
    knots: Array
    counts: tuple[int, int]
    deviations: Array
    centre: tuple[float, float]
    tilt: tuple[float, float]
    offset: tuple[float, float]
    reach: float
    noise: float
    correlation: float
    x: Array
    heights: Array
    residual: Array
    autocorrelation: Array
    patches: int
    missed: float

    @property
    def pitch(self) -> float:
        """The median distance of neighbouring points, in the unit of the scan."""
        return pitch_of(self.x)

    @property
    def both_sides(self) -> bool:
        """Whether the scan has points on both sides of the apex, more than 5 % of its width on each."""
        return is_two_sided(self.x)

    def folded(self) -> tuple[Array, Array]:
        """Return radii and heights of the points without tilt, (m,) each, in the unit of the scan, with z(0) = 0.

        The radii are evenly spaced from 0 by about the median distance of points. With points on both sides of the apex
        they end at the nearer end and heights are averaged; else they end at the farthest point. Heights between points
        are interpolated.
        """
        from scipy.interpolate import Akima1DInterpolator  # which takes longer to import than a small run

        # It meets a parabola exactly, also across the axis, and does not overshoot beside a corner.
        curve = Akima1DInterpolator(*_rising(self.x, self.heights), extrapolate=True)
        right = float(np.sign(self.x[-1] + self.x[0])) or 1.0
        end = float(min(self.x[-1], -self.x[0]) if self.both_sides else np.abs(self.x).max())
        r = np.linspace(0.0, end, 1 + round(end / self.pitch))
        z = np.mean([curve(side * r) for side in (right, -right)[: 1 + self.both_sides]], axis=0)
        return r, z - z[0]


def pitch_of(x: Array) -> float:
    """Return the median distance of neighbouring positions, (n,), rising, in their unit."""
    return float(np.median(np.diff(x)))


def is_two_sided(x: Array) -> bool:
    """Return whether rising positions, (n,), have more than 5 % of their width on each side of 0.

    False for one position.
    """
    return float(min(-x[0], x[-1])) > 0.05 * float(x[-1] - x[0])


def _rising(x: Array, z: Array) -> tuple[Array, Array]:
    """Return positions and heights sorted by position, each position once.

    Of several at the same position the mean height.
    """
    positions, index, counts = np.unique(x, return_inverse=True, return_counts=True)
    return positions, np.bincount(index, z) / counts


def one_pass(x: Array, z: Array) -> tuple[Array, Array]:
    """Return positions, rising, and heights of a scan, (n,) each; of a scan forth and back the mean of its passes.

    A pass with half of the points of the longest or fewer is left out. The means are at the positions of the first pass
    that is left, where all passes have points, between points linear. Of several points of a pass at one position it is
    their mean.
    """
    steps = np.flatnonzero(np.diff(x))
    turns = steps[np.flatnonzero(np.diff(np.sign(np.diff(x)[steps])))] + 1
    ends = [0, *turns.tolist(), len(x) - 1]
    passes = [_rising(x[first : last + 1], z[first : last + 1]) for first, last in pairwise(ends)]
    longest = max(len(along) for along, _ in passes)
    passes = [(along, heights) for along, heights in passes if len(along) > 0.5 * longest]
    low, high = max(along[0] for along, _ in passes), min(along[-1] for along, _ in passes)
    positions = passes[0][0]
    positions = positions[(positions >= low) & (positions <= high)]
    return positions, np.mean([np.interp(positions, along, heights) for along, heights in passes], axis=0)


def require_rising(x: Array, z: Array) -> None:
    """Raise ScanError where heights z, (n,), decrease outwards over the positions x, (n,), both in any units.

    That is a parabola through all of them that opens downwards and halves the squared residual of a straight line, with
    most of the points in the upper half.
    """
    along = (x - x[0]) / np.ptp(x)
    (square, *_), squares = np.polyfit(along, z, 2, full=True)[:2]
    straight = np.polyfit(along, z, 1, full=True)[1]
    if square <= 0.0 and 2.0 * squares.sum() < straight.sum() and float(np.median(z)) > 0.5 * float(z.max() + z.min()):
        raise ScanError(
            "its heights decrease from the apex outwards, as those of a bump seen from above; heights are measured "
            "from the plane and grow outwards: change the sign of z"
        )
