"""Claims of results that are means over time: their errors follow from the blocks, whatever is made of the means."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d.analysis.friction import interval, standard_error
from contact1d.workflow.continuation.outcome import LATTICE, Reading, Result, unmet
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.experiments.series import Series, measured
from contact1d.workflow.experiments.thermal import require_balance

SEEDS, COUNT = 400, 20
SCATTER = 0.1
"""Relative: what 400 seeds leave open of a standard error, 5 %, twice."""
PERIOD, ROWS = 1.7, 37


def blocks(seed: int) -> Series:
    """Two quantities, half of the scatter of which is the same."""
    random = np.random.default_rng(seed)
    same, one, other = random.normal(size=(3, COUNT))
    return Series({"force": 10.0 + same + one, "area": 5.0 + 0.5 * (same + other)})


def read(series: Series) -> Mapping[str, Reading]:
    force, area = float(series.mean("force")), float(series.mean("area"))
    return {"force": Reading(force, "FU"), "pressure": Reading(force / area, "FU/LU²")}


def test_the_error_of_a_mean_is_that_of_its_blocks_and_of_two_means_what_they_scatter_together() -> None:
    """A ratio, whose parts go up and down together: the sum of their relative errors is 2.3 times as much."""
    found, force = measured(blocks(1), read)["force"], blocks(1)["force"]
    assert found.errors == pytest.approx({"statistics": force.std(ddof=1) / np.sqrt(COUNT)})
    assert measured(blocks(1), read, interval)["force"].uncertainty == pytest.approx(interval(force))
    ratios = [measured(blocks(seed), read)["pressure"] for seed in range(SEEDS)]
    stated = np.mean([one.uncertainty for one in ratios])
    assert stated == pytest.approx(np.std([one.value for one in ratios]), rel=SCATTER)
    single = measured(Series({"force": np.array([-3.0]), "area": np.array([2.0])}), read)
    assert (single["force"].uncertainty, single["pressure"].uncertainty) == (3.0, 1.5)


def trace(periods: float, seed: int) -> Series:
    """A smooth periodic force and its integral, with a phase by the seed."""
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi)
    time = np.linspace(0.0, periods * PERIOD, round(ROWS * periods) + 1)
    turn = 2.0 * np.pi * time / PERIOD + phase
    force: NDArray[np.float64] = np.sin(turn) ** 4
    integral = 3.0 * turn / 8.0 - np.sin(2.0 * turn) / 4.0 + np.sin(4.0 * turn) / 32.0
    return Series({"time": time, "force": force}, {"force": PERIOD / (2.0 * np.pi) * integral}, smooth=True)


def test_periods_that_end_between_records_are_known_by_every_second_one() -> None:
    """The mean of sin⁴ is 3/8; blocks of a periodic force hardly scatter by their interpolation error."""
    outside, unseen = 0, 0
    for seed in range(SEEDS):
        series = trace(6.43, seed)
        others = {"sampling": series.every_second().periods(PERIOD)}
        (found,) = measured(
            series.periods(PERIOD), lambda one: {"mean": Reading(float(one.mean("force")), "FU")}, interval, others
        ).values()
        outside += abs(found.value - 0.375) > found.uncertainty
        unseen += abs(found.value - 0.375) > found.errors["statistics"]
        assert found.uncertainty < 0.4 / ROWS**2
    assert outside <= 0.05 * SEEDS
    assert unseen > 0.5 * SEEDS


def test_a_standard_error_is_that_of_the_mean_of_a_correlated_series() -> None:
    """Of variance 1, forgotten in some steps."""
    count, memory, seeds = 4000, 8.0, 60
    kept, rng = math.exp(-1.0 / memory), np.random.default_rng(0)
    kicks = rng.normal(size=(count, seeds)) * math.sqrt(1.0 - kept**2)
    series = np.empty((count, seeds))
    series[0] = rng.normal(size=seeds)
    for i in range(1, count):
        series[i] = kept * series[i - 1] + kicks[i]
    errors = np.array([standard_error(Series({"d": one}).parts(20)["d"]) for one in series.T])
    assert errors.mean() == pytest.approx(math.sqrt(2.0 * memory / count), rel=0.15)
    assert (np.abs(series.mean(axis=0)) <= 2.1 * errors).mean() >= 0.9


def test_a_mean_force_that_misses_its_load_is_no_result() -> None:
    require_balance(Result(1.1, "FU", {"statistics": 0.021}), 1.0)
    with pytest.raises(UntrustedError, match=r"not in equilibrium: .* 1\.1 FU .* load 1 FU by 5\.3 standard errors"):
        require_balance(Result(1.1, "FU", {"statistics": 0.019}), 1.0)


ONE = Result(2.0, "FU", {"solver": 0.02, LATTICE: 0.1})


@pytest.mark.parametrize(
    ("name", "result", "without", "share"),
    [
        ("force", ONE, (), 0.06),
        ("force", replace(ONE, given=0.01), (), 0.055),  # what the scene leaves open is no error of the program
        ("force", ONE, (LATTICE,), 0.01),
        ("force", replace(ONE, read=0.03), (LATTICE,), 0.025),  # the discretisation error counts
        ("energy", replace(ONE, value=0.0), (), 0.0),
        ("energy", replace(ONE, value=0.0, scale=1.0), (), 0.12),
        ("contact_radius", replace(ONE, value=0.0), (), math.inf),  # a length without bound
    ],
)
def test_a_tolerance_is_asked_of_what_the_program_leaves_open(
    name: str, result: Result, without: tuple[str, ...], share: float
) -> None:
    limit = min(share, 1.0)
    assert unmet({name: result}, 1.01 * limit + 1e-9, without) == ({} if share < math.inf else {name: share})
    if share > 0.0:
        assert unmet({name: result}, 0.99 * limit, without) == {name: pytest.approx(share)}
