"""Rows of a schedule: each kind of step is a fragment `steps/<step>.lmp` and the variables that a row of it gives.

A field `load` is the LAMMPS variable `row_load`. A phase is a named sequence of rows of one kind.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import ClassVar

from contact1d.workflow.deck.effects.base import number

UNITS = (
    dict.fromkeys(("displacement", "place", "parted", "through", "end"), "LU")
    | dict.fromkeys(("load", "rest"), "FU")
    | dict.fromkeys(("damping", "drag"), "FU·TU/LU")
    | {"spring": "FU/LU"}
)
"""Units of the numbers in rows; whole ones have none."""


@dataclass(frozen=True)
class Row:
    """What one row of a schedule prescribes."""

    step: ClassVar[str]
    """The fragment in `lammps_inputs/fragments/steps`."""

    @classmethod
    def columns(cls) -> tuple[str, ...]:
        """Names of the LAMMPS variables, in order."""
        return tuple(f"row_{field.name}" for field in fields(cls))

    def texts(self, to_deck: Callable[[float, str], float]) -> tuple[str, ...]:
        """Their values as LAMMPS text; `to_deck` takes a value with its unit to that of the deck."""
        given = {field.name: getattr(self, field.name) for field in fields(self)}
        return tuple(str(v) if isinstance(v, int) else number(to_deck(v, UNITS[name])) for name, v in given.items())


@dataclass(frozen=True)
class Displace(Row):
    """The plate is put to a displacement [LU] and the particles are brought to rest."""

    step: ClassVar[str] = "displace"
    displacement: float


@dataclass(frozen=True)
class Draw(Row):
    """The plate is put to a displacement and a place along x [LU], in a straight line, its particles with it."""

    step: ClassVar[str] = "sweep_along"
    displacement: float
    place: float


@dataclass(frozen=True)
class DisplaceInTime(Row):
    """The plate is put to a displacement [LU] and the particles move for so many timesteps."""

    step: ClassVar[str] = "displace_dynamic"
    displacement: float
    steps: int


@dataclass(frozen=True)
class UnderLoad(Row):
    """Plate and particles move for so many timesteps under a load [FU], compression positive."""

    step: ClassVar[str] = "load"
    load: float
    steps: int


@dataclass(frozen=True)
class DrawnOff(Row):
    """Plate and particles move while the plate's spring [FU/LU] has its far end at a displacement [LU]."""

    step: ClassVar[str] = "draw"
    spring: float
    end: float
    steps: int


@dataclass(frozen=True)
class Hold(Row):
    """A load [FU], compression positive, until the plate is at rest, parted or through.

    Attributes:
        start: 1: the place is kept to come back to, -1: first go back there, 0: go on.
        load: on the plate [FU].
        damping: coefficient of a particle [FU·TU/LU].
        drag: of the moving bodies over their inertia's share [FU·TU/LU].
        rest: unbalanced force below which the plate is at rest [FU].
        parted, through: displacements [LU] below and above which LAMMPS stops.
        steps: timesteps after which it stops in any case.
    """

    step: ClassVar[str] = "hold"
    start: int
    load: float
    damping: float
    drag: float
    rest: float
    parted: float
    through: float
    steps: int


STEPS: tuple[type[Row], ...] = (Displace, Draw, DisplaceInTime, UnderLoad, DrawnOff, Hold)


@dataclass(frozen=True)
class Phase:
    """A named part of a schedule.

    Attributes:
        name: what happens, one word.
        rows: all of one kind.
        state: whether every atom's place and force are written after the last row.
        begin: fragments that come before the first row.
        kept: with `[output] states`, whether the state of each row is kept; None: of all.
    """

    name: str
    rows: tuple[Row, ...]
    state: bool = False
    begin: tuple[str, ...] = ()
    kept: tuple[bool, ...] | None = None


def displacements(places: Sequence[float]) -> tuple[Displace, ...]:
    """Rows that put the plate to each of the displacements [LU]."""
    return tuple(Displace(float(place)) for place in places)
