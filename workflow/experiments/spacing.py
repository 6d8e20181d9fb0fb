"""The automatic spacing of a contact on the plane: so small that the discretisation error meets the tolerance.

The discretisation error follows before a run from the reduced model (`continuation.budget`). It falls with the
square of the spacing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from contact1d.analysis.pressure import Array
from contact1d.digits import digits_apart
from contact1d.workflow.continuation.budget import misread
from contact1d.workflow.continuation.outcome import LATTICE, LOSSES
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.laws import law_of
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Impact, Scene

FEWEST, MOST = 30, 5000
"""Particles in the contact radius: at FEWEST F_A and a₀ of JKR are within 3e-3; MOST keep 1e-6."""
LEFT = 0.9
"""Part of the tolerance that the lattice may use up."""
MOST_TRIES = 8
APPEARING = 16.0
"""What an excess without bound counts: that of a radius which is 0 at one place of the contact's centre only."""
LARGEST = 0.1
"""The largest tolerance that there is."""
RADII = ("contact_radius", "stick_radius", "zero_load_radius", "critical_radius", "largest_radius")
SQUARED = 2.0
"""Error of a square over that of its root: areas and mean pressures follow from radii."""
SHORTEST, LONGEST, PLACES = 1e-12, 1e12, 12000
"""Radii [LU] among which that of a contact is sought, in geometric progression, and how many."""
INSIDE = 0.999999
"""Largest of them over the half-width of a body that ends: the transform of a circle has no bound there."""


def with_spacing(scene: Scene) -> Scene:
    """The scene with a number for its `bodies.spacing`; as it is where it has one.

    Raises:
        SettingsError: nothing touches, or the tolerance needs more than MOST particles in the contact radius.
    """
    if scene.bodies.given_spacing != "auto":
        return scene
    radius = contact_radius(scene)
    chosen, left = fine_enough(partial(_spaced, scene, radius))
    tolerance = scene.accuracy.tolerance
    if tolerance < left < math.inf:  # without bound the run says what appears
        larger = "" if left > 0.9 * LARGEST else f"use an accuracy.tolerance of {_up(left)}, or "
        digits = digits_apart(left, tolerance, 2)
        raise SettingsError(
            f"a tolerance of {tolerance:g} is not reached by {MOST} particles in the contact radius of "
            f'{radius:.4g} LU, the limit of bodies.spacing = "auto": '
            f"their discretisation error is {left:.{digits - 1}e}. "
            f"{larger[:1].upper()}{larger[1:]}{'give' if larger else 'Give'} bodies.spacing"
        )
    return chosen


def fine_enough(scene_of: Callable[[int], Scene]) -> tuple[Scene, float]:
    """The scene with so many particles in the contact radius that its lattice leaves LEFT of its tolerance, or MOST.

    And what it leaves.
    """
    count = FEWEST
    for _ in range(MOST_TRIES):
        scene = scene_of(count)
        left = left_by_lattice(scene)
        over = left / (LEFT * scene.accuracy.tolerance)
        if over <= 1.0 or count == MOST:
            break
        count = min(MOST, math.ceil(count * math.sqrt(over if over < math.inf else APPEARING)) + 1)
    return scene, left


def left_by_lattice(scene: Scene) -> float:
    """The largest relative discretisation error of a result, or of a curve over its largest force.

    0 where no contact can be predicted: the run reports it. A result that is 0 has no share; a radius that is 0 here
    and not elsewhere has one without bound.
    """
    try:
        settings = settings_for(scene)
    except SettingsError:
        return 0.0
    case = kind_of(scene).reduction(scene, settings)
    if case is None:
        return 0.0
    left, appear = [0.0], False
    others = [case.read(trace) for trace in misread(case.path)]
    for name, one in case.readings.items():
        read = max((abs(other[name].value - one.value) for other in others if name in other), default=0.0)
        error = case.lattice.get(name, 0.0) + read + one.errors.get(LATTICE, 0.0)
        size = abs(one.value) if one.scale is None else one.scale
        if (one.prescribed and name not in RADII) or (name.startswith(LOSSES) and error > LARGEST * size):
            continue  # a loss so small that no spacing shows it is not reported, and others are not to wait for it
        if size:
            left.append((SQUARED if name in RADII else 1.0) * error / size)
        appear |= bool(error) and not size and name in RADII
    if kind_of(scene).curve_is_result and (largest := float(np.abs(case.path.force).max())):
        rows = case.along(case.trace(case.model, whole=True)).lattice
        left.append(float(np.max(rows.get("force", 0.0))) / largest)
    return math.inf if appear else max(left)


def _spaced(scene: Scene, radius: float, count: int) -> Scene:
    """The scene with so many particles in a contact radius [LU]: a whole number, as a punch needs."""
    return scene.model_copy(update={"bodies": scene.bodies.model_copy(update={"given_spacing": radius / count})})


def contact_curve(scene: Scene) -> tuple[Array, Array, Array]:
    """Radii a [LU] of contacts of the body on the plane, rising, their displacements d [LU] and forces F [FU].

        d = g(a) − √(2πaW/E*),    F = 2E* [a d − ∫₀ᵃ g dx],    of a flat punch its one radius

    (V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, sections 3.1 and 4.4), E* that of the layer.
    """
    bodies, modulus = scene.bodies, _spaced(scene, 1.0, 1).bulk_stiffness
    work, reach = scene.work_of_adhesion, bodies.profile.reach
    radii = (
        np.asarray([reach]) if bodies.profile.has_edge else np.geomspace(SHORTEST, min(LONGEST, INSIDE * reach), PLACES)
    )
    with np.errstate(over="ignore"):
        heights = bodies.height(radii)
    radii, heights = radii[np.isfinite(heights)], heights[np.isfinite(heights)]
    below = np.cumsum(0.5 * (heights + np.append(0.0, heights[:-1])) * np.diff(radii, prepend=0.0))
    displacements = heights - np.sqrt(2.0 * math.pi * radii * work / modulus)
    return radii, displacements, 2.0 * modulus * (radii * displacements - below)


def contact_radius(scene: Scene) -> float:
    """The contact radius [LU] that particles are counted in: under the load, or at F = 0 where it is drawn off.

    Raises:
        SettingsError: nothing touches.
    """
    radii, displacements, forces = contact_curve(scene)
    load = scene.experiment.compression
    if law_of(scene).attracts(scene) and scene.experiment.finds_pull_off:
        load = 0.0
    values, wanted = forces, load or 0.0
    if isinstance(scene.experiment, Impact):  # where the body has given up its energy
        assert scene.plate
        assert scene.plate.mass != "auto"
        work = np.cumsum(0.5 * (forces[1:] + forces[:-1]) * np.diff(displacements))
        values, wanted = np.append(0.0, work), 0.5 * scene.plate.mass * scene.experiment.velocity**2
    elif load is None:
        values, wanted = displacements, max(scene.experiment.places())
    lower = np.flatnonzero(values < wanted)
    at = int(lower[-1]) if lower.size else int(np.argmin(values))
    if at == 0 and radii.size > 1:
        raise SettingsError(
            "nothing touches in this experiment, so that there is no contact to choose a spacing for: give "
            "bodies.spacing, or a displacement above 0"
        )
    near = slice(at, at + 2)  # of what is beyond either end the run says why
    return float(np.interp(wanted, values[near], radii[near]))


def _up(tolerance: float) -> str:
    """Two figures of a tolerance that is no smaller."""
    step = 10.0 ** (math.floor(math.log10(tolerance)) - 1)
    return f"{math.ceil(1.1 * tolerance / step) * step:.2g}"
