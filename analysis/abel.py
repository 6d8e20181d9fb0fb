"""The pressure under an axisymmetric body from the line load of its image: the inverse Abel transform, p(r).

The method of dimensionality reduction (MDR) keeps force, displacement and radius; its line load q(x) [force/length] is
the body's pressure p(r) seen from the side, and so (Popov and Heß 2015, chapter 2; W. C. Hayes' form of Sneddon's)

    q(x) = 2 ∫_x^∞ r p(r)/√(r² − x²) dr,     p(r) = −(1/π) ∫_r^∞ q′(x)/√(x² − r²) dx

With q a polynomial between neighbouring positions, q′ = c₀ + c₁ x + c₂ x², each piece has a closed form,

    ∫ q′/√(x² − r²) dx = (c₀ + c₂ r²/2) arcosh(x/r) + (c₁ + c₂ x/2) √(x² − r²)

and where q ends at the edge a by a jump q(a), as under a flat punch or in JKR, that adds q(a)/π√(a² − r²). So the root
at Hertz's edge, the pole at a punch's and the logarithm at a cone's tip are exact, not resolved by a grid.

Independent springs on a plane have the body's own shape, q(x) = c (d − h(x)), whose x^n no polynomial follows at the
axis unless n is even. There polynomials are put through q + c h alone, and

    p(r) = … + (c/π) ∫ dh/t,   x² = r² + t²,  0 < t < √(a² − r²)

over intervals that halve towards the axis, and on both sides towards a kink, where h rises as a root.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from contact1d.analysis.polynomial import divided, gauss
from contact1d.analysis.pressure import Array, spacing_of

NEAR = 0.3
"""Of a spacing: a place closer to the edge than that is left out, since a slope over so short a way is mostly noise."""
WHOLE = 0.5 - 1e-6
"""The same where q jumps to 0 at the edge: a particle represents its cell on either side, and has less where the edge
cuts that off."""
SAME = 1e-6
"""Of a spacing: positions so alike on both sides of the axis are the same."""
AT_ONCE = 100
"""Distances from the axis that are worked out at once, to bound the memory."""
HALVINGS, NODES = 20, 16
"""Intervals of an integral that halve towards each end, and Gauss's positions in each: to 1e-12 of it."""
LEAST = 0.5**HALVINGS
"""Width of the first of them over that of all, at least."""
EPSILON = 1e-9
"""Of a power above 1, whose integral has a bound."""
Body = Callable[[Array], Array]
FEWEST = 3
"""Positions on one side that determine a shape."""


@dataclass(frozen=True)
class LineLoad:
    """An even line load as cubics between positions: q(x) for 0 ≤ x ≤ edge, nothing beyond.

    Attributes:
        breaks: 0 = x₀ < x₁ < … < x_n = edge, shape (n + 1,) [length].
        coefficients: of q = Σ_k coefficients[k] x^k between them, shape (4, n); with a `body` of q + c h.
        body: c h(x) of positions x of any shape [force/length], where it is known.
        kinks: positions at which its slope jumps [length].
        jump: q just inside the edge [force/length], where it is known; None: that of the polynomials.
        apex: whether the body's slope does not vanish on the axis.
    """

    breaks: Array
    coefficients: Array
    body: Body | None = None
    kinks: Sequence[float] = ()
    jump: float | None = None
    apex: bool = False

    @property
    def edge(self) -> float:
        """Where it ends [length]."""
        return float(self.breaks[-1])

    @property
    def at_edge(self) -> float:
        """q just inside the edge [force/length]: the jump there."""
        if self.jump is not None:
            return self.jump
        less = 0.0 if self.body is None else float(self.body(np.asarray([self.edge]))[0])
        return float(np.polynomial.polynomial.polyval(self.edge, self.coefficients[:, -1])) - less

    @property
    def has_apex(self) -> bool:
        """Whether its slope does not vanish on the axis: the pressure then grows without bound there."""
        return self.apex or bool(self.coefficients[1, 0] != 0.0)

    def pressure(self, r: ArrayLike) -> Array:
        """Return p(r) [force/length²], exactly; infinite at r = 0 under an apex, 0 from the edge on.

        Args:
            r: distances from the axis ≥ 0, any shape [length].
        """
        at = np.atleast_1d(np.asarray(r, dtype=np.float64))
        inside = at < self.edge
        p = np.zeros_like(at)
        wanted = at[inside]
        at_once = np.array_split(wanted, range(AT_ONCE, wanted.size, AT_ONCE))
        p[inside] = np.concatenate([self._pressure(some[:, None]) for some in at_once])
        return p.reshape(np.shape(r))

    def _pressure(self, r: Array) -> Array:
        """p at distances below the edge, shape (n, 1)."""
        ends = np.maximum(self.breaks, r)
        root = np.sqrt((ends - r) * (ends + r))
        c_0, c_1, c_2 = (k * self.coefficients[k] for k in (1, 2, 3))
        total = np.sum(c_1 * np.diff(root) + 0.5 * c_2 * np.diff(ends * root), axis=1)
        off, on = r[:, 0] > 0.0, r[:, 0] == 0.0
        total[off] += np.sum((c_0 + 0.5 * c_2 * r[off] ** 2) * np.diff(np.arccosh(ends[off] / r[off])), axis=1)
        total[on] += np.sum(c_0[1:] * np.diff(np.log(self.breaks[1:])))
        found = (self.at_edge / root[:, -1] - total) / np.pi
        if self.body is not None:
            places = sorted({0.0, *self.kinks, self.edge, np.inf})
            piece, end = np.searchsorted(places, r[:, 0], side="right") - 1, places.index(self.edge) + 2
            for own in (on, *(off & (piece == first) for first in np.unique(piece))):
                if own.any():
                    # Line loads through every and every second position have the same body.
                    found[own] += _of_body(self.body, r[own, 0].tobytes(), tuple(places[piece[own][0] : end]))
        if self.has_apex:
            found[on] = np.inf if self.apex else np.copysign(np.inf, -c_0[0])
        return np.asarray(found)


