"""Claim: under heat a contact lets go at the tension that Smoluchowski's equation says, and later if pulled faster.

Nine pairs too far apart to feel each other: the free energy of the plate is nine times that of a pair, by quadrature;
its density is followed in time as the load grows.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, read_scene, run, run_many
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.runs.processors import pool
from tests.kept_runs import KeptBench
from validation.paper import detachment
from validation.references.detachment import detachment as quasi_stationary
from validation.references.detachment import detachment_in_time, drag_of_pairs

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
REPEATS = 16
SIGMAS = 4.0
"""Standard errors: one test in 16 000 would fail by chance, and the seeds are fixed."""
ADIABATIC = 0.01
"""Relative: what a rate per time at every load leaves out where the load is slow."""


@pytest.mark.parametrize("rate", [pytest.param(3e-4, marks=pytest.mark.slow), 1e-3])
def test_the_detachment_force_is_that_of_smoluchowskis_equation(rate: float, tmp_path: Path) -> None:
    found = run(detachment.scene(rate, REPEATS), tmp_path / "run", figures=False)
    mean, spread = detachment.expected(rate)
    results, forces = found.results, found.detachments["force"]
    assert results["detachment_force"].value == pytest.approx(mean, abs=SIGMAS * spread / np.sqrt(REPEATS))
    assert results["detachment_force_spread"].value == pytest.approx(spread, rel=SIGMAS / np.sqrt(2 * REPEATS))
    assert results["detachment_force"].value == pytest.approx(forces.mean())
    assert results["detachment_force"].uncertainty == pytest.approx(spread / np.sqrt(REPEATS), rel=1.0)
    assert len(set(forces.tolist())) > REPEATS // 2
    samples, held = found.tables["samples"], found.profiles["last_held"]
    last = np.flatnonzero(-samples["load"] < forces[0])[-1]
    assert found.scene.bodies.spacing * held.pressure.sum() == pytest.approx(samples["force"][last])
    assert (
        samples["displacement"][last]
        > settings_for(found.scene).law.parted(detachment.LET_GO)
        > samples["displacement"][last + 1]
    )


def test_followed_in_time_slow_pulls_are_those_of_a_rate_at_every_load() -> None:
    d, energy = detachment.free_energy()
    strongest, _ = detachment.largest()
    drag = detachment.PAIRS * detachment.DRAG
    mean, spread = quasi_stationary(d, energy, drag, detachment.TEMPERATURE, 3e-5, strongest)
    assert detachment.expected(3e-5)[0] == pytest.approx(mean, rel=ADIABATIC)
    assert detachment.expected(3e-5)[1] == pytest.approx(spread, rel=5.0 * ADIABATIC)


def test_a_faster_pull_is_held_longer() -> None:
    means = [detachment.expected(rate)[0] for rate in (1e-5, 1e-4, 1e-3)]
    assert means == sorted(means)


@pytest.mark.slow
def test_three_decades_of_the_loading_rate(tmp_path: Path) -> None:
    paper = read_scene(SCENES / "paper.toml")
    scenes = detachment.scenes(paper)
    with pool(2) as executor:
        runs = run_many([(scene, tmp_path / name) for name, scene in scenes.items()], executor)
    done = {name: one for name, one in zip(scenes, runs, strict=True) if isinstance(one, Run)}
    bench: Any = KeptBench(done, paper)
    rows = detachment.judge(bench).rows
    assert [row.name for row in rows if row.verdict != "PASS"] == []


@pytest.mark.slow
def test_a_spring_drawn_off_at_a_velocity_lets_go_as_smoluchowskis_equation_says(tmp_path: Path) -> None:
    """The density of the plate under the spring's force, whose far end begins where it is slack."""
    drawn = {"kind": "pull_off", "preload": 0.1, "velocity": 2e-3, "stiffness": 0.5, "repeats": REPEATS}
    scene = detachment.scene(1e-3, REPEATS).with_({"experiment": drawn})
    found = run(scene, tmp_path / "run", figures=False).results
    d, energy = detachment.free_energy()
    drag = drag_of_pairs(d, energy, detachment.PAIRS, detachment.STIFFNESS, detachment.DRAG)
    slack = settings_for(scene).law.displacement_at(0.0)
    mean, spread = detachment_in_time(
        d, energy, drag, detachment.TEMPERATURE, 0.5 * 2e-3, detachment.barrier(), 0.5, slack
    )
    assert found["detachment_force"].value == pytest.approx(mean, abs=SIGMAS * spread / np.sqrt(REPEATS))
    assert found["detachment_force_spread"].value == pytest.approx(spread, rel=SIGMAS / np.sqrt(2 * REPEATS))
