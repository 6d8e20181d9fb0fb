"""What a deck reads, in files: system.data, and the table if it has one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from contact1d.potentials.table import write_table
from contact1d.workflow.deck.box import margins
from contact1d.workflow.deck.datafile import assemble, write_data
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects.base import sphere_radius
from contact1d.workflow.deck.lattice import bodies, period


def write_system(deck: Deck, folder: Path) -> None:
    """Write what a deck reads: system.data, and the table if it has one."""
    scene, settings = deck.written
    both = bodies(scene, settings)
    anchors = settings.particles
    mass = settings.plate_mass / anchors if scene.plate is not None else scene.bodies.mass
    system = assemble(
        both,
        scene.neighbours is not None,
        scene.bodies.mass,
        mass,
        margins(scene, settings),
        driver=scene.cantilever is not None,
        period=period(scene, settings) if scene.bodies.periodic else 0.0,
    )
    write_data(replace(system, radius=sphere_radius(scene, settings)), scene.title, folder / "system.data")
    if settings.table is not None:
        write_table(settings.table, settings.table_from, folder / "interaction.table")
