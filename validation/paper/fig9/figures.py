"""Figures of the study: panels of points beside the lines of a theory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from contact1d.analysis.plots import THEORY, new_figure
from validation.judging.figures import COLOURS, MARKERS, Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ONE, TWO = (6.4, 4.2), (9.6, 4.2)


@dataclass(frozen=True)
class Panel:
    """A panel: labels of both axes, the runs, what they are held against.

    Attributes:
        lines: whether the runs are curves and no points.
        joined: whether points of one series are joined by a thin line.
        logarithmic: whether x is.
        mark: where a threshold is along x.
    """

    along: str
    up: str
    runs: Sequence[Series]
    theory: Sequence[Series]
    title: str = ""
    lines: bool = False
    joined: bool = False
    logarithmic: bool = False
    mark: float | None = None


def panels_figure(panels: Sequence[Panel]) -> Figure:
    """The panels side by side."""
    figure = new_figure(ONE if len(panels) == 1 else TWO)
    axes = figure.subplots(1, len(panels), squeeze=False)[0]
    for axis, panel in zip(axes, panels, strict=True):
        _draw(axis, panel)
    return figure


def _draw(axis: Axes, panel: Panel) -> None:
    for i, one in enumerate(panel.theory):
        point = len(one.x) == 1
        marker, line = ("+", "") if point else ("", "--" if i else "-")
        axis.plot(
            one.x, one.y, marker=marker, markersize=14, linestyle=line, color=THEORY, linewidth=1.2,
            label=one.name or None, clip_on=False,
        )  # fmt: skip
    for one, colour, marker in zip(panel.runs, COLOURS, MARKERS, strict=False):
        if panel.lines:
            axis.plot(one.x, one.y, color=colour, linewidth=1.4, label=one.name)
            axis.margins(y=0.3)  # room for the names
            continue
        axis.errorbar(
            one.x, one.y, one.spread, fmt=marker + ("--" if panel.joined else ""), color=colour, markersize=5.5,
            linewidth=0.8, capsize=2, fillstyle="none", label=one.name,
        )  # fmt: skip
    if panel.mark is not None:
        axis.axvline(panel.mark, color="black", linewidth=0.8, linestyle=":", label="threshold")
    if panel.logarithmic:
        axis.set_xscale("log")
        axis.set_xticks(panel.runs[0].x, [f"{x:g}" for x in panel.runs[0].x])
        axis.minorticks_off()
    if panel.title:
        axis.set_title(panel.title, loc="left", fontsize=10)
    axis.axhline(0.0, color="black", linewidth=0.6)
    axis.set_xlabel(panel.along)
    axis.set_ylabel(panel.up)
    axis.legend(frameon=False, fontsize=9)
