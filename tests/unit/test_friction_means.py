"""Claims of what a slide reports: a mean is over what comes after the run-in, and sliding that lags behind is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.friction import block_means, mean_of, sampled_mean
from contact1d.workflow.experiments.motion import Motion
from contact1d.workflow.experiments.series import Series
from contact1d.workflow.model.dynamics import DriveLeg

PERIODS, VELOCITY = 12, 0.5


MASS = 2.0
SPACED: Any = SimpleNamespace(
    bodies=SimpleNamespace(spacing=1.0, mass=MASS), the=lambda kind: SimpleNamespace(stiffness=0.5)
)
"""A scene, as far as it is asked."""


def weighing(plate: float) -> Any:
    """Settings, as far as they are asked: of a plate so heavy [MU] and three particles."""
    leg = DriveLeg(rows=40 * PERIODS, steps=10, velocity=VELOCITY, time_step=0.005)
    return SimpleNamespace(motion=SimpleNamespace(plate_mass=plate, drive=(leg,)), chains=SimpleNamespace(upper=3))


def test_a_mean_leaves_the_run_in_out() -> None:
    blocks = np.array([9.0, 7.0, 5.0, *np.full(PERIODS, 2.0)])
    found = mean_of(blocks)
    assert found.value == pytest.approx(2.0)
    assert found.first == 3


def moved(share: float, plate: float = 1.0) -> Motion:
    """A plate that lags behind its drive, under a constant friction of 1 FU."""
    time = np.linspace(0.0, PERIODS / VELOCITY, 40 * PERIODS + 1)
    columns = {"time": time, "drive": VELOCITY * time, "plate_x": share * VELOCITY * time, "friction": 1.0 + 0.0 * time}
    series = Series(columns, {"friction": time}, smooth=True)
    return Motion(SPACED, weighing(plate), series, {})


@pytest.mark.parametrize(("share", "steady"), [(1.0, True), (0.95, True), (0.5, False)])
def test_a_plate_that_falls_behind_the_drive_does_not_slide_steadily(share: float, steady: bool) -> None:
    told = moved(share).unsteady
    assert (told == "") == steady
    assert "has a period of" not in told


def test_a_plate_that_swings_for_longer_than_the_way_is_named_as_why() -> None:
    """2π √((M + N m)/k) against 12 periods of 2 TU: the threshold is 0.5 (24/2π)² = 7.295 MU in all."""
    for plate, said in ((1.29, False), (1.30, True)):
        assert ("lighter plate.mass" in moved(0.5, plate).unsteady) == said


def test_samples_know_a_friction_under_heat_better_than_the_balance() -> None:
    """Kicks of the bath are in the balance of forces over a time, and not in the friction."""
    generator = np.random.default_rng(3)
    time = np.linspace(0.0, 40.0, 40 * 50 + 1)
    friction = 1.0 + 0.3 * generator.standard_normal(time.size)
    kicks = np.concatenate([[0.0], np.cumsum(generator.standard_normal(time.size - 1) * 0.3)])
    found, balance = sampled_mean(time, friction, 1.0), mean_of(block_means(time, time + kicks, 1.0))
    assert abs(found.value - 1.0) < found.error < 0.3 * balance.error


def test_a_slip_between_two_samples_is_in_the_error_of_their_mean() -> None:
    """A sawtooth of 50 rows a period, without heat: each period errs alike."""
    time = np.linspace(0.0, 20.0, 20 * 50 + 1)
    sawtooth = (time + 0.99 / 50.0) % 1.0
    found = sampled_mean(time, sawtooth, 1.0)
    assert 0.0 < abs(found.value - 0.5) <= found.error < 0.02


@pytest.mark.parametrize("rows", [20, 50, 200])
@pytest.mark.parametrize("slip", [0.0003, 0.3137, 0.7719])
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
