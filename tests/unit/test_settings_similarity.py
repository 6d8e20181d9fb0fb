"""Claim: settings are made of the scene's own lengths, energies and masses: scaled scenes have scaled settings.

Factors are powers of two, so that products are exact: a spacing or a mass that multiplies where it should divide, and
is 1 in most scenes, shows here. In units far from 1 a number that is compared with 1, and should not be, shows as well.
"""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import pytest

from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.centring import expected, left_by_centring
from contact1d.workflow.settings.chain import decay_length, reflected
from contact1d.workflow.settings.inertia import inertia
from contact1d.workflow.settings.settings import Settings, settings_for
from contact1d.workflow.settings.size import in_words
from contact1d.workflow.settings.way import contact_half_width, too_fast
from tests.scenes import chains

UNITS = {"usual": (4.0, 8.0, 2.0), "tiny": (2.0**-20, 2.0**-44, 2.0**-10), "vast": (2.0**17, 2.0**40, 2.0**22)}
"""Of length, energy and mass: in the new ones over that in the scene's."""
EXACT = 1e-9
"""Relative: round-off; an offset of 1e-12 of a grid, searches that end within their own bracket."""
KEYS = {
    "spacing": "length", "radius": "length", "range": "length", "amplitude": "energy", "bulk_stiffness": "stiffness",
    "bulk_stiffness_tangential": "stiffness", "stiffness": "stiffness", "mass": "mass", "force": "force",
    "preload": "force", "displacements": "length", "temperature": "energy", "coefficient": "drag", "damping": "drag",
    "work_of_adhesion": "stiffness", "normal_force": "force", "velocity": "velocity", "distance": "length",
    "upper_spacing": "length", "upper_offset": "length",
}  # fmt: skip
NUMBERS = {
    "tolerance": "one", "particles": "one", "rest": "length", "cutoff": "length", "table_from": "length",
    "closest": "length", "bulk_stiffness": "stiffness", "plane_stiffness": "stiffness", "far": "length",
    "force_scale": "force", "force_tolerance": "force", "displacement_step": "length", "loading_step": "length",
    "smooth_step": "length", "longest_move": "length", "time_step": "time", "damping": "drag",
    "damped_stiffness": "stiffness", "plate_mass": "mass", "plate_damping": "drag", "settle_time": "time",
    "largest_displacement": "length", "calm_damping": "drag", "calm_step": "time", "part": "one", "beyond": "one",
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
    "friction under a small load": PLANE | {
        "friction": {"coefficient": 0.3},
        "experiment": {"kind": "tangential", "normal_force": 0.05, "displacements": [0.001, 0.05, -0.002]},
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


def factors(units: str) -> dict[str, float]:
    length, energy, mass = UNITS[units]
    time = length * math.sqrt(mass / energy)
    return {
        "one": 1.0, "length": length, "energy": energy, "mass": mass, "time": time, "force": energy / length,
        "stiffness": energy / length**2, "drag": mass / time, "velocity": length / time,
    }  # fmt: skip


def scaled(table: Any, by: dict[str, float], key: str = "") -> Any:
    if isinstance(table, dict):
        return {name: value if name == "friction" else scaled(value, by, name) for name, value in table.items()}
    if isinstance(table, list):
        return [scaled(value, by, key) for value in table]
    numeric = isinstance(table, int | float) and not isinstance(table, bool)
    return table * by[KEYS[key]] if numeric and key in KEYS else table


def massive(tables: dict[str, Any]) -> dict[str, Any]:
    return tables | {"bodies": {"mass": 1.0} | tables["bodies"]}


def test_every_number_of_the_settings_has_its_dimension_here() -> None:
    assert {field.name for field in fields(Settings)} == set(NUMBERS) | OTHERS


@pytest.mark.parametrize("units", UNITS)
@pytest.mark.parametrize("name", SCENES)
def test_settings_scale_with_the_scene(name: str, units: str) -> None:
    by = factors(units)
    length, force = by["length"], by["force"]
    own, other = (scene_from_dict(tables) for tables in (massive(SCENES[name]), scaled(massive(SCENES[name]), by)))
    first, second = settings_for(own), settings_for(other)
    for field, unit in NUMBERS.items():
        value = getattr(first, field)
        assert getattr(second, field) == pytest.approx(value * by[unit], rel=EXACT, abs=0.0, nan_ok=True), field
    if first.table is not None and second.table is not None:
        assert second.table.points == first.table.points
        error = force * first.table.error_beyond(first.closest)
        assert second.table.error_beyond(length * first.closest) == pytest.approx(error, rel=1e-6, abs=0.0)
    assert second.is_toothed == first.is_toothed
    assert second.estimate.tooth(40) == pytest.approx(length * first.estimate.tooth(40), rel=1e-6, abs=0.0)
    if first.estimate.gap.size > 2:
        for d in (first.largest_displacement, 0.5 * first.largest_displacement):
            stuck = by["stiffness"] * first.estimate.stuck_stiffness(d)
            assert second.estimate.stuck_stiffness(length * d) == pytest.approx(stuck, rel=EXACT, abs=0.0)
    assert decay_length(other) == pytest.approx(length * decay_length(own), rel=EXACT, abs=0.0)
    assert [(leg.rows, leg.steps) for leg in second.drive] == [(leg.rows, leg.steps) for leg in first.drive]
    for leg, its in zip(second.drive, first.drive, strict=True):
        assert leg.velocity == pytest.approx(its.velocity * by["velocity"], rel=EXACT, abs=0.0)
        assert leg.time_step == pytest.approx(its.time_step * by["time"], rel=EXACT, abs=0.0)
    assert inertia(other, second) == pytest.approx([by["mass"] * mass for mass in inertia(own, first)], abs=0.0)
    assert bool(too_fast(other)) == bool(too_fast(own))
    assert in_words(other, 30_000, second.cutoff) == in_words(own, 30_000, first.cutoff)
    if first.law is not None:
        width = length * contact_half_width(own, first)
        assert contact_half_width(other, second) == pytest.approx(width, rel=1e-6, abs=0.0)
    most = first.largest_displacement
    back = reflected(own, first.estimate, most, 30)
    assert reflected(other, second.estimate, length * most, 30) == pytest.approx(back, rel=EXACT)
    for marks in (left_by_centring, expected):
        left, there = marks(own, first), marks(other, second)
        assert set(left) == set(there)
        for quantity, part in left.items():
            unit = by[{"displacement": "length", "radius": "length"}.get(last := quantity.split("_")[-1], last)]
            assert there[quantity] == pytest.approx(unit * part, rel=1e-6, abs=1e-12 * unit), quantity
