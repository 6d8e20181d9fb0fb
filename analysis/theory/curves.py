"""Closed forms as curves, for figures: Hertz and JKR over displacement, and laws of adhesion in reduced form.

In reduced form F/F_A is a function of x = a/a_0 that is free of any parameter. The 2D cylinder, 2.1165 (x^2 - sqrt x),
is JKR for a line contact, per length of the cylinder. Source: M. Barquins, J. Adhesion 26 (1988) 1.
"""

from __future__ import annotations

import numpy as np

from contact1d.analysis.theory.indenters import Floats, PowerLaw

BARQUINS_FACTOR = 4.0 ** (4.0 / 3.0) / 3.0
"""2.1165: makes the minimum of factor * (x^2 - x^(1/2)), at x = 4^(-2/3) = 0.397, equal to -1."""
LEAST, LARGEST, POINTS = 0.05, 1.3, 400
"""Radii over a_0 that JKR's curve goes from and to, and how many it has."""


def jkr_reduced_force(reduced_radius: Floats) -> Floats:
    """Return F/F_A = 4 x^3 - 4 x^(3/2), x = a/a_0 >= 0, shape of `reduced_radius`: JKR's, Eq. (8) of the paper."""
    return np.asarray(4.0 * reduced_radius**3 - 4.0 * reduced_radius**1.5)


def barquins_reduced_force(reduced_radius: Floats) -> Floats:
    """Return F/F_A = 2.1165 (x^2 - sqrt x) of a 2D cylinder, x = a/a_0 >= 0, shape of `reduced_radius`."""
    return np.asarray(BARQUINS_FACTOR * (reduced_radius**2 - np.sqrt(reduced_radius)))


def jkr_curve(adhesion_force: float, zero_load_radius: float, radius: float) -> tuple[Floats, Floats]:
    """Displacement [LU] and force [FU] of JKR with this F_A [FU], a₀ and R [LU], up to the radius 1.3 a₀.

    d/d₀ = 3ã² − 2√ã and F/F_A = 4ã³ − 4ã^{3/2}, ã = a/a₀. In the model's own radii d₀ = a₀²/6R: a₀ is twice the radius
    of the two spheres that it stands for, and their effective radius is R/2 (Section 2 of the paper).
    """
    a = np.linspace(LEAST, LARGEST, POINTS)
    return zero_load_radius**2 / (6 * radius) * (3 * a**2 - 2 * np.sqrt(a)), adhesion_force * jkr_reduced_force(a)


def jkr_on_plane(radius: float, contact_modulus: float, work_of_adhesion: float) -> tuple[Floats, Floats]:
    """Displacement [LU] and force [FU] of JKR, R [LU], E* [FU/LU²], W [FU/LU], from fixed grips' end to 1.3 a₀."""
    contact = PowerLaw.sphere(radius, contact_modulus, work_of_adhesion)
    radii = np.linspace(contact.fixed_grips_radius(), LARGEST * contact.zero_load_radius(), POINTS).tolist()
    return np.asarray([contact.displacement(a) for a in radii]), np.asarray([contact.force(a) for a in radii])


def hertz_curve(largest: float, radius: float, layer_stiffness: float) -> tuple[Floats, Floats]:
    """Displacement [LU] up to `largest` and force [FU] of a plane parabola x²/2R on springs c_n per length [FU/LU²].

    F = (4√2/3) c_n √R d^{3/2}, the integral of c_n (d − x²/2R) over |x| < √(2Rd). With c_n = E*/2 it is Hertz for the
    effective radius R/2, with twice the contact radius.
    """
    d = np.linspace(0.0, largest, 200)
    return d, 4.0 * np.sqrt(2.0) / 3.0 * layer_stiffness * np.sqrt(radius) * d**1.5
