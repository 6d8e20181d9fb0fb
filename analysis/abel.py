"""The pressure under an axisymmetric body from the line load of its image: the inverse Abel transform, p(r).

The method of dimensionality reduction (MDR) keeps force, displacement and radius; its line load q(x) [force/length] is
the body's pressure p(r) seen from the side, and so (Popov and Heß 2015, chapter 2; W. C. Hayes' form of Sneddon's)

    q(x) = 2 ∫_x^∞ r p(r)/√(r² − x²) dr,     p(r) = −(1/π) ∫_r^∞ q′(x)/√(x² − r²) dx

With q a polynomial between neighbouring positions, q′ = c₀ + c₁ x + c₂ x², each piece has a closed form,

    ∫ q′/√(x² − r²) dx = (c₀ + c₂ r²/2) arcosh(x/r) + (c₁ + c₂ x/2) √(x² − r²)

and where q ends at the edge a by a jump q(a), as under a flat punch or in JKR, that adds q(a)/π√(a² − r²). So the root
at Hertz's edge, the pole at that of a punch and the logarithm at a cone's tip are exact, without a fine grid.

Independent springs on a plane have the shape of the body, q(x) = c (d − h(x)), and its x^n is no even polynomial at the
axis unless n is even. Polynomials then go through q + c h, and

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

NODES = 16
"""Gauss's positions in an interval; with 20 intervals that halve towards an end an integral is good to 1e-12."""
Body = Callable[[Array], Array]
FEWEST = 3
"""Positions on one side of the axis that determine a shape."""


