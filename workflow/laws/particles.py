"""Particles as the law of their contact has them; on a rigid plane they are those of the deck, with the same numbers.

    springs on a rigid plane    f = k max(0, d − h(x))
    pairs of opposite chains    f = f(r),  G(r) = r₀ + h(x) − d, on the branch that a pair came by (`pairs`)
    cells that adhere           f = k φ [d − g(x) + c (1 − φ)], while the contact is held (`jkr`)
    cells with an attraction    f = ∫ q dx over the cell, where the contact is on its curve (`maugis`)
    springs with a memory       f = k (part u + Σ share s_j) ≥ 0  (`relaxing`)
    springs with a slider       s ← clip(s + k_t Δu, ±μ f)  (`friction`)

They follow any path of displacements with the memory that they have, all positions at once. On a rigid plane that is
the plan of a run; of pairs it is a predictor, and of both it gives the discretisation error (`shifted`, `resized`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.law import Law
from contact1d.workflow.laws.path import Followed, History, Path, equilibria
from contact1d.workflow.laws.shape import Profile as Undeformed
from contact1d.workflow.laws.shape import places_within

Array = NDArray[np.float64]
OVERREACH = 0.1
"""How far beyond the expected displacement a force is searched, over that displacement and a spacing."""
ROUNDS, POINTS, SNAPPING = 5, 24, 10
"""How often the bracket of a displacement is cut, and at how many positions: so many times more at first where pairs
snap, and the force has many maxima."""
SIDES, LOOKS = np.asarray([-0.5, -0.1, -0.01, -1e-4, 0.0, 1e-4, 0.01, 0.1, 0.5]), 40
"""Looks for where a force is carried, each beside the secant's place by so much of the bracket, and most of them."""
EXACT = 1e-13
"""Difference of the forces of a bracket over the larger one of the first, from which on it is straight."""
PHASES, MORE_PHASES = (0.25, 0.0), (0.375, 0.25, 0.125, 0.0)
"""Positions of the apex between particles, over the spacing, that an even chain is compared with; more where a contact
has several edges, the errors of which may cancel at two positions."""
UNEVEN, FINER = (0.93, 0.86), (0.5, 0.25)
"""Spacings over the own one that put a kink of the profile elsewhere between particles, on both sides alike, and on
which errors converge."""
NEAREST = 1e-9
"""Distance from the limit point, over that to the largest displacement, from which positions are examined."""


