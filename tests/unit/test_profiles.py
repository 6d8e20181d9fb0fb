"""Profiles in a scene: heights by formula, the MDR's transform by its defining integral, and what no profile is.

References: g(x) = |x| ∫₀^|x| f′(r)/√(x² − r²) dr by adaptive quadrature, with slopes f′ written down here; bodies whose
points are those of a formula, with the rates at which cubics through them converge.
"""

import math
import pickle
import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d import read_scene
from tests.scenes import refused

Function = Callable[[Any], Any]

ROUND_OFF = 1e-13
"""Relative: closed forms of a few operations."""
QUADRATURE = 1e-9
"""Relative: the adaptive quadrature of the check stops there, at worst for the exponent 1.5, whose f′ ~ √r."""
CUBICS = 2e-9
"""Of the height at the edge: a piece's closed form is a difference of numbers as large as f″/h, measured 5e-10."""
PLACES = np.array([[-40.0, -7.3, -1.0, 1e-3], [0.5, 3.0, 29.0, 45.0]])
FORMULAS: dict[str, tuple[dict[str, Any], Function, Function, float, float | None]] = {
    "parabola": ({"radius": 50.0}, lambda x: x**2 / 100.0, lambda r: r / 50.0, math.inf, 50.0),
    "circle": (
        {"radius": 50.0}, lambda x: 50.0 - np.sqrt(2500.0 - x**2), lambda r: r / math.sqrt(2500.0 - r**2), 50.0, 50.0,
    ),
    "ellipsoid": (
        {"radius": 50.0, "height": 20.0}, lambda x: 20.0 - np.sqrt(400.0 - 0.16 * x**2),
        lambda r: 0.4 * r / math.sqrt(2500.0 - r**2), 50.0, 125.0,
    ),
    "cone": ({"slope": 0.3}, lambda x: 0.3 * np.abs(x), lambda r: 0.3, math.inf, None),
    "flat_punch": ({"radius": 50.0}, lambda x: 0.0 * x, lambda r: 0.0, 50.0, None),
    "capped_punch": (
        {"radius": 50.0, "cap_radius": 30.0}, lambda x: x**2 / 60.0, lambda r: r / 30.0, 50.0, None,
    ),
    "power": (
        {"exponent": 1.5, "radius": 20.0, "height": 2.0}, lambda x: 2.0 * np.abs(x / 20.0) ** 1.5,
        lambda r: 3.0 * math.sqrt(r / 20.0) / 20.0, math.inf, None,
    ),
    "hyperboloid": (
        {"slope": 0.3, "tip_radius": 50.0}, lambda x: np.hypot(4.5, 0.3 * x) - 4.5,
        lambda r: 0.3 * r / math.hypot(15.0, r), math.inf, 50.0,
    ),
    "blunt_cone": (
        {"slope": 0.3, "tip_radius": 50.0},
        lambda x: np.where(np.abs(x) < 15.0, x**2 / 100.0, 0.3 * np.abs(x) - 2.25), lambda r: min(r / 50.0, 0.3),
        math.inf, 50.0,
    ),
    "truncated_cone": (
        {"slope": 0.3, "land_radius": 9.0}, lambda x: 0.3 * np.maximum(np.abs(x) - 9.0, 0.0),
        lambda r: 0.3 * (r > 9.0), math.inf, None,
    ),
    "truncated_parabola": (
        {"radius": 50.0, "land_radius": 9.0}, lambda x: np.maximum(x**2 - 81.0, 0.0) / 100.0,
        lambda r: r / 50.0 * (r > 9.0), math.inf, None,
    ),
    "rounded_punch": (
        {"radius": 9.0, "edge_radius": 50.0}, lambda x: np.maximum(np.abs(x) - 9.0, 0.0) ** 2 / 100.0,
        lambda r: max(r - 9.0, 0.0) / 50.0, math.inf, None,
    ),
}  # fmt: skip
"""Keys, height, slope, half-width of the body and radius of curvature of each kind that has a formula."""


def tables(profile: dict[str, Any], **bodies: Any) -> dict[str, Any]:
    given = {"particles": "auto", "spacing": 1.0, "bulk_stiffness": 1.0, "lower": "rigid_plane", "profile": profile}
    return {"title": "x", "bodies": given | bodies, "experiment": {"kind": "path", "displacements": [0.1]}}


