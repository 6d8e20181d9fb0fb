"""Roots and minima of polynomials against those that they were made of."""

import math

import numpy as np
import pytest

from contact1d.analysis.polynomial import fitting, lowest_minimum, real_roots, through, value

ROUND_OFF = 1e-12  # of a polynomial of low degree in doubles
PLACES = np.array([-1.0, -0.4, 0.1, 0.7, 1.0])
QUARTIC = np.array([0.0, 0.05, -0.5, 0.0, 1.0])
"""t⁴ − t²/2 + t/20: a minimum on each side of 0, the left one lower."""


def test_a_polynomial_goes_through_its_samples_and_least_squares_find_one_of_lower_degree() -> None:
    values = np.array([value(QUARTIC, t) for t in PLACES])
    assert through(PLACES, values) == pytest.approx(QUARTIC, abs=ROUND_OFF)
    assert fitting(PLACES, 1) @ (3.0 - 2.0 * PLACES) == pytest.approx([3.0, -2.0], abs=ROUND_OFF)


@pytest.mark.parametrize("lead", [1e-10, -1e-17, 1e-200])
def test_a_highest_coefficient_of_round_off_leaves_the_roots_of_the_others(lead: float) -> None:
    """As of a cubic through four points of a parabola: (t − 1/2)(t + 3/4) stays where it is."""
    assert np.sort(real_roots(np.array([-0.375, 0.25, 1.0, lead]), -5.0, 5.0)) == pytest.approx([-0.75, 0.5])
    assert real_roots(np.array([-0.25, 2.0, lead]), -5.0, 5.0) == pytest.approx([0.125])


def test_only_real_roots_in_the_interval_count_its_ends_among_them() -> None:
    cubic = np.array([-0.5, 1.0, -0.5, 1.0, 0.0])  # (t - 1/2)(t² + 1)
    assert real_roots(cubic, -1.0, 1.0) == pytest.approx([0.5], abs=ROUND_OFF)
    assert not real_roots(cubic, 0.6, 1.0).size
    assert sorted(real_roots(np.array([0.0, -1.0, 1.0]), 0.0, 1.0)) == [0.0, 1.0]
    assert not real_roots(np.zeros(3), -1.0, 1.0).size


def test_the_lowest_minimum_in_the_interval_is_found_with_its_bend() -> None:
    for low, high, side in ((-1.0, 1.0, -1), (0.2, 1.0, 1)):
        place, bend = lowest_minimum(QUARTIC, low, high)
        assert side * place > 0.4
        assert 4.0 * place**3 - place + 0.05 == pytest.approx(0.0, abs=10.0 * ROUND_OFF)
        assert bend == pytest.approx(12.0 * place**2 - 1.0, rel=10.0 * ROUND_OFF)
        assert lowest_minimum(1e-6 * QUARTIC, low, high)[0] == pytest.approx(place)


def test_a_maximum_a_level_place_or_a_minimum_beyond_the_interval_is_none() -> None:
    assert math.isnan(lowest_minimum(QUARTIC, -0.3, 0.3)[0])
    assert math.isnan(lowest_minimum(np.array([0.0, 0.0, 0.0, 1.0]), -1.0, 1.0)[0])
    assert lowest_minimum(np.array([0.0, 0.0, 1.0]), 0.0, 1.0)[0] == 0.0
