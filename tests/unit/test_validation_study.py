"""Claim: a row's verdict follows from its rule; one runner does studies, reuses what is there, and keeps what fails;
pages are made from its records; every listed fault can still be put back."""

import math
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from tests.pages import require_shown
from tests.punch import PUNCH
from validation import doors, grains
from validation.__main__ import RESULTS, ROOT, app
from validation.age import RECORDS, Measured, today
from validation.hard import STUDIES as HARD
from validation.page import duration, limits, measured, outcome, speed_table, summary, tables_page
from validation.paper import STUDIES as PAPER
from validation.row import Bound, Known, Reference, Row, absolute, at_most, claim, relative
from validation.speed import STUDIES as SPEED
from validation.speed import overhead, peers, plain, scaling
from validation.study import Bench, Findings, Record, Study, answered, conduct, read_record
from validation.tools.faults import listed
from validation.tools.mutants import mutants

TWO = Reference(2.0, "theory")
DIFFERS = Row("differs", 3.0, TWO, relative(0.1, "model"), known=Known(3.0, 0.1, "first record"))


@pytest.mark.parametrize(("bound", "passes", "fails"), [
    (relative(0.1, "lattice"), 2.19, 2.21), (absolute(0.1, "lattice"), 1.91, 1.89), (claim("run"), 2.1, 2.12),
    (claim("run", 0.06), 2.1, 2.12), (claim("run", 0.05), math.nan, 2.1), (Bound("at most", 0.0, "–"), 2.0, 2.01),
    (Bound("at least", 0.0, "–"), 2.1, 1.9),
])  # fmt: skip
def test_a_row_passes_where_its_rule_holds_and_its_warnings_are_answered(
    bound: Bound, passes: float, fails: float
) -> None:
    verdicts = [
        Row.of(Row("row", value, TWO, bound, 0.11, warnings={"lattice": answer}).as_data()).verdict
        for value, answer in ((passes, "since"), (fails, "since"), (passes, ""))
    ]
    assert verdicts == ["FAIL" if math.isnan(passes) else "PASS", "FAIL", "FAIL"]


def test_a_row_that_differs_does_so_by_what_is_known() -> None:
    verdicts = [replace(DIFFERS, value=value).verdict for value in (3.05, 3.2, 2.05)]
    assert verdicts == ["DIFFERS", "FAIL", "FAIL"]
    assert "known to be 3" in limits(DIFFERS)


def test_rows_are_written_for_people() -> None:
    row = at_most("half", 0.5, 1.0, "theory")
    assert row.margin == pytest.approx(2.0)
    rows = [row, replace(row, standing="repeats"), replace(row, value=2.0)]
    assert outcome(rows) == "1 of 2 rows pass; counted separately: 1 repeats another"
    assert measured(1.48341, 0.00012, "FU") == "1.48341 ± 0.00012 FU"
    assert [duration(seconds) for seconds in (12.0, 2700.0, 7500.0)] == ["12 s", "45 min", "2 h 5 min"]
    assert measured(3.1e-7, 4e-8, "1") == "(3.10 ± 0.40) × 10⁻⁷"


def test_what_no_record_can_hold_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        Row("row", 1.0, Reference(math.nan, "theory"), relative(0.1, "–"))
    with pytest.raises(ValueError, match="uncertainty"):
        Row("row", 1.0, TWO, relative(0.1, "–"), uncertainty=math.inf)


@pytest.fixture(scope="module")
def conducted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Record]:
    folder = tmp_path_factory.mktemp("study")
    return folder, conduct([PUNCH], folder, workers=1)


