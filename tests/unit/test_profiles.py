"""Shapes of the upper body: heights, the MDR's transform against its defining integral, and measured profiles.

Reference: g(x) = |x| ∫₀^x f′(r)/√(x² − r²) dr by adaptive quadrature, with slopes f′ written down here.
"""

from __future__ import annotations

import math
import pickle
import tomllib
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

from contact1d.workflow.scene import (
    Bodies,
    Circle,
    Cone,
    Ellipsoid,
    FlatPunch,
    Measured,
    Parabola,
    Power,
    Profile,
    SceneError,
    scene_from_dict,
    scene_to_toml,
)

Array = NDArray[np.float64]
Slope = Callable[[float], float]

ROUND_OFF = 1e-13
"""Relative: closed forms of a few operations."""
QUADRATURE = 1e-9
"""Relative: the adaptive quadrature of the check stops there, at worst for the exponent 1.5, whose f′ ~ √r."""
CUBICS = 2e-9
"""Of the height at the edge: round-off. The closed form of a piece is a difference of numbers as large as the slope's
second derivative, h⁻² at a kink: measured 1e-12 with 100 points and 5e-10 with 2000; without a kink 1e-14."""
PLACES = np.array([-40.0, -7.3, -1.0, 1e-3, 0.5, 3.0, 29.0, 45.0])

SHAPES: dict[str, tuple[Profile, Callable[[Array], Array], Slope]] = {
    "parabola": (Parabola(kind="parabola", radius=50.0), lambda x: x**2 / 100.0, lambda r: r / 50.0),
    "circle": (
        Circle(kind="circle", radius=50.0),
        lambda x: 50.0 - np.sqrt(2500.0 - x**2),
        lambda r: r / math.sqrt(2500.0 - r**2),
    ),
    "ellipsoid": (
        Ellipsoid(kind="ellipsoid", radius=50.0, height=20.0),
        lambda x: 20.0 - np.sqrt(400.0 - 0.16 * x**2),
        lambda r: 0.4 * r / math.sqrt(2500.0 - r**2),
    ),
    "cone": (Cone(kind="cone", slope=0.3), lambda x: 0.3 * np.abs(x), lambda r: 0.3),
    "flat_punch": (FlatPunch(kind="flat_punch", radius=50.0), lambda x: 0.0 * x, lambda r: 0.0),
    "power 3": (
        Power(kind="power", exponent=3.0, radius=20.0, height=2.0),
        lambda x: 2.0 * np.abs(x / 20.0) ** 3,
        lambda r: 6.0 * r**2 / 8000.0,
    ),
    "power 1.5": (
        Power(kind="power", exponent=1.5, radius=20.0, height=2.0),
        lambda x: 2.0 * np.abs(x / 20.0) ** 1.5,
        lambda r: 3.0 * math.sqrt(r / 20.0) / 20.0,
    ),
    "power 1": (Power(kind="power", exponent=1.0, radius=20.0, height=2.0), lambda x: np.abs(x) / 10.0, lambda r: 0.1),
}  # fmt: skip
"""Profile, height and slope of each kind that has a formula."""


def transform(slope: Slope, x: float, kinks: tuple[float, ...] = ()) -> float:
    """g(x) of the docstring; the end's 1/√ is the weight of the quadrature, and `kinks` of f′ part the way to it."""
    x = abs(x)
    inner = [k for k in kinks if 0.0 < k < x]
    total = 0.0
    for low, high in pairwise([0.0, *inner]):
        total += quad(lambda r: slope(r) / math.sqrt(x**2 - r**2), low, high, epsabs=0.0, epsrel=1e-11, limit=200)[0]
    last = inner[-1] if inner else 0.0
    weighted = quad(
        lambda r: slope(r) / math.sqrt(x + r), last, x, weight="alg", wvar=(0.0, -0.5), epsabs=1e-13, epsrel=1e-11,
        limit=200,
    )  # fmt: skip
    return x * (total + float(weighted[0]))


