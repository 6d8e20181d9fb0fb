"""Shear traction q(r) under an axisymmetric body from the line shear of its plane image, which has kinks.

As the pressure (`analysis.abel`) it is the inverse Abel transform q(r) = -(1/pi) int_r^inf q'(x)/sqrt(x^2 - r^2) dx
(Popov and Hess 2015, chapter 5). Where a zone that sticks and one that slips meet the line shear has a kink, and q(r) a
vertical tangent: between kinks it is smooth, a spline for each zone, and on a parabola all of that is exact.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact1d.analysis.abel import FEWEST, LineLoad
from contact1d.analysis.row import spacing_of

Array = NDArray[np.float64]
NEAR = 1e-6
"""Of a spacing: a particle nearer to a kink than that belongs to it."""


def kinks_of(stick: Sequence[float], contact: Sequence[float]) -> list[list[float]]:
    """Return the kinks that the line shear has after each row, inside of the edge, rising [length].

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
        if c > before:
            kept += [old for old in (before, edge) if 0.0 < old < c]
        kept = sorted({old for old in kept if old < c})
        found.append([*kept, c] if 0.0 < c < a else list(kept))
        before, edge = c, a
    return found


def shear_load(
    x: ArrayLike, shear: ArrayLike, edge: float, kinks: Sequence[float] = (), apex: bool = False
) -> LineLoad:
    """Return the even line shear through values at places: a cubic spline in each zone between kinks, 0 at the edge.

    At a kink it is the mean of what the zones on both sides come to there. A kink is left out that would leave fewer
    than FEWEST places on one side of it.

    Args:
        x: places, rising and the same on both sides of 0, shape (n,) [length].
        shear: there, shape (n,) [force/length].
        edge: a, beyond which there is none [length].
        kinks: inside of it [length].
        apex: whether the body has one at x = 0, so that a slope there is meant.

    Raises:
        ValueError: fewer than FEWEST places on a side within the edge, or places that are not the same on both sides.
    """
    places, values = np.asarray(x, dtype=np.float64), np.asarray(shear, dtype=np.float64)
    half = places.size // 2
    spacing = spacing_of(places)
    if places.size < 2 or np.abs(places + places[::-1]).max() > NEAR * spacing:
        raise ValueError("the places must be the same on both sides of 0")
    right, mean = places[half:], 0.5 * (values[half:] + values[::-1][half:])
    inside = right < edge - NEAR * spacing
    right, mean = right[inside], mean[inside]
    if right.size < FEWEST:
        raise ValueError(f"a shear needs {FEWEST} places on each side of the axis, got {right.size}")
    borders = [edge]
    for kink in sorted(kinks, reverse=True):
        beyond, within = (right > kink) & (right < borders[0]), right < kink
        if kink < borders[0] and beyond.sum() >= FEWEST and within.sum() >= FEWEST:
            borders.insert(0, kink)
    low, breaks, coefficients = 0.0, [0.0], []
    for border, zone in zip(borders, _zones(right, borders, NEAR * spacing), strict=True):
        ends = [(low, _height(right, mean, low, NEAR * spacing)), (border, 0.0)]
        if border != edge:
            ends[1] = (border, _height(right, mean, border, NEAR * spacing))
        starts, pieces = _spline(right[zone], mean[zone], ends, low == 0.0, apex)
        breaks += [*starts[1:], border]
        coefficients.append(pieces)
        low = border
    return LineLoad(np.asarray(breaks), np.concatenate(coefficients, axis=1))


def _zones(places: Array, borders: Sequence[float], near: float) -> list[NDArray[np.bool_]]:
    """Which places lie in each zone; one on a border lies in none, and one at the axis in the first."""
    starts = [-np.inf, *borders[:-1]]
    return [(places > low + near) & (places < high - near) for low, high in zip(starts, borders, strict=True)]


def _height(places: Array, values: Array, border: float, near: float) -> float:
    """The mean of the parabolas through the FEWEST places next to a border, on both sides of it."""
    found = []
    for side in (places < border - near, places > border + near):
        at, there = places[side], values[side]
        nearest = np.argsort(np.abs(at - border))[:FEWEST]
        if nearest.size == FEWEST:
            found.append(np.polynomial.Polynomial.fit(at[nearest], there[nearest], FEWEST - 1)(border))
    return float(np.mean(found))


def _spline(
    places: Array, values: Array, ends: Sequence[tuple[float, float]], first: bool, apex: bool
) -> tuple[Array, Array]:
    """Where each cubic of a zone begins, and its coefficients in powers of x, shape (4, n).

    The `first` zone is mirrored at the axis, unless the body has an `apex` there.
    """
    from scipy.interpolate import CubicSpline

    (low, start), (high, end) = ends
    x, y = np.append(places, high), np.append(values, end)
    if not first:
        x, y = np.insert(x, 0, low), np.insert(y, 0, start)
    elif not apex:
        mirrored = x > 0.0
        x, y = np.append(-x[mirrored][::-1], x), np.append(y[mirrored][::-1], y)
    spline = CubicSpline(x, y)
    begin = max(int(np.searchsorted(x, low, side="right")) - 1, 0)
    starts, local = x[begin:-1].copy(), spline.c[::-1, begin:]
    shift = -starts
    pieces = np.zeros((4, starts.size))
    for power, coefficients in enumerate(local):
        for k in range(power + 1):  # (x + shift)^power
            pieces[k] += math.comb(power, k) * coefficients * shift ** (power - k)
    starts[0] = low
    if first and not apex:
        pieces[1, 0] = 0.0
    return starts, pieces
