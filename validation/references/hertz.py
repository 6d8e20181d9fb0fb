"""Hertz: a sphere on a flat without adhesion, F = (4/3) E* R^(1/2) d^(3/2), a = (R d)^(1/2).

R is the effective radius, 1/R = 1/R1 + 1/R2, and E* the contact modulus, 1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2. Valid for
a << R. Source: K. L. Johnson, Contact Mechanics (1985), section 4.2. Any consistent units; those given are 3D ones,
with stress = force / length^2.
"""

import numpy as np

from validation.references.interaction import Floats


def hertz_force(displacement: Floats | float, radius: float, contact_modulus: float) -> Floats:
    """Return F = (4/3) E* sqrt(R) d^(3/2) [force], zero where d < 0; shape of `displacement`.

    Args:
        displacement: d, approach of distant points [length].
        radius: R [length].
        contact_modulus: E* [stress].
    """
    d = np.maximum(displacement, 0.0)
    return np.asarray(4.0 / 3.0 * contact_modulus * np.sqrt(radius) * d**1.5)


def hertz_contact_radius(displacement: Floats | float, radius: float) -> Floats:
    """Return a = sqrt(R d) [length], zero where d < 0; shape of `displacement`.

    Args:
        displacement: d [length].
        radius: R [length].
    """
    return np.asarray(np.sqrt(radius * np.maximum(displacement, 0.0)))


def hertz_peak_pressure(displacement: Floats | float, radius: float, contact_modulus: float) -> Floats:
    """Return p0 = (2/pi) E* sqrt(d/R) [stress], 3/2 of the mean; zero where d < 0; shape of `displacement`.

    Args:
        displacement: d [length].
        radius: R [length].
        contact_modulus: E* [stress].
    """
    d = np.maximum(displacement, 0.0)
    return np.asarray(2.0 / np.pi * contact_modulus * np.sqrt(d / radius))
