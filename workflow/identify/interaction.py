"""The interaction for which the run of a scene has a required F_A and a₀, by Newton's method on

    ( ln F_A/F_A*,  ln a₀/a₀* )  over  ( ln of the factor of the amplitudes, ln of the factor of the ranges ).

Runs give the values; the start and the slopes are those of independent pairs, without a run. With the radius R₁ of the
chain's parabola and the stiffness per length c of both chains in series, F_A R₁/(c a₀³) rises from 0 to
4/(9√3) = 0.2566 as the range of the interaction falls to 0, the limit of brittle springs. JKR with the springs of the
MDR, R₁ = R/2 and c = E*, has 1/6. The inverse problem, LU and FU of a finished run for a material, is Eq. 9 of the
paper.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from contact1d.analysis.curve_marks import vertex
from contact1d.analysis.theory.indenters import PowerLaw
from contact1d.digits import apart
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import Contact1dError, FolderError, RunError
from contact1d.workflow.laws.law import Law
from contact1d.workflow.laws.pairs import interaction_law, of_pairs
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.finished import Run, load_run
from contact1d.workflow.runs.scales import UNIT_FIXING_RESULTS, jkr_scales
from contact1d.workflow.scene import Scene, read_scene
from contact1d.workflow.scene.tables import PARABOLA_SHARE, SPHERES
from contact1d.workflow.units import SI, Scales

Array = NDArray[np.float64]
LARGEST_RADIUS_SHARE = 0.6
"""Largest contact radius over the radius of the sphere: beyond it neither parabola nor half-space is valid."""
PRELOAD_SHARE = 0.7
"""Preload of a pull-off over JKR's F_A, where no load is given."""


class IdentifyError(Contact1dError, ValueError):
    """A target that the model can't reach, with the nearest possible one in the message."""


class Target(NamedTuple):
    """Required results of a run.

    Attributes:
        adhesion_force: F_A > 0, tension as a positive magnitude [FU], or [N] before a scene is made.
        zero_load_radius: a₀ > 0 [LU], or [m].
    """

    adhesion_force: float
    zero_load_radius: float


def require_held(target: Target, layer: float, radius: float) -> None:
    """Check that a layer of springs can have F_A and a₀ of a target, with any interaction; nothing is returned.

    They can up to F_A R₁/(layer a₀³) = 0.95 · 4/(9√3).

    Args:
        target: F_A [N] and a₀ [m].
        layer: stiffness per length of both chains in series [N/m²].
        radius: R₁ of the chain's parabola [m].

    Raises:
        IdentifyError: it cannot; the message has the nearest zero-load radius and the nearest adhesion force.
    """
    brittle_limit = 4.0 / (9.0 * math.sqrt(3.0))
    largest_ratio = 0.95 * brittle_limit  # beyond it the range would be so short that each pair snaps by itself
    rounding = 1.0 + 1e-5  # the nearest values are possible as they are printed, with six digits
    force, a_0 = target
    if force * radius / (layer * a_0**3) <= largest_ratio:
        return
    smallest = rounding * (force * radius / (largest_ratio * layer)) ** (1.0 / 3.0)
    largest = largest_ratio * layer * a_0**3 / radius / rounding
    raise IdentifyError(
        f"an adhesion force of {force:.6g} N with a zero-load radius of {a_0:.6g} m is not possible with springs of "
        f"this stiffness. Nearest: the same force with a radius of at least {smallest:.6g} m, or the same radius with "
        f"a force of at most {largest:.6g} N"
    )


