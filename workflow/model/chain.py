"""How long a chain is, whether profile and contact fit into it, and whether a computer holds what a scene asks for.

All of it is judged before anything runs; an error names the nearest value that is possible.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np

from contact1d.digits import apart, digits_apart
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.law import FARTHEST_RATIO, Law
from contact1d.workflow.model.dynamics import DriveLeg
from contact1d.workflow.scene import Bodies, Scene, Tangential

CHAIN_MARGIN = 1.1
"""Length of an automatic chain over what the predictor asks for."""
FALL_SHARE = 1e-5
"""A profile counts as falling where it does by more than this share of its height."""
ROUND_OFF = 1e-9
"""Relative, of a length that a chain only just fits into."""


def require_room(bodies: Bodies) -> None:
    """Refuse a profile that is too narrow for the fewest particles: 3, or 4 of an automatic chain, which is even.

    Raises:
        SettingsError: with the widest spacing that is possible.
    """
    fewest = 4 if bodies.particles == "auto" else 3
    widest = 2.0 * bodies.reach / (fewest - 1)
    if bodies.own_count is None and bodies.spacing > (1.0 - ROUND_OFF) * widest:
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
    if bodies.own_count is not None:
        return
    half = 0.5 * (particles - 1) * bodies.spacing
    if half > bodies.reach:
        wide, end = apart(half, bodies.reach, 6)
        raise SettingsError(
            f"the chain of {particles} particles is {wide} LU wide to each side, and the profile ends at {end} LU: at "
            f"most {_most_particles(bodies)} particles"
        )
    if bodies.reach < math.inf:
        longest = 0.5 * (max(particles, _most_particles(bodies)) - 1) * bodies.spacing
        deepest = float(bodies.height(np.asarray([longest]))[0])
        if largest >= deepest:
            needed, possible = apart(largest, deepest, 4)
            raise SettingsError(
                f"the contact would cover the profile, which ends at {bodies.reach:.6g} LU: the experiment "
                f"needs a displacement of about {needed} LU, at most {possible} LU is possible"
            )
    places = np.linspace(0.0, half, 2001)
    heights = bodies.height(places)
    falls = np.diff(heights) < -FALL_SHARE * float(np.ptp(heights))
    if falls.any():
        at = float(places[int(np.argmax(falls))])
        raise SettingsError(
            f"the profile under the reduction {bodies.reduction} falls beyond x = {at:.4g} LU, so that the "
            "contact would have several parts: smooth it, or end it there"
        )


def _most_particles(bodies: Bodies) -> int:
    """The longest chain, with 3 or an even number of particles, that the profile is wide enough for."""
    return max(3, 2 * math.floor(bodies.reach / bodies.spacing * (1.0 - ROUND_OFF) + 0.5))


def decay_length(scene: Scene) -> float:
    """Decay length ℓ [LU] of the displacement of a chain beside a point load; 0 without neighbours.

    Beside the push, k u_i = k_n (u_{i+1} − 2 u_i + u_{i−1}) has the solutions exp(±x/ℓ), cosh(s/ℓ) = 1 + k/(2 k_n): for
    stiff neighbours ℓ = s √(k_n/k).
    """
    if not scene.neighbours:
        return 0.0
    softest = min(scene.bulk_stiffness, scene.tangential_stiffness if scene.horizontal else math.inf)
    return scene.bodies.spacing / math.acosh(1.0 + 0.5 * softest / scene.neighbours.stiffness)


def reflected(scene: Scene, estimate: Law, largest: float, particles: int) -> float:
    """Share of a displacement at the contact edge that the ends of the chain reflect, exp(−2 L/ℓ), L apart."""
    decay = decay_length(scene)
    beyond = 0.5 * particles * scene.bodies.spacing - _edge(estimate, largest)
    return math.exp(-2.0 * max(beyond, 0.0) / decay) if decay > 0.0 else 0.0


def chains_of(scene: Scene, estimate: Law, largest: float, share: float) -> tuple[int, int]:
    """Particles of the upper and of the lower body, those left open chosen.

    The upper one by `chain_length`; the lower one the same, and longer by the way on both sides in a slide.
    """
    bodies = scene.bodies
    if bodies.particles != "auto":
        return bodies.upper_particles or bodies.particles, bodies.particles
    needed = chain_length(scene, estimate, largest, share)
    beside = 2 * math.ceil((scene.experiment.excursion + abs(bodies.upper_offset or 0.0)) / bodies.spacing)
    half = 0.5 * needed * bodies.own_spacing
    below = needed if bodies.upper_spacing is None else 2 * math.ceil(half / bodies.spacing)
    return bodies.upper_particles or needed, below + beside


def _edge(estimate: Law, largest: float) -> float:
    """Half-width [LU] up to the force maximum, or without attraction up to where nothing is felt."""
    return estimate.half_width(max(largest, 0.0), float(estimate.gap[int(estimate.force.argmin())]))


def felt_up_to(estimate: Law, largest: float, share: float) -> float:
    """Undeformed gap [LU] beyond which no force is more than a share of the largest of a contact; r₀ if none has any.

    `largest`: displacement [LU] of the contact.
    """
    force = np.abs(estimate.force)
    borne = force[estimate.gap > estimate.rest - largest]
    return float(estimate.gap[force > share * borne.max()][-1]) if borne.any() else estimate.rest


def chain_length(scene: Scene, estimate: Law, largest: float, share: float) -> int:
    """Particles of an automatic chain: up to where a force, and the reflection by the end, is at most this share.

    A flat punch has its own length; no chain is longer than its profile is wide.
    """
    if (own := scene.bodies.own_count) is not None:
        return own
    # Without attraction the contact ends where nothing is felt at all.
    reach = felt_up_to(estimate, largest, share) if estimate.attracts(scene) else estimate.felt
    half = CHAIN_MARGIN * estimate.half_width(max(largest, 0.0), reach)
    half = max(half, _edge(estimate, largest) - 0.5 * decay_length(scene) * math.log(share))
    wanted = 2 * (math.ceil(half / scene.bodies.own_spacing) + 2)
    return wanted if scene.bodies.reach == math.inf else min(wanted, _most_particles(scene.bodies))


MOST_PARTICLES = 10_000_000
MOST_PARTNERS = 5_000
"""Opposite particles within reach of one."""
MOST_ROWS = 1_000_000
"""Load steps of a prescribed path, intermediate ones included."""
PER_PARTICLE = 2_000.0
"""Memory for each particle of a body, its opposite and both anchors [bytes]: measured, 2 GB at 10⁶."""
PER_PAIR = 8.0
"""The same for each pair of particles within reach."""
MOST_TIMESTEPS = 2**31 - 1
"""Timesteps of one row: LAMMPS counts no further."""
LARGE, USUALLY_FELT = 20_000, 10.0
"""Particles per body, each within reach of so many opposite ones, from which on a run takes minutes."""
SHARPEST_RATIO = 1e3
"""Height of the particles beside an apex over cutoff and spacing: so far even neighbour springs bring none."""
DIGIT_SHARE = 0.1
"""Force that the last digit of a position may be, over one particle's and the tolerance: that of a converged state."""
MIX_UP = "All lengths (spacing, radius, ranges) are in LU: are some of them in another unit?"


