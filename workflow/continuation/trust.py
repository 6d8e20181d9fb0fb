"""Which states are accepted as results, and their limitations."""

from __future__ import annotations

import math
from collections.abc import Iterable

from contact1d.analysis.pressure import Profile, end_pressure_share, left_out
from contact1d.digits import apart
from contact1d.workflow.continuation.state import State
from contact1d.workflow.errors import ChainEndError as ChainEndError
from contact1d.workflow.errors import DigitsError as DigitsError
from contact1d.workflow.errors import OffEndError as OffEndError
from contact1d.workflow.errors import PartedError as PartedError
from contact1d.workflow.errors import RestlessError as RestlessError
from contact1d.workflow.errors import TensionError as TensionError
from contact1d.workflow.errors import ThroughError as ThroughError
from contact1d.workflow.errors import UnsteadyError as UnsteadyError
from contact1d.workflow.errors import UntrustedError as UntrustedError
from contact1d.workflow.model.chain import decay_length, reflected
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.scene import Damping, Plate, Scene
from contact1d.workflow.scene.remedies import against_passing, longer_chain

END_SHARE_LIMIT = 1.0
"""Pressure at a chain's end over the largest one, per unit of tolerance, from which on the chain cuts the contact."""
INSIDE_SHARE = 0.5
"""The same from which on the end of the chain is inside the contact."""
RESIDUAL_LIMIT = 0.1
"""Largest residual force of a particle over the force scale, per unit of tolerance, for a converged state."""
TAIL = 10.0
"""Force of the tail beyond the cutoff, summed over particles, over the force at the cutoff times a particle's share."""
COMPLIANCE_FACTOR = 2.0
"""Error of an equilibrium over that of the force on particles held in place: they follow it, and a table's error, here
at the distances that happen to be there, is half of what it is between two entries on average."""
SLOWNESS_RATIO = 10.0
"""Timesteps to settle over those with automatic values from which on it is reported: seconds become minutes."""


def require_trust(scene: Scene, settings: Settings, state: State, moving: bool = False) -> None:
    """Refuse a state that is no result; one of a motion has to be at rest only where it is not looked at as `moving`.

    Raises:
        UntrustedError: bodies that went through each other, particles not at rest, a contact that reaches the end of
            a chain.
    """
    at = f"at displacement {state.displacement:.4g} LU (phase {state.phase})"
    if state.depth > 0.0:
        heat = "" if scene.noise is None else " at this temperature"
        raise ThroughError(
            f"the bodies went through each other {at}: a particle lies {state.depth:.3g} LU below the opposite "
            f"surface. One layer of particles cannot carry this load{heat}",
            f"{_against_passing(scene)}lower the load or the displacement, or take a stronger repulsion",
            against_passing(scene),
        )
    if not moving and scene.plate is None and scene.noise is None and not is_converged(settings, state):
        residual, limit = apart(state.residual, RESIDUAL_LIMIT * settings.tolerance * settings.forces.scale, 2)
        if scene.is_stepped:
            raise DigitsError(
                f"the forces are too small to resolve {at}: the round-off error of a position corresponds to "
                f"{residual} FU, and a tolerance of {settings.tolerance:g} allows {limit} FU",
                "use a larger load or displacement, or a larger [accuracy] tolerance",
            )
        raise UntrustedError(
            f"not converged {at}: a particle has a residual force of {residual} FU, above the {limit} FU "
            f"that a tolerance of {settings.tolerance:g} allows. Use "
            + ("more [damping]" if scene.method == "dynamic" else "a smaller load or smaller displacements")
            + ", or a larger [accuracy] tolerance"
        )
    if _reaches_end(scene, state.profile):
        raise ChainEndError(
            f"the contact reaches the end of the chain {at}",
            f"use {_more_particles(scene, settings)}, or a smaller load",
            longer_chain(scene),
        )


