"""Contacts whose edges the law computes for each load step: a particle has the integral of the line load over its cell.

The integrals add up, so that F is exact at every spacing.
"""

from __future__ import annotations

import sys
from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from contact1d.workflow.laws.dugdale import Dugdale, Zone
from contact1d.workflow.laws.jkr import Jkr
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, Followed
from contact1d.workflow.laws.radius import Given
from contact1d.workflow.laws.shape import Profile


@dataclass(frozen=True)
class Cells:
    """The cell of each particle on one side of the axis; arrays (n,).

    Attributes:
        inner, outer: distances of the ends of the cell from the axis [LU].
        below, above: G = ∫₀ˣ g dx, the integral of the transformed profile, at these ends [LU²].
        sides: 2 for a particle on the axis, which has a cell on each side; else 1.
    """

    inner: Array
    outer: Array
    below: Array
    above: Array
    sides: Array


@dataclass(frozen=True, eq=False)
class Zoned(Jkr):
    """A contact whose edges are computed for each load step.

    Attributes:
        surface: actual profile f [LU], whose transform is `profile`.
    """

    rules = (Given, Given)

    surface: Profile = field(kw_only=True)

    @property
    @abstractmethod
    def equations(self) -> Dugdale:
        """Equations of the contact edge, of F and of the line load; Receding has no attraction beyond the edge, Maugis
        one.
        """

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """Return constants of the cells of particles at positions x, (n,) [LU], by name: (p, values (n,) in [LUᵖ]).

        "inner" and "outer", p = 1: distances of the ends of a cell from the axis; "below" and "above", p = 2: G = ∫₀ˣ g
        dx of the transformed profile at these; "sides", p = 0: 2 for a particle on the axis, else 1. `body` is not
        used.
        """
        zones, powers = self.zones(x), {"inner": 1, "outer": 1, "below": 2, "above": 2, "sides": 0}
        return {name: (power, getattr(zones, name)) for name, power in powers.items()}

    def zones(self, x: Array) -> Cells:
        """Return the cells of particles at positions x, (n,) [LU]: half a spacing to both sides of each, on one side of
        the axis.

        An inner end is 0 at least. Beyond the largest contact radius that is computed, `known`, G = ∫ g dx does not
        rise.
        """
        radius, half = np.abs(x), 0.5 * self.spacing
        inner, outer = np.maximum(radius - half, 0.0), radius + half
        sides = np.where(radius < 0.25 * self.spacing, 2.0, 1.0)
        # Beyond the body there is neither profile nor load.
        below, above = (self.equations.area(np.minimum(end, self.known)) for end in (inner, outer))
        return Cells(inner, outer, below, above, sides)

    def loads(self, cells: Cells, zone: Zone, state: int) -> Array:
        """Return the force ∫ q dx of each cell, (n,) [FU], compression positive, in the state of index `state`.

        0 of cells outside contact and attraction; those across an edge have the force of their part within it.

        Args:
            cells: of the particles.
            zone: edges and displacements of all states.
            state: index of one of them.
        """
        a, c, d = (float(column[state]) for column in (zone.edge, zone.reach, zone.displacement))
        end = np.minimum(cells.outer, a)
        area = np.where(cells.outer < a, cells.above, self.equations.area(np.asarray([a]))[0])
        pressed = self.modulus * np.where(cells.inner < a, d * (end - cells.inner) - (area - cells.below), 0.0)
        low, high = (np.minimum(np.maximum(end, a), c) for end in (cells.inner, cells.outer))
        return cells.sides * (pressed - 2.0 * self.equations.stress * (_half_disc(high, c) - _half_disc(low, c)))


def _half_disc(x: Array, radius: float) -> Array:
    """Return ∫₀ˣ √(c² − x²) dx, (n,) [LU²], at positions 0 ≤ x ≤ c, (n,) [LU], for a `radius` c [LU]."""
    root = np.sqrt((radius - x) * (radius + x))
    return 0.5 * (x * root + radius**2 * np.arctan2(x, root))


@dataclass(frozen=True, eq=False)
class ZonedCells(Particles):
    """The cells of a chain on a rigid plane, in a contact whose edges are computed for each load step."""

    law: Zoned
    shares_edges = True

    @property
    def apart(self) -> float:
        """Displacement [LU] at which a contact that is unloaded slowly is lost, below which it has no force.

        A contact whose edge recedes at a finite speed is lost below it.
        """
        return self.law.fixed_grips[1]

    def _edges_of(self, zone: Zone) -> dict[str, Array]:
        """Return the columns of states by name, (m,) [LU] each: "displacement" d, "edge" a, "reach" c and "height".

        a is the contact radius, c that up to which an attraction acts. The height is the mean of the transformed
        profile g over the contact, 0 where a = 0.
        """
        area = self.law.equations.area(zone.edge)
        height = np.divide(area, zone.edge, out=np.zeros_like(area), where=zone.edge > 0.0)
        return {"displacement": zone.displacement, "edge": zone.edge, "reach": zone.reach, "height": height}

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the forces of load steps by their columns "displacement" d, "edge" a and "reach" c, (m,) [LU]; others
        are not used.

        The total, (m,) [FU], compression positive, is that of the continuous contact; a function of the index of a load
        step gives the force of each cell, (n,) [FU]. `zone` has a, c and the jump of the line load [FU/LU] at the edge:
        E* (d − g(a)), negative in tension, and 0 without contact or where an attraction acts beyond the edge.
        """
        law, equations, cells = self.law, self.law.equations, self.law.zones(self.x)
        d, edge, reach = (columns[name] for name in ("displacement", "edge", "reach"))
        zone = Zone(edge, reach, d, equations.forces(edge, np.sqrt((reach - edge) * (reach + edge)), d))
        ends = (reach == edge) & (edge > 0.0)
        jump = np.where(ends, law.modulus * (d - law.profile.height(edge)), 0.0)
        # The part of a cell in the ring of attraction is a difference of the discs up to its ends.
        round_off = sys.float_info.epsilon * 2.0 * equations.stress * reach**2
        return Followed(
            self.x, zone.force, lambda state: law.loads(cells, zone, state), zone=(edge, reach, jump),
            round_off=round_off,
        )  # fmt: skip
