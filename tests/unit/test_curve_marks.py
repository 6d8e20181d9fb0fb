"""Marks on a sampled curve against functions whose maxima and zeros are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.curve_marks import crossing, largest_tension, promised, rivals, smooth_crossing, tops

PARABOLA = 1e-12  # round-off of a polynomial fit in doubles
PLACE_FACTOR = 2.0  # of what two rows more change: a claim for a place
SIXTH = 0.5  # the constant of the interpolation error of this function, generously
FOURTH = 0.5  # the same of the vertex's place
CUBIC = 1e-5  # the fit is a parabola: its error is the third derivative times the square of the step

FAR, ORIGIN = 512.0, 1e-6
"""An origin [LU]; absolute: a place that far away has lost nine digits of a small difference of heights."""


def falling(values: np.ndarray) -> list[float]:
    return np.sort(values)[::-1].tolist()


def test_the_vertex_of_a_parabola_is_found_between_samples() -> None:
    displacement = falling(np.linspace(-1.0, 1.0, 24))
    peak = largest_tension(displacement, [-(2.0 - (d - 0.123) ** 2) for d in displacement])
    assert peak.position == pytest.approx(0.123, abs=PARABOLA)
    assert peak.smooth == pytest.approx(2.0, abs=PARABOLA)
    assert peak.tension <= peak.smooth
    assert abs(2.0 - peak.smooth) <= peak.uncertainty + PARABOLA


def test_uneven_steps_around_a_smooth_maximum_are_no_jump() -> None:
    displacement = falling(np.concatenate([np.linspace(-1.0, 0.1, 9), np.linspace(0.11, 0.3, 40), [0.5, 0.9]]))
    peak = largest_tension(displacement, [-np.exp(-((d - 0.2) ** 2)) for d in displacement])
    assert peak.position == pytest.approx(0.2, abs=CUBIC)


def test_a_jump_after_the_maximum_leaves_the_sampled_point_and_the_last_rise_as_uncertainty() -> None:
    displacement = falling(np.linspace(0.0, 1.0, 11))
    tension = [1.0 - d if d > 0.45 else 0.1 for d in displacement]
    peak = largest_tension(displacement, [-t for t in tension])
    assert displacement[peak.index] == peak.position == pytest.approx(0.5)
    assert peak.uncertainty == pytest.approx(0.1)  # one increment of a unit slope
    assert peak.misplaced == 0.0


@pytest.mark.parametrize("rows", [(-2, 7), (-6, 3)])
def test_a_maximum_two_rows_from_an_end_is_as_exact_as_any(rows: tuple[int, int]) -> None:
    displacement = falling(0.03 + 0.1 * np.arange(*rows))
    peak = largest_tension(displacement, [-np.exp(-((d - 0.05) ** 2)) for d in displacement])
    assert abs(peak.smooth - 1.0) <= min(peak.uncertainty, SIXTH * 0.1**5)
    assert abs(peak.position - 0.05) <= FOURTH * 0.1**4


@pytest.mark.parametrize("force", [[0.0, -1.0, -2.0], [-2.0, -1.0, 0.0]])
def test_a_maximum_at_an_end_is_as_uncertain_as_it_is_large(force: list[float]) -> None:
    peak = largest_tension([1.0, 0.5, 0.0], force)
    assert peak.uncertainty == peak.tension == peak.smooth == 2.0
    assert (peak.position, peak.misplaced) == (0.0 if force[0] == 0.0 else 1.0, 0.0)


@pytest.mark.parametrize("rows", [(-1, 7), (-7, 1)])
def test_a_maximum_one_row_from_an_end_is_known_to_what_the_parabola_adds(rows: tuple[int, int]) -> None:
    """Its place to the way from the row; both are no more than an increment makes of it."""
    displacement = falling(5.03 + 0.1 * np.arange(rows[0], rows[1] + 1))
    peak = largest_tension(displacement, [-np.exp(-((d - 5.05) ** 2)) for d in displacement])
    assert abs(peak.smooth - 1.0) <= peak.uncertainty <= 0.1**2
    assert abs(peak.position - 5.05) <= peak.misplaced <= 0.05


@pytest.mark.parametrize("step", [0.2, 0.1, 0.05])
def test_the_vertex_of_a_smooth_maximum_is_of_sixth_order_and_its_uncertainty_covers_it(step: float) -> None:
    displacement = falling(0.03 + step * np.arange(-6, 7))
    peak = largest_tension(displacement, [-np.exp(-((d - 0.05) ** 2)) for d in displacement])
    assert abs(peak.smooth - 1.0) <= peak.uncertainty
    assert abs(peak.smooth - 1.0) <= SIXTH * step**5
    assert abs(peak.position - 0.05) <= PLACE_FACTOR * peak.misplaced <= FOURTH * step**4


@pytest.mark.parametrize("beside", [1e-7, -1e-7])
def test_a_row_as_good_as_on_another_changes_nothing(beside: float) -> None:
    displacement = falling(0.03 + 0.1 * np.arange(-6, 7))
    doubled = falling(np.asarray([*displacement, 0.03 + beside]))
    alone, both = (largest_tension(d, [-np.exp(-((x - 0.05) ** 2)) for x in d]) for d in (displacement, doubled))
    assert both.position == pytest.approx(alone.position, rel=1e-9)
    assert both.misplaced == pytest.approx(alone.misplaced, rel=1e-3)


def test_a_smooth_crossing_is_of_fourth_order() -> None:
    errors = []
    for step in (0.2, 0.1):
        displacement = falling(0.07 + step * np.arange(-6, 7))
        place = smooth_crossing(displacement, [np.expm1(d) for d in displacement], 0.0)
        errors.append(abs(place))
    assert errors[0] / errors[1] > 2.0**3.5


def test_a_smooth_crossing_at_a_jump_or_an_end_is_the_straight_lines() -> None:
    jump = ([4.0, 3.0, 2.0, 1.0], [9.0, 8.9, -1.0, -1.1])
    assert smooth_crossing(*jump, 0.0) == pytest.approx(crossing(*jump, 0.0)[1], abs=0.5)
    end = ([2.0, 1.0, 0.0], [3.0, 1.0, -1.0])
    assert smooth_crossing(*end, 0.0) == crossing(*end, 0.0)[1]


def test_a_tooth_beside_the_highest_row_may_be_higher_by_the_rises_before_it() -> None:
    places = falling(np.arange(9.0))
    tension = [0.0, 1.0, 1.5, 0.5, 1.2, 1.48, 0.5, 0.2, 0.0]
    peak = largest_tension(places, [-t for t in tension])
    assert peak.tension == 1.5
    assert rivals(places, [-t for t in tension], peak) == pytest.approx({5: 1.2 + 0.7 - peak.smooth})
    assert rivals(places[:4], [-t for t in tension[:4]], peak) == {}


def test_places_that_all_but_coincide_get_no_polynomial() -> None:
    places, force = [1.0, 1.0 - 1e-9, 0.0, -1.0], [2.0, 1.0, -1.0, -2.0]
    assert smooth_crossing(places, force, 0.0) == crossing(places, force, 0.0)[1]


def test_a_crossing_lies_where_the_straight_line_passes_the_level() -> None:
    assert crossing([2.0, 1.0, 0.0], [3.0, 1.0, -1.0], 0.0) == (1, 0.5)
    assert crossing([2.0, 1.0, 0.0], [3.0, 1.0, -1.0], 1.0) == (0, 1.0)
    assert crossing([2.0, 1.0, 0.0], [3.0, 2.0, 1.0], 1.0) == (1, 0.0)  # met by the last row


def test_a_level_that_is_never_passed_is_an_error() -> None:
    with pytest.raises(ValueError, match="never passes 7 FU"):
        crossing([2.0, 1.0], [3.0, 1.0], 7.0)


def test_a_tooth_is_no_higher_than_its_own_rise_to_the_next_row_allows() -> None:
    """Rows every 0.5 from 10 down: the tension rises at 2 up to the tooth at 1.0, so to 2.0 at most half a row on."""
    d = [10.0, 9.5, 9.0, 8.5, 8.0, 7.5, 7.0]
    for last in (0.0, 2.9):  # what comes after says nothing of it
        tension = [0.0, 1.0, 0.2, 0.6, 3.0, 0.1, last]
        force = [-t for t in tension]
        peak = largest_tension(d, force)
        found = rivals(d, force, peak)
        assert found == {1: pytest.approx(1.0 + (1.0 - 0.0) / 0.5 * 0.5 - peak.smooth)}


@pytest.mark.parametrize("apart", [1e-8, 1e-6, 1e-5, 1e-4, 3e-4])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_what_a_minimiser_leaves_of_rows_that_lie_close_to_the_top_is_no_slope(apart: float, sign: float) -> None:
    """A search comes back to a top that it knew well: forces are off by 3e-8 of themselves, to either side."""
    step, left = 0.01, 3e-8
    d = falling(np.concatenate([step * (np.arange(-4, 5) + 0.3), [1e-9, -apart, 0.0]]))
    tension = np.array([1.0 - 500.0 * x**2 + 3e3 * x**3 for x in d])
    close = np.abs(d) < 0.1 * step
    tension[close] += left * sign * np.where(np.arange(close.sum()) % 2, 1.0, -1.0)
    peak = largest_tension(d, (-tension).tolist())
    assert abs(peak.smooth - 1.0) <= 2.0 * left + peak.uncertainty
    assert peak.uncertainty < 1e-5
    assert abs(peak.position) < 1e-2 * step


def test_rows_that_lie_on_the_top_itself_leave_it_where_it_is() -> None:
    """A search that ends at the maximum: no row beyond it is apart from it."""
    d, tension = [3.0, 2.0, 1.0, 1.0 - 1e-9], [0.0, 1.0, 1.5, 1.5 - 1e-9]
    peak = largest_tension(d, [-t for t in tension])
    assert (peak.position, peak.smooth) == (pytest.approx(1.0), pytest.approx(1.5))
    assert np.isnan(promised(d, [-t for t in tension], [1.0])).all()


def test_a_tooth_with_a_flat_top_is_a_rival_once_and_a_step_on_the_way_up_is_one_at_most() -> None:
    d = falling(np.arange(12.0))
    tension = [0.0, 1.0, 1.0, 0.2, 3.0, 3.0, 0.5, 1.5, 1.5, 1.5, 0.1, 9.0]
    peak = largest_tension(d[:-1], [-t for t in tension[:-1]])
    assert peak.index == 4
    assert list(rivals(d[:-1], [-t for t in tension[:-1]], peak)) == [1, 7]


def test_a_smooth_crossing_is_exact_on_a_cubic_and_straight_at_both_ends() -> None:
    d = np.array([6.0, 4.0, 3.1, 2.0, 1.2, 0.0, -3.0])
    law = np.polynomial.Polynomial.fromroots([0.5, -7.0, -9.0])
    for level_at in (3.6, 2.7, 1.5, 0.6):
        level = float(law(level_at))
        assert smooth_crossing(d.tolist(), law(d).tolist(), level) == pytest.approx(level_at, abs=1e-9)
    for level_at in (5.0, -1.0):
        level = float(law(level_at))
        assert smooth_crossing(d.tolist(), law(d).tolist(), level) == crossing(d.tolist(), law(d).tolist(), level)[1]


@pytest.mark.parametrize(
    ("tension", "fall", "found"),
    [
        ([0.0, 5.0, 6.0], 1.0, []),
        ([0.0, 5.0, 4.5, 6.0, 2.0], 1.0, [3]),
        ([0.0, 5.0, 3.0, 6.0, 2.0], 1.0, [1, 3]),
        ([0.0, 5.0, 5.0, 3.0, 3.5, 3.0], 1.0, [1]),
        ([7.0, 2.0, 4.0, 4.0, 2.0], 1.0, [0, 2]),
    ],
)
def test_tops_are_where_a_fall_begins_that_is_no_noise(tension: list[float], fall: float, found: list[int]) -> None:
    assert tops(tension, fall) == found


@pytest.mark.parametrize("jumps", [False, True])
def test_marks_do_not_depend_on_the_origin(jumps: bool) -> None:
    random = np.random.default_rng(8)
    d = np.cumsum(random.integers(1, 9, size=40))[::-1] / 8.0
    force = (random.uniform(size=40) - 0.5 if jumps else 0.3 - np.exp(-(((d - d[20] - 0.1) / 5.0) ** 2))).tolist()
    here, there = (largest_tension(places, force) for places in (d, d + FAR))
    assert there.position - FAR == pytest.approx(here.position, abs=ORIGIN)
    for name in ("index", "misplaced", "tension", "uncertainty", "smooth"):
        assert getattr(there, name) == pytest.approx(getattr(here, name), rel=ORIGIN, abs=ORIGIN)
    tooth = [here.position + 0.25]
    exact = promised(d, force, tooth)
    assert promised(d + FAR, force, [tooth[0] + FAR]) == pytest.approx(exact, rel=ORIGIN, nan_ok=True)
    assert smooth_crossing(d + FAR, force, 0.0) - FAR == pytest.approx(smooth_crossing(d, force, 0.0), abs=ORIGIN)
    assert rivals(d + FAR, force, there) == pytest.approx(rivals(d, force, here), abs=ORIGIN)
