"""Whether a run contradicts itself: each check compares two numbers that are found in ways that share nothing.

    plan      forces of LAMMPS and of the reduced model along the same load steps on a rigid plane
    asked     the force that the scene asks for and that of the state that has it
    balance   the force of the contact and what LAMMPS adds up on the plate
    energy    the work of the plate, and what springs store and contacts, dashpots and sliders lose

The pressure of the body and closed forms are checked where these are made (`body.consistency`).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from contact1d.workflow.continuation.budget import Reduction
from contact1d.workflow.continuation.model_branch import ModelBranch
from contact1d.workflow.continuation.outcome import Agreement
from contact1d.workflow.continuation.state import State
from contact1d.workflow.model.reduced import Array, Path, Reduced, legs, path_of
from contact1d.workflow.scene import Scene

PLAN, ABSOLUTE = 1e-9, 1e-5
"""Difference of two forces of a load step over the sum of all loads in it; share of the largest sum of the run that is
added to that, for a step that carries nothing. Measured on right runs: 4e-14 to 8e-11."""
TABLE = 2e-3
"""The same of a table, whose transform the model has between points."""
AT_REST, MOVING = 1e-8, 1e-4
"""Force that is missing, over the forces of a state in equilibrium, and over those of a motion."""
ENERGY, LEAST_LOSS, OPEN = 1e-3, 0.05, 4.0
"""Energy that is missing over what is lost, or over all work where that is less than this share of it; over what half
the spacing and half the steps change, where that is more: forces rise as roots at first."""
DENSE, EACH_STEP, EACH_LEG, BESIDE, NEAREST = 2, 16, 400, 60, 1e-9
"""Positions in a step of a history and of a tangential path, and in a leg of others, between which forces are straight
lines; on both sides of a jump, the nearest of them over the spacing."""


def plan(scene: Scene, states: Sequence[State], forces: Array | None) -> dict[str, Agreement]:
    """LAMMPS's forces beside those of the model, (m,) [FU], of all load steps in order; nothing without these.

    Each may be off by the round-off of the particles that carry.
    """
    if forces is None or not states:
        return {}
    spacing = scene.bodies.own_spacing
    sizes = np.asarray([spacing * float(np.abs(state.profile.pressure).sum()) for state in states])
    measured = np.asarray([state.force for state in states])
    missed = np.maximum(np.abs(measured - forces) - np.asarray([*map(_round_off, states)]), 0.0)
    off = missed / (sizes + ABSOLUTE * max(float(sizes.max()), np.finfo(float).tiny))
    worst = int(off.argmax())
    words = (
        f"LAMMPS has {measured[worst]:.10g} FU at displacement {states[worst].displacement:.6g} LU (phase "
        f"{states[worst].phase}), and the model of the same contact {forces[worst]:.10g} FU"
    )
    allowed = TABLE if scene.bodies.profile.slow else PLAN
    return {"plan": Agreement(float(off[worst]), allowed, words)}


def asked(scene: Scene, pairs: Sequence[tuple[float, float]], states: Sequence[State]) -> dict[str, Agreement]:
    """Forces [FU] that the scene asks for beside those of the states that have them; a search has a tolerance."""
    if not pairs:
        return {}
    largest = max([abs(state.force) for state in states] + [abs(wanted) for wanted, _ in pairs])
    wanted, found = max(pairs, key=lambda pair: abs(pair[0] - pair[1]))
    words = f"the scene asks for {wanted:.10g} FU, and the state that has it carries {found:.10g} FU"
    allowed = AT_REST if scene.is_stepped and scene.is_modelled else scene.accuracy.tolerance
    missed = max(abs(wanted - found) - max(map(_round_off, states)), 0.0)
    return {"asked": Agreement(missed / largest if largest else 0.0, allowed, words)}


def _round_off(state: State) -> float:
    """What residual forces add up to at most [FU]."""
    return state.residual * np.count_nonzero(state.profile.pressure)


def balance(scene: Scene, states: Sequence[State]) -> dict[str, Agreement]:
    """The contact's force on the plate beside what LAMMPS adds up on it, but for residual forces."""
    told = [
        (max(abs(one.missing) - one.profile.x.size * one.residual, 0.0), one)
        for one in states
        if one.missing is not None
    ]
    if not told:
        return {}
    size = max(scene.bodies.own_spacing * float(np.abs(state.profile.pressure).sum()) for state in states)
    missed, worst = max(told, key=lambda pair: pair[0])
    words = (
        f"the contact has {worst.force:.10g} FU at displacement {worst.displacement:.6g} LU (phase {worst.phase}), and "
        f"what LAMMPS adds up on the plate differs by {missed:.3g} FU from that"
    )
    allowed = AT_REST if scene.method == "quasistatic" else MOVING
    return {"balance": Agreement(missed / size if size else 0.0, allowed, words)}


