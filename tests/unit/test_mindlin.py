"""Cattaneo and Mindlin's closed forms along any way."""

import math

import numpy as np
import pytest

from contact1d.analysis.theory.mindlin import mindlin_path, mindlin_stick_path
from validation.references.mindlin import mindlin_loop_area

N, MU, SLIDING = 40.0, 0.3, 0.36


def test_the_stick_radius_on_a_way_is_that_of_half_the_way_since_the_turn() -> None:
    found = mindlin_stick_path([0.1, 0.2, 0.15, 0.19, 0.25, 0.5, 0.4], 1.0, SLIDING)
    ways = [0.1, 0.2, 0.025, 0.02, 0.25, 0.5, 0.05]
    assert found == pytest.approx([math.sqrt(max(0.0, 1.0 - way / SLIDING)) for way in ways], rel=1e-14)


def test_the_area_of_the_loop_is_the_integral_around_it() -> None:
    amplitude = 0.1
    places = [amplitude, *np.linspace(amplitude, -amplitude, 4001), *np.linspace(-amplitude, amplitude, 4001)]
    area = float(np.trapezoid(mindlin_path(places, N, MU, SLIDING)[1:], places[1:]))
    assert area == pytest.approx(mindlin_loop_area(amplitude, N, MU, SLIDING), rel=1e-5)


def test_an_inner_loop_closes_where_it_began_and_the_way_goes_on_as_if_it_had_not_been() -> None:
    direct = mindlin_path([0.2, 0.05, 0.3], N, MU, SLIDING)
    around = mindlin_path([0.2, 0.05, 0.12, 0.08, 0.12, 0.05, 0.3], N, MU, SLIDING)
    assert around[2] == pytest.approx(around[4], rel=1e-14)
    assert (around[5], around[6]) == pytest.approx((direct[1], direct[2]), rel=1e-14)


def test_beyond_sliding_the_force_stays_and_a_way_back_of_twice_that_turns_it_round() -> None:
    forces = mindlin_path([1.0, 1.0 - SLIDING, 1.0 - 2.0 * SLIDING, -3.0], N, MU, SLIDING)
    assert forces[0] == MU * N
    assert forces[1] == pytest.approx(MU * N * (1.0 - 2.0 * (1.0 - 0.5**1.5)), rel=1e-13)
    assert forces[2:] == pytest.approx([-MU * N] * 2, rel=1e-13)
