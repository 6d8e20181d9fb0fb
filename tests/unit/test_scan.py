"""What is taken of a scan, beside the body that it was made of: apex, tilt, offset, noise, curve and deviations.

Statistics are those of the generator: a share of seeds has the binomial bounds that its test names.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from contact1d.analysis.residual import independent, noise_by
from contact1d.analysis.scan import ScanError, Taken, one_pass
from contact1d.analysis.scan_fit import take

R, LAND, NOISE = 1e4, 100.0, 3e-3
"""[µm]; 3 nm."""
WIDE, SIDE = np.arange(-600.0, 600.5, 1.0), np.arange(0.0, 600.5, 1.0)
Array = np.ndarray[Any, np.dtype[np.float64]]
SEEDS, FEWEST = 40, 33
"""Of 40 values each inside by 95 %, 33 or fewer would be seen once in 5000 times."""


def worn(x: Array, land: float = LAND) -> Array:
    return np.asarray(np.maximum(x**2 - land**2, 0.0) / (2.0 * R))


def white(seed: int, x: Array, deviation: float = NOISE) -> Array:
    return deviation * np.random.default_rng(seed).standard_normal(x.size)


def correlated(seed: int, x: Array, length: float) -> Array:
    """Exponential autocorrelation."""
    kept = math.exp(-float(x[1] - x[0]) / length)
    drawn = np.random.default_rng(seed).standard_normal(x.size + 1000)
    return np.asarray(NOISE * lfilter([math.sqrt(1.0 - kept**2)], [1.0, -kept], drawn)[1000:])


def curve(taken: Taken, r: Array) -> Array:
    """The height of a smooth curve: its slope is linear between the knots."""
    fine = np.linspace(0.0, taken.reach, 60_001)
    slope = np.interp(fine, taken.knots, np.append(0.0, taken.parameters))
    height = np.concatenate([[0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * np.diff(fine))])
    return np.interp(r, fine, height)


@pytest.mark.parametrize(("shape", "step"), [("parabola", 20), ("circle", 10), ("power", 10)])
def test_a_named_shape_without_noise_is_found_with_its_apex_and_offset(shape: Any, step: int) -> None:
    x = WIDE[::step]
    r = np.abs(x - 37.3)
    exact = {"parabola": r**2 / (2.0 * R), "circle": R - np.sqrt(R**2 - r**2), "power": 40.0 * (r / 600.0) ** 1.7}
    taken = take(x, 40.0 + exact[shape], centre=None, shape=shape)
    # Rounding of heights of 40 to 60 at 1e-16 of them, over the curvature.
    assert taken.centre[0] == pytest.approx(37.3, rel=1e-6)
    assert taken.offset[0] == pytest.approx(40.0, rel=1e-9)
    assert np.isfinite(taken.deviations).all()
    first, *more = taken.parameters.tolist()
    if shape == "power":
        assert more[0] == pytest.approx(1.7, rel=1e-6)
        assert first * (600.0 / 1200.0) ** 1.7 == pytest.approx(40.0, rel=1e-6)
    else:
        assert 1.0 / first == pytest.approx(R, rel=1e-6)


def test_a_radius_and_an_apex_are_within_their_uncertainties() -> None:
    """A tilt moves the apex by R tan, and nothing else."""
    tilt, inside, x = math.tan(math.radians(0.1)), np.zeros(2, dtype=int), WIDE[::10]
    for seed in range(SEEDS):
        z = x**2 / (2.0 * R) + tilt * x + white(seed, x)
        taken = take(x, z, centre=None, shape="parabola")
        low, high = sorted(1.0 / taken.deviations[1, :, 0])
        inside += [low <= R <= high, abs(taken.centre[0] + R * tilt) <= taken.centre[1]]
    assert inside.min() >= FEWEST
    # z = x²/2R + b x: the apex moves by R b, and the heights determine b to σ/√Σx²; the sample is uncertain by 4 %.
    assert taken.centre[1] == pytest.approx(1.98 * R * taken.noise / math.sqrt(np.sum(x**2)), rel=0.1)
    assert taken.offset[1] < NOISE


def test_noise_and_its_correlation_length_are_those_of_the_generator() -> None:
    found = [take(WIDE, worn(WIDE, 0.0) + correlated(seed, WIDE, 5.0), centre=None) for seed in range(6)]
    # Of 600 differences of both sides, 6 times.
    assert np.mean([one.noise for one in found]) == pytest.approx(NOISE, rel=0.1)
    assert np.mean([one.correlation for one in found]) == pytest.approx(5.0, rel=0.3)


@pytest.mark.parametrize(("x", "depth"), [(WIDE, 15.0), (SIDE, 3.0)])
def test_a_shallow_land_is_within_the_deviations(x: Array, depth: float) -> None:
    """The height of the flank over the land, which the noise hides in part; of ten scans two or fewer are outside."""
    land = math.sqrt(2.0 * R * depth * NOISE)
    outside = 0
    for seed in range(10):
        taken = take(x, worn(x, land) + correlated(seed, x, 3.0), centre=0.0)
        fits = [replace(taken, parameters=theta) for pair in taken.deviations for theta in pair]
        off, *ends = (float(curve(fit, np.asarray([2.0 * land]))[0]) for fit in (taken, *fits))
        spread = math.sqrt(sum((0.5 * (more - less)) ** 2 for more, less in zip(ends[::2], ends[1::2], strict=True)))
        outside += abs(off - float(worn(np.asarray([2.0 * land]), land)[0])) > spread
    assert outside <= 2


@pytest.mark.parametrize("shape", [None, "parabola", "circle", "power"])
def test_noise_alone_is_no_profile(shape: Any) -> None:
    for seed in range(3):
        with pytest.raises(ScanError, match="shows no curvature beyond the noise"):
            take(WIDE, white(seed, WIDE), centre=None, shape=shape)


def test_an_apex_outside_of_the_points_stays_where_it_was_given() -> None:
    x = np.arange(5.0, 60.0)
    for side in (1.0, -1.0):
        taken = take((side * x)[:: int(side)], (x**2)[:: int(side)] / 20.0, shape="parabola")
        assert taken.parameters == pytest.approx([0.1])
        assert taken.folded()[1] == pytest.approx(taken.folded()[0] ** 2 / 20.0, abs=1e-9)
    with pytest.raises(ScanError, match="has no points within 5 LU of its apex"):
        take(0.1 * x + 4.5, x**2)


def test_a_smooth_curve_has_the_land_and_the_flank() -> None:
    """The apex off the middle, between two points, and a tilt that the land shows."""
    z = 40.0 + worn(WIDE - 13.37) + math.tan(math.radians(0.1)) * WIDE + white(5, WIDE)
    taken = take(WIDE, z, centre=None, level=True)
    r = np.linspace(0.0, 580.0, 300)
    far = np.abs(r - LAND) > 5.0
    assert np.abs(curve(taken, r) - worn(r))[far].max() < 2.0 * NOISE
    assert abs(taken.centre[0] - 13.37) <= taken.centre[1]
    assert math.degrees(math.atan(taken.tilt[0])) == pytest.approx(0.1, rel=0.01)
    assert np.all(np.diff(taken.parameters) >= 0.0)


def test_every_deviation_is_a_profile_that_rises_and_as_large_as_the_noise() -> None:
    taken = take(SIDE, worn(SIDE) + white(3, SIDE))
    assert taken.deviations.shape[1:] == (2, taken.parameters.size)
    assert np.all(np.diff(np.insert(taken.deviations, 0, 0.0, axis=2), axis=2) >= 0.0)
    scans = (worn(WIDE, 0.0) + white(2, WIDE, size) for size in (1e-3, 4e-3))
    small, large = (np.ptp(take(WIDE, z, centre=None, shape="parabola").deviations[1]) for z in scans)
    assert large / small == pytest.approx(4.0, rel=1e-6)


def test_a_body_whose_slope_falls_is_followed_where_the_scan_shows_it() -> None:
    z = 0.05 * WIDE**2 / (200.0**2 + WIDE**2) * 20.0 + white(1, WIDE, 1e-4)
    taken = take(WIDE, z, centre=None)
    assert np.diff(taken.parameters).min() < 0.0
    assert taken.noise == pytest.approx(1e-4, rel=0.2)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_two_sides_are_folded_up_to_the_nearer_end(side: float) -> None:
    x = np.arange(-200.0, 301.0, 10.0)[:: int(side)] * side
    r, z = take(x, x**2 / 2000.0, centre=0.0, shape="parabola").folded()
    assert (r[0], r[-1]) == (0.0, 200.0)
    assert z == pytest.approx(r**2 / 2000.0)


def test_patches_are_counted_where_the_measured_points_are_lowest() -> None:
    """Two rings of asperities about one on the axis: five parts."""
    x = WIDE[::4]
    z = x**2 / (2.0 * R) + white(4, x, 1e-6)
    for place in (-60.0, -32.0, 0.0, 32.0, 60.0):
        z[np.abs(x - place) < 5.0] -= place**2 / (2.0 * R) + 0.5
    assert take(x, z, centre=0.0, shape="parabola").patches == 5


@pytest.mark.parametrize(
    ("x", "z", "how", "words"),
    [
        (WIDE, -worn(WIDE), {}, "change the sign of z"),
        (WIDE, 0.0 * WIDE, {}, "is flat"),
        (WIDE[:7], worn(WIDE[:7]), {}, "has 7 points in one direction, at least 8 are needed"),
        (SIDE, worn(SIDE), {"centre": None}, "needs points on both sides"),
        (WIDE, worn(WIDE, 0.0), {"centre": None, "level": True}, "a tilt of a parabola only moves the apex"),
    ],
)
def test_what_is_no_scan_is_refused(x: Array, z: Array, how: dict[str, Any], words: str) -> None:
    with pytest.raises(ScanError, match=words):
        take(x, z, **how)


# What the reading is made of.

SAME = 1e-6
"""Relative: of fits whose steps end at 1e-10, of points that are the same but for round-off."""


def tilted(x: Array, apex: float = 13.37) -> Array:
    return 40.0 + worn(x - apex) + 2e-3 * x + white(5, x)


@pytest.mark.parametrize("how", [{"level": True, "shape": "circle"}, {"shape": "power"}])
def test_a_scan_in_another_unit_and_from_another_origin_is_the_same_body(how: dict[str, Any]) -> None:
    size, right, up = 1e-3, -70.0, 5.0
    own = take(WIDE, tilted(WIDE), None, **how)
    other = take(size * WIDE + right, size * tilted(WIDE) + up, None, **how)
    for name in ("reach", "noise", "correlation", "missed", "pitch"):
        assert getattr(other, name) == pytest.approx(size * getattr(own, name), rel=SAME)
    assert other.centre[0] - right == pytest.approx(size * own.centre[0], rel=SAME)
    assert other.offset[0] - up == pytest.approx(size * own.offset[0], rel=SAME)
    for name in ("centre", "offset"):
        assert getattr(other, name)[1] == pytest.approx(size * getattr(own, name)[1], rel=1e-3)
    assert other.tilt == pytest.approx(own.tilt, rel=1e-3)
    powers = [1.0, 0.0] if own.shape == "power" else [-1.0]
    assert other.parameters == pytest.approx(own.parameters * size ** np.array(powers), rel=1e-4, abs=1e-9)


def test_correlations_count_up_to_the_first_that_is_chance() -> None:
    """σ² 0.8ᵏ of 400 points: 0.8¹⁰ = 0.107 counts and 0.8¹¹ = 0.086 does not, since 2/√400 = 0.1."""
    noise = noise_by(9.0 * 0.8 ** np.arange(40.0), 400)
    assert noise.deviation == pytest.approx(3.0)
    assert noise.together == pytest.approx(1.0 + 2.0 * sum(0.8**k for k in range(1, 11)) / 0.9)
    assert noise.power == pytest.approx(9.0 * noise.together)
    n = 400.0 / noise.together
    assert noise.price(400, 7) == pytest.approx(noise.power * (math.log(n) + 2.0 * math.log(7.0)))


def test_a_sample_to_both_sides_is_its_own_deviation() -> None:
    """Of two directions the one that moves heights more comes first; what moves none is left out."""
    along, across = np.array([2.0, 1.0, 0.0]), np.array([-0.1, 0.2, 0.0])
    sample = np.array([along + across, along - across, -along + across, -along - across])
    pairs = independent(sample, np.eye(3))
    assert pairs.shape == (2, 2, 3)
    for pair, one in zip(pairs, (along, across), strict=True):
        assert np.abs(0.5 * (pair[0] - pair[1])) == pytest.approx(np.abs(one), abs=1e-12)
    assert len(independent(sample, np.array([[1.0, 2.0, 0.0]]) - np.array([[0.0, 0.0, 1.0]]))) == 1


def test_forth_and_back_are_one_scan_on_the_positions_of_the_first() -> None:
    """What is shorter than half of a pass is none; of points at one position the mean counts."""
    forth, back = np.arange(0.0, 11.0), np.arange(9.75, 0.5, -0.5)
    x, z = one_pass(np.append(forth, back), np.append(3.0 * forth, 3.0 * back + 1.0))
    assert x == pytest.approx(np.arange(1.0, 11.0))
    assert z == pytest.approx(3.0 * x + 0.5 * (x < 10.0))  # both passes have the point where it turns
    x, z = one_pass(np.append(forth[::-1], [0.5, 1.0]), np.append(forth[::-1] ** 2, [7.0, 7.0]))
    assert (x, z) == (pytest.approx(forth), pytest.approx(forth**2))
