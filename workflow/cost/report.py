"""What a cost study leaves: cost.json, cost.csv, the tables for a terminal, the work-precision figure."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import TypeAdapter, computed_field

from contact1d.analysis.curve import write_columns
from contact1d.analysis.plots import THEORY, describe, new_figure, save_figure
from contact1d.files import write_whole
from contact1d.workflow.cost.knobs import Keys, Knob
from contact1d.workflow.cost.measure import EffectCost, Measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

AS_IT_IS, BASE, EFFECT, COMBINED = "scene", "base", "effect", "combined"
"""Knobs, in a manner of speaking, of variants that belong to none."""


@dataclass(frozen=True, kw_only=True)
class Variant(Measured):
    """A variant of the scene: what it is, and once it has run, what was measured of it.

    Attributes:
        label: "cutoff 3.67 LU".
        knob, value: which knob, and where it stands; NaN for what is no place on a scale.
        scene_keys: changes that a scene file can say; effects left out are "without …".
        details: what it is made of, where the label does not say it.
        own_reference: whether the errors are against the finest level of its own knob.
        values: main results.
        errors: of each, relative to the reference; none where an effect was left out.
        error, spread: the largest of them, and its standard error from noise (0 without).
    """

    label: str
    knob: str
    value: float = math.nan
    scene_keys: Keys = ()
    details: str = ""
    own_reference: bool = False
    values: Mapping[str, float] = field(default_factory=dict)
    errors: Mapping[str, float] = field(default_factory=dict)
    error: float = math.nan
    spread: float = 0.0

    @computed_field  # type: ignore[prop-decorator]  # mypy knows no decorator on a property
    @property
    def same_physics(self) -> bool:
        """Whether its errors are errors at all: not where an effect was left out."""
        return self.knob != EFFECT

    @property
    def competes(self) -> bool:
        """Whether it has an error against the reference and a cost, to be compared with others."""
        return not self.failure and self.same_physics and not self.own_reference and math.isfinite(self.error)

    @property
    def bound(self) -> float:
        """The error with its standard error on top."""
        return self.error + self.spread

    @property
    def in_words(self) -> str:
        """Error and CPU time."""
        spread = f" ± {self.spread:.0e}" if self.spread else ""
        return f"error {self.error:.1e}{spread} in {self.cpu_s:.2g} s of CPU"


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
        reference_uncertainties: that the reference run itself estimated, relative.
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
    knobs: tuple[Knob, ...]
    variants: tuple[Variant, ...]
    effect_costs: tuple[EffectCost, ...]
    left_out: Mapping[str, str]
    pareto: tuple[str, ...]
    advice: tuple[Advice, ...]
    versions: Mapping[str, str]
    wall_s: float


def write_report(record: CostRecord, folder: Path) -> None:
    """Write cost.json (what is no number is null), cost.csv and cost.png into `folder`."""
    write_whole(folder / "cost.json", TypeAdapter(CostRecord).dump_json(record, indent=1).decode() + "\n")
    write_columns(folder / "cost.csv", _columns(record))
    save_figure(cost_figure(record), folder / "cost.png")


COLUMNS = {
    "knob": "knob", "label": "label", "value": "value", "error": "error", "error_spread": "spread",
    "lammps_cpu_s": "cpu_s", "wall_s": "total_s", "steps": "steps", "memory_mb": "memory_mb",
}  # fmt: skip
"""Of cost.csv: what a variant calls them."""


def _columns(record: CostRecord) -> dict[str, list[Any]]:
    """The columns of cost.csv, a row for each variant: what it is and costs, the error of each main result."""
    several = record.variants
    columns = {name: [getattr(one, attribute) for one in several] for name, attribute in COLUMNS.items()}
    columns["runs"] = [len(one.cpu_runs) for one in several]
    columns["pareto"] = [one.label in record.pareto for one in several]
    columns["failure"] = [_on_one_line(one.failure) for one in several]
    columns["details"] = [one.details for one in several]
    for name in record.reference_values:
        columns[f"error_{name}"] = [one.errors.get(name, math.nan) for one in several]
    return columns


def _on_one_line(text: str) -> str:
    return " ".join(text.split())


def summary(record: CostRecord) -> list[str]:
    """The study for a terminal: what was held against what, knobs, effects, failures, advice, the study itself."""
    best = ", ".join(f"{name} {value:.9g}" for name, value in record.reference_values.items())
    lines = [f"reference: {record.reference}: {best}", ""]
    lines += _aligned([("knob", "here", "error there", "order of the error"), *(_row(record, k) for k in record.knobs)])
    lines += [f"  not turned: {name}, because {reason}" for name, reason in record.left_out.items()]
    if record.effect_costs:
        lines += ["", "what each effect costs per step:"]
        lines += _aligned([EFFECT_COLUMNS, *map(effect_row, record.effect_costs)])
    failures = [one for one in record.variants if one.failure]
    if failures:
        lines += ["", "gave no numbers:", *(f"  {one.label}: {_on_one_line(one.failure)}" for one in failures)]
    runs = sum(len(one.cpu_runs) for one in record.variants)
    done = f"{runs} runs of {len(record.variants)} variants in {record.wall_s:.0f} s"
    return [
        *lines,
        "",
        *(one.text for one in record.advice),
        "",
        f"{done}; error of the base {power(record.base_error)}",
    ]


EFFECT_COLUMNS = ("effect", "a step with it", "without it", "ratio", "per particle", "changes the main results by")


def effect_row(one: EffectCost) -> tuple[str, ...]:
    """The cells of EFFECT_COLUMNS."""
    if one.reason:
        return one.name, f"{one.with_us:.1f} µs", "cannot be left out", "", "", ""
    largest = max((abs(change) for change in (one.changes or {}).values()), default=None)
    change = "no such result without it" if largest is None else f"up to {largest:.1e}"
    ratio = f"{one.ratio:.3f} ± {one.ratio_error:.3f}"
    return one.name, f"{one.with_us:.1f} µs", f"{one.without_us:.1f} µs", ratio, f"{one.ns_per_particle:.1f} ns", change


def _row(record: CostRecord, knob: Knob) -> tuple[str, ...]:
    """Name, the scene's own value, the knob's error at the measured value nearest to it (by ratio), order."""
    levels = [one for one in record.variants if one.knob == knob.name and math.isfinite(one.error)]
    order = "" if knob.order is None else str(knob.order)
    if not math.isfinite(knob.own):
        return knob.name, "", "", order
    nearest = min(levels, key=lambda one: abs(math.log(one.value / knob.own)), default=None)
    error = "" if nearest is None else f"{nearest.error:.1e} at {nearest.value:.3g}"
    return knob.name, f"{knob.own:.3g}", error, order


def _aligned(table: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return ["  " + "  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)) for row in table]


def power(value: float) -> str:
    """`1e-3`."""
    return f"{value:.0e}".replace("e-0", "e-")


SIZE = (10.5, 5.4)
COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999933")
"""Okabe and Ito's, and one more; a knob has its colour and its marker in both panels."""
MARKERS = "osD^vPX*"
OTHERS = ((AS_IT_IS, "*", 13, "scene as it is"), (COMBINED, "h", 7, "combined"), (BASE, "+", 7, "base"))
"""Variants of no knob: their group, marker, its size, and what the legend says."""


