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


class Error(NamedTuple):
    """A relative error of a result, or an upper bound of it.

    Attributes:
        relative: error over the size of the result, ≥ 0, dimensionless; ∞ where it is not known.
        is_bound: whether it is an upper bound.
    """

    relative: float
    is_bound: bool = False

    def __str__(self) -> str:
        """Return `0.00012`, or for an upper bound `less than 0.00013`, with two digits.

        The bound is increased by 5 % first, so that the digits never round it down. An infinite error is `inf`.
        """
        return f"less than {1.05 * self.relative:.2g}" if self.is_bound else f"{self.relative:.2g}"


@dataclass(frozen=True)
class VariantRuns:
    """The runs of a variant of a scene, and its errors against the reference.

    Attributes:
        results: results by name, in units of the model, of the last run.
        cpu_runs: CPU time of each run, of LAMMPS and the program together, without figures [s].
        warnings: names of the warnings, then of the results that miss the tolerance.
        failure: why there are no numbers, "" where there are.
        edit: what is changed in the scene, in the form that `contact1d run` accepts; the varied key first.
        errors: relative errors of the main results against the reference, by name; empty where the runs failed.
        dominant: the largest source of error of the result with the largest error, "solver of contact_radius"; ""
            without errors.
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
        """Median CPU time of the runs [s]; NaN without runs."""
        return median(self.cpu_runs or (math.nan,))

    @property
    def change(self) -> tuple[str, str]:
        """(Varied key, its value) as text, `accuracy.tolerance` and `0.01`, or "without" and the effect left out.

        Of several varied keys it is the first; without any change the two are "without" and "".
        """
        setting, value = next(iter(self.edit.values.items()), ("without", "".join(self.edit.without)))
        return setting, str(value)

    @property
    def error(self) -> Error:
        """The largest of the relative errors of the results; infinite, and no bound, if there is none."""
        return max(self.errors.values(), default=Error(math.inf))


@dataclass(frozen=True)
class CostRecord:
    """The record of a cost study: the reference, and the runs of every variant of the scene.

    Attributes:
        title: title of the scene.
        tolerance: accuracy.tolerance of the scene, relative.
        reference_tolerance: accuracy.tolerance of the reference, relative.
        reference: main results of the reference, by name, in units of the model.
        rows: tolerances from coarse to fine, that of the scene among them, then settings, then effects left out.
    """

    title: str
    tolerance: float
    reference_tolerance: float
    reference: Mapping[str, Result]
    rows: tuple[VariantRuns, ...]

    @property
    def baseline(self) -> VariantRuns:
        """The runs of the scene without a change: the first row that only sets the scene's own tolerance.

        StopIteration where there is none.
        """
        return next(row for row in self.rows if row.edit.values == {"accuracy.tolerance": self.tolerance})

    def new_warnings(self, variant: VariantRuns) -> list[str]:
        """Return the names of a variant's warnings that the scene without a change lacks, in order; [] for none.

        The names of results that miss the tolerance are among them.
        """
        return [name for name in variant.warnings if name not in self.baseline.warnings]

    @property
    def advice(self) -> str:
        """A sentence with the variant of least CPU time that is within the tolerance and has no new warnings.

        Where the scene itself is within the tolerance, a variant must save at least 0.1 s and at least 10 % of the
        time; otherwise the sentence says to keep the scene. Where neither the scene nor a variant without new warnings
        is within the tolerance, it says that none is.
        """
        # CPU time [s], and its part of that of the scene, which a change saves at least to be recommended.
        saved_s = saved_share = 0.1
        baseline = self.baseline
        accurate = [row for row in self.rows if row.error.relative <= self.tolerance and not self.new_warnings(row)]
        best = min(accurate, key=lambda row: row.cpu_s, default=baseline)
        if baseline in accurate and baseline.cpu_s - best.cpu_s < max(saved_s, saved_share * baseline.cpu_s):
            least = f"{saved_s:g} s and {saved_share:.0%} of the time"
            return f"Keep the scene as it is: no variant within its tolerance saves {least}."
        if not accurate:
            return "Neither the scene as it is nor a variant is known to be within its tolerance."
        return f"Use {in_words(best.edit)}: error {best.error}, {best.cpu_s:.2g} s in place of {baseline.cpu_s:.2g} s."


def write_report(record: CostRecord, folder: Path) -> None:
    """Write cost.json and cost.png into `folder`, which must exist; earlier ones are replaced."""
    write_whole(folder / "cost.json", TypeAdapter(CostRecord).dump_json(record, indent=1).decode() + "\n")
    save_figure(cost_figure(record), folder / "cost.png")


def table(record: CostRecord) -> list[tuple[str, ...]]:
    """Return the table of a study as text: a header of 6 columns, then a row for each variant, in order.

    The columns are the varied key, its value (of the scene itself with "(as it is)"), largest relative error, median
    CPU time [s], that time over the scene's ("nan" where the scene failed), and the dominant error with up to two new
    warnings. Of a variant without errors the three numbers are "", and the reason is in place of the dominant error.
    """
    rows: list[tuple[str, ...]] = [("setting", "value", "true error", "CPU time", "of the scene's", "dominant error")]
    baseline = record.baseline
    for variant in record.rows:
        setting, value = variant.change
        cells = ["", "", ""]
        if variant.errors:
            cells = [str(variant.error), f"{variant.cpu_s:.2g} s", f"{variant.cpu_s / baseline.cpu_s:.2f}"]
        remarks = [variant.failure or variant.dominant, ", ".join(record.new_warnings(variant)[:2])]
        cells.append("; the run warns: ".join(filter(None, remarks)))
        rows.append((setting, value + " (as it is)" * (variant is baseline), *cells))
    return rows


def summary(record: CostRecord) -> list[str]:
    """Return the lines that a terminal shows of a study: the table, an empty line, what true errors are, the advice."""
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
    """Return the figure of the largest relative error over CPU time [s] of every variant that has errors.

    Each point is labelled with its value; both axes are logarithmic; ↓ marks upper bounds. A star is the scene as it
    is, a dotted line its tolerance.
    """
    figure = new_figure((7.4, 5.2))
    axes = figure.subplots()
    groups: dict[str, list[tuple[float, float]]] = {}
    labels: list[tuple[float, float, str]] = []
    for variant in record.rows:
        if variant.errors:
            setting, value = variant.change
            point = variant.cpu_s, variant.error.relative
            groups.setdefault(setting, []).append(point)
            labels.append((*point, f"{'↓' * variant.error.is_bound}{value}"))
    for place, (seconds, error, text) in enumerate(sorted(labels)):  # neighbours in time on both sides of their points
        side = (-1.0) ** place
        axes.annotate(
            text, (seconds, error), (0.0, 6.0 * side), textcoords="offset points", fontsize=7, rotation=60.0 * side,
            rotation_mode="anchor", va="center",
        )  # fmt: skip
    baseline = record.baseline
    for setting, points in groups.items():
        marker = "o" if setting != baseline.change[0] else "o-"
        axes.plot(*zip(*points, strict=True), marker, linewidth=0.8, label=setting)
    axes.plot(baseline.cpu_s, baseline.error.relative, "k*", markersize=13, label="scene as it is")
    axes.axhline(record.tolerance, color=THEORY, linewidth=0.8, linestyle=":", label="its tolerance")
    axes.loglog()
    axes.margins(0.15)
    axes.legend(frameon=False)
    axes.set(xlabel="CPU time of a run (s)", ylabel="largest relative error (↓ less than)", title=record.title)
    return figure
