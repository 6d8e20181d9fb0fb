"""Descriptions of charts: axes with units, and series in panels one below the other.

A description has arrays and texts, and needs no drawing library. `analysis.plots` draws it by matplotlib, for files and
Python; `workflow.report.charts` by plotly, for a page. Both draw what `Chart.written` returns.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
UnitOf = Callable[[float, str], tuple[float, str]]
"""Maps the largest number and its unit to the factor to the unit in which it is written, and that unit."""
COMPRESSION, TENSION, LOADING, UNLOADING, THEORY = "#0072B2", "#D55E00", "#56B4E9", "#0072B2", "#555555"
"""Okabe and Ito's colours, which the colour-blind can tell apart; theories are grey."""
BLACK = "#000000"
"""The colour of marks and bounds, which belong to no run."""
FILL = "fill"
"""The look of a series that is the outline of an area; other looks are matplotlib's: "-", "--", "o", "o-"."""
ENDLESS = np.asarray([-math.inf, math.inf])
"""From one end of an axis to the other."""


@dataclass(frozen=True)
class Axis:
    """An axis of a chart, with the measured quantity.

    Attributes:
        name, unit, remark: `force`, `FU`, `, compression positive`; the unit "1" is that of a number.
        zero: whether 0 is shown, with a line.
        log: whether it is logarithmic.
        ticks: labels in place of numbers, by their positions.
        view: lower and upper end of the axis, in the unit of the numbers; NaN before `written` has chosen them.
    """

    name: str
    unit: str = "1"
    remark: str = ""
    zero: bool = False
    log: bool = False
    ticks: Mapping[float, str] = field(default_factory=dict)
    view: tuple[float, float] = (math.nan, math.nan)

    @property
    def label(self) -> str:
        """Name, unit and remark, as in `force (FU), compression positive`; the unit "1" is not written."""
        return f"{self.name}{'' if self.unit == '1' else f' ({self.unit})'}{self.remark}"

    def ended(self, values: Array) -> Array:
        """Return a copy of the values, (…), with −∞ and ∞ replaced by the lower and the upper end of the axis.

        NaN stays.
        """
        return np.nan_to_num(values, nan=math.nan, neginf=self.view[0], posinf=self.view[1])

    def written(self, numbers: Sequence[Array], unit_of: UnitOf) -> tuple[float, Axis]:
        """Return the factor to the unit that fits the numbers, and a copy of the axis in it, with ends around them.

        There are 5 % of the span beyond the numbers on both sides (of equal numbers 5 % of their size, of none or only
        0 ±0.05), on a logarithmic axis of its logarithms. Numbers that are not finite do not count, nor those ≤ 0 on a
        logarithmic axis, which must have one above 0. An axis with `zero` includes 0.

        Args:
            numbers: arrays of what is drawn, in the axis' unit.
            unit_of: returns factor and new unit for the largest |number| and its unit.
        """
        shown = np.concatenate([[0.0] * self.zero, *map(np.ravel, numbers)])
        shown = shown[np.isfinite(shown) & ((shown > 0.0) | (not self.log))]
        low, high = (shown.min(), shown.max()) if shown.size else (0.0, 0.0)
        factor, unit = unit_of(max(abs(low), abs(high)), self.unit)
        ends = np.log([low, high]) if self.log else np.asarray([low, high])
        span, size = np.ptp(ends), np.abs(ends).max()
        constant = not span > 1e-9 * size  # whose round-off is not magnified
        margin = 0.05 * ((size or 1.0) if constant else span)
        low, high = ends[0] - margin, ends[1] + margin
        view = (math.exp(low), math.exp(high)) if self.log else (low, high)
        return factor, replace(self, unit=unit, view=(factor * view[0], factor * view[1]))


@dataclass(frozen=True, eq=False)
class Series:
    """A line, points, or the outline of an area.

    Attributes:
        x, y: arrays (n,); NaN is a gap, ±∞ the end of the axis. In a chart that moves either may be (m, n), m states.
        name: in the legend; a name of several series appears once.
        colour, look, width, opacity: see FILL.
        dx, dy: uncertainties, which points show as bars.
    """

    x: Array
    y: Array
    name: str = ""
    colour: str = THEORY
    look: str = "-"
    width: float = 1.4
    opacity: float = 1.0
    dx: Array | float = 0.0
    dy: Array | float = 0.0


@dataclass(frozen=True)
class Panel:
    """A panel of a chart: all that is drawn over one pair of axes.

    Attributes:
        y: the axis upwards; all panels of a chart share the axis along x.
        series: in the order in which they are drawn. Theories, marked by their colour, do not widen the view.
        title, note: above the panel; the note has numbers of one run.
        height: [inch].
    """

    y: Axis
    series: Sequence[Series]
    title: str = ""
    note: str = ""
    height: float = 3.2

    @property
    def heading(self) -> str:
        """The title and the note of a panel, joined by ", "; "" where it has neither."""
        return ", ".join(filter(None, [self.title, self.note]))

    @property
    def legend(self) -> list[str]:
        """The names in the legend, each once, in order: all up to seven; of more the first three and the last three."""
        names, most = list(dict.fromkeys(series.name for series in self.series if series.name)), 7
        return names if len(names) <= most else names[: most // 2] + names[-(most // 2) :]


@dataclass(frozen=True)
class Chart:
    """Panels one below the other over one axis, and their title.

    Attributes:
        x: the axis along x, of all panels.
        panels: from the top.
        title: above all panels; "" for none.
    """

    x: Axis
    panels: Sequence[Panel]
    title: str = ""

    def written(self, unit_of: UnitOf, words: Callable[[str], str] = str) -> Chart:
        """Return the chart as it is drawn: every axis with its ends, and in the unit that fits its numbers.

        Series of theories, marked by their colour, widen no axis, unless a panel has no others. The numbers are
        converted in copies; this chart stays.

        Args:
            unit_of: returns the factor and the unit in which a number is written, for the largest and its unit.
            words: puts the numbers of a text, a name in a legend, a panel's title or note, into these units; by default
                unchanged.
        """
        decisive = [[line for line in panel.series if line.colour != THEORY] or panel.series for panel in self.panels]
        signs = (-1.0, 1.0)  # both ends of an uncertainty
        ends = [line.x + sign * line.dx for lines in decisive for line in lines for sign in signs]
        along, x = self.x.written(ends, unit_of)
        panels = []
        for panel, lines in zip(self.panels, decisive, strict=True):
            up, y = panel.y.written([line.y + sign * line.dy for line in lines for sign in signs], unit_of)
            series = [
                replace(
                    line, x=line.x * along, dx=line.dx * along, y=line.y * up, dy=line.dy * up, name=words(line.name)
                )
                for line in panel.series
            ]
            panels.append(replace(panel, y=y, series=series, title=words(panel.title), note=words(panel.note)))
        return replace(self, x=x, panels=panels)


def upright(*positions: float, **look: Any) -> Series:
    """Return one series of dashed lines along y, from end to end of a panel, at positions along x, in its unit.

    `look` has fields of Series, which go over black colour, dashes and width 1.
    """
    x, y = np.repeat(positions, 3), np.tile([*ENDLESS, math.nan], len(positions))
    return Series(x, y, **{"colour": BLACK, "look": "--", "width": 1.0, **look})


def area(x: Any, y: Any, **look: Any) -> Series:
    """Return the filled rectangle between two ends along x and two along y, in the axes' units.

    ±∞ is an end of an axis. `look`: fields of Series other than `look`.
    """
    return Series(np.repeat(x, 2), np.asarray([*y, *y[::-1]]), look=FILL, **look)
