"""Marks on curves against the same rules followed slowly: by fits, dense grids and plain loops."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from contact1d.analysis.curve_marks import crossing, largest_tension, promised, smooth_crossing, tops

FITS = 1e-7
"""Of the size of a curve: the place of a vertex goes with the root of round-off."""


def vertex(d: list[float], tension: list[float], middle: int, beside: int) -> tuple[float, float]:
    """Of the polynomial through so many rows on each side; the highest row where it has no maximum beside it."""
    near = slice(middle - beside, middle + beside + 1)
    x = np.asarray(d[near]) - d[middle]
    law = Polynomial.fit(x, np.asarray(tension[near]) - tension[middle], 2 * beside)
    level = [root.real for root in law.deriv().roots() if abs(root.imag) < 1e-9 * np.ptp(x)]
    level = [place for place in level if x[beside + 1] <= place <= x[beside - 1] and law.deriv(2)(place) < 0.0]
    best = max(level, key=law, default=0.0)
    return (d[middle] + best, tension[middle] + law(best)) if law(best) > 0.0 else (d[middle], tension[middle])


def slowly(d: list[float], tension: list[float]) -> tuple[float, float, float, float]:
    """(smooth tension, its uncertainty, place, by how much it may be misplaced)."""
    i = int(np.argmax(tension))
    top = tension[i]
    if i in (0, len(d) - 1):
        return top, abs(top), d[i], 0.0
    before, after = (top - tension[i - 1]) / (d[i - 1] - d[i]), (top - tension[i + 1]) / (d[i] - d[i + 1])
    bend = 0.0
    if i >= 2:
        earlier = (tension[i - 1] - tension[i - 2]) / (d[i - 2] - d[i - 1])
        bend = (earlier - before) * (d[i - 1] - d[i + 1]) / (d[i - 2] - d[i])
    if after > 3.0 * (before + abs(bend)):
        return top, before * (d[i] - d[i + 1]), d[i], 0.0
    width = d[max(i - 3, 0)] - d[min(i + 3, len(d) - 1)]
    kept = [k for k in range(len(d)) if k in (0, i, len(d) - 1) or abs(d[k] - d[i]) > 1e-3 * width]
    d, tension, i = [d[k] for k in kept], [tension[k] for k in kept], kept.index(i)
    room = min(i, len(d) - 1 - i)
    places, values = zip(*(vertex(d, tension, i, beside) for beside in range(1, min(room, 3) + 1)), strict=True)
    if room == 1:
        return values[0], abs(values[0] - top), places[0], abs(places[0] - d[i])
    return values[1], abs(values[1] - values[0]), places[1], abs(places[1] - places[2 if room > 2 else 0])


@pytest.mark.parametrize("scale", [2.0**-12, 1.0, 2.0**12])
@pytest.mark.parametrize("seed", range(4))
def test_the_largest_tension_is_what_the_polynomials_through_three_five_and_seven_rows_say(
    seed: int, scale: float
) -> None:
    """Smooth and snapping curves of few and of many uneven rows; some rows lie nearly on the highest one."""
    random = np.random.default_rng(seed)
    for number in range(60):
        d = np.cumsum(random.uniform(0.3, 1.7, random.integers(3, 11)))[::-1]
        middle = random.uniform(d[-1], d[0])
        tension = 2.0 - 0.02 * (d - middle) ** 2 + 0.001 * (d - middle) ** 3 + 0.01 * random.normal(size=d.size)
        if number % 3 == 0:
            tension = np.where(d < middle, tension - random.uniform(0.0, 1.0), tension)
        i = int(np.argmax(tension))
        if number % 4 == 0 and 0 < i < d.size - 1:
            width = d[max(i - 3, 0)] - d[min(i + 3, d.size - 1)]
            side = int(random.choice([0, 1]))
            apart = (1 - 2 * side) * random.choice([0.3, 0.9, 1.1, 3.0]) * 1e-3 * width
            d, tension = np.insert(d, i + side, d[i] + apart), np.insert(tension, i + side, tension[i] - 1e-9)
        peak = largest_tension((scale * d).tolist(), (-tension).tolist())
        smooth, doubt, place, misplaced = slowly(d.tolist(), tension.tolist())
        assert (peak.smooth, peak.uncertainty) == pytest.approx((smooth, doubt), abs=FITS)
        assert (peak.position / scale, peak.misplaced / scale) == pytest.approx((place, misplaced), abs=100.0 * FITS)


def test_a_fall_three_times_as_steep_as_the_rise_before_it_is_no_jump_yet() -> None:
    for fall, jumps in ((3.0, False), (3.5, True)):
        peak = largest_tension([3.0, 2.0, 1.0, 0.0], [0.0, -1.0, fall - 1.0, fall])
        assert (peak.position == 2.0 and peak.misplaced == 0.0) == jumps


@pytest.mark.parametrize("beside", [1e-9, -1e-9])
def test_rows_at_an_end_that_lie_on_the_top_stay_as_its_neighbours(beside: float) -> None:
    d, tension = [1.0 + 1e-9, 1.0, 0.0, -1.0], [1.5 - 1e-9, 1.5, 1.0, 0.0]
    if beside < 0.0:
        d, tension = [-place for place in d[::-1]], tension[::-1]
    peak = largest_tension(d, [-t for t in tension])
    assert (peak.position, peak.smooth) == (pytest.approx(1.0 if beside > 0.0 else -1.0), pytest.approx(1.5))


def test_what_a_curve_promises_beside_its_second_row_is_the_cubic_through_four() -> None:
    d, tension = [4.0, 3.0, 1.5, 1.0, 0.0], [1.0, 2.0, 1.7, 1.2, -9.0]
    law = Polynomial.fit(d[:4], tension[:4], 3)
    for side in (1.0, -1.0):
        rows = [(side * place, -t) for place, t in zip(d, tension, strict=True)][:: int(side)]
        found = promised([place for place, _ in rows], [f for _, f in rows], [side * 3.4, side * 2.0])
        assert found == pytest.approx(law(np.array([3.4, 2.0])))


def test_a_level_that_is_passed_again_in_the_next_row_is_first_passed_where_the_cubic_says() -> None:
    d = [6.0, 5.0, 4.0, 3.0, 2.0, 1.0]
    law = Polynomial.fromroots([3.5, 2.5, -9.0])
    assert smooth_crossing(d, law(np.array(d)).tolist(), 0.0) == pytest.approx(3.5, abs=1e-9)


def test_a_level_met_by_a_row_is_passed_there_and_one_met_by_the_last_row_too() -> None:
    assert crossing([2.0, 1.0, 0.0], [3.0, 2.0, 1.0], 1.0) == (1, 0.0)
    assert crossing([2.0, 1.0, 0.0], [3.0, 2.0, 1.0], 2.0) == (0, 1.0)


def turns(tension: list[float], fall: float) -> list[int]:
    """The same, leg by leg: up to the first fall from the highest, then up to the first rise from the lowest."""
    found, start = [], 0
    while True:
        over = [j for j in range(start, len(tension)) if max(tension[start : j + 1]) - tension[j] > fall]
        if not over:
            return found
        top = start + int(np.argmax(tension[start : over[0] + 1]))
        found.append(top)
        up = [j for j in range(over[0], len(tension)) if tension[j] - min(tension[top : j + 1]) > fall]
        if not up:
            return found
        start = up[0]


def test_tops_are_where_a_fall_begins_that_is_no_noise() -> None:
    random = np.random.default_rng(6)
    assert tops([], 1.0) == tops([1.0], 1.0) == tops([0.0, 5.0, 6.0], 1.0) == []
    for _ in range(300):
        tension = random.integers(0, 9, random.integers(2, 25)).astype(float).tolist()
        for fall in (0.0, 1.0, 2.5, 4.0):
            assert tops(tension, fall) == turns(tension, fall)
