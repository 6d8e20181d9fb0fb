"""Rows of a schedule: a kind of row is a fragment `steps/<step>.lmp` and the variables whose values a row gives.

A field `load` is the LAMMPS variable `row_load`. A phase is a named sequence of rows of one kind.

`[output] states` asks for the number of rows whose states are in states.lammpstrj. Each has one frame: that of the
row, or that of its phase, where this writes its last state anyway. A search does not know its rows in advance: it
writes all states, and afterwards removes those that are not wanted.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import groupby
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from contact1d.files import whole
from contact1d.workflow.deck.effects import number
from contact1d.workflow.scene import Scene

UNITS = (
    dict.fromkeys(("displacement", "place", "parted", "through", "end", "edge", "reach", "height"), "LU")
    | dict.fromkeys(("load", "rest"), "FU")
    | dict.fromkeys(("damping", "drag"), "FU·TU/LU")
    | {"spring": "FU/LU", "duration": "TU", "velocity": "LU/TU", "slip": "LU/TU"}
)
"""Units of the numbers in rows; integers have none."""


@dataclass(frozen=True)
class Row:
    """The values that one row of a schedule prescribes."""

    step: ClassVar[str]
    """The fragment in `lammps_inputs/fragments/steps`."""

    @classmethod
    def columns(cls) -> tuple[str, ...]:
        """Return the names of the LAMMPS variables of such a row, in order: "row_" and the name of each field."""
        return tuple(f"row_{field.name}" for field in fields(cls))

    def texts(self, to_deck: Callable[[float, str], float]) -> tuple[str, ...]:
        """Return the values of the fields as LAMMPS text, in order; whole numbers are not converted.

        `to_deck` converts a value with its unit, "LU" for instance, to that of the deck.
        """
        return tuple(
            str(value) if isinstance(value, int) else number(to_deck(value, UNITS[name]))
            for name, value in vars(self).items()
        )


@dataclass(frozen=True)
class Displace(Row):
    """The plate is set to a displacement [LU] and the particles relax."""

    step = "displace"
    displacement: float


@dataclass(frozen=True)
class Cohere(Displace):
    """The plate is set to a displacement [LU], with the contact edge there of adhesion with a range or a rate.

    Attributes:
        edge, reach: distances up to which the bodies touch and attract each other [LU].
        height: mean of g(x) over the contact [LU].
    """

    step = "sweep_cohesive"
    edge: float
    reach: float
    height: float


@dataclass(frozen=True)
class Spend(Displace):
    """The plate reaches a displacement [LU] after a duration [TU] with a velocity [LU/TU], positive in approach."""

    step = "sweep_timed"
    duration: float
    velocity: float


@dataclass(frozen=True)
class Draw(Row):
    """The plate moves to a displacement and a position along x [LU], in a straight line, its particles with it.

    Attributes:
        displacement: towards the other body [LU].
        place: position along x [LU].
    """

    step = "sweep_along"
    displacement: float
    place: float


@dataclass(frozen=True)
class DisplaceInTime(Row):
    """The plate is set to a displacement [LU] and the particles move for a number of timesteps."""

    step = "displace_dynamic"
    displacement: float
    steps: int


@dataclass(frozen=True)
class UnderLoad(Row):
    """Plate and particles move for a number of timesteps under a load [FU], compression positive."""

    step = "load"
    load: float
    steps: int


@dataclass(frozen=True)
class Launch(Row):
    """The plate moves for a number of timesteps, at first towards the plane at a velocity [LU/TU] > 0."""

    step = "launch"
    velocity: float
    steps: int


@dataclass(frozen=True)
class LaunchAlong(Launch):
    """The plate also moves along x, at first at the velocity of the contact point, `slip` [LU/TU]."""

    step = "launch_along"
    slip: float


@dataclass(frozen=True)
class Fly(Row):
    """The plate moves on for a number of timesteps."""

    step = "fly"
    steps: int


@dataclass(frozen=True)
class DrawnOff(Row):
    """Plate and particles move while the plate's spring [FU/LU] has its far end at a displacement [LU]."""

    step = "draw"
    spring: float
    end: float
    steps: int


