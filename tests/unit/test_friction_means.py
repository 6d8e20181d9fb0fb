"""Claims of what a slide reports: a mean is over what comes after the run-in, and sliding that lags behind is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.friction import block_means, mean_of
from contact1d.workflow.experiments.slide.findings import is_steady
from contact1d.workflow.experiments.slide.motion import Motion
from contact1d.workflow.settings.drive import DriveLeg

PERIODS, VELOCITY = 12, 0.5


SPACED = SimpleNamespace(bodies=SimpleNamespace(spacing=1.0))
"""A scene, as far as it is asked."""


def test_a_mean_leaves_the_run_in_out() -> None:
    blocks = np.array([9.0, 7.0, 5.0, *np.full(PERIODS, 2.0)])
    found = mean_of(blocks)
    assert found.value == pytest.approx(2.0)
    assert found.first == 3


def test_means_over_periods_are_those_of_what_was_summed_up() -> None:
    time = np.linspace(0.0, 6.0, 61)
    assert block_means(time, time**2, 2.0) == pytest.approx([2.0, 6.0, 10.0])


def moved(place: Any, leg: DriveLeg) -> Motion:
    time = np.linspace(0.0, PERIODS / VELOCITY, 40 * PERIODS + 1)
    none = np.zeros_like(time)
    legs = np.zeros(time.size, dtype=np.int64)
    return Motion((leg,), legs, time, VELOCITY * time, place(time), none, none, time, none, none, none, none, none)


@pytest.mark.parametrize(("share", "steady"), [(1.0, True), (0.95, True), (0.5, False)])
def test_a_plate_that_falls_behind_the_drive_does_not_slide_steadily(share: float, steady: bool) -> None:
    leg = DriveLeg(VELOCITY, 40 * PERIODS, 10, 0.005)
    told = is_steady(SPACED, moved(lambda time: share * VELOCITY * time, leg))
    assert (told == "") == steady