def cost_figure(record: CostRecord) -> Figure:
    """Left: error over CPU time of all variants. Right: error over a knob's place relative to the scene's own."""
    from matplotlib.ticker import LogLocator

    figure = new_figure(SIZE)
    left, right = figure.subplots(1, 2, sharey=True)
    for knob, colour, marker in zip(record.knobs, cycle(COLOURS), cycle(MARKERS), strict=False):
        levels = sorted(_shown(record, knob.name), key=lambda one: one.value)
        style = {"color": colour, "marker": marker, "markersize": 5, "fillstyle": "none"}
        if levels and not knob.own_reference:
            spread = [one.spread or math.nan for one in levels]  # without noise there is no bar
            left.errorbar(*_cost_and_error(levels), spread, linewidth=0.6, label=knob.name, **style)
        if levels and math.isfinite(knob.own):
            coarser = [knob.coarseness(one.value) / knob.coarseness(knob.own) for one in levels]
            label = knob.name if knob.order is None else f"{knob.name}, order {knob.order}"
            right.loglog(coarser, [one.error for one in levels], linewidth=0.9, label=label, **style)
    for group, marker, size, label in OTHERS:
        if found := _shown(record, group):
            left.plot(*_cost_and_error(found), marker, color=COLOURS[0], markersize=size, label=label, zorder=3)
    front = sorted((one for one in _shown(record) if one.label in record.pareto), key=lambda one: one.cpu_s)
    style = {"color": THEORY, "linewidth": 5.0, "alpha": 0.35}
    left.step(*_cost_and_error(front), where="post", label="Pareto front", zorder=0, **style)
    for axis, columns in ((left, 3), (right, 2)):
        axis.axhline(record.tolerance, color=THEORY, linewidth=0.8, linestyle=":")
        axis.legend(frameon=False, fontsize=7, ncols=columns, loc="upper center", bbox_to_anchor=(0.5, -0.13))
    left.set(xscale="log", yscale="log")
    left.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    left.xaxis.set_major_formatter("{x:g}")
    left.xaxis.set_minor_formatter("")
    right.axvline(1.0, color=THEORY, linewidth=0.8)
    place = {"xycoords": ("axes fraction", "data"), "ha": "left", "va": "bottom"}
    right.annotate("accuracy.tolerance", (0.01, record.tolerance), fontsize=8, color=THEORY, **place)
    largest, turned = "largest relative error of the main results", "one knob at a time; at 1 stands what the scene has"
    describe(left, "CPU time in LAMMPS (s)", largest, record.title, zero=False)
    describe(right, "how much coarser than in the scene as it is", "", turned, zero=False)
    return figure


def _shown(record: CostRecord, knob: str = "") -> list[Variant]:
    """The variants (of a knob) with an error that a logarithmic axis has a place for."""
    return [one for one in record.variants if one.error > 0.0 and knob in ("", one.knob)]


def _cost_and_error(variants: Sequence[Variant]) -> tuple[list[float], list[float]]:
    return [one.cpu_s for one in variants], [one.error for one in variants]
