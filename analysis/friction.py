"""Friction from the motion of a slide: means over whole periods after the run-in, their errors, slips, energies.

The momentum of what moves, P, changes by the cantilever's force F_c, the friction F and the drag D of its bath, which
goes with the drive at v:

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

STUDENT = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26)
"""Half-widths of 95 % of Student's distribution with 1, 2, … degrees of freedom, over the standard error."""
BEYOND = (1.95996, 2.37227, 2.82250, 2.55585)
"""Beyond the list: coefficients of the powers of 1/freedom. The first is that of a normal distribution (Fisher's
expansion of the quantile: Abramowitz and Stegun 26.7.5)."""
FEWEST_BLOCKS = 2
"""Periods that a mean needs after the run-in."""
DROPPED = 1
"""Periods that always belong to the run-in: they hold the path from the start to the first slip."""
FEWEST_PERIODS = DROPPED + FEWEST_BLOCKS
"""That a slide needs for a mean."""
MOST_PAIRED = 4
"""Periods that may be one block, if that leaves so many blocks: slips may repeat after several periods only."""
FASTER = 2.0
"""Velocity of the plate over that of the drive above which it may slip."""
BESIDE, EVEN = 2, 2.0
"""Rows on each side of a smooth top, and the ratio of the largest to the smallest curvature of friction over position
about it: where a slip begins the rows lie so far apart that it is many times as large."""
LONG = 0.45
"""Way over the spacing that it makes of it: at the threshold of stick-slip it passes a barrier as fast over 0.33."""


@dataclass(frozen=True)
class Mean:
    """A mean over blocks.

    Attributes:
        blocks: that it is over, shape (n,).
        first: how many before them are the run-in.
        missed: sampling error of each.
    """

    blocks: Array
    first: int
    missed: float = 0.0

    @property
    def value(self) -> float:
        """The mean."""
        return float(self.blocks.mean())

    @property
    def error(self) -> float:
        """Half of its interval of 95 %, and what is missed."""
        return interval(self.blocks) + self.missed


@dataclass(frozen=True)
class Slip:
    """A jump of the plate into another potential minimum: its end [TU], its position and its size [LU]."""

    time: float
    place: float
    size: float


def block_means(time: Array, integral: Array, period: float, rate: Array | None = None) -> Array:
    """Means over whole periods, the last of which ends with the series; shape (periods,).

    A period that ends within a row has the part of it of Hermite's cubic, whose slopes at the row's ends are known:
    along a straight line the mean of a friction that swings would change from period to period, as they end elsewhere.

    Args:
        time: shape (n,), rising [TU].
        integral: of what is averaged, up to each of the times, shape (n,).
        period: [TU].
        rate: of the integral at these times, what is averaged itself, where it is smooth; shape (n,).
    """
    count = math.floor((time[-1] - time[0]) / period * (1.0 + 1e-9))
    ends = np.maximum(time[-1] - period * np.arange(count, -1, -1), time[0])
    if rate is None:
        at = np.interp(ends, time, integral)
    else:
        from scipy.interpolate import CubicHermiteSpline  # whose import takes longer than a small run

        at = CubicHermiteSpline(time, integral, rate)(ends)
    return np.asarray(np.diff(at) / period)


def mean_of(blocks: Array) -> Mean:
    """The mean after the run-in; the run-in minimises the standard error of the rest, at most half of the blocks.

    Raises:
        ValueError: fewer than FEWEST_PERIODS blocks.
    """
    if blocks.size < FEWEST_PERIODS:
        raise ValueError(f"a mean needs {FEWEST_PERIODS} periods, got {blocks.size}")
    means = [Mean(blocks[first:], first) for first in range(DROPPED, blocks.size // 2 + 1)]
    return min(means, key=lambda mean: mean.error)


def sampled_mean(time: Array, force: Array, period: float) -> Mean:
    """The mean of forces that are known at single times only, shape (n,), with many in a period.

    In a heat bath the random forces, ∫ ξ dt ~ √(2γkT t), are no part of the friction, but of the balance that
    gives its integral: samples may know it better. A slip between two is missed by half of the time between at most:
    slips at random times are in the scatter of the blocks, those that come at the same time in each are in their mean.
    Such a slip is larger than the step between two samples by what the friction rises by in the meantime.

    Raises:
        ValueError: see `mean_of`.
    """
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(time))])
    blocks = block_means(time, integral, period)
    mean = mean_of(blocks)
    count = mean.blocks.size
    each = max(2, round(period / float(np.median(np.diff(time)))))
    phases = time[-1] - period * count + period / each * np.arange(count * each)
    usual = np.interp(phases, time, force).reshape(count, each).mean(axis=0)
    steps = np.diff(usual, append=usual[0])
    missed = 0.5 * (float(np.abs(steps).max()) + abs(float(np.median(steps)))) / each
    return replace(mean, missed=missed)


