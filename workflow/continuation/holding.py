"""Load control in time, as in the paper: hold a load until plate and particles are at rest, or the bodies separate.

LAMMPS itself checks every few timesteps whether the plate is at rest or separated, and stops there; only then a state
is measured. With automatic damping each load has the drag that is critical for the contact stiffness under it: the
stiffness falls to zero towards the pull-off, and one drag for all makes the last tensions creep. Where pairs separate
one by one, it does not fall: F(d) has a maximum for each, as stiff as the pairs in contact, and a plate that oscillates
past such a maximum detaches pairs prematurely.

Displacements [LU], loads and forces [FU] are positive in compression.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import require_trust
from contact1d.workflow.deck.steps import Hold, Phase
from contact1d.workflow.errors import ThroughError, UntrustedError
from contact1d.workflow.model.dynamics import SOFTENING
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

MOST_HOLDS = 50
"""Load steps under one load after which it counts as never coming to rest."""


class Start(IntEnum):
    """The position at which a load is applied."""

    BACK = -1
    """Where the load before was applied."""
    HERE = 0
    KEPT = 1
    """Here, and the position is kept to come back to."""


@dataclass(frozen=True)
class Held:
    """The outcome of a load that was applied.

    Attributes:
        load: compression positive [FU].
        states: measured on the path, the last of them under the load.
        held: whether the contact carries the load at rest; else it is lost.
        unbalance: |carried − load| at the end [FU]; where `held`, plus |force of the drag| on plate and particles.
    """

    load: float
    states: tuple[State, ...]
    held: bool
    unbalance: float

    @property
    def last(self) -> State:
        """The last measured state under the load, at rest where `held`, else of a contact that is lost."""
        return self.states[-1]


def stiffness_under(settings: Settings, load: float) -> float:
    """Return the contact stiffness dF/dd [FU/LU] under a load [FU], compression positive.

    A tension counts as 0.998 of the force maximum at most, since the stiffness is 0 there; without attraction it is 0
    or NaN under a load of 0 or less. Where the tension has several maxima, the result is that of all pairs in contact
    at the largest expected displacement, whatever the load.

    Raises:
        NotCarriedError: without adhesion, a compression that the body cannot carry.
    """
    if settings.has_several_maxima:
        return settings.law.stuck_stiffness(settings.largest_displacement)
    return settings.law.stiffness_under(load)


def damping_under(settings: Settings, load: float) -> float:
    """Return the damping coefficient of a particle [FU·TU/LU] under a load [FU], compression positive.

    The usual one where the scene gives it, and in a slide. An automatic one is critical for the contact stiffness under
    the load, at most √(1/0.6) times the usual one. In a search that restarted in smaller steps, under a compressive
    load or none, it is the settling damping instead.
    """
    if settings.motion.damped_stiffness == 0.0:
        return settings.motion.damping
    if settings.gentle and load >= 0.0:
        return settings.motion.settling_damping
    stiffer = stiffness_under(settings, load) / settings.motion.damped_stiffness
    return settings.motion.damping * math.sqrt(min(max(stiffer, 0.0), 1.0 / SOFTENING))


def overshoot(settings: Settings, mass: float, load: float, next_load: float) -> float:
    """Return by how much of its path a plate overshoots that goes from rest under `load` to `next_load` [FU].

    exp(−πζ/√(1 − ζ²)), 0 … 1, of a linear oscillator with the contact stiffness under `load`, the largest one on the
    path to a larger tension, and the drag under `next_load`; 0 where it does not oscillate. Loads are positive in
    compression; `mass`: of a particle [MU].
    """
    moving = settings.motion.plate_mass + settings.chains.upper * mass
    drag = settings.drag(damping_under(settings, next_load))
    ratio = drag / (2.0 * math.sqrt(stiffness_under(settings, load) * moving))
    return math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2)) if ratio < 1.0 else 0.0


def hold_row(scene: Scene, settings: Settings, load: float, scale: float, start: Start) -> Hold:
    """Return a load step that holds a load [FU], compression positive, until LAMMPS finds the plate at rest.

    It is at rest where the contact force is within a tenth of the tolerance of `scale` [FU] of the load: with M the
    mass of the plate, N m that of the particles that move with it and c the drag on both, that force differs from the
    load by (M + N m) Z″ + c Z′; LAMMPS has M Z″ and Z′. LAMMPS also stops where the bodies have separated or went
    through each other, and after ten settling times, 20 timesteps at least.

    `start`: the position at which the load is applied.
    """
    damping = damping_under(settings, load)
    inertia = _inertia(scene, settings)
    drag = settings.drag(damping)
    # LAMMPS stops first where the tension of the model has fallen to this share of its maximum.
    parted = settings.law.parted(0.6) if load < 0.0 else _separated_displacement(settings)
    longest = 10.0 * settings.motion.settle_time  # then a state is measured in any case
    steps = max(20, math.ceil(longest / settings.motion.time_step))
    rest = at_rest(settings, scale) / inertia
    return Hold(int(start), load, damping, drag / inertia, rest, parted, _passed_displacement(settings), steps)


def held_phase(
    name: str, scene: Scene, settings: Settings, loads: Sequence[float], scale: float, state: bool = False
) -> Phase:
    """Return a planned phase that holds loads [FU], compression positive, one after the other, a load step each.

    `scale`: force [FU] to which the tolerance of equilibrium is relative; `state`: whether the last state is written.
    """
    return Phase(name, tuple(hold_row(scene, settings, load, scale, Start.KEPT) for load in loads), state)


def at_rest(settings: Settings, scale: float, share: float = 0.1) -> float:
    """Return the unbalanced force [FU] below which a contact is at rest: `share` of the tolerance of `scale` [FU]."""
    return share * settings.tolerance * scale


def hold(
    contact: Contact, load: float, scale: float, start: Start = Start.KEPT, settings: Settings | None = None
) -> Held:
    """Apply a load [FU], compression positive, until the contact holds it at rest or is lost; return the outcome.

    At rest means that the contact force balances the load within a tenth of the tolerance of `scale` [FU], and that
    drag and motion of the plate are as small. The outcome of a lost contact has `held` False; nothing is raised then.
    The phase of the contact must have begun. `start`: the position at which the load is applied; `settings` replace
    those of the contact, with another drag.

    Raises:
        ThroughError: the bodies went through each other.
        UntrustedError: neither happens within 50 load steps, or a state at rest is no result.
    """
    settings = settings or contact.settings
    near = at_rest(settings, scale)
    row = hold_row(contact.scene, settings, load, scale, start)
    states: list[State] = []
    for _ in range(MOST_HOLDS):
        state = contact.row(row, trusted=False)
        states.append(state)
        drag = row.drag * abs(state.plate_velocity)
        unbalance, stands = abs(state.carried - load), drag <= row.rest
        if stands and unbalance <= near:
            require_trust(contact.scene, settings, state)
            return Held(load, tuple(states), True, unbalance + drag * _inertia(contact.scene, settings))
        if state.displacement < row.parted:
            if _lost(contact, state, load):
                return Held(load, tuple(states), False, unbalance)
            row = replace(row, parted=_separated_displacement(settings))
        if state.displacement > row.through:
            require_trust(contact.scene, settings, state)
            raise ThroughError(
                f"the bodies went through each other under {load:.4g} FU, at {state.displacement:.4g} LU"
            )
        # A plate that is at rest while its contact is not gets a lower threshold.
        row = replace(row, start=int(Start.HERE), rest=row.rest * (0.5 if stands else 1.0))
    raise UntrustedError(
        f"the contact did not reach equilibrium under {load:.4g} FU within {MOST_HOLDS * row.steps} timesteps "
        f"(phase {state.phase}): the residual force is {unbalance:.2g} FU",
        "use more [damping] or [plate] damping",
    )


def press(contact: Contact, load: float, scale: float) -> Held:
    """Hold a load ≥ 0 [FU], compression positive, at once or in the equal parts of a search in smaller steps.

    Return the outcome of the last part, with the states of all. Where the contact is lost before, it is the outcome of
    the part under which it was, with `held` False.

    Raises:
        UntrustedError: the contact neither comes to rest nor is lost, or bodies went through each other.
    """
    count = max(1, round(1.0 / contact.settings.increments.part)) if load > 0.0 else 1
    states: list[State] = []
    for i in range(1, count + 1):
        held = hold(contact, load * i / count, scale)
        states += held.states
        if not held.held:
            break
    return replace(held, states=tuple(states))


def _inertia(scene: Scene, settings: Settings) -> float:
    """Return the moving mass, plate and upper particles, over the mass of the plate (dimensionless), ≥ 1.

    1 where particles are fixed in the plate's body, on a rigid plane.
    """
    return 1.0 if scene.stands else 1.0 + settings.chains.upper * scene.bodies.mass / settings.motion.plate_mass


def _separated_displacement(settings: Settings) -> float:
    """Return a displacement [LU], compression positive, at which bodies are beyond the cutoff of their interaction.

    It is r₀ less the cutoff and a spacing; without an interaction, a spacing before touch.
    """
    return settings.forces.rest - settings.forces.cutoff - settings.law.spacing


def _passed_displacement(settings: Settings) -> float:
    """Return a displacement [LU], compression positive, that an undamped plate on its contact does not reach.

    Beyond it bodies went through each other.
    """
    distance = settings.largest_displacement - settings.forces.rest + settings.forces.cutoff
    return settings.largest_displacement + 2.0 * max(distance, settings.law.spacing)


def _lost(contact: Contact, state: State, load: float, share: float = 0.7) -> bool:
    """Return whether a contact is beyond the cutoff, or moves apart with a tension below `share` of a tensile load.

    `load`: compression positive [FU]. Without a cutoff (on a rigid plane) only the second counts; under a compressive
    load or none only the first.
    """
    if 0.0 < contact.settings.forces.cutoff < state.smallest_distance:
        return True
    return load < 0.0 and state.plate_velocity < 0.0 and -state.force < -share * load
