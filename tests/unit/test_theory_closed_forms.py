"""The closed forms against their defining integrals, their limits and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar

from validation.references import hertz
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction

ROUND_OFF = 1e-12
QUADRATURE = 1e-9
"""Relative: the adaptive quadrature of the check stops there."""
FLAT_MINIMUM = 1e-7
"""Relative: a search on values alone locates a minimum only to the square root of the round-off."""

LAW = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))


def test_hertz_force_is_the_integral_of_its_pressure() -> None:
    r, e, d = 3.0, 7.0, 0.02
    a, p0 = float(hertz.hertz_contact_radius(d, r)), float(hertz.hertz_peak_pressure(d, r, e))
    total = quad(lambda s: p0 * math.sqrt(1.0 - (s / a) ** 2) * 2.0 * math.pi * s, 0.0, a, epsrel=QUADRATURE)[0]
    assert float(hertz.hertz_force(d, r, e)) == pytest.approx(total, rel=QUADRATURE)
    assert float(hertz.hertz_force(-0.1, r, e)) == 0.0


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


def test_independent_pairs_refuse_snapping() -> None:
    with pytest.raises(ValueError, match="snap"):
        IndependentPairs(LAW, 0.05, 1000.0)
    with pytest.raises(ValueError, match="through each other"):
        IndependentPairs(LAW, 0.83, 1000.0).pair_distance(-100.0)
