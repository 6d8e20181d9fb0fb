"""Figures of a motion under heat: what a contact does over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.plots import COMPRESSION, SIZE, TENSION, THEORY, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BEFORE = "#bbbbbb"
"""Of what is not measured yet: a contact that forgets its start."""


def samples_figure(
    columns: Mapping[str, NDArray[np.float64]], measured: NDArray[np.bool_], mean: float | None = None
) -> Figure:
    """Displacement and force over time, what comes before the measurement in grey; the load beside the force.

    Args:
        columns: of samples.csv, `time` [TU], `displacement` [LU], `force` and `load` [FU].
        measured: which rows are.
        mean: of the displacement [LU], where it is a result.
    """
    figure = new_figure(SIZE)
    upper, lower = figure.subplots(2, 1, sharex=True)
    time = columns["time"]
    for axis, name, unit in ((upper, "displacement", "LU"), (lower, "force", "FU")):
        axis.plot(time[~measured], columns[name][~measured], ".", color=BEFORE, markersize=3)
        axis.plot(time[measured], columns[name][measured], ".-", color=COMPRESSION, markersize=3, linewidth=0.6)
        axis.set_ylabel(f"{name} ({unit})")
    lower.plot(time, columns["load"], color=TENSION, linewidth=1.2, label="load")
    lower.legend(frameon=False, fontsize=9)
    if mean is not None:
        upper.axhline(mean, color=TENSION, linewidth=1.2, label="mean")
        upper.legend(frameon=False, fontsize=9)
    if not measured.all():
        upper.set_title("grey: before the measurement", loc="left", fontsize=9, color=THEORY)
    lower.set_xlabel("time (TU)")
    return figure
