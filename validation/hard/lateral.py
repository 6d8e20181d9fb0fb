"""Aligned chains with freedom along x on a path: where an equilibrium loses its stability along x, the chain jumps.

Followed in fine steps by the independent solver, the upper chain jumps along x if the largest move of a particle in one
step does not shrink with the step. Such a path has more than one answer at a displacement, and which one a run has
depends on its steps: it is to be named. Tangential springs that hold the chains leave one answer, and no warning.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from validation.doors import law_table
from validation.references.interaction import Floats, PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver
from validation.row import Row, at_most, so
from validation.study import Bench, Findings, Refused, Study, said

WARNING = "buckling"
LAW = (0.0916, 0.451, 0.0675, 0.597)
"""A, a, B, b [FU·LU, LU] of the interaction."""
PARTICLES, RADIUS, SPACING, FIRST, LAST = 7, 1.72, 2.0, -2.498, 0.6825
"""Of each body; R, s, first and last displacement [LU]."""
SPRINGS = {"free": (0.00279, None), "held along x": (0.00279, 0.05), "stiff": (0.02, None)}
"""k and k_t [FU/LU]; None: as k."""
STEPS, FULL_STEPS = (20, 160), (20, 40, 80, 160, 320)
FINE, HALVED, MOVED = 400, 0.75, 0.06
"""Steps of the solver; a jump is a move of a particle along x in one step that is larger than this share of that in a
step twice as wide, and than this [LU], a tenth of the attraction's range."""
FORCE = 1e-3
"""Of the largest force: the tolerance of the scene."""
SNAP = 0.02
"""Change of the force in a step of the solver, over the largest force, that is a snap."""
SOURCE = "the independent solver"


def measure(bench: Bench) -> Findings:
    """Whether a run says what the solver finds; the force at each load step where there is one answer."""
    rows: list[Row] = []
    for name, (stiffness, along) in SPRINGS.items():
        coarse, _, _ = _followed(stiffness, along, FINE)
        fine, places, forces = _followed(stiffness, along, 2 * FINE)
        jumps = fine > max(MOVED, HALVED * coarse)
        for steps in FULL_STEPS if bench.full else STEPS:
            run = bench.run(f"{name.split()[0]}_{steps}", _scene(stiffness, along, steps))
            if isinstance(run, Refused):
                rows.append(so(f"{name}, {steps} steps: refused", wrong=True, limited_by=said("–", run)))
                continue
            words = "no warning says that the chain jumps along x" if jumps else "a warning of what does not happen"
            rows.append(so(f"{name}, {steps} steps: {words}", jumps != (WARNING in run.warnings), SOURCE))
            if not jumps:
                d, force = (np.asarray(column)[: steps + 1] for column in (run.curve.displacement, run.curve.force))
                off = _off(d, force, places, forces)
                rows.append(at_most(f"{name}, {steps} steps: force off over the largest", off, FORCE, SOURCE))
    return Findings(rows)


def _off(d: Floats, force: Floats, places: Floats, forces: Floats) -> float:
    """Largest difference of the forces over the largest, without load steps beside a snap of pairs along z."""
    largest = float(np.abs(forces).max())
    snaps = np.abs(np.diff(forces)) > SNAP * largest
    near = np.zeros(d.size, dtype=bool)
    for at in np.flatnonzero(snaps).tolist():
        near |= (d >= places[max(at - 1, 0)]) & (d <= places[min(at + 2, places.size - 1)])
    return float(np.abs(force - np.interp(d, places, forces))[~near].max() / largest)


def _scene(stiffness: float, along: float | None, steps: int) -> dict[str, Any]:
    """There and back."""
    bodies = {"particles": PARTICLES, "spacing": SPACING, "profile": {"kind": "parabola", "radius": RADIUS},
              "bulk_stiffness": stiffness}  # fmt: skip
    bodies |= {} if along is None else {"bulk_stiffness_tangential": along}
    way = {"from": FIRST, "to": LAST, "steps": steps}
    experiment = {"kind": "path", "displacements": way}
    return {"bodies": bodies, "interaction": law_table(*LAW), "horizontal": {}, "experiment": experiment}


def _followed(stiffness: float, along: float | None, steps: int) -> tuple[float, Floats, Floats]:
    """The largest move of a particle along x in one of the steps [LU], displacements [LU] and forces [FU]."""
    model = ChainModel(
        PARTICLES, stiffness, PairInteraction.of(*LAW), radius=RADIUS, spacing=SPACING, horizontal=True,
        tangential_stiffness=along,
    )  # fmt: skip
    solver, state, places, forces = ChainSolver(model), None, [], []
    displacements = np.linspace(FIRST, LAST, steps + 1)
    for displacement in displacements:
        state = solver.equilibrium(float(displacement), state)
        places.append(np.concatenate([state.lower[:, 0], state.upper[:, 0]]))
        forces.append(state.force)
    return float(np.abs(np.diff(places, axis=0)).max()), displacements, np.asarray(forces)


LATERAL = Study(
    "lateral",
    "Aligned chains that buckle along x on a path",
    "A chain that loses its stability along x between two load steps ends in a state that depends on the steps. Does "
    "the run warn of it, and only then?",
    measure,
)
