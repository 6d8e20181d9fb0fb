"""Shapes f(r; θ) of a body of revolution, with the derivatives that a fit needs: named ones, and a smooth curve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ShapeName = Literal["parabola", "circle", "power"]


@dataclass(frozen=True)
class Form:
    """A shape f(r; θ), with r and f in any one unit of length.

    Attributes:
        name: of a named shape, or "smooth".
        value: returns f, (n,) [length], of r ≥ 0, (n,) [length], and θ, (k,).
        slope: returns ∂f/∂r, (n,), dimensionless.
        gradient: returns ∂f/∂θ, (n, k).
        start: θ, (k,), to begin a fit with.
        least: lower bounds of θ, (k,).
        powers: exponents of length in the unit of each θ, (k,).
        knots: radii of the knots of a smooth curve, (k + 1,), from 0 [length]; None of a named shape.
        convex: whether θ of a smooth curve are the increments of the slope from knot to knot, and not the slopes.
    """

    name: str
    value: Callable[[Array, Array], Array]
    slope: Callable[[Array, Array], Array]
    gradient: Callable[[Array, Array], Array]
    start: Array
    least: Array
    powers: Array
    knots: Array | None = None
    convex: bool = False

    def shown(self, theta: Array) -> Array:
        """Return θ, (…, k), with values below the lower bounds set to these; a new array.

        Of a convex smooth curve its increments are added up, so that they are the slopes at the knots.
        """
        theta = np.maximum(theta, self.least)
        return np.cumsum(theta, axis=-1) if self.convex else theta


def named(shape: ShapeName, curvature: float) -> Form:
    """Return a shape by its name: "parabola" r²/2R, "circle" R − √(R² − r²), or "power" h rⁿ.

    θ is (1/R), bounded by 1/R ≥ 0, or (h, n), bounded by h ≥ 0 and n ≥ 1. Of a circle 1 − r²/R² is 1e-6 at least, so
    that it has values beyond r = R, too.

    Args:
        shape: the name.
        curvature: 1/R to begin a fit with [1/length]; a power begins with n = 2 and h = 1/2R.
    """
    tiny = 1e-300  # in place of 0 in a logarithm
    if shape == "power":
        return Form(
            shape,
            lambda r, p: p[0] * r ** p[1],
            lambda r, p: p[0] * p[1] * r ** (p[1] - 1.0),
            lambda r, p: np.stack([r ** p[1], p[0] * r ** p[1] * np.log(np.maximum(r, tiny))], axis=1),
            np.asarray([0.5 * curvature, 2.0]),
            np.asarray([0.0, 1.0]),
            np.asarray([1.0, 0.0]),
        )
    bend = 0.0 if shape == "parabola" else 1.0

    def root(r: Array, p: Array) -> Array:
        """Return √(1 − r²/R²), (n,), of a circle and 1 of a parabola, of radii r, (n,), and p = (1/R,).

        It is 1e-3 at least, also for r > R.
        """
        return np.asarray(np.sqrt(np.maximum(1.0 - bend * (p[0] * r) ** 2, 1e-6)))

    return Form(
        shape,
        lambda r, p: p[0] * r**2 / (1.0 + root(r, p)),
        lambda r, p: p[0] * r / root(r, p),
        lambda r, p: (r**2 / root(r, p) ** bend / (1.0 + root(r, p)))[:, None],
        np.asarray([curvature]),
        np.zeros(1),
        -np.ones(1),
    )


def smooth(knots: Array, convex: bool) -> Form:
    """Return a curve f(r) whose slope is linear between knots and 0 on the axis; θ ≥ 0 is dimensionless, (k,).

    A fit begins with f = r²/2. Beyond the last knot the last piece goes on.

    Args:
        knots: radii, rising from 0, (k + 1,) [length].
        convex: whether θ are the increments of the slope from knot to knot; else they are the slopes at all knots but
            0.
    """
    from scipy.interpolate import make_interp_spline  # which takes longer to import than a small run

    many = len(knots) - 1
    at_knots = np.tril(np.ones((many, many))) if convex else np.eye(many)
    slopes = make_interp_spline(knots, np.vstack([np.zeros(many), at_knots]), k=1)
    heights = slopes.antiderivative()
    return Form(
        "smooth",
        lambda r, p: heights(r) @ p,
        lambda r, p: slopes(r) @ p,
        lambda r, _: heights(r),
        np.asarray(np.linalg.solve(at_knots, knots[1:])),
        np.zeros(many),
        np.zeros(many),
        knots,
        convex,
    )
