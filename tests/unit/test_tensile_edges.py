"""Which of the lowest pressures about a contact's centre are its two edges, and where one that was drawn along is."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.extremum import Place, place_of_minimum
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import moved_centre, tensile_radius

ROUND_OFF = 1e-12
SPREAD = 15


def profile(x: np.ndarray, pressure: np.ndarray) -> Profile:
    zero = np.zeros_like(x)
    return Profile(x, zero, zero, pressure, zero)


def edge(x: np.ndarray, p: np.ndarray, spacing: float, side: int) -> Place:
    """From half a spacing beyond the centre on; one on the other side that ties with one of this side is not it."""
    centre = sum(abs(p) * x) / sum(abs(p))
    away = [side * (place - centre) / spacing for place in x]
    reach = [i for i in range(x.size) if away[i] >= -0.5]
    own = [i for i in range(x.size) if away[i] >= 0.0]
    found = place_of_minimum(x, p, np.array(reach))
    beyond = side * (found.position - centre) / spacing < -0.25
    if beyond and own and min(p[own]) - min(p[reach]) <= 1e-5 * max(abs(p)):
        return place_of_minimum(x, p, np.array(own))
    return found


@pytest.mark.parametrize("spacing", [2.0**-40, 1.0, 2.0**40])
@pytest.mark.parametrize("origin", [0.0, 64.0])
def test_both_edges_are_looked_for_from_just_beyond_the_centre_in_any_unit(spacing: float, origin: float) -> None:
    """Contacts of up to two spacings, one side lower than the other by nothing, round-off, or much; jumps; noise."""
    random = np.random.default_rng(3)
    spots = 0
    for number in range(150):
        t = np.arange(-SPREAD, SPREAD + 1.0) + random.choice([0.0, 0.5, random.uniform(-0.5, 0.5)])
        half = random.uniform(0.0, 2.2)
        tilt = random.choice([0.0, 1e-7, 1e-6, 2e-5, 1e-3, 1e-2]) * random.choice([-1, 1])
        p = -np.exp(-(((t**2 - half**2) / 6.0) ** 2) - 0.02 * t**2) * (1.0 + tilt * t)
        if number % 3 == 0:
            p = np.where(np.abs(t) > half + 0.7, 0.3 * p, p)
        elif number % 3 == 1:
            p = p + random.choice([1e-6, 1e-4]) * random.normal(size=t.size)
        found = tensile_radius(profile(spacing * (t + origin), 1.5 * p * spacing))
        left, right = (edge(t, p, 1.0, side) for side in (-1, 1))
        near = 1e-9 * (1.0 + origin)
        assert (found.left / spacing - origin, found.right / spacing - origin) == pytest.approx(
            (left.position, right.position), abs=near
        )
        half = max(0.0, 0.5 * (right.position - left.position))
        assert found.value / spacing == pytest.approx(half, abs=near)
        assert (found.value == 0.0) == (half < 1e-9)
        spots += half < 1e-9
        doubt = max(0.5 * (left.uncertainty + right.uncertainty), 1.2 * (1.0 - half / 3.0))
        assert found.uncertainty / spacing == pytest.approx(doubt, rel=1e-6)
    assert spots > 10


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
