"""What settings use up of a tolerance is what the kept study says, and nothing else."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from validation.tools.calibration import (
    LADDERS,
    PART,
    PROMISED,
    SCENES,
    TARGETS,
    TOGETHER,
    Row,
    chosen_values,
    read_rows,
)

FILE = Path(__file__).parents[2] / "workflow" / "model" / "calibration.json"


def test_the_file_in_use_follows_from_a_study_of_every_share_at_every_tolerance() -> None:
    """Renew both with `python -m validation.tools.calibration`; never by hand."""
    rows, kept = read_rows(), json.loads(FILE.read_text(encoding="utf-8"))
    assert kept == chosen_values(rows)
    assert kept["values"].keys() == LADDERS.keys()
    assert {row.scene for row in rows} == set(SCENES)
    for share, ladder in LADDERS.items():
        mine = [row for row in rows if row.share == share]
        assert {row.value for row in mine} == set(ladder)
        assert {row.tolerance for row in mine} == set(TARGETS)


def test_all_shares_together_keep_the_tolerance_in_every_scene() -> None:
    together = [row for row in read_rows() if row.share == TOGETHER]
    assert len(together) == len(TARGETS) * len(SCENES)
    assert max(row.error for row in together) <= 1.0


def ladder(errors: Sequence[float], scene: str = "a", share: str = "cutoff", unit: float = 1.0) -> list[Row]:
    """A study of one share in one scene: errors that 1, 2, 3, … units add, and times that fall by a tenth each."""
    return [Row(scene, 1e-3, share, unit * (i + 1), error, error, 0.9**i, 10, "") for i, error in enumerate(errors)]


GONE = {"added": math.nan, "error": math.nan, "cpu_s": math.nan, "trouble": "not converged: at 0.1 LU"}
GOOD, PROMISE = ladder([0.0] * 4), PROMISED["residual"]


@pytest.mark.parametrize(
    ("rows", "value", "following"),
    [
        (ladder([0.0, 0.5 * PART, 0.9 * PART, 2.0 * PART, 0.0]), 3.0, "4: adds 0.2 of the tolerance in a at 1e-3"),
        ([*GOOD, *ladder([0.0, 0.0, 2.0 * PART], "b")], 2.0, "3: adds 0.2 of the tolerance in b at 1e-3"),
        (ladder([0.0, 0.0, 0.0, 1.1]), 2.0, "3: 4 misses the tolerance"),
        (GOOD, 3.0, "4: nothing coarser was tried"),
        ([*GOOD[:2], replace(GOOD[2], **GONE), GOOD[3]], 1.0, "2: 3 misses the tolerance"),
        ([replace(row, cpu_s=1.0 + 0.001 * row.value) for row in GOOD], 1.0, "2: is no cheaper (1 of the finest)"),
        (ladder([0.0] * 4, share="residual", unit=0.5 * PROMISE[0]), PROMISE[0], f"0.0015: {PROMISE[1]}"),
    ],
)
def test_the_cheapest_value_is_chosen_that_is_good_in_every_scene_and_away_from_trouble(
    rows: list[Row], value: float, following: str
) -> None:
    (share,) = {row.share for row in rows}
    others = [row for name in LADDERS if name != share for row in ladder([0.0, 0.0], share=name, unit=1e-5)]
    found = chosen_values([*rows, *others])["values"][share]
    assert (found["value"], found["next"]) == (value, following)
