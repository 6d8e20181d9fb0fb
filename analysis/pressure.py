"""Pressure that the opposite body puts on the upper particles, and quantities read off it: p_i = F_z,i / spacing.

Here F_z,i is the force of the whole lower body on upper particle i, positive upwards, so that compression is positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from contact1d.potentials import DoubleExponential
    from contact1d.potentials.table import Table

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Profile:
    """The state of a contact along x; all arrays (n,), sorted by x. Two are equal if they are the same object.

    Attributes:
        x: positions of the upper particles [LU].
        z_lower, z_upper: heights of the lower and upper surface there [LU].
        pressure: force on the upper particle in +z per spacing, compression positive [FU/LU].
        shear: force on the upper particle in +x per spacing [FU/LU].
    """

    x: Array
    z_lower: Array
    z_upper: Array
    pressure: Array
    shear: Array

    def __post_init__(self) -> None:
        """Raise ValueError for arrays of unequal shapes, not 1-D, or not sorted by x; equal neighbours are allowed."""
        shapes = {array.shape for array in (self.x, self.z_lower, self.z_upper, self.pressure, self.shear)}
        if [len(shape) for shape in shapes] != [1]:
            raise ValueError(f"the arrays of a profile must be 1-D and equally long, got shapes {sorted(shapes)}")
        if (self.x[1:] < self.x[:-1]).any():
            raise ValueError("the arrays of a profile must be sorted by x")


@dataclass(frozen=True, eq=False)
class ZonedProfile(Profile):
    """A profile with a known contact edge.

    Attributes:
        edge: contact radius a [LU].
        reach: outer radius c of an attraction with a range [LU].
        jump: the line load just inside of a less that just outside [FU/LU].
        doubt: uncertainty of a [LU].
        layer: possible rise of the line load just inside of a, over less than the spacing [FU/LU].
    """

    edge: float
    reach: float
    jump: float
    doubt: float = 0.0
    layer: float = 0.0


def pressure_profile(
    x_upper: ArrayLike,
    z_upper: ArrayLike,
    z_lower: ArrayLike,
    force_x: ArrayLike,
    force_z: ArrayLike,
    spacing: float,
) -> Profile:
    """Return the state of a contact with p = F_z / spacing and q = F_x / spacing [FU/LU] over x, sorted by x.

    Valid for any order of the particles; compression, F_z > 0, is positive.

    Args:
        x_upper, z_upper: upper particles [LU], (n,).
        z_lower: height of the lower surface for each of them [LU], (n,).
        force_x, force_z: force of the lower body on each upper particle [FU], (n,).
        spacing: of the particles [LU].

    Raises:
        ValueError: unequal lengths, a spacing <= 0 or a value that is not finite.
    """
    if not spacing > 0.0:
        raise ValueError(f"spacing must be positive, got {spacing}")
    columns = [np.asarray(column, dtype=np.float64) for column in (x_upper, z_lower, z_upper, force_z, force_x)]
    if not all(np.all(np.isfinite(column)) for column in columns):
        raise ValueError("positions and forces of a profile must be finite")
    if [len(shape) for shape in {column.shape for column in columns}] != [1]:
        raise ValueError(f"positions and forces must be 1-D and equally long: {[c.shape for c in columns]}")
    order = np.argsort(columns[0], kind="stable")
    x, lower, upper, normal, tangential = (column[order] for column in columns)
    return Profile(x, lower, upper, normal / spacing, tangential / spacing)


def mean_pressure(profile: Profile, spacing: float, radius: float) -> float:
    """Return F / (pi a^2), the mean pressure of the three-dimensional contact that the model represents [FU/LU^2].

    spacing of the particles [LU]; radius: contact radius a [LU]. F is the whole normal force, compression positive,
    tension beyond a included, because that is the force of Eq. (8). This is the paper's mean pressure: for R = 1000, a
    = 35 and the row R = 1000 of Table 1, F = 1.950 F_A = 2.867 FU and F / (pi a^2) = 7.45e-4 FU/LU^2 = 784 MPa (paper:
    about 800 MPa), while F / (2 a) has no unit of a pressure. Source: Geike and Popov 2007, Section 4. Valid for one
    contact. Raises ValueError for a radius <= 0: a contact of no extent has no mean pressure.
    """
    if not radius > 0.0:
        raise ValueError(f"a mean pressure needs a contact radius above 0, got {radius}")
    return float(spacing * np.sum(profile.pressure)) / (math.pi * radius**2)


def penetration_depth(x_upper: ArrayLike, z_upper: ArrayLike, x_lower: ArrayLike, z_lower: ArrayLike) -> float:
    """Return the largest depth [LU], >= 0, of an upper particle below the straight lines between the lower particles.

    It is 0 where none is below, or there is no upper particle. Particles beyond the ends of the lower body do not
    count. The paper names interpenetration as the limit of a model of one layer (Section 5).

    Args:
        x_upper, z_upper: upper particles [LU], (n,).
        x_lower, z_lower: lower particles in any order [LU], (m,), m >= 1.
    """
    surface = np.interp(np.asarray(x_upper), *_sorted_by_x(x_lower, z_lower), left=-np.inf, right=-np.inf)
    return float(np.max(surface - np.asarray(z_upper), initial=0.0))


def smallest_distance(x_upper: ArrayLike, z_upper: ArrayLike, x_lower: ArrayLike, z_lower: ArrayLike) -> float:
    """Return min_ij |r_i - r_j| [LU], the smallest distance of the centres of upper particles i and lower particles j.

    The next lower particle along x gives a first distance for each upper one, and only pairs within it along x are
    examined: for chains a few.

    Args:
        x_upper, z_upper: upper particles in any order [LU], (n,).
        x_lower, z_lower: lower particles in any order [LU], (m,).

    Raises:
        ValueError: a body has no particle, or a position is not finite.
    """
    (across, height), (x, z) = _sorted_by_x(x_upper, z_upper), _sorted_by_x(x_lower, z_lower)
    if not (across.size and x.size):
        raise ValueError("a distance between the bodies needs a particle in each of them")
    if not all(np.isfinite(row).all() for row in (across, height, x, z)):
        raise ValueError("the positions of particles must be finite")
    following = np.searchsorted(x, across)
    least = float(np.hypot(across - x.take(following, mode="clip"), height - z.take(following, mode="clip")).min())
    near = np.maximum(height - z.max(), z.min() - height) < least  # no other one can have a smaller distance
    across, height = across[near], height[near]
    first, end = np.searchsorted(x, across - least), np.searchsorted(x, across + least, side="right")
    for step in range(int((end - first).max(initial=0))):
        lower = first + step
        distances = np.hypot(across - x.take(lower, mode="clip"), height - z.take(lower, mode="clip"))
        least = min(least, float(distances.min()))
    return least


def _sorted_by_x(x: ArrayLike, z: ArrayLike) -> tuple[Array, Array]:
    """Return copies of positions x and heights z, (n,) each, sorted by x; those of equal x keep their order."""
    x, z = np.asarray(x, dtype=np.float64), np.asarray(z, dtype=np.float64)
    rising = np.argsort(x, kind="stable")
    return x[rising], z[rising]


def end_pressure_share(profile: Profile) -> float:
    """Return max(|p_first|, |p_last|) / max |p|, between 0 and 1 [-]; 0 where there is no pressure at the ends.

    Far below 1e-3 the chain is long enough: "the contact region should be smaller than the chain" (paper, Section 4).
    """
    ends = max(map(abs, profile.pressure[[0, -1]].tolist()))
    return ends / float(np.abs(profile.pressure).max()) if ends else 0.0


def spacing_of(x: Array) -> float:
    """Return the mean distance of neighbours, in the unit of x, of rising positions x, (n,), n >= 1.

    0 for one position; ValueError for none.
    """
    return float(np.ptp(x)) / max(x.size - 1, 1)


def left_out(law: DoubleExponential, table: Table, profile: Profile) -> float:
    """Return Σ |F_table(r) - f(r)| |z|/r [FU], the truncation and table error of an interaction in a state, >= 0.

    The sum is over all pairs of an upper and a lower particle, with the distance r and the height difference z, up to
    the cutoff plus five times the longest range; pairs nearer than the core of the table count at its core. Summed
    offset by offset along the chain: memory for one row of pairs.

    Args:
        law: the exact pair potential, f(r) [FU].
        table: its force as LAMMPS has it, 0 beyond the cutoff [FU].
        profile: the state; particles are evenly spaced, two at least.
    """
    reach = table.cutoff + 5.0 * law.longest_range  # with all but a share exp(-5) of the tail
    x, lower, upper = profile.x, profile.z_lower, profile.z_upper
    spacing = spacing_of(x)
    near = np.flatnonzero(upper - lower < reach)
    total = 0.0
    farthest = int(reach / spacing)
    for offset in range(-farthest, farthest + 1):
        first = near[(near + offset >= 0) & (near + offset < len(x))]
        across, up = x[first + offset] - x[first], upper[first] - lower[first + offset]
        r = np.maximum(np.hypot(across, up), table.core)
        kept = np.where(r <= table.cutoff, table.force(np.minimum(r, table.cutoff)), 0.0)
        total += float(np.sum(np.where(r < reach, np.abs(kept - law.force(r)) * np.abs(up) / r, 0.0)))
    return total
