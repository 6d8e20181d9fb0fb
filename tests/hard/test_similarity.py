"""Lengths × λ and energies × ε are the same physics: reduced numbers are the same, whatever the magnitudes.

With masses as they are, forces go as ε/λ, stiffnesses as ε/λ², times as λ/√ε.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.scene import scene_from_dict
from tests.scenes import chains

SAME = 1e-6
"""Of reduced numbers: the minimisers stop at a residual, and round-off decides by how much they fall below it. Most
decks are the same to the last digits and agree within 1e-8."""
DIMENSIONS = {
    "spacing": (1, 0), "radius": (1, 0), "range": (1, 0), "amplitude": (0, 1), "bulk_stiffness": (-2, 1),
    "bulk_stiffness_tangential": (-2, 1), "stiffness": (-2, 1), "force": (-1, 1), "preload": (-1, 1),
    "displacements": (1, 0), "temperature": (0, 1), "coefficient": (-1, 0.5), "normal_force": (-1, 1),
    "distance": (1, 0), "velocity": (0, 0.5),
}  # fmt: skip
"""Powers of λ and ε in each key of a scene that has any."""
"""The same of a result."""

PLANE = {
    "title": "plane",
    "bodies": {
        "particles": "auto", "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0},
        "bulk_stiffness": 0.5, "lower": "rigid_plane",
    },
    "experiment": {"kind": "load", "force": 0.5},
}  # fmt: skip
LOAD = chains(100.0, neighbours={"stiffness": 0.3}, experiment={"kind": "load", "force": 0.5})
SCENES = {
    "load": LOAD,
    "sideways": LOAD | {"horizontal": {}, "bodies": LOAD["bodies"] | {"bulk_stiffness_tangential": 1.6}},
    "plane": PLANE,
    "pull_off": chains(
        100.0,
        bodies={"particles": 60},
        neighbours={"stiffness": 0.3},
        horizontal={},
        accuracy={"tolerance": 1e-4},
        experiment={"kind": "pull_off", "preload": 0.3},
    ),
    "path": chains(100.0, experiment={"kind": "path", "displacements": [0.0, 0.2, 0.4, 0.2, 0.0, -0.2, -0.4, -0.6]}),
    "dynamic": chains(
        100.0,
        bodies={"particles": 50},
        damping={"coefficient": "auto"},
        plate={},
        accuracy={"tolerance": 1e-2},
        experiment={"kind": "load", "method": "dynamic", "force": 0.3},
    ),
}


def similar(scene: Any, length: float, energy: float, key: str = "") -> Any:
    """The tables of a scene with every number times its powers of the two factors."""
    if isinstance(scene, Mapping):
        return {name: similar(value, length, energy, name) for name, value in scene.items()}
    if isinstance(scene, list):
        return [similar(item, length, energy, key) for item in scene]
    if isinstance(scene, float):
        powers = DIMENSIONS.get(key, (0, 0))
        return scene * length ** powers[0] * energy ** powers[1]
    return scene


def test_a_deck_in_units_of_its_own_repeats_the_run_in_those_of_the_scene(tmp_path: Path) -> None:
    """`lmp -in in.lammps` gives the program's curve.txt and states, bitwise, and both are in LU and FU."""
    done = run(scene_from_dict(similar(SCENES["path"], 1e-6, 1.0)), tmp_path / "run", figures=False)
    again = tmp_path / "again"
    again.mkdir()
    for file in ("in.lammps", "system.data", "interaction.table"):
        shutil.copy(done.folder / file, again)
    lmp = [str(Path(sys.executable).parent / "lmp"), "-in", "in.lammps"]
    subprocess.run(lmp, cwd=again, env=os.environ | {"UCX_TLS": "self,sm"}, check=True, capture_output=True, timeout=60)
    for file in ("curve.txt", "states.lammpstrj"):
        assert (again / file).read_bytes() == (done.folder / file).read_bytes()
    lines = {tuple(map(float, line.split()[1:])) for line in (again / "curve.txt").read_text().splitlines()[1:]}
    assert {state.displacement for state in done.outcome.states} <= {line[0] for line in lines}
    assert done.atoms().positions[:, 0].max() == pytest.approx(done.outcome.profiles["final"].x.max(), rel=SAME)


def test_ordinary_scenes_are_written_in_their_own_units() -> None:
    for scene in SCENES.values():
        deck = Deck(scene_from_dict(scene), settings_for(scene_from_dict(scene)))
        assert "unit_length" not in deck.head
