"""The area of a loop: exact where chords are, covered by its uncertainty where they are not, none where none closes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contact1d.analysis.curve_marks import closes, work_of

ROUND_OFF = 1e-12


def there_and_back(rows: int) -> np.ndarray:
    leg = np.linspace(-1.0, 1.0, rows)
    return np.concatenate([leg, leg[-2::-1]])


def test_a_parallelogram_has_its_area() -> None:
    """Straight sides: nothing is missed but at the two jumps of its ends, half a row's change each."""
    d = there_and_back(21)
    force = 0.3 * d + np.where(np.arange(len(d)) < 21, 0.5, -0.5)
    loop = work_of(d, force)
    assert loop is not None
    ends = 0.5 * 0.1 * 1.0  # the last chord there and the first one back join at the turn
    assert loop.area == pytest.approx(2.0 * 1.0 - ends, rel=ROUND_OFF)
    assert loop.length == pytest.approx(4.0, rel=ROUND_OFF)
    assert abs(loop.area - 2.0) <= loop.uncertainty


@pytest.mark.parametrize("rows", [11, 41, 161])
def test_one_smooth_curve_there_and_back_loses_nothing_and_claims_nothing(rows: int) -> None:
    d = there_and_back(rows)
    loop = work_of(d, np.exp(d))
    assert loop is not None
    assert abs(loop.area) <= ROUND_OFF * loop.whole
    assert loop.uncertainty <= ROUND_OFF * loop.whole
    assert loop.whole == pytest.approx(2.0 * (math.e - 1.0 / math.e), rel=0.01)


@pytest.mark.parametrize("rows", [21, 81, 321])
def test_a_smooth_loop_is_within_its_claim_which_falls_with_the_square_of_the_rows(rows: int) -> None:
    """An ellipse-like loop: F = ± (1 - d^2), area 8/3."""
    d = there_and_back(rows)
    force = np.where(np.arange(len(d)) < rows, 1.0, -1.0) * (1.0 - d**2)
    loop = work_of(d, force)
    assert loop is not None
    assert abs(loop.area - 8.0 / 3.0) <= loop.uncertainty
    assert loop.uncertainty < 6.0 / rows**2 * loop.area


def test_jumps_anywhere_between_rows_are_covered() -> None:
    """A square loop whose jumps lie anywhere: half an increment more or less for each."""
    rng = np.random.default_rng(7)
    for _ in range(200):
        d = there_and_back(41)
        on, off = rng.uniform(-0.2, 0.8), rng.uniform(-0.9, -0.3)
        there, back = np.where(d[:41] > on, 1.0, 0.0), np.where(d[41:] > off, 1.0, 0.0)
        loop = work_of(d, np.concatenate([there, back]))
        assert loop is not None
        assert abs(loop.area + (on - off)) <= loop.uncertainty
        assert loop.uncertainty <= 1.5 * 2 * 0.5 * 0.05 * 2


def test_several_turns_make_one_loop() -> None:
    """A path 0, 1, 0.5, 1, 0 on one straight line, by other places each time."""
    d = np.concatenate([np.linspace(0, 1, 11), np.linspace(1, 0.5, 8)[1:], np.linspace(0.5, 1, 5)[1:], [0.3, 0.0]])
    loop = work_of(d, 2.0 * d)
    assert loop is not None
    assert loop.area == pytest.approx(0.0, abs=ROUND_OFF)
    assert loop.uncertainty == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("d", [[0.0, 0.0], [0.3]])
def test_what_does_not_move_has_no_work(d: list[float]) -> None:
    assert work_of(d, [0.0] * len(d)) is None


@pytest.mark.parametrize(
    ("d", "f", "closed"),
    [
        ([0.0, 1.0, 0.5], [0.0, 1.0, 0.0], False),
        ([-0.5, 1.0, -0.5], [0.0, 1.0, -0.3], False),
        ([-0.5, 1.0, -0.5], [0.0, 1e4, -1e-3], True),
        ([-0.5, 1.0, -0.5], [-0.3, 1.0, -0.3002], True),
    ],
)
def test_a_path_closes_where_displacement_and_force_do(d: list[float], f: list[float], closed: bool) -> None:
    """Bodies that began apart and end held together at the same displacement have not come back."""
    assert closes(d, f, 1e-3) == closed


def test_of_a_way_of_one_row_only_the_ends_are_known() -> None:
    """F is 1 as far as the turn and then −1: it may fall anywhere on the way back, so that the area is 0 to 4."""
    loop = work_of([0.0, 2.0, 0.0], [1.0, 1.0, -1.0])
    assert loop is not None
    assert (loop.area, loop.uncertainty) == pytest.approx((2.0, 2.0), rel=ROUND_OFF)


def test_rows_that_stay_in_place_add_nothing() -> None:
    d, f = [0.0, 0.1, 0.25, 0.4, 0.3, 0.15, 0.0], [0.0, 1.0, 2.0, 2.5, 0.3, 0.1, 0.0]
    alone = work_of(d, f)
    held = work_of([*d[:4], d[3], d[3], d[3], *d[4:]], [*f[:4], 2.4, 2.2, 2.5, *f[4:]])
    assert alone is not None
    assert held is not None
    assert held.uncertainty == pytest.approx(alone.uncertainty, rel=ROUND_OFF)
    assert (held.area, held.whole, held.length) == pytest.approx((alone.area, alone.whole, alone.length))
    assert work_of([0.1, 0.1, 0.1], [1.0, 1.0, 1.0]) is None


def test_a_path_that_ends_where_it_began_but_for_round_off_is_closed() -> None:
    """A billionth of its width, and no more; also as the same way back."""
    for beyond, closed in ((0.0, True), (1e-9, True), (3e-9, False)):
        places = [0.0, 1.0, beyond]
        assert closes(places, [0.0, 1.0, 0.0], 1e-3) == closed
        if closed:
            assert (loop := work_of(places, [0.0, 1.0, 0.0])) is not None
            assert (loop.uncertainty, loop.whole, loop.length) == pytest.approx((0.0, 1.0, 2.0), abs=1e-8)
