"""Compress to a preload, pull apart under prescribed displacement, and find the largest tension on the way.

F_A = -min F(d) over the unloading branch that starts at F(d) = preload; a_cr is the radius of maximum tensile stress
there, a_0 the same where F(d) = 0.
"""

from typing import NamedTuple

import numpy as np

from validation.references.model import ChainModel
from validation.references.solver import ChainSolver, State
from validation.references.tension_radius import PARABOLA, state_radius

STEP_IN_RANGES = 1.0 / 16.0
"""Coarse step of the displacement over the shortest range."""
APPROACH_IN_RANGES = 4.0
"""Largest gap beyond the force-free one at which the approach starts, over the longest range."""
SEPARATED = 0.01
"""The bodies count as separated once the tension has fallen to this share of its maximum."""
RIVAL = 0.05
"""Local maxima of the coarse tension within this share of the largest are refined too, the best few of them."""
RIVALS = 5
"""How many."""
DIVISIONS = 8
"""Sub-steps per round of refinement."""
FORCE_SPREAD = 1e-9
"""A maximum is located when both neighbours on the path agree with it to this share."""
CLOSEST = 1e-6
"""Least distance of a trial from the ends of a bracket, over its width."""
SMALLEST_STEP = 1e-10
"""Refinement ends here at a fold, where the force jumps beside its maximum [LU]."""


class PullOff(NamedTuple):
    """What a pull-off test measures.

    Args:
        adhesion_force: largest tension on the unloading branch, a positive magnitude [FU].
        zero_load_radius: a_0 at the first F = 0 of the unloading branch [LU].
        critical_radius: a_cr at the largest tension [LU].
        preload: F_D as reached [FU]; above the one asked for only if the force jumped over it.
        zero_load: the state at F = 0 (at a jump through zero: the one nearer to it).
        critical: the state of the largest tension.
    """

    adhesion_force: float
    zero_load_radius: float
    critical_radius: float
    preload: float
    zero_load: State
    critical: State


def pull_off(model: ChainModel, preload: float, step: float | None = None, stencil: int = PARABOLA) -> PullOff:
    """Return adhesion force and radii of a pull-off under prescribed displacement.

    Numerically the force is exact to about 1e-9 and the radii to about 1e-6 (relative) of what their definitions say,
    as long as the coarse step sees every dip of F(d); where many particles snap one after another, take a step well
    below (radius of the contact) * spacing / R. What the definition leaves open under buckling: see `solver`.

    Args:
        model: two chains with attraction.
        preload: F_D >= 0, compression [FU].
        step: coarse step of the displacement [LU]; None: a sixteenth of the shortest range.
        stencil: points of the polynomial behind every radius, see `tension_radius`.

    Raises:
        ValueError: on a rigid plane, or if the chain is too short for its contact.
        RuntimeError: if the preload is beyond what the chains carry, or a minimisation does not converge.
    """
    if model.interaction is None:
        raise ValueError("a pull-off needs attraction")
    step = STEP_IN_RANGES * model.interaction.shortest_range if step is None else step
    solver = ChainSolver(model)
    loaded = _load(solver, preload, step)
    unloaded = _unload(solver, loaded[-1], step)
    zero = _crossing(solver, unloaded, 0.0)
    critical = _largest_tension(solver, unloaded)
    return PullOff(
        adhesion_force=-critical.force,
        zero_load_radius=state_radius(model, zero, stencil),
        critical_radius=state_radius(model, critical, stencil),
        preload=loaded[-1].force,
        zero_load=zero,
        critical=critical,
    )


def _load(solver: ChainSolver, preload: float, step: float) -> list[State]:
    """Compress from a gap until the force is the preload; the last state has it (or lies behind a jump over it)."""
    law = solver.model.interaction
    assert law is not None
    profile = solver.model.profile()
    start = np.min(profile) - APPROACH_IN_RANGES * law.longest_range
    limit = np.max(profile) + 10.0 * law.longest_range + preload / solver.model.bulk_stiffness
    states = [solver.equilibrium(start)]
    while states[-1].force < preload:
        if states[-1].displacement > limit:
            raise RuntimeError(f"the chains do not carry the preload {preload} FU")
        states.append(solver.equilibrium(states[-1].displacement + step, states[-1]))
    states[-1] = _crossing(solver, states, preload)
    return states


