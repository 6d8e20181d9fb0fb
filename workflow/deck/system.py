"""The input files of a deck: system.data, and where it needs them the interaction table or the adhesion cells.

Atom types: 1 lower particles, 2 upper particles, 3 lower anchors, 4 upper anchors, 5 lower far anchors, 6 upper far
anchors, 7 the driver, which pulls the plate by a spring.

Bond types: 1 bulk springs, then neighbour springs if any, then long bonds if any. ASE cannot write `atom_style bond`,
and other writers round positions: hence this small one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from contact1d.files import whole, write_whole
from contact1d.potentials.table import write_table
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects import number, sphere_radius
from contact1d.workflow.deck.lattice import Body, bodies, period
from contact1d.workflow.deck.parts import margins
from contact1d.workflow.model.motion import inertia
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Integers = NDArray[np.int64]
PARTICLES = {"lower": 1, "upper": 2}
ANCHORS = {"lower": 3, "upper": 4}
FAR_ANCHORS = {"lower": 5, "upper": 6}
DRIVER = 7


@dataclass(frozen=True)
class System:
    """Atoms and bonds as arrays.

    Attributes:
        types: atom type, 1 to 7, of each atom, in the order of atom numbers, shape (atoms,).
        positions: shape (atoms, 3) [LU].
        bonds: rows (bond type, atom number, atom number), counted from 1, shape (bonds, 3).
        bond_names: name of each bond type, in order, of "bulk", "neighbours" and "far"; () without bonds.
        masses: mass of each atom type [MU], in order.
        box: lower and upper corner, shape (2, 3) [LU].
        radius: radius of the atoms [LU] where they are spheres; 0 where they are points.
    """

    types: Integers
    positions: NDArray[np.float64]
    bonds: Integers
    bond_names: tuple[str, ...]
    masses: tuple[float, ...]
    box: NDArray[np.float64]
    radius: float


def assemble(scene: Scene, settings: Settings) -> System:
    """Return the atoms and bonds of the bodies of a scene, and the box around them.

    Atoms are numbered from 1, particles first, then anchors, far anchors and driver, each of the lower body first. The
    driver, of a cantilever, is in the middle of the upper anchors. Particles have bonds to their anchors and far
    anchors, if they have any, and with [neighbours] to each other; kinds without bonds have no type. The masses are
    those of atom types 1 to 4, with far anchors or a driver to 6, far anchors with 1e-12 of an anchor's, with a driver
    to 7, an anchor's; an anchor has its part of the mass of a plate. Around the atoms is free space up to the walls of
    the box; a periodic box is around 0 along x.
    """
    parts, driver = bodies(scene, settings), bool(scene.cantilever)
    far, groups = len(parts[-1].far_anchors) > 0, _groups(parts, driver)
    positions = np.concatenate([*groups.values()])
    types = np.repeat([*groups], [*map(len, groups.values())])
    atoms = {kind: 1 + np.flatnonzero(types == kind) for kind in groups}
    anchored = [body.name for body in parts if len(body.anchors)]
    chains = [atoms[PARTICLES[name]] for name in anchored]
    pairs = {"bulk": [(chain, atoms[ANCHORS[name]]) for name, chain in zip(anchored, chains, strict=True)]}
    if scene.neighbours:
        pairs["neighbours"] = [_nexts(chain, scene.bodies.periodic) for chain in chains]
    if far:
        pairs["far"] = [(chain, atoms[FAR_ANCHORS[name]]) for name, chain in zip(anchored, chains, strict=True)]
    names = tuple(filter(pairs.get, pairs))  # kinds without bonds have no type
    bonds = [np.empty((0, 3), dtype=np.int64)]
    bonds += [_bonds(kind, *pair) for kind, name in enumerate(names, 1) for pair in pairs[name]]
    particle_mass, plate_mass = inertia(scene, settings)
    anchor_mass = plate_mass / settings.chains.upper if scene.plate else particle_mass
    if scene.stands and scene.plate:
        # There are no anchors, so that particles have the mass of the plate.
        particle_mass = anchor_mass + particle_mass * (not scene.experiment.is_massless)
    masses: tuple[float, ...] = (particle_mass, particle_mass, anchor_mass, anchor_mass)
    if far or driver:
        masses += 2 * (1e-12 * anchor_mass,) + (anchor_mass,) * driver  # far anchors add nothing to the plate's inertia
    margin = margins(scene, settings)
    corners = np.concatenate([positions, *(body.corners for body in parts)])
    box = np.stack([corners.min(axis=0) - margin, corners.max(axis=0) + margin])
    if scene.bodies.periodic:
        half = 0.5 * period(scene, settings)
        box[:, 0] = -half, half
    radius = sphere_radius(scene, settings)
    return System(types, positions, np.concatenate(bonds), names, masses, box, radius)


def _groups(bodies: Sequence[Body], driver: bool) -> dict[int, NDArray[np.float64]]:
    """Return the positions [LU] of the atoms by their type, (N, 3) each, in the order of their numbers.

    A body without anchors has an empty group of them, (0, 3). There is no group of far anchors where the upper body
    lacks them; where it has them, that of a body without them is empty.

    `driver`: whether the middle of the upper anchors is a further atom, (1, 3).
    """
    groups = {PARTICLES[body.name]: body.particles for body in bodies}
    groups |= {ANCHORS[body.name]: body.anchors for body in bodies}
    if len(bodies[-1].far_anchors):
        groups |= {FAR_ANCHORS[body.name]: body.far_anchors for body in bodies}
    if driver:
        groups[DRIVER] = bodies[-1].anchors.mean(axis=0, keepdims=True)
    return groups


def _nexts(chain: Integers, periodic: bool) -> tuple[Integers, Integers]:
    """Return (atom numbers of particles, those of the next ones) of a chain, (n − 1,) each.

    In a periodic one the first follows the last, (n,) each.
    """
    return (chain, np.roll(chain, -1)) if periodic else (chain[:-1], chain[1:])


def write_data(system: System, title: str, path: Path) -> None:
    """Write a LAMMPS data file for `atom_style bond`, without bonds `atomic`, or `sphere` where atoms have a radius.

    Numbers are those of `system`, to 17 significant digits. Masses of spheres are in the file as diameter and density.
    With bonds each atom has the molecule ID 1, unless it is a sphere. The file is written whole or not at all, in place
    of an earlier one. `title`: its first line, behind "# ".
    """
    with whole(path) as part, part.open("w") as file:
        file.write(f"# {title}\n\n{len(system.types)} atoms\n{len(system.masses)} atom types\n")
        if system.bond_names:
            file.write(f"{len(system.bonds)} bonds\n{len(system.bond_names)} bond types\n")
        file.write("\n")
        for axis, low, high in zip("xyz", *system.box.tolist(), strict=True):
            file.write(f"{low:.17g} {high:.17g} {axis}lo {axis}hi\n")
        ids = np.arange(1, len(system.types) + 1)
        if system.radius > 0.0:
            # LAMMPS takes the mass of a sphere from its density.
            volume = 4.0 / 3.0 * np.pi * system.radius**3
            density = np.asarray(system.masses)[system.types - 1] / volume
            diameter = np.full(len(ids), 2.0 * system.radius)
            file.write("\nAtoms # sphere\n\n")
            columns = (ids, system.types, diameter, density, *system.positions.T)
            _write_rows(file, "%d %d %.17g %.17g %.17g %.17g %.17g\n", *columns)
        else:
            file.write("\nMasses\n\n")
            file.writelines(f"{i} {mass:.17g}\n" for i, mass in enumerate(system.masses, 1))
            style, template = ("bond", "%d 1 %d") if system.bond_names else ("atomic", "%d %d")
            file.write(f"\nAtoms # {style}\n\n")
            _write_rows(file, template + " %.17g %.17g %.17g\n", ids, system.types, *system.positions.T)
        if len(system.bonds):
            file.write("\nBonds\n\n")
        _write_rows(file, "%d %d %d %d\n", np.arange(1, len(system.bonds) + 1), *system.bonds.T)


def _bonds(kind: int, first: Integers, second: Integers) -> Integers:
    """Return rows (type `kind`, first atom, second atom), (n, 3), one for each pair of atom numbers."""
    return np.column_stack([np.full(len(first), kind), first, second])


def _write_rows(file: TextIO, template: str, *columns: NDArray[np.float64] | Integers, at_once: int = 100_000) -> None:
    """Write rows of numbers, one for each element of the columns, (n,) each, by a `template` with % and its line break.

    They are formatted from lists, `at_once` rows at a time: several times quicker than numpy.savetxt, which uses
    arrays.
    """
    for start in range(0, len(columns[0]), at_once):
        lists = [column[start : start + at_once].tolist() for column in columns]
        file.write("".join(map(template.__mod__, zip(*lists, strict=True))))


def write_system(deck: Deck, folder: Path) -> None:
    """Write the input files of a deck to an existing folder, in deck units; each whole, in place of an earlier one.

    These are system.data, with an interaction interaction.table, with springs between neighbours neighbours.moves, and
    the file of constants of each particle that a contact law needs, such as adhesion.cells, where it has any.
    """
    scene, settings = deck.written
    system = assemble(scene, settings)
    write_data(system, scene.title, folder / "system.data")
    if scene.neighbours:
        moves = np.concatenate([body.moves for body in bodies(scene, settings)])
        anchors = 1 + np.flatnonzero(np.isin(system.types, [*ANCHORS.values()]))
        _write_columns({"x": moves[:, 0], "z": moves[:, 2]}, folder / "neighbours.moves", anchors)
    if settings.forces.table:
        write_table(settings.forces.table, settings.forces.table_from, folder / "interaction.table")
    x, unit = bodies(deck.scene, deck.settings)[0].particles[:, 0], deck.units.to_deck(1.0, "LU")
    law = deck.settings.law
    if columns := law.columns(deck.scene.bodies, x):
        _write_columns({name: unit**power * column for name, (power, column) in columns.items()}, folder / law.file)


def _write_columns(
    columns: Mapping[str, NDArray[np.float64]], path: Path, atoms: Sequence[int] | Integers | None = None
) -> None:
    """Write numbers of atoms, (n,) by name, for `variable atomfile`, the columns below each other.

    Each is a block: a comment with its name, the number n, and n lines of atom number and value, which reads back to
    the same double. The file is written whole or not at all. `atoms`: their numbers, (n,); by default from 1 on.
    """
    blocks = []
    for name, column in columns.items():
        numbers = range(1, 1 + len(column)) if atoms is None else atoms
        rows = "".join(f"{i} {number(value)}\n" for i, value in zip(numbers, column, strict=True))
        blocks.append(f"# {name}\n{len(column)}\n{rows}")
    write_whole(path, "\n".join(blocks))