@dataclass(frozen=True, eq=False)
class Particles(ABC):
    """The particles of a chain.

    Attributes:
        law: of their contact, with the body, its spacing and stiffness.
        x: positions of the particles [LU], rising.
        deepest: largest displacement that is expected [LU].
        body: the same body as the deck has it, where the law has it between points of a table.
    """

    law: Law
    x: Array
    deepest: float
    body: Undeformed | None = field(default=None, kw_only=True)

    dense: ClassVar[int] = 8
    """Positions in one step of a path that show what its steps miss."""
    phases: ClassVar[tuple[float, ...]] = PHASES

    @property
    def shape(self) -> Undeformed:
        """What the particles are of."""
        return self.body or self.law.profile

    @property
    def shares_edges(self) -> bool:
        """Whether the cells at an edge of the contact have the part of its load that is inside of it.

        Then sums over particles come closer to the body's own steadily. Whole particles touch or don't, and what they
        miss goes up and down with the spacing.
        """
        return False

    def lattices(self, is_pointed: bool) -> tuple[list[Particles], list[Particles]]:
        """The same with particles elsewhere, and on finer spacings, where errors converge.

        Of a body that `is_pointed`, sums miss as much wherever its apex is, as those of a cone do.
        """
        kinks, finer = self.law.profile.kinks, FINER if self.shares_edges else ()
        phases = MORE_PHASES if kinks else () if finer else self.phases
        uneven = UNEVEN if kinks or is_pointed else ()
        beside = [self.resized(factor) for factor in uneven] + [self.shifted(phase) for phase in phases]
        return beside, [self.resized(factor) for factor in finer]

    def prescribed(self, path: Path) -> dict[str, Array]:
        """What load steps along a path that begins apart give a deck, by the names of its columns, (m,)."""
        return {"displacement": path.displacement}

    @abstractmethod
    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Forces of load steps that give such columns."""

    def follow(self, path: Path) -> Followed:
        """Forces along a path that begins apart."""
        return self.carried(self.prescribed(path))

    @abstractmethod
    def held(self, displacements: Array) -> Array:
        """F [FU] at displacements (m,) [LU] of a contact that is unloaded from deeper."""

    @property
    @abstractmethod
    def apart(self) -> float:
        """Displacement [LU] below which nothing is felt."""

    def energies(self, path: Path) -> tuple[float, float] | None:
        """What springs and surfaces store at the end of a path on a rigid plane, and what was lost on it [FU·LU].

        Found without a force. None where this is not known.
        """
        return None

    def checked(self, path: Path, finer: int) -> Path:
        """The path along which the work of a run is compared with `energies`: from apart on, in dense equilibria.

        `finer`: times as many. Where forces depend on time, the load steps themselves.
        """
        return equilibria(path, self.apart, self.jumps, self.law.spacing, finer)

    def refined(self, history: History) -> History:
        """With further moments where a contact needs them: beside its jumps."""
        return history if history.by_force or not self.jumps else history.beside(self.jumps)

    def moments(self, deepest: float, velocity: float, count: int) -> Array:
        """Times [TU] of load steps of a pull from a displacement [LU] at a velocity [LU/TU], until nothing is felt."""
        return np.linspace(0.0, (deepest - self.apart) / velocity, count)

    def carrying(self, times: Array, forces: Array) -> tuple[Array, Array | None]:
        """Displacements [LU] of load steps at times (m,) [TU] under forces (m,) [FU] ≥ 0; velocities, see `Path`."""
        found = {force: self.displacement_at(force) if force > 0.0 else 0.0 for force in np.unique(forces).tolist()}
        return np.asarray([found[force] for force in forces.tolist()]), None

    def feeling(self) -> Callable[[float, float, float], float]:
        """F [FU] of a body that has just touched, by its next displacement [LU], the time until then [TU] and its
        velocity there [LU/TU].
        """
        is_lost = False

        def force(place: float, time: float, velocity: float) -> float:
            nonlocal is_lost
            is_lost = place < self.apart or (is_lost and place < 0.0)
            return 0.0 if is_lost else float(self.held(np.asarray([place]))[0])

        return force

    @property
    def parted(self) -> float | None:
        """Displacement [LU] at which a contact that is unloaded is lost; None where the history decides that."""
        return None if self.law.in_time else self.apart

    @property
    def limits(self) -> tuple[float, ...]:
        """Limit points [LU], at which a contact that is unloaded is lost at once; none where its force falls to 0."""
        return ()

    @property
    def jumps(self) -> tuple[float, ...]:
        """Displacements [LU] at which the force jumps, in loading or unloading."""
        return self.limits

    @property
    def top(self) -> float | None:
        """Displacement [LU] of the force maximum of a contact that is unloaded, where the law knows it."""
        return None

    @property
    def critical_radius(self) -> float | None:
        """Contact radius [LU] at the force maximum, likewise."""
        return None

    def unloading(self, start: float, end: float, count: int) -> Array:
        """Displacements [LU] of load steps of a contact that is unloaded, after the first one.

        Closer towards the end, its limit point, where the force rises as a root.
        """
        return end + (start - end) * np.linspace(1.0, 0.0, count + 1)[1:] ** 2

    def work(self, start: float, every: int) -> float | None:
        """∫ −F dd [FU·LU] of a contact that is unloaded from a displacement [LU], where its curve is known.

        Of every so manieth point of the curve alone.
        """
        return None

    def radii(self, displacements: Array) -> Array | None:
        """Contact radii [LU] of a contact that is unloaded, where particles need not tell them."""
        return None

    def shifted(self, phase: float) -> Particles:
        """The same with the apex `phase` spacings off a particle."""
        return replace(self, x=places_within(self._reach, self.law.spacing, phase))

    def resized(self, factor: float) -> Particles:
        """The same body with its particles `factor` times as far apart."""
        own = self.law
        other = replace(own, spacing=factor * own.spacing, stiffness=factor * own.stiffness, force=factor * own.force)
        phase = 0.5 if self.x.size % 2 == 0 else 0.0
        return replace(self, law=other, x=places_within(self._reach, other.spacing, phase))

    @property
    def _reach(self) -> float:
        return float(self.x[-1]) + 0.5 * self.law.spacing

    def displacement_at(self, force: float) -> float:
        """Largest displacement [LU] at which a force [FU] is carried; that of the force maximum if none is."""
        low, high = self.apart, self.deepest + OVERREACH * (abs(self.deepest) + self.law.spacing)
        points = POINTS * (SNAPPING if self.law.snaps else 1)
        # The attraction may end within a millionth of the way: what lies near the limit point is looked at by decades.
        near = low + (high - low) * np.geomspace(NEAREST, 1.0, points)
        positions = np.union1d(np.linspace(low, high, points), near)
        forces = self.held(positions)
        for _ in range(ROUNDS):
            if (forces < force).any():
                break
            # Where none is below, a lower one may lie on either side of the lowest.
            lowest = int(np.argmin(forces))
            ends = positions[[max(lowest - 1, 0), min(lowest + 1, positions.size - 1)]]
            positions = np.linspace(ends[0], ends[1], POINTS)
            forces = self.held(positions)
        else:
            return float(positions[int(np.argmin(forces))])
        first = min(int(np.flatnonzero(forces < force)[-1]), positions.size - 2)
        return self._crossing(force, positions[first : first + 2], forces[first : first + 2])

    def _crossing(self, force: float, places: Array, forces: Array) -> float:
        """Where a force [FU] is carried between two places [LU] that have less and more.

        Each look is at the secant's place and at SIDES beside it, a bracket of its own if the curve is straight there.
        """
        straight = EXACT * float(np.abs(forces).max())
        for _ in range(LOOKS):
            low, high = (float(one) for one in places)
            if not forces[0] < force < forces[1] or np.ptp(forces) <= straight:
                break
            secant = low + (high - low) * (force - forces[0]) / (forces[1] - forces[0])
            beside = np.clip(secant + (high - low) * SIDES, low, high)
            every = np.concatenate([[low], beside, [high]])
            found = np.concatenate([forces[:1], self.held(beside), forces[1:]])
            first = min(int(np.flatnonzero(found < force)[-1]), every.size - 2)
            places, forces = every[first : first + 2], found[first : first + 2]
        return float(np.interp(force, forces, places))
