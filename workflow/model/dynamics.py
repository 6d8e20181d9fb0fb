"""Time step, damping, plate mass and settling time of a scene in time, and the rows of a slide's drive.

The time step is the smaller one of those that a particle and the plate allow (`longest_step`). In a slide it divides
every leg of the drive, and every load step has as many of them.
"""

from __future__ import annotations

import math
from dataclasses import MISSING, dataclass, field
from typing import Any

from contact1d.workflow.laws.law import Law
from contact1d.workflow.scene import Cantilever, Damping, Impact, Scene, Slide

RELAXING_STEP = 0.5
"""ω_max·Δt without time, where a minimiser is the only one that takes steps (`workflow.deck.parts`)."""
MOVING_STEP, MOVING_TOLERANCE = 0.2, 1e-3
"""ω_max·Δt of a slide, whose motion itself is the result, and the tolerance below which it falls with its square root.

Measured on 24 random slides: mean friction off by 1e-6 to 9e-5 of itself, by 5e-4 where that is 1e-4 of a particle's.
"""
IMPACT_STEP = 1e-3
"""Time step of an impact over the time to the deepest displacement at the first velocity; below that tolerance, too."""
SWING = 0.5
"""Of the swing of a slide's plate on the law and its springs, the time to settle at least: springs may be rigid."""
DRAG_STEP = 0.2
"""Time step over the time m/γ in which drag stops a particle, or the plate: explicit integration needs it below 1."""
CALM_STEP = 0.4
"""The same during relaxation, whose drag is no part of what is examined."""
CREEPING = 10.0
"""Drag over the critical one from which on the relaxation of a plate is too slow."""
SOFTENING = 0.6
"""Stiffness of the contact under tension over that under the preload: automatic damping is critical for the former."""
LIGHT = 0.5
"""Drag over the mass of a plate far lighter than its particles, over the same of a particle (`_swinging_apart`)."""


def measured(unit: str, default: Any = MISSING) -> Any:
    """A field whose number a deck with units of its own converts (`deck.units`)."""
    return field(default=default, metadata={"unit": unit})


@dataclass(frozen=True)
class DriveLeg:
    """A leg of the drive.

    Attributes:
        velocity: [LU/TU]; 0 where it rests.
        rows: measured states.
        steps: timesteps of each row, a multiple of FEWEST_STEPS.
        time_step: [TU]; rows × steps of it are the leg's time exactly.
    """

    rows: int
    steps: int
    velocity: float = measured("LU/TU")
    time_step: float = measured("TU")

    @property
    def row_time(self) -> float:
        """Duration of a load step [TU]."""
        return self.steps * self.time_step


@dataclass(frozen=True)
class Motion:
    """Numbers of a motion in time.

    Attributes:
        plate_mass: [MU].
        drive: the legs of a slide; `time_step` is that of the first one.
        time_step: [TU].
        damping: coefficient of a particle [FU·TU/LU].
        damped_stiffness: of the contact [FU/LU], for which that is critical; 0 where it is the same under every load.
        plate_damping: [FU·TU/LU].
        settle_time: about one period of the plate on its contact [TU].
        calm_damping, calm_step: damping with which particles snap together and don't swing [FU·TU/LU], and the time
            step for it [TU]; the usual ones where the scene gives its damping. In a slide the one under which it is
            loaded, with which its plate does not swing.
    """

    plate_mass: float
    drive: tuple[DriveLeg, ...]
    time_step: float = measured("TU")
    damping: float = measured("FU·TU/LU")
    damped_stiffness: float = measured("FU/LU")
    plate_damping: float = measured("FU·TU/LU")
    settle_time: float = measured("TU")
    calm_damping: float = measured("FU·TU/LU")
    calm_step: float = measured("TU")


