"""Contact radius of a row of springs that are held up to an edge, where the pressure jumps to zero: JKR's, reduced.

The last particle that carries stands for the share φ of its cell, x ± s/2, that lies within the edge: with p(x) the
pressure inside, continued to the middle of that share,

    p_last = φ p(x_last − (1 − φ) s/2),    a = x_last − s/2 + φ s

p is the parabola through the three particles before it, whose cells lie within the edge as a whole.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.extremum import Place
from contact1d.analysis.pressure import Profile, middle_of, spacing_of
from contact1d.analysis.radius import ContactRadius

Array = NDArray[np.float64]

INNER = 3
"""Particles before the last that fix a parabola."""
SHARES = 10
"""Steps in which the share has settled: each leaves a small part of the error, (φ − 1) s p′/2p."""
OUTSIDE = 0.05
"""By how much a share may seem to lie outside of 0…1."""


def held_radius(profile: Profile) -> ContactRadius:
    """The radius of a contact that is held up to its edges; 0 where nothing carries.

    profile: of a chain of evenly spaced particles, n >= 3. Where fewer than INNER particles lie before the last one, as
    in a contact a few spacings wide, the edge is somewhere in its cell. See the module's docstring.
    Raises ValueError for fewer than 3 particles.
    """
    x, p = profile.x, profile.pressure
    if len(x) < INNER:
        raise ValueError(f"a contact radius needs at least {INNER} particles, got {len(x)}")
    spacing = spacing_of(x)
    held = np.flatnonzero(p != 0.0)
    if held.size == 0:
        middle = middle_of(x)
        return ContactRadius(0.0, 0.5 * spacing, middle, middle, False)
    first, last = int(held[0]), int(held[-1])
    right = _edge(x[: last + 1], p[: last + 1], last - first, spacing, last == len(x) - 1)
    mirrored = _edge(-x[first:][::-1], p[first:][::-1], last - first, spacing, first == 0)
    left = -mirrored.position
    uncertainty = 0.5 * (right.uncertainty + mirrored.uncertainty)
    ends = right.at_end or mirrored.at_end
    return ContactRadius(0.5 * (right.position - left), uncertainty, left, right.position, ends)


def whole_cells(profile: Profile, radius: ContactRadius) -> Array:
    """Pressures [FU/LU], (n,), with that of the inside at the particles at both edges, in place of a cell's share; 0
    where they stand outside of the edge, `radius`.
    """
    x, p = profile.x, profile.pressure.copy()
    held = np.flatnonzero(p != 0.0)
    if held.size < 2 * INNER + 2:
        return p
    for last, inwards in ((int(held[-1]), -1), (int(held[0]), 1)):
        inner = [float(p[last + k * inwards]) for k in (3, 2, 1)]
        inside = radius.left <= x[last] <= radius.right
        p[last] = inner[0] - 3.0 * inner[1] + 3.0 * inner[2] if inside else 0.0
    return p


def _edge(x: Array, p: Array, before: int, spacing: float, at_end: bool) -> Place:
    """The right edge of a contact whose last particle is that of x and p; `before` it so many others are held."""
    place, carried = float(x[-1]), float(p[-1])
    inner = [float(value) for value in p[-1 - INNER : -1]]
    if before <= INNER:  # the last one of them is at the other edge
        return Place(place, 0.5 * spacing, at_end)
    found, straight = _share(carried, inner), _share(carried, [2.0 * inner[1] - inner[2], inner[1], inner[2]])
    if not -OUTSIDE <= found <= 1.0 + OUTSIDE:
        return Place(place, 0.5 * spacing, at_end)
    share = min(max(found, 0.0), 1.0)
    return Place(place + (share - 0.5) * spacing, min(0.5, abs(found - straight)) * spacing, at_end)


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
