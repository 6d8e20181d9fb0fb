"""The particle model as data: two tethered chains (or one chain on a rigid plane) that press on each other.

Undeformed places: x_i = (i - (N-1)/2) s, lower z = 0, upper z = r0 + profile(x_i) - d, with the displacement d counted
positive in compression and r0 the distance at which one opposite pair is force-free.
"""

from typing import NamedTuple

import numpy as np

from validation.references.interaction import Floats, PairInteraction


class ChainModel(NamedTuple):
    """Everything that fixes the energy of the model except the displacement.

    Args:
        particles: N, per chain.
        bulk_stiffness: k, each particle to its own bulk, normal direction [FU/LU].
        interaction: between particles of opposite bodies; None exactly if `rigid_plane`.
        radius: R of the parabola x^2/2R on the upper body [LU]. Give this or `heights`.
        heights: any other profile of the upper body, shape (N,) [LU], measured upwards.
        spacing: s [LU].
        neighbour_stiffness: k_n of isotropic springs between neighbours of one chain [FU/LU]; 0: none.
        horizontal: whether particles may also move along x.
        tangential_stiffness: k_t of the bulk springs along x [FU/LU]; None: the same as `bulk_stiffness`.
        rigid_plane: one chain on a frictionless rigid plane at z = 0; then r0 = 0. The plane acts along z only, so
            with or without `horizontal` nothing moves along x.
    """

    particles: int
    bulk_stiffness: float
    interaction: PairInteraction | None = None
    radius: float | None = None
    heights: Floats | None = None
    spacing: float = 1.0
    neighbour_stiffness: float = 0.0
    horizontal: bool = False
    tangential_stiffness: float | None = None
    rigid_plane: bool = False

    def places(self) -> Floats:
        """Return the undeformed x of both chains, (i - (N-1)/2) s, shape (N,) [LU]."""
        return (np.arange(self.particles, dtype=np.float64) - 0.5 * (self.particles - 1)) * self.spacing

    def profile(self) -> Floats:
        """Return the undeformed heights of the upper body over its apex plane, x^2/2R or as given, shape (N,) [LU]."""
        if self.heights is not None:
            return np.array(self.heights)
        assert self.radius is not None
        return self.places() ** 2 / (2.0 * self.radius)

    def undeformed_gap(self, displacement: float) -> Floats:
        """Return r0 + profile - d, shape (N,) [LU]; `displacement` d [LU]; r0 is 0 on a rigid plane."""
        apart = 0.0 if self.interaction is None else self.interaction.force_free_distance()
        return apart + self.profile() - displacement
