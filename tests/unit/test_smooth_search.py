"""The search for F = 0 and the largest tension of a smooth curve, over formulas: its rows, its marks and its claim.

A parabola is what its polynomials say, so that every row of a search over it can be counted out.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve_marks import largest_tension, promised, rivals
from contact1d.workflow.experiments.pull_off.smooth import (
    _halved,
    _look_at_rivals,
    _pulled,
    _searched,
    _to_largest_tension,
    _to_zero,
    smooth_pass,
)
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.trust import UntrustedError
from tests.given import PROFILE, Estimate, GivenContact, at, given_context

STEP = {"smooth_step": 0.1, "longest_move": 0.0, "cutoff": 9.0, "tolerance": 1e-3, "force_scale": 0.5}
"""Increments of a tenth everywhere."""
GONE = Estimate(force=np.zeros(4))
"""Particles that hold nothing more."""


def contact(force: Any, **more: Any) -> Any:
    return GivenContact(force, **{"closest": lambda d: 1.0, "estimate": GONE, "scene": None} | STEP | more)


def places(states: list[State]) -> list[float]:
    return [state.displacement for state in states]


def parabola(d: float) -> float:
    """F = (d + 0.33)² − 1: 0 at 0.67, and largest tension, 1, at −0.33."""
    return (d + 0.33) ** 2 - 1.0


@pytest.mark.parametrize(
    ("before", "rows"),
    [
        ([], [0.9, 0.8, 0.7, 0.6, 0.67]),
        ([0.65], [0.9, 0.8, 0.7, 0.67]),
        ([0.6, 0.64], [0.9, 0.8, 0.7, 0.67]),
    ],
)
def test_no_load_is_found_in_increments_or_at_once_where_the_way_down_has_passed_it(
    before: list[float], rows: list[float]
) -> None:
    one = contact(parabola)
    loading = [at(d, parabola(d)) for d in (*before, 1.0)]
    found = _to_zero(one, loading, 1e-2)
    assert places(found) == one.places
    if len(before) == 1:  # three rows: a line first
        assert places(found)[:3] == pytest.approx(rows[:3])
        assert abs(found[-1].force) <= 1e-2
    else:
        assert places(found)[:-1] == pytest.approx(rows[:-1])
        assert places(found)[-1] == pytest.approx(0.67, abs=5e-3)


def test_no_load_counts_from_the_tolerance_of_the_largest_tension_on() -> None:
    """Under next to no load the mark is where the loading has ended, once more; the estimate's tension is 2 FU."""
    for force, rows in ((0.0199, [0.5]), (-0.0199, [0.5]), (0.0201, None), (-0.0201, None)):
        one = contact(lambda d, force=force: force + 3.0 * (d - 0.5), estimate=Estimate(largest=2.0))
        loading = [at(0.9, force + 1.2), at(0.4, force - 0.3), at(0.5, force)]
        found = _to_zero(one, loading, 1e-2)
        if rows:
            assert places(found) == rows
        else:
            assert len(found) == 1 + (force < 0.0)
            assert places(found)[-1] == pytest.approx(0.5 - force / 3.0)
    exactly = contact(lambda d: 0.03125 + d, estimate=Estimate(largest=2.0))
    assert places(_to_zero(exactly, [at(0.0, 0.03125)], 0.015625)) == [0.0]


def test_a_force_that_jumps_over_zero_or_never_comes_to_it_is_told() -> None:
    jump = contact(lambda d: 0.5 if d > 0.55 else -0.5)
    with pytest.raises(UntrustedError, match="F = 0 is not found near"):
        _to_zero(jump, [at(1.0, 0.5)], 1e-3)
    assert len(jump.places) == 5 + 12
    pressed = contact(lambda d: 1.0)
    with pytest.raises(UntrustedError, match="nothing holds the bodies together"):
        _to_zero(pressed, [at(1.0, 0.5)], 1e-3)
    assert len(pressed.places) == 2_000


@pytest.mark.parametrize("zero", [0.67, 0.3])
def test_rows_go_three_beyond_the_largest_tension_or_until_no_more_can_be_held(zero: float) -> None:
    one = contact(parabola)
    states = _pulled(one, at(zero, parabola(zero)), 0.1, through=False)
    count = round((zero + 0.33) / 0.1 + 3.0)
    assert places(states) == pytest.approx([zero - 0.1 * (n + 1) for n in range(count)])
    still = contact(parabola, profile=lambda d: pulling(0.9 if d < -1.0 else 1.1))
    through = _pulled(still, at(zero, parabola(zero)), 0.1, through=True)
    assert places(through)[-1] < -1.0 <= places(through)[-2]


def pulling(whole: float) -> Any:
    """Ten particles that hold so much together."""
    pressure = np.where(np.abs(PROFILE.x) < 5.0, -0.1 * whole, 0.0)
    return type(PROFILE)(PROFILE.x, PROFILE.z_lower, PROFILE.z_upper + 9.0, pressure, PROFILE.shear)


