"""Claim: `method = "dynamic"`, the paper's own way, gives the equilibria and the pull-off force of the model.

Reference: `validation.references`, energy minimisation in numpy/scipy without time, plate, damping or LAMMPS. Asked:
within 1 %.

What limits the agreement. The pull-off force: the bracket between the largest tension that held and the smallest that
broke the contact, one tolerance wide. The critical radius: force control never sees the pull-off itself; near it the
radius goes with √(F_A − F), so a bracket of 1e-3 leaves 3 % of the way from a₀ to a_cr to an extrapolation. A load:
what is left of the motion when it counts as rest, a tenth of the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from contact1d import Run
from contact1d.workflow.continuation.outcome import Result
from tests.scenes import chains
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off
from validation.references.solver import ChainSolver, State, trace
from validation.references.tension_radius import tension_radius

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
NEAR_PULL_OFF = 0.01
"""Relative: what may be claimed of a radius within 3e-4 of the pull-off, where it goes with √(F_A − F)."""
SNAPPING, SNAP_STEP, SNAPS_RADIUS = 0.05, 0.004, 4.0
"""Bulk stiffness with which pairs snap [FU/LU]; the reference's step, finer than a tooth [LU]; a radius there is known
to a few spacings only [LU]."""
NEARLY_SNAPPING = 0.9
"""Steepest attraction of a pair over the stiffness of its springs in series; it snaps at 1."""
CHAIN, SNAPPING_CHAIN = 160, 80
STENCIL = 9
STIFFNESS = 0.83
SHORT: tuple[Term, Term, float] = ((0.18, 0.13), (0.09, 0.26), 200.0)
LONG: tuple[Term, Term, float] = ((0.4, 0.25), (0.2, 0.5), 50.0)
"""Repulsion, attraction and radius of contacts that are as small as they can be and still many particles wide."""
PLAIN: tuple[float, bool] = (0.0, False)
BOTH: tuple[float, bool] = (0.3, True)
BOTH_VERTICAL: tuple[float, bool] = (0.3, False)
STIFF: tuple[float, bool] = (1.0, False)
"""Independent pairs, from which the first tensions follow, are off here: it is the bracket that makes the number."""
"""Stiffness of the neighbour springs, and whether particles may move along x."""


def tables(law: tuple[Term, Term, float], effects: tuple[float, bool], experiment: dict[str, Any]) -> dict[str, Any]:
    """A dynamic scene; damping, plate, chain and time step are left open."""
    scene = chains(
        law[2],
        STIFFNESS,
        (*law[0], *law[1]),
        damping={"coefficient": "auto"},
        plate={},
        experiment={"method": "dynamic"} | experiment,
    )
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


def vertical_model(
    law: tuple[Term, Term, float], neighbours: float, stiffness: float = STIFFNESS, count: int = CHAIN
) -> ChainModel:
    """A chain that is long enough, whatever the program would take."""
    terms = PairInteraction(Exponential(*law[0]), Exponential(*law[1]))
    return ChainModel(count, stiffness, terms, radius=law[2], neighbour_stiffness=neighbours)


def radius(model: ChainModel, state: State) -> float:
    """Radius of the largest tension over the places where the upper particles are [LU]."""
    return tension_radius(model.places() + state.upper[:, 0], state.pair_force[:, 1] / model.spacing, STENCIL)


@pytest.mark.parametrize(
    ("law", "effects"),
    [(SHORT, PLAIN), (LONG, BOTH), (LONG, STIFF)],
    ids=["range 0.26", "range 0.5, neighbours, horizontal", "range 0.5, stiff neighbours"],
)
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


@pytest.mark.parametrize(("effects", "force"), [(PLAIN, 0.5), (BOTH, -0.5)], ids=["plain", "neighbours horizontal"])
def test_load(run_tables: RunTables, effects: tuple[float, bool], force: float) -> None:
    finished = run_tables(tables(LONG, effects, {"kind": "load", "force": force}))
    found, model = finished.outcome.quantities, model_of(LONG, effects, finished)
    exact = equilibrium_under(model, force)
    assert abs(found["displacement"].value - exact.displacement) < LOAD_DISPLACEMENT
    assert abs(found["displacement"].value - exact.displacement) <= found["displacement"].uncertainty
    assert found["force"].value == pytest.approx(force, abs=found["force"].uncertainty)
    assert found["contact_radius"].value == pytest.approx(radius(model, exact), rel=LOAD_RADIUS)


@pytest.mark.parametrize("method", ["dynamic", "quasistatic"])
@pytest.mark.parametrize("share", [0.9, 0.9997])
def test_a_tension_just_below_the_largest_is_within_what_is_claimed(
    run_tables: RunTables, share: float, method: str
) -> None:
    """There the stiffness falls to zero, so that a force that is a little off moves displacement and radius far."""
    contact = tables(SHORT, BOTH_VERTICAL, {"kind": "pull_off", "preload": 0.5})
    model = vertical_model(SHORT, BOTH_VERTICAL[0])
    top = pull_off(model, 0.5, step=0.25 * SHORT[0][1], stencil=STENCIL)
    force, solver = -share * top.adhesion_force, ChainSolver(model)
    contact["experiment"] = {"kind": "load", "force": force, "method": method}
    if method == "quasistatic":
        contact = {name: table for name, table in contact.items() if name not in ("damping", "plate")}
    found = run_tables(contact).outcome.quantities
    start = solver.equilibrium(top.critical.displacement, top.critical)
    ends = top.critical.displacement, top.zero_load.displacement
    place = brentq(lambda d: solver.equilibrium(d, start).force - force, *ends, xtol=1e-11)
    exact = solver.equilibrium(float(place), start)
    assert abs(found["displacement"].value - exact.displacement) <= found["displacement"].uncertainty
    assert abs(found["contact_radius"].value - radius(model, exact)) <= found["contact_radius"].uncertainty
    assert found["contact_radius"].uncertainty < NEAR_PULL_OFF * found["contact_radius"].value


@pytest.mark.slow
@pytest.mark.parametrize("radius_of_body", [200.0, 100.0])
def test_pairs_that_snap_let_go_where_they_do_without_time(run_tables: RunTables, radius_of_body: float) -> None:
    """The largest tooth of the tension: a plate that swings lets go before; and the run tells of several equilibria."""
    scene = tables((*SHORT[:2], radius_of_body), PLAIN, {"kind": "pull_off", "preload": 1.0})
    scene["bodies"]["bulk_stiffness"] = SNAPPING
    still = {name: table for name, table in scene.items() if name not in ("damping", "plate")}
    still["experiment"] = {"kind": "pull_off", "preload": 1.0, "method": "quasistatic"}
    moving, resting = run_tables(scene), run_tables(still)
    model = vertical_model((*SHORT[:2], radius_of_body), 0.0, SNAPPING, SNAPPING_CHAIN)
    exact = pull_off(model, 1.0, step=SNAP_STEP)
    for finished in (moving, resting):
        found = on_own_lattice(finished, "adhesion_force")
        assert abs(found.value - exact.adhesion_force) <= found.uncertainty
        assert found.uncertainty < 3e-3 * exact.adhesion_force
        assert "snaps" in [warning["name"] for warning in finished.document["warnings"]]
    for name in ("zero_load_radius", "critical_radius"):
        one, other = on_own_lattice(moving, name), on_own_lattice(resting, name)
        assert abs(one.value - other.value) <= one.uncertainty + other.uncertainty
        assert one.uncertainty < SNAPS_RADIUS


def on_own_lattice(finished: Run, name: str) -> Result:
    """A result without its discretisation error: the reference has these very particles."""
    result = finished.outcome.results[name]
    return replace(result, errors={source: e for source, e in result.errors.items() if source != "discretisation"})


@pytest.mark.parametrize("displacement", [-0.1, 0.08])
def test_a_path_in_time_waits_for_equilibrium_where_pairs_nearly_snap(
    run_tables: RunTables, displacement: float
) -> None:
    """At these displacements one pair is all but as steep as its springs are stiff, so that it comes to rest slowly."""
    law = PairInteraction(Exponential(*SHORT[0]), Exponential(*SHORT[1]))
    steepest = float(law.force_slope(np.asarray(law.extremum_distance(2))))
    scene = tables(SHORT, PLAIN, {"kind": "path", "displacements": [displacement]})
    scene["bodies"]["bulk_stiffness"] = stiffness = 2.0 * steepest / NEARLY_SNAPPING
    del scene["plate"]
    found = run_tables(scene).outcome.states[-1].force
    down = np.append(np.arange(-1.0, displacement, 0.05), displacement)
    assert found == pytest.approx(trace(vertical_model(SHORT, 0.0, stiffness), down)[-1].force, rel=FORCE)


def equilibrium_under(model: ChainModel, force: float) -> State:
    """The reference's state under a force; these contacts do not snap, so there is one."""
    start, solver = trace(model, np.arange(-1.0, 0.3, 0.05))[-1], ChainSolver(model)
    place = brentq(lambda d: solver.equilibrium(d, start).force - force, 0.1, 0.65, xtol=1e-10)
    return solver.equilibrium(float(place), start)
