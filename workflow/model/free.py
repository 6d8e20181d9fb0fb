"""A plate that moves freely on the model of a contact: the swing under a load, and an impact."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Path
from contact1d.workflow.model.motion import inertia
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]


MOST_STEPS = 20_000
"""Timesteps of a swing that is followed; a longer one ends in equilibrium."""


def swing(scene: Scene, settings: Settings, model: Particles, start: float, load: float, duration: float) -> Array:
    """Displacements [LU] of a plate under a load [FU] after the first timestep, and after a time [TU], (2,).

        (M + N m) d″ = load − F(d) − c d′

    from rest at `start` [LU], with F(d) and limit points of the reduced model, in LAMMPS's own steps (velocity Verlet,
    drag half a step late).
    """
    total = sum(settings.steps_of(duration))
    if total > MOST_STEPS:
        return np.full(2, model.displacement_at(load))
    particle, plate = inertia(scene, settings)
    mass, drag, step = plate + settings.chains.upper * particle, settings.drag(), settings.motion.time_step
    path, place, velocity, feel = np.empty(total), start, 0.0, model.feeling()
    force = load - float(model.held(np.asarray([place]))[0])
    for i in range(total):
        velocity += 0.5 * step * force / mass
        place += step * velocity
        force = load - drag * velocity - feel(place, step, velocity + 0.5 * step * force / mass)
        velocity += 0.5 * step * force / mass
        path[i] = place
    return path[[0, total - 1]]


STRETCHES, COARSER = 60, 16
"""States of an impact in the time of a fall to the deepest displacement; timesteps of the model in each."""


FLIGHT = 3
"""States in free flight that show its velocity."""


def stretch(settings: Settings, velocity: float) -> int:
    """Timesteps from state to state of an impact at a velocity [LU/TU]."""
    return max(1, round(settings.largest_displacement / velocity / STRETCHES / settings.motion.time_step))


def is_over(displacement: Sequence[float], force: Sequence[float], flight: int = FLIGHT) -> bool:
    """Whether a body that has hit flies off, so many states long, or comes down again without having parted."""
    ways = np.sign(np.diff(displacement))
    parted = not any(force[-flight:]) and ways[-1] < 0.0
    return bool(parted or np.count_nonzero(np.diff(ways[ways != 0.0])) > 1)


def impact(scene: Scene, settings: Settings, model: Particles, velocity: float, dense: int = 1) -> Path:
    """The model's states of an impact, from touch on at the times of a run, or `dense` ones for each.

    It takes longer timesteps: with `feeling` F, velocity Verlet of M d″ = −F.
    """
    assert scene.plate
    assert scene.plate.mass != "auto"
    each, time = max(1, COARSER // dense), stretch(settings, velocity) * settings.motion.time_step / dense
    step, feel, place, force, mass = time / each, model.feeling(), 0.0, 0.0, scene.plate.mass
    places, forces, velocities = [0.0], [0.0], [velocity]
    while len(places) < FLIGHT * dense or not is_over(places, forces, FLIGHT * dense):
        for _ in range(each):
            velocity -= 0.5 * step * force / mass
            before, place = place, place + step * velocity
            if model.limits and place < model.limits[0] <= before:  # the force ends there, within the step
                velocity -= step * force / mass * ((before - model.limits[0]) / (before - place) - 0.5)
            force = feel(place, step, velocity - 0.5 * step * force / mass)
            velocity -= 0.5 * step * force / mass
        places.append(place)
        forces.append(force)
        velocities.append(velocity)
        if len(places) > MOST_STEPS:
            break
    path = np.asarray(places)
    return Path(path, np.zeros_like(path), time * np.arange(float(path.size)), np.asarray(velocities))
