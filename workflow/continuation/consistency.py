"""Whether a run contradicts itself: each check compares two numbers that are found in ways that share nothing.

    plan      forces of LAMMPS and of the reduced model along the same load steps on a rigid plane
    asked     the force that the scene asks for and that of the state that has it
    balance   the force of the contact and what LAMMPS adds up on the plate
    energy    the work of the plate, and what springs store and contacts, dashpots and sliders lose

The pressure of the body and closed forms are checked where these are made (`body.consistency`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from contact1d.workflow.continuation.outcome import Agreement
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.laws.particles import Array, Particles
from contact1d.workflow.laws.path import Path
from contact1d.workflow.scene import Scene

PLAN, ABSOLUTE = 1e-9, 1e-5
"""Difference of two forces of a load step over the sum of all loads in it; share of the largest sum of the run that is
added to that, for a step that carries nothing. Measured on right runs: 4e-14 to 8e-11."""
AT_REST, MOVING = 1e-8, 1e-4
"""Force that is missing, over the forces of a state in equilibrium, and over those of a motion."""
ENERGY, LEAST_LOSS, OPEN = 1e-3, 0.05, 4.0
"""Energy that is missing over what is lost, or over all work where that is less than this share of it; over what half
the spacing and half the steps change, where that is more: forces rise as roots at first."""
DENSER = 4
"""Load steps for each of a history that show what these miss: twice as many may miss the same by chance."""


def plan(scene: Scene, states: Sequence[State], forces: Array) -> dict[str, Agreement]:
    """LAMMPS's forces beside those of the model, (m,) [FU], of all load steps in order.

    Each may be off by the round-off of the particles that carry.
    """
    sizes = np.asarray([_size(scene, state) for state in states])
    measured = np.asarray([state.force for state in states])
    missed = np.maximum(np.abs(measured - forces) - np.asarray([*map(_round_off, states)]), 0.0)
    off = missed / (sizes + ABSOLUTE * max(float(sizes.max()), np.finfo(float).tiny))
    worst = int(off.argmax())
    words = (
        f"LAMMPS has {measured[worst]:.10g} FU at displacement {states[worst].displacement:.6g} LU (phase "
        f"{states[worst].phase}), and the model of the same contact {forces[worst]:.10g} FU"
    )
    return {"plan": Agreement(float(off[worst]), PLAN, words)}


def asked(scene: Scene, pairs: Sequence[tuple[float, float]], states: Sequence[State]) -> dict[str, Agreement]:
    """Forces [FU] that the scene asks for beside those of the states that have them; a search has a tolerance."""
    if not pairs:
        return {}
    largest = max([_size(scene, state) for state in states] + [abs(wanted) for wanted, _ in pairs])
    wanted, found = max(pairs, key=lambda pair: abs(pair[0] - pair[1]))
    words = f"the scene asks for {wanted:.10g} FU, and the state that has it carries {found:.10g} FU"
    allowed = AT_REST if scene.is_stepped and scene.is_modelled else scene.accuracy.tolerance
    missed = max(abs(wanted - found) - max(map(_round_off, states)), 0.0)
    return {"asked": Agreement(missed / largest if largest else 0.0, allowed, words)}


def _size(scene: Scene, state: State) -> float:
    """All loads of a state, pressed and pulled [FU]: a force of 0 is compared with what makes it up."""
    return scene.bodies.own_spacing * float(np.abs(state.profile.pressure).sum())


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
    size = max(_size(scene, state) for state in states)
    missed, worst = max(told, key=lambda pair: pair[0])
    words = (
        f"the contact has {worst.force:.10g} FU at displacement {worst.displacement:.6g} LU (phase {worst.phase}), and "
        f"what LAMMPS adds up on the plate differs by {missed:.3g} FU from that"
    )
    allowed = AT_REST if scene.method == "quasistatic" else MOVING
    return {"balance": Agreement(missed / size if size else 0.0, allowed, words)}


@dataclass(frozen=True)
class Work:
    """What the plate has done on its path.

    Attributes:
        path: in LAMMPS.
        forces: of the model along it, (m,) [FU]; None where they are still to be found, with positions between.
        kinetic: the first energy of a body that flies, and what is gone of it [FU·LU].
    """

    path: Path
    forces: Array | None = None
    kinetic: tuple[float, float] | None = None


def energy(case: Reduction, work: Work, doubt: float = 0.0) -> dict[str, Agreement]:
    """Work beside what is stored and lost; nothing where the model of a contact does not tell.

    `doubt`: what is uncertain of the energy that the run reports, relative.
    """
    found = _missing(case.model, work, 1)
    if found is None:
        return {}
    missing, done, spent, size = found
    allowed = ENERGY + doubt
    if abs(missing) > ENERGY * size:  # cells and steps miss some of it, which may cancel
        finer = _missing(case.model, _denser(case, work), 2)
        others = (_missing(case.model.resized(0.5), replace(work, forces=None), 1), finer)
        allowed += OPEN * sum(abs(missing / size - other[0] / other[3]) for other in others if other)
    words = f"the work of the plate is {done:.6g} FU·LU, and {spent:.6g} FU·LU are stored or lost"
    return {"energy": Agreement(abs(missing) / size if size else 0.0, allowed, words)}


def _missing(model: Particles, work: Work, finer: int) -> tuple[float, float, float, float] | None:
    """Work that is neither stored nor lost, the work, what is stored and lost, and the size of it [FU·LU]."""
    path = work.path if work.kinetic else model.checked(work.path, finer)
    if (found := model.energies(path)) is None:
        return None
    stored, lost = found
    if work.kinetic:
        whole, done = work.kinetic
        return done - stored - lost, done, stored + lost, whole
    followed = None if path is work.path and work.forces is not None else model.follow(path)
    forces = followed.total if followed else np.asarray(work.forces)
    if forces[0] != 0.0:  # work begins there; what was gained and lost before is no part of it
        first = {name: column[:1] for name, column in vars(path).items() if column is not None}
        before = model.energies(Path(**first)) or (0.0, 0.0)
        stored, lost = stored - before[0], lost - before[1]
    parts = 0.5 * (forces[1:] + forces[:-1]) * np.diff(path.displacement)
    if followed and followed.shear is not None:
        shears = np.asarray([-followed.shear(state).sum() for state in range(path.along.size)])
        parts += 0.5 * (shears[1:] + shears[:-1]) * np.diff(path.along)
    done, whole = float(parts.sum()), float(np.abs(parts).sum())
    size = lost if lost > LEAST_LOSS * whole else whole
    return done - stored - lost, done, stored + lost, max(size, abs(stored))


def _denser(case: Reduction, work: Work) -> Work:
    """The same of a history in smaller load steps."""
    if work.kinetic or case.model.checked(work.path, 1) is not work.path:
        return work
    return Work(case.driven(case.model, DENSER).path)
