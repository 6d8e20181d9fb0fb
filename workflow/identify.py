"""From a material to a scene: the interaction with which the model has a wanted F_A and a₀, found by a solver.

Two numbers are free, a factor on both amplitudes and one on both ranges of the scene's interaction; two are wanted.
Independent pairs (`workflow.estimate`) give the start and the slopes, finished runs the values: Newton's method on

    ( ln F_A/F_A*,  ln a₀/a₀* )  over  ( ln of the amplitudes' factor, ln of the ranges' factor ).

What can be reached: with the radius R₁ of the chain's parabola and the stiffness per length c of both chains in series,
F_A R₁/(c a₀³) rises from 0 to 4/(9√3) = 0.2566 as the range falls to 0, where springs break (`line_adhesion`). JKR with
the springs that the MDR gives a material, R₁ = R/2 and c = E*, has 1/6.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, least_squares, minimize_scalar

from analysis.reference.jkr import Jkr, work_of_adhesion
from workflow.campaign import Run, run
from workflow.progress import Progress
from workflow.scene import Parabola, PullOff, Scene, scene_from_dict
from workflow.settings import settings_for

Array = NDArray[np.float64]
MOST_RUNS = 8
"""Runs after which the search gives up; two to four are usual."""
CLOSE = 0.3
"""A search ends where both deviations are below this share of the scene's tolerance."""
BRITTLE = 4.0 / (9.0 * math.sqrt(3.0))
"""F_A R₁/(c a₀³) in the limit of a vanishing range."""
REACHABLE = 0.95 * BRITTLE
"""Beyond this the range would be so short that each pair snaps by itself."""
SLOPE_STEP = 0.03
"""Step of the finite differences of the estimate, in both logarithms: well above the grain of its grid."""
APPROACHES = 8
"""Steps by which the amplitudes alone are brought near F_A, before both factors are sought."""
RESOLUTION = 28.5
"""Particles in a₀, unless the length unit is given: as in the first row of the paper's Table 1."""
COARSEST = 8.0
"""Fewest particles in a₀ that a length unit must leave."""
PRELOAD_SHARE = 0.7
"""Preload of a scene for a material over its F_A."""
SHAPE = {"amplitudes": 2.0, "ranges": 2.0}
"""A over B and b over a of a scene for a material: those of the shipped pull_off scene."""


class IdentifyError(ValueError):
    """A target that the model can't reach; the message names the nearest one that it can."""


@dataclass(frozen=True)
class Target:
    """What a run is to find: F_A [FU] and a₀ [LU]."""

    adhesion_force: float
    zero_load_radius: float


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
        progress: told of phases and steps.

    Raises:
        IdentifyError: no interaction of this shape has the target, or the search does not end.
        SettingsError, RunError: see `workflow.campaign.run`.
    """
    require_reachable(scene, target)
    at = _start(scene, target)
    found: Identified | None = None
    for count in range(1, MOST_RUNS + 1):
        trial = _scaled(scene, at)
        finished = run(trial, folder, figures=False, progress=progress)
        reached = _deviations(
            (finished.results["adhesion_force"]["value"], finished.results["zero_load_radius"]["value"]), target
        )
        found = Identified(trial, finished, (math.expm1(reached[0]), math.expm1(reached[1])), count)
        if np.abs(reached).max() < CLOSE * scene.accuracy.tolerance:
            return found
        at = at - np.linalg.solve(_slopes(scene, at), reached)
    assert found is not None
    raise IdentifyError(
        f"the search did not come to its end in {MOST_RUNS} runs: adhesion force off by {found.deviations[0]:.1e}, "
        f"zero-load radius by {found.deviations[1]:.1e}. A finer [accuracy] tolerance or more particles in a₀ may help"
    )


def require_reachable(scene: Scene, target: Target) -> None:
    """Refuse a target beyond what springs of the scene's stiffness can do.

    Raises:
        IdentifyError: with the nearest zero-load radius and the nearest adhesion force.
    """
    if not isinstance(scene.experiment, PullOff) or scene.interaction is None or scene.interaction.attraction is None:
        raise IdentifyError("only a pull_off with an attraction finds F_A and a₀")
    if not isinstance(scene.bodies.profile, Parabola):
        raise IdentifyError("only a parabola has the F_A and a₀ of JKR's sphere")
    layer = scene.bulk_stiffness / (2.0 * scene.bodies.spacing)
    radius = scene.bodies.profile.radius * (0.5 if scene.bodies.reduction == "mdr" else 1.0)
    force, a_0 = target.adhesion_force, target.zero_load_radius
    if force * radius / (layer * a_0**3) > REACHABLE:
        smallest = (force * radius / (REACHABLE * layer)) ** (1.0 / 3.0)
        largest = REACHABLE * layer * a_0**3 / radius
        raise IdentifyError(
            f"an adhesion force of {force:.6g} FU with a zero-load radius of {a_0:.6g} LU is more than springs of this "
            f"stiffness hold, whatever the interaction. Nearest: the same force with a radius of at least "
            f"{smallest:.6g} LU, or the same radius with a force of at most {largest:.6g} FU"
        )


def material_scene(
    contact_modulus: float, radius: float, target: Target, length_unit: float | None = None, tolerance: float = 1e-3
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
        IdentifyError: a length unit that is too coarse.
    """
    coarsest = target.zero_load_radius / COARSEST
    unit = target.zero_load_radius / RESOLUTION if length_unit is None else length_unit
    if unit > coarsest:
        raise IdentifyError(
            f"a length unit of {unit:.4g} m leaves {target.zero_load_radius / unit:.2g} particles in the zero-load "
            f"radius of {target.zero_load_radius:.4g} m: at most {coarsest:.4g} m leaves {COARSEST:g}"
        )
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


