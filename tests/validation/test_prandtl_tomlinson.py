"""Claim: one particle on a rigid row, pulled by a spring, is Prandtl and Tomlinson's, with the corrugation there is.

U(x) = min_z Σ V + F_N z of the row is computed on its own; the equation of motion is that of the independent
integrator; the slow limit is the energy that a slip loses. The same scenes, decks and means as any other slide.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, Scene, read_scene, run
from contact1d.workflow.model.settings import settings_for
from validation.references.prandtl_tomlinson import Corrugation, corrugation, slow_friction
from validation.references.slide import Integrator
from validation.slides import slide_model

LAW = (1.0, 0.5, 0.5, 1.0)
LOAD, TANGENTIAL = 0.2, 1.0
MOTION = 2e-3
"""Of ⟨F⟩: the cutoff changes the corrugation by 1e-4, and the mean is over other periods than the integrator's."""
SLOW = 1e-2
"""Of ⟨F⟩: what is left of v^(2/3) after the limit is taken from two velocities."""
SINUSOID = {1.0: 0.0, 2.0: 0.2015, 5.0: 0.5710}
"""⟨F⟩/F_max in the slow limit (Gnecco et al.; derived anew in the reference)."""


def scene_of(eta: float, velocity: float, distance: float, **bodies: Any) -> Scene:
    """A particle whose spring to the drive, its own and the cantilever's in series, is max(−U″)/η."""
    stiffness = corrugation(LAW, 1.0, LOAD).steepest / eta
    return read_scene({
        "title": "Prandtl-Tomlinson",
        "bodies": {
            "particles": 32, "upper_particles": 1, "upper_offset": 0.0, "spacing": 1.0, "lower": "rigid_chain",
            "periodic": True, "profile": {"kind": "flat"}, "bulk_stiffness": TANGENTIAL, "mass": 1.0,
        } | bodies,
        "interaction": {
            "repulsion": {"amplitude": LAW[0], "range": LAW[1]}, "attraction": {"amplitude": LAW[2], "range": LAW[3]},
        },
        "horizontal": {},
        "damping": {"coefficient": 0.4},
        "plate": {"free": ["x", "z"], "damping": 0.0},
        "cantilever": {"stiffness": 1.0 / (1.0 / stiffness - 1.0 / TANGENTIAL), "velocity": velocity},
        "experiment": {"kind": "slide", "normal_force": LOAD, "distance": distance},
    })  # fmt: skip


def slid(eta: float, velocity: float, distance: float, folder: Path) -> Run:
    return run(scene_of(eta, velocity, distance), folder / f"{eta}-{velocity}", figures=False)


@pytest.mark.parametrize("eta", [1.0, 2.0, 5.0])
def test_the_reference_knows_the_sinusoid(eta: float) -> None:
    wave = Corrugation(1.0, np.asarray([1.0]))
    assert slow_friction(wave, wave.steepest / eta) / wave.largest_force == pytest.approx(SINUSOID[eta], abs=2e-4)


def test_the_reference_is_the_sum_over_the_row() -> None:
    """U′ against a difference of energies, minimised on a fine grid."""
    wells, x, step = corrugation(LAW, 1.0, LOAD), 0.3, 1e-3
    z = np.linspace(0.5, 1.1, 20_001)

    def energy(place: float) -> float:
        r = np.hypot(place - np.arange(-60.0, 61.0)[:, None], z)
        return float(((np.exp(-2.0 * r) - 0.5 * np.exp(-r)).sum(axis=0) + LOAD * z).min())

    slope = (energy(x + step) - energy(x - step)) / (2.0 * step)
    assert float(wells.slope(np.asarray(x))) == pytest.approx(slope, rel=1e-4)


@pytest.mark.parametrize(("eta", "velocity"), [(1.0, 2e-3), pytest.param(5.0, 2e-3, marks=pytest.mark.slow)])
def test_the_friction_is_that_of_the_equation_of_motion(eta: float, velocity: float, tmp_path: Path) -> None:
    scene = scene_of(eta, velocity, 4.0)
    settings = settings_for(scene)
    found = run(scene, tmp_path / "run", figures=False).results
    body = Integrator(slide_model(scene, settings))
    body.settle(settings.motion.time_step, 1e-7)
    (leg,) = settings.motion.drive
    trace = body.run(leg.rows * leg.steps, leg.time_step, velocity, every=leg.steps)
    periods = np.interp(trace.time[-1] - np.arange(3)[::-1] / velocity, trace.time, trace.impulse)
    expected = float(np.diff(periods).mean()) * velocity
    assert found["mean_friction"].value == pytest.approx(expected, rel=MOTION)
    assert found["mean_friction"].value == pytest.approx(expected, abs=3.0 * found["mean_friction"].uncertainty)
    assert found["static_friction"].value == pytest.approx(corrugation(LAW, 1.0, LOAD).largest_force, rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("eta", [2.0, 5.0])
def test_the_slow_limit_is_the_energy_that_a_slip_loses(eta: float, tmp_path: Path) -> None:
    """⟨F⟩(v) = F_0 + C v^(2/3) at low velocities, by two of them."""
    wells = corrugation(LAW, 1.0, LOAD)
    fast, slow = 1e-4, 1e-4 / 8.0
    at_fast, at_slow = (slid(eta, v, 4.0, tmp_path).results["mean_friction"].value for v in (fast, slow))
    limit = at_slow - (at_fast - at_slow) / ((fast / slow) ** (2.0 / 3.0) - 1.0)
    assert limit == pytest.approx(slow_friction(wells, wells.steepest / eta), rel=SLOW)


def test_below_the_threshold_it_slides_smoothly(tmp_path: Path) -> None:
    """η = 0.8: no slip, and a friction that falls with the velocity, where that of η = 5 hardly does."""
    fast, slow = (slid(0.8, v, 4.0, tmp_path).results for v in (2e-3, 5e-4))
    assert slow["slips"].value == 0
    assert fast["mean_friction"].value / slow["mean_friction"].value > 2.5
    sticking = [slid(5.0, v, 5.0, tmp_path).results["mean_friction"].value for v in (2e-3, 5e-4)]
    assert sticking[0] / sticking[1] < 1.1


def test_a_commensurate_chain_is_so_many_particles(tmp_path: Path) -> None:
    """With the same spring and force for each, with and without springs between them."""
    alone = slid(2.0, 2e-3, 4.0, tmp_path).results
    scene = scene_of(2.0, 2e-3, 4.0)
    assert scene.cantilever is not None
    many = {
        "bodies.upper_particles": 8, "bodies.particles": 8, "bodies.upper_offset": 0.5,
        "cantilever.stiffness": 8.0 * scene.cantilever.stiffness, "experiment.normal_force": 8.0 * LOAD,
    }  # fmt: skip
    for name, changes in (("free", {}), ("chained", {"neighbours": {"stiffness": 0.5}})):
        found = run(scene.with_(many | changes), tmp_path / name, figures=False).results
        for quantity in ("mean_friction", "static_friction"):
            assert found[quantity].value == pytest.approx(8.0 * alone[quantity].value, rel=MOTION), name
