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
