"""Claim: JKR's stress carries JKR's force, and Eq. (9) of Geike and Popov (2007) reads the law backwards.

Independent numerics: quadrature of the stress; the stress intensity at the edge gives W. Second source: the paper's
Table 1, whose length and force units follow from gamma = 1 N/m and E* = 200 GPa.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d.analysis.theory.jkr import (
    Jkr,
    identified_contact_modulus,
    identified_surface_energy,
    jkr_reduced_force,
)

ROUND_OFF = 1e-12
QUADRATURE = 1e-9
"""Relative: adaptive quadrature of a smooth integrand; its upper end is cut off by 1e-12."""
EDGE = 1e-6
"""Relative: Hertz's part, of the order of the distance from the edge, which is 1e-7 a."""
PRINTED = 0.01
"""Relative: LU is printed with two digits, and a modulus has its square."""
SPHERE = Jkr(radius=3.0, contact_modulus=7.0, work_of_adhesion=0.2)
TABLE_1 = ((1000.0, 28.53, 1.47, 6.1e-9, 39.0e-6), (1600.0, 36.14, 1.87, 7.7e-9, 61.8e-6))
TABLE_1 += ((2000.0, 40.36, 2.09, 8.6e-9, 77.6e-6),)


@pytest.mark.parametrize("ratio", [0.4, 0.63, 1.0, 2.0])
def test_stress_integrates_to_the_force(ratio: float) -> None:
    a = ratio * SPHERE.zero_load_radius()

    def ring(phi: float) -> float:
        """2 pi r p dr with r = a sin(phi), which is smooth at the edge."""
        return math.pi * a**2 * math.sin(2.0 * phi) * float(SPHERE.stress(a * math.sin(phi), a))

    total = quad(ring, 0.0, 0.5 * math.pi - 1e-6, epsabs=QUADRATURE)[0]
    scale = SPHERE.pull_off_force()
    cut = 1e-6 * 2.0 * math.pi * a**2 * math.sqrt(2.0 * 7.0 * 0.2 / (math.pi * a))  # the tension left out at the edge
    assert total - cut == pytest.approx(float(SPHERE.force(a)), abs=QUADRATURE * scale)
    mean = float(SPHERE.mean_pressure(a))
    assert mean * math.pi * a**2 == pytest.approx(float(SPHERE.force(a)), abs=ROUND_OFF * scale)


def test_stress_intensity_at_the_edge_is_that_of_the_work_of_adhesion() -> None:
    """Irwin: K = lim -p sqrt(2 pi (a - r)) has K^2/2E* = W, for any a."""
    for a in (0.3, 1.0):
        inside = 1e-7 * a
        intensity = -float(SPHERE.stress(a - inside, a)) * math.sqrt(2.0 * math.pi * inside)
        assert intensity**2 / (2.0 * 7.0) == pytest.approx(0.2, rel=EDGE)


def test_stress_without_adhesion_is_hertz_and_is_refused_at_the_edge() -> None:
    weak = Jkr(3.0, 7.0, 1e-20)
    r = np.array([0.0, 0.1, 0.25])
    hertz = 2.0 * 7.0 * 0.3 / (math.pi * 3.0) * np.sqrt(1.0 - (r / 0.3) ** 2)
    np.testing.assert_allclose(weak.stress(r, 0.3), hertz, rtol=1e-8)  # sqrt(W)
    for outside in (-0.1, 0.3, 0.4):
        with pytest.raises(ValueError, match="outside 0 <= r < a"):
            SPHERE.stress(outside, 0.3)


def test_identification_inverts_jkr() -> None:
    f_a, a_0 = SPHERE.pull_off_force(), SPHERE.zero_load_radius()
    assert 2.0 * identified_surface_energy(f_a, 3.0) == pytest.approx(0.2, rel=ROUND_OFF)
    assert identified_contact_modulus(f_a, 3.0, a_0) == pytest.approx(7.0, rel=ROUND_OFF)
    with pytest.raises(ValueError, match="positive"):
        identified_surface_energy(-f_a, 3.0)
    with pytest.raises(ValueError, match="positive"):
        identified_contact_modulus(f_a, 3.0, 0.0)


@pytest.mark.parametrize("row", TABLE_1, ids=[f"R={row[0]:g}" for row in TABLE_1])
def test_identification_gives_the_material_of_table_1(row: tuple[float, float, float, float, float]) -> None:
    radius, a_0, f_a, length, force = row
    assert identified_surface_energy(f_a * force, radius * length) == pytest.approx(1.0, rel=PRINTED)
    modulus = identified_contact_modulus(f_a * force, radius * length, a_0 * length)
    assert modulus == pytest.approx(200e9, rel=2.0 * PRINTED)


def test_mean_pressure_of_the_paper() -> None:
    """R = 1000 LU, a = 35 LU: "about 800 MPa"; the reduced law and the law with units agree."""
    radius, a_0, f_a, length, force = TABLE_1[0]
    sphere = Jkr(radius * length, 200e9, 2.0)
    reduced = float(jkr_reduced_force(35.0 / a_0)) * f_a * force / (math.pi * (35.0 * length) ** 2)
    assert reduced == pytest.approx(784e6, rel=PRINTED)
    assert float(sphere.mean_pressure(35.0 * length)) == pytest.approx(reduced, rel=2.0 * PRINTED)
