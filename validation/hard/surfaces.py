"""Bodies on a plane: a scene's profile beside the body that it is; tables of bodies whose slope or curvature jumps.

A kink is a jump up of the slope, or of the curvature, at a radius b. A table has the heights at even distances.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

import numpy as np

from validation.doors import on_plane
from validation.hard.units import Scene
from validation.references.axisymmetric import Body
from validation.references.numerics import integral
from validation.references.relaxing import Flat, Power

SMOOTH = ("parabola", "cone", "power", "circle", "flat_punch", "ellipsoid")
KINKED = ("land_cone", "worn_ball", "two_slopes", "two_radii", "rounded_punch", "steps")
ROUND = ("parabola", "circle", "ellipsoid")
"""Those with a curvature at the apex."""
LAND = (0.0, 0.0, 0.0)
"""The plane piece of a body."""
WIDEST = 0.5
"""a/R of spheres, up to which they are searched."""


@dataclass(frozen=True)
class Surface:
    """A profile [LU], its slope and bend, and a radius that its contacts have about [LU]."""

    profile: Scene
    body: Body
    radius: float

    @property
    def punch(self) -> bool:
        """Whether it is a flat punch."""
        return self.body.flat

    @property
    def power(self) -> Power | Flat:
        """The body as z = c rⁿ, or as a flat punch. Raises ValueError."""
        return power_of(self.profile)

    def sampled(self, pitch: float, reach: float, digits: int | None = None) -> Surface:
        """The table of its heights at every `pitch` up to `reach` [LU], with so many digits of the largest height."""
        radii = [pitch * i for i in range(math.ceil(reach / pitch) + 1)]
        rises = (integral(self.body.slope, *self.body.corners(*ends)) for ends in pairwise(radii))
        heights = [0.0, *accumulate(rises)]
        if digits is not None:
            places = digits - 1 - math.floor(math.log10(heights[-1]))
            heights = [round(z, places) for z in heights]
        return replace(self, profile={"kind": "table", "r": radii, "z": heights})

    def tables(self, spacing: float, tolerance: float = 1e-3) -> Scene:
        """[bodies] and [accuracy] of a scene of model units, E* = 1 FU/LU²."""
        return on_plane(self.profile, spacing, tolerance)


def power_of(profile: Scene) -> Power | Flat:
    """z = c rⁿ of a parabola, a cone, a power; or a flat punch. Raises ValueError."""
    match profile["kind"]:
        case "parabola":
            return Power(2.0, 0.5 / profile["radius"])
        case "cone":
            return Power(1.0, profile["slope"])
        case "power":
            return Power(profile["exponent"], profile["height"] / profile["radius"] ** profile["exponent"])
        case "flat_punch":
            return Flat(profile["radius"])
    raise ValueError(f"{profile['kind']} is no power of r")


def surface(radius: float, kind: str, /, **numbers: float) -> Surface:
    """The profile of that kind and its body."""
    return Surface({"kind": kind} | numbers, _body(kind, **numbers), radius)


def power(one: Power | Flat, radius: float) -> Surface:
    """The profile of a power of r, or of a punch."""
    if isinstance(one, Flat):
        return surface(radius, "flat_punch", radius=one.end)
    n = one.exponent
    if n == 2.0:
        return surface(radius, "parabola", radius=0.5 / one.factor)
    if n == 1.0:
        return surface(radius, "cone", slope=one.factor)
    return surface(radius, "power", exponent=n, radius=radius, height=one.factor * radius**n)


def _body(
    kind: str, radius: float = 0.0, slope: float = 0.0, height: float = 0.0, exponent: float = 2.0,
    tip_radius: float = 0.0, land_radius: float = 0.0, edge_radius: float = 0.0, cap_radius: float = 0.0,
) -> Body:  # fmt: skip
    b = tip_radius * slope
    match kind:
        case "blunt_cone":
            return pieces((0.0, 0.0, 1.0 / tip_radius), (b, slope, 0.0))
        case "truncated_cone":
            return pieces(LAND, (land_radius, slope, 0.0))
        case "truncated_parabola":
            return pieces(LAND, (land_radius, land_radius / radius, 1.0 / radius))
        case "rounded_punch":
            return pieces(LAND, (radius, 0.0, 1.0 / edge_radius))
        case "hyperboloid":
            return Body(lambda r: slope * r / math.hypot(r, b), lambda r: slope * b * b / math.hypot(r, b) ** 3)
        case "cone":
            return Body(lambda _: slope, lambda _: 0.0)
        case "flat_punch":
            return Body(lambda _: 0.0, lambda _: 0.0, end=radius)
        case "capped_punch":
            return Body(lambda r: r / cap_radius, lambda _: 1.0 / cap_radius, end=radius)
        case "circle" | "ellipsoid":
            ratio = height / radius if height else 1.0
            return Body(
                lambda r: ratio * r / math.sqrt((radius - r) * (radius + r)),
                lambda r: ratio * radius * radius / ((radius - r) * (radius + r)) ** 1.5,
                limit=WIDEST * radius,
            )
    n, c = (exponent, height / radius**exponent) if height else (2.0, 0.5 / radius)
    return Body(
        lambda r: n * c * r ** (n - 1.0),
        lambda r: n * (n - 1.0) * c * r ** (n - 2.0) if r > 0.0 or n >= 2.0 else 0.0,
    )


def smooth(kind: str, radius: float, slope: float, rng: np.random.Generator) -> Surface:
    """A profile with about that slope at a radius [LU]."""
    end, n = radius / slope, rng.uniform(1.05, 4.0)
    match kind:
        case "blunt_cone" | "hyperboloid":
            return surface(radius, kind, slope=slope, tip_radius=end * rng.uniform(0.2, 2.0))
        case "truncated_cone":
            return surface(radius, kind, slope=slope, land_radius=radius * rng.uniform(0.2, 0.95))
        case "truncated_parabola":
            return surface(radius, kind, radius=end, land_radius=radius * rng.uniform(0.2, 0.95))
        case "rounded_punch":
            return surface(radius, kind, radius=radius * rng.uniform(0.2, 0.95), edge_radius=end)
        case "cone":
            return surface(radius, kind, slope=slope)
        case "flat_punch":
            return surface(radius, kind, radius=radius)
        case "ellipsoid":
            return surface(radius, kind, radius=end, height=end * float(10.0 ** rng.uniform(-0.5, 0.5)))
        case "power" | "cubic":
            n = n if kind == "power" else 3.0
            return surface(radius, "power", exponent=n, radius=radius, height=slope * radius / n)
    return surface(radius, kind, radius=end)


def pieces(*parts: tuple[float, float, float]) -> Body:
    """A body whose slope is straight in pieces: where each begins [LU], the slope there, and its bend [1/LU]."""
    starts = [start for start, _, _ in parts]

    def part(r: float) -> tuple[float, float, float]:
        return parts[max(0, bisect_right(starts, r) - 1)]

    def slope(r: float, of: tuple[float, float, float]) -> float:
        return of[1] + of[2] * (r - of[0])

    jumps = tuple(after[1] - slope(after[0], before) for before, after in pairwise(parts))
    return Body(lambda r: slope(r, part(r)), lambda r: part(r)[2], tuple(starts[1:]), jumps)


def kinked_body(kind: str, b: float, slope: float, rng: np.random.Generator) -> Body:
    """A body whose slope or curvature jumps up at a radius b [LU], with about that slope beyond it."""
    bend = slope / b
    match kind:
        case "land_cone":
            return pieces(LAND, (b, slope, 0.0))
        case "worn_ball":
            return pieces(LAND, (b, slope, bend))
        case "two_slopes":
            return pieces((0.0, slope * rng.uniform(0.1, 0.8), 0.0), (b, slope, 0.0))
        case "two_radii":
            return pieces((0.0, 0.0, bend / rng.uniform(1.5, 8.0)), (b, slope, bend))
        case "rounded_punch":
            return pieces(LAND, (b, 0.0, bend))
    further, low = b * rng.uniform(1.3, 2.0), slope * rng.uniform(0.2, 0.6)
    return pieces(LAND, (b, low, 0.0), (further, slope, 0.0))
