"""What a deck reads, in files: system.data, and the table if it has one."""

from __future__ import annotations

import math
from pathlib import Path

from contact1d.potentials.table import write_table
from contact1d.workflow.deck.datafile import assemble, write_data
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies

SIDE_MARGIN = 20.0
"""Free space beside the chains over the spacing, beyond what a slide needs."""
HEAD_MARGIN = 10.0
"""Free space above and below the bodies over the spacing and over the cutoff.

LAMMPS bins the whole box, five integers for a square of half a cutoff: of long chains it is most of the memory.
"""
FLIGHT = 10.0
"""How much more a free plate needs that may fly off between two looks; under a held load LAMMPS stops it."""

BIN_MARGIN = 1e-3
"""Least free space over the length of a long bond: LAMMPS wants no box much thinner than its bins."""


def write_system(deck: Deck, folder: Path) -> None:
    """Write what a deck reads: system.data, and the table if it has one."""
    scene, settings = deck.written
    both = bodies(scene, settings)
    anchors = len(both[-1].anchors)
    mass = settings.plate_mass / anchors if scene.plate is not None else scene.bodies.mass
    side = SIDE_MARGIN * scene.bodies.spacing + scene.experiment.way
    head = HEAD_MARGIN * max(scene.bodies.spacing, settings.cutoff) + 2 * abs(settings.largest_displacement)
    if scene.plate is not None and (scene.noise is not None or scene.experiment.motion_is_result):
        head *= FLIGHT
    head -= min([0.0, *scene.experiment.places()])
    least = BIN_MARGIN * settings.far
    margin = (math.ceil(max(side, least)), math.ceil(max(1.0, least)), math.ceil(max(head, least)))
    write_data(
        assemble(both, scene.neighbours is not None, scene.bodies.mass, mass, margin),
        scene.title,
        folder / "system.data",
    )
    if settings.table is not None:
        write_table(settings.table, settings.table_from, folder / "interaction.table")
