"""Claims of results that are means over time: their errors follow from the blocks, whatever is made of the means."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d.analysis.friction import interval
from contact1d.workflow.continuation.outcome import Reading
from contact1d.workflow.experiments.series import Series, measured

SEEDS, COUNT = 400, 20
SCATTER = 0.1
"""Relative: what 400 seeds leave open of a standard error, 5 %, twice."""
PERIOD = 1.7


def blocks(seed: int) -> Series:
    """Two quantities, half of the scatter of which is the same."""
    random = np.random.default_rng(seed)
    same, one, other = random.normal(size=(3, COUNT))
    return Series({"force": 10.0 + same + one, "area": 5.0 + 0.5 * (same + other)})


def read(series: Series) -> Mapping[str, Reading]:
    force, area = float(series.mean("force")), float(series.mean("area"))
    return {"force": Reading(force, "FU"), "pressure": Reading(force / area, "FU/LU²")}


def test_the_error_of_a_mean_is_that_of_its_blocks() -> None:
    found, force = measured(blocks(1), read)["force"], blocks(1)["force"]
    assert found.value == pytest.approx(force.mean())
    assert found.errors == pytest.approx({"statistics": force.std(ddof=1) / np.sqrt(COUNT)})
    assert measured(blocks(1), read, interval)["force"].uncertainty == pytest.approx(interval(force))


def test_what_is_made_of_two_means_scatters_as_much_as_is_stated() -> None:
    """A ratio, whose parts go up and down together: the sum of their relative errors is 2.3 times as much."""
    found = [measured(blocks(seed), read)["pressure"] for seed in range(SEEDS)]
    stated = np.mean([one.uncertainty for one in found])
    assert stated == pytest.approx(np.std([one.value for one in found]), rel=SCATTER)


def test_a_single_block_leaves_all_of_a_mean_open() -> None:
    found = measured(Series({"force": np.array([-3.0]), "area": np.array([2.0])}), read)
    assert found["force"].uncertainty == 3.0
    assert found["pressure"].uncertainty == 1.5


def test_what_a_reader_determines_itself_stays_and_what_others_lack_may_be_zero() -> None:
    def rarely(series: Series) -> Mapping[str, Reading]:
        known = {"known": Reading(2.0, "LU", {"statistics": 0.25, "discretisation": 0.5})}
        return known | ({"seen": Reading(4.0, "LU")} if 1.0 in series["spot"] else {})

    found = measured(Series({"spot": np.array([1.0, 0.0, 0.0])}), rarely)
    assert found["known"].errors == {"statistics": 0.25, "discretisation": 0.5}
    assert found["known"].read == 0.5
    assert found["seen"].uncertainty > 0.5 * found["seen"].value


def trace(rows: int, periods: float, seed: int) -> Series:
    """A smooth periodic force and its integral, with a phase by the seed."""
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi)
    time = np.linspace(0.0, periods * PERIOD, round(rows * periods) + 1)
    turn = 2.0 * np.pi * time / PERIOD + phase
    force: NDArray[np.float64] = np.sin(turn) ** 4
    integral = 3.0 * turn / 8.0 - np.sin(2.0 * turn) / 4.0 + np.sin(4.0 * turn) / 32.0
    return Series({"time": time, "force": force}, {"force": PERIOD / (2.0 * np.pi) * integral}, smooth=True)


def mean_force(series: Series) -> Mapping[str, Reading]:
    return {"mean": Reading(float(series.mean("force")), "FU")}


@pytest.mark.parametrize("rows", [20, 37, 50])
def test_periods_that_end_between_records_are_known_by_every_second_one(rows: int) -> None:
    """The mean of sin⁴ is 3/8; blocks of a periodic force hardly scatter by their interpolation error."""
    outside, unseen = 0, 0
    for seed in range(SEEDS):
        series = trace(rows, 6.43, seed)
        others = {"sampling": series.every_second().periods(PERIOD)}
        found = measured(series.periods(PERIOD), mean_force, interval, others)["mean"]
        outside += abs(found.value - 0.375) > found.uncertainty
        unseen += abs(found.value - 0.375) > found.errors["statistics"]
        assert found.uncertainty < 0.4 / rows**2
    assert outside <= 0.05 * SEEDS
    assert unseen > 0.5 * SEEDS


def test_every_second_record_ends_where_all_of_them_do() -> None:
    for count in (2, 3, 8, 9):
        time = np.arange(float(count))
        kept = Series({"time": time}, {"force": 2.0 * time}).every_second()
        assert kept["time"][[0, -1]].tolist() == time[[0, -1]].tolist()
        assert len(kept) == count // 2 + 1
        assert kept.integrals["force"].tolist() == (2.0 * kept["time"]).tolist()
