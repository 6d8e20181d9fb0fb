"""A slide's scene as the independent integrator has it."""

from __future__ import annotations

import numpy as np

from contact1d.analysis.reference.slide import SlideModel
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.settings.settings import Settings


def slide_model(scene: Scene, settings: Settings) -> SlideModel:
    """Places, springs and drags of a scene that gives `bodies.upper_offset`, with the values that were left open."""
    bodies, terms = scene.bodies, scene.interaction
    assert terms is not None
    assert terms.attraction is not None
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)
    assert bodies.upper_offset is not None

    def row(count: int, spacing: float) -> np.ndarray:
        return (np.arange(count) - 0.5 * (count - 1)) * spacing

    below, along = row(settings.lower_particles, bodies.spacing), row(settings.particles, bodies.own_spacing)
    upper = np.column_stack([along + bodies.upper_offset, settings.rest + bodies.profile.height(along)])
    return SlideModel(
        lower=np.column_stack([below, np.zeros_like(below)]),
        upper=upper,
        law=(
            terms.repulsion.amplitude,
            terms.repulsion.range,
            terms.attraction.amplitude,
            terms.attraction.range,
        ),
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
