"""Closed forms against their defining integrals and each other; Mindlin's against springs with sliders."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from contact1d.analysis.theory.mindlin import mindlin_path, mindlin_stick_path, sliding_displacement
from validation.references import hertz
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import PairInteraction
from validation.references.mindlin import raised_load_force
from validation.references.spring_sliders import SpringSliders

ROUND_OFF = 1e-12
QUADRATURE = 1e-9
"""Relative: the adaptive quadrature of the check stops there."""
FLAT_MINIMUM = 1e-7
"""Relative: a search on values alone locates a minimum only to the square root of the round-off."""
LAW = PairInteraction.of(0.18, 0.13, 0.09, 0.26)
N, MU, SLIDING = 40.0, 0.3, 0.36
EDGES = 1e-6
"""Relative: 4000 springs in the contact, whose two kinks leave (h/a)² and less."""


def test_hertz_force_is_the_integral_of_its_pressure() -> None:
    r, e, d = 3.0, 7.0, 0.02
    a, p0 = float(hertz.hertz_contact_radius(d, r)), float(hertz.hertz_peak_pressure(d, r, e))
    total = quad(lambda s: p0 * math.sqrt(1.0 - (s / a) ** 2) * 2.0 * math.pi * s, 0.0, a, epsrel=QUADRATURE)[0]
    assert float(hertz.hertz_force(d, r, e)) == pytest.approx(total, rel=QUADRATURE)
    assert float(hertz.hertz_force(-0.1, r, e)) == 0.0


def test_independent_pairs_by_adaptive_quadrature() -> None:
    pairs = IndependentPairs(LAW, 0.83, 1000.0, spacing=0.5)
    for d in (-0.4, 0.3):

        def tension(x: float, d: float = d) -> float:
            gap = LAW.force_free_distance() - d + x**2 / 2000.0
            r = brentq(lambda s: s - 2.0 * float(LAW.force(np.array(s))) / 0.83 - gap, 1e-9, 50.0, xtol=1e-15)
            return float(LAW.force(np.array(r)))

        total = 2.0 * sum(quad(tension, low, low + 20.0, epsabs=1e-11)[0] for low in range(0, 160, 20)) / 0.5
        assert pairs.force(d) == pytest.approx(total, abs=QUADRATURE)
        step = 1e-4
        slope = (pairs.force(d + step) - pairs.force(d - step)) / (2.0 * step)
        assert pairs.stiffness(d) == pytest.approx(slope, rel=1e-5)  # step^2 F'''/6


def test_the_stick_radius_on_a_way_is_that_of_half_the_way_since_the_turn() -> None:
    found = mindlin_stick_path([0.1, 0.2, 0.15, 0.19, 0.25, 0.5, 0.4], 1.0, SLIDING)
    ways = [0.1, 0.2, 0.025, 0.02, 0.25, 0.5, 0.05]
    assert found == pytest.approx([math.sqrt(max(0.0, 1.0 - way / SLIDING)) for way in ways], rel=1e-14)


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


def test_many_springs_are_mindlin_and_deresiewicz_under_a_raised_load() -> None:
    """The paraboloid x²/R of the method of dimensionality reduction, in springs of one stiffness per length."""
    R, ratio, depths, count = 1000.0, 0.8, (0.6, 0.9), 2000
    slidings = tuple(sliding_displacement(MU, ratio, depth) for depth in depths)
    loads = tuple(4.0 / 3.0 * math.sqrt(R) * depth**1.5 for depth in depths)
    turn, spacing = 0.5 * slidings[0], 80.0 / count
    x = spacing * (np.arange(count) + 0.5) - 40.0
    for beyond in (0.3, 0.9, 1.5):
        chain = SpringSliders((x**2 / R).tolist(), spacing, ratio * spacing, MU)
        place = turn + beyond * (slidings[1] - slidings[0])
        for stop in ((depths[0], 0.0), (depths[0], turn), (depths[1], turn), (depths[1], place)):
            chain.move(*stop)
        expected = raised_load_force(place, turn, (loads[0], loads[1]), (slidings[0], slidings[1]), MU)
        assert chain.tangential_force == pytest.approx(expected, abs=20.0 * EDGES * MU * loads[1])
