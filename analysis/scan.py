"""A scan of a body of revolution: what is removed of its points, the curve that is taken, and how far off it may be.

    z(x) = f(|x − c|; θ) + t (x − c) + z₀ + noise

with the apex at c, the tilt t and the offset z₀. The shape f has f(0) = 0 and rises. Its parameters θ are those of a
named shape, or of a smooth curve the slopes f′ ≥ 0 at knots, linear between them and 0 on the axis. All are found
together by least squares, so that both sides of a scan say what f is, and their covariance is known. The noise may be
correlated: n points are worth n/τ independent ones, τ = 1 + 2 Σ ρ_k of the residual's autocorrelation ρ. The knots of
a smooth curve are added one by one, each that lowers the residual most by halving an interval, and removed again where
they have become needless, as the extended Bayesian information criterion says (J. Chen, Z. Chen, Biometrika 95 (2008)
759) under a noise that is read off the difference of both sides, which knows nothing of the shape.

Lengths have any one unit.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.form import Array, Form, ShapeName, named, smooth
from contact1d.analysis.residual import Noise, autocovariance, bounded, drawn, independent, noise_by, noise_in

COVERAGE = 0.95
FEWEST = 8
"""Points of a scan."""
ROUNDS = 30
"""Gauss-Newton steps at most: a few suffice."""
STEP = 0.05
"""Of the position of the apex, over the width, and of the tilt: the largest change at once."""
CONVERGED = 1e-10
"""Relative change of the fitted curve from which on it counts as found."""
SIDE = 0.05
"""Share of a scan's width that must be on either side of an apex that is looked for."""
PER_KNOT = 4
"""Points in an interval between two knots at least."""
FIRST_KNOTS = 24
"""Intervals of the curve whose residual is the first estimate of the noise: more than any shape needs off its kinks."""
BLOCKS = 12
"""Parts of a residual of one side, whose median autocovariance a kink in one of them leaves as it is."""
LARGEST_SELECTED = 4000
"""Points from which the knots are chosen: of more, means of neighbours."""
MOST_KNOTS = 40
"""Of a curve that is as detailed as the noise allows: of a scan without noise."""
NEEDLESS = 3.0
"""Increase of the squares of the residual by all removed knots together, over σ²τ, at most.

Of 1, 2, 3 and 4 it has the fewest rows beyond their bounds for the worn balls of the study `scans`, on the same seeds.
"""
ALIKE = 0.9999
"""Correlation of what a tilt and a moved apex do to heights from which on they cannot be distinguished."""
GRID = 200
"""Radii at which heights decide which deviations count."""
TINY = 1e-300
"""In place of 0 below a fraction."""
ASPERITY = 2.0
"""Standard deviations of the noise above the lowest point up to which patches are counted."""


class ScanError(ValueError):
    """Points of which no profile can be taken; the message says why, and what to do."""


@dataclass(frozen=True)
class Taken:
    """What was taken of a scan.

    Attributes:
        shape: "smooth", or the name of what was fitted.
        parameters: θ, (k,): 1/R; h and n of h (r/w)ⁿ, w the width of the scan; the slopes at the knots.
        knots: of a smooth curve, (k + 1,), from 0.
        deviations: pairs of θ, (m, 2, k): half of the difference of what follows from the two of each is independent of
            the others, at 95 %.
        centre, tilt, offset: position of the apex, slope and height there; each with its uncertainty at 95 %, 0 of
            what was given.
        reach: largest distance of a point from the apex.
        noise, correlation: standard deviation of the residual, and its correlation length, Σ ρ_k of the points' pitch.
        x: positions of the points from the apex, rising, (n,).
        heights, residual: without tilt and offset, and without the curve, too, (n,).
        autocorrelation: ρ_k of the residual.
        missed: RMS of what a fitted shape leaves beyond the noise; 0 of a smooth curve.
        patches: parts in which the measured points would touch a plane ASPERITY σ above the lowest one.
    """

    shape: str
    parameters: Array
    knots: Array
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
        """Distance of neighbouring points."""
        return float(np.median(np.diff(self.x)))

    @property
    def both_sides(self) -> bool:
        """Whether points are on both sides of the apex."""
        return is_two_sided(self.x)

    def folded(self) -> tuple[Array, Array]:
        """Radii and heights (n,) of the points themselves: the mean of both sides where there are two, z(0) = 0."""
        from scipy.interpolate import PchipInterpolator  # which takes longer to import than a small run

        sides = [PchipInterpolator(*_rising(side * self.x, self.heights)) for side in (1.0, -1.0)]
        end = float(min(self.x[-1], -self.x[0])) if self.both_sides else float(self.x[-1])
        r = np.linspace(0.0, end, 1 + round(end / self.pitch))
        z = np.mean([one(r) for one in sides[: 1 + self.both_sides]], axis=0)
        return r, z - z[0]


