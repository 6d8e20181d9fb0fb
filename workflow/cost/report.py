"""What a cost study found, as one value: cost.json, cost.csv, the tables for a terminal, the work-precision figure."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contact1d.analysis.plots import THEORY, new_figure
from contact1d.files import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AS_IT_IS, BASE, EFFECT, COMBINED = "scene", "base", "effect", "combined"
"""Knobs, in a manner of speaking, of variants that belong to none."""


@dataclass(frozen=True)
class VariantRecord:
    """One variant, measured.

    Attributes:
        label: "cutoff 3.67 LU".
        knob, value: which knob, and where it stands; NaN for what is no place on a scale.
        details: what it is made of, where the label does not say it.
        scene_keys: changes that a scene file can say; effects left out are "without …".
        same_physics: whether its errors are errors at all: not where an effect was left out.
        own_reference: whether the errors are against the finest level of its own knob.
        values: main results.
        errors: of each, relative to the reference.
        error, spread: the largest of them, and its standard error from noise (0 without).
        cpu_s: median CPU time in LAMMPS [s].
        cpu_runs: of each run [s].
        total_s: median wall time of a run, LAMMPS and all around it [s].
        steps: minimiser iterations or timesteps.
        memory_mb: peak of the LAMMPS process; NaN where the system does not tell.
        failure: why there are no numbers; "" where there are.
    """

    label: str
    knob: str
    value: float
    details: str = ""
    scene_keys: tuple[str, ...] = ()
    same_physics: bool = True
    own_reference: bool = False
    values: Mapping[str, float] | None = None
    errors: Mapping[str, float] | None = None
    error: float = math.nan
    spread: float = 0.0
    cpu_s: float = math.nan
    cpu_runs: tuple[float, ...] = ()
    total_s: float = math.nan
    steps: int = 0
    memory_mb: float = math.nan
    failure: str = ""

    @property
    def competes(self) -> bool:
        """Whether it has an error against the reference and a cost, to be compared with others."""
        return not self.failure and self.same_physics and not self.own_reference and math.isfinite(self.error)

    @property
    def bound(self) -> float:
        """The error with its standard error on top."""
        return self.error + self.spread


@dataclass(frozen=True)
class Order:
    """p of error ∝ h^p, its standard error, and how many points it comes from."""

    order: float
    standard_error: float
    points: int


@dataclass(frozen=True)
class KnobRecord:
    """One knob: see `workflow.cost.knobs.Knob`; `order` of its error, None where there is none to be fitted."""

    name: str
    meaning: str
    finer: str
    own: float
    own_reference: bool
    order: Order | None


@dataclass(frozen=True)
class EffectCost:
    """What an effect costs per timestep, or per force evaluation of a minimiser, which is the same work.

    Attributes:
        name: the effect.
        with_us, without_us: CPU time of a step with all effects, and without this one [µs]; medians.
        ratio, ratio_error: of the two, median over turns, and its standard error.
        particles: of both bodies.
        reason: why it cannot be left out; "" where it can.
        changes: what the main results become without it, over those with it, minus 1.
    """

    name: str
    with_us: float
    without_us: float
    ratio: float
    ratio_error: float
    particles: int
    reason: str = ""
    changes: Mapping[str, float] | None = None

    @property
    def ns_per_particle(self) -> float:
        """What it adds to a step, per particle [ns], by the ratio."""
        return 1e3 * self.with_us * (1.0 - 1.0 / self.ratio) / self.particles


@dataclass(frozen=True)
class Advice:
    """What a tolerance chooses, and the cheapest measured variants that reach it.

    Attributes:
        tolerance: asked for.
        text: one line.
        chosen: label of the scene with this `accuracy.tolerance`, "" where it was not run.
        label: of the cheapest, "" where none reaches it.
    """

    tolerance: float
    text: str
    chosen: str
    label: str


@dataclass(frozen=True)
class CostRecord:
    """A whole study.

    Attributes:
        title, scene, method: of the scene; `scene` is its name.
        effects: that it has.
        reference: label of the reference run, with its main results.
        uncertainties: that the reference run itself estimated, relative.
        base: label of what the knobs are turned from.
        base_error: what is left of error there, the floor of every fit.
        repeats: asked for.
        left_out: knobs that are not turned, with the reason.
    """

    title: str
    scene: str
    method: str
    tolerance: float
    effects: tuple[str, ...]
    reference: str
    reference_values: Mapping[str, float]
    reference_uncertainties: Mapping[str, float]
    base: str
    base_error: float
    repeats: int
    knobs: tuple[KnobRecord, ...]
    variants: tuple[VariantRecord, ...]
    effect_costs: tuple[EffectCost, ...]
    left_out: Mapping[str, str]
    pareto: tuple[str, ...]
    advice: tuple[Advice, ...]
    versions: Mapping[str, str]
    wall_s: float

    def variant(self, label: str) -> VariantRecord:
        """The variant of that label."""
        return next(one for one in self.variants if one.label == label)

    def to_json(self) -> str:
        """Return the text of cost.json; what is no number is null."""
        return json.dumps(_plain(asdict(self)), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


COLUMNS = (
    "knob", "label", "value", "error", "error_spread", "lammps_cpu_s", "wall_s", "steps", "memory_mb", "runs", "pareto",
    "failure", "details",
)  # fmt: skip


def write_report(record: CostRecord, folder: Path) -> None:
    """Write cost.json, cost.csv and cost.png into `folder`."""
    write_whole(folder / "cost.json", record.to_json())
    write_whole(folder / "cost.csv", csv_text(record))
    from contact1d.analysis.plots import save_figure

    save_figure(cost_figure(record), folder / "cost.png")


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


def power(value: float) -> str:
    """`1e-3`."""
    return f"{value:.0e}".replace("e-0", "e-")


def closing(record: CostRecord) -> str:
    """One line about the study itself."""
    runs = sum(len(one.cpu_runs) for one in record.variants)
    done = f"{runs} runs of {len(record.variants)} variants in {record.wall_s:.0f} s"
    return f"{done}; error of the base {power(record.base_error)}"


SIZE = (10.5, 5.4)
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999933")
"""Okabe and Ito's, and one more; a knob has its colour and its marker in both panels."""
MARKERS = "osD^vPX*"


