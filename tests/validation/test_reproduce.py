"""Every row of the reproduction passes; the quick studies each time, all of them with -m slow."""

from __future__ import annotations

from pathlib import Path

import pytest

from contact1d import FolderError
from contact1d.workflow.runs.campaign import alone
from validation.paper.studies import NAMES, reproduce

QUICK = ("eq3", "fig4", "exponents", "table1", "mean_pressure", "tangential")


def failed(folder: Path, names: tuple[str, ...]) -> list[str]:
    record = reproduce(folder, names)
    assert tuple(study.name for study in record.studies) == names
    assert all(study.checks for study in record.studies)
    return [f"{check.study}: {check.name}" for check in record.checks if check.verdict == "FAIL"]


def test_the_quick_studies_pass(tmp_path: Path) -> None:
    assert failed(tmp_path, QUICK) == []


def test_a_second_reproduction_at_work_in_a_folder_is_refused_and_leaves_it(tmp_path: Path) -> None:
    with alone(tmp_path), pytest.raises(FolderError, match="a reproduction is at work in"):
        reproduce(tmp_path, QUICK[:1])
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_other_things_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(FolderError, match="not of a reproduction"):
        reproduce(tmp_path, QUICK[:1])
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]


@pytest.mark.slow
def test_all_studies_pass(tmp_path: Path) -> None:
    assert failed(tmp_path, NAMES) == []
