"""How matplotlib draws a chart, and what a figure needs besides: its size, its frame, its file."""

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

WIDTH, BESIDE = 6.4, 1.0
"""Of a figure, and the height of title and axis that its panels leave [inch]."""
DPI = 120
"""Of a figure, points of an image [1/inch]."""
TITLE, HEADING = 11.0, 10.0
"""Sizes of what stands above a figure and above a panel [pt]."""
LINE, DIGIT, TICK, PAD = 13.0, 6.4, 10.0, 6.0
"""A line of text, a digit of it, a tick with the room around it, and that around what stands above [pt]."""
FEW_DECADES = 1e3
"""Span of a logarithmic axis up to which 2 and 5 of each decade have numbers."""


def draw(chart: Chart) -> Figure:
    """Draw a chart; numbers and units are as they are described."""
    heights = [panel.height for panel in chart.panels]
    figure = _figure_class()(figsize=(WIDTH, BESIDE + sum(heights)), dpi=DPI)
    axes = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    legend: list[str] = []
    for one, panel in zip(axes, chart.panels, strict=True):
        draw_panel(one, chart.x, panel, panel.legend != legend)
        one.label_outer()
        legend = panel.legend
    figure.suptitle(chart.title, fontsize=TITLE, y=1.0 - PAD / (72.0 * figure.get_figheight()))
    _arrange(plain_axes(figure), list(axes), chart)
    return figure


def _arrange(figure: Figure, axes: Sequence[Axes], chart: Chart) -> None:
    """Give panels, one below the other, and their labels the room that these take [pt].

    A constrained layout measures every text for it, several times, and takes longer than the drawing.
    """
    ticks = [one.yaxis.get_major_formatter().format_ticks(one.yaxis.get_majorticklocs().tolist()) for one in axes]
    beside, under = TICK + DIGIT * max(len(text) for texts in ticks for text in texts), TICK + LINE
    above = [LINE + PAD if panel.heading else 0.0 for panel in chart.panels]
    title, gap, more = 1.1 * LINE * len(chart.title.splitlines()), TICK + max(above[1:], default=0.0), len(axes) - 1
    left, right, bottom, top = PAD + LINE + beside, 2.0 * PAD, PAD + LINE + under, 2.0 * PAD + title + above[0]
    width, height = 72.0 * figure.get_size_inches()
    inside = height - top - bottom - more * gap
    figure.subplots_adjust(
        left / width, bottom / height, 1.0 - right / width, 1.0 - top / height, hspace=(more + 1) * gap / inside
    )
    for one in axes:
        one.yaxis.set_label_coords(-beside / (width - left - right), 0.5)
        one.xaxis.set_label_coords(0.5, -under / (one.get_position().height * height))


def draw_panel(axes: Axes, x: Axis, panel: Panel, legend: bool = True) -> None:
    """Draw a panel of a chart over its axis along x."""
    from matplotlib.ticker import LogLocator

    for one in panel.series:
        along, up = x.ended(one.x), panel.y.ended(one.y)
        look: dict[str, Any] = {"color": one.colour, "alpha": one.opacity, "linewidth": one.width, "label": one.name}
        if one.look == FILL:
            axes.fill(along, up, **look | {"linewidth": 0.0})
            continue
        axes.plot(along, up, one.look, markersize=3.0 + one.width / 2.0, **look)
        for dx, dy in ((one.dx, 0.0), (0.0, one.dy)):
            if np.any(dx) or np.any(dy):
                bars = (np.ravel([at - d, at + d, math.nan * at], order="F") for at, d in ((along, dx), (up, dy)))
                axes.plot(*bars, color=one.colour, alpha=0.3)
    for key, axis, own in (("x", x, axes.xaxis), ("y", panel.y, axes.yaxis)):
        axes.set(**{f"{key}scale": "log" if axis.log else "linear", f"{key}lim": axis.view})
        if axis.log:
            few = axis.view[1] < FEW_DECADES * axis.view[0]
            own.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if few else (1.0,)))
            own.set_major_formatter("{x:g}")
            own.set_minor_formatter("")
        if axis.ticks:
            own.set_ticks([*axis.ticks], labels=[*axis.ticks.values()])
    describe(axes, x.label, panel.y.label, panel.heading, panel.y.zero)
    handles, names = axes.get_legend_handles_labels()
    if shown := panel.legend if legend else []:
        axes.legend([handles[names.index(name)] for name in shown], shown, frameon=False, fontsize=9)


def describe(axes: Axes, x: str = "", y: str = "", title: str = "", zero: bool = True) -> None:
    """Write what is drawn; where `zero`, a line is drawn there."""
    if zero:
        axes.axhline(0.0, color=BLACK, linewidth=0.8)
    axes.set(xlabel=x, ylabel=y)
    axes.set_title(title, loc="left", fontsize=HEADING, y=1.0)  # without a y it is measured how high labels reach


def new_figure(size: tuple[float, float]) -> Figure:
    """Return an empty figure of that size [inch], without the state that pyplot keeps; a notebook shows it."""
    return _figure_class()(figsize=size, dpi=DPI, layout="constrained")


@cache
def _figure_class() -> type[Figure]:
    from matplotlib.figure import Figure

    class ShownFigure(Figure):
        def _repr_png_(self) -> bytes:
            """A notebook asks for it; a plain Figure is shown only where pyplot was imported."""
            shown = io.BytesIO()
            self.savefig(shown, format="png")
            return shown.getvalue()

    return ShownFigure


def plain_axes(figure: Figure) -> Figure:
    """Take away the lines above and to the right of each axis; returns the figure."""
    for axis in figure.axes:
        axis.spines[["top", "right"]].set_visible(False)
    return figure


def save_figure(figure: Figure, path: Path) -> None:
    """Save in the format that the name ends on (png, svg, pdf), whole or not at all."""
    if layout := plain_axes(figure).get_layout_engine():
        layout.execute(figure)
        figure.set_layout_engine(None)  # savefig would draw it twice, to find the layout again
    form = path.suffix[1:]  # a PNG a tenth larger, in two thirds of the time
    quick: dict[str, Any] = {"pil_kwargs": {"compress_level": 1}} if form == "png" else {}
    with whole(path) as part:
        figure.savefig(part, format=form, **quick)
