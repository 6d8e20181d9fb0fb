"""Shapes of the upper body by formula, and the MDR's transform by its defining integral.

g(x) = |x| ∫₀^x f′(r)/√(x² − r²) dr by adaptive quadrature, with slopes f′ written down here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad

from contact1d.workflow.scene import (
    Circle,
    Cone,
    Ellipsoid,
    FlatPunch,
    Measured,
    Parabola,
    Power,
    Profile,
)

Array = NDArray[np.float64]
Slope = Callable[[float], float]

ROUND_OFF = 1e-13
"""Relative: closed forms of a few operations."""
QUADRATURE = 1e-9
"""Relative: the adaptive quadrature of the check stops there, at worst for the exponent 1.5, whose f′ ~ √r."""
CUBICS = 2e-9
"""Of the height at the edge: round-off. The closed form of a piece is a difference of numbers as large as the slope's
second derivative, h⁻² at a kink: measured 1e-12 with 100 points and 5e-10 with 2000; without a kink 1e-14."""
PLACES = np.array([-40.0, -7.3, -1.0, 1e-3, 0.5, 3.0, 29.0, 45.0])

SHAPES: dict[str, tuple[Profile, Callable[[Array], Array], Slope]] = {
    "parabola": (Parabola(kind="parabola", radius=50.0), lambda x: x**2 / 100.0, lambda r: r / 50.0),
    "circle": (
        Circle(kind="circle", radius=50.0),
        lambda x: 50.0 - np.sqrt(2500.0 - x**2),
        lambda r: r / math.sqrt(2500.0 - r**2),
    ),
    "ellipsoid": (
        Ellipsoid(kind="ellipsoid", radius=50.0, height=20.0),
        lambda x: 20.0 - np.sqrt(400.0 - 0.16 * x**2),
        lambda r: 0.4 * r / math.sqrt(2500.0 - r**2),
    ),
    "cone": (Cone(kind="cone", slope=0.3), lambda x: 0.3 * np.abs(x), lambda r: 0.3),
    "flat_punch": (FlatPunch(kind="flat_punch", radius=50.0), lambda x: 0.0 * x, lambda r: 0.0),
    "power 3": (
        Power(kind="power", exponent=3.0, radius=20.0, height=2.0),
        lambda x: 2.0 * np.abs(x / 20.0) ** 3,
        lambda r: 6.0 * r**2 / 8000.0,
    ),
    "power 1.5": (
        Power(kind="power", exponent=1.5, radius=20.0, height=2.0),
        lambda x: 2.0 * np.abs(x / 20.0) ** 1.5,
        lambda r: 3.0 * math.sqrt(r / 20.0) / 20.0,
    ),
    "power 1": (Power(kind="power", exponent=1.0, radius=20.0, height=2.0), lambda x: np.abs(x) / 10.0, lambda r: 0.1),
}  # fmt: skip
"""Profile, height and slope of each kind that has a formula."""


def transform(slope: Slope, x: float, kinks: tuple[float, ...] = ()) -> float:
    """g(x) of the module; the end's 1/√ is the weight of the quadrature, and `kinks` of f′ part the way to it."""
    x = abs(x)
    inner = [k for k in kinks if 0.0 < k < x]
    total = 0.0
    for low, high in pairwise([0.0, *inner]):
        total += quad(lambda r: slope(r) / math.sqrt(x**2 - r**2), low, high, epsabs=0.0, epsrel=1e-11, limit=200)[0]
    last = inner[-1] if inner else 0.0
    weighted = quad(
        lambda r: slope(r) / math.sqrt(x + r), last, x, weight="alg", wvar=(0.0, -0.5), epsabs=1e-13, epsrel=1e-11,
        limit=200,
    )  # fmt: skip
    return x * (total + float(weighted[0]))


def table(r: Array, z: Array) -> Measured:
    """A measured profile of these points."""
    return Measured(kind="table", r=tuple(r.tolist()), z=tuple(z.tolist()))