def material_scene(
    contact_modulus: float, radius: float, target: Target, length_unit: float | None = None, *, tolerance: float
) -> tuple[Scene, Target]:
    """Return (scene of a sphere of a material on two chains, its target in FU and LU); its interaction is only a start.

    The reduction is the MDR's, so that stiffness, displacement and radius are those of the sphere. FU is chosen so that
    a bulk spring has the stiffness 1 FU/LU. The experiment is a pull-off with a preload of 0.7 F_A.

    Args:
        contact_modulus: E* [Pa].
        radius: R of the sphere, or effective radius of both spheres [m].
        target: F_A [N] and a₀ [m].
        length_unit: one LU [m]; None: 28.5 particles in a₀, as in the first row of the paper's Table 1.
        tolerance: relative tolerance of the scene.

    Raises:
        IdentifyError: the target is out of reach, or the length unit too coarse or too fine.
    """
    require_held(target, contact_modulus, PARABOLA_SHARE["mdr"] * radius)  # the MDR's springs are E*
    unit = target.zero_load_radius / 28.5 if length_unit is None else length_unit
    _require_resolved(target.zero_load_radius, unit, radius)
    force_unit = 2.0 * contact_modulus * unit**2
    wanted = Target(target.adhesion_force / force_unit, target.zero_load_radius / unit)
    depth = wanted.zero_load_radius**2 / (radius / unit)
    reach, energy = 0.3 * depth, 0.1 * depth**2  # only a start
    scene = read_scene(
        {
            "title": f"Sphere of R = {radius:.4g} m, E* = {contact_modulus:.4g} Pa",
            "bodies": {
                "particles": "auto",
                "spacing": 1.0,
                "profile": {"kind": "parabola", "radius": radius / unit},
                "reduction": "mdr",
                "bulk_stiffness": "auto",
            },
            "interaction": {  # of the shape in the example scene pull_off.toml: A/B = b/a = 2
                "repulsion": {"amplitude": 2.0 * energy, "range": reach / 2.0},
                "attraction": {"amplitude": energy, "range": reach},
            },
            "material": {"contact_modulus": contact_modulus, "length_unit": unit, "force_unit": force_unit},
            "accuracy": {"tolerance": tolerance},
            "experiment": {"kind": "pull_off", "preload": PRELOAD_SHARE * wanted.adhesion_force},
        }
    )
    return scene, wanted


def _require_resolved(a_0: float, unit: float, radius: float, fewest: float = 8.0, most: float = 2000.0) -> None:
    """Check that a₀ [m] has `fewest` to `most` particles one length unit [m] apart and is at most 0.6 of R [m].

    Nothing is returned; ends are included.

    Raises:
        IdentifyError: it has not, or is not; the message has the allowed length unit or radius.
    """
    particles = a_0 / unit
    if not fewest <= particles <= most:
        side, count = ("most", fewest) if particles < fewest else ("least", most)
        given, limit = apart(unit, a_0 / count, 4)
        raise IdentifyError(
            f"a length unit of {given} m gives {particles:.2g} particles in the zero-load radius of {a_0:.4g} m: "
            f"use at {side} {limit} m for {count:g}"
        )
    if a_0 > LARGEST_RADIUS_SHARE * radius:
        share, limit = apart(a_0 / radius, LARGEST_RADIUS_SHARE, 2)
        raise IdentifyError(
            f"the zero-load radius of {a_0:.4g} m is {share} of the sphere's: JKR is for a << R, here up to {limit}. "
            "Use a larger radius, a larger contact modulus or a smaller surface energy"
        )


def jkr_target(contact_modulus: float, surface_energy: float, radius: float) -> Target:
    """Return F_A = 3πγR [N], positive, and a₀ = (9πγR²/E*)^{1/3} [m] of JKR's contact.

    Args:
        contact_modulus: E* [Pa].
        surface_energy: γ of one side [J/m²].
        radius: R [m].
    """
    sphere = PowerLaw.sphere(radius, contact_modulus, work_of_adhesion=2.0 * surface_energy)
    return Target(sphere.pull_off_force(), sphere.zero_load_radius())