def _unload(solver: ChainSolver, start: State, step: float) -> list[State]:
    """Pull until the tension has passed its maximum and died away."""
    states, largest = [start], 0.0
    while largest <= 0.0 or -states[-1].force > SEPARATED * largest:
        states.append(solver.equilibrium(states[-1].displacement - step, states[-1]))
        largest = max(largest, -states[-1].force)
    return states


def _crossing(solver: ChainSolver, states: list[State], force: float) -> State:
    """Return the state at which the force first crosses a value along the path, found from the side it came from.

    Regula falsi (Illinois); the near end of the bracket moves up along the path, the far end is only a target. Where
    the force jumps, loading ends behind the jump and a crossing of zero at the side that is nearer.
    """
    excess = [state.force - force for state in states]
    tolerance = FORCE_SPREAD * 1e-2 * max(abs(state.force) for state in states)
    if abs(excess[0]) <= tolerance:
        return states[0]
    last = next(i for i in range(1, len(states)) if excess[i] * excess[0] <= 0.0)
    near, far = states[last - 1], states[last]
    near_excess, far_excess, moved = excess[last - 1], excess[last], ""
    while abs(near.displacement - far.displacement) > SMALLEST_STEP:
        share = near_excess / (near_excess - far_excess) if near_excess != far_excess else 0.5
        share = min(max(share, CLOSEST), 1.0 - CLOSEST)
        middle = solver.equilibrium(near.displacement + share * (far.displacement - near.displacement), near)
        value = middle.force - force
        if abs(value) <= tolerance:
            return middle
        if value * near_excess > 0.0:
            far_excess *= 0.5 if moved == "near" else 1.0
            near, near_excess, moved = middle, value, "near"
        else:
            near_excess *= 0.5 if moved == "far" else 1.0
            far, far_excess, moved = middle, value, "far"
    if force == 0.0 and abs(near.force) < abs(far.force):
        return near
    return far


def _largest_tension(solver: ChainSolver, states: list[State]) -> State:
    """Return the state of the largest tension of the unloading branch, all near-equal maxima refined."""
    force = np.array([state.force for state in states])
    inner = np.arange(1, force.size - 1)
    dips = inner[(force[inner] <= force[inner - 1]) & (force[inner] <= force[inner + 1])]
    best = [int(i) for i in dips[np.argsort(force[dips])][:RIVALS] if force[i] <= (1.0 - RIVAL) * force[dips].min()]
    return min((_refine(solver, states[i - 1], states[i], states[i + 1]) for i in best), key=lambda s: s.force)


def _refine(solver: ChainSolver, before: State, lowest: State, after: State) -> State:
    """Return the lowest force between two states, following the path from the first with ever smaller steps."""
    while True:
        spread = max(before.force - lowest.force, after.force - lowest.force)
        step = (before.displacement - after.displacement) / DIVISIONS
        if spread <= FORCE_SPREAD * abs(lowest.force) or step < SMALLEST_STEP:
            break
        path = [before]
        for i in range(1, DIVISIONS):
            path.append(solver.equilibrium(before.displacement - i * step, path[-1]))
        path.append(after)
        place = min(max(int(np.argmin([state.force for state in path])), 1), DIVISIONS - 1)
        before, lowest, after = path[place - 1 : place + 2]
    bends = after.force - 2.0 * lowest.force + before.force
    if spread > FORCE_SPREAD * abs(lowest.force) or bends <= 0.0:
        return lowest
    shift = 0.25 * (before.displacement - after.displacement) * (before.force - after.force) / bends
    return solver.equilibrium(lowest.displacement - shift, before)