def drawn_and_transformed(profile: dict[str, Any]) -> list[Any]:
    """The bodies of a scene, whose height is that of its reduction."""
    return [read_scene(tables(profile, reduction=name)).bodies for name in ("geike_popov", "mdr")]


def message(profile: dict[str, Any]) -> str:
    return str(refused(tables(profile)))


def transform(slope: Function, x: float) -> float:
    """g(x) of the module; the end's 1/√ is the weight of the quadrature."""
    last = {"weight": "alg", "wvar": (0.0, -0.5), "epsabs": 1e-13, "epsrel": 1e-11, "limit": 200}
    return float(x * quad(lambda r: slope(r) / math.sqrt(x + r), 0.0, x, **last)[0])


@pytest.mark.parametrize("kind", FORMULAS)
def test_height_is_the_formula_and_transform_its_defining_integral(kind: str) -> None:
    keys, height, slope, reach, curvature = FORMULAS[kind]
    drawn, transformed = drawn_and_transformed({"kind": kind} | keys)
    places = PLACES.copy()
    np.testing.assert_allclose(drawn.height(places), height(PLACES), rtol=ROUND_OFF, atol=ROUND_OFF)
    exact = [[transform(slope, abs(float(x))) for x in row] for row in PLACES]
    np.testing.assert_allclose(transformed.height(places), exact, rtol=QUADRATURE, atol=0.0)
    assert np.array_equal(places, PLACES)
    assert np.array_equal(transformed.height(places), transformed.height(-places))
    assert drawn.height(np.zeros(1)).tolist() == [0.0]
    assert reach == math.inf or math.isfinite(transformed.height(np.array([reach]))[0])
    if curvature:  # no difference of large numbers, which would lose all digits
        assert drawn.height(np.array([1e-4]))[0] == pytest.approx(5e-9 / curvature, rel=1e-10)
    assert (drawn.reach, drawn.profile.curvature_radius) == (reach, curvature)
    scene = read_scene(tables({"kind": kind} | keys))
    assert read_scene(tomllib.loads(str(scene))) == scene == pickle.loads(pickle.dumps(scene))


# Measured profiles: points of a formula at equal steps h.

COUNTS = (20, 40, 80, 160, 320)
SAMPLED: dict[str, tuple[Function, Function]] = {
    "parabola": (lambda r: r**2 / 100.0, lambda x: x**2 / 50.0),
    "power 3": (lambda r: r**3 / 4000.0, lambda x: 0.75 * math.pi * x**3 / 4000.0),
    "power 1.5": (
        lambda r: r**1.5 / 40.0,
        lambda x: 0.75 * math.sqrt(math.pi) * math.gamma(0.75) / math.gamma(1.25) * x**1.5 / 40.0,
    ),
    "flat-ended cone": (
        lambda r: 0.3 * np.maximum(r - 10.0, 0.0), lambda x: 0.3 * x * np.arccos(np.minimum(10.0 / x, 1.0)),
    ),
}  # fmt: skip
"""Height and transform; the rates are those from x = 15 on, so that a place has many points before it."""
RATE = 0.25
"""Of an exponent; measured 0.2 for the heights of the third power, with the fewest points, and less else."""


def table(r: Any, z: Any) -> Any:
    """The profile of these points in a scene."""
    return read_scene(tables({"kind": "table", "r": np.asarray(r), "z": np.asarray(z)})).bodies.profile


def sampled(name: str, count: int) -> Any:
    r = np.linspace(0.0, 40.0, count + 1)
    return table(r, SAMPLED[name][0](r))


@pytest.mark.parametrize("count", [20, 320])
def test_a_sampled_paraboloid_is_the_paraboloid(count: int) -> None:
    """The slopes at the points are those of parabolas through them, and the transform of the cubics is exact."""
    (height, transformed), x = SAMPLED["parabola"], np.linspace(0.1, 39.9, 10_001)  # of so many a part at a time
    profile = sampled("parabola", count)
    np.testing.assert_allclose(profile.height(x), height(x), rtol=1e3 * ROUND_OFF)
    np.testing.assert_allclose(profile.transformed(x), transformed(x), rtol=0.0, atol=CUBICS * transformed(x)[-1])


