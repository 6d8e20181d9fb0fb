"""Files that are whole or not there: written under a temporary name, then renamed."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PART = ".part"
"""What ends the name of a file that is not whole yet."""
FULL_DISK = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "a file would be larger than is allowed (ulimit -f)",
}
"""Errors of the system by which no further file can be written, in words."""


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Give the temporary path to write to; it takes the place of `path` in the end, and not after an error."""
    part = path.with_name(path.name + PART)
    yield part
    os.replace(part, path)


def write_whole(path: Path, text: str) -> None:
    """Write a text file, whole or not at all."""
    with whole(path) as part:
        part.write_text(text, encoding="utf-8")
