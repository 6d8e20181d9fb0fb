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
        position: the vertex's displacement [LU].
    """

    index: int
    tension: float
    uncertainty: float
    smooth: float
    position: float


def largest_tension(displacement: Sequence[float], force: Sequence[float]) -> Peak:
    """The largest −F of an unloading branch (displacements falling).

    Between samples a smooth curve exceeds the sampled maximum by what the parabola through three points says. Where a
    particle snaps after the maximum, tension rises right up to the snap: it is then missed by one increment's rise at
    most. The uncertainty is the larger of the two.
    """
    d, tension = np.asarray(displacement), -np.asarray(force)
    i = int(np.argmax(tension))
    if i == 0 or i == len(tension) - 1:
        return Peak(i, float(tension[i]), float(abs(tension[i])), float(tension[i]), float(d[i]))
    left, middle, right = tension[i - 1 : i + 2]
    a, b, _ = np.polyfit(d[i - 1 : i + 2] - d[i], tension[i - 1 : i + 2] - middle, 2)
    excess = float(b**2 / (-4 * a)) if a < 0 else 0.0
    position = float(d[i] - b / (2 * a)) if a < 0 else float(d[i])
    snap = middle - left if middle - right > 3 * (middle - left) else 0.0
    return Peak(i, float(middle), max(excess, float(snap)), float(middle) + excess, position)


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
