"""Figures of studies: panels of points beside the lines of what they are held against."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.chart import THEORY
from contact1d.analysis.plots import new_figure, save_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Values = Array | Sequence[float]
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999933")
"""Okabe and Ito's colours, and one more."""
MARKERS = "osD^vP*Xh"
ONE, TWO = (6.4, 4.4), (9.6, 4.2)
"""Sizes of one panel and of two [inch]."""
MOST = 12
"""Names in a legend."""
SMALLEST, MOST_SHARE = 1e-6, 1.3
"""Ends of an axis of shares that are allowed up to 1."""


@dataclass(frozen=True)
class Series:
    """Points with a name; `spread` their uncertainty or None."""

    name: str
    x: Values
    y: Values
    spread: Values | None = None


@dataclass(frozen=True)
class Panel:
    """One plot.

    Attributes:
        along, up: labels of both axes.
        runs: what this program finds, as points.
        theory: what that is held against, as lines; a line of one point as a cross.
        log: which axes are logarithmic, letters of "xy".
        title: in a corner.
        lines: whether the runs are lines, too.
        bound: where a dashed line is drawn across.
        mark: where a dotted one is drawn upright.
        view: limits of y.
    """

    along: str
    up: str
    runs: Sequence[Series]
    theory: Sequence[Series] = ()
    log: str = ""
    title: str = ""
    lines: bool = False
    bound: float | None = None
    mark: float | None = None
    view: tuple[float | None, float | None] | None = None


@dataclass(frozen=True)
class Drawing:
    """Panels side by side, and what they show."""

    caption: str
    panels: Sequence[Panel]


def figure(caption: str, *panels: Panel) -> dict[str, Drawing]:
    """The figure of a study that has one."""
    return {"": Drawing(caption, panels)}


def save(drawing: Drawing, path: Path) -> None:
    """Draw the panels side by side, and save them whole or not at all."""
    figure = new_figure(ONE if len(drawing.panels) == 1 else TWO)
    for axis, panel in zip(figure.subplots(1, len(drawing.panels), squeeze=False)[0], drawing.panels, strict=True):
        _draw(axis, panel)
    save_figure(figure, path)


def _draw(axis: Axes, panel: Panel) -> None:
    for i, one in enumerate(panel.theory):
        style = "+" if len(one.x) == 1 else ("--", ":")[i % 2] if i else "-"
        axis.plot(one.x, one.y, style, markersize=14, color=THEORY, linewidth=1.2, label=one.name or None)
    for i, one in enumerate(panel.runs):
        colour, style = COLOURS[i % len(COLOURS)], "-" if panel.lines else MARKERS[i % len(MARKERS)]
        axis.errorbar(
            one.x, one.y, one.spread, fmt=style, color=colour, markersize=5, capsize=2, fillstyle="none",
            label=one.name or None,
        )  # fmt: skip
    if panel.bound is not None:
        axis.axhline(panel.bound, color=THEORY, linewidth=1.0, linestyle="--")
    if panel.mark is not None:
        axis.axvline(panel.mark, color=THEORY, linewidth=1.0, linestyle=":")
    for letter in panel.log:
        getattr(axis, f"set_{letter}scale")("log")
    if "y" not in panel.log:
        axis.axhline(0.0, color="black", linewidth=0.6)
    if panel.view:
        axis.set_ylim(*panel.view)
    axis.set(xlabel=panel.along, ylabel=panel.up)
    axis.set_title(panel.title, loc="left", fontsize=10)
    if len(axis.get_legend_handles_labels()[1]) <= MOST:
        axis.legend(frameon=False, fontsize=8)


def margins(classes: Mapping[str, Sequence[float]]) -> Figure:
    """A line of points for each class, by its name: the distance from a reference over what is allowed."""
    figure = new_figure((9.6, 0.6 + 0.24 * len(classes)))
    axis = figure.subplots()
    for place, (name, shares) in enumerate(sorted(classes.items(), key=lambda one: -max(one[1]))):
        axis.plot(np.maximum(shares, SMALLEST), np.full(len(shares), place), "|", markersize=9, color=COLOURS[0])
        axis.text(1.1 * MOST_SHARE, place, f"{name}, {len(shares)}", fontsize=8, verticalalignment="center")
    axis.axvline(1.0, color=THEORY, linewidth=1.0, linestyle="--")
    axis.set(
        xscale="log",
        xlim=(0.5 * SMALLEST, MOST_SHARE),
        yticks=[],
        xlabel="distance from the reference over what the run or the bound allows",
    )
    return figure