@cache
def _differences() -> Array:
    """M of ∫ w dh = w·M h over an interval, of values w and h at Gauss's positions in it; (NODES, NODES)."""
    node, weight = gauss(NODES)
    powers = np.polynomial.legendre.legvander(node, NODES - 1)
    slopes = np.polynomial.legendre.legvander(node, NODES - 2) @ np.polynomial.legendre.legder(np.eye(NODES))
    return np.asarray(weight[:, None] * np.linalg.solve(powers.T, slopes.T).T)


def _graded(width: Array, smooth: Array) -> Array:
    """Ends of intervals that halve towards 0, from half the `width` (…) until they are `smooth`, so long; (…, m)."""
    half, least = 0.5 * width[..., None], np.clip(smooth, LEAST * width, 0.5 * width)[..., None]
    count = math.ceil(np.log2((half / least).max()))
    return np.asarray(least * (half / least) ** np.linspace(0.0, 1.0, count + 1))


@lru_cache(maxsize=64)
def _of_body(body: Body, distances: bytes, places: Sequence[float]) -> Array:
    """(1/π) ∫ dh/t at distances r, (n,). Places: the axis or a kink before r, the kinks beyond, the edge, another kink.

    h is smooth in t up to √(r² − x²) of the kink x before, and from the edge to the next kink; on the axis the
    remainder at 0 is that of a power of t.
    """
    (node, _), r = gauss(NODES), np.frombuffer(distances)
    ends = np.stack([np.zeros_like(r), *(np.sqrt((place - r) * (place + r)) for place in places[1:])], axis=1)
    width, smooth = np.diff(ends, axis=1), 0.5 * np.sqrt((r - places[0]) * (r + places[0]))
    ends, width, beyond, none = ends[:, :-1], width[:, :-1], width[:, -1:], np.zeros_like(width[:, 1:-1])
    up = ends[:, :-1, None] + _graded(width, np.append(smooth[:, None], none, axis=1))
    down = ends[:, 1:, None] - _graded(width, np.append(none, beyond, axis=1))[..., -2::-1]
    graded = np.concatenate([up, down, ends[:, 1:, None]], axis=-1)

    def height(t: Array) -> Array:
        return body(np.sqrt(r.reshape(-1, *(1,) * (t.ndim - 1)) ** 2 + t * t))  # hypot takes five times as long

    def integral(low: Array, high: Array) -> Array:
        t = 0.5 * ((low + high)[..., None] + (high - low)[..., None] * node)
        return np.asarray(np.sum((height(t) @ _differences().T) / t, axis=-1))

    total = np.sum(integral(graded[..., :-1], graded[..., 1:]), axis=(1, 2))
    # Up to the first interval of a piece h rises as a root at most, which 1/t knows nothing of but at the axis.
    first = graded[..., 0]
    rise = height(first) - height(ends[:, :-1])
    total += np.sum(rise[:, 1:] / first[:, 1:], axis=1)
    start, up = first[:, 0], rise[:, 0]
    twice = (height(2.0 * first[:, :1]) - height(ends[:, :1]))[:, 0]
    ratio = np.divide(twice, up, out=np.full_like(up, 4.0), where=up > 0.0)
    power = np.maximum(np.log2(np.maximum(ratio, 1.0)), 1.0 + EPSILON)  # h − h(0) ∝ t^power
    inner = integral(ends[:, :1], first[:, :1])[:, 0]
    return np.asarray((total + np.where(start <= smooth, inner, power / (power - 1.0) * up / start)) / np.pi)


