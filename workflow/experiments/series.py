"""A series: what is recorded over time, its means, and the results of one reader with their errors.

A reader makes results of blocks, each a mean over a time that is long against the memory of the motion: a whole period
where a drive repeats itself, a pull where each has a seed of its own. Their errors are found by perturbing it:

    statistics   the reader without one block after the other, as the jackknife has it: n θ − (n − 1) θ₋ᵢ scatters as
                 the blocks of a mean do, whatever is made of means
    sampling     the reader on what every second record says

What a reader determines by itself stays as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.friction import block_means, standard_error
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.outcome import LATTICE, Reading, Result
from contact1d.workflow.deck.steps import Phase, Row

Array = NDArray[np.float64]
Reader = Callable[["Series"], Mapping[str, Reading]]
MISSING = Reading(0.0, "")
"""A result that other blocks do not have may be 0."""


@dataclass(frozen=True)
class Series:
    """Records in order, or means over blocks of them.

    Attributes:
        columns: what was recorded, by name, (n,), of a profile (n, particles); "time" [TU] where they have one.
        integrals: over the time, of what is known between the records as well, by name, (n,).
        smooth: whether columns are the rates of change of integrals of the same name.
    """

    columns: Mapping[str, Array]
    integrals: Mapping[str, Array] = field(default_factory=dict)
    smooth: bool = False

    def __getitem__(self, name: str) -> Array:
        """A column."""
        return self.columns[name]

    def __len__(self) -> int:
        """How many records."""
        return len(next(iter(self.columns.values())))

    def mean(self, name: str) -> Any:
        """Of a column: a number, of a profile an array (particles,)."""
        return self.columns[name].mean(axis=0)

    def table(self) -> dict[str, tuple[float, ...]]:
        """The columns as a file has them."""
        return {name: tuple(values.tolist()) for name, values in self.columns.items()}

    def chosen(self, records: Any) -> Series:
        """The records of these numbers: a slice or an array."""
        columns, integrals = ({n: one[records] for n, one in each.items()} for each in (self.columns, self.integrals))
        return Series(columns, integrals, self.smooth)

    def every_second(self) -> Series:
        """Every second record, the first and the last one among them."""
        return self.chosen(np.union1d(0, np.arange(len(self))[::-2]))

    def parts(self, count: int) -> Series:
        """Means over so many parts."""
        split = {name: np.array_split(values, count) for name, values in self.columns.items()}
        return Series({name: np.asarray([one.mean(axis=0) for one in parts]) for name, parts in split.items()})

    def periods(self, length: float) -> Series:
        """Means of what is integrated over whole periods [TU]; see `block_means`."""
        rates = self.columns if self.smooth else {}
        means = {n: block_means(self["time"], one, length, rates.get(n)) for n, one in self.integrals.items()}
        return Series(means)


def recorded(records: Sequence[object], names: Iterable[str]) -> dict[str, Array]:
    """Columns of a series: attributes of what was recorded."""
    return {name: np.asarray([getattr(one, name) for one in records]) for name in names}


def measured(
    blocks: Series,
    read: Reader,
    error: Callable[[Array], float] = standard_error,
    others: Mapping[str, Series] | None = None,
) -> dict[str, Result]:
    """The results with their errors.

    Args:
        blocks: nearly independent of each other.
        read: the reader.
        error: of the mean of blocks (n,).
        others: by the source of the error that they show, the blocks by other records.
    """
    readings, count = read(blocks), len(blocks)
    every = np.arange(count)
    left_out = [read(blocks.chosen(every != one)) for one in every] if count > 1 else [readings]
    again = {source: read(other) for source, other in (others or {}).items()}
    found = {}
    for name, one in readings.items():
        rest = np.asarray([other.get(name, MISSING).value for other in left_out])
        errors = {"statistics": error(count * one.value - (count - 1) * rest)}
        errors |= {source: abs(other.get(name, MISSING).value - one.value) for source, other in again.items()}
        errors |= one.errors
        found[name] = Result(one.value, one.unit, errors, one.scale, one.prescribed, one.errors.get(LATTICE, 0.0))
    return found


def begun(contact: Contact, phase: Phase) -> Sequence[Row]:
    """The load steps of a phase, which begins."""
    contact.begin(phase.name, phase.begin, sum(getattr(row, "steps", 0) for row in phase.rows))
    return phase.rows
