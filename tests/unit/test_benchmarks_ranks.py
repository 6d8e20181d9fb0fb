"""The table of ranks in docs/performance.md is made from validation/speed/results, so that neither can drift."""

from __future__ import annotations

import json

from validation.speed.pages import between
from validation.speed.ranks import PAGE, RESULTS, markdown

SAME = 1e-10
"""Relative: sums in another order."""


def test_the_table_of_the_page_is_what_the_results_say() -> None:
    """Renew it with `python -m validation.speed.ranks`."""
    rows = json.loads(RESULTS.read_text(encoding="utf-8"))["rows"]
    assert between(PAGE, "ranks")[1] == markdown(rows)
    assert all(row["force_difference"] < SAME for row in rows)
