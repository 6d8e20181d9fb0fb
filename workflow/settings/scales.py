"""Lengths and forces of a contact that thresholds and increments go by."""

from __future__ import annotations

import math

import numpy as np

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.estimate import ContactEstimate
from contact1d.workflow.settings.registry import slide_cutoff
from contact1d.workflow.settings.size import reaches_too_far

THERMAL_SIGMAS = 5.0
"""Standard deviations by which a particle's thermal motion brings it nearer."""


def interaction_law(scene: Scene) -> DoubleExponential | None:
    """The scene's law, or None on a rigid plane."""
    if scene.interaction is None:
        return None
    terms = scene.interaction
    attraction = None if terms.attraction is None else Exponential(terms.attraction.amplitude, terms.attraction.range)
    return DoubleExponential(Exponential(terms.repulsion.amplitude, terms.repulsion.range), attraction)


def cutoff_for(scene: Scene, law: DoubleExponential, share: float, tolerance: float) -> float:
    """The scene's cutoff [LU], or the one beyond which the force is below a share of the law's own.

    In a slide also below what the tolerance leaves of the force along x.
    """
    assert scene.interaction is not None
    if scene.interaction.cutoff != "auto":
        return scene.interaction.cutoff
    reach = law.cutoff_for(share)
    if scene.experiment.motion_is_result and not reaches_too_far(scene, reach):
        return max(reach, slide_cutoff(law, scene.bodies.spacing, 0.0, tolerance))
    return reach


def innermost_distance(estimate: ContactEstimate, cutoff: float, displacement: float) -> float:
    """Distance [LU] of the estimate's innermost pair at a displacement [LU]; its grid ends at the cutoff [LU]."""
    grid = cutoff / estimate.gap.size * np.arange(1, estimate.gap.size + 1)
    return float(np.interp(estimate.rest - displacement, estimate.gap, grid))


def thermal_motion(scene: Scene) -> float:
    """By how much noise brings two particles on their springs nearer to each other [LU]: THERMAL_SIGMAS √(2 k_BT/k)."""
    return (
        0.0 if scene.noise is None else THERMAL_SIGMAS * math.sqrt(2.0 * scene.noise.temperature / scene.bulk_stiffness)
    )


def force_scale_of(scene: Scene, law: DoubleExponential | None, largest: float) -> float:
    """The largest tension of one pair, or without attraction the force of the deepest particle."""
    if law is not None and law.attraction is not None:
        r = law.force_free_distance() + law.longest_range * np.linspace(0.0, 5.0, 2001)
        return float(-law.force(r).min())
    return (largest if largest > 0.0 else 1e-3 * scene.bodies.spacing) * scene.bulk_stiffness / 2


def loading_step_of(law: DoubleExponential | None, spacing: float, step: float) -> float:
    """The `step` [LU] if it is > 0, never more than a quarter of the longest range."""
    limit = 0.25 * law.longest_range if law is not None else 0.1 * spacing
    return min(step, limit) if step > 0 else limit


def plane_stiffness_of(scene: Scene, tolerance: float) -> float:
    """One-sided stiffness of the rigid plane.

    In series with a bond it is exact for a particle on its own (bond and plane 2k each give k), and without one, where
    particles are moved with their body, it is k. Neighbour springs and thermal motion see the bond alone, so with them
    the plane is 1/tolerance times stiffer than the chain.
    """
    if scene.bodies.lower != "rigid_plane":
        return 0.0
    stiffness = scene.bulk_stiffness
    if scene.stands:
        return stiffness
    if scene.neighbours is None and scene.noise is None:
        return 2.0 * stiffness
    neighbours = 0.0 if scene.neighbours is None else scene.neighbours.stiffness
    return (stiffness + 4.0 * neighbours) / tolerance
