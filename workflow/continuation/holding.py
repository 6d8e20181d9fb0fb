"""Load control in time, as in the paper: hold a load until all is at rest, or until the bodies separate.

LAMMPS itself checks every few timesteps whether the plate is at rest or separated, and stops there; only then a state
is measured. With automatic damping each load has the drag that is critical for the contact's stiffness under it: the
stiffness falls to zero towards the pull-off, and one drag for all makes the last tensions creep. Where pairs separate
one by one, it does not fall: F(d) has a maximum for each, as stiff as the pairs in contact, and a plate that oscillates
past one detaches pairs prematurely.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import RestlessError, ThroughError, require_trust
from contact1d.workflow.deck.steps import Hold, Phase
from contact1d.workflow.model.dynamics import SOFTENING
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

FEWEST_STEPS = 20
PATIENCE = 10.0
"""Time of one load step over the settling time, after which a state is measured in any case."""
MOST_HOLDS = 50
"""Load steps under one load after which it counts as never coming to rest."""
REST_SHARE = 0.1
"""Unbalanced load over the load scale and the tolerance."""
CALMING_FACTOR = 0.5
"""Factor on the threshold of a plate that stood still while its contact did not."""
LOSS_SHARE = 0.7
"""Tension over what is pulled with, below which a plate that moves off counts as lost."""
PARTING_SHARE = 0.6
"""The same of the predictor's force maximum, where LAMMPS stops: the first position at which to look for it."""


class Start(IntEnum):
    """Where a load begins."""

    BACK = -1
    """Where the load before began."""
    HERE = 0
    KEPT = 1
    """Here, and the position is kept to come back to."""


@dataclass(frozen=True)
class Held:
    """What a load led to.

    Attributes:
        load: compression positive [FU].
        states: measured on the path.
        held: whether the contact carries it at rest.
        unbalance: |carried − load| at the end, and what drag may still carry: particles lag behind the plate [FU].
    """

    load: float
    states: tuple[State, ...]
    held: bool
    unbalance: float

    @property
    def last(self) -> State:
        """The last state."""
        return self.states[-1]


def stiffness_under(settings: Settings, load: float) -> float:
    """Contact stiffness [FU/LU] under a load [FU]; where pairs separate one by one, of all that ever touch."""
    if settings.has_several_maxima:
        return settings.law.stuck_stiffness(settings.largest_displacement)
    return settings.law.stiffness_under(load)


def damping_under(settings: Settings, load: float) -> float:
    """Coefficient of a particle [FU·TU/LU]; an automatic one is critical for the contact's stiffness under the load.

    In a search that restarts, no particle that is pressed on oscillates either.
    """
    if settings.motion.damped_stiffness == 0.0:
        return settings.motion.damping
    if settings.gentle and load >= 0.0:
        return settings.motion.settling_damping
    stiffer = stiffness_under(settings, load) / settings.motion.damped_stiffness
    return settings.motion.damping * math.sqrt(min(max(stiffer, 0.0), 1.0 / SOFTENING))


def overshoot(settings: Settings, mass: float, load: float, next_load: float) -> float:
    """How far a plate at rest under `load` shoots past its position under `next_load` at most, over the path there.

    exp(−πζ/√(1 − ζ²)) of a linear oscillator with the stiffness of the beginning, the largest one under tension.
    """
    moving = settings.motion.plate_mass + settings.chains.upper * mass
    drag = settings.drag(damping_under(settings, next_load))
    ratio = drag / (2.0 * math.sqrt(stiffness_under(settings, load) * moving))
    return math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2)) if ratio < 1.0 else 0.0


def hold_row(scene: Scene, settings: Settings, load: float, scale: float, start: Start) -> Hold:
    """A `hold` step, which ends where the contact force is within `at_rest` of the load.

    With M the plate's mass, N m that of the particles that move with it and c the drag on both, the contact's force
    misses the load by (M + N m) Z″ + c Z′; LAMMPS knows M Z″ and Z′.
    """
    damping = damping_under(settings, load)
    inertia = _inertia(scene, settings)
    drag = settings.drag(damping)
    parted = settings.law.parted(PARTING_SHARE) if load < 0.0 else _apart(settings)
    steps = max(FEWEST_STEPS, math.ceil(PATIENCE * settings.motion.settle_time / settings.motion.time_step))
    rest = at_rest(settings, scale) / inertia
    return Hold(int(start), load, damping, drag / inertia, rest, parted, _through(settings), steps)


