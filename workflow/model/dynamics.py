"""Timestep, damping, plate mass and settling time of a motion, and the load steps of a slide's drive.

The timestep is the smaller one of those that a particle and the plate allow (`longest_step`). In a slide every leg of
the drive, and every load step, is a whole number of timesteps.
"""

from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, field
from typing import Any

from contact1d.workflow.laws.law import Law
from contact1d.workflow.laws.numerics import ROUND_OFF
from contact1d.workflow.scene import Cantilever, Damping, Impact, Scene, Slide

MOVING_TOLERANCE = 1e-3
"""Tolerance below which the timestep of a motion that is the result falls with the square root of the tolerance."""
DRAG_STEP = 0.2
"""Timestep over the time m/γ in which drag stops a particle, or the plate: explicit integration needs it below 1."""
SOFTENING = 0.6
"""Stiffness of the contact under tension over that under the preload: automatic damping is critical for the former."""
MOST_ROWS = 50
"""Most measured states of a slide per spacing of the drive distance."""


def measured(unit: str, default: Any = MISSING) -> Any:
    """Return a dataclass field for a number in `unit`, with {"unit": unit} as metadata.

    `default`: its value; without one the field is required.
    """
    return field(default=default, metadata={"unit": unit})


@dataclass(frozen=True)
class DriveLeg:
    """A leg of the drive of a slide.

    Attributes:
        rows: measured states.
        steps: timesteps from one state to the next, a multiple of 5.
        velocity: velocity of the drive along x [LU/TU], negative along −x; 0 where it rests.
        time_step: timestep [TU]; rows × steps of it are exactly the leg's duration.
    """

    rows: int
    steps: int
    velocity: float = measured("LU/TU")
    time_step: float = measured("TU")

    @property
    def row_time(self) -> float:
        """Time [TU] from one measured state to the next: `steps` timesteps."""
        return self.steps * self.time_step


@dataclass(frozen=True)
class Motion:
    """Numbers of a motion in time.

    Attributes:
        plate_mass: mass of the plate [MU].
        drive: legs of a slide.
        time_step: timestep [TU], in a slide that of the first leg.
        damping: coefficient of a particle [FU·TU/LU].
        damped_stiffness: contact stiffness [FU/LU] for which that is critical; 0 where it is the same under every load.
        plate_damping: coefficient of the plate [FU·TU/LU].
        settle_time: about one period of the plate on its contact [TU].
        settling_damping: coefficient with which particles snap in without oscillation [FU·TU/LU], in a slide the one
            with which the plate is loaded without oscillation; `damping` where the scene gives it.
        settling_step: timestep with that coefficient [TU].
    """

    plate_mass: float
    drive: tuple[DriveLeg, ...]
    time_step: float = measured("TU")
    damping: float = measured("FU·TU/LU")
    damped_stiffness: float = measured("FU/LU")
    plate_damping: float = measured("FU·TU/LU")
    settle_time: float = measured("TU")
    settling_damping: float = measured("FU·TU/LU")
    settling_step: float = measured("TU")


