"""Marks of a curve: the largest tension of an unloading, and how a displacement or a radius goes with the force."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import Peak, largest_tension
from contact1d.workflow.continuation.trace import Trace

Array = NDArray[np.float64]
BRANCH_DISTANCE = 0.02
"""Distance of two displacements over the whole path from which on a change is more than interpolation error."""
LAST = 1e-6
"""Distance from the limit point, over the way from F = 0 to there, within which the last row stands for it."""


def peak_of(trace: Trace) -> Peak:
    """The largest tension by falling displacement; at the limit point, where a contact is lost at once, what it is."""
    found = largest_tension(trace.displacement.tolist(), trace.force.tolist())
    last = len(trace) - 1
    left = abs(float(trace.displacement[last]) - trace.limit) / max(float(np.ptp(trace.displacement)), 1e-300)
    if found.index < last or not left <= LAST:
        return found
    return Peak(last, found.tension, left * found.tension, found.tension, found.position, 0.0)


def radius_rate(trace: Trace, state: int, least: float = 0.0) -> float:
    """da/dd at a state, from the nearest other one that is farther than a share `least` of the whole path."""
    away = np.abs(trace.displacement - trace.displacement[state])
    others = np.flatnonzero(away > least * float(away.max()))
    if others.size == 0:
        return 0.0
    near = int(others[np.argmin(away[others])])
    change = trace.radius_or_spot(near) - trace.radius_or_spot(state)
    return change / float(trace.displacement[near] - trace.displacement[state])


def radius_at(trace: Trace, position: float) -> float:
    """Contact radius [LU] at a displacement [LU] of a sorted trace, by a parabola through the three nearest states."""
    near = int(np.argmin(np.abs(trace.displacement - position)))
    first = min(max(near - 1, 0), max(len(trace) - 3, 0))
    at = range(first, min(first + 3, len(trace)))
    if position == trace.displacement[near] or len(at) < 2:
        return trace.radius_or_spot(near)
    radii = [trace.radius_or_spot(i) for i in at]
    if min(radii) == max(radii):  # a body that ends at an edge
        return radii[0]
    d = trace.displacement[list(at)]
    weights = [np.prod([(position - d[k]) / (d[j] - d[k]) for k in range(len(d)) if k != j]) for j in range(len(d))]
    return max(0.0, float(sum(weight * radius for weight, radius in zip(weights, radii, strict=True))))


def displacement_under(trace: Trace, state: int, force: float, expected: float) -> float:
    """Displacement [LU] at which the curve through a state carries a force [FU] that is near to its own.

    x with S x + K x²/2 = ΔF: towards the largest tension the stiffness S = dF/dd falls as K = dS/dd says, and x
    grows as a square root, up to √(2 |ΔF|/K). S and K are those of a parabola through up to two states beside it,
    one at least twice as far off as the other; S is at most `expected` [FU/LU], which counts alone where there are
    no such states.
    """
    own, missing = float(trace.displacement[state]), force - float(trace.force[state])
    ways, slopes = _beside(trace, state)
    expected = max(expected, float(np.finfo(np.float64).tiny))
    if len(ways) < 2:
        known = [expected, *(abs(slope) for slope in slopes if slope)]
        return own + missing / min(known)
    bend = 2.0 * (slopes[0] - slopes[1]) / (ways[0] - ways[1])
    stiffness = min(expected, slopes[0] - 0.5 * bend * ways[0])
    if bend <= 0.0:
        return own + missing / (stiffness if stiffness > 0.0 else expected)
    root = stiffness**2 + 2.0 * bend * missing
    if stiffness <= 0.0 or root <= 0.0:
        return own + math.copysign(math.sqrt(2.0 * abs(missing) / bend), missing)
    return own + 2.0 * missing / (stiffness + math.sqrt(root))


def _beside(trace: Trace, state: int) -> tuple[list[float], list[float]]:
    """Distances [LU] of up to two states beside one, and dF/dd [FU/LU] up to each.

    Nearer than BRANCH_DISTANCE of the path they say less than their own errors.
    """
    away = trace.displacement - trace.displacement[state]
    least = BRANCH_DISTANCE * float(np.abs(away).max())
    ways: list[float] = []
    slopes: list[float] = []
    for other in np.argsort(np.abs(away), kind="stable"):
        way = float(away[other])
        if way != 0.0 and abs(way) >= least and len(ways) < 2:
            ways.append(way)
            slopes.append(float(trace.force[other] - trace.force[state]) / way)
            least = 2.0 * abs(way)
    return ways, slopes
