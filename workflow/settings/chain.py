"""Whether profile, chain and contact fit into each other, and how long an automatic chain is."""

from __future__ import annotations

import math

import numpy as np

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.scene import Bodies, Scene
from contact1d.workflow.settings.estimate import ContactEstimate

CHAIN_MARGIN = 1.1
"""Length of an automatic chain over what the estimate asks for."""
FALL_SHARE = 1e-9
"""A profile counts as falling where it does by more than this share of its height."""
ROUND_OFF = 1e-9
"""Relative, of a length that a chain only just fits into."""


class SettingsError(Contact1dError, ValueError):
    """A scene whose numbers, each allowed, lead to no computable system; the message says which and what to change."""


def require_room(bodies: Bodies) -> None:
    """Refuse a profile that is too narrow for the fewest particles: 3, or 4 of an automatic chain, which is even.

    Raises:
        SettingsError: with the widest spacing that is possible.
    """
    fewest = 4 if bodies.particles == "auto" else 3
    widest = 2.0 * bodies.reach / (fewest - 1)
    if not bodies.profile.has_edge and bodies.spacing > (1.0 - ROUND_OFF) * widest:
        raise SettingsError(
            f"the profile ends at {bodies.reach:.6g} LU, which is too narrow for {fewest} particles, the fewest"
            f"{' of an automatic chain' if fewest == 4 else ''}: take a bodies.spacing below {widest:.6g} LU"
        )


def require_body(bodies: Bodies, largest: float, particles: int) -> None:
    """Refuse a chain or a contact that is wider than its profile, and a profile whose contact is no single one.

    A contact that is wider than its chain alone is left to the run, which knows how wide it is.

    Raises:
        SettingsError: with the nearest value that is possible.
    """
    if bodies.profile.has_edge:
        return
    half = 0.5 * (particles - 1) * bodies.spacing
    if half > bodies.reach:
        raise SettingsError(
            f"the chain of {particles} particles is {half:.6g} LU wide to each side, and the profile ends at "
            f"{bodies.reach:.6g} LU: at most {_most_particles(bodies)} particles"
        )
    if bodies.reach < math.inf:
        longest = 0.5 * (max(particles, _most_particles(bodies)) - 1) * bodies.spacing
        deepest = float(bodies.height(np.asarray([longest]))[0])
        if largest >= deepest:
            raise SettingsError(
                f"the contact would spread over the whole profile, which ends at {bodies.reach:.6g} LU: the experiment "
                f"needs a displacement of about {largest:.4g} LU, at most {deepest:.4g} LU is possible"
            )
    places = np.linspace(0.0, half, 2001)
    heights = bodies.height(places)
    falls = np.diff(heights) < -FALL_SHARE * float(np.ptp(heights))
    if falls.any():
        at = float(places[int(np.argmax(falls))])
        raise SettingsError(
            f"the profile, as the reduction {bodies.reduction} has it, falls beyond x = {at:.4g} LU, so that the "
            "contact would not be one piece: smooth it, or end it there"
        )


def _most_particles(bodies: Bodies) -> int:
    """The longest chain, with 3 or an even number of particles, that the profile is wide enough for."""
    return max(3, 2 * math.floor(bodies.reach / bodies.spacing * (1.0 - ROUND_OFF) + 0.5))


def decay_length(scene: Scene) -> float:
    """Length ℓ [LU] in which a chain that is pushed at one place comes back to rest beside it; 0 without neighbours.

    Beside the push, k u_i = k_n (u_{i+1} − 2 u_i + u_{i−1}) has the solutions exp(±x/ℓ), cosh(s/ℓ) = 1 + k/(2 k_n): for
    stiff neighbours ℓ = s √(k_n/k).
    """
    if scene.neighbours is None:
        return 0.0
    softest = min(scene.bulk_stiffness, scene.tangential_stiffness if scene.horizontal is not None else math.inf)
    return scene.bodies.spacing / math.acosh(1.0 + 0.5 * softest / scene.neighbours.stiffness)


def reflected(scene: Scene, estimate: ContactEstimate, largest: float, particles: int) -> float:
    """Share of a contact's displacement that comes back to its edge from the chain's ends, exp(−2 L/ℓ), L apart."""
    decay = decay_length(scene)
    beyond = 0.5 * particles * scene.bodies.spacing - _edge(estimate, largest)
    return math.exp(-2.0 * max(beyond, 0.0) / decay) if decay > 0.0 else 0.0


def chains_of(scene: Scene, estimate: ContactEstimate, largest: float, share: float) -> tuple[int, int]:
    """Particles of the upper and of the lower body, those left open chosen.

    The upper one by `chain_length`; the lower one the same, and longer by the way on both sides in a slide.
    """
    bodies = scene.bodies
    if bodies.particles != "auto":
        return bodies.upper_particles or bodies.particles, bodies.particles
    needed = chain_length(scene, estimate, largest, share)
    beside = 2 * math.ceil((scene.experiment.way + abs(bodies.upper_offset or 0.0)) / bodies.spacing)
    half = 0.5 * needed * bodies.own_spacing
    below = needed if bodies.upper_spacing is None else 2 * math.ceil(half / bodies.spacing)
    return bodies.upper_particles or needed, below + beside


def _edge(estimate: ContactEstimate, largest: float) -> float:
    """Half-width [LU] up to the largest tension, or without attraction up to where nothing is felt."""
    return estimate.half_width(max(largest, 0.0), float(estimate.gap[int(estimate.force.argmin())]))


def felt_up_to(estimate: ContactEstimate, largest: float, share: float) -> float:
    """Undeformed gap [LU] beyond which no force is more than a share of the largest of a contact; r₀ if none has any.

    `largest`: displacement [LU] of the contact.
    """
    force = np.abs(estimate.force)
    borne = force[estimate.gap > estimate.rest - largest]
    return float(estimate.gap[force > share * borne.max()][-1]) if borne.any() else estimate.rest


def chain_length(scene: Scene, estimate: ContactEstimate, largest: float, share: float) -> int:
    """Particles of an automatic chain: out to where a force, and what a chain's end reflects, is this share at most.

    A flat punch has its own length; no chain is longer than its profile is wide.
    """
    if scene.bodies.profile.has_edge:
        return round(2.0 * scene.bodies.reach / scene.bodies.own_spacing)
    reach = felt_up_to(estimate, largest, share)
    if scene.interaction is not None and scene.interaction.attraction is None:
        reach = float(estimate.gap[-1])  # the contact ends where nothing is felt at all
    half = CHAIN_MARGIN * estimate.half_width(max(largest, 0.0), reach)
    half = max(half, _edge(estimate, largest) - 0.5 * decay_length(scene) * math.log(share))
    wanted = 2 * (math.ceil(half / scene.bodies.own_spacing) + 2)
    return wanted if scene.bodies.reach == math.inf else min(wanted, _most_particles(scene.bodies))
