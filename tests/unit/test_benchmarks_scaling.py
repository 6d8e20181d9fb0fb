"""What of validation/speed/scaling.py can be said without a clock: its scenes, its counts and its verdict."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.deck.lattice import places
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.settings.settings import settings_for
from validation.speed.scaling import ROWS, missed, scaled_scene, spread, steps_of

ROUND_OFF = 1e-12


@pytest.mark.parametrize("method", ["dynamic", "quasistatic"])
def test_bodies_of_every_size_have_the_same_heights_along_the_chain(method: str) -> None:
    share = np.linspace(0.0, 1.0, 9)
    small, large = (scaled_scene(count, method).bodies for count in (200, 1_000_000))
    half = [places(body.particles, body.spacing)[-1] + 0.5 for body in (small, large)]
    assert large.height(half[1] * share) == pytest.approx(small.height(half[0] * share), rel=ROUND_OFF)


@pytest.mark.parametrize("method", ["dynamic", "quasistatic"])
def test_no_row_comes_in_between(method: str) -> None:
    """So the number of rows is what ROWS says, there and back, and the first."""
    for count, rows in ROWS.items():
        scene = scaled_scene(count, method)
        assert len(scene.experiment.places()) == 2 * rows + 1
        assert max(scene.experiment.places()) < settings_for(scene).longest_move


def test_steps_are_what_lammps_says(tmp_path: Path) -> None:
    """Force evaluations of the log; time steps of the timing."""
    (tmp_path / "log.lammps").write_text(
        "  Iterations, force evaluations = 3 42\nLoop time\n  Iterations, force evaluations = 2 33\n"
    )
    assert steps_of(tmp_path, {"method": "quasistatic", "timing": {"steps": 5}}) == 75
    assert steps_of(tmp_path, {"method": "dynamic", "timing": {"steps": 5}}) == 5


def test_a_real_log_is_counted(tmp_path: Path) -> None:
    finished = run(scaled_scene(20, "quasistatic"), tmp_path / "run", figures=False)
    assert steps_of(finished.folder, finished.document) > finished.document["timing"]["steps"] > 0


def sized(cost: float, memory: float, method: str = "dynamic") -> dict[str, Any]:
    half = memory / 2
    names = ("method", "particles_per_body", "ns_per_particle_step", "python_bytes", "lammps_bytes")
    return dict(zip(names, (method, 200, cost, half, half), strict=True))


def test_the_verdict() -> None:
    """Wall times, the spread of each method by itself, and the memory of both processes together."""
    quick = {"run": "quick", "wall_s": 0.04, "asked_s": 0.05}
    slow = {"run": "slow", "wall_s": 0.06, "asked_s": 0.05}
    free = {"run": "free", "wall_s": 9.0, "asked_s": None}
    even = [sized(50.0, 1e9), sized(99.0, 7.9e9), sized(500.0, 1e9, "quasistatic")]
    assert spread(even[:2]) == 1.98
    assert missed([quick, free], even) == []
    found = missed([slow], [*even, sized(101.0, 8.1e9)])
    assert [words.split(":")[0] for words in found] == ["slow", "dynamic", "dynamic, N = 200"]


def test_one_size_in_a_process_of_its_own() -> None:
    """The command's record of a small size; every cost is there and positive."""
    import subprocess
    import sys

    script = Path(__file__).parents[2] / "benchmarks" / "scaling.py"
    done = subprocess.run(
        [sys.executable, str(script), "--one", "40", "quasistatic"], check=True, capture_output=True, text=True
    )
    row = json.loads(done.stdout)
    assert row["particles_per_body"] == 40
    assert all(row[key] > 0 for key in row if key.endswith(("cpu_s", "bytes", "step", "steps")) and "other" not in key)
