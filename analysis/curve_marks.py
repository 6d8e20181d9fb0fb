"""Marks of a curve F(d): its crossings of a force, its force maximum, and the hysteresis of a closed path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from contact1d.analysis.polynomial import Array, divided, lowest_minimum, real_roots, through, value


@dataclass(frozen=True)
class Peak:
    """The force maximum of a sampled curve, tension positive.

    Attributes:
        index: the highest sampled point, from 0.
        tension: at that point [FU]; below 0 where all points are under compression.
        uncertainty: the sampling error of `smooth` [FU]; |tension| where the highest point is the first or the last.
        smooth: the tension at the vertex of the polynomial through the point and its neighbours [FU]; that of the point
            at an end of the curve, or where it jumps.
        position: the displacement of the vertex [LU]; of the sampled point at an end of the curve, or where it jumps.
        misplaced: distance of `position` from the vertex of another polynomial [LU]; with one point only on a side,
            from the sampled point; 0 at an end or where the curve jumps.
    """

    index: int
    tension: float
    uncertainty: float
    smooth: float
    position: float
    misplaced: float


WIDEST_REACH = 3
"""Samples on either side of the highest one under the widest polynomial."""


def largest_tension(displacement: Sequence[float], force: Sequence[float]) -> Peak:
    """Return the largest tension −F of an unloading branch, with its position and sampling errors.

    Of equal tensions the first counts. Between samples the maximum of a smooth curve is that of the polynomial through
    five points; the polynomial through three estimates its error, and the one through seven, or else three, the error
    of its position. With one point only beside the maximum on one side it is the parabola through three points,
    compared with the sampled point. Where a particle snaps after the maximum, tension rises right up to the snap, no
    faster than before the sampled point: the sampled point is then the position, and the rise up to the next point the
    largest sampling error. At an end of the curve it is the point itself, with |tension| as the error.

    Args:
        displacement: falling, (n,) [LU].
        force: compression positive, (n,) [FU].
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    i = int(np.argmax(tension))
    top = float(tension[i])
    if i == 0 or i == len(tension) - 1:
        return Peak(i, top, abs(top), top, float(d[i]), 0.0)
    rise, fall = top - tension[i - 1], top - tension[i + 1]
    even = rise / max(d[i - 1] - d[i], 1e-300), fall / max(d[i] - d[i + 1], 1e-300)
    jump_ratio = 3.0  # a drop after the maximum over the rise before it, above which it is an instability
    if even[1] > jump_ratio * even[0] + jump_ratio * abs(_bend(d, tension, i)):
        return Peak(i, top, float(even[0] * (d[i] - d[i + 1])), top, float(d[i]), 0.0)
    # A search that returns to the maximum leaves points too near to it for a polynomial.
    d, tension, highest = _apart_from(d, tension, i)
    compared, coarse = vertex(d, tension, highest, 1)
    if not 2 <= highest < len(d) - 2:
        return Peak(i, top, abs(coarse - top), coarse, compared, abs(compared - float(d[highest])))
    position, smooth = vertex(d, tension, highest, 2)
    if WIDEST_REACH <= highest < len(d) - WIDEST_REACH:
        compared, _ = vertex(d, tension, highest, WIDEST_REACH)
    return Peak(i, top, abs(smooth - coarse), smooth, position, abs(position - compared))


def _apart_from(d: Array, tension: Array, i: int) -> tuple[Array, Array, int]:
    """Return displacements and tensions without samples that nearly coincide with the inner one i, and its new index.

    Left out are samples nearer to i than 1e-3 of the distance between the third sample before it and the third after it
    (the first or the last one, where there are fewer). The first and the last sample stay. The residual ε of two
    samples makes a slope of ε over their distance: over that distance of six samples 1000 ε at most.

    Args:
        d, tension: displacements, falling, and tensions, (n,).
        i: index of the sample.
    """
    width = float(d[max(i - WIDEST_REACH, 0)] - d[min(i + WIDEST_REACH, len(d) - 1)])
    kept = np.abs(d - d[i]) > 1e-3 * width
    kept[[0, i, -1]] = True
    return d[kept], tension[kept], int(kept[:i].sum())


def _about(x: Array, y: Array, middle: int, neighbours: int) -> tuple[float, Array] | None:
    """Return the width of the samples about one, and coefficients of the polynomial through them, lowest power first.

    None where two neighbours are within 1e-5 of the width. The variable of the polynomial is (x − x[middle])/width, its
    value y − y[middle].

    Args:
        x, y: positions and values, (n,).
        middle: index of the sample.
        neighbours: samples on each side; fewer at the ends.
    """
    near = slice(max(middle - neighbours, 0), middle + neighbours + 1)
    if not are_apart(x[near]):
        return None
    width = float(np.ptp(x[near]))
    return width, through((x[near] - x[middle]) / width, y[near] - y[middle])


