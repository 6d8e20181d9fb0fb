"""The box around the bodies, and the bins of it in which LAMMPS looks for neighbours.

LAMMPS bins the whole box, five integers for a cube of half the reach of the forces: of long chains that is most of the
memory, and of a steep body, whose ends rise far beyond all forces, more than there is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contact1d.workflow.deck.effects.base import LEAST_SLENDERNESS
from contact1d.workflow.deck.effects.interaction import SKIN
from contact1d.workflow.deck.lattice import Body
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

SIDE_MARGIN = 20.0
"""Free space beside the chains over the spacing, beyond what a slide needs."""
HEAD_MARGIN = 10.0
"""Free space above and below the bodies over the spacing and over the cutoff."""
FLIGHT = 10.0
"""How much more a free plate needs that may fly off between two looks; under a held load LAMMPS stops it."""
BIN_MARGIN = 1e-3
"""Least free space over the length of a long bond: LAMMPS wants no box much thinner than its bins."""
MOST_BINS = 4_000_000
"""Bins beyond which they are made larger: some 100 MB of them."""

Lengths = tuple[float, float, float]


def margins(scene: Scene, settings: Settings) -> Lengths:
    """Free space along x, y and z [LU] between the bodies and the walls of the box."""
    side = SIDE_MARGIN * scene.bodies.spacing + scene.experiment.way
    head = HEAD_MARGIN * max(scene.bodies.spacing, settings.cutoff) + 2 * abs(settings.largest_displacement)
    if scene.plate is not None and (scene.noise is not None or scene.experiment.motion_is_result):
        head *= FLIGHT
    head -= min([0.0, *scene.experiment.places()])
    least = max(BIN_MARGIN * settings.far, LEAST_SLENDERNESS * reach(scene, settings))
    side, flat, head = (math.ceil(max(margin, least)) for margin in (side, 1.0, head))
    return side, flat, head


def reach(scene: Scene, settings: Settings) -> float:
    """Distance [LU] up to which LAMMPS lists neighbours."""
    return settings.cutoff + SKIN * scene.bodies.spacing


def bin_size(bodies: Sequence[Body], scene: Scene, settings: Settings, chosen: float = 0.0) -> float:
    """Edge of a bin [LU] with which the box has MOST_BINS at most; 0 where it has no more with LAMMPS's own choice.

    Args:
        bodies: of the deck.
        scene, settings: of the deck.
        chosen: edge [LU] that an effect has chosen, 0 where none has.
    """
    groups = [group for body in bodies for group in (body.particles, body.anchors, body.far_anchors) if len(group)]
    low, high = (np.asarray([end(group, axis=0) for group in groups]) for end in (np.min, np.max))
    edges = high.max(axis=0) - low.min(axis=0) + 2.0 * np.asarray(margins(scene, settings), dtype=np.float64)
    own = edge = max(chosen, 0.5 * reach(scene, settings))
    while np.log(np.maximum(edges / edge, 1.0)).sum() > math.log(MOST_BINS):  # the number itself may overflow
        edge *= 2.0
    return 0.0 if edge == own else min(edge, float(edges.min()) / LEAST_SLENDERNESS)
