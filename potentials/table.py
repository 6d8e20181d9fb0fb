"""LAMMPS `pair_style table` files of a central interaction, exact down to zero distance of opposite particles.

LAMMPS interpolates g(s) = f(r)/r over s = r² on a uniform grid and stops if a pair comes closer than the first entry.
The two bodies therefore lie in parallel planes a small offset ε apart (out of plane, with no motion there), and
the table is a function of the distance in space r_L = √(r² + ε²):

    F_table(r_L) = f(r) · r_L / r,      so that the force in the plane, F_table · r / r_L, is f(r) exactly.

Since r_L² = r² + ε², the offset only shifts the grid: it costs no accuracy, and since r_L ≥ ε no run stops.
Within one grid cell of r = 0, where a finite core's g = f/r diverges, g is held at its value one cell out: there, and
only there, the force falls to 0 at r = 0 instead of jumping to its opposite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

from contact1d.files import write_whole
from contact1d.potentials.double_exponential import Array, DoubleExponential

FEWEST_POINTS = 2_000
MOST_POINTS = 400_000
INNER_CELLS = 4
"""Grid cells between the first entry and r = 0: a spline's end condition does not reach across them."""


@dataclass(frozen=True)
class Table:
    """A tabulated pair interaction.

    Attributes:
        law: the potential that it represents.
        cutoff: r_c [LU]; the energy is V(r) − V(r_c), the force f(r) up to r_c and 0 beyond.
        points: number of grid points over r_L².
    """

    law: DoubleExponential
    cutoff: float
    points: int

    @property
    def cell(self) -> float:
        """Grid step of r², or of r_L² = r² + ε² [LU²]."""
        return self.cutoff**2 / (self.points - 1 - INNER_CELLS)

    @property
    def plane_offset(self) -> float:
        """Distance ε of the two bodies' planes [LU]; ε² is five grid steps of r²."""
        return math.sqrt((INNER_CELLS + 1) * self.cell)

    @property
    def core(self) -> float:
        """Distance in the plane of motion [LU] below which the force falls in proportion to the distance, to 0 at
        distance 0.
        """
        return math.sqrt(self.cell)

    def grid(self) -> Array:
        """Return the squares r_L² [LU²] of the distances in space of all entries, rising in equal steps, (points,).

        The first is one step, less than ε², the last r_c² + ε².
        """
        first = self.plane_offset**2 - INNER_CELLS * self.cell
        return np.asarray(first + self.cell * np.arange(self.points), dtype=np.float64)

    def entries(self) -> tuple[Array, Array, Array]:
        """Return (r_L [LU], energy [FU·LU], F_table [FU]) of all entries, by rising distance r_L in space, (points,)
        each.

        F_table is positive where particles repel each other; the energy is 0 at the cutoff. F_table/r_L is constant
        for distances in the plane below the core, and at the first four entries, r_L < ε, which no pair reaches.
        """
        squared = self.grid()
        distance, in_plane = np.sqrt(squared), squared - self.plane_offset**2
        r = np.sqrt(np.maximum(in_plane, self.cell))
        slope = self.law.force(r) / r
        # Where g is constant, the energy continues with the corresponding force −dE/dr_L = g r_L.
        inside = 0.5 * slope * np.maximum(self.cell - in_plane, 0.0)
        return distance, self.law.energy(r) - self.law.energy(self.cutoff) + inside, slope * distance

    def force(self, r: Array) -> Array:
        """Return the force in the plane [FU] that LAMMPS interpolates from this table at distances 0 ≤ r ≤ r_c [LU].

        It has the shape of r, and repulsion is positive. Beyond r_c, where LAMMPS has no force, it is not 0 but
        meaningless. LAMMPS interpolates g = F_table/r_L by a cubic spline over s = r_L² with knots at the entries.
        Between two of them, at the share t of the cell h: (1 − t) g₀ + t g₁ − t (1 − t) [(2 − t) M₀ + (1 + t) M₁] h²/6,
        M = g″.
        """
        slope, bend = _knots(self)
        position = (np.square(r) + self.plane_offset**2 - self.grid()[0]) / self.cell
        left = np.clip(position.astype(np.intp), 0, self.points - 2)
        t = position - left
        curved = (2.0 - t) * bend[left] + (1.0 + t) * bend[left + 1]
        between = (1.0 - t) * slope[left] + t * slope[left + 1] - t * (1.0 - t) * curved
        return np.asarray(between * r)

    # Cached, since a scene needs the errors of few tables often.
    @lru_cache(maxsize=64)  # noqa: B019  # a table is small, and equal by value
    def error_beyond(self, r_min: float, samples: int = 20_000) -> float:
        """Return max |F − f(r)| [FU] of the interpolated force F in the plane and the law's f for r_min ≤ r ≤ r_c.

        It is cached. `r_min`: [LU], > 0; `samples`: number of distances in geometric progression at which it is
        measured, both ends included.
        """
        r = r_min * (self.cutoff / r_min) ** np.linspace(0.0, 1.0, samples)
        return float(np.abs(self.force(r) - self.law.force(r)).max())


