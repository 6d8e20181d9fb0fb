"""The profile fitted to a scan of a body of revolution, with its tilt, offset and apex, and its uncertainty.

    z(x) = f(|x − c|; θ) + t (x − c) + z₀ + noise

with the apex at c, the tilt t and the offset z₀. The shape f has f(0) = 0 and rises. Its parameters θ are those of a
named shape, or of a smooth curve the slopes f′ ≥ 0 at knots, linear between them and 0 on the axis. All are fitted
together by least squares, so that both sides of a scan determine f, and their covariance is known. The noise may be
correlated: n points are worth n/τ independent ones, τ = 1 + 2 Σ ρ_k of the residual's autocorrelation ρ. Of a smooth
curve without given knots these are drawn (`analysis.knots`): it is the mean of many curves, with knots and corners at
many radii, each as often as it is likely under the noise, and their scatter is its uncertainty.

Lengths have any one unit.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.form import Array, Form, ShapeName, named, smooth
from contact1d.analysis.knots import Candidates, Curves
from contact1d.analysis.residual import Noise, autocovariance, bounded, drawn, independent, noise_in
from contact1d.analysis.scan import ASPERITY, ScanError, Taken, is_two_sided, one_pass, pitch_of, require_rising

FEWEST = 8
"""Points that a scan needs."""
PER_KNOT = 4
"""Points that an interval between two knots needs."""
FIRST_KNOTS = 24
"""Intervals of the curve whose residual is the first estimate of the noise: more than any shape needs off its kinks."""
FLAT = 'shows no curvature beyond the noise: give a wider scan, or write kind = "flat_punch"'
"""The message of a scan whose noise conceals its shape."""


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
        centre: position of the apex; None: it is fitted.
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
    require_rising(x, z)
    nearest, most = 0.0 if centre is None else float(np.abs(x - centre).min()), FEWEST * pitch_of(x)
    if shape is None and nearest > most:
        raise ScanError(
            f"has no points within {nearest:.4g} LU of its apex, where at most {most:.4g} LU are allowed: give its "
            'centre, or "auto", or a fit'
        )
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
        start = self.inside(-0.5 * linear / square)
        reach = float(np.abs(self.x - start).max())
        if self.moves and self.tilts:
            self.require_flat_part(reach, start)
        # Only the residual of a smooth curve counts beside a named shape.
        free = self.smoothed(reach, start, None if shape else length, (200,) if shape else (200, 200, 800))
        self.require_curvature(free)
        if shape:
            solved = self.solve(named(shape, max(2.0 * float(square), 1e-6)), start)
            return self.judged(solved, self.excess(solved, free))
        return self.judged(free, 0.0)

    def inside(self, centre: float) -> float:
        """Return the position of the apex over the width: the nearest one to `centre` in the scan; 0 if it is given."""
        return float(np.clip(centre, self.x[0], self.x[-1])) if self.moves else 0.0

    def require_curvature(self, solved: _Solved, deviations: float = 6.0) -> None:
        """Raise ScanError where a fitted curve is no better than a straight line, by the noise of the scan.

        The line is level unless apex or tilt are fitted.

        Args:
            solved: the fitted curve.
            deviations: by how many standard deviations the curvature must differ from 0.
        """
        straight = np.polynomial.polynomial.polyfit(self.x, self.z, int(self.moves or self.tilts))
        residual = self.z - np.polynomial.polynomial.polyval(self.x, straight)
        if float(np.sum(residual**2)) - solved.squares < deviations**2 * self.noise_of(solved).power:
            raise ScanError(FLAT)

    def excess(self, shape: _Solved, smooth_curve: _Solved) -> float:
        """Return the RMS residual of a named shape beyond that of a smooth curve, over the width of the scan.

        It is the root of the difference of their mean squares, 0 where that may be chance.
        """
        more, count = shape.squares - smooth_curve.squares, smooth_curve.count
        price = self.noise_of(smooth_curve).price(len(self.x), count)
        return math.sqrt(more / len(self.x)) if more > price * count else 0.0

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

    def smoothed(self, reach: float, start: float, length: float | None, draws: Sequence[int]) -> _Solved:
        """Return the fitted smooth curve: its slope rises from the apex on, unless the scan shows a fall of the slope.

        Args:
            reach: largest distance of a point from the apex, over the width of the scan.
            start: position of the apex to begin with, over the width.
            length: distance of the knots over the width; None: by the noise.
            draws: number of curves by the noise, in each pass.
        """
        if length is None:
            return self.averaged(reach, start, draws)
        knots = np.linspace(0.0, reach, 1 + max(1, round(reach / length)))
        convex, free = (self.solve(smooth(knots, rises), start) for rises in (True, False))
        price = self.noise_of(free).price(len(self.x), free.count)
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
            parameters[-2] = self.inside(parameters[-2])
        return self.solved(form, parameters)

    def solved(self, form: Form, parameters: Array, curves: Curves | None = None) -> _Solved:
        """Return the fit of a form with its parameters θ, z₀, c and t, (k + 3,); `curves`: whose mean it is."""
        curve, columns = self.design(form, parameters)
        return _Solved(form, parameters, columns[:, self.fitted(form)], self.z - curve, curves)

    def averaged(self, reach: float, centre: float, draws: Sequence[int]) -> _Solved:
        """Return the mean of the curves with drawn knots.

        Candidates are dense at the apex, and after each pass denser around knots that half of the curves have.

        Args:
            reach: largest distance of a point from the apex, over the width of the scan.
            centre: position of the apex to begin with, over the width.
            draws: number of curves in each pass, with the noise, apex and candidates of the one before.
        """
        pitch = pitch_of(self.x)
        first = min(FIRST_KNOTS, max(2, round(reach / pitch / PER_KNOT)))
        solved = self.solve(smooth(np.linspace(0.0, reach, first + 1), False), centre)
        knots = np.linspace(0.0, 1.0, PER_KNOT * FIRST_KNOTS + 1) ** 2
        knots = knots[(knots == 0.0) | (knots > min(0.5, PER_KNOT * pitch / reach))]
        start = knots[::-PER_KNOT]
        for seed, count in enumerate(draws):
            reach = float(np.abs(self.x - solved.centre).max())
            chosen = np.isin(knots, start)
            chosen[0] = True
            curves = self.candidates(solved, knots * reach).drawn(chosen, seed, count)
            start, sure = (
                (radii / reach).astype(np.float32) for radii in (curves.last, curves.knots[curves.shares > 0.5][1:-1])
            )
            near = np.searchsorted(knots, sure).clip(1, len(knots) - 2)
            finer = [np.linspace(knots[i - 1], knots[i + 1], 2 * PER_KNOT + 1) for i in near]
            knots = np.unique(np.concatenate([knots, *finer]).astype(np.float32)).astype(np.float64)
            solved = self.mean_of(curves)
        return solved

    def candidates(self, solved: _Solved, knots: Array) -> Candidates:
        """Return the least squares of curves with any of the radii over the width as knots.

        `solved`: a fit with the position of the apex and the noise.
        """
        nuisance, round_off = solved.columns[:, len(solved.form.start) :], (1e-10 * float(self.z.max())) ** 2
        heights = self.z + nuisance[:, 1:2].sum(axis=1) * solved.centre * self.moves
        power = max(round_off, self.noise_of(solved).power)
        return Candidates.of(knots, np.abs(self.x - solved.centre), heights, nuisance, power)

    def mean_of(self, curves: Curves) -> _Solved:
        """Return the mean of curves as a fit."""
        form = smooth(curves.knots, curves.convex)
        count, fitted = len(form.start), self.fitted(form)
        parameters = np.zeros(len(fitted))
        parameters[fitted] = curves.mean
        if form.convex:
            parameters[:count] = np.diff(parameters[:count], prepend=0.0)
        parameters[-2] = self.inside(parameters[-2])
        return self.solved(form, parameters, curves)

    def noise_of(self, solved: _Solved) -> Noise:
        """Return the noise, over the width, by the difference of both sides; for one side by the residual.

        The difference does not depend on the shape; what parameters have taken of the noise is added. A point on the
        right has its partner nearest to its mirror image: between points interpolated noise would be smaller.
        """
        from scipy.interpolate import interp1d

        x, residual, count = self.x - solved.centre, solved.residual, solved.count
        if is_two_sided(x):
            right = x > 0.0
            left = interp1d(-x[::-1], residual[::-1], kind="nearest", bounds_error=False)(x[right])
            residual, count = (residual[right] - left) / math.sqrt(2.0), self.moves + self.tilts
            residual = residual[np.isfinite(residual)]
        noise = noise_in(residual)
        share = min(0.5, count * noise.together / len(residual))
        return replace(noise, deviation=noise.deviation / math.sqrt(1.0 - share))

    def errors(self, solved: _Solved, noise: Noise) -> tuple[Array, float]:
        """Return drawn errors of the fitted parameters, (draws, k), and the factor from a standard deviation to 95 %.

        Lengths are over the width of the scan; the factor is that of Student's distribution.
        """
        from scipy.special import stdtrit

        if solved.curves:
            sample = np.hstack([solved.curves.slopes, solved.curves.nuisance])
            return sample - sample.mean(axis=0), float(stdtrit(math.inf, 0.975))
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
        noise = self.noise_of(solved) if solved.curves else noise_in(solved.residual)
        reach = float(np.abs(x).max())
        off, factor = self.errors(solved, noise)
        spread = np.zeros(3)
        spread[self.fitted(form)[count:]] = factor * np.sqrt(np.mean(off[:, count:] ** 2, axis=0))
        theta, (offset, centre, tilt) = parameters[:count], parameters[count:].tolist()
        heights = self.z - offset - tilt * x
        touching = heights < heights.min() + ASPERITY * noise.deviation
        covariance = autocovariance(solved.residual)
        grid = np.linspace(0.0, reach, 200)  # radii whose heights decide which deviations count
        if solved.curves and form.knots is not None:
            deviations = solved.curves.deviations(smooth(form.knots, False).gradient(grid, theta))
        else:
            # Bounds bias the mean of a sample: a deviation, too, from 0 to twice the bias.
            bias = np.stack([np.zeros(count), 2.0 * off[:, :count].mean(axis=0)])
            changes = np.concatenate([[bias], factor * independent(off[:, :count], form.gradient(grid, theta))])
            deviations = form.shown(theta + changes)
        if not deviations[..., 0 if form.knots is None else -1].all():
            raise ScanError(FLAT)
        knots = np.zeros(0) if form.knots is None else size * form.knots
        numbers = solved.curves.counts if solved.curves else np.asarray([len(knots)])
        return Taken(
            shape=form.name,
            parameters=form.shown(theta) * size**form.powers,
            knots=knots,
            counts=(int(numbers.min()), int(numbers.max())),
            deviations=deviations * size**form.powers,
            centre=(self.origin + size * centre, size * spread[1]),
            tilt=(tilt, spread[2]),
            offset=(self.base + size * offset, size * spread[0]),
            reach=size * reach,
            noise=size * noise.deviation,
            correlation=size * 0.5 * (noise.together - 1.0) * pitch_of(x),
            x=size * x,
            heights=size * heights,
            residual=size * solved.residual,
            autocorrelation=covariance[: points // 4] / max(float(covariance[0]), 1e-300),
            patches=int(np.count_nonzero(np.diff(np.append(0, touching.astype(int))) > 0)),
            missed=size * missed,
        )


@dataclass(frozen=True)
class _Solved:
    """A fitted form; lengths over the width of the scan.

    Attributes:
        form: the shape.
        parameters: θ, z₀, c and t, (k + 3,).
        columns: derivatives of the curve by those that are fitted, (n, m).
        residual: heights less the curve, (n,).
        curves: whose mean it is; None of a single curve.
    """

    form: Form
    parameters: Array
    columns: Array
    residual: Array
    curves: Curves | None = None

    @property
    def count(self) -> int:
        """The number of parameters of the shape; of a mean of curves the mean number of their knots but 0."""
        return round(float(self.curves.counts.mean())) - 1 if self.curves else len(self.form.start)

    @property
    def centre(self) -> float:
        """The position of the apex c, over the width of the scan."""
        return float(self.parameters[-2])

    @property
    def squares(self) -> float:
        """The sum of the squares of the residual, over the width squared."""
        return float(np.sum(self.residual**2))
