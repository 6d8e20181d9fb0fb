"""A plate on which a tension acts at once: limits of no damping and of much."""

from __future__ import annotations

import math

import pytest

from validation.references.released_plate import SHARE, ReleasedPlate

# F(d) = d² (d + 3/2) − 1/2 … a cubic with F(0) = −1/2 its minimum, F → 0⁻ at its foot d = −1, F = 0 at d = 1/2
FOLD, FOOT = -0.5, -1.0


def force(d: float) -> float:
    return d**2 * (d + 1.5) - 0.5


def primitive(d: float) -> float:
    return d**4 / 4.0 + d**3 / 2.0 - d / 2.0


PLATE = ReleasedPlate(force, FOOT, 2.0)


def place(value: float) -> float:
    """d > 0 with F(d) = value, by bisection."""
    low, high = 0.0, 2.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if force(middle) < value else (low, middle)
    return low


@pytest.mark.parametrize("preload", [0.0, 0.1, 0.5])
def test_without_damping_the_energy_decides(preload: float) -> None:
    """At the largest tension ∫ (F + T) dd from the unstable place to d_D is 0."""
    tension = PLATE.largest_tension(preload, 0.0)
    low, high = FOOT, 0.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if force(middle) > -tension else (low, middle)
    start = place(preload)
    work = primitive(start) - primitive(low) + tension * (start - low)
    assert work == pytest.approx(0.0, abs=5.0 * SHARE)


def test_a_plate_that_creeps_holds_all_that_the_contact_holds() -> None:
    assert PLATE.largest_tension(0.5, 3.0) == pytest.approx(-FOLD, rel=SHARE)


def test_a_plate_that_swings_holds_less_the_harder_it_was_pressed() -> None:
    tensions = [PLATE.largest_tension(preload, 0.1) for preload in (0.0, 0.2, 0.6)]
    assert math.inf > tensions[0] > tensions[1] > tensions[2] > 0.0
