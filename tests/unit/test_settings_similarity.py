"""Claim: settings are made of the scene's own lengths, energies and masses: scaled scenes have scaled settings.

Factors are powers of two, so that products are exact: a spacing or a mass that multiplies where it should divide, and
is 1 in most scenes, shows here.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import pytest

from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.centring import left_by_centring
from contact1d.workflow.settings.chain import decay_length, reflected
from contact1d.workflow.settings.inertia import inertia
from contact1d.workflow.settings.settings import Settings, settings_for
from contact1d.workflow.settings.way import contact_half_width, too_fast
from tests.scenes import chains

LENGTH, ENERGY, MASS = 4.0, 8.0, 2.0
FORCE, TIME = ENERGY / LENGTH, LENGTH * math.sqrt(MASS / ENERGY)
STIFFNESS, DRAG = ENERGY / LENGTH**2, MASS / TIME
EXACT = 1e-9
"""Relative: round-off; an offset of 1e-12 of a grid, searches that end within their own bracket."""
KEYS = {
    "spacing": LENGTH, "radius": LENGTH, "range": LENGTH, "amplitude": ENERGY, "bulk_stiffness": STIFFNESS,
    "bulk_stiffness_tangential": STIFFNESS, "stiffness": STIFFNESS, "mass": MASS, "force": FORCE, "preload": FORCE,
    "displacements": LENGTH, "temperature": ENERGY, "coefficient": DRAG, "damping": DRAG,
    "work_of_adhesion": STIFFNESS, "normal_force": FORCE, "velocity": LENGTH / TIME, "distance": LENGTH,
    "upper_spacing": LENGTH, "upper_offset": LENGTH,
}  # fmt: skip
NUMBERS = {
    "tolerance": 1.0, "particles": 1.0, "rest": LENGTH, "cutoff": LENGTH, "table_from": LENGTH, "closest": LENGTH,
    "bulk_stiffness": STIFFNESS, "plane_stiffness": STIFFNESS, "far": LENGTH, "force_scale": FORCE,
    "force_tolerance": FORCE, "displacement_step": LENGTH, "loading_step": LENGTH, "smooth_step": LENGTH,
    "longest_move": LENGTH, "time_step": TIME, "damping": DRAG, "damped_stiffness": STIFFNESS, "plate_mass": MASS,
    "plate_damping": DRAG, "settle_time": TIME, "largest_displacement": LENGTH, "calm_damping": DRAG,
    "calm_step": TIME, "part": 1.0, "beyond": 1.0,
}  # fmt: skip
OTHERS = {"law", "table", "estimate", "drive"}
"""Fields that are no numbers."""
ALL = chains(
    100.0, neighbours={"stiffness": 0.3}, horizontal={}, bodies={"bulk_stiffness_tangential": 1.6, "mass": 1.0},
    experiment={"kind": "pull_off", "method": "quasistatic", "preload": 1.0},
)  # fmt: skip
PLANE: dict[str, Any] = {
    "title": "plane",
    "bodies": {
        "particles": "auto", "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 1.0,
        "lower": "rigid_plane", "reduction": "mdr",
    },
}  # fmt: skip
SCENES: dict[str, dict[str, Any]] = {
    "pull-off with all springs": ALL,
    "smooth pull-off": ALL | {"interaction": {n: t | {"range": 4 * t["range"]} for n, t in ALL["interaction"].items()}},
    "tension": ALL | {"experiment": {"kind": "load", "method": "quasistatic", "force": -0.05}},
    "pull-off in time": ALL
    | {"damping": {"coefficient": "auto"}, "plate": {}, "experiment": ALL["experiment"] | {"method": "dynamic"}},
    "its own drag": ALL
    | {
        "damping": {"coefficient": 0.3}, "plate": {"mass": 7.0, "damping": 2.0},
        "experiment": ALL["experiment"] | {"method": "dynamic"},
    },
    "noise": ALL
    | {
        "damping": {"coefficient": "auto"}, "plate": {}, "noise": {"temperature": 1e-3, "seed": 1},
        "experiment": {"kind": "load", "method": "dynamic", "force": 0.5},
    },
    "path in time": ALL
    | {
        "damping": {"coefficient": "auto"},
        "experiment": {"kind": "path", "method": "dynamic", "displacements": [0.05]},
    },
    "plane": {
        "title": "plane",
        "bodies": {
            "particles": "auto", "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0},
            "bulk_stiffness": 0.5, "lower": "rigid_plane",
        },
        "neighbours": {"stiffness": 0.3}, "experiment": {"kind": "load", "method": "quasistatic", "force": 0.5},
    },
    "JKR on the plane": PLANE | {
        "adhesion": {"work_of_adhesion": 0.005}, "experiment": {"kind": "pull_off", "preload": 2.0},
    },
    "tension on the plane": PLANE | {
        "adhesion": {"work_of_adhesion": 0.005}, "experiment": {"kind": "load", "force": -1.0},
    },
    "punch on the plane": PLANE | {
        "bodies": PLANE["bodies"] | {"profile": {"kind": "flat_punch", "radius": 5.0}},
        "adhesion": {"work_of_adhesion": 0.005}, "experiment": {"kind": "pull_off", "preload": 2.0},
    },
    "friction": PLANE | {
        "friction": {"coefficient": 0.3},
        "experiment": {"kind": "tangential", "normal_force": 2.0, "displacements": [0.01, 0.05, -0.02]},
    },
    "slide": chains(
        30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": "auto"}, plate={"free": ["x", "z"]},
        cantilever={"stiffness": 0.5, "velocity": 0.1}, bodies={"mass": 1.0, "upper_offset": 0.5},
        experiment={"kind": "slide", "normal_force": 1.0, "distance": 7.0},
    ),
    "slide of few particles over another spacing": chains(
        30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": 0.3},
        plate={"free": ["x", "z"], "mass": 5.0, "damping": 0.1}, cantilever={"stiffness": 0.5, "velocity": 0.1},
        bodies={"mass": 1.0, "upper_spacing": 1.3, "upper_particles": 12, "bulk_stiffness_tangential": 1.6},
        experiment={"kind": "slide", "normal_force": 1.0, "distance": 7.0},
    ),
}  # fmt: skip


def scaled(table: Any, key: str = "") -> Any:
    if isinstance(table, dict):
        return {name: value if name == "friction" else scaled(value, name) for name, value in table.items()}
    if isinstance(table, list):
        return [scaled(value, key) for value in table]
    numeric = isinstance(table, int | float) and not isinstance(table, bool)
    return table * KEYS[key] if numeric and key in KEYS else table


def massive(tables: dict[str, Any]) -> dict[str, Any]:
    return tables | {"bodies": {"mass": 1.0} | tables["bodies"]}


def test_every_number_of_the_settings_has_its_dimension_here() -> None:
    assert {field.name for field in fields(Settings)} == set(NUMBERS) | OTHERS


@pytest.mark.parametrize("name", SCENES)
def test_settings_scale_with_the_scene(name: str) -> None:
    own, other = (scene_from_dict(massive(tables)) for tables in (SCENES[name], scaled(massive(SCENES[name]))))
    first, second = settings_for(own), settings_for(other)
    for field, factor in NUMBERS.items():
        value = getattr(first, field)
        assert getattr(second, field) == pytest.approx(value * factor, rel=EXACT, nan_ok=True), field
    if first.table is not None and second.table is not None:
        assert second.table.points == first.table.points
        r = first.closest
        assert second.table.error_beyond(LENGTH * r) == pytest.approx(FORCE * first.table.error_beyond(r), rel=1e-6)
    assert second.estimate.tooth(40) == pytest.approx(LENGTH * first.estimate.tooth(40), rel=1e-6)
    if first.estimate.gap.size > 2:
        place = first.largest_displacement
        for d, factor in ((place, STIFFNESS), (0.5 * place, STIFFNESS)):
            stuck = first.estimate.stuck_stiffness(d)
            assert second.estimate.stuck_stiffness(LENGTH * d) == pytest.approx(factor * stuck, rel=EXACT)
    assert decay_length(other) == pytest.approx(LENGTH * decay_length(own), rel=EXACT)
    assert [(leg.rows, leg.steps) for leg in second.drive] == [(leg.rows, leg.steps) for leg in first.drive]
    for leg, its in zip(second.drive, first.drive, strict=True):
        assert (leg.velocity, leg.time_step) == pytest.approx((its.velocity * LENGTH / TIME, its.time_step * TIME))
    assert inertia(other, second) == pytest.approx([MASS * mass for mass in inertia(own, first)])
    assert bool(too_fast(other)) == bool(too_fast(own))
    if first.law is not None:
        assert contact_half_width(other, second) == pytest.approx(LENGTH * contact_half_width(own, first), rel=1e-6)
    most = first.largest_displacement
    back = reflected(own, first.estimate, most, 30)
    assert reflected(other, second.estimate, LENGTH * most, 30) == pytest.approx(back, rel=EXACT)
    units = {"force": FORCE, "displacement": LENGTH, "radius": LENGTH, "energy": ENERGY}
    left, there = left_by_centring(own, first), left_by_centring(other, second)
    assert set(left) == set(there)
    for quantity, part in left.items():
        assert there[quantity] == pytest.approx(units[quantity.split("_")[-1]] * part, rel=1e-6, abs=1e-12), quantity
