"""A finished run as ASE atoms, against the profile that the same run wrote; and dumps that ASE itself opens."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import read_profiles
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.scene import scene_from_dict
from tests.scenes import chains

ROUND_OFF = 1e-13  # the same doubles, divided by the spacing in between


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pull = {"kind": "pull_off", "preload": 0.2}
    tables = chains(50.0, bodies={"particles": 40}, accuracy={"tolerance": 1e-2}, experiment=pull)
    return run(scene_from_dict(tables), tmp_path_factory.mktemp("run") / "small", figures=False).folder


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


FRAME = """ITEM: TIMESTEP
{timestep}
ITEM: NUMBER OF ATOMS
{count}
ITEM: BOX BOUNDS ff ff ff
-1 1
-1 1
-1 1
ITEM: ATOMS {columns}
{rows}
"""


def frame(timestep: int, columns: str, ids: list[int]) -> str:
    """An atom of each id, its type the id; x, y, z and the force are told by it."""
    value = {"x": 0.5, "y": 0.25, "z": -3.0, "opposite_fx": 7.0, "opposite_fz": 9.0, "fx": 7.0, "fy": 0.0, "fz": 9.0}
    rows = "\n".join(
        " ".join(str(i) if name in ("id", "type") else str(value[name] * i + timestep) for name in columns.split())
        for i in ids
    )
    return FRAME.format(timestep=timestep, count=len(ids), columns=columns, rows=rows)


@pytest.mark.parametrize("columns", ["type z id opposite_fz x y opposite_fx", "id type x y z fx fy fz"])
def test_each_state_of_a_dump_is_read_by_the_names_of_its_columns(columns: str, tmp_path: Path) -> None:
    ids = [3, 1, 7, 2, 5, 4, 6]
    text = frame(10, columns, ids) + frame(20, columns, ids[::-1]) + frame(30, columns, [1])
    (tmp_path / "states.lammpstrj").write_text(text)
    for state, timestep in ((0, 10), (1, 20), (-2, 20), (-3, 10)):
        found = atoms(tmp_path, state)
        number = np.arange(1, 8)
        assert found.info["timestep"] == timestep
        assert not found.pbc.any()
        assert found.arrays["id"].tolist() == found.arrays["type"].tolist() == number.tolist()
        assert found.positions.tolist() == (number[:, None] * [0.5, 0.25, -3.0] + timestep).tolist()
        assert found.arrays["opposite_force"].tolist() == [
            [7.0 * i + timestep, 0.0, 9.0 * i + timestep] for i in number
        ]
        assert found.arrays["body"].tolist() == ["lower", "upper", "lower", "upper", "lower", "upper", "upper"]
        assert found.arrays["role"].tolist() == [
            "particle", "particle", "anchor", "anchor", "far anchor", "far anchor", "driver",
        ]  # fmt: skip
    assert len(atoms(tmp_path)) == len(atoms(tmp_path, 2)) == 1
    for state in (3, -4):
        with pytest.raises(IndexError, match="holds 3 states"):
            atoms(tmp_path, state)


@pytest.mark.parametrize("wrong", ["\n9", "", "ITEM: ATOMS"])
def test_a_frame_with_more_or_fewer_rows_than_it_promises_is_cut_short(wrong: str, tmp_path: Path) -> None:
    whole = frame(1, "id type x y z opposite_fx opposite_fz", [1, 2, 3])
    for text in (
        whole.replace("\n3\n", "\n4\n", 1),
        whole[:-1],
        whole[: whole.index("ITEM: BOX")],
        whole + wrong + "\n",
    ):
        if text != whole:
            (tmp_path / "states.lammpstrj").write_text(text)
            with pytest.raises(ValueError, match="cut short"):
                atoms(tmp_path)
