"""How many particles stand in a contact on the plane, where nobody said: so many that the lattice keeps the tolerance.

What the places of particles leave open is known before a run, from sums over cells beside JKR's integral, or over
particles at other places (`workflow.settings.centring`). It falls with the square of the spacing.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.centring import expected, left_by_centring
from contact1d.workflow.settings.settings import SettingsError, settings_for

FEWEST, MOST = 30, 5000
"""Particles in the contact radius: at FEWEST F_A and a₀ of JKR are within 3e-3; MOST keep 1e-6."""
LEFT = 0.9
"""Part of the tolerance that the lattice may use up."""
MOST_TRIES = 8


def fine_enough(scene_of: Callable[[int], Scene]) -> Scene:
    """The scene with so many particles in the contact radius that its lattice leaves LEFT of its tolerance, or MOST."""
    count = FEWEST
    for _ in range(MOST_TRIES):
        scene = scene_of(count)
        over = left_by_lattice(scene) / (LEFT * scene.accuracy.tolerance)
        if over <= 1.0 or count == MOST:
            break
        count = min(MOST, math.ceil(count * math.sqrt(over)) + 1)
    return scene


def left_by_lattice(scene: Scene) -> float:
    """The largest share of a result that its lattice leaves open; 0 where no contact can be estimated: the run says so.

    A result that is 0 has no share.
    """
    try:
        settings = settings_for(scene)
        left, sizes = left_by_centring(scene, settings), expected(scene, settings)
    except SettingsError:
        return 0.0
    return max((left[name] / abs(sizes[name]) for name in left if sizes[name]), default=0.0)
