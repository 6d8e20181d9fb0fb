"""Claim: the closed forms of rigid indenters (Sneddon, Galin) are right: one energy gives d, F and p of each shape.

Second source: `validation.references.mdr`, quadratures of the profile's slope that know no closed form. Limits: n = 2
and a << R are Hertz. Numerics: the pressure integrates to the force, the force is dU/dd by finite differences.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d.analysis.theory.sneddon import (
    FlatPunch,
    PowerLaw,
    Sphere,
    cone,
    cone_pressure,
    galin_factor,
    paraboloid,
)
from validation.references.hertz import hertz_contact_radius, hertz_force, hertz_peak_pressure
from validation.references.mdr import ReducedContact

ROUND_OFF = 1e-12
QUADRATURE = 1e-10
"""Relative: nested adaptive quadratures, each asked for 1e-12; the sphere's force also cancels (R/a)^2 digits."""
PRESSURE = 1e-8
"""Relative: the quadrature of a pressure is asked for 1e-9."""
PRESSURE_SUM = 1e-7
"""Relative: a quadrature over pressures, whose own round-off grows towards the edge."""
DIFFERENCE = 1e-8
"""Relative: central differences with a step of 1e-5 of the displacement, error step^2 F''/6F."""
MODULUS, RADIUS = 7.0, 3.0
EXPONENTS = (1.0, 1.5, 2.0, 2.7, 4.0, 9.0)
EDGES = np.array([0.05, 0.3, 0.8])


def power_law(exponent: float) -> tuple[PowerLaw, ReducedContact]:
    """The same indenter z = 0.2 r^n twice: closed form and quadrature."""
    return PowerLaw(0.2, exponent, MODULUS), ReducedContact(lambda r: 0.2 * exponent * r ** (exponent - 1.0), MODULUS)


def sphere() -> tuple[Sphere, ReducedContact]:
    """The whole sphere twice."""
    return Sphere(RADIUS, MODULUS), ReducedContact(lambda r: r / math.sqrt(RADIUS**2 - r**2), MODULUS)


SHAPES = [pytest.param(power_law(n), id=f"r^{n:g}") for n in EXPONENTS] + [pytest.param(sphere(), id="sphere")]


@pytest.mark.parametrize("pair", SHAPES)
def test_closed_form_is_the_reduced_contact(pair: tuple[PowerLaw | Sphere, ReducedContact]) -> None:
    closed, reduced = pair
    for a in EDGES:
        d = float(closed.displacement(a))
        assert reduced.displacement(a) == pytest.approx(d, rel=QUADRATURE)
        assert reduced.force(a) == pytest.approx(float(closed.force(a)), rel=QUADRATURE)
        assert reduced.energy(a) == pytest.approx(float(closed.energy(d)), rel=QUADRATURE)
        assert reduced.contact_radius(d) == pytest.approx(a, rel=QUADRATURE)


