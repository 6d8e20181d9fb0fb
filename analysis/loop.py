"""Area of a closed path in the plane of displacement and force: the energy that it dissipates, W = ∮ F dd."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CLOSURE = 1e-9
"""Distance of two displacements over the width of the path up to which they are one: round-off."""


@dataclass(frozen=True)
class Loop:
    """A closed path.

    Attributes:
        area: ∮ F dd [FU·LU], by the trapezoidal rule.
        uncertainty: of it, by the rows between which F is not known [FU·LU].
        whole: ∫ |F| |dd| [FU·LU]: of all that is done on the way.
        length: ∫ |dd| [LU].
    """

    area: float
    uncertainty: float
    whole: float
    length: float


def loop_of(displacement: Sequence[float], force: Sequence[float]) -> Loop | None:
    """The loop of a path through the rows, (n,) [LU] and (n,) [FU]; None where it does not close, or stays in place.

    Between two rows a smooth curve departs from its chord by h³F″/12, F″ from the chords before and after. Where the
    chord's own slope is not the mean of these two, the force may have jumped, anywhere between the rows: that part of
    its change may count for half of the increment h more or less. A way back over the same places misses as much of the
    same curve as the way there, so that there the difference of the two is what counts.
    """
    d, f = np.asarray(displacement, dtype=np.float64), np.asarray(force, dtype=np.float64)
    same = CLOSURE * float(np.ptp(d))
    if same == 0.0 or len(d) < 3 or abs(d[-1] - d[0]) > same:
        return None
    h, mean = np.diff(d), 0.5 * (f[1:] + f[:-1])
    half = len(d) // 2
    if np.abs(d - d[::-1]).max() <= same and (np.diff(np.sign(h)) != 0.0).sum() == 1:
        uncertainty = _missed(np.abs(h[:half]), np.diff(f[: half + 1] - f[half:][::-1]))
    else:
        turns = np.flatnonzero(np.diff(np.sign(h)) != 0.0) + 1
        legs = [leg for leg in np.split(np.arange(len(h)), turns) if h[leg[0]] != 0.0]
        uncertainty = sum(_missed(np.abs(h[leg]), np.diff(f)[leg]) for leg in legs)
    return Loop(float(mean @ h), uncertainty, float(np.abs(mean) @ np.abs(h)), float(np.abs(h).sum()))


def _missed(h: Array, rise: Array) -> float:
    """What the trapezoidal rule may miss on a leg of increments h > 0 with these changes of the force."""
    if len(h) < 2:
        return float(0.5 * h @ np.abs(rise))
    padded_h, padded = np.pad(h, 1, mode="edge"), np.pad(rise / h, 1, mode="edge")
    before, after = padded[:-2], padded[2:]
    bend = np.abs(after - before) / (0.5 * (padded_h[:-2] + padded_h[2:]) + h)
    jump = h * np.abs(rise / h - 0.5 * (before + after))
    return float((h**3 * bend / 12.0 + 0.5 * h * jump).sum())