def require_reach(scene: Scene, cutoff: float) -> None:
    """Refuse an interaction that reaches over more particles than can be summed over.

    Raises:
        SettingsError: with the widest reach that is possible.
    """
    spacing = scene.bodies.spacing
    if reaches_too_far(scene, cutoff):
        partners, _ = apart(2.0 * cutoff / spacing, MOST_PARTNERS, 2)
        raise SettingsError(
            f"with a cutoff of {cutoff:.4g} LU and a spacing of {spacing:.4g} LU a particle would interact with "
            f"{partners} opposite ones, at most {MOST_PARTNERS} are possible: use shorter ranges in "
            f"[interaction], an interaction.cutoff below {0.5 * MOST_PARTNERS * spacing:.4g} LU, or a wider "
            f"bodies.spacing. {MIX_UP}"
        )


def reaches_too_far(scene: Scene, cutoff: float) -> bool:
    """Whether a particle would interact with more opposite ones within a cutoff [LU] than can be summed over."""
    return cutoff > 0.5 * MOST_PARTNERS * scene.bodies.spacing


def require_apex(scene: Scene, particles: int, cutoff: float) -> None:
    """Refuse a chain whose particles beside the apex are far out of range of the interaction (a cutoff [LU]).

    Raises:
        SettingsError: with the particles' height.
    """
    beside = 0.5 * scene.bodies.spacing if particles % 2 == 0 else 0.0
    height = float(scene.bodies.height(np.asarray([beside]))[0])
    if height > SHARPEST_RATIO * max(cutoff, scene.bodies.spacing):
        raise SettingsError(
            f"the body is too sharp for its chain: it rises by {height:.4g} LU from its apex to the nearest particles, "
            f"{beside:.4g} LU from it. Use a finer bodies.spacing, a blunter bodies.profile, or an odd number of "
            f"bodies.particles, of which one is the apex. {MIX_UP}"
        )


def require_travel(scene: Scene, largest: float, cutoff: float) -> None:
    """Refuse a displacement `largest` [LU] out of all proportion to the range of the forces.

    Raises:
        SettingsError: with the path.
    """
    most = FARTHEST_RATIO * max(cutoff, scene.bodies.spacing)
    if abs(largest) > most:
        digits = digits_apart(abs(largest), most)
        raise SettingsError(
            f"the displacement would reach {largest:.{digits}g} LU, at most {most:.{digits}g} LU are possible with "
            f"this range of forces: use a larger bodies.bulk_stiffness, or a smaller load or displacement. {MIX_UP}"
        )


