"""The potential energy of two tethered chains with its analytic gradient and banded Hessian.

U = sum_p [k_t u_px^2 + k u_pz^2]/2 + (k_n/2) sum_neighbours |u_p - u_q|^2 + sum_(lower i, upper j) V(r_ij),
u the displacement of a particle from its undeformed place and r_ij the distance in the plane.
"""

import math

import numpy as np
from numpy.typing import NDArray

from validation.references.interaction import Floats
from validation.references.model import ChainModel

REACH = 40.0
"""Pairs further apart along the chain than this many ranges are left out: exp(-40) = 4e-18."""


class EnergySurface:
    """U and its derivatives for one model, as functions of the degrees of freedom and the displacement d.

    Degrees of freedom are ordered by particle, then body (lower, upper), then direction ((x,) z), so the Hessian is
    banded. They are passed flat, shape (dofs,) [LU], with dofs = 2 N without and 4 N with horizontal freedom.

    Args:
        model: two chains with an interaction.

    Raises:
        ValueError: for a model on a rigid plane, which has a constraint in place of an interaction.
    """

    def __init__(self, model: ChainModel) -> None:
        """List the interacting pairs and the places of their terms in the band."""
        if model.interaction is None:
            raise ValueError("a rigid plane has no interaction energy; use solve_rigid_plane")
        self.model = model
        self.directions = 2 if model.horizontal else 1
        self.dofs = 2 * self.directions * model.particles
        k_z, k_x = model.bulk_stiffness, model.tangential_stiffness or model.bulk_stiffness
        self.law = model.interaction
        self._tether = np.array([k_x, k_z])[2 - self.directions :]
        self._gap_at_touch = model.undeformed_gap(0.0)
        self._offset = min(max(2, math.ceil(REACH * self.law.longest_range / model.spacing) + 1), model.particles - 1)
        pairs = np.arange(model.particles)[:, None] + np.arange(-self._offset, self._offset + 1)[None, :]
        inside = (pairs >= 0) & (pairs < model.particles)
        self.lower: NDArray[np.intp] = np.nonzero(inside)[0]
        self.upper: NDArray[np.intp] = pairs[inside]
        self._lattice_dx = np.asarray((self.upper - self.lower) * model.spacing, dtype=np.float64)
        self.bandwidth = min(2 * self.directions * (self._offset + 1), self.dofs) - 1

    def separations(self, u: Floats, displacement: float) -> tuple[Floats, Floats, Floats]:
        """Return x_upper - x_lower, z_upper - z_lower and the distance of every listed pair, each (pairs,) [LU].

        Args:
            u: degrees of freedom, shape (dofs,) [LU].
            displacement: d [LU].
        """
        v = u.reshape(self.model.particles, 2, self.directions)
        dz = self._gap_at_touch[self.upper] - displacement + v[self.upper, 1, -1] - v[self.lower, 0, -1]
        dx = self._lattice_dx
        if self.directions == 2:
            dx = dx + v[self.upper, 1, 0] - v[self.lower, 0, 0]
        return dx, dz, np.maximum(np.hypot(dx, dz), 1e-300)

    def energy_gradient(self, u: Floats, displacement: float) -> tuple[float, Floats]:
        """Return U [FU LU] and dU/du, shape (dofs,) [FU]; arguments as for `separations`."""
        v = u.reshape(self.model.particles, 2, self.directions)
        stretch = np.diff(v, axis=0)
        k_n = self.model.neighbour_stiffness
        dx, dz, r = self.separations(u, displacement)
        potential, force, _ = self.law.evaluate(r)
        energy = 0.5 * np.sum(self._tether * v**2) + 0.5 * k_n * np.sum(stretch**2) + np.sum(potential)
        gradient = self._tether * v
        gradient[:-1] -= k_n * stretch
        gradient[1:] += k_n * stretch
        for axis, component in enumerate((dx, dz)[2 - self.directions :]):
            on_upper = force * component / r
            gradient[:, 1, axis] -= self._sum_over(self.upper, on_upper)
            gradient[:, 0, axis] += self._sum_over(self.lower, on_upper)
        return float(energy), gradient.ravel()

    def pair_force(self, u: Floats, displacement: float) -> Floats:
        """Return the force of the lower chain on each upper particle, columns x and z, shape (N, 2) [FU]."""
        dx, dz, r = self.separations(u, displacement)
        force = self.law.force(r) / r
        return np.column_stack([self._sum_over(self.upper, force * component) for component in (dx, dz)])

    def hessian(self, u: Floats, displacement: float) -> Floats:
        """Return d2U/du2 in lower band storage, H[i+b, i] at [b, i], shape (bandwidth + 1, dofs) [FU/LU].

        With n the unit vector of a pair its block is K = -f' n n^T - (f/r)(1 - n n^T).
        """
        dx, dz, r = self.separations(u, displacement)
        _, force, slope = self.law.evaluate(r)
        normal = (dx / r, dz / r)[2 - self.directions :]
        band = np.zeros((self.bandwidth + 1, self.dofs))
        for row in range(self.directions):
            for column in range(self.directions):
                block = (force / r - slope) * normal[row] * normal[column] - (force / r if row == column else 0.0)
                self._add_pair_terms(band, row, column, block)
        # The springs to the bulk and between neighbours, both constant.
        c, k_n = self.directions, self.model.neighbour_stiffness
        band[0] += np.tile(self._tether, 2 * self.model.particles)
        if k_n > 0.0 and self.model.particles > 1:
            band[0, 2 * c :] += k_n
            band[0, : -2 * c] += k_n
            band[2 * c, : -2 * c] -= k_n
        return band

    def _sum_over(self, index: NDArray[np.intp], weights: Floats) -> Floats:
        """Return the sum of the weights of the pairs of each particle, shape (N,)."""
        return np.asarray(np.bincount(index, weights, minlength=self.model.particles), dtype=np.float64)

    def _add_pair_terms(self, band: Floats, row: int, column: int, block: Floats) -> None:
        """Put one component of all pair blocks into the band: +K within a body, -K between the bodies."""
        c = self.directions
        lower = 2 * c * self.lower + row
        upper = 2 * c * self.upper + c + column
        band[np.abs(upper - lower), np.minimum(upper, lower)] = -block
        if row >= column:
            band[row - column, column :: 2 * c] += self._sum_over(self.lower, block)
            band[row - column, c + column :: 2 * c] += self._sum_over(self.upper, block)
