"""A slide's inertia in LAMMPS, whether it stays on its lower chain, whether particles can follow its drive.

LAMMPS evaluates the drag of a step with the velocity half a step before: m a = F − γ (v − a Δt/2). With m + γ Δt/2 in
the position of m that is m a = F − γ v. Otherwise a slip is as much too light as its drag is strong, which at usual
timesteps is percents of its time and tenths of percents of a mean friction. The first half step of a row has the right
velocity by itself, and so its share of the row is left out.
"""

from __future__ import annotations

import math

from contact1d.digits import apart
from contact1d.workflow.errors import SceneEdit, SettingsError
from contact1d.workflow.model.chain import felt_up_to
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Cantilever, Scene, Slide


def inertia(scene: Scene, settings: Settings) -> tuple[float, float]:
    """(mass of a particle, of the plate) in LAMMPS [MU]: the scene's own but in a slide without noise.

    With noise the thermostat's own error, of the same order, is bounded by the timestep.
    """
    late, motion = 0.0, settings.motion
    if motion.drive and not scene.noise:
        late = 0.5 * motion.time_step * (1.0 - 0.5 / motion.drive[0].steps)
    return scene.bodies.mass + motion.damping * late, motion.plate_mass + motion.plate_damping * late


SHORTEST = 4.0
"""Way over the spacing below which no mean friction comes of a slide: a run-in and three periods."""


def contact_half_width(scene: Scene, settings: Settings) -> float:
    """Half-width [LU] in which upper particles feel more than the tolerance's share of the largest force."""
    estimate, largest = settings.law, settings.largest_displacement
    half = estimate.half_width(max(largest, 0.0), felt_up_to(estimate, largest, scene.accuracy.tolerance))
    return min(half, 0.5 * (settings.chains.upper - 1) * scene.bodies.own_spacing)


def require_way(scene: Scene, settings: Settings) -> None:
    """Refuse a slide whose contact would leave the lower chain; a periodic one has no end.

    Raises:
        SettingsError: with the particles that are needed.
    """
    bodies = scene.bodies
    if not isinstance(scene.experiment, Slide) or bodies.periodic:
        return
    half, way = contact_half_width(scene, settings), scene.experiment.excursion + abs(bodies.upper_offset or 0.0)
    end = 0.5 * settings.chains.lower * bodies.spacing
    if end < half + way:
        needed = 2 * math.ceil((half + way) / bodies.spacing)
        room = end - half - abs(bodies.upper_offset or 0.0)
        shorter = f", or a distance of at most {room:.4g} LU" if room >= SHORTEST * bodies.spacing else ""
        raise SettingsError(
            f"the lower chain is too short for the sliding distance: it ends {end:.4g} LU from its middle, and a "
            f"contact of half-width {half:.4g} LU moves {way:.4g} LU along it. Use at least "
            f"{needed} bodies.particles (with upper_particles = "
            f'{settings.chains.upper}), or "auto"{shorter}',
            changes=[SceneEdit({"bodies.particles": needed, "bodies.upper_particles": settings.chains.upper})],
        )


def cantilever_swing(scene: Scene, settings: Settings) -> float:
    """Time [TU] of a swing of plate and particles on the cantilever, 2π √((M + N m)/k)."""
    moving = settings.motion.plate_mass + settings.chains.upper * scene.bodies.mass
    return 2.0 * math.pi * math.sqrt(moving / scene.the(Cantilever).stiffness)


def too_fast(scene: Scene) -> str:
    """A warning where the drive passes particles quicker than they swing, 2π v/s > √(k/m); else empty."""
    experiment, bodies = scene.experiment, scene.bodies
    if not isinstance(experiment, Slide):
        return ""
    fastest = max(abs(leg.velocity) for leg in experiment.legs(scene.the(Cantilever).velocity))
    own = math.sqrt(min(scene.bulk_stiffness, scene.tangential_stiffness) / bodies.mass)
    if 2.0 * math.pi * fastest / bodies.spacing <= own:
        return ""
    passing, period = apart(bodies.spacing / fastest, 2.0 * math.pi / own)
    return (
        f"the drive passes a particle in {passing} TU, less than the period of a particle on its "
        f"springs, {period} TU: the bodies cannot follow, and the friction is that of a shock. "
        f"Use a velocity below {own * bodies.spacing / (2.0 * math.pi):.3g} LU/TU"
    )
