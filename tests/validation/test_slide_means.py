"""Claims on the mean friction of a slide: halves of a long one agree, its drag changes it as the integrator says."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from contact1d import Run, run
from contact1d.analysis.friction import block_means, interval, mean_of
from contact1d.workflow.experiments.motion import motion_of
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.stability.random_slides import integrated, mean_friction

LONG = 14.0
"""Way of the drive [LU]: periods."""
SMALL = 0.02
"""Change of a mean friction that doubling the drag makes at least, of the mean."""


def scene_of(below: int, above: int, velocity: float = 0.02, **tables: dict[str, Any]) -> Scene:
    """A row of particles on springs, over a rigid one that goes on for ever."""
    base: dict[str, dict[str, Any]] = {
        "bodies": {
            "particles": below, "upper_particles": above, "upper_spacing": below / above, "spacing": 1.0, "mass": 1.0,
            "bulk_stiffness": 1.0, "lower": "rigid_chain", "periodic": True, "profile": {"kind": "flat"},
        },
        "interaction": {"repulsion": {"amplitude": 1.0, "range": 0.5}, "attraction": {"amplitude": 0.5, "range": 1.0}},
        "horizontal": {},
        "damping": {"coefficient": 0.3},
        "plate": {"free": ["x", "z"], "mass": float(above), "damping": 0.0},
        "cantilever": {"stiffness": 0.04 * above, "velocity": velocity},
        "accuracy": {"tolerance": 1e-3},
        "experiment": {"kind": "slide", "normal_force": 0.2 * above, "distance": LONG},
    }  # fmt: skip
    changed = {name: base.get(name, {}) | tables.get(name, {}) for name in {**base, **tables}}
    return scene_from_dict({"title": "means"} | changed)


STICKING = scene_of(4, 4, 0.005)
FREE = scene_of(13, 8, bodies={"bulk_stiffness": 0.2}, cantilever={"stiffness": 4.0})


def halves(found: Run) -> list[tuple[float, float]]:
    """Mean friction and half of its interval, of both halves of what comes after the run-in."""
    states, settings = found.outcome.states, settings_for(found.scene)
    motion = motion_of(found.scene, settings, states[0], list(states[1:]))
    assert found.scene.cantilever is not None
    period = found.scene.bodies.spacing / found.scene.cantilever.velocity
    blocks = block_means(motion.time, motion.impulse, period, motion.friction)
    steady = blocks[mean_of(blocks).first :]
    half = steady.size // 2
    room = 0.3 * settings.tolerance * abs(float(steady.mean()))  # what the settings may leave open, in both alike
    return [(float(part.mean()), interval(part) + room) for part in (steady[:half], steady[half:])]


@pytest.mark.parametrize("scene", [STICKING, FREE], ids=["stick-slip", "out of step"])
def test_two_halves_of_a_long_slide_agree_within_their_intervals(scene: Scene, tmp_path: Path) -> None:
    found = run(scene, tmp_path / "run", figures=False)
    (first, error), (second, other) = halves(found)
    assert first == pytest.approx(second, abs=error + other)
    stated = found.results["mean_friction"]
    assert abs(0.5 * (first + second) - stated.value) <= stated.uncertainty
    assert (found.results["slips"].value > LONG / 2.0) == (scene is STICKING)


def test_twice_the_drag_changes_the_friction_as_the_integrator_says(tmp_path: Path) -> None:
    """The drag is against what moves with the drive: what it changes is how the contact slips."""
    means, expected, open_ = [], [], 0.0
    for drag in (0.3, 0.6):
        scene = scene_of(4, 4, damping={"coefficient": drag}, experiment={"distance": 6.0})
        stated = run(scene, tmp_path / f"{drag}", figures=False).results["mean_friction"]
        means.append(stated.value)
        open_ += stated.uncertainty
        expected.append(mean_friction(integrated(scene, settings_for(scene)), 1.0 / 0.02))
    assert means[1] - means[0] == pytest.approx(expected[1] - expected[0], abs=open_)
    assert abs(expected[1] - expected[0]) > max(SMALL * expected[0], 2.0 * open_)
