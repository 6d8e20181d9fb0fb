"""What settings use up of a tolerance is what the kept study says, and nothing else."""

from tests.scenes import ROOT, read_json
from validation.tools.calibration import (
    LADDERS,
    SCENES,
    TARGETS,
    TOGETHER,
    chosen_values,
    read_rows,
)

FILE = ROOT / "workflow" / "model" / "calibration.json"


def test_the_file_in_use_follows_from_a_study_of_every_share_at_every_tolerance() -> None:
    """Renew both with `python -m validation.tools.calibration`; never by hand."""
    rows, kept = read_rows(), read_json(FILE)
    assert kept == chosen_values(rows)
    assert kept["values"].keys() == LADDERS.keys()
    assert {row.scene for row in rows} == set(SCENES)
    for share, ladder in LADDERS.items():
        mine = [row for row in rows if row.share == share]
        assert {row.value for row in mine} == set(ladder)
        assert {row.tolerance for row in mine} == set(TARGETS)


def test_all_shares_together_keep_the_tolerance_in_every_scene() -> None:
    together = [row for row in read_rows() if row.share == TOGETHER]
    assert len(together) == len(TARGETS) * len(SCENES)
    assert max(row.error for row in together) <= 1.0