def motion_of(
    scene: Scene, tolerance: float, estimate: Law, largest: float, particles: int, stiffest: float, still_step: float
) -> Motion:
    """Return masses, drags, timesteps, settling time and the legs of a slide, for a motion of the scene in time.

    The timestep is the smaller one of those that a particle and the plate allow, in an impact a thousandth of the time
    to the deepest displacement at the impact velocity (a third of that in an oblique one, below a tolerance of 1e-3
    less); shortened to a whole part of the duration. An automatic mass of the plate is that of all its particles; 0
    without a plate. Automatic drag is critical for 0.6 of the contact stiffness, without a plate half the critical one
    of a particle on its spring. With automatic [damping] the settling drag is at least the critical one of a particle
    in the stiffest contact, and its timestep short enough for it; else both are the usual ones. In a slide the settling
    drag is that under which the plate is loaded. `damped_stiffness` is 0 in a slide and without automatic [damping].

    Args:
        scene: whose motion it is.
        tolerance: relative tolerance of the main results.
        estimate: contact law.
        largest: largest displacement expected [LU], below 0 as at 0.
        particles: number of particles of the upper body.
        stiffest: largest stiffness of a particle's bonds and contacts [FU/LU].
        still_step: ω_max·Δt of a motion that comes to rest (dimensionless).
    """
    bodies, plate, moves = scene.bodies, scene.plate, scene.experiment.motion_is_result
    touching = 2.0 * estimate.half_width(max(largest, 0.0), estimate.rest) / bodies.spacing
    contact = max(touching, 1.0) * estimate.stiffness
    plate_mass = 0.0
    if plate:
        plate_mass = particles * bodies.mass if plate.mass == "auto" else plate.mass
    moving = plate_mass + particles * bodies.mass
    critical = 2.0 * math.sqrt(SOFTENING * contact * moving)
    damping, plate_damping = _drags(scene, particles, critical, plate_mass)
    # The drag on a motion is part of the result, so it is one and the same throughout.
    is_automatic = scene.damping == Damping(coefficient="auto")
    product = _product(scene, tolerance, still_step)
    step = min(
        longest_step(product, stiffest, bodies.mass, damping),
        longest_step(product, _plate_stiffness(scene, particles), plate_mass, plate_damping),
    )
    if isinstance(scene.experiment, Impact):
        # A thousandth of the time to the deepest displacement at the impact velocity, less below the tolerance.
        step = 1e-3 * min(1.0, math.sqrt(tolerance / MOVING_TOLERANCE)) * largest / scene.experiment.velocity
        step /= 1.0 + 2.0 * scene.is_oblique  # a spring is drawn along from the timestep in which it touches
    slowest = contact / moving if plate else scene.bulk_stiffness / bodies.mass
    settle_time = 2.0 * math.pi / math.sqrt(slowest)
    settling, settling_step = damping, step
    if is_automatic:
        settling = max(damping, 2.0 * math.sqrt(stiffest * bodies.mass))
        settling_step = min(step, DRAG_STEP * bodies.mass / settling)
    if moves:
        # The law is softer than stiff springs: the plate is on both in series.
        softest = min(contact, max(0.0, estimate.stiffness_under(scene.experiment.compression or 0.0)))
        if softest > 0.0:  # half a period at least: springs may be rigid
            settle_time = max(settle_time, math.pi * math.sqrt(moving / softest))
        critical = 2.0 * math.sqrt(SOFTENING * softest * moving) / particles
        # This drag is no part of the result, and may be twice as strong for its timestep.
        critical = min(critical, 2.0 * DRAG_STEP * bodies.mass / step)
        settling, settling_step = _loading_drag(damping, critical), step
    damped = SOFTENING * contact if is_automatic and not moves else 0.0
    drive = drive_steps(scene, step)
    first = drive[0].time_step if drive else whole_steps(step, scene.experiment.lasts)
    return Motion(plate_mass, drive, first, damping, damped, plate_damping, settle_time, settling, settling_step)


def _plate_stiffness(scene: Scene, particles: int) -> float:
    """Return the stiffness [FU/LU] of all springs of the plate: N bulk springs and the one that retracts it, if any.

    With a cantilever its stiffness is added, and N times that by which the tangential exceeds the bulk stiffness, if
    so.
    """
    stiffness = particles * scene.bulk_stiffness + scene.experiment.retraction_stiffness
    if scene.cantilever:
        lateral = max(0.0, scene.tangential_stiffness - scene.bulk_stiffness)
        stiffness += scene.cantilever.stiffness + particles * lateral
    return stiffness


def _loading_drag(damping: float, critical: float) -> float:
    """Return the drag of a particle [FU·TU/LU] with which a slide is loaded: `damping`, or `critical` instead.

    `critical`, at which the plate does not oscillate, is returned where `damping` is below it or more than ten times as
    large. A plate that oscillates as it is loaded goes through the other body, which would carry it at rest.
    """
    too_slow = 10.0 * critical  # the plate would creep to rest
    return damping if critical <= damping <= too_slow else critical


def whole_steps(longest: float, duration: float | None) -> float:
    """Return the longest timestep [TU], `longest` at most, of which a `duration` [TU] is a whole number, two at least.

    `longest` itself where the duration is None.
    """
    return longest if duration is None else duration / max(2, math.ceil(duration / longest - ROUND_OFF))


def longest_step(product: float, stiffness: float, mass: float, drag: float) -> float:
    """Return the longest timestep Δt [TU] of a mass [MU] on springs [FU/LU] with a drag γ [FU·TU/LU].

    ω Δt is the `product` (dimensionless) at most, and Δt 0.2 m/γ at most. Infinite for a mass of 0.

    Raises:
        ZeroDivisionError: a mass without stiffness.
    """
    if mass == 0.0:
        return math.inf
    return min(product / math.sqrt(stiffness / mass), DRAG_STEP * mass / drag if drag > 0.0 else math.inf)


