"""Figures of the body of three dimensions, and what every figure of a run has: its title, and axes in SI.

A label names its unit in brackets, "force (FU)"; `in_si` puts the unit of SI there with a prefix that fits the numbers.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.plots import COMPRESSION, SIZE, TENSION, THEORY, new_figure

if TYPE_CHECKING:
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Conversion = Callable[[float, str], tuple[float, str]]
"""Of a number in a model unit: the factor to the unit that is written, and that unit, by the number's size."""
UNIT = re.compile(r"\(([A-Z]{2}(?:[·/][A-Z]{2}²?)*)\)")
NUMBER = re.compile(r"([\d.]+(?:e[+-]?\d+)?) ((?:LU|FU)(?:[·/][A-Z]{2}²?)*)")
DIGITS = 4
VIEW = 2.0
"""Largest contact radius that is shown, over itself: beyond is only the tail of an attraction."""
CLEAR = 5.0
"""Largest pressure that is shown over that at a third of the contact radius: a pole at the edge would hide the rest."""


def body_pressure_figure(
    pressures: Mapping[str, tuple[Array, Array, float]],
    theories: Mapping[str, tuple[str, Array, Array]],
) -> Figure:
    """p over r of each state, one panel below the other, the closed form beside it.

    Args:
        pressures: r [LU], p [FU/LU²] and the contact radius [LU] by state.
        theories: name of the closed form, r and p, by state.
    """
    figure = new_figure((SIZE[0], 1.2 + 2.6 * len(pressures)))
    axes = figure.subplots(len(pressures), 1, sharex=True, squeeze=False)[:, 0]
    for axis, (name, (r, p, edge)) in zip(axes, pressures.items(), strict=True):
        shown = np.isfinite(p)
        axis.plot(r[shown], p[shown], "o", color=COMPRESSION, markersize=3.5, label="this run")
        if name in theories:
            words, at, said = theories[name]
            axis.plot(at, said, "-", color=THEORY, linewidth=1.4, zorder=0, label=words)
        axis.axhline(0.0, color="black", linewidth=0.8)
        axis.axvline(edge, color=TENSION, linewidth=1.0, linestyle="--", label=f"contact radius a = {edge:.4g} LU")
        inner = p[shown & (r <= max(edge / 3.0, r[min(2, r.size - 1)]))]
        top = CLEAR * float(np.abs(inner).max(initial=0.0)) or 1e-12
        axis.set_ylim(max(1.1 * min(float(p[shown].min()), 0.0), -top), min(1.1 * max(float(p[shown].max()), 0.0), top))
        axis.set_ylabel("pressure (FU/LU²)")
        axis.set_title(f"{name.replace('_', ' ')} state", loc="left", fontsize=10)
        axis.legend(frameon=False, fontsize=9)
    axes[-1].set_xlabel("distance from the axis r (LU)")
    widest = max(edge for _, _, edge in pressures.values())
    farthest = max(float(r.max()) for r, _, _ in pressures.values())
    axes[-1].set_xlim(0.0, 1.05 * min(max(farthest, widest), VIEW * widest))
    return figure


def entitled(figure: Figure, title: str) -> Figure:
    """The figure with a title above everything else, the scene's; returns it."""
    figure.suptitle(title, fontsize=11)
    return figure


def in_si(figure: Figure, conversion: Conversion) -> Figure:
    """The figure with units of SI at its axes and in its words; returns it. What is drawn stays as it is."""
    for axes in figure.axes:
        for axis, limits in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):
            _axis_in_si(axis, max(map(abs, limits)), conversion)
        words: list[Any] = [*axes.texts, axes.title, getattr(axes, "_left_title", None)]
        legend = axes.get_legend()
        words += list(legend.get_texts()) if legend is not None else []
        for text in filter(None, words):
            text.set_text(NUMBER.sub(lambda found: _number_in_si(found, conversion), text.get_text()))
    return figure


def _axis_in_si(axis: Axis, largest: float, conversion: Conversion) -> None:
    from matplotlib.ticker import FuncFormatter, MaxNLocator

    label = axis.get_label_text()
    found = UNIT.search(label)
    if found is None:
        return
    factor, unit = conversion(largest, found[1])

    class Scaled(MaxNLocator):
        """Round numbers in the unit that is written."""

        def tick_values(self, vmin: float, vmax: float) -> Any:
            return np.asarray(super().tick_values(vmin * factor, vmax * factor)) / factor

    axis.set_major_locator(Scaled(nbins=7, steps=[1, 2, 2.5, 5, 10]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value * factor:.6g}".replace("-", "\N{MINUS SIGN}")))
    axis.set_label_text(label.replace(found[0], f"({unit})"))


def _number_in_si(found: re.Match[str], conversion: Conversion) -> str:
    number = float(found[1])
    factor, unit = conversion(number, found[2])
    return f"{number * factor:.{DIGITS}g} {unit}"
