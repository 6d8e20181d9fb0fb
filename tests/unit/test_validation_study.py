"""Claim: one runner does studies, reuses what is there, and keeps what fails; the pages are made from its records."""

from __future__ import annotations

import importlib
import pickle
from pathlib import Path

import pytest
from typer.testing import CliRunner

from tests.pages import require_shown
from tests.punch import PUNCH
from validation import doors
from validation.__main__ import RESULTS, ROOT, app
from validation.age import RECORDS, Measured, today
from validation.grains import STUDIES as GRAINS
from validation.hard import STUDIES as HARD
from validation.page import speed_table, summary, tables_page
from validation.paper import STUDIES as PAPER
from validation.row import Row, at_most
from validation.speed import STUDIES as SPEED
from validation.study import Bench, Findings, Record, Study, answered, conduct, read_record


def broken(bench: Bench) -> Findings:
    raise RuntimeError("a study that does not end")


@pytest.fixture(scope="module")
def conducted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Record]:
    folder = tmp_path_factory.mktemp("study")
    return folder, conduct([PUNCH], folder, workers=1)


def test_a_study_runs_its_scenes_once_and_a_refusal_is_a_row_that_fails(conducted: tuple[Path, Record]) -> None:
    folder, record = conducted
    assert [(row.name, row.verdict) for row in record.rows] == [("force", "PASS"), ("refused", "FAIL")]
    assert record.rows[1].bound.source.startswith("refused before anything ran: ")
    assert (folder / "small.png").stat().st_size > 1000
    results = folder / "runs" / "small" / "punch" / "results.json"
    made = results.stat().st_mtime_ns
    again = conduct([PUNCH], folder, workers=1)
    assert results.stat().st_mtime_ns == made
    assert [row.as_data() for row in read_record(folder / "record.json").rows] == [row.as_data() for row in again.rows]


def test_a_record_says_at_which_commit_it_was_measured_and_its_age_is_printed(conducted: tuple[Path, Record]) -> None:
    (answer,) = conducted[1].answers
    assert Measured(answer.date, answer.commit) == today()
    assert all(answer.commit for answer in read_record(RESULTS / "paper.json").answers)
    done = CliRunner().invoke(app, ["ages"])
    assert done.exit_code == 0
    for name in RECORDS:
        assert any(line.startswith(name) and line.endswith(" days ago") for line in done.output.splitlines())


def test_a_study_that_breaks_has_a_row_that_fails(tmp_path: Path) -> None:
    answer = answered(Study("broken", "–", "–", broken), tmp_path, False)
    assert [row.verdict for row in answer.rows] == ["FAIL"]
    assert "a study that does not end" in answer.rows[0].name


def test_a_folder_of_other_things_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(doors.FolderError, match="not of a validation"):
        conduct([PUNCH], tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


def test_every_study_goes_to_a_process_of_its_own() -> None:
    for study in (*PAPER, *HARD, *SPEED, *GRAINS):
        assert pickle.loads(pickle.dumps(study)).name == study.name


@pytest.mark.parametrize("command", ["paper", "hard", "speed", "grains"])
def test_an_unknown_study_is_told_with_the_known_ones(command: str, tmp_path: Path) -> None:
    done = CliRunner().invoke(app, [command, "--only", "fig_4", "--out", str(tmp_path / "out")])
    assert done.exit_code == 2
    assert "there are " in done.output


def test_the_pages_are_what_the_records_say() -> None:
    """Renew them with `python -m validation pages`."""
    paper, hard, speed = (read_record(RESULTS / f"{name}.json") for name in ("paper", "hard", "speed"))
    assert (ROOT / "VALIDATION.md").read_text(encoding="utf-8") == summary(paper, hard, speed)
    assert (RESULTS / "tables.md").read_text(encoding="utf-8") == tables_page([paper, hard])
    require_shown("docs/performance.md", "speed", speed_table(speed), exactly=True)


@pytest.mark.parametrize(("name", "studies"), [("paper", PAPER), ("hard", HARD), ("speed", SPEED)])
def test_a_record_has_every_study(name: str, studies: tuple[Study, ...]) -> None:
    record = read_record(RESULTS / f"{name}.json")
    assert [answer.name for answer in record.answers] == [study.name for study in studies]
    if name != "speed":
        assert [row.name for row in record.rows if row.verdict == "FAIL"] == []


def test_what_validates_knows_nothing_of_what_is_printed() -> None:
    """No module of validation imports the closed forms that users see."""
    for path in sorted((ROOT / "validation").rglob("*.py")):
        assert "analysis.theory" not in path.read_text(encoding="utf-8"), path


@pytest.mark.parametrize("name", ["loads", "loops", "friction", "forces", "modes", "buckling"])
@pytest.mark.slow
def test_a_class_of_seconds_has_no_new_failure(name: str, tmp_path: Path) -> None:
    study = next(study for study in HARD if study.name == name)
    assert [row.name for row in answered(study, tmp_path, False).rows if row.verdict == "FAIL"] == []


def test_speed_rows_are_ours_over_theirs() -> None:
    plain = importlib.import_module("validation.speed.plain")
    scaling = importlib.import_module("validation.speed.scaling")
    overhead = importlib.import_module("validation.speed.overhead")
    assert overhead.over([2.0, 9.0, 4.0], [1.0, 3.0, 1.0]) == pytest.approx(3.0)
    seconds = {"quasistatic": 1.0, "dynamic": 2.0, "plain": 200.0, "plain, tuned": 20.0, "scipy solver": 4.0}
    rows: list[Row] = plain.rows_of(1e-3, seconds, {"quasistatic": 1e-4, "dynamic": 1e-4})
    assert rows[0].value == pytest.approx(1.0 / 200.0)
    assert rows[0].verdict == "PASS"
    assert scaling.spread({200: 3.0, 2000: 6.0}) == pytest.approx(2.0)
    assert at_most("slow", 3.0, scaling.SPREAD, "asked").verdict == "FAIL"
    peers = importlib.import_module("validation.speed.peers")
    found = {
        "contact": "hertz",
        "setting": "any",
        "wall": 0.01,
        "errors": {"limit_force": 1e-3, "limit_relative": 1e-3},
    }
    solvers = {peers.OURS: 0.002, peers.ELEMENTS[0]: 1.0}
    compared = peers.rows_of([found | {"solver": solver, "seconds": time} for solver, time in solvers.items()])
    assert [row.value for row in compared] == pytest.approx([0.002, 0.002, 0.01])
