"""The work-precision figure: error over CPU time with the Pareto front, and error over each knob with its order."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from contact1d.analysis.plots import THEORY, new_figure
from contact1d.workflow.cost.record import CostRecord, KnobRecord, VariantRecord
from contact1d.workflow.cost.study import AS_IT_IS, BASE, COMBINED

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
