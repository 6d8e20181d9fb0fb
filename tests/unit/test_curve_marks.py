"""Marks on a sampled curve and the area of a loop, against functions whose maxima, zeros and areas are known."""

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from contact1d.analysis.curve_marks import (
    Peak,
    Work,
    closes,
    crossing,
    largest_tension,
    promised,
    rivals,
    smooth_crossing,
    tops,
    work_of,
)

Array = NDArray[np.float64]
ROUND_OFF = 1e-12
PLACE_FACTOR = 2.0
"""Of what two rows more change: a claim for a place."""
SIXTH = FOURTH = 0.5
"""Constants of the interpolation errors of this maximum and of its place, generously."""
TOP = 0.05
"""Where `rounded` is largest."""


def falling(values: ArrayLike) -> list[float]:
    return np.sort(np.asarray(values))[::-1].tolist()


def rounded(displacement: ArrayLike, top: float = TOP) -> Array:
    """A tension with a smooth maximum 1."""
    return np.asarray(np.exp(-((np.asarray(displacement) - top) ** 2)))


def peak_of(displacement: list[float], tension: ArrayLike) -> Peak:
    return largest_tension(displacement, (-np.asarray(tension)).tolist())


def test_a_jump_after_the_maximum_leaves_the_sampled_point_and_the_last_rise_as_uncertainty() -> None:
    d = falling(np.linspace(0.0, 1.0, 11))
    peak = peak_of(d, [1.0 - place if place > 0.45 else 0.1 for place in d])
    assert d[peak.index] == peak.position == pytest.approx(0.5)
    assert peak.uncertainty == pytest.approx(0.1)  # one increment of a unit slope
    assert peak.misplaced == 0.0


@pytest.mark.parametrize("step", [0.2, 0.1, 0.05])
@pytest.mark.parametrize("rows", [(-6, 7), (-2, 7), (-6, 3)])
def test_a_smooth_maximum_two_rows_from_an_end_or_more_is_of_sixth_order_and_covered(
    rows: tuple[int, int], step: float
) -> None:
    d = falling(0.03 + step * np.arange(*rows))
    peak = peak_of(d, rounded(d))
    assert abs(peak.smooth - 1.0) <= min(peak.uncertainty, SIXTH * step**5)
    assert abs(peak.position - TOP) <= FOURTH * step**4
    if rows == (-6, 7):
        assert abs(peak.position - TOP) <= PLACE_FACTOR * peak.misplaced <= FOURTH * step**4


@pytest.mark.parametrize("rows", [(-1, 8), (-7, 2)])
def test_a_maximum_one_row_from_an_end_is_known_to_what_the_parabola_adds(rows: tuple[int, int]) -> None:
    d = falling(5.03 + 0.1 * np.arange(*rows))
    peak = peak_of(d, rounded(d, 5.05))
    assert abs(peak.smooth - 1.0) <= peak.uncertainty <= 0.1**2
    assert abs(peak.position - 5.05) <= peak.misplaced <= 0.05


@pytest.mark.parametrize("tension", [[0.0, 1.0, 2.0], [2.0, 1.0, 0.0]])
def test_a_maximum_at_an_end_is_as_uncertain_as_it_is_large(tension: list[float]) -> None:
    peak = peak_of([1.0, 0.5, 0.0], tension)
    assert peak.uncertainty == peak.tension == peak.smooth == 2.0
    assert (peak.position, peak.misplaced) == (0.0 if tension[0] == 0.0 else 1.0, 0.0)


@pytest.mark.parametrize("apart", [1e-8, 1e-6, 1e-5, 1e-4, 3e-4])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_what_a_minimiser_leaves_of_rows_that_lie_close_to_the_top_is_no_slope(apart: float, sign: float) -> None:
    """A search comes back to a top that it knew well: forces are off by 3e-8 of themselves, to either side."""
    step, left = 0.01, 3e-8
    d = np.asarray(falling(np.concatenate([step * (np.arange(-4, 5) + 0.3), [1e-9, -apart, 0.0]])))
    tension, close = 1.0 - 500.0 * d**2 + 3e3 * d**3, np.abs(d) < 0.1 * step
    tension[close] += left * sign * np.where(np.arange(close.sum()) % 2, 1.0, -1.0)
    peak = peak_of(d.tolist(), tension)
    assert abs(peak.smooth - 1.0) <= 2.0 * left + peak.uncertainty
    assert peak.uncertainty < 1e-5
    assert abs(peak.position) < 1e-2 * step


def test_rows_that_lie_on_the_top_itself_leave_it_where_it_is() -> None:
    """A search that ends at the maximum: no row beyond it is apart from it."""
    d, tension = [3.0, 2.0, 1.0, 1.0 - 1e-9], [0.0, 1.0, 1.5, 1.5 - 1e-9]
    peak = peak_of(d, tension)
    assert (peak.position, peak.smooth) == (pytest.approx(1.0), pytest.approx(1.5))
    assert np.isnan(promised(d, [-t for t in tension], [1.0])).all()


