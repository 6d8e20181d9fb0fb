"""system.data: the atoms and bonds of a deck, with 17 significant digits.

Atom types: 1 lower particles, 2 upper particles, 3 lower anchors, 4 upper anchors, 5 lower far anchors, 6 upper far
anchors. Bond types: 1 bulk springs, then neighbour springs if any, then long bonds if any. ASE cannot write
`atom_style bond`, and other writers round positions: hence this small one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
from numpy.typing import NDArray

from contact1d.files import whole
from contact1d.workflow.deck.lattice import Body

Integers = NDArray[np.int64]
CHUNK = 100_000
FAR_MASS = 1e-12
"""Mass of a far anchor over an anchor's: it moves with the plate and adds nothing to its inertia."""
PARTICLES = {"lower": 1, "upper": 2}
ANCHORS = {"lower": 3, "upper": 4}
FAR_ANCHORS = {"lower": 5, "upper": 6}


@dataclass(frozen=True)
class System:
    """Atoms and bonds as arrays.

    Attributes:
        types: shape (atoms,).
        positions: shape (atoms, 3) [LU].
        bonds: rows (type, atom, atom), shape (bonds, 3).
        bond_names: name of each bond type, in order.
        masses: mass of each atom type [MU], in order.
        box: lower and upper corner, shape (2, 3) [LU].
        radius: of the atoms [LU], where they are spheres; 0 where they are points.
    """

    types: Integers
    positions: NDArray[np.float64]
    bonds: Integers
    bond_names: tuple[str, ...]
    masses: tuple[float, ...]
    box: NDArray[np.float64]
    radius: float = 0.0


def assemble(
    bodies: Sequence[Body],
    neighbours: bool,
    particle_mass: float,
    anchor_mass: float,
    margin: tuple[float, float, float],
) -> System:
    """Number the atoms (particles first, lower body first) and bond them.

    Args:
        bodies: what `workflow.deck.lattice.bodies` returns.
        neighbours: whether neighbouring particles are bonded.
        particle_mass: [MU].
        anchor_mass: [MU]; the plate's mass over its number of anchors.
        margin: free space along x, y and z [LU] between atoms and the walls of the box.
    """
    count = len(bodies[0].particles)
    far = len(bodies[0].far_anchors) > 0
    groups = [(PARTICLES[b.name], b.particles) for b in bodies] + [(ANCHORS[b.name], b.anchors) for b in bodies]
    if far:
        groups += [(FAR_ANCHORS[b.name], b.far_anchors) for b in bodies]
    positions = np.concatenate([p for _, p in groups])
    types = np.concatenate([np.full(len(p), t) for t, p in groups])
    particle = np.arange(1, len(bodies) * count + 1)
    standing = len(bodies[0].anchors) == 0
    bonds = [np.empty((0, 3), dtype=np.int64)] if standing else [_bonds(1, particle, particle + len(particle))]
    names = [] if standing else ["bulk"]
    if neighbours:
        names.append("neighbours")
        inner = particle[particle % count != 0]
        bonds.append(_bonds(len(names), inner, inner + 1))
    if far:
        names.append("far")
        bonds.append(_bonds(len(names), particle, particle + 2 * len(particle)))
    masses = (particle_mass, particle_mass, anchor_mass, anchor_mass, *(2 * (FAR_MASS * anchor_mass,) if far else ()))
    space = np.asarray(margin)
    box = np.stack([positions.min(axis=0) - space, positions.max(axis=0) + space])
    return System(types, positions, np.concatenate(bonds), tuple(names), masses, box)


def write_data(system: System, title: str, path: Path) -> None:
    """Write a LAMMPS data file for `atom_style bond`, or `sphere`; whole or not at all."""
    with whole(path) as part, part.open("w") as file:
        file.write(f"# {title}\n\n{len(system.types)} atoms\n{len(system.bonds)} bonds\n")
        file.write(f"{len(system.masses)} atom types\n{len(system.bond_names)} bond types\n\n")
        for axis, low, high in zip("xyz", *system.box.tolist(), strict=True):
            file.write(f"{low:.17g} {high:.17g} {axis}lo {axis}hi\n")
        ids = np.arange(1, len(system.types) + 1)
        if system.radius > 0.0:
            # Spheres have masses of their own, by their density.
            volume = 4.0 / 3.0 * np.pi * system.radius**3
            density = np.asarray(system.masses)[system.types - 1] / volume
            diameter = np.full(len(ids), 2.0 * system.radius)
            file.write("\nAtoms # sphere\n\n")
            columns = (ids, system.types, diameter, density, *system.positions.T)
            _write_rows(file, "%d %d %.17g %.17g %.17g %.17g %.17g\n", *columns)
        else:
            file.write("\nMasses\n\n")
            file.writelines(f"{i} {mass:.17g}\n" for i, mass in enumerate(system.masses, 1))
            file.write("\nAtoms # bond\n\n")
            _write_rows(file, "%d 1 %d %.17g %.17g %.17g\n", ids, system.types, *system.positions.T)
        if len(system.bonds):
            file.write("\nBonds\n\n")
        _write_rows(file, "%d %d %d %d\n", np.arange(1, len(system.bonds) + 1), *system.bonds.T)


def _bonds(kind: int, first: Integers, second: Integers) -> Integers:
    return np.column_stack([np.full(len(first), kind), first, second])


def _write_rows(file: TextIO, template: str, *columns: NDArray[np.float64] | Integers) -> None:
    """One `%` operation per chunk: ten times quicker than numpy.savetxt, which formats row by row."""
    for start in range(0, len(columns[0]), CHUNK):
        lists = [column[start : start + CHUNK].tolist() for column in columns]
        rows = [value for row in zip(*lists, strict=True) for value in row]
        file.write(template * len(lists[0]) % tuple(rows))
