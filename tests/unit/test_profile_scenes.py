"""Profiles in a scene: what is no profile is refused in words; what is one reads back."""

from __future__ import annotations

import math
import pickle
import tomllib
from typing import Any

import numpy as np
import pytest

from contact1d import SceneError, read_scene
from tests.shapes import SHAPES

# Faults: the points, and words that the message has.
FAULTS: dict[str, tuple[list[float], list[float], str]] = {
    "gap": (
        [0, 1, 2, 3, 13.5], [0, 1, 2, 3, 4],
        "has a gap from r = 3 to 13.5: the median step is 1, and the largest gap allowed 10; add points there",
    ),
    "not from 0": ([0.5, 1, 2, 3], [0, 1, 2, 3], "must begin at the radius 0, not 0.5: the transform needs the slope"),
    "standing": ([0, 1, 2, 2, 3], [0, 1, 2, 3, 4], "radii must increase; 2 follows 2"),
    "falling radii": ([0, 1, 2, 1.5, 3], [0, 1, 2, 3, 4], "radii must increase; 1.5 follows 2"),
    "apex elsewhere": ([0, 1, 2, 3], [0, 1, -0.5, 3], "its apex at r = 0; at r = 2 LU the height is lower by 0.5 LU"),
    "flat": ([0, 1, 2, 3], [2, 2, 2, 2], 'is flat: write kind = "flat_punch"'),
    "unequal": ([0, 1, 2, 3], [0, 1, 2, 3, 4], "must have as many radii as heights, not 4 and 5"),
}  # fmt: skip


def scene_of(profile: dict[str, Any], **bodies: Any) -> dict[str, Any]:
    return {
        "title": "profile",
        "bodies": {
            "particles": "auto",
            "spacing": 1.0,
            "bulk_stiffness": 1.0,
            "lower": "rigid_plane",
            "profile": profile,
        }
        | bodies,
        "experiment": {"kind": "path", "displacements": [0.1]},
    }


def message(profile: dict[str, Any], **bodies: Any) -> str:
    with pytest.raises(SceneError) as caught:
        read_scene(scene_of(profile, **bodies))
    return str(caught.value)


@pytest.mark.parametrize("name", FAULTS)
def test_points_that_are_no_profile_are_refused(name: str) -> None:
    r, z, words = FAULTS[name]
    printed = message({"kind": "table", "r": r, "z": z})
    assert printed.startswith("bodies.profile = ")
    assert words in printed
    assert "\n" not in printed


def test_steps_up_to_the_longest_are_no_gap() -> None:
    scene = read_scene(scene_of({"kind": "table", "r": [0, 1, 2, 3, 13], "z": [0, 1, 2, 3, 4]}))
    assert scene.bodies.reach == 13.0


@pytest.mark.parametrize(
    "profile", [{"kind": "table"}, {"kind": "table", "r": [0, 1, 2, 3]}, {"kind": "table", "z": [0.0] * 4}]
)
def test_a_table_needs_a_file_or_both_lists(profile: dict[str, Any]) -> None:
    assert "needs a file, or the lists r and z" in message(profile)


def test_radii_are_not_negative_and_heights_are_finite() -> None:
    assert "radii must increase; -2 follows 1" in message({"kind": "table", "r": [0, 1, -2, 3], "z": [0, 1, 2, 3]})
    assert "bodies.profile.z[1] = nan" in message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, math.nan, 2, 3]})
    assert "bodies.profile.z[1] = true" in message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, True, 2, 3]})


def test_fewer_than_four_points_are_too_few() -> None:
    printed = message({"kind": "table", "r": [0, 1], "z": [0, 1]})
    assert "at least one item" not in printed
    assert printed.count("must have at least 4 items") == 2


def test_a_point_that_is_no_number_is_one_problem() -> None:
    printed = message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, math.nan, 2, 3]})
    assert printed == "bodies.profile.z[1] = nan: must be a finite number (LU)"


def test_scale_belongs_to_a_file() -> None:
    assert "scale" in message({"kind": "table", "r": [0, 1, 2, 3], "z": [0, 1, 4, 9], "scale": 2.0})


@pytest.mark.parametrize(
    ("profile", "words"),
    [
        ({"kind": "power", "exponent": 0.9, "radius": 1.0, "height": 1.0}, "exponent = 0.9: must be at least 1"),
        ({"kind": "power", "exponent": 2.0, "radius": 1.0}, "bodies.profile.height: missing"),
        ({"kind": "power", "exponent": 2.0, "radius": 1.0, "height_there": 1.0}, "profile.height_there: unknown key"),
        ({"kind": "cone", "slope": 0.0}, "bodies.profile.slope = 0.0: must be greater than 0"),
        ({"kind": "cone", "radius": 3.0}, "bodies.profile.radius: unknown key"),
        ({"kind": "circle", "radius": -3.0}, "bodies.profile.radius = -3.0: must be greater than 0 (LU)"),
    ],
)  # fmt: skip
def test_each_kind_has_its_own_keys_and_ranges(profile: dict[str, Any], words: str) -> None:
    assert words in message(profile)


def test_a_scene_with_a_table_is_hashable_equal_and_survives_pickling() -> None:
    tables = scene_of({"kind": "table", "r": [0, 1, 2, 3], "z": [0, 1, 4, 9]})
    scene, same = read_scene(tables), read_scene(tables)
    other = read_scene(scene_of({"kind": "table", "r": [0, 1, 2, 3], "z": [0, 1, 4, 9.5]}))
    assert scene == same
    assert hash(scene) == hash(same)
    assert scene != other
    copy = pickle.loads(pickle.dumps(scene))
    assert copy == scene
    x = np.linspace(-3.0, 3.0, 7)
    assert np.array_equal(copy.bodies.height(x), scene.bodies.height(x))
    drawn, others = scene.bodies.profile.height(x), other.bodies.profile.height(x)
    assert np.array_equal(others[1:-1], drawn[1:-1])


@pytest.mark.parametrize("name", SHAPES)
def test_every_kind_reads_back_from_the_text_of_its_scene(name: str) -> None:
    scene = read_scene(scene_of(SHAPES[name][0].model_dump(by_alias=True, exclude_none=True), reduction="mdr"))
    assert scene.bodies.profile == SHAPES[name][0]
    assert read_scene(tomllib.loads(str(scene))) == scene
