"""The profile fitted to a scan of a body of revolution, with its tilt, offset and apex, and its uncertainty.

    z(x) = f(|x − c|; θ) + t (x − c) + z₀ + noise

with the apex at c, the tilt t and the offset z₀. The shape f has f(0) = 0 and rises. Its parameters θ are those of a
named shape, or of a smooth curve the slopes f′ ≥ 0 at knots, linear between them and 0 on the axis. All are fitted
together by least squares, so that both sides of a scan determine f, and their covariance is known. The noise may be
correlated: n points are worth n/τ independent ones, τ = 1 + 2 Σ ρ_k of the residual's autocorrelation ρ. The knots of
a smooth curve are added one by one, each that lowers the residual most by halving an interval, and removed again where
they have become needless, by the extended Bayesian information criterion (J. Chen, Z. Chen, Biometrika 95 (2008)
759) under a noise from the difference of both sides, which does not depend on the shape.

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

FEWEST = 8
"""Points that a scan needs."""
PER_KNOT = 4
"""Points that an interval between two knots needs."""
FIRST_KNOTS = 24
"""Intervals of the curve whose residual is the first estimate of the noise: more than any shape needs off its kinks."""
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
        return float(np.median(np.diff(self.x)))

    @property
    def both_sides(self) -> bool:
        """Whether the scan has points on both sides of the apex, more than 5 % of its width on each."""
        return is_two_sided(self.x)

    def folded(self) -> tuple[Array, Array]:
        """Return radii and heights of the points without tilt, (m,) each, in the unit of the scan, with z(0) = 0.

        The radii are evenly spaced from 0 by about the median distance of points. With points on both sides of the apex
        they end at the nearer end and heights are averaged; else they end at the last position, and a scan to the left
        only gives the radius 0 alone. Heights between points are interpolated.
        """
        from scipy.interpolate import PchipInterpolator  # which takes longer to import than a small run

        sides = [PchipInterpolator(*_rising(sign * self.x, self.heights)) for sign in (1.0, -1.0)]
        end = float(min(self.x[-1], -self.x[0])) if self.both_sides else float(self.x[-1])
        r = np.linspace(0.0, end, 1 + round(end / self.pitch))
        z = np.mean([side(r) for side in sides[: 1 + self.both_sides]], axis=0)
        return r, z - z[0]


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


def take(
    x: Array,
    z: Array,
    centre: float | None = 0.0,
    level: bool = False,
    length: float | None = None,
    shape: ShapeName | None = None,
) -> Taken:
    """Return the profile fitted to the points of a scan, in the unit of x and z.

    Args:
        x, z: positions and heights, (n,), growing away from the plane; a scan may go forth and back.
        centre: position of the apex, the nearest point of the scan instead where it is outside of that; None: it is
            fitted.
        level: whether a tilt is fitted and removed.
        length: distance of the knots of a smooth curve; None: by the noise. Not used with a named shape.
        shape: the named shape that is fitted; None: a smooth curve.

    Raises:
        ScanError: fewer than 8 points in one direction, a flat or inverted profile, or an apex or tilt that the points
            do not determine.
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
    """Points of a scan over its width, from the given apex or the first point on; what is fitted; the true lengths.

    Attributes:
        x, z: positions from `origin` and heights from `base` over the width, (n,), dimensionless.
        moves, tilts: whether the apex and a tilt are fitted.
        size: the width, in the unit of the scan.
        origin, base: position and height of 0, in the unit of the scan.
    """

    x: Array
    z: Array
    moves: bool
    tilts: bool
    size: float
    origin: float
    base: float

    def of(self, shape: ShapeName | None, length: float | None) -> Taken:
        """Return the fit of a named shape, or of a smooth curve where `shape` is None.

        Args:
            shape: name of the shape.
            length: distance of the knots of a smooth curve over the width of the scan; None: by the noise.

        Raises:
            ScanError: an inverted profile, or an apex or tilt that the points do not determine.
        """
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

    def excess(self, shape: _Solved, smooth_curve: _Solved) -> float:
        """Return the RMS residual of a named shape beyond that of a smooth curve, over the width of the scan.

        It is the root of the difference of their mean squares, 0 where that may be chance.
        """
        more, knots = shape.squares - smooth_curve.squares, len(smooth_curve.form.start)
        price = self.noise_of(smooth_curve).price(len(self.x), knots)
        return math.sqrt(more / len(self.x)) if more > price * knots else 0.0

    def require_flat_part(self, reach: float, start: float) -> None:
        """Raise ScanError where a tilt and a moved apex have the same effect on heights: a correlation above 0.9999.

        Args:
            reach: largest distance of a point from the apex, over the width.
            start: position of the apex, over the width.
        """
        curve = replace(self, tilts=False).solve(smooth(np.linspace(0.0, reach, FIRST_KNOTS), True), start)
        if abs(np.corrcoef(curve.columns[:, -1], self.x)[0, 1]) > 0.9999:
            raise ScanError(
                "its tilt and the position of its apex cannot be distinguished: a tilt of a parabola only moves the "
                "apex; remove level = true"
            )

    def smoothed(self, reach: float, start: float, length: float | None) -> _Solved:
        """Return the fitted smooth curve: its slope rises from the apex on, unless the scan shows a fall of the slope.

        Args:
            reach: largest distance of a point from the apex, over the width of the scan.
            start: position of the apex to begin with, over the width.
            length: distance of the knots over the width; None: by the noise.
        """

        def curve(convex: bool) -> _Solved:
            """Return the smooth curve fitted with a slope that only rises if `convex`, else with any slope ≥ 0."""
            if length is None:
                return self.adapted(reach, start, convex)
            return self.solve(smooth(np.linspace(0.0, reach, 1 + max(1, round(reach / length))), convex), start)

        convex, free = curve(True), curve(False)
        price = self.noise_of(free).price(len(self.x), len(free.form.start))
        return free if convex.squares - free.squares > price else convex

    def fitted(self, form: Form) -> NDArray[np.bool_]:
        """Return which of θ, z₀, c and t are fitted, in this order, (k + 3,).

        θ and z₀ always are, the apex c if `moves`, the tilt t if `tilts`.
        """
        return np.array([True] * (len(form.start) + 1) + [self.moves, self.tilts])

    def design(self, form: Form, parameters: Array) -> tuple[Array, Array]:
        """Return the curve over the width at the points, (n,), and its derivatives by θ, z₀, c and t, (n, k + 3).

        `parameters` are θ, (k,), z₀, c and t, in this order; the tilt is about the apex.
        """
        count = len(form.start)
        theta, (offset, centre, tilt) = parameters[:count], parameters[count:]
        away = self.x - centre
        r, side = np.abs(away), np.sign(away)
        columns = [form.gradient(r, theta), np.ones_like(r), -side * form.slope(r, theta) - tilt, away]
        return form.value(r, theta) + offset + tilt * away, np.column_stack(columns)

    def solve(
        self, form: Form, centre: float, iterations: int = 30, largest_step: float = 0.05, tolerance: float = 1e-10
    ) -> _Solved:
        """Return the least squares by Gauss-Newton steps, with the bounds of θ in each; a few iterations suffice.

        Args:
            form: the shape.
            centre: position of the apex to begin with, over the width of the scan.
            iterations: at most; the last one is returned whether it has converged or not.
            largest_step: of the position of the apex, over the width, and of the tilt.
            tolerance: change of the curve over its largest height in the last step.
        """
        count = len(form.start)
        parameters = np.concatenate([form.start, [0.0, centre, 0.0]])
        before = np.full_like(self.z, math.inf)
        for iteration in range(iterations):
            curve, columns = self.design(form, parameters)
            if np.abs(curve - before).max() < tolerance * self.z.max():
                break
            before, free = curve, self.fitted(form)
            free[count + 1 :] &= iteration > 0  # the shape first: its slope is how the apex moves heights
            columns = columns[:, free]
            step = bounded(columns, self.z - curve + columns @ parameters[free], form.least) - parameters[free]
            step[count + 1 :] = np.clip(step[count + 1 :], -largest_step, largest_step)
            parameters[free] += step
            parameters[count + 1] = min(max(parameters[count + 1], float(self.x[0])), float(self.x[-1]))
        curve, columns = self.design(form, parameters)
        return _Solved(form, parameters, columns[:, self.fitted(form)], self.z - curve)

    def adapted(self, reach: float, centre: float, convex: bool) -> _Solved:
        """Return the fitted smooth curve with as many knots as the noise allows.

        Args:
            reach: largest distance of a point from the apex, over the width of the scan.
            centre: position of the apex to begin with, over the width.
            convex: whether its slope may only rise.
        """
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
        """Return the noise, over the width, by the difference of both sides; for one side by the residual in blocks.

        These are twelve: a kink in one of them does not change the median of their autocovariances.
        """
        x, residual = self.x - solved.centre, solved.residual
        if is_two_sided(x):
            right = x > 0.0
            left = np.interp(x[right], -x[::-1], residual[::-1], right=math.nan)
            odd = (residual[right] - left) / math.sqrt(2.0)
            return noise_in(odd[np.isfinite(odd)])
        size = max(FEWEST, len(x) // 12)
        blocks = [residual[i : i + size] for i in range(0, len(x) - size + 1, size)]
        spectrum = np.median([autocovariance(block) for block in blocks], axis=0)
        return noise_by(spectrum, len(x))

    def selected(self, solved: _Solved, noise: Noise, most_points: int = 4000, most_knots: int = 40) -> Array:
        """Return the knots over the width, (k + 1,), from 0: intervals are halved, first the one that gains most.

        It ends by the extended Bayesian information criterion; knots that have become needless are removed again. Of
        more than most_points the knots are selected on means of neighbours. A scan without noise has most_knots.

        Args:
            solved: a fit with the position of the apex.
            noise: of the residual, over the width.
            most_points: from which on neighbours are averaged.
            most_knots: number of knots at most.
        """
        away = np.abs(self.x - solved.centre)
        reach, group = float(away.max()), -(-len(away) // most_points)
        order = np.argsort(away)[: len(away) // group * group].reshape(-1, group)
        columns = solved.columns[:, len(solved.form.start) :]
        r, rest, z = away[order].mean(axis=1), columns[order].mean(axis=1), self.z[order].mean(axis=1)
        knots, convex = np.asarray([0.0, reach]), solved.form.convex

        def columns_of(knots: Array) -> Array:
            """Return the derivatives of heights by the slopes at the knots and by the other parameters, (n, p)."""
            return np.hstack([smooth(knots, False).gradient(r, knots), rest])

        while len(knots) < most_knots:
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
        # Of 1, 2, 3 and 4 σ²τ for all removed knots, 3 leaves the fewest rows beyond their bounds for the worn balls of
        # the study `scans`, on the same seeds.
        return _needed(knots, np.column_stack([columns_of(knots), z]), convex, 3.0 * noise.power / group)

    def errors(self, solved: _Solved, noise: Noise) -> tuple[Array, float]:
        """Return drawn errors of the fitted parameters, (draws, k), and the factor from a standard deviation to 95 %.

        Lengths are over the width of the scan; the factor is that of Student's distribution.
        """
        from scipy.special import stdtrit

        points = len(self.x) / noise.together
        free = max(1.0, points - solved.columns.shape[1])
        deviation = math.sqrt(noise.power * max(1.0, points / free))
        exact = solved.parameters[self.fitted(solved.form)]
        return drawn(solved.columns, exact, solved.form.least, deviation), float(stdtrit(free, 0.975))

    def judged(self, solved: _Solved, missed: float) -> Taken:
        """Return the fitted profile in the unit of the scan, with its uncertainties at 95 %.

        Args:
            solved: the fit.
            missed: RMS residual of a named shape beyond that of a smooth curve, over the width.

        Raises:
            ScanError: a fitted apex at the edge of the scan or outside.
        """
        form, parameters, count = solved.form, solved.parameters, len(solved.form.start)
        x, points, size = self.x - solved.centre, len(self.x), self.size
        if self.moves and not is_two_sided(x):
            raise ScanError(
                'its apex would be at the edge of the scan or outside: centre = "auto" needs points on both sides '
                "of it; give centre as a length, or a wider scan"
            )
        noise, reach, spread = noise_in(solved.residual), float(np.abs(x).max()), np.zeros(3)
        off, factor = self.errors(solved, noise)
        spread[self.fitted(form)[count:]] = factor * np.sqrt(np.mean(off[:, count:] ** 2, axis=0))
        theta, (offset, centre, tilt) = parameters[:count], parameters[count:].tolist()
        heights = self.z - offset - tilt * x
        touching = heights < heights.min() + ASPERITY * noise.deviation
        grid = np.linspace(0.0, reach, 200)  # radii whose heights decide which deviations count
        # Bounds bias the mean of a sample: a deviation, too, from 0 to twice the bias.
        bias = np.stack([np.zeros(count), 2.0 * off[:, :count].mean(axis=0)])
        changes = np.concatenate([[bias], factor * independent(off[:, :count], form.gradient(grid, theta))])
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
            autocorrelation=autocovariance(solved.residual)[: points // 4] / max(noise.deviation**2, 1e-300),
            patches=int(np.count_nonzero(np.diff(np.append(0, touching.astype(int))) > 0)),
            missed=size * missed,
        )


def _needed(knots: Array, columns: Array, convex: bool, increase: float) -> Array:
    """Return the knots without needless ones, which are removed one by one; the first and the last one stay.

    Args:
        knots: from 0, (k + 1,).
        columns: derivatives of the heights by the slopes at all knots and by other parameters, and the heights, (n, m).
        convex: whether the slope may only rise.
        increase: of the squared residual by all removed knots together, at most.
    """
    _, upper = np.linalg.qr(columns)

    def squares_of(fewer: Array) -> float:
        """Return the squared residual of a rising curve with fewer knots, which all knots represent exactly."""
        form = smooth(fewer, convex)
        by_theta = form.slope(knots[1:], np.eye(len(form.start)))
        design = np.hstack([upper[:, : len(knots) - 1] @ by_theta, upper[:, len(knots) - 1 : -1]])
        return float(np.sum((upper[:, -1] - design @ bounded(design, upper[:, -1], form.least)) ** 2))

    allowed, kept = squares_of(knots) + increase, knots
    while len(kept) > 2:
        fewer = [np.delete(kept, i) for i in range(1, len(kept) - 1)]
        squares = [squares_of(candidate) for candidate in fewer]
        best = int(np.argmin(squares))
        if squares[best] > allowed:
            break
        kept = fewer[best]
    return kept


@dataclass(frozen=True)
class _Solved:
    """A fitted form; lengths over the width of the scan.

    Attributes:
        form: the shape.
        parameters: θ, z₀, c and t, (k + 3,).
        columns: derivatives of the curve by those that are fitted, (n, m).
        residual: heights less the curve, (n,).
    """

    form: Form
    parameters: Array
    columns: Array
    residual: Array

    @property
    def centre(self) -> float:
        """The position of the apex c, over the width of the scan."""
        return float(self.parameters[-2])

    @property
    def squares(self) -> float:
        """The sum of the squares of the residual, over the width squared."""
        return float(np.sum(self.residual**2))
