"""Discretisation error of a result on a lattice, from its values on two finer ones."""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = Array | float
TINY = sys.float_info.min
SLOWEST = 0.9
"""Largest ratio of the second difference to the first at which three spacings count as converging."""


def extrapolated(coarse: Numbers, fine: Numbers, finest: Numbers) -> Array:
    """Return the discretisation error of `coarse`, ≥ 0, in its unit and of its shape: |v_h − v_{h/2}|/(1 − q).

    q is the observed ratio |v_{h/2} − v_{h/4}|/|v_h − v_{h/2}|, bounded to 0.9: of v_h = v + c hᵖ it is 2⁻ᵖ, and the
    error is |v_h − v|. Where the second difference is the larger one, the first is small by accident: the error is then
    |v_h − v_{h/2}| + 2 |v_{h/2} − v_{h/4}|. It is 0 where all three are equal.

    Args:
        coarse, fine, finest: values on lattices of spacing h, h/2 and h/4.
    """
    first, second = np.abs(np.subtract(coarse, fine)), np.abs(np.subtract(fine, finest))
    share = np.minimum(second, SLOWEST * first) / np.maximum(first, TINY)
    return np.where(second > first, first + 2.0 * second, first / (1.0 - share))
