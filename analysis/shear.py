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
"""Remaining μ f over the largest μ f that counts as 0: a history is a sum over all load steps."""


def stick_margin(profile: Profile, coefficient: float, direction: int) -> Array:
    """Return the part of μ p not used up in the direction of motion, (n,) ≥ 0 [FU/LU].

    It is μ p less the shear against the motion, so up to 2 μ p after a reversal, and 0 where a particle slips or is
    free; a tensile pressure counts as 0. A margin below 1e-10 of the largest μ p is 0, too.

    Args:
        profile: pressure p, compression positive, and shear of the lower body on the upper one, which is against the
            motion [FU/LU].
        coefficient: μ, dimensionless.
        direction: of the body along x, 1 or -1; 0 where it has not moved: then |shear| is what is used up.
    """
    limit = coefficient * np.maximum(profile.pressure, 0.0)
    shear = np.abs(profile.shear) if direction == 0 else -direction * profile.shear
    margin = limit - shear
    return np.where(margin > ROUND_OFF * limit.max(), margin, 0.0)


def stick_radius(profile: Profile, coefficient: float, direction: int) -> ContactRadius:
    """Return the half-width c of the stick zone [LU], to where the margin of μ p vanishes, with edges and uncertainty.

    Value and uncertainty are 0 where all particles slip. As a pressure without attraction, the margin is a smooth
    function of x inside the zone and 0 outside: its zero is that of a parabola through the outermost particles that
    stick; without a zero before the next particle it is halfway to that. Where an end of the chain sticks it is the
    edge.

    Args:
        profile: pressure p and shear of the lower body on the upper one [FU/LU], n ≥ 3 particles.
        coefficient: μ, dimensionless.
        direction: of the motion along x, 1 or -1; 0 where the body has not moved.

    Raises:
        ValueError: fewer than 3 particles.
    """
    margin = stick_margin(profile, coefficient, direction)
    radius = compressive_radius(replace(profile, pressure=margin), ROUND_OFF)
    return radius if margin.any() else replace(radius, uncertainty=0.0)


@dataclass(frozen=True)
class Slip:
    """Changes of particles in contact during a load step: arrays (…, n).

    Attributes:
        force: tangential force after the step [FU].
        work: ≥ 0, dissipated by the slip [FU·LU].
    """

    force: Array
    work: Array


def slip(force: Array, pushed: Array, limit: Array, next_limit: Array, stiffness: float) -> Slip:
    """Return force and dissipated work of springs whose ends move while the limits of their forces change.

        s₁ = clip(s₀ + k Δu, ±B₁)

    For a straight path and a limit B that changes evenly along it this is exact: a force that reaches its limit stays
    at it. The slip is (s₀ + k Δu − s₁)/k, with its sign, from s₀ + k Δu t = ±B(t) on, under the mean of B from there
    on; 0 where the spring sticks. The work is ≥ 0, for each spring.

    Args:
        force: s₀ [FU], (…, n), |s₀| ≤ B₀.
        pushed: k Δu [FU], (…, n).
        limit, next_limit: B₀ and B₁ = μ f ≥ 0, before and after [FU], (…, n).
        stiffness: k [FU/LU].
    """
    wanted = force + pushed
    after = np.minimum(np.maximum(wanted, -next_limit), next_limit)
    distance = (wanted - after) / stiffness
    side = np.sign(distance)
    faster = pushed - side * (next_limit - limit)
    with np.errstate(over="ignore"):  # of a tiny displacement
        begins = np.divide(side * limit - force, faster, out=np.zeros_like(force), where=faster != 0.0)
    at_begin = limit + np.clip(begins, 0.0, 1.0) * (next_limit - limit)
    return Slip(after, np.abs(distance) * 0.5 * (at_begin + next_limit))


def kinks_of(stick: Sequence[float], contact: Sequence[float]) -> list[list[float]]:
    """Return a list of kinks of the line shear for each load step, inside the contact edge, ascending [length].

    The edge c of the stick zone is a kink. Where c grows, at a turn or with the load, the old edge remains as a kink,
    and so does the old edge of a growing contact; a kink that c reaches again vanishes. A list is empty where all
    sticks (c = a) or slips (c = 0) and no old edge lies within c.

    Args:
        stick: c after each load step [length].
        contact: a after each load step [length].

    Raises:
        ValueError: arguments of unequal lengths.
    """
    kinks: list[list[float]] = []
    kept: list[float] = []
    before, edge = 0.0, 0.0
    for c, a in zip(stick, contact, strict=True):
        kept = sorted({old for old in (*kept, before, edge) if 0.0 < old < c})
        kinks.append([*kept, c] if 0.0 < c < a else list(kept))
        before, edge = c, a
    return kinks


def shear_load(
    x: ArrayLike, shear: ArrayLike, edge: float, kinks: Sequence[float] = (), apex: bool = False
) -> LineLoad:
    """Return the even line shear through values at positions: a cubic spline in each zone between kinks, 0 at the edge.

    At a kink it is the mean of the values extrapolated from the zones on both sides. Left out are kinks with fewer than
    3 positions between the axis and them, or between them and the next kink farther out or the edge; and values from
    the edge on.

    Args:
        x: positions, rising and the same on both sides of 0, shape (n,) [length].
        shear: line shear at these positions, shape (n,) [force/length].
        edge: contact radius a [length].
        kinks: inside of the edge, in any order [length].
        apex: whether the body has an apex at x = 0, so that the line shear may have a slope there.

    Raises:
        ValueError: fewer than 3 positions on a side within the edge, positions that differ between both sides, or
            arrays of unequal lengths.
    """
    right, mean, spacing = of_both_sides(x, shear)
    near = 1e-6 * spacing  # a particle that is closer to a kink belongs to it
    count = int(np.searchsorted(right, edge - near))
    right, mean = right[:count], mean[:count]
    if count < FEWEST:
        raise ValueError(f"a shear traction needs {FEWEST} positions on each side of the axis, got {count}")
    # Of each border the indices of the first position that is not within it and the first beyond it, then x and height.
    borders = [(count, count, edge, 0.0)]
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
    """Return the line shear at a kink, in the unit of y: the mean of parabolas through 3 positions on either side.

    Args:
        x, y: positions, rising, and line shear there, (n,).
        within, beyond: index after the last position before the kink, and that of the first one beyond it.
        kink: its position.
    """
    sides = [slice(start, start + FEWEST) for start in (within - FEWEST, beyond)]
    return float(np.mean([np.polynomial.Polynomial.fit(x[side], y[side], FEWEST - 1)(kink) for side in sides]))


def _spline(
    positions: Array, values: Array, low: tuple[float, float], high: tuple[float, float], first: bool, apex: bool
) -> tuple[Array, Array]:
    """Return where the 2nd to mth cubic of a zone begin, (m − 1,), and coefficients of all m in powers of x, (4, m).

    The spline goes through the values and those at the borders; the lowest power comes first.

    Args:
        positions, values: line shear inside the zone, (n,) each.
        low, high: the borders of the zone, each with its position and the line shear there.
        first: whether the zone begins at the axis; it is then mirrored there, and `low` has only a position, 0.
        apex: whether the body has an apex: the first zone is then not mirrored.
    """
    from scipy.interpolate import CubicSpline

    x, y = np.append(positions, high[0]), np.append(values, high[1])
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
