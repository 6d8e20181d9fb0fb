"""Maugis-Dugdale: a sphere whose attraction is a constant stress sigma_0 in a ring a < r < c; from DMT to JKR.

With K = 4E*/3, in the units of Maugis: A = a/(pi W R^2/K)^(1/3), C = c in the same unit, N = F/(pi W R),
D = d/(pi^2 W^2 R/K^2)^(1/3), lambda = 2 sigma_0 (R/(pi W K^2))^(1/3), and with S = sqrt(C^2-A^2), phi = arccos(A/C):

    (lambda/2) [A S + (C^2 - 2A^2) phi] + (4 lambda^2/3) [S phi - C + A] = 1     gap at c times sigma_0 is W
    N = A^3 - lambda [A S + C^2 phi],     D = A^2 - (4/3) lambda S

which is Maugis' form in m = C/A, written so that it also holds at A = 0. Limits: lambda -> 0 N = A^3 - 2, D = A^2
(DMT); lambda -> infinity N = A^3 - A sqrt(6A), D = A^2 - (2/3) sqrt(6A) (JKR). Valid for a << R, c << R, and from first
touch on (states before touch are left out; their tension is less). Source: D. Maugis, J. Colloid Interface Sci. 150
(1992) 243. Forces positive in compression.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from contact1d.analysis.theory.adhesive_pair import Floats

LENNARD_JONES_STRESS = 16.0 / (9.0 * math.sqrt(3.0))
"""1.026: the largest tension of the 9-3 surface law of Lennard-Jones over W/z_0; taken as sigma_0."""
LAMBDA_OVER_TABOR = 2.0 * LENNARD_JONES_STRESS * math.cbrt(9.0 / (16.0 * math.pi))
"""1.157: lambda over Tabor's mu = (R W^2/(E*^2 z_0^3))^(1/3), for the sigma_0 of Lennard-Jones."""
LARGEST_CRITICAL_RADIUS = 1.5
"""A above that of every pull-off: JKR's, the largest, is (3/2)^(1/3) = 1.145."""
ROOT = 4.0 * np.finfo(np.float64).eps
"""Relative tolerance of a root: the least that the root finder takes."""
FLAT_MINIMUM = 1e-9
"""Absolute, in A: how near the search for the largest tension comes; its error in N is the square of this."""


def maugis_parameter(radius: float, contact_modulus: float, work_of_adhesion: float, cohesive_stress: float) -> float:
    """Return lambda = 2 sigma_0 (R/(pi W K^2))^(1/3), K = 4E*/3; R [length], E*, sigma_0 [stress], W [force/length]."""
    k = 4.0 / 3.0 * contact_modulus
    return 2.0 * cohesive_stress * math.cbrt(radius / (math.pi * work_of_adhesion * k**2))


def maugis_parameter_of_tabor(tabor_number: float) -> float:
    """Return lambda = 1.157 mu of a Lennard-Jones surface; `tabor_number` mu."""
    return LAMBDA_OVER_TABOR * tabor_number


@dataclass(frozen=True)
class MaugisDugdale:
    """The reduced contact of one lambda; A, N and D are in the units of the module.

    Args:
        transition_parameter: lambda > 0; tried from 1e-6 to 1e4.

    Raises:
        ValueError: if lambda is not positive and finite.
    """

    transition_parameter: float

    def __post_init__(self) -> None:
        """Check the range."""
        if not (math.isfinite(self.transition_parameter) and self.transition_parameter > 0.0):
            raise ValueError(f"transition_parameter must be positive and finite, got {self.transition_parameter}")

    def ring_width(self, contact_radius: Floats | float) -> Floats:
        """Return C - A, the root of the adhesion equation; shape of `contact_radius` A >= 0."""
        radii = np.asarray(contact_radius, dtype=np.float64)
        widths = [_ring_width(self.transition_parameter, float(a)) for a in radii.ravel()]
        return np.asarray(widths, dtype=np.float64).reshape(radii.shape)

    def load(self, contact_radius: Floats | float) -> Floats:
        """Return N = A^3 - lambda [A S + C^2 phi], that is F/(pi W R); shape of `contact_radius` A >= 0."""
        a = np.asarray(contact_radius, dtype=np.float64)
        u = self.ring_width(a)
        s = np.sqrt(u * (2.0 * a + u))
        return np.asarray(a**3 - self.transition_parameter * (a * s + (a + u) ** 2 * np.arctan2(s, a)))

    def displacement(self, contact_radius: Floats | float) -> Floats:
        """Return D = A^2 - (4/3) lambda S, shape of `contact_radius` A >= 0."""
        a = np.asarray(contact_radius, dtype=np.float64)
        u = self.ring_width(a)
        return np.asarray(a**2 - 4.0 / 3.0 * self.transition_parameter * np.sqrt(u * (2.0 * a + u)))

    def critical_radius(self) -> float:
        """Return A where a fixed load pulls off: the lowest N(A), A >= 0; 0 where N rises from first touch on."""
        return _critical_radius(self.transition_parameter)

    def pull_off_load(self) -> float:
        """Return F_A/(pi W R), a positive magnitude: from 2 (DMT) to 3/2 (JKR)."""
        return -float(self.load(self.critical_radius()))

    def zero_load_radius(self) -> float:
        """Return A_0 with N(A_0) = 0: from 2^(1/3) (DMT) to 6^(1/3) (JKR)."""
        return self.contact_radius(0.0)

    def contact_radius(self, load: float) -> float:
        """Return the stable A with N(A) = `load` >= -F_A/(pi W R).

        Raises:
            ValueError: if the tension exceeds the pull-off load.
        """
        low = self.critical_radius()
        if load < float(self.load(low)):
            raise ValueError(f"no equilibrium: the tension exceeds the pull-off load {self.pull_off_load()}")
        high = 1.0 + jkr_contact_radius(max(load, 0.0))
        return float(brentq(lambda a: float(self.load(a)) - load, low, high, xtol=1e-15, rtol=ROOT))


