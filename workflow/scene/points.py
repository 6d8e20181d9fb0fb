"""Bodies that are known at points: the curve between these, its corners, and what else the points may mean."""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, PPoly

from contact1d.analysis.scan import Taken
from contact1d.workflow.scene.shapes import FEWEST_POINTS, Circle, Parabola, Power, Shape

Array = NDArray[np.float64]

LEAST_JUMP = 1e-6
"""Smallest jump of the slope over the largest slope: smaller ones are round-off."""


class Piecewise(Shape):
    """A body whose curve is polynomials of up to the third degree between points."""

    slow = True

    @property
    @abstractmethod
    def curve(self) -> Any:
        """The height [LU] over r [LU], 0 on the axis, a `scipy.interpolate.PPoly` of the third degree; cached.

        NaN beyond the body's end.
        """

    @property
    def reach(self) -> float:
        """The radius [LU] of the last point or knot, at which the body ends."""
        return float(self.curve.x[-1])

    def height(self, x: Array) -> Array:
        """Return the height z(|x|) − z(0) [LU] at positions x [LU], constant beyond the body's end; same shape."""
        return np.asarray(self.curve(np.minimum(np.abs(x), self.reach)))

    def transformed(self, x: Array) -> Array:
        """Return the height g(x) [LU] after the MDR transform at positions x [LU]; same shape.

        It is constant beyond the body's end. It is exact: the slope is a parabola p₀ + p₁ r + p₂ r² between two points,
        and ∫ (p₀ + p₁ r + p₂ r²)/√(x² − r²) dr = (p₀ + p₂ x²/2) arcsin(r/x) − (p₁ + p₂ r/2) √(x² − r²).
        """
        p_2, linear, constant = self.curve.derivative().c
        radii, start = self.curve.x, self.curve.x[:-1]
        p_1, p_0 = linear - 2.0 * p_2 * start, constant - start * (linear - p_2 * start)
        flat = np.minimum(np.abs(np.ravel(x)), self.reach)
        count, g = 1 + flat.size * start.size // 1_000_000, []  # positions times points at once: it bounds the memory
        for chunk in np.array_split(flat, count):
            position = chunk[:, None]
            ends = np.minimum(radii, position)
            angle = np.arcsin(ends / np.where(position > 0.0, position, 1.0))
            root = np.sqrt((position - ends) * (position + ends))
            parts = (p_0 + 0.5 * p_2 * position**2) * np.diff(angle, axis=1)
            parts -= p_1 * np.diff(root, axis=1) + 0.5 * p_2 * np.diff(ends * root, axis=1)
            g.append(chunk * parts.sum(axis=1))
        return np.concatenate(g).reshape(np.shape(x))


