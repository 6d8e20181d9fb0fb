"""The frames that LAMMPS writes are read by atom, or it is said that they are not there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d.workflow.engine.frames import last_frames

HEADER = 52
"""Bytes before the numbers of a frame."""


def dump(path: Path, frames: list[list[list[float]]]) -> Path:
    """Rows (id, columns…) of each frame."""
    path.write_bytes(b"".join(bytes(HEADER) + np.asarray(rows).tobytes() for rows in frames))
    return path


def test_atoms_come_by_their_id_and_reading_goes_on_at_the_end(tmp_path: Path) -> None:
    path = dump(tmp_path / "a.bin", [[[2, 5.0, 6.0], [1, 3.0, 4.0]], [[2, 9.0, 10.0], [1, 7.0, 8.0]]])
    both, end = last_frames(path, 2, 2, 3, 0)
    assert both.tolist() == [[[3.0, 4.0], [5.0, 6.0]], [[7.0, 8.0], [9.0, 10.0]]]
    assert end == path.stat().st_size
    second, same = last_frames(path, 1, 2, 3, end // 2)
    assert second.tolist() == both[1:].tolist()
    assert same == end


@pytest.mark.parametrize("cut", [1, 40, 60, 110])
def test_frames_that_are_not_whole_are_refused(cut: int, tmp_path: Path) -> None:
    path = dump(tmp_path / "a.bin", [[[2, 5.0, 6.0], [1, 3.0, 4.0]], [[2, 9.0, 10.0], [1, 7.0, 8.0]]])
    path.write_bytes(path.read_bytes()[:-cut])
    with pytest.raises(ValueError, match=r"are not 2 frames|change their order"):
        last_frames(path, 2, 2, 3, 0)


def test_atoms_in_another_order_are_refused(tmp_path: Path) -> None:
    path = dump(tmp_path / "a.bin", [[[2, 5.0], [1, 3.0]], [[1, 7.0], [2, 9.0]]])
    with pytest.raises(ValueError, match="change their order"):
        last_frames(path, 2, 2, 2, 0)