def table(r: Array, z: Array) -> Measured:
    return Measured(kind="table", r=tuple(r.tolist()), z=tuple(z.tolist()))


@pytest.mark.parametrize("name", SHAPES)
def test_height_is_that_of_the_formula(name: str) -> None:
    profile, height, _ = SHAPES[name]
    given = PLACES.copy()
    np.testing.assert_allclose(profile.height(given), height(PLACES), rtol=ROUND_OFF, atol=ROUND_OFF)
    assert np.array_equal(given, PLACES)
    assert float(profile.height(np.zeros(1))[0]) == 0.0


@pytest.mark.parametrize("name", SHAPES)
def test_transform_is_its_defining_integral(name: str) -> None:
    profile, _, slope = SHAPES[name]
    exact = [transform(slope, float(x)) for x in PLACES]
    np.testing.assert_allclose(profile.transformed(PLACES.copy()), exact, rtol=QUADRATURE, atol=0.0)


@pytest.mark.parametrize("name", SHAPES)
def test_profile_is_even_and_keeps_the_shape_of_its_places(name: str) -> None:
    profile = SHAPES[name][0]
    places = np.abs(PLACES).reshape(2, 4)
    for function in (profile.height, profile.transformed):
        assert function(places).shape == (2, 4)
        assert np.array_equal(function(places), function(-places))


def test_height_of_a_circle_keeps_its_digits_near_the_apex() -> None:
    """R − √(R² − x²) would lose all of them."""
    x = np.array([1e-3])
    assert Circle(kind="circle", radius=1e6).height(x)[0] == pytest.approx(5e-13, rel=ROUND_OFF)


def test_circle_is_its_parabola_near_the_apex() -> None:
    """The next term of the height is x⁴/8R³, that of the transform x⁴/3R³."""
    x, circle, parabola = np.array([1.0]), Circle(kind="circle", radius=100.0), Parabola(kind="parabola", radius=100.0)
    assert (circle.height(x) - parabola.height(x))[0] == pytest.approx(1.0 / 8e6, rel=1e-3)
    assert (circle.transformed(x) - parabola.transformed(x))[0] == pytest.approx(1.0 / 3e6, rel=1e-3)


def test_power_has_its_height_at_its_radius() -> None:
    for exponent in (1.0, 2.0, 7.5, 50.0):
        profile = Power(kind="power", exponent=exponent, radius=20.0, height=2.0)
        assert profile.height(np.array([-20.0, 20.0])).tolist() == [2.0, 2.0]


def test_square_is_the_parabola_and_the_first_power_the_cone() -> None:
    square = Power(kind="power", exponent=2.0, radius=20.0, height=4.0)
    first = Power(kind="power", exponent=1.0, radius=20.0, height=4.0)
    parabola, cone = Parabola(kind="parabola", radius=50.0), Cone(kind="cone", slope=0.2)
    for function in ("height", "transformed"):
        np.testing.assert_allclose(
            getattr(square, function)(PLACES), getattr(parabola, function)(PLACES), rtol=ROUND_OFF
        )
        np.testing.assert_allclose(getattr(first, function)(PLACES), getattr(cone, function)(PLACES), rtol=ROUND_OFF)


def test_reach_is_where_the_body_ends() -> None:
    reaches = {name: profile.reach for name, (profile, _, _) in SHAPES.items()}
    assert {name for name, reach in reaches.items() if reach == 50.0} == {"circle", "ellipsoid", "flat_punch"}
    assert all(
        reach == math.inf for name, reach in reaches.items() if name not in ("circle", "ellipsoid", "flat_punch")
    )
    assert table(np.arange(5.0), np.arange(5.0) ** 2).reach == 4.0
    assert [name for name, (profile, _, _) in SHAPES.items() if profile.has_edge] == ["flat_punch"]