def _against_passing(scene: Scene) -> str:
    """What else keeps particles from passing each other; "" where there is nothing."""
    cooler = "" if scene.noise is None else f"lower noise.temperature from {scene.noise.temperature:g} FU·LU, "
    if scene.horizontal is None or scene.experiment.motion_is_result:  # a slide needs it
        return cooler
    return f"{cooler}leave out [horizontal], which lets particles move aside, "


def _more_particles(scene: Scene, settings: Settings) -> str:
    """Which number to increase: that of the upper chain, if given."""
    if scene.bodies.upper_particles is not None:
        return f"more bodies.upper_particles than {settings.chains.upper}, or leave it out"
    return f'more bodies.particles than {settings.chains.upper} (or "auto")'


def is_converged(settings: Settings, state: State) -> bool:
    """Whether the residual force on every particle is below RESIDUAL_LIMIT."""
    return state.residual <= RESIDUAL_LIMIT * settings.tolerance * settings.forces.scale


def require_no_contradiction(settings: Settings, tension: float, uncertainty: float, states: Iterable[State]) -> None:
    """Refuse a force maximum [FU] that a state of the run's own curve exceeds by more than its uncertainty [FU].

    Raises:
        UntrustedError: names the state.
    """
    for state in states:
        if -state.force > tension + uncertainty + state.residual * settings.chains.upper:
            raise UntrustedError(
                f"the search found a force maximum of {tension:.6g} FU, but the curve of this run has "
                f"{-state.force:.6g} FU at displacement {state.displacement:.6g} LU (phase {state.phase}): it missed "
                'the maximum. Use kind = "path" over the full tensile range, or a smaller [accuracy] tolerance'
            )


def _reaches_end(scene: Scene, profile: Profile) -> bool:
    """Whether the contact's edge, the force maximum or else the last loaded particle, is a chain's last particle.

    That of a flat punch is meant to be.
    """
    if scene.bodies.profile.has_edge:
        return False
    pressure = profile.pressure
    if scene.adheres and scene.adhesion is None:
        largest = float(pressure.min())
        inside = end_pressure_share(profile) > INSIDE_SHARE  # the chain is shorter than the compressed middle
        return inside or (largest < 0.0 and largest in (pressure[0], pressure[-1]))
    return bool(max(abs(pressure[0]), abs(pressure[-1])) > 0.0)


def doubts(scene: Scene, settings: Settings, states: tuple[State, ...]) -> dict[str, str]:
    """Named warnings about states that are results, but limited ones."""
    found = {}
    share = max(end_pressure_share(state.profile) for state in states)
    if not scene.bodies.profile.has_edge and share > END_SHARE_LIMIT * settings.tolerance:
        found["chain_end"] = (
            f"the outermost particles carry up to {share:.2g} of the largest pressure, so the chain of "
            f"{settings.chains.upper} particles truncates the contact: use {_more_particles(scene, settings)}"
        )
    ends = reflected(scene, settings.estimate, settings.largest_displacement, settings.chains.upper)
    if not scene.bodies.profile.has_edge and ends > settings.tolerance:
        found["chain_end"] = (
            f"neighbour springs spread the load over {decay_length(scene):.3g} LU to each side, and the chain of "
            f"{settings.chains.upper} particles ends so near to the contact that up to {ends:.1g} of it is reflected "
            f"by its end: use {_more_particles(scene, settings)}"
        )
    share = law_share(scene, settings)
    if share > settings.tolerance:
        found["cutoff"] = (
            f"the truncation error of the interaction (a cutoff of {settings.forces.cutoff:.3g} LU, its table near "
            f"zero distance, or the finite stiffness of the plane) changes a force by up to "
            f'{share:.1g} of it, and the radii with it: use a longer interaction.cutoff, or "auto", or a smaller load'
        )
    if slow := slowness(scene, settings):
        found["slow"] = slow
    if settings.estimate.snaps and not scene.experiment.way_is_given:
        found["snaps"] = (
            "the gradient of a pair's attraction exceeds the stiffness of its springs, so that pairs snap in and snap "
            "out: there are several equilibria under one load, and the loading history decides which one is reached. "
            "The uncertainties hold for this history; another preload or method may end in another "
            "equilibrium, a few particles wider or narrower. Stiffer springs or a longer range of the interaction "
            "leave a single equilibrium"
        )
    closest, forces = min(state.smallest_distance for state in states), settings.forces
    if forces.table is not None and closest < forces.table_from:
        error = forces.table.error_beyond(max(closest, forces.table.core))
        found["table_core"] = (
            f"opposite particles came as close as {closest:.3g} LU; the table was made for {forces.table_from:.3g} "
            f"LU and beyond, and its error is {error:.1e} FU there"
        )
    return found


