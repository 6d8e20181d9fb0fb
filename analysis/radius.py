"""Contact radius from a pressure profile: with tension dp/dx = 0 at a, where p is least; without it p(a) = 0.

A row of springs that are held up to an edge, where the pressure jumps to zero, is JKR's contact, reduced. The last
particle that carries represents the share φ of its cell, x ± s/2, that lies within the edge: with p(x) the pressure
inside, continued to the middle of that share,

    p_last = φ p(x_last − (1 − φ) s/2),    a = x_last − s/2 + φ s

p is the parabola through the three particles before it, whose cells lie within the edge as a whole.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.extremum import Place, place_of_minimum
from contact1d.analysis.pressure import Array, Profile, spacing_of

NEGLIGIBLE = 1e-12
"""Tension or pressure below this share of the largest |p| is round-off."""
PARABOLA_POINTS = 3
"""Particles that fix a pressure parabolic in x."""
SHARES = 10
"""Steps in which the share of a cell has settled: each leaves a small part of the error, (φ − 1) s p′/2p."""
OUTSIDE = 0.05
"""By how much a share may seem to lie outside of 0…1."""
SPOT, TOLD = 1.2, 3.0
"""Error of a radius of 0 under tension, and radius from which on particles tell the contact's two edges from each other
as well as the interpolation says, both over the spacing.

