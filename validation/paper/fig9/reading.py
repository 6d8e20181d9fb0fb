"""What runs of slides say together: the slow limit, how ⟨F⟩ falls with the velocity, where sticking ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from validation.doors import Quantity, Run
from validation.study import found

STICKS, CRITICAL, SLIDES = 2.0 / 3.0, 0.8, 1.0
"""⟨F⟩ goes to its limit, or to 0, as v to this power: where slips are, at the threshold, where all is smooth."""


def mean(run: Run) -> float:
    """⟨F⟩ of a run [FU]; NaN where it failed."""
    return found(run, "mean_friction").value


def static(run: Run) -> float:
    """The largest friction before the plate has moved by a spacing [FU]; NaN where the run failed."""
    return found(run, "static_friction").value


def slow_limit(friction: Mapping[float, float], power: float = STICKS) -> Quantity:
    """F_0 of ⟨F⟩ = F_0 + C v^p + D v through three velocities [LU/TU].

    Which power follows v^p is not known to be 1: it is uncertain by what it is off the line in v^p through the two
    slowest.
    """
    velocities = np.asarray(sorted(friction))
    values = np.asarray([friction[v] for v in velocities])
    terms = np.column_stack([np.ones(3), velocities**power, velocities])
    limit, line = (float(np.linalg.solve(terms[:n, :n], values[:n])[0]) for n in (3, 2))
    return Quantity(limit, abs(limit - line), "FU")


def exponent(friction: Mapping[float, float]) -> float:
    """d ln⟨F⟩/d ln v between the two slowest velocities."""
    slow, fast = sorted(friction)[:2]
    return float(np.log(friction[fast] / friction[slow]) / np.log(fast / slow))


def threshold(stiffness: Sequence[float], exponents: Sequence[float], unit: str = "1") -> Quantity:
    """The stiffness at which ⟨F⟩ falls as at a threshold: between the last one where it falls slower and the next."""
    sticking = [k for k, p in zip(stiffness, exponents, strict=True) if p < CRITICAL]
    sliding = [k for k in stiffness if k not in sticking]
    low, high = max(sticking, default=stiffness[0]), min(sliding, default=stiffness[-1])
    return Quantity(0.5 * (low + high), 0.5 * abs(high - low), unit)
