"""What a result on a lattice is off by, from the same on finer ones."""

from __future__ import annotations

SLOWEST = 0.9
"""Ratio of two differences of three spacings above which they do not shrink."""


def extrapolated(coarse: float, fine: float, finest: float) -> float:
    """|v_h − v_{h/2}|/(1 − q) with the observed ratio q = 2⁻ᵖ of the differences of three spacings h, h/2, h/4.

    For v_h = v + c hᵖ it is |v_h − v|. Where the second difference is the larger one, the first is small by accident,
    and later ones are taken to halve.
    """
    first, second = abs(coarse - fine), abs(fine - finest)
    if second > first:
        return first + 2.0 * second
    return first / (1.0 - min(second / first, SLOWEST)) if first else 0.0
