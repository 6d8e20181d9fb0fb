"""Claims about the place of a minimum between samples, by itself: what ties and few samples leave open."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.extremum import place_of_minimum
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import compressive_radius

SPACING, FAR = 0.25, 400.0
"""Of the samples, and where they begin: a place is not a distance."""


def sampled(values: list[float] | np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    y = np.asarray(values, dtype=np.float64)
    return FAR + SPACING * np.arange(y.size), y, np.arange(y.size)


def test_two_samples_that_tie_leave_no_doubt_of_their_own() -> None:
    t = np.arange(24.0) - 11.5
    place = place_of_minimum(*sampled(-1.0 / np.cosh(0.2 * t)))
    assert place.position == pytest.approx(FAR + SPACING * 11.5, abs=1e-9)
    assert place.uncertainty < 1e-3 * SPACING


def test_three_samples_that_tie_leave_a_quarter_of_their_extent() -> None:
    y = np.full(31, 0.0)
    y[14:17] = -1.0
    place = place_of_minimum(*sampled(y))
    assert FAR + 14 * SPACING <= place.position <= FAR + 16 * SPACING
    assert 0.25 * 2 * SPACING <= place.uncertainty <= 4 * SPACING


def test_a_tie_at_the_edge_of_where_one_looks_leaves_all_of_its_extent() -> None:
    y = np.full(31, 0.0)
    y[10:17] = -1.0
    x, y, every = sampled(y)
    place = place_of_minimum(x, y, every[14:20])
    assert place.uncertainty >= 2 * SPACING


def test_five_samples_on_each_side_are_enough_to_converge() -> None:
    """With four the polynomials through seven samples decide, which know less."""
    t = np.arange(-5.0, 6.0) + 0.3
    wide = place_of_minimum(*sampled(np.cosh(0.3 * t)))
    narrow = place_of_minimum(*sampled(np.cosh(0.3 * t[1:-1])))
    assert abs(wide.position - (FAR + SPACING * 4.7)) <= wide.uncertainty
    assert abs(narrow.position - (FAR + SPACING * 3.7)) <= narrow.uncertainty
    assert wide.uncertainty != pytest.approx(narrow.uncertainty, rel=0.1)


@pytest.mark.parametrize("spacing", [0.2, 1.0, 7.0])
def test_the_edge_of_a_parabolic_pressure_is_exact_at_any_spacing(spacing: float) -> None:
    x = spacing * (np.arange(-20.0, 21.0) + 0.2)
    half = 12.37 * spacing
    pressure = np.maximum(0.0, 1.0 - (x / half) ** 2)
    zero = np.zeros_like(x)
    found = compressive_radius(Profile(x, zero, zero, pressure, zero))
    assert found.value == pytest.approx(half, rel=1e-9)
