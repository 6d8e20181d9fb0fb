"""How far particles of opposite bodies feel each other.

The cutoff of a slide follows from how a particle is held along x by a straight row of opposite ones,

    F_x(x, z) = Σ_j f(r_j) (x − j s)/r_j,    r_j = √((x − j s)² + z²)

a small difference of large sums: at the spacing of the longest range b it is some 1e-2 of one pair's force.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from contact1d.potentials import DoubleExponential
from contact1d.workflow.laws.law import Law
from contact1d.workflow.model.chain import reaches_too_far
from contact1d.workflow.scene import Interaction, Scene

Array = NDArray[np.float64]
REACH = 40.0
"""Reach of the sums, and of the longest cutoff, over the longest range."""
ASIDE, HEIGHTS = 33, 400
"""Positions within half a spacing, and heights, that are examined."""
LEFT_OUT = 0.1
"""Force of a pair at the cutoff over the largest force along x, per unit of tolerance: each pair that comes within
reach, or leaves it, changes that by that much at once."""
THERMAL_SIGMAS = 5.0
"""Standard deviations by which a particle's thermal motion brings it nearer."""


def slide_cutoff(law: DoubleExponential, spacing: float, load: float, share: float) -> float:
    """Cutoff [LU] at which a pair's force is LEFT_OUT `share` of the largest force along x [FU].

    Args:
        law: of a pair.
        spacing: of the row [LU].
        load: on a particle [FU], compression positive.
        share: the tolerance.
    """
    holding = max(largest_holding_force(law, spacing, load), np.finfo(float).tiny)
    far = law.repulsion if law.attraction is None else law.attraction
    start = far.range * math.log(far.amplitude / far.range / (LEFT_OUT * share * holding))
    return min(max(start, law.longest_range), REACH * law.longest_range)


def largest_holding_force(law: DoubleExponential, spacing: float, load: float) -> float:
    """max_x F_x [FU] of a particle pressed by a load [FU] onto a rigid chain, at its height in a potential minimum."""
    reach = math.ceil(REACH * law.longest_range / spacing) + 1
    row: Array = np.asarray(spacing * np.arange(-reach, reach + 1), dtype=np.float64)
    heights: Array = np.asarray(law.longest_range * np.geomspace(1e-2, 10.0, HEIGHTS))
    _, upward = _row_forces(law, 0.5 * spacing - row, heights)
    carried = np.flatnonzero(upward >= load)
    height = float(heights[carried[-1]] if carried.size else heights[0])
    x: Array = np.linspace(0.0, 0.5 * spacing, ASIDE)
    along = [float(_row_forces(law, place - row, np.asarray([height]))[0][0]) for place in x.tolist()]
    return float(np.max(np.abs(along)))


def _row_forces(law: DoubleExponential, aside: Array, heights: Array) -> tuple[Array, Array]:
    """Forces along x and z [FU] of pairs so far `aside` [LU], summed, at each of the heights [LU]."""
    distance = np.hypot(aside[None, :], heights[:, None])
    over = law.force(distance) / distance
    return (over * aside).sum(axis=1), over.sum(axis=1) * heights


def cutoff_for(scene: Scene, law: DoubleExponential, share: float, tolerance: float) -> float:
    """The scene's cutoff [LU], or the one beyond which the force is below a share of the force scale.

    In a slide also below what the tolerance leaves of the force along x.
    """
    given = scene.the(Interaction).cutoff
    if given != "auto":
        return given
    reach = law.cutoff_for(share)
    if scene.experiment.motion_is_result and not reaches_too_far(scene, reach):
        return max(reach, slide_cutoff(law, scene.bodies.spacing, 0.0, tolerance))
    return reach


def innermost_distance(estimate: Law, cutoff: float, displacement: float) -> float:
    """Distance [LU] of the predictor's innermost pair at a displacement [LU]; its grid ends at the cutoff [LU]."""
    grid = cutoff / estimate.gap.size * np.arange(1, estimate.gap.size + 1)
    return float(np.interp(estimate.rest - displacement, estimate.gap, grid))


def thermal_motion(scene: Scene) -> float:
    """Thermal approach [LU] of two particles on their springs: THERMAL_SIGMAS √(2 k_BT/k)."""
    return THERMAL_SIGMAS * math.sqrt(2.0 * scene.temperature / scene.bulk_stiffness)
