"""How a figure is made: its colours, panels, axes and words, units of SI, and the file.

A label names its unit in brackets, "force (FU)"; `in_si` puts the unit of SI there with a prefix that fits the numbers.
"""

from __future__ import annotations

import io
import re
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from contact1d.files import whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
COMPRESSION, TENSION, LOADING, UNLOADING, THEORY = "#0072B2", "#D55E00", "#56B4E9", "#0072B2", "#555555"
"""Okabe and Ito's colours, which the colour-blind can tell apart."""
SIZE = (6.4, 4.2)
DPI = 120


class Units(Protocol):
    """What units of the model stand for."""

    def written(self, value: float, unit: str) -> tuple[float, str]:
        """The factor to the unit in which a number of this size is written, and that unit."""

    def in_words(self, text: str) -> str:
        """A text with its numbers in these units."""


UNIT = re.compile(r"\(([^() ]+)\)")
"""Of an axis, in its label."""


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
    plain_axes(figure)
    with whole(path) as part:
        figure.savefig(part, format=path.suffix[1:])


def panels(count: int = 1, height: float = SIZE[1], sharex: bool = True, **layout: Any) -> tuple[Figure, list[Axes]]:
    """An empty figure of that height [inch], and its panels, one below the other, over the same axis if `sharex`."""
    figure = new_figure((SIZE[0], height))
    return figure, figure.subplots(count, 1, sharex=sharex, squeeze=False, **layout)[:, 0].tolist()


def describe(axis: Axes, x: str = "", y: str = "", title: str = "", zero: bool = True) -> None:
    """Write what is drawn; where `zero`, a line is drawn there."""
    if zero:
        axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set(xlabel=x, ylabel=y)
    axis.set_title(title, loc="left", fontsize=10)


def legend(axis: Axes, place: Any = "best", size: float | None = 9) -> None:
    """Name what has a label."""
    axis.legend(frameon=False, loc=place, fontsize=size)


def beside(axis: Axes, theory: tuple[str, Array, Array], style: str = "--", width: float = 1.4) -> None:
    """Draw a theory, by its name, x and y, below what is measured where its line goes through."""
    name, x, y = theory
    axis.plot(x, y, style, color=THEORY, linewidth=width, zorder=2.0 if style == "--" else 0.0, label=name)


def mark(axis: Axes, *places: float, colour: str = "black", label: str | None = None) -> None:
    """Draw dashed lines across the axis at these places along x."""
    for place in places:
        axis.axvline(place, color=colour, linewidth=1.0, linestyle="--", label=label)


def in_si(figure: Figure, units: Units) -> Figure:
    """The figure with units of SI at its axes and in its words; returns it. What is drawn stays as it is."""
    from matplotlib.text import Text

    for axes in figure.axes:
        for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            _axis_in_si(axis, max(map(abs, limits)), units)
        for text in axes.findobj(Text):
            assert isinstance(text, Text)
            text.set_text(units.in_words(text.get_text()))
    return figure


def _axis_in_si(axis: Axis, largest: float, units: Units) -> None:
    from matplotlib.ticker import FuncFormatter, MaxNLocator, NullFormatter

    label = axis.get_label_text()
    found = UNIT.search(label)
    if found is None:
        return
    factor, unit = units.written(largest, found[1])
    axis.set_label_text(label.replace(found[0], f"({unit})"))
    if factor == 1.0:
        return

    class Scaled(MaxNLocator):
        """Round numbers in the unit that is written."""

        def tick_values(self, vmin: float, vmax: float) -> Any:
            return np.asarray(super().tick_values(vmin * factor, vmax * factor)) / factor

    if axis.get_scale() == "linear":
        axis.set_major_locator(Scaled(nbins=7, steps=[1, 2, 2.5, 5, 10]))
    else:
        axis.set_minor_formatter(NullFormatter())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value * factor:.6g}".replace("-", "\N{MINUS SIGN}")))
