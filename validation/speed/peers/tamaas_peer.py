"""tamaas (3D boundary elements, FFT), Polonsky and Keer's conjugate gradients, warm starts.

Hertz: non-periodic (`registerNonPeriodic`, discrete-convolution FFT), prescribed load, the displacement read in the
contact. JKR: `ExponentialAdhesionFunctional` needs the gap as the unknown, whose operator is periodic only; so the box
is SIDE a_0 wide, the mean gap is prescribed, and d is corrected for the images: a square lattice of point forces lowers
the mean-free displacement by 3.9003 F/(pi E* L), 3.9003 its Madelung constant. Nothing is corrected for what the images
do to the curvature, 0.4 % of it under F_A.
"""

from typing import Any

import numpy as np

from validation.row import tables_beside
from validation.speed.peers.contacts import (
    A_0,
    CONTACT_MODULUS,
    WORK_OF_ADHESION,
    Array,
    Curve,
    Setting,
    closed_form,
    displacements,
    elements,
    heights,
    law_range,
    timed,
)  # fmt: skip

NAME = "tamaas"
SETTINGS = elements(**tables_beside(__file__))
SIDE = {"hertz": 2.3, "jkr": 5.0}
"""Side of the square over a_0."""
MADELUNG = 3.900265
MOST_ITERATIONS = 3000
"""Of one displacement. From a pixel of 0.016 a_0 on (320²) all of them end within it at µ = 5; on coarser grids some do
not end at all. A tolerance of 1e-5 takes longer and gives the same curve."""


def load() -> None:
    """Import the package."""
    import tamaas

    tamaas.set_log_level(tamaas.LogLevel.error)


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve of one grid."""
    import tamaas

    side, n = SIDE[contact] * A_0, setting.grid
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [side, side], [n, n])
    model.E, model.nu = CONTACT_MODULUS, 0.0
    surface = heights(side, n)
    solve = _hertz if contact == "hertz" else _jkr
    solver, _adhesion = _solver(model, surface, contact, setting)  # the solver does not keep its functional alive
    return timed(contact, setting, lambda: solve(model, solver, surface, side))


def _solver(model: Any, surface: Array, contact: str, setting: Setting) -> tuple[Any, Any]:
    import tamaas

    kind = tamaas.PolonskyKeerRey
    if contact == "hertz":
        tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
        solver = kind(model, surface, setting.tolerance)
        solver.setIntegralOperator("dcfft")
        adhesion = None
    else:
        solver = kind(model, surface, setting.tolerance, kind.gap, kind.gap)
        adhesion = tamaas.ExponentialAdhesionFunctional(surface)
        adhesion.parameters = {"rho": law_range(setting.tabor), "surface_energy": WORK_OF_ADHESION}
        solver.addFunctionalTerm(adhesion)
    solver.max_iter = MOST_ITERATIONS
    return solver, adhesion


def _hertz(model: Any, solver: Any, surface: Array, side: float) -> tuple[Array, Array]:
    """Return d [nm] and F [µN]; the loads are Hertz's of the prescribed d."""
    pixel = side**2 / surface.size
    points = []
    for load in closed_form("hertz", displacements("hertz")):
        solver.solve(load / side**2)
        touching = model.traction > 0.0
        model.operators["dcfft"](model.traction, model.displacement)
        points.append(((model.displacement - surface)[touching].mean(), model.traction.sum() * pixel))
    return tuple(np.array(points).T)


def _jkr(model: Any, solver: Any, surface: Array, side: float) -> tuple[Array, Array]:
    """Return d [nm] and F [µN]."""
    pixel, images = side**2 / surface.size, MADELUNG / (np.pi * CONTACT_MODULUS * side)
    wanted = displacements("jkr")
    force = closed_form("jkr", wanted)
    points = []
    for depth in np.linspace(wanted[0] - images * force[0], wanted[-1] - images * force[-1], len(wanted)):
        solver.solve(-surface.mean() - depth)
        load = model.traction.sum() * pixel
        points.append((depth + images * load, load))
    return tuple(np.array(points).T)
