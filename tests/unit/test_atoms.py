"""A finished run as ASE atoms, against the profile that the same run wrote; and dumps that ASE itself opens."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from analysis.atoms import atoms
from analysis.curve import read_profiles
from workflow.campaign import run
from workflow.scene import scene_from_dict

ROUND_OFF = 1e-13  # the same doubles, divided by the spacing in between


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    scene = scene_from_dict(
        {
            "title": "small pull-off",
            "bodies": {
                "particles": 40,
                "spacing": 1.0,
                "profile": {"kind": "parabola", "radius": 50.0},
                "bulk_stiffness": 0.83,
            },
            "interaction": {
                "repulsion": {"amplitude": 0.18, "range": 0.13},
                "attraction": {"amplitude": 0.09, "range": 0.26},
            },
            "accuracy": {"tolerance": 1e-2},
            "experiment": {"kind": "pull_off", "preload": 0.2},
        }
    )
    return run(scene, tmp_path_factory.mktemp("run") / "small", figures=False).folder


def test_every_state_agrees_with_its_profile(folder: Path) -> None:
    for index, profile in enumerate(read_profiles(folder / "profile.csv").values()):
        state = atoms(folder, index)
        upper = (state.arrays["body"] == "upper") & (state.arrays["role"] == "particle")
        np.testing.assert_allclose(state.positions[upper, 2], profile.z_upper, rtol=ROUND_OFF)
        np.testing.assert_allclose(state.arrays["opposite_force"][upper, 2], profile.pressure, atol=ROUND_OFF)


def test_action_is_reaction(folder: Path) -> None:
    force = atoms(folder).arrays["opposite_force"]
    assert np.abs(force.sum(axis=0)).max() < 1e-12 * np.abs(force).sum()


def test_ase_opens_the_dump_by_itself(folder: Path) -> None:
    import ase.io

    frames = ase.io.read(folder / "states.lammpstrj", index=":", format="lammps-dump-text")
    assert len(frames) == 2
    np.testing.assert_allclose(frames[-1].positions, atoms(folder).positions, rtol=1e-12)


def test_what_is_not_there_is_said(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="no folder of a finished run"):
        atoms(tmp_path)
    with pytest.raises(IndexError, match="holds 2 states"):
        atoms(folder, 2)
