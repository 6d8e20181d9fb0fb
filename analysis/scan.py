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
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Named = Literal["parabola", "circle", "power"]
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
PATIENCE = 100
"""Steps of a search for the active bounds, over their number, at most."""
NEEDLESS = 3.0
"""Increase of the squares of the residual by all removed knots together, over σ²τ, at most.

Of 1, 2, 3 and 4 it has the fewest rows beyond their bounds for the worn balls of the study `scans`, on the same seeds.
"""
DRAWS = 300
"""Of the noise: a standard deviation is then known to 4 %."""
ALIKE = 0.9999
"""Correlation of what a tilt and a moved apex do to heights from which on they cannot be distinguished."""
KEPT = 1e-4
"""Variance of a deviation over that of all below which it is left out."""
FLATTEST = 1e-6
"""1 − r²/R² of a circle at least, while its radius is sought."""
GRID = 200
"""Radii at which heights decide which deviations count."""
TINY = 1e-300
"""In place of 0 below a fraction."""
ASPERITY = 2.0
"""Standard deviations of the noise above the lowest point up to which patches are counted."""


class ScanError(ValueError):
    """Points of which no profile can be taken; the message says why, and what to do."""


@dataclass(frozen=True)
class Form:
    """A shape f(r; θ).

    Attributes:
        name: of a named shape, or "smooth".
        value: f, (n,), of r ≥ 0 and θ.
        slope: ∂f/∂r, (n,).
        gradient: ∂f/∂θ, (n, k).
        start: θ, (k,), to begin with.
        least: lower bounds of θ, (k,).
        knots: of a smooth curve, (k + 1,), from 0.
        convex: whether θ of a smooth curve is by how much the slope rises from knot to knot, and not the slope itself.
    """

    name: str
    value: Callable[[Array, Array], Array]
    slope: Callable[[Array, Array], Array]
    gradient: Callable[[Array, Array], Array]
    start: Array
    least: Array
    knots: Array | None = None
    convex: bool = False

    def shown(self, theta: Array) -> Array:
        """θ, (…, k), within its bounds, as slopes."""
        theta = np.maximum(theta, self.least)
        return np.cumsum(theta, axis=-1) if self.convex else theta


def named(shape: Named, curvature: float) -> Form:
    """A named shape: θ = (1/R), or (h, n) of h rⁿ."""
    if shape == "power":
        return Form(
            shape,
            lambda r, p: p[0] * r ** p[1],
            lambda r, p: p[0] * p[1] * r ** (p[1] - 1.0),
            lambda r, p: np.stack([r ** p[1], p[0] * r ** p[1] * np.log(np.maximum(r, TINY))], axis=1),
            np.asarray([0.5 * curvature, 2.0]),
            np.asarray([0.0, 1.0]),
        )
    bend = 0.0 if shape == "parabola" else 1.0

    def root(r: Array, p: Array) -> Array:
        """√(1 − r²/R²) of a circle, 1 of a parabola."""
        return np.asarray(np.sqrt(np.maximum(1.0 - bend * (p[0] * r) ** 2, FLATTEST)))

    return Form(
        shape,
        lambda r, p: p[0] * r**2 / (1.0 + root(r, p)),
        lambda r, p: p[0] * r / root(r, p),
        lambda r, p: (r**2 / root(r, p) ** bend / (1.0 + root(r, p)))[:, None],
        np.asarray([curvature]),
        np.zeros(1),
    )


def _slopes_of(many: int, convex: bool) -> Array:
    """The slopes at knots by θ, (k, k)."""
    return np.tril(np.ones((many, many))) if convex else np.eye(many)


