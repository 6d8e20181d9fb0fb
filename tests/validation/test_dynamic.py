"""Claim: `method = "dynamic"`, the paper's own way, gives the equilibria and the pull-off force of the model.

Reference: `analysis.reference`, energy minimisation in numpy/scipy without time, plate, damping or LAMMPS. Asked for:
within 1 %.

What limits the agreement. The pull-off force: the bracket between the largest tension that held and the smallest that
broke the contact, one tolerance wide. The critical radius: force control never sees the pull-off itself; near it the
radius goes with √(F_A − F), so a bracket of 1e-3 leaves 3 % of the way from a₀ to a_cr to an extrapolation. A load:
what is left of the motion when it counts as rest, a tenth of the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from analysis.reference.interaction import Exponential, PairInteraction
from analysis.reference.model import ChainModel
from analysis.reference.pull_off import pull_off
from analysis.reference.solver import ChainSolver, State, trace
from analysis.reference.tension_radius import tension_radius
from workflow import Run

RunTables = Callable[[dict[str, Any]], Run]
Term = tuple[float, float]

FORCE = 1e-3
"""Relative: the tolerance of the scenes; measured 1e-4. Asked for: 1 %."""
ZERO_LOAD_RADIUS = 1e-3
"""Relative; measured 2e-4: rest at F = 0 within a tenth of the tolerance, and the interpolation between particles."""
CRITICAL_RADIUS = 1e-2
"""Relative; measured 5e-3: the extrapolation from the last tensions that held, and what was asked for."""
LOAD_DISPLACEMENT = 1e-4
"""[LU]; a tenth of the tolerance of a load of half the pull-off force over the contact's stiffness; measured 2e-5."""
LOAD_RADIUS = 2e-3
"""Relative; measured 1e-3, where the dip is five spacings from the middle and few particles wide."""
STENCIL = 9
STIFFNESS = 0.83
SHORT: tuple[Term, Term, float] = ((0.18, 0.13), (0.09, 0.26), 200.0)
LONG: tuple[Term, Term, float] = ((0.4, 0.25), (0.2, 0.5), 50.0)
"""Repulsion, attraction and radius of contacts that are as small as they can be and still many particles wide."""
PLAIN: tuple[float, bool] = (0.0, False)
BOTH: tuple[float, bool] = (0.3, True)
"""Stiffness of the neighbour springs, and whether particles may move along x."""


def tables(law: tuple[Term, Term, float], effects: tuple[float, bool], experiment: dict[str, Any]) -> dict[str, Any]:
    """A dynamic scene; damping, plate, chain and time step are left open."""
    scene: dict[str, Any] = {
        "bodies": {
            "particles": "auto",
            "spacing": 1.0,
            "profile": {"kind": "parabola", "radius": law[2]},
            "bulk_stiffness": STIFFNESS,
        },
        "interaction": {
            "repulsion": {"amplitude": law[0][0], "range": law[0][1]},
            "attraction": {"amplitude": law[1][0], "range": law[1][1]},
        },
        "damping": {"coefficient": "auto"},
        "plate": {},
        "experiment": {"method": "dynamic"} | experiment,
    }
    if effects[0]:
        scene["neighbours"] = {"stiffness": effects[0]}
    if effects[1]:
        scene["horizontal"] = {}
    return scene


def model_of(law: tuple[Term, Term, float], effects: tuple[float, bool], finished: Run) -> ChainModel:
    """The same chains for the reference."""
    return ChainModel(
        finished.outcome.states[0].profile.x.size,
        STIFFNESS,
        PairInteraction(Exponential(*law[0]), Exponential(*law[1])),
        radius=law[2],
        neighbour_stiffness=effects[0],
        horizontal=effects[1],
    )


def radius(model: ChainModel, state: State) -> float:
    """Radius of the largest tension over the places where the upper particles are [LU]."""
    return tension_radius(model.places() + state.upper[:, 0], state.pair_force[:, 1] / model.spacing, STENCIL)


@pytest.mark.parametrize("law", [SHORT, LONG], ids=["range 0.26", "range 0.5"])
@pytest.mark.parametrize("effects", [PLAIN, BOTH], ids=["plain", "neighbours horizontal"])
def test_pull_off(run_tables: RunTables, law: tuple[Term, Term, float], effects: tuple[float, bool]) -> None:
    finished = run_tables(tables(law, effects, {"kind": "pull_off", "preload": 0.5}))
    found, model = finished.outcome.quantities, model_of(law, effects, finished)
    exact = pull_off(model, 0.5, step=0.25 * law[0][1])
    assert found["adhesion_force"].value == pytest.approx(exact.adhesion_force, rel=FORCE)
    assert found["zero_load_radius"].value == pytest.approx(radius(model, exact.zero_load), rel=ZERO_LOAD_RADIUS)
    assert found["critical_radius"].value == pytest.approx(radius(model, exact.critical), rel=CRITICAL_RADIUS)
    covered = abs(found["adhesion_force"].value - exact.adhesion_force) <= found["adhesion_force"].uncertainty
    assert covered
    assert found["adhesion_force"].uncertainty < 1e-3 * exact.adhesion_force


@pytest.mark.parametrize("force", [0.5, -0.5])
@pytest.mark.parametrize("effects", [PLAIN, BOTH], ids=["plain", "neighbours horizontal"])
def test_load(run_tables: RunTables, effects: tuple[float, bool], force: float) -> None:
    finished = run_tables(tables(LONG, effects, {"kind": "load", "force": force}))
    found, model = finished.outcome.quantities, model_of(LONG, effects, finished)
    exact = equilibrium_under(model, force)
    assert abs(found["displacement"].value - exact.displacement) < LOAD_DISPLACEMENT
    assert abs(found["displacement"].value - exact.displacement) <= found["displacement"].uncertainty
    assert found["force"].value == pytest.approx(force, abs=found["force"].uncertainty)
    assert found["contact_radius"].value == pytest.approx(radius(model, exact), rel=LOAD_RADIUS)


@pytest.mark.parametrize("mass", [5.0, 500.0])
def test_equilibrium_does_not_depend_on_inertia_and_damping(run_tables: RunTables, mass: float) -> None:
    """A plate that swings for long, and one that creeps, end in the same place."""
    scene = tables(LONG, PLAIN, {"kind": "load", "force": 0.5})
    scene |= {"damping": {"coefficient": 0.1}, "plate": {"mass": mass, "damping": 0.5}}
    finished = run_tables(scene)
    exact = equilibrium_under(model_of(LONG, PLAIN, finished), 0.5)
    assert abs(finished.outcome.quantities["displacement"].value - exact.displacement) < LOAD_DISPLACEMENT


def equilibrium_under(model: ChainModel, force: float) -> State:
    """The reference's state under a force; these contacts do not snap, so there is one."""
    start, solver = trace(model, np.arange(-1.0, 0.3, 0.05))[-1], ChainSolver(model)
    place = brentq(lambda d: solver.equilibrium(d, start).force - force, 0.1, 0.65, xtol=1e-10)
    return solver.equilibrium(float(place), start)
