"""Claims of means under noise: a standard error knows that a series is correlated; a motion forgets its start first."""

from __future__ import annotations

import math

import numpy as np
import pytest

from contact1d import read_scene
from contact1d.analysis.friction import standard_error
from contact1d.workflow.continuation.outcome import Result
from contact1d.workflow.continuation.trust import UntrustedError
from contact1d.workflow.experiments.series import Series
from contact1d.workflow.experiments.thermal import BLOCKS, planned_samples, require_balance
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains

COUNT, MEMORY, SEEDS = 4000, 8.0, 60


def correlated(seed: int) -> np.ndarray:
    """A series of variance 1 that forgets in MEMORY steps."""
    kept, rng = math.exp(-1.0 / MEMORY), np.random.default_rng(seed)
    kicks, found = rng.normal(size=COUNT) * math.sqrt(1.0 - kept**2), np.empty(COUNT)
    found[0] = rng.normal()
    for i in range(1, COUNT):
        found[i] = kept * found[i - 1] + kicks[i]
    return found


def test_a_standard_error_is_that_of_the_mean_of_a_correlated_series() -> None:
    series = [correlated(seed) for seed in range(SEEDS)]
    errors = [standard_error(Series({"d": one}).parts(BLOCKS)["d"]) for one in series]
    stated = np.mean(errors)
    assert stated == pytest.approx(math.sqrt(2.0 * MEMORY / COUNT), rel=0.15)
    off = np.asarray([abs(one.mean()) / error for one, error in zip(series, errors, strict=True)])
    assert (off <= 2.1).mean() >= 0.9


def test_a_motion_forgets_its_start_before_it_is_sampled() -> None:
    noisy = chains(1000.0, experiment={"kind": "load", "force": 1.0}, damping={"coefficient": "auto"}, plate={})
    scene = read_scene(noisy | {"noise": {"temperature": 1e-4, "seed": 1}})
    settings = settings_for(scene)
    settling, _ = planned_samples(settings, 1.0)
    time = sum(getattr(row, "steps", 0) for row in settling.rows) * settings.motion.time_step
    assert time >= 8.0 * settings.motion.settle_time


def test_a_mean_force_that_misses_its_load_is_no_result() -> None:
    require_balance(Result(1.1, "FU", {"statistics": 0.021}), 1.0)
    with pytest.raises(UntrustedError, match=r"not in equilibrium: .* 1\.1 FU .* load 1 FU by 5\.3 standard errors"):
        require_balance(Result(1.1, "FU", {"statistics": 0.019}), 1.0)
