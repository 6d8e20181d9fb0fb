"""The table: what LAMMPS makes of the written file, at thousands of distances at once, against the law itself."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.potentials import table as table_module
from contact1d.potentials.table import MOST_POINTS, Table, table_for, write_table
from contact1d.workflow.engine.session import Session

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
BEND = 1e-6
"""Of the force at r = 0: next to its largest tension a force is not between its neighbours on the grid."""
RATE = 0.25
"""Distance of the measured exponent from 4, the order of a cubic spline: the second term of its expansion."""

PAIRS = """units lj
dimension 3
boundary f f f
atom_style atomic
pair_style table spline {points}
read_data pairs.data
pair_coeff * * interaction.table DOUBLE_EXPONENTIAL
neighbor 0.1 bin
neigh_modify exclude type 1 1 exclude type 2 2
thermo_modify norm no
run 0
"""


def lammps_forces(session: Session, table: Table, closest: float, r: Array) -> tuple[Array, Array]:
    """Forces [FU] (n, 3) on the upper one of n pairs, each alone, r apart along z and ε along y; and their energy."""
    write_table(table, closest, session.folder / "interaction.table")
    text = (session.folder / "interaction.table").read_text()
    offset = float(re.search(r"e = (\S+) LU", text)[1])
    apart = 2.0 * table.cutoff + 1.0
    x = apart * np.arange(len(r))
    lines = [f"# pairs\n\n{2 * len(r)} atoms\n2 atom types\n", f"{-1.0} {x[-1] + 1.0} xlo xhi", "-1 2 ylo yhi"]
    lines += [f"-1 {r.max() + 1.0} zlo zhi\n\nMasses\n\n1 1\n2 1\n\nAtoms # atomic\n"]
    for i in range(len(r)):
        lines += [f"{2 * i + 1} 1 {x[i]:.17g} 0 0", f"{2 * i + 2} 2 {x[i]:.17g} {offset:.17g} {r[i]:.17g}"]
    (session.folder / "pairs.data").write_text("\n".join(lines) + "\n")
    reading = session.measure("clear\n" + PAIRS.format(points=table.points), ("pe",), ("f",))
    force: Array = reading.atoms["f"]
    assert np.array_equal(force[0::2], -force[1::2])
    return force[1::2], np.asarray(reading.values[0])


@pytest.mark.parametrize("name", LAWS)
def test_lammps_reproduces_the_law(session: Session, name: str) -> None:
    """From the closest distance to the cutoff within the error of the header; no force along x; energy as well."""
    law, cutoff, closest = LAWS[name]
    table = table_for(law, cutoff, closest, 1e-6 * float(law.force(0.0)))
    r = closest * (0.999 * cutoff / closest) ** np.linspace(0.0, 1.0, 3000)
    force, energy = lammps_forces(session, table, closest, r)
    header = (session.folder / "interaction.table").read_text().splitlines()
    stated = re.search(r"force within (\S+) FU of the law for r >= (\S+) LU", "\n".join(header))
    assert stated is not None
    assert float(stated[2]) == pytest.approx(closest, rel=DIGITS)
    error = np.abs(force[:, 2] - law.force(r)).max()
    assert error <= float(stated[1]) * (1 + DIGITS + MEASURED)
    assert error >= float(stated[1]) * (1 - DIGITS - MEASURED)
    assert float(stated[1]) <= 1e-6 * float(law.force(0.0)) * (1 + DIGITS)
    assert not force[:, 0].any()
    exact = float(np.sum(law.energy(r) - law.energy(cutoff)))
    assert float(energy) == pytest.approx(exact, abs=len(r) * error * cutoff)


@pytest.mark.parametrize("name", LAWS)
def test_table_force_is_what_lammps_computes(session: Session, name: str) -> None:
    """`Table.force`, on which the error measurement stands, from half the closest distance to the cutoff."""
    law, cutoff, closest = LAWS[name]
    for points in (8000, 64_000):
        table = Table(law, cutoff, points)
        r = 0.5 * closest * (2 * 0.999 * cutoff / closest) ** np.linspace(0.0, 1.0, 2000)
        force, _ = lammps_forces(session, table, closest, r)
        cells = r**2 / table.cell
        allowed = END_CONDITION * np.sqrt(1 + cells) * DECAY**cells + ROUND_OFF
        assert (np.abs(force[:, 2] - table.force(r)) <= float(law.force(0.0)) * allowed).all()


@pytest.mark.parametrize("name", LAWS)
def test_no_force_beyond_the_cutoff(session: Session, name: str) -> None:
    """Exactly none, and the law's own right before it."""
    law, cutoff, closest = LAWS[name]
    table = Table(law, cutoff, 4000)
    r = np.asarray([cutoff * (1 - 1e-9), cutoff * (1 + 1e-6), 1.5 * cutoff])
    force, _ = lammps_forces(session, table, closest, r)
    assert force[0, 2] == pytest.approx(float(law.force(cutoff)), rel=1e-5)
    assert not force[1:].any()


@pytest.mark.parametrize("name", LAWS)
def test_energy_and_force_of_the_table_agree(name: str) -> None:
    """F = −dE/dr_L between entries, across the core as well: a minimiser may look at energies."""
    law, cutoff, _ = LAWS[name]
    distance, energy, force = Table(law, cutoff, 16_000).entries()
    middle = -np.diff(energy) / np.diff(distance)
    low, high = np.minimum(force[:-1], force[1:]), np.maximum(force[:-1], force[1:])
    slack = BEND * float(law.force(0.0))
    assert (middle >= low - slack).all()
    assert (middle <= high + slack).all()


