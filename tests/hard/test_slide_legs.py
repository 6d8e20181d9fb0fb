"""Claim: hard slides are the motion of `validation.references.slide`: there and back with a rest, too fast, on a stiff
cantilever, with particles that slip one by one."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import read_scene, run
from contact1d.workflow.model.settings import settings_for
from validation.slides import integrated, mean_friction

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
TRACE = 1e-3
"""Of the peak: legs other than the first have timesteps of their own, and the inertia of the first one's drag."""
CLOSED = 5e-3
"""Work that is neither dissipated nor stored, over the largest of the three."""
PATH = [[0.02, 1.0], [0.0, 0.5], [-0.02, 2.0], [0.03, 0.5]]
SHARP = {
    "accuracy.tolerance": 1e-3, "bodies.bulk_stiffness": 3.0, "bodies.profile.radius": 8.0,
    "bodies.upper_particles": 20, "bodies.upper_offset": 0.5, "plate.mass": 20.0, "plate.damping": 2.0,
    "damping.coefficient": 0.2,
}  # fmt: skip
CASES: dict[str, tuple[str, dict[str, Any]]] = {
    "there and back with a rest": ("slide", {
        "accuracy.tolerance": 1e-2, "bodies.particles": 48, "bodies.upper_particles": 32,
        "experiment": {"kind": "slide", "normal_force": 1.0, "path": PATH},
    }),
    "faster than the particles follow": ("slide", SHARP | {
        "bodies.particles": 64, "cantilever": {"velocity": 0.5, "stiffness": 4.0}, "experiment.distance": 12.0,
    }),
    "without slips on a cantilever stiffer than the contact": ("slide", SHARP | {
        "bodies.particles": 48, "cantilever": {"velocity": 0.02, "stiffness": 20.0}, "experiment.distance": 5.0,
    }),
    "without slips of particles that slip one by one": ("prandtl_tomlinson", {
        "accuracy.tolerance": 1e-4, "bodies.particles": 13, "bodies.upper_particles": 8, "bodies.upper_spacing": 13 / 8,
        "bodies.bulk_stiffness_tangential": 0.03, "plate.mass": 8.0, "damping.coefficient": 0.3,
        "cantilever": {"velocity": 0.01, "stiffness": 8.0}, "experiment.normal_force": 1.6, "experiment.distance": 4.0,
    }),
}  # fmt: skip


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * name.endswith("one by one")) for name in CASES]
)
def test_a_hard_slide_is_the_motion_of_the_integrator(name: str) -> None:
    shipped, changes = CASES[name]
    scene = read_scene(SCENES / f"{shipped}.toml").with_(changes)
    found, expected = run(scene), integrated(scene, settings_for(scene))
    assert found.friction["friction"] == pytest.approx(expected.friction, abs=TRACE * np.abs(expected.friction).max())
    work, lost, stored = (found.results[n].value for n in ("cantilever_work", "dissipated_energy", "stored_energy"))
    assert work == pytest.approx(lost + stored, abs=CLOSED * max(map(abs, (work, lost, stored))))
    if "path" not in changes.get("experiment", {}):
        mean, velocity = found.results["mean_friction"], changes["cantilever"]["velocity"]
        assert abs(mean.value - mean_friction(expected, 1.0 / velocity)) <= mean.uncertainty
    if name.startswith("without slips"):
        assert found.results["slips"].value == 0