def smooth(knots: Array, convex: bool) -> Form:
    """A smooth curve: θ are the slopes at the knots but that on the axis, where it is 0, or their increments."""
    many = len(knots) - 1
    slopes = _slopes_of(many, convex)

    def gradient(r: Array, _: Array) -> Array:
        """∫ of each hat up to r."""
        steps, cell = np.diff(knots), np.clip(np.searchsorted(knots, r, side="right") - 1, 0, many - 1)
        share = (r - knots[cell]) / steps[cell]
        full = np.zeros((many + 1, many + 1))
        full[1:] = np.cumsum(0.5 * steps[:, None] * (np.eye(many + 1)[:-1] + np.eye(many + 1)[1:]), axis=0)
        found, rows = full[cell], np.arange(len(r))
        found[rows, cell] += steps[cell] * (share - 0.5 * share**2)
        found[rows, cell + 1] += 0.5 * steps[cell] * share**2
        return np.asarray(found[:, 1:] @ slopes)

    def slope(r: Array, p: Array) -> Array:
        return np.asarray(np.interp(r, knots, np.append(0.0, slopes @ p)))

    start = np.asarray(np.linalg.solve(slopes, knots[1:]))
    return Form("smooth", lambda r, p: gradient(r, p) @ p, slope, gradient, start, np.zeros(many), knots, convex)


@dataclass(frozen=True)
class Noise:
    """Standard deviation of the residual, and how many points τ are worth one."""

    deviation: float
    together: float

    @property
    def power(self) -> float:
        """σ²τ: variance of a mean of n points, times n."""
        return self.deviation**2 * self.together

    def price(self, points: int, choices: int) -> float:
        """By how much a parameter must lower the squares of the residual of n points, one of so many choices."""
        return self.power * (math.log(max(2.0, points / self.together)) + 2.0 * math.log(choices))


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
    missed: float = 0.0

    def scaled(self, size: float, origin: float, base: float) -> Taken:
        """The same with lengths `size` times as large, positions from `origin`, heights from `base`."""
        powers = np.asarray({"smooth": [0.0], "power": [1.0, 0.0]}.get(self.shape, [-1.0]))
        lengths = ("knots", "reach", "noise", "correlation", "x", "heights", "residual", "missed")
        return replace(
            self,
            parameters=self.parameters * size**powers,
            deviations=self.deviations * size**powers,
            centre=(origin + size * self.centre[0], size * self.centre[1]),
            offset=(base + size * self.offset[0], size * self.offset[1]),
            **{name: size * getattr(self, name) for name in lengths},
        )

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
    shape: Named | None = None,
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
    fit = _Fit((x - origin) / wide, (z - base) / wide, centre is None, level)
    return fit.of(shape, length and length / wide).scaled(wide, origin, base)


