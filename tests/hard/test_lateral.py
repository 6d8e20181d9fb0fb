"""Claim: a path on which aligned chains jump along x, from step to step to another state, is warned of, and no other.

Reference: the independent solver. The chains jump where the largest move of a particle in one of its steps does not
shrink with the step. Springs that hold them along x leave one answer at each displacement, which the run has.
"""

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import run
from tests.scenes import chains
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver

Array = NDArray[np.float64]
LAW = (0.0916, 0.451, 0.0675, 0.597)
PARTICLES, RADIUS, SPACING, FIRST, LAST = 7, 1.72, 2.0, -2.498, 0.6825
FINE, HALVED, MOVED = 400, 0.75, 0.06
"""Steps of the solver; a jump is a move in a step beyond this share of that in one twice as wide, and this [LU]."""
FORCE, SNAP = 1e-3, 0.02
"""Over the largest force: the tolerance of the scene; a change in a step of the solver that is a snap along z."""


def followed(stiffness: float, along: float, steps: int) -> tuple[float, Array, Array]:
    """The largest move of a particle along x in one of the steps, displacements and forces."""
    model = ChainModel(
        PARTICLES, stiffness, PairInteraction.of(*LAW), radius=RADIUS, spacing=SPACING, horizontal=True,
        tangential_stiffness=along,
    )  # fmt: skip
    solver, states = ChainSolver(model), []
    displacements = np.linspace(FIRST, LAST, steps + 1)
    for d in displacements:
        states.append(solver.equilibrium(float(d), states[-1] if states else None))
    places = np.array([np.concatenate([state.lower[:, 0], state.upper[:, 0]]) for state in states])
    return float(np.abs(np.diff(places, axis=0)).max()), displacements, np.array([state.force for state in states])


@pytest.mark.parametrize(
    ("stiffness", "along", "jump"), [(0.00279, 0.00279, True), (0.00279, 0.05, False), (0.02, 0.02, False)]
)
@pytest.mark.slow
def test_a_jump_along_x_is_warned_of_and_nothing_else(stiffness: float, along: float, jump: bool) -> None:
    coarse, (fine, places, forces) = followed(stiffness, along, FINE)[0], followed(stiffness, along, 2 * FINE)
    assert (fine > max(MOVED, HALVED * coarse)) == jump
    largest = np.abs(forces).max()
    snaps = np.flatnonzero(np.abs(np.diff(forces)) > SNAP * largest)
    bodies = {"particles": PARTICLES, "spacing": SPACING, "bulk_stiffness_tangential": along}
    for steps in (20, 40, 80, 160, 320):
        found = run(chains(
            RADIUS, stiffness, LAW, bodies=bodies, horizontal={},
            experiment={"kind": "path", "displacements": {"from": FIRST, "to": LAST, "steps": steps}},
        ))  # fmt: skip
        assert ("buckling" in found.warnings) == jump
        d, force = found.curve.displacement[: steps + 1], found.curve.force[: steps + 1]
        beside = [(d >= places[max(at - 1, 0)]) & (d <= places[at + 2]) for at in snaps]
        off = np.abs(force - np.interp(d, places, forces))[~np.any(beside, axis=0)]
        assert jump or off.max() <= FORCE * largest
