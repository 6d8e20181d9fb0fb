"""Marks of a curve F(d): its crossing of a force, its force maximum, the hysteresis of a closed one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from contact1d.analysis.polynomial import Array, divided, lowest_minimum, real_roots, through, value


@dataclass(frozen=True)
class Peak:
    """The force maximum of a sampled curve.

    Attributes:
        index: of the sampled point.
        tension: there [FU], positive.
        uncertainty: of `smooth`: how much the sampling may have missed [FU].
        smooth: the tension at the vertex of the polynomial through the point and its neighbours [FU].
        position: the vertex's displacement [LU]; the sampled point's where the curve jumps there.
        misplaced: of `position` [LU]: how far it lies from the vertex of another polynomial; 0 where the curve jumps.
    """

    index: int
    tension: float
    uncertainty: float
    smooth: float
    position: float
    misplaced: float


LEAST_SEPARATION = 1e-5
"""Distance of two positions over that of the outermost ones below which no polynomial is put through them."""
AS_HIGH = 1e-3
"""Distance from the highest sample over the width of the widest polynomial within which another one is ignored: the
residual of both, ε, would be a slope of ε over their distance, and that over the width 1000 ε at least."""
WIDEST_REACH = 3
"""Samples on either side of the highest one under the widest polynomial."""
JUMP_RATIO = 3.0
"""A drop after the maximum over the rise before it, above which it is an instability."""


def largest_tension(displacement: Sequence[float], force: Sequence[float]) -> Peak:
    """The largest −F of an unloading branch (displacements falling).

    Between samples a smooth curve exceeds the sampled maximum by what the polynomial through five points says; that
    through three estimates its error, and that through seven the error of its position. Where a particle
    snaps after the maximum, tension rises right up to the snap, no faster than before the sampled point: that is
    then the position, and the rise up to the next point what is missed at most.
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    i = int(np.argmax(tension))
    top = float(tension[i])
    if i == 0 or i == len(tension) - 1:
        return Peak(i, top, abs(top), top, float(d[i]), 0.0)
    rise, fall = top - tension[i - 1], top - tension[i + 1]
    even = rise / max(d[i - 1] - d[i], 1e-300), fall / max(d[i] - d[i + 1], 1e-300)
    if even[1] > JUMP_RATIO * even[0] + JUMP_RATIO * abs(_bend(d, tension, i)):
        return Peak(i, top, float(even[0] * (d[i] - d[i + 1])), top, float(d[i]), 0.0)
    # A search that has come back to the maximum leaves rows beside it that no polynomial tells apart.
    d, tension, at = _apart_from(d, tension, i)
    place, coarse = vertex(d, tension, at, 1)
    if not 2 <= at < len(d) - 2:
        return Peak(i, top, abs(coarse - top), coarse, place, abs(place - float(d[at])))
    position, smooth = vertex(d, tension, at, 2)
    if WIDEST_REACH <= at < len(d) - WIDEST_REACH:
        place, _ = vertex(d, tension, at, WIDEST_REACH)
    return Peak(i, top, abs(smooth - coarse), smooth, position, abs(position - place))


def _apart_from(d: Array, tension: Array, i: int) -> tuple[Array, Array, int]:
    """The samples without those that lie as good as on the inner sample i, and its new index; two neighbours stay."""
    width = float(d[max(i - WIDEST_REACH, 0)] - d[min(i + WIDEST_REACH, len(d) - 1)])
    kept = np.abs(d - d[i]) > AS_HIGH * width
    kept[[0, i, -1]] = True
    return d[kept], tension[kept], int(kept[:i].sum())


def _about(x: Array, y: Array, middle: int, beside: int) -> tuple[float, Array] | None:
    """Width of samples, so many on either side of one, and the polynomial through them less it, of x over the width.

    None where they lie too near to each other.
    """
    near = slice(max(middle - beside, 0), middle + beside + 1)
    if not are_apart(x[near]):
        return None
    width = float(np.ptp(x[near]))
    return width, through((x[near] - x[middle]) / width, y[near] - y[middle])


