"""Numerical limits that several laws share, and the value of a function of arrays at one number."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

ROUND_OFF = 1e-9
"""Relative difference of two displacements, positions or moments that counts as round-off."""
NARROWEST = 1e-12
"""Least height, over the spacing, over which a cell comes to touch or separates: no formula may divide by 0."""


def value_at(function: Callable[[NDArray[np.float64]], NDArray[np.float64]], position: float) -> float:
    """Return the value, in its unit, of a function of positions, (n,), at one position, in the unit of these."""
    return float(function(np.asarray([position]))[0])
