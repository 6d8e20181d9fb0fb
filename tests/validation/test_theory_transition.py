"""Claim: between the stiff sphere of DMT and the soft one of JKR lies Maugis and Dugdale's, with both as its limits.

Limits with their rates; independent numerics: the same cohesive contact with units, built from springs and quadrature
without Maugis' formulae. DMT's force is Derjaguin's integral of any attraction.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d.analysis.theory.dmt import Dmt, dmt_reduced_force
from contact1d.analysis.theory.jkr import Jkr
from contact1d.analysis.theory.maugis_dugdale import (
    LAMBDA_OVER_TABOR,
    LENNARD_JONES_STRESS,
    MaugisDugdale,
    dmt_contact_radius,
    dmt_load,
    jkr_contact_radius,
    jkr_load,
    maugis_parameter,
    maugis_parameter_of_tabor,
)
from contact1d.analysis.theory.tabor import tabor_number

ROUND_OFF = 1e-12
QUADRATURE = 1e-9
ROOT = 1e-11
"""Relative: the root of the adhesion equation, through differences of terms of order one."""
RATE = 0.06
"""Relative, of the change of an error between two lambda: the next order of the expansion."""
RADIUS, MODULUS, ADHESION = 3.0, 7.0, 0.2
PLACES = np.array([0.3, 1.0, 1.8, 3.0])
LAMBDAS = (0.05, 0.5, 1.0, 3.0)
A_UNIT = math.cbrt(math.pi * ADHESION * RADIUS**2 / (4.0 / 3.0 * MODULUS))
N_UNIT = math.pi * ADHESION * RADIUS
D_UNIT = A_UNIT**2 / RADIUS


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("transition", LAMBDAS)
def test_maugis_is_the_cohesive_contact_by_springs_and_quadrature(transition: float, place: float) -> None:
    """Springs E* per length under x^2/R; a uniform tension s_0 in a ring pulls -2 s_0 sqrt(c^2-x^2) per length outside.

    The row is continuous at a (no infinite stress), which gives d; its integral is F; the surface outside is
    w(r) = (2/pi) int_0^r (q/E*)/sqrt(r^2-x^2) dx, and the gap at c, times s_0, must be W.
    """
    stress = 0.5 * transition * math.cbrt(math.pi * ADHESION * (4.0 / 3.0 * MODULUS) ** 2 / RADIUS)
    assert maugis_parameter(RADIUS, MODULUS, ADHESION, stress) == pytest.approx(transition, rel=ROUND_OFF)
    contact = MaugisDugdale(transition)
    a = float(place * A_UNIT)
    c = a + float(contact.ring_width(place)) * A_UNIT
    d = a**2 / RADIUS - 2.0 * stress * math.sqrt(c**2 - a**2) / MODULUS
    assert float(contact.displacement(place)) * D_UNIT == pytest.approx(d, rel=ROOT, abs=ROOT * D_UNIT)

    def row(phi: float) -> float:
        x = c * math.sin(phi)  # smooth on both sides of the edge
        return MODULUS * (d - x**2 / RADIUS) if x < a else -2.0 * stress * c * math.cos(phi)

    parts = ((0.0, math.asin(a / c)), (math.asin(a / c), 0.5 * math.pi))
    force = sum(2.0 * quad(lambda phi: row(phi) * c * math.cos(phi), *part)[0] for part in parts)
    assert float(contact.load(place)) * N_UNIT == pytest.approx(force, rel=QUADRATURE, abs=QUADRATURE * N_UNIT)
    lift = sum(2.0 / (math.pi * MODULUS) * quad(row, *part)[0] for part in parts)
    gap = c**2 / (2.0 * RADIUS) - d + lift
    assert stress * gap == pytest.approx(ADHESION, rel=QUADRATURE)


def test_units_are_those_of_jkr_and_dmt() -> None:
    jkr, dmt = Jkr(RADIUS, MODULUS, ADHESION), Dmt(RADIUS, MODULUS, ADHESION)
    np.testing.assert_allclose(jkr_load(PLACES) * N_UNIT, jkr.force(PLACES * A_UNIT), rtol=ROUND_OFF)
    np.testing.assert_allclose(dmt_load(PLACES) * N_UNIT, dmt.force(PLACES * A_UNIT), rtol=ROUND_OFF)
    for load in (-1.4, 0.0, 30.0):
        assert jkr_contact_radius(load) * A_UNIT == pytest.approx(float(jkr.contact_radius(load * N_UNIT)))
        assert dmt_contact_radius(load) * A_UNIT == pytest.approx(float(dmt.contact_radius(load * N_UNIT)))


def test_large_lambda_is_jkr_and_the_error_falls_as_the_square() -> None:
    contacts = [MaugisDugdale(value) for value in (30.0, 300.0)]
    loads = [float(np.max(np.abs(contact.load(PLACES) - jkr_load(PLACES)))) for contact in contacts]
    jkr_displacement = PLACES**2 - 2.0 / 3.0 * np.sqrt(6.0 * PLACES)
    shifts = [float(np.max(np.abs(contact.displacement(PLACES) - jkr_displacement))) for contact in contacts]
    pulls = [contact.pull_off_load() - 1.5 for contact in contacts]
    radii = [6.0 ** (1.0 / 3.0) - contact.zero_load_radius() for contact in contacts]
    for errors in (loads, shifts, pulls, radii):
        assert errors[0] < 2e-2
        assert errors[0] == pytest.approx(100.0 * errors[1], rel=RATE)


def test_small_lambda_is_dmt_and_the_error_falls_as_the_power_three_halves() -> None:
    contacts = [MaugisDugdale(value) for value in (1e-5, 1e-3)]
    pulls = [2.0 - contact.pull_off_load() for contact in contacts]
    assert 0.0 < pulls[1] < 1e-4
    assert pulls[1] == pytest.approx(1e3 * pulls[0], rel=RATE)
    tiny = MaugisDugdale(1e-6)
    np.testing.assert_allclose(tiny.load(PLACES), dmt_load(PLACES), atol=5e-3)  # A sqrt(lambda), from the ring inside a
    np.testing.assert_allclose(tiny.displacement(PLACES), PLACES**2, atol=2e-3)  # sqrt(lambda)
    assert tiny.zero_load_radius() == pytest.approx(2.0 ** (1.0 / 3.0), abs=1e-3)


def test_the_transition_is_monotonic_and_its_pull_off_is_the_lowest_load() -> None:
    contacts = [MaugisDugdale(value) for value in (0.01, 0.1, 0.3, 1.0, 3.0, 10.0)]
    pulls, radii = [c.pull_off_load() for c in contacts], [c.zero_load_radius() for c in contacts]
    assert np.all(np.diff(pulls) < 0.0)
    assert np.all(np.diff(radii) > 0.0)
    for contact in contacts:
        scanned = contact.load(np.linspace(0.0, 2.0, 401))
        assert -contact.pull_off_load() <= float(np.min(scanned))
        assert -contact.pull_off_load() == pytest.approx(float(np.min(scanned)), abs=1e-4)  # the grid of the scan
        assert float(contact.load(contact.contact_radius(0.7))) == pytest.approx(0.7, rel=ROOT)
        assert abs(float(contact.load(contact.zero_load_radius()))) < ROOT
        with pytest.raises(ValueError, match="exceeds the pull-off"):
            contact.contact_radius(-contact.pull_off_load() - 1e-6)


def test_first_touch_is_the_limit_of_small_contacts() -> None:
    contact = MaugisDugdale(0.5)
    for quantity in (contact.load, contact.displacement, contact.ring_width):
        assert float(quantity(0.0)) == pytest.approx(float(quantity(1e-9)), abs=1e-8)


def test_lambda_of_tabor() -> None:
    """sigma_0 of the 9-3 law: (8W/3z)[(z/h)^3 - (z/h)^9] is highest at h = 3^(1/6) z; lambda/mu is printed as 1.157."""
    heights = np.linspace(1.0, 2.0, 100001)
    law = 8.0 / 3.0 * (heights**-3 - heights**-9)
    assert float(np.max(law)) == pytest.approx(LENNARD_JONES_STRESS, rel=1e-9)
    assert pytest.approx(1.157, abs=5e-4) == LAMBDA_OVER_TABOR
    mu, z_0 = tabor_number(RADIUS, MODULUS, ADHESION, 0.01), 0.01
    direct = maugis_parameter(RADIUS, MODULUS, ADHESION, LENNARD_JONES_STRESS * ADHESION / z_0)
    assert maugis_parameter_of_tabor(mu) == pytest.approx(direct, rel=ROUND_OFF)


def test_dmt_pull_off_is_derjaguins_integral_of_the_attraction() -> None:
    """2 pi R int sigma(h) dh over a rigid paraboloid that touches at h = z_0."""
    z_0 = 0.01
    whole = quad(lambda h: 8.0 * ADHESION / (3.0 * z_0) * ((z_0 / h) ** 3 - (z_0 / h) ** 9), z_0, math.inf)[0]
    sphere = Dmt(RADIUS, MODULUS, ADHESION)
    assert sphere.pull_off_force() == pytest.approx(2.0 * math.pi * RADIUS * whole, rel=QUADRATURE)
    assert float(sphere.force(0.0)) == -sphere.pull_off_force()


def test_dmt_radii_and_reduced_law() -> None:
    sphere = Dmt(RADIUS, MODULUS, ADHESION)
    a_0 = sphere.zero_load_radius()
    x = np.linspace(0.0, 2.0, 9)
    np.testing.assert_allclose(sphere.force(x * a_0) / sphere.pull_off_force(), dmt_reduced_force(x), atol=ROUND_OFF)
    np.testing.assert_allclose(sphere.contact_radius(sphere.force(x * a_0)), x * a_0, atol=1e-5)  # cbrt of round-off
    assert a_0 * math.cbrt(3.0) == pytest.approx(Jkr(RADIUS, MODULUS, ADHESION).zero_load_radius(), rel=ROUND_OFF)
    assert float(sphere.displacement(a_0)) == pytest.approx(a_0**2 / RADIUS, rel=ROUND_OFF)
    with pytest.raises(ValueError, match="exceeds"):
        sphere.contact_radius(-1.01 * sphere.pull_off_force())
    with pytest.raises(ValueError, match="radius must be positive"):
        Dmt(0.0, MODULUS, ADHESION)


def test_what_is_refused() -> None:
    with pytest.raises(ValueError, match="transition_parameter"):
        MaugisDugdale(0.0)
    with pytest.raises(ValueError, match="negative"):
        MaugisDugdale(1.0).load(-0.1)