def motion_of(
    scene: Scene,
    tolerance: float,
    estimate: Law,
    largest: float,
    particles: int,
    stiffest: float,
    still_step: float,
) -> Motion:
    """Time step, damping, plate mass and settling time from the stiffest and the softest motion of the scene."""
    bodies, plate, moves = scene.bodies, scene.plate, scene.experiment.motion_is_result
    touching = 2.0 * estimate.half_width(max(largest, 0.0), estimate.rest) / bodies.spacing
    contact = max(touching, 1.0) * estimate.stiffness
    plate_mass = 0.0
    if plate:
        plate_mass = particles * bodies.mass if plate.mass == "auto" else plate.mass
    moving = plate_mass + particles * bodies.mass
    critical = 2.0 * math.sqrt(SOFTENING * contact * moving)
    damping, plate_damping = _drags(scene, particles, critical, plate_mass)
    # The drag on a motion is part of what is looked at, so it is one and the same throughout.
    is_automatic = scene.damping == Damping(coefficient="auto")
    product = _product(scene, tolerance, still_step)
    beside = sum(effect.bond_drag(scene.bulk_stiffness) for effect in scene.present)
    held = particles * scene.bulk_stiffness + scene.experiment.retraction_stiffness
    if scene.cantilever:
        held += scene.cantilever.stiffness + particles * max(0.0, scene.tangential_stiffness - scene.bulk_stiffness)
    step = min(
        longest_step(product, stiffest, bodies.mass, damping + beside),
        longest_step(product, held, plate_mass, plate_damping + particles * beside),
    )
    if isinstance(scene.experiment, Impact):
        step = IMPACT_STEP * min(1.0, math.sqrt(tolerance / MOVING_TOLERANCE)) * largest / scene.experiment.velocity
    slowest = contact / moving if plate else scene.bulk_stiffness / bodies.mass
    settle_time = 2.0 * math.pi / math.sqrt(slowest)
    calm, calm_step = damping, step
    if is_automatic:
        calm = max(damping, 2.0 * math.sqrt(stiffest * bodies.mass))
        calm_step = min(step, DRAG_STEP * bodies.mass / calm)
    if moves:
        # A plate that swings as it is loaded goes through the other body, which would carry it at rest.
        # The law is softer than stiff springs: the plate is on both in series.
        held = min(contact, max(0.0, estimate.stiffness_under(scene.experiment.compression or 0.0)))
        if held > 0.0:
            settle_time = max(settle_time, SWING * 2.0 * math.pi * math.sqrt(moving / held))
        enough = 2.0 * math.sqrt(SOFTENING * held * moving) / particles
        enough = min(enough, CALM_STEP * bodies.mass / step)
        calm, calm_step = damping if enough <= damping <= CREEPING * enough else enough, step
    damped = SOFTENING * contact if is_automatic and not moves else 0.0
    drive = drive_steps(scene, step)
    first = drive[0].time_step if drive else whole_steps(step, scene.experiment.lasts)
    return Motion(plate_mass, drive, first, damping, damped, plate_damping, settle_time, calm, calm_step)


def whole_steps(longest: float, duration: float | None) -> float:
    """The longest time step [TU] of which a motion's duration [TU] is a whole number, two at least."""
    return longest if duration is None else duration / max(2, math.ceil(duration / longest - ROUND_OFF))


def longest_step(product: float, stiffness: float, mass: float, drag: float) -> float:
    """Longest time step [TU] of a mass [MU] on springs [FU/LU] with a drag [FU·TU/LU]; inf of none.

    ω Δt is the `product` at most, and Δt a share DRAG_STEP of m/γ.
    """
    if mass == 0.0:
        return math.inf
    return min(product / math.sqrt(stiffness / mass), DRAG_STEP * mass / drag if drag > 0.0 else math.inf)


def _product(scene: Scene, tolerance: float, still_step: float) -> float:
    """Largest ω Δt: of a relaxation, of a motion that is the result, with noise, or quasi-static."""
    if scene.experiment.motion_is_result:
        product = MOVING_STEP * math.sqrt(min(1.0, tolerance / MOVING_TOLERANCE))
    else:
        product = still_step if scene.method == "dynamic" else RELAXING_STEP
    return min([product, *(effect.largest_phase(tolerance) for effect in scene.present)])


def _drags(scene: Scene, particles: int, critical: float, plate_mass: float) -> tuple[float, float]:
    """Drag [FU·TU/LU] of a particle and of the plate, given or together critical for the contact."""
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
    if scene.noise:  # drag without its noise would cool the plate; the particles' heat bath is its
        return damping, 0.0
    swinging = _swinging_apart(plate_mass, particles * mass, damping / mass)
    return damping, max(0.0, critical - particles * damping, swinging)


def _swinging_apart(plate: float, particles: float, rate: float) -> float:
    """Drag [FU·TU/LU] that a plate lighter than all its particles needs, so as not to swing against them.

    Of that swing a plate of the mass M [MU] leaves the particles, N m [MU] together with the drag `rate` · N m, the
    share M/(M + N m): next to nothing, if it is light, and drag on particles does not end it. With the drag c on the
    plate it decays with [rate · M + c N m/M] / 2(M + N m), which is to be what it is for M = N m, c = 0.
    """
    return LIGHT * rate * plate * max(0.0, 1.0 - plate / particles)


MOST_ROWS, FEWEST_ROWS = 50, 20
"""Measured states per spacing of the drive distance."""
USUAL_STEPS = 10
"""Timesteps of a row below which measuring takes longer than moving, so that there are fewer rows."""
FEWEST_STEPS = 5
"""Timesteps of a row are a multiple of it: the means of the cantilever are over every fifth one."""

ROUND_OFF = 1e-9


def drive_steps(scene: Scene, longest: float) -> tuple[DriveLeg, ...]:
    """The legs of a slide, with timesteps of at most `longest` [TU]; none of anything else."""
    experiment = scene.experiment
    if not isinstance(experiment, Slide):
        return ()
    cantilever, found = scene.the(Cantilever), []
    for leg in experiment.legs(cantilever.velocity):
        time = leg.distance / (abs(leg.velocity) or cantilever.velocity)
        spacings = leg.distance / scene.bodies.spacing
        each = min(MOST_ROWS, max(FEWEST_ROWS, int(time / spacings / longest / USUAL_STEPS)))
        rows = max(1, math.ceil(each * spacings - ROUND_OFF))
        steps = FEWEST_STEPS * max(1, math.ceil(time / rows / longest / FEWEST_STEPS - ROUND_OFF))
        found.append(DriveLeg(rows, steps, leg.velocity, time / rows / steps))
    return tuple(found)
