"""The same sweep by processes here and by jobs of a real Slurm: one table."""

import csv
import getpass
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from contact1d import Contact1dError, sweep
from tests.slurm import slurm
from tests.sweeps import FORCE, plane

pytestmark = pytest.mark.cluster
POINTS, MANY = 12, 105
"""Of one job, and of two: the second has five."""
TABLE = "results.csv"
SWEEP = plane({"key": FORCE, "from": 0.1, "to": 900.0, "steps": POINTS - 1})
FINE: dict[str, Any] = {"particles": "auto", "spacing": 0.005}
"""Bodies of runs that take long enough for a job to be cancelled between two."""
PATIENCE = 120.0


@pytest.fixture
def in_slurm(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, str]]:
    with slurm(tmp_path / "slurm") as environment:
        for name in ("PATH", "SLURM_CONF"):
            monkeypatch.setenv(name, environment[name])
        yield environment


def test_a_partition_that_is_not_there_is_told_before_anything_is_written(
    tmp_path: Path, in_slurm: dict[str, str]
) -> None:
    with pytest.raises(Contact1dError, match="no partition 'night': take local"):
        sweep(SWEEP, tmp_path / "there", "slurm", figures=False, partition="night")
    assert not (tmp_path / "there").exists()


def test_points_of_a_job_that_was_cancelled_are_missing_and_run_next_time(
    tmp_path: Path, in_slurm: dict[str, str], monkeypatch: pytest.MonkeyPatch
) -> None:
    source = SWEEP | {"base": SWEEP["base"] | {"bodies": SWEEP["base"]["bodies"] | FINE}}
    folder = tmp_path / "there"

    def cancel() -> None:
        until = time.monotonic() + PATIENCE
        while not list(folder.glob("runs/*/results.json")) and time.monotonic() < until:
            time.sleep(0.05)
        subprocess.run(["scancel", "--state=RUNNING", "--user", getpass.getuser()], env=in_slurm, check=True)

    cancelling = threading.Thread(target=cancel)
    cancelling.start()
    first = sweep(source, folder, "slurm", figures=False)  # all points in one job
    cancelling.join()
    assert first.counts["done"] + first.counts["missing"] == POINTS
    with (folder / TABLE).open(newline="") as file:
        reasons = {row["reason"] for row in csv.DictReader(file) if row["status"] == "missing"}
    assert all(reason.startswith("its job ended before it ran") for reason in reasons)
    stamps = {path: path.stat().st_mtime_ns for path in folder.glob("runs/*/results.json")}
    assert sweep(source, folder, "slurm", figures=False).counts == {"done": POINTS}
    assert all(path.stat().st_mtime_ns == stamp for path, stamp in stamps.items())


def test_a_sweep_through_slurm_has_the_table_of_one_here(tmp_path: Path, in_slurm: dict[str, str]) -> None:
    many = SWEEP | {"axes": [SWEEP["axes"][0] | {"steps": MANY - 1}]}
    there = sweep(many, tmp_path / "there", "slurm", figures=False)
    here = sweep(many, tmp_path / "here", "local", workers=1, figures=False)
    assert there.counts == here.counts
    assert set(here.counts) == {"done", "failed"}
    assert (tmp_path / "there" / TABLE).read_text() == (tmp_path / "here" / TABLE).read_text()
