"""The automatic spacing of a contact on the plane: so small that the discretisation error meets the tolerance.

The discretisation error is estimated before a run on the reduced model (`continuation.budget`). It falls with the
square of the spacing.
 g is the profile under the reduction, E* the contact modulus [FU/LU²], W the work of adhesion [FU/LU]; d [LU] and F
[FU] are positive in compression.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from contact1d.analysis.pressure import Array
from contact1d.digits import digits_apart
from contact1d.workflow.continuation.budget import reading_errors
from contact1d.workflow.continuation.outcome import LATTICE, LOSSES
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.laws import law_of
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Impact, Scene

MOST = 5000
"""Particles in the contact radius at most; they keep a tolerance of 1e-6."""
LARGEST = 0.1
"""The largest tolerance that a scene may have."""
RADII = ("contact_radius", "stick_radius", "zero_load_radius", "critical_radius", "largest_radius")


def with_spacing(scene: Scene) -> Scene:
    """Return the scene with a number for `bodies.spacing` [LU], unchanged where it has one.

    Else it is the first of up to eight trials, from 30 to 5000 particles in the contact radius, whose discretisation
    error is below 90 % of the tolerance, or the last one where its error is within the tolerance. An infinite error, of
    a radius that is 0, is accepted.

    Raises:
        SettingsError: the bodies do not touch, or the tolerance is not reached.
    """
    if scene.bodies.given_spacing != "auto":
        return scene
    radius, profile = contact_radius(scene), scene.bodies.profile
    wider = profile.reach / radius if profile.has_edge else 1.0  # whole particles are as wide as such a body

    def with_count(count: int) -> Scene:
        """Return the scene with a number of particles in the contact radius, of a body with an edge that or more."""
        return _spaced(scene, wider * radius, math.ceil(wider * count))

    share = 0.5 if scene.is_oblique else 0.9  # of the tolerance: timesteps take a part of that of sliding particles
    chosen, error = spaced_within_tolerance(with_count, share)
    tolerance = scene.accuracy.tolerance
    if tolerance < error < math.inf:  # the run reports the radius that has an infinite error
        larger = "" if error > 0.9 * LARGEST else f"use an accuracy.tolerance of {_rounded_up(error)}, or "
        digits = digits_apart(error, tolerance, 2)
        raise SettingsError(
            f"a tolerance of {tolerance:g} is not reached by {MOST} particles in the contact radius of "
            f'{radius:.4g} LU, the limit of bodies.spacing = "auto": '
            f"their discretisation error is {error:.{digits - 1}e}. "
            f"{larger[:1].upper()}{larger[1:]}{'give' if larger else 'Give'} bodies.spacing"
        )
    return chosen


def spaced_within_tolerance(scene_of: Callable[[int], Scene], share: float, fewest: int = 30) -> tuple[Scene, float]:
    """Return (scene whose discretisation error is below a share of its tolerance, that error, relative).

    With 5000 particles, or after 8 trials, the error may be larger, or infinite.

    Args:
        scene_of: returns the scene with a number of particles in the contact radius, which is 5000 at most.
        share: of the tolerance.
        fewest: particles in the contact radius of the first trial; with 30, F_A and a₀ of JKR are within 3e-3.
    """
    count = fewest
    for _ in range(8):
        scene = scene_of(count)
        error = lattice_error(scene)
        excess = error / (share * scene.accuracy.tolerance)
        if excess <= 1.0 or count == MOST:
            break
        # An infinite error is of a radius that is 0 only where the apex has one position between particles.
        count = min(MOST, math.ceil(count * math.sqrt(excess if excess < math.inf else 16.0)) + 1)
    return scene, error


def lattice_error(scene: Scene) -> float:
    """Return the largest relative discretisation error ≥ 0 of a result, or of a curve over its largest force.

    The error of a radius counts twice; prescribed results other than radii, and energy losses with an error above 10 %,
    do not count. It is 0 where the scene has no settings, and for a slide, which has no prediction: the run reports it.
    A result of 0 has no relative error; a radius that is 0 here and not on another lattice makes the error infinite.
    """
    try:
        settings = settings_for(scene)
    except SettingsError:
        return 0.0
    case = kind_of(scene).reduction(scene, settings)
    if case is None:
        return 0.0
    errors, is_unbounded = [0.0], False
    read = reading_errors(case, case.path, case.results)
    for name, reading in case.readings.items():
        error, size = case.lattice.get(name, 0.0) + read[name] + reading.errors.get(LATTICE, 0.0), reading.size
        if (reading.prescribed and name not in RADII) or (name.startswith(LOSSES) and error > LARGEST * size):
            continue  # a loss too small for any spacing is not reported, and must not refine the spacing of the rest
        if size:  # areas and mean pressures go with the square of a radius
            errors.append((2.0 if name in RADII else 1.0) * error / size)
        is_unbounded |= bool(error) and not size and name in RADII
    if kind_of(scene).curve_is_result and (largest := float(np.abs(case.path.force).max())):
        rows = case.along(case.trace(case.model, whole=True)).lattice
        errors.append(float(np.max(rows.get("force", 0.0))) / largest)
    return math.inf if is_unbounded else max(errors)


def _spaced(scene: Scene, radius: float, count: int) -> Scene:
    """Return a copy of the scene with a whole number `count` of particles in a contact radius [LU], as a punch needs.

    Its spacing is radius/count.
    """
    return scene.model_copy(update={"bodies": scene.bodies.model_copy(update={"given_spacing": radius / count})})


def contact_curve(scene: Scene) -> tuple[Array, Array, Array]:
    """Return (a [LU], d [LU], F [FU]), (m,) each, of contacts of the body on the plane, by rising radius a.

        d = g(a) − √(2πaW/E*),    F = 2E* [a d − ∫₀ᵃ g dx],    of a flat punch its one radius

    (V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, sections 3.1 and 4.4), E* that of the layer per
    length [FU/LU²], d and F positive in compression, W 0 without [adhesion]. The radii are a geometric progression from
    1e-12 LU to 1e12 LU, or to just inside the end of a body; those at which g is not finite are left out.
    """
    bodies, modulus = scene.bodies, _spaced(scene, 1.0, 1).bulk_stiffness
    work, reach = scene.work_of_adhesion, bodies.profile.reach
    # The transform of a circle has no bound at the end of the body.
    radii = np.geomspace(1e-12, min(1e12, 0.999999 * reach), 12000)
    if bodies.profile.is_plane:
        radii = np.asarray([reach])
    with np.errstate(over="ignore"):
        heights = bodies.height(radii)
    radii, heights = radii[np.isfinite(heights)], heights[np.isfinite(heights)]
    below = np.cumsum(0.5 * (heights + np.append(0.0, heights[:-1])) * np.diff(radii, prepend=0.0))
    displacements = heights - np.sqrt(2.0 * math.pi * radii * work / modulus)
    return radii, displacements, 2.0 * modulus * (radii * displacements - below)


def contact_radius(scene: Scene) -> float:
    """Return the contact radius [LU] in which particles are counted, by the closed theory of the body, without a run.

    It is that under the largest load, at the largest prescribed displacement, where an impact turns, or at F = 0 where
    an experiment with adhesion finds the pull-off force; beyond the curve of the theory, that of its end. Of a flat
    punch it is its radius.

    Raises:
        SettingsError: the bodies do not touch.
    """
    radii, displacements, forces = contact_curve(scene)
    load = scene.experiment.compression
    if law_of(scene).attracts(scene) and scene.experiment.finds_pull_off:
        load = 0.0
    values, wanted = forces, load or 0.0
    if isinstance(scene.experiment, Impact):  # where the body has lost its kinetic energy
        work = np.cumsum(0.5 * (forces[1:] + forces[:-1]) * np.diff(displacements))
        values, wanted = np.append(0.0, work), 0.5 * scene.impact_mass * scene.experiment.velocity**2
    elif load is None:
        values, wanted = displacements, max(scene.experiment.places())
    lower = np.flatnonzero(values < wanted)
    index = int(lower[-1]) if lower.size else int(np.argmin(values))
    if index == 0 and radii.size > 1:
        raise SettingsError(
            "nothing touches in this experiment, so that there is no contact to choose a spacing for: give "
            "bodies.spacing, or a displacement above 0"
        )
    near = slice(index, index + 2)  # the run reports a load beyond either end
    return float(np.interp(wanted, values[near], radii[near]))


def _rounded_up(tolerance: float) -> str:
    """Return a tolerance > 0, made 10 to about 20 % larger, as text, rounded up to two significant digits."""
    step = 10.0 ** (math.floor(math.log10(tolerance)) - 1)
    return f"{math.ceil(1.1 * tolerance / step) * step:.2g}"
