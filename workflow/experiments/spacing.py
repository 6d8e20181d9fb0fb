"""The automatic spacing of a contact on the plane: so small that the discretisation error meets the tolerance.

The discretisation error follows before a run from the reduced model (`continuation.budget`). It falls with the
square of the spacing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from contact1d.workflow.continuation.budget import ForceErrors, budgeted
from contact1d.workflow.continuation.outcome import LATTICE
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.model.adhesion import estimate_on_plane
from contact1d.workflow.model.pairs import tabulated
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import SettingsError, settings_for
from contact1d.workflow.scene import FlatPunch, Measured, Path, PullOff, Scene

FEWEST, MOST = 30, 5000
"""Particles in the contact radius: at FEWEST F_A and a₀ of JKR are within 3e-3; MOST keep 1e-6."""
LEFT = 0.9
"""Part of the tolerance that the lattice may use up."""
MOST_TRIES = 8
APPEARING = 16.0
"""What an excess without bound counts: that of a radius which is 0 at one place of the contact's centre only."""
LARGEST = 0.1
"""The largest tolerance that there is."""
SAME = 0.01
"""Difference of a radius at two spacings over it, below which it is the body's."""
RADII = ("contact_radius", "stick_radius", "zero_load_radius", "critical_radius", "largest_radius")
SQUARED = 2.0
"""Error of a square over that of its root: areas and mean pressures follow from radii."""
WIDEST = 0.5
"""Radius that is tried first, 1 LU or this share of where a body ends or of its curvature."""
MOST_SIZES = 60
"""Tries to find a radius: each brings a spacing that is too wide nearer by FEWEST, or doubles one that is too fine."""


def with_spacing(scene: Scene) -> Scene:
    """The scene with a number for its `bodies.spacing`; as it is where it has one.

    Raises:
        SettingsError: nothing touches, or the tolerance needs more than MOST particles in the contact radius.
    """
    if scene.bodies.given_spacing != "auto":
        return scene
    radius = _contact_radius(scene)
    chosen = fine_enough(partial(_spaced, scene, radius))
    left = left_by_lattice(chosen)
    if scene.accuracy.tolerance < left < math.inf:  # without bound the run says what appears
        larger = "" if left > 0.9 * LARGEST else f"use an accuracy.tolerance of {_up(left)}, or "
        raise SettingsError(
            f"a tolerance of {scene.accuracy.tolerance:g} is not reached by {MOST} particles in the contact radius of "
            f'{radius:.4g} LU, the limit of bodies.spacing = "auto": their discretisation error is {left:.1e}. '
            f"{larger[:1].upper()}{larger[1:]}{'give' if larger else 'Give'} bodies.spacing"
        )
    return chosen


def fine_enough(scene_of: Callable[[int], Scene]) -> Scene:
    """The scene with so many particles in the contact radius that its lattice leaves LEFT of its tolerance, or MOST."""
    count = FEWEST
    for _ in range(MOST_TRIES):
        scene = scene_of(count)
        over = left_by_lattice(scene) / (LEFT * scene.accuracy.tolerance)
        if over <= 1.0 or count == MOST:
            break
        count = min(MOST, math.ceil(count * math.sqrt(over if over < math.inf else APPEARING)) + 1)
    return scene


def left_by_lattice(scene: Scene) -> float:
    """The largest relative discretisation error of a result; 0 where no contact can be predicted: the run reports it.

    A result that is 0 has no share; a radius that is 0 here and not elsewhere has one without bound.
    """
    try:
        settings = settings_for(scene)
    except SettingsError:
        return 0.0
    case = kind_of(scene).reduction(scene, settings)
    if case is None:
        return 0.0
    trace = case.trace(reduced(scene, settings))
    exact = ForceErrors(np.zeros(len(trace)), np.zeros(len(trace)))
    results = budgeted(case, trace, exact)
    left = [
        (SQUARED * one.errors[LATTICE] if name in RADII else one.errors[LATTICE], one.size)
        for name, one in results.items()
        if not one.prescribed or name in RADII
    ]
    shares = [error / size for error, size in left if size]
    appear = any(
        error for name, one in results.items() if (error := one.errors[LATTICE]) and not one.size and name in RADII
    )
    return max([0.0, *shares, math.inf if appear else 0.0])


def _spaced(scene: Scene, radius: float, count: int) -> Scene:
    """The scene with so many particles in a contact radius [LU]: a whole number, as a punch needs."""
    return scene.model_copy(update={"bodies": scene.bodies.model_copy(update={"given_spacing": radius / count})})


def _contact_radius(scene: Scene) -> float:
    """The contact radius [LU] that determines the spacing: under the load, or at F = 0 of an unloading.

    Raises:
        SettingsError: nothing touches.
    """
    profile = scene.bodies.profile
    if isinstance(profile, FlatPunch):
        return profile.radius
    size = WIDEST * min(profile.reach, profile.curvature_radius or math.inf, 1.0 / WIDEST)
    for _ in range(MOST_SIZES):
        before, size = size, _half_width(_spaced(scene, size, FEWEST))
        if abs(size - before) <= SAME * size:
            return size
    raise SettingsError(
        "the bodies never touch in this experiment, so that no spacing can be chosen: give bodies.spacing, "
        "or a displacement above 0"
    )


def _half_width(scene: Scene) -> float:
    """Half-width [LU] of the contact with this spacing, which is the least that there is."""
    bodies, experiment = scene.bodies, scene.experiment
    estimate = estimate_on_plane(
        scene, tabulated(bodies, bodies.spacing) if isinstance(bodies.profile, Measured) else bodies
    )
    load = experiment.compression
    if scene.adheres and isinstance(experiment, Path | PullOff):
        load = 0.0
    deepest = max(experiment.places()) if load is None else estimate.displacement_at(load)
    return estimate.half_width(deepest, estimate.rest)


def _up(tolerance: float) -> str:
    """Two figures of a tolerance that is no smaller."""
    step = 10.0 ** (math.floor(math.log10(tolerance)) - 1)
    return f"{math.ceil(1.1 * tolerance / step) * step:.2g}"