@pytest.mark.parametrize("name", ["power 3", "power 1.5"])
def test_a_sampled_formula_converges_at_the_rates_of_its_heights_and_slopes(name: str) -> None:
    """The slope at a point is off by h²f‴/6, the height between points by h times that. The transform has half an order
    less than smooth slopes would give: 1/√(x² − r²) weights the slope's error in the last cell by √h."""
    x = np.linspace(15.0, 39.9, 301)
    profiles, (height, transformed) = [sampled(name, count) for count in COUNTS], SAMPLED[name]
    for errors, order in (
        ([np.abs(one.height(x) - height(x)).max() for one in profiles], 3.0),
        ([np.abs(one.transformed(x) - transformed(x)).max() for one in profiles], 2.5),
    ):
        rate = -float(np.polyfit(np.log(COUNTS), np.log(errors), 1)[0])
        assert rate == pytest.approx(order, abs=RATE)


@pytest.mark.parametrize("count", [20, 57])
def test_a_corner_is_met_at_a_point_and_between_two_however_near_to_one(count: int) -> None:
    """Straight flanks that meet at r = 10; a ball worn to another radius: the parabolas of both sides are exact."""
    profile, (height, transformed) = sampled("flat-ended cone", count), SAMPLED["flat-ended cone"]
    x = np.linspace(0.1, 39.9, 301)
    assert profile.kinks == pytest.approx((10.0,), rel=1e-9)
    np.testing.assert_allclose(profile.height(x), height(x), rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(profile.transformed(x), transformed(x), rtol=0.0, atol=1e-8)
    r = np.arange(61.0)
    for b in (20.01, 20.99):
        worn = np.minimum(r, b) ** 2 / 4000.0 + np.maximum(r**2 - b**2, 0.0) / 200.0
        assert table(r, worn).kinks == pytest.approx((b,), rel=1e-9)


def test_a_table_passes_through_its_points_from_its_apex_to_its_end_and_never_over_them() -> None:
    """Kinks and flat parts: a monotone cubic rises only where its points do."""
    r = np.array([0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 6.0])
    z = np.array([0.0, 0.0, 0.0, 1.0, 5.0, 5.0, 5.5])
    profile, x = table(r, 7.0 + z), np.linspace(0.0, 6.0, 6001)
    height = profile.height(x)
    assert profile.height(-r) == pytest.approx(z, abs=10.0 * ROUND_OFF)
    assert np.all(np.diff(height) >= -10.0 * ROUND_OFF)
    assert height[(x >= 3.5) & (x <= 4.0)] == pytest.approx(5.0, abs=10.0 * ROUND_OFF)
    assert np.abs(profile.transformed(x[x <= 2.0])).max() == 0.0
    assert profile.reach == 6.0
    assert np.ptp(profile.transformed(np.array([6.0, 7.0, -1e6]))) == 0.0


@pytest.mark.parametrize("count", [41, 42])
def test_a_table_is_as_sure_as_without_every_second_point(count: int) -> None:
    """Each inner point is missing once, and the ends stay."""
    given = table(np.linspace(0.0, 40.0, count), np.linspace(0.0, 40.0, count) ** 2)
    fewer = [set(np.unique(other.r)) for other in given.coarser]
    assert len(fewer) == 2
    assert set.union(*fewer) == set(given.r)
    assert set.intersection(*fewer) == {0.0, 40.0}


def test_a_corner_at_a_point_is_found_where_no_slope_keeps_both_cubics_convex() -> None:
    """A jump of the slope of 3.6 times its rise from point to point; the transform of a convex body rises."""
    r = np.arange(36.0)
    body = table(r, 0.01 * r**2 + 0.072 * np.maximum(r - 11.0, 0.0))
    assert body.kinks == (11.0,)
    assert np.diff(body.transformed(np.linspace(0.0, 35.0, 2001))).min() > 0.0


def test_points_without_a_smooth_curve_lie_on_chords_or_in_corners_of_neighbouring_chords() -> None:
    """A body whose slope only rises is below its chords, and above the two that go on from both sides."""
    draw = np.random.default_rng(1)
    slope = np.cumsum(draw.choice([0.02, 0.2], 24) * draw.uniform(0.5, 1.0, 24))
    r, z = np.arange(25.0), np.append(0.0, np.cumsum(slope))
    chords, corners = table(r, z).alternatives
    x = np.linspace(3.05, 20.95, 359)  # on its ends the curve is smooth
    cell = x.astype(int)
    before, after = (z[i] + slope[i] * (x - r[i]) for i in (cell - 1, cell + 1))
    np.testing.assert_allclose(chords.height(x), np.interp(x, r, z), rtol=1e-9)
    np.testing.assert_allclose(corners.height(x), np.maximum(before, after), rtol=1e-9)


@pytest.mark.parametrize(("wide", "high"), [(1e-3, 1e-3), (1.0, 1e-7)])
def test_a_table_is_the_same_body_in_any_units(wide: float, high: float) -> None:
    """A worn ball: a flat, then an arc, of which some cells are straight and others smooth."""
    r, x = np.linspace(0.0, 40.0, 41), np.linspace(0.0, 40.0, 333)
    z = np.maximum(0.0, r**2 - 8.3**2) * (1.0 + 1e-3 * np.sin(r))
    given, scaled = table(r, z), table(wide * r, high * z)
    assert len(given.alternatives) == len(scaled.alternatives) == 2
    for one, same in zip((given, *given.alternatives), (scaled, *scaled.alternatives), strict=True):
        np.testing.assert_allclose(same.height(wide * x), high * one.height(x), rtol=1e-9, atol=1e-6 * high)


@pytest.mark.parametrize(("digits", "scale"), [(2, 1.0), (0, 1e3)])
def test_heights_with_few_digits_may_have_their_apex_half_a_digit_lower(digits: int, scale: float) -> None:
    r = np.arange(31.0)
    given = table(r, scale * np.round(r**2 / 7.0, digits))
    _, _, lower, *wavy = (one.height(r[1:]) - given.height(r[1:]) for one in given.alternatives)
    half = 0.5 * scale * 10.0**-digits
    assert lower == pytest.approx(half, rel=1e-6)
    for change, pattern in zip(wavy, ([-1, -1, 1, 1], [-1, 1, 1, -1]), strict=True):
        assert change == pytest.approx(half * np.resize(pattern, 30), rel=1e-6)
    assert len(table(r, scale * r**2 / 7.0).alternatives) == 2


NUMBERS = [0.0, 1.0, 2.0, 3.0]
NO_TABLE = [
    (NUMBERS, [0, 1, 2, 3, 4], "must have as many radii as heights, not 4 and 5"),
    ([*NUMBERS, 13.01], [0, 1, 2, 3, 4], "has a gap from r = 3 LU to 13.01 LU: the median step is 1 LU"),
    ([1e-9, 1, 2, 3], NUMBERS, "must begin at the radius 0, not 1e-09 LU: the transform needs the slope"),
    ([0, 1, 2, 2, 3], [0, 1, 2, 3, 4], "radii must increase; 2 LU follows 2 LU"),
    (NUMBERS, [0, 1, -0.5, 3], "its apex at r = 0; at r = 2 LU the height is lower by 0.5 LU"),
    (NUMBERS, [3, 2, 1, 0], "decrease from the axis"),
    (NUMBERS, [2, 2, 2, 2], 'is flat: write kind = "flat_punch"'),
    ([0, 1], NUMBERS, "bodies.profile.r = [0, 1]: must have at least 4 items"),
    (NUMBERS, [0, math.nan, 2, 3], "bodies.profile.z[1] = nan: must be a finite number (LU)"),
    (NUMBERS, None, "needs a file, or the lists r and z"),
]  # fmt: skip


@pytest.mark.parametrize(("r", "z", "words"), NO_TABLE)
def test_points_that_are_no_profile_are_one_sentence(r: list[float], z: list[float] | None, words: str) -> None:
    printed = message({"kind": "table", "r": r, "z": z})
    assert printed.startswith("bodies.profile")
    assert words in printed
    assert "\n" not in printed


def test_a_gap_of_ten_steps_is_accepted() -> None:
    assert table([*NUMBERS, 13.0], [0, 1, 4, 9, 16]).reach == 13.0
