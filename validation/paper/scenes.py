"""The paper's numbers, and the scenes that stand for its experiments.

Geike and Popov, Tribology International 40 (2007). Neither interaction nor bulk stiffness is printed. The interaction
is identified by the first row of Table 1. The stiffness of 1 FU/LU was chosen: with it the curve of R = 1000
lies nearest to JKR's, so the nearness of that curve and the mean pressure are not predictions. The other rows of the
table, the exponents, and that curves of other R and N fall on the same one, are.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from validation.doors import (
    FolderError,
    Parabola,
    RunError,
    Scene,
    Target,
    identify,
    law_of,
    load_run,
    read_scene,
    shipped,
    versions,
)
from validation.figures import Array
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver, State

CONTACT_MODULUS = 200e9
"""E* of the paper's example [Pa]."""
SURFACE_ENERGY = 1.0
"""γ of the paper's example [J/m²]."""


class Printed(NamedTuple):
    """A row of Table 1: R and a₀ [LU], F_A [FU], one LU [m], one FU [N]."""

    radius: float
    zero_load_radius: float
    adhesion_force: float
    length_unit: float
    force_unit: float


TABLE_1 = (
    Printed(1000.0, 28.53, 1.47, 6.1e-9, 39.0e-6),
    Printed(1600.0, 36.14, 1.87, 7.7e-9, 61.8e-6),
    Printed(2000.0, 40.36, 2.09, 8.6e-9, 77.6e-6),
)
FIRST_ROW = Target(TABLE_1[0].adhesion_force, TABLE_1[0].zero_load_radius)
"""What the interaction is identified by."""
IN_PLACE = (
    "These runs have in place of the paper's: particles that move along z only (Fig. 2 has both directions; `fig6` has "
    "what that changes), the interaction that is identified by the first row of Table 1, and a bulk stiffness of "
    "1 FU/LU, chosen by the nearness of the curve of R = 1000 LU to JKR's. The paper prints neither of the last two."
)
HALF_DIGIT = {"a_0": 0.005, "F_A": 0.005, "one LU": 0.05, "one FU": 0.05}
"""Rounding of the printed numbers, in their units."""
LOCAL_SPACING = 4.0
"""Spacing of the scenes in the local limit, wider than the cutoff of some 3.8 LU: only opposite particles meet."""


def calibrated(folder: Path) -> Scene:
    """The paper's scene with the interaction that gives the first row of Table 1; `folder` for the runs.

    An identification that is there already, of the same scene and versions, holds.
    """
    scene = read_scene(shipped("scenes/paper.toml"))
    return _identified(scene, folder) or identify(scene, FIRST_ROW, folder)[0].scene


def _identified(scene: Scene, folder: Path) -> Scene | None:
    """The scene of a finished run in `folder` that is `scene` but for the interaction, and has its target."""
    try:
        run = load_run(folder).model
        reached = [run.results[name].value for name in ("adhesion_force", "zero_load_radius")]
    except (FolderError, RunError, KeyError):
        return None
    found = run.scene
    same = found.model_copy(update={"interaction": scene.interaction}) == scene
    wanted = (FIRST_ROW.adhesion_force, FIRST_ROW.zero_load_radius)
    near = all(abs(a / b - 1.0) < scene.accuracy.tolerance for a, b in zip(reached, wanted, strict=True))
    return found if same and near and run.document.get("versions") == versions() else None


MOVING = ("damping.coefficient=auto", "plate.mass=auto")
"""What a method in time needs besides."""


def changed(scene: Scene, *overrides: str) -> Scene:
    """The scene with `table.key=value` changed."""
    return read_scene(scene, overrides)


def curve_scene(scene: Scene, deepest: float, steps: int) -> Scene:
    """The scene's F(a) by prescribed displacement: from 0 to `deepest` [LU] and back to separation in `steps`."""
    back = [deepest - (deepest + 1.5 * law_of(scene)[3]) * i / steps for i in range(steps + 1)]
    return changed(scene, f"experiment={{ kind = 'path', displacements = {[round(d, 6) for d in back]} }}")


