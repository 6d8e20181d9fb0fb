"""Claim: a row's verdict follows from its rule, and a row that is known to differ has a bound, too."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from validation.page import limits, measured, outcome
from validation.row import Bound, Known, Reference, Row, absolute, at_most, claim, relative

TWO = Reference(2.0, "theory")


@pytest.mark.parametrize(
    ("row", "verdict"),
    [
        (Row("relative", 2.19, TWO, relative(0.1, "lattice")), "PASS"),
        (Row("relative", 2.21, TWO, relative(0.1, "lattice")), "FAIL"),
        (Row("absolute", 1.89, TWO, absolute(0.1, "lattice")), "FAIL"),
        (Row("claim", 2.1, TWO, claim("run"), uncertainty=0.11), "PASS"),
        (Row("claim", 2.1, TWO, claim("run"), uncertainty=0.09), "FAIL"),
        (Row("claim that is too wide", 2.1, TWO, claim("run", 0.01), uncertainty=0.11), "FAIL"),
        (at_most("bound", 1.0, 1.0, "theory"), "PASS"),
        (at_most("bound", 1.01, 1.0, "theory"), "FAIL"),
        (Row("at least", 2.1, TWO, Bound("at least", 0.0, "–")), "PASS"),
        (Row("not at least", 1.9, TWO, Bound("at least", 0.0, "–")), "FAIL"),
        (at_most("no number", math.nan, 1.0, "theory"), "FAIL"),
        (Row("not answered", 2.0, TWO, relative(0.1, "–"), warnings={"lattice": ""}), "FAIL"),
        (Row("answered", 2.0, TWO, relative(0.1, "–"), warnings={"lattice": "since"}), "PASS"),
    ],
    ids=lambda value: value if isinstance(value, str) else value.name,
)
def test_a_row_passes_where_its_rule_holds(row: Row, verdict: str) -> None:
    assert row.verdict == verdict
    assert Row.of(row.as_data()).verdict == verdict


@pytest.mark.parametrize(("value", "verdict"), [(3.0, "DIFFERS"), (3.2, "FAIL"), (1e9, "FAIL"), (2.05, "FAIL")])
def test_a_row_that_differs_does_so_by_what_is_known(value: float, verdict: str) -> None:
    row = Row("a_cr/a_0", value, TWO, relative(0.1, "model"), known=Known(3.0, 0.1, "first record"))
    assert row.verdict == verdict
    assert "known to be 3" in limits(row)


def test_rows_are_counted_apart_from_their_repeats() -> None:
    row = at_most("half", 0.5, 1.0, "theory")
    assert row.margin == pytest.approx(2.0)
    again = replace(row, standing="repeats")
    assert outcome([row, again, replace(row, value=2.0)]) == "1 of 2 rows pass; counted separately: 1 repeat another"


@pytest.mark.parametrize(
    ("number", "text"),
    [((1.48341, 0.00012, "FU"), "1.48341 ± 0.00012 FU"), ((3.1e-7, 4e-8, "1"), "(3.1 ± 0.4) × 10⁻⁷")],
)
def test_numbers_are_written_for_people(number: tuple[float, float, str], text: str) -> None:
    assert measured(*number) == text.replace("0.4)", "0.40)").replace("(3.1 ", "(3.10 ") if "10⁻⁷" in text else text


def test_what_no_record_can_hold_is_refused() -> None:
    with pytest.raises(ValueError, match="finite"):
        Row("row", 1.0, Reference(math.nan, "theory"), relative(0.1, "–"))
    with pytest.raises(ValueError, match="uncertainty"):
        Row("row", 1.0, TWO, relative(0.1, "–"), uncertainty=math.inf)
