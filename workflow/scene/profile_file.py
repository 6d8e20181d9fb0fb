"""A measured profile from a CSV file: the columns r and z, as comma, semicolon, tab or blanks part them."""

from __future__ import annotations

import math
import re
from pathlib import Path

from contact1d.workflow.scene.profiles import FEWEST_POINTS


class ProfileFileError(ValueError):
    """A file that is no profile; the message says in which line and what is wrong."""


def read_profile(path: Path, scale: float) -> tuple[list[float], list[float]]:
    """Radii and heights [LU], each of the file's numbers times `scale`.

    Messages name lines and never quote them: a path in a scene may point at any file.

    Lines that begin with # and empty ones are skipped; the first other line may be names. Further columns are ignored.

    Raises:
        ProfileFileError: if there is no such file, a cell is empty or no number, a line has one column, there are
            fewer than FEWEST_POINTS points, or a number times `scale` is none that a computer holds.
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
    columns = (0, 1)
    if rows and not any(_number(cell) is not None for cell in _cells(rows[0][1])):
        columns = _columns(path, *rows[0])
        rows = rows[1:]
    if not rows:
        raise ProfileFileError(f"{path} has no points")
    points = [_point(path, place, line, columns) for place, line in rows]
    if len(points) < FEWEST_POINTS:
        raise ProfileFileError(f"{path} must have at least {FEWEST_POINTS} points, not {len(points)}")
    radii, heights = [scale * r for r, _ in points], [scale * z for _, z in points]
    if not all(map(math.isfinite, radii + heights)):
        raise ProfileFileError(f"{path} has numbers that are too large for the scale {scale:g}")
    return radii, heights


def _columns(path: Path, place: int, line: str) -> tuple[int, int]:
    """Where r and z stand by their names; two columns of other names are r and z in this order."""
    names = [(re.match(r"\w+", cell.strip().lower()) or [""])[0] for cell in _cells(line)]
    if "r" in names and "z" in names:
        return names.index("r"), names.index("z")
    if len(names) == 2 and not {"r", "z"} & set(names):
        return 0, 1
    raise ProfileFileError(
        f"{path.name}, line {place}: {len(names)} columns without numbers, and no names r and z among them; name the "
        "radius r and the height z, or leave the names out and have these two columns in this order"
    )


def _point(path: Path, place: int, line: str, columns: tuple[int, int]) -> tuple[float, float]:
    cells = _cells(line)
    at = f"{path.name}, line {place}"
    if len(cells) <= max(columns):
        many = "has one column" if len(cells) == 1 else f"has {len(cells)} columns"
        raise ProfileFileError(f"{at}: {many}; r and z are needed")
    values = []
    for name, cell in zip("rz", (cells[column] for column in columns), strict=True):
        value = _number(cell)
        if value is None:
            what = "is no number" if cell.strip() else "is empty"
            hint = "leave out a line that has no value, or interpolate it"
            if _number(cell.replace(",", ".")) is not None:
                hint = "write it with a decimal point"
            raise ProfileFileError(f"{at}: {name} {what}; {hint}")
        if not math.isfinite(value):
            raise ProfileFileError(f"{at}: {name} is {value}; leave out a line that has no value")
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
