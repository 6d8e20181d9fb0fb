"""Claim: the classes of hard cases that take seconds pass, but for the rows listed here, a list that only shrinks.

`contact1d stability` runs all of them; what it took when these were chosen is in the comments. A row that is listed and
passes makes its test fail as well: take it off the list.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from validation.hard.case import Class, Findings, at_most
from validation.hard.record import RECORD, Answer, Stability, stability_markdown
from validation.hard.suite import CLASSES, NAMES, earlier, measured, written
from validation.judging.check import Check

FAILS: dict[str, set[str]] = {}
"""Rows that fail since the program is wrong there, by class."""
QUICK = ("loads", "loops", "friction", "forces", "motion", "modes", "buckling")
"""Each some seconds."""


@pytest.mark.parametrize("name", QUICK)
def test_a_class_has_no_new_failure(name: str, tmp_path: Path) -> None:
    found = measured(name, tmp_path, full=False).found
    assert {check.name for check in found.checks if check.verdict == "FAIL"} == FAILS.get(name, set())
    assert (tmp_path / found.figure).is_file()


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if name not in QUICK])
def test_a_long_class_has_no_new_failure(name: str, tmp_path: Path) -> None:
    found = measured(name, tmp_path, full=False).found
    assert {check.name for check in found.checks if check.verdict == "FAIL"} == FAILS.get(name, set())


def test_a_row_without_a_number_fails_and_stays_in_the_table() -> None:
    rows = [at_most("kind", "lost", float("nan"), 1.0, "theory", "–"), at_most("kind", "half", 0.5, 1.0, "theory", "–")]
    asked = Class("kind", "A kind", "What for?", lambda bench, folder: Findings(rows, "", ""))
    record = Stability((Answer(asked, Findings(rows, "", ""), 1.0, "quick", "2007-01-01"),), "a machine", {}, 1.0)
    assert [check.name for check in record.failed] == ["lost"]
    assert '"margin": 2.0' in record.to_json()
    page = stability_markdown(record.document(), "docs/", ["kind", "other"])
    assert "Not measured for this record: `other`." in page
    assert "| lost | no number |" in page
    assert "**1 of 2 rows pass.**" in page


def test_a_class_that_is_measured_later_joins_the_record(tmp_path: Path) -> None:
    first, second = (
        Answer(
            asked,
            Findings([at_most(asked.name, "half", 0.5, 1.0, "theory", "–")], "", "what"),
            2.0,
            "full",
            "2007-01-01",
        )
        for asked in CLASSES[:2]
    )
    written(tmp_path, {second.asked.name: second}, 2.0)
    kept = earlier(tmp_path)
    assert kept == {second.asked.name: second}
    record = written(tmp_path, kept | {first.asked.name: first}, 4.0)
    assert [check.study for check in record.checks] == [first.asked.name, second.asked.name]
    (tmp_path / RECORD).write_text((tmp_path / RECORD).read_text().replace("numpy", "numbers"))
    assert earlier(tmp_path) == {}  # of other versions


@pytest.mark.parametrize(
    ("comparison", "value", "expected"), [("relative", 1.1, 2.0), ("absolute", 1.05, 4.0), ("at most", 0.25, 4.0)]
)
def test_the_margin_is_what_is_allowed_over_what_is_found(comparison: str, value: float, expected: float) -> None:
    row = Check("kind", "row", value, 0.0, "1", 1.0, "theory", "closed form", 0.2, "–", comparison)
    assert row.margin == pytest.approx(expected)
