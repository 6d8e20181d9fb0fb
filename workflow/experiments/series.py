"""A series: records over time, their means, and the results of a reader with their errors.

A reader makes results of blocks, each a mean over a time that is long against the memory of the motion: a whole period
where a drive repeats itself, a pull where each has a seed of its own. Their errors are found by perturbing it:

    statistics   the reader without one block after the other, a jackknife: n θ − (n − 1) θ₋ᵢ scatters as the blocks of
                 a mean do, whatever function of means θ is
    sampling     the reader on every second record

Errors that the reader determines by itself are kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.friction import block_means, standard_error
from contact1d.workflow.continuation.outcome import LATTICE, Reading, Result

Array = NDArray[np.float64]
Reader = Callable[["Series"], Mapping[str, Reading]]


@dataclass(frozen=True)
class Series:
    """Records in order, or means over blocks of them.

    Attributes:
        columns: recorded quantities by name, (n,), of a profile (n, particles); "time" [TU] where they have one.
        integrals: integrals over time, of quantities that are known between the records as well, by name, (n,).
        smooth: whether columns are the rates of change of integrals of the same name.
    """

    columns: Mapping[str, Array]
    integrals: Mapping[str, Array] = field(default_factory=dict)
    smooth: bool = False

    def __getitem__(self, name: str) -> Array:
        """Return the recorded column of a name, (n,), in its own unit.

        Raises:
            KeyError: there is no such column; integrals are not among them.
        """
        return self.columns[name]

    def __len__(self) -> int:
        """Return the number of records, that of the first column; there must be one."""
        return len(next(iter(self.columns.values())))

    def mean(self, name: str) -> Any:
        """Return the mean of a column over all records in its unit: a number, of a profile an array (particles,)."""
        return self.columns[name].mean(axis=0)

    def table(self) -> dict[str, tuple[float, ...]]:
        """Return the columns by name, as tuples of n numbers, as a file has them; integrals are left out."""
        return {name: tuple(values.tolist()) for name, values in self.columns.items()}

    def chosen(self, records: Any) -> Series:
        """Return the series of the records with given indices, a slice, an array of numbers or a mask.

        Columns and integrals are those of these records.
        """
        columns, integrals = (
            {name: values[records] for name, values in part.items()} for part in (self.columns, self.integrals)
        )
        return Series(columns, integrals, self.smooth)

    def every_second(self) -> Series:
        """Return the series of every second record, counted from the last, and of the first one, in the same order."""
        return self.chosen(np.union1d(0, np.arange(len(self))[::-2]))

    def parts(self, count: int) -> Series:
        """Return the means over `count` parts of about equal length, in order, as a series without integrals.

        With fewer records than parts the means of empty parts are NaN.
        """
        split = {name: np.array_split(values, count) for name, values in self.columns.items()}
        return Series({name: np.asarray([part.mean(axis=0) for part in parts]) for name, parts in split.items()})

    def periods(self, length: float) -> Series:
        """Return the means of quantities with integrals over whole periods of a length [TU], in order, as a series.

        The last period ends with the series, a remainder at its beginning is left out; with less than a period the
        columns are empty. A mean is in the unit of the integral over [TU].
        """
        rates = self.columns if self.smooth else {}
        return Series(
            {
                name: block_means(self["time"], integral, length, rates.get(name))
                for name, integral in self.integrals.items()
            }
        )


def recorded(records: Sequence[object], names: Iterable[str]) -> dict[str, Array]:
    """Return attributes of n records as columns by name, in their own units: (n,), of an array attribute (n, …)."""
    return {name: np.asarray([getattr(record, name) for record in records]) for name in names}


def measured(
    blocks: Series,
    read: Reader,
    error: Callable[[Array], float] = standard_error,
    repeats: Mapping[str, Series] | None = None,
) -> dict[str, Result]:
    """Return the results of a reader with their errors, by name.

    The error "statistics" is `error` of the n values n θ − (n − 1) θ₋ᵢ of a jackknife over the blocks, of a single
    block that of its value θ. The errors of the reader are kept, and replace those of the same source. A result that is
    missing without a block, or in a repeat, counts as 0 there.

    Args:
        blocks: nearly independent of each other.
        read: the reader: returns readings of a series, by name.
        error: a function of n values that returns the error of their mean.
        repeats: blocks of other records, by the source of the error that they show: the change of the result.
    """
    readings, count = read(blocks), len(blocks)
    numbers, missing = np.arange(count), Reading(0.0, "")
    jackknife = [read(blocks.chosen(numbers != number)) for number in numbers] if count > 1 else [readings]
    repeated = {source: read(series) for source, series in (repeats or {}).items()}
    results = {}
    for name, reading in readings.items():
        value = reading.value
        left_out = np.asarray([replicate.get(name, missing).value for replicate in jackknife])
        errors = {"statistics": error(count * value - (count - 1) * left_out)}
        errors |= {source: abs(repeat.get(name, missing).value - value) for source, repeat in repeated.items()}
        errors |= reading.errors
        lattice = reading.errors.get(LATTICE, 0.0)
        results[name] = Result(value, reading.unit, errors, reading.scale, reading.prescribed, lattice)
    return results
