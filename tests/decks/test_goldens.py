"""Whole decks of the shipped scenes, line by line.

After a wanted change write them anew and read the difference before you commit it:

    WRITE_GOLDENS=1 pytest tests/decks/test_goldens.py && git diff tests/decks/golden
"""

import os
import re
from pathlib import Path

import pytest

from tests.decks.written import written
from tests.scenes import ROOT

GOLDEN = Path(__file__).parent / "golden"
SCENES = sorted(path.stem for path in (ROOT / "lammps_inputs" / "scenes").glob("*.toml"))
NUMBER = re.compile(r"-?\d+\.\d+(?:e[+-]?\d+)?|-?\d+e[+-]?\d+")

SAME = 1e-9
"""Relative, of a number that is computed: numpy's exp differs in its last bits from one processor to another, and the
estimate behind a schedule bisects on it."""
ZERO = 1e-15
"""Of a displacement that is 0 but for round-off; scenes in SI have numbers of 1e-9."""


@pytest.mark.parametrize("name", SCENES)
def test_deck_of_a_shipped_scene(name: str) -> None:
    """All text and whole numbers are the same, other numbers to round-off."""
    text, path = written(ROOT / "lammps_inputs" / "scenes" / f"{name}.toml").text, GOLDEN / f"{name}.lammps"
    if os.environ.get("WRITE_GOLDENS"):
        path.write_text(text, encoding="utf-8")
    golden = path.read_text(encoding="utf-8")
    assert NUMBER.sub("…", text) == NUMBER.sub("…", golden)
    numbers, wanted = ([float(n) for n in NUMBER.findall(t)] for t in (text, golden))
    assert numbers == pytest.approx(wanted, rel=SAME, abs=ZERO)


def test_every_scene_has_a_golden_and_every_golden_a_scene() -> None:
    assert sorted(path.stem for path in GOLDEN.iterdir()) == SCENES