@dataclass(frozen=True)
class LineLoad:
    """An even line load as cubics between positions: q(x) for 0 ≤ x ≤ edge, 0 beyond; q(−x) = q(x).

    Attributes:
        breaks: 0 = x₀ < x₁ < … < x_n = edge, shape (n + 1,) [length].
        coefficients: of q = Σ_k coefficients[k] x^k between them, shape (4, n); with a `body` those of q + c h.
        body: returns c h(x), (…) [force/length], of positions x ≥ 0, (…); None: the cubics are those of q itself.
        kinks: positions at which the slope of the body jumps [length].
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
        """The contact radius a, beyond which there is no line load [length]."""
        return float(self.breaks[-1])

    @property
    def at_edge(self) -> float:
        """The line load just inside the edge [force/length]: `jump`.

        Without it that of the cubic, less c h of a body.
        """
        if self.jump is not None:
            return self.jump
        of_body = 0.0 if self.body is None else float(self.body(np.asarray([self.edge]))[0])
        return float(np.polynomial.polynomial.polyval(self.edge, self.coefficients[:, -1])) - of_body

    @property
    def has_apex(self) -> bool:
        """Whether `apex` is set or the first cubic has a term linear in x.

        The pressure is then unbounded on the axis.
        """
        return self.apex or bool(self.coefficients[1, 0] != 0.0)

    def pressure(self, r: ArrayLike) -> Array:
        """Return p(r) [force/length²], of the shape of r, compression positive as q; 0 from the edge on.

        At r = 0 under an apex it is infinite: +∞ where the body has the apex, else with the sign of −dq/dx there.

        Args:
            r: distances from the axis ≥ 0, any shape [length].
        """
        radii = np.atleast_1d(np.asarray(r, dtype=np.float64))
        inside = radii < self.edge
        p = np.zeros_like(radii)
        wanted, chunk_size = radii[inside], 100  # which bounds the memory
        chunks = np.array_split(wanted, range(chunk_size, wanted.size, chunk_size))
        p[inside] = np.concatenate([self._pressure(chunk[:, None]) for chunk in chunks])
        return p.reshape(np.shape(r))

    def _pressure(self, r: Array) -> Array:
        """Return p [force/length²], (n,), at distances r from the axis, (n, 1), below the edge.

        At r = 0 of an apex it is +∞ where `apex` is set, else ∞ with the sign of −dq/dx there.
        """
        ends = np.maximum(self.breaks, r)
        root = np.sqrt((ends - r) * (ends + r))
        c_0, c_1, c_2 = (k * self.coefficients[k] for k in (1, 2, 3))
        total = np.sum(c_1 * np.diff(root) + 0.5 * c_2 * np.diff(ends * root), axis=1)
        off, on = r[:, 0] > 0.0, r[:, 0] == 0.0
        total[off] += np.sum((c_0 + 0.5 * c_2 * r[off] ** 2) * np.diff(np.arccosh(ends[off] / r[off])), axis=1)
        total[on] += np.sum(c_0[1:] * np.diff(np.log(self.breaks[1:])))
        p = (self.at_edge / root[:, -1] - total) / np.pi
        if self.body is not None:
            borders = sorted({0.0, *self.kinks, self.edge, np.inf})
            piece, end = np.searchsorted(borders, r[:, 0], side="right") - 1, borders.index(self.edge) + 2
            for group in (on, *(off & (piece == first) for first in np.unique(piece))):
                if group.any():
                    # Line loads through every and every second position have the same body.
                    p[group] += _of_body(self.body, r[group, 0].tobytes(), tuple(borders[piece[group][0] : end]))
        if self.has_apex:
            p[on] = np.inf if self.apex else np.copysign(np.inf, -c_0[0])
        return np.asarray(p)


@cache
def _differences() -> Array:
    """Return M, (16, 16), of ∫ w dh = w·M h over an interval, w and h the values at its 16 Gauss-Legendre positions.

    It is dimensionless: the length of the interval cancels. The result is cached.
    """
    node, weight = gauss(NODES)
    powers = np.polynomial.legendre.legvander(node, NODES - 1)
    slopes = np.polynomial.legendre.legvander(node, NODES - 2) @ np.polynomial.legendre.legder(np.eye(NODES))
    return weight[:, None] * np.linalg.solve(powers.T, slopes.T).T


def _graded(width: Array, smooth: Array, halvings: int = 20) -> Array:
    """Return distances from one end of intervals, (…, m), rising: borders of parts whose length grows geometrically.

    They go from `smooth`, but at least 0.5^halvings of the width and at most half of it, to half the width; m follows
    from the largest ratio of the two, so that borders double at most.

    Args:
        width: lengths of the intervals, (…).
        smooth: distance from the end over which the integrand is smooth, (…); 0: it is singular at the end itself.
        halvings: largest number of halvings.
    """
    half, least = 0.5 * width[..., None], np.clip(smooth, 0.5**halvings * width, 0.5 * width)[..., None]
    count = math.ceil(np.log2((half / least).max()))
    return least * (half / least) ** np.linspace(0.0, 1.0, count + 1)


@lru_cache(maxsize=64)
def _of_body(body: Body, distances: bytes, borders: Sequence[float]) -> Array:
    """Return (1/π) ∫ dh/t, (n,) [force/length²], with x² = r² + t²: the pressure that belongs to c h(x) of a body.

    The integral goes from t = 0 to the edge. h is smooth in t up to √(r² − x²) of the kink x before, and from the edge
    to the next kink; on the axis the remainder at 0 is that of a power of t. The result is cached.

    Args:
        body: returns c h(x) [force/length].
        distances: r, (n,) [length], as the bytes of an array of float64.
        borders: the axis or the kink before all r, the kinks beyond r, the edge, and the kink beyond it, ∞ without one.
    """
    (node, _), r = gauss(NODES), np.frombuffer(distances)
    ends = np.stack([np.zeros_like(r), *(np.sqrt((x - r) * (x + r)) for x in borders[1:])], axis=1)
    width, smooth = np.diff(ends, axis=1), 0.5 * np.sqrt((r - borders[0]) * (r + borders[0]))
    ends, width, beyond, zero = ends[:, :-1], width[:, :-1], width[:, -1:], np.zeros_like(width[:, 1:-1])
    up = ends[:, :-1, None] + _graded(width, np.append(smooth[:, None], zero, axis=1))
    down = ends[:, 1:, None] - _graded(width, np.append(zero, beyond, axis=1))[..., -2::-1]
    graded = np.concatenate([up, down, ends[:, 1:, None]], axis=-1)

    def height(t: Array) -> Array:
        """Return c h [force/length] at √(r² + t²), of the shape of t, (n, …) [length], the first index that of r."""
        return body(np.sqrt(r.reshape(-1, *(1,) * (t.ndim - 1)) ** 2 + t * t))  # hypot takes five times as long

    def integral(low: Array, high: Array) -> Array:
        """Return ∫ dh/t from low to high, (…) each, by Gauss-Legendre quadrature [force/length²]."""
        t = 0.5 * ((low + high)[..., None] + (high - low)[..., None] * node)
        return np.asarray(np.sum((height(t) @ _differences().T) / t, axis=-1))

    total = np.sum(integral(graded[..., :-1], graded[..., 1:]), axis=(1, 2))
    # Below the first interval of a piece h rises as a root at most; 1/t is singular at the axis only.
    first = graded[..., 0]
    rise = height(first) - height(ends[:, :-1])
    total += np.sum(rise[:, 1:] / first[:, 1:], axis=1)
    start, up = first[:, 0], rise[:, 0]
    twice = (height(2.0 * first[:, :1]) - height(ends[:, :1]))[:, 0]
    ratio = np.divide(twice, up, out=np.full_like(up, 4.0), where=up > 0.0)
    power = np.maximum(np.log2(np.maximum(ratio, 1.0)), 1.0 + 1e-9)  # h − h(0) ∝ t^power, above 1: bounded
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
    """Return the even line load through values: cubics through the four nearest positions, both sides averaged.

    Polynomials up to x³ on each side (Hertz, cone, flat punch) are exact, others of the third order in the spacing.
    Values beyond the edge are left out, and those within 0.3 spacings of it, half a spacing unless `jump` is 0.

    Args:
        x: positions, rising and the same on both sides of 0, shape (n,) [length].
        load: q there, shape (n,) [force/length].
        edge: contact radius a [length]; None: the last position.
        jump: q just inside the edge [force/length], from which it jumps to 0; None: the last cubic goes on to the edge.
        apex: whether q has a kink on the axis, as under a cone; else it is smooth there, an even function.
        body: returns c h(x) [force/length]: cubics are put through q + c h, which is smooth on the axis.
        kinks: positions at which the slope of the body jumps [length]; not used without a body.

    Raises:
        ValueError: fewer than 3 positions on a side within the edge, positions that differ between both sides, or
            arrays of unequal lengths.
    """
    right, mean, spacing = of_both_sides(x, load)
    end = float(right[-1]) if edge is None else edge
    # Nearer to the edge a slope is mostly noise; where q jumps, the edge cuts off a cell that reaches it, ± round-off.
    inside = right <= end - (0.3 if jump == 0.0 else 0.5 - 1e-6) * spacing
    right, mean = right[inside], mean[inside]
    if right.size < FEWEST:
        raise ValueError(f"a pressure needs {FEWEST} positions on each side of the axis, got {right.size}")
    if jump is not None:
        right, mean = np.append(right, end), np.append(mean, jump)
    if body is not None:
        mean = mean + body(right)
    if apex and body is None:
        return _cubics(right, mean, end)
    even = _even(right, mean, end)
    return even if body is None else replace(even, body=body, kinks=kinks, jump=jump, apex=apex)


def _even(x: Array, q: Array, end: float) -> LineLoad:
    """Return the line load from 0 to `end` by cubics through values and their mirror images, smooth on the axis.

    It is that of the values, without a body, jump or apex.

    Args:
        x: positions ≥ 0, rising, (n,) [length].
        q: line load there, (n,) [force/length].
        end: where it ends [length].
    """
    mirrored = slice(None) if x[0] > 0.0 else slice(1, None)
    even = _cubics(np.append(-x[mirrored][::-1], x), np.append(q[mirrored][::-1], q), end)
    if x[0] > 0.0:
        even.coefficients[1, 0] = 0.0  # by symmetry, but for round-off
    else:  # the four nearest are not the same on both sides of the axis
        even.coefficients[:, 0] = (q[0], 0.0, (q[1] - q[0]) / x[1] ** 2, 0.0)
    return even


def of_both_sides(x: ArrayLike, load: ArrayLike) -> tuple[Array, Array, float]:
    """Return positions x ≥ 0, (m,) [length], the mean load of both sides there, (m,), and the spacing [length].

    The load keeps its unit. The positions must be the same on both sides of 0 to 1e-6 spacings; m is half of their
    number, rounded up. The spacing is the mean distance of neighbours.

    Args:
        x: positions, rising, (n,) [length].
        load: values there, (n,).

    Raises:
        ValueError: arrays of unequal lengths or not 1-D, or positions that differ between both sides.
    """
    positions, values = np.asarray(x, dtype=np.float64), np.asarray(load, dtype=np.float64)
    if positions.shape != values.shape or positions.ndim != 1:
        raise ValueError(f"positions and loads must be 1-D and equally long, got {positions.shape} and {values.shape}")
    spacing = spacing_of(positions)
    if not np.abs(positions + positions[::-1]).max() <= 1e-6 * spacing:  # more than round-off
        raise ValueError("the positions must be the same on both sides of 0")
    half = positions.size // 2
    return positions[half:], 0.5 * (values + values[::-1])[half:], spacing


def _cubics(x: Array, q: Array, end: float) -> LineLoad:
    """Return the line load from 0 to the `end` [length] by the cubics through the four nearest positions.

    Through fewer than four positions it is the parabola or the straight line through all of them.

    Args:
        x: positions, rising, (n,) [length]; those below 0 are mirror images.
        q: line load there, (n,) [force/length].
        end: where it ends [length].
    """
    count = min(4, x.size)
    right_of_axis = x[x > 1e-12 * end]
    inner = right_of_axis[right_of_axis < end * (1.0 - 1e-12)]
    breaks = np.concatenate([[0.0], inner, [end]])
    middle = 0.5 * (breaks[1:] + breaks[:-1])
    first = np.clip(np.searchsorted(x, middle) - count // 2, 0, x.size - count)
    nearest = first + np.arange(count)[:, None]
    newton = [q[first], *(difference[0] for difference in divided(x[nearest], q[nearest]))]
    return LineLoad(breaks, in_powers(np.stack(newton), x[nearest]))


def in_powers(newton: Array, positions: Array) -> Array:
    """Return the coefficients in powers of x, (4, n), of n polynomials Σ_k newton[k] Π_{j<k} (x − positions[j]).

    Args:
        newton: divided differences of each polynomial, (k, n), k ≤ 4; with fewer than four the highest powers are 0.
        positions: those of Newton's form, (k, n); the last row is not used.
    """
    powers = np.zeros((4, newton.shape[1]))
    for value, position in zip(newton[::-1], positions[::-1], strict=True):
        powers[1:] = powers[:-1] - position * powers[1:]
        powers[0] = value - position * powers[0]
    return powers
