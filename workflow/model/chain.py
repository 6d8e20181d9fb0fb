"""The length of chains, and limits of size: of profile, contact, memory and numbers of particles and load steps.

All of them are checked before LAMMPS runs; an error names the nearest value that is possible.
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
from contact1d.workflow.laws.numerics import ROUND_OFF, value_at
from contact1d.workflow.model.dynamics import DriveLeg
from contact1d.workflow.scene import Bodies, Scene, Tangential

MOST_PARTICLES = 10_000_000
"""Most particles of a body."""
MOST_PARTNERS = 5_000
"""Most opposite particles within the cutoff of one."""
MOST_LOAD_STEPS = 1_000_000
"""Most load steps of a prescribed path, intermediate ones included."""
MOST_TIMESTEPS = 2**31 - 1
"""Most timesteps of one load step: LAMMPS counts no further."""
MIX_UP = "All lengths (spacing, radius, ranges) are in LU: are some of them in another unit?"


def require_room(bodies: Bodies) -> None:
    """Refuse a profile that is too narrow for the fewest particles: 3, or 4 of an automatic chain, which is even.

    A body with a vertical edge, whose particles are as many as fit into it, is not refused.

    Raises:
        SettingsError: names the widest spacing [LU] that is possible.
    """
    fewest = 4 if bodies.particles == "auto" else 3
    widest = 2.0 * bodies.reach / (fewest - 1)
    if bodies.own_count is None and bodies.spacing > (1.0 - ROUND_OFF) * widest:
        raise SettingsError(
            f"the profile ends at {bodies.reach:.6g} LU, which is too narrow for {fewest} particles, the fewest"
            f"{' of an automatic chain' if fewest == 4 else ''}: take a bodies.spacing below {widest:.6g} LU"
        )


def require_body(bodies: Bodies, largest: float, particles: int) -> None:
    """Refuse a chain that is wider than the profile, or a contact that would be at the displacement `largest` [LU].

    The latter reaches the height of the last particle of the longest chain that fits on a bounded profile. Refused too
    is a profile (after reduction) that falls within the chain, by more than 1e-5 of its rise between neighbours of 2001
    positions, since the contact would have several parts. A contact that is wider than its chain, but not than its
    profile, is not refused here, and a body with a vertical edge never. `particles`: number of the upper chain.

    Raises:
        SettingsError: names the most particles, the largest displacement, or the position at which the profile
            falls.
    """
    if bodies.own_count is not None:
        return
    half = 0.5 * (particles - 1) * bodies.own_spacing
    if half > bodies.reach:
        wide, end = apart(half, bodies.reach, 6)
        raise SettingsError(
            f"the chain of {particles} particles is {wide} LU wide to each side, and the profile ends at {end} LU: at "
            f"most {_most_particles(bodies)} particles"
        )
    if bodies.reach < math.inf:
        longest = 0.5 * (max(particles, _most_particles(bodies)) - 1) * bodies.own_spacing
        deepest = value_at(bodies.height, longest)
        if largest >= deepest:
            needed, possible = apart(largest, deepest, 4)
            raise SettingsError(
                f"the contact would cover the profile, which ends at {bodies.reach:.6g} LU: the experiment "
                f"needs a displacement of about {needed} LU, at most {possible} LU is possible"
            )
    x = np.linspace(0.0, half, 2001)
    heights = bodies.height(x)
    falls = np.diff(heights) < -1e-5 * float(np.ptp(heights))  # a smaller share of the height is no fall
    if falls.any():
        position = float(x[int(np.argmax(falls))])
        raise SettingsError(
            f"the profile under the reduction {bodies.reduction} falls beyond x = {position:.4g} LU, so that the "
            "contact would have several parts: smooth it, or end it there"
        )


def _most_particles(bodies: Bodies) -> int:
    """Return the number of particles of the longest chain, 3 or an even number, that the profile is wide enough for.

    They are at the spacing of the upper chain; 3 also where not even these fit.

    Raises:
        OverflowError: the profile is unbounded.
    """
    return max(3, 2 * math.floor(bodies.reach / bodies.own_spacing * (1.0 - ROUND_OFF) + 0.5))


def decay_length(scene: Scene) -> float:
    """Return the decay length ℓ [LU] of the displacement of a chain near a point load; 0 without neighbour springs.

    Outside of the load, k u_i = k_n (u_{i+1} − 2 u_i + u_{i−1}) has the solutions exp(±x/ℓ), cosh(s/ℓ) = 1 + k/(2 k_n):
    for stiff neighbours ℓ = s √(k_n/k). k_n is the stiffness of a neighbour spring, s the spacing of the lower chain, k
    the bulk stiffness of a particle, or with [horizontal] the tangential one where that is smaller.
    """
    if not scene.neighbours:
        return 0.0
    softest = min(scene.bulk_stiffness, scene.tangential_stiffness if scene.horizontal else math.inf)
    return scene.bodies.spacing / math.acosh(1.0 + 0.5 * softest / scene.neighbours.stiffness)


def reflected(scene: Scene, estimate: Law, largest: float, particles: int) -> float:
    """Return the share of a displacement that the end of the chain reflects, exp(−2 L/ℓ), 0 … 1.

    0 without neighbour springs; with them 1 where the chain ends within the contact. L is the distance [LU] of the end
    of the chain from the contact edge (with an attraction, from the largest tension) at the displacement `largest`
    [LU], below 0 as at 0. ℓ [LU] is the decay length of a displacement along the chain. `estimate`: the contact law;
    `particles`: number of the upper chain, at the spacing of the lower one.
    """
    decay = decay_length(scene)
    beyond = 0.5 * particles * scene.bodies.own_spacing - _edge(estimate, largest)
    return math.exp(-2.0 * max(beyond, 0.0) / decay) if decay > 0.0 else 0.0


def chains_of(scene: Scene, estimate: Law, largest: float, share: float) -> tuple[int, int]:
    """Return the numbers of particles (upper body, lower body).

    Where bodies.particles is a number they are given: it is that of the lower body, and of the upper one unless
    bodies.upper_particles differs. Else the upper body has upper_particles where given, or as many as the contact
    needs; the lower body has as long a chain as the contact needs, lengthened on both sides by the largest tangential
    displacement of the experiment and the given offset of the upper body. With a rigid plane the second number is not
    used.

    Args:
        scene: whose chains they are.
        estimate: contact law.
        largest: largest displacement [LU].
        share: force at the end of an automatic chain over the largest force (relative).
    """
    bodies = scene.bodies
    if bodies.particles != "auto":
        return bodies.upper_particles or bodies.particles, bodies.particles
    needed = chain_length(scene, estimate, largest, share)
    additional = 2 * math.ceil((scene.experiment.excursion + abs(bodies.upper_offset or 0.0)) / bodies.spacing)
    half = 0.5 * needed * bodies.own_spacing
    below = needed if bodies.upper_spacing is None else 2 * math.ceil(half / bodies.spacing)
    return bodies.upper_particles or needed, below + additional


def _edge(estimate: Law, largest: float) -> float:
    """Return the half-width [LU] up to the largest tension; without attraction, that of the contact.

    It is where the undeformed gap is that of the least force of the law; one spacing where the gap at the apex is
    larger. Of an adhesive body on a rigid plane the contact radius, with a range of adhesion that of the attraction.
    `largest`: displacement [LU], compression positive, below 0 as at 0.
    """
    return estimate.half_width(max(largest, 0.0), float(estimate.gap[int(estimate.force.argmin())]))


def significant_gap(estimate: Law, largest: float, share: float) -> float:
    """Return the largest undeformed gap [LU] at which the magnitude of a force exceeds a `share` of the largest one.

    Only gaps above that at the apex, at the displacement `largest` [LU], count. r₀ [LU], the distance at displacement
    0, where there is no force at any of these.
    """
    force = np.abs(estimate.force)
    borne = force[estimate.gap > estimate.rest - largest]
    return float(estimate.gap[force > share * borne.max()][-1]) if borne.any() else estimate.rest


def chain_length(scene: Scene, estimate: Law, largest: float, share: float) -> int:
    """Return the number of particles of an automatic upper chain, at whose ends force and reflection are at most a
    share.

    Of a flat punch, or another body with a vertical edge, it is as many as fit into it (`own_count`), even or odd,
    whatever the other arguments. Of all others it is even, at the upper chain's spacing, with some more than are
    needed, and the chain no wider than the profile, even if force or reflection at its end are then larger.

    Args:
        scene: whose chain it is.
        estimate: contact law.
        largest: largest displacement [LU], below 0 as at 0.
        share: force at the end over the largest one, and the part of a displacement that the end reflects
            (relative).
    """
    if (count := scene.bodies.own_count) is not None:
        return count
    # Without attraction the contact ends where the force is 0.
    reach = significant_gap(estimate, largest, share) if estimate.attracts(scene) else estimate.cutoff_gap
    margin = 1.1  # over the length that the predictor gives
    half = margin * estimate.half_width(max(largest, 0.0), reach)
    half = max(half, _edge(estimate, largest) - 0.5 * decay_length(scene) * math.log(share))
    wanted = 2 * (math.ceil(half / scene.bodies.own_spacing) + 2)
    return wanted if scene.bodies.reach == math.inf else min(wanted, _most_particles(scene.bodies))


def require_reach(scene: Scene, cutoff: float) -> None:
    """Refuse an interaction with a `cutoff` [LU] above 2500 spacings of the lower chain (5000 opposite particles).

    Raises:
        SettingsError: names the longest cutoff that is possible.
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
    """Return whether a cutoff [LU] is above 2500 spacings of the lower chain: more than 5000 opposite particles."""
    return cutoff > 0.5 * MOST_PARTNERS * scene.bodies.spacing


