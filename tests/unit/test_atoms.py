"""A finished run as ASE atoms, against the profile that the same run wrote; and dumps that ASE itself opens."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d import read_scene, run
from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import by_state, read_columns
from tests.scenes import chains

ROUND_OFF = 1e-13  # the same doubles, divided by the spacing in between


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pull = {"kind": "pull_off", "preload": 0.2}
    tables = chains(50.0, bodies={"particles": 40}, accuracy={"tolerance": 1e-2}, experiment=pull)
    return run(read_scene(tables), tmp_path_factory.mktemp("run") / "small", figures=False).folder


def test_every_state_agrees_with_its_profile(folder: Path) -> None:
    for index, profile in enumerate(by_state(read_columns(folder / "profile.csv")).values()):
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


@pytest.mark.parametrize("kept", [0.1, 0.5, 0.999])
def test_a_dump_that_is_cut_short_gives_no_atoms(folder: Path, tmp_path: Path, kept: float) -> None:
    text = (folder / "states.lammpstrj").read_text()
    first = text[: text.index("ITEM: TIMESTEP", 1)]
    (tmp_path / "states.lammpstrj").write_text(first[: int(kept * len(first))])
    with pytest.raises(ValueError, match="cut short"):
        atoms(tmp_path)


def test_a_dump_without_the_forces_is_refused_by_their_names(folder: Path, tmp_path: Path) -> None:
    text = (folder / "states.lammpstrj").read_text()
    (tmp_path / "states.lammpstrj").write_text(text.replace("opposite_fx opposite_fz", "fx fz"))
    with pytest.raises(ValueError, match="no column opposite_fx, opposite_fz"):
        atoms(tmp_path)


def test_atoms_come_in_the_order_of_their_ids_and_have_no_energy(folder: Path, tmp_path: Path) -> None:
    lines = (folder / "states.lammpstrj").read_text().splitlines()
    second = lines.index("ITEM: TIMESTEP", 1)
    lines = lines[:9] + lines[9:second][::-1]
    (tmp_path / "states.lammpstrj").write_text("\n".join([*lines, ""]))
    state, reference = atoms(tmp_path), atoms(folder, 0)
    assert state.calc is None
    assert set(state.get_chemical_symbols()) == {"X"}
    for name, values in reference.arrays.items():
        np.testing.assert_array_equal(state.arrays[name], values)
