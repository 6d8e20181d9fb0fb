"""Masses with which the timesteps of a slide are exact to second order.

LAMMPS evaluates the drag of a step with the velocity half a step before: m a = F − γ (v − a Δt/2). With m + γ Δt/2 in
the place of m that is m a = F − γ v. Otherwise a slip is as much too light as its drag is strong, which at usual
timesteps is percents of its time and tenths of percents of a mean friction. The first half step of a row has the right
velocity by itself, and so its share of the row is left out.
"""

from __future__ import annotations

from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings


def inertia(scene: Scene, settings: Settings) -> tuple[float, float]:
    """(mass of a particle, of the plate) in LAMMPS [MU]: the scene's own but in a slide without noise.

    With noise the thermostat's own error, of the same order, is bounded by the timestep.
    """
    late = 0.0
    if settings.drive and scene.noise is None:
        late = 0.5 * settings.time_step * (1.0 - 0.5 / settings.drive[0].steps)
    return scene.bodies.mass + settings.damping * late, settings.plate_mass + settings.plate_damping * late
