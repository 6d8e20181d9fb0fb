"""Contact radius from a pressure profile: with tension dp/dx = 0 at a, where p is least; without it p(a) = 0.

Springs under tension up to an edge, where the pressure jumps to 0, are the reduced model of JKR's contact. The last
particle that carries represents the share φ of its cell, x ± s/2, that lies within the edge: with p(x) the pressure
inside, extrapolated to the middle of that share,

    p_last = φ p(x_last − (1 − φ) s/2),    a = x_last − s/2 + φ s

p is the parabola through the three particles before it, whose cells lie within the edge.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.extremum import EstimatedPosition, position_of_minimum
from contact1d.analysis.pressure import Array, Profile, spacing_of

NEGLIGIBLE = 1e-12
"""Tension or pressure below this share of the largest |p| is round-off."""
PARABOLA_POINTS = 3
"""Particles that determine a pressure parabolic in x."""


@dataclass(frozen=True)
class ContactRadius:
    """Half the distance between the two edges of a contact.

    Attributes:
        value: (right − left)/2 ≥ 0 [LU]; 0 where there is no contact, or a single spot.
        uncertainty: estimated [LU]; it covers the error in at least 95 % of random cases.
        left, right: positions of the edges [LU].
    """

    value: float
    uncertainty: float
    left: float
    right: float


def tensile_radius(profile: Profile) -> ContactRadius:
    """Return the radius a of maximum tensile stress [LU], between particles: p(a) = min p on each side of the centre.

    The centre is the mean of x weighted with |p|. The value is half the distance of both minima; a contact that has
    shrunk to one tensile spot has radius 0: the minimum is the same on both sides. An edge at the first or last
    particle is uncertain by a spacing. The interpolation of `analysis.extremum` has a median
    error of 3e-4 spacings s, 0.04 where particles snap. A radius a below 3 s is uncertain by 1.2 (s - a/3) at least:
    over 6900 random contacts of independent pairs in closed form, with bodies as sharp as two spacings, that covers at
    least 94 % of the errors of every size of contact; without, 85 to 90 %. Source: Geike and Popov 2007, Section 3.2
    and Fig. 4, after Greenwood.

    Args:
        profile: a pressure profile of one contact, n >= 3 particles, compression positive.

    Raises:
        ValueError: no particle carries tension (use `compressive_radius`), fewer than 3 particles, or a pressure that
            is not finite.
    """
    x, p = profile.x, profile.pressure
    least, most = _extremes(profile)
    if not least < -NEGLIGIBLE * max(-least, most):
        raise ValueError("no particle carries tension, so there is no radius of maximum tensile stress")
    centre = _centre(x, p)
    spacing = spacing_of(x)
    left, right = (_edge(x, p, centre, side * spacing) for side in (-1, 1))
    radius = _between(left, right)
    value = radius.value if radius.value > 1e-9 * spacing else 0.0  # by more than round-off
    return replace(radius, value=value, uncertainty=max(radius.uncertainty, 1.2 * (spacing - value / 3.0)))


def compressive_radius(profile: Profile, residual: float = 0.0) -> ContactRadius:
    """Return the contact radius a [LU] where the pressure vanishes, p(a) = 0, beyond the outermost loaded particles.

    A particle is loaded where p exceeds 1e-12 of the largest. Springs to a bulk give p = (k/s) (d - x^2/2R), so that
    the parabola through the three outermost loaded particles is extended to p = 0: exact there (to round-off), where a
    straight line through two overshoots by up to s^2/a with the spacing s. The edge is kept between the outermost
    loaded particle and the next. Where the parabola has no zero there (few particles, a load concentrated at the edge,
    a soft law's tail) it is halfway, within half a spacing. Where the last particle of the chain is loaded it is the
    edge, uncertain by a spacing. No load at all: radius 0 at the middle of the chain,
    uncertain by half a spacing.

    Args:
        profile: of one contact, p >= 0, n >= 3 particles.
        residual: error of each pressure that a minimiser leaves, over the largest pressure; it moves the edge by that
            error over the slope dp/dx at the edge, which is added to the uncertainty.

    Raises:
        ValueError: fewer than 3 particles, a pressure that is not finite, or a particle under tension.
    """
    x, p = profile.x, profile.pressure
    least, most = _extremes(profile)
    largest = max(-least, most)
    if least < -NEGLIGIBLE * largest:
        raise ValueError("particles carry tension: the radius is that of maximum tensile stress")
    share = p / (largest or 1.0)
    return _of_edges(x, share, share > NEGLIGIBLE, partial(_zero, residual=residual))


def held_radius(profile: Profile) -> ContactRadius:
    """Return the contact radius [LU] of a profile whose pressure jumps to 0 at its edges, as JKR's.

    The share of the last cell that lies inside the edge follows from the pressure of the last loaded particle and the
    parabola through the three before it. With fewer than 5 loaded particles, or where that share is not within −0.05 …
    1.05, the edge is at the last loaded particle, within half a spacing. A particle is loaded where its pressure is not
    exactly 0. Where all pressures are 0 the radius is 0 at the middle of the chain, uncertain by half a spacing.

    Args:
        profile: of a chain of evenly spaced particles, n >= 3.

    Raises:
        ValueError: fewer than 3 particles, or a pressure that is not finite.
    """
    _extremes(profile)
    return _of_edges(profile.x, profile.pressure, profile.pressure != 0.0, _held_edge)


def within(profile: Profile, edge: float) -> Profile:
    """Return the particles of a profile within an `edge` [LU] on both sides of x = 0, in new arrays.

    Beyond either end there is one more without a load, a spacing away, since a contact may end in between.
    """
    inside = np.abs(profile.x) < edge
    columns = (profile.z_lower, profile.z_upper, profile.pressure, profile.shear)
    x = np.pad(profile.x[inside], 1, mode="reflect", reflect_type="odd")
    return Profile(x, *(np.pad(column[inside], 1) for column in columns))


def covers(profile: Profile, edge: float) -> bool:
    """Return whether a contact, of a profile `within` the edge of a body, is pressed up to that `edge` [LU].

    It is where both ends are, and the parabola through the last three pressures is not below 0 at the edge. False for
    fewer than 3 particles.
    """
    p = profile.pressure[1:-1]
    if p.size < PARABOLA_POINTS or not min(p[0], *p[-PARABOLA_POINTS:]) > 0.0:
        return False
    last = np.polyfit(profile.x[-PARABOLA_POINTS - 1 : -1] - edge, p[-PARABOLA_POINTS:], 2)
    return bool(last[-1] >= 0.0)


def ends_whole(profile: Profile, round_off: float) -> bool:
    """Return whether both ends of a profile `within` the edge of a body carry whole cells.

    They do where the last pressure is that of the parabola of the three before, but for a share `round_off` of the
    largest one. False for fewer than 4 particles, and where the first or the last pressure is 0.
    """
    p = profile.pressure[1:-1]
    if p.size <= PARABOLA_POINTS or 0.0 in (p[0], p[-1]):
        return False
    return bool(abs(np.diff(p[-PARABOLA_POINTS - 1 :], PARABOLA_POINTS)[0]) <= round_off * np.abs(p).max())


def whole_cells(profile: Profile, radius: ContactRadius) -> Array:
    """Return the pressures, (n,) [FU/LU], with that of the outermost loaded particle on each side as of a whole cell.

    It is extrapolated by the parabola through the next three particles inwards, and 0 for a particle outside the edges
    of `radius`. Loaded particles are those with p other than 0; with fewer than 8 of them no pressure is changed. The
    result is a copy in each case.
    """
    x, p = profile.x, profile.pressure.copy()
    held = np.flatnonzero(p != 0.0)
    if held.size < 2 * PARABOLA_POINTS + 2:
        return p
    for last, inwards in ((int(held[-1]), -1), (int(held[0]), 1)):
        inner = [float(p[last + k * inwards]) for k in (3, 2, 1)]
        inside = radius.left <= x[last] <= radius.right
        p[last] = inner[0] - 3.0 * inner[1] + 3.0 * inner[2] if inside else 0.0
    return p


def moved_centre(profile: Profile) -> float:
    """Return the position of the centre of a contact that was displaced along x [LU]: the mean of x weighted with |p|.

    0 if it is less than a spacing from x = 0, for a single particle, and without any pressure.
    """
    if profile.x.size < 2 or not np.any(profile.pressure):
        return 0.0
    centre = _centre(profile.x, profile.pressure)
    return centre if abs(centre) > spacing_of(profile.x) else 0.0


def _centre(x: Array, p: Array) -> float:
    """Return the mean of x weighted with |p|, in the unit of x; ZeroDivisionError where every p is 0."""
    return float(np.average(x, weights=np.abs(p)))


def _edge(x: Array, p: Array, centre: float, outwards: float) -> EstimatedPosition:
    """Return the position [LU] of the largest tension, where p is least, on one side of the centre, as estimated.

    A particle just beyond the centre belongs to both sides, so that both find a single spot. A minimum more than a
    quarter of a spacing beyond the centre is that of the other side; where one on this side is as low, but for the
    residual of a minimiser, the latter counts.

    Args:
        x: positions, rising, (n,) [LU].
        p: pressures, (n,) [FU/LU].
        centre: position of the centre [LU].
        outwards: the spacing [LU], negative for the left side.
    """
    away = (x - centre) / outwards
    reach, inside = np.flatnonzero(away >= -0.5), np.flatnonzero(away >= 0.0)
    minimum, residual = position_of_minimum(x, p, reach), 1e-5 * float(np.abs(p).max())
    across = (minimum.position - centre) / outwards < -0.25
    if across and inside.size and float(p[inside].min()) <= float(p[reach].min()) + residual:
        return position_of_minimum(x, p, inside)
    return minimum


def _extremes(profile: Profile) -> tuple[float, float]:
    """Return the smallest and the largest pressure of a profile [FU/LU], compression positive.

    Raises:
        ValueError: fewer than 3 particles, or a pressure that is not finite.
    """
    if len(profile.x) < PARABOLA_POINTS:
        raise ValueError(f"a contact radius needs at least {PARABOLA_POINTS} particles, got {len(profile.x)}")
    extremes = float(profile.pressure.min()), float(profile.pressure.max())
    if not all(map(math.isfinite, extremes)):
        raise ValueError("a contact radius needs a finite pressure on every particle")
    return extremes


def _between(left: EstimatedPosition, right: EstimatedPosition) -> ContactRadius:
    """Return half the distance of two edges, 0 where the left one is beyond the right one; uncertain by their mean.

    `left` and `right` are the positions as they are.
    """
    value = max(0.0, 0.5 * (right.position - left.position))
    uncertainty = 0.5 * (left.uncertainty + right.uncertainty)
    return ContactRadius(value, uncertainty, left.position, right.position)


def _of_edges(
    x: Array,
    p: Array,
    carries: NDArray[np.bool_],
    edge: Callable[[list[float], list[float], int, int], EstimatedPosition],
) -> ContactRadius:
    """Return the radius between the right `edge` of the particles that carry, and that of their mirror image.

    Without such a particle it is 0 at the middle of the chain, uncertain by half a spacing.

    Args:
        x, p: positions, rising, and pressures, (n,).
        carries: which particles are loaded, (n,).
        edge: returns the right edge of x and p of the last 4 particles that carry and of the next one, if there is one,
            and of the indices in these of the first and the last that carry.
    """
    carrying, end = np.flatnonzero(carries), len(x) - 1
    if carrying.size == 0:
        middle = float(0.5 * (x.max() + x.min()))
        return ContactRadius(0.0, 0.5 * spacing_of(x), middle, middle)
    first, last = int(carrying[0]), int(carrying[-1])
    edges = []
    for positions, pressures, least, most in ((x, p, first, last), (-x[::-1], p[::-1], end - last, end - first)):
        low = max(0, most - PARABOLA_POINTS)
        near = slice(low, most + 2)
        edges.append(edge(positions[near].tolist(), pressures[near].tolist(), least - low, most - low))
    right, mirrored = edges
    return _between(EstimatedPosition(-mirrored.position, mirrored.uncertainty), right)


def _zero(x: list[float], p: list[float], first: int, last: int, residual: float) -> EstimatedPosition:
    """Return the right edge of a contact, where p is 0, in the unit of x, with its uncertainty.

    It is the falling zero of the parabola through the last three loaded particles, uncertain by the difference from
    that of the three up to the last but one and by `residual`, at most by a spacing. It is halfway to the next
    particle, within half a spacing, where the parabola has no such zero before that, or fewer are loaded. If the last
    particle of the chain is loaded, it is that, uncertain by a spacing.

    Args:
        x, p: positions, and pressures over the largest one.
        first, last: indices of the first and the last loaded particle.
        residual: error of each of these pressures.
    """
    if last == len(x) - 1:
        return EstimatedPosition(x[last], x[last] - x[last - 1])
    inner, outer = x[last], x[last + 1]
    zero, compared = (
        _parabola_zero(x[end - 2 : end + 1], p[end - 2 : end + 1], inner, outer, residual)
        if end - PARABOLA_POINTS >= first - 1
        else None
        for end in (last, last - 1)
    )
    if zero is None:
        return EstimatedPosition(0.5 * (inner + outer), 0.5 * (outer - inner))
    if compared is None:
        return EstimatedPosition(zero.position, max(outer - zero.position, zero.position - inner))
    return EstimatedPosition(
        zero.position, min(abs(zero.position - compared.position) + zero.uncertainty, outer - inner)
    )


def _parabola_zero(
    x: list[float], p: list[float], inner: float, outer: float, residual: float
) -> EstimatedPosition | None:
    """Return the falling zero, between inner and outer, of the parabola through three particles; None without one.

    c + b t + a t^2 falls with the slope -sqrt(D), D = b^2 - 4ac, at t = c/q for b < 0 and else at q/a, where
    q = -(b + sign(b) sqrt(D))/2: no difference of near numbers, so that a straight line (a cone's pressure) is no
    special case.

    Args:
        x, p: positions, and pressures over the largest one, of the three particles.
        inner, outer: positions of the outermost loaded particle and of the next.
        residual: error of each pressure, over the largest one; its share of the slope is the uncertainty.
    """
    width = outer - inner
    (first, second, third), (high, middle, low) = ((position - inner) / width for position in x), p
    chord, slope = (low - high) / (third - first), (low - middle) / (third - second)
    a = (slope - chord) / (second - first)
    b = slope - a * (second + third)
    c = low - third * (b + a * third)
    square = b**2 - 4.0 * a * c
    if square <= 0.0 or min(a, b) >= 0.0:
        return None
    falling = math.sqrt(square)
    q = -0.5 * (b + math.copysign(falling, b))
    zero = c / q if b < 0.0 else q / a
    moved = residual / falling  # the outermost pressure may be lost in the residual
    if not -NEGLIGIBLE - moved <= zero <= 1.0 + NEGLIGIBLE + moved:
        return None
    return EstimatedPosition(inner + width * zero, NEGLIGIBLE * (abs(inner) + width) + width * moved)


def _held_edge(x: list[float], p: list[float], first: int, last: int) -> EstimatedPosition:
    """Return the right edge of a contact whose pressure jumps to 0 at it, in the unit of x, with its uncertainty.

    It is the position of the last loaded particle, within half a spacing, where fewer than 5 particles are loaded or
    the share of the last cell is not within −0.05 … 1.05; a share beyond 0 … 1 counts as 0 or 1.

    Args:
        x, p: positions and pressures, evenly spaced.
        first, last: indices of the first and the last loaded particle.
    """
    spacing = (x[-1] - x[0]) / (len(x) - 1)
    somewhere = EstimatedPosition(x[last], 0.5 * spacing)
    if last - first <= PARABOLA_POINTS:  # the parabola would include the other edge
        return somewhere
    *inner, carried = p[last - PARABOLA_POINTS : last + 1]
    parabola, straight = _share(carried, inner), _share(carried, [2.0 * inner[1] - inner[2], inner[1], inner[2]])
    if not -0.05 <= parabola <= 1.05:  # 0 … 1 within the error of the extrapolation
        return somewhere
    share = min(max(parabola, 0.0), 1.0)
    off = min(0.5, abs(parabola - straight)) * spacing
    return EstimatedPosition(x[last] + (share - 0.5) * spacing, off)


def _share(carried: float, inner: list[float], steps: int = 10) -> float:
    """Return the share φ of its cell that the last particle carries, 1 for a whole cell; NaN for a pressure 0 inside.

    By the parabola through the pressures of the three particles before it, extrapolated to the middle of the share. It
    may lie outside of 0 … 1. Each step of the iteration leaves a small part of the error, (φ − 1) s p′/2p.

    Args:
        carried: force of the last particle over the spacing.
        inner: pressures of the three before, the outermost last.
        steps: of the iteration.
    """
    bend = inner[2] - 2.0 * inner[1] + inner[0]
    slope = inner[2] - inner[1] + 0.5 * bend
    share = 1.0
    for _ in range(steps):
        t = 1.0 - 0.5 * (1.0 - share)  # from the particle before, in spacings
        inside = inner[2] + slope * t + 0.5 * bend * t * t
        if inside == 0.0:
            return math.nan
        share = carried / inside
    return share
