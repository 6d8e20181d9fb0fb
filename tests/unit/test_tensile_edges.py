"""Which of the lowest pressures about a contact's centre are its two edges, and where one that was drawn along is."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import moved_centre, tensile_radius

ROUND_OFF = 1e-12


def profile(x: np.ndarray, pressure: np.ndarray) -> Profile:
    zero = np.zeros_like(x)
    return Profile(x, zero, zero, pressure, zero)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_contact_at_one_end_of_its_chain_says_so(side: float) -> None:
    x = np.arange(-20.0, 21.0)
    t = (x - side * 14.0) / 5.0
    found = tensile_radius(profile(x, (0.5 - t**2) * np.exp(-(t**2))))  # least at t² = 3/2, on one side beyond the end
    assert found.reaches_end
    assert found.value == pytest.approx(0.5 * (6.0 + 5.0 * np.sqrt(1.5)), abs=0.01)


@pytest.mark.parametrize("scale", [2.0**-20, 1.0, 2.0**20])
def test_a_contact_drawn_along_by_more_than_a_spacing_has_its_centre_where_its_pressure_is(scale: float) -> None:
    x = scale * np.arange(-10.0, 11.0)
    for to, moved in ((0, 0.0), (1, 0.0), (2, 2.0), (-1, 0.0), (-2, -2.0), (5, 5.0)):
        p = np.zeros(21)
        p[9 + to : 12 + to] = 1.0, -4.0, 1.0
        assert moved_centre(profile(x, p)) == pytest.approx(moved * scale, rel=ROUND_OFF)
    assert moved_centre(profile(x, np.zeros(21))) == 0.0
    assert moved_centre(profile(x[:1], np.ones(1))) == 0.0
    assert moved_centre(profile(scale * np.array([3.0, 4.0]), np.ones(2))) == 3.5 * scale
    assert moved_centre(profile(scale * np.array([3.0, 4.0, 5.0]), np.ones(3))) == 4.0 * scale
