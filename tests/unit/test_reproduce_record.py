"""The record of a reproduction: verdicts, numbers in words, and what a row refuses."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from tests.checks import BOUND, FORCE, record
from validation.judging.check import Check, Comparison, Verdict
from validation.judging.words import duration, measured, number, printed, ratio, share, tolerance
from validation.paper.record import RECORD, read_record


@pytest.mark.parametrize(
    ("comparison", "value", "verdict"),
    [
        ("relative", 2.2, "PASS"),
        ("relative", 2.3, "FAIL"),
        ("relative", 1.7, "FAIL"),
        ("absolute", 2.1, "PASS"),
        ("absolute", 2.2, "FAIL"),
        ("at most", -7.0, "PASS"),
        ("at most", 2.0, "PASS"),
        ("at most", 2.01, "FAIL"),
        ("uncertainty", 2.4, "PASS"),
        ("uncertainty", 2.6, "FAIL"),
        ("relative", math.nan, "FAIL"),
        ("absolute", math.nan, "FAIL"),
        ("at most", math.nan, "FAIL"),
        ("uncertainty", math.nan, "FAIL"),
    ],
)
def test_each_comparison_has_its_own_verdict(comparison: Comparison, value: float, verdict: Verdict) -> None:
    allowed = 0.0 if comparison == "uncertainty" else 0.125
    check = replace(FORCE, value=value, uncertainty=0.5, reference=2.0, tolerance=allowed, comparison=comparison)
    assert check.verdict == verdict


def test_a_record_comes_back_from_its_file_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / RECORD
    path.write_text(record().to_json(), encoding="utf-8")
    again = read_record(path)
    assert again.to_json() == record().to_json()
    assert again.studies[1] == record().studies[1]
    assert again.checks[0] == FORCE
    assert math.isnan(again.checks[1].value)
    assert [check.verdict for check in again.checks] == ["PASS", "FAIL", "FAIL", "DIFFERS", "PASS"]


def test_a_number_that_is_none_is_null_in_the_file_and_fails() -> None:
    document = json.loads(record().to_json())
    assert document["rows"][1]["ours"] == {"value": None, "uncertainty": None, "unit": "LU"}
    assert document["rows"][1]["ratio"] is None
    assert document["verdicts"] == {
        "judged": {"PASS": 1, "FAIL": 2, "DIFFERS": 1}, "repeats": {"PASS": 1}, "by construction": {}
    }  # fmt: skip


@pytest.mark.parametrize(
    ("value", "uncertainty", "unit", "text"),
    [
        (1.48341, 0.00012, "FU", "1.48341 ± 0.00012 FU"),
        (0.00031, 0.00002, "1", "(3.10 ± 0.20) × 10⁻⁴"),
        (-0.5, 0.02, "1", "−0.500 ± 0.020"),
        (12345.0, 120.0, "LU", "(1.234 ± 0.012) × 10⁴ LU"),
        (12.0, 0.0, "LU", "12 LU"),
        (math.nan, 0.1, "LU", "no number"),
    ],
)
def test_a_value_has_the_places_of_its_uncertainty(value: float, uncertainty: float, unit: str, text: str) -> None:
    assert measured(value, uncertainty, unit) == text


def test_numbers_are_written_for_people() -> None:
    assert [number(x) for x in (1000.0, -0.25, 4e-7, 1.23e9)] == ["1000", "−0.25", "4 × 10⁻⁷", "1.23 × 10⁹"]
    assert [share(x) for x in (0.0, 0.009, 4e-6, 0.996, 1.5)] == ["0 %", "0.9 %", "4 × 10⁻⁶", "99.6 %", "150 %"]
    assert [duration(x) for x in (4.21, 61.0, 7500.0)] == ["4.2 s", "1 min", "2 h 5 min"]
    assert (printed(FORCE), printed(BOUND)) == ("1.47 FU", "–")


@pytest.mark.parametrize(
    ("check", "words"),
    [
        (FORCE, "within 1.5 %"),
        (replace(FORCE, tolerance=0.0125), "within 1.25 %"),
        (replace(FORCE, tolerance=4e-6), "within 4 × 10⁻⁶"),
        (replace(FORCE, tolerance=0.02, comparison="absolute"), "within 0.02 FU"),
        (BOUND, "at most 0.08"),
        (replace(FORCE, comparison="uncertainty", tolerance=0.0), "within the uncertainty"),
        (replace(FORCE, comparison="uncertainty"), "within the uncertainty, itself at most 1.5 %"),
    ],
)
def test_a_tolerance_is_said_in_words(check: Check, words: str) -> None:
    assert tolerance(check) == words


def test_a_ratio_shows_how_far_from_one_it_is() -> None:
    values = (1.0091, 0.9999968, 1.0, 2.5, math.nan)
    assert [ratio(replace(FORCE, value=v, reference=1.0)) for v in values] == ["1.0091", "0.9999968", "1", "2.5", "–"]
    assert ratio(replace(FORCE, reference=0.0)) == "–"


def test_a_row_refuses_what_no_record_can_hold() -> None:
    with pytest.raises(ValueError, match="reference must be finite"):
        replace(FORCE, reference=math.inf)
    with pytest.raises(ValueError, match="needs an uncertainty"):
        replace(FORCE, uncertainty=math.nan)
    assert replace(BOUND, value=-math.inf).verdict == "FAIL"
