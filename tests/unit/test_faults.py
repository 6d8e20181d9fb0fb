"""Claim: every fault that once passed all tests can still be put back: the text that it changes is there, once."""

from __future__ import annotations

from pathlib import Path

import pytest

from validation.tools.faults import FAULTS, Fault

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_a_fault_is_of_a_text_that_is_there_once(fault: Fault) -> None:
    assert (ROOT / fault.file).read_text(encoding="utf-8").count(fault.old) == 1
    assert fault.new != fault.old
    files = [word for word in fault.tests.split() if word.endswith(".py")]
    assert files
    assert all((ROOT / name).is_file() for name in files)
