"""Means over whole periods, their errors, slips: on series whose answers are known."""

from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import quad
from scipy.stats import t as students

from contact1d.analysis.friction import block_means, interval, largest_before, mean_of, sampled_mean, slips, student

PERIOD, ROWS = 2.0, 50
PRINTED = 0.006
"""Relative: the table of Student's factors has three figures."""
GOES_ON = 1e-4
"""Relative: from ten degrees of freedom on it is an expansion in 1/n."""


def saw(periods: float, run_in: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Times, and the integral of a saw tooth between 0 and 1 with a run-in that decays in a period."""
    time = np.linspace(0.0, periods * PERIOD, round(periods * ROWS) + 1)
    phase = time / PERIOD
    integral = PERIOD * (np.floor(phase) / 2.0 + (phase % 1.0) ** 2 / 2.0)
    return time, integral + run_in * PERIOD * (1.0 - np.exp(-phase))


def test_a_mean_is_over_whole_periods_wherever_the_way_ends_after_the_run_in() -> None:
    """The mean of the saw's rows themselves changes by 0.2 with where it ends."""
    for periods in (4.0, 4.37, 20.9):
        mean = mean_of(block_means(*saw(periods), PERIOD))
        assert mean.value == pytest.approx(0.5, abs=1e-12 if periods.is_integer() else 1e-2)
        assert mean.error < 1e-2
    mean = mean_of(block_means(*saw(20.0, run_in=2.0), PERIOD))
    assert mean.first > 3
    assert abs(mean.value - 0.5) <= mean.error < 1e-2
    exact = mean_of(np.array([9.0, 7.0, 5.0, *np.full(12, 2.0)]))
    assert (exact.value, exact.first) == (pytest.approx(2.0), 3)
    with pytest.raises(ValueError, match="3 periods, got 2"):
        mean_of(np.asarray([1.0, 1.0]))


def test_the_interval_holds_the_true_mean_as_often_as_it_says() -> None:
    """Independent blocks of a normal law, few and many; half-widths of 95 %; alternations and drifts are reported."""
    random = np.random.default_rng(1)
    for count in (3, 6, 40):
        inside = sum(abs(b.mean()) <= interval(b) for b in random.normal(size=(1000, count)))
        assert inside >= 940, count
    assert interval(np.asarray([0.0, 1.0] * 20)) >= 0.15
    assert interval(np.linspace(0.0, 1.0, 40)) >= 0.25


def test_students_factors_are_students() -> None:
    for freedom in range(1, 80):
        near = PRINTED if freedom < 10 else GOES_ON
        assert student(freedom) == pytest.approx(students.ppf(0.975, freedom), rel=near)


def test_a_slip_is_a_jump_and_smooth_sliding_none() -> None:
    time = np.linspace(0.0, 4.0, 401)
    steps = np.floor(time) + np.clip(20.0 * (time % 1.0) - 19.0, 0.0, 1.0)
    found = slips(time, steps, 1.0, 1.0)
    assert [slip.size for slip in found] == pytest.approx([1.0] * 4)
    assert [slip.place for slip in found] == pytest.approx([0.0, 1.0, 2.0, 3.0])
    assert [slip.time for slip in found] == pytest.approx([1.0, 2.0, 3.0, 4.0])
    wavy = time - 0.12 * np.sin(2.0 * np.pi * time)  # η = 0.75: four times as fast at its fastest
    assert slips(time, wavy, 1.0, 1.0) == []
    assert [slip.size for slip in slips(time, -steps, 1.0, -1.0)] == pytest.approx([-1.0] * 4)


def test_a_smooth_largest_friction_lies_between_the_rows_and_within_its_claim() -> None:
    """Rows in equal steps of the drive over corrugations of any form that the plate passes without a slip.

    What comes after a spacing is larger.
    """
    random, outside, worst = np.random.default_rng(8), 0, 0.0
    for _ in range(200):
        start, lag, second = random.uniform(-0.1, 0.1), random.uniform(0.0, 0.12), random.uniform(-0.2, 0.2)
        drive = start + np.arange(0.0, 2.5, 1.0 / random.integers(25, 60))

        def force(x: Any, second: float = second) -> Any:
            return (np.sin(2.0 * np.pi * x) + second * np.sin(4.0 * np.pi * x)) * (1.0 + 0.5 * (x > 1.0))

        place = drive - lag * np.sin(2.0 * np.pi * drive)  # it hurries over the top
        top, missed = largest_before(force(place), place, 1.0)
        exact = force(np.linspace(0.0, 0.5, 20_001)).max()
        outside += abs(top - exact) > missed
        worst = max(worst, abs(top - exact))
    assert outside <= 10
    assert worst < 1e-3


@pytest.mark.parametrize("start", [0.0, -40.0])
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


@pytest.mark.parametrize("rows", [20, 200])
@pytest.mark.parametrize("slip", [0.0003, 0.3137])
def test_a_slip_at_the_same_time_of_every_period_may_be_missed_by_half_the_time_between_samples(
    rows: int, slip: float
) -> None:
    """Without heat nothing else is in the error: half the largest step of the period's own shape over its samples."""
    period, height = 2.5, 3.0
    time = np.linspace(-7.0, -7.0 + 17.3 * period, round(17.3 * rows) + 1)
    run_in = 40.0 * np.exp(-12.0 * (time - time[0]) / period)
    sawtooth = height * ((time / period - slip) % 1.0) + run_in
    found = sampled_mean(time, sawtooth, period)
    assert abs(found.value - 0.5 * height) <= found.error * (1.0 + 1e-9)
    assert found.error == pytest.approx(0.5 * height / rows, rel=0.1)
