"""The table: what LAMMPS makes of the written file, at thousands of distances at once, against the law itself."""

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.potentials.table import FEWEST_POINTS, Table, table_for, write_table
from tests.decks.written import lmp

Array = NDArray[np.float64]

ADHESIVE = DoubleExponential(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
REPULSIVE = DoubleExponential(Exponential(0.18, 0.13))
WIDE = DoubleExponential(Exponential(2.0, 0.5), Exponential(1.5, 1.0))
LAWS = {"adhesive": (ADHESIVE, 2.5, 0.07), "repulsive": (REPULSIVE, 1.8, 0.026), "wide": (WIDE, 12.0, 0.2)}
"""Law, cutoff [LU], closest distance [LU]."""

END_CONDITION = 6e-6
"""`Table.force` and LAMMPS end their splines differently: f/r times the root of a cell, over the force at r = 0, …"""
DECAY = 2 - 3**0.5
"""… times this for every cell away from the end, as any disturbance of a cubic spline."""
ROUND_OFF = 1e-12
"""Of a force, over the force at r = 0: positions in the data file have 17 digits, r² loses a few."""
MEASURED = 0.02
"""Header and LAMMPS sample the same error at different places; near its largest value it changes by less than this."""
DIGITS = 5e-3
"""The header states the error with three digits."""
RATE = 0.25
"""Distance of the measured exponent from 4, the order of a cubic spline: the second term of its expansion."""

PAIRS = """units lj
boundary f f f
atom_style atomic
pair_style table spline {points}
read_data pairs.data
pair_coeff * * interaction.table DOUBLE_EXPONENTIAL
neighbor 0.1 bin
neigh_modify exclude type 1 1 exclude type 2 2
thermo_modify norm no
run 0
write_dump all custom forces fx fz modify sort id format float %.17g
print $(pe:%.17g) file energy
"""


def in_lammps(table: Table, closest: float, r: Array, folder: Path, along: float = 0.0) -> tuple[Array, Array, float]:
    """Forces along x and z [FU] (n,) on the upper one of n pairs, each alone and r apart, and their energy.

    They lie ε apart along y, and in the plane of motion at the angle `along` from z.
    """
    write_table(table, closest, folder / "interaction.table")
    offset = float(re.search(r"e = (\S+) LU", (folder / "interaction.table").read_text())[1])
    x, far = (2.0 * table.cutoff + 1.0) * np.arange(len(r)), r.max() + 1.0
    lines = [f"# pairs\n\n{2 * len(r)} atoms\n2 atom types\n", f"-1 {x[-1] + far} xlo xhi", "-1 2 ylo yhi"]
    lines += [f"-1 {far} zlo zhi\n\nMasses\n\n1 1\n2 1\n\nAtoms # atomic\n"]
    for i, (place, distance) in enumerate(zip(x, r, strict=True)):
        upper = f"{place + distance * np.sin(along):.17g} {offset:.17g} {distance * np.cos(along):.17g}"
        lines += [f"{2 * i + 1} 1 {place:.17g} 0 0", f"{2 * i + 2} 2 {upper}"]
    (folder / "pairs.data").write_text("\n".join(lines) + "\n")
    (folder / "in.lammps").write_text(PAIRS.format(points=table.points))
    lmp(folder)
    force = np.loadtxt(folder / "forces", skiprows=9)
    assert np.array_equal(force[0::2], -force[1::2])
    return force[1::2, 0], force[1::2, 1], float((folder / "energy").read_text())


@pytest.mark.parametrize("name", LAWS)
def test_lammps_reproduces_the_law(tmp_path: Path, name: str) -> None:
    """From the closest distance to the cutoff within the error of the header; no force along x; energy as well."""
    law, cutoff, closest = LAWS[name]
    table = table_for(law, cutoff, closest, 1e-6 * float(law.force(0.0)))
    r = closest * (0.999 * cutoff / closest) ** np.linspace(0.0, 1.0, 3000)
    along, force, energy = in_lammps(table, closest, r, tmp_path)
    stated = re.search(
        r"force within (\S+) FU of the law for r >= (\S+) LU", (tmp_path / "interaction.table").read_text()
    )
    assert stated is not None
    assert float(stated[2]) == pytest.approx(closest, rel=DIGITS)
    error = np.abs(force - law.force(r)).max()
    assert error == pytest.approx(float(stated[1]), rel=DIGITS + MEASURED)
    assert float(stated[1]) <= 1e-6 * float(law.force(0.0)) * (1 + DIGITS)
    assert not along.any()
    exact = float(np.sum(law.energy(r) - law.energy(cutoff)))
    assert energy == pytest.approx(exact, abs=len(r) * error * cutoff)


@pytest.mark.parametrize("name", ["adhesive", "wide"])
def test_lammps_computes_the_tables_own_force_down_to_a_particle_on_its_opposite_and_none_beyond_the_cutoff(
    tmp_path: Path, name: str
) -> None:
    """`Table.force`, on which the error measurement stands; across the core it keeps its sign and is bounded."""
    law, cutoff, closest = LAWS[name]
    table, first = Table(law, cutoff, 8000), float(law.force(0.0))
    inside = 0.5 * closest * (2 * 0.999 * cutoff / closest) ** np.linspace(0.0, 1.0, 600)
    core = table.core * np.linspace(0.01, 3.0, 100)
    ends = [0.0, cutoff * (1 - 1e-9), cutoff * (1 + 1e-6), 1.5 * cutoff]
    along, force, _ = in_lammps(table, closest, np.concatenate([ends, core, inside]), tmp_path)
    assert along[0] == force[0] == 0.0
    assert force[1] == pytest.approx(float(law.force(cutoff)), rel=1e-5)
    assert not force[2:4].any()
    near, rest = force[4:104], force[104:]
    assert (near > 0).all()
    assert near.max() <= 1.05 * first
    out = core >= 2.0 * table.core
    assert np.abs(near[out] / law.force(core[out]) - 1.0).max() < 0.05
    cells = inside**2 / table.cell
    allowed = END_CONDITION * np.sqrt(1 + cells) * DECAY**cells + ROUND_OFF
    assert (np.abs(rest - table.force(inside)) <= first * allowed).all()


def test_error_falls_with_the_fourth_power_of_the_cell_and_the_force_in_the_plane_is_central(tmp_path: Path) -> None:
    """As measured in LAMMPS beyond a fixed distance, and as `error_beyond` says; pairs lie at 37° from the normal."""
    r, angle = 0.2 * (2.4 / 0.2) ** np.linspace(0.0, 1.0, 4000), np.arcsin(0.6)
    measured, stated = [], []
    for points in (4000, 8000):
        table = Table(ADHESIVE, 2.5, points)
        along, force, _ = in_lammps(table, 0.2, r, tmp_path, angle)
        assert 0.8 * along == pytest.approx(0.6 * force, abs=ROUND_OFF)
        measured.append(np.abs(np.hypot(along, force) - np.abs(ADHESIVE.force(r))).max())
        stated.append(table.error_beyond(0.2))
    assert -np.diff(np.log2(measured)) == pytest.approx(4.0, abs=RATE)
    assert stated == pytest.approx(measured, rel=MEASURED)


def test_the_smallest_table_is_taken_that_is_good_enough_and_its_file_is_whole(tmp_path: Path) -> None:
    """Half as many points would not do; what is read back is bitwise what was meant, and no .part is left."""
    table, path = table_for(ADHESIVE, 2.5, 0.07, 1e-4), tmp_path / "interaction.table"
    assert table.error_beyond(0.07) <= 1e-4 < Table(ADHESIVE, 2.5, table.points // 2).error_beyond(0.07)
    assert table_for(ADHESIVE, 2.5, 0.07, 1.0).points == FEWEST_POINTS
    write_table(table, 0.07, path)
    assert [file.name for file in tmp_path.iterdir()] == ["interaction.table"]
    head, rows = path.read_text().split("DOUBLE_EXPONENTIAL\n")
    assert "V(r) = 0.17999999999999999 exp(-r/0.13) - 0.089999999999999997 exp(-r/0.26000000000000001)" in head
    first, _, *body = rows.splitlines()
    distance, energy, force = table.entries()
    assert first == f"N {table.points} RSQ {distance[0]:.17g} {distance[-1]:.17g}"
    read = np.asarray([line.split() for line in body], dtype=float)
    assert np.array_equal(read.T, [np.arange(1, table.points + 1), distance, energy, force])
