"""Bodies on a plane for random scenes: profiles of a scene beside the body that they are, tables of bodies with kinks.

A kink is a jump up of the slope, or of the curvature, at a radius b. A table has the heights at even distances.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from validation.references.axisymmetric import Body

Scene = dict[str, Any]
SMOOTH = ("parabola", "cone", "power", "circle", "flat_punch", "ellipsoid")
KINKED = ("land_cone", "worn_ball", "two_slopes", "two_radii", "rounded_punch", "steps")
WIDEST = 0.5
"""a/R of spheres, up to which they are searched."""
LENGTHS = {"radius", "height", "spacing", "from", "to", "amplitude", "r", "z", "range"}
FORCES = {"force", "preload", "normal_force"}
"""Keys of the numbers that are given with units."""


def smooth_body(kind: str, radius: float, slope: float, rng: np.random.Generator) -> tuple[Scene, Body]:
    """A profile with that slope at a radius [LU]."""
    end = radius / slope
    match kind:
        case "parabola":
            return {"kind": kind, "radius": end}, Body(lambda r: r / end, lambda _: 1.0 / end)
        case "cone":
            return {"kind": kind, "slope": slope}, Body(lambda _: slope, lambda _: 0.0)
        case "circle" | "ellipsoid":
            ratio = 1.0 if kind == "circle" else float(10.0 ** rng.uniform(-0.5, 0.5))
            more = {} if kind == "circle" else {"height": ratio * end}
            body = Body(
                lambda r: ratio * r / math.sqrt((end - r) * (end + r)),
                lambda r: ratio * end * end / ((end - r) * (end + r)) ** 1.5,
                limit=WIDEST * end,
            )
            return {"kind": kind, "radius": end} | more, body
        case "flat_punch":
            return {"kind": kind, "radius": radius}, Body(lambda _: 0.0, lambda _: 0.0, end=radius)
    n = float(rng.uniform(1.05, 4.0))
    table = {"kind": "power", "exponent": n, "radius": radius, "height": slope * radius / n}
    return table, Body(
        lambda r: slope * (r / radius) ** (n - 1.0),
        lambda r: slope * (n - 1.0) / radius * (r / radius) ** (n - 2.0) if r > 0.0 else 0.0,
    )


def kinked_body(kind: str, b: float, slope: float, rng: np.random.Generator) -> Body:
    """A body whose slope or curvature jumps up at a radius b [LU], with about that slope beyond it."""
    if kind in ("land_cone", "two_slopes"):
        first = 0.0 if kind == "land_cone" else slope * float(rng.uniform(0.1, 0.8))
        return Body(lambda r: slope if r >= b else first, lambda _: 0.0, (b,), (slope - first,))
    if kind in ("worn_ball", "two_radii"):
        end = b / slope
        blunt = math.inf if kind == "worn_ball" else end * float(rng.uniform(1.5, 8.0))
        return Body(
            lambda r: r / end if r >= b else r / blunt,
            lambda r: 1.0 / end if r >= b else 1.0 / blunt,
            (b,),
            (b / end - b / blunt,),
        )
    if kind == "rounded_punch":
        end = b / slope
        return Body(lambda r: max(0.0, r - b) / end, lambda r: 1.0 / end if r >= b else 0.0, (b,), (0.0,))
    further = b * float(rng.uniform(1.3, 2.0))
    low, high = slope * float(rng.uniform(0.2, 0.6)), slope
    return Body(
        lambda r: high if r >= further else low if r >= b else 0.0,
        lambda _: 0.0,
        (b, further),
        (low, high - low),
    )


def sampled(body: Body, pitch: float, reach: float, digits: int | None) -> Scene:
    """The table of its heights at every `pitch` up to `reach` [LU], with so many digits of the largest height."""
    count = math.ceil(reach / pitch)
    radii = [pitch * i for i in range(count + 1)]
    heights = [0.0]
    for low, high in pairwise(radii):
        heights.append(heights[-1] + float(_rise(body, low, high)))
    if digits is not None:
        places = digits - 1 - math.floor(math.log10(heights[-1]))
        heights = [round(z, places) for z in heights]
    return {"kind": "table", "r": radii, "z": heights}


def _rise(body: Body, low: float, high: float) -> float:
    """∫ f′ dr by Gauss between kinks: exact for the slopes up to cubic, and to round-off for these pitches."""
    ends = [low, *(b for b in body.kinks if low < b < high), high]
    u, w = np.polynomial.legendre.leggauss(8)
    return sum(
        0.5 * (q - p) * sum(wi * body.slope(0.5 * (p + q) + 0.5 * (q - p) * ui) for ui, wi in zip(u, w, strict=True))
        for p, q in pairwise(ends)
    )


def elastic(modulus: float, ratio: float) -> Scene:
    """Two equal bodies of that E* and G*/E* = 2 (1 − ν)/(2 − ν)."""
    poisson = (2.0 - 2.0 * ratio) / (2.0 - ratio)
    young = 2.0 * modulus * (1.0 - poisson**2)
    one = {"youngs_modulus": f"{young!r} Pa", "poisson_ratio": poisson}
    return {"upper": one, "lower": dict(one)}


def with_units(node: Any, length: float, modulus: float, key: str = "") -> Any:
    """The same with texts: lengths, forces and the work of adhesion in SI."""
    if isinstance(node, dict):
        return {name: with_units(value, length, modulus, name) for name, value in node.items()}
    if isinstance(node, list):
        return [with_units(value, length, modulus, key) for value in node]
    if isinstance(node, float) and key in LENGTHS:
        return f"{node * length * 1e6!r} µm"
    if isinstance(node, float) and key in FORCES:
        return f"{node * modulus * length**2 * 1e3!r} mN"
    if isinstance(node, float) and key == "work_of_adhesion":
        return f"{node * modulus * length!r} J/m²"
    return node