def held_phase(
    name: str, scene: Scene, settings: Settings, loads: Sequence[float], scale: float, state: bool = False
) -> Phase:
    """A planned phase that holds loads [FU] one after the other."""
    return Phase(name, tuple(hold_row(scene, settings, load, scale, Start.KEPT) for load in loads), state)


def at_rest(settings: Settings, scale: float) -> float:
    """Unbalanced force [FU] at which a contact counts as at rest; `scale` is the force in question [FU]."""
    return REST_SHARE * settings.tolerance * scale


def hold(
    contact: Contact, load: float, scale: float, start: Start = Start.KEPT, settings: Settings | None = None
) -> Held:
    """Apply a load to a `hold` phase and run until it is held at rest, or lost.

    At rest means that what the contact carries balances the load within `at_rest(settings, scale)`, and that the
    plate's motion keeps it there (see `hold_row`). `settings` represent those of the contact, with a drag of their own.

    Raises:
        UntrustedError: the contact neither comes to rest nor is lost, or see `require_trust`.
    """
    settings = settings or contact.settings
    near = at_rest(settings, scale)
    row = hold_row(contact.scene, settings, load, scale, start)
    states: list[State] = []
    for _ in range(MOST_HOLDS):
        state = contact.row(row, trusted=False)
        states.append(state)
        drag = row.drag * abs(state.plate_velocity)
        unbalance, calm = abs(state.carried - load), drag <= row.rest
        if calm and unbalance <= near:
            require_trust(contact.scene, settings, state)
            return Held(load, tuple(states), True, unbalance + drag * _inertia(contact.scene, settings))
        if state.displacement < row.parted:
            if _lost(contact, state, load):
                return Held(load, tuple(states), False, unbalance)
            row = replace(row, parted=_apart(settings))
        if state.displacement > row.through:
            require_trust(contact.scene, settings, state)
            raise ThroughError(
                f"the bodies went through each other under {load:.4g} FU, at {state.displacement:.4g} LU"
            )
        row = replace(row, start=int(Start.HERE), rest=row.rest * (CALMING_FACTOR if calm else 1.0))
    raise RestlessError(
        f"the contact did not reach equilibrium under {load:.4g} FU within {MOST_HOLDS * row.steps} timesteps "
        f"(phase {state.phase}): the residual force is {unbalance:.2g} FU",
        "use more [damping] or [plate] damping",
    )


def press(contact: Contact, load: float, scale: float) -> Held:
    """Hold a load ≥ 0 at once, as in the paper; in as many steps as a search in smaller ones says. All states are kept.

    Raises:
        UntrustedError: see `hold`.
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
    """Total moving mass over that of the plate in LAMMPS: the upper particles move with it, or are part of it."""
    return 1.0 if scene.stands else 1.0 + settings.chains.upper * scene.bodies.mass / settings.motion.plate_mass


def _apart(settings: Settings) -> float:
    """Displacement [LU] at which the bodies are certainly out of each other's reach."""
    return settings.forces.rest - settings.forces.cutoff - settings.law.spacing


def _through(settings: Settings) -> float:
    """Displacement [LU] beyond what a plate without any damping would shoot to: the bodies went through each other."""
    way = settings.largest_displacement - settings.forces.rest + settings.forces.cutoff
    return settings.largest_displacement + 2.0 * max(way, settings.law.spacing)


def _lost(contact: Contact, state: State, load: float) -> bool:
    """Out of reach, or moving off with a tension that has fallen below what is pulled with."""
    if 0.0 < contact.settings.forces.cutoff < state.smallest_distance:
        return True
    return load < 0.0 and state.plate_velocity < 0.0 and -state.force < -LOSS_SHARE * load