def start(scene: Scene, target: Target) -> Array:
    """Return the natural logarithms of the factors (of amplitudes, of ranges), (2,), that give the target.

    They give F_A and a₀ of independent pairs of particles, without a run. F_A is monotone in the amplitudes, and a₀ in
    the range at that F_A: two nested bracketed searches.

    Raises:
        IdentifyError: no interaction of this shape has the target; the message has the nearest a₀ at the same F_A.
    """
    amplitude, wanted = 0.0, np.log(target)

    def deviations(amplitude: float, reach: float) -> Array:
        """Return ln F_A/F_A* and ln a₀/a₀* of independent pairs from the target, (2,), at two logarithms of factors."""
        return _estimated(scaled(scene, np.array([amplitude, reach]))) - wanted

    def radius_deviation(reach: float) -> float:
        """Return ln a₀/a₀* at the factor of the ranges, with the amplitudes for which F_A is the required one.

        The logarithm of their factor is kept, as the start of the next search.
        """
        nonlocal amplitude
        amplitude = _root(lambda a: float(deviations(a, reach)[0]), amplitude)
        return float(deviations(amplitude, reach)[1])

    try:
        reach = _root(radius_deviation, 0.0)
    except _NoRootError as error:
        nearest = target.zero_load_radius * math.exp(error.args[0])
        raise IdentifyError(
            f"no interaction of this shape has an adhesion force of {target.adhesion_force:.4g} FU together with a "
            f"zero-load radius of {target.zero_load_radius:.4g} LU; nearest: the same force with {nearest:.4g} LU"
        ) from None
    return np.array([amplitude, reach])


class _NoRootError(ValueError):
    """A function without a change of sign in the searched interval; its argument is the value nearest to zero."""


def _root(
    function: Callable[[float], float], start: float, step: float = 0.25, last_step: float = 9.0, error: float = 1e-4
) -> float:
    """Return the zero of a monotone function, rising or falling, of a logarithm, to ± `error`.

    The interval grows to both sides of `start`, which is returned if it is a zero.

    Args:
        function: function of the logarithm of a factor.
        start: first logarithm.
        step: distance of both ends of the first interval from `start`; that of each next one is twice as long.
        last_step: largest such distance.
        error: error of the logarithm; the reduced model is no more accurate.

    Raises:
        _NoRootError: the function has one sign in the searched interval.
    """
    low = high = start
    below = above = function(start)
    while below * above > 0.0:
        if step > last_step:
            raise _NoRootError(min(below, above, key=abs))
        low, high, step = start - step, start + step, 2.0 * step
        below, above = function(low), function(high)
    return low if low == high else float(brentq(function, low, high, xtol=error))


def slopes(scene: Scene, logarithms: Array, step: float = 0.03) -> Array:
    """Return d(ln F_A, ln a₀)/d(logarithms) of independent pairs, (2, 2), dimensionless, by central differences.

    Rows are ln F_A and ln a₀, columns the logarithms of the factors of amplitudes and ranges. The `step` is much larger
    than the error of F_A and a₀ by their grid.
    """
    moves = step * np.eye(2)
    ends = [[_estimated(scaled(scene, logarithms + sign * move)) for sign in (1.0, -1.0)] for move in moves]
    return np.column_stack([(above - below) / (2.0 * step) for above, below in ends])


def scaled(scene: Scene, logarithms: Array) -> Scene:
    """Return the checked scene with amplitudes and ranges of its interaction times exp(`logarithms`), (2,).

    Repulsion and attraction have the same factors, first that of the amplitudes, then that of the ranges.
    """
    data = scene.model_dump(by_alias=True, exclude_none=True)
    for term in ("repulsion", "attraction"):
        for key, factor in zip(("amplitude", "range"), np.exp(logarithms).tolist(), strict=True):
            data["interaction"][term][key] *= factor
    return read_scene(data)


def _estimated(scene: Scene, tail: float = 1e-5, points: int = 1000) -> Array:
    """Return ln F_A [FU] and ln a₀ [LU] of independent pairs of particles, (2,), on a coarse grid, without a run.

    a₀ is the half-width of the contact up to the largest tension of a pair, at F = 0.

    Args:
        scene: scene with an interaction.
        tail: force at the cutoff over the force scale.
        points: distances at which there are forces.
    """
    law = interaction_law(scene)
    assert law is not None
    cutoff, rest = law.cutoff_for(tail), law.force_free_distance()
    estimate = of_pairs(law, scene.bodies, scene.bodies.spacing, scene.bulk_stiffness, cutoff, rest, points)
    radius = estimate.half_width(estimate.displacement_at(0.0), _largest_tension(estimate))
    return np.log([estimate.pull_off_force(), radius])


