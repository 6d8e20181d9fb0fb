"""The frames of a binary dump (`dump custom` to a file *.bin): the same atoms and columns in each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray


def last_frames(
    path: Path, frames: int, atoms: int, columns: int, start: int, part: slice = slice(None)
) -> tuple[NDArray[np.float64], int]:
    """Return (numbers of the frames from byte `start` on, or of a part of them; the end of the file [bytes]).

    The numbers have the shape (frames of the part, atoms, columns − 1), atoms by ascending id, without the ids. A frame
    is a header, of equal length in all frames, and then its numbers, atom by atom.

    Args:
        path: the dump.
        frames: number of frames from `start` to the end of the file.
        atoms, columns: number of atoms and columns in a frame; the first column is the id.
        start: where to begin [bytes].
        part: indices of consecutive frames that are read.

    Raises:
        ValueError: the size of the file does not fit these frames, or the atoms change their order within the part.
    """
    size, numbers = path.stat().st_size - start, 8 * atoms * columns
    if size % frames or size < frames * numbers:
        raise ValueError(f"{path}: {size} bytes are not {frames} frames of {atoms} atoms")
    wanted, length = range(frames)[part], size // frames
    raw = np.fromfile(path, dtype=np.uint8, count=len(wanted) * length, offset=start + wanted.start * length)
    ends = raw.reshape(len(wanted), -1)[:, -numbers:]
    table = np.ascontiguousarray(ends).view(np.float64).reshape(len(wanted), atoms, columns)
    order = np.argsort(table[0, :, 0], kind="stable")
    if (table[:, order, 0] != table[0, order, 0]).any():
        raise ValueError(f"{path}: the atoms change their order between frames")
    return table[:, order, 1:], start + size
