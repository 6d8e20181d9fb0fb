"""A row of places that rise evenly: its spacing and its middle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def spacing_of(x: Array) -> float:
    """The mean distance of neighbours [length], of rising places x, (n,), n >= 1; 0 for one."""
    return float(np.ptp(x)) / max(x.size - 1, 1)


def middle_of(x: Array) -> float:
    """The middle between both ends [length]."""
    return float(0.5 * (x.max() + x.min()))
