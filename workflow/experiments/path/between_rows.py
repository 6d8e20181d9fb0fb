"""What the rows of a path miss of the largest tension, by the same rows of the estimate.

Rows are the scene's own, and polynomials through rows that are wide beside a sharp maximum agree with each other by
chance. Independent pairs on the chain's own places,

    F(d) = Σ_i f(r_i),    G(r_i) = r₀ + h(x_i) − d,    pairs that snap on the branch that unloads,

have maxima as sharp, and theirs is known: what is read off the estimate at the path's rows misses it by some share.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import largest_tension
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

Array = NDArray[np.float64]
MARGIN = 1.5
"""Claim over the share by which the estimate is missed: it knows no neighbours, and its maximum lies elsewhere."""
SHIFTS = (0.0, 0.25, 0.5, 0.75)
"""Shifts of the rows over their increment, of which the worst counts: the estimate's maximum has another place."""
MOST_PAIRS, MOST_PLACES = 4_000_000, 32
"""Forces that are looked up, and places between two rows."""


def missed_between_rows(scene: Scene, settings: Settings, displacements: Sequence[float]) -> float:
    """Share of the largest tension that rows at falling displacements [LU] may miss; 0 where the estimate has none."""
    if len(displacements) < 2:
        return 0.0
    estimate = settings.estimate
    x = scene.bodies.spacing * (np.arange(settings.particles) - 0.5 * (settings.particles - 1))
    heights, counts = np.unique(estimate.profile.height(np.abs(x)), return_counts=True)
    rows = np.asarray(displacements, dtype=np.float64)

    def forces(places: Array) -> Array:
        gaps = estimate.rest + heights - places[:, None]
        return np.asarray(np.interp(gaps, estimate.gap, estimate.force, right=0.0) @ counts)

    between = int(np.clip(MOST_PAIRS // (rows.size * heights.size), 2, MOST_PLACES))
    places = np.linspace(0.0, rows.size - 1.0, (rows.size - 1) * between + 1)
    fine = np.interp(places, np.arange(rows.size), rows)
    curve = forces(fine)
    top = int(np.argmin(curve))
    if not curve[top] < 0.0:
        return 0.0
    increment = abs(float(fine[max(top - between, 0)] - fine[min(top + between, fine.size - 1)])) / 2.0
    read = [largest_tension(rows.tolist(), forces(rows + shift * increment).tolist()).smooth for shift in SHIFTS]
    return MARGIN * max(abs(value / -float(curve[top]) - 1.0) for value in read)
