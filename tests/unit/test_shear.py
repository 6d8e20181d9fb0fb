"""The shear traction in three dimensions: Mindlin's closed form, with turns, and what every transform keeps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d.analysis.shear import kinks_of, shear_load
from validation.references.mindlin import mindlin_shear

EXACT = 1e-10
"""Of the largest traction: zones of a parabola are parabolas, which splines have exactly."""
A, MU, PEAK = 20.0, 0.3, 2.0
"""a, μ, p0; the line load of Hertz's pressure p0 √(1 − r²/a²) is (π/2) p0 (a² − x²)/a."""
R = np.linspace(0.0, 0.999 * A, 300)


def line(edge: float, x: np.ndarray) -> np.ndarray:
    return MU * 0.5 * math.pi * PEAK * np.maximum(edge**2 - x**2, 0.0) / A


def lattice(count: int) -> np.ndarray:
    return np.arange(count) - 0.5 * (count - 1)


@pytest.mark.parametrize("count", [46, 47])
@pytest.mark.parametrize("stick", [0.0, 5.2, 10.5, 11.0, 16.8])
def test_the_way_out_is_mindlins(count: int, stick: float) -> None:
    x = lattice(count)
    found = shear_load(x, line(A, x) - line(stick, x), A, [stick] if stick else []).pressure(R)
    assert found == pytest.approx(mindlin_shear(R, A, max(stick, 1e-300), MU, PEAK), abs=EXACT * MU * PEAK)


def test_after_a_turn_it_is_the_way_out_less_twice_a_smaller_one() -> None:
    """Two kinks: at the new edge of what sticks, and at the old one inside."""
    x, old, new = lattice(60), 7.3, 13.4
    values = line(A, x) - line(old, x) - 2.0 * (line(A, x) - line(new, x))
    found = shear_load(x, values, A, [old, new]).pressure(R)
    expected = mindlin_shear(R, A, old, MU, PEAK) - 2.0 * mindlin_shear(R, A, new, MU, PEAK)
    assert found == pytest.approx(expected, abs=EXACT * MU * PEAK)


def test_the_traction_adds_up_to_the_force() -> None:
    """∫ q 2πr dr = ∫ q(x) dx, for a line shear of any shape."""
    x = lattice(80)
    values = np.maximum(1.0 - (np.abs(x) / A) ** 3, 0.0) - 0.5 * np.maximum(1.0 - (x / 12.0) ** 4, 0.0)
    load = shear_load(x, values, A, [12.0])
    total, _ = quad(lambda r: 2.0 * math.pi * r * float(load.pressure(r)), 0.0, A, points=[12.0], limit=300)
    assert total == pytest.approx(2.0 * (0.75 * A - 0.5 * 0.8 * 12.0), rel=1e-4)


def test_a_kink_without_places_on_both_sides_is_left_out() -> None:
    x = lattice(46)
    load = shear_load(x, line(A, x), A, [0.7, 18.4, 19.2])
    assert load.pressure(R) == pytest.approx(mindlin_shear(R, A, 1e-300, MU, PEAK), abs=EXACT * MU * PEAK)


def test_kinks_stay_where_the_zone_that_sticks_grows_and_go_where_it_comes_back() -> None:
    stick = [20.0, 15.0, 10.0, 19.0, 14.0, 9.0, 20.0, 12.0]
    assert kinks_of(stick, [20.0] * 8) == [[], [15.0], [10.0], [10.0, 19.0], [10.0, 14.0], [9.0], [9.0], [9.0, 12.0]]


def test_too_few_places_or_places_that_differ_raise() -> None:
    with pytest.raises(ValueError, match="3 positions on each side"):
        shear_load(lattice(10), np.ones(10), 1.2)
    with pytest.raises(ValueError, match="the same on both sides"):
        shear_load(lattice(10) + 0.1, np.ones(10), 4.0)
    one_aside = lattice(10) + np.where(np.arange(10) == 7, 0.2, 0.0)
    with pytest.raises(ValueError, match="the same on both sides"):
        shear_load(one_aside, np.ones(10), 4.0)


@pytest.mark.parametrize("count", [46, 47])
def test_what_differs_between_both_sides_cancels(count: int) -> None:
    x = lattice(count)
    even = line(A, x) - line(7.2, x)
    found = shear_load(x, even + 0.1 * np.tanh(x), A, [7.2]).pressure(R)
    assert found == pytest.approx(mindlin_shear(R, A, 7.2, MU, PEAK), abs=EXACT * MU * PEAK)


def test_a_zone_that_comes_back_to_a_kink_or_stays_leaves_none() -> None:
    assert kinks_of([9.0, 4.0, 7.0, 4.0, 4.0], [9.0] * 5) == [[], [4.0], [4.0, 7.0], [4.0], [4.0]]
    small = [1e-6 * c for c in (9.0, 4.0, 7.0, 4.0, 4.0)]
    assert kinks_of(small, [9e-6] * 5) == [[], [small[1]], [small[1], small[2]], [small[1]], [small[1]]]
    assert kinks_of([0.0, 0.0, 5.0, 5.0], [3.0, 6.0, 8.0, 5.0]) == [[], [], [5.0], []]
