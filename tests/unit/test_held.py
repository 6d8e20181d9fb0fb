"""The radius of a contact that is held up to an edge: exact for a parabola, wherever the edge lies in its cell."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import held_radius, whole_cells

ROUND_OFF = 1e-9
X = np.arange(60.0) - 29.5


def row(edge: float, d: float = 1.0) -> Profile:
    """p = d − x²/200 up to the edge, that of the last cells by the middle of their share."""
    share = np.clip(edge - np.abs(X) + 0.5, 0.0, 1.0)
    middle = np.abs(X) - 0.5 * (1.0 - share)
    zero = np.zeros_like(X)
    return Profile(X, zero, zero, share * (d - middle**2 / 200.0), zero)


def test_nothing_held_has_no_radius() -> None:
    found = held_radius(row(-1.0))
    assert (found.value, found.uncertainty, found.reaches_end) == (0.0, 0.5, False)


def test_a_contact_of_few_particles_is_known_to_half_a_spacing() -> None:
    found = held_radius(row(1.6, -0.3))
    assert abs(found.value - 1.6) <= found.uncertainty == 0.5


def test_an_end_is_told() -> None:
    assert held_radius(row(40.0, -1.0)).reaches_end


@pytest.mark.parametrize("edge", [16.2, 16.8])
def test_pressures_at_the_edge_are_those_of_the_inside(edge: float) -> None:
    """Where the last particle stands outside of the edge, and inside with less than a whole cell."""
    profile = row(edge, -0.3)
    found = whole_cells(profile, held_radius(profile))
    inside = np.abs(X) < edge
    assert found[inside] == pytest.approx((-0.3 - X**2 / 200.0)[inside], abs=ROUND_OFF)
    assert (found[~inside] == 0.0).all()


def test_too_few_particles() -> None:
    two = np.zeros(2)
    with pytest.raises(ValueError, match="at least 3 particles"):
        held_radius(Profile(np.arange(2.0), two, two, two, two))


@pytest.mark.parametrize("spacing", [2.0**-12, 1.0, 2.0**12])
@pytest.mark.parametrize("origin", [0.0, 32.0])
def test_both_edges_of_a_parabola_are_found_wherever_each_lies(spacing: float, origin: float) -> None:
    """Contacts of nine spacings and more, at any place of a row, up to its ends; in any unit."""
    random, ends, n = np.random.default_rng(1), 0, 30
    t = np.arange(float(n))
    zero = np.zeros(n)
    for _ in range(60):
        left = random.choice([-0.5, random.uniform(-0.4, 12.0)])
        right = random.choice([n - 0.5, random.uniform(left + 9.0, n - 0.6)])
        low, high = np.maximum(t - 0.5, left), np.minimum(t + 0.5, right)
        share = np.maximum(high - low, 0.0)
        inside = np.polynomial.Polynomial([2.0, random.uniform(-0.03, 0.03), random.uniform(-1e-3, 1e-3)])
        profile = Profile(spacing * (t + origin), zero, zero, share * inside(0.5 * (low + high)), zero)
        found = held_radius(profile)
        assert (found.left / spacing - origin, found.right / spacing - origin) == pytest.approx(
            (left, right), abs=ROUND_OFF
        )
        assert found.value / spacing == pytest.approx(0.5 * (right - left), abs=ROUND_OFF)
        assert found.reaches_end == (share[0] > 0.0 or share[-1] > 0.0)
        ends += (share[0] > 0.0) != (share[-1] > 0.0)
        whole = whole_cells(profile, found)
        within = (t > left + ROUND_OFF) & (t < right - ROUND_OFF)
        assert whole == pytest.approx(np.where(within, inside(t), 0.0), abs=1e-6)
    assert ends > 10
