"""Claim: the adhesive cylinder with units is Barquins' reduced law, with F_A ~ R^(1/3) and a_0 ~ R^(2/3).

Independent numerics: quadrature of its stress, the stress intensity at its edge (Irwin), a search for its lowest force.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from contact1d.analysis.theory.line_adhesion import AdhesiveCylinder, barquins_reduced_force

ROUND_OFF = 1e-12
QUADRATURE = 1e-9
EDGE = 5e-6
"""Relative: the pressure of Hertz, which grows with a; measured 2e-6 at 1e-7 a from the edge."""
MODULUS, ADHESION = 7.0, 0.2
CYLINDER = AdhesiveCylinder(3.0, MODULUS, ADHESION)


def test_reduced_law_is_barquins() -> None:
    x = np.linspace(0.0, 2.0, 11)
    reduced = CYLINDER.force(x * CYLINDER.zero_load_half_width()) / CYLINDER.pull_off_force()
    np.testing.assert_allclose(reduced, barquins_reduced_force(x), atol=ROUND_OFF)
    ratio = CYLINDER.critical_half_width() / CYLINDER.zero_load_half_width()
    assert ratio == pytest.approx(4.0 ** (-2.0 / 3.0), rel=ROUND_OFF)


def test_pull_off_is_the_lowest_force() -> None:
    lowest = minimize_scalar(lambda a: float(CYLINDER.force(a)), bounds=(0.01, 2.0), method="bounded")
    assert -lowest.fun == pytest.approx(CYLINDER.pull_off_force(), rel=1e-9)  # the search stops at 1e-5 in a
    assert lowest.x == pytest.approx(CYLINDER.critical_half_width(), rel=1e-4)


@pytest.mark.parametrize("ratio", [0.4, 1.0, 2.0])
def test_stress_integrates_to_the_force_and_its_edge_to_the_work_of_adhesion(ratio: float) -> None:
    a = ratio * CYLINDER.zero_load_half_width()
    start = -0.5 * math.pi + 1e-6  # x = a sin(phi) makes the edge smooth; the tension left out there is `cut`
    total = quad(
        lambda phi: float(CYLINDER.stress(a * math.sin(phi), a)) * a * math.cos(phi), start, 0.0, epsabs=QUADRATURE
    )[0]
    cut = 1e-6 * math.sqrt(2.0 * MODULUS * ADHESION * a / math.pi)
    assert 2.0 * (total - cut) == pytest.approx(float(CYLINDER.force(a)), abs=QUADRATURE * CYLINDER.pull_off_force())
    inside = 1e-7 * a
    intensity = -float(CYLINDER.stress(a - inside, a)) * math.sqrt(2.0 * math.pi * inside)
    assert intensity**2 / (2.0 * MODULUS) == pytest.approx(ADHESION, rel=EDGE)


def test_powers_of_the_radius() -> None:
    large = AdhesiveCylinder(24.0, MODULUS, ADHESION)
    assert large.pull_off_force() == pytest.approx(2.0 * CYLINDER.pull_off_force(), rel=ROUND_OFF)
    assert large.zero_load_half_width() == pytest.approx(4.0 * CYLINDER.zero_load_half_width(), rel=ROUND_OFF)
    with pytest.raises(ValueError, match="work_of_adhesion"):
        AdhesiveCylinder(1.0, 1.0, 0.0)
