"""Searches of a displacement over curves that are formulas: every row that they ask for, and why they end.

A secant aims 2 % beyond the force, in increments of the settings at most; inside a bracket it stays 5 % off both ends.
Rows that follow from that are counted out by hand.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.experiments.running.prescribing import _around, _next, approach
from contact1d.workflow.experiments.running.trust import TensionError, UntrustedError
from tests.given import Estimate, GivenContact, at, given_scene

STEP = {"smooth_step": 0.1, "longest_move": 0.0, "cutoff": 9.0}
"""Increments of a tenth, wherever particles are 0.4 from each other or more; nothing is out of reach."""


def line(slope: float = 2.0, **more: Any) -> Any:
    return GivenContact(lambda d: slope * d, **{"closest": lambda d: 1.0} | STEP | more)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("start", [0.0, 0.3])
def test_a_force_on_a_straight_line_takes_two_steps_a_secant_and_two_looks_inside_its_bracket(
    direction: int, start: float
) -> None:
    """F = 2(d − d₀), F = 0.5 at 0.25: 0.1; 0.2; 1.02 of the rest; 95 % of that bracket; and the line's own place."""
    contact: Any = GivenContact(lambda d: 2.0 * (d - start), closest=lambda d: 1.0, **STEP)
    states = approach(contact, direction * 0.5, start, direction)
    beyond = 0.2 + 1.02 * 0.05
    ways = [0.0, 0.1, 0.2, beyond, 0.2 + 0.95 * (beyond - 0.2), 0.25]
    assert [s.displacement for s in states] == pytest.approx([start + direction * way for way in ways], abs=1e-12)
    assert contact.places == [s.displacement for s in states]


def test_a_secant_that_points_back_or_nowhere_takes_a_whole_increment() -> None:
    """F falls at first: 0, −0.1, then rises by 1 per LU; a flat piece has no secant."""
    curve = [(0.0, 0.0), (0.1, -0.1), (0.2, -0.1), (1.2, 0.9)]
    contact: Any = GivenContact(lambda d: float(np.interp(d, *zip(*curve, strict=True))), closest=lambda d: 1.0, **STEP)
    states = approach(contact, 0.3, 0.0)
    assert [s.displacement for s in states[:6]] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.5])
    assert states[-1].displacement == pytest.approx(0.6)


def test_increments_towards_the_other_body_are_a_quarter_of_the_distance_and_away_from_it_whole() -> None:
    contact = line(closest=lambda d: 0.2)
    assert [s.displacement for s in approach(contact, 0.2, 0.0)][:3] == pytest.approx([0.0, 0.05, 0.1])
    contact = line(closest=lambda d: 0.002)
    assert [s.displacement for s in approach(contact, -0.2, 0.0, -1)][:2] == pytest.approx([0.0, -0.1])


@pytest.mark.parametrize(("force", "scale"), [(0.5, 0.5), (-3.0, 3.0), (0.01, 0.2)])
def test_a_force_is_met_to_a_thousandth_of_the_tolerance_of_itself_or_of_the_scale(force: float, scale: float) -> None:
    for share, rows in ((0.99, 1), (1.01, 2)):
        for side in (-1.0, 1.0):
            contact = line(1.0, force_scale=0.2, tolerance=1e-2)
            off = side * share * 1e-5 * scale
            direction = int(math.copysign(1.0, -off))
            states = approach(contact, force, force + off, direction)
            assert (len(states) == 1) == (rows == 1)


@pytest.mark.parametrize(("direction", "word"), [(1, "above"), (-1, "below")])
def test_a_way_that_begins_beyond_its_force_is_refused(direction: int, word: str) -> None:
    with pytest.raises(UntrustedError, match=f"starts at .* {word} it already"):
        approach(line(), 0.0, direction * 0.1, direction)


@pytest.mark.parametrize("spacing", [0.25, 4.0])
def test_a_jump_is_told_where_two_places_are_one(spacing: float) -> None:
    """The bracket closes by a twentieth at least of what it was, down to the last digits of a spacing."""
    scene = given_scene(bodies={"particles": 40, "spacing": spacing})
    contact: Any = GivenContact(lambda d: 0.2 if d < 0.0313 else 0.9, closest=lambda d: 1.0, scene=scene, **STEP)
    with pytest.raises(UntrustedError, match=r"the force jumps past 0.5 FU .* from 0.2 to 0.9 FU"):
        approach(contact, 0.5, 0.0)
    low, high = -math.inf, math.inf
    widths = []
    for place in contact.places:
        low, high = (max(low, place), high) if place < 0.0313 else (low, min(high, place))
        widths.append(high - low)
    assert widths[-1] < 1e-12 * spacing <= widths[-2]


