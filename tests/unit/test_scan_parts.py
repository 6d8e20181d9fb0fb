"""What the reading of a scan is made of: similarity, shapes and their derivatives, bounds, noise, deviations."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from contact1d.analysis.form import Form, named, smooth
from contact1d.analysis.residual import autocovariance, bounded, independent, noise_by, noise_in
from contact1d.analysis.scan import ScanError, is_two_sided, one_pass, take
from tests.unit.test_scan import NOISE, WIDE, Array, curve, white, worn

ROUND_OFF = 1e-12
STEP, DIFFERENCE = 1e-6, 1e-7
"""Of a central difference, whose error is its square and 1e-16 over it."""
SAME = 1e-6
"""Relative: of fits whose steps end at 1e-10, of points that are the same but for round-off."""
RADII = np.linspace(0.0, 0.9, 37)
KNOTS = np.array([0.0, 0.1, 0.35, 0.4, 0.9])
FORMS: dict[str, tuple[Form, Array]] = {
    "parabola": (named("parabola", 0.7), np.array([0.8])),
    "circle": (named("circle", 0.7), np.array([0.8])),
    "power": (named("power", 0.7), np.array([0.6, 1.6])),
    "slopes": (smooth(KNOTS, False), np.array([0.3, 0.1, 0.5, 0.2])),
    "rises": (smooth(KNOTS, True), np.array([0.3, 0.1, 0.5, 0.2])),
}


def tilted(x: Array, apex: float = 13.37) -> Array:
    return 40.0 + worn(x - apex) + 2e-3 * x + white(5, x)


@pytest.mark.parametrize("how", [{"level": True}, {"shape": "parabola"}, {"shape": "power"}, {"length": 90.0}])
def test_a_scan_in_another_unit_and_from_another_origin_is_the_same_body(how: dict[str, Any]) -> None:
    size, right, up = 1e-3, -70.0, 5.0
    own = take(WIDE, tilted(WIDE), None, **how)
    if "length" in how:
        how = how | {"length": size * how["length"]}
    other = take(size * WIDE + right, size * tilted(WIDE) + up, None, **how)
    for name in ("reach", "noise", "correlation", "missed", "pitch"):
        assert getattr(other, name) == pytest.approx(size * getattr(own, name), rel=SAME)
    assert other.centre[0] - right == pytest.approx(size * own.centre[0], rel=SAME)
    assert other.offset[0] - up == pytest.approx(size * own.offset[0], rel=SAME)
    for name in ("centre", "offset"):
        assert getattr(other, name)[1] == pytest.approx(size * getattr(own, name)[1], rel=1e-3)
    assert other.tilt == pytest.approx(own.tilt, rel=1e-3)
    powers = {"parabola": [-1.0], "power": [1.0, 0.0]}.get(own.shape, [0.0])
    assert other.parameters == pytest.approx(own.parameters * size ** np.array(powers), rel=1e-4, abs=1e-9)
    assert other.patches == own.patches


@pytest.mark.parametrize("how", [{"level": True}, {"shape": "parabola"}])
def test_a_scan_from_the_other_side_is_the_mirror_image(how: dict[str, Any]) -> None:
    own, other = (take(x, z, None, **how) for x, z in ((WIDE, tilted(WIDE)), (-WIDE[::-1], tilted(WIDE)[::-1])))
    assert other.centre[0] == pytest.approx(-own.centre[0], rel=SAME)
    assert other.tilt[0] == pytest.approx(-own.tilt[0], rel=SAME, abs=ROUND_OFF)
    assert other.noise == pytest.approx(own.noise, rel=SAME)
    assert other.reach == pytest.approx(own.reach, rel=SAME)
    assert other.residual == pytest.approx(own.residual[::-1], abs=SAME * NOISE)


@pytest.mark.parametrize("name", FORMS)
def test_a_shape_has_the_slope_and_the_derivatives_of_its_height(name: str) -> None:
    form, theta = FORMS[name]
    r = RADII[1:-1] + 1e-3
    slope = (form.value(r + STEP, theta) - form.value(r - STEP, theta)) / (2.0 * STEP)
    assert form.slope(r, theta) == pytest.approx(slope, abs=DIFFERENCE)
    by = [(form.value(r, theta + one) - form.value(r, theta - one)) / (2.0 * STEP) for one in STEP * np.eye(theta.size)]
    assert form.gradient(r, theta) == pytest.approx(np.stack(by, axis=1), abs=DIFFERENCE)
    assert form.value(np.zeros(1), theta) == pytest.approx(0.0, abs=ROUND_OFF)


def test_shapes_are_those_of_their_formulas() -> None:
    for name, height in (
        ("parabola", 0.4 * RADII**2),
        ("circle", 1.25 - np.sqrt(1.25**2 - RADII**2)),
        ("power", 0.6 * RADII**1.6),
    ):
        form, theta = FORMS[name]
        assert form.value(RADII, theta) == pytest.approx(height, abs=ROUND_OFF)


@pytest.mark.parametrize("convex", [False, True])
def test_a_smooth_curve_has_its_slopes_at_the_knots_and_begins_as_a_parabola(convex: bool) -> None:
    form, theta = FORMS["rises" if convex else "slopes"]
    slopes = np.cumsum(theta) if convex else theta
    assert form.slope(KNOTS, theta) == pytest.approx([0.0, *slopes], abs=ROUND_OFF)
    assert form.shown(theta) == pytest.approx(slopes, abs=ROUND_OFF)
    assert form.value(RADII, form.start) == pytest.approx(0.5 * RADII**2, abs=ROUND_OFF)
    assert np.all(form.shown(-theta) == 0.0)


def test_bounded_least_squares_are_those_of_scipy() -> None:
    draw = np.random.default_rng(7)
    at_bound = 0
    for _ in range(20):
        columns, target = draw.normal(size=(12, 5)) * 10.0 ** draw.uniform(-3, 3, 5), draw.normal(size=12)
        least = draw.normal(size=3) / np.linalg.norm(columns[:, :3], axis=0)
        exact = lsq_linear(columns, target, ([*least, -np.inf, -np.inf], np.inf), method="bvls", tol=1e-14).x
        found = bounded(columns, target, least)
        assert columns @ found == pytest.approx(columns @ exact, abs=1e-8)
        assert np.all(found[:3] >= least)
        at_bound += int((found[:3] - least < 1e-12 / np.linalg.norm(columns[:, :3], axis=0)).sum())
    assert 10 < at_bound < 50


def test_the_autocovariance_is_the_mean_of_products() -> None:
    drawn = np.random.default_rng(2).normal(size=50)
    exact = [float(drawn[: 50 - k] @ drawn[k:]) / 50.0 for k in range(50)]
    assert autocovariance(drawn) == pytest.approx(exact, abs=ROUND_OFF)


def test_correlations_count_up_to_the_first_that_is_chance() -> None:
    """σ² 0.8ᵏ of 400 points: 0.8¹⁰ = 0.107 counts and 0.8¹¹ = 0.086 does not, since 2/√400 = 0.1."""
    noise = noise_by(9.0 * 0.8 ** np.arange(40.0), 400)
    assert noise.deviation == pytest.approx(3.0)
    assert noise.together == pytest.approx(1.0 + 2.0 * sum(0.8**k for k in range(1, 11)))
    assert noise.power == pytest.approx(9.0 * noise.together)
    n = 400.0 / noise.together
    assert noise.price(400, 7) == pytest.approx(noise.power * (math.log(n) + 2.0 * math.log(7.0)))
    alternating = noise_in(np.tile([1.0, -1.0], 50))
    assert (alternating.deviation, alternating.together) == pytest.approx((1.0, 1.0))
    assert noise_in(np.zeros(9)).power == 0.0


def test_a_sample_to_both_sides_is_its_own_deviation() -> None:
    """Of two directions the one that moves heights more comes first; what moves none is left out."""
    along, across = np.array([2.0, 1.0, 0.0]), np.array([-0.1, 0.2, 0.0])
    sample = np.array([along + across, along - across, -along + across, -along - across])
    pairs = independent(sample, np.eye(3))
    assert pairs.shape == (2, 2, 3)
    for pair, one in zip(pairs, (along, across), strict=True):
        assert np.abs(0.5 * (pair[0] - pair[1])) == pytest.approx(np.abs(one), abs=ROUND_OFF)
    assert len(independent(sample, np.array([[1.0, 2.0, 0.0]]) - np.array([[0.0, 0.0, 1.0]]))) == 1


def test_forth_and_back_are_one_pass_on_the_positions_of_the_first() -> None:
    forth, back = np.arange(0.0, 11.0), np.arange(9.75, 0.5, -0.5)
    x, z = one_pass(np.append(forth, back), np.append(3.0 * forth, 3.0 * back + 1.0))
    assert x == pytest.approx(np.arange(1.0, 11.0))
    assert z == pytest.approx(3.0 * x + 0.5 * (x < 10.0))  # both passes have the point where it turns
    x, z = one_pass(np.append(forth[::-1], [0.5, 1.0]), np.append(forth[::-1] ** 2, [7.0, 7.0]))
    assert (x, z) == (pytest.approx(forth), pytest.approx(forth**2))
    x, z = one_pass(np.array([0.0, 1.0, 1.0, 2.0]), np.array([0.0, 1.0, 3.0, 5.0]))
    assert (x.tolist(), z.tolist()) == ([0.0, 1.0, 2.0], [0.0, 2.0, 5.0])


def test_an_apex_has_two_sides_where_a_twentieth_of_the_width_is_beyond_it() -> None:
    assert is_two_sided(np.linspace(-0.06, 0.94, 9))
    assert not is_two_sided(np.linspace(-0.04, 0.96, 9))
    assert is_two_sided(np.linspace(-940.0, 60.0, 9))
    assert not is_two_sided(np.linspace(-960.0, 40.0, 9))


def test_points_of_both_sides_are_folded_to_their_mean_up_to_the_nearer_end() -> None:
    x = np.arange(-30.0, 51.0, 2.0)
    taken = take(x, 7.0 + x**2 / 200.0 + 0.1 * np.tanh(x / 10.0), 0.0)
    r, z = taken.folded()
    assert taken.both_sides
    assert (r[0], r[-1], r.size) == (0.0, 30.0, 16)
    assert z == pytest.approx(r**2 / 200.0, abs=1e-9)
    side = take(x[x >= 0.0], x[x >= 0.0] ** 2 / 200.0, 0.0)
    r, z = side.folded()
    assert not side.both_sides
    assert (r[-1], r.size, side.pitch) == (50.0, 26, 2.0)
    assert z == pytest.approx(r**2 / 200.0, abs=1e-9)


def test_knots_at_a_given_distance_are_so_far_apart() -> None:
    taken = take(WIDE, worn(WIDE, 0.0) + white(1, WIDE), 0.0, length=50.0)
    assert np.diff(taken.knots) == pytest.approx(50.0, rel=1e-9)
    assert taken.knots[-1] == pytest.approx(600.0, rel=1e-9)
    r = np.linspace(0.0, 590.0, 50)
    assert curve(taken, r) == pytest.approx(worn(r, 0.0), abs=3.0 * NOISE)


def test_few_points_are_refused_and_as_many_as_are_asked_are_not() -> None:
    with pytest.raises(ScanError, match="has 7 points"):
        take(WIDE[:7], WIDE[:7] ** 2)
    x = np.arange(-4.0, 4.0)
    assert 1.0 / take(x, x**2 / 10.0, shape="parabola").parameters[0] == pytest.approx(5.0, rel=SAME)


def test_the_autocorrelation_is_known_as_far_as_most_points_have_a_partner() -> None:
    """ρ₀ = 1, and up to a quarter of the scan: of points farther apart there are few pairs."""
    taken = take(WIDE, worn(WIDE, 0.0) + white(1, WIDE), 0.0, shape="parabola")
    assert taken.autocorrelation[0] == pytest.approx(1.0)
    assert taken.pitch * taken.autocorrelation.size == pytest.approx(0.25 * (WIDE[-1] - WIDE[0]), abs=taken.pitch)
    assert np.abs(taken.autocorrelation[1:]).max() < 0.2
