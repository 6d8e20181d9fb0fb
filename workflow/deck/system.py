"""What a deck reads, in files: system.data, and the table or what particles know of their cells if it has these."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from contact1d.files import write_whole
from contact1d.potentials.table import write_table
from contact1d.workflow.deck.datafile import assemble, write_data
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects.base import number, sphere_radius
from contact1d.workflow.deck.lattice import bodies, period
from contact1d.workflow.deck.parts import margins
from contact1d.workflow.model.adhesion import cells_of
from contact1d.workflow.model.motion import inertia

CELLS = "adhesion.cells"


def write_system(deck: Deck, folder: Path) -> None:
    """Write what a deck reads: system.data, and interaction.table or adhesion.cells if it has one."""
    scene, settings = deck.written
    both = bodies(scene, settings)
    anchors = settings.particles
    particle, plate = inertia(scene, settings)
    mass = plate / anchors if scene.plate is not None else particle
    if scene.stands and scene.plate is not None:
        particle += mass  # there are no anchors that would have it
    system = assemble(
        both,
        scene.neighbours is not None,
        particle,
        mass,
        margins(scene, settings),
        driver=scene.cantilever is not None,
        period=period(scene, settings) if scene.bodies.periodic else 0.0,
    )
    write_data(replace(system, radius=sphere_radius(scene, settings)), scene.title, folder / "system.data")
    if settings.table is not None:
        write_table(settings.table, settings.table_from, folder / "interaction.table")
    if scene.adhesion is not None:
        _write_cells(deck, folder / CELLS)


def _write_cells(deck: Deck, path: Path) -> None:
    """The columns of `workflow.model.adhesion.Cells` below each other, as `variable atomfile` reads them."""
    x = bodies(deck.scene, deck.settings)[0].particles[:, 0]
    cells = cells_of(deck.scene, deck.settings.estimate, x)
    lengths = {name: deck.units.to_deck(1.0, "LU") * getattr(cells, name) for name in ("hold", "width", "fall")}
    blocks = []
    for name, column in (lengths | {"bend": cells.bend}).items():
        rows = "".join(f"{i} {number(value)}\n" for i, value in enumerate(column, 1))
        blocks.append(f"# {name}\n{len(x)}\n{rows}")
    write_whole(path, "\n".join(blocks))
