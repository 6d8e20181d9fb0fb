"""Claim: every listed fault can still be put back: the text that it changes is there, once."""

from __future__ import annotations

from pathlib import Path

import pytest

from validation.tools.faults import listed
from validation.tools.mutants import mutants

ROOT = Path(__file__).parents[2]


EACH = [pytest.param(one, id=one["name"]) for one in listed()]


@pytest.mark.parametrize("fault", EACH)
def test_a_fault_is_of_a_text_that_is_there_once(fault: dict[str, str]) -> None:
    assert (ROOT / fault["file"]).read_text(encoding="utf-8").count(fault["old"]) == 1


def test_a_mutant_is_one_change_of_a_function() -> None:
    found = mutants("potentials/double_exponential.py")
    assert len({one.source for one in found}) > 10
    assert any(one.function == "DoubleExponential.derivative" for one in found)


def test_of_drawings_and_messages_only_what_they_show_is_drawn() -> None:
    """Sizes and digits are left, numbers stay."""
    drawn = [one.text for file in ("workflow/report/animation.py", "analysis/figures.py") for one in mutants(file)]
    assert not [text for text in drawn if text.startswith("HEIGHT =")]
    assert [text for text in drawn if text.startswith("carrying = np.abs(p) > 0.01")]
    assert [text for text in drawn if "4.0 * a**3" in text]
    spacings = [one for one in mutants("workflow/experiments/spacing.py") if "digits_apart" in one.text]
    assert not spacings