def test_a_tension_that_is_never_passed_is_told_after_two_thousand_rows() -> None:
    rising = contact(lambda d: d)
    with pytest.raises(UntrustedError, match="never passed"):
        _pulled(rising, at(0.0, 0.0), 0.1, through=False)
    assert len(rising.places) == 2_001


def test_a_parabola_is_met_at_once_and_looked_at_beside_its_top() -> None:
    """The row at its vertex, one on each side at half of the increment, and the vertex again."""
    one = contact(parabola)
    states, missed = _to_largest_tension(one, [at(0.67, 0.0)], 1e-3, through=False)
    count = 13
    ways = [0.67 - 0.1 * (n + 1) for n in range(count)]
    assert places(states) == pytest.approx([*ways, -0.33, -0.28, -0.38, -0.33])
    assert missed == pytest.approx(0.0, abs=1e-9)


def test_the_way_back_to_a_top_is_in_halves_of_the_smallest_distance() -> None:
    """0.065 LU at a time from the last row, −0.63, to the vertex; what lies beside it is near enough."""
    one = contact(parabola, closest=lambda d: 0.13)
    states, _ = _to_largest_tension(one, [at(0.67, 0.0)], 1e-3, through=False)
    back = [-0.565, -0.5, -0.435, -0.37, -0.33, -0.28, -0.38, -0.33]
    assert places(states)[13:] == pytest.approx(back)


def sharp(d: float) -> float:
    """T = 1/cosh(4(d + 0.33)): as wide as two rows."""
    return -1.0 / math.cosh(4.0 * (d + 0.33))


@pytest.mark.parametrize(("slope", "tolerance"), [(0.0, 1e-2), (0.0, 1e-4), (3.0, 1e-2), (3.0, 1e-4)])
def test_a_sharp_top_is_halved_until_polynomials_keep_what_they_promise(slope: float, tolerance: float) -> None:
    """Height and place, where the radius changes, are known to the tolerance; more than three halvings never for it."""
    one = contact(sharp, radius=lambda d: 5.0 + slope * d)
    states, missed = _to_largest_tension(one, [at(0.67, sharp(0.67))], tolerance, through=False)
    peak = largest_tension(*falling([at(0.67, sharp(0.67)), *states]))
    error = abs(peak.smooth - 1.0)
    assert error <= missed <= tolerance
    assert abs(states[-1].displacement + 0.33) * slope <= tolerance * 5.0
    beside = sorted({round(abs(d + 0.33), 3) for d in places(states)[13:] if abs(d + 0.33) > 0.004})
    assert len(beside) >= 1 + (tolerance < 1e-3)
    widths = [0.1 * 0.5**n for n in range(1, 1 + len(beside))]
    assert beside[::-1] == pytest.approx(widths, abs=2e-3)
    assert slope or tolerance < 1e-3 or len(beside) <= 3
    radius = 5.0 + slope * states[-1].displacement
    assert len(beside) > 2 or 2.0 * slope * peak.misplaced <= tolerance * radius


def falling(states: list[State]) -> tuple[list[float], list[float]]:
    known = {s.displacement: s.force for s in states}
    order = sorted(known, reverse=True)
    return order, [known[d] for d in order]


def test_a_top_that_jumps_is_told_after_sixty_looks() -> None:
    seen: list[float] = []

    def restless(d: float) -> float:
        seen.append(d)
        return parabola(d) - 0.03 * (len(seen) % 7)

    one = contact(restless)
    with pytest.raises(UntrustedError, match="the largest tension is not found near"):
        _to_largest_tension(one, [at(0.67, 0.0)], 1e-6, through=False)
    assert 60 <= len(one.places) <= 30 + 3 * 60


def test_rows_beside_a_top_are_held_against_what_was_promised_there() -> None:
    one = contact(sharp)
    unloaded = [at(0.67, sharp(0.67))]
    states = [at(0.6 - 0.1 * n, sharp(0.6 - 0.1 * n)) for n in range(14)]
    before = falling([*unloaded, *states])
    beside = (-0.25, -0.41)
    surprise = _halved(one, unloaded, states, beside)
    expected = promised(*before, beside)
    assert places(states)[-2:] == list(beside)
    assert surprise == pytest.approx(max(abs(t + sharp(d)) for t, d in zip(expected, beside, strict=True)))
    ends = [at(0.67, -5.0)], [at(0.6, -3.0)]
    assert _halved(contact(sharp), *ends, beside) == math.inf


TEETH = {1.0: 0.0, 0.9: -0.4, 0.8: -0.7, 0.7: -0.3, 0.6: -0.6, 0.5: -0.75, 0.4: -0.2, 0.3: -0.5, 0.2: -0.68, 0.1: 0.0}
"""Three teeth: 0.75 FU at 0.5, 0.7 at 0.8, 0.68 at 0.2."""


