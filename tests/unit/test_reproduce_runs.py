"""Claims of the runs behind the reproduction: none that is there, of its scene and versions, is made again."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.errors import RunError
from contact1d.workflow.runs.report import versions
from tests.conftest import MakeScene
from validation.judging.machine import family, machine
from validation.judging.runs import found, there
from validation.paper import studies
from validation.paper.paper import HALF_DIGIT, TABLE_1
from validation.paper.record import RECORD, Record, StudyRecord, read_record
from validation.paper.runs import finish

KEPT = Path(__file__).parents[2] / "docs" / "reproduced" / "reproduce.json"


def test_a_run_is_there_where_scene_and_versions_are_the_same(plane: MakeScene, tmp_path: Path) -> None:
    scenes = {"one": plane(force=0.4), "two": plane(force=0.6)}
    done = finish(scenes, tmp_path, 1, Silent())
    assert {name: run.scene for name, run in done.items()} == scenes
    written = (tmp_path / "one" / "results.json").stat().st_mtime_ns
    again = finish(scenes, tmp_path, 1, Silent())
    assert {name: run.results["force"] for name, run in again.items()} == {
        name: run.results["force"] for name, run in done.items()
    }
    assert (tmp_path / "one" / "results.json").stat().st_mtime_ns == written
    assert there(scenes["one"], tmp_path / "two") is None
    assert there(scenes["one"], tmp_path / "three") is None
    path = tmp_path / "one" / "results.json"
    document = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(document | {"versions": {"contact1d": "0"}}), encoding="utf-8")
    assert there(scenes["one"], tmp_path / "one") is None
    assert str(found(done["one"], "adhesion_force").value) == "nan"


def test_a_run_that_failed_is_among_them_and_one_that_could_not_begin_ends_all(
    plane: MakeScene, tmp_path: Path
) -> None:
    wide = plane(force=1e6)
    failed = finish({"wide": wide}, tmp_path, 1, Silent())["wide"]
    assert failed.status == "failed"
    (tmp_path / "taken").write_text("a file", encoding="utf-8")
    with pytest.raises(RunError):
        finish({"taken": plane(force=0.4)}, tmp_path, 1, Silent())


def study(name: str) -> StudyRecord:
    return next(one for one in read_record(KEPT).studies if one.name == name)


def test_studies_of_an_earlier_record_stay_where_its_versions_are_the_same(tmp_path: Path) -> None:
    old = tuple(replace(study(name), title="old") for name in ("table1", "eq3"))
    new = (replace(study("table1"), title="new"), study("fig4"))
    for own, titles in ((versions(), ["old", study("fig4").title, "new"]), ({}, [study("fig4").title, "new"])):
        (tmp_path / RECORD).write_text(Record(old, own, 1.0).to_json(), encoding="utf-8")
        assert [one.title for one in studies._merged(tmp_path, new)] == titles


def test_long_runs_begin_first_and_none_is_left_out() -> None:
    ordered = studies._longest_first(studies.STUDIES)
    assert [one.name for one in ordered[:4]] == ["fig8a", "fig5", "fig6", "fig8b"]
    assert {one.name for one in ordered} == set(studies.NAMES)


def test_half_a_digit_is_that_of_the_numbers_as_printed() -> None:
    printed = {"a_0": "28.53 36.14 40.36", "F_A": "1.47 1.87 2.09", "one LU": "6.1 7.7 8.6", "one FU": "39.0 61.8 77.6"}
    for symbol, texts in printed.items():
        assert HALF_DIGIT[symbol] == pytest.approx(0.5 * 10.0 ** -len(texts.split()[0].split(".")[1]))
    columns = zip(*((row.zero_load_radius, row.adhesion_force, 1e9 * row.length_unit, 1e6 * row.force_unit)
                    for row in TABLE_1), strict=True)  # fmt: skip
    for column, texts in zip(columns, printed.values(), strict=True):
        assert list(column) == pytest.approx([float(text) for text in texts.split()])


def test_a_machine_is_its_kind_of_processor_and_no_name(tmp_path: Path) -> None:
    told = tmp_path / "cpuinfo"
    told.write_text("processor : 0\nmodel name\t: Intel(R) Xeon(R) Gold 6248 CPU @ 2.50GHz\n", encoding="utf-8")
    assert family(told) == "Intel Xeon Gold"
    assert "(Intel Xeon Gold)" in machine(told)
    assert family(tmp_path / "none") == ""
    told.write_text("flags : fpu\n", encoding="utf-8")
    assert family(told) == ""
    assert "(" not in machine(told)
