"""Which rows of a schedule have their state in states.lammpstrj, as `[output] states` asks.

A frame is a row's own, or that of a phase whose last state is written anyway: then the row has none of its own. Python
runs a search without knowing what comes, so that it writes all of them and then leaves out those that are not wanted.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from contact1d.files import whole
from contact1d.workflow.deck.steps import Phase

STATES = "states.lammpstrj"
FRAME = b"ITEM: TIMESTEP\n"
NONE, NEW, APPENDED = "none", "no", "yes"
"""What `row_append` of `fragments/steps/kept.lmp` may be."""


def chosen(rows: Sequence[int], wanted: int | str, marked: Collection[int] = ()) -> list[int]:
    """The numbers among `rows`, rising, that are kept: all, or so many evenly, with the `marked` ones among them."""
    if wanted == "all" or len(rows) <= int(wanted):
        return list(rows)
    found = {rows[i] for i in np.linspace(0, len(rows) - 1, int(wanted)).round().astype(int)}
    ends = {rows[0], rows[-1]}
    for mark in sorted({*marked} & {*rows}):
        replaceable = found - ends - {*marked}
        if mark not in found and replaceable:
            found.remove(min(replaceable, key=lambda row: abs(row - mark)))
        found.add(mark)
    return sorted(found)


def marked_rows(phases: Sequence[Phase]) -> list[int]:
    """Numbers, over all phases, of the rows whose state a phase writes at its end."""
    ends = np.cumsum([len(phase.rows) for phase in phases]).tolist()
    return [end - 1 for phase, end in zip(phases, ends, strict=True) if phase.state and phase.rows]


def keeping(phases: Sequence[Phase], rows: Collection[int]) -> tuple[Phase, ...]:
    """The phases with the rows of these numbers kept."""
    found, first = [], 0
    for phase in phases:
        found.append(replace(phase, kept=tuple(first + i in rows for i in range(len(phase.rows)))))
        first += len(phase.rows)
    return tuple(found)


def appended(phase: Phase, in_one_run: bool, first: bool) -> list[str]:
    """`row_append` of each row of a phase; `first`: no frame has been written before it."""
    wanted = _kept(phase)
    if phase.state and not in_one_run:
        wanted[-1] = False
    words = []
    for keep in wanted:
        words.append((NEW if first else APPENDED) if keep else NONE)
        first = first and not keep
    return words


def skipped(phase: Phase) -> list[int]:
    """0 for each row of a phase that is kept, where rows are steps of one run; 1 for the others."""
    return [int(not keep) for keep in _kept(phase)]


def _kept(phase: Phase) -> list[bool]:
    wanted = list(phase.kept) if phase.kept is not None else [True] * len(phase.rows)
    if phase.state:
        wanted[-1] = True
    return wanted


def leave_out(folder: Path, phases: Sequence[Phase], in_one_run: bool) -> None:
    """Rewrite the states of a run that has written one frame for each row, and one more where a phase has a state."""
    wanted: list[bool] = []
    for phase in (phase for phase in phases if phase.rows):
        rows = [word != NONE for word in appended(phase, in_one_run, first=False)]
        wanted += rows if in_one_run or not phase.state else [*rows, True]
    with whole(folder / STATES) as part, part.open("wb") as kept:
        frames = _frames(folder / STATES)
        for keep, frame in zip(wanted, frames, strict=True):
            if keep:
                kept.write(frame)


def _frames(path: Path) -> Iterator[bytes]:
    """The frames of a dump, one in memory at a time."""
    lines: list[bytes] = []
    with path.open("rb") as file:
        for line in file:
            if line == FRAME and lines:
                yield b"".join(lines)
                lines = []
            lines.append(line)
    if lines:
        yield b"".join(lines)
