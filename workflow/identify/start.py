"""Where independent pairs have a target: the start of the search, and its slopes, without a run.

Two numbers are free, a factor on both amplitudes and one on both ranges of the scene's interaction.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from contact1d.workflow.identify.target import IdentifyError, Target, require_reachable
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.estimate import ContactEstimate, particles_estimate
from contact1d.workflow.settings.scales import interaction_law

Array = NDArray[np.float64]
SLOPE_STEP = 0.03
"""Step of the finite differences of the estimate, in both logarithms: well above the grain of its grid."""
FIRST_STEP, FARTHEST = 0.25, 9.0
"""First and last step of a search for a bracket, in the logarithm of a factor."""
START_ERROR = 1e-4
"""Of both logarithms at the start: what the estimate itself is good for."""
TAIL = 1e-5
"""Force at the estimate's cutoff over the law's own."""
POINTS = 1000
"""Distances at which the estimate has the force of a row."""


def estimated(scene: Scene, target: Target) -> Scene:
    """The scene with the interaction with which independent pairs have the target: near it, and no run needed.

    Raises:
        IdentifyError: as in `identify`.
    """
    require_reachable(scene, target)
    return scaled(scene, start(scene, target))


def start(scene: Scene, target: Target) -> Array:
    """Where independent pairs have the target: for each range the amplitudes that give F_A, and of those the range
    that gives a₀. Both depend on their unknown in one direction only, so that each is a bracketed search.
    """
    amplitude = 0.0

    def force_off(amplitude: float, reach: float) -> float:
        found = _estimated(scaled(scene, np.array([amplitude, reach])))
        return math.log(found.adhesion_force / target.adhesion_force)

    def radius_off(reach: float) -> float:
        nonlocal amplitude
        amplitude = _root(lambda a: force_off(a, reach), amplitude)
        found = _estimated(scaled(scene, np.array([amplitude, reach])))
        return math.log(found.zero_load_radius / target.zero_load_radius)

    try:
        reach = _root(radius_off, 0.0)
    except _NoRootError as error:
        nearest = target.zero_load_radius * math.exp(error.nearest)
        raise IdentifyError(
            f"no interaction of this shape has an adhesion force of {target.adhesion_force:.4g} FU together with a "
            f"zero-load radius of {target.zero_load_radius:.4g} LU; nearest: the same force with {nearest:.4g} LU"
        ) from None
    return np.array([amplitude, reach])


class _NoRootError(ValueError):
    """No change of sign was found; `nearest` is the value of the function that is nearest to zero."""

    def __init__(self, nearest: float) -> None:
        super().__init__(nearest)
        self.nearest = nearest


def _root(function: Callable[[float], float], start: float) -> float:
    """The zero of a monotone function of a logarithm, looked for on both sides of `start`.

    Raises:
        _NoRootError: there is none within a factor of exp(FARTHEST).
    """
    low = high = start
    below = above = function(start)
    step = FIRST_STEP
    while below * above > 0.0:
        if step > FARTHEST:
            raise _NoRootError(min(below, above, key=abs))
        low, high, step = start - step, start + step, 2.0 * step
        below, above = function(low), function(high)
    return low if low == high else float(brentq(function, low, high, xtol=START_ERROR))


def slopes(scene: Scene, at: Array) -> Array:
    """d(ln F_A, ln a₀)/d(logarithms) of independent pairs, by central differences."""

    def logarithms(place: Array) -> Array:
        found = _estimated(scaled(scene, place))
        return np.log([found.adhesion_force, found.zero_load_radius])

    steps = SLOPE_STEP * np.eye(2)
    columns = [(logarithms(at + step) - logarithms(at - step)) / (2.0 * SLOPE_STEP) for step in steps]
    return np.column_stack(columns)


def scaled(scene: Scene, logarithms: Array) -> Scene:
    """The scene with both amplitudes and both ranges multiplied by the exponentials of `logarithms`."""
    amplitude, reach = np.exp(logarithms)
    data = scene.model_dump(by_alias=True, exclude_none=True)
    for term in ("repulsion", "attraction"):
        data["interaction"][term]["amplitude"] *= float(amplitude)
        data["interaction"][term]["range"] *= float(reach)
    return scene_from_dict(data)


@dataclass(frozen=True)
class _Estimated:
    """F_A [FU] and a₀ [LU] of independent pairs."""

    adhesion_force: float
    zero_load_radius: float


def _estimated(scene: Scene) -> _Estimated:
    """By the estimate that every run's settings begin with, on a grid that is coarser and ends sooner."""
    law = interaction_law(scene)
    assert law is not None
    cutoff, rest = law.cutoff_for(TAIL), law.force_free_distance()
    estimate = particles_estimate(law, scene.bodies, scene.bodies.spacing, scene.bulk_stiffness, cutoff, rest, POINTS)
    zero = estimate.displacement_at(0.0)
    return _Estimated(estimate.pull_off_force(), estimate.half_width(zero, _largest_tension(estimate)))


def _largest_tension(estimate: ContactEstimate) -> float:
    """The undeformed gap [LU] of the largest tension, between the points of the grid by a parabola."""
    force = estimate.force
    i = min(max(int(np.argmin(force)), 1), len(force) - 2)
    before, lowest, after = (float(f) for f in force[i - 1 : i + 2])
    shift = 0.5 * (before - after) / (before - 2.0 * lowest + after)
    return float(np.interp(i + shift, np.arange(len(force)), estimate.gap))
