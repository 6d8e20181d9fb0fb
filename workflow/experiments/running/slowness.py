"""Whether a scene's own damping and plate make it settle much more slowly than the automatic ones would.

A mass M on a contact of stiffness K with the drag c comes to rest within some T = max(2M/c, c/K): too little drag lets
it swing, too much lets it creep.
"""

from __future__ import annotations

import math

from contact1d.workflow.scene import Damping, Plate, Scene
from contact1d.workflow.settings.settings import Settings, settings_for

SLOWNESS_RATIO = 10.0
"""Timesteps to settle over those with automatic values from which on it is told: seconds become minutes."""


def slowness(scene: Scene, settings: Settings) -> str:
    """What makes the scene slow, in words; empty where nothing does, or where time is what is looked at (a slide)."""
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
        f"a drag of {drag:.3g} FU·TU/LU in all on {_mass(scene, settings):.3g} MU, in place of the automatic "
        f"{usual:.3g} FU·TU/LU on {_mass(same, automatic):.3g} MU, makes a load take about {times:.0f} times as long "
        'to settle: give "auto" for [damping] coefficient and [plate] mass and damping, unless the motion itself is '
        "what you look at"
    )


def _mass(scene: Scene, settings: Settings) -> float:
    """What moves [MU]: plate and upper particles, or without a plate each particle by itself."""
    alone = scene.bodies.mass
    return alone if scene.plate is None else settings.plate_mass + settings.particles * alone


def _drag(scene: Scene, settings: Settings) -> float:
    """Drag on that [FU·TU/LU]."""
    return settings.damping if scene.plate is None else settings.particles * settings.damping + settings.plate_damping


def _steps(scene: Scene, settings: Settings) -> float:
    """Timesteps of T; the settling time is 2π √(M/K)."""
    mass, drag = _mass(scene, settings), _drag(scene, settings)
    stiffness = mass * (2.0 * math.pi / settings.settle_time) ** 2
    return max(2.0 * mass / drag, drag / stiffness) / settings.time_step
