"""The output of a cost study: cost.json, the table for a terminal and for pages, the work-precision figure."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import TypeAdapter, computed_field

from contact1d.analysis.chart import THEORY
from contact1d.analysis.plots import describe, new_figure, save_figure
from contact1d.files import write_whole
from contact1d.workflow.cost.knobs import Keys, Knob
from contact1d.workflow.cost.measure import EffectCost, Measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure

AS_IT_IS, BASE, EFFECT = "scene", "base", "without"
"""In place of a setting, of variants that belong to none."""
WORTHWHILE = 90.0
"""CPU time over that of the value now [%], below which a change is worth it: medians differ by less."""


@dataclass(frozen=True, kw_only=True)
class Variant(Measured):
    """A variant of the scene, and once it has run, its measurements.

    Attributes:
        knob, value, h: a setting and its `Level`; or AS_IT_IS, BASE, or EFFECT and the effect that is left out.
        scene_keys: what is changed in the scene.
        details: what the settings are then (`choice`).
        errors: of the main results, relative to the reference or to the finest level; without an effect the changes
            relative to the scene as it is.
        spread: standard error of the largest from noise (0 without).
    """

    knob: str
    value: str = ""
    h: float = math.nan
    scene_keys: Keys = ()
    details: str = ""
    errors: Mapping[str, float] = field(default_factory=dict)
    spread: float = 0.0

    @property
    def label(self) -> str:
        """`interaction.cutoff 3.67 LU`."""
        return f"{self.knob} {self.value}"

    @computed_field  # type: ignore[prop-decorator]  # mypy knows no decorator on a property
    @property
    def error(self) -> float:
        """The largest of the errors, NaN where there is none."""
        return max(self.errors.values(), default=math.nan)


@dataclass(frozen=True)
class CostRecord:
    """A whole study.

    Attributes:
        title, scene: of the scene, and its name.
        reference: label of the reference run, with its main results.
        base_error: error of the base, the floor of every fit.
        limit: largest error that a value may leave to be enough.
        knobs, effect_costs: of the scene.
        variants: the scene as it is first, the others as far as they gave numbers.
        left_out: settings that were not tried, with the reason.
    """

    title: str
    scene: str
    reference: str
    reference_values: Mapping[str, float]
    base_error: float
    limit: float
    knobs: tuple[Knob, ...]
    variants: tuple[Variant, ...]
    effect_costs: tuple[EffectCost, ...]
    left_out: Mapping[str, str]
    versions: Mapping[str, str]

    def of(self, knob: str) -> list[Variant]:
        """The variants of a setting that gave numbers."""
        return [one for one in self.variants if one.knob == knob and not one.failure]


def write_report(record: CostRecord, folder: Path) -> None:
    """Write cost.json (null for an unknown number) and cost.png into `folder`."""
    write_whole(folder / "cost.json", TypeAdapter(CostRecord).dump_json(record, indent=1).decode() + "\n")
    save_figure(cost_figure(record), folder / "cost.png")


def table(record: CostRecord) -> list[tuple[str, ...]]:
    """The table of the study: a header, a row for every setting and for every effect."""
    header = (
        "setting or effect",
        "now",
        "enough",
        "error: now → enough",
        "CPU time: now → enough",
        "order",
        "what to do",
    )
    return [header, *(_setting(record, knob) for knob in record.knobs), *_effects(record)]


def _setting(record: CostRecord, knob: Knob) -> tuple[str, ...]:
    """Enough is the coarsest value within the limit; of a setting without a scale of errors the cheapest."""
    if not (ran := record.of(knob.name)):
        return knob.name, knob.now, "", "", "", "", "Keep it: no value that was tried gave numbers."
    now = min(ran, key=lambda one: (one.value != knob.now, abs(math.log(one.h / knob.h))))
    within = [one for one in ran if one.error + one.spread <= record.limit]
    enough = max(within, key=lambda one: one.h if knob.has_order else -one.cpu_s, default=now)
    if not within:
        advice = "No value that was tried is enough: try a finer one, or a smaller accuracy.tolerance."
    elif enough is now:
        advice = "Keep it."
    elif now not in within:
        advice = f"Set it to {enough.value}: the error is too large now."
    else:
        advice = _saving(f"Set it to {enough.value}", 100.0 * enough.cpu_s / now.cpu_s)
    both = [now] if enough is now else [now, enough]
    error = " → ".join(map(_error, both))
    time = " → ".join(f"{one.cpu_s:.2g}" for one in both)
    return knob.name, knob.now, enough.value if within else "", error, f"{time} s", str(knob.order or ""), advice


def _saving(do: str, left: float) -> str:
    """What to do where another value is enough and takes `left` % of the time."""
    return f"{do}: it saves {100.0 - left:.0f} % of the time." if left < WORTHWHILE else "Keep it: less saves no time."


def _effects(record: CostRecord) -> Iterator[tuple[str, ...]]:
    """An effect is on now; off suffices where this changes the results by at most the limit."""
    changes = {one.value: one for one in record.of(EFFECT)}
    for one in record.effect_costs:
        time, error, enough, advice = f"{one.with_us:.1f} µs a step", "", "on", "Keep it: the main results need it."
        if math.isfinite(one.ratio):
            time = f"{one.with_us:.1f} → {one.without_us:.1f} µs a step, ratio {one.ratio:.3f} ± {one.ratio_error:.3f}"
        if change := changes.get(one.name):
            error = f"{_error(change)} without it"
            if change.error + change.spread <= record.limit:
                enough, advice = "off", _saving(f"Leave it out (--without {one.name})", 100.0 / one.ratio)
        yield one.name, "on", enough, error, time, "", advice


def _error(one: Variant) -> str:
    return f"{one.error:.2g} ± {one.spread:.1g}" if one.spread else f"{one.error:.2g}"


def summary(record: CostRecord) -> list[str]:
    """The study for a terminal: reference, the scene as it is, the table, its definitions, settings not tried."""
    own = record.variants[0]
    numbers = f"error {own.error:.2g}, {own.cpu_s:.2g} s of CPU, {own.memory_mb:.0f} MB ({own.details})"
    rows = table(record)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return [
        f"reference: {record.reference}, for {', '.join(record.reference_values)}",
        f"the scene as it is: {' '.join(own.failure.split()) or numbers}",
        "",
        *("  ".join(map(str.ljust, row, widths)).rstrip() for row in rows),
        "",
        f"Errors are the largest of the main results, all else exact; at most {record.limit:.2g} suffices.",
        *(f"Not tried: {name}, because {reason}." for name, reason in record.left_out.items()),
    ]


SIZE = (10.5, 5.4)
MARKERS = "sD^vPXo"
"""A setting has its marker and its colour in both panels."""
SMALLEST = 1e-12
"""Errors below it are of round-off and not drawn."""


def cost_figure(record: CostRecord) -> Figure:
    """Left: error over CPU time of all variants. Right: error over each setting relative to the scene's own."""
    from matplotlib.ticker import LogLocator

    figure = new_figure(SIZE)
    left, right = figure.subplots(1, 2, sharey=True)
    for i, knob in enumerate(record.knobs):
        levels = sorted((one for one in record.of(knob.name) if one.error > SMALLEST), key=lambda one: one.h)
        cpu, errors = [one.cpu_s for one in levels], [one.error for one in levels]
        style = {"color": f"C{i}", "marker": MARKERS[i], "markersize": 5, "fillstyle": "none", "linewidth": 0.8}
        if levels:
            left.errorbar(cpu, errors, [one.spread for one in levels], label=knob.name, **style)
        if levels and math.isfinite(knob.h):
            label = knob.name if knob.order is None else f"{knob.name}, order {knob.order}"
            right.loglog([one.h / knob.h for one in levels], errors, label=label, **style)
    own = record.variants[0]
    left.plot(own.cpu_s, own.error, "k*", markersize=13, label="scene as it is", zorder=3)
    left.set(xscale="log", yscale="log")
    left.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    left.xaxis.set_major_formatter("{x:g}")
    left.xaxis.set_minor_formatter("")
    right.axvline(1.0, color=THEORY, linewidth=0.8)
    for axis in (left, right):
        axis.axhline(record.limit, color=THEORY, linewidth=0.8, linestyle=":", label="enough in this scene")
        axis.legend(frameon=False, fontsize=7, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.13))
    largest, one = "largest relative error of the main results", "one setting at a time, all else exact"
    describe(left, "CPU time in LAMMPS (s)", largest, record.title, zero=False)
    describe(right, "h of the setting over that of the scene as it is", "", one, zero=False)
    return figure
