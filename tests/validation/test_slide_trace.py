"""Claim: a slide is the motion of the model: its trace is that of an integrator written independently, in numpy.

Particles, plate, cantilever and drag as the scene says; only the numbers that the program chose (timestep, cutoff,
automatic drag and mass) are taken over.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from contact1d import Run, Scene, read_scene, run
from contact1d.workflow.model.settings import Settings, settings_for
from validation.references.slide import Integrator, Trace
from validation.slides import slide_model

TRACE = 1e-4
"""Of the peak: the table of the law, the rest from which the slide starts, and the order of the sums."""
MEAN = 3e-4
"""Of the peak: the samples of the cantilever's force, every fifth step, against every step of the integrator."""
CLOSED = 5e-4
"""Work that is neither dissipated nor stored: the drag is sampled at every fifth step."""
RESIDUAL = 1e-6
"""Force [FU] below which the integrator's bodies are at rest before they slide."""


def scene_of(**tables: Any) -> Scene:
    """A small sticky curved body on a longer flat one; keys of tables are added to those here."""
    base: dict[str, dict[str, Any]] = {
        "bodies": {
            "particles": 40, "upper_particles": 24, "upper_offset": 0.5, "spacing": 1.0, "mass": 1.0,
            "bulk_stiffness": 2.0, "profile": {"kind": "parabola", "radius": 30.0},
        },
        "interaction": {"repulsion": {"amplitude": 1.0, "range": 0.5}, "attraction": {"amplitude": 0.5, "range": 1.0}},
        "horizontal": {},
        "damping": {"coefficient": 0.2},
        "plate": {"free": ["x", "z"], "mass": 24.0, "damping": 2.0},
        "cantilever": {"stiffness": 0.4, "velocity": 0.02},
        "accuracy": {"tolerance": 1e-3},
        "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 4.0},
    }  # fmt: skip
    changed = {name: base.get(name, {}) | tables.get(name, {}) for name in {**base, **tables}}
    return read_scene({"title": "slide"} | changed)


def integrated(scene: Scene, settings: Settings) -> Trace:
    """The same by the reference, measured where the program measures."""
    body = Integrator(slide_model(scene, settings))
    body.settle(settings.motion.time_step, RESIDUAL)
    (leg,) = settings.motion.drive
    return body.run(leg.rows * leg.steps, leg.time_step, leg.velocity, every=leg.steps)


CASES: dict[str, dict[str, Any]] = {
    "plain": {},
    "neighbours, softer along, twice the drag": {
        "neighbours": {"stiffness": 0.3},
        "bodies": {"bulk_stiffness_tangential": 1.2},
        "damping": {"coefficient": 0.4},
        "plate": {"damping": 4.0},
    },
}


@pytest.fixture(scope="module", params=CASES.values(), ids=CASES.keys())
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Run, Trace]:
    scene = scene_of(**request.param)
    return run(scene, tmp_path_factory.mktemp("slide") / "run", figures=False), integrated(scene, settings_for(scene))


def test_the_trace_is_that_of_the_integrator(both: tuple[Run, Trace]) -> None:
    slid, expected = both
    peak = float(np.abs(expected.friction).max())
    assert slid.friction["time"] == pytest.approx(expected.time, rel=1e-12)
    assert slid.friction["friction"] == pytest.approx(expected.friction, abs=TRACE * peak)
    assert slid.friction["cantilever_force"] == pytest.approx(expected.cantilever_force, abs=TRACE * peak)
    assert slid.friction["plate_x"] == pytest.approx(expected.place, abs=TRACE)
    assert slid.friction["drive"][-1] == pytest.approx(4.0, abs=1e-12)


def test_means_over_whole_periods_are_those_of_every_step(both: tuple[Run, Trace]) -> None:
    """The friction by the balance of the momentum against the sum of the lower body's forces, step by step."""
    slid, expected = both
    period = 1.0 / 0.02
    end = expected.time[-1]
    peak = float(np.abs(expected.friction).max())
    for first in (1, 2):  # where the run-in ends is the program's choice
        mean = (expected.impulse[-1] - np.interp(first * period, expected.time, expected.impulse)) / (
            end - first * period
        )
        if slid.results["mean_friction"].value == pytest.approx(mean, abs=MEAN * peak):
            return
    pytest.fail(f"{slid.results['mean_friction']} is none of the means of the integrator, the last of which is {mean}")


def test_the_largest_friction_is_that_before_the_plate_slides(both: tuple[Run, Trace]) -> None:
    slid, expected = both
    before = expected.place < 1.0
    assert slid.results["static_friction"].value == pytest.approx(
        expected.friction[before].max(), abs=slid.results["static_friction"].uncertainty + TRACE
    )


def test_the_work_is_dissipated_or_stored(both: tuple[Run, Trace]) -> None:
    slid, _ = both
    work, lost, stored = (slid.results[f"{name}"].value for name in ENERGIES)
    assert work == pytest.approx(lost + stored, abs=CLOSED * work)
    assert slid.friction["cantilever_work"][-1] == work
    assert work > 0.0
    assert lost > 0.0


ENERGIES = ("cantilever_work", "dissipated_energy", "stored_energy")
