"""VALIDATION.md and the README's table are made from docs/reproduced/reproduce.json, so that neither can drift.

Renew all of it with `make validation`, or the texts alone with WRITE_DOCS=1 pytest tests/unit/test_validation_page.py.
"""

from __future__ import annotations

import os
from pathlib import Path

from contact1d.workflow.reproduce.markdown import readme_table, validation_markdown
from contact1d.workflow.reproduce.record import Record, read_record
from contact1d.workflow.reproduce.studies import NAMES

ROOT = Path(__file__).parents[2]
KEPT = ROOT / "docs" / "reproduced"
BEGIN, END = "<!-- reproduced: begin -->\n", "<!-- reproduced: end -->\n"


def record() -> Record:
    return read_record(KEPT / "reproduce.json")


def test_validation_md_is_what_the_record_says() -> None:
    page = ROOT / "VALIDATION.md"
    if os.environ.get("WRITE_DOCS"):
        page.write_text(validation_markdown(record()), encoding="utf-8")
    assert page.read_text(encoding="utf-8") == validation_markdown(record())


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
