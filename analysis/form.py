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
    """A shape f(r; θ).

    Attributes:
        name: of a named shape, or "smooth".
        value: f, (n,), of r ≥ 0 and θ.
        slope: ∂f/∂r, (n,).
        gradient: ∂f/∂θ, (n, k).
        start: θ, (k,), to begin with.
        least: lower bounds of θ, (k,).
        powers: exponents of length in the unit of each θ, (k,).
        knots: of a smooth curve, (k + 1,), from 0.
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
        """Return θ, (…, k), within its bounds; of a smooth curve as slopes at the knots."""
        theta = np.maximum(theta, self.least)
        return np.cumsum(theta, axis=-1) if self.convex else theta


def named(shape: ShapeName, curvature: float) -> Form:
    """Return a named shape: θ = (1/R), or (h, n) of h rⁿ."""
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
        """Return √(1 − r²/R²) of a circle, bounded from below for a trial radius R < r, and 1 of a parabola."""
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
    """Return a smooth curve: θ are the slopes at the knots, or their increments; on the axis the slope is 0."""
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