@dataclass(frozen=True)
class _Fit:
    """Points of a scan whose width is 1, from the given apex or the first one, and what is looked for."""

    x: Array
    z: Array
    moves: bool
    tilts: bool

    def of(self, shape: Named | None, length: float | None) -> Taken:
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
        if shape:
            solved = self.solve(named(shape, max(2.0 * float(square), 1e-6)), start)
            free = self.smoothed(reach, start, None)
            return replace(self.judged(solved), missed=self.excess(solved, free))
        return self.judged(self.smoothed(reach, start, length))

    def excess(self, one: _Solved, other: _Solved) -> float:
        """RMS of the residual that a fit has more than another one has, 0 where that may be chance."""
        more = float(np.sum(one.residual**2) - np.sum(other.residual**2))
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
        excess = float(np.sum(one.residual**2) - np.sum(other.residual**2))
        noise = self.noise_of(other)
        return other if excess > noise.price(len(self.x), len(other.form.start)) else one

    def design(self, form: Form, found: Array) -> tuple[Array, Array]:
        """The curve at the points, (n,), and its derivatives by all parameters: θ, z₀, then c and t if looked for."""
        many = len(form.start)
        theta, (offset, centre, tilt) = found[:many], found[many:]
        away = self.x - centre
        r, side = np.abs(away), np.sign(away)
        columns = [form.gradient(r, theta), np.ones((len(r), 1))]
        if self.moves:
            columns.append((-side * form.slope(r, theta) - tilt)[:, None])
        if self.tilts:
            columns.append(away[:, None])
        return form.value(r, theta) + offset + tilt * away, np.hstack(columns)

    def solve(self, form: Form, centre: float) -> _Solved:
        """Least squares by Gauss and Newton, with the bounds of θ in each step."""
        many = len(form.start)
        found = np.concatenate([form.start, [0.0, centre, 0.0]])
        open_ = np.r_[np.ones(many + 1, dtype=bool), self.moves, self.tilts]
        before = np.full_like(self.z, math.inf)
        for step in range(ROUNDS):
            curve, columns = self.design(form, found)
            if np.abs(curve - before).max() < CONVERGED * self.z.max():
                break
            before, now = curve, open_.copy()
            now[many + 1 :] &= step > 0  # the shape first: its slope says how the apex moves heights
            columns = columns[:, now[open_]]
            moved = bounded(columns, self.z - curve + columns @ found[now], form.least) - found[now]
            moved[many + 1 :] = np.clip(moved[many + 1 :], -STEP, STEP)
            found[now] += moved
            found[many + 1] = min(max(found[many + 1], float(self.x[0])), float(self.x[-1]))
        curve, columns = self.design(form, found)
        return _Solved(form, found, columns, self.z - curve)

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
            return np.hstack([smooth(knots, convex).gradient(r, knots), rest])

        while len(knots) < MOST_KNOTS:
            q, _ = np.linalg.qr(columns_of(knots))
            new = np.stack([_bump(r, *ends) for ends in pairwise(knots)], axis=1)
            new -= q @ (q.T @ new)
            gain = (new.T @ z / np.linalg.norm(new, axis=0)) ** 2
            gain[np.diff(np.searchsorted(r, knots)) * group < 2 * PER_KNOT] = 0.0
            best = int(gain.argmax())
            if gain[best] <= noise.price(len(away), len(knots)) / group:
                break
            knots = np.insert(knots, best + 1, 0.5 * (knots[best] + knots[best + 1]))
        _, upper = np.linalg.qr(np.column_stack([columns_of(knots), z]))

        def squares_of(fewer: Array) -> float:
            """Of the residual of a curve that rises, which all knots have exactly."""
            of_slopes = np.stack([np.interp(knots[1:], fewer, one) for one in np.eye(len(fewer))[1:]], axis=1)
            to, own = _slopes_of(len(fewer) - 1, convex), np.linalg.inv(_slopes_of(len(knots) - 1, convex))
            one = np.hstack([upper[:, : len(knots) - 1] @ own @ of_slopes @ to, upper[:, len(knots) - 1 : -1]])
            return float(np.sum((upper[:, -1] - one @ bounded(one, upper[:, -1], np.zeros(len(fewer) - 1))) ** 2))

        own, kept = squares_of(knots), knots
        while len(kept) > 2:
            fewer = [np.delete(kept, i) for i in range(1, len(kept) - 1)]
            squares = [squares_of(one) for one in fewer]
            best = int(np.argmin(squares))
            if squares[best] > own + NEEDLESS * noise.power / group:
                break
            kept = fewer[best]
        return kept

    def judged(self, solved: _Solved) -> Taken:
        """What was found with its uncertainties, and the deviations of the shape."""
        form, found, many = solved.form, solved.found, len(solved.form.start)
        x, points = self.x - solved.centre, len(self.x)
        if self.moves and not is_two_sided(x):
            raise ScanError(
                'its apex would be at the edge of the scan or outside: centre = "auto" needs points on both sides '
                "of it; give centre as a length, or a wider scan"
            )
        noise = noise_in(solved.residual)
        free = max(1.0, points / noise.together - solved.columns.shape[1])
        deviation = math.sqrt(noise.power * max(1.0, points / noise.together / free))
        looked_for = np.r_[np.ones(many + 1, dtype=bool), self.moves, self.tilts]
        off = _drawn(solved.columns, found[looked_for], form.least, deviation)
        from scipy.special import stdtrit

        reach, factor = float(np.abs(x).max()), float(stdtrit(free, 0.5 + 0.5 * COVERAGE))
        spread = np.zeros(3)
        spread[looked_for[many:]] = factor * np.sqrt(np.mean(off[:, many:] ** 2, axis=0))
        theta, (offset, centre, tilt) = found[:many], found[many:].tolist()
        heights = self.z - offset - tilt * x
        touching = heights < heights.min() + ASPERITY * noise.deviation
        knots = np.zeros(0) if form.knots is None else form.knots
        grid = np.linspace(0.0, reach, GRID)
        # Bounds make the mean of a sample other than what is true: a deviation, too, from 0 to twice of it.
        bias = np.stack([np.zeros(many), 2.0 * off[:, :many].mean(axis=0)])
        changes = np.concatenate([[bias], factor * independent(off[:, :many], form.gradient(grid, theta))])
        return Taken(
            shape=form.name,
            parameters=form.shown(theta),
            knots=knots,
            deviations=form.shown(theta + changes),
            centre=(centre, spread[1]),
            tilt=(tilt, spread[2]),
            offset=(offset, spread[0]),
            reach=reach,
            noise=noise.deviation,
            correlation=0.5 * (noise.together - 1.0) * float(np.median(np.diff(x))),
            x=x,
            heights=heights,
            residual=solved.residual,
            autocorrelation=autocovariance(solved.residual)[: points // 4] / max(noise.deviation**2, TINY),
            patches=int(np.count_nonzero(np.diff(np.append(0, touching.astype(int))) > 0)),
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


def bounded(columns: Array, target: Array, least: Array) -> Array:
    """Least squares (n, k) p = (n,), the first ones of p ≥ `least`."""
    size = np.linalg.norm(columns, axis=0)
    size[size == 0.0] = 1.0
    first, free = np.split(columns / size, [len(least)], axis=1)
    q, _ = np.linalg.qr(free)
    target = target - columns[:, : len(least)] @ least
    from scipy.optimize import nnls

    above, _ = nnls(first - q @ (q.T @ first), target - q @ (q.T @ target), maxiter=PATIENCE * len(least))
    rest = np.linalg.lstsq(free, target - first @ above)[0]
    return np.asarray(np.concatenate([least, 0.0 * rest]) + np.concatenate([above, rest]) / size)


def _drawn(columns: Array, found: Array, least: Array, deviation: float) -> Array:
    """By how much bounded least squares are off, (DRAWS, k), where p, (k,), is true, and the noise is drawn.

    The first parameters have the bounds: a land, whose slope is 0, is known better than the normal equations say.
    """
    _, upper = np.linalg.qr(columns)
    noise = deviation * np.random.default_rng(1).standard_normal((DRAWS, len(found)))
    return np.stack([bounded(upper, upper @ found + one, least) - found for one in noise])


def _bump(r: Array, first: float, last: float) -> Array:
    """∫ of the hat between two knots that a knot in the middle adds, up to r."""
    half = 0.5 * (last - first)
    share = np.clip((r - first) / half, 0.0, 2.0)
    return half * np.where(share < 1.0, 0.5 * share**2, 1.0 - 0.5 * (2.0 - share) ** 2)


def independent(off: Array, heights: Array) -> Array:
    """Pairs (m, 2, k) of a sample (n, k) whose halved differences are its independent standard deviations.

    Principal ones of the heights by θ, (j, k): the means of those that are on either side of 0 along each, widened from
    the mean to the standard deviation, so that they are within the bounds of the sample. What moves next to nothing is
    left out.
    """
    _, sizes, along = np.linalg.svd(heights @ off.T, full_matrices=False)
    modes = along[sizes**2 > KEPT * np.sum(sizes**2)]
    wider = np.sqrt(np.mean(modes**2, axis=1)) / np.mean(np.abs(modes), axis=1)
    ways = [[off[side * one > 0.0].mean(axis=0) for side in (1.0, -1.0)] for one in modes]
    return np.asarray(wider[:, None, None] * np.reshape(ways, (len(modes), 2, off.shape[1])))


def autocovariance(residual: Array) -> Array:
    """Mean of e_i e_{i+k}, k from 0, (n,)."""
    power = np.abs(np.fft.rfft(residual, 2 * len(residual))) ** 2
    return np.asarray(np.fft.irfft(power)[: len(residual)] / len(residual))


def noise_in(residual: Array) -> Noise:
    """The noise of a residual."""
    return noise_by(autocovariance(residual), len(residual))


def noise_by(covariance: Array, points: int) -> Noise:
    """The noise by its autocovariance: correlations add up to the first one that is no more than chance, 2/√n."""
    if covariance[0] <= 0.0:
        return Noise(0.0, 1.0)
    rho = covariance[1:] / covariance[0]
    end = int(np.argmax(np.append(rho, -1.0) < 2.0 / math.sqrt(points)))
    return Noise(math.sqrt(covariance[0]), 1.0 + 2.0 * float(rho[:end].sum()))
