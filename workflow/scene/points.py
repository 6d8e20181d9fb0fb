"""Bodies that are known at points: the curve between these, its corners, and what else the points may mean."""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import lru_cache
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, PPoly

from contact1d.analysis.scan import Taken
from contact1d.workflow.scene.shapes import FEWEST_POINTS, Circle, Parabola, Power, Shape

Array = NDArray[np.float64]

STEEPEST = 3.0
"""Slope at a measured point over the rise to its neighbour up to which a cubic has no overshoot."""
CELLS = 1_000_000
"""Places times points of a measured profile that are transformed at once, to bound the memory."""
ROUGH, BESIDE = 3.0, 2
"""Ratio of the curvatures at the four points around a cell from which on they show no smooth curve, and how many cells
on either side do not, either."""
SHARP = 8.0
"""Curvature at a point, or at two beside each other, over that at both neighbours from which on the slope jumps."""


class Piecewise(Shape):
    """A body whose curve is polynomials of up to the third degree between points."""

    slow = True

    @abstractmethod
    def _curve(self) -> Any:
        """Its `scipy.interpolate.PPoly`, from the axis to its end."""

    def height(self, x: Array) -> Array:
        """z(|x|) − z(0)."""
        return np.asarray(self._curve()(np.minimum(np.abs(x), self.reach)))

    def transformed(self, x: Array) -> Array:
        """g, exactly: the slope is a parabola p₀ + p₁ r + p₂ r² between two points.

        ∫ (p₀ + p₁ r + p₂ r²)/√(x² − r²) dr = (p₀ + p₂ x²/2) arcsin(r/x) − (p₁ + p₂ r/2) √(x² − r²).
        """
        radii, p_0, p_1, p_2 = _slopes(self._curve())
        flat = np.minimum(np.abs(np.ravel(x)), self.reach)
        g = np.zeros_like(flat)
        chunk = max(1, CELLS // len(p_0))
        for start in range(0, flat.size, chunk):
            place = flat[start : start + chunk, None]
            ends = np.minimum(radii, place)
            angle = np.arcsin(ends / np.where(place > 0.0, place, 1.0))
            root = np.sqrt((place - ends) * (place + ends))
            parts = (p_0 + 0.5 * p_2 * place**2) * np.diff(angle, axis=1)
            parts -= p_1 * np.diff(root, axis=1) + 0.5 * p_2 * np.diff(ends * root, axis=1)
            g[start : start + chunk] = place[:, 0] * parts.sum(axis=1)
        return g.reshape(np.shape(x))


class Points(Piecewise):
    """A body that is known at points (r, z), from r = 0 on.

    Between them it is a monotone cubic: no overshoot, a paraboloid met exactly, and a continuous slope but at points
    where that jumps, as at the edge of a land.
    """

    sharp: ClassVar[float] = SHARP
    r: tuple[float, ...]
    z: tuple[float, ...]

    @property
    def reach(self) -> float:
        """The last radius."""
        return self.r[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the points show that."""
        x, _, corners = _points(self.r, self.z, self.sharp)
        return tuple(x[corners].tolist())

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """Where the points show no smooth curve, chords, and the corners in which neighbouring chords meet.

        A body whose slope only rises is between the two. Of heights with few digits, also the apex half a digit lower,
        and heights by as much higher and lower in pairs: that changes the slope at every other point most.
        """
        found: list[Shape] = [kind.model_construct(r=self.r, z=self.z) for kind in (Chords, Corners)]
        if digit := _digit(self.z):
            found.append(Points.model_construct(r=self.r, z=(self.z[0] - 0.5 * digit, *self.z[1:])))
            for first in (1, 2):  # at the points between, too
                z = [z + (digit * ((i + first) % 4 < 2) - 0.5 * digit) * (i > 0) for i, z in enumerate(self.z)]
                found.append(Points.model_construct(r=self.r, z=tuple(z)))
        return tuple(found)

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """The curve through every second point, or through the others."""
        r, z = self.r, self.z
        fewer = [((r[0], *r[first:-1:2], r[-1]), (z[0], *z[first:-1:2], z[-1])) for first in (1, 2)]
        return tuple(Points.model_construct(r=r, z=z) for r, z in fewer if len(r) >= FEWEST_POINTS)

    def _curve(self) -> Any:
        return _spline(self.r, self.z)


class Chords(Points):
    """A measured profile that is straight between its points, where these show no smooth curve."""

    def _curve(self) -> Any:
        return _angular(self.r, self.z, False)


class Corners(Points):
    """The same with a corner in each such cell where the chords on both sides of it meet in it.

    Kinks are also where the points do not exclude that the slope jumps.
    """

    sharp: ClassVar[float] = ROUGH

    def _curve(self) -> Any:
        return _angular(self.r, self.z, True)


MOST_DIGITS, NEARLY = 10, 1e-4
"""Digits of heights that are rounded, at most, and how near to a whole multiple one is one."""
LEAST_JUMP = 1e-6
"""Such a jump over the largest slope at least: others are round-off."""
INSIDE = 1e-3
"""Of a cell, the least distance of such a jump from its ends: there the points beside it would have shown it."""
FLANK = 3
"""Points on either side of a jump whose parabola goes on to where it meets the other one."""


def _bends(r: tuple[float, ...], z: tuple[float, ...]) -> tuple[Array, Array, Array, Array]:
    """Radii; heights above the apex; slopes of the chords; and by how much they change, over the length where they do.

    The body is even in x: the chords begin at the point on the other side of the axis, (n,), and the bends on the axis,
    (n − 1,).
    """
    x, y = np.asarray(r), np.asarray(z) - z[0]
    slope = np.diff(y, prepend=y[1]) / np.diff(x, prepend=-x[1])
    return x, y, slope, np.diff(slope) / np.append(2.0 * x[1], x[2:] - x[:-2])


@lru_cache(maxsize=8)
def _points(r: tuple[float, ...], z: tuple[float, ...], sharpness: float = SHARP) -> tuple[Array, Array, Any]:
    """Radii and heights with a point where the slope jumps between two, and the numbers of all at which it does.

    It jumps between two points whose curvatures are in sum `sharpness` times those beside them: where the parabolas of
    either side meet, or at a point where they do not meet between two.
    """
    x, y, slope, bend = _bends(r, z)
    curvature = np.where(np.abs(np.diff(slope)) > LEAST_JUMP * np.abs(slope).max(), np.abs(bend), 0.0)
    beside = np.maximum(curvature[:-3], curvature[3:])
    excess = curvature[1:-2] + curvature[2:-1] - sharpness * beside
    found, taken = dict[float, float](), set[int]()
    for i in np.argsort(-excess) + 1:
        if excess[i - 1] <= 0.0 or taken & {i, i + 1}:
            continue
        left, right, step = slice(max(0, i + 1 - FLANK), i + 1), slice(i + 1, i + 1 + FLANK), x[i + 1] - x[i]
        lines = [np.polyfit((x[own] - x[i]) / step, y[own], min(2, len(x[own]) - 1)) for own in (left, right)]
        meet = [
            one.real for one in np.roots(np.polysub(*lines)) if one.imag == 0.0 and INSIDE < one.real < 1.0 - INSIDE
        ]
        if len(meet) == 1:
            taken |= {i, i + 1}
            found[float(x[i] + step * meet[0])] = float(np.polyval(lines[0], meet[0]))
    single = curvature[1:-1] > sharpness * np.maximum(curvature[:-2], curvature[2:])
    for i in {*(np.flatnonzero(single) + 1)} - taken:
        found[float(x[i])] = float(y[i])
    every = dict(zip(x.tolist(), y.tolist(), strict=True)) | found
    places = sorted(every)
    return np.asarray(places), np.asarray([every[one] for one in places]), np.searchsorted(places, sorted(found))


def _cornered(r: tuple[float, ...], z: tuple[float, ...]) -> tuple[Array, Array]:
    """The points, and in each cell the one where the chords on both sides of it meet, if they do there."""
    x, y, slope, _ = _bends(r, z)
    before, after, start, end = slope[1:-2], slope[3:], slice(1, -2), slice(2, -1)
    with np.errstate(divide="ignore", invalid="ignore"):
        meet = (y[end] - y[start] + before * x[start] - after * x[end]) / (before - after)
    # Where a point is a corner by itself, it is not beside it.
    places, _, corners = _points(r, z)
    own = np.isin(x, places[corners])
    inside = (meet > x[start]) & (meet < x[end]) & ~own[start] & ~own[end]
    places = np.append(x, meet[inside])
    heights = np.append(y, (y[start] + before * (meet - x[start]))[inside])
    order = np.argsort(places)
    return places[order], heights[order]


def _digit(z: tuple[float, ...]) -> float:
    """The power of ten of which all heights are whole multiples; 0 where that is beyond MOST_DIGITS of the largest."""
    heights = np.asarray(z)
    first = math.ceil(math.log10(np.abs(heights).max()))
    for power in range(first, first - MOST_DIGITS, -1):
        whole = heights / 10.0**power
        if np.abs(whole - whole.round()).max() < NEARLY:
            return float(10.0**power)
    return 0.0


@lru_cache(maxsize=8)
def _angular(r: tuple[float, ...], z: tuple[float, ...], corners: bool) -> Any:
    """The curve through the points, straight in rough cells, or with a corner there."""
    own = _spline(r, z)
    x, y = _cornered(r, z) if corners else (np.asarray(r), np.asarray(z) - z[0])
    places = np.union1d(own.x, x)
    start = places[:-1]
    smooth = [own(start, k) / math.factorial(k) for k in (3, 2, 1, 0)]
    chord = (np.diff(y) / np.diff(x))[np.searchsorted(x, start, side="right") - 1]
    straight = [0.0 * start, 0.0 * start, chord, np.interp(start, x, y)]
    rough = _is_rough(r, z)[np.searchsorted(r, start, side="right") - 1]
    return PPoly(np.where(rough, straight, smooth), places, extrapolate=False)


def _is_rough(r: tuple[float, ...], z: tuple[float, ...]) -> NDArray[np.bool_]:
    """Of each cell, whether the curvatures at the points around it, or near by, differ by more than ROUGH, (n − 1,)."""
    x, _, slope, bend = _bends(r, z)
    bend = np.concatenate([bend[1:2], bend, bend[-1:], bend[-1:]])  # of the points from −1 to n
    around = np.lib.stride_tricks.sliding_window_view(bend, 4)
    low, high = around.min(axis=1), around.max(axis=1)
    least = LEAST_JUMP * np.abs(slope).max() / x[-1]
    rough = (np.abs(around).max(axis=1) > least) & ((low <= 0.0) | (high > ROUGH * low))
    return np.asarray(np.convolve(rough, np.ones(2 * BESIDE + 1), mode="same") > 0.0)


@lru_cache(maxsize=8)
def _spline(r: tuple[float, ...], z: tuple[float, ...]) -> Any:
    """Monotone cubics through the points, z(0) = 0; kept, since a chain's length is found by asking many times.

    The slope at a point is that of the parabola through it and its neighbours, so that a sphere's paraboloid is met
    exactly, but no more than STEEPEST times the rise to either side, and 0 where that changes its sign: then no cubic
    overshoots (F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238). Where the slope jumps, each side has
    its own.
    """
    x, y, corners = _points(r, z)
    ends = [0]
    for corner in corners:
        if corner - ends[-1] >= MIDDLE and corner <= len(x) - 1 - MIDDLE:
            ends.append(corner)
    ends.append(len(x) - 1)
    pieces = [_cubics(x[first : last + 1], y[first : last + 1]) for first, last in pairwise(ends)]
    return PPoly(np.concatenate(pieces, axis=1), x, extrapolate=False)


MIDDLE = 2
"""Points that a curve needs beside the one where its slope jumps."""


def _cubics(x: Array, y: Array) -> Array:
    """Coefficients of monotone cubics through the points (x, y), (4, n − 1), as `PPoly` has them."""
    step, rise = np.diff(x), np.diff(y) / np.diff(x)
    inner = (step[1:] * rise[:-1] + step[:-1] * rise[1:]) / (step[1:] + step[:-1])
    first = rise[0] + step[0] / (step[0] + step[1]) * (rise[0] - rise[1])
    last = rise[-1] + step[-1] / (step[-1] + step[-2]) * (rise[-1] - rise[-2])
    before, after = np.append(rise[0], rise), np.append(rise, rise[-1])
    least = np.where(np.abs(before) < np.abs(after), before, after)
    limit = np.where(before * after > 0.0, STEEPEST * np.abs(least), 0.0)
    slopes = np.sign(least) * np.clip(np.sign(least) * np.concatenate([[first], inner, [last]]), 0.0, limit)
    return np.asarray(CubicHermiteSpline(x, y, slopes).c)


def _slopes(curve: Any) -> tuple[Array, Array, Array, Array]:
    """Radii, shape (n,), and p₀, p₁, p₂ of the slope p₀ + p₁ r + p₂ r² between them, each of shape (n − 1,)."""
    square, linear, constant = curve.derivative().c
    start = curve.x[:-1]
    return curve.x, constant - linear * start + square * start**2, linear - 2.0 * square * start, square


OFF_AXIS = 1
"""Intervals from the axis on of a smooth curve whose slope may rise as it likes: an apex is no kink beside it."""


class Smoothed(Piecewise):
    """A body whose slope is linear between knots: what was taken of a scan."""

    knots: tuple[float, ...]
    slopes: tuple[float, ...]

    @property
    def reach(self) -> float:
        """The last knot."""
        return self.knots[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """The middle of an interval in which the slope rises SHARP times as fast as over all: a jump that was seen so.

        What is infinite at a kink is then no number that depends on the distance of the knots.
        """
        cells = zip(pairwise(self.knots), pairwise(self.slopes), strict=True)
        steep = SHARP * max(self.slopes) / self.reach
        found = [0.5 * (start + end) for (start, end), (low, high) in cells if high - low > steep * (end - start)]
        return tuple(place for place in found if place > self.knots[OFF_AXIS])

    def _curve(self) -> Any:
        return _quadratics(self.knots, self.slopes)


@lru_cache(maxsize=64)
def _quadratics(knots: tuple[float, ...], slopes: tuple[float, ...]) -> Any:
    """The curve of these slopes, 0 on the axis."""
    x, slope = np.asarray(knots), np.asarray(slopes)
    return PPoly(
        np.stack([0.0 * x[1:], np.diff(slope) / np.diff(x), slope[:-1]]), x, extrapolate=False
    ).antiderivative()


class Fitted(Shape):
    """A named shape out to the end of the scan that it was fitted to."""

    slow = True
    inner: Shape
    end: float

    def height(self, x: Array) -> Array:
        """That of the shape."""
        return self.inner.height(np.minimum(np.abs(x), self.end))

    def transformed(self, x: Array) -> Array:
        """That of the shape."""
        return self.inner.transformed(np.minimum(np.abs(x), self.end))

    @property
    def reach(self) -> float:
        """The end."""
        return min(self.end, self.inner.reach)

    @property
    def curvature_radius(self) -> float | None:
        """That of the shape."""
        return self.inner.curvature_radius


def curve_of(taken: Taken, parameters: Array) -> Shape:
    """The body with these parameters."""
    first, *more = parameters.tolist()
    if taken.shape == "smooth":
        return Smoothed.model_construct(knots=tuple(taken.knots.tolist()), slopes=(0.0, first, *more))
    inner: Shape
    if taken.shape == "power":
        inner = Power.model_construct(exponent=more[0], radius=float(taken.x[-1] - taken.x[0]), height_there=first)
    else:
        inner = (Circle if taken.shape == "circle" else Parabola).model_construct(radius=1.0 / first)
    return Fitted.model_construct(inner=inner, end=taken.reach)