def _product(scene: Scene, tolerance: float, still_step: float) -> float:
    """Return the largest ω Δt (dimensionless) of a timestep.

    In a slide 0.2, below a tolerance of 1e-3 less with its square root; in any other motion in time `still_step`; of a
    quasi-static scene 0.5. With [noise] it is √(`tolerance`/0.4) at most, `tolerance` relative.
    """
    if scene.experiment.motion_is_result:
        # Measured on 24 random slides: mean friction off by 1e-6 to 9e-5 of itself, by 5e-4 where that is 1e-4 of a
        # particle's.
        product = 0.2 * math.sqrt(min(1.0, tolerance / MOVING_TOLERANCE))
    else:
        # Without time only the minimiser takes steps (`workflow.deck.parts`).
        product = still_step if scene.method == "dynamic" else 0.5
    return min([product, *(effect.largest_phase(tolerance) for effect in scene.present)])


def _drags(scene: Scene, particles: int, critical: float, plate_mass: float) -> tuple[float, float]:
    """Return the drags [FU·TU/LU] (of a particle, of the plate): those of the scene, or automatic ones.

    That of a particle is 0 without [damping]. If automatic it is `critical` [FU·TU/LU], the drag of plate and particles
    together, over their number; without a plate √(k m), half the critical one of the particle on its spring. An
    automatic one of the plate is `critical` less the drag of all particles, or more where a plate lighter than its
    particles would oscillate against them; 0 without a plate, with noise, and in an impact. `plate_mass` [MU].
    """
    mass, damping = scene.bodies.mass, 0.0
    if scene.damping:
        automatic = critical / particles if scene.plate else math.sqrt(scene.bulk_stiffness * mass)
        damping = automatic if scene.damping.coefficient == "auto" else scene.damping.coefficient
    if not scene.plate:
        return damping, 0.0
    if scene.plate.damping != "auto":
        return damping, scene.plate.damping
    if isinstance(scene.experiment, Impact):  # it is free
        return damping, 0.0
    if scene.noise:  # drag without noise would cool the plate; its heat bath is that of the particles
        return damping, 0.0
    relative = _relative_drag(plate_mass, particles * mass, damping / mass)
    return damping, max(0.0, critical - particles * damping, relative)


def _relative_drag(plate: float, particles: float, rate: float) -> float:
    """Return the drag [FU·TU/LU] ≥ 0 with which a plate lighter than its particles does not oscillate against them.

    0 for a plate as heavy as all particles or heavier. In that oscillation a plate of mass M = `plate` [MU] leaves the
    particles, N m = `particles` [MU] together with the drag `rate` · N m, `rate` in [1/TU], the share M/(M + N m): next
    to nothing, if it is light, so that drag on particles does not end it. With the drag c on the plate the decay rate
    is [rate · M + c N m/M] / 2(M + N m); c = ½ `rate` M (1 − M/N m) makes it that of M = N m, c = 0.
    """
    return 0.5 * rate * plate * max(0.0, 1.0 - plate / particles)


def drive_steps(scene: Scene, longest: float) -> tuple[DriveLeg, ...]:
    """Return the legs of the drive of a slide in order; () for any other experiment.

    Each has a whole number of measured states, 20 to 50 per spacing of the lower chain and one at least, its start not
    counted, and from one to the next a multiple of 5 timesteps of at most `longest` [TU]. A leg of velocity 0 lasts as
    long as its distance takes at the velocity of the cantilever.
    """
    experiment = scene.experiment
    if not isinstance(experiment, Slide):
        return ()
    fewest_rows = 20  # per spacing
    usual_steps = 10  # per row: with fewer, measuring takes longer than moving, so that there are fewer rows
    means = 5  # the means of the cantilever are over every fifth timestep
    cantilever, drive = scene.the(Cantilever), []
    for leg in experiment.legs(cantilever.velocity):
        time = leg.distance / (abs(leg.velocity) or cantilever.velocity)
        spacings = leg.distance / scene.bodies.spacing
        density = min(MOST_ROWS, max(fewest_rows, int(time / spacings / longest / usual_steps)))
        rows = max(1, math.ceil(density * spacings - ROUND_OFF))
        steps = means * max(1, math.ceil(time / rows / longest / means - ROUND_OFF))
        drive.append(DriveLeg(rows, steps, leg.velocity, time / rows / steps))
    return tuple(drive)
