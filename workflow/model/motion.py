"""Masses of a slide in LAMMPS, and checks that it stays on its lower chain and that particles can follow its drive.

LAMMPS evaluates the drag of a step with the velocity half a step before: m a = F − γ (v − a Δt/2). With m + γ Δt/2 in
place of m that is m a = F − γ v. Without this correction a slip has too small a mass, by γ Δt/2: at usual timesteps an
error of percents of its duration and tenths of percents of a mean friction. The first half step of a load step has the
right velocity, and so its share of the load step is not corrected.
"""

from __future__ import annotations

import math

from contact1d.digits import apart
from contact1d.workflow.errors import SceneEdit, SettingsError
from contact1d.workflow.model.chain import significant_gap
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Cantilever, Scene, Slide


def inertia(scene: Scene, settings: Settings) -> tuple[float, float]:
    """Return (mass of a particle, mass of the plate) [MU] for LAMMPS: those of the settings, 0 without a plate.

    In a slide without noise γ Δt/2 is added to each, times 1 − 1/2n, with its drag γ, the timestep Δt and n timesteps
    from state to state of the first leg: LAMMPS has the drag of the velocity half a timestep before. With noise the
    error of the thermostat, of the same order, is bounded by the timestep.
    """
    late, motion = 0.0, settings.motion
    if motion.drive and not scene.noise:
        late = 0.5 * motion.time_step * (1.0 - 0.5 / motion.drive[0].steps)
    return scene.bodies.mass + motion.damping * late, motion.plate_mass + motion.plate_damping * late


def contact_half_width(scene: Scene, settings: Settings) -> float:
    """Return the half-width [LU] in which forces on upper particles exceed the tolerance times the largest one.

    It is that at the largest expected displacement (below 0 as at 0), and at most that of the upper chain.
    """
    estimate, largest = settings.law, settings.largest_displacement
    half = estimate.half_width(max(largest, 0.0), significant_gap(estimate, largest, scene.accuracy.tolerance))
    return min(half, 0.5 * (settings.chains.upper - 1) * scene.bodies.own_spacing)


def require_way(scene: Scene, settings: Settings) -> None:
    """Refuse a slide whose contact would leave the lower chain; other experiments and periodic bodies are not refused.

    Raises:
        SettingsError: names the particles that are needed and, where it is long enough, the possible distance.
    """
    bodies = scene.bodies
    if not isinstance(scene.experiment, Slide) or bodies.periodic:
        return
    half, distance = contact_half_width(scene, settings), scene.experiment.excursion + abs(bodies.upper_offset or 0.0)
    end = 0.5 * settings.chains.lower * bodies.spacing
    if end < half + distance:
        needed = 2 * math.ceil((half + distance) / bodies.spacing)
        room = end - half - abs(bodies.upper_offset or 0.0)
        run_in_and_periods = 4.0 * bodies.spacing  # a mean friction needs the run-in and three periods
        shorter = f", or a distance of at most {room:.4g} LU" if room >= run_in_and_periods else ""
        raise SettingsError(
            f"the lower chain is too short for the sliding distance: it ends {end:.4g} LU from its middle, and a "
            f"contact of half-width {half:.4g} LU moves {distance:.4g} LU along it. Use at least "
            f"{needed} bodies.particles (with upper_particles = "
            f'{settings.chains.upper}), or "auto"{shorter}',
            changes=[SceneEdit({"bodies.particles": needed, "bodies.upper_particles": settings.chains.upper})],
        )


def cantilever_swing(scene: Scene, settings: Settings) -> float:
    """Return the period [TU] of plate and all N particles on the cantilever alone, 2π √((M + N m)/k).

    Raises:
        StopIteration: the scene has no cantilever.
    """
    moving = settings.motion.plate_mass + settings.chains.upper * scene.bodies.mass
    return 2.0 * math.pi * math.sqrt(moving / scene.the(Cantilever).stiffness)


def too_fast(scene: Scene) -> str:
    """Return a warning where the drive of a slide passes a particle in less than its period, 2π v/s > √(k/m).

    v is the fastest leg, k the smaller of bulk and tangential stiffness. "" where it does not, and for any other
    experiment.
    """
    experiment, bodies = scene.experiment, scene.bodies
    if not isinstance(experiment, Slide):
        return ""
    fastest = max(abs(leg.velocity) for leg in experiment.legs(scene.the(Cantilever).velocity))
    frequency = math.sqrt(min(scene.bulk_stiffness, scene.tangential_stiffness) / bodies.mass)
    if 2.0 * math.pi * fastest / bodies.spacing <= frequency:
        return ""
    passing, period = apart(bodies.spacing / fastest, 2.0 * math.pi / frequency)
    return (
        f"the drive passes a particle in {passing} TU, less than the period of a particle on its "
        f"springs, {period} TU: the bodies cannot follow, and the friction is that of a shock. "
        f"Use a velocity below {frequency * bodies.spacing / (2.0 * math.pi):.3g} LU/TU"
    )