def jkr_target(contact_modulus: float, surface_energy: float, radius: float) -> Target:
    """F_A = 3πγR [N] and a₀ = (9πγR²/E*)^{1/3} [m] of JKR; E* [Pa], γ of one side [J/m²], R [m]."""
    sphere = Jkr(radius, contact_modulus, work_of_adhesion(surface_energy))
    return Target(sphere.pull_off_force(), sphere.zero_load_radius())


def _scaled(scene: Scene, logarithms: Array) -> Scene:
    """The scene with both amplitudes and both ranges multiplied by the exponentials of `logarithms`."""
    amplitude, reach = np.exp(logarithms)
    data = scene.model_dump(by_alias=True, exclude_none=True)
    for term in ("repulsion", "attraction"):
        data["interaction"][term]["amplitude"] *= float(amplitude)
        data["interaction"][term]["range"] *= float(reach)
    return scene_from_dict(data)


def _deviations(values: tuple[float, float], target: Target) -> Array:
    return np.log(np.asarray(values) / (target.adhesion_force, target.zero_load_radius))


def _start(scene: Scene, target: Target) -> Array:
    """Where independent pairs have the target."""

    def deviations(at: Array) -> Array:
        return _deviations(_estimated(_scaled(scene, at)), target)

    first = np.zeros(2)
    for _ in range(APPROACHES):  # F_A grows a little faster than the amplitudes
        first[0] -= 0.7 * float(deviations(first)[0])
    fit = least_squares(deviations, first, diff_step=SLOPE_STEP, x_scale=1.0, bounds=(-12.0, 12.0), xtol=1e-6)
    if np.abs(fit.fun).max() > 0.05:
        force, radius = (
            target.adhesion_force * math.exp(fit.fun[0]),
            target.zero_load_radius * math.exp(fit.fun[1]),
        )
        raise IdentifyError(
            f"no interaction of this shape has an adhesion force of {target.adhesion_force:.4g} FU together with a "
            f"zero-load radius of {target.zero_load_radius:.4g} LU; nearest: {force:.4g} FU with {radius:.4g} LU"
        )
    return np.asarray(fit.x)


def _slopes(scene: Scene, at: Array) -> Array:
    """d(ln F_A, ln a₀)/d(logarithms) of independent pairs, by central differences."""

    def logarithms(place: Array) -> Array:
        return np.log(_estimated(_scaled(scene, place)))

    steps = SLOPE_STEP * np.eye(2)
    columns = [(logarithms(at + step) - logarithms(at - step)) / (2.0 * SLOPE_STEP) for step in steps]
    return np.column_stack(columns)


def _estimated(scene: Scene) -> tuple[float, float]:
    """F_A [FU] and a₀ [LU] of independent pairs."""
    estimate = settings_for(scene).estimate
    tail = float(estimate.gap[-1])
    force: Callable[[float], float] = estimate.contact_force
    grid = np.linspace(estimate.rest - tail, estimate.rest + tail, 80)
    values = np.asarray([force(float(d)) for d in grid])
    lowest = int(np.argmin(values))
    around = (float(grid[max(lowest - 1, 0)]), float(grid[min(lowest + 1, len(grid) - 1)]))
    best = minimize_scalar(force, bounds=around, method="bounded", options={"xatol": 1e-6 * tail})
    high = around[1]
    while force(high) <= 0.0:
        high += tail
    zero = brentq(force, float(best.x), high, xtol=1e-9 * tail)
    edge = int(np.argmin(estimate.force))
    return -float(best.fun), estimate.half_width(zero, float(estimate.gap[edge]))
