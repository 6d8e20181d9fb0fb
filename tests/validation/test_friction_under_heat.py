"""Claim: ⟨F⟩(T, v) of one particle on a row is that of Smoluchowski's equation, and of an ensemble for fast drives.

The references share no code with the program: a free energy by quadrature and a density in finite volumes, and a
vectorised integrator of other form (BAOAB) than LAMMPS's.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contact1d import Run, Scene, read_scene, run, run_many
from contact1d.workflow.runs.processors import pool
from tests.kept_runs import KeptBench
from validation.paper import heat

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
SIGMAS = 4.0
"""Standard errors of run and reference: one test in 16 000 would fail by chance, and the seeds are fixed."""
TELLS = 3.0
"""What heat takes from the friction, over the run's error: one that could not tell it from none is no test."""


@pytest.fixture(scope="module")
def paper() -> Scene:
    return read_scene(SCENES / "paper.toml")


@pytest.mark.parametrize(
    ("share", "velocity", "distance"), [pytest.param(0.15, 2e-2, 30.0, marks=pytest.mark.slow), (0.05, 2e-3, 6.0)]
)
def test_the_friction_under_heat_is_that_of_its_reference(
    share: float, velocity: float, distance: float, tmp_path: Path
) -> None:
    found = run(heat.scene(share, velocity, distance, seed=7), tmp_path / "run", figures=False).results["mean_friction"]
    mean, error = heat.expected(share, velocity)
    sigma = (found.uncertainty**2 / heat.INTERVAL**2 + error**2) ** 0.5
    assert found.value == pytest.approx(mean, abs=SIGMAS * sigma)
    assert found.uncertainty < 0.5 * mean


@pytest.mark.slow
def test_three_decades_of_velocity_at_two_temperatures(paper: Scene, tmp_path: Path) -> None:
    scenes = heat.scenes(paper)
    with pool(2) as executor:
        runs = run_many([(scene, tmp_path / name) for name, scene in scenes.items()], executor)
    done = {name: one for name, one in zip(scenes, runs, strict=True) if isinstance(one, Run)}
    bench: Any = KeptBench(done, paper)
    rows = heat.judge(bench).rows
    assert [row.name for row in rows if row.verdict != "PASS"] == []
    coldest, slowest = min(heat.SHARES), min(heat.DRIVES)
    still = heat.slow_friction(heat.WELLS, heat.SPRING)
    found = done[heat.run_name(coldest, slowest)].results["mean_friction"]
    assert still - found.value > TELLS * found.uncertainty / heat.INTERVAL
