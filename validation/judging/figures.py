"""What figures share: colours, markers, points with a name, and how a file is saved."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.plots import save_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#999933")
"""Okabe and Ito's colours, and one more."""
MARKERS = "osD^vP*Xh"


@dataclass(frozen=True)
class Series:
    """Points with a name; `spread` their uncertainty or None."""

    name: str
    x: Array
    y: Array
    spread: Array | None = None


def save(figure: Figure, path: Path) -> None:
    """Save whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    save_figure(figure, path)
