"""Force control in time, the paper's way: hold a load until all is at rest, or until the bodies part."""

from __future__ import annotations

import math
from dataclasses import dataclass

from workflow.experiments.contact import Contact, State
from workflow.experiments.outcome import UntrustedError, require_trust
from workflow.settings import Settings

CHUNK = 0.25
"""Time between two looks at the contact, over the settling time."""
FEWEST_STEPS = 20
MOST_CHUNKS = 2_000
"""Looks at one load after which it counts as never coming to rest."""
AT_REST = 0.1
"""Unbalanced load, and load that the plate would still travel through, over the load scale and the tolerance."""
LOST = 0.7
"""Tension over the largest one under this load at which a plate that moves off counts as lost."""


@dataclass(frozen=True)
class Held:
    """What a load led to.

    Attributes:
        load: compression positive [FU].
        states: measured on the way.
        held: whether the contact carries it at rest.
        steps: LAMMPS timesteps that it took.
        unbalance: |contact force − load| at the end [FU].
    """

    load: float
    states: tuple[State, ...]
    held: bool
    steps: int
    unbalance: float

    @property
    def last(self) -> State:
        """The last state."""
        return self.states[-1]


def chunk_steps(settings: Settings) -> int:
    """Timesteps between two looks."""
    return max(FEWEST_STEPS, math.ceil(CHUNK * settings.settle_time / settings.time_step))


def hold(contact: Contact, load: float, load_scale: float) -> Held:
    """Apply a load to a `load` phase and run until it is held at rest, or lost.

    At rest means both: the contact's force balances the load within AT_REST·tolerance·load_scale, and at its present
    velocity the plate would within a settling time change the contact's force by no more than that.

    Raises:
        UntrustedError: the contact neither comes to rest nor is lost, or see `require_trust`.
    """
    settings = contact.settings
    near = AT_REST * contact.scene.accuracy.tolerance * load_scale
    steps, states, largest = chunk_steps(settings), [], 0.0
    stiffness = load_scale / max(settings.largest_displacement, settings.closest, 0.1 * contact.scene.bodies.spacing)
    for count in range(1, MOST_CHUNKS + 1):
        state = contact.row(load, steps)
        states.append(state)
        unbalance = abs(state.force - load)
        travel = abs(state.plate_velocity) * settings.settle_time * stiffness
        if unbalance <= near and travel <= near:
            require_trust(contact.scene, settings, state)
            return Held(load, tuple(states), True, count * steps, unbalance)
        largest = max(largest, -state.force)
        if _lost(contact, state, load, largest):
            return Held(load, tuple(states), False, count * steps, unbalance)
    raise UntrustedError(
        f"the contact did not come to rest under {load:.4g} FU within {MOST_CHUNKS * steps} timesteps "
        f"(phase {state.phase}): {unbalance:.2g} FU are unbalanced. More [damping] or [plate] damping settles it sooner"
    )


def _lost(contact: Contact, state: State, load: float, largest: float) -> bool:
    """Out of reach, or past the largest tension: moving off, and the tension has fallen below what is pulled with."""
    if contact.settings.law is not None and state.smallest_distance > contact.settings.cutoff:
        return True
    tension = -state.force
    pulled = load < 0.0 and largest > 0.0  # before any tension was felt, the plate is still on its way from a preload
    return pulled and state.plate_velocity < 0.0 and tension < LOST * min(largest, -load)