@pytest.mark.parametrize("allowed", [0.01, 0.16, 0.31])
def test_teeth_that_may_be_higher_are_looked_at_on_both_sides(allowed: float) -> None:
    """Their lines may rise by what they did before; what the rows between leave is returned."""
    d, f = list(TEETH), list(TEETH.values())

    def saw(place: float) -> float:
        return float(np.interp(place, d[::-1], f[::-1]))

    one = contact(saw, closest=lambda d: 8.0)
    unloaded = [at(1.0, 0.0)]
    states = [at(place, force, smallest_distance=8.0) for place, force in list(TEETH.items())[1:]]
    left = _look_at_rivals(one, unloaded, states, allowed)
    rows = falling([*unloaded, *states])
    teeth = rivals(*rows, largest_tension(*rows))
    assert left == pytest.approx(max(0.0, *teeth.values()))
    assert left <= allowed
    looked = one.places
    first = rivals(*falling([at(p, v) for p, v in TEETH.items()]), largest_tension(d, f))
    if max(first.values()) <= allowed:
        assert looked == []
        return
    highest = max(first, key=lambda i: first[i])
    assert looked[:2] == pytest.approx([0.5 * (d[highest] + d[highest - 1]), 0.5 * (d[highest] + d[highest + 1])])


def hills(d: float) -> float:
    """T = exp(−(4d)²) and a second hill of 1.3 FU at −2; F = 0 at 0.5, and 3 (d − 0.5) above."""
    if d > 0.5:
        return 3.0 * (d - 0.5)
    return 0.02 * (d - 0.5) - math.exp(-((4.0 * d) ** 2)) + math.exp(-4.0) - 1.3 * math.exp(-((4.0 * (d + 2.0)) ** 2))


def single(d: float) -> float:
    """T = 1/cosh(4(d + 0.33)) below 0.5, and a line above it that presses."""
    return sharp(d) if d < 0.5 else 2.0 * (d - 0.5) + sharp(d)


def test_a_schedule_goes_down_to_no_load_to_the_top_and_apart() -> None:
    """Apart it goes on from the lowest row so far; moves grow where less than half of the largest tension is left."""
    one = contact(single, profile=lambda d: pulling(-sharp(d)), force_scale=1.0)
    found, before = _searched(given_context(one), 0.6, 1e-3, through=False)
    assert [(p.name, p.state) for p in found.phases] == [
        ("loading", False), ("unloading", True), ("pulling", True), ("separating", False),
    ]  # fmt: skip
    assert one.ended == ["separating"]
    assert found.peak.smooth == pytest.approx(1.0, abs=found.missed + 1e-9)
    assert before.smooth == found.peak.smooth
    assert found.loading[-1].force == pytest.approx(0.6, abs=1e-6)
    assert abs(found.zero.force) <= 1e-3
    assert found.critical.displacement == pytest.approx(-0.33, abs=1e-2)
    names = [s.phase for s in one.states]
    pulled, apart = ([s for s in one.states if s.phase == name] for name in ("pulling", "separating"))
    assert found.unloading == [s for s in one.states if s.phase != "loading"]
    assert names.count("loading") == len(found.loading)
    assert apart[0].displacement == max(min(places(pulled)), pulled[-1].displacement - 0.4)
    moves = [a.displacement - b.displacement for a, b in pairwise(apart)]
    step = 0.1
    for move, state in zip(moves, apart[1:], strict=True):
        assert move == pytest.approx(step)
        step *= 1.6 if -state.force < 0.5 else 1.0
    assert -apart[-1].force < 0.02 <= -apart[-2].force


def test_a_tension_that_rises_again_is_gone_through_once_more_and_then_told() -> None:
    """Seen by the rows apart; the second way goes on while particles hold as much as the largest tension so far."""

    def one(held: float) -> Any:
        return contact(
            hills, profile=lambda d: pulling(held if d > -2.6 else 0.0), estimate=Estimate(largest=1.0),
            closest=lambda d: 1.0 if d > -3.0 else 99.0,
        )  # fmt: skip

    for held, found in ((2.0, True), (0.5, False)):
        contacts = given_context(one(held), one(held))
        if found:
            result = smooth_pass(contacts, 0.3, 1e-3)
            assert result.peak.smooth == pytest.approx(1.3, abs=0.1)
            assert result.peak.position == pytest.approx(-2.0, abs=0.02)
        else:
            with pytest.raises(UntrustedError, match="the tension rises again to 1"):
                smooth_pass(contacts, 0.3, 1e-3)
        assert len(contacts.notes) == 2 - found
    alone = given_context(contact(single, profile=lambda d: pulling(-sharp(d))))
    smooth_pass(alone, 0.6, 1e-3)
    assert alone.notes == []
