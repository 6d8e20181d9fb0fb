"""The 1D contact without adhesion: a curved body with a layer of springs on a rigid plane, F = (4 sqrt2/3) c_n R^(1/2)
d^(3/2), and the exact sum over its particles.

The integral of c_n (d - x^2/2R) over |x| < sqrt(2Rd). Its energy is (8 sqrt2/15) c_n sqrt(R d^5); Eq. (2) of Geike and
Popov, Tribology International 40 (2007), prints 2 sqrt2/15, which contradicts their Eq. (3). With c_n = E*/2 it is
the law of Hertz for the effective radius R/2, with twice the contact radius.
"""

from __future__ import annotations

import numpy as np

from contact1d.analysis.theory.adhesive_pair import Floats


def winkler_force(displacement: Floats | float, radius: float, layer_stiffness: float) -> Floats:
    """Return F = (4 sqrt2/3) c_n sqrt(R) d^(3/2) [FU], zero where d < 0; shape of `displacement`.

    Args:
        displacement: d, zero at touch [LU].
        radius: R of the parabola x^2/2R [LU].
        layer_stiffness: c_n, bulk stiffness of a particle over the spacing [FU/LU^2].
    """
    d = np.maximum(np.asarray(displacement, dtype=np.float64), 0.0)
    return np.asarray(4.0 * np.sqrt(2.0) / 3.0 * layer_stiffness * np.sqrt(radius) * d**1.5)


def winkler_energy(displacement: Floats | float, radius: float, layer_stiffness: float) -> Floats:
    """Return U = (8 sqrt2/15) c_n sqrt(R d^5) [FU LU], zero where d < 0; arguments as for `winkler_force`."""
    d = np.maximum(np.asarray(displacement, dtype=np.float64), 0.0)
    return np.asarray(8.0 * np.sqrt(2.0) / 15.0 * layer_stiffness * np.sqrt(radius * d**5))


def winkler_half_width(displacement: Floats | float, radius: float) -> Floats:
    """Return sqrt(2 R d) [LU], zero where d < 0; arguments as for `winkler_force`."""
    return np.sqrt(2.0 * radius * np.maximum(np.asarray(displacement, dtype=np.float64), 0.0))


def rigid_plane_sum(displacement: float, places: Floats, radius: float, bulk_stiffness: float) -> float:
    """Return F = sum_i k max(0, d - x_i^2/2R) [FU]: one chain without neighbour springs on a rigid plane, exactly.

    Args:
        displacement: d, zero where a particle at x = 0 would touch [LU].
        places: x_i, shape (N,) [LU].
        radius: R [LU].
        bulk_stiffness: k of a particle [FU/LU].
    """
    return float(bulk_stiffness * np.sum(np.maximum(0.0, displacement - places**2 / (2.0 * radius))))
