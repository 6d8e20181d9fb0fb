"""What a cost study leaves and says: cost.csv, the table of knobs, the table of effects, the advice."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from contact1d.files import write_whole
from contact1d.workflow.cost.advice import power
from contact1d.workflow.cost.figure import cost_figure
from contact1d.workflow.cost.record import RECORD, CostRecord, EffectCost, KnobRecord, VariantRecord

TABLE, FIGURE = "cost.csv", "cost.png"
COLUMNS = (
    "knob", "label", "value", "error", "error_spread", "lammps_cpu_s", "wall_s", "steps", "memory_mb", "runs", "pareto",
    "failure", "details",
)  # fmt: skip


def write_report(record: CostRecord, folder: Path) -> None:
    """Write cost.json, cost.csv and cost.png into `folder`."""
    write_whole(folder / RECORD, record.to_json())
    write_whole(folder / TABLE, csv_text(record))
    from contact1d.analysis.plots import save_figure

    save_figure(cost_figure(record), folder / FIGURE)


def csv_text(record: CostRecord) -> str:
    """One row for each variant: COLUMNS, then the error of each main result; empty where there is no number."""
    names = list(record.reference_values)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*COLUMNS, *(f"error_{name}" for name in names)])
    for one in record.variants:
        errors = one.errors or {}
        fixed = (
            one.knob, one.label, _cell(one.value), _cell(one.error), _cell(one.spread), _cell(one.cpu_s),
            _cell(one.total_s), one.steps, _cell(one.memory_mb), len(one.cpu_runs), int(one.label in record.pareto),
            " ".join(one.failure.split()), one.details,
        )  # fmt: skip
        writer.writerow([*fixed, *(_cell(errors.get(name, math.nan)) for name in names)])
    return text.getvalue()


def _cell(value: float) -> str:
    return f"{value:.6g}" if math.isfinite(value) else ""


def summary(record: CostRecord) -> list[str]:
    """The study for a terminal: what was held against what, knobs, effects, failures, advice."""
    best = ", ".join(f"{name} {value:.9g}" for name, value in record.reference_values.items())
    lines = [f"reference: {record.reference}: {best}", ""]
    lines += _columns(("knob", "here", "error there", "order of the error"), [_knob(record, k) for k in record.knobs])
    lines += [f"  not turned: {name}, because {reason}" for name, reason in record.left_out.items()]
    if record.effect_costs:
        lines += ["", "what each effect costs per step:"]
        lines += _columns(EFFECT_COLUMNS, [effect_row(one) for one in record.effect_costs])
    failures = [one for one in record.variants if one.failure]
    if failures:
        lines += ["", "gave no numbers:", *(f"  {one.label}: {' '.join(one.failure.split())}" for one in failures)]
    return [*lines, "", *(one.text for one in record.advice)]


EFFECT_COLUMNS = ("effect", "a step with it", "without it", "ratio", "per particle", "changes the main results by")


def effects_markdown(record: CostRecord) -> str:
    """The table of docs/performance.md of what each effect costs, with the advice below it."""
    rows = [EFFECT_COLUMNS, ["---"] * len(EFFECT_COLUMNS)]
    cells = [(f"`{row[0]}`", *row[1:]) for row in map(effect_row, record.effect_costs)]
    table = "".join("| " + " | ".join(row) + " |\n" for row in [*rows, *cells])
    return table + "\n" + "".join(f"- {one.text}\n" for one in record.advice)


def effect_row(one: EffectCost) -> tuple[str, ...]:
    """The cells of EFFECT_COLUMNS."""
    if one.reason:
        return one.name, f"{one.with_us:.1f} µs", "cannot be left out", "", "", ""
    largest = max((abs(change) for change in (one.changes or {}).values()), default=math.nan)
    change = f"up to {largest:.1e}" if math.isfinite(largest) else "no such result without it"
    ratio = f"{one.ratio:.3f} ± {one.ratio_error:.3f}"
    return one.name, f"{one.with_us:.1f} µs", f"{one.without_us:.1f} µs", ratio, f"{one.ns_per_particle:.1f} ns", change


def _knob(record: CostRecord, knob: KnobRecord) -> tuple[str, ...]:
    """Name, the scene's own value, the knob's error at the measured value nearest to it, order."""
    order = "" if knob.order is None else f"{knob.order.order:.2f} ± {knob.order.standard_error:.2f}"
    if not math.isfinite(knob.own):
        return knob.name, "", "", order
    nearest = nearest_level(record.variants, knob)
    error = "" if nearest is None else f"{nearest.error:.1e} at {nearest.value:.3g}"
    return knob.name, f"{knob.own:.3g}", error, order


def nearest_level(variants: Iterable[VariantRecord], knob: KnobRecord) -> VariantRecord | None:
    """The measured level of the knob that is nearest to what the scene has, by ratio; None where there is none."""
    levels = [one for one in variants if one.knob == knob.name and math.isfinite(one.error)]
    return min(levels, key=lambda one: abs(math.log(one.value / knob.own)), default=None)


def _columns(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    table = [head, *rows]
    widths = [max(len(row[i]) for row in table if len(row) > i) for i in range(len(head))]
    return ["  " + "  ".join(text.ljust(width) for text, width in zip(row, widths, strict=False)) for row in table]


def closing(record: CostRecord) -> str:
    """One line about the study itself."""
    runs = sum(len(one.cpu_runs) for one in record.variants)
    done = f"{runs} runs of {len(record.variants)} variants in {record.wall_s:.0f} s"
    return f"{done}; error of the base {power(record.base_error)}"