def line_load(
    x: ArrayLike,
    load: ArrayLike,
    edge: float | None = None,
    jump: float | None = 0.0,
    apex: bool = False,
    body: Body | None = None,
    kinks: Sequence[float] = (),
) -> LineLoad:
    """Return the even line load through values at positions, a cubic through the four nearest; of both sides the mean.

    Polynomials up to x³ on each side (Hertz, cone, flat punch) are met exactly, others with the third order of the
    spacing.

    Args:
        x: positions, rising and the same on both sides of 0, shape (n,) [length].
        load: q there, shape (n,) [force/length].
        edge: a, where it ends [length]; None: it fades out, and ends at 0 at the last position.
        jump: q just inside the edge [force/length], whence it jumps to 0; None: the last piece goes on to the edge.
        apex: whether q has a kink on the axis, as under a cone; else it is smooth there, an even function.
        body: c h(x), of which and a smooth function of h q is made.
        kinks: positions at which its slope jumps [length].

    Raises:
        ValueError: fewer than FEWEST places on a side within the edge, or places that are not the same on both sides.
    """
    right, mean, spacing = of_both_sides(x, load)
    end = float(right[-1]) if edge is None else edge
    inside = right <= end - (NEAR if jump == 0.0 else WHOLE) * spacing
    right, mean = right[inside], mean[inside]
    if right.size < FEWEST:
        raise ValueError(f"a pressure needs {FEWEST} positions on each side of the axis, got {right.size}")
    if jump is not None:
        right, mean = np.append(right, end), np.append(mean, jump)
    if body is not None:
        mean = mean + body(right)
    if apex and body is None:
        return _cubics(right, mean, end)
    own = slice(None) if right[0] > 0.0 else slice(1, None)
    even = _cubics(np.append(-right[own][::-1], right), np.append(mean[own][::-1], mean), end)
    if right[0] > 0.0:
        even.coefficients[1, 0] = 0.0  # by symmetry, but for round-off
    else:  # the four nearest are not the same on both sides of the axis
        even.coefficients[:, 0] = (mean[0], 0.0, (mean[1] - mean[0]) / right[1] ** 2, 0.0)
    return even if body is None else replace(even, body=body, kinks=kinks, jump=jump, apex=apex)


def of_both_sides(x: ArrayLike, load: ArrayLike) -> tuple[Array, Array, float]:
    """Positions from the axis on, the mean load of both sides there, and the spacing; ValueError as of `line_load`."""
    places, values = np.asarray(x, dtype=np.float64), np.asarray(load, dtype=np.float64)
    if places.shape != values.shape or places.ndim != 1:
        raise ValueError(f"positions and loads must be 1-D and equally long, got {places.shape} and {values.shape}")
    spacing = spacing_of(places)
    if not np.abs(places + places[::-1]).max() <= SAME * spacing:
        raise ValueError("the positions must be the same on both sides of 0")
    half = places.size // 2
    return places[half:], 0.5 * (values + values[::-1])[half:], spacing


def _cubics(x: Array, q: Array, end: float) -> LineLoad:
    """From 0 to the `end` the cubic through the four nearest of the positions x, of fewer a parabola or a line."""
    count = min(4, x.size)
    right_of_axis = x[x > 1e-12 * end]
    inner = right_of_axis[right_of_axis < end * (1.0 - 1e-12)]
    breaks = np.concatenate([[0.0], inner, [end]])
    middle = 0.5 * (breaks[1:] + breaks[:-1])
    first = np.clip(np.searchsorted(x, middle) - count // 2, 0, x.size - count)
    nearest = first + np.arange(count)[:, None]
    newton = [q[first], *(one[0] for one in divided(x[nearest], q[nearest]))]
    return LineLoad(breaks, in_powers(np.stack(newton), x[nearest]))


def in_powers(newton: Array, places: Array) -> Array:
    """Coefficients in powers of x, shape (4, n), of Σ_k newton[k] Π_{j<k} (x − positions[j]), k < 4 at most."""
    powers = np.zeros((4, newton.shape[1]))
    for value, place in zip(newton[::-1], places[::-1], strict=True):
        powers[1:] = powers[:-1] - place * powers[1:]
        powers[0] = value - place * powers[0]
    return powers