def energy(
    case: Reduction, motion: tuple[Path, float, float] | None = None, doubt: float = 0.0
) -> dict[str, Agreement]:
    """Work beside what is stored and lost; nothing where the model of a contact does not tell.

    `motion`: of a body that flies, its path in LAMMPS, its first kinetic energy and what is gone of it [FU·LU].
    `doubt`: what is uncertain of the energy that the run reports, relative.
    """
    found = _missing(case, case.model, 1, motion)
    if found is None:
        return {}
    missing, work, spent, size = found
    allowed = ENERGY + doubt
    if abs(missing) > ENERGY * size:  # cells and steps miss some of it, which may cancel
        others = (_missing(case, case.model.resized(0.5), 1, motion), _missing(case, case.model, 2, motion))
        allowed += OPEN * sum(abs(missing / size - finer[0] / finer[3]) for finer in others if finer)
    words = f"the work of the plate is {work:.6g} FU·LU, and {spent:.6g} FU·LU are stored or lost"
    return {"energy": Agreement(abs(missing) / size if size else 0.0, allowed, words)}


def _missing(
    case: Reduction, model: Reduced, finer: int, motion: tuple[Path, float, float] | None
) -> tuple[float, float, float, float] | None:
    """Work that is neither stored nor lost, the work, what is stored and lost, and the size of it [FU·LU]."""
    path = _dense(case, model, finer) if motion is None else motion[0]
    if (found := model.energies(path)) is None:
        return None
    stored, lost = found
    if motion is None:
        followed = model.follow(path)
        if path.displacement[0] > 0.0 and followed.total[0] != 0.0:  # what came before is not known
            return None
        parts = 0.5 * (followed.total[1:] + followed.total[:-1]) * np.diff(path.displacement)
        if followed.shear is not None:
            shears = np.asarray([-followed.shear(state).sum() for state in range(path.along.size)])
            parts += 0.5 * (shears[1:] + shears[:-1]) * np.diff(path.along)
        work, whole = float(parts.sum()), float(np.abs(parts).sum())
    else:
        whole, work = motion[1:]
        return work - stored - lost, work, stored + lost, whole
    size = lost if lost > LEAST_LOSS * whole else whole
    return work - stored - lost, work, stored + lost, max(size, abs(stored))


def _dense(case: Reduction, model: Reduced, finer: int) -> Path:
    """The path of the script, with as many states as the work along it needs."""
    along = case.scene.experiment.goes_along
    branch = ModelBranch(case.scene, case.settings, model, 1 if along else DENSE * finer, 0.0)
    case.script(branch)
    path = branch.path
    if path.time.any():
        return path
    start = min(0.0, model.apart) - NEAREST * model.estimate.spacing  # below that nothing is felt
    places, count = np.append(start, np.maximum(path.displacement, start)), EACH_STEP * finer
    if along:
        at = np.arange(0.0, places.size - 1.0 + 0.5 / count, 1.0 / count)
        steps, moved = np.arange(places.size), np.append(path.along[:1], path.along)
        return Path(np.interp(at, steps, places), np.interp(at, steps, moved), np.zeros_like(at))
    ends = places[[0, *(leg.stop - 1 for leg in legs(places))]]
    near = model.estimate.spacing * np.geomspace(NEAREST, 1.0, BESIDE)
    beside = np.asarray([jump + side for jump in model.jumps for side in (-near, near)]).ravel()
    found = [places[:1]]
    for start, end in pairwise(ends.tolist()):
        between = beside[(beside > min(start, end)) & (beside < max(start, end))]
        places = np.unique(np.concatenate([np.linspace(start, end, EACH_LEG * finer + 1), between]))
        found.append((places if end > start else places[::-1])[1:])
    return path_of(np.concatenate(found))
