"""The interaction with which a scene's run has a wanted F_A and a₀: Newton's method, with runs for the values.

    ( ln F_A/F_A*,  ln a₀/a₀* )  over  ( ln of the amplitudes' factor, ln of the ranges' factor ),

the start and the slopes from independent pairs, without a run. With the radius R₁ of the chain's parabola and the
stiffness per length c of both chains in series, F_A R₁/(c a₀³) rises from 0 to 4/(9√3) = 0.2566 as the range of the
interaction falls to 0, where springs break. JKR with the springs that the MDR gives a material,
R₁ = R/2 and c = E*, has 1/6. The other way, a finished run has the LU and FU of a material (Eq. 9 of the paper).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

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
from contact1d.workflow.scene import PullOff, Scene, scene_from_dict
from contact1d.workflow.scene.tables import PARABOLA_SHARE, SPHERES
from contact1d.workflow.units import SI, Scales

BRITTLE_RATIO = 4.0 / (9.0 * math.sqrt(3.0))
"""F_A R₁/(c a₀³) in the limit of a vanishing range."""
REACHABLE_RATIO = 0.95 * BRITTLE_RATIO
"""Beyond this the range would be so short that each pair snaps by itself."""
ROUNDING = 1.0 + 1e-5
"""Keeps a nearest value possible after it was printed with six digits."""


class IdentifyError(Contact1dError, ValueError):
    """A target that the model can't reach; the message names the nearest one that it can."""


@dataclass(frozen=True)
class Target:
    """What a run is to find: F_A [FU] and a₀ [LU]."""

    adhesion_force: float
    zero_load_radius: float


def require_reachable(scene: Scene, target: Target) -> None:
    """Refuse a target that springs of the scene's stiffness cannot reach.

    Raises:
        IdentifyError: with the nearest zero-load radius and the nearest adhesion force.
    """
    if not isinstance(scene.experiment, PullOff) or scene.interaction is None or scene.interaction.attraction is None:
        raise IdentifyError("only a pull_off with an attraction finds F_A and a₀")
    if scene.bodies.plane_radius is None:
        raise IdentifyError("only a parabola has the F_A and a₀ of JKR's sphere")
    layer = scene.bulk_stiffness / (2.0 * scene.bodies.spacing)
    require_held(target, layer, scene.bodies.plane_radius, ("FU", "LU"))


def require_held(target: Target, layer: float, radius: float, units: tuple[str, str]) -> None:
    """Refuse a target that a layer of springs does not hold, whatever the interaction.

    Args:
        target: F_A and a₀, in `units`.
        layer: stiffness per length of both chains in series [force/length²].
        radius: R₁ of the chain's parabola [length].
        units: of force and length, for the message.

    Raises:
        IdentifyError: with the nearest zero-load radius and the nearest adhesion force.
    """
    force, a_0 = target.adhesion_force, target.zero_load_radius
    if force * radius / (layer * a_0**3) <= REACHABLE_RATIO:
        return
    smallest = ROUNDING * (force * radius / (REACHABLE_RATIO * layer)) ** (1.0 / 3.0)
    largest = REACHABLE_RATIO * layer * a_0**3 / radius / ROUNDING
    newton, metre = units
    raise IdentifyError(
        f"an adhesion force of {force:.6g} {newton} with a zero-load radius of {a_0:.6g} {metre} is not possible with "
        "springs of this stiffness. Nearest: the same force with a radius of at least "
        f"{smallest:.6g} {metre}, or the same radius with a force of at most {largest:.6g} {newton}"
    )


RESOLUTION = 28.5
"""Particles in a₀, unless the length unit is given: as in the first row of the paper's Table 1."""
FEWEST_IN_RADIUS = 8.0
"""Fewest particles in a₀ that a length unit must leave."""
MOST_IN_RADIUS = 2000.0
"""Most particles in a₀."""
LARGEST_RADIUS_SHARE = 0.6
"""Largest a₀ over the radius of the sphere: beyond it neither parabola nor half-space is valid."""
PRELOAD_SHARE = 0.7
"""Preload of a scene for a material over its F_A."""
SHAPE = {"amplitudes": 2.0, "ranges": 2.0}
"""A/B and b/a of the fitted interaction: those of the example scene pull_off.toml."""