def test_a_tension_that_is_never_reached_is_told_with_the_largest_there_was() -> None:
    """T = 1 − (d + 0.35)²; out of reach beyond 0.8."""
    steps = STEP | {"cutoff": 4.5}
    contact: Any = GivenContact(lambda d: (d + 0.35) ** 2 - 1.0, closest=lambda d: 0.5 - 5.0 * d, **steps)
    with pytest.raises(TensionError) as caught:
        approach(contact, -1.2, 0.65, -1)
    assert contact.places[-1] == pytest.approx(-0.85)
    assert contact.places[-2] == pytest.approx(-0.75)
    assert caught.value.most == pytest.approx(1.0)
    near: Any = GivenContact(lambda d: 2.0 * d + 3.0, closest=lambda d: 0.5 - 5.0 * d, **steps)
    assert approach(near, 3.0, -1.0)[-1].force == pytest.approx(3.0, abs=1e-4)


def test_a_search_without_an_end_in_sight_ends_after_ten_thousand_increments() -> None:
    contact = line(1e-9)
    with pytest.raises(UntrustedError, match="within 10000 increments"):
        approach(contact, 1.0, 0.0)
    assert len(contact.places) == 10_001


EXPECTED = Estimate(place=lambda force: 0.4 * force, apart=lambda share: -1.0 - share, largest=0.9)


@pytest.mark.parametrize(
    ("force", "start", "direction", "end"),
    [
        (0.5, 0.0, 1, 0.204),
        (0.5, 0.1, 1, 0.202),
        (0.5, 0.3, -1, 0.198),
        (-0.5, 0.3, -1, -0.21),
        (-0.5, -0.9, 1, -0.186),
        (-0.5, 50.0, -1, -0.6),
        (0.0, 50.0, -1, -1.0),
    ],
)
def test_rows_that_need_no_rest_go_past_where_the_force_is_expected(
    force: float, start: float, direction: int, end: float
) -> None:
    """By a fiftieth of the way; of a tension no further than half of what is left to fixed grips. F = 2.5 d."""
    contact = line(2.5, stepped=True, estimate=EXPECTED)
    states = approach(contact, force, start, direction, steps=8)
    assert contact.places[:9] == pytest.approx(np.linspace(start, end, 9))
    assert contact.batches == [9]
    assert states[-1].carried == pytest.approx(force, abs=1e-4)
    assert len(states) == 10


def test_rows_begin_one_by_one_where_the_force_is_expected_behind() -> None:
    contact = line(2.5, stepped=True, estimate=EXPECTED)
    with pytest.raises(UntrustedError, match="already"):
        approach(contact, 0.5, 0.3, 1)
    assert contact.batches == []
    at_once = line(2.5, stepped=True, estimate=EXPECTED)
    assert len(approach(at_once, 0.5, 0.2, 1)) == 1


def test_a_tension_beyond_what_rows_past_it_have_is_never_reached() -> None:
    for floor, raises in ((-0.499, True), (-0.5, False), (-0.501, False)):
        contact: Any = GivenContact(
            lambda d, floor=floor: max(4.0 * d, floor), stepped=True, estimate=EXPECTED, closest=lambda d: 1.0, **STEP
        )  # fmt: skip
        if raises:
            with pytest.raises(TensionError, match=r"about 0\.9 FU"):
                approach(contact, -0.5, 0.0, -1)
        else:
            assert approach(contact, -0.5, 0.0, -1)[-1].force == pytest.approx(-0.5, abs=1e-4)


def test_a_force_that_is_a_rows_own_lies_between_it_and_the_next() -> None:
    rows = [at(0.25 * i, 0.5 * i) for i in range(4)]
    assert _around(rows, 0.5, 1) == (rows[1], rows[2])
    assert _around(rows, 1.25, 1) == (rows[2], rows[3])
    assert _around(rows[::-1], 0.5, -1) == (rows[1], rows[0])
    assert _around(rows[:2], 0.25, 1) == (rows[0], rows[1])


@pytest.mark.parametrize("part", [-1.0, 0.0, 0.04, 0.06, 0.94, 0.96, 2.0])
def test_a_secant_stays_a_twentieth_of_the_bracket_off_its_ends(part: float) -> None:
    place = _next(at(1.0, 2.0), at(3.0, 6.0), [at(1.0, 2.0)], 2.0 + 4.0 * part, 9.0)
    assert place == pytest.approx(1.0 + 2.0 * min(max(part, 0.05), 0.95))
