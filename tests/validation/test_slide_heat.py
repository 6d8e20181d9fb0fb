"""Claim: under heat a slide has its temperature, also the plate, whose own drag comes with its heat.

M ⟨(V − v)²⟩ = k_BT for each free direction, the ratio's own spread over independent times as error.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, Scene, read_scene, run
from validation.paper.heat import FLAT_PAIR, TEMPERATURE

SIGMAS = 3.0
CLOSED = 5e-3
"""Work that is neither given to the baths nor stored, over the energy that the drive and the baths exchange."""


def scene_of(**tables: Any) -> Scene:
    """A flat pair of eight particles that slides slowly under heat."""
    base = FLAT_PAIR | {"experiment": {"kind": "slide", "normal_force": 1.6, "distance": 12.0}}
    changed = {name: base.get(name, {}) | tables.get(name, {}) for name in {**base, **tables}}
    return read_scene({"title": "slide under heat"} | changed)


@pytest.fixture(scope="module")
def hot(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(scene_of(), tmp_path_factory.mktemp("heat") / "run", figures=False)


def test_the_plate_is_as_warm_as_its_particles(tmp_path: Path) -> None:
    """A drag of 4 beside 8 · 0.4 of the particles would cool it to 0.44 T if it had no heat of its own."""
    at_rest = {"kind": "slide", "normal_force": 1.6, "path": [[0.0, 12.0]]}
    found = run(scene_of().with_({"experiment": at_rest}), tmp_path / "run", figures=False).results["plate_temperature"]
    sigma = found.uncertainty / 2.0
    assert found.value / TEMPERATURE == pytest.approx(1.0, abs=SIGMAS * sigma / TEMPERATURE)
    assert found.uncertainty < 0.2 * TEMPERATURE


def test_the_balance_of_energy_holds_under_heat(hot: Run) -> None:
    work, lost, stored = (hot.results[f"{n}"].value for n in ("cantilever_work", "dissipated_energy", "stored_energy"))
    assert work == pytest.approx(lost + stored, abs=CLOSED * max(abs(work), abs(lost), abs(stored)))


def test_heat_lowers_the_friction(hot: Run, tmp_path: Path) -> None:
    cold = run(scene_of().with_(without="noise"), tmp_path / "cold", figures=False).results
    assert hot.results["mean_friction"].value < cold["mean_friction"].value
    assert np.isfinite(hot.friction["friction"]).all()


def test_a_plate_at_rest_relaxes_with_its_drag(tmp_path: Path) -> None:
    """Pulled aside and left, its force falls as the drag N γ + c on all that moves lets it, where nothing else holds.

    The friction of the incommensurate, stiff pair is nil; the time is that of the drag, with and without heat.
    """
    flat = {"particles": 13, "upper_particles": 8, "upper_spacing": 13 / 8, "bulk_stiffness": 4.0}
    plate = {"free": ["x", "z"], "mass": 8.0, "damping": 16.0}
    experiment = {"kind": "slide", "normal_force": 1.6, "path": [[0.5, 1.0], [0.0, 0.5]]}
    base = scene_of(
        bodies=flat, plate=plate, cantilever={"stiffness": 1.0, "velocity": 0.02}, noise={"temperature": 1e-11}
    )
    for without in ((), ("noise",)):
        scene = base.with_({"experiment": experiment}, without=without)
        found = run(scene, tmp_path / f"relax{len(without)}", figures=False)
        resting = found.friction["time"] > 15.0  # the particles have come to rest, too
        time, pull = found.friction["time"][resting], found.friction["cantilever_force"][resting]
        slope = np.polyfit(time, np.log(np.abs(pull)), 1)[0]
        total = 8 * 0.4 + 16.0
        rate = total / 32.0 * (1.0 - np.sqrt(1.0 - 4.0 * 16.0 / total**2))
        assert -slope == pytest.approx(rate, rel=0.03)