def standard_error(blocks: Array) -> float:
    """Of the mean of blocks, shape (n,), by their scatter; a single one, of which that says nothing, may be chance."""
    return float(blocks.std(ddof=1)) / math.sqrt(blocks.size) if blocks.size > 1 else abs(float(blocks[0]))


def interval(blocks: Array) -> float:
    """Half of the interval of 95 % of the mean of blocks, the largest for blocks of one, two and four of them.

    Not below half the difference of the means of both halves, which a slow drift leaves.
    """
    found, together = 0.0, 1
    while together == 1 or (together <= MOST_PAIRED and blocks.size // together >= MOST_PAIRED):
        whole = blocks[blocks.size % together :]
        means = whole.reshape(whole.size // together, together).mean(axis=1)
        found = max(found, student(means.size - 1) * standard_error(means))
        together *= 2
    half = blocks.size // 2
    drift = 0.5 * abs(float(blocks[-half:].mean() - blocks[:half].mean()))
    return max(found, drift)


def student(freedom: int) -> float:
    """Half-width of 95 % of Student's distribution over the standard error."""
    if freedom <= len(STUDENT):
        return STUDENT[freedom - 1]
    return sum(coefficient / float(freedom) ** power for power, coefficient in enumerate(BEYOND))


def slips(time: Array, place: Array, spacing: float, velocity: float) -> list[Slip]:
    """Where a plate moves FASTER than the drive over a LONG distance: across a barrier, or from one into a minimum.

    With much drag it slows down on the barrier itself, wherever that is: no position is asked for.

    Args:
        time, place: of the plate, shape (n,) [TU], [LU].
        spacing: of the other body [LU].
        velocity: of the drive [LU/TU].
    """
    quick = np.abs(np.diff(place)) > FASTER * abs(velocity) * np.diff(time)
    borders = np.flatnonzero(np.diff(quick.astype(int), prepend=0, append=0)).reshape(-1, 2)
    found = (Slip(float(time[end]), float(place[start]), float(place[end] - place[start])) for start, end in borders)
    return [slip for slip in found if abs(slip.size) > LONG * spacing]


def largest_before(friction: Array, place: Array, spacing: float) -> tuple[float, float]:
    """(largest friction [FU] until the plate has moved by one period, its sampling error [FU]).

    The friction rises smoothly up to where the plate slips: what is missed is less than what the row before rose by.
    Over the top of a barrier that the plate passes without a slip it is a smooth function of the place, and its largest
    value lies between the rows: on the polynomial through five of them, known to what three make another of it.
    """
    before = place - place[0] < spacing
    top = int(np.argmax(np.where(before, friction, -np.inf)))
    if (summit := _summit(friction, place, top)) is not None:
        return summit
    missed = float(friction[top] - friction[top - 1]) if top > 0 else 0.0
    if 1 < top < friction.size - 1:
        missed = min(missed, max(missed - float(friction[top - 1] - friction[top - 2]), 0.125 * missed))
    return float(friction[top]), abs(missed)


def _summit(friction: Array, place: Array, top: int) -> tuple[float, float] | None:
    """(largest value between the rows about a smooth top, its uncertainty); None where the rows show no smooth top."""
    near = slice(top - BESIDE, top + BESIDE + 1)
    x, y = place[near], friction[near]
    if top < BESIDE or x.size < 2 * BESIDE + 1 or not (np.diff(x) > 0.0).all():
        return None
    _, bends, *_ = divided(x, y)
    if bends.min() < EVEN * bends.max():  # or one of them is not below 0
        return None
    (_, largest), (_, coarse) = (vertex(place, friction, top, beside) for beside in (BESIDE, BESIDE - 1))
    return largest, abs(largest - coarse)
