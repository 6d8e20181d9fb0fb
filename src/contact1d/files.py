"""Files that are whole or not there: written under a temporary name, then renamed."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PART = ".part"
"""What ends the name of a file that is not whole yet."""


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
