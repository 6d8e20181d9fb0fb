"""The frames of a binary dump (`dump custom` to a file *.bin): the same atoms and columns in each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def last_frames(path: Path, frames: int, atoms: int, columns: int, start: int) -> tuple[NDArray[np.float64], int]:
    """The frames from byte `start` on, atoms by ascending id, and the end of the file.

    A frame ends with its numbers, atom by atom; what is before them is as long in every frame.

    Args:
        path: of the dump.
        frames: how many stand there.
        atoms, columns: of each; the first column is the id.
        start: where to begin [bytes].

    Returns:
        Shape (frames, atoms, columns - 1), without the ids; the length of the file [bytes].

    Raises:
        ValueError: that is not what stands there.
    """
    raw = np.fromfile(path, dtype=np.uint8, offset=start)
    numbers = 8 * atoms * columns
    if raw.size % frames or raw.size < frames * numbers:
        raise ValueError(f"{path}: {raw.size} bytes are not {frames} frames of {atoms} atoms")
    ends = raw.reshape(frames, -1)[:, -numbers:]
    table = np.ascontiguousarray(ends).view(np.float64).reshape(frames, atoms, columns)
    order = np.argsort(table[0, :, 0], kind="stable")
    if (table[:, order, 0] != table[0, order, 0]).any():
        raise ValueError(f"{path}: the atoms change their order between frames")
    return table[:, order, 1:], start + raw.size