def _largest_tension(estimate: Law) -> float:
    """Return the undeformed gap [LU] at which independent pairs have their largest tension.

    By a parabola through three points of the grid; at an end of the grid through the last three.
    """
    force, points = estimate.force, np.arange(estimate.force.size, dtype=np.float64)
    i = min(max(int(np.argmin(force)), 1), len(force) - 2)
    peak, _ = vertex(points, -force, i, 1)
    return float(np.interp(peak, points, estimate.gap))


def identify(
    scene: Scene, target: Target, folder: Path, progress: Progress | None = None, most_runs: int = 8
) -> tuple[Run, int]:
    """Return (finished run that has the F_A and a₀ of `target`, number of runs) after scaling a scene's interaction.

    Both are met to 0.3 of the tolerance of the scene. Each run replaces the one before in the folder; none has figures.

    Args:
        scene: a pull_off with attraction; the shape of its interaction is kept.
        target: required F_A [FU] and a₀ [LU].
        folder: run folder, for the last run.
        progress: informed of phases and steps; None: nobody is.
        most_runs: runs after which the search ends without a result, one at least; two to four are usual.

    Raises:
        IdentifyError: no interaction of this shape has the target, or the search does not converge.
        SettingsError: the numbers of a scene lead to no computable system.
        FolderError: the folder holds something else, or another run is active in it.
        RunError: LAMMPS failed, or a result can't be trusted.
        KeyError: a run does not report F_A or a₀.
    """
    largest_deviation = 0.3 * scene.accuracy.tolerance
    logarithms = start(scene, target)
    for count in range(1, most_runs + 1):
        finished = run(scaled(scene, logarithms), folder, figures=False, progress=progress)
        values = [finished.model.results[name].value for name in UNIT_FIXING_RESULTS]
        errors = np.log(np.divide(values, target))
        if np.abs(errors).max() < largest_deviation:
            return finished, count
        logarithms = logarithms - np.linalg.solve(slopes(scene, logarithms), errors)
    raise IdentifyError(
        f"the search did not converge in {most_runs} runs: deviation {math.expm1(errors[0]):.1e} of the adhesion "
        f"force, {math.expm1(errors[1]):.1e} of a₀. Use a smaller [accuracy] tolerance or more particles in a₀"
    )


def scales_of_run(folder: Path, contact_modulus: float, surface_energy: float) -> tuple[Scales, dict[str, Any]]:
    """Return (scales with which a run is JKR's contact of a material, its results with units of LU, FU and MU).

    The scales are LU [m] and FU [N] with their uncertainties; results, pure numbers included, are dicts by name with
    "value", "uncertainty" and "unit" of the model.

    Args:
        folder: run folder of a pull_off, or of a path that found F_A and a₀.
        contact_modulus: E* [Pa].
        surface_energy: γ of one side [J/m²].

    Raises:
        IdentifyError: the folder has no such run, its body is no sphere, or F_A or a₀ is missing or not positive.
    """
    try:
        run = load_run(folder).model
    except (FolderError, RunError) as error:
        raise IdentifyError(str(error)) from None
    missing = [name for name in UNIT_FIXING_RESULTS if name not in run.results]
    if missing:
        raise IdentifyError(f"{folder} has no {' and no '.join(missing)}: use a run of kind pull_off")
    profile, curvature = run.scene.bodies.profile, run.scene.bodies.profile.curvature_radius
    if curvature is None or profile.kind not in SPHERES:
        raise IdentifyError(f"{folder}: the profile is a {profile.kind}, and JKR is for a sphere")
    force, radius = (run.results[name] for name in UNIT_FIXING_RESULTS)
    if not (force.value > 0.0 and radius.value > 0.0):
        raise IdentifyError(f"{folder}: F_A and a_0 must be positive; they are {force.value:g} and {radius.value:g}")
    scales = jkr_scales(force, radius, curvature, contact_modulus, surface_energy)
    return scales, {name: quantity.entry() for name, quantity in run.results.items() if quantity.unit in SI}
