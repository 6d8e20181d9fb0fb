"""Equilibria of the particle model along a path of displacements, by minimisation of its energy alone.

dU/du = 0 and d2U/du2 > 0 at each displacement d; F(d) = sum over the upper chain of k u_z, positive in compression.

Which equilibrium. Each minimisation starts from the state before, moved rigidly with its body, and goes downhill in
short steps, so a solution is followed until it ends in a fold and then left the way a slow overdamped motion leaves it.
Aligned chains that carry load are an exception: a pair of opposite particles at the distance r with the force f is
unstable sideways where k_t < 2 f/r, and nothing in the model says to which side it goes. The exactly symmetric state
is then a saddle, which is not kept; the upper chain slips towards +x, but which particles slip together depends on the
step of the path and on the solver. In that regime the branch is one of many, not the solution.
"""

import math
from collections.abc import Iterable
from functools import partial
from typing import NamedTuple

import numpy as np

from validation.references.energy import EnergySurface
from validation.references.interaction import Floats
from validation.references.model import ChainModel
from validation.references.newton import Descent, minimise
from validation.references.rigid_plane import contact_on_rigid_plane

GRADIENT_TOLERANCE = 1e-10
"""Largest force left on a particle over bulk stiffness times the shortest range."""
STEP_LIMIT = 0.05
"""Largest motion of a particle in one iteration [LU]."""
STEP_LIMIT_IN_RANGES = 0.2
"""The same, over the shortest range; the smaller one counts."""
MOVE_LIMIT_IN_RANGES = 0.25
"""Largest change of the displacement between two minimisations, over the shortest range."""


class State(NamedTuple):
    """One equilibrium.

    Args:
        displacement: d, compression positive [LU].
        force: on the upper bulk, compression positive [FU].
        pair_force: force of the opposite body on each upper particle, columns x and z, shape (N, 2) [FU].
        lower: displacements of the lower particles from their undeformed places, columns x and z, shape (N, 2) [LU].
            All zero on a rigid plane.
        upper: the same for the upper particles.
        smallest_distance: between particles of opposite bodies, or to the rigid plane [LU].
        energy: U [FU LU].
    """

    displacement: float
    force: float
    pair_force: Floats
    lower: Floats
    upper: Floats
    smallest_distance: float
    energy: float


class ChainSolver:
    """Finds equilibria of one model; holds the pair list, so that a path builds it once.

    Args:
        model: what is solved; two chains, or one on a rigid plane.
    """

    def __init__(self, model: ChainModel) -> None:
        """Prepare the energy surface and the limits of the descent."""
        self.model = model
        self.surface = None if model.interaction is None else EnergySurface(model)

    def equilibrium(self, displacement: float, start: State | None = None) -> State:
        """Return the equilibrium at `displacement` reached from `start`.

        The way from `start` is divided into moves of at most a quarter of the shortest range. Without a start the
        chains begin undeformed at the displacement, or at 0 where the displacement is positive. On a rigid plane the
        equilibrium is unique and the start does not matter.

        Args:
            displacement: d [LU].
            start: an equilibrium of the same model, or None.

        Raises:
            RuntimeError: if a minimisation does not converge.
        """
        surface = self.surface
        if surface is None:
            return self._on_rigid_plane(displacement)
        c, reach = surface.directions, surface.law.shortest_range
        if start is None:
            d, u = min(displacement, 0.0), np.zeros(surface.dofs)
        else:
            d, u = start.displacement, np.stack([start.lower, start.upper], axis=1)[:, :, 2 - c :].ravel()
        descent = Descent(
            step_limit=min(STEP_LIMIT, STEP_LIMIT_IN_RANGES * reach),
            gradient_tolerance=GRADIENT_TOLERANCE * self.model.bulk_stiffness * reach,
            preferred=_slip(self.model, c),
        )
        moves = max(1, math.ceil(abs(displacement - d) / (MOVE_LIMIT_IN_RANGES * reach)))
        targets = np.linspace(d, displacement, moves + 1).tolist()
        for target in targets if start is None else targets[1:]:
            energy_gradient = partial(surface.energy_gradient, displacement=target)
            u = minimise(energy_gradient, partial(surface.hessian, displacement=target), u, descent)
        places = np.zeros((self.model.particles, 2, 2))
        places[:, :, 2 - c :] = u.reshape(self.model.particles, 2, c)
        return State(
            displacement=displacement,
            force=float(self.model.bulk_stiffness * np.sum(places[:, 1, 1])),
            pair_force=surface.pair_force(u, displacement),
            lower=places[:, 0],
            upper=places[:, 1],
            smallest_distance=float(np.min(surface.separations(u, displacement)[2])),
            energy=surface.energy_gradient(u, displacement)[0],
        )

    def _on_rigid_plane(self, displacement: float) -> State:
        """Return the unique contact of one chain with the plane."""
        model = self.model
        gap = model.undeformed_gap(displacement)
        k, k_n = model.bulk_stiffness, model.neighbour_stiffness
        lift, reaction = contact_on_rigid_plane(gap, k, k_n)
        still = np.zeros_like(lift)
        return State(
            displacement=displacement,
            force=float(k * np.sum(lift)),
            pair_force=np.column_stack([still, reaction]),
            lower=np.zeros((model.particles, 2)),
            upper=np.column_stack([still, lift]),
            smallest_distance=float(np.min(gap + lift)),
            energy=float(0.5 * k * np.sum(lift**2) + 0.5 * k_n * np.sum(np.diff(lift) ** 2)),
        )


def trace(model: ChainModel, displacements: Iterable[float], start: State | None = None) -> list[State]:
    """Return the equilibria along a path, each reached from the one before it.

    Args:
        model: two chains, or one on a rigid plane.
        displacements: in the order in which they are visited [LU].
        start: where the path begins; None: undeformed, see `ChainSolver.equilibrium`.

    Raises:
        RuntimeError: if a minimisation does not converge.
    """
    solver = ChainSolver(model)
    states = []
    for displacement in displacements:
        start = solver.equilibrium(float(displacement), start)
        states.append(start)
    return states


def _slip(model: ChainModel, directions: int) -> Floats:
    """Return the preferred way off a saddle: upper chain to +x and up, lower one the other way, slightly uneven.

    The unevenness (a fixed irrational sequence) keeps the direction from being orthogonal to any soft mode.
    """
    uneven = np.modf(np.arange(1, model.particles + 1) * 0.5 * (math.sqrt(5.0) - 1.0))[0]
    pattern: Floats = np.ones((model.particles, 2, directions)) + 1e-3 * uneven[:, None, None]
    pattern[:, 0] *= -1.0
    return pattern.ravel()