def _adhesion_excess(transition: float, a: float, u: float) -> float:
    """Return (lambda/2) [A S + (C^2-2A^2) phi] + (4 lambda^2/3) [S phi - C + A] - 1 for C = a + u: rises with u."""
    s = math.sqrt(u * (2.0 * a + u))
    phi = math.atan2(s, a)
    elastic = a * s + (s**2 - a**2) * phi
    return 0.5 * transition * elastic + 4.0 / 3.0 * transition**2 * (s * phi - u) - 1.0


def _ring_width(transition: float, a: float) -> float:
    """Return u = C - A >= 0 of one contact radius A; it is widest at A = 0, where the equation is quadratic in C.

    There (pi/4) lambda C^2 + (4 lambda^2/3)(pi/2 - 1) C = 1; the root is written without a difference of large numbers.
    """
    if a < 0.0:
        raise ValueError(f"contact_radius must not be negative, got {a}")
    quadratic, linear = 0.25 * math.pi * transition, 4.0 / 3.0 * transition**2 * (0.5 * math.pi - 1.0)
    widest = 2.0 / (linear + math.sqrt(linear**2 + 4.0 * quadratic))
    if a == 0.0:
        return widest
    high = widest * (1.0 + 1e-9)  # above the root by more than round-off
    return float(brentq(lambda u: _adhesion_excess(transition, a, u), 0.0, high, xtol=1e-300, rtol=ROOT))


@lru_cache(maxsize=256)
def _critical_radius(transition: float) -> float:
    """Return A of the lowest N of one lambda; the search is on 0..1.5, and the end A = 0 is compared."""
    contact = MaugisDugdale(transition)
    found = minimize_scalar(
        lambda a: float(contact.load(a)),
        bounds=(0.0, LARGEST_CRITICAL_RADIUS),
        method="bounded",
        options={"xatol": FLAT_MINIMUM},
    )
    return float(found.x) if found.fun < float(contact.load(0.0)) else 0.0


def jkr_load(contact_radius: Floats | float) -> Floats:
    """Return N = A^3 - A sqrt(6A), the limit lambda -> infinity; shape of `contact_radius` A >= 0."""
    a = np.asarray(contact_radius, dtype=np.float64)
    return np.asarray(a**3 - a * np.sqrt(6.0 * a))


def jkr_contact_radius(load: float) -> float:
    """Return JKR's stable A = [N + 3 + sqrt(6N + 9)]^(1/3); `load` N >= -3/2."""
    return math.cbrt(load + 3.0 + math.sqrt(6.0 * load + 9.0))


def dmt_load(contact_radius: Floats | float) -> Floats:
    """Return N = A^3 - 2, the limit lambda -> 0; shape of `contact_radius` A >= 0."""
    return np.asarray(np.asarray(contact_radius, dtype=np.float64) ** 3 - 2.0)


def dmt_contact_radius(load: float) -> float:
    """Return DMT's A = (N + 2)^(1/3); `load` N >= -2."""
    return math.cbrt(load + 2.0)