@pytest.mark.parametrize("name", LAWS)
def test_a_particle_may_stand_on_its_opposite(session: Session, name: str) -> None:
    """At r = 0 the run goes on with no force in the plane; across the core the force keeps its sign and is bounded."""
    law, cutoff, closest = LAWS[name]
    table = Table(law, cutoff, 4000)
    r = np.concatenate([[0.0], table.core * np.linspace(0.01, 3.0, 300)])
    force, _ = lammps_forces(session, table, closest, r)
    assert np.isfinite(force).all()
    assert force[0, 0] == force[0, 2] == 0.0
    assert (force[1:, 2] > 0).all()
    assert force[:, 2].max() <= 1.05 * float(law.force(0.0))
    out = r >= 2.0 * table.core
    assert np.abs(force[out, 2] / law.force(r[out]) - 1.0).max() < 0.05


def test_the_force_in_the_plane_is_central(session: Session) -> None:
    """A pair at 37° in the plane: the force points along the pair and has the law's size."""
    table = Table(ADHESIVE, 2.5, 16_000)
    write_table(table, 0.07, session.folder / "interaction.table")
    for r in (0.1, 0.3604, 0.8):
        x, z = 0.8 * r, 0.6 * r
        atoms = f"create_atoms 1 single 0 0 0\ncreate_atoms 2 single {x:.17g} {table.plane_offset:.17g} {z:.17g}\n"
        box = "region all block -9 9 -9 9 -9 9\ncreate_box 2 all\nmass * 1\n"
        text = PAIRS.format(points=table.points).replace("read_data pairs.data\n", box + atoms)
        force = session.measure("clear\n" + text, (), ("f",)).atoms["f"][1]
        wanted = float(ADHESIVE.force(r)) * np.asarray([0.8, 0.6])
        assert force[[0, 2]] == pytest.approx(wanted, abs=table.error_beyond(0.07) + ROUND_OFF)


def test_error_falls_with_the_fourth_power_of_the_cell(session: Session) -> None:
    """As measured in LAMMPS beyond a fixed distance, and as `error_beyond` says."""
    r = 0.2 * (2.4 / 0.2) ** np.linspace(0.0, 1.0, 4000)
    points = np.asarray([4000, 8000, 16_000, 32_000])
    measured, stated = [], []
    for count in points:
        table = Table(ADHESIVE, 2.5, int(count))
        force, _ = lammps_forces(session, table, 0.2, r)
        measured.append(np.abs(force[:, 2] - ADHESIVE.force(r)).max())
        stated.append(table.error_beyond(0.2))
    orders = -np.diff(np.log2(measured))
    assert orders == pytest.approx(4.0, abs=RATE)
    assert stated == pytest.approx(measured, rel=MEASURED)


@pytest.mark.parametrize("error", [1e-2, 1e-4, 1e-7])
def test_the_smallest_table_that_is_good_enough(error: float) -> None:
    """Half as many points would not do, or 2000 are enough."""
    table = table_for(ADHESIVE, 2.5, 0.07, error)
    assert table.error_beyond(0.07) <= error
    half = Table(ADHESIVE, 2.5, table.points // 2)
    assert table.points == table_module.FEWEST_POINTS or half.error_beyond(0.07) > error


def test_an_error_out_of_reach_ends_at_the_largest_table(tmp_path: Path) -> None:
    """The header then states what was reached, not what was asked for."""
    table = table_for(ADHESIVE, 2.5, 0.003, 1e-15)
    assert MOST_POINTS // 2 < table.points <= MOST_POINTS
    write_table(table, 0.003, tmp_path / "t.table")
    stated = re.search(r"force within (\S+) FU", (tmp_path / "t.table").read_text())
    assert stated is not None
    assert float(stated[1]) == pytest.approx(table.error_beyond(0.003), rel=DIGITS)
    assert float(stated[1]) > 1e-15


def test_the_file_is_whole(tmp_path: Path) -> None:
    """Header, section, one row per point, 17 digits: what is read back is bitwise what was meant; no .part is left."""
    table = Table(ADHESIVE, 2.5, 2500)
    path = tmp_path / "interaction.table"
    write_table(table, 0.07, path)
    assert [file.name for file in tmp_path.iterdir()] == ["interaction.table"]
    text = path.read_text()
    assert "V(r) = 0.17999999999999999 exp(-r/0.13) - 0.089999999999999997 exp(-r/0.26000000000000001)" in text
    head, rows = text.split("DOUBLE_EXPONENTIAL\n")
    assert all(line.startswith("#") or not line for line in head.splitlines())
    first, _, *body = rows.splitlines()
    distance, energy, force = table.entries()
    assert first == f"N 2500 RSQ {distance[0]:.17g} {distance[-1]:.17g}"
    read = np.asarray([line.split() for line in body], dtype=float)
    assert np.array_equal(read.T, [np.arange(1, 2501), distance, energy, force])


def test_without_attraction_no_attractive_term(tmp_path: Path) -> None:
    """Neither in the header nor in the force."""
    write_table(Table(REPULSIVE, 1.8, 2000), 0.03, tmp_path / "t.table")
    text = (tmp_path / "t.table").read_text()
    law = re.search(r"^# V\(r\) = (.*), r in the plane", text, re.MULTILINE)
    assert law is not None
    assert law[1] == "0.17999999999999999 exp(-r/0.13)"
    rows = text.split("RSQ", 1)[1].splitlines()[2:]
    assert min(float(row.split()[3]) for row in rows) > 0.0
