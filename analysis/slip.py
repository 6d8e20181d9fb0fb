"""Stick and slip of particles under Coulomb's friction: |s| ≤ μ f, with the tangential force s and the normal one f.

A particle sticks where some of μ f is left in the direction in which its body was moved last, μ f − s to the right and
μ f + s to the left; where none is left, it slips.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius

Array = NDArray[np.float64]

ROUND_OFF = 1e-10
"""What is left of μ f over the largest μ f below which nothing is: a history is a sum over all rows."""


def stick_margin(profile: Profile, coefficient: float, direction: int) -> Array:
    """Return what is left of μ p in the direction of motion [FU/LU], (n,); 0 where a particle slips or is not touched.

    Args:
        profile: pressure p, and shear of the lower body on the upper one, which is against the motion [FU/LU].
        coefficient: μ.
        direction: of the body along x, 1 or -1; 0 where it has not moved, and what is left to either side counts.
    """
    limit = coefficient * np.maximum(profile.pressure, 0.0)
    shear = np.abs(profile.shear) if direction == 0 else -direction * profile.shear
    margin = limit - shear
    return np.where(margin > ROUND_OFF * limit.max(), margin, 0.0)


def stick_radius(profile: Profile, coefficient: float, direction: int) -> ContactRadius:
    """Return the half-width c of the zone that sticks [LU]: out to where nothing of μ p is left; 0 where all slips.

    As a pressure without attraction that margin is a smooth function of x inside the zone and 0 outside, and its zero
    is found in the same way (`analysis.radius.compressive_radius`). Arguments as of `stick_margin`.
    """
    margin = stick_margin(profile, coefficient, direction)
    found = compressive_radius(replace(profile, pressure=margin), ROUND_OFF)
    return found if margin.any() else replace(found, uncertainty=0.0)


@dataclass(frozen=True)
class Slip:
    """What a row did to particles that were touched all the way: arrays (n,).

    force: tangential force after it [FU]; way: by how much each slipped [LU]; work: that it took [FU·LU].
    """

    force: Array
    way: Array
    work: Array


def slip(force: Array, pushed: Array, limit: Array, next_limit: Array, stiffness: float) -> Slip:
    """Return what becomes of tangential springs whose ends are moved, while the limits of their forces change.

        s₁ = clip(s₀ + k Δu, ±B₁)

    With a straight way and a limit B that changes evenly along it this is exact: a force that reaches its limit stays
    there. It slips by (s₀ + k Δu − s₁)/k, from where s₀ + k Δu t = ±B(t), under the mean of B from there on.

    Args:
        force: s₀ [FU], (n,), |s₀| ≤ B₀.
        pushed: k Δu [FU], (n,).
        limit, next_limit: B₀ and B₁ = μ f, before and after [FU], (n,).
        stiffness: k [FU/LU].
    """
    wanted = force + pushed
    after = np.clip(wanted, -next_limit, next_limit)
    way = (wanted - after) / stiffness
    side = np.sign(way)
    faster = pushed - side * (next_limit - limit)
    begins = np.divide(side * limit - force, faster, out=np.zeros_like(force), where=faster != 0.0)
    at_begin = limit + np.clip(begins, 0.0, 1.0) * (next_limit - limit)
    return Slip(after, way, np.abs(way) * 0.5 * (at_begin + next_limit))
