"""Stick, slip and their work: closed forms of a parabola, small steps, and the balance of energy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from contact1d.analysis.pressure import Profile
from contact1d.analysis.shear import slip, stick_margin, stick_radius
from contact1d.workflow.laws.path import legs

ROUND_OFF = 1e-12
"""Relative; sums of a few products."""
MU = 0.3


def pressed(force: float, half: float = 10.0) -> Profile:
    """p = 1 − (x/a)² with a shear that resists a move to the right: min(force, μp)."""
    x = np.arange(-14.5, 15.0)
    pressure = np.maximum(1.0 - (x / half) ** 2, 0.0)
    shear = -np.clip(force, -MU * pressure, MU * pressure)
    return Profile(x, 0.0 * x, 0.0 * x, pressure, shear)


@pytest.mark.parametrize("share", [0.05, 0.9])
def test_the_stick_radius_of_a_parabola_is_exact(share: float) -> None:
    found = stick_radius(pressed(share * MU), MU, 1)
    assert found.value == pytest.approx(10.0 * np.sqrt(1.0 - share), rel=1e-9)
    assert found.uncertainty < 1e-6


def test_what_slips_one_way_sticks_right_after_a_reversal() -> None:
    profile = pressed(0.5 * MU)
    assert stick_radius(profile, MU, 1).value == pytest.approx(10.0 * np.sqrt(0.5))
    assert stick_radius(profile, MU, -1).value == pytest.approx(10.0)
    assert (stick_margin(profile, MU, -1) > 0.0).sum() == (profile.pressure > 0.0).sum()


def test_where_all_slips_or_nothing_is_touched_the_stick_radius_is_0_for_sure() -> None:
    for profile in (pressed(2.0 * MU), pressed(0.0, half=1e-3)):
        found = stick_radius(profile, MU, 1)
        assert (found.value, found.uncertainty) == (0.0, 0.0)


def test_before_any_move_what_is_left_counts_on_both_sides() -> None:
    for share in (0.5, -0.5):
        assert stick_radius(pressed(share * MU), MU, 0).value == pytest.approx(10.0 * np.sqrt(0.5))


limits = st.floats(0.0, 2.0)


@given(share=st.floats(-1.0, 1.0), limit=limits, after=limits, pushed=st.floats(-5.0, 5.0), k=st.floats(0.1, 10.0))
def test_work_is_what_is_put_in_less_what_the_spring_holds(
    share: float, limit: float, after: float, pushed: float, k: float
) -> None:
    """Against 4000 small steps of the same straight way."""
    one = np.array([share * limit])
    row = slip(one, np.array([pushed]), np.array([limit]), np.array([after]), k)
    steps = 4000
    force, work = float(one[0]), 0.0
    for i in range(1, steps + 1):
        bound = limit + (after - limit) * i / steps
        new = min(max(force + pushed / steps, -bound), bound)
        work += 0.5 * (force + new) * pushed / (k * steps)
        force = new
    dissipated = work - (force**2 - float(one[0]) ** 2) / (2.0 * k)
    size = (2.0 + abs(pushed)) ** 2 / k
    assert row.force[0] == pytest.approx(force, abs=ROUND_OFF * steps)
    assert row.work[0] == pytest.approx(dissipated, abs=size / steps)
    assert row.work[0] >= 0.0
    assert abs(row.force[0]) <= after


def test_a_path_that_rests_where_it_turns_has_two_legs() -> None:
    assert legs(np.asarray([0.0, 1.0, 1.0, 2.0, 2.0, 0.5])) == [slice(0, 5), slice(5, 6)]