def test_only_round_bodies_have_a_curvature_radius() -> None:
    curved = {name: profile.curvature_radius for name, (profile, _, _) in SHAPES.items()}
    known = {name: radius for name, radius in curved.items() if radius is not None}
    assert known == {"parabola": 50.0, "circle": 50.0, "ellipsoid": 125.0}
    assert table(np.arange(5.0), np.arange(5.0) ** 2).curvature_radius is None


def test_circle_has_a_finite_transform_at_its_edge() -> None:
    circle = Circle(kind="circle", radius=50.0)
    edge = float(circle.transformed(np.array([50.0]))[0])
    assert math.isfinite(edge)
    assert edge > float(circle.transformed(np.array([49.999999]))[0])
    assert circle.height(np.array([50.0])).tolist() == [50.0]


def test_bodies_take_the_profile_as_drawn_or_transformed_by_their_reduction() -> None:
    x = np.array([0.0, 10.0])
    made = {"particles": 20, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 50.0}, "bulk_stiffness": 1.0}
    for reduction, height in (("geike_popov", 1.0), ("mdr", 2.0)):
        bodies = Bodies.model_validate(made | {"reduction": reduction})
        assert bodies.height(x).tolist() == [0.0, height]
        assert bodies.plane_radius == 50.0 / height
        assert bodies.reach == math.inf


# Measured profiles: heights of formulas at equal steps h, and where the cubics go to.

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
RATES = {"power 3": 2.5, "power 1.5": 2.5, "flat-ended cone": 2.0}
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
    the slope's error, which has no mean over a whole cell, is weighted by √h. A kink that is a point: h²."""
    x = np.linspace(15.0, 39.9, 301)
    errors = [float(np.abs(sampled(name, n).transformed(x) - SAMPLED[name][1](x)).max()) for n in COUNTS]
    assert rate(errors) == pytest.approx(RATES[name], abs=RATE)


@pytest.mark.parametrize("count", [4, 25, 100, 2000])
@pytest.mark.parametrize("name", SAMPLED)
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


# Faults: the points, and words that the message has.
FAULTS: dict[str, tuple[list[float], list[float], str]] = {
    "gap": (
        [0, 1, 2, 3, 13.5], [0, 1, 2, 3, 4],
        "has a gap from r = 3 to 13.5: beside a median step of 1, the longest that is read over is 10; measure there",
    ),
    "not from 0": ([0.5, 1, 2, 3], [0, 1, 2, 3], "must begin at the radius 0, not 0.5: the transform needs the slope"),
    "standing": ([0, 1, 2, 2, 3], [0, 1, 2, 3, 4], "must have rising radii; 2 follows on 2"),
    "falling radii": ([0, 1, 2, 1.5, 3], [0, 1, 2, 3, 4], "must have rising radii; 1.5 follows on 2"),
    "apex elsewhere": ([0, 1, 2, 3], [0, 1, -0.5, 3], "must have its apex at r = 0; at r = 2 it is lower by 0.5"),
    "flat": ([0, 1, 2, 3], [2, 2, 2, 2], 'is flat: write kind = "flat_punch"'),
    "unequal": ([0, 1, 2, 3], [0, 1, 2, 3, 4], "must have as many radii as heights, not 4 and 5"),
}  # fmt: skip


def scene_of(profile: dict[str, Any], **bodies: Any) -> dict[str, Any]:
    return {
        "title": "profile",
        "bodies": {
            "particles": "auto",
            "spacing": 1.0,
            "bulk_stiffness": 1.0,
            "lower": "rigid_plane",
            "profile": profile,
        }
        | bodies,
        "experiment": {"kind": "path", "displacements": [0.1]},
    }


def message(profile: dict[str, Any], **bodies: Any) -> str:
    with pytest.raises(SceneError) as caught:
        scene_from_dict(scene_of(profile, **bodies))
    return str(caught.value)


@pytest.mark.parametrize("name", FAULTS)
def test_points_that_are_no_profile_are_refused(name: str) -> None:
    r, z, words = FAULTS[name]
    printed = message({"kind": "table", "r": r, "z": z})
    assert printed.startswith("bodies.profile = ")
    assert words in printed
    assert "\n" not in printed