def is_two_sided(x: Array) -> bool:
    """Whether rising positions have points on both sides of 0."""
    return float(min(-x[0], x[-1])) > SIDE * float(x[-1] - x[0])


def _rising(x: Array, z: Array) -> tuple[Array, Array]:
    """The points by their positions; of several at one their mean."""
    at, which, counts = np.unique(x, return_inverse=True, return_counts=True)
    return at, np.bincount(which, z) / counts


def one_pass(x: Array, z: Array) -> tuple[Array, Array]:
    """The points in rising x; a scan that goes forth and back as the mean of both, on the positions of the first."""
    steps = np.flatnonzero(np.diff(x))
    turns = steps[np.flatnonzero(np.diff(np.sign(np.diff(x)[steps])))] + 1
    ends = [0, *turns.tolist(), len(x) - 1]
    passes = [_rising(x[first : last + 1], z[first : last + 1]) for first, last in pairwise(ends)]
    passes = [one for one in passes if len(one[0]) > 0.5 * max(len(one[0]) for one in passes)]
    low, high = max(one[0][0] for one in passes), min(one[0][-1] for one in passes)
    at = passes[0][0]
    at = at[(at >= low) & (at <= high)]
    return at, np.mean([np.interp(at, *one) for one in passes], axis=0)


def take(
    x: Array,
    z: Array,
    centre: float | None = 0.0,
    level: bool = False,
    length: float | None = None,
    shape: ShapeName | None = None,
) -> Taken:
    """What is taken of the points of a scan.

    Args:
        x, z: positions and heights, (n,), growing away from the plane; a scan may go forth and back.
        centre: position of the apex; None: it is looked for.
        level: whether a tilt is removed.
        length: distance of the knots of a smooth curve; None: by the noise.
        shape: the named shape that is fitted, in place of a smooth curve.

    Raises:
        ScanError: the points are no such profile.
    """
    x, z = one_pass(x, z)
    if len(x) < FEWEST:
        raise ScanError(f"has {len(x)} points in one direction, at least {FEWEST} are needed")
    wide, base = float(np.ptp(x)), float(z.min())
    if float(z.max()) == base:
        raise ScanError('is flat: write kind = "flat_punch"')
    origin = float(x[0]) if centre is None else centre
    fit = _Fit((x - origin) / wide, (z - base) / wide, centre is None, level, wide, origin, base)
    return fit.of(shape, length and length / wide)


