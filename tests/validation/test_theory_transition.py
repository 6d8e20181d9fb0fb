"""Claim: between the stiff sphere of DMT and the soft one of JKR lies Maugis and Dugdale's, with both as its limits.

Limits with their rates; independent numerics: the same cohesive contact with units, built from springs and quadrature
without Maugis' formulae.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

from contact1d.analysis.theory.adhesion import (
    LAMBDA_OVER_TABOR,
    LENNARD_JONES_STRESS,
    Dmt,
    MaugisDugdale,
)
from contact1d.analysis.theory.indenters import PowerLaw

Array = NDArray[np.float64]

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


UNIT = 1.0, 0.75, 1.0 / math.pi
"""R, E* and W with which a is A, F is N and d is D."""
JKR, DMT = PowerLaw.sphere(*UNIT), Dmt(*UNIT)


def of_lambda(transition: float) -> MaugisDugdale:
    return MaugisDugdale.reduced(transition / LAMBDA_OVER_TABOR)


def loads(contact: PowerLaw | Dmt) -> Array:
    return np.array([contact.force(place) for place in PLACES])


def displacements(contact: PowerLaw | Dmt) -> Array:
    return np.array([contact.displacement(place) for place in PLACES])


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("transition", LAMBDAS)
def test_maugis_is_the_cohesive_contact_by_springs_and_quadrature(transition: float, place: float) -> None:
    """Springs E* per length under x^2/R; a uniform tension s_0 in a ring pulls -2 s_0 sqrt(c^2-x^2) per length outside.

    The row is continuous at a (no infinite stress), which gives d; its integral is F; the surface outside is
    w(r) = (2/pi) int_0^r (q/E*)/sqrt(r^2-x^2) dx, and the gap at c, times s_0, must be W.
    """
    stress = 0.5 * transition * math.cbrt(math.pi * ADHESION * (4.0 / 3.0 * MODULUS) ** 2 / RADIUS)
    contact = MaugisDugdale(RADIUS, MODULUS, ADHESION, ADHESION / stress)
    assert contact.transition == pytest.approx(transition, rel=ROUND_OFF)
    a = float(place * A_UNIT)
    c = a + contact.ring_width(a)
    d = a**2 / RADIUS - 2.0 * stress * math.sqrt(c**2 - a**2) / MODULUS
    assert contact.displacement(a) == pytest.approx(d, rel=ROOT, abs=ROOT * D_UNIT)

    def row(phi: float) -> float:
        x = c * math.sin(phi)  # smooth on both sides of the edge
        return MODULUS * (d - x**2 / RADIUS) if x < a else -2.0 * stress * c * math.cos(phi)

    parts = ((0.0, math.asin(a / c)), (math.asin(a / c), 0.5 * math.pi))
    force = sum(2.0 * quad(lambda phi: row(phi) * c * math.cos(phi), *part)[0] for part in parts)
    assert contact.force(a) == pytest.approx(force, rel=QUADRATURE, abs=QUADRATURE * N_UNIT)
    lift = sum(2.0 / (math.pi * MODULUS) * quad(row, *part)[0] for part in parts)
    gap = c**2 / (2.0 * RADIUS) - d + lift
    assert stress * gap == pytest.approx(ADHESION, rel=QUADRATURE)


def test_reduced_units_are_those_of_any_sphere() -> None:
    """N = F/(pi W R) over A = a/(pi W R^2/K)^(1/3): A^3 - A sqrt(6A) of JKR, A^3 - 2 of DMT."""
    jkr, dmt = PowerLaw.sphere(RADIUS, MODULUS, ADHESION), Dmt(RADIUS, MODULUS, ADHESION)
    for place in PLACES:
        assert jkr.force(place * A_UNIT) == pytest.approx(N_UNIT * (place**3 - place * math.sqrt(6.0 * place)))
        assert dmt.force(place * A_UNIT) == pytest.approx(N_UNIT * (place**3 - 2.0))
        assert jkr.force(place * A_UNIT) == pytest.approx(N_UNIT * JKR.force(place), rel=ROUND_OFF)
        assert jkr.displacement(place * A_UNIT) == pytest.approx(D_UNIT * JKR.displacement(place), rel=ROUND_OFF)
    same, reduced = MaugisDugdale(RADIUS, MODULUS, ADHESION, 0.01), of_lambda(1.0)
    assert reduced.transition == pytest.approx(1.0, rel=ROUND_OFF)
    reduced = of_lambda(same.transition)
    assert same.pull_off_force() == pytest.approx(N_UNIT * reduced.pull_off_force(), rel=ROUND_OFF)
    assert same.critical_radius() == pytest.approx(A_UNIT * reduced.critical_radius(), rel=1e-8)  # a flat minimum


def test_large_lambda_is_jkr_and_the_error_falls_as_the_square() -> None:
    contacts = [of_lambda(value) for value in (30.0, 300.0)]
    off = [float(np.max(np.abs(loads(contact) - loads(JKR)))) for contact in contacts]
    shifts = [float(np.max(np.abs(displacements(contact) - displacements(JKR)))) for contact in contacts]
    pulls = [contact.pull_off_force() - 1.5 for contact in contacts]
    radii = [6.0 ** (1.0 / 3.0) - contact.zero_load_radius() for contact in contacts]
    ends = [JKR.displacement(JKR.fixed_grips_radius()) - c.displacement(c.fixed_grips_radius()) for c in contacts]
    for errors in (off, shifts, pulls, radii, ends):
        assert abs(errors[0]) < 2e-2
        assert errors[0] == pytest.approx(100.0 * errors[1], rel=RATE)


def test_small_lambda_is_dmt_and_the_error_falls_as_the_power_three_halves() -> None:
    pulls = [2.0 - of_lambda(value).pull_off_force() for value in (1e-5, 1e-3)]
    assert 0.0 < pulls[1] < 1e-4
    assert pulls[1] == pytest.approx(1e3 * pulls[0], rel=RATE)
    tiny = of_lambda(1e-6)
    np.testing.assert_allclose(loads(tiny), loads(DMT), atol=5e-3)  # A sqrt(lambda), from the ring inside a
    np.testing.assert_allclose(displacements(tiny), displacements(DMT), atol=2e-3)  # sqrt(lambda)
    assert tiny.zero_load_radius() == pytest.approx(2.0 ** (1.0 / 3.0), abs=1e-3)


def test_the_transition_is_monotonic_and_its_pull_off_is_the_lowest_load() -> None:
    contacts = [of_lambda(value) for value in (0.01, 0.1, 0.3, 1.0, 3.0, 10.0)]
    pulls, radii = [c.pull_off_force() for c in contacts], [c.zero_load_radius() for c in contacts]
    assert np.all(np.diff(pulls) < 0.0)
    assert np.all(np.diff(radii) > 0.0)
    for contact in contacts:
        lowest = min(contact.force(place) for place in np.linspace(0.0, 2.0, 401))
        assert -contact.pull_off_force() <= lowest
        assert -contact.pull_off_force() == pytest.approx(lowest, abs=1e-4)  # the grid of the scan
        assert contact.force(contact.contact_radius(0.7)) == pytest.approx(0.7, rel=ROOT)
        assert abs(contact.force(contact.zero_load_radius())) < ROOT
        with pytest.raises(ValueError, match="exceeds the pull-off"):
            contact.contact_radius(-contact.pull_off_force() - 1e-6)


def test_first_touch_is_the_limit_of_small_contacts() -> None:
    contact = of_lambda(0.5)
    for quantity in (contact.force, contact.displacement, contact.ring_width):
        assert quantity(0.0) == pytest.approx(quantity(1e-9), abs=1e-8)


def test_lambda_of_tabor() -> None:
    """sigma_0 of the 9-3 law: (8W/3z)[(z/h)^3 - (z/h)^9] is highest at h = 3^(1/6) z; lambda/mu is 1.157 with z_0."""
    heights = np.linspace(1.0, 2.0, 100001)
    law = 8.0 / 3.0 * (heights**-3 - heights**-9)
    assert float(np.max(law)) == pytest.approx(LENNARD_JONES_STRESS, rel=1e-9)
    contact = MaugisDugdale(RADIUS, MODULUS, ADHESION, 0.01)
    assert contact.transition / contact.tabor == pytest.approx(1.127, abs=5e-4)
    surface = MaugisDugdale(RADIUS, MODULUS, ADHESION, 0.01 / LENNARD_JONES_STRESS)
    assert surface.transition / contact.tabor == pytest.approx(1.157, abs=5e-4)


def test_dmt_is_hertz_pressed_by_its_attraction() -> None:
    sphere = Dmt(RADIUS, MODULUS, ADHESION)
    a_0 = sphere.zero_load_radius()
    assert a_0 * math.cbrt(3.0) == pytest.approx(
        PowerLaw.sphere(RADIUS, MODULUS, ADHESION).zero_load_radius(), rel=ROUND_OFF
    )
    for x in (0.0, 0.5, 1.5):
        assert sphere.force(x * a_0) == pytest.approx(sphere.pull_off_force() * (x**3 - 1.0), rel=ROUND_OFF)
        assert sphere.displacement(x * a_0) == pytest.approx((x * a_0) ** 2 / RADIUS, rel=ROUND_OFF)
    with pytest.raises(ValueError, match="exceeds"):
        sphere.contact_radius(-1.01 * sphere.pull_off_force())
    with pytest.raises(ValueError, match="radius must be positive"):
        Dmt(0.0, MODULUS, ADHESION)


def test_what_is_refused() -> None:
    with pytest.raises(ValueError, match="range_of_attraction"):
        MaugisDugdale(*UNIT, 0.0)
    with pytest.raises(ValueError, match="negative"):
        of_lambda(1.0).force(-0.1)
