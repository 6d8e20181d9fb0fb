"""Reading marks off a curve F(d): where it crosses a force, and where its tension is largest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Peak:
    """The largest tension of a sampled curve.

    Attributes:
        index: of the sampled point.
        tension: there [FU], positive.
        uncertainty: how much the sampling may have missed [FU].
        smooth: the tension at the vertex of the parabola through the point and its neighbours [FU].
        position: the vertex's displacement [LU]; the sampled point's where the curve jumps there.
    """

    index: int
    tension: float
    uncertainty: float
    smooth: float
    position: float


FIT_POINTS = 4
"""Points on either side of the largest tension through which the parabola goes, where there are as many."""
JUMP = 3.0
"""A fall after the maximum over the rise before it, from which on it is a jump and no curve."""


def largest_tension(displacement: Sequence[float], force: Sequence[float]) -> Peak:
    """The largest −F of an unloading branch (displacements falling).

    Between samples a smooth curve exceeds the sampled maximum by what a parabola through its neighbourhood says. Where
    a particle snaps after the maximum, tension rises right up to the snap: it is then missed by one increment's rise at
    most, and the sampled point is the place.
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    i = int(np.argmax(tension))
    top = float(tension[i])
    if i == 0 or i == len(tension) - 1:
        return Peak(i, top, abs(top), top, float(d[i]))
    rise, fall = top - tension[i - 1], top - tension[i + 1]
    even = rise / max(d[i - 1] - d[i], 1e-300), fall / max(d[i] - d[i + 1], 1e-300)
    if even[1] > JUMP * even[0] + JUMP * abs(_bend(d, tension, i)):
        return Peak(i, top, float(rise), top, float(d[i]))
    reach = min(FIT_POINTS, i, len(tension) - 1 - i)
    near = slice(i - reach, i + reach + 1)
    scale = float(np.ptp(d[near]))
    a, b, c = np.polyfit((d[near] - d[i]) / scale, tension[near] - top, 2)
    if a >= 0:
        return Peak(i, top, float(max(rise, fall)), top, float(d[i]))
    place = float(np.clip(d[i] - scale * b / (2 * a), d[i + 1], d[i - 1]))
    return Peak(i, top, float(abs(c - b**2 / (4 * a))), top + max(0.0, float(c - b**2 / (4 * a))), place)


def _bend(d: np.ndarray, tension: np.ndarray, i: int) -> float:
    """Change of slope that a smooth curve makes over the increments around point i, from the increments before."""
    if i < 2:
        return 0.0
    first = (tension[i - 1] - tension[i - 2]) / (d[i - 2] - d[i - 1])
    second = (tension[i] - tension[i - 1]) / (d[i - 1] - d[i])
    return float(first - second) * float((d[i - 1] - d[i + 1]) / (d[i - 2] - d[i]))


def crossing(displacement: Sequence[float], force: Sequence[float], level: float) -> tuple[int, float]:
    """(index i, displacement) of the first crossing of `level` [FU] between points i and i + 1, linear in between.

    Raises:
        ValueError: if the curve never crosses the level.
    """
    over = np.asarray(force) - level
    for i in range(len(over) - 1):
        if over[i] == 0.0:
            return i, float(displacement[i])
        if over[i] * over[i + 1] <= 0.0:
            part = over[i] / (over[i] - over[i + 1])
            return i, float(displacement[i] + part * (displacement[i + 1] - displacement[i]))
    raise ValueError(f"the force never passes {level:.4g} FU")
