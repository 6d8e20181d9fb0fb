"""The same sweep by processes here and by jobs of a real Slurm: one table."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contact1d import sweep
from contact1d.workflow.sweep import executors
from contact1d.workflow.sweep.table import TABLE
from tests.slurm import slurm

POINTS = 12
JOB = 5
"""Points of a job here: three jobs, the last of two points."""
SWEEP: dict[str, Any] = {
    "title": "a sweep",
    "base": {
        "title": "on a plane",
        "bodies": {
            "particles": 41, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 1.0,
            "lower": "rigid_plane",
        },
        "experiment": {"kind": "load", "force": 1.0},
    },
    "axes": [{"key": "experiment.force", "from": 0.1, "to": 900.0, "steps": POINTS - 1}],
}  # fmt: skip


@pytest.mark.cluster
def test_a_sweep_through_slurm_has_the_table_of_one_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "JOB_POINTS", JOB)
    with slurm(tmp_path / "slurm") as environment:
        for name in ("PATH", "SLURM_CONF"):
            monkeypatch.setenv(name, environment[name])
        there = sweep(SWEEP, tmp_path / "there", "slurm", figures=False)
    here = sweep(SWEEP, tmp_path / "here", "local", workers=1, figures=False)
    assert there.counts == here.counts
    assert set(here.counts) == {"done", "failed"}
    assert (tmp_path / "there" / TABLE).read_text() == (tmp_path / "here" / TABLE).read_text()
