"""How slow a scene's own drag and plate make it: T = max(2M/c, c/K) in timesteps over that of automatic ones."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest

from contact1d.workflow.experiments.running import slowness as slow
from contact1d.workflow.experiments.running.law_error import law_error, law_share
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.slowness import slowness
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.given import PROFILE, at, given_scene
from tests.unit.test_settings_similarity import SCENES

TIMED = {"kind": "load", "force": 0.3, "method": "dynamic"}
WAY = {"kind": "path", "displacements": [0.0, 0.05], "method": "dynamic"}


def moving(scene: Scene, settings: Settings) -> tuple[float, float, float]:
    """Mass [MU], drag [FU·TU/LU], and timesteps of T."""
    if scene.plate is None:
        mass, drag = scene.bodies.mass, settings.damping
    else:
        mass = settings.plate_mass + settings.particles * scene.bodies.mass
        drag = settings.particles * settings.damping + settings.plate_damping
    stiffness = mass * (2.0 * math.pi / settings.settle_time) ** 2
    return mass, drag, max(2.0 * mass / drag, drag / stiffness) / settings.time_step


@pytest.mark.parametrize(
    ("given", "automatic"),
    [
        ({"damping": {"coefficient": 300.0}, "plate": {"damping": 7.0}, "experiment": TIMED}, {"plate": {}}),
        ({"damping": {"coefficient": 1e-4}, "plate": {"damping": 0.0}, "experiment": TIMED}, {"plate": {}}),
        ({"damping": {"coefficient": 0.5}, "plate": {"mass": 4e4, "damping": 3.0}, "experiment": TIMED}, {"plate": {}}),
        ({"damping": {"coefficient": 300.0}, "experiment": WAY}, {}),
        ({"damping": {"coefficient": 1e-3}, "experiment": WAY}, {}),
        ({"damping": {"coefficient": 2.0}, "experiment": WAY}, {}),
    ],
)
def test_what_is_told_is_the_ratio_of_both_times_and_both_drags_and_masses(given: Any, automatic: Any) -> None:
    scene = given_scene(**given)
    usual = given_scene(**(given | automatic | {"damping": {"coefficient": "auto"}}))
    settings, other = settings_for(scene), settings_for(usual, settings_for(scene).tolerance)
    (mass, drag, steps), (usual_mass, usual_drag, usual_steps) = moving(scene, settings), moving(usual, other)
    told = slowness(scene, settings)
    times = steps / usual_steps
    assert bool(told) == (times >= 10.0)
    if told:
        numbers = [float(number) for number in re.findall(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?", told)[:5]]
        assert numbers == pytest.approx([drag, mass, usual_drag, usual_mass, times], rel=6e-3, abs=0.5)


def test_ten_times_is_slow_and_less_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = given_scene(damping={"coefficient": 2.0}, experiment=WAY)
    settings = settings_for(scene)
    for times, told in ((10.0, True), (9.99, False)):
        monkeypatch.setattr(slow, "_steps", lambda of, s, times=times: times if s is settings else 1.0)
        assert bool(slowness(scene, settings)) == told


def test_automatic_ones_are_not_compared_with_themselves_nor_slides_at_all() -> None:
    for scene in (
        given_scene(damping={"coefficient": "auto"}, plate={}, experiment=TIMED),
        given_scene(damping={"coefficient": "auto"}, experiment=WAY), given_scene(),
        scene_from_dict(SCENES["slide"]),
    ):  # fmt: skip
        assert slowness(scene, settings_for(scene)) == ""


def test_what_the_law_leaves_out_is_a_share_before_a_run_and_a_force_after_it() -> None:
    """Ten times the tail at the cutoff and what the table misses, over the scale; of a plane 4 k_n over its own."""
    scene = given_scene()
    settings = settings_for(scene)
    assert settings.law is not None
    assert settings.table is not None
    tail = 10.0 * abs(float(settings.law.force(settings.cutoff)))
    expected = (tail + settings.table.error_beyond(settings.table_from)) / settings.force_scale
    assert law_share(scene, settings) == pytest.approx(expected)
    plane = scene_from_dict(SCENES["plane"] | {"neighbours": {"stiffness": 0.3}})
    own = settings_for(plane)
    share = 4.0 * 0.3 / own.plane_stiffness
    assert law_share(plane, own) == pytest.approx(share)
    assert law_error(plane, own, at(0.0, -2.5)) == pytest.approx(2.5 * share)
    bare = scene_from_dict(SCENES["JKR on the plane"])
    assert law_share(bare, settings_for(bare)) == law_error(bare, settings_for(bare), at(0.0, 2.5)) == 0.0


def test_a_spot_is_a_spacing_and_a_half_wide_at_most() -> None:
    for spacing in (0.5, 1.0):
        scene = given_scene(bodies={"particles": 40, "spacing": spacing})
        rule = RadiusRule(scene, 1e-3)
        none = type(PROFILE)(*(0.0 * PROFILE.x for _ in range(5)))
        spot = rule.or_spot(none)
        assert (spot.value, spot.uncertainty, spot.left, spot.right) == (0.0, 1.5 * spacing, 0.0, 0.0)
        assert rule.of(none) is None
        assert rule.or_spot(PROFILE) == rule.of(PROFILE)
