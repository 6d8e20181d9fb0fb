"""One table of all results: a row for each point, in the order of the axes, from what the run folders hold."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.util import find_spec
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contact1d.analysis.curve import HEADER, MARKED, as_text, headed, plain
from contact1d.files import whole
from contact1d.workflow.errors import Contact1dError, FolderError
from contact1d.workflow.runs.report import quantities_in, read_results
from contact1d.workflow.scene import SceneError
from contact1d.workflow.sweep.axes import Axis, SweepPlan, read_sweep
from contact1d.workflow.units import SI, Quantity

if TYPE_CHECKING:
    from pandas import DataFrame

RECORD = "sweep.toml"
"""The sweep, as it ran last."""
RUNS = "runs"
"""Folder of the run folders."""
TABLE = "results.csv"
PARQUET = "results.parquet"
MANY_ROWS = 100_000
"""Rows from which on the table is written as Parquet as well."""
FIXED = ("status", "reason", "run")


@dataclass(frozen=True)
class Answer:
    """What became of a point: `done`, `failed`, `refused` (no run can be made of it), or `missing` so far.

    Attributes:
        run: its folder, relative to the sweep's; empty where there is none.
        results: those that are reported.
    """

    status: str
    reason: str = ""
    run: str = ""
    results: Mapping[str, Quantity] = field(default_factory=dict)


def answer_in(folder: Path) -> Answer | None:
    """What the run in a folder of a sweep says; None where none came to its end there."""
    document = document_in(folder)
    if not document:
        return None
    named = ", ".join(warning["name"] for warning in document["warnings"])
    reason = document["error"]["message"] if document["status"] == "failed" else f"warnings: {named}" if named else ""
    results = {name: Quantity.of(entry) for name, entry in quantities_in(document).items()}
    return Answer(document["status"], reason, f"{RUNS}/{folder.name}", results)


def write_table(
    folder: Path, axes: Sequence[Axis], rows: Callable[[], Iterable[tuple[tuple[Any, ...], Answer]]]
) -> dict[str, str]:
    """Write results.csv, in SI where it is known. Two passes over the runs, one of them in memory at a time.

    Args:
        folder: of the sweep.
        axes: with their values.
        rows: makes the rows, in order: cells of the axes, and the answer.

    Returns:
        The quantities: names, and the unit of each.
    """
    units = _units(answer for _, answer in rows())
    columns = [column for name in units for column in columns_of(name)]
    of_axes = {axis.key: axis.numbers[1] for axis in axes if axis.numbers[1]}
    of_results = {column: unit for name, unit in units.items() if unit not in SI for column in columns_of(name)}
    with whole(folder / TABLE) as part, part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headed([*(axis.key for axis in axes), *FIXED, *columns], of_axes | of_results))
        for cells, answer in rows():
            own = {name: one for name, one in answer.results.items() if one.unit == units[name]}
            numbers = {name: (one.value, one.uncertainty) for name, one in own.items()}
            results = chain.from_iterable(numbers.get(name, ("", "")) for name in units)
            writer.writerow(map(as_text, [*cells, answer.status, answer.reason, answer.run, *results]))
    return units


def columns_of(name: str) -> tuple[str, str]:
    """The columns of a result."""
    return name, f"{name}_uncertainty"


def frame_of(folder: Path) -> DataFrame:
    """The table as a pandas.DataFrame, its texts without the mark of a spreadsheet."""
    import pandas

    return pandas.read_csv(folder / TABLE, float_precision="round_trip").replace(MARKED, r"\1", regex=True)


def write_parquet(folder: Path) -> None:
    """The table again as results.parquet. Raises Contact1dError where pyarrow isn't installed."""
    if find_spec("pyarrow") is None:
        raise Contact1dError("Parquet needs pyarrow: install it with pip install 'contact1d[tables]'")
    with whole(folder / PARQUET) as part:
        frame_of(folder).to_parquet(part, index=False)


def document_in(folder: Path) -> dict[str, Any]:
    """What results.json in a run folder holds; nothing where it can't be read."""
    try:
        return read_results(folder)
    except FolderError:
        return {}


def read_record(folder: Path) -> SweepPlan:
    """The sweep in a folder, as it ran last. Raises FolderError."""
    try:
        return read_sweep(folder / RECORD)
    except SceneError:
        raise FolderError(f"{folder / RECORD} is not the record of a sweep: start the sweep again") from None


def units_in(folder: Path) -> dict[str, str]:
    """The results of a sweep by name, with their units."""
    return _units(filter(None, (answer_in(folder / row["run"]) for row in read_table(folder))))


def _units(answers: Iterable[Answer]) -> dict[str, str]:
    """The unit of each result, as the first run that has it gives it."""
    units: dict[str, str] = {}
    for answer in answers:
        for name, one in answer.results.items():
            units.setdefault(name, one.unit)
    return units


def counts_in(folder: Path) -> dict[str, int]:
    """How many points of a sweep's table ended as `done`, `failed`, `refused`, or are `missing`."""
    return dict(Counter(row["status"] for row in read_table(folder)))


def read_table(folder: Path) -> Iterator[dict[str, str]]:
    """The rows of results.csv, one by one, by names without units, cells as text."""
    with (folder / TABLE).open(newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        names = [*map(bare, next(rows))]
        yield from (dict(zip(names, map(plain, row), strict=True)) for row in rows)


def bare(header: str) -> str:
    """The name of a column without its unit."""
    return found[1] if (found := HEADER.fullmatch(header)) else header
