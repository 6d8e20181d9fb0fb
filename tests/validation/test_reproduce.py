"""Every row of the reproduction passes; the quick studies each time, all of them with -m slow."""

from __future__ import annotations

from pathlib import Path

import pytest

from contact1d.workflow.reproduce.studies import NAMES, reproduce

QUICK = ("eq3", "fig4", "exponents", "table1", "mean_pressure", "tangential")


def failed(folder: Path, names: tuple[str, ...]) -> list[str]:
    record = reproduce(folder, names)
    assert tuple(study.name for study in record.studies) == names
    assert all(study.checks for study in record.studies)
    return [f"{check.study}: {check.name}" for check in record.checks if check.verdict == "FAIL"]


def test_the_quick_studies_pass(tmp_path: Path) -> None:
    assert failed(tmp_path, QUICK) == []


@pytest.mark.slow
def test_all_studies_pass(tmp_path: Path) -> None:
    assert failed(tmp_path, NAMES) == []