@dataclass(frozen=True)
class Hold(Row):
    """A load [FU], compression positive, until the plate is at rest, parted or through.

    Attributes:
        start: 1: the position is saved, -1: the saved position is restored first, 0: neither.
        load: on the plate [FU].
        damping: coefficient of a particle [FU·TU/LU].
        drag: that of plate and particles together, over the ratio of the moving mass to the plate's [FU·TU/LU].
        rest: the plate is at rest where its mass times |acceleration| plus `drag` times |velocity| is below it [FU].
        parted, through: displacements [LU] below and above which LAMMPS stops.
        steps: largest number of timesteps.
    """

    step = "hold"
    start: int
    load: float
    damping: float
    drag: float
    rest: float
    parted: float
    through: float
    steps: int


def launch(scene: Scene, velocity: float, steps: int) -> Launch:
    """Return the first row of an impact at a `velocity` [LU/TU] for a number of timesteps, along x where it slips."""
    return LaunchAlong(velocity, steps, scene.slip_velocity) if scene.is_oblique else Launch(velocity, steps)


STEPS: tuple[type[Row], ...] = (
    Displace,
    Cohere,
    Spend,
    Draw,
    DisplaceInTime,
    UnderLoad,
    Launch,
    LaunchAlong,
    Fly,
    DrawnOff,
    Hold,
)


@dataclass(frozen=True)
class Phase:
    """A named part of a schedule.

    Attributes:
        name: one word for its motion, "loading" for instance.
        rows: all of one kind.
        state: whether every atom's position and force are written after the last row.
        begin: fragments that come before the first row.
        kept: with `[output] states`, whether the state of each row is kept, one for each row; None: all are.
    """

    name: str
    rows: tuple[Row, ...]
    state: bool = False
    begin: tuple[str, ...] = ()
    kept: tuple[bool, ...] | None = None


def numbered(name: str, taken: Sequence[str]) -> str:
    """Return the name of a phase: "loading", and where that is taken, "loading_2", "loading_3", …

    The number is one more than that of the names in `taken`, those of the phases before it, that are `name` alone or
    `name` and "_…". `name` itself has no "_".
    """
    count = 1 + sum(phase.partition("_")[0] == name for phase in taken)
    return name if count == 1 else f"{name}_{count}"


def phase_names(names: Iterable[str]) -> list[str]:
    """Return the names of phases, one for each load step, with a number where a name comes again after another one.

    "loading", "unloading", "loading_2"; load steps in succession with the same name are one phase.
    """
    counts, phases = Counter[str](), list[str]()
    for name, steps in groupby(names):
        counts[name] += 1
        phases += [name if counts[name] == 1 else f"{name}_{counts[name]}"] * len(list(steps))
    return phases


def last_steps(phases: Sequence[str]) -> dict[str, int]:
    """Return the number of the last load step of each phase, by the phase's name, from one name for each load step."""
    return {name: number for number, name in enumerate(phases)}


SWEPT: tuple[type[Row], ...] = (Displace, Cohere, Spend, Draw)
"""Kinds of rows that are one timestep each on a rigid plane."""


def swept(columns: Mapping[str, NDArray[np.float64]]) -> list[Row]:
    """Return the rows of load steps on a rigid plane with these columns, (m,), by field name: a row for each element.

    Names and their order choose the kind of row: `Displace`, `Cohere`, `Spend` or `Draw`. Numbers are in units of the
    scene.

    Raises:
        StopIteration: no kind of row has these fields.
    """
    variables = tuple(f"row_{name}" for name in columns)
    kind = next(kind for kind in SWEPT if kind.columns() == variables)
    return [kind(*numbers) for numbers in zip(*(column.tolist() for column in columns.values()), strict=True)]


def displacements(positions: Iterable[float]) -> tuple[Displace, ...]:
    """Return rows that set the plate to each of the displacements [LU], compression positive, in order; () for none."""
    return tuple(Displace(float(position)) for position in positions)


STATES = "states.lammpstrj"
FRAME = b"ITEM: TIMESTEP\n"
NONE, NEW, APPENDED = "none", "no", "yes"
"""Values of `row_append` in `fragments/steps/kept.lmp`."""


