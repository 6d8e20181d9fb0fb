"""VALIDATION.md and the README's table are made from the records in docs, so that neither can drift.

Renew all of it with `make validation`, `contact1d stability --full` and `WRITE_DOCS=1 make test ARGS='-m slow'`, or the
texts alone with WRITE_DOCS=1 pytest tests/unit/test_validation_page.py.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from tests.records import slow_markdown
from validation.hard.record import RECORD, stability_markdown
from validation.hard.suite import NAMES as CLASSES
from validation.paper.markdown import readme_table, validation_markdown
from validation.paper.record import Record, read_record
from validation.paper.studies import NAMES

ROOT = Path(__file__).parents[2]
KEPT, HARD = ROOT / "docs" / "reproduced", ROOT / "docs" / "stability"
BEGIN, END = "<!-- reproduced: begin -->\n", "<!-- reproduced: end -->\n"


def record() -> Record:
    return read_record(KEPT / "reproduce.json")


def hard_cases() -> dict[str, Any]:
    found: dict[str, Any] = json.loads((HARD / RECORD).read_text(encoding="utf-8"))
    return found


def test_validation_md_is_what_the_records_say() -> None:
    page = ROOT / "VALIDATION.md"
    text = validation_markdown(record(), stability_markdown(hard_cases(), "docs/stability/", CLASSES), slow_markdown())
    if os.environ.get("WRITE_DOCS"):
        page.write_text(text, encoding="utf-8")
    assert page.read_text(encoding="utf-8") == text


def test_every_class_of_the_record_of_hard_cases_has_rows_and_its_figure() -> None:
    found = hard_cases()
    names = [one["name"] for one in found["classes"]]
    assert names == [name for name in CLASSES if name in names]
    for one in found["classes"]:
        assert (HARD / one["figure"]).is_file(), one["figure"]
        assert any(row["study"] == one["name"] for row in found["rows"])


def test_the_table_of_the_readme_is_what_the_record_says() -> None:
    readme = ROOT / "README.md"
    text = readme.read_text(encoding="utf-8")
    before, begin, rest = text.partition(BEGIN)
    kept, end, after = rest.partition(END)
    if os.environ.get("WRITE_DOCS"):
        kept = readme_table(record())
        readme.write_text(before + begin + kept + end + after, encoding="utf-8")
    assert kept == readme_table(record())


def test_the_record_has_every_study_and_its_figures() -> None:
    assert tuple(study.name for study in record().studies) == NAMES
    for study in record().studies:
        for figure in study.figures:
            assert (KEPT / figure).is_file(), figure