def law_share(scene: Scene, settings: Settings) -> float:
    """Relative error of a force that table and cutoff, or a plane that is not quite rigid, may cause, before a run."""
    if settings.forces.table is None or settings.forces.law is None:
        return _plane_share(scene, settings)
    tail = TAIL * abs(float(settings.forces.law.force(settings.forces.cutoff)))
    return (tail + settings.forces.table.error_beyond(settings.forces.table_from)) / settings.forces.scale


def law_error(scene: Scene, settings: Settings, state: State) -> float:
    """Error of the force of a measured state that table and cutoff, or the plane, cause [FU].

    COMPLIANCE_FACTOR Σ |F_table(r) - f(r)| |z|/r over the pairs of opposite particles, F_table = 0 beyond the cutoff.
    """
    if settings.forces.table is None or settings.forces.law is None:
        return _plane_share(scene, settings) * abs(state.force)
    return COMPLIANCE_FACTOR * left_out(settings.forces.law, settings.forces.table, state.profile)


def _plane_share(scene: Scene, settings: Settings) -> float:
    neighbours = 0.0 if scene.neighbours is None else scene.neighbours.stiffness
    return 4.0 * neighbours / settings.forces.plane_stiffness


def slowness(scene: Scene, settings: Settings) -> str:
    """The reason why the scene is slow; empty where it is not, or where the motion itself is studied (a slide)."""
    if scene.method != "dynamic" or scene.damping is None or scene.experiment.motion_is_result:
        return ""
    plate = None if scene.plate is None else Plate(free=scene.plate.free)
    same = scene.model_copy(update={"damping": Damping(coefficient="auto"), "plate": plate})
    if same == scene:
        return ""
    automatic = settings_for(same, settings.tolerance)
    times = _steps(scene, settings) / _steps(same, automatic)
    if times < SLOWNESS_RATIO:
        return ""
    drag, usual = (_drag(s, c) for s, c in ((scene, settings), (same, automatic)))
    return (
        f"a total drag of {drag:.3g} FU·TU/LU on {_mass(scene, settings):.3g} MU, in place of the automatic "
        f"{usual:.3g} FU·TU/LU on {_mass(same, automatic):.3g} MU, makes relaxation under a load about {times:.0f} "
        'times slower: use "auto" for [damping] coefficient and [plate] mass and damping, unless the motion itself '
        "is studied"
    )


def _mass(scene: Scene, settings: Settings) -> float:
    """What moves [MU]: plate and upper particles, or without a plate each particle by itself."""
    alone = scene.bodies.mass
    return alone if scene.plate is None else settings.motion.plate_mass + settings.chains.upper * alone


def _drag(scene: Scene, settings: Settings) -> float:
    """Drag on that [FU·TU/LU]."""
    return settings.motion.damping if scene.plate is None else settings.drag()


def _steps(scene: Scene, settings: Settings) -> float:
    """Timesteps of T; the settling time is 2π √(M/K)."""
    mass, drag = _mass(scene, settings), _drag(scene, settings)
    stiffness = mass * (2.0 * math.pi / settings.motion.settle_time) ** 2
    return max(2.0 * mass / drag, drag / stiffness) / settings.motion.time_step
