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


def slide_cutoff(law: DoubleExponential, spacing: float, tolerance: float) -> float:
    """Return the cutoff [LU] at which a pair's force is a tenth of the tolerance of the largest tangential force.

    The latter is that on a particle that slides over a rigid row of opposite ones. The pair's force is that of the
    attraction alone, or of the repulsion where there is no attraction. The result is kept between the longest range of
    the interaction and 40 times that.

    Args:
        law: interaction of a pair.
        spacing: distance of neighbours in the row [LU].
        tolerance: relative tolerance of the force.
    """
    holding = max(largest_holding_force(law, spacing), np.finfo(float).tiny)
    far = law.repulsion if law.attraction is None else law.attraction
    start = far.range * math.log(far.amplitude / far.range / (0.1 * tolerance * holding))
    return min(max(start, law.longest_range), REACH * law.longest_range)


def largest_holding_force(law: DoubleExponential, spacing: float) -> float:
    """Return the largest |F_x| [FU] ≥ 0 of a particle that moves over a rigid straight row of opposite particles.

    Its height is fixed at the largest of 400, from 0.01 to 10 times the longest range, at which it is not
    attracted, midway between two of them; where there is none, at the smallest. The maximum is taken over 33 positions
    along x within half a `spacing` [LU].
    """
    reach = math.ceil(REACH * law.longest_range / spacing) + 1
    row: Array = np.asarray(spacing * np.arange(-reach, reach + 1), dtype=np.float64)
    heights: Array = law.longest_range * np.geomspace(1e-2, 10.0, 400)
    _, upward = _row_forces(law, 0.5 * spacing - row, heights)
    carried = np.flatnonzero(upward >= 0.0)
    height = float(heights[carried[-1]] if carried.size else heights[0])
    x: Array = np.linspace(0.0, 0.5 * spacing, 33)
    along = [float(_row_forces(law, position - row, np.asarray([height]))[0][0]) for position in x.tolist()]
    return float(np.max(np.abs(along)))


def _row_forces(law: DoubleExponential, offsets: Array, heights: Array) -> tuple[Array, Array]:
    """Return (sums of F_x, sums of F_z), (m,) [FU] each, of the pair forces of a row on one particle.

    Repulsion is positive along z, and along x has the sign of the offset.

    Args:
        law: interaction of a pair.
        offsets: position of the particle along x less those of the row, (n,) [LU].
        heights: of the particle above the row, (m,) [LU].
    """
    distance = np.hypot(offsets[None, :], heights[:, None])
    ratio = law.force(distance) / distance
    return (ratio * offsets).sum(axis=1), ratio.sum(axis=1) * heights


def cutoff_for(scene: Scene, law: DoubleExponential, share: float, tolerance: float) -> float:
    """Return the scene's cutoff [LU] where that is a number, else one that follows from `share` and `tolerance`.

    That is r₀ + b ln(1/share), r₀ = 0 without attraction: beyond it a pair's force is below about `share` (relative) of
    the force at r₀ of the term of longest range b alone. In a slide it is at least the one at which a pair's force is a
    tenth of `tolerance` (relative) of the largest tangential force on a particle without load, unless the first has
    more than 5000 opposite particles within it.

    Raises:
        StopIteration: the scene has no interaction.
    """
    given = scene.the(Interaction).cutoff
    if given != "auto":
        return given
    reach = law.cutoff_for(share)
    if scene.experiment.motion_is_result and not reaches_too_far(scene, reach):
        return max(reach, slide_cutoff(law, scene.bodies.spacing, tolerance))
    return reach


def innermost_distance(estimate: Law, cutoff: float, displacement: float) -> float:
    """Return the distance [LU], 0 < distance ≤ cutoff, of the two particles at the apex at a displacement [LU].

    `estimate`: contact law of pairs of particles on springs, whose grid of distances ends at `cutoff` [LU]; a
    displacement beyond the grid gives its end. Compression is positive.
    """
    grid = cutoff / estimate.gap.size * np.arange(1, estimate.gap.size + 1)
    return float(np.interp(estimate.rest - displacement, estimate.gap, grid))


def thermal_motion(scene: Scene) -> float:
    """Return how much nearer thermal motion brings two particles on their springs [LU]: 5 √(2 k_BT/k) ≥ 0.

    These are five standard deviations of their distance; 0 without noise.
    """
    return 5.0 * math.sqrt(2.0 * scene.temperature / scene.bulk_stiffness)
