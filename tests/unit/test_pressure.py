"""Pressure and what is read off it, against sums, the paper's own number, and brute force over all pairs."""

import math

import numpy as np
import pytest

from contact1d.analysis.pressure import (
    Profile,
    end_pressure_share,
    left_out,
    mean_pressure,
    penetration_depth,
    pressure_profile,
    smallest_distance,
)
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.potentials.table import table_for
from tests.profiles import profile

ROUND_OFF = 1e-14
"""Relative: a few operations on doubles."""


def test_a_profile_is_sorted_and_per_spacing_and_keeps_signs() -> None:
    x, z_upper, z_lower = [2.0, 0.0, 1.0], [5.0, 3.0, 4.0], [-0.2, -0.0, -0.1]
    made = pressure_profile(x, z_upper, z_lower, [0.3, 0.1, 0.2], [6.0, -2.0, 4.0], 0.5)
    np.testing.assert_array_equal(made.x, [0.0, 1.0, 2.0])
    np.testing.assert_array_equal(made.z_upper, [3.0, 4.0, 5.0])
    np.testing.assert_array_equal(made.z_lower, [0.0, -0.1, -0.2])
    np.testing.assert_array_equal(made.pressure, [-4.0, 8.0, 12.0])
    np.testing.assert_array_equal(made.shear, [0.2, 0.4, 0.6])


def test_what_is_not_a_profile_is_refused() -> None:
    zeros = [0.0, 0.0]
    for last, spacing, words in (
        ([0.0, math.nan], 1.0, "finite"),
        ([0.0], 1.0, "equally long"),
        (zeros, 0.0, "spacing"),
    ):
        with pytest.raises(ValueError, match=words):
            pressure_profile([0.0, 1.0], zeros, zeros, zeros, last, spacing)
    with pytest.raises(ValueError, match="sorted"):
        profile(np.array([1.0, 0.0]), np.zeros(2))
    with pytest.raises(ValueError, match="above 0"):
        mean_pressure(profile(np.arange(3.0), np.ones(3)), 1.0, 0.0)


@pytest.mark.parametrize("seed", range(16))
def test_the_smallest_distance_is_that_of_all_pairs_of_chains_in_any_place(seed: int) -> None:
    """Beside, above and through each other, with places taken twice: what a search along the chain could miss."""
    rng = np.random.default_rng(seed)
    count, other = rng.integers(1, 40, 2)
    spacing = rng.choice([0.1, 1.0, 10.0])
    x_upper = rng.permutation(spacing * np.arange(count) + rng.choice([0.0, 0.3]) * rng.normal(size=count))
    x_lower = np.round(spacing * rng.uniform(0.0, other, other), 1) - rng.choice([0.0, 3.0, 100.0])
    z_upper, z_lower = rng.uniform(-4.0, 4.0) + rng.normal(size=count), 0.1 * rng.normal(size=other)
    every = np.hypot(x_upper[:, None] - x_lower, z_upper[:, None] - z_lower)
    assert smallest_distance(x_upper, z_upper, x_lower, z_lower) == pytest.approx(every.min(), rel=ROUND_OFF)


def test_the_depth_is_exact_over_a_tilted_plane_in_any_order() -> None:
    rng = np.random.default_rng(2)
    x_low = rng.permutation(np.linspace(-5.0, 5.0, 11))
    x, z = rng.uniform(-5.0, 5.0, 30), rng.normal(size=30)
    depth = penetration_depth(x, z - 3.0, x_low, 0.3 * x_low - 1.0)
    assert depth == pytest.approx(float(np.max(0.3 * x - 1.0 - (z - 3.0))), rel=ROUND_OFF)


def test_a_mean_pressure_is_the_whole_force_over_the_area_of_the_contact() -> None:
    made = profile(np.arange(4.0), np.array([-1.0, 4.0, 4.0, -1.0]))
    assert mean_pressure(made, 0.5, 2.0) == pytest.approx(3.0 / (4.0 * math.pi), rel=ROUND_OFF)


def test_the_share_at_the_ends_counts_tension_and_compression() -> None:
    x = np.arange(4.0)
    assert end_pressure_share(profile(x, np.array([0.1, -4.0, 2.0, -0.2]))) == pytest.approx(0.05, rel=ROUND_OFF)
    assert end_pressure_share(profile(x, np.zeros(4))) == 0.0


def test_what_a_table_leaves_out_is_summed_over_all_pairs() -> None:
    """Beyond the cutoff up to five ranges all of the force, below it the table's error; each along z."""
    law, cutoff = DoubleExponential(Exponential(0.18, 0.13), Exponential(0.09, 0.26)), 1.1
    table, x = table_for(law, cutoff, 0.2, 1e-3), 0.4 * np.arange(15)
    state = Profile(x, 0.01 * np.sin(x), 0.3 + 0.02 * (x - 2.0) ** 2, np.ones(15), np.zeros(15))
    total = 0.0
    for i in range(15):
        for j in range(15):
            up = state.z_upper[i] - state.z_lower[j]
            r = math.hypot(x[i] - x[j], up)
            if r < cutoff + 5.0 * 0.26:
                kept = float(table.force(np.asarray([r]))[0]) if r <= cutoff else 0.0
                total += abs(kept - float(law.force(r))) * up / r
    assert left_out(law, table, state) == pytest.approx(total, rel=1e-9, abs=0.0)