def require_apex(scene: Scene, particles: int, cutoff: float) -> None:
    """Refuse a chain whose particles next to the apex lie more than 1000 times the cutoff [LU] above it.

    Where the spacing (of the lower chain) is larger than the cutoff, it counts in place of it. A chain of an odd number
    of `particles` has one at the apex and is never refused.

    Raises:
        SettingsError: names the particles' height [LU].
    """
    nearest = 0.5 * scene.bodies.own_spacing if particles % 2 == 0 else 0.0
    height = value_at(scene.bodies.height, nearest)
    # Not even neighbour springs bring a particle so far.
    if height > 1e3 * max(cutoff, scene.bodies.spacing):
        raise SettingsError(
            f"the body is too sharp for its chain: it rises by {height:.4g} LU from its apex to the nearest particles, "
            f"{nearest:.4g} LU from it. Use a finer bodies.spacing, a blunter bodies.profile, or an odd number of "
            f"bodies.particles, of which one is the apex. {MIX_UP}"
        )


def require_travel(scene: Scene, largest: float, cutoff: float) -> None:
    """Refuse a displacement of more than 10⁹ times the cutoff or the spacing of the lower chain, whichever is larger.

    `largest`: displacement [LU], of either sign; `cutoff` [LU], 0 without an interaction.

    Raises:
        SettingsError: names the largest displacement that is possible.
    """
    most = FARTHEST_RATIO * max(cutoff, scene.bodies.spacing)
    if abs(largest) > most:
        digits = digits_apart(abs(largest), most)
        raise SettingsError(
            f"the displacement would reach {largest:.{digits}g} LU, at most {most:.{digits}g} LU are possible with "
            f"this range of forces: use a larger bodies.bulk_stiffness, or a smaller load or displacement. {MIX_UP}"
        )


