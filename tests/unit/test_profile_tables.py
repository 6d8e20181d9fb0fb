"""Measured profiles: heights of formulas at equal steps h, and where the cubics through them go to."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from contact1d.workflow.scene import (
    Measured,
)
from tests.shapes import CUBICS, PLACES, QUADRATURE, ROUND_OFF, SHAPES, Array, Slope, table, transform

COUNTS = (20, 40, 80, 160, 320)
SAMPLED: dict[str, tuple[Callable[[Array], Array], Callable[[Array], Array], Slope]] = {
    "parabola": (lambda r: r**2 / 100.0, lambda x: x**2 / 50.0, lambda r: r / 50.0),
    "power 3": (lambda r: r**3 / 4000.0, lambda x: 0.75 * math.pi * x**3 / 4000.0, lambda r: 3.0 * r**2 / 4000.0),
    "power 1.5": (
        lambda r: r**1.5 / 40.0,
        lambda x: 0.75 * math.sqrt(math.pi) * math.gamma(0.75) / math.gamma(1.25) * x**1.5 / 40.0,
        lambda r: 1.5 * math.sqrt(r) / 40.0,
    ),
    "flat-ended cone": (
        lambda r: 0.3 * np.maximum(r - 10.0, 0.0),
        lambda x: 0.3 * x * np.arccos(np.minimum(10.0 / x, 1.0)),
        lambda r: 0.3 if r > 10.0 else 0.0,
    ),
}  # fmt: skip
"""Height, transform and slope; x ≥ 15 in what follows, so that a place has many points before it."""
RATES = {"power 3": 2.5, "power 1.5": 2.5}
RATE = 0.25
"""Of an exponent; measured 0.2 for the heights of the third power, with the fewest points, and less else."""
EVEN = np.linspace(0.0, 40.0, 401)


def sampled(name: str, count: int) -> Measured:
    r = np.linspace(0.0, 40.0, count + 1)
    return table(r, SAMPLED[name][0](r))


def rate(errors: list[float]) -> float:
    return -float(np.polyfit(np.log(COUNTS), np.log(errors), 1)[0])


def slope_of_cells(profile: Measured) -> Callable[[Array], Array]:
    """The slope of each cell's cubic, from four heights inside it."""
    assert profile.r is not None
    r = np.asarray(profile.r)
    inside = 0.5 * (1.0 - np.cos(math.pi * (np.arange(4) + 0.5) / 4.0))
    at = r[:-1, None] + np.diff(r)[:, None] * inside
    powers = np.linalg.solve(np.vander(inside, increasing=True), profile.height(at).T)

    def slope(place: Array) -> Array:
        cell = np.clip(np.searchsorted(r, place, side="right") - 1, 0, r.size - 2)
        step = np.diff(r)[cell]
        t = (place - r[cell]) / step
        return np.asarray((powers[1][cell] + t * (2.0 * powers[2][cell] + t * 3.0 * powers[3][cell])) / step)

    return slope


def transform_of_cubics(profile: Measured, x: Array) -> Array:
    """g of the docstring for the monotone cubics through the points, a Gauss rule in φ = arcsin(r/x) for each piece."""
    assert profile.r is not None
    assert profile.z is not None
    r = np.asarray(profile.r)
    slope = slope_of_cells(profile)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    g = []
    for place in x:
        angles = np.arcsin(np.append(r[r < place], place) / place)
        half, middle = 0.5 * np.diff(angles)[:, None], 0.5 * (angles[1:] + angles[:-1])[:, None]
        g.append(place * float(np.sum(half * weights * slope(place * np.sin(middle + half * nodes)))))
    return np.asarray(g)


def test_a_sampled_paraboloid_is_the_paraboloid() -> None:
    """The slopes at the points are those of parabolas through them, and the transform of the cubics is exact."""
    height, transformed, _ = SAMPLED["parabola"]
    x = np.linspace(0.1, 39.9, 301)
    for count in COUNTS:
        profile = sampled("parabola", count)
        np.testing.assert_allclose(profile.height(x), height(x), rtol=1e3 * ROUND_OFF)
        np.testing.assert_allclose(profile.transformed(x), transformed(x), rtol=0.0, atol=CUBICS * transformed(x)[-1])


@pytest.mark.parametrize("name", ["power 3", "power 1.5"])
def test_height_of_a_sampled_formula_converges_with_the_third_power_of_the_step(name: str) -> None:
    """The slope at a point is off by h²f‴/6, the height between the points by h times that."""
    x = np.linspace(15.0, 39.9, 301)
    errors = [float(np.abs(sampled(name, n).height(x) - SAMPLED[name][0](x)).max()) for n in COUNTS]
    assert rate(errors) == pytest.approx(3.0, abs=RATE)


