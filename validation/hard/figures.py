"""The figure of a class: points over one quantity, a dashed line at the bound, a logarithmic axis where asked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from contact1d.analysis.plots import THEORY, new_figure
from validation.judging.figures import COLOURS, MARKERS, Series, save

SIZE = (6.4, 4.2)


def points_figure(
    path: Path,
    measured: Sequence[Series],
    labels: tuple[str, str],
    theory: Sequence[Series] = (),
    bound: float | None = None,
    log: str = "xy",
) -> None:
    """Draw series as points and theory as lines, and save.

    Args:
        path: of the PNG.
        measured: points.
        labels: of x and y.
        theory: lines.
        bound: where a dashed line is drawn.
        log: which axes are logarithmic, letters of "xy".
    """
    figure = new_figure(SIZE)
    axis = figure.subplots()
    for line in theory:
        axis.plot(line.x, line.y, "-", color=THEORY, linewidth=1.0, label=line.name)
    for i, one in enumerate(measured):
        marker = MARKERS[i % len(MARKERS)]
        axis.plot(one.x, one.y, marker, color=COLOURS[i % len(COLOURS)], fillstyle="none", label=one.name)
    if bound is not None:
        axis.axhline(bound, color=THEORY, linewidth=1.0, linestyle="--")
    for letter in log:
        getattr(axis, f"set_{letter}scale")("log")
    axis.set_xlabel(labels[0])
    axis.set_ylabel(labels[1])
    axis.legend(frameon=False, fontsize=8)
    save(figure, path)
