"""The axes of a sweep: its points, and every wrong file in a sentence."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import SceneError, sweep
from contact1d.workflow.sweep.axes import MOST_POINTS, Axis, read_sweep
from tests.sweeps import FORCE, RADIUS, axis, plane


def problems(source: Mapping[str, Any]) -> str:
    with pytest.raises(SceneError) as caught:
        read_sweep(source)
    return str(caught.value)


def test_a_product_has_every_value_with_every_other_the_last_axis_quickest() -> None:
    plan = read_sweep(plane(axis(RADIUS, 50.0, 100.0), axis(FORCE, 0.5, 1.0, 1.5)))
    assert len(plan) == 6
    assert list(plan.values())[:4] == [(50.0, 0.5), (50.0, 1.0), (50.0, 1.5), (100.0, 0.5)]


def test_zip_takes_values_side_by_side() -> None:
    plan = read_sweep(plane(axis(RADIUS, 50.0, 100.0), axis(FORCE, 0.5, 1.0), combine="zip"))
    assert list(plan.values()) == [(50.0, 0.5), (100.0, 1.0)]


def test_spans_have_steps_and_one_more_value_with_exact_ends() -> None:
    spans = [
        {"key": RADIUS, "from": 0.1, "to": 0.7, "steps": 6},
        {"key": FORCE, "from": 1.0, "to": 1000.0, "steps": 3, "scale": "log"},
        {"key": "noise.seed", "from": 1, "to": 3, "steps": 2},
    ]
    linear, log, seeds = (a.values for a in read_sweep(plane(*spans)).axes)
    np.testing.assert_allclose(linear, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
    np.testing.assert_allclose(log, [1.0, 10.0, 100.0, 1000.0])
    assert (linear[-1], log[-1]) == (0.7, 1000.0)
    assert seeds == (1, 2, 3)
    assert all(isinstance(seed, int) for seed in seeds)


def test_an_axis_may_have_a_unit() -> None:
    span = {"key": RADIUS, "from": "1 µm", "to": "100 µm", "steps": 2, "scale": "log"}
    (radii,) = read_sweep(plane(span)).axes
    assert radii.values == ("1 µm", "1e-05 m", "100 µm")
    assert radii.numbers == ((1e-6, 1e-5, 1e-4), "m")
    assert Axis(RADIUS, ("1 µm", "1 mm")).numbers == ((1e-6, 1e-3), "m")
    assert Axis(RADIUS, ("1 µm", "1 N")).numbers == ((), "")
    assert Axis("bodies.lower", ("particles", "rigid_plane")).numbers == ((), "")


@pytest.mark.parametrize(
    ("source", "sentence"),
    [
        (plane({"key": RADIUS, "from": "1 m", "to": "2 N", "steps": 1}), "must have the same dimension at"),
        (plane(), "axes: missing; write [[axes]]"),
        (plane(axis(RADIUS)), "axes[0].values: is empty: the sweep would have no point"),
        (plane(axis(RADIUS, 1.0), axis(RADIUS, 2.0)), "another axis has the same key"),
        (plane({"key": RADIUS}), "axes[0]: lacks from, to, steps; give values, or from, to and steps"),
        (plane({"key": RADIUS, "form": 1.0, "to": 2.0, "steps": 2}), 'axes[0].form: unknown key; did you mean "from"?'),
        (plane({"key": RADIUS, "from": 0.0, "to": 2.0, "steps": 2, "scale": "log"}), "log needs from and to above 0"),
        (plane({"key": RADIUS, "from": 1.0, "to": 2.0, "steps": 0}), "must be a whole number from 1 to"),
        (plane({"key": RADIUS, "from": "1", "to": 2.0, "steps": 1}), 'axes[0].from = "1": must be a finite number'),
        (plane({"values": [1.0]}), "axes[0].key: missing; such as noise.seed"),
        (plane(axis(RADIUS, 1.0) | {"steps": 3}), "axes[0].values: not together with steps"),
        (plane(axis(RADIUS, 1.0), scene="a.toml"), "scene: not together with [base]"),
        ({"axes": [axis(RADIUS, 1.0)]}, "scene: missing; give a scene file"),
        ({"scene": "nowhere.toml", "axes": [axis(RADIUS, 1.0)]}, "nowhere.toml: no such file"),
        (plane(axis(RADIUS, 1.0), combine="cross"), 'combine = "cross": must be "product" or "zip"'),
        (plane(axis(RADIUS, 1.0), axis(FORCE, 1.0, 2.0), combine="zip"), '"zip" needs axes of one length'),
        (plane(axis(RADIUS, 1.0), colour="red"), "colour: unknown key; allowed here: title, scene"),
        (
            plane(*({"key": key, "from": 1.0, "to": 2.0, "steps": n} for key, n in ((RADIUS, 9999), (FORCE, 999)))),
            f"10000 × 1000 = 10000000 points are more than {MOST_POINTS}",
        ),
    ],
)  # fmt: skip
def test_a_wrong_sweep_file_is_told_in_a_sentence(source: dict[str, Any], sentence: str) -> None:
    assert sentence in problems(source)


@pytest.mark.parametrize("key", ["bodies.profile.radus", "boddies.spacing", "title.key", "interaction..range"])
def test_an_axis_that_is_no_key_of_the_scene_is_refused_before_anything_is_written(key: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError):
        sweep(plane(axis(key, 1.0, 2.0)), tmp_path / "out")
    assert not (tmp_path / "out").exists()
