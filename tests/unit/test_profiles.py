"""Shapes of the upper body: heights, and the MDR's transform against its defining integral."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contact1d.workflow.scene import (
    Bodies,
    Circle,
    Cone,
    Parabola,
    Power,
)
from tests.shapes import PLACES, QUADRATURE, ROUND_OFF, SHAPES, table, transform


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
