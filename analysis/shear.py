"""Shear with Coulomb's friction: stick and slip zones, and the traction q(r) under an axisymmetric body.

The tangential force s and the normal force f of a particle obey |s| ≤ μ f. It slips where |s| = μ f in the direction of
the last motion of its body, s = μ f to the right and s = −μ f to the left; otherwise it sticks.

The line shear of the plane image has kinks. As the pressure (`analysis.abel`) it is the inverse Abel transform q(r) =
-(1/pi) int_r^inf q'(x)/sqrt(x^2 - r^2) dx (Popov and Hess 2015, chapter 5). Where a zone that sticks and one that
slips meet the line shear has a kink, and q(r) a vertical tangent: between kinks it is smooth, a spline for each zone,
and on a parabola all of that is exact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from contact1d.analysis.abel import FEWEST, LineLoad, in_powers, of_both_sides
from contact1d.analysis.pressure import Array, Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius

ROUND_OFF = 1e-10
"""Remaining μ f over the largest μ f below which there is none: a history is a sum over all rows."""
NEAR = 1e-6
"""Of a spacing: a particle closer to a kink than that belongs to it."""


def stick_margin(profile: Profile, coefficient: float, direction: int) -> Array:
    """Return the part of μ p not used up in the direction of motion [FU/LU], (n,); 0 where a particle slips or is free.

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
    """Changes of particles in contact during a whole load step: arrays (…, n).

    force: tangential force after it [FU]; way: by how much each slipped [LU]; work: that it took [FU·LU].
    """

    force: Array
    way: Array
    work: Array


def slip(force: Array, pushed: Array, limit: Array, next_limit: Array, stiffness: float) -> Slip:
    """Return the forces of tangential springs whose ends are moved, while the limits of their forces change.

        s₁ = clip(s₀ + k Δu, ±B₁)

    With a straight way and a limit B that changes evenly along it this is exact: a force that reaches its limit stays
    there. It slips by (s₀ + k Δu − s₁)/k, from where s₀ + k Δu t = ±B(t), under the mean of B from there on.

    Args:
        force: s₀ [FU], (…, n), |s₀| ≤ B₀.
        pushed: k Δu [FU], (…, n).
        limit, next_limit: B₀ and B₁ = μ f, before and after [FU], (…, n).
        stiffness: k [FU/LU].
    """
    wanted = force + pushed
    after = np.minimum(np.maximum(wanted, -next_limit), next_limit)
    way = (wanted - after) / stiffness
    side = np.sign(way)
    faster = pushed - side * (next_limit - limit)
    with np.errstate(over="ignore"):  # of a move that is next to nothing
        begins = np.divide(side * limit - force, faster, out=np.zeros_like(force), where=faster != 0.0)
    at_begin = limit + np.clip(begins, 0.0, 1.0) * (next_limit - limit)
    return Slip(after, way, np.abs(way) * 0.5 * (at_begin + next_limit))


def kinks_of(stick: Sequence[float], contact: Sequence[float]) -> list[list[float]]:
    """Return the kinks of the line shear after each load step, inside the contact edge, ascending [length].

    The edge c of what sticks is one. Where c grows, at a turn or with the load, the old one stays behind, and so does
    the old edge of a contact that grows; where c comes back to a kink, that is gone.

    Args:
        stick: c after each row [length].
        contact: a after each row [length].
    """
    found: list[list[float]] = []
    kept: list[float] = []
    before, edge = 0.0, 0.0
    for c, a in zip(stick, contact, strict=True):
        kept = sorted({old for old in (*kept, before, edge) if 0.0 < old < c})
        found.append([*kept, c] if 0.0 < c < a else list(kept))
        before, edge = c, a
    return found


def shear_load(
    x: ArrayLike, shear: ArrayLike, edge: float, kinks: Sequence[float] = (), apex: bool = False
) -> LineLoad:
    """Return the even line shear through values at positions: a cubic spline in each zone between kinks, 0 at the edge.

    At a kink it is the mean of what the zones on both sides come to there. A kink is left out that would leave fewer
    than FEWEST positions on one side of it.

    Args:
        x: positions, rising and the same on both sides of 0, shape (n,) [length].
        shear: there, shape (n,) [force/length].
        edge: a, beyond which there is none [length].
        kinks: inside of it [length].
        apex: whether the body has one at x = 0, so that a slope there is meant.

    Raises:
        ValueError: fewer than FEWEST places on a side within the edge, or places that are not the same on both sides.
    """
    right, mean, spacing = of_both_sides(x, shear)
    near = NEAR * spacing
    count = int(np.searchsorted(right, edge - near))
    right, mean = right[:count], mean[:count]
    if count < FEWEST:
        raise ValueError(f"a shear traction needs {FEWEST} positions on each side of the axis, got {count}")
    borders = [(count, count, edge, 0.0)]  # first place that is not within, first one beyond, where, the height there
    for kink in sorted(kinks, reverse=True):
        within, beyond = (int(i) for i in np.searchsorted(right, [kink - near, kink + near]))
        if min(within, borders[0][0] - beyond) >= FEWEST:
            borders.insert(0, (within, beyond, kink, _height(right, mean, within, beyond, kink)))
    first, low, breaks, coefficients = 0, (0.0, math.nan), [0.0], []
    for within, beyond, border, height in borders:
        zone, high = slice(first, within), (border, height)
        inner, pieces = _spline(right[zone], mean[zone], low, high, first == 0, apex)
        breaks += [*inner, border]
        coefficients.append(pieces)
        first, low = beyond, high
    return LineLoad(np.asarray(breaks), np.concatenate(coefficients, axis=1))


def _height(x: Array, y: Array, within: int, beyond: int, kink: float) -> float:
    """The mean of the parabolas through the FEWEST positions before index `within`, and those from `beyond` on."""
    sides = [slice(start, start + FEWEST) for start in (within - FEWEST, beyond)]
    return float(np.mean([np.polynomial.Polynomial.fit(x[side], y[side], FEWEST - 1)(kink) for side in sides]))


def _spline(
    places: Array, values: Array, low: tuple[float, float], high: tuple[float, float], first: bool, apex: bool
) -> tuple[Array, Array]:
    """Where each cubic of a zone but the first begins, and the coefficients of all in powers of x, shape (4, n).

    low, high: the zone's borders and the heights there. The `first` zone is mirrored at the axis, unless the body has
    an `apex` there.
    """
    from scipy.interpolate import CubicSpline

    x, y = np.append(places, high[0]), np.append(values, high[1])
    if not first:
        x, y = np.insert(x, 0, low[0]), np.insert(y, 0, low[1])
    elif not apex:
        mirrored = x > 0.0
        x, y = np.append(-x[mirrored][::-1], x), np.append(y[mirrored][::-1], y)
    spline = CubicSpline(x, y)
    begin = max(int(np.searchsorted(x, low[0], side="right")) - 1, 0)
    starts = x[begin:-1]
    pieces = in_powers(spline.c[::-1, begin:], np.tile(starts, (4, 1)))
    if first and not apex:
        pieces[1, 0] = 0.0
    return starts[1:], pieces
