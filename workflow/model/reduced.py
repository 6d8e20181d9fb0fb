"""The reduced model of a scene: the particles that run, without their neighbours."""

from __future__ import annotations

from dataclasses import replace

from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.shape import positions_within
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def reduced(scene: Scene, settings: Settings) -> Particles:
    """Return the particles of the upper chain, without their neighbours, with the contact law of the settings.

    Where bodies adhere they go to the end of the chain. Else, of an automatic chain, they go as far as forces reach at
    the largest expected displacement (on a rigid plane 1.5 times that), also beyond the chain; of a given number of
    particles, and of a body with a vertical edge, not beyond the chain. None lies beyond the end of the profile. The
    apex is midway between two where the chain has an even number, else at one.
    """
    law, bodies, deepest = settings.law, scene.bodies, settings.largest_displacement
    half = 0.5 * (settings.chains.upper - 1) * law.spacing
    # On another lattice fewer springs may carry the load, up to 1.5 times as deep as expected.
    margin = 1.0 if settings.forces.range else 1.5
    reach = min(law.extent(margin * deepest, half), bodies.reach)
    if bodies.particles != "auto" or bodies.own_count is not None:
        reach = min(reach, half)
    round_off = 1.0 + 1e-12  # so that a chain has its last particle
    x = positions_within(reach * round_off, law.spacing, 0.5 if settings.chains.upper % 2 == 0 else 0.0)
    return replace(law.particles(x, deepest), body=bodies if bodies.profile.slow else None)