def vertex(x: Array, y: Array, highest: int, neighbours: int) -> tuple[float, float]:
    """Return position and value of the maximum of the polynomial through the highest of samples and its neighbours.

    It lies between the next two; where samples are too near (within 1e-5 of their width), or the polynomial has no
    higher maximum there, it is the sample itself.

    Args:
        x, y: positions, rising or falling, and values, (n,).
        highest: index of the highest sample, neither the first nor the last.
        neighbours: samples on either side that the polynomial goes through.
    """
    position, top = float(x[highest]), float(y[highest])
    if (polynomial := _about(x, y, highest, neighbours)) is None:
        return position, top
    width, rise = polynomial
    low, high = sorted(float(x[highest + side] - x[highest]) / width for side in (-1, 1))
    best, _ = lowest_minimum(-rise, low, high)
    above = value(rise, best)
    return (position + width * best, top + above) if above > 0.0 else (position, top)


def promised(displacement: Sequence[float], force: Sequence[float], positions: Sequence[float]) -> Array:
    """Return the tension [FU] that samples of a curve let expect at positions [LU] near its largest tension, (m,).

    It is −F, that of the polynomial through the largest tension and two points on each side, where there are as many.
    All are NaN where the largest is at the first or last point, or points are within 1e-5 of their width.

    Args:
        displacement: falling, (n,) [LU].
        force: compression positive, (n,) [FU].
        positions: (m,) [LU].
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    i = int(np.argmax(tension))
    if 0 < i < len(d) - 1:
        d, tension, highest = _apart_from(d, tension, i)
        if (polynomial := _about(d, tension, highest, 2)) is not None:
            width, rise = polynomial
            return np.asarray([tension[highest] + value(rise, (x - d[highest]) / width) for x in positions])
    return np.full(len(positions), np.nan)


def rivals(displacement: Sequence[float], force: Sequence[float], peak: Peak) -> dict[int, float]:
    """Return by how much each other maximum of the tension may exceed the peak [FU], by the index of its highest point.

    A negative number: it can't exceed it. The peak is the tension at its vertex. Empty without other maxima; the first
    and the last point are none. Beyond its highest point the tension rises no faster than up to it, and at most as far
    as the next point; between the highest point and the one before, no faster than up to the latter.

    Args:
        displacement: falling, (n,) [LU].
        force: compression positive, (n,) [FU].
        peak: the force maximum that they are compared with.
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    inner = np.arange(1, len(tension) - 1)
    teeth = inner[(tension[inner] > tension[inner - 1]) & (tension[inner] >= tension[inner + 1])]
    rise = np.diff(tension) / -np.diff(d)
    excess = {}
    for i in teeth[teeth != peak.index]:
        top = tension[i] + rise[i - 1] * (d[i] - d[i + 1])
        if i > 1:
            top = max(top, tension[i - 1] + rise[i - 2] * (d[i - 1] - d[i]))
        excess[int(i)] = float(top) - peak.smooth
    return excess


def are_apart(d: Array) -> bool:
    """Return whether all neighbours of d, (n,), n ≥ 2, are farther apart than 1e-5 of its width.

    False where all are equal; a polynomial through nearer points would be mostly round-off.
    """
    return float(np.abs(np.diff(d)).min()) > 1e-5 * float(np.ptp(d))


def _bend(d: Array, tension: Array, i: int) -> float:
    """Return the change of slope [FU/LU] of a smooth curve over both increments about point i, from those before it.

    0 with fewer than two points before, or where these are at the same displacement.

    Args:
        d, tension: displacements [LU], falling, and tensions [FU], (n,).
        i: index of the point, not the last.
    """
    if i < 2 or d[i - 2] == d[i - 1]:
        return 0.0
    before = slice(i - 2, i + 1)
    _, bend = divided(d[before], tension[before])
    return float(bend[0] * (d[i + 1] - d[i - 1]))


def crossing(displacement: Sequence[float], force: Sequence[float], level: float) -> tuple[int, float]:
    """Return i and the displacement [LU] of the first crossing of `level` [FU], linear between points i and i + 1.

    A point at the level itself counts as a crossing. Crossings in both directions count.

    Args:
        displacement, force: (n,) [LU] and (n,) [FU].
        level: [FU], compression positive as the force.

    Raises:
        ValueError: if the curve never crosses the level.
    """
    over = np.asarray(force) - level
    crossed = np.flatnonzero(over[:-1] * over[1:] <= 0.0)
    if not crossed.size:
        raise ValueError(f"the force never passes {level:.4g} FU")
    i = int(crossed[0])
    part = over[i] / (over[i] - over[i + 1]) if over[i] else 0.0
    return i, float(displacement[i] + part * (displacement[i + 1] - displacement[i]))


def smooth_crossing(displacement: Sequence[float], force: Sequence[float], level: float) -> float:
    """Return the displacement [LU] of the first crossing of `level` [FU].

    It is that of the cubic through two points on each side; at an end of the curve, where points are within 1e-5 of the
    width, and where the cubic does not cross exactly once between the two inner points, as near a jump, that of the
    straight line.

    Args:
        displacement, force: (n,) [LU] and (n,) [FU].
        level: [FU], compression positive as the force.

    Raises:
        ValueError: if the curve never crosses the level.
    """
    index, linear = crossing(displacement, force, level)
    if not 1 <= index < len(force) - 2:
        return linear
    d = np.asarray(displacement[index - 1 : index + 3])
    if not are_apart(d):
        return linear
    over = np.asarray(force[index - 1 : index + 3]) - level
    x = (d - d[1]) / (d[2] - d[1])
    inside = real_roots(through(x, over), 0.0, 1.0)
    return float(d[1] + inside[0] * (d[2] - d[1])) if len(inside) == 1 else linear