class Points(Piecewise):
    """A body that is known at points (r, z) [LU], from r = 0 on.

    Between them it is a monotone cubic: no overshoot, a paraboloid met exactly, and a continuous slope but at points
    where that jumps, as at the edge of a land.
    """

    sharp: ClassVar[float] = 8.0
    """Curvature at a point, or at two in sequence, over that at both neighbours beyond which the slope jumps."""
    r: tuple[float, ...]
    z: tuple[float, ...]

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU], rising, at which the points show that the slope jumps; empty without any; cached.

        There the curvature at a point, or in sum at two in sequence, exceeds that at both neighbours by a factor, 8. A
        jump between two points is where the parabolas through the points of either side meet. The axis and the last
        point are not among them.
        """
        return tuple(sorted(_corners(self, self.sharp)))

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """Other bodies that the points may mean, two or five.

        Always one with chords and one with corners in which neighbouring chords meet, in place of cubics where the
        points show no smooth curve: a body whose slope only rises is between the two. Where heights have nine digits or
        fewer, also a body whose apex is half a digit lower, and two whose heights are by as much higher and lower in
        pairs, which changes the slope at every other point most.
        """
        bodies: list[Shape] = [Rough.model_construct(r=self.r, z=self.z, corners=corners) for corners in (False, True)]
        if digit := _smallest_digit(self.z):
            index = np.arange(len(self.z))
            pairs = [(index > 0) * np.where((index + first) % 4 < 2, 1.0, -1.0) for first in (1, 2)]
            for signs in (-1.0 * (index == 0), *pairs):
                z = np.asarray(self.z) + 0.5 * digit * signs
                bodies.append(Points.model_construct(r=self.r, z=tuple(z.tolist())))
        return tuple(bodies)

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """Bodies through every second point, and through the other points, each with the first and the last point.

        Without those of fewer than four points, so that there are two, one or none.
        """
        fewer = [[(x[0], *x[first:-1:2], x[-1]) for x in (self.r, self.z)] for first in (1, 2)]
        return tuple(Points.model_construct(r=r, z=z) for r, z in fewer if len(r) >= FEWEST_POINTS)

    @cached_property
    def curve(self) -> Any:
        """Monotone cubics through the points, z(0) = 0, a `PPoly`: height [LU] over r [LU]; cached.

        It is NaN beyond the last point. Where the slope jumps, it has a further point, and the cubics of each side have
        their own slope, unless the jump is less than two points from the next one or from an end.
        """
        least = 2  # points of a curve in addition to the one at which its slope jumps
        x, y, *_ = self._chords()
        corners = _corners(self, self.sharp)
        x, y = np.array(sorted((dict(zip(x.tolist(), y.tolist(), strict=True)) | corners).items())).T
        ends = [0]
        for corner in np.searchsorted(x, sorted(corners)):
            if corner - ends[-1] >= least and corner <= len(x) - 1 - least:
                ends.append(corner)
        pieces = [_cubics(x[first : last + 1], y[first : last + 1]) for first, last in pairwise([*ends, len(x) - 1])]
        return PPoly(np.concatenate(pieces, axis=1), x, extrapolate=False)

    def _chords(self) -> tuple[Array, Array, Array, Array]:
        """Return (radii [LU], heights above the apex [LU], slopes of the chords, their changes per length [1/LU]).

        Radii and heights are (n,). The body is even in x: the chords begin at the point on the other side of the axis,
        (n,). The changes of slope are over the distance of the two neighbours, at the axis and all points but the last,
        (n − 1,).
        """
        x, y = np.asarray(self.r), np.asarray(self.z) - self.z[0]
        slope = np.diff(y, prepend=y[1]) / np.diff(x, prepend=-x[1])
        return x, y, slope, np.diff(slope) / np.append(2.0 * x[1], x[2:] - x[:-2])


class Rough(Points):
    """A measured profile with chords in place of cubics where its points show no smooth curve.

    Attributes:
        corners: whether the chords of both sides go on into a cell up to the corner in which they meet; kinks are then
            also where the points do not exclude that the slope jumps.
    """

    uneven: ClassVar[float] = 3.0
    """Ratio of the curvatures at the four points around a cell beyond which they show no smooth curve."""
    corners: bool

    @cached_property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU], rising, at which the slope jumps, with `corners` also where points do not exclude it."""
        return tuple(sorted(_corners(self, self.uneven if self.corners else self.sharp)))

    @cached_property
    def curve(self) -> Any:
        """The height above the apex [LU] over r [LU], a `PPoly`: monotone cubics, and chords in rough cells; cached.

        Rough cells are within two cells of one that shows no smooth curve. It is NaN beyond the last point.
        """
        spline = Points.model_construct(r=self.r, z=self.z).curve
        x, y = self._with_chord_corners() if self.corners else self._chords()[:2]
        radii = np.union1d(spline.x, x)
        start = radii[:-1]
        smooth = [spline(start, k) / math.factorial(k) for k in (3, 2, 1, 0)]
        chord = (np.diff(y) / np.diff(x))[np.searchsorted(x, start, side="right") - 1]
        straight = [0.0 * start, 0.0 * start, chord, np.interp(start, x, y)]
        rough = self._is_rough()[np.searchsorted(self.r, start, side="right") - 1]
        return PPoly(np.where(rough, straight, smooth), radii, extrapolate=False)

    def _with_chord_corners(self) -> tuple[Array, Array]:
        """Return (radii, heights) [LU] of the points, with one in each cell in which the chords of both sides meet.

        Radii rise, heights are above the apex. No point is added where chords do not meet inside the cell, in the first
        and last cell, and beside a point at which the slope jumps.
        """
        x, y, slope, _ = self._chords()
        before, after, start, end = slope[1:-2], slope[3:], slice(1, -2), slice(2, -1)
        with np.errstate(divide="ignore", invalid="ignore"):
            meet = (y[end] - y[start] + before * x[start] - after * x[end]) / (before - after)
            level = y[start] + before * (meet - x[start])
        is_corner = np.isin(x, [*_corners(self, self.sharp, smooth=False)])
        inside = (meet > x[start]) & (meet < x[end]) & ~is_corner[start] & ~is_corner[end]
        behind = np.flatnonzero(inside) + 2
        return np.insert(x, behind, meet[inside]), np.insert(y, behind, level[inside])

    def _is_rough(self) -> NDArray[np.bool_]:
        """Return whether each cell between two points is within two cells of one that shows no smooth curve, (n − 1,).

        That is one around which one of the four curvatures is 0 or negative, or the largest is more than 3 times the
        smallest, unless all are round-off errors.
        """
        x, _, slope, bend = self._chords()
        bend = np.concatenate([bend[1:2], bend, bend[-1:], bend[-1:]])  # of the points from −1 to n
        around = np.lib.stride_tricks.sliding_window_view(bend, 4)
        low, high = around.min(axis=1), around.max(axis=1)
        least = LEAST_JUMP * np.abs(slope).max() / x[-1]
        rough = (np.abs(around).max(axis=1) > least) & ((low <= 0.0) | (high > self.uneven * low))
        return np.convolve(rough, np.ones(5), mode="same") > 0.0  # two cells on either side


