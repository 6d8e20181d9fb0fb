"""From measured errors to numbers: the order of a knob, error ∝ h^p, and the Pareto front of error and time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FLOOR_FACTOR = 5.0
"""An error below this many floors belongs to the other settings, not to the knob."""
ASYMPTOTIC = 0.1
"""Errors above it are too large for a leading term to prevail."""
ROUND_OFF = 1e-9
"""Errors below it are those of the reference and of round-off."""
FEWEST_POINTS = 3
"""Points below which a slope would have no standard error."""


@dataclass(frozen=True)
class Order:
    """p of error ∝ h^p, its standard error, and how many points it comes from."""

    order: float
    standard_error: float
    points: int


def fit_order(h: Sequence[float], errors: Sequence[float], floor: float = 0.0) -> Order | None:
    """Least squares of ln error = p ln h + c.

    Args:
        h: what goes to zero as the knob gets finer, > 0.
        errors: relative, of the same length; NaN where there is none.
        floor: error that is left where this knob has none: points within FLOOR_FACTOR times it are left out.

    Returns:
        The order with its standard error, √(Σ residual²/(n − 2)/Σ(x − x̄)²), or None with fewer than FEWEST_POINTS
        points between the floor and ASYMPTOTIC.
    """
    used = [
        (math.log(one), math.log(error))
        for one, error in zip(h, errors, strict=True)
        if math.isfinite(error) and max(FLOOR_FACTOR * floor, ROUND_OFF) < error < ASYMPTOTIC
    ]
    if len(used) < FEWEST_POINTS or len({x for x, _ in used}) < FEWEST_POINTS:
        return None
    x, y = np.asarray(used).T
    spread = float(np.sum((x - x.mean()) ** 2))
    slope = float(np.sum((x - x.mean()) * (y - y.mean()))) / spread
    residual = y - y.mean() - slope * (x - x.mean())
    return Order(slope, math.sqrt(float(np.sum(residual**2)) / (len(used) - 2) / spread), len(used))


def pareto_front(costs: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Indices of the points that no other beats in both cost and error, the cheapest first; NaN is no point."""
    order = sorted(
        (i for i in range(len(costs)) if math.isfinite(costs[i]) and math.isfinite(errors[i])),
        key=lambda i: (costs[i], errors[i]),
    )
    front: list[int] = []
    for i in order:
        if not front or errors[i] < errors[front[-1]]:
            front.append(i)
    return front
