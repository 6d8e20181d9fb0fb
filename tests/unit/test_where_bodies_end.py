"""What a state says of where bodies touch and end: a radius only where they touch, a slide only on the lower body."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import read_scene
from contact1d.analysis.pressure import Profile
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.trust import OffEndError, PartedError
from contact1d.workflow.experiments.slide.slide import _require_above
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.settings.way import contact_half_width
from tests.scenes import chains

SLIDE = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "slide.toml"
X = np.arange(-5.0, 5.5)
PARABOLIC = np.maximum(9.0 - X**2, 0.0)
DIPPED = np.where(np.abs(X) < 2.5, 0.0, -1.5 / np.maximum(np.abs(X), 1.0))
"""Tension that is largest at the edge of what does not press."""


def profile(pressure: Any) -> Profile:
    nothing = np.zeros_like(X)
    return Profile(x=X, z_upper=nothing + 1.0, z_lower=nothing, pressure=np.asarray(pressure), shear=nothing)


def scene_on(lower: str, **body: Any) -> Scene:
    """Chains that attract each other, or a plane that doesn't."""
    tables = chains(30.0, bodies={"particles": 11, "lower": lower, **body}, experiment={"kind": "load", "force": 1.0})
    if lower == "rigid_plane":
        del tables["interaction"]
    return scene_from_dict(tables)


@pytest.mark.parametrize(
    ("scene", "pressure", "radius"),
    [
        (scene_on("rigid_plane"), 0.0 * X, None),
        (scene_on("rigid_plane"), PARABOLIC, 3.0),
        (scene_on("rigid_plane", profile={"kind": "flat_punch", "radius": 5.5}), 0.0 * X, None),
        (scene_on("rigid_plane", profile={"kind": "flat_punch", "radius": 5.5}), 0.0 * X + 1.0, 5.5),
        (scene_on("particles"), 0.0 * X, None),
        (scene_on("particles"), PARABOLIC, None),
        (scene_on("particles"), PARABOLIC + DIPPED, 3.0),
    ],
)
def test_bodies_have_a_radius_where_they_touch_and_none_elsewhere(
    scene: Scene, pressure: Any, radius: float | None
) -> None:
    """Where pairs attract each other what presses alone is no contact yet: it has no largest tension."""
    found = RadiusRule(scene, 1e-3).of(profile(pressure))
    assert (found is None) == (radius is None)
    assert found is None or abs(found.value - float(radius or 0.0)) <= max(found.uncertainty, 1e-9)


@pytest.mark.parametrize("spacing", [0.5, 1.0, 2.0])
def test_a_plate_runs_off_where_the_lower_body_ends_in_any_spacing(spacing: float) -> None:
    lengths = {"bodies.profile.radius": 30.0, "interaction.repulsion.range": 0.5, "interaction.attraction.range": 1.0,
               "bodies.spacing": 1.0, "experiment.distance": 8.0}  # fmt: skip
    scene = read_scene(SLIDE).with_({key: spacing * length for key, length in lengths.items()})
    settings = settings_for(scene)
    last = (0.5 * settings.lower_particles + 1.0) * spacing - contact_half_width(scene, settings)

    def at(place: float, apart: float = 0.0) -> State:
        flat = np.zeros_like(X)
        there = Profile(X, flat, flat, flat, flat)
        return State("sliding", 0.0, 1.0, there, apart, 0.0, 0.0, RadiusRule(scene, 1e-3), plate_x=place)

    for side in (-1.0, 1.0):
        _require_above(scene, settings, at(side * (last - 0.01 * spacing)))
        with pytest.raises(OffEndError, match="ran off the lower body"):
            _require_above(scene, settings, at(side * (last + 0.01 * spacing)))
    with pytest.raises(PartedError):
        _require_above(scene, settings, at(0.0, 1.01 * settings.cutoff))


def punch_on(lower: str) -> Scene:
    """A flat punch that adheres: by a work of adhesion on a plane, by a law between chains."""
    body = {"particles": "auto", "lower": lower, "profile": {"kind": "flat_punch", "radius": 5.5}}
    tables = chains(30.0, bodies=body, experiment={"kind": "pull_off", "preload": 1.0})
    if lower == "rigid_plane":
        tables |= {"interaction": None, "adhesion": {"work_of_adhesion": 0.01}}
    return scene_from_dict({name: table for name, table in tables.items() if table is not None})


def test_a_punch_that_stands_on_a_plane_is_held_by_it_without_any_force() -> None:
    scene = punch_on("rigid_plane")
    standing, away = profile(0.0 * X), profile(0.0 * X)
    standing.z_upper[:] = 0.5
    standing.z_upper[3] = 0.0
    away.z_upper[:] = 0.5
    found = RadiusRule(scene, 1e-3).of(standing)
    assert found is not None
    assert (found.value, found.uncertainty) == (5.5, 0.0)
    assert RadiusRule(scene, 1e-3).of(away) is None
    between = RadiusRule(punch_on("particles"), 1e-3)
    assert between.of(standing) is None
    pressed = between.of(profile(0.0 * X + 1.0))
    assert pressed is not None
    assert (pressed.left, pressed.right) == (-5.5, 5.5)


def test_what_presses_only_is_held_on_a_plane_that_adheres() -> None:
    tables = chains(30.0, bodies={"particles": 12, "lower": "rigid_plane"}, interaction=None,
                    adhesion={"work_of_adhesion": 0.01}, experiment={"kind": "load", "force": 1.0})  # fmt: skip
    scene = scene_from_dict(tables)
    found = RadiusRule(scene, 1e-3).of(profile(PARABOLIC))
    assert found is not None
    assert found.value > 2.0
    assert RadiusRule(scene, 1e-3).of(profile(0.0 * X)) is None
