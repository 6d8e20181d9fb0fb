"""The cutoff of the interaction of opposite particles, and their smallest distance.

The cutoff of a slide follows from the tangential force of a straight row of opposite particles on one,

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


def slide_cutoff(law: DoubleExponential, spacing: float, load: float, tolerance: float) -> float:
    """Return the cutoff [LU] at which a pair's force is a tenth of the tolerance of the largest tangential force.

    Between the longest range of the interaction and 40 times that. Each pair that comes within the cutoff or leaves it
    changes the tangential force by that much at once.

    Args:
        law: interaction of a pair.
        spacing: distance of neighbours in the row [LU].
        load: load on a particle [FU], compression positive.
        tolerance: relative tolerance of the force.
    """
    holding = max(largest_holding_force(law, spacing, load), np.finfo(float).tiny)
    far = law.repulsion if law.attraction is None else law.attraction
    start = far.range * math.log(far.amplitude / far.range / (0.1 * tolerance * holding))
    return min(max(start, law.longest_range), REACH * law.longest_range)


def largest_holding_force(law: DoubleExponential, spacing: float, load: float) -> float:
    """Return max_x |F_x| [FU] of a particle under a load [FU] on a rigid chain, at its height in a potential minimum.

    The maximum is taken over 33 positions within half a `spacing` [LU], the height is one of 400: the largest that
    carries the load, compression positive, or where none does the smallest.
    """
    reach = math.ceil(REACH * law.longest_range / spacing) + 1
    row: Array = np.asarray(spacing * np.arange(-reach, reach + 1), dtype=np.float64)
    heights: Array = np.asarray(law.longest_range * np.geomspace(1e-2, 10.0, 400))
    _, upward = _row_forces(law, 0.5 * spacing - row, heights)
    carried = np.flatnonzero(upward >= load)
    height = float(heights[carried[-1]] if carried.size else heights[0])
    x: Array = np.linspace(0.0, 0.5 * spacing, 33)
    along = [float(_row_forces(law, position - row, np.asarray([height]))[0][0]) for position in x.tolist()]
    return float(np.max(np.abs(along)))


def _row_forces(law: DoubleExponential, offsets: Array, heights: Array) -> tuple[Array, Array]:
    """Return (sums along x, sums along z), (m,) [FU], of pair forces at lateral offsets [LU], at heights (m,) [LU].

    Repulsion is positive along z.
    """
    distance = np.hypot(offsets[None, :], heights[:, None])
    ratio = law.force(distance) / distance
    return (ratio * offsets).sum(axis=1), ratio.sum(axis=1) * heights


def cutoff_for(scene: Scene, law: DoubleExponential, share: float, tolerance: float) -> float:
    """Return the scene's cutoff [LU], or the distance beyond which a pair's force is below a share of the force scale.

    In a slide it is `slide_cutoff` at least, unless it is too long for any run. `tolerance`: relative.
    """
    given = scene.the(Interaction).cutoff
    if given != "auto":
        return given
    reach = law.cutoff_for(share)
    if scene.experiment.motion_is_result and not reaches_too_far(scene, reach):
        return max(reach, slide_cutoff(law, scene.bodies.spacing, 0.0, tolerance))
    return reach


def innermost_distance(estimate: Law, cutoff: float, displacement: float) -> float:
    """Return the distance [LU] of the predictor's innermost pair at a displacement [LU].

    Its grid ends at `cutoff` [LU]. 0 < distance ≤ cutoff.
    """
    grid = cutoff / estimate.gap.size * np.arange(1, estimate.gap.size + 1)
    return float(np.interp(estimate.rest - displacement, estimate.gap, grid))


def thermal_motion(scene: Scene) -> float:
    """Return the thermal approach [LU] of two particles on their springs: five standard deviations, 5 √(2 k_BT/k).

    0 without noise.
    """
    return 5.0 * math.sqrt(2.0 * scene.temperature / scene.bulk_stiffness)