def test_steps_up_to_the_longest_are_no_gap() -> None:
    scene = scene_from_dict(scene_of({"kind": "table", "r": [0, 1, 2, 3, 13], "z": [0, 1, 2, 3, 4]}))
    assert scene.bodies.reach == 13.0


@pytest.mark.parametrize(
    "profile", [{"kind": "table"}, {"kind": "table", "r": [0, 1, 2, 3]}, {"kind": "table", "z": [0.0] * 4}]
)
def test_a_table_needs_a_file_or_both_lists(profile: dict[str, Any]) -> None:
    assert "must have a file, or the lists r and z" in message(profile)


def test_radii_are_not_negative_and_heights_are_finite() -> None:
    assert "must have rising radii; -2 follows on 1" in message(
        {"kind": "table", "r": [0, 1, -2, 3], "z": [0, 1, 2, 3]}
    )
    assert "bodies.profile.z[1] = nan" in message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, math.nan, 2, 3]})
    assert "bodies.profile.z[1] = true" in message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, True, 2, 3]})


def test_fewer_than_four_points_are_too_few() -> None:
    printed = message({"kind": "table", "r": [0, 1], "z": [0, 1]})
    assert "at least one item" not in printed
    assert printed.count("must have at least 4 items") == 2


def test_a_point_that_is_no_number_is_one_problem() -> None:
    printed = message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, math.nan, 2, 3]})
    assert printed == "bodies.profile.z[1] = nan: must be a finite number (LU)"


def test_scale_belongs_to_a_file() -> None:
    assert "scale" in message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, 1, 4, 9], "scale": 2.0})


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        ({"kind": "power", "exponent": 0.9, "radius": 1.0, "height": 1.0}, "exponent = 0.9: must be at least 1"),
        ({"kind": "power", "exponent": 2.0, "radius": 1.0}, "bodies.profile.height: missing"),
        ({"kind": "power", "exponent": 2.0, "radius": 1.0, "height_there": 1.0}, "profile.height_there: unknown key"),
        ({"kind": "cone", "slope": 0.0}, "bodies.profile.slope = 0.0: must be greater than 0"),
        ({"kind": "cone", "radius": 3.0}, "bodies.profile.radius: unknown key"),
        ({"kind": "circle", "radius": -3.0}, "bodies.profile.radius = -3.0: must be greater than 0 (LU)"),
    ],
)  # fmt: skip
def test_each_kind_has_its_own_keys_and_ranges(profile: dict[str, Any], words: str) -> None:
    assert words in message(profile)


def test_a_scene_with_a_table_is_hashable_equal_and_survives_pickling() -> None:
    tables = scene_of({"kind": "table", "r": [0, 1, 2, 3], "z": [0, 1, 4, 9]})
    scene, same = scene_from_dict(tables), scene_from_dict(tables)
    other = scene_from_dict(scene_of({"kind": "table", "r": [0, 1, 2, 3], "z": [0, 1, 4, 9.5]}))
    assert scene == same
    assert hash(scene) == hash(same)
    assert scene != other
    copy = pickle.loads(pickle.dumps(scene))
    assert copy == scene
    x = np.linspace(-3.0, 3.0, 7)
    assert np.array_equal(copy.bodies.height(x), scene.bodies.height(x))
    drawn, others = scene.bodies.profile.height(x), other.bodies.profile.height(x)
    assert np.array_equal(others[1:-1], drawn[1:-1])


@pytest.mark.parametrize("name", SHAPES)
def test_every_kind_reads_back_from_the_text_of_its_scene(name: str) -> None:
    scene = scene_from_dict(scene_of(SHAPES[name][0].model_dump(by_alias=True, exclude_none=True), reduction="mdr"))
    assert scene.bodies.profile == SHAPES[name][0]
    assert scene_from_dict(tomllib.loads(scene_to_toml(scene))) == scene
