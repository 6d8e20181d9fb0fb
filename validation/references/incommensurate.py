"""A flat chain on a rigid row whose spacings have no common measure, after Frenkel, Kontorova and Tomlinson.

Each particle hangs by springs (k_t, k_n) on a body at (X, Z), and stands at every phase of the row as often. So neither
the body's energy nor its height depends on X, and a particle slides alone over

    U(x) = min_z Σ_j V(√((x − j s)² + z²)) + k_n (z − Z)²/2

with Z such that the mean of the spring's force over X is the load of a particle. The chain is pinned where
k_t < max(−U″), and ⟨F⟩ of a particle is then the energy that its slips lose; above it slides freely. The load of a
particle on the top is larger than that of one in a hollow: the threshold is above that of a constant load, which is the
limit of soft springs.
"""

from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from validation.references.interaction import LawNumbers
from validation.references.prandtl_tomlinson import Corrugation, corrugation

REACH = 0.1
"""Of the spacing: how far the mean height may be from that under a constant load."""
POINTS = 4001
"""Places in a period on the way that the mean is taken over."""


def shared_corrugation(
    law: LawNumbers,
    spacing: float,
    load: float,
    normal_stiffness: float,
    tangential_stiffness: float,
) -> Corrugation:
    """U(x) of a particle of the chain while the body is drawn slowly.

    Args:
        law: A [FU·LU], a [LU], B [FU·LU], b [LU].
        spacing: of the row [LU].
        load: on a particle in the mean [FU].
        normal_stiffness, tangential_stiffness: k_n, k_t [FU/LU].

    Raises:
        ArithmeticError: the row does not hold the load.
    """

    return _shared(law, spacing, load, normal_stiffness, lambda wells: tangential_stiffness)


def threshold(law: LawNumbers, spacing: float, load: float, normal_stiffness: float) -> float:
    """The k_t [FU/LU] above which the chain slides freely: k_t = max(−U″) of the wells at this same k_t."""
    return _shared(law, spacing, load, normal_stiffness, lambda wells: wells.steepest).steepest


def _shared(
    law: LawNumbers,
    spacing: float,
    load: float,
    normal_stiffness: float,
    tangential_stiffness: Callable[[Corrugation], float],
) -> Corrugation:
    """The wells whose mean height is that at which the spring's force is the load."""

    def excess(place: float) -> float:
        wells = corrugation(law, spacing, load, normal_stiffness, place)
        return _mean_height(wells, tangential_stiffness(wells)) - place

    middle = corrugation(law, spacing, load).heights[0]
    place = brentq(excess, middle - REACH * spacing, middle + REACH * spacing, xtol=1e-7)
    return corrugation(law, spacing, load, normal_stiffness, place)


def _mean_height(wells: Corrugation, stiffness: float) -> float:
    """Mean of z [LU] over the places of the body, on the way that a slow drive takes."""
    s = wells.spacing
    x = np.linspace(0.5 * s, 2.5 * s, 2 * POINTS - 1)
    drive = x + wells.slope(x) / stiffness
    falls = np.flatnonzero(np.diff(drive) <= 0.0)
    way = slice(0, POINTS)
    if falls.size:  # it slips from there to the next place in which it rests, and has gone on from one like that before
        begin = int(falls[0])
        beyond = np.flatnonzero((drive[:-1] < drive[begin]) & (drive[1:] >= drive[begin]))
        x = np.linspace(x[int(beyond[beyond > begin][0])] - s, x[begin], POINTS)
        drive = x + wells.slope(x) / stiffness
    z = sum(h * np.cos(2.0 * np.pi * n * x[way] / s) for n, h in enumerate(wells.heights.tolist()))
    return float(np.trapezoid(z, drive[way]) / (drive[way][-1] - drive[way][0]))
