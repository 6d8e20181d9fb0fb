"""Random slides, curved and flat, with the friction that an independent integrator finds for them."""

from __future__ import annotations

from dataclasses import fields, replace
from random import Random
from typing import Any

import numpy as np

from contact1d.analysis import friction
from validation.doors import Scene, Settings
from validation.references.slide import Integrator, Trace
from validation.slides import slide_model

SEED = 5
CURVED = 0.5
"""Share of the slides of a curved body."""
RESIDUAL = 1e-6
"""Force over that of the law, B/b, below which the integrator's bodies are at rest before they slide."""


def random_slide(random: Random) -> dict[str, Any]:
    """A slide of some particles, by a law, springs, drags, a load and a velocity that are drawn."""
    spacing, force = 2.0 ** random.uniform(-2.0, 2.0), 10.0 ** random.uniform(-1.0, 1.0)
    stiffness, curved = force / spacing, random.random() < CURVED
    mass = 10.0 ** random.uniform(-1.0, 1.0)
    clock = (mass / stiffness) ** 0.5
    amplitude, reach = force * spacing * random.uniform(0.3, 0.7), spacing * random.uniform(0.9, 1.1)
    bodies: dict[str, Any] = {"spacing": spacing, "mass": mass}
    if curved:
        count = 20
        bodies |= {
            "particles": 48, "upper_particles": count, "upper_offset": spacing * random.uniform(0.3, 0.7),
            "profile": {"kind": "parabola", "radius": spacing * random.uniform(6.0, 14.0)},
            "bulk_stiffness": stiffness * random.uniform(2.0, 5.0),
        }  # fmt: skip
        load, touching = 4.0 * amplitude / spacing * random.uniform(-0.2, 0.6), 4
    else:
        below, count = random.choice([(4, 4), (6, 6), (6, 3), (3, 1), (4, 2), (8, 5)])
        bodies |= {
            "particles": below, "upper_particles": count, "upper_spacing": below / count * spacing,
            "lower": random.choice(["rigid_chain", "particles"]), "periodic": True, "profile": {"kind": "flat"},
            "bulk_stiffness": stiffness * random.uniform(1.0, 4.0),
        }  # fmt: skip
        load, touching = count * amplitude / spacing * random.uniform(-0.1, 0.5), count
    bodies["bulk_stiffness_tangential"] = random.uniform(0.6, 1.0) * bodies["bulk_stiffness"]
    return {
        "title": "random slide",
        "bodies": bodies,
        "interaction": {
            "repulsion": {"amplitude": 2.0 * amplitude, "range": 0.5 * reach},
            "attraction": {"amplitude": amplitude, "range": reach},
        },
        "horizontal": {},
        "damping": {"coefficient": random.uniform(0.05, 0.3) * stiffness * clock},
        "plate": {
            "free": ["x", "z"],
            "mass": random.uniform(0.5, 2.0) * count * mass,
            "damping": random.uniform(0.0, 0.1) * count * stiffness * clock,
        },
        "cantilever": {
            "stiffness": touching * stiffness * 10.0 ** random.uniform(-1.7, -0.5),
            "velocity": spacing / clock * 10.0 ** random.uniform(-2.6, -1.5),
        },
        "accuracy": {"tolerance": 10.0 ** random.uniform(-3.0, -2.0)},
        "experiment": {"kind": "slide", "normal_force": load, "distance": spacing * random.uniform(6.0, 10.0)},
    }


def integrated(scene: Scene, settings: Settings) -> Trace:
    """All legs by the independent integrator, in the program's timesteps, measured where the program measures."""
    assert scene.interaction is not None
    assert scene.interaction.attraction is not None
    law = scene.interaction.attraction
    body = Integrator(slide_model(scene, settings))
    body.settle(settings.time_step, RESIDUAL * law.amplitude / law.range, drag=settings.calm_damping)
    legs, drive, time, impulse = [], 0.0, 0.0, 0.0
    for leg in settings.drive:
        trace = body.run(leg.rows * leg.steps, leg.time_step, leg.velocity, start=drive, every=leg.steps)
        drive += leg.velocity * leg.rows * leg.row_time
        legs.append(replace(trace, time=time + trace.time, impulse=impulse + trace.impulse))
        time, impulse = float(legs[-1].time[-1]), float(legs[-1].impulse[-1])
    return Trace(*(np.concatenate([getattr(leg, one.name) for leg in legs]) for one in fields(Trace)))


def mean_friction(trace: Trace, period: float) -> float:
    """Mean of the friction [FU] over the last whole periods, one less than there are or half of them."""
    blocks = friction.block_means(trace.time, trace.impulse, period, trace.friction)
    return float(blocks[min(blocks.size - 1, max(1, blocks.size // 2)) :].mean())
