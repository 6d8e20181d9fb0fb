"""`[output] states` keeps the whole way: a frame for each row of the curve, or some of them, by the deck's own dump."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import ase.io
import numpy as np
import pytest

from contact1d import Run, run
from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import read_states
from tests.decks.test_run_folder import PLANE, READ, lmp
from tests.decks.test_run_folder import SCENES as OTHERS
from tests.scenes import chains

SINGLE = 1e-6  # relative: states.npz is in single precision
ROUND_OFF = 1e-12
FEW = 6
FRICTION: dict[str, Any] = {
    "bodies": PLANE["bodies"] | {"reduction": "mdr", "particles": "auto"},
    "friction": {"coefficient": 0.3},
    "experiment": {"kind": "tangential", "normal_force": [4.0, 2.0, 3.0], "displacements": [0.1, 0.2, 0.0]},
}
NAMES = ("load_thermal", "pull_off_dynamic", "plane_adhesion", "slide", "units")
SCENES = {name: OTHERS[name] for name in NAMES} | {
    "snapping": chains(
        20.0,
        0.2,
        (0.18, 0.065, 0.09, 0.13),
        accuracy={"tolerance": 1e-2},
        experiment={"kind": "pull_off", "preload": 0.05},
    ),
    "tangential": FRICTION,
}
"""Every way to move, both methods, chains and plane, rows that are steps of one run and rows that are not."""


@pytest.fixture(scope="module", params=SCENES)
def scene(request: pytest.FixtureRequest) -> dict[str, Any]:
    return {"title": request.param} | SCENES[request.param]


@pytest.fixture(scope="module")
def whole(scene: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(scene | {"output": {"states": "all"}}, tmp_path_factory.mktemp("all"), figures=False)


def test_each_row_of_the_curve_is_a_frame_with_types_places_and_forces_that_ase_finds(whole: Run) -> None:
    """Plain `ase.io.read`, no format and no column named."""
    frames = ase.io.read(whole.folder / "states.lammpstrj", index=":")
    assert len(frames) == len(whole.curve.force)
    for frame, force in zip(frames, whole.curve.force, strict=True):
        upper = frame.arrays["type"] == 2
        assert frame.get_forces()[upper, 2].sum() == pytest.approx(force, rel=ROUND_OFF, abs=ROUND_OFF)
        assert not frame.get_forces()[:, 1].any()
    np.testing.assert_allclose(atoms(whole.folder).positions, frames[-1].positions, rtol=ROUND_OFF)
    np.testing.assert_array_equal(atoms(whole.folder).arrays["opposite_force"], frames[-1].get_forces())


def test_what_the_page_and_the_picture_move_through_is_all_of_it(whole: Run) -> None:
    kept = read_states(whole.folder / "states.npz")
    assert kept.rows.tolist() == list(range(len(whole.curve.force)))
    spacing = whole.scene.bodies.own_spacing
    largest = float(np.abs(whole.curve.force).max())
    np.testing.assert_allclose(
        spacing * kept.pressure.sum(axis=1), whole.curve.force, rtol=SINGLE, atol=SINGLE * largest
    )


def test_the_deck_alone_writes_the_same_file(whole: Run, tmp_path: Path) -> None:
    for name in READ:
        if (whole.folder / name).exists():
            shutil.copy(whole.folder / name, tmp_path / name)
    (tmp_path / "states.lammpstrj").write_text("what another run has left\n")
    done = lmp(tmp_path)
    assert done.returncode == 0, done.stdout[-2000:]
    assert (tmp_path / "states.lammpstrj").read_bytes() == (whole.folder / "states.lammpstrj").read_bytes()


def test_some_states_are_frames_of_all_and_the_results_are_those_without_any(
    scene: dict[str, Any], whole: Run, tmp_path: Path
) -> None:
    """So many frames as asked for, first and last among them, and bitwise the numbers of a run that keeps none."""
    some = run(scene | {"output": {"states": FEW}}, tmp_path / "some", figures=False)
    none = run(scene, tmp_path / "none", figures=False)
    assert some.results == none.results == whole.results
    frames, every = (
        (kept.folder / "states.lammpstrj").read_text().split("ITEM: TIMESTEP\n")[1:] for kept in (some, whole)
    )
    assert len(frames) == min(FEW, len(every))
    assert (frames[0], frames[-1]) == (every[0], every[-1])
    assert frames == [frame for frame in every if frame in frames]
    again = tmp_path / "again"
    again.mkdir()
    for name in READ:
        if (some.folder / name).exists():
            shutil.copy(some.folder / name, again / name)
    assert lmp(again).returncode == 0
    assert (again / "states.lammpstrj").read_bytes() == (some.folder / "states.lammpstrj").read_bytes()
