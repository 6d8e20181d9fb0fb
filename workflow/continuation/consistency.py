"""Whether a run contradicts itself: each check compares two numbers that are computed independently.

An `Agreement` has their relative difference, how large it may be (relative), and a sentence with both numbers.

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
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, Path
from contact1d.workflow.scene import Scene

AT_REST = 1e-8
"""Allowed difference of two forces over the forces of a state in equilibrium."""


def plan(scene: Scene, states: Sequence[State], forces: Array) -> dict[str, Agreement]:
    """Return {"plan": agreement} of the forces of LAMMPS and of the model, (m,) [FU], of all load steps in order.

    |difference|, less the residual force times the number of loaded particles (at least 0), is divided by the sum of
    the absolute forces of the particles in its load step, to which 1e-5 of the largest sum of the run is added, for an
    unloaded step. The load step with the largest quotient counts; 1e-9 is allowed. `states`: one at least.
    """
    allowed, share = 1e-9, 1e-5  # differences of right runs are 4e-14 to 8e-11
    sizes = np.asarray([_load_sum(scene, state) for state in states])
    measured = np.asarray([state.force for state in states])
    missed = np.maximum(np.abs(measured - forces) - np.asarray([*map(_round_off, states)]), 0.0)
    off = missed / (sizes + share * max(float(sizes.max()), np.finfo(float).tiny))
    worst = int(off.argmax())
    words = (
        f"LAMMPS has {measured[worst]:.10g} FU at displacement {states[worst].displacement:.6g} LU (phase "
        f"{states[worst].phase}), and the model of the same contact {forces[worst]:.10g} FU"
    )
    return {"plan": Agreement(float(off[worst]), allowed, words)}


def asked(scene: Scene, pairs: Sequence[tuple[float, float]], states: Sequence[State]) -> dict[str, Agreement]:
    """Return {"asked": agreement} of pairs of forces [FU], (required by the scene, carried by its state).

    {} without pairs. The largest |difference| counts, less the largest round-off error of a state (at least 0), over
    the largest |required force| or sum of absolute forces of particles of a state, whichever is larger. Allowed are
    1e-8 in a quasi-static run on a rigid plane whose effects the reduced model all has, else the tolerance of the
    scene. `states`: one at least where there are pairs.
    """
    if not pairs:
        return {}
    largest = max([_load_sum(scene, state) for state in states] + [abs(wanted) for wanted, _ in pairs])
    wanted, carried = max(pairs, key=lambda pair: abs(pair[0] - pair[1]))
    words = f"the scene asks for {wanted:.10g} FU, and the state that has it carries {carried:.10g} FU"
    allowed = AT_REST if scene.is_stepped and scene.is_modelled else scene.accuracy.tolerance
    missed = max(abs(wanted - carried) - max(map(_round_off, states)), 0.0)
    return {"asked": Agreement(missed / largest if largest else 0.0, allowed, words)}


def _load_sum(scene: Scene, state: State) -> float:
    """Return the sum of the absolute forces of a state's upper particles [FU] ≥ 0, compressive and tensile.

    It is a scale also where the contact force is 0.
    """
    return scene.bodies.own_spacing * float(np.abs(state.profile.pressure).sum())


def _round_off(state: State) -> float:
    """Return the residual force of a state times the number of its loaded particles [FU]: 0 without a loaded one."""
    return state.residual * np.count_nonzero(state.profile.pressure)


def balance(scene: Scene, states: Sequence[State]) -> dict[str, Agreement]:
    """Return {"balance": agreement} of the contact force with the forces that LAMMPS adds up on the plate.

    {} where no state has this sum. The largest |difference| counts, less the state's residual force times the number of
    upper particles (at least 0), over the largest sum of the absolute forces of particles of a state. Allowed are 1e-8
    in a quasi-static run, 1e-4 in a dynamic one.
    """
    missing = [
        (max(abs(state.missing) - state.profile.x.size * state.residual, 0.0), state)
        for state in states
        if state.missing is not None
    ]
    if not missing:
        return {}
    size = max(_load_sum(scene, state) for state in states)
    missed, worst = max(missing, key=lambda pair: pair[0])
    words = (
        f"the contact has {worst.force:.10g} FU at displacement {worst.displacement:.6g} LU (phase {worst.phase}), and "
        f"what LAMMPS adds up on the plate differs by {missed:.3g} FU from that"
    )
    allowed = AT_REST if scene.method == "quasistatic" else 1e-4  # of the forces of a motion
    return {"balance": Agreement(missed / size if size else 0.0, allowed, words)}


@dataclass(frozen=True)
class Work:
    """The path of the plate, on which it does work.

    Attributes:
        path: in LAMMPS, or in free motion of the model.
        forces: of the model along it, (m,) [FU]; None: to be computed, with positions between.
        kinetic: of a free body, its first kinetic energy and the loss of it [FU·LU]; None with a prescribed motion.
    """

    path: Path
    forces: Array | None = None
    kinetic: tuple[float, float] | None = None


def energy(case: Reduction, work: Work, doubt: float = 0.0) -> dict[str, Agreement]:
    """Return {"energy": agreement} of the work of the plate with the energy that is stored and lost.

    {} where the contact law has no expression for its energies. The |difference| is relative to the energy lost where
    that exceeds 5 % of all work ∫ |F| |dd|, else to all work, and to the energy stored where that is larger; of a free
    body, to its first kinetic energy.
    Allowed are 1e-3 plus `doubt`, the relative uncertainty of the energy that the run reports; where the difference
    exceeds 1e-3, also four times what smaller steps and half the spacing change.
    """
    checked = _missing(case.model, work, 1)
    if checked is None:
        return {}
    missing, done, spent, size = checked
    share = 1e-3
    allowed = share + doubt
    if abs(missing) > share * size:  # cells and steps miss some of it, which may cancel
        finer = _missing(case.model, _denser(case, work), 2)
        # Half the spacing, and one on which kinks are elsewhere in their cells.
        refined = (*(_missing(case.model.resized(s), replace(work, forces=None), 1) for s in (0.5, 0.7)), finer)
        # Forces rise as roots at first: four times what other spacings and smaller steps change.
        allowed += 4.0 * sum(abs(missing / size - result[0] / result[3]) for result in refined if result)
    words = f"the work of the plate is {done:.6g} FU·LU, and {spent:.6g} FU·LU are stored or lost"
    return {"energy": Agreement(abs(missing) / size if size else 0.0, allowed, words)}


def _missing(model: Particles, work: Work, finer: int) -> tuple[float, float, float, float] | None:
    """Return (work neither stored nor lost, work, energy stored and lost, the scale of all), all [FU·LU].

    None where the contact law has no expression for its energies. The work is that of the plate from the first state
    on, of a free body the loss of its kinetic energy; energies stored or lost before do not count. The scale is all
    work ∫ |F| |dd|, tangential included, or the energy lost where that exceeds 5 % of it, but at least the energy
    stored; of a free body its first kinetic energy. `finer`: factor on the number of states of the path; without effect
    on a free motion.
    """
    path = work.path if work.kinetic else model.checked(work.path, finer)
    if (energies := model.energies(path)) is None:
        return None
    stored, lost = energies
    if work.kinetic:
        whole, done = work.kinetic
        return done - stored - lost, done, stored + lost, whole
    followed = None if path is work.path and work.forces is not None else model.follow(path)
    forces = followed.total if followed else np.asarray(work.forces)
    if forces[0] != 0.0:  # the work begins there: energies before the first state are no part of it
        first = {name: column[:1] for name, column in vars(path).items() if column is not None}
        before = model.energies(Path(**first)) or (0.0, 0.0)
        stored, lost = stored - before[0], lost - before[1]
    parts = 0.5 * (forces[1:] + forces[:-1]) * np.diff(path.displacement)
    if followed and followed.shear is not None:
        shears = np.asarray([-followed.shear(state).sum() for state in range(path.along.size)])
        parts += 0.5 * (shears[1:] + shears[:-1]) * np.diff(path.along)
    done, whole = float(parts.sum()), float(np.abs(parts).sum())
    size = lost if lost > 0.05 * whole else whole  # a smaller loss is compared with all work
    return done - stored - lost, done, stored + lost, max(size, abs(stored))


def _denser(case: Reduction, work: Work, dense: int = 4) -> Work:
    """Return the work along the path of the same experiment on the model with `dense` load steps for each, no forces.

    Twice as many may miss as much by chance. Returned unchanged are a free motion, and a path of equilibria, which gets
    its states from the model.
    """
    if work.kinetic or case.model.checked(work.path, 1) is not work.path:
        return work
    return Work(case.driven(case.model, dense).path)
