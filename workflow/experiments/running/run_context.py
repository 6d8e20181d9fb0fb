"""Where contacts are opened: one deck, one run folder, the LAMMPS process, and the time spent in it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from contact1d.potentials.table import write_table
from contact1d.workflow.deck.datafile import assemble, write_data
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.engine.session import Engine
from contact1d.workflow.experiments.running.contact import Contact

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


@dataclass
class RunContext:
    """Opens contacts of one deck, one after the other, in one folder.

    Attributes:
        deck: what is run.
        folder: the run folder; system.data and the table are in it.
        progress: told of phases and steps.
        time_limit: for each contact [s].
        lammps_seconds, lammps_cpu_seconds, steps: summed over all contacts so far.
        phase, timestep: where the latest contact is or ended.
    """

    deck: Deck
    folder: Path
    progress: Progress
    time_limit: float
    lammps_seconds: float = field(default=0.0, init=False)
    lammps_cpu_seconds: float = field(default=0.0, init=False)
    steps: int = field(default=0, init=False)
    phase: str = field(default="start", init=False)
    timestep: int = field(default=0, init=False)

    @contextmanager
    def contact(self, purpose: str = "") -> Iterator[Contact]:
        """A fresh contact at displacement 0, in a LAMMPS instance of its own; `purpose` is told to the user."""
        if purpose:
            self.progress.note(purpose)
        with Engine.session(self.folder, time_limit=self.time_limit, progress=self.progress) as session:
            try:
                yield Contact(self.deck, session)
            finally:
                self.lammps_seconds += session.lammps_seconds
                self.lammps_cpu_seconds += session.lammps_cpu_seconds
                self.steps += session.steps
                self.phase, self.timestep = session.phase, session.timestep


def write_system(deck: Deck, folder: Path) -> None:
    """Write what a deck reads: system.data, and the table if it has one."""
    scene, settings = deck.scene, deck.settings
    both = bodies(scene, settings)
    anchors = len(both[-1].anchors)
    mass = settings.plate_mass / anchors if scene.plate is not None else scene.bodies.mass
    side = SIDE_MARGIN * scene.bodies.spacing
    if scene.experiment.kind == "slide":
        side += scene.experiment.distance
    head = HEAD_MARGIN * max(scene.bodies.spacing, settings.cutoff) + 2 * abs(settings.largest_displacement)
    if scene.plate is not None and (scene.noise is not None or scene.experiment.kind == "slide"):
        head *= FLIGHT
    if scene.experiment.kind == "path":
        head -= min(0.0, *scene.experiment.values())
    least = BIN_MARGIN * settings.far
    margin = (math.ceil(max(side, least)), math.ceil(max(1.0, least)), math.ceil(max(head, least)))
    write_data(
        assemble(both, scene.neighbours is not None, scene.bodies.mass, mass, margin),
        scene.title,
        folder / "system.data",
    )
    if settings.table is not None:
        write_table(settings.table, settings.table_from, folder / "interaction.table")