def cost_figure(record: CostRecord) -> Figure:
    """Left: error over CPU time of all variants. Right: error over a knob's place relative to the scene's own."""
    from matplotlib.ticker import LogLocator

    figure = new_figure(SIZE)
    left, right = figure.subplots(1, 2, sharey=True)
    for i, knob in enumerate(record.knobs):
        levels = sorted(
            (one for one in record.variants if one.knob == knob.name and math.isfinite(one.error) and one.error > 0.0),
            key=lambda one: one.value,
        )
        style: dict[str, Any] = {"color": COLOURS[i % len(COLOURS)], "marker": MARKERS[i % len(MARKERS)]}
        if levels:
            _over_time(left, knob, levels, style)
            _over_knob(right, knob, levels, style)
    _others(left, record)
    _front(left, record)
    for axis, columns in ((left, 3), (right, 2)):
        axis.axhline(record.tolerance, color=THEORY, linewidth=0.8, linestyle=":")
        axis.legend(frameon=False, fontsize=7, ncols=columns, loc="upper center", bbox_to_anchor=(0.5, -0.13))
    left.set(xscale="log", yscale="log")
    left.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    left.xaxis.set_major_formatter("{x:g}")
    left.xaxis.set_minor_formatter("")
    left.set_xlabel("CPU time in LAMMPS (s)")
    left.set_ylabel("largest relative error of the main results")
    right.axvline(1.0, color=THEORY, linewidth=0.8)
    right.set_xlabel("how much coarser than in the scene as it is")
    right.annotate(
        "accuracy.tolerance", (0.01, record.tolerance), xycoords=("axes fraction", "data"), ha="left", va="bottom",
        fontsize=8, color=THEORY,
    )  # fmt: skip
    left.set_title(record.title, loc="left", fontsize=10)
    right.set_title("one knob at a time; at 1 stands what the scene has", loc="left", fontsize=10)
    return figure


def _over_time(axis: Axes, knob: KnobRecord, levels: Sequence[VariantRecord], style: dict[str, Any]) -> None:
    if knob.own_reference:
        return
    cpu, error = [one.cpu_s for one in levels], [one.error for one in levels]
    axis.plot(cpu, error, linewidth=0.6, markersize=5, fillstyle="none", label=knob.name, **style)
    if any(one.spread for one in levels):
        axis.errorbar(cpu, error, [one.spread for one in levels], fmt="none", ecolor=style["color"], elinewidth=0.6)


def _over_knob(axis: Axes, knob: KnobRecord, levels: Sequence[VariantRecord], style: dict[str, Any]) -> None:
    if not math.isfinite(knob.own):
        return
    coarser = [one.value / knob.own if knob.finer == "smaller" else knob.own / one.value for one in levels]
    order = "" if knob.order is None else f", order {knob.order.order:.2f} ± {knob.order.standard_error:.2f}"
    label = f"{knob.name}{order}"
    axis.loglog(
        coarser, [one.error for one in levels], linewidth=0.9, markersize=5, fillstyle="none", label=label, **style
    )


def _others(axis: Axes, record: CostRecord) -> None:
    """The scene as it is, and the combinations."""
    for group, marker, label in ((AS_IT_IS, "*", "scene as it is"), (COMBINED, "h", "combined"), (BASE, "+", "base")):
        found = [one for one in record.variants if one.knob == group and one.competes and one.error > 0.0]
        if found:
            size = 13 if group == AS_IT_IS else 7
            cpu, error = [one.cpu_s for one in found], [one.error for one in found]
            axis.plot(cpu, error, marker, color=COLOURS[0], markersize=size, label=label, zorder=3)


def _front(axis: Axes, record: CostRecord) -> None:
    front = [record.variant(label) for label in record.pareto]
    front = [one for one in front if one.error > 0.0]
    cpu, error = [one.cpu_s for one in front], [one.error for one in front]
    axis.step(cpu, error, where="post", color=THEORY, linewidth=5.0, alpha=0.35, label="Pareto front", zorder=0)