def test_a_study_runs_its_scenes_once_and_a_refusal_is_a_row_that_fails(
    conducted: tuple[Path, Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, record = conducted
    assert [(row.name, row.verdict) for row in record.rows] == [("force", "PASS"), ("refused", "FAIL")]
    assert record.rows[1].bound.source.startswith("refused before anything ran: ")
    assert (folder / "small.png").stat().st_size > 1000
    results = folder / "runs" / "small" / "punch" / "results.json"
    made = results.stat().st_mtime_ns
    monkeypatch.setattr(grains, "STUDIES", (PUNCH,))
    done = CliRunner().invoke(app, ["grains", "--out", str(folder)])
    assert (done.exit_code, results.stat().st_mtime_ns) == (1, made)
    assert "1 of 2 rows pass, 1 fail" in done.output
    again = read_record(folder / "record.json")
    assert [row.as_data() for row in again.rows] == [row.as_data() for row in record.rows]


def test_a_record_says_at_which_commit_it_was_measured_and_its_age_is_printed(conducted: tuple[Path, Record]) -> None:
    (answer,) = conducted[1].answers
    assert Measured(answer.date, answer.commit) == today()
    done = CliRunner().invoke(app, ["ages"])
    assert done.exit_code == 0
    for name in RECORDS:
        assert any(line.startswith(name) and line.endswith(" days ago") for line in done.output.splitlines())


def test_a_study_that_breaks_has_a_row_that_fails(tmp_path: Path) -> None:
    def broken(bench: Bench) -> Findings:
        raise RuntimeError("a study that does not end")

    (row,) = answered(Study("broken", "–", "–", broken), tmp_path, False).rows
    assert row.verdict == "FAIL"
    assert "a study that does not end" in row.name


def test_a_folder_of_other_things_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(doors.FolderError, match="not of a validation"):
        conduct([PUNCH], tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


def test_the_pages_are_what_the_records_of_all_studies_say() -> None:
    """Renew them with `python -m validation pages`."""
    paper, hard, speed = (read_record(RESULTS / f"{name}.json") for name in ("paper", "hard", "speed"))
    assert (ROOT / "VALIDATION.md").read_text(encoding="utf-8") == summary(paper, hard, speed)
    assert (RESULTS / "tables.md").read_text(encoding="utf-8") == tables_page([paper, hard])
    require_shown("docs/performance.md", "speed", speed_table(speed), exactly=True)
    for record, studies in ((paper, PAPER), (hard, HARD), (speed, SPEED)):
        assert [answer.name for answer in record.answers] == [study.name for study in studies]
    assert [row.name for row in [*paper.rows, *hard.rows] if row.verdict == "FAIL"] == []


def test_what_validates_knows_nothing_of_what_is_printed() -> None:
    """No module of validation imports the closed forms that users see."""
    for path in sorted((ROOT / "validation").rglob("*.py")):
        assert "analysis.theory" not in path.read_text(encoding="utf-8"), path


def test_speed_rows_are_ours_over_theirs() -> None:
    seconds = {"quasistatic": 1.0, "dynamic": 2.0, "plain": 200.0, "plain, tuned": 20.0, "scipy solver": 4.0}
    (row, *_) = plain.rows_of(1e-3, seconds, {"quasistatic": 1e-4, "dynamic": 1e-4})
    assert (row.value, row.verdict) == (pytest.approx(1.0 / 200.0), "PASS")
    assert overhead.over([2.0, 9.0, 4.0], [1.0, 3.0, 1.0]) == pytest.approx(3.0)
    assert scaling.spread([3.0, 6.0]) == pytest.approx(2.0)
    found = {"contact": "hertz", "setting": "any", "wall": 0.01, "errors": {"limit_force": 0.0, "limit_relative": 0.0}}
    solvers = {peers.OURS: 0.002, peers.ELEMENTS[0]: 1.0}
    compared = peers.rows_of([found | {"solver": solver, "seconds": time} for solver, time in solvers.items()])
    assert [row.value for row in compared] == pytest.approx([0.002, 0.002, 0.01])


def test_every_listed_fault_is_of_a_text_that_is_there_once() -> None:
    counts = {one["name"]: (ROOT / one["file"]).read_text(encoding="utf-8").count(one["old"]) for one in listed()}
    assert {name for name, count in counts.items() if count != 1} == set()


def test_a_mutant_is_one_change_of_what_a_function_does_not_of_what_it_draws() -> None:
    found = mutants("potentials/double_exponential.py")
    assert len({one.source for one in found}) > 10
    assert any(one.function == "DoubleExponential.derivative" for one in found)
    drawn = [one.text for one in mutants("workflow/report/animation.py")]
    assert drawn
    assert not [text for text in drawn if text.startswith("HEIGHT =")]
