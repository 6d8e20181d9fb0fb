"""Rows of one run are read off the frames of a binary dump: places, pressures and shears, row by row, in any order."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.parts import PLANE_DEPTH
from contact1d.workflow.deck.steps import Displace, Draw
from contact1d.workflow.engine.session import EngineError
from contact1d.workflow.experiments.running.contact import Contact
from contact1d.workflow.experiments.running.stepped import FRAMES, SteppedRows
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.unit.test_settings_similarity import SCENES

HEADER = 72
"""Bytes before the numbers of a frame."""


def scene_of(name: str, spacing: float = 0.5) -> Scene:
    tables = SCENES[name]
    return scene_from_dict(tables | {"bodies": tables["bodies"] | {"particles": 40, "spacing": spacing}})


def frames(folder: Path, numbers: Any) -> None:
    """Append frames (rows, atoms, columns), with atoms from the last to the first."""
    atoms = numbers.shape[1]
    with (folder / FRAMES).open("ab") as file:
        for row in numbers:
            ids = np.arange(1.0, atoms + 1.0)
            table = np.column_stack([ids, row])[::-1]
            file.write(b"x" * HEADER + np.ascontiguousarray(table).tobytes())


def opened(folder: Path, scene: Scene) -> tuple[Any, SteppedRows]:
    session: Any = SimpleNamespace(folder=folder, timestep=33, phase="forward")
    return session, SteppedRows(Deck(scene, settings_for(scene)), session)


@pytest.mark.parametrize(("name", "columns"), [("plane", 2), ("friction", 3)])
def test_frames_are_read_once_and_what_carries_stands_on_the_plane(name: str, columns: int, tmp_path: Path) -> None:
    scene = scene_of(name)
    _, rows = opened(tmp_path, scene)
    rng = np.random.default_rng(9)
    numbers = rng.standard_normal((7, 40, columns))
    numbers[:, 20:, 1] = 0.0
    frames(tmp_path, numbers[:3])
    found = rows.profiles([Displace(0.0)] * 3)
    frames(tmp_path, numbers[3:])
    found += rows.profiles([Displace(0.0)] * 4)
    x = bodies(scene, settings_for(scene))[0].particles[:, 0]
    for profile, row in zip(found, numbers, strict=True):
        assert profile.x == pytest.approx(x)
        assert not profile.z_lower.any()
        assert profile.z_upper == pytest.approx(np.concatenate([np.zeros(20), row[20:, 0]]))
        assert profile.pressure == pytest.approx(row[:, 1] / 0.5)
        assert profile.shear == pytest.approx(row[:, 2] / 0.5 if columns == 3 else 0.0 * x)


def test_lost_particles_and_numbers_that_are_none_are_told(tmp_path: Path) -> None:
    scene = scene_of("plane")
    _, rows = opened(tmp_path, scene)
    frames(tmp_path, np.zeros((2, 30, 2)))
    with pytest.raises(EngineError, match="atoms are missing"):
        rows.profiles([Displace(0.0)] * 2)
    (tmp_path / FRAMES).unlink()
    _, again = opened(tmp_path, scene)
    bad = np.zeros((2, 40, 2))
    bad[1, 3, 0] = np.nan
    frames(tmp_path, bad)
    with pytest.raises(EngineError):
        again.profiles([Displace(0.0)] * 2)


@pytest.mark.parametrize("spacing", [0.001, 0.5])
def test_the_last_digit_of_a_force_is_that_of_a_distance_from_far_below(spacing: float, tmp_path: Path) -> None:
    scene = scene_of("plane", spacing)
    settings = settings_for(scene)
    _, rows = opened(tmp_path, scene)
    depth = PLANE_DEPTH * max(settings.largest_displacement, spacing)
    assert rows.round_off == pytest.approx(2.0**-52 * depth * settings.plane_stiffness)


def test_as_many_rows_go_together_as_a_million_numbers_hold(tmp_path: Path) -> None:
    for particles, together in ((40, 25_000), (400_000, 2), (3_000_000, 1)):
        _, rows = opened(tmp_path, scene_of("plane"))
        rows._x = np.zeros(particles)
        assert rows.at_once == together


class Session:
    """Writes the frames of the rows that it is asked for: heights of 1, and forces that tell the row."""

    lammps_seconds = 0.0
    timestep = 0
    phase = "pressing"

    def __init__(self, folder: Path, columns: int) -> None:
        """Without rows so far."""
        self.folder, self.columns, self.rows, self.texts = folder, columns, 0, list[str]()

    def execute(self, text: str, **_: Any) -> None:
        """Note it."""
        self.texts.append(text)

    def measure(self, text: str, meanwhile: Any) -> None:
        """All rows of a run; there are as many as the test has set."""
        meanwhile()
        self.texts.append(text)
        numbers = np.ones((self.count, 40, self.columns))
        numbers[:, :, 1] = 0.25 * (self.rows + np.arange(self.count))[:, None]
        frames(self.folder, numbers)
        self.rows += self.count
        self.timestep += self.count
        self.lammps_seconds += 1.0

    count = 0


@pytest.mark.parametrize("name", ["JKR on the plane", "friction"])
def test_rows_of_a_run_are_states_with_their_numbers_places_and_steps(name: str, tmp_path: Path) -> None:
    scene = scene_of(name)
    session: Any = Session(tmp_path, 3 if name == "friction" else 2)
    contact = Contact(Deck(scene, settings_for(scene)), session)
    states = []
    for phase, count in (("pressing", 3), ("forward", 4)):
        contact.begin(phase)
        session.count = count
        rows = [Draw(0.125 * i, 0.5 * i) if name == "friction" else Displace(0.125 * i) for i in range(count)]
        states += contact.rows(rows)
        contact.write_state()
    assert [s.number for s in states] == list(range(7))
    assert [s.step for s in states] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    assert [s.displacement for s in states] == pytest.approx([0.125 * i for i in (0, 1, 2, 0, 1, 2, 3)])
    along = [0.5 * i for i in (0, 1, 2, 0, 1, 2, 3)] if name == "friction" else [0.0] * 7
    assert [s.plate_x for s in states] == pytest.approx(along)
    assert [s.force for s in states] == pytest.approx([40 * 0.25 * i for i in range(7)])
    assert [s.smallest_distance for s in states] == [1.0, *[0.0] * 6]  # what carries stands on the plane
    assert {s.depth for s in states} == {0.0}
    assert {s.residual for s in states} == {SteppedRows(contact.deck, session).round_off}
    assert [s.phase for s in states] == ["pressing"] * 3 + ["forward"] * 4
    assert contact.rows_seconds == 2.0
    (tmp_path / FRAMES).touch()
    contact.finish()
    assert not (tmp_path / FRAMES).exists()
