"""A measured profile from a CSV file: the columns r and z, as comma, semicolon, tab or blanks part them."""

from __future__ import annotations

import math
import re
from pathlib import Path

from workflow.scene.profiles import FEWEST


class ProfileFileError(ValueError):
    """A file that is no profile; the message says in which line and what is wrong."""


def read_profile(path: Path, scale: float) -> tuple[list[float], list[float]]:
    """Radii and heights [LU], each of the file's numbers times `scale`.

    Lines that begin with # and empty ones are skipped; the first other line may be names. Further columns are ignored.

    Raises:
        ProfileFileError: if there is no such file, a cell is empty or no number, a line has one column, there are
            fewer than FEWEST points, or a number times `scale` is none that a computer holds.
    """
    try:
        lines = path.read_bytes().decode("utf-8-sig").splitlines()
    except FileNotFoundError:
        raise ProfileFileError(f"there is no file {path}") from None
    except UnicodeDecodeError:
        raise ProfileFileError(f"{path} is no text (UTF-8)") from None
    except OSError as error:
        raise ProfileFileError(f"{path} cannot be read: {error.strerror}") from None
    except ValueError:
        raise ProfileFileError("is no name that a file can have") from None
    rows = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    if rows and not any(_number(cell) is not None for cell in _cells(rows[0][1])):
        rows = rows[1:]
    if not rows:
        raise ProfileFileError(f"{path} has no points")
    points = [_point(path, place, line) for place, line in rows]
    if len(points) < FEWEST:
        raise ProfileFileError(f"{path} must have at least {FEWEST} points, not {len(points)}")
    radii, heights = [scale * r for r, _ in points], [scale * z for _, z in points]
    if not all(map(math.isfinite, radii + heights)):
        raise ProfileFileError(f"{path} has numbers that are too large for the scale {scale:g}")
    return radii, heights


def _point(path: Path, place: int, line: str) -> tuple[float, float]:
    cells = _cells(line)
    at = f"{path.name}, line {place}"
    if len(cells) < 2:
        raise ProfileFileError(f"{at}: {line.strip()[:40]!r} is one column; r and z are needed")
    values = []
    for name, cell in zip("rz", cells, strict=False):
        value = _number(cell)
        if value is None:
            what = f"{cell[:20]!r} is no number" if cell.strip() else "is empty"
            raise ProfileFileError(f"{at}: {name} {what}; leave out a line that has no value, or interpolate it")
        if not math.isfinite(value):
            raise ProfileFileError(f"{at}: {name} is {cell.strip()}; leave out a line that has no value")
        values.append(value)
    return values[0], values[1]


def _cells(line: str) -> list[str]:
    parting = ";" if ";" in line else "," if "," in line else "\t" if "\t" in line else None
    return line.split(parting) if parting else re.split(r"\s+", line.strip())


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None
