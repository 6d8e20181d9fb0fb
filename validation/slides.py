"""A slide as the independent integrator has it."""

from __future__ import annotations

import numpy as np

from validation.doors import Scene, Settings, Slide, start_offset
from validation.figures import Array
from validation.references.slide import SlideModel


def law_of(scene: Scene) -> tuple[float, float, float, float]:
    """A [FU·LU], a [LU], B [FU·LU], b [LU] of the scene's law."""
    terms = scene.interaction
    assert terms is not None
    assert terms.attraction is not None
    return terms.repulsion.amplitude, terms.repulsion.range, terms.attraction.amplitude, terms.attraction.range


def slide_model(scene: Scene, settings: Settings, beyond: int = 0) -> SlideModel:
    """Places, springs and drags of a slide, with the values that it leaves open; a lower body longer by so many."""
    bodies = scene.bodies
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)

    def row(count: int, spacing: float) -> Array:
        return np.asarray((np.arange(count) - 0.5 * (count - 1)) * spacing, dtype=np.float64)

    below, along = row(settings.lower_particles + beyond, bodies.spacing), row(settings.particles, bodies.own_spacing)
    height = settings.rest + bodies.profile.height(along)
    upper = np.column_stack([along + start_offset(scene, settings), height])
    return SlideModel(
        lower=np.column_stack([below, np.zeros_like(below)]),
        upper=upper,
        law=law_of(scene),
        cutoff=settings.cutoff,
        normal_stiffness=scene.bulk_stiffness,
        tangential_stiffness=scene.tangential_stiffness,
        mass=bodies.mass,
        plate_mass=settings.plate_mass,
        drag=settings.damping,
        plate_drag=settings.plate_damping,
        cantilever_stiffness=scene.cantilever.stiffness,
        velocity=scene.cantilever.velocity,
        normal_force=scene.experiment.normal_force,
        rigid=bodies.lower == "rigid_chain",
        period=settings.lower_particles * bodies.spacing if bodies.periodic else 0.0,
        neighbours=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
    )
