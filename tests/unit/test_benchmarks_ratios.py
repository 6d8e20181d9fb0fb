"""The table of ratios of docs/performance.md is made from validation/speed/results, so that neither can drift."""

from __future__ import annotations

import copy
import os
from pathlib import Path

import pytest

from validation.speed.pages import between, write_between
from validation.speed.ratios import HEAD, PAGE, markdown, read_results

MOST_ROWS = 16


def test_the_table_of_the_page_is_what_the_results_say() -> None:
    """Renew it with `python -m validation.speed.ratios`, or with WRITE_DOCS=1 pytest this file."""
    made = markdown(read_results())
    if os.environ.get("WRITE_DOCS"):
        write_between(PAGE, "ratios", made)
    assert between(PAGE, "ratios")[1] == made


def test_the_table_is_short_and_every_row_says_by_which_command() -> None:
    rows = [line.strip("| ").split(" | ") for line in markdown(read_results()).splitlines()]
    assert tuple(rows[0]) == HEAD
    assert len(rows) - 2 <= MOST_ROWS
    assert all(len(row) == len(HEAD) and "`python " in row[-1] for row in rows[2:])


def test_a_figure_that_is_not_reached_says_so() -> None:
    results = copy.deepcopy(read_results())
    for row in results["scaling"]["outside_lammps"]:
        row["wall_s"] = 1e-3
    results["deck_overhead"]["rows"][0]["ratio"] = 1.0
    good = markdown(results)
    results["scaling"]["outside_lammps"][0]["wall_s"] = 9.0
    results["deck_overhead"]["rows"][0]["ratio"] = 1.2
    bad = markdown(results)
    assert bad.count("not reached") == good.count("not reached") + 2
    assert "1.200, 5 scenes: **not reached**" in bad


def test_a_new_way_gets_a_row() -> None:
    results = copy.deepcopy(read_results())
    results["plain"]["rows"].append({"way": "newest", "tolerance": 0.1, "cpu_s": 1.0, "plain_over_it": 77.0})
    assert "plain way over `newest` | – | 77 (tolerance 0.1) |" in markdown(results)


def test_a_text_goes_between_its_markers(tmp_path: Path) -> None:
    page = tmp_path / "README.md"
    page.write_text("before\n<!-- a: begin -->\nold\n<!-- a: end -->\nafter\n")
    write_between(page, "a", "new\n")
    assert page.read_text() == "before\n<!-- a: begin -->\nnew\n<!-- a: end -->\nafter\n"


def test_a_page_without_markers_is_refused(tmp_path: Path) -> None:
    page = tmp_path / "README.md"
    page.write_text("<!-- other: begin -->\n<!-- other: end -->\n")
    with pytest.raises(ValueError, match="no markers"):
        write_between(page, "table", "table")
