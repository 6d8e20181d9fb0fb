"""A slide as the independent integrator has it."""

import math
from dataclasses import fields, replace

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from validation.doors import Scene, Settings, Slide, law_of, start_offset
from validation.figures import Array
from validation.references.slide import Integrator, SlideModel, Trace


def slide_model(scene: Scene, settings: Settings) -> SlideModel:
    """Places, springs and drags of a slide, with the values that it leaves open."""
    bodies = scene.bodies
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)

    def row(count: int, spacing: float) -> Array:
        return (np.arange(count, dtype=np.float64) - 0.5 * (count - 1)) * spacing

    below, along = row(settings.chains.lower, bodies.spacing), row(settings.chains.upper, bodies.own_spacing)
    height = settings.forces.rest + bodies.profile.height(along)
    return SlideModel(
        lower=np.column_stack([below, np.zeros_like(below)]),
        upper=np.column_stack([along + start_offset(scene, settings), height]),
        law=law_of(scene),
        cutoff=settings.forces.cutoff,
        normal_stiffness=scene.bulk_stiffness,
        tangential_stiffness=scene.tangential_stiffness,
        mass=bodies.mass,
        plate_mass=settings.motion.plate_mass,
        drag=settings.motion.damping,
        plate_drag=settings.motion.plate_damping,
        cantilever_stiffness=scene.cantilever.stiffness,
        velocity=scene.cantilever.velocity,
        normal_force=scene.experiment.normal_force,
        rigid=bodies.lower == "rigid_chain",
        period=settings.chains.lower * bodies.spacing if bodies.periodic else 0.0,
        neighbours=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
    )


RESIDUAL = 1e-6
"""Force over that of the law, B/b, below which the integrator's bodies are at rest before they slide."""


def integrated(scene: Scene, settings: Settings, residual: float = 0.0, rows: float = math.inf) -> Trace:
    """All legs by the independent integrator, in the program's timesteps, measured where the program measures.

    Args:
        scene, settings: of the slide.
        residual: force [FU] below which the bodies are at rest before they slide; 0: RESIDUAL of the law's.
        rows: of a leg, at most.
    """
    _, _, amplitude, reach = law_of(scene)
    body, motion = Integrator(slide_model(scene, settings)), settings.motion
    body.settle(motion.time_step, residual or RESIDUAL * amplitude / reach, drag=motion.settling_damping)
    legs, drive, time, impulse = [], 0.0, 0.0, 0.0
    for leg in motion.drive:
        steps = leg.steps * int(min(leg.rows, rows))
        trace = body.run(steps, leg.time_step, leg.velocity, start=drive, every=leg.steps)
        drive += leg.velocity * leg.rows * leg.row_time
        legs.append(replace(trace, time=time + trace.time, impulse=impulse + trace.impulse))
        time, impulse = legs[-1].time[-1], legs[-1].impulse[-1]
    return Trace(*(np.concatenate([getattr(leg, one.name) for leg in legs]) for one in fields(Trace)))


def mean_friction(trace: Trace, period: float) -> float:
    """Mean of the friction [FU] over the last whole periods, one less than there are or half of them."""
    count = math.floor((trace.time[-1] - trace.time[0]) / period * (1.0 + 1e-9))
    ends = np.maximum(trace.time[-1] - period * np.arange(count, -1, -1), trace.time[0])
    blocks = np.diff(CubicHermiteSpline(trace.time, trace.impulse, trace.friction)(ends)) / period
    return float(blocks[min(count - 1, max(1, count // 2)) :].mean())
