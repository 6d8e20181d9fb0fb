"""Runs of Fig. 8: curves F(a) of many N and R, and of the local limit, by prescribed displacement; dynamic loads.

N has two meanings: a longer chain of the same spacing, and a finer spacing of the same length. "The same physics" of
the latter is the same stiffness and line tension per length, and an interaction with the same F_A and a₀ (by
`workflow.identify.estimated`, to some 0.1 %).
"""

from __future__ import annotations

from functools import cache

from contact1d.workflow.identify import Target, estimated
from contact1d.workflow.scene import Scene
from validation.paper.paper import TABLE_1, changed, curve_scene, local, with_radius
from validation.paper.study import Scenes

DEEPEST, STEPS = 0.46, 56
"""Largest displacement [LU] of a curve, F/F_A some 2 in every scene, and its rows on the way back."""
LENGTHENED = (200, 400, 800, 1600)
"""The contact of R = 1000 needs some 174; what a shorter chain cuts off the run warns of."""
REFINED = (1600, 800, 400, 100)
"""N on the length of 200 LU; the longest run first. N = 200 is the lengthened one."""
REFINED_TOLERANCE = 1e-2
"""Of runs whose particles feel tens of others."""
REFINED_DEEPEST = 0.5
"""Their contacts are softer; from 0.55 LU on particles of the finest go through the opposite chain."""
RADII = (500.0, 1000.0, 2000.0, 3000.0, 4000.0)
LOCAL_RADII = (4000.0, 8000.0, 16000.0, 32000.0)
LOCAL_COUNTS = (100, 200, 300, 400)
LOCAL_LENGTH = 1600.0
"""Length of the local chains of given N [LU], at R = LOCAL_RADIUS."""
LOCAL_RADIUS = 64000.0
READ = {"tolerance": "of a_cr and a_0, which a path reads between its rows; used here are the rows"}
"""Answer to the warning of every curve."""
DYNAMIC_FORCES = (1.0, 0.0, -1.0)
"""Loads [FU] of the dynamic points; the paper's own method."""


def lengthened_run(count: int) -> str:
    """Name of the curve of a chain of `count` particles, 1 LU apart."""
    return f"curve_lengthened_N{count}"


def refined_run(count: int) -> str:
    """Name of the curve of `count` particles on 200 LU."""
    return f"curve_refined_N{count}"


def radius_run(R: float) -> str:
    """Name of the curve of the paper's chain with that R."""
    return lengthened_run(200) if TABLE_1[0].radius == R else f"curve_R{R:g}"


@cache  # three studies ask for the same four scenes, of a second each
def refined(paper: Scene, count: int) -> Scene:
    """The paper's scene with `count` particles on the same length."""
    spacing = 200.0 / count
    assert paper.neighbours is not None
    scene = changed(
        paper,
        f"bodies.particles={count}",
        f"bodies.spacing={spacing}",
        f"bodies.bulk_stiffness={paper.bulk_stiffness * spacing}",
        f"neighbours.stiffness={paper.neighbours.stiffness / spacing}",
        f"accuracy.tolerance={REFINED_TOLERANCE}",
    )
    first = TABLE_1[0]
    return estimated(scene, Target(first.adhesion_force, first.zero_load_radius))


def local_counted(paper: Scene, count: int) -> Scene:
    """The local limit with `count` particles on a given length."""
    scene = with_radius(local(paper, LOCAL_LENGTH / count), LOCAL_RADIUS)
    return changed(scene, f"bodies.particles={count}")


def scenes_8a(paper: Scene) -> Scenes:
    """Curves of both meanings of N, and of the local limit."""
    fine = {refined_run(n): curve_scene(refined(paper, n), REFINED_DEEPEST, STEPS) for n in REFINED}
    long = {lengthened_run(n): curve_scene(changed(paper, f"bodies.particles={n}"), DEEPEST, STEPS) for n in LENGTHENED}
    pairs = {f"curve_local_N{n}": curve_scene(local_counted(paper, n), DEEPEST, STEPS) for n in LOCAL_COUNTS}
    return fine | long | pairs


def dynamic_run(force: float) -> str:
    """Name of the dynamic load."""
    return f"dynamic_load{force:g}"


def _curve(paper: Scene, R: float) -> Scene:
    long = paper if TABLE_1[0].radius == R else changed(with_radius(paper, R), "bodies.particles=auto")
    return curve_scene(long, DEEPEST, STEPS)


def scenes_8b(paper: Scene) -> Scenes:
    """Curves over R, of the local limit too, and dynamic loads of the paper's scene."""
    moving = {
        dynamic_run(force): changed(
            paper,
            f"experiment={{ kind = 'load', force = {force}, method = 'dynamic' }}",
            "damping.coefficient=auto",
            "plate.mass=auto",
        )
        for force in DYNAMIC_FORCES
    }
    pairs = {f"curve_local_R{R:g}": curve_scene(with_radius(local(paper), R), DEEPEST, STEPS) for R in LOCAL_RADII}
    return moving | {radius_run(R): _curve(paper, R) for R in RADII} | pairs
