"""Friction from the motion of a slide: means over whole periods after the run-in, their errors, and slips.

The momentum P of plate and particles changes by the cantilever's force F_c, the friction F and the drag D of the bath,
which moves with the drive at v:

    ∫ F dt = ∫ F_c dt + D_p ∫ (v − V_p) dt + D_c ∫ (v − V) dt − ΔP

over any time, with V_p, V the velocities of particles and plate. So a mean of F needs no samples of F, which falls
within a timestep or two where the plate slips.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from contact1d.analysis.curve_marks import vertex
from contact1d.analysis.polynomial import Array, divided

FEWEST_PERIODS = 3
"""Periods that a mean of a slide needs: one of the run-in, and two blocks after it."""


@dataclass(frozen=True)
class Mean:
    """A mean over blocks, in the unit of the averaged quantity, such as [FU].

    Attributes:
        blocks: means of the periods after the run-in, shape (n,).
        first: number of periods of the run-in.
        missed: sampling error of the mean.
    """

    blocks: Array
    first: int
    missed: float = 0.0

    @property
    def value(self) -> float:
        """The mean of the blocks, in their unit; the periods of the run-in are not in it."""
        return float(self.blocks.mean())

    @property
    def error(self) -> float:
        """Half of the 95 % interval of the mean plus the sampling error, in the unit of the blocks, ≥ 0."""
        return interval(self.blocks) + self.missed


@dataclass(frozen=True)
class Slip:
    """A jump of the plate into another potential minimum.

    Attributes:
        time: its end [TU].
        place: position of the plate at its begin [LU].
        size: displacement of the plate during it, with its sign [LU].
    """

    time: float
    place: float
    size: float


def block_means(time: Array, integral: Array, period: float, rate: Array | None = None) -> Array:
    """Return the means over whole periods, the last of which ends with the series; shape (periods,), in order.

    It is empty for a series shorter than a period; the part before the first whole period is not used. The integral
    at the end of a period, between two times, is that of Hermite's cubic where the `rate` is known: along a straight
    line the mean of a periodic friction would change from period to period, as they end elsewhere.

    Args:
        time: shape (n,), rising [TU].
        integral: of the averaged quantity, up to each of the times, shape (n,), in its unit times [TU].
        period: [TU].
        rate: the averaged quantity at these times, where it is smooth; shape (n,). None: the integral is interpolated
            linearly.
    """
    count = math.floor((time[-1] - time[0]) / period * (1.0 + 1e-9))
    ends = np.maximum(time[-1] - period * np.arange(count, -1, -1), time[0])
    if rate is None:
        values = np.interp(ends, time, integral)
    else:
        from scipy.interpolate import CubicHermiteSpline  # whose import takes longer than a small run

        values = CubicHermiteSpline(time, integral, rate)(ends)
    return np.asarray(np.diff(values) / period)


def mean_of(blocks: Array) -> Mean:
    """Return the mean after the run-in, in the unit of the blocks, without a sampling error.

    The run-in minimises the error of the mean, half of its 95 % interval. It has one period at least, with the path
    from the start to the first slip, and half of the periods at most.

    Args:
        blocks: means of successive periods, from the start on, shape (n,).

    Raises:
        ValueError: fewer than 3 blocks.
    """
    if blocks.size < FEWEST_PERIODS:
        raise ValueError(f"a mean needs {FEWEST_PERIODS} periods, got {blocks.size}")
    means = [Mean(blocks[first:], first) for first in range(1, blocks.size // 2 + 1)]
    return min(means, key=lambda mean: mean.error)


def sampled_mean(time: Array, force: Array, period: float) -> Mean:
    """Return the mean, with a sampling error, of forces that are known at single times only, with many in a period.

    In a heat bath the balance of momentum that gives the integral of the friction contains the random forces as well, ∫
    ξ dt ~ √(2γkT t): samples may be more accurate. The time of a slip between two samples is off by half of the time
    between them at most: slips at random times add to the scatter of the blocks, slips at the same time in each period
    shift their mean. Such a slip is larger than the step between two samples by the rise of friction in between. So the
    sampling error is half of the largest step of the mean period plus half of its median step, over the number of
    samples in a period.

    Args:
        time: shape (n,), rising [TU].
        force: at these times, shape (n,) [FU].
        period: [TU].

    Raises:
        ValueError: fewer than 3 periods.
    """
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(time))])
    blocks = block_means(time, integral, period)
    mean = mean_of(blocks)
    count = mean.blocks.size
    samples = max(2, round(period / float(np.median(np.diff(time)))))  # in a period
    phases = time[-1] - period * count + period / samples * np.arange(count * samples)
    usual = np.interp(phases, time, force).reshape(count, samples).mean(axis=0)
    steps = np.diff(usual, append=usual[0])
    missed = 0.5 * (float(np.abs(steps).max()) + abs(float(np.median(steps)))) / samples
    return replace(mean, missed=missed)


def standard_error(blocks: Array) -> float:
    """Return the standard error of the mean of blocks, shape (n,), in their unit; of a single block its magnitude.

    Raises IndexError without a block.
    """
    return float(blocks.std(ddof=1)) / math.sqrt(blocks.size) if blocks.size > 1 else abs(float(blocks[0]))


def interval(blocks: Array) -> float:
    """Return half of the 95 % interval of the mean of two or more blocks, shape (n,), in their unit, ≥ 0.

    It is the largest for blocks of one, two and four periods, if four such blocks are left: slips may repeat after
    several periods only; the first periods are left out where their number is no multiple. It is at least half the
    difference of the means of the first and the last half, as of a slow drift.
    """
    widest, together, most = 0.0, 1, 4
    while together == 1 or (together <= most and blocks.size // together >= most):
        whole = blocks[blocks.size % together :]
        means = whole.reshape(whole.size // together, together).mean(axis=1)
        widest = max(widest, student(means.size - 1) * standard_error(means))
        together *= 2
    half = blocks.size // 2
    drift = 0.5 * abs(float(blocks[-half:].mean() - blocks[:half].mean()))
    return max(widest, drift)


def student(freedom: int) -> float:
    """Return the half-width of the 95 % interval of Student's distribution over the standard error, for `freedom` ≥ 1.

    Up to nine degrees of freedom it is tabulated; beyond it is Fisher's expansion in 1/freedom (Abramowitz and Stegun
    26.7.5), which begins with the normal distribution.
    """
    exact = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26)
    if freedom <= len(exact):
        return exact[freedom - 1]
    return sum(term / float(freedom) ** power for power, term in enumerate((1.95996, 2.37227, 2.82250, 2.55585)))


def slips(
    time: Array, position: Array, spacing: float, velocity: float, faster: float = 2.0, least: float = 0.45
) -> list[Slip]:
    """Return the slips of a plate in order of time: across a barrier, or from a barrier into a minimum.

    A slip is an uninterrupted motion faster, in either direction, than `faster` times the drive, and longer than
    `least` spacings; one that goes on at the end of the series counts as far as it came. Empty without one. At high
    drag the plate slows down on the barrier itself, wherever that is: a slip has no given position.

    Args:
        time, position: of the plate, shape (n,) [TU], [LU].
        spacing: of the other body [LU].
        velocity: of the drive [LU/TU], of either sign.
        faster: velocity of the plate over that of the drive, at least.
        least: length of a slip over the spacing; at the threshold of stick-slip the plate passes a barrier as fast over
            0.33 of it.
    """
    quick = np.abs(np.diff(position)) > faster * abs(velocity) * np.diff(time)
    borders = np.flatnonzero(np.diff(quick.astype(int), prepend=0, append=0)).reshape(-1, 2)
    moves = (
        Slip(float(time[end]), float(position[start]), float(position[end] - position[start])) for start, end in borders
    )
    return [slip for slip in moves if abs(slip.size) > least * spacing]


def largest_before(friction: Array, position: Array, spacing: float) -> tuple[float, float]:
    """Return the largest friction [FU] until the plate has moved by one period, and its sampling error ≥ 0 [FU].

    Friction counts with its sign, at points less than `spacing` beyond the first one in +x. The friction rises smoothly
    until the plate slips: the error is the rise from the point before, less the rise before that, but an eighth of it
    at least; the whole rise where the largest is the second or the last point, and 0 where it is the first. Over the
    top of a barrier that the plate passes without a slip friction is a smooth function of the position: its maximum is
    that of the polynomial through five points, with the difference to that through three as its error.

    Args:
        friction: shape (n,) [FU].
        position: of the plate, shape (n,) [LU].
        spacing: of the other body, the period [LU].
    """
    before = position - position[0] < spacing
    top = int(np.argmax(np.where(before, friction, -np.inf)))
    if (summit := _summit(friction, position, top)) is not None:
        return summit
    missed = float(friction[top] - friction[top - 1]) if top > 0 else 0.0
    if 1 < top < friction.size - 1:
        missed = min(missed, max(missed - float(friction[top - 1] - friction[top - 2]), 0.125 * missed))
    return float(friction[top]), abs(missed)


def _summit(
    friction: Array, position: Array, top: int, neighbours: int = 2, largest_ratio: float = 2.0
) -> tuple[float, float] | None:
    """Return friction at a smooth maximum near the point `top`, and its uncertainty; None where it is not smooth.

    Both are in the unit of `friction`. None, too, where positions do not rise, where there are too few points on a
    side, or where the curvature of friction over position is not negative everywhere. Where a slip begins the points
    lie so far apart that the ratio of the largest to the smallest curvature is many times as large as the limit.

    Args:
        friction, position: shape (n,) each.
        top: index of the largest friction.
        neighbours: points on each side through which the polynomial goes.
        largest_ratio: of the largest curvature to the smallest.
    """
    near = slice(top - neighbours, top + neighbours + 1)
    x, y = position[near], friction[near]
    if top < neighbours or x.size < 2 * neighbours + 1 or not (np.diff(x) > 0.0).all():
        return None
    _, bends, *_ = divided(x, y)
    if bends.min() < largest_ratio * bends.max():  # or one of them is not below 0
        return None
    (_, largest), (_, coarse) = (vertex(position, friction, top, count) for count in (neighbours, neighbours - 1))
    return largest, abs(largest - coarse)