def local(scene: Scene, spacing: float = LOCAL_SPACING) -> Scene:
    """The scene in the local limit: no neighbour springs, and particles so wide apart that only opposite ones meet.

    Stiffness and interaction per length are those of the scene, whose spacing is 1 LU.
    """
    (A, _, B, _), wider = law_of(scene), spacing / scene.bodies.spacing
    keys = (
        f"bodies.spacing={spacing}",
        "bodies.particles=auto",
        f"bodies.bulk_stiffness={wider * scene.bulk_stiffness}",
        f"interaction.repulsion.amplitude={wider * A}",
        f"interaction.attraction.amplitude={wider * B}",
    )
    return read_scene(scene, keys, "neighbours")


def with_radius(scene: Scene, radius: float) -> Scene:
    """The scene with another R [LU]."""
    return changed(scene, f"bodies.profile.radius={radius}")


READ = {"tolerance": "of a_cr and a_0, which a path reads between its rows; used here are the rows"}
"""Answer to the warning of every curve."""
ROW_REACH, ROW_POINTS, ROW_HALF = 5.0, 4001, 20
"""Distances [longest ranges] and particles to each side that the largest tension of a row is looked for with."""
STEP, BEYOND = 0.02, 0.1
"""Of the displacement [LU] in which an equilibrium under a force is looked for, and what is added at both ends."""


def interaction(scene: Scene) -> PairInteraction:
    """The scene's law."""
    return PairInteraction.of(*law_of(scene))


def radius(scene: Scene) -> float:
    """R of the scene's parabola [LU]."""
    assert isinstance(scene.bodies.profile, Parabola)
    return scene.bodies.profile.radius


def chain_model(scene: Scene) -> ChainModel:
    """The scene for the independent solver; the transformed profile x²/R is that of half the radius as given."""
    assert isinstance(scene.bodies.particles, int)
    return ChainModel(
        scene.bodies.particles,
        scene.bulk_stiffness,
        interaction(scene),
        radius=radius(scene) / (2.0 if scene.bodies.reduction == "mdr" else 1.0),
        spacing=scene.bodies.spacing,
        neighbour_stiffness=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
        horizontal=scene.horizontal is not None,
    )


def equilibrium_under(model: ChainModel, force: float) -> State:
    """The solver's state under a force [FU]: steps of the displacement from 0 until it is passed, then bisection."""
    solver = ChainSolver(model)
    state = solver.equilibrium(0.0)
    towards = math.copysign(STEP, force - state.force)
    before = state
    while (state.force - force) * towards < 0.0:
        before, state = state, solver.equilibrium(state.displacement + towards, state)

    if before is state:
        return state
    ends = (before.displacement - BEYOND * towards, state.displacement + BEYOND * towards)  # a step may end on it
    place = brentq(lambda d: solver.equilibrium(d, before).force - force, *ends, xtol=1e-12)
    return solver.equilibrium(place, before)


def independent_pairs(scene: Scene) -> IndependentPairs:
    """The scene's closed form, which holds where only opposite particles meet."""
    return IndependentPairs(interaction(scene), scene.bulk_stiffness, radius(scene), scene.bodies.spacing)


def row_tension(scene: Scene) -> float:
    """Largest tension [FU] of a particle that faces a straight row: f(r) = Σ_j f_pair(ϱ_j) r/ϱ_j, ϱ_j² = r² + (js)²."""
    law, spacing = interaction(scene), scene.bodies.spacing
    r = np.linspace(law.force_free_distance(), law.force_free_distance() + ROW_REACH * law.longest_range, ROW_POINTS)
    distance = np.hypot(r[:, None], spacing * np.arange(-ROW_HALF, ROW_HALF + 1))
    return float(-(law.force(distance) * r[:, None] / distance).sum(axis=1).min())


def jkr_reduced(a: Array | float) -> Array:
    """F/F_A = 4 ã³ − 4 ã^{3/2} at ã = a/a₀ (Eq. 8)."""
    return 4.0 * a**3 - 4.0 * a**1.5


def breaking_reduced(a: Array | float) -> Array:
    """F/F_A = (3√3/2)(ã³ − ã) of springs that break: the model's own limit of zero range, whatever the law."""
    return np.asarray(1.5 * math.sqrt(3.0) * (a**3 - a))


def barquins_reduced(a: Array | float) -> Array:
    """F/F_A of a cylinder, ∝ ã² − √ã with the minimum −1 (Barquins 1988)."""
    lowest = 4.0 ** (-2.0 / 3.0)  # where 2ã = 1/(2√ã)
    return np.asarray((a**2 - np.sqrt(a)) / (lowest**0.5 - lowest**2))
