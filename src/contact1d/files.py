"""Atomic writing of files, under a temporary name that is renamed; safe reading of text files of a user."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

AnyPath = str | PathLike[str]
PART = ".part"
"""Suffix of a file that is not complete yet."""
FULL_DISK = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "a file would be larger than is allowed (ulimit -f)",
}
"""System errors after which no further file can be written, as text."""


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Provide the temporary path to write to, `path` with ".part" behind it; it replaces `path` after the block.

    Where the block raises an error, `path` remains as it was and the temporary file is left.
    """
    part = path.with_name(path.name + PART)
    yield part
    os.replace(part, path)


class UnreadableError(ValueError):
    """A file that can't be read as text; its arguments are the path, and the reason with what to do."""

    def __str__(self) -> str:
        """Return the path and the reason, "path: reason"."""
        return ": ".join(self.args)


def read_text(path: Path, largest: int = 8_000_000, fallback: str = "") -> str:
    """Return the text of a regular file of at most `largest` bytes, in UTF-8, without a byte-order mark.

    Line ends stay as they are. By default a file may be twice as large as a scene with a measured profile of 1e5
    points. A pipe or a device is not opened, since it may have no end. `fallback`: encoding if it is not UTF-8.

    Raises:
        UnreadableError: there is no such file, it is too large, no regular file or no text, or it cannot be read.
    """
    try:
        if path.stat().st_size > largest:
            reason = f"has {path.stat().st_size} bytes, and at most {largest} are read; make it smaller"
        elif path.is_dir():
            reason = "is a directory; name a file in it"
        elif not path.is_file():
            reason = "is not a regular file (a pipe or a device); save its content in a file"
        else:
            return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        reason = "no such file"
    except UnicodeDecodeError as error:
        if fallback:
            return error.object.decode(fallback)
        reason = f"line {len(error.object[: error.start + 1].splitlines())} is not UTF-8 text; save the file as UTF-8"
    except (OSError, ValueError) as error:
        reason = f"cannot be read: {getattr(error, 'strerror', None) or error}"
    raise UnreadableError(str(path), reason)


def write_whole(path: Path, text: str) -> None:
    """Write a text file in UTF-8 atomically: completely or not at all; an existing file is replaced.

    Where that fails the error is raised, and an incomplete file, `path` with ".part" behind it, may be left.
    """
    with whole(path) as part:
        part.write_text(text, encoding="utf-8")