def require_memory(scene: Scene, particles: int, cutoff: float) -> None:
    """Refuse a system that exceeds the memory of this machine.

    Raises:
        SettingsError: with the number of particles or bytes.
    """
    if particles > MOST_PARTICLES:
        raise SettingsError(
            f"the contact would need {apart(particles, MOST_PARTICLES)[0]} particles per body, more than "
            f"{MOST_PARTICLES:.0e}: a wider bodies.spacing, a smaller radius, load or displacement needs fewer"
        )
    felt = _felt(scene, particles, cutoff)
    needed = particles * (PER_PARTICLE + PER_PAIR * felt)
    available = float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    if needed > available:
        large, there = apart(needed / 1e9, available / 1e9, 2)
        raise SettingsError(
            f"{particles} particles per body, each within reach of {felt:.0f} opposite ones, need about {large} GB of "
            f"memory, and this machine has {there} GB: a wider bodies.spacing, "
            "a smaller radius, load or displacement needs fewer particles, a shorter cutoff fewer pairs"
        )


def require_digits(scene: Scene, particles: int, deepest: float, force: float) -> None:
    """Refuse springs so stiff that the last digit of a position is more force than a particle at rest may be left with.

    Args:
        scene: whose particles are brought to rest without time.
        particles: per body.
        deepest: length that a position has beside the height of the last particle [LU].
        force: of one particle, times the tolerance [FU].

    Raises:
        SettingsError: with springs that are possible.
    """
    if scene.method != "quasistatic" or not scene.interaction:
        return
    last = float(scene.bodies.height(np.asarray([0.5 * (particles - 1) * scene.bodies.spacing]))[0])
    digit = 0.5 * float(np.spacing(abs(last) + abs(deepest)))
    left, allowed = scene.bulk_stiffness * digit, DIGIT_SHARE * force
    if left > allowed:
        error, most = apart(left, allowed, 1)
        raise SettingsError(
            f"a bodies.bulk_stiffness of {scene.bulk_stiffness:.3g} FU/LU is too stiff to resolve: the round-off error "
            f"of a position, {digit:.1g} LU, is a force of {error} FU, and the tolerance allows {most} FU. "
            f"Use {float(f'{0.3 * allowed / digit:.1g}'):g} FU/LU, which is practically rigid"
        )


def _steps(rows: float) -> str:
    """A number of load steps beyond the largest one."""
    return f"{apart(rows, MOST_ROWS)[0]} load steps, more than {MOST_ROWS:.0e}"


def require_rows(scene: Scene, longest_move: float, drive: Sequence[DriveLeg]) -> None:
    """Refuse a prescribed path of too many rows; a body moves towards the other by `longest_move` [LU] at most.

    A slide's rows are those of its drive.

    Raises:
        SettingsError: with the number of rows.
    """
    experiment = scene.experiment
    if isinstance(experiment, Tangential) and len(experiment.along()) > MOST_ROWS:
        raise SettingsError(
            f"the tangential path would need {_steps(len(experiment.along()))}: use fewer steps in "
            "experiment.displacements"
        )
    if (driven := sum(leg.rows for leg in drive)) > MOST_ROWS:
        raise SettingsError(
            f"the slide would need {_steps(driven)}: each spacing has some tens. "
            f"Use a shorter experiment.distance, or shorter legs of experiment.path. {MIX_UP}"
        )
    places = [0.0, *experiment.places()]
    way = sum(max(0.0, after - before) for before, after in pairwise(places))
    rows = len(places) + math.floor(way / longest_move)
    if rows > MOST_ROWS:
        raise SettingsError(
            f"the path would need {_steps(rows)}: the ranges of the interaction "
            f"limit a step to {longest_move:.3g} LU. Use smaller "
            f"experiment.displacements or longer ranges. {MIX_UP}"
        )


def require_steps(steps: Iterable[int]) -> None:
    """Refuse a scene with a load step of more `steps` than LAMMPS can count.

    Raises:
        SettingsError: with the number of timesteps.
    """
    most = max(steps, default=0)
    if most > MOST_TIMESTEPS:
        raise SettingsError(
            f"a load step would need {apart(most, MOST_TIMESTEPS)[0]} timesteps, at most {MOST_TIMESTEPS} can be "
            "counted: the periods of the "
            "slowest and the fastest motion differ too much. Use masses ([bodies] and [plate]), stiffnesses and "
            'dampings of similar magnitude, or "auto"'
        )


def in_words(scene: Scene, particles: int, cutoff: float) -> str:
    """What makes a run a long one, for its user to know before it starts; "" for a usual one."""
    felt = _felt(scene, particles, cutoff)
    if particles * max(1.0, felt / USUALLY_FELT) < LARGE:
        return ""
    return (
        f"a large system: {particles} particles per body, each within reach of {felt:.0f} opposite ones; a "
        "wider bodies.spacing, a smaller radius or load needs fewer"
    )


def _felt(scene: Scene, particles: int, cutoff: float) -> float:
    return min(particles, 2.0 * cutoff / scene.bodies.spacing + 2.0) if cutoff else 0.0
