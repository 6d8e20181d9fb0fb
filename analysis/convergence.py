"""Discretisation error of a result on a lattice, from its values on two finer ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = Array | float
TINY = float(np.finfo(np.float64).tiny)
SLOWEST = 0.9
"""Largest ratio of the second difference to the first at which three spacings count as converging."""


def extrapolated(coarse: Numbers, fine: Numbers, finest: Numbers) -> Array:
    """Return |v_h − v_{h/2}|/(1 − q), with the observed ratio q = 2⁻ᵖ of the differences of three spacings h, h/2, h/4.

    For v_h = v + c hᵖ it is |v_h − v|. Where the second difference is the larger one, the first is small by accident,
    and later ones are assumed to halve.
    """
    first, second = np.abs(np.subtract(coarse, fine)), np.abs(np.subtract(fine, finest))
    share = np.minimum(second, SLOWEST * first) / np.maximum(first, TINY)
    return np.asarray(np.where(second > first, first + 2.0 * second, first / (1.0 - share)))