def material_scene(
    contact_modulus: float, radius: float, target: Target, length_unit: float | None = None, *, tolerance: float
) -> tuple[Scene, Target]:
    """A scene for a sphere of a material, and its target in model units; the interaction is still to be identified.

    The reduction is the MDR's, so that stiffness, displacement and radius are those of the sphere. FU is chosen so that
    a bulk spring has the stiffness 1 FU/LU.

    Args:
        contact_modulus: E* [Pa].
        radius: R of the sphere, or effective of both [m].
        target: F_A [N] and a₀ [m].
        length_unit: of one LU [m]; None: such that a₀ has some 28 particles.
        tolerance: of the scene.

    Raises:
        IdentifyError: a target out of reach, or a length unit that is too coarse.
    """
    require_held(target, contact_modulus, PARABOLA_SHARE["mdr"] * radius, ("N", "m"))  # the MDR's springs are E*
    unit = target.zero_load_radius / RESOLUTION if length_unit is None else length_unit
    _require_resolved(target.zero_load_radius, unit, radius)
    force_unit = 2.0 * contact_modulus * unit**2
    wanted = Target(target.adhesion_force / force_unit, target.zero_load_radius / unit)
    depth = wanted.zero_load_radius**2 / (radius / unit)
    reach, energy = 0.3 * depth, 0.1 * depth**2
    scene = scene_from_dict(
        {
            "title": f"Sphere of R = {radius:.4g} m, E* = {contact_modulus:.4g} Pa",
            "bodies": {
                "particles": "auto",
                "spacing": 1.0,
                "profile": {"kind": "parabola", "radius": radius / unit},
                "reduction": "mdr",
                "bulk_stiffness": "auto",
            },
            "interaction": {
                "repulsion": {"amplitude": SHAPE["amplitudes"] * energy, "range": reach / SHAPE["ranges"]},
                "attraction": {"amplitude": energy, "range": reach},
            },
            "material": {"contact_modulus": contact_modulus, "length_unit": unit, "force_unit": force_unit},
            "accuracy": {"tolerance": tolerance},
            "experiment": {"kind": "pull_off", "preload": PRELOAD_SHARE * wanted.adhesion_force},
        }
    )
    return scene, wanted


def _require_resolved(a_0: float, unit: float, radius: float) -> None:
    """Refuse an a₀ [m] of too few or too many length units [m], or too large a part of the sphere's radius [m]."""
    particles = a_0 / unit
    if not FEWEST_IN_RADIUS <= particles <= MOST_IN_RADIUS:
        side, count = ("most", FEWEST_IN_RADIUS) if particles < FEWEST_IN_RADIUS else ("least", MOST_IN_RADIUS)
        given, limit = apart(unit, a_0 / count, 4)
        raise IdentifyError(
            f"a length unit of {given} m gives {particles:.2g} particles in the zero-load radius of {a_0:.4g} m: "
            f"use at {side} {limit} m for {count:g}"
        )
    if a_0 > LARGEST_RADIUS_SHARE * radius:
        share, most = apart(a_0 / radius, LARGEST_RADIUS_SHARE, 2)
        raise IdentifyError(
            f"the zero-load radius of {a_0:.4g} m is {share} of the sphere's: JKR is for a << R, here up to {most}. "
            "Use a larger radius, a larger contact modulus or a smaller surface energy"
        )


def jkr_target(contact_modulus: float, surface_energy: float, radius: float) -> Target:
    """F_A = 3πγR [N] and a₀ = (9πγR²/E*)^{1/3} [m] of JKR; E* [Pa], γ of one side [J/m²], R [m]."""
    sphere = PowerLaw.sphere(radius, contact_modulus, work_of_adhesion=2.0 * surface_energy)
    return Target(sphere.pull_off_force(), sphere.zero_load_radius())


