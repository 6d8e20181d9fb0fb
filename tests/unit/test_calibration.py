"""What settings use up of a tolerance is what the kept study says, and nothing else."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import fields, replace
from operator import attrgetter
from pathlib import Path

import pytest

from contact1d import Scene
from contact1d.workflow.model.calibration import CALIBRATION, FILE, Calibration, calibration_of
from contact1d.workflow.model.settings import settings_for
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

MakeScene = Callable[..., Scene]
ROOT = Path(__file__).parents[2]
AT_ALL_TOLERANCES = 4


def test_the_file_in_use_follows_from_the_kept_study() -> None:
    """Renew both with `python -m validation.tools.calibration`; never by hand."""
    kept = json.loads(FILE.read_text(encoding="utf-8"))
    assert kept == chosen_values(read_rows())
    assert calibration_of(kept) == CALIBRATION


def test_every_share_was_studied_at_every_tolerance_and_every_scene_has_a_part() -> None:
    rows = read_rows()
    assert {one.name for one in fields(Calibration)} == set(LADDERS)
    assert {row.scene for row in rows} == set(SCENES)
    for share, ladder in LADDERS.items():
        mine = [row for row in rows if row.share == share]
        assert {row.value for row in mine} == set(ladder)
        assert {row.tolerance for row in mine} == set(TARGETS)


def test_all_shares_together_keep_the_tolerance_in_every_scene() -> None:
    together = [row for row in read_rows() if row.share == TOGETHER]
    assert len(together) == AT_ALL_TOLERANCES * len(SCENES)
    assert max(row.error for row in together) <= 1.0


@pytest.mark.parametrize(
    ("share", "field"), [("residual", "forces.residual"), ("smooth_increment", "increments.smooth_step")]
)
def test_settings_follow_their_share(share: str, field: str, make_scene: MakeScene) -> None:
    scene = make_scene()
    double = replace(CALIBRATION, **{share: 2.0 * getattr(CALIBRATION, share)})
    chosen = attrgetter(field)
    assert chosen(settings_for(scene, calibration=double)) == 2.0 * chosen(settings_for(scene))


def test_a_longer_share_of_the_law_or_of_the_pressure_shortens(make_scene: MakeScene) -> None:
    scene = make_scene(bodies={"particles": "auto"})
    usual = settings_for(scene)
    assert (
        settings_for(scene, calibration=replace(CALIBRATION, cutoff=10.0 * CALIBRATION.cutoff)).forces.cutoff
        < usual.forces.cutoff
    )
    assert (
        settings_for(scene, calibration=replace(CALIBRATION, chain=100.0 * CALIBRATION.chain)).chains.upper
        < usual.chains.upper
    )
    fine, rough = (
        settings_for(scene, calibration=replace(CALIBRATION, table=f * CALIBRATION.table)).forces.table
        for f in (1e-4, 1.0)
    )
    assert fine is not None
    assert rough is not None
    assert fine.points > rough.points


def ladder(share: str, scene: str = "a", **added: float) -> list[Row]:
    """A study of one share in one scene: by value the error that it adds, and a time that falls by a tenth each."""
    values = [float(name[1:]) for name in added]
    return [
        Row(scene, 1e-3, share, value, error, error, 0.9**i, 10, "")
        for i, (value, error) in enumerate(zip(values, added.values(), strict=True))
    ]


def study(share: str, rows: list[Row]) -> dict[str, object]:
    others = [row for name in LADDERS if name != share for row in ladder(name, **{"_1e-5": 0.0, "_1e-4": 0.0})]
    found = chosen_values([*rows, *others])["values"][share]
    assert isinstance(found, dict)
    return found


def test_the_cheapest_good_value_is_chosen() -> None:
    found = study("cutoff", ladder("cutoff", _1=0.0, _2=0.5 * PART, _3=0.9 * PART, _4=2.0 * PART, _5=0.0))
    assert found["value"] == 3.0
    assert found["cpu_over_finest"] == 0.81
    assert found["next"] == "4: adds 0.2 of the tolerance in a at 1e-3"


def test_it_has_to_be_good_in_every_scene() -> None:
    rows = [*ladder("cutoff", _1=0.0, _2=0.0, _3=0.0, _4=0.0), *ladder("cutoff", "b", _1=0.0, _2=0.0, _3=2.0 * PART)]
    assert study("cutoff", rows)["value"] == 2.0


def test_it_stays_away_from_what_misses_the_tolerance_and_from_what_was_not_tried() -> None:
    found = study("cutoff", ladder("cutoff", _1=0.0, _2=0.0, _3=0.0, _4=1.1))
    assert (found["value"], found["next"]) == (2.0, "3: 4 misses the tolerance")
    found = study("cutoff", ladder("cutoff", _1=0.0, _2=0.0, _3=0.0))
    assert (found["value"], found["next"]) == (2.0, "3: nothing coarser was tried")


def test_a_warning_or_a_failure_refuses_a_value() -> None:
    rows = ladder("cutoff", _1=0.0, _2=0.0, _3=0.0, _4=0.0)
    warned = [replace(row, trouble="chain_end") if row.value == 3.0 else row for row in rows]
    assert study("cutoff", warned)["value"] == 2.0
    assert study("cutoff", warned)["next"] == "3: chain_end in a at 1e-3"
    gone = {"added": math.nan, "error": math.nan, "cpu_s": math.nan, "trouble": "not converged: at 0.1 LU"}
    failed = [replace(row, **gone) if row.value == 3.0 else row for row in rows]
    assert study("cutoff", failed)["value"] == 1.0  # the next coarser one has no numbers


def test_what_is_promised_beside_the_tolerance_is_kept() -> None:
    values = {f"_{value}": 0.0 for value in ("1e-4", "1e-3", "1e-2", "1e-1")}
    found = study("residual", ladder("residual", **values))
    assert found["value"] == PROMISED["residual"][0]
    assert found["next"] == f"0.01: {PROMISED['residual'][1]}"


def test_what_costs_the_same_stays_fine() -> None:
    rows = [replace(row, cpu_s=1.0 + 0.001 * row.value) for row in ladder("cutoff", _1=0.0, _2=0.0, _3=0.0)]
    found = study("cutoff", rows)
    assert found["value"] == 1.0
    assert found["next"] == "2: is no cheaper (1 of the finest)"
