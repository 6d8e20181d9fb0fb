"""Cattaneo and Mindlin's closed forms, and the exact sum over springs with sliders: alone and against each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d.analysis.theory.mindlin import mindlin_path, mindlin_stick_path, sliding_displacement
from validation.paper.tangential import stiffness_ratio
from validation.references.mindlin import (
    mindlin_force,
    mindlin_loop_area,
    mindlin_shear,
    mindlin_stick_radius,
    raised_load_force,
)
from validation.references.spring_sliders import SpringSliders

N, MU, SLIDING = 40.0, 0.3, 0.36
QUADRATURE = 1e-10
"""Relative: scipy's quad of a smooth function."""
EDGES = 1e-6
"""Relative: 4000 springs in the contact, whose two kinks leave (h/a)² and less."""


@pytest.mark.parametrize("poisson", [-0.5, 0.0, 0.3, 0.5])
def test_equal_materials_have_the_ratio_of_the_book(poisson: float) -> None:
    expected = 2.0 * (1.0 - poisson) / (2.0 - poisson)
    assert stiffness_ratio((3.0, 3.0), (poisson, poisson)) == pytest.approx(expected, rel=1e-15)


def test_a_rigid_body_leaves_the_ratio_of_the_other_one() -> None:
    assert stiffness_ratio((1.0, 1e15), (0.2, 0.45)) == pytest.approx(1.6 / 1.8, rel=1e-12)


@pytest.mark.parametrize("place", [0.05, 0.2, 0.36])
def test_force_and_stick_radius_say_the_same(place: float) -> None:
    """F_x = μN (1 − (c/a)³), u = u* (1 − (c/a)²)."""
    share = float(mindlin_stick_radius(place, 1.0, SLIDING))
    assert float(mindlin_force(place, N, MU, SLIDING)) == pytest.approx(MU * N * (1.0 - share**3), rel=1e-14)
    assert SLIDING * (1.0 - share**2) == pytest.approx(place, rel=1e-14)


def test_the_stick_radius_on_a_way_is_that_of_half_the_way_since_the_turn() -> None:
    found = mindlin_stick_path([0.1, 0.2, 0.15, 0.19, 0.25, 0.5, 0.4], 1.0, SLIDING)
    ways = [0.1, 0.2, 0.025, 0.02, 0.25, 0.5, 0.05]
    assert found == pytest.approx([math.sqrt(max(0.0, 1.0 - way / SLIDING)) for way in ways], rel=1e-14)


@pytest.mark.parametrize("stick", [0.0, 3.0, 9.0])
def test_the_shear_in_three_dimensions_adds_up_to_the_force(stick: float) -> None:
    """∫ q 2πr dr = μN (1 − (c/a)³) with N = (2/3) π a² p0."""
    a, peak = 10.0, 2.0
    load = 2.0 / 3.0 * math.pi * a**2 * peak
    points = [stick] if stick else None
    total, _ = quad(
        lambda r: 2.0 * math.pi * r * float(mindlin_shear(r, a, stick, MU, peak)), 0.0, a, points=points, limit=200
    )
    assert total == pytest.approx(MU * load * (1.0 - (stick / a) ** 3), rel=1e-7)


@pytest.mark.parametrize("amplitude", [0.1, 0.36])
def test_the_area_of_the_loop_is_the_integral_around_it(amplitude: float) -> None:
    places = [amplitude, *np.linspace(amplitude, -amplitude, 4001), *np.linspace(-amplitude, amplitude, 4001)]
    forces = mindlin_path(places, N, MU, SLIDING)
    area = float(np.trapezoid(forces[1:], places[1:]))
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


def springs(count: int = 2000, radius: float = 1000.0, normal: float = 1.0, tangential: float = 0.8) -> SpringSliders:
    """The paraboloid x²/R of the method of dimensionality reduction, a = 30, in springs of one stiffness per length."""
    spacing = 80.0 / count
    x = spacing * (np.arange(count) + 0.5) - 40.0
    return SpringSliders((x**2 / radius).tolist(), normal * spacing, tangential * spacing, MU)


def test_many_springs_are_mindlin_and_deresiewicz_under_a_raised_load() -> None:
    loads, depths = [], (0.6, 0.9)
    slidings = tuple(sliding_displacement(MU, 0.8, depth) for depth in depths)
    loads = tuple(4.0 / 3.0 * math.sqrt(1000.0) * depth**1.5 for depth in depths)
    turn = 0.5 * slidings[0]
    for beyond in (0.3, 0.9, 1.5):
        chain = springs()
        place = turn + beyond * (slidings[1] - slidings[0])
        for stop in ((depths[0], 0.0), (depths[0], turn), (depths[1], turn), (depths[1], place)):
            chain.move(*stop)
        expected = raised_load_force(place, turn, (loads[0], loads[1]), (slidings[0], slidings[1]), MU)
        assert chain.tangential_force == pytest.approx(expected, abs=20.0 * EDGES * MU * loads[1])