@dataclass(frozen=True)
class _Fit:
    """Points of a scan whose width is 1, from the given apex or the first one; what is looked for; its own lengths."""

    x: Array
    z: Array
    moves: bool
    tilts: bool
    size: float
    origin: float
    base: float

    def of(self, shape: ShapeName | None, length: float | None) -> Taken:
        """The points by a named shape, or a smooth curve."""
        square, linear, _ = np.polyfit(self.x, self.z, 2)
        start = -0.5 * linear / square if self.moves else 0.0
        if square <= 0.0 and float(np.median(self.z)) > 0.5 * float(self.z.max()):
            raise ScanError(
                "its heights decrease from the apex outwards, as those of a bump seen from above; heights are "
                'measured from the plane and grow outwards: change the sign of z, or of its unit: units = ["mm", "-µm"]'
            )
        start = min(max(start, float(self.x[0])), float(self.x[-1]))
        reach = float(np.abs(self.x - start).max())
        if self.moves and self.tilts:
            self.require_flat_part(reach, start)
        free = self.smoothed(reach, start, None if shape else length)
        if shape:
            solved = self.solve(named(shape, max(2.0 * float(square), 1e-6)), start)
            return self.judged(solved, self.excess(solved, free))
        return self.judged(free, 0.0)

    def excess(self, one: _Solved, other: _Solved) -> float:
        """RMS of the residual that a fit has more than another one has, 0 where that may be chance."""
        more = one.squares - other.squares
        price = self.noise_of(other).price(len(self.x), len(other.form.start))
        return math.sqrt(more / len(self.x)) if more > price * len(other.form.start) else 0.0

    def require_flat_part(self, reach: float, start: float) -> None:
        """Refuse a tilt beside an unknown apex where both do the same to all heights."""
        curve = replace(self, tilts=False).solve(smooth(np.linspace(0.0, reach, FIRST_KNOTS), True), start)
        if abs(np.corrcoef(curve.columns[:, -1], self.x)[0, 1]) > ALIKE:
            raise ScanError(
                "its tilt and the position of its apex cannot be distinguished: a tilt of a parabola only moves the "
                "apex; remove level = true"
            )

    def smoothed(self, reach: float, start: float, length: float | None) -> _Solved:
        """A smooth curve whose slope rises from the apex on, unless the scan shows that it falls somewhere."""

        def curve(convex: bool) -> _Solved:
            if length is None:
                return self.adapted(reach, start, convex)
            return self.solve(smooth(np.linspace(0.0, reach, 1 + max(1, round(reach / length))), convex), start)

        one, other = curve(True), curve(False)
        price = self.noise_of(other).price(len(self.x), len(other.form.start))
        return other if one.squares - other.squares > price else one

    def looked_for(self, form: Form) -> NDArray[np.bool_]:
        """Which of all parameters are: θ and z₀ always, c and t if they are asked for."""
        return np.array([True] * (len(form.start) + 1) + [self.moves, self.tilts])

    def design(self, form: Form, found: Array) -> tuple[Array, Array]:
        """The curve at the points, (n,), and its derivatives by all parameters: θ, z₀, c and t."""
        many = len(form.start)
        theta, (offset, centre, tilt) = found[:many], found[many:]
        away = self.x - centre
        r, side = np.abs(away), np.sign(away)
        columns = [form.gradient(r, theta), np.ones_like(r), -side * form.slope(r, theta) - tilt, away]
        return form.value(r, theta) + offset + tilt * away, np.column_stack(columns)

    def solve(self, form: Form, centre: float) -> _Solved:
        """Least squares by Gauss and Newton, with the bounds of θ in each step."""
        many = len(form.start)
        found = np.concatenate([form.start, [0.0, centre, 0.0]])
        before = np.full_like(self.z, math.inf)
        for step in range(ROUNDS):
            curve, columns = self.design(form, found)
            if np.abs(curve - before).max() < CONVERGED * self.z.max():
                break
            before, now = curve, self.looked_for(form)
            now[many + 1 :] &= step > 0  # the shape first: its slope says how the apex moves heights
            columns = columns[:, now]
            moved = bounded(columns, self.z - curve + columns @ found[now], form.least) - found[now]
            moved[many + 1 :] = np.clip(moved[many + 1 :], -STEP, STEP)
            found[now] += moved
            found[many + 1] = min(max(found[many + 1], float(self.x[0])), float(self.x[-1]))
        curve, columns = self.design(form, found)
        return _Solved(form, found, columns[:, self.looked_for(form)], self.z - curve)

    def adapted(self, reach: float, centre: float, convex: bool) -> _Solved:
        """A smooth curve with as many knots as the noise allows."""
        pitch = float(np.median(np.diff(self.x)))
        first = min(FIRST_KNOTS, max(2, round(reach / pitch / PER_KNOT)))
        solved = self.solve(smooth(np.linspace(0.0, reach, first + 1), convex), centre)
        noise = self.noise_of(solved)
        for _ in range(3):
            solved = self.solve(smooth(self.selected(solved, noise), convex), solved.centre)
            if is_two_sided(self.x - solved.centre):
                noise = self.noise_of(solved)
        return solved

    def noise_of(self, solved: _Solved) -> Noise:
        """The noise, by the difference of both sides; of one side by the residual in blocks, whose median counts."""
        x, residual = self.x - solved.centre, solved.residual
        if is_two_sided(x):
            right = x > 0.0
            left = np.interp(x[right], -x[::-1], residual[::-1], right=math.nan)
            odd = (residual[right] - left) / math.sqrt(2.0)
            return noise_in(odd[np.isfinite(odd)])
        size = max(FEWEST, len(x) // BLOCKS)
        blocks = [residual[i : i + size] for i in range(0, len(x) - size + 1, size)]
        spectrum = np.median([autocovariance(one) for one in blocks], axis=0)
        return noise_by(spectrum, len(x))

    def selected(self, solved: _Solved, noise: Noise) -> Array:
        """The knots: intervals are halved, that first which lowers the residual most, while the criterion falls."""
        away = np.abs(self.x - solved.centre)
        reach, group = float(away.max()), -(-len(away) // LARGEST_SELECTED)
        order = np.argsort(away)[: len(away) // group * group].reshape(-1, group)
        columns = solved.columns[:, len(solved.form.start) :]
        r, rest, z = away[order].mean(axis=1), columns[order].mean(axis=1), self.z[order].mean(axis=1)
        knots, convex = np.asarray([0.0, reach]), solved.form.convex

        def columns_of(knots: Array) -> Array:
            return np.hstack([smooth(knots, False).gradient(r, knots), rest])

        while len(knots) < MOST_KNOTS:
            q, _ = np.linalg.qr(columns_of(knots))
            halved = np.sort(np.append(knots, 0.5 * (knots[1:] + knots[:-1])))
            new = smooth(halved, False).gradient(r, halved)[:, ::2]
            new -= q @ (q.T @ new)
            gain = (new.T @ z / np.linalg.norm(new, axis=0)) ** 2
            gain[np.diff(np.searchsorted(r, knots)) * group < 2 * PER_KNOT] = 0.0
            best = int(gain.argmax())
            if gain[best] <= noise.price(len(away), len(knots)) / group:
                break
            knots = np.insert(knots, best + 1, halved[2 * best + 1])
        _, upper = np.linalg.qr(np.column_stack([columns_of(knots), z]))

        def squares_of(fewer: Array) -> float:
            """Of the residual of a curve that rises, which all knots have exactly."""
            form = smooth(fewer, convex)
            by_theta = form.slope(knots[1:], np.eye(len(form.start)))
            one = np.hstack([upper[:, : len(knots) - 1] @ by_theta, upper[:, len(knots) - 1 : -1]])
            return float(np.sum((upper[:, -1] - one @ bounded(one, upper[:, -1], form.least)) ** 2))

        own, kept = squares_of(knots), knots
        while len(kept) > 2:
            fewer = [np.delete(kept, i) for i in range(1, len(kept) - 1)]
            squares = [squares_of(one) for one in fewer]
            best = int(np.argmin(squares))
            if squares[best] > own + NEEDLESS * noise.power / group:
                break
            kept = fewer[best]
        return kept

    def judged(self, solved: _Solved, missed: float) -> Taken:
        """What was found with its uncertainties, and the deviations of the shape; `missed` by a fitted one."""
        form, found, many = solved.form, solved.found, len(solved.form.start)
        x, points, size = self.x - solved.centre, len(self.x), self.size
        if self.moves and not is_two_sided(x):
            raise ScanError(
                'its apex would be at the edge of the scan or outside: centre = "auto" needs points on both sides '
                "of it; give centre as a length, or a wider scan"
            )
        noise, looked_for = noise_in(solved.residual), self.looked_for(form)
        free = max(1.0, points / noise.together - solved.columns.shape[1])
        deviation = math.sqrt(noise.power * max(1.0, points / noise.together / free))
        off = drawn(solved.columns, found[looked_for], form.least, deviation)
        from scipy.special import stdtrit

        reach, factor = float(np.abs(x).max()), float(stdtrit(free, 0.5 + 0.5 * COVERAGE))
        spread = np.zeros(3)
        spread[looked_for[many:]] = factor * np.sqrt(np.mean(off[:, many:] ** 2, axis=0))
        theta, (offset, centre, tilt) = found[:many], found[many:].tolist()
        heights = self.z - offset - tilt * x
        touching = heights < heights.min() + ASPERITY * noise.deviation
        grid = np.linspace(0.0, reach, GRID)
        # Bounds make the mean of a sample other than what is true: a deviation, too, from 0 to twice of it.
        bias = np.stack([np.zeros(many), 2.0 * off[:, :many].mean(axis=0)])
        changes = np.concatenate([[bias], factor * independent(off[:, :many], form.gradient(grid, theta))])
        return Taken(
            shape=form.name,
            parameters=form.shown(theta) * size**form.powers,
            knots=np.zeros(0) if form.knots is None else size * form.knots,
            deviations=form.shown(theta + changes) * size**form.powers,
            centre=(self.origin + size * centre, size * spread[1]),
            tilt=(tilt, spread[2]),
            offset=(self.base + size * offset, size * spread[0]),
            reach=size * reach,
            noise=size * noise.deviation,
            correlation=size * 0.5 * (noise.together - 1.0) * float(np.median(np.diff(x))),
            x=size * x,
            heights=size * heights,
            residual=size * solved.residual,
            autocorrelation=autocovariance(solved.residual)[: points // 4] / max(noise.deviation**2, TINY),
            patches=int(np.count_nonzero(np.diff(np.append(0, touching.astype(int))) > 0)),
            missed=size * missed,
        )


@dataclass(frozen=True)
class _Solved:
    """A fitted form: θ, z₀, c and t, the derivatives by those looked for, and the residual (n,)."""

    form: Form
    found: Array
    columns: Array
    residual: Array

    @property
    def centre(self) -> float:
        return float(self.found[-2])

    @property
    def squares(self) -> float:
        return float(np.sum(self.residual**2))
