"""Friction on a rigid plane: F_x over the way u along x, which zone sticks, and what is dissipated."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.slip import slip, stick_margin, stick_radius
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.experiments.tangential.schedule import moved_too_far, passed, schedule
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, Quantity

Array = NDArray[np.float64]
RADII = ("contact_radius", "stick_radius")
ROUND_OFF = 1e-13
"""Error of tangential forces over the largest on the way, for each row: a history is a sum over all of them."""
AS_PREDICTED = 1e-8
"""How far a particle's tangential force may be from what spring and slider make of the row before, over its limit."""


@dataclass(frozen=True)
class Drawn:
    """A measured state with what friction made of it.

    Attributes:
        state: as measured.
        place: of the plate along x [LU].
        force: with which the body resists a move to the right [FU].
        carried: Σ |s_i|, of all particles whichever way they push [FU].
        stick: half-width of the zone that sticks.
        dissipated: energy since the start [FU·LU].
    """

    state: State
    place: float
    force: float
    carried: float
    stick: ContactRadius
    dissipated: float


def tangential(context: RunContext) -> Outcome:
    """F_N, F_x, a, c and the dissipated energy Σ ∫ |s_i| dδ_i of a scene with `[experiment] kind = "tangential"`.

    All are those of its last row; δ_i is the way by which a particle has slipped.

    Raises:
        UntrustedError: see `require_trust`; also where a particle's force is not what its spring and slider make of it.
    """
    scene, settings = context.deck.scene, context.deck.settings
    with context.contact() as contact:
        states = contact.replay(schedule(scene, settings))
        phases = contact.phases
    for state in states:
        require_trust(scene, settings, state)
    way = passed(scene, settings)
    rows = _drawn(scene, states, [place for (_, place), _ in way])
    drawn = [row for row, (_, asked) in zip(rows, way, strict=True) if asked]
    states = [row.state for row in drawn]
    ends = {"farthest": max(drawn, key=lambda row: abs(row.place)).state, "final": states[-1]}
    radii = {name: state.radius for name, state in ends.items()}
    strongest = max(row.carried for row in rows)
    error = ROUND_OFF * len(rows) * strongest + moved_too_far(scene, settings)
    quantities = _quantities(scene, drawn[-1], error)
    return Outcome(
        quantities,
        tuple(states),
        {name: state.profile for name, state in ends.items()},
        {name: math.nan if radius is None else radius.value for name, radius in radii.items()},
        phases,
        doubts(scene, settings, tuple(states)),
        friction=_columns(drawn),
        spacing_uncertainty={name: quantities[name].uncertainty for name in RADII},
        prescribed=_prescribed(scene, quantities),
        compared_with={"tangential_force": strongest, "dissipated_energy": _work(rows)},
    )


def _drawn(scene: Scene, states: Sequence[State], places: Sequence[float]) -> list[Drawn]:
    """What friction made of each state, from the one before it; at the first the load is just there."""
    assert scene.friction is not None
    coefficient, spacing, stiffness = scene.friction.coefficient, scene.bodies.spacing, scene.tangential_stiffness
    flat = scene.bodies.profile.has_edge
    limits = [spacing * coefficient * np.maximum(state.profile.pressure, 0.0) for state in states]
    forces = [-spacing * state.profile.shear for state in states]
    rows, dissipated, direction, largest = [], 0.0, 0, max(float(limit.max()) for limit in limits)
    for i, (state, force) in enumerate(zip(states, forces, strict=True)):
        if i:
            moved = places[i] - places[i - 1]
            direction = int(np.sign(moved)) or direction
            row = slip(forces[i - 1], np.full_like(force, stiffness * moved), limits[i - 1], limits[i], stiffness)
            _require_history(state, force - row.force, largest)
            dissipated += float(row.work.sum())
        stick = _whole(state, coefficient, direction) if flat else stick_radius(state.profile, coefficient, direction)
        rows.append(Drawn(state, places[i], float(force.sum()), float(np.abs(force).sum()), stick, dissipated))
    return rows


def _require_history(state: State, error: Array, limit: float) -> None:
    """Refuse forces that are not the history's."""
    worst = float(np.abs(error).max())
    if worst > AS_PREDICTED * limit:
        raise UntrustedError(
            f"a particle's tangential force is {worst:.2g} FU off what its spring and slider make of the row before, "
            f"at displacement {state.displacement:.4g} LU and {state.plate_x:.4g} LU along x (phase {state.phase}): "
            "LAMMPS has lost its history. Take rows that are nearer to each other"
        )


def _whole(state: State, coefficient: float, direction: int) -> ContactRadius:
    """A flat punch sticks or slips as a whole: all of its particles carry the same."""
    edge = state.radius
    sticks = edge is not None and stick_margin(state.profile, coefficient, direction).any()
    return edge if sticks and edge is not None else ContactRadius(0.0, 0.0, 0.0, 0.0, reaches_end=False)


def _quantities(scene: Scene, last: Drawn, error: float) -> dict[str, Quantity]:
    """The results; `error` [FU] is that of a sum of tangential forces."""
    state, radius = last.state, last.state.radius
    value, spread = (0.0, 0.0) if radius is None else (radius.value, radius.uncertainty)
    return {
        "normal_force": Quantity(state.force, ROUND_OFF * abs(state.force), FORCE),
        "tangential_force": Quantity(last.force, error, FORCE),
        "contact_radius": Quantity(value, spread, LENGTH),
        "stick_radius": Quantity(last.stick.value, last.stick.uncertainty, LENGTH),
        "dissipated_energy": Quantity(last.dissipated, error * scene.experiment.way, ENERGY),
    }


def _prescribed(scene: Scene, quantities: Mapping[str, Quantity]) -> frozenset[str]:
    """A load that is given, and the radius of what does not touch or stick, which is 0 without an error."""
    given = {"normal_force"} if scene.experiment.compression is not None else set()
    return frozenset(given | {name for name in RADII if quantities[name].value == quantities[name].uncertainty == 0.0})


def _work(rows: Sequence[Drawn]) -> float:
    """Σ |s_i| |Δu| [FU·LU] since the load came on: with what a dissipated energy is compared."""
    return sum(0.5 * (a.carried + b.carried) * abs(b.place - a.place) for a, b in pairwise(rows))


def _columns(drawn: Sequence[Drawn]) -> dict[str, tuple[float, ...]]:
    """What curve.csv has beside the columns of every curve."""
    columns = {
        "tangential_displacement": [row.place for row in drawn],
        "tangential_force": [row.force for row in drawn],
        "normal_force": [row.state.force for row in drawn],
        "stick_radius": [row.stick.value for row in drawn],
        "stick_radius_uncertainty": [row.stick.uncertainty for row in drawn],
        "dissipated_energy": [row.dissipated for row in drawn],
    }
    return {name: tuple(column) for name, column in columns.items()}