Array = NDArray[np.float64]
SLOPE_STEP = 0.03
"""Step of the finite differences of the predictor, in both logarithms: well above the grain of its grid."""
FIRST_STEP, FARTHEST = 0.25, 9.0
"""First and last step of a search for a bracket, in the logarithm of a factor."""
START_ERROR = 1e-4
"""Of both logarithms at the start: what the predictor itself is good for."""
TAIL = 1e-5
"""Force at the predictor's cutoff over the force scale."""
POINTS = 1000
"""Distances at which the predictor has the force of a row."""


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
    amplitude, wanted = 0.0, np.log([target.adhesion_force, target.zero_load_radius])

    def off(amplitude: float, reach: float) -> Array:
        return _estimated(scaled(scene, np.array([amplitude, reach]))) - wanted

    def radius_off(reach: float) -> float:
        nonlocal amplitude
        amplitude = _root(lambda a: float(off(a, reach)[0]), amplitude)
        return float(off(amplitude, reach)[1])

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
    """The zero of a monotone function of a logarithm, searched on both sides of `start`.

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
    steps = SLOPE_STEP * np.eye(2)
    ends = [[_estimated(scaled(scene, at + sign * step)) for sign in (1.0, -1.0)] for step in steps]
    return np.column_stack([(above - below) / (2.0 * SLOPE_STEP) for above, below in ends])


def scaled(scene: Scene, logarithms: Array) -> Scene:
    """The scene with both amplitudes and both ranges multiplied by the exponentials of `logarithms`."""
    data = scene.model_dump(by_alias=True, exclude_none=True)
    for term in ("repulsion", "attraction"):
        for key, factor in zip(("amplitude", "range"), np.exp(logarithms).tolist(), strict=True):
            data["interaction"][term][key] *= factor
    return scene_from_dict(data)


def _estimated(scene: Scene) -> Array:
    """ln F_A and ln a₀ of independent pairs, by the predictor of every run's settings, on a coarser grid."""
    law = interaction_law(scene)
    assert law is not None
    cutoff, rest = law.cutoff_for(TAIL), law.force_free_distance()
    estimate = of_pairs(law, scene.bodies, scene.bodies.spacing, scene.bulk_stiffness, cutoff, rest, POINTS)
    radius = estimate.half_width(estimate.displacement_at(0.0), _largest_tension(estimate))
    return np.log([estimate.pull_off_force(), radius])


def _largest_tension(estimate: Law) -> float:
    """The undeformed gap [LU] of the force maximum, between the points of the grid by a parabola."""
    force, points = estimate.force, np.arange(estimate.force.size, dtype=np.float64)
    i = min(max(int(np.argmin(force)), 1), len(force) - 2)
    place, _ = vertex(points, -force, i, 1)
    return float(np.interp(place, points, estimate.gap))


MOST_RUNS = 8
"""Runs after which the search gives up; two to four are usual."""
SEARCH_SHARE = 0.3
"""A search ends where both deviations are below this share of the scene's tolerance."""


@dataclass(frozen=True)
class Identified:
    """A scene that has its target.

    Attributes:
        scene: with the interaction that was found.
        run: of that scene.
        deviations: relative ones of F_A and a₀ from the target.
        runs: how many it took.
    """

    scene: Scene
    run: Run
    deviations: tuple[float, float]
    runs: int


def identify(scene: Scene, target: Target, folder: Path, progress: Progress | None = None) -> Identified:
    """Scale the interaction of a pull_off `scene` so that its F_A and a₀ are those of `target`.

    Args:
        scene: a pull_off with attraction; its interaction's shape is kept.
        target: wanted.
        folder: run folder; it holds the last run.
        progress: informed of phases and steps.

    Raises:
        IdentifyError: no interaction of this shape has the target, or the search does not end.
        SettingsError, RunError: see `workflow.runs.campaign.run`.
    """
    require_reachable(scene, target)
    at = start(scene, target)
    found: Identified | None = None
    for count in range(1, MOST_RUNS + 1):
        trial = scaled(scene, at)
        finished = run(trial, folder, figures=False, progress=progress)
        values = [finished.model.results[name].value for name in UNIT_FIXING_RESULTS]
        reached = np.log(np.asarray(values) / (target.adhesion_force, target.zero_load_radius))
        found = Identified(trial, finished, (math.expm1(reached[0]), math.expm1(reached[1])), count)
        if np.abs(reached).max() < SEARCH_SHARE * scene.accuracy.tolerance:
            return found
        at = at - np.linalg.solve(slopes(scene, at), reached)
    assert found is not None
    raise IdentifyError(
        f"the search did not converge in {MOST_RUNS} runs: deviation {found.deviations[0]:.1e} of the adhesion force, "
        f"{found.deviations[1]:.1e} of a₀. Use a smaller [accuracy] tolerance or more particles in a₀"
    )


def scales_of_run(folder: Path, contact_modulus: float, surface_energy: float) -> tuple[Scales, dict[str, Any]]:
    """The scales with which the run is JKR's contact of the material, and the run's quantities that have a unit of LU
    and FU.

    Args:
        folder: run folder of a pull_off, or of a path that found F_A and a₀.
        contact_modulus: E* [Pa].
        surface_energy: γ of one side [J/m²].

    Raises:
        IdentifyError: no such run, or one without these quantities.
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
