"""ContactMechanics and Adhesion (3D boundary elements, FFT, free half-space), prescribed displacement, warm starts.

Hertz: the dual problem (pressure) by constrained conjugate gradients with restarts, the quickest of its ways here; the
tolerance is of the gap in contact, over d_max. JKR:
hard wall and V = -W exp(-gap/z_0) (`BoundedSmoothContactSystem`), L-BFGS-B of scipy on the displacements; the conjugate
gradients of NuMPI diverge from these starts, since the adhesive Hessian is not positive.
"""

from typing import Any

import numpy as np

from validation.row import tables_beside
from validation.speed.peers.contacts import (
    A_0,
    CONTACT_MODULUS,
    DEPTH,
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

NAME = "ContactMechanics"
SETTINGS = elements(**tables_beside(__file__))
SIDE = {"hertz": 2.3, "jkr": 3.2}
"""Side of the square over a_0: the largest contact is 2 a_0 wide (Hertz), 2.66 a_0 and what the law reaches (JKR)."""


def load() -> None:
    """Import the packages."""
    import Adhesion.System  # noqa: F401 (loading it is the point)
    import ContactMechanics.Systems  # noqa: F401 (loading it is the point)
    import SurfaceTopography  # noqa: F401 (loading it is the point)


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve of one grid."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from SurfaceTopography import Topography

    side, n = SIDE[contact] * A_0, setting.grid
    space = FreeFFTElasticHalfSpace((n, n), CONTACT_MODULUS, (side, side))
    surface = Topography(heights(side, n), physical_sizes=(side, side))
    solve = _hertz if contact == "hertz" else _jkr
    d = displacements(contact)
    return timed(contact, setting, lambda: (d, np.array(solve(space, surface, setting, d))))


def _hertz(space: Any, surface: Any, setting: Setting, places: Array) -> list[float]:
    """Return F [µN]; the tolerance is of the gap in contact, over d_max."""
    from ContactMechanics.Systems import NonSmoothContactSystem

    system = NonSmoothContactSystem(space, surface)
    middle = setting.grid // 2
    pressure = np.zeros((setting.grid, setting.grid))
    pressure[middle - 1 : middle + 1, middle - 1 : middle + 1] = closed_form("hertz", places)[0] / 4.0
    force = []
    for d in places:
        found = system.dual_minimize_proxy(
            offset=d, init_force=pressure, solver="ccg-with-restart", gtol=setting.tolerance * DEPTH
        )
        if not found.success:
            raise RuntimeError(f"{setting.name}: not converged at d = {d:.4g} nm")
        pressure = found.x.reshape(pressure.shape)
        force.append(float(pressure.sum()))
    return force


def _jkr(space: Any, surface: Any, setting: Setting, places: Array) -> list[float]:
    """Return F [µN]; the tolerance is of the pressure, over W/z_0."""
    from Adhesion.Interactions import Exponential
    from Adhesion.System import BoundedSmoothContactSystem

    z, pixel = law_range(setting.tabor), (SIDE["jkr"] * A_0 / setting.grid) ** 2
    system = BoundedSmoothContactSystem(space, Exponential(WORK_OF_ADHESION, z), surface)
    moved = np.zeros(space.nb_subdomain_grid_pts)
    options = {"gtol": setting.tolerance * WORK_OF_ADHESION / z * pixel, "ftol": 0.0, "maxiter": 5000, "maxfun": 10**6}
    force = []
    for d in places:
        moved = system.minimize_proxy(offset=d, initial_displacements=moved, options=options).x
        force.append(float(system.compute_normal_force()))
    return force
