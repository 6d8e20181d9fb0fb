"""Means of friction, slips and static friction against the same rules followed slowly, on random series."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import quad
from scipy.stats import t as students

from contact1d.analysis.friction import block_means, interval, largest_before, mean_of, sampled_mean, slips, student

PRINTED = 0.006
"""Relative: the table of Student's factors has three figures."""


def doubt(blocks: np.ndarray) -> float:
    """Half of the interval of 95 %, the largest for blocks of one, two and four of them, and half of a drift."""
    count, found = blocks.size, []
    for together in (1, 2, 4):
        if together == 1 or count // together >= 4:
            means = [blocks[i : i + together].mean() for i in range(count % together, count, together)]
            found.append(students.ppf(0.975, len(means) - 1) * np.std(means, ddof=1) / math.sqrt(len(means)))
    drift = blocks[count - count // 2 :].mean() - blocks[: count // 2].mean()
    return float(max(*found, 0.5 * abs(drift)))


@pytest.mark.parametrize("count", [3, 4, 5, 6, 7, 9, 12, 21])
def test_the_run_in_ends_where_what_is_left_is_known_best(count: int) -> None:
    """Never before the first period, and at half of them or two before the end at the latest."""
    random = np.random.default_rng(count)
    for _ in range(40):
        blocks = 1.0 + 0.1 * random.normal(size=count) + 3.0 * np.exp(-np.arange(count) / random.uniform(0.1, 5.0))
        blocks = blocks + random.choice([0.0, 0.5]) * np.arange(count)
        latest = max(1, min(count // 2, count - 2))
        claims = {first: doubt(blocks[first:]) for first in range(1, latest + 1)}
        found = mean_of(blocks)
        assert found.error == pytest.approx(claims[found.first], rel=PRINTED)
        assert found.error <= min(claims.values()) * (1.0 + PRINTED)
        assert found.value == pytest.approx(blocks[found.first :].mean())


@pytest.mark.parametrize("count", [2, 3, 5, 6, 9, 11, 17])
def test_a_drift_of_the_means_counts_by_half_of_what_both_halves_differ(count: int) -> None:
    """Of an odd number the one in the middle is in neither."""
    for trend in (np.arange(count), -np.arange(count), np.arange(count) ** 2, np.where(np.arange(count) < 2, 5.0, 0.0)):
        blocks = trend + 1e-3 * np.cos(np.arange(count))
        assert interval(blocks) == pytest.approx(doubt(blocks), rel=PRINTED)


def test_students_factors_are_the_printed_ones_as_far_as_they_go() -> None:
    assert [student(freedom) for freedom in (1, 9)] == [12.71, 2.26]
    assert student(10) == pytest.approx(students.ppf(0.975, 10), rel=1e-4)


@pytest.mark.parametrize("start", [0.0, -40.0, 7.0])
def test_means_over_periods_are_integrals_of_hermites_cubic_or_of_chords_between_rows(start: float) -> None:
    random = np.random.default_rng(5)
    for periods in (1.0, 2.0, 3.7):
        period = random.uniform(0.5, 3.0)
        time = start + period * periods * np.linspace(0.0, 1.0, 23) ** 1.3
        law = Polynomial(random.normal(size=4))  # its integral is no cubic
        integral = law.integ()(time - start)
        for rate in (None, law(time - start)):
            found = block_means(time, integral, period, rate)
            assert found.size == int(periods)
            for number, mean in enumerate(found[::-1]):
                end = time[-1] - start - number * period
                if rate is None:
                    at = np.interp([end - period, end], time - start, integral)
                    assert mean == pytest.approx((at[1] - at[0]) / period)
                else:
                    exact = quad(law, end - period, end)[0] / period
                    assert mean == pytest.approx(exact, abs=1e-3 * np.abs(law(time - start)).max())


@pytest.mark.parametrize("rows", [2, 3, 4, 10, 33])
def test_samples_miss_half_of_the_largest_step_of_the_usual_period_and_of_its_common_one(rows: int) -> None:
    random = np.random.default_rng(rows)
    for count in (3, 4, 8, 15):
        period = random.uniform(0.3, 4.0)
        time = -3.0 + period / rows * np.arange(round(rows * (count + random.uniform(0.0, 0.9))) + 1)
        shape = random.normal(size=rows)
        force = np.array([shape[i % rows] + 0.2 * random.normal() for i in range(time.size)])
        integral = [float(np.trapezoid(force[: i + 1], time[: i + 1])) for i in range(time.size)]
        mean = mean_of(block_means(time, np.array(integral), period))
        whole = int(((time[-1] - time[0]) / period) * (1.0 + 1e-9)) - mean.first
        usual = np.zeros(rows)
        for back in range(whole):
            begin = time.size - 1 - rows * (back + 1)
            usual += force[begin : begin + rows] / whole
        steps = [usual[(i + 1) % rows] - usual[i] for i in range(rows)]
        missed = 0.5 / rows * (max(map(abs, steps)) + abs(float(np.median(steps))))
        found = sampled_mean(time, force, period)
        assert (found.value, found.first) == (pytest.approx(mean.value), mean.first)
        assert found.error == pytest.approx(mean.error + missed)


def jumps(time: np.ndarray, place: np.ndarray, spacing: float, velocity: float) -> list[tuple[float, float, float]]:
    """Row by row: a way that is faster than twice the drive's goes on as long as it is."""
    found, begin = [], None
    for i in range(time.size):
        faster = i + 1 < time.size and abs(place[i + 1] - place[i]) > 2.0 * abs(velocity) * (time[i + 1] - time[i])
        if faster and begin is None:
            begin = i
        if not faster and begin is not None:
            if abs(place[i] - place[begin]) > 0.45 * spacing:
                found.append((time[i], place[begin], place[i] - place[begin]))
            begin = None
    return found


@pytest.mark.parametrize("spacing", [0.25, 1.0, 8.0])
def test_slips_are_the_long_ways_that_are_faster_than_twice_the_drive(spacing: float) -> None:
    """From the first row or up to the last one, there or back."""
    random, several = np.random.default_rng(7), 0
    for _ in range(60):
        time = np.cumsum(random.uniform(0.5, 1.5, 40))
        velocity = 0.1 * spacing * random.choice([-1.0, 1.0])
        place = np.cumsum(velocity * random.choice([0.1, 1.0, 1.9, 2.1, 4.0, -3.0], 40) * np.diff(time, prepend=0.0))
        expected = jumps(time, place, spacing, velocity)
        several += len(expected)
        assert [(slip.time, slip.place, slip.size) for slip in slips(time, place, spacing, velocity)] == expected
    assert several > 60
    even = np.arange(9.0)
    assert slips(even, 2.0 * spacing * even, spacing, spacing) == []
    assert [slip.size for slip in slips(even, 2.0 * spacing * even, spacing, 0.99 * spacing)] == [16.0 * spacing]


def largest_slowly(friction: np.ndarray, place: np.ndarray, spacing: float) -> tuple[float, float]:
    """A smooth top, five rows that bend evenly, has the vertex of their quartic; else the row, and what it may miss."""
    inside = [i for i in range(place.size) if place[i] - place[0] < spacing]
    top = max(inside, key=lambda i: friction[i])
    if 2 <= top < place.size - 2 and (np.diff(place[top - 2 : top + 3]) > 0.0).all():
        x, y = place[top - 2 : top + 3], friction[top - 2 : top + 3]
        bends = [2.0 * Polynomial.fit(x[i : i + 3], y[i : i + 3], 2).convert().coef[-1] for i in range(3)]
        if max(bends) < 0.0 and min(bends) >= 2.0 * max(bends):
            values = []
            for rows, degree in ((slice(None), 4), (slice(1, 4), 2)):
                law = Polynomial.fit(x[rows], y[rows], degree)
                level = [r.real for r in law.deriv().roots() if abs(r.imag) < 1e-9 and x[1] <= r.real <= x[3]]
                values.append(max((law(r) for r in level if law.deriv(2)(r) < 0.0), default=math.nan))
            if not math.isnan(sum(values)):
                return values[0], abs(values[0] - values[1])
    if top == 0:
        return friction[0], 0.0
    missed = friction[top] - friction[top - 1]
    if top < place.size - 1:
        before = friction[top - 1] - friction[top - 2] if top > 1 else 0.0
        missed = min(missed, max(missed - before, missed / 8.0))
    return friction[top], abs(missed)


@pytest.mark.parametrize("spacing", [2.0**-10, 1.0, 2.0**10])
def test_the_largest_friction_is_that_of_a_smooth_top_or_of_the_row_before_a_slip(spacing: float) -> None:
    random, smooth = np.random.default_rng(9), 0
    for number in range(200):
        count = int(random.integers(3, 14))
        place = 3.0 + np.cumsum(random.uniform(0.4, 1.0, count)) * random.uniform(0.6, 2.0) / count
        friction = 1.0 - random.uniform(0.3, 3.0) * (place - place[0] - random.uniform(-0.2, 1.0)) ** 2
        friction = friction + random.uniform(-0.4, 0.4) * (place - place[0]) ** 3
        if number % 3 == 0:
            friction = np.where(place > random.uniform(place[0], place[-1]), -0.5, friction)
        elif number % 3 == 1:
            friction = friction + random.choice([0.003, 0.1]) * random.normal(size=count)
        if number % 5 == 0:
            place[-2:] = place[-2:][::-1]
        elif number % 10 in (1, 2):  # no or one row beyond the top
            end = friction.argmax() + number % 10
            place, friction = place[:end], friction[:end]
        exact = largest_slowly(friction, place, 1.0)
        found = largest_before(0.5 * friction, spacing * place, spacing)
        assert found == pytest.approx((0.5 * exact[0], 0.5 * exact[1]), abs=1e-9)
        smooth += exact[0] not in friction
    assert 20 < smooth < 180


def test_a_top_is_smooth_from_two_rows_before_it_to_two_rows_after_it() -> None:
    x = np.arange(5.0)
    assert largest_before(-((x - 1.7) ** 2), x, 9.0) == pytest.approx((0.0, 0.0), abs=1e-12)
    for rows in (slice(0, 4), slice(1, 5)):  # the top is the last but one, or the second
        found, missed = largest_before(-((x - 1.7) ** 2)[rows], x[rows], 9.0)
        assert found == pytest.approx(-0.09)
        assert missed > 0.04


def test_bends_of_which_one_is_twice_another_are_even_and_a_level_top_has_no_vertex() -> None:
    x = np.arange(5.0)
    assert largest_before(np.array([0.0, 2.0, 3.0, 2.0, 0.0]), x, 9.0) == pytest.approx((3.0, 0.0), abs=1e-12)
    assert largest_before(np.array([-0.25, 2.0, 3.0, 2.0, -0.25]), x, 9.0) == pytest.approx((3.0, 0.0), abs=1e-12)
    assert largest_before(np.array([0.25, 2.0, 3.0, 2.0, 0.25]), x, 9.0) == pytest.approx((3.0, 0.125), abs=1e-12)
    assert largest_before(np.ones(5), x, 9.0) == (1.0, 0.0)


def test_a_way_of_as_much_as_a_plate_may_make_without_a_slip_is_none() -> None:
    assert slips(np.array([0.0, 1.0]), np.array([0.0, 0.45]), 1.0, 0.1) == []