Between them it is taken as a straight line. Over 6900 random contacts of independent pairs in closed form, with bodies
as sharp as two spacings, it covers at least 94 % of the errors of every size of contact; without, 85 to 90 %.
"""
MIRROR_DISTANCE = 0.25
"""Distance beyond the centre, over the spacing, from which on a force maximum is that of the other side."""
TIE_DIFFERENCE = 1e-5
"""Difference of two pressures over the largest |p| that a minimiser leaves between mirror images."""
SAME_PLACE = 1e-9
"""Distance of two edges over the spacing below which they are one and the same minimum: round-off."""


@dataclass(frozen=True)
class ContactRadius:
    """Half the distance between the two edges of a contact.

    value = (right - left) / 2 [LU]; uncertainty: estimated [LU], covers the error in at least 95 % of random cases;
    left, right: positions of the edges [LU]; reaches_end: an edge is at the chain's end, so the chain is too short and
    the true radius may be larger than value + uncertainty.
    """

    value: float
    uncertainty: float
    left: float
    right: float
    reaches_end: bool


def tensile_radius(profile: Profile) -> ContactRadius:
    """Return the radius of maximum tensile stress, between the particles: p(a) = min p on each side of the centre.

    profile: a pressure profile of one contact, n >= 3 particles. The centre is the mean of x weighted with |p|. A
    contact that has shrunk to one tensile spot has radius 0, both sides finding the same minimum. See
    `analysis.extremum` for the interpolation and its measured accuracy: a median error of 3e-4 spacings, 0.04 where
    particles snap. A radius a below TOLD spacings s is uncertain by SPOT (s - a/TOLD) at least.
    Source: Geike and Popov 2007, Section 3.2 and Fig. 4, after Greenwood.
    Raises ValueError where no particle carries tension (use `compressive_radius`), and for fewer than 3 particles.
    """
    x, p = profile.x, profile.pressure
    least, most = _extremes(profile)
    if not least < -NEGLIGIBLE * max(-least, most):
        raise ValueError("no particle carries tension, so there is no radius of maximum tensile stress")
    centre = _centre(x, p)
    spacing = spacing_of(x)
    left, right = (_edge(x, p, centre, side * spacing) for side in (-1, 1))
    found = _between(left, right)
    value = found.value if found.value > SAME_PLACE * spacing else 0.0
    return replace(found, value=value, uncertainty=max(found.uncertainty, SPOT * (spacing - value / TOLD)))


def compressive_radius(profile: Profile, residual: float = 0.0) -> ContactRadius:
    """Return where the pressure without attraction vanishes: p(a) = 0 beyond the outermost loaded particle.

    profile: a pressure profile of one contact, p >= 0, n >= 3 particles. Springs to a bulk give p = (k/s) (d - x^2/2R),
    a parabola in x, so the parabola through the three outermost loaded particles is extended to p = 0: exact there (to
    round-off), where a straight line through two overshoots by up to s^2/a with the spacing s. The edge is kept between
    the outermost loaded particle and the next. Where the parabola has no zero there (few particles, a load
    concentrated at the edge, a soft law's tail) it is halfway, give or take half a spacing.
    residual: error of each pressure, as a minimiser leaves it, over the largest one; it moves the edge by itself over
    the slope dp/dx there, in the same unit.
    No load at all: radius 0 at the middle of the chain, uncertain by half a spacing.
    Raises ValueError for fewer than 3 particles, and where a particle carries tension (use `tensile_radius`).
    """
    x, p = profile.x, profile.pressure
    least, most = _extremes(profile)
    largest = max(-least, most)
    if least < -NEGLIGIBLE * largest:
        raise ValueError("particles carry tension: the radius is that of maximum tensile stress")
    share = p / (largest or 1.0)
    return _of_edges(x, share, share > NEGLIGIBLE, partial(_zero, residual=residual))


def held_radius(profile: Profile) -> ContactRadius:
    """The radius of a contact that is held up to its edges; 0 where nothing carries.

    profile: of a chain of evenly spaced particles, n >= 3. Where fewer than three particles lie before the last one, as
    in a contact a few spacings wide, the edge is somewhere in its cell. See the module's docstring.
    Raises ValueError for fewer than 3 particles.
    """
    _extremes(profile)
    return _of_edges(profile.x, profile.pressure, profile.pressure != 0.0, _held_edge)


def whole_cells(profile: Profile, radius: ContactRadius) -> Array:
    """Pressures [FU/LU], (n,), with that of the inside at the particles at both edges, in place of a cell's share; 0
    where they stand outside of the edge, `radius`.
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
    """Where a contact that was drawn along x has its centre [LU]; 0 for one that is within a spacing of its place."""
    if profile.x.size < 2 or not np.any(profile.pressure):
        return 0.0
    centre = _centre(profile.x, profile.pressure)
    return centre if abs(centre) > spacing_of(profile.x) else 0.0


def _centre(x: Array, p: Array) -> float:
    """Mean of x weighted with |p| [LU]."""
    return float(np.average(x, weights=np.abs(p)))


def _edge(x: Array, p: Array, centre: float, outwards: float) -> Place:
    """The force maximum on one side of the centre; outwards: the spacing, negative for the left side [LU].

    A particle just beyond the centre belongs to both sides, so that a single spot is found by both. Where it is no spot
    at the centre but ties with its mirror image, the mirror image counts.
    """
    away = (x - centre) / outwards
    reach, own = np.flatnonzero(away >= -0.5), np.flatnonzero(away >= 0.0)
    place = place_of_minimum(x, p, reach)
    across = (place.position - centre) / outwards < -MIRROR_DISTANCE
    if across and own.size and float(p[own].min()) <= float(p[reach].min()) + TIE_DIFFERENCE * float(np.abs(p).max()):
        return place_of_minimum(x, p, own)
    return place


def _extremes(profile: Profile) -> tuple[float, float]:
    """The smallest and the largest pressure."""
    if len(profile.x) < PARABOLA_POINTS:
        raise ValueError(f"a contact radius needs at least {PARABOLA_POINTS} particles, got {len(profile.x)}")
    found = float(profile.pressure.min()), float(profile.pressure.max())
    if not all(map(math.isfinite, found)):
        raise ValueError("a contact radius needs a finite pressure on every particle")
    return found


def _between(left: Place, right: Place) -> ContactRadius:
    value = max(0.0, 0.5 * (right.position - left.position))
    uncertainty = 0.5 * (left.uncertainty + right.uncertainty)
    return ContactRadius(value, uncertainty, left.position, right.position, left.at_end or right.at_end)


def _of_edges(
    x: Array, p: Array, carries: NDArray[np.bool_], edge: Callable[[list[float], list[float], int, int], Place]
) -> ContactRadius:
    """Between the right `edge` of the particles that carry, first … last, and that of the mirror image.

    An edge has x and p of the last ones alone, PARABOLA_POINTS and one more, and of the next particle if there is one.
    """
    carrying, end = np.flatnonzero(carries), len(x) - 1
    if carrying.size == 0:
        middle = float(0.5 * (x.max() + x.min()))
        return ContactRadius(0.0, 0.5 * spacing_of(x), middle, middle, False)
    first, last = int(carrying[0]), int(carrying[-1])
    sides = [(x, p, first, last), (-x[::-1], p[::-1], end - last, end - first)]
    found = []
    # A contact that is the same on both sides has one edge.
    for places, pressures, least, most in sides[: 1 if x[0] == -x[-1] and (p == p[::-1]).all() else 2]:
        low = max(0, most - PARABOLA_POINTS)
        near = slice(low, most + 2)
        found.append(edge(places[near].tolist(), pressures[near].tolist(), least - low, most - low))
    right, mirrored = found[0], found[-1]
    return _between(Place(-mirrored.position, mirrored.uncertainty, mirrored.at_end), right)


def _zero(x: list[float], p: list[float], first: int, last: int, residual: float) -> Place:
    """Right edge of a contact whose loaded particles are first … last; pressures over the largest one."""
    if last == len(x) - 1:
        return Place(x[last], x[last] - x[last - 1], True)
    inner, outer = x[last], x[last + 1]
    zero, other = (
        _parabola_zero(x[end - 2 : end + 1], p[end - 2 : end + 1], inner, outer, residual)
        if end - PARABOLA_POINTS >= first - 1
        else None
        for end in (last, last - 1)
    )
    if zero is None:
        return Place(0.5 * (inner + outer), 0.5 * (outer - inner))
    if other is None:
        return Place(zero.position, max(outer - zero.position, zero.position - inner))
    return Place(zero.position, min(abs(zero.position - other.position) + zero.uncertainty, outer - inner))


def _parabola_zero(x: list[float], p: list[float], inner: float, outer: float, residual: float) -> Place | None:
    """Falling zero, between inner and outer, of the parabola through three particles; None if there is none.

    c + b t + a t^2 falls with the slope -sqrt(D), D = b^2 - 4ac, at t = c/q for b < 0 and else at q/a, where
    q = -(b + sign(b) sqrt(D))/2: no difference of near numbers, so that a straight line (a cone's pressure) is no
    special case.
    """
    width = outer - inner
    (first, second, third), (high, middle, low) = ((place - inner) / width for place in x), p
    chord, slope = (low - high) / (third - first), (low - middle) / (third - second)
    a = (slope - chord) / (second - first)
    b = slope - a * (second + third)
    c = low - third * (b + a * third)
    square = b**2 - 4.0 * a * c
    if square <= 0.0 or min(a, b) >= 0.0:
        return None
    falling = math.sqrt(square)
    q = -0.5 * (b + math.copysign(falling, b))
    place = c / q if b < 0.0 else q / a
    moved = residual / falling  # a pressure that is lost in the residual may have been the outermost
    if not -NEGLIGIBLE - moved <= place <= 1.0 + NEGLIGIBLE + moved:
        return None
    return Place(inner + width * place, NEGLIGIBLE * (abs(inner) + width) + width * moved)


def _held_edge(x: list[float], p: list[float], first: int, last: int) -> Place:
    """Right edge of a contact that is held from the particle first to last."""
    spacing = (x[-1] - x[0]) / (len(x) - 1)
    somewhere = Place(x[last], 0.5 * spacing, last == len(x) - 1)
    if last - first <= PARABOLA_POINTS:  # the last one of them is at the other edge
        return somewhere
    *inner, carried = p[last - PARABOLA_POINTS : last + 1]
    found, straight = _share(carried, inner), _share(carried, [2.0 * inner[1] - inner[2], inner[1], inner[2]])
    if not -OUTSIDE <= found <= 1.0 + OUTSIDE:
        return somewhere
    share = min(max(found, 0.0), 1.0)
    off = min(0.5, abs(found - straight)) * spacing
    return Place(x[last] + (share - 0.5) * spacing, off, somewhere.at_end)


def _share(carried: float, inner: list[float]) -> float:
    """φ of the last particle by the parabola through the pressures of three before it, NaN where it has none."""
    bend = inner[2] - 2.0 * inner[1] + inner[0]
    slope = inner[2] - inner[1] + 0.5 * bend
    share = 1.0
    for _ in range(SHARES):
        t = 1.0 - 0.5 * (1.0 - share)  # from the particle before, in spacings
        inside = inner[2] + slope * t + 0.5 * bend * t * t
        if inside == 0.0:
            return math.nan
        share = carried / inside
    return share