def vertex(x: Array, y: Array, highest: int, beside: int) -> tuple[float, float]:
    """Position and value of the maximum of the polynomial through the highest of samples and its neighbours.

    It lies between the next two; where these are too near, it is the sample itself.

    Args:
        x, y: positions, rising or falling, and values, (n,).
        highest: index of the highest sample.
        beside: how many on either side are under the polynomial.
    """
    place, top = float(x[highest]), float(y[highest])
    if (found := _about(x, y, highest, beside)) is None:
        return place, top
    width, rise = found
    low, high = sorted(float(x[highest + side] - x[highest]) / width for side in (-1, 1))
    best, _ = lowest_minimum(-rise, low, high)
    above = value(rise, best)
    return (place + width * best, top + above) if above > 0.0 else (place, top)


def promised(displacement: Sequence[float], force: Sequence[float], places: Sequence[float]) -> Array:
    """Tension [FU] at `places` [LU] near the force maximum, by the polynomial through it and two points on each side.

    NaN where there are no such rows.
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    i = int(np.argmax(tension))
    if 0 < i < len(d) - 1:
        d, tension, at = _apart_from(d, tension, i)
        if (found := _about(d, tension, at, 2)) is not None:
            width, rise = found
            return np.asarray([tension[at] + value(rise, (place - d[at]) / width) for place in places])
    return np.full(len(places), np.nan)


def rivals(displacement: Sequence[float], force: Sequence[float], peak: Peak) -> dict[int, float]:
    """The other maxima of a sawtooth, by their highest rows: how much each may be higher than the peak [FU], or lower.

    Beyond its highest row the tension rises no faster than it did up to there, and no further than to the next
    row; between that row and the one before, no faster than up to the latter. Displacements fall.
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    inner = np.arange(1, len(tension) - 1)
    teeth = inner[(tension[inner] > tension[inner - 1]) & (tension[inner] >= tension[inner + 1])]
    rise = np.diff(tension) / -np.diff(d)
    found = {}
    for i in teeth[teeth != peak.index]:
        top = tension[i] + rise[i - 1] * (d[i] - d[i + 1])
        if i > 1:
            top = max(top, tension[i - 1] + rise[i - 2] * (d[i - 1] - d[i]))
        found[int(i)] = float(top) - peak.smooth
    return found


def are_apart(d: Array) -> bool:
    """Whether neighbouring displacements are far enough from each other for a polynomial through them."""
    return float(np.abs(np.diff(d)).min()) > LEAST_SEPARATION * float(np.ptp(d))


def _bend(d: Array, tension: Array, i: int) -> float:
    """Change of slope that a smooth curve makes over the increments around point i, from the increments before."""
    if i < 2 or d[i - 2] == d[i - 1]:
        return 0.0
    before = slice(i - 2, i + 1)
    _, bend = divided(d[before], tension[before])
    return float(bend[0] * (d[i + 1] - d[i - 1]))