def require_memory(scene: Scene, particles: int, cutoff: float) -> None:
    """Refuse a system of more than 10⁷ particles of a body, or that exceeds the physical memory of this machine.

    Needed are 2000 bytes a particle of one body, its opposite one and anchors included, and 8 for each opposite one
    within the cutoff. `particles`: of each body; `cutoff`: of the interaction [LU], 0 without one.

    Raises:
        SettingsError: names the number of particles, or the memory needed and that of the machine [GB].
    """
    if particles > MOST_PARTICLES:
        raise SettingsError(
            f"the contact would need {apart(particles, MOST_PARTICLES)[0]} particles per body, more than "
            f"{MOST_PARTICLES:.0e}: a wider bodies.spacing, a smaller radius, load or displacement needs fewer"
        )
    partners = _partners(scene, particles, cutoff)
    # Measured: 2 GB at 10⁶ particles of a body, with their opposite ones and all anchors.
    bytes_per_particle, bytes_per_pair = 2_000.0, 8.0
    needed = particles * (bytes_per_particle + bytes_per_pair * partners)
    available = float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    if needed > available:
        large, memory = apart(needed / 1e9, available / 1e9, 2)
        raise SettingsError(
            f"{particles} particles per body, each within reach of {partners:.0f} opposite ones, need about {large} GB "
            f"of memory, and this machine has {memory} GB: a wider bodies.spacing, "
            "a smaller radius, load or displacement needs fewer particles, a shorter cutoff fewer pairs"
        )


