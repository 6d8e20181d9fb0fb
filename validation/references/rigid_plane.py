"""One tethered chain pressed on a frictionless rigid plane: a linear complementarity problem, solved exactly.

0 <= g + u, 0 <= p, p (g + u) = 0 per particle, with the reaction p = K u, K = k 1 + k_n (chain Laplacian), g the
undeformed gap and u the lift of a particle.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from validation.references.interaction import Floats


def contact_on_rigid_plane(gap: Floats, bulk_stiffness: float, neighbour_stiffness: float) -> tuple[Floats, Floats]:
    """Return the lift u and the reaction p = K u of every particle.

    Primal-dual active set. K has no positive entry off its diagonal, so the method ends with the exact set of
    touching particles after at most a few more rounds than there are particles, with no penalty and no tolerance.
    Source: M. Hintermueller, K. Ito, K. Kunisch, SIAM J. Optim. 13 (2003) 865.

    Args:
        gap: undeformed height over the plane, negative where the undeformed body would penetrate, shape (N,) [LU].
        bulk_stiffness: k > 0 [FU/LU].
        neighbour_stiffness: k_n >= 0 [FU/LU].

    Returns:
        u [LU] and p [FU], each of shape (N,); p is exactly zero where the particle does not touch.

    Raises:
        RuntimeError: if the set of touching particles does not settle.
    """
    touching = gap < 0.0
    for _ in range(2 * gap.size + 10):
        lift = _lift(gap, touching, bulk_stiffness, neighbour_stiffness)
        pull, stretch = bulk_stiffness * lift, neighbour_stiffness * np.diff(lift)
        pull[:-1] -= stretch
        pull[1:] += stretch
        reaction = np.where(touching, pull, 0.0)
        now_touching = np.where(touching, reaction > 0.0, gap + lift < 0.0)
        if np.array_equal(now_touching, touching):
            return lift, reaction
        touching = now_touching
    raise RuntimeError("the set of touching particles does not settle")


def rigid_plane_sum(displacement: float, places: Floats, radius: float, bulk_stiffness: float) -> float:
    """Return F = sum_i k max(0, d - x_i^2/2R) [FU]: one chain without neighbour springs on a rigid plane, exactly.

    Args:
        displacement: d, zero where a particle at x = 0 would touch [LU].
        places: x_i, shape (N,) [LU].
        radius: R [LU].
        bulk_stiffness: k of a particle [FU/LU].
    """
    return float(bulk_stiffness * np.sum(np.maximum(0.0, displacement - places**2 / (2.0 * radius))))


def _lift(gap: Floats, touching: NDArray[np.bool_], k: float, k_n: float) -> Floats:
    """Solve u = -g where touching and (K u) = 0 elsewhere; a tridiagonal system."""
    size = gap.size
    bands = np.zeros((3, size))
    bands[1] = k
    if size > 1 and k_n > 0.0:
        bands[1, :-1] += k_n
        bands[1, 1:] += k_n
        bands[0, 1:] = np.where(touching[:-1], 0.0, -k_n)
        bands[2, :-1] = np.where(touching[1:], 0.0, -k_n)
    bands[1] = np.where(touching, 1.0, bands[1])
    right = np.where(touching, -gap, 0.0)
    return np.asarray(solve_banded((1, 1), bands, right)) if size > 1 else right / bands[1]