@lru_cache(maxsize=8)
def _corners(body: Points, sharpness: float, smooth: bool = True) -> dict[float, float]:
    """Return the height above the apex [LU] at each radius [LU] at which the slope of a body jumps; cached.

    It jumps between two points whose curvatures are in sum more than `sharpness` times each of their neighbours':
    where the parabolas through the points of either side meet, or at a point where these do not meet between two
    and its curvature alone is as large. Jumps in the round-off error do not count. It also jumps at points of a
    `smooth` body at which no slope keeps the cubics of both sides convex.
    """
    flank = 3  # points that determine the parabola of one side
    margin = 1e-3  # share of a cell at its ends, where a jump would have shown at the next points
    x, y, slope, bend = body._chords()
    curvature = np.where(np.abs(np.diff(slope)) > LEAST_JUMP * np.abs(slope).max(), np.abs(bend), 0.0)
    excess = curvature[1:-2] + curvature[2:-1] - sharpness * np.maximum(curvature[:-3], curvature[3:])
    corners, used = dict[float, float](), set[int]()
    for i in np.argsort(-excess) + 1:
        if excess[i - 1] <= 0.0 or used & {i, i + 1}:
            continue
        sides, step = (slice(max(0, i + 1 - flank), i + 1), slice(i + 1, i + 1 + flank)), x[i + 1] - x[i]
        parabolas = [np.polyfit((x[side] - x[i]) / step, y[side], min(2, len(x[side]) - 1)) for side in sides]
        roots = np.roots(np.polysub(*parabolas))
        meetings = [root.real for root in roots if root.imag == 0.0 and margin < root.real < 1.0 - margin]
        if len(meetings) == 1:
            used |= {i, i + 1}
            corners[float(x[i] + step * meetings[0])] = float(np.polyval(parabolas[0], meetings[0]))
    single = curvature[1:-1] > sharpness * np.maximum(curvature[:-2], curvature[2:])
    single[1:] |= smooth & _bends_too_much(x, y)
    return corners | {float(x[i]): float(y[i]) for i in {*(np.flatnonzero(single) + 1)} - used}


def _bends_too_much(x: Array, y: Array) -> NDArray[np.bool_]:
    """Return whether no slope at a point keeps the cubics of both sides convex, (n − 4,), from the third point on.

    The cubic over a chord of slope S₁ from the slope d₀ to d is convex for d ≤ 3 S₁ − 2 d₀, the one over S₂ to d₃ for
    d ≥ 3 S₂ − 2 d₃. False where the chords around the point are not convex themselves, or within the round-off error.

    Args:
        x, y: radii and heights of the points [LU], (n,).
    """
    step = np.diff(x)
    slope = np.diff(y) / step
    inner = (step[1:] * slope[:-1] + step[:-1] * slope[1:]) / (step[1:] + step[:-1])
    bend = np.diff(slope)
    jump = bend[1:-1]
    excess = 3.0 * jump - 2.0 * (inner[2:] - inner[:-2])
    convex = np.minimum(bend[:-2], bend[2:]) >= 0.0
    return np.asarray(convex & (excess > 0.0) & (jump > LEAST_JUMP * np.abs(slope).max()))


def _smallest_digit(z: tuple[float, ...]) -> float:
    """Return the largest power of ten [LU] of which all heights [LU] are whole multiples, within 1e-4 of it.

    0 where it would be ten digits or more below the largest height; a height other than 0 is required.
    """
    heights = np.asarray(z)
    first = math.ceil(math.log10(np.abs(heights).max()))
    for power in range(first, first - 10, -1):
        multiples = heights / 10.0**power
        if np.abs(multiples - multiples.round()).max() < 1e-4:
            return float(10.0**power)
    return 0.0