def require_digits(scene: Scene, particles: int, deepest: float, force: float) -> None:
    """Refuse springs so stiff that the round-off error of a position is more force than a tenth of `force`.

    Only quasi-static scenes with an interaction are refused.

    Args:
        scene: whose springs they are.
        particles: number of the upper chain.
        deepest: length [LU] that a position has in addition to the height of the last particle.
        force: force scale of one particle times the relative tolerance [FU].

    Raises:
        SettingsError: names a stiffness [FU/LU] that is possible.
    """
    if scene.method != "quasistatic" or not scene.interaction:
        return
    last = value_at(scene.bodies.height, 0.5 * (particles - 1) * scene.bodies.own_spacing)
    digit = 0.5 * float(np.spacing(abs(last) + abs(deepest)))
    round_off, allowed = scene.bulk_stiffness * digit, 0.1 * force  # a tenth, as the residual of a converged state
    if round_off > allowed:
        error, most = apart(round_off, allowed, 1)
        raise SettingsError(
            f"a bodies.bulk_stiffness of {scene.bulk_stiffness:.3g} FU/LU is too stiff to resolve: the round-off error "
            f"of a position, {digit:.1g} LU, is a force of {error} FU, and the tolerance allows {most} FU. "
            f"Use {float(f'{0.3 * allowed / digit:.1g}'):g} FU/LU, which is practically rigid"
        )


def _steps(rows: float) -> str:
    """Return a text for a message: the number of load steps `rows`, and that it is more than 10⁶ (not checked here)."""
    return f"{apart(rows, MOST_LOAD_STEPS)[0]} load steps, more than {MOST_LOAD_STEPS:.0e}"


def require_rows(scene: Scene, longest_move: float, drive: Sequence[DriveLeg]) -> None:
    """Refuse a path of more than 10⁶ load steps: tangential ones, states of a slide, or prescribed displacements.

    Prescribed displacements begin with 0, and all approaches together take as many additional load steps as their sum
    has lengths `longest_move` [LU], none for an infinite one. `drive`: legs of a slide, () for any other experiment.

    Raises:
        SettingsError: names the number of load steps.
    """
    experiment = scene.experiment
    if isinstance(experiment, Tangential) and len(experiment.along()) > MOST_LOAD_STEPS:
        raise SettingsError(
            f"the tangential path would need {_steps(len(experiment.along()))}: use fewer steps in "
            "experiment.displacements"
        )
    if (driven := sum(leg.rows for leg in drive)) > MOST_LOAD_STEPS:
        raise SettingsError(
            f"the slide would need {_steps(driven)}: each spacing has some tens. "
            f"Use a shorter experiment.distance, or shorter legs of experiment.path. {MIX_UP}"
        )
    displacements = [0.0, *experiment.places()]
    approach = sum(max(0.0, after - before) for before, after in pairwise(displacements))
    steps = len(displacements) + math.floor(approach / longest_move)
    if steps > MOST_LOAD_STEPS:
        raise SettingsError(
            f"the path would need {_steps(steps)}: the ranges of the interaction "
            f"limit a step to {longest_move:.3g} LU. Use smaller "
            f"experiment.displacements or longer ranges. {MIX_UP}"
        )


def require_steps(steps: Iterable[int]) -> None:
    """Refuse a scene with a load step of more timesteps than LAMMPS can count, 2³¹ − 1.

    `steps`: timesteps of each load step; without any, nothing is refused.

    Raises:
        SettingsError: names the largest number of timesteps.
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
    """Return a note for the user on a system so large that a run takes minutes; "" for a usual one.

    Large are 20 000 particles per body or more; where each has more than ten opposite ones within the cutoff, fewer in
    proportion. `particles`: of each body; `cutoff`: of the interaction [LU], 0 without one.
    """
    large, usual_partners = 20_000, 10.0
    partners = _partners(scene, particles, cutoff)
    if particles * max(1.0, partners / usual_partners) < large:
        return ""
    return (
        f"a large system: {particles} particles per body, each within reach of {partners:.0f} opposite ones; a "
        "wider bodies.spacing, a smaller radius or load needs fewer"
    )


def _partners(scene: Scene, particles: int, cutoff: float) -> float:
    """Return the estimated number (not rounded) of opposite particles within the cutoff r_c [LU] of one: 2 r_c/s + 2.

    s is the spacing of the lower chain. At most `particles`; 0 for a cutoff of 0, that of a rigid plane.
    """
    return min(particles, 2.0 * cutoff / scene.bodies.spacing + 2.0) if cutoff else 0.0
