"""The table of a sweep: a row for each point, in the order of the axes, with the results in the run folders."""

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
"""File with the sweep as it ran last."""
RUNS = "runs"
"""Folder with the run folders of all points."""
TABLE = "results.csv"
PARQUET = "results.parquet"
STATUS_COLUMNS = ("status", "reason", "run")


@dataclass(frozen=True)
class Answer:
    """The outcome of a point.

    Attributes:
        status: `done`, `failed`, `refused` (no valid scene), or `missing` (not run yet).
        reason: why it is not done, or its warnings.
        run: run folder, relative to that of the sweep; empty where there is none.
        results: the reported results by name, each in SI where the scene gives its unit's size, else in units of the
            model.
    """

    status: str
    reason: str = ""
    run: str = ""
    results: Mapping[str, Quantity] = field(default_factory=dict)


def answer_in(folder: Path) -> Answer | None:
    """Return the outcome of the run in a run folder, "done" or "failed"; None if results.json is missing or invalid.

    Its results are in SI where the scene gives the size of their unit, else in units of the model; those without a
    value are left out. Its reason is the message of the error, or "warnings: " and their names, or "" without any.
    """
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
    """Write results.csv, in two passes over the runs with a single run in memory; an earlier file is replaced.

    Columns are the axes, status, reason, run, and each result with its uncertainty; one in SI has its unit in its name.
    A result that a run lacks, or whose unit differs from that in the first run that has it, is left empty.

    Args:
        folder: folder of the sweep.
        axes: axes of the sweep.
        rows: returns the rows in order, each time anew: (cells of the axes, outcome).

    Returns:
        The unit of each result by name, of SI or of the model, from the first run that has it; {} without results.
    """
    units = _units(answer for _, answer in rows())
    columns = [column for name in units for column in columns_of(name)]
    of_axes = {axis.key: axis.numbers[1] for axis in axes if axis.numbers[1]}
    of_results = {column: unit for name, unit in units.items() if unit not in SI for column in columns_of(name)}
    with whole(folder / TABLE) as part, part.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headed([*(axis.key for axis in axes), *STATUS_COLUMNS, *columns], of_axes | of_results))
        for cells, answer in rows():
            numbers = {
                name: (quantity.value, quantity.uncertainty)
                for name, quantity in answer.results.items()
                if quantity.unit == units[name]
            }
            results = chain.from_iterable(numbers.get(name, ("", "")) for name in units)
            writer.writerow(map(as_text, [*cells, answer.status, answer.reason, answer.run, *results]))
    return units


def columns_of(name: str) -> tuple[str, str]:
    """Return the names of the two columns of a result in the table: (of its value, of its uncertainty)."""
    return name, f"{name}_uncertainty"


def frame_of(folder: Path) -> DataFrame:
    """Return results.csv of a sweep as a pandas.DataFrame, a row for each point, in order.

    A column in SI has its unit in its name, as in `radius [m]`; without one, results are in units of the model. Empty
    cells are NaN. Texts lack the apostrophe by which no spreadsheet takes them for a formula, `'=1+1` in the file.

    Raises:
        FileNotFoundError: the folder has no results.csv.
    """
    import pandas

    return pandas.read_csv(folder / TABLE, float_precision="round_trip").replace(MARKED, r"\1", regex=True)


def write_parquet(folder: Path) -> None:
    """Write the table in results.csv as results.parquet as well, in place of an earlier one; NaN for empty cells.

    Raises:
        FileNotFoundError: the folder has no results.csv.
        Contact1dError: pyarrow isn't installed.
    """
    if find_spec("pyarrow") is None:
        raise Contact1dError("Parquet needs pyarrow: install it with pip install 'contact1d[tables]'")
    with whole(folder / PARQUET) as part:
        frame_of(folder).to_parquet(part, index=False)


def document_in(folder: Path) -> dict[str, Any]:
    """Return the content of results.json in a run folder, also of a run that failed.

    An empty dict where it can't be read or is none of a run.
    """
    try:
        return read_results(folder)
    except FolderError:
        return {}


def read_record(folder: Path) -> SweepPlan:
    """Return the sweep in a folder as it ran last, with the base scene in its record.

    Raises:
        FolderError: the folder holds no record of a sweep.
    """
    try:
        return read_sweep(folder / RECORD)
    except SceneError:
        raise FolderError(f"{folder / RECORD} is not the record of a sweep: start the sweep again") from None


def units_in(folder: Path) -> dict[str, str]:
    """Return the unit of each result of a sweep by name, of SI or of the model, from the first run that has it.

    The runs of the table in `folder` are read; points that did not run have none. Empty without results.

    Raises:
        FileNotFoundError: the folder has no results.csv.
    """
    return _units(filter(None, (answer_in(folder / row["run"]) for row in read_table(folder))))


def _units(answers: Iterable[Answer]) -> dict[str, str]:
    """Return the unit of each result, as text, in the first run that has it, by name; empty without results."""
    units: dict[str, str] = {}
    for answer in answers:
        for name, quantity in answer.results.items():
            units.setdefault(name, quantity.unit)
    return units


def counts_in(folder: Path) -> dict[str, int]:
    """Return how many points of a sweep's table ended as `done`, `failed`, `refused`, or are `missing`, by status.

    A status that no point has is left out.

    Raises:
        FileNotFoundError: the folder has no results.csv.
    """
    return dict(Counter(row["status"] for row in read_table(folder)))


def read_table(folder: Path) -> Iterator[dict[str, str]]:
    """Yield the rows of results.csv as dicts: cells as text, "" for empty ones, by the names of columns without units.

    Texts lack the apostrophe by which no spreadsheet takes them for a formula, `'=1+1` in the file.

    Raises:
        FileNotFoundError: with the first row that is asked for; the folder has no results.csv.
    """
    with (folder / TABLE).open(newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        names = [*map(bare, next(rows))]
        yield from (dict(zip(names, map(plain, row), strict=True)) for row in rows)


def bare(header: str) -> str:
    """Return the name of a column without its unit, `force` of `force [N]`; a header without one as it is."""
    return match[1] if (match := HEADER.fullmatch(header)) else header