@pytest.mark.parametrize("name", RATES)
def test_transform_of_a_sampled_formula_converges_at_its_rate(name: str) -> None:
    """Smooth: h^(5/2), the slope's h² but for the half of an order that 1/√(x² − r²) makes of the last cell: there
    the slope's error, which has no mean over a whole cell, is weighted by √h."""
    x = np.linspace(15.0, 39.9, 301)
    errors = [float(np.abs(sampled(name, n).transformed(x) - SAMPLED[name][1](x)).max()) for n in COUNTS]
    assert rate(errors) == pytest.approx(RATES[name], abs=RATE)


@pytest.mark.parametrize("count", [20, 23, 57, 320])
def test_a_corner_is_met_at_a_point_and_between_two(count: int) -> None:
    """Straight flanks that meet at r = 10: the curve has the corner, wherever the points are, and names it."""
    profile, (height, transformed, _) = sampled("flat-ended cone", count), SAMPLED["flat-ended cone"]
    x = np.linspace(0.1, 39.9, 301)
    assert profile.kinks == pytest.approx((10.0,), rel=1e-9)
    np.testing.assert_allclose(profile.height(x), height(x), rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(profile.transformed(x), transformed(x), rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("share", [0.0, 0.01, 0.05, 0.09, 0.5, 0.93, 0.99])
@pytest.mark.parametrize("inner", [math.inf, 2000.0])
def test_a_corner_is_met_however_near_to_a_point(share: float, inner: float) -> None:
    """A ball worn to another radius: the parabolas of both sides are exact, and so is where they meet."""
    r, b = np.arange(61.0), 20.0 + share
    worn = np.minimum(r, b) ** 2 / (2.0 * inner) + np.maximum(r**2 - b**2, 0.0) / 200.0
    assert table(r, worn).kinks == pytest.approx((b,), rel=1e-9)


@pytest.mark.parametrize("count", [4, 25, 100, 2000])
@pytest.mark.parametrize("name", RATES)
def test_transform_of_a_table_is_the_defining_integral_of_its_cubics(name: str, count: int) -> None:
    profile, x = sampled(name, count), np.linspace(11.0, 40.0, 59)
    exact = transform_of_cubics(profile, x)
    np.testing.assert_allclose(profile.transformed(x), exact, rtol=0.0, atol=CUBICS * exact[-1])


@pytest.mark.parametrize("name", SAMPLED)
def test_closed_transform_of_a_sampled_formula_is_its_defining_integral(name: str) -> None:
    """What the two tests above measure against."""
    _, closed, slope = SAMPLED[name]
    x = np.array([11.0, 25.0, 40.0])
    np.testing.assert_allclose(closed(x), [transform(slope, float(place), (10.0,)) for place in x], rtol=QUADRATURE)


def test_sampled_cone_is_the_cone() -> None:
    """Cubics through a straight line are the line: nothing is lost but round-off."""
    profile, cone = table(np.array([0.0, 3.0, 4.0, 20.0, 40.0]), 0.3 * np.array([0.0, 3.0, 4.0, 20.0, 40.0])), SHAPES
    x = np.linspace(-40.0, 40.0, 81)
    np.testing.assert_allclose(profile.height(x), cone["cone"][0].height(x), rtol=1e3 * ROUND_OFF, atol=ROUND_OFF)
    np.testing.assert_allclose(
        profile.transformed(x), cone["cone"][0].transformed(x), rtol=1e3 * ROUND_OFF, atol=ROUND_OFF
    )


def test_table_passes_through_its_points_and_never_over_them() -> None:
    """Kinks and flat parts: a monotone cubic rises only where its points do."""
    r = np.array([0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 6.0])
    z = np.array([0.0, 0.0, 0.0, 1.0, 5.0, 5.0, 5.5])
    profile = table(r, z)
    assert profile.height(r) == pytest.approx(z, abs=ROUND_OFF)
    x = np.linspace(0.0, 6.0, 6001)
    height = profile.height(x)
    assert np.all(np.diff(height) >= -ROUND_OFF)
    assert np.all(height[x <= 2.0] == 0.0)
    assert height[(x >= 3.5) & (x <= 4.0)] == pytest.approx(5.0, abs=ROUND_OFF)
    assert np.all(profile.transformed(x[x <= 2.0]) == 0.0)


def test_heights_of_a_table_count_from_its_apex() -> None:
    r = EVEN
    shifted, plain = table(r, 7.0 + r**2), table(r, r**2)
    np.testing.assert_allclose(shifted.height(PLACES[1:-1]), plain.height(PLACES[1:-1]), rtol=1e-9, atol=1e-9)
    assert shifted.height(np.zeros(1)).tolist() == [0.0]


def test_table_ends_at_its_reach() -> None:
    """Beyond the last radius there is no body; the height stays finite, and a chain there is refused elsewhere."""
    profile = table(EVEN, EVEN**2)
    x = np.array([40.0, 41.0, -1e6])
    assert profile.height(x).tolist() == [1600.0] * 3
    assert np.ptp(profile.transformed(x)) == 0.0


def test_transform_of_many_places_is_that_of_each() -> None:
    """The places are taken in parts, to bound the memory."""
    profile, x = table(EVEN, EVEN**2), np.linspace(-40.0, 40.0, 10_001)
    chosen = slice(0, None, 997)
    np.testing.assert_allclose(profile.transformed(x)[chosen], profile.transformed(x[chosen]), rtol=ROUND_OFF, atol=0.0)
    assert profile.transformed(np.empty(0)).shape == (0,)
    assert profile.height(np.empty(0)).shape == (0,)


@pytest.mark.parametrize("count", [41, 42])
def test_a_table_is_as_sure_as_without_every_second_point(count: int) -> None:
    """Each inner point is missing once, and the ends stay."""
    given = table(np.linspace(0.0, 40.0, count), np.linspace(0.0, 40.0, count) ** 2)
    points, fewer = set(given.r), [set(other.r) for other in given.coarser]
    assert len(fewer) == 2
    assert set.union(*fewer) == points
    assert set.intersection(*fewer) == {0.0, 40.0}


@pytest.mark.parametrize(("wide", "high"), [(1e-3, 1e-3), (1e4, 1.0), (1.0, 1e5), (1.0, 1e-7)])
def test_a_table_has_the_same_corners_in_any_units(wide: float, high: float) -> None:
    """A worn ball: a flat, then an arc, of which some cells are straight and others smooth."""
    r = np.linspace(0.0, 40.0, 41)
    z = np.maximum(0.0, r**2 - 8.3**2) * (1.0 + 1e-3 * np.sin(r))
    x = np.linspace(0.0, 40.0, 333)
    given, scaled = table(r, z), table(wide * r, high * z)
    assert len(given.alternatives) == len(scaled.alternatives) == 2
    for one, same in zip((given, *given.alternatives), (scaled, *scaled.alternatives), strict=True):
        own, other = one.height(x), same.height(wide * x)
        np.testing.assert_allclose(other, high * own, rtol=1e-9, atol=1e-9 * high * own.max())


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("size", [1.0, 1e-4])
def test_points_without_a_smooth_curve_lie_on_chords_or_in_corners_of_neighbouring_chords(
    seed: int, size: float
) -> None:
    """A body whose slope only rises is below its chords, and above the two that go on from both sides."""
    draw = np.random.default_rng(seed)
    slope = np.cumsum(draw.choice([0.02, 0.2], 24) * draw.uniform(0.5, 1.0, 24))
    r, z = np.arange(25.0), np.append(0.0, np.cumsum(slope))
    profile = table(size * r, size * z)
    chords, corners = profile.alternatives
    x = np.linspace(3.05, 20.95, 359)  # on its ends the curve is smooth
    cell = x.astype(int)
    before, after = (z[i] + slope[i] * (x - r[i]) for i in (cell - 1, cell + 1))
    np.testing.assert_allclose(chords.height(size * x), size * np.interp(x, r, z), rtol=1e-9)
    np.testing.assert_allclose(corners.height(size * x), size * np.maximum(before, after), rtol=1e-9)
    assert {round(place / size, 6) for place in profile.kinks} <= {round(place / size, 6) for place in corners.kinks}


@pytest.mark.parametrize(("digits", "scale"), [(2, 1.0), (0, 1.0), (2, 1e-6), (4, 1e3)])
def test_heights_with_few_digits_may_have_their_apex_half_a_digit_lower(digits: int, scale: float) -> None:
    r = np.arange(31.0)
    rounded = np.round(r**2 / 7.0, digits)
    _, _, lower, *wavy = table(r, scale * rounded).alternatives
    assert len(wavy) == 2
    between = np.array([r[-2] + 0.5])
    own = float(table(r, scale * rounded).height(between)[0])
    assert float(lower.height(between)[0]) - own == pytest.approx(0.5 * scale * 10.0**-digits, rel=1e-6)
    assert len(table(r, scale * r**2 / 7.0).alternatives) == 2


def test_radii_have_gaps_up_to_ten_steps_and_heights_no_apex_elsewhere() -> None:
    r = np.append(np.arange(8.0), 17.0)
    assert table(r, r**2).reach == 17.0
    for radii, heights, words in (
        (np.append(np.arange(8.0), 17.01), r**2, "has a gap from r = 7 to 17.01"),
        (r + 1e-9, r**2, "must begin at the radius 0"),
        (r, -(r**2), "decrease from the axis"),
        (r, np.maximum(r, 2.0 - r) - 1.5, "must have its apex at r = 0; at r = 1 LU the height is lower by 1 LU"),
        (r, 0.0 * r, "is flat"),
        (np.append(r[:-1], 7.0), r**2, "radii must increase; 7 follows 7"),
        (r, r[:-1] ** 2, "as many radii as heights, not 9 and 8"),
    ):
        with pytest.raises(ValueError, match=words):
            table(radii, heights)
