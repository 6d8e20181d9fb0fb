"""Other laws of adhesive contact in reduced form, F/F_A over x = a/a_0: springs without range, and the 2D cylinder.

Brittle springs (the particle model for a vanishing range): a spring layer of c_n per length lets go where it is
stretched by D. At the half-width a the edge is stretched by D = a^2/2R - d, so F(a) = 2 c_n (a^3/3R - D a),
a_0 = sqrt(3RD), a_cr = a_0/sqrt3, F_A = (4/3) c_n sqrt(R D^3), F/F_A = (3 sqrt3/2)(x^3 - x).

Cylinder: F/F_A = 2.1165 (x^2 - x^(1/2)). Source: M. Barquins, J. Adhesion 26 (1988) 1.
"""

from __future__ import annotations

import math

import numpy as np

from analysis.reference.interaction import Floats

BARQUINS_FACTOR = 4.0 ** (4.0 / 3.0) / 3.0
"""2.1165: makes the minimum of factor * (x^2 - x^(1/2)), at x = 4^(-2/3) = 0.397, equal to -1."""


def barquins_reduced_force(reduced_radius: Floats | float) -> Floats:
    """Return F/F_A = 2.1165 (x^2 - sqrt x) of a 2D cylinder, x = a/a_0 >= 0, shape of `reduced_radius`."""
    x = np.asarray(reduced_radius, dtype=np.float64)
    return np.asarray(BARQUINS_FACTOR * (x**2 - np.sqrt(x)))


def brittle_reduced_force(reduced_radius: Floats | float) -> Floats:
    """Return F/F_A = (3 sqrt3/2)(x^3 - x) of brittle springs, x = a/a_0 >= 0, shape of `reduced_radius`."""
    x = np.asarray(reduced_radius, dtype=np.float64)
    return np.asarray(1.5 * math.sqrt(3.0) * (x**3 - x))


def brittle_force(
    half_width: Floats | float, radius: float, layer_stiffness: float, elongation_at_break: float
) -> Floats:
    """Return F(a) = 2 c_n (a^3/3R - D a) [FU], shape of `half_width`.

    Args:
        half_width: a >= 0 [LU].
        radius: R of the parabola x^2/2R [LU].
        layer_stiffness: c_n [FU/LU^2]. For two equal chains of springs k at the spacing s: the series, k/2s.
        elongation_at_break: D, of the two springs of a pair together [LU].
    """
    a = np.asarray(half_width, dtype=np.float64)
    return np.asarray(2.0 * layer_stiffness * (a**3 / (3.0 * radius) - elongation_at_break * a))


def brittle_zero_load_radius(radius: float, elongation_at_break: float) -> float:
    """Return a_0 = sqrt(3 R D) [LU]; arguments as for `brittle_force`."""
    return math.sqrt(3.0 * radius * elongation_at_break)


def brittle_adhesion_force(radius: float, layer_stiffness: float, elongation_at_break: float) -> float:
    """Return F_A = (4/3) c_n sqrt(R D^3), a positive magnitude [FU]; arguments as for `brittle_force`."""
    return 4.0 / 3.0 * layer_stiffness * math.sqrt(radius * elongation_at_break**3)