def crossing(displacement: Sequence[float], force: Sequence[float], level: float) -> tuple[int, float]:
    """(index i, displacement) of the first crossing of `level` [FU] between points i and i + 1, linear in between.

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
    """Displacement of the first crossing of `level` [FU] on the cubic through the two points on each side of it.

    At an end of the curve, and where the cubic does not cross between the two points, as beside a jump, it is the
    straight line's.

    Raises:
        ValueError: if the curve never crosses the level.
    """
    index, place = crossing(displacement, force, level)
    if not 1 <= index < len(force) - 2:
        return place
    d = np.asarray(displacement[index - 1 : index + 3])
    if not are_apart(d):
        return place
    over = np.asarray(force[index - 1 : index + 3]) - level
    x = (d - d[1]) / (d[2] - d[1])
    inside = real_roots(through(x, over), 0.0, 1.0)
    return float(d[1] + inside[0] * (d[2] - d[1])) if len(inside) == 1 else place


def tops(tension: list[float], fall: float) -> list[int]:
    """Indices of maxima after each of which values fall by more than `fall` before they rise by more than that."""
    found: list[int] = []
    high = low = 0
    for i, here in enumerate(tension):
        if here > tension[high]:
            high = low = i
        elif here < tension[low]:
            low = i
            if tension[high] - here > fall and (not found or found[-1] != high):
                found.append(high)
        elif found and found[-1] == high and here - tension[low] > fall:
            high = low = i
    return found


CLOSURE = 1e-9
"""Distance of two displacements over the width of the path up to which they are one: round-off."""
SAME_FORCE = 1e-6
"""Difference of two forces over the largest of a path up to which they are one: minimisers leave less."""


@dataclass(frozen=True)
class Work:
    """Work along a path.

    Attributes:
        area: ∫ F dd [FU·LU], by the trapezoidal rule; of a closed path what it dissipates.
        uncertainty: of it, by interpolation of F between load steps [FU·LU].
        whole: ∫ |F| |dd| [FU·LU]: of all that is done on the path.
        length: ∫ |dd| [LU].
    """

    area: float
    uncertainty: float
    whole: float
    length: float


def work_of(displacement: Sequence[float], force: Sequence[float]) -> Work | None:
    """The work along a path through points, (n,) [LU] and (n,) [FU]; None where it stays in place.

    Between two points a smooth curve departs from its chord by h³F″/12, F″ from the chords before and after. Where the
    chord's own slope is not the mean of these two, the force may have jumped, anywhere between the points: that part of
    its change may count for half of the increment h more or less. An unloading through the same displacements misses as
    much of the same curve as the loading, so that there the difference of the two is what counts.
    """
    d, f = np.asarray(displacement, dtype=np.float64), np.asarray(force, dtype=np.float64)
    same = CLOSURE * float(np.ptp(d))
    if same == 0.0 or len(d) < 3:
        return None
    h, mean = np.diff(d), 0.5 * (f[1:] + f[:-1])
    half = len(d) // 2
    if np.abs(d - d[::-1]).max() <= same and (np.diff(np.sign(h)) != 0.0).sum() == 1:
        uncertainty = _missed(np.abs(h[:half]), np.diff(f[: half + 1] - f[half:][::-1]))
    else:
        turns = np.flatnonzero(np.diff(np.sign(h)) != 0.0) + 1
        legs = [leg for leg in np.split(np.arange(len(h)), turns) if h[leg[0]] != 0.0]
        uncertainty = sum(_missed(np.abs(h[leg]), np.diff(f)[leg]) for leg in legs)
    return Work(float(mean @ h), uncertainty, float(np.abs(mean) @ np.abs(h)), float(np.abs(h).sum()))


def closes(displacement: Sequence[float], force: Sequence[float], tolerance: float) -> bool:
    """Whether a path ends in the state that it began in: at the same displacement, under the same force.

    `tolerance`: relative, of the forces at both ends; SAME_FORCE of the largest is none.
    """
    d, f = np.asarray(displacement), np.asarray(force)
    ends = tolerance * max(abs(f[0]), abs(f[-1])) + SAME_FORCE * np.abs(f).max()
    return bool(abs(d[-1] - d[0]) <= CLOSURE * np.ptp(d) and abs(f[-1] - f[0]) <= ends)


def _missed(h: Array, rise: Array) -> float:
    """What the trapezoidal rule may miss on a leg of increments h > 0 with these changes of the force."""
    if len(h) < 2:
        return float(0.5 * h @ np.abs(rise))
    last, slope = len(h) - 1, rise / h
    before, after = [0, *range(last)], [*range(1, last + 1), last]
    bend = np.abs(slope[after] - slope[before]) / (0.5 * (h[before] + h[after]) + h)
    jump = h * np.abs(slope - 0.5 * (slope[before] + slope[after]))
    return float((h**3 * bend / 12.0 + 0.5 * h * jump).sum())
