"""Claims about the place of a minimum between samples, by itself: what ties and few samples leave open."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.extremum import position_of_minimum
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import compressive_radius

SPACING, FAR = 0.25, 400.0
"""Of the samples, and where they begin: a place is not a distance."""


def sampled(values: list[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    y = np.asarray(values, dtype=np.float64)
    return FAR + SPACING * np.arange(y.size), y, np.arange(y.size)


def test_two_samples_that_tie_leave_no_doubt_of_their_own() -> None:
    t = np.arange(24.0) - 11.5
    place = position_of_minimum(*sampled(-1.0 / np.cosh(0.2 * t)))
    assert place.position == pytest.approx(FAR + SPACING * 11.5, abs=1e-9)
    assert place.uncertainty < 1e-3 * SPACING


def test_three_samples_that_tie_leave_a_quarter_of_their_extent() -> None:
    y = np.full(31, 0.0)
    y[14:17] = -1.0
    place = position_of_minimum(*sampled(y))
    assert FAR + 14 * SPACING <= place.position <= FAR + 16 * SPACING
    assert 0.25 * 2 * SPACING <= place.uncertainty <= 4 * SPACING


def test_a_side_on_which_nothing_pulls_has_its_minimum_anywhere() -> None:
    """A body pressed on so hard that one side alone has a particle under tension."""
    x, y, _ = sampled([0.0] * 20 + [-2e-4] + [1.0] * 40 + [0.0] * 20)
    place = position_of_minimum(x, y, np.arange(40, 81))
    assert abs(place.position - x[71]) <= 2.0 * SPACING
    assert place.uncertainty >= 9.5 * SPACING


def test_five_samples_on_each_side_are_enough_to_converge() -> None:
    """With four the polynomials through seven samples decide, which know less."""
    t = np.arange(-5.0, 6.0) + 0.3
    wide = position_of_minimum(*sampled(np.cosh(0.3 * t)))
    narrow = position_of_minimum(*sampled(np.cosh(0.3 * t[1:-1])))
    assert abs(wide.position - (FAR + SPACING * 4.7)) <= wide.uncertainty
    assert abs(narrow.position - (FAR + SPACING * 3.7)) <= narrow.uncertainty
    assert wide.uncertainty < 1e-3 * narrow.uncertainty


@pytest.mark.parametrize(("width", "known"), [(0.7, 1.0), (1.4, 0.8), (2.8, 0.1), (5.6, 1e-3)])
def test_a_dip_is_known_the_better_the_more_samples_it_has(width: float, known: float) -> None:
    """One narrower than a sample is anywhere between those beside the lowest, one of ten samples is where it is."""
    place = position_of_minimum(*sampled(-1.0 / np.cosh((np.arange(60.0) - 30.3) / width)))
    assert abs(place.position - (FAR + SPACING * 30.3)) <= place.uncertainty <= known * SPACING


def test_a_flat_dip_in_noise_is_found_within_its_claim_and_better_than_its_lowest_sample() -> None:
    """Noise of 1 % of the depth hides which of some fifteen samples is lowest."""
    random = np.random.default_rng(13)
    t, middle = np.arange(61.0), 30.3
    law = 1e-4 * ((t - middle) ** 2 + 0.01 * np.abs(t - middle) ** 3)
    errors, claims, lowest = [], [], []
    for _ in range(200):
        y = law + 1e-3 * random.normal(size=t.size)
        found = position_of_minimum(t, y, np.arange(t.size))
        errors.append(found.position - middle)
        claims.append(found.uncertainty)
        lowest.append(t[y.argmin()] - middle)
    assert np.mean(np.abs(errors) <= claims) >= 0.95
    assert np.sqrt(np.mean(np.square(errors))) < 0.5 * np.sqrt(np.mean(np.square(lowest)))
    assert np.median(claims) < 6.0 * np.sqrt(np.mean(np.square(errors)))


@pytest.mark.parametrize("beside", [(0.95, 0.1), (0.1, 0.95)])
def test_a_dip_of_one_sample_may_lie_anywhere_up_to_both_of_its_neighbours(beside: tuple[float, float]) -> None:
    y = np.full(21, 1.0)
    y[9:12] = beside[0], 0.0, beside[1]
    x, y, every = sampled(y)
    place = position_of_minimum(x, y, every)
    assert place.position + place.uncertainty >= x[11] - 1e-9
    assert place.position - place.uncertainty <= x[9] + 1e-9
    assert place.uncertainty <= 2.0 * SPACING


def test_the_edge_of_a_parabolic_pressure_is_exact_between_uneven_places() -> None:
    random = np.random.default_rng(15)
    for _ in range(50):
        x = np.cumsum(random.uniform(0.4, 1.6, size=40)) - 20.0
        middle = 0.5 * (x[0] + x[-1])
        half = 0.6 * (x[-1] - middle)
        pressure = np.maximum(0.0, 1.0 - ((x - middle) / half) ** 2)
        zero = np.zeros_like(x)
        assert compressive_radius(Profile(x, zero, zero, pressure, zero)).value == pytest.approx(half, rel=1e-9)
