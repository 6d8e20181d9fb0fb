"""The closed forms against their defining integrals, their limits and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from contact1d.analysis.theory import jkr, line_adhesion, winkler
from validation.references import hertz
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction

ROUND_OFF = 1e-12
QUADRATURE = 1e-9
"""Relative: the adaptive quadrature of the check stops there."""
DIFFERENCE = 1e-8
"""Relative: central differences with a step of 1e-5 of the argument."""
FLAT_MINIMUM = 1e-7
"""Relative: a search on values alone locates a minimum only to the square root of the round-off."""

SPHERE = jkr.Jkr(radius=3.0, contact_modulus=7.0, work_of_adhesion=0.2)
LAW = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))


def test_hertz_force_is_the_integral_of_its_pressure() -> None:
    r, e, d = 3.0, 7.0, 0.02
    a, p0 = float(hertz.hertz_contact_radius(d, r)), float(hertz.hertz_peak_pressure(d, r, e))
    total = quad(lambda s: p0 * math.sqrt(1.0 - (s / a) ** 2) * 2.0 * math.pi * s, 0.0, a, epsrel=QUADRATURE)[0]
    assert float(hertz.hertz_force(d, r, e)) == pytest.approx(total, rel=QUADRATURE)
    assert float(hertz.hertz_force(-0.1, r, e)) == 0.0


def test_jkr_pulls_off_where_the_force_is_stationary() -> None:
    a = SPHERE.critical_radius()
    assert float(SPHERE.force(a)) == pytest.approx(-SPHERE.pull_off_force(), rel=ROUND_OFF)
    step = 1e-5 * a
    slope = float(SPHERE.force(a + step) - SPHERE.force(a - step)) / (2.0 * step)
    assert abs(slope) < DIFFERENCE * SPHERE.pull_off_force() / a
    assert SPHERE.pull_off_force() == pytest.approx(1.5 * math.pi * 0.2 * 3.0)


def test_jkr_pulls_off_under_fixed_grips_where_the_displacement_is_stationary() -> None:
    a = SPHERE.critical_radius_fixed_grips()
    step = 1e-5 * a
    slope = float(SPHERE.displacement(a + step) - SPHERE.displacement(a - step)) / (2.0 * step)
    assert abs(slope) < DIFFERENCE * a / SPHERE.radius
    assert float(SPHERE.force(a)) == pytest.approx(jkr.FIXED_GRIPS_FORCE_RATIO * SPHERE.pull_off_force(), rel=ROUND_OFF)


def test_jkr_radius_inverts_the_force() -> None:
    a = np.linspace(1.0, 4.0, 9) * SPHERE.critical_radius()
    np.testing.assert_allclose(SPHERE.contact_radius(SPHERE.force(a)[1:]), a[1:], rtol=ROUND_OFF)
    assert float(SPHERE.contact_radius(0.0)) == pytest.approx(SPHERE.zero_load_radius(), rel=ROUND_OFF)
    assert float(SPHERE.force(SPHERE.zero_load_radius())) == pytest.approx(0.0, abs=ROUND_OFF)
    with pytest.raises(ValueError, match="exceeds"):
        SPHERE.contact_radius(-1.01 * SPHERE.pull_off_force())


def test_jkr_displacement_is_conjugate_to_the_force() -> None:
    """U(a) has dU = F dd along fixed a and dU/da = W 2 pi a at fixed d, so (F_rigid punch) stiffness is 2 E* a."""
    a = np.linspace(0.5, 3.0, 6) * SPHERE.critical_radius()
    hertz_like = SPHERE.displacement(a) - a**2 / SPHERE.radius
    punch = SPHERE.force(a) - 4.0 * SPHERE.contact_modulus * a**3 / (3.0 * SPHERE.radius)
    np.testing.assert_allclose(punch, 2.0 * SPHERE.contact_modulus * a * hertz_like, rtol=ROUND_OFF)
    released = hertz_like**2 * SPHERE.contact_modulus / (2.0 * math.pi * a)
    np.testing.assert_allclose(released, SPHERE.work_of_adhesion, rtol=ROUND_OFF)


def test_jkr_without_adhesion_is_hertz() -> None:
    weak = jkr.Jkr(3.0, 7.0, 1e-16)
    d = float(weak.displacement(0.2))
    assert float(weak.force(0.2)) == pytest.approx(float(hertz.hertz_force(d, 3.0, 7.0)), rel=1e-6)  # sqrt(W)


def test_reduced_curves() -> None:
    x = np.linspace(0.3, 1.4, 12)
    exact = SPHERE.force(x * SPHERE.zero_load_radius()) / SPHERE.pull_off_force()
    np.testing.assert_allclose(jkr.jkr_reduced_force(x), exact, atol=ROUND_OFF)
    for curve, place in (
        (jkr.jkr_reduced_force, 0.630),
        (line_adhesion.barquins_reduced_force, 0.397),
        (line_adhesion.brittle_reduced_force, 0.577),
    ):
        lowest = minimize_scalar(lambda s, f=curve: float(f(s)), bounds=(0.1, 0.9), method="bounded")
        assert lowest.fun == pytest.approx(-1.0, abs=1e-9)
        assert lowest.x == pytest.approx(place, abs=5e-4)  # printed with three digits
        assert float(curve(1.0)) == pytest.approx(0.0, abs=ROUND_OFF)
    assert pytest.approx(2.1165, abs=5e-5) == line_adhesion.BARQUINS_FACTOR
    assert jkr.work_of_adhesion(0.1) == 0.2


def test_brittle_springs_are_the_integral_of_their_springs() -> None:
    r, c_n, length, a = 1000.0, 0.4, 0.3, 25.0
    d = a**2 / (2.0 * r) - length
    total = quad(lambda x: c_n * (d - x**2 / (2.0 * r)), -a, a)[0]
    assert float(line_adhesion.brittle_force(a, r, c_n, length)) == pytest.approx(total, rel=QUADRATURE)
    a0, f_a = line_adhesion.brittle_zero_load_radius(r, length), line_adhesion.brittle_adhesion_force(r, c_n, length)
    x = np.linspace(0.2, 1.5, 8)
    reduced = line_adhesion.brittle_force(x * a0, r, c_n, length) / f_a
    np.testing.assert_allclose(reduced, line_adhesion.brittle_reduced_force(x), atol=ROUND_OFF)


def test_winkler_is_its_integral_and_hertz_with_twice_the_radius() -> None:
    r, c_n, d = 1000.0, 0.4, 0.3
    width = float(winkler.winkler_half_width(d, r))
    total = quad(lambda x: c_n * (d - x**2 / (2.0 * r)), -width, width)[0]
    assert float(winkler.winkler_force(d, r, c_n)) == pytest.approx(total, rel=QUADRATURE)
    work = quad(lambda s: float(winkler.winkler_force(s, r, c_n)), 0.0, d, epsrel=QUADRATURE)[0]
    assert float(winkler.winkler_energy(d, r, c_n)) == pytest.approx(work, rel=QUADRATURE)
    sphere = float(hertz.hertz_force(d, r / 2.0, 2.0 * c_n))
    assert float(winkler.winkler_force(d, r, c_n)) == pytest.approx(sphere, rel=ROUND_OFF)
    assert width == pytest.approx(2.0 * float(hertz.hertz_contact_radius(d, r / 2.0)), rel=ROUND_OFF)


def test_independent_pairs_by_adaptive_quadrature() -> None:
    pairs = IndependentPairs(LAW, 0.83, 1000.0, spacing=0.5)
    for d in (-0.4, 0.0, 0.3):

        def tension(x: float, d: float = d) -> float:
            gap = LAW.force_free_distance() - d + x**2 / 2000.0
            r = brentq(lambda s: s - 2.0 * float(LAW.force(np.array(s))) / 0.83 - gap, 1e-9, 50.0, xtol=1e-15)
            return float(LAW.force(np.array(r)))

        total = 2.0 * sum(quad(tension, low, low + 20.0, epsabs=1e-11)[0] for low in range(0, 160, 20)) / 0.5
        assert pairs.force(d) == pytest.approx(total, abs=QUADRATURE)
        step = 1e-4
        slope = (pairs.force(d + step) - pairs.force(d - step)) / (2.0 * step)
        assert pairs.stiffness(d) == pytest.approx(slope, rel=1e-5)  # step^2 F'''/6


def test_independent_pairs_invert_their_gap() -> None:
    pairs = IndependentPairs(LAW, 0.83, 1000.0)
    r = np.linspace(0.01, 3.0, 50)
    np.testing.assert_allclose(pairs.pair_distance(pairs.undeformed_gap(r)), r, atol=ROUND_OFF)


def test_independent_pairs_scale_with_the_square_root_of_the_radius() -> None:
    small, large = IndependentPairs(LAW, 0.83, 1000.0), IndependentPairs(LAW, 0.83, 4000.0)
    assert large.adhesion_force() == pytest.approx(2.0 * small.adhesion_force(), rel=QUADRATURE)
    assert large.zero_load_radius() == pytest.approx(2.0 * small.zero_load_radius(), rel=QUADRATURE)
    assert large.critical_radius() == pytest.approx(2.0 * small.critical_radius(), rel=QUADRATURE)


def test_independent_pairs_find_the_lowest_force() -> None:
    pairs = IndependentPairs(LAW, 0.83, 1000.0)
    lowest = minimize_scalar(pairs.force, bounds=(-1.0, 0.5), method="bounded", options={"xatol": 1e-9})
    assert pairs.adhesion_force() == pytest.approx(-lowest.fun, rel=ROUND_OFF)
    assert pairs.critical_displacement() == pytest.approx(lowest.x, abs=10 * FLAT_MINIMUM)
    assert pairs.force(pairs.zero_load_displacement()) == pytest.approx(0.0, abs=ROUND_OFF)


def test_independent_pairs_refuse_snapping_and_repulsion() -> None:
    with pytest.raises(ValueError, match="snap"):
        IndependentPairs(LAW, 0.05, 1000.0)
    with pytest.raises(ValueError, match="attraction"):
        IndependentPairs(PairInteraction(Exponential(0.18, 0.13), cutoff=1.0), 0.83, 1000.0)
    with pytest.raises(ValueError, match="through each other"):
        IndependentPairs(LAW, 0.83, 1000.0).pair_distance(-100.0)