@pytest.mark.parametrize("pair", SHAPES)
def test_contact_radius_inverts_the_displacement_and_energy_differentiates_to_force(
    pair: tuple[PowerLaw | Sphere, ReducedContact],
) -> None:
    closed = pair[0]
    d = closed.displacement(EDGES)
    np.testing.assert_allclose(closed.contact_radius(d), EDGES, rtol=ROUND_OFF)
    step = 1e-5 * d
    slope = (closed.energy(d + step) - closed.energy(d - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, closed.force(EDGES), rtol=DIFFERENCE)
    for outside in (closed.contact_radius(-0.1), closed.energy(-0.1), closed.contact_radius(0.0), closed.energy(0.0)):
        assert float(outside) == 0.0


@pytest.mark.parametrize("pair", SHAPES)
def test_reduced_pressure_integrates_to_the_force(pair: tuple[PowerLaw | Sphere, ReducedContact]) -> None:
    closed, reduced = pair
    a = 0.8
    # r = a sin(phi): the root at the edge becomes smooth
    total = quad(
        lambda phi: 2.0 * math.pi * a**2 * math.sin(phi) * math.cos(phi) * reduced.pressure(a * math.sin(phi), a),
        1e-9,
        0.5 * math.pi - 1e-6,
        epsrel=PRESSURE_SUM,
    )[0]
    assert total == pytest.approx(float(closed.force(a)), rel=PRESSURE_SUM)


def test_pressures_in_closed_form() -> None:
    a, places = 0.5, np.array([1e-3, 0.1, 0.3, 0.49])
    tip, ball = ReducedContact(lambda r: 0.3, MODULUS), ReducedContact(lambda r: r / RADIUS, MODULUS)
    peak = float(hertz_peak_pressure(a**2 / RADIUS, RADIUS, MODULUS))
    for r in places:
        assert tip.pressure(r, a) == pytest.approx(float(cone_pressure(r, a, 0.3, MODULUS)), rel=PRESSURE)
        assert ball.pressure(r, a) == pytest.approx(peak * math.sqrt(1.0 - (r / a) ** 2), rel=PRESSURE)
    assert float(cone_pressure(0.6, a, 0.3, MODULUS)) == 0.0


def test_paraboloid_and_shallow_sphere_are_hertz() -> None:
    d = np.array([1e-3, 0.02, 0.1])
    ball = paraboloid(RADIUS, MODULUS)
    np.testing.assert_allclose(ball.contact_radius(d), hertz_contact_radius(d, RADIUS), rtol=ROUND_OFF)
    np.testing.assert_allclose(ball.force(ball.contact_radius(d)), hertz_force(d, RADIUS, MODULUS), rtol=ROUND_OFF)
    whole = Sphere(RADIUS, MODULUS)
    excess = [float(whole.force(a) / ball.force(a)) - 1.0 for a in (0.03, 0.06)]
    assert excess[1] == pytest.approx(4.0 * excess[0], rel=1e-3)  # next order: (a/R)^2
    assert excess[0] == pytest.approx(0.4 * 0.01**2, rel=1e-3)  # 1 + (2/5)(a/R)^2 from the series of artanh


def test_known_factors() -> None:
    assert galin_factor(1.0) == pytest.approx(math.pi / 2.0, rel=ROUND_OFF)
    assert galin_factor(2.0) == pytest.approx(2.0, rel=ROUND_OFF)
    assert galin_factor(4.0) == pytest.approx(8.0 / 3.0, rel=ROUND_OFF)
    tip = cone(0.3, MODULUS)
    d = 0.1
    love = 2.0 * MODULUS * d**2 / (math.pi * 0.3)
    assert float(tip.force(tip.contact_radius(d))) == pytest.approx(love, rel=ROUND_OFF)


def test_flat_punch_is_the_limit_of_a_steep_power_law() -> None:
    """z = (r/a)^n for n -> infinity rises at r = a only: F = 2 E* a d, and the energy is half of F d."""
    punch, d = FlatPunch(0.5, MODULUS), 0.02
    assert float(punch.energy(d)) == pytest.approx(0.5 * float(punch.force(d)) * d, rel=ROUND_OFF)
    steep = PowerLaw(d / (galin_factor(1e3) * 0.5**1e3), 1e3, MODULUS)
    edge = float(steep.contact_radius(d))
    assert edge == pytest.approx(punch.radius, rel=ROUND_OFF)
    assert float(steep.force(edge)) == pytest.approx(2.0 * MODULUS * edge * d, rel=2e-3)  # 1/n
    # r = a sin(phi)
    total = quad(
        lambda phi: float(punch.pressure(0.5 * math.sin(phi), d)) * math.pi * 0.25 * math.sin(2.0 * phi),
        0.0,
        0.5 * math.pi - 1e-9,
    )[0]
    assert total == pytest.approx(float(punch.force(d)), rel=PRESSURE)


def test_what_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 1"):
        PowerLaw(1.0, 0.5, MODULUS)
    with pytest.raises(ValueError, match="radius must be positive"):
        Sphere(-1.0, MODULUS)
    with pytest.raises(ValueError, match="coefficient"):
        cone(0.0, MODULUS)
    with pytest.raises(ValueError, match="contact_modulus"):
        FlatPunch(1.0, math.nan)
    with pytest.raises(ValueError, match="never rises"):
        ReducedContact(lambda r: 0.0, MODULUS).contact_radius(0.1)
    with pytest.raises(ValueError, match="outside 0 < r < a"):
        ReducedContact(lambda r: r, MODULUS).pressure(0.5, 0.5)
    with pytest.raises(ValueError, match="contact_modulus"):
        ReducedContact(lambda r: r, 0.0)
    with pytest.raises(ValueError, match="negative"):
        ReducedContact(lambda r: r, MODULUS, -1.0)
