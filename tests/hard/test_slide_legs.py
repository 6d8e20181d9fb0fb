"""Claim: a slide there and back with a rest is the motion of `validation.references.slide`, leg by leg."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d import read_scene, run
from contact1d.workflow.deck.lattice import start_offset
from contact1d.workflow.model.settings import settings_for
from validation.references.slide import Integrator
from validation.slides import slide_model

SCENE = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "slide.toml"
TRACE = 1e-3
"""Of the peak: legs other than the first have timesteps of their own, and the inertia of the first one's drag."""
PATH = [[0.02, 1.0], [0.0, 0.5], [-0.02, 2.0], [0.03, 0.5]]


def test_there_and_back_with_a_rest_is_the_motion_of_the_integrator() -> None:
    scene = read_scene(SCENE).with_({
        "accuracy.tolerance": 1e-2, "bodies.particles": 48, "bodies.upper_particles": 32,
        "experiment": {"kind": "slide", "normal_force": 1.0, "path": PATH},
    })  # fmt: skip
    settings = settings_for(scene)
    scene = scene.with_({"bodies.upper_offset": start_offset(scene, settings)})
    found = run(scene)
    body, drive, friction = Integrator(slide_model(scene, settings)), 0.0, []
    body.settle(settings.motion.time_step, 1e-6)
    for leg in settings.motion.drive:
        trace = body.run(leg.rows * leg.steps, leg.time_step, leg.velocity, start=drive, every=leg.steps)
        drive += leg.velocity * leg.rows * leg.row_time
        friction.append(trace.friction)
    expected = np.concatenate(friction)
    assert found.friction["friction"] == pytest.approx(expected, abs=TRACE * np.abs(expected).max())
    assert found.friction["drive"][-1] == pytest.approx(1.0 - 2.0 + 0.5, abs=1e-9)
    work, lost, stored = (found.results[n].value for n in ("cantilever_work", "dissipated_energy", "stored_energy"))
    assert work == pytest.approx(lost + stored, abs=5e-3 * work)