@pytest.mark.parametrize(
    ("displacement", "tension", "expected"),
    [
        # 1.5 at the third row; the sixth may hold as much as the rise before it, 0.7 in a row, adds to the fifth.
        (range(8, -1, -1), [0.0, 1.0, 1.5, 0.5, 1.2, 1.48, 0.5, 0.2, 0.0], {5: 1.2 + 0.7}),
        # Up to the next row only; what comes after it says nothing.
        ([10.0, 9.5, 9.0, 8.5, 8.0, 7.5, 7.0], [0.0, 1.0, 0.2, 0.6, 3.0, 0.1, 2.9], {1: 1.0 + 1.0}),
        # A flat top is one rival.
        (range(10, -1, -1), [0.0, 1.0, 1.0, 0.2, 3.0, 3.0, 0.5, 1.5, 1.5, 1.5, 0.1], {1: 2.0, 7: 2.5}),
        (range(3, -1, -1), [0.0, 1.0, 1.5, 0.5], {}),
    ],
)
def test_another_maximum_may_be_as_high_as_its_own_rise_allows(
    displacement: ArrayLike, tension: list[float], expected: dict[int, float]
) -> None:
    d = np.asarray(displacement, dtype=float).tolist()
    peak = peak_of(d, tension)
    over = {index: top - peak.smooth for index, top in expected.items()}
    assert rivals(d, [-t for t in tension], peak) == pytest.approx(over)


@pytest.mark.parametrize(
    ("tension", "found"),
    [
        ([0.0, 5.0, 6.0], []),
        ([0.0, 5.0, 4.5, 6.0, 2.0], [3]),
        ([0.0, 5.0, 3.0, 6.0, 2.0], [1, 3]),
        ([0.0, 5.0, 5.0, 3.0, 3.5, 3.0], [1]),
        ([7.0, 2.0, 4.0, 4.0, 2.0], [0, 2]),
    ],
)
def test_tops_are_where_a_fall_begins_that_is_no_noise(tension: list[float], found: list[int]) -> None:
    assert tops(tension, 1.0) == found


def test_a_smooth_crossing_is_exact_on_a_cubic_and_straight_at_both_ends() -> None:
    d = np.array([6.0, 4.0, 3.1, 2.0, 1.2, 0.0, -3.0])
    law = np.polynomial.Polynomial.fromroots([0.5, -7.0, -9.0])
    for place in (3.6, 2.7, 1.5, 0.6, 5.0, -1.0):
        level, at_end = float(law(place)), place in (5.0, -1.0)
        expected = crossing(d.tolist(), law(d).tolist(), level)[1] if at_end else place
        assert smooth_crossing(d.tolist(), law(d).tolist(), level) == pytest.approx(expected, abs=1e-9)


def test_a_smooth_crossing_of_places_that_all_but_coincide_is_the_straight_lines() -> None:
    close = ([1.0, 1.0 - 1e-9, 0.0, -1.0], [2.0, 1.0, -1.0, -2.0])
    assert smooth_crossing(*close, 0.0) == crossing(*close, 0.0)[1]
    assert crossing([2.0, 1.0, 0.0], [3.0, 2.0, 1.0], 1.0) == (1, 0.0)  # met by the last row
    with pytest.raises(ValueError, match="never passes 7 FU"):
        crossing([2.0, 1.0], [3.0, 1.0], 7.0)


def there_and_back(rows: int) -> Array:
    leg = np.linspace(-1.0, 1.0, rows)
    return np.concatenate([leg, leg[-2::-1]])


def loop_of(d: ArrayLike, force: ArrayLike) -> Work:
    loop = work_of(np.asarray(d).tolist(), np.asarray(force).tolist())
    assert loop is not None
    return loop


@pytest.mark.parametrize("rows", [21, 81, 321])
def test_a_smooth_loop_is_within_its_claim_which_falls_with_the_square_of_the_rows(rows: int) -> None:
    """F = ± (1 - d²), area 8/3."""
    d = there_and_back(rows)
    loop = loop_of(d, np.where(np.arange(len(d)) < rows, 1.0, -1.0) * (1.0 - d**2))
    assert abs(loop.area - 8.0 / 3.0) <= loop.uncertainty
    assert loop.uncertainty < 6.0 / rows**2 * loop.area


def test_of_a_way_of_one_row_only_the_ends_are_known() -> None:
    """F is 1 as far as the turn and then −1: it may fall anywhere between, so that the loss is 0 to 4."""
    loop = loop_of([0.0, 2.0, 0.0], [1.0, 1.0, -1.0])
    assert (loop.area, loop.uncertainty) == pytest.approx((2.0, 2.0), rel=ROUND_OFF)


@pytest.mark.parametrize(
    ("d", "f", "closed"),
    [
        ([0.0, 1.0, 0.5], [0.0, 1.0, 0.0], False),
        ([-0.5, 1.0, -0.5], [0.0, 1.0, -0.3], False),
        ([-0.5, 1.0, -0.5], [0.0, 1e4, -1e-3], True),
        ([-0.5, 1.0, -0.5], [-0.3, 1.0, -0.3002], True),
        ([0.0, 1.0, 1e-9], [0.0, 1.0, 0.0], True),
        ([0.0, 1.0, 3e-9], [0.0, 1.0, 0.0], False),
    ],
)
def test_a_path_closes_where_displacement_and_force_do_but_for_round_off(
    d: list[float], f: list[float], closed: bool
) -> None:
    """Bodies that began apart and end held together at the same displacement have not come back."""
    assert closes(d, f, 1e-3) == closed
    if d[-1] == 1e-9:  # the same way back
        assert loop_of(d, f).uncertainty == pytest.approx(0.0, abs=1e-8)