@lru_cache(maxsize=4)  # each lateral offset of the bodies needs the knots
def _knots(table: Table) -> tuple[Array, Array]:
    """Return (g, M h²/6) [FU/LU] at the entries of a table, (points,) each; both are cached and must not be changed.

    g = F_table/r_L is f(r)/r, repulsion positive: r [LU] is the distance in the plane of motion, r_L = √(r² + ε²) that
    in space. M = d²g/ds² of the cubic spline of g over s = r_L², h the step of s [LU²]. On this uniform grid M₋ + 4 M₀
    + M₊ = 6 δ²g/h² is solved by the decaying Green's function z^|j| / 2√3, z = √3 − 2. The spline's ends, where LAMMPS
    has other end conditions, lie in the margin of INNER_CELLS and beyond the cutoff. `scipy.interpolate.CubicSpline`,
    the reference of the tests, takes longer to import than a small run takes.
    """
    distance, _, force = table.entries()
    slope = force / distance
    second = np.zeros_like(slope)
    second[1:-1] = slope[:-2] - 2.0 * slope[1:-1] + slope[2:]
    z = math.sqrt(3.0) - 2.0
    reach = math.ceil(math.log(np.spacing(1.0), -z))  # entries beyond which z^|j| is round-off
    green = z ** abs(np.arange(-reach, reach + 1)) / (2.0 * math.sqrt(3.0))
    return slope, np.convolve(second, green, mode="same")


def table_for(law: DoubleExponential, cutoff: float, closest: float, error: float) -> Table:
    """Return the smallest table whose force error is at most `error` [FU] from `closest` [LU] to the cutoff [LU].

    The number of points doubles from 2000 on until the measured error is small enough, or 400000 would be exceeded;
    then the error is larger, and nothing is raised. `law`: interaction of a pair.
    """
    table = Table(law, cutoff, FEWEST_POINTS)
    while table.error_beyond(closest) > error and 2 * table.points <= MOST_POINTS:
        table = Table(law, cutoff, 2 * table.points)
    return table


def write_table(table: Table, closest: float, path: Path) -> None:
    """Write the LAMMPS table file atomically, over an existing one: entries r_L [LU], energy [FU·LU] and F_table [FU].

    Its header states the interaction and the measured error [FU]. `closest`: distance [LU] from which on that holds.
    """
    write_whole(path, _text(table, closest))


@lru_cache(maxsize=4)  # scenes run one after the other mostly share their law, and 32 000 rows take 45 ms
def _text(table: Table, closest: float) -> str:
    """Return the text of the LAMMPS table file: comments, section, size, and a line for each entry.

    A line has the number from 1 on, r_L [LU], energy [FU·LU] and F_table [FU], to 17 digits. The comments state the
    interaction, cutoff and plane offset, also to 17 digits, and to 3 the largest error [FU] of the force beyond
    `closest` [LU]. It is cached.
    """
    law = table.law
    distance, energy, force = table.entries()
    header = (
        f"# V(r) = {law.formula}, r in the plane [LU], V [FU LU]\n"
        f"# cut at r = {table.cutoff:.17g} and shifted there to zero energy\n"
        f"# r_L = sqrt(r^2 + e^2), e = {table.plane_offset:.17g} LU: the bodies lie in planes that far apart\n"
        f"# measured: force within {table.error_beyond(closest):.2e} FU of the law for r >= {closest:.3g} LU;"
        f" smoothed to zero below r = {table.core:.2g} LU\n\n"
        f"DOUBLE_EXPONENTIAL\nN {table.points} RSQ {distance[0]:.17g} {distance[-1]:.17g}\n\n"
    )
    rows = np.empty((table.points, 4))
    rows.T[:] = np.arange(1, table.points + 1), distance, energy, force
    body = ("%d %.17g %.17g %.17g\n" * table.points) % tuple(rows.ravel().tolist())
    return header + body