def chosen(rows: Sequence[int], wanted: int | str, marked: Collection[int] = ()) -> list[int]:
    """Return the numbers of the rows to keep, rising: all, or as many as `wanted`, evenly spaced, with the `marked`.

    All where `wanted` is "all" or no less than their number. The first and the last are kept. A marked row takes the
    place of the nearest other one that is neither marked nor the first or the last; without such a one it is added, so
    that there are more than `wanted`.

    Args:
        rows: numbers of the rows, rising.
        wanted: number of rows, 2 at least, or "all".
        marked: numbers of rows that are kept in any case; those that are not among `rows` are ignored.
    """
    if wanted == "all" or len(rows) <= int(wanted):
        return list(rows)
    kept = {rows[i] for i in np.linspace(0, len(rows) - 1, int(wanted)).round().astype(int)}
    ends = {rows[0], rows[-1]}
    for mark in sorted({*marked} & {*rows}):
        replaceable = kept - ends - {*marked}
        if mark not in kept and replaceable:
            kept.remove(min(replaceable, key=lambda row: abs(row - mark)))
        kept.add(mark)
    return sorted(kept)


def marked_rows(phases: Sequence[Phase]) -> list[int]:
    """Return the numbers of the last rows of phases that write a state at their end, rising, from 0 over all phases.

    Phases without rows are left out.
    """
    ends = np.cumsum([len(phase.rows) for phase in phases]).tolist()
    return [end - 1 for phase, end in zip(phases, ends, strict=True) if phase.state and phase.rows]


def keeping(phases: Sequence[Phase], rows: Collection[int]) -> tuple[Phase, ...]:
    """Return copies of the phases with `kept` set: true for the rows of these numbers, false for the others.

    Rows are numbered from 0 over all phases.
    """
    result, first = [], 0
    for phase in phases:
        result.append(replace(phase, kept=tuple(first + i in rows for i in range(len(phase.rows)))))
        first += len(phase.rows)
    return tuple(result)


def appended(phase: Phase, in_one_run: bool, first: bool) -> list[str]:
    """Return `row_append` of each row of a phase: "none" writes no state, "no" begins the file, "yes" appends to it.

    Of the last row of a phase with a state it is "none", since the phase writes that state itself, unless rows are
    `in_one_run`. The others are written where `phase.kept` is true; where that is None all are. "no" is that of one row
    at most, the first that is written, and only if `first`: no frame has been written before the phase. [] of a phase
    without rows and state; with a state it must have rows.
    """
    wanted = _kept(phase)
    if phase.state and not in_one_run:
        wanted[-1] = False
    words = []
    for keep in wanted:
        words.append((NEW if first else APPENDED) if keep else NONE)
        first = first and not keep
    return words


def skipped(phase: Phase) -> list[int]:
    """Return a number for each row of a phase whose rows are steps of one run: 0 where its state is kept, else 1.

    Kept are the rows where `phase.kept` is true, all where it is None, and the last row where the phase has a state.
    """
    return [int(not keep) for keep in _kept(phase)]


def _kept(phase: Phase) -> list[bool]:
    """Return whether the state of each row of a phase is kept, by `phase.kept`; without it all are.

    Always of the last one where the phase has a state; then it must have rows.
    """
    wanted = list(phase.kept) if phase.kept is not None else [True] * len(phase.rows)
    if phase.state:
        wanted[-1] = True
    return wanted


def leave_out(folder: Path, phases: Sequence[Phase], in_one_run: bool) -> None:
    """Rewrite states.lammpstrj in a folder without the frames of rows that are not kept; whole or not at all.

    The run has written one frame for each row, and one more where a phase has a state and rows are not `in_one_run`; of
    the last row of such a phase the latter is kept. Phases without rows have none.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: the file has another number of frames; it is left as it was.
    """
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
    """Yield the frames of a dump as bytes, in order, with one in memory at a time; none of an empty file."""
    lines: list[bytes] = []
    with path.open("rb") as file:
        for line in file:
            if line == FRAME and lines:
                yield b"".join(lines)
                lines = []
            lines.append(line)
    if lines:
        yield b"".join(lines)
