"""Charts drawn by matplotlib, with the size, the frame and the file of a figure."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from contact1d.analysis.chart import BLACK, FILL, Axis, Chart, Panel
from contact1d.files import whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, DPI = 6.4, 120
"""Width of a figure [inch], and its resolution [1/inch]."""
PAD = 6.0
"""Margin around titles and labels [pt]."""


def draw(chart: Chart) -> Figure:
    """Return the figure of a chart, 6.4 inches wide, its panels below each other over one x axis, in the chart's units.

    Every axis needs its ends (`view`). A legend equal to that of the panel above is not repeated. The title is that of
    the chart; the upper and the right line of each panel are hidden.
    """
    heights = [panel.height for panel in chart.panels]
    figure = _figure_class()(figsize=(WIDTH, 1.0 + sum(heights)), dpi=DPI)  # with an inch for title and axis
    axes = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    legend: list[str] = []
    for ax, panel in zip(axes, chart.panels, strict=True):
        draw_panel(ax, chart.x, panel, panel.legend != legend)
        ax.label_outer()
        legend = panel.legend
    figure.suptitle(chart.title, fontsize=11.0, y=1.0 - PAD / (72.0 * figure.get_figheight()))
    _arrange(plain_axes(figure), list(axes), chart)
    return figure


def _arrange(figure: Figure, axes: Sequence[Axes], chart: Chart) -> None:
    """Set, in place, the margins of a figure and the distances of its panels, so that all labels have room.

    The panels, one below the other, are `axes`, from the top, those of the chart. A constrained layout measures every
    text several times, and takes longer than the drawing.
    """
    line, digit, tick = 13.0, 6.4, 10.0  # a line of text, a digit of it, and a tick with the room around it
    ticks = [ax.yaxis.get_major_formatter().format_ticks(ax.yaxis.get_majorticklocs().tolist()) for ax in axes]
    aside, under = tick + digit * max(len(text) for texts in ticks for text in texts), tick + line
    above = [line + PAD if panel.heading else 0.0 for panel in chart.panels]
    title, gap, more = 1.1 * line * len(chart.title.splitlines()), tick + max(above[1:], default=0.0), len(axes) - 1
    left, right, bottom, top = PAD + line + aside, 2.0 * PAD, PAD + line + under, 2.0 * PAD + title + above[0]
    width, height = 72.0 * figure.get_size_inches()
    inside = height - top - bottom - more * gap
    figure.subplots_adjust(
        left / width, bottom / height, 1.0 - right / width, 1.0 - top / height, hspace=(more + 1) * gap / inside
    )
    for ax in axes:
        ax.yaxis.set_label_coords(-aside / (width - left - right), 0.5)
        ax.xaxis.set_label_coords(0.5, -under / (ax.get_position().height * height))


def draw_panel(axes: Axes, x: Axis, panel: Panel, legend: bool = True) -> None:
    """Draw a panel of a chart over the axis `x` into `axes`: series, axes with their ends and labels, heading, legend.

    Both axes need their ends. ±∞ in a series are the ends of an axis; uncertainties are bars. The legend has the
    panel's names, and is left out without `legend` or names. `axes` is changed, nothing is returned.
    """
    from matplotlib.ticker import LogLocator

    for series in panel.series:
        along, up = x.ended(series.x), panel.y.ended(series.y)
        look: dict[str, Any] = {
            "color": series.colour, "alpha": series.opacity, "linewidth": series.width, "label": series.name,
        }  # fmt: skip
        if series.look == FILL:
            axes.fill(along, up, **look | {"linewidth": 0.0})
            continue
        axes.plot(along, up, series.look, markersize=3.0 + series.width / 2.0, **look)
        for dx, dy in ((series.dx, 0.0), (0.0, series.dy)):
            if np.any(dx) or np.any(dy):
                bars = (np.ravel([v - d, v + d, math.nan * v], order="F") for v, d in ((along, dx), (up, dy)))
                axes.plot(*bars, color=series.colour, alpha=0.3)
    for key, axis, drawn in (("x", x, axes.xaxis), ("y", panel.y, axes.yaxis)):
        axes.set(**{f"{key}scale": "log" if axis.log else "linear", f"{key}lim": axis.view})
        if axis.log:
            few_decades = axis.view[1] < 1e3 * axis.view[0]
            drawn.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few_decades else (1.0,)))
            drawn.set_major_formatter("{x:g}")
            drawn.set_minor_formatter("")
        if axis.ticks:
            drawn.set_ticks([*axis.ticks], labels=[*axis.ticks.values()])
    describe(axes, x.label, panel.y.label, panel.heading, panel.y.zero)
    handles, names = axes.get_legend_handles_labels()
    if shown := panel.legend if legend else []:
        axes.legend([handles[names.index(name)] for name in shown], shown, frameon=False, fontsize=9)


def describe(axes: Axes, x: str = "", y: str = "", title: str = "", zero: bool = True) -> None:
    """Write the labels of both axes and the title, left above, into `axes`; where `zero`, draw a line at y = 0."""
    if zero:
        axes.axhline(0.0, color=BLACK, linewidth=0.8)
    axes.set(xlabel=x, ylabel=y)
    axes.set_title(title, loc="left", fontsize=10.0, y=1.0)  # without y matplotlib measures the labels


def new_figure(size: tuple[float, float]) -> Figure:
    """Return an empty figure of `size`, width and height [inch], that pyplot does not keep; a notebook shows it.

    It has 120 dots per inch and a constrained layout, and no axes.
    """
    return _figure_class()(figsize=size, dpi=DPI, layout="constrained")


@cache
def _figure_class() -> type[Figure]:
    """Return a subclass of matplotlib's Figure that a notebook shows as a PNG even without pyplot; it is cached."""
    from matplotlib.figure import Figure

    class ShownFigure(Figure):
        def _repr_png_(self) -> bytes:
            """Return the figure as the bytes of a PNG file, which a notebook shows, also without pyplot."""
            shown = io.BytesIO()
            self.savefig(shown, format="png")
            return shown.getvalue()

    return ShownFigure


def plain_axes(figure: Figure) -> Figure:
    """Hide the lines above and to the right of each axis of a figure, and return that same figure."""
    for axis in figure.axes:
        axis.spines[["top", "right"]].set_visible(False)
    return figure


def save_figure(figure: Figure, path: Path) -> None:
    """Save a figure in the format of the file's suffix (png, svg, pdf); where that fails, an earlier file stays.

    The figure is changed: the upper and right lines of its axes are hidden, and its layout is no longer adapted.
    """
    if layout := plain_axes(figure).get_layout_engine():
        layout.execute(figure)
        figure.set_layout_engine(None)  # savefig would draw it twice, to find the layout again
    form = path.suffix[1:]  # a PNG a tenth larger, in two thirds of the time
    quick: dict[str, Any] = {"pil_kwargs": {"compress_level": 1}} if form == "png" else {}
    with whole(path) as part:
        figure.savefig(part, format=form, **quick)