def _cubics(x: Array, y: Array) -> Array:
    """Return the coefficients of monotone cubics through the points (x, y), (4, n − 1), as `PPoly` has them.

    x rises; three points are needed. The slope at a point is that of the parabola through it and its neighbours, so
    that a sphere's paraboloid is met exactly, but no more than three times the rise to either side, and 0 where that
    changes its sign: then no cubic overshoots (F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238).
    """
    rise = np.diff(y) / np.diff(x)
    before, after = np.append(rise[0], rise), np.append(rise, rise[-1])
    steepest = 1.5 * (np.sign(before) + np.sign(after)) * np.minimum(np.abs(before), np.abs(after))
    parabolic = np.gradient(y, x, edge_order=2)
    slopes = np.clip(parabolic, np.minimum(steepest, 0.0), np.maximum(steepest, 0.0))
    return np.asarray(CubicHermiteSpline(x, y, slopes).c)


class Smoothed(Piecewise):
    """A body whose slope is linear between knots: a smooth curve that is fitted to a scan.

    Attributes:
        knots: radii from 0 on [LU].
        slopes: dz/dr at the knots.
    """

    knots: tuple[float, ...]
    slopes: tuple[float, ...]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Middles [LU], rising, of the intervals between knots in which the slope jumps; empty without any.

        There it rises faster than in both neighbours, and at more than eight times its mean rate, which is the largest
        slope over the radius of the last knot. In the first interval, at the apex, the slope may rise by any amount: it
        is never among them.
        """
        knots, steep = np.asarray(self.knots), Points.sharp * max(self.slopes) / self.reach
        rates = np.diff(self.slopes) / np.diff(knots)
        steepest = (rates[1:] >= rates[:-1]) & (rates[1:] > np.append(rates[2:], 0.0)) & (rates[1:] > steep)
        first = 1 + np.flatnonzero(steepest)  # knots with which these intervals begin
        return tuple((0.5 * (knots[first] + knots[first + 1])).tolist())

    @cached_property
    def curve(self) -> Any:
        """The height [LU] over r [LU], a `PPoly`: parabolas between knots; 0 on the axis, NaN beyond the end; cached.

        It is stored in the third degree, with 0 as first coefficient.
        """
        x, slope = np.asarray(self.knots), np.asarray(self.slopes)
        slopes = [0.0 * x[1:], np.diff(slope) / np.diff(x), slope[:-1]]
        return PPoly(np.stack(slopes), x, extrapolate=False).antiderivative()


class Fitted(Shape):
    """A named shape out to the end of the scan that it was fitted to.

    Attributes:
        inner: the shape.
        end: radius at which the scan ends [LU].
    """

    slow = True
    inner: Shape
    end: float

    def height(self, x: Array) -> Array:
        """Return the height [LU] of the fitted shape above its apex at positions x [LU]; same shape.

        It is constant beyond the end of the scan. NaN of a circle that ends before the scan, beyond its radius.
        """
        return self.inner.height(np.minimum(np.abs(x), self.end))

    def transformed(self, x: Array) -> Array:
        """Return the height g(x) [LU] of the fitted shape after the MDR transform at positions x [LU].

        It is constant beyond the end of the scan. Same shape as x.
        """
        return self.inner.transformed(np.minimum(np.abs(x), self.end))

    @property
    def reach(self) -> float:
        """The radius [LU] at which the scan or the fitted shape (a circle) ends, the smaller one."""
        return min(self.end, self.inner.reach)

    @property
    def curvature_radius(self) -> float | None:
        """The radius of curvature [LU] at the apex of the fitted parabola or circle; None of a power."""
        return self.inner.curvature_radius


def curve_of(taken: Taken, parameters: Array) -> Shape:
    """Return the body [LU] that is fitted to a scan, unchecked, with these `parameters`, (k,), of its curve.

    It is a smooth curve by its slopes at the knots but the first, or a parabola or circle by 1/R [1/LU] or a power by
    height [LU] and exponent, each up to the end of the scan. `taken`: has the kind of curve, and its knots or width.
    """
    first, *more = parameters.tolist()
    if taken.shape == "smooth":
        return Smoothed.model_construct(knots=tuple(taken.knots.tolist()), slopes=(0.0, first, *more))
    inner: Shape
    if taken.shape == "power":
        inner = Power.model_construct(exponent=more[0], radius=float(taken.x[-1] - taken.x[0]), height_there=first)
    else:
        inner = (Circle if taken.shape == "circle" else Parabola).model_construct(radius=1.0 / first)
    return Fitted.model_construct(inner=inner, end=taken.reach)
