"""The tutorial runs as it stands, with what it asserts of Hertz and of the paper's √R."""

from __future__ import annotations

import runpy
from pathlib import Path

from contact1d import Run

TUTORIAL = Path(__file__).parents[2] / "docs" / "tutorial.py"


def test_the_tutorial_runs_from_hertz_to_a_sweep() -> None:
    names = runpy.run_path(str(TUTORIAL))
    assert isinstance(names["hertz"], Run)
    assert names["sweep"].counts == {"done": 4}
