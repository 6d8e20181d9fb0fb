"""The shear traction in three dimensions: Mindlin's closed form, with turns, and what every transform keeps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.interpolate import make_interp_spline

from contact1d.analysis.reference.mindlin import mindlin_shear
from contact1d.analysis.shear import kinks_of, shear_load

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


def test_a_kink_stays_with_three_places_on_each_side_of_it_and_goes_with_two() -> None:
    """Places 0.5, 1.5, … 19.5 of a contact up to 20; what is next to a kink is between it and the kink before."""
    x = lattice(46)
    for kinks, stay in (
        ([2.4], []), ([2.6], [2.6]), ([17.4], [17.4]), ([17.6], []),
        ([8.4, 11.2], [8.4, 11.2]), ([8.6, 11.2], [11.2]), ([11.2, 8.4], [8.4, 11.2]), ([8.4, 20.4], [8.4]),
    ):  # fmt: skip
        breaks = shear_load(x, line(A, x), A, kinks).breaks.tolist()
        assert [place for place in breaks if place % 1.0 not in (0.0, 0.5)] == stay


@pytest.mark.parametrize("scale", [2.0**-7, 2.0**9])
def test_zones_are_the_same_in_any_unit_of_length(scale: float) -> None:
    x, kinks = lattice(60), [7.5, 13.4]
    values = line(A, x) - line(7.5, x) - 2.0 * (line(A, x) - line(13.4, x))
    here, there = shear_load(x, values, A, kinks), shear_load(scale * x, values, scale * A, [scale * k for k in kinks])
    assert there.breaks.tolist() == (scale * here.breaks).tolist()
    assert (there.coefficients * scale ** np.arange(4.0)[:, None]).tolist() == here.coefficients.tolist()


def test_kinks_stay_where_the_zone_that_sticks_grows_and_go_where_it_comes_back() -> None:
    stick = [20.0, 15.0, 10.0, 19.0, 14.0, 9.0, 20.0, 12.0]
    assert kinks_of(stick, [20.0] * 8) == [[], [15.0], [10.0], [10.0, 19.0], [10.0, 14.0], [9.0], [9.0], [9.0, 12.0]]


def test_a_contact_that_grows_leaves_its_old_edge_behind() -> None:
    assert kinks_of([20.0, 10.0, 25.0, 22.0, 15.0], [20.0, 20.0, 25.0, 25.0, 25.0]) == [
        [], [10.0], [10.0, 20.0], [10.0, 20.0, 22.0], [10.0, 15.0],
    ]  # fmt: skip


def test_too_few_places_or_places_that_differ_raise() -> None:
    with pytest.raises(ValueError, match="3 places on each side"):
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


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**20])
def test_kinks_are_the_same_in_any_unit_of_length(scale: float) -> None:
    stick, contact = [3.0, 1.5, 2.5, 0.7, 2.0, 1.0], [4.0, 4.0, 4.0, 2.9, 3.5, 3.5]
    there = kinks_of([scale * c for c in stick], [scale * a for a in contact])
    assert there == [[scale * kink for kink in row] for row in kinks_of(stick, contact)]


def splines(x: np.ndarray, q: np.ndarray, edge: float, kinks: list[float], apex: bool, at: np.ndarray) -> np.ndarray:
    """The line shear at places 0 ≤ x ≤ edge, zone by zone: splines without knots next to a zone's ends."""
    right, mean = x[(x >= 0.0) & (x < edge - 1e-3)], (0.5 * (q + q[::-1]))[(x >= 0.0) & (x < edge - 1e-3)]
    found, low, start = np.zeros_like(at), 0.0, None
    for border in [*kinks, edge]:
        height = 0.0
        if border != edge:
            order = np.argsort(np.abs(right - border))
            sides = [[i for i in order if side * (right[i] - border) > 1e-3][:3] for side in (-1.0, 1.0)]
            height = float(np.mean([np.polyval(np.polyfit(right[i], mean[i], 2), border) for i in sides]))
        inside = (right > low + 1e-3 if start is not None else right >= 0.0) & (right < border - 1e-3)
        places, values = [*right[inside], border], [*mean[inside], height]
        if start is not None:
            places, values = [low, *places], [start, *values]
        elif not apex:
            places, values = (
                [-p for p in places if p > 0.0][::-1] + places,
                [v for p, v in zip(places, values, strict=True) if p > 0.0][::-1] + values,
            )
        zone = (at >= low) & (at <= border)
        found[zone] = make_interp_spline(places, values, k=3)(at[zone])
        low, start = border, height
    return found


@pytest.mark.parametrize("apex", [False, True])
@pytest.mark.parametrize("count", [30, 31])
@pytest.mark.parametrize(
    ("edge", "kinks"),
    [(13.2, []), (13.2, [5.3]), (12.5, [4.5, 8.5]), (12.0, [4.0, 8.0]), (13.2, [3.1, 6.2, 9.9]), (3.2, []), (2.6, [])],
)
def test_the_line_shear_is_a_spline_of_its_own_between_kinks_wherever_they_lie(
    edge: float, kinks: list[float], count: int, apex: bool
) -> None:
    """Kinks and edges between places, and on them; three places are enough."""
    x = lattice(count)
    q = np.exp(-((x / 6.0) ** 2)) + 0.3 * np.cos(0.7 * x) + 0.2 * np.tanh(x)
    at = np.linspace(0.0, edge, 400)
    load = shear_load(x, q, edge, kinks, apex)
    assert load.edge == edge
    assert load.has_apex == apex
    piece = np.clip(np.searchsorted(load.breaks, at, side="right") - 1, 0, load.breaks.size - 2)
    found = (load.coefficients[:, piece] * at ** np.arange(4)[:, None]).sum(axis=0)
    assert found == pytest.approx(splines(x, q, edge, kinks, apex, at), abs=1e-9)


@pytest.mark.parametrize("off", [-1e-9, 0.0, 1e-9])
@pytest.mark.parametrize("scale", [2.0**-20, 1.0, 2.0**20])
def test_a_place_on_a_kink_or_the_edge_belongs_to_it_and_is_none_of_the_three_beside_it(
    scale: float, off: float
) -> None:
    """Places 0.5, 1.5, … up to the edge at 19.5, all of them round-off aside, in any unit of length."""
    x = lattice(46)
    q = np.cos(0.1 * x)
    for kinks, stay in (
        ([2.5], []), ([3.5], [3.5]), ([15.5], [15.5]), ([16.5], []),
        ([8.5, 11.5], [11.5]), ([7.5, 11.5], [7.5, 11.5]), ([11.5, 11.5], [11.5]),
    ):  # fmt: skip
        load = shear_load(scale * x, q, scale * (19.5 + off), [scale * (kink + off) for kink in kinks])
        expected = splines(x, q, 19.5 + off, [kink + off for kink in stay], False, np.arange(20.0))
        piece = np.searchsorted(load.breaks, scale * np.arange(20.0), side="right") - 1
        found = (load.coefficients[:, piece] * (scale * np.arange(20.0)) ** np.arange(4)[:, None]).sum(axis=0)
        assert found == pytest.approx(expected, abs=1e-9)
        assert load.breaks.size == 21  # the axis, 19 places or what they belong to, and the edge


def test_a_zone_that_comes_back_to_a_kink_or_stays_leaves_none() -> None:
    assert kinks_of([9.0, 4.0, 7.0, 4.0, 4.0], [9.0] * 5) == [[], [4.0], [4.0, 7.0], [4.0], [4.0]]
    assert kinks_of([0.0, 0.0, 5.0, 5.0], [3.0, 6.0, 8.0, 5.0]) == [[], [], [5.0], []]
