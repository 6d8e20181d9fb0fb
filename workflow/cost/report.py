"""The output of a cost study: cost.json, the table for a terminal and for pages, what to do, the figure."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING, NamedTuple

from pydantic import TypeAdapter

from contact1d.analysis.chart import THEORY
from contact1d.analysis.plots import new_figure, save_figure
from contact1d.files import write_whole
from contact1d.workflow.continuation.outcome import Result
from contact1d.workflow.errors import SceneEdit
from contact1d.workflow.runs.advised import in_words

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAVED, SAVED_SHARE = 0.1, 0.1
"""CPU time [s], and its part of that of the scene, which a change saves at least to be recommended."""
ROUNDED_UP = 1.05
"""A bound with two digits over the bound."""


class Error(NamedTuple):
    """A relative error of a result, or an upper bound of it."""

    relative: float
    is_bound: bool = False

    def __str__(self) -> str:
        """`0.00012`, or `less than 0.00013`."""
        return f"less than {ROUNDED_UP * self.relative:.2g}" if self.is_bound else f"{self.relative:.2g}"


@dataclass(frozen=True)
class Measured:
    """The runs of a scene, and how it compares with the reference.

    Attributes:
        results: of all runs the same.
        cpu_runs: CPU time of each, of LAMMPS and the program together, without figures [s].
        warnings: names of the warnings, then of the results that miss the tolerance.
        failure: why there are no numbers, "" where there are.
        edit: what is changed in the scene, as `contact1d run` takes it; the key that it is about first.
        errors: of the main results, against the reference.
        dominant: the largest source in the budget of the result with the largest error.
    """

    results: Mapping[str, Result] = field(default_factory=dict)
    cpu_runs: tuple[float, ...] = ()
    warnings: tuple[str, ...] = ()
    failure: str = ""
    edit: SceneEdit = field(default_factory=SceneEdit)
    errors: Mapping[str, Error] = field(default_factory=dict)
    dominant: str = ""

    @property
    def cpu_s(self) -> float:
        """Median CPU time [s]."""
        return median(self.cpu_runs or (math.nan,))

    @property
    def change(self) -> tuple[str, str]:
        """`accuracy.tolerance` and `0.01`; `without` and an effect."""
        setting, value = next(iter(self.edit.values.items()), ("without", "".join(self.edit.without)))
        return setting, str(value)

    @property
    def error(self) -> Error:
        """The largest of the errors; infinite where there is none."""
        return max(self.errors.values(), default=Error(math.inf))


@dataclass(frozen=True)
class CostRecord:
    """A whole study.

    Attributes:
        title, tolerance: of the scene.
        reference_tolerance, reference: of the reference, with its main results.
        rows: tolerances from coarse to fine, the scene's own among them, then settings, then effects left out.
    """

    title: str
    tolerance: float
    reference_tolerance: float
    reference: Mapping[str, Result]
    rows: tuple[Measured, ...]

    @property
    def own(self) -> Measured:
        """The scene as it is."""
        return next(one for one in self.rows if one.edit.values == {"accuracy.tolerance": self.tolerance})

    def new_warnings(self, one: Measured) -> list[str]:
        """What a variant warns of, and the scene as it is does not."""
        return [name for name in one.warnings if name not in self.own.warnings]

    @property
    def advice(self) -> str:
        """The cheapest variant within the tolerance that warns of nothing new, where it saves time."""
        own = self.own
        fit = [one for one in self.rows if one.error.relative <= self.tolerance and not self.new_warnings(one)]
        best = min(fit, key=lambda one: one.cpu_s, default=own)
        if own in fit and own.cpu_s - best.cpu_s < max(SAVED, SAVED_SHARE * own.cpu_s):
            least = f"{SAVED:g} s and {SAVED_SHARE:.0%} of the time"
            return f"Keep the scene as it is: no variant within its tolerance saves {least}."
        if not fit:
            return "Neither the scene as it is nor a variant is known to be within its tolerance."
        return f"Use {in_words(best.edit)}: error {best.error}, {best.cpu_s:.2g} s in place of {own.cpu_s:.2g} s."


def write_report(record: CostRecord, folder: Path) -> None:
    """Write cost.json and cost.png into `folder`."""
    write_whole(folder / "cost.json", TypeAdapter(CostRecord).dump_json(record, indent=1).decode() + "\n")
    save_figure(cost_figure(record), folder / "cost.png")


def table(record: CostRecord) -> list[tuple[str, ...]]:
    """The table of the study: a header and the rows."""
    rows: list[tuple[str, ...]] = [("setting", "value", "true error", "CPU time", "of the scene's", "dominant error")]
    for one in record.rows:
        setting, value = one.change
        cells = (
            [str(one.error), f"{one.cpu_s:.2g} s", f"{one.cpu_s / record.own.cpu_s:.2f}"] if one.errors else [""] * 3
        )
        remarks = [one.failure or one.dominant, ", ".join(record.new_warnings(one)[:2])]
        cells.append("; the run warns: ".join(filter(None, remarks)))
        rows.append((setting, value + " (as it is)" * (one is record.own), *cells))
    return rows


def summary(record: CostRecord) -> list[str]:
    """The study for a terminal: the table, its definitions, what to do."""
    rows = table(record)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        *("  ".join(map(str.ljust, row, widths)).rstrip() for row in rows),
        "",
        f"True error: the largest relative error of {', '.join(record.reference)}, against a run that is finer in all, "
        f"accuracy.tolerance = {record.reference_tolerance:g}.",
        record.advice,
    ]


def cost_figure(record: CostRecord) -> Figure:
    """Error over CPU time of every row with numbers, beside its value; ↓ before that of an upper bound."""
    figure = new_figure((7.4, 5.2))
    axes = figure.subplots()
    groups: dict[str, list[tuple[float, float]]] = {}
    for one in record.rows:
        if one.errors:
            setting, value = one.change
            at = one.cpu_s, one.error.relative
            groups.setdefault(setting, []).append(at)
            axes.annotate(f"  {'↓' * one.error.is_bound}{value}", at, fontsize=7)
    for setting, points in groups.items():
        axes.plot(
            *zip(*points, strict=True), "o" if setting != record.own.change[0] else "o-", linewidth=0.8, label=setting
        )
    axes.plot(record.own.cpu_s, record.own.error.relative, "k*", markersize=13, label="scene as it is")
    axes.axhline(record.tolerance, color=THEORY, linewidth=0.8, linestyle=":", label="its tolerance")
    axes.loglog()
    axes.legend(frameon=False)
    axes.set(xlabel="CPU time of a run (s)", ylabel="largest relative error (↓ less than)", title=record.title)
    return figure
