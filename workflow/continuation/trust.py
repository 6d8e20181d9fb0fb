"""Which states are accepted as results, and their limitations.

Displacements [LU] and forces [FU] are positive in compression.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from contact1d.analysis.pressure import end_pressure_share
from contact1d.digits import apart
from contact1d.workflow.continuation.state import State
from contact1d.workflow.errors import ThroughError, UntrustedError
from contact1d.workflow.model.chain import decay_length, reflected
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.scene import Damping, Plate, Scene
from contact1d.workflow.scene.remedies import against_passing, longer_chain


def require_trust(scene: Scene, settings: Settings, state: State, moving: bool = False) -> None:
    """Refuse a state that is no result; return nothing otherwise.

    Whether particles are at rest counts only without `moving`, a plate and noise.

    Raises:
        ThroughError: a particle lies below the opposite surface.
        UntrustedError: a residual force, or on a rigid plane without relaxation the round-off error of positions,
            exceeds a tenth of the tolerance; or the contact reaches the end of the chain.
    """
    where = f"at displacement {state.displacement:.4g} LU (phase {state.phase})"
    if state.depth > 0.0:
        heat = " at this temperature" if scene.noise else ""
        raise ThroughError(
            f"the bodies went through each other {where}: a particle lies {state.depth:.3g} LU below the opposite "
            f"surface. One layer of particles cannot carry this load{heat}",
            f"{_against_passing(scene)}lower the load or the displacement, or take a stronger repulsion",
            against_passing(scene),
        )
    if not (moving or scene.plate or scene.noise or is_converged(settings, state)):
        residual, limit = apart(state.residual, residual_limit(settings), 2)
        if scene.is_stepped:
            raise UntrustedError(
                f"the forces are too small to resolve {where}: the round-off error of a position corresponds to "
                f"{residual} FU, and a tolerance of {settings.tolerance:g} allows {limit} FU",
                "use a larger load or displacement, or a larger [accuracy] tolerance",
            )
        raise UntrustedError(
            f"not converged {where}: a particle has a residual force of {residual} FU, above the {limit} FU "
            f"that a tolerance of {settings.tolerance:g} allows. Use "
            + ("more [damping]" if scene.method == "dynamic" else "a smaller load or smaller displacements")
            + ", or a larger [accuracy] tolerance"
        )
    if scene.bodies.own_count is None and state.rule.is_cut(state.profile):
        raise UntrustedError(
            f"the contact reaches the end of the chain {where}",
            f"use {_more_particles(scene, settings)}, or a smaller load",
            longer_chain(scene),
        )


def _against_passing(scene: Scene) -> str:
    """Return advice for a message against particles that pass each other, ", " at its end; "" where there is none.

    A lower temperature with noise, and leaving out [horizontal] where the scene has it, but not in a slide.
    """
    cooler = f"lower noise.temperature from {scene.temperature:g} FU·LU, " if scene.noise else ""
    if not scene.horizontal or scene.experiment.motion_is_result:  # a slide needs it
        return cooler
    return f"{cooler}leave out [horizontal], which lets particles move aside, "


def _more_particles(scene: Scene, settings: Settings) -> str:
    """Return the advice, part of a sentence, to take more particles than now, or an automatic number.

    It names bodies.upper_particles where the scene gives that, else bodies.particles.
    """
    if scene.bodies.upper_particles is not None:
        return f"more bodies.upper_particles than {settings.chains.upper}, or leave it out"
    return f'more bodies.particles than {settings.chains.upper} (or "auto")'


def residual_limit(settings: Settings, share: float = 0.1) -> float:
    """Return the largest residual force [FU] of a particle in a converged state.

    It is `share` times the relative tolerance times the force scale of one particle.
    """
    return share * settings.tolerance * settings.forces.scale


def is_converged(settings: Settings, state: State) -> bool:
    """Return whether the largest residual force on a particle is at most a tenth of the tolerance of the force scale.

    The force scale is that of one particle.
    """
    return state.residual <= residual_limit(settings)


def require_no_contradiction(settings: Settings, tension: float, uncertainty: float, states: Iterable[State]) -> None:
    """Refuse a force maximum that a state of the run's own curve exceeds by more than its uncertainty.

    Args:
        settings: of the run.
        tension: the force maximum, tension positive [FU].
        uncertainty: of it [FU]; the residual force of a state, times the number of upper particles, is added.
        states: of the curve; without any, nothing is refused.

    Raises:
        UntrustedError: names the first such state.
    """
    for state in states:
        if -state.force > tension + uncertainty + state.residual * settings.chains.upper:
            raise UntrustedError(
                f"the search found a force maximum of {tension:.6g} FU, but the curve of this run has "
                f"{-state.force:.6g} FU at displacement {state.displacement:.6g} LU (phase {state.phase}): it missed "
                'the maximum. Use kind = "path" over the full tensile range, or a smaller [accuracy] tolerance'
            )


def _chain_end(scene: Scene, settings: Settings, states: tuple[State, ...]) -> dict[str, str]:
    """Return {"chain_end": warning} where a chain ends too near to its contact, {} where it does not.

    Too near: its end reflects more of a displacement than the tolerance, or else the outermost particles of any state
    carry more than the tolerance of its largest pressure. `states`: one at least.
    """
    share = max(end_pressure_share(state.profile) for state in states)
    ends = reflected(scene, settings.law, settings.largest_displacement, settings.chains.upper)
    if ends > settings.tolerance:
        why = (
            f"neighbour springs spread the load over {decay_length(scene):.3g} LU to each side, and the chain of "
            f"{settings.chains.upper} particles ends so near to the contact that up to {ends:.1g} of it is reflected "
            "by its end"
        )
    elif share > settings.tolerance:
        why = (
            f"the outermost particles carry up to {share:.2g} of the largest pressure, so the chain of "
            f"{settings.chains.upper} particles truncates the contact"
        )
    else:
        return {}
    return {"chain_end": f"{why}: use {_more_particles(scene, settings)}"}


def doubts(scene: Scene, settings: Settings, states: tuple[State, ...]) -> dict[str, str]:
    """Return warnings about what limits the accuracy of states that are results, by name; {} for none.

    "chain_end": the chain ends near the contact, not checked of a body with an edge; "cutoff": the cutoff, the table or
    the plane's stiffness; "slow": drag or mass; "snaps": pairs snap, unless the scene prescribes the path;
    "table_core": particles came nearer than the table was made for. `states`: one at least.
    """
    warnings = _chain_end(scene, settings, states) if scene.bodies.own_count is None else {}
    share = settings.forces.share(scene)
    if share > settings.tolerance:
        warnings["cutoff"] = (
            f"the truncation error of the interaction (a cutoff of {settings.forces.cutoff:.3g} LU, its table near "
            f"zero distance, or the finite stiffness of the plane) changes a force by up to "
            f'{share:.1g} of it, and the radii with it: use a longer interaction.cutoff, or "auto", or a smaller load'
        )
    if slow := slowness(scene, settings):
        warnings["slow"] = slow
    if settings.law.snaps and not scene.experiment.history_is_given:
        warnings["snaps"] = (
            "the gradient of a pair's attraction exceeds the stiffness of its springs, so that pairs snap in and snap "
            "out: there are several equilibria under one load, and the loading history decides which one is reached. "
            "The uncertainties hold for this history; another preload or method may end in another "
            "equilibrium, a few particles wider or narrower. Stiffer springs or a longer range of the interaction "
            "leave a single equilibrium"
        )
    closest, forces = min(state.smallest_distance for state in states), settings.forces
    if forces.table is not None and closest < forces.table_from:
        error = forces.table.error_beyond(max(closest, forces.table.core))
        warnings["table_core"] = (
            f"opposite particles came as close as {closest:.3g} LU; the table was made for {forces.table_from:.3g} "
            f"LU and beyond, and its error is {error:.1e} FU there"
        )
    return warnings


def slowness(scene: Scene, settings: Settings, least: float = 10.0) -> str:
    """Return a warning that relaxation is at least `least` times slower than with automatic mass and drag.

    "" where it is not, for a quasi-static scene, without [damping], in a slide, and where mass and drag are automatic.
    """
    if scene.method != "dynamic" or not scene.damping or scene.experiment.motion_is_result:
        return ""
    plate = Plate(free=scene.plate.free) if scene.plate else None
    automatic = scene.model_copy(update={"damping": Damping(coefficient="auto"), "plate": plate})
    if automatic == scene:
        return ""
    usual = settings_for(automatic, settings.tolerance)
    times = _steps(scene, settings) / _steps(automatic, usual)
    if times < least:
        return ""
    return (
        f"a total drag of {_drag(scene, settings):.3g} FU·TU/LU on {_mass(scene, settings):.3g} MU, in place of the "
        f"automatic {_drag(automatic, usual):.3g} FU·TU/LU on {_mass(automatic, usual):.3g} MU, makes "
        f"relaxation under a load about {times:.0f} "
        'times slower: use "auto" for [damping] coefficient and [plate] mass and damping, unless the motion itself '
        "is studied"
    )


def _mass(scene: Scene, settings: Settings) -> float:
    """Return the moving mass [MU]: the plate and all upper particles; without a plate that of one particle."""
    particle = scene.bodies.mass
    return settings.motion.plate_mass + settings.chains.upper * particle if scene.plate else particle


def _drag(scene: Scene, settings: Settings) -> float:
    """Return the drag on the moving mass [FU·TU/LU]: on plate and all upper particles, or without a plate on one."""
    return settings.drag() if scene.plate else settings.motion.damping


def _steps(scene: Scene, settings: Settings) -> float:
    """Return the number of timesteps (not rounded) of a relaxation: the longer decay time over the timestep.

    Decay times are 2M/c and c/K, with the moving mass M, its drag c, and K from the settling time 2π √(M/K).

    Raises:
        ZeroDivisionError: there is no drag.
    """
    mass, drag = _mass(scene, settings), _drag(scene, settings)
    stiffness = mass * (2.0 * math.pi / settings.motion.settle_time) ** 2
    return max(2.0 * mass / drag, drag / stiffness) / settings.motion.time_step