def tops(tension: list[float], fall: float) -> list[int]:
    """Return the indices, ascending, of maxima after which values fall by more than `fall` before they rise above them.

    `fall` has the unit of the values. After such a fall the next maximum is sought once values have risen by more than
    `fall` from the lowest one since. The first value may be a maximum, the last never. Empty where they never fall that
    far, or without values.
    """
    maxima: list[int] = []
    high = low = 0
    for i, force in enumerate(tension):
        if force > tension[high]:
            high = low = i
        elif force < tension[low]:
            low = i
            if tension[high] - force > fall and (not maxima or maxima[-1] != high):
                maxima.append(high)
        elif maxima and maxima[-1] == high and force - tension[low] > fall:
            high = low = i
    return maxima


CLOSURE = 1e-9
"""Difference of two displacements over the width of the path up to which they are equal: round-off."""


@dataclass(frozen=True)
class Work:
    """The work along a path.

    Attributes:
        area: ∫ F dd [FU·LU], by the trapezoidal rule, F compression positive and d positive in approach; of a closed
            path the dissipated energy.
        uncertainty: of the area, by interpolation of F between load steps, ≥ 0 [FU·LU].
        whole: ∫ |F| |dd| ≥ 0 [FU·LU].
    """

    area: float
    uncertainty: float
    whole: float


def work_of(displacement: Sequence[float], force: Sequence[float]) -> Work | None:
    """Return the work along a path through points, (n,) [LU] and (n,) [FU].

    None with fewer than 3, or where nothing moves. It is ∫ F dd by the trapezoidal rule, F compression positive, d
    positive in approach, with its uncertainty and ∫ |F| |dd|. Between two points a smooth curve
    departs from its chord by h³F″/12, F″ from the chords before and after. Where the chord's slope is not the mean of
    these two, the force may have jumped, anywhere between the points: that part of its change may count for half of the
    increment h more or less. An unloading through the same displacements has the same error as the loading, so that
    only the difference of the two counts.
    """
    d, f = np.asarray(displacement, dtype=np.float64), np.asarray(force, dtype=np.float64)
    round_off = CLOSURE * float(np.ptp(d))
    if round_off == 0.0 or len(d) < 3:
        return None
    h, mean = np.diff(d), 0.5 * (f[1:] + f[:-1])
    half = len(d) // 2
    if np.abs(d - d[::-1]).max() <= round_off and (np.diff(np.sign(h)) != 0.0).sum() == 1:
        uncertainty = _missed(np.abs(h[:half]), np.diff(f[: half + 1] - f[half:][::-1]))
    else:
        turns = np.flatnonzero(np.diff(np.sign(h)) != 0.0) + 1
        legs = [leg for leg in np.split(np.arange(len(h)), turns) if h[leg[0]] != 0.0]
        uncertainty = sum(_missed(np.abs(h[leg]), np.diff(f)[leg]) for leg in legs)
    return Work(float(mean @ h), uncertainty, float(np.abs(mean) @ np.abs(h)))


def closes(displacement: Sequence[float], force: Sequence[float], tolerance: float) -> bool:
    """Return whether a path ends in the state in which it began: at the same displacement, under the same force.

    Displacements may differ by 1e-9 of the width of the path, forces by the tolerance of the larger one plus 1e-6 of
    the largest of all.

    Args:
        displacement, force: (n,) [LU] and (n,) [FU].
        tolerance: relative, of the forces at both ends.
    """
    d, f = np.asarray(displacement), np.asarray(force)
    residual = 1e-6 * np.abs(f).max()  # minimisers leave less
    ends = tolerance * max(abs(f[0]), abs(f[-1])) + residual
    return bool(abs(d[-1] - d[0]) <= CLOSURE * np.ptp(d) and abs(f[-1] - f[0]) <= ends)


def _missed(h: Array, rise: Array) -> float:
    """Return the error bound, ≥ 0 [FU·LU], of the trapezoidal rule on a leg of increments in one direction.

    Of a single increment it is half of its length times the change of the force.

    Args:
        h: increments > 0, (n,) [LU].
        rise: change of the force over each, (n,) [FU].
    """
    if len(h) < 2:
        return float(0.5 * h @ np.abs(rise))
    last, slope = len(h) - 1, rise / h
    before, after = [0, *range(last)], [*range(1, last + 1), last]
    bend = np.abs(slope[after] - slope[before]) / (0.5 * (h[before] + h[after]) + h)
    jump = h * np.abs(slope - 0.5 * (slope[before] + slope[after]))
    return float((h**3 * bend / 12.0 + 0.5 * h * jump).sum())
