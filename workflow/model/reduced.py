"""The reduced model of a scene: the particles that run, without their neighbours."""

from __future__ import annotations

from dataclasses import replace

from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.shape import places_within
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

MARGIN = 1.5
"""Depth up to which particles of springs are counted, over the expected one: few carry a load deeper than many."""
ROUNDED = 1.0 + 1e-12
"""Length of a chain with its round-off, over it."""


def reduced(scene: Scene, settings: Settings) -> Particles:
    """The model of the particles that run, as far as the contact reaches."""
    law, bodies, deepest = settings.law, scene.bodies, settings.largest_displacement
    half = 0.5 * (settings.chains.upper - 1) * law.spacing
    reach = min(law.extent((1.0 if settings.forces.range else MARGIN) * deepest, half), bodies.reach)
    if bodies.particles != "auto" or bodies.own_count is not None:
        reach = min(reach, half)
    x = places_within(reach * ROUNDED, law.spacing, 0.5 if settings.chains.upper % 2 == 0 else 0.0)
    return replace(law.particles(x, deepest), body=bodies if bodies.profile.slow else None)
