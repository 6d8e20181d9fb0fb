"""A plate that moves freely on the reduced model of a contact: oscillation under a load, and impact.

d [LU] and F [FU] are positive in compression, M is the mass of the plate and m that of each of N particles [MU].
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from contact1d.workflow.laws.numerics import value_at
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, Path
from contact1d.workflow.model.motion import inertia
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

MOST_STEPS = 20_000
"""Most timesteps of an oscillation, beyond which it has ended in equilibrium, and most states of an impact."""
STRETCHES = 60
"""States of an impact in the time of a free motion to the deepest displacement."""
FLIGHT = 3
"""States in free flight that give its velocity."""


def swing(scene: Scene, settings: Settings, model: Particles, start: float, load: float, duration: float) -> Array:
    """Return two displacements [LU], (2,), of a plate under a load [FU]: after one timestep, and after `duration` [TU].

        (M + N m) d″ = load − F(d) − c d′

    from rest at `start` [LU]; displacement and load are positive in compression. F(d) is the force of the reduced model
    with its limit points; timesteps are those of LAMMPS (velocity Verlet, drag half a step late). Where there are more
    than 20 000 timesteps, both numbers are the equilibrium under the load.

    Raises:
        IndexError: the duration is half a timestep or less.
    """
    total = sum(settings.steps_of(duration))
    if total > MOST_STEPS:
        return np.full(2, model.displacement_at(load))
    particle, plate = inertia(scene, settings)
    mass, drag, step = plate + settings.chains.upper * particle, settings.drag(), settings.motion.time_step
    path, displacement, velocity, contact_force = np.empty(total), start, 0.0, model.force_in_time()
    force = load - value_at(model.held, displacement)
    for i in range(total):
        velocity += 0.5 * step * force / mass
        displacement += step * velocity
        force = load - drag * velocity - contact_force(displacement, step, velocity + 0.5 * step * force / mass)
        velocity += 0.5 * step * force / mass
        path[i] = displacement
    return path[[0, total - 1]]


def stretch(settings: Settings, velocity: float) -> int:
    """Return the number of timesteps, one at least, from one state of an impact to the next.

    A time of free motion at `velocity` [LU/TU] over the largest expected displacement has 60 states.
    """
    return max(1, round(settings.largest_displacement / velocity / STRETCHES / settings.motion.time_step))


def is_over(displacement: Sequence[float], force: Sequence[float], flight: int = FLIGHT) -> bool:
    """Return whether a body has rebounded, or moves down again after it moved up.

    It has rebounded where the last `flight` states have no force and the displacement of the last is less than that
    before. Else its direction has turned at least twice, with or without contact; equal displacements are no turn.

    Args:
        displacement: of the states so far, two at least [LU], compression positive.
        force: of the contact in these states [FU].
        flight: number of last states without a force.
    """
    directions = np.sign(np.diff(displacement))
    separated = not any(force[-flight:]) and directions[-1] < 0.0
    return bool(separated or np.count_nonzero(np.diff(directions[directions != 0.0])) > 1)


def impact(scene: Scene, settings: Settings, model: Particles, velocity: float, dense: int = 1) -> Path:
    """Return the path of an impact on the reduced model, from displacement 0 at a `velocity` [LU/TU] to free flight.

    It also ends where the body moves down again, and after 20 000 states. Displacements [LU], times [TU] from 0 on and
    velocities [LU/TU], (m,), positive in approach, have `dense` states for each one of a run in LAMMPS. Velocity Verlet
    of M d″ = −F(d, time), without drag, takes 16 steps for each state of a run. Of an oblique impact it is also that of
    the contact point along x, u″ = −F_t (1 + m l²/I)/M, with the velocity v_t − l ω at first.

    Raises:
        StopIteration: the scene has no plate.
        AssertionError: its mass M is automatic.
    """
    steps, time = max(1, 16 // dense), stretch(settings, velocity) * settings.motion.time_step / dense
    step, contact_force, mass = time / steps, model.force_in_time(), scene.impact_mass
    displacement = force = along = shear = 0.0
    slip, lighter, shear_force = scene.slip_velocity, scene.slip_mass, model.shear_in_time()
    displacements, forces, velocities, places = [0.0], [0.0], [velocity], [0.0]
    while len(displacements) < FLIGHT * dense or not is_over(displacements, forces, FLIGHT * dense):
        for _ in range(steps):
            velocity -= 0.5 * step * force / mass
            slip -= 0.5 * step * shear / lighter
            along += step * slip
            before, displacement = displacement, displacement + step * velocity
            if model.limits and displacement < model.limits[0] <= before:  # the force ends there, within the step
                velocity -= step * force / mass * ((before - model.limits[0]) / (before - displacement) - 0.5)
            force = contact_force(displacement, step, velocity - 0.5 * step * force / mass)
            velocity -= 0.5 * step * force / mass
            shear = shear_force(displacement, along)
            slip -= 0.5 * step * shear / lighter
        displacements.append(displacement)
        forces.append(force)
        velocities.append(velocity)
        places.append(along)
        if len(displacements) > MOST_STEPS:
            break
    path = np.asarray(displacements)
    return Path(path, np.asarray(places), time * np.arange(float(path.size)), np.asarray(velocities))
