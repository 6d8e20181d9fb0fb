"""Particles of a contact without their neighbours; on a rigid plane they have the same numbers as those of the deck.

    springs on a rigid plane    f = k max(0, d − h(x))
    pairs of opposite chains    f = f(r),  G(r) = r₀ + h(x) − d, on the branch of the pair's history (`pairs`)
    cells that adhere           f = k φ [d − g(x) + c (1 − φ)], while the bodies are in contact (`jkr`)
    cells with an attraction    f = ∫ q dx over the cell, by the state of the contact (`maugis`)
    viscoelastic springs        f = k (part u + Σ share s_j) ≥ 0  (`relaxing`)
    springs with a slider       s ← clip(s + k_t Δu, ±μ f)  (`friction`)

They follow any path of displacements with their own memory, all positions at once. On a rigid plane that is the plan of
a run; of pairs it is a predictor, and of both it gives the discretisation error (`shifted`, `resized`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from contact1d.workflow.laws.law import Law
from contact1d.workflow.laws.numerics import ROUND_OFF, value_at
from contact1d.workflow.laws.path import Array, Followed, History, Path, equilibria
from contact1d.workflow.laws.shape import Profile as Undeformed
from contact1d.workflow.laws.shape import positions_within

MORE_PHASES = (0.375, 0.25, 0.125, 0.0)
"""`Particles.phases` of a contact with several edges, whose errors may cancel at two of them."""


@dataclass(frozen=True, eq=False)
class Particles(ABC):
    """The particles of a chain: their forces along any path of displacements.

    A new law's particles have `carried`, `held` and `apart`; every other method has a default.

    Attributes:
        law: contact law, with the body, its spacing and stiffness.
        x: positions of the particles [LU], rising, (n,).
        deepest: largest displacement that is expected [LU].
        body: the body as the deck has it, where the law's profile is a table of it.
    """

    law: Law
    x: Array
    deepest: float
    body: Undeformed | None = field(default=None, kw_only=True)

    dense: ClassVar[int] = 8
    """States in one load step by which the sampling error of a path is estimated."""
    phases: ClassVar[tuple[float, ...]] = (0.25, 0.0)
    """Positions of the apex between particles, over the spacing, at which the discretisation error is sampled."""

    @property
    def shape(self) -> Undeformed:
        """Undeformed profile of the particles' body: as LAMMPS has it, where the law has a table of it, else that of
        the law.
        """
        return self.body or self.law.profile

    @property
    def shares_edges(self) -> bool:
        """Whether the cell at a contact edge carries the load of its part inside the contact; False by default.

        True of adhesive contacts and of bodies with dashpots. Then sums over particles converge steadily. Whole
        particles touch or do not, and their error goes up and down with the spacing.
        """
        return False

    def lattices(self, is_pointed: bool, has_edge: bool) -> tuple[list[Particles], list[Particles]]:
        """Return (moved, finer): new particles of the same body at other positions, to sample the discretisation error.

        The second list has those at a half and a quarter of the spacing; it is empty unless `shares_edges`. The first
        list begins, for a body with kinks or one that `is_pointed`, as a cone, with those at 0.93 and 0.86 of the
        spacing. Then it has those shifted against the apex: by 0.375, 0.25, 0.125 and 0 spacings for a body with kinks;
        else by each of `phases` where the second list is empty, and none where it is not. Of a body that `has_edge`
        these are 0.375, 0.25 and 0.125: a shift by 0 would put a particle at each edge, one more than cells.
        """
        kinks, finer = self.law.profile.kinks, (0.5, 0.25) if self.shares_edges else ()
        phases = MORE_PHASES if kinks else () if finer else MORE_PHASES[:-1] if has_edge else self.phases
        # These put a kink elsewhere between particles, on both sides alike.
        uneven = (0.93, 0.86) if kinks or is_pointed else ()
        moved = [self.resized(factor) for factor in uneven] + [self.shifted(phase) for phase in phases]
        return moved, [self.resized(factor) for factor in finer]

    def prescribed(self, path: Path) -> dict[str, Array]:
        """Return the columns of load steps by name, (m,) each, that prescribe a path to LAMMPS; by default
        {"displacement": d [LU]}.

        The path begins with separated bodies.
        """
        return {"displacement": path.displacement}

    @abstractmethod
    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the forces in load steps by their columns, (m,) each, named as `prescribed` names them.

        They are the sums of the normal forces, (m,) [FU], compression positive, and a function of the index of a load
        step that gives those of each particle, (n,) [FU]. The path begins with separated bodies. A missing column
        raises KeyError; others are ignored.
        """

    def follow(self, path: Path) -> Followed:
        """Return the forces on the particles in all states of a path that begins with separated bodies.

        They are the sums of the normal forces, (m,) [FU], compression positive, and a function of the index of a state
        that gives those of each particle, (n,) [FU].
        """
        return self.carried(self.prescribed(path))

    @abstractmethod
    def held(self, displacements: Array) -> Array:
        """Return F, (m,) [FU], the sum over the particles in unloading, at displacements (m,) [LU]; compression
        positive.

        JkrCells continue below pull-off under fixed grips, other adhesive cells have 0 there; viscoelastic springs have
        the instantaneous F of an untouched body.
        """

    @property
    @abstractmethod
    def apart(self) -> float:
        """Displacement [LU] below which a contact that is unloaded has no force; 0 of viscoelastic springs."""

    def energies(self, path: Path) -> tuple[float, float] | None:
        """Return (energy stored at the end of a path on a rigid plane, energy dissipated along it), both [FU·LU].

        Computed independently of the forces, which it checks; None, as by default, where the law has no expression for
        them. The path begins with separated bodies.
        """
        return None

    def booked(self, path: Path) -> tuple[Array, Array, Array] | None:
        """Return (normal elastic energy, tangential one, work of slip so far) of each state, (m,) [FU·LU] each.

        None, as by default, where particles have no tangential force. The path begins with separated bodies.
        """
        return None

    def checked(self, path: Path, finer: int) -> Path:
        """Return the path along which the work of a run is compared with `energies`: many equilibria, from separated
        bodies on.

        `finer`: factor on the number of states. A law whose forces depend on time has the `path` itself.
        """
        if self.law.in_time:  # its load steps have their times
            return path
        return equilibria(path, self.apart, self.jumps, self.law.spacing, finer)

    def refined(self, history: History) -> History:
        """Return a history with further moments on both sides of displacements at which the force jumps.

        The same object where the force is prescribed, or jumps at no displacement.
        """
        return history if history.by_force or not self.jumps else history.refined_at(self.jumps)

    def moments(self, deepest: float, velocity: float, count: int) -> Array:
        """Return the times, (count,) [TU], rising from 0 on, of load steps of a pull-off at a `velocity` [LU/TU].

        It begins at the displacement `deepest` [LU]. By default the times are at equal intervals, both ends included,
        up to the displacement `apart`, below which there is no force. Receding has others, up to 2 · `count` + 1.
        """
        return np.linspace(0.0, (deepest - self.apart) / velocity, count)

    def displacements_under(self, times: Array, forces: Array) -> tuple[Array, Array | None]:
        """Return (displacements (m,) [LU], velocities) under forces, (m,) [FU] ≥ 0, at times, (m,) [TU].

        Velocities (m,) [LU/TU] are those at the end of each load step; None, as by default, where displacements are
        straight between the states. The default does not depend on the times, and has the displacement 0 for a force of
        0.
        """
        depths = {force: self.displacement_at(force) if force > 0.0 else 0.0 for force in np.unique(forces).tolist()}
        return np.asarray([depths[force] for force in forces.tolist()]), None

    def force_in_time(self) -> Callable[[float, float, float], float]:
        """Return a function of the force F [FU], compression positive, on a body that has just touched.

        It is called state by state with (next displacement [LU], time until then [TU], velocity there [LU/TU]), and
        remembers the state. By default F depends on the displacement alone: that in unloading, and 0 from pull-off
        until the displacement is 0 or above again.
        """
        is_lost = False

        def force(displacement: float, time: float, velocity: float) -> float:
            """Return F [FU], compression positive, at a displacement [LU]; the other arguments are not used."""
            nonlocal is_lost
            is_lost = displacement < self.apart or (is_lost and displacement < 0.0)
            return 0.0 if is_lost else value_at(self.held, displacement)

        return force

    def shear_in_time(self) -> Callable[[float, float], float]:
        """Return a function of the tangential force [FU] with which the contact resists a motion of the body along +x.

        It is called state by state with (next displacement, next position along x) [LU], from 0, and remembers the
        state. By default it is 0.
        """
        return lambda displacement, along: 0.0

    @property
    def parted(self) -> float | None:
        """Displacement [LU] below which a contact that is unloaded is lost; None where forces depend on time."""
        return None if self.law.in_time else self.apart

    @property
    def limits(self) -> tuple[float, ...]:
        """Displacements [LU], rising, at which the force of a contact that is unloaded jumps; empty by default."""
        return ()

    @property
    def jumps(self) -> tuple[float, ...]:
        """Displacements [LU] at which the force jumps, in loading or unloading; by default those in unloading
        (`limits`).

        They need not be sorted.
        """
        return self.limits

    @property
    def corners(self) -> tuple[float, ...]:
        """Displacements [LU] at which F(d) has a corner in unloading; empty by default."""
        return ()

    @property
    def critical_displacement(self) -> float | None:
        """Displacement [LU] of the force maximum in unloading; None, as by default, where the law does not give it."""
        return None

    @property
    def critical_radius(self) -> float | None:
        """Contact radius [LU] at the force maximum in unloading; None, as by default, where the law has none."""
        return None

    def unloading(self, start: float, end: float, count: int) -> Array:
        """Return the falling displacements, (count,) [LU], of load steps in unloading from `start` to `end` [LU].

        The start is not among them, the end is the last. They are closest near the end, a limit point, where the force
        rises as a root.
        """
        return end + (start - end) * np.linspace(1.0, 0.0, count + 1)[1:] ** 2

    def work(self, start: float, every: int) -> float | None:
        """Return None: by default a law has no curve of the work.

        A law with one returns ∫ −F dd [FU·LU] in unloading from `start` [LU] to pull-off, positive where tension
        prevails, by one point of `every` so many of the curve.
        """
        return None

    def radii(self, displacements: Array) -> Array | None:
        """Return None: by default contact radii follow from the particles' forces.

        Maugis' cells return those in unloading, (m,) [LU], at displacements (m,) [LU].
        """
        return None

    def shifted(self, phase: float) -> Particles:
        """Return new particles of the same body and half-width, its apex `phase` spacings (0 … 1) from a particle."""
        return replace(self, x=positions_within(self._reach, self.law.spacing, phase))

    def resized(self, factor: float) -> Particles:
        """Return new particles of the same body and half-width at `factor` times the spacing.

        Stiffness and force of a particle are scaled alike. The apex is midway between two particles where the number of
        particles was even, else at one; in a body that ends with its chain where the new number is even.
        """
        law = self.law
        law = replace(law, spacing=factor * law.spacing, stiffness=factor * law.stiffness, force=factor * law.force)
        is_whole = math.isclose(self._reach, law.profile.reach)
        count = round(2.0 * self._reach / law.spacing) if is_whole else self.x.size
        phase = 0.5 if count % 2 == 0 else 0.0
        return replace(self, law=law, x=positions_within(self._reach, law.spacing, phase))

    @property
    def _reach(self) -> float:
        """Half-width [LU] of the chain, to the end of the last cell."""
        return float(self.x[-1]) + 0.5 * self.law.spacing

    def displacement_at(self, force: float) -> float:
        """Return the largest displacement [LU] at which a force [FU], compression positive, is carried in unloading.

        Of a tension that is never carried, the displacement of the force maximum. The search ends at the largest
        expected displacement `deepest` plus 0.1 · (|`deepest`| + spacing); for a force larger than there, this end is
        returned.
        """
        low, high = self.apart, self.deepest + 0.1 * (abs(self.deepest) + self.law.spacing)
        rounds, cuts = 5, 24
        points = cuts * (10 if self.law.snaps else 1)  # where pairs snap, the force has many maxima
        # The attraction may end within a millionth of the bracket: near the limit point it is scanned by decades.
        near = low + (high - low) * np.geomspace(ROUND_OFF, 1.0, points)
        displacements = np.union1d(np.linspace(low, high, points), near)
        forces = self.held(displacements)
        for _ in range(rounds):
            if (forces < force).any():
                break
            # Where none is below, a lower one may lie on either side of the lowest.
            lowest = int(np.argmin(forces))
            ends = displacements[[max(lowest - 1, 0), min(lowest + 1, displacements.size - 1)]]
            displacements = np.linspace(ends[0], ends[1], cuts)
            forces = self.held(displacements)
        else:
            return float(displacements[int(np.argmin(forces))])
        first = min(int(np.flatnonzero(forces < force)[-1]), displacements.size - 2)
        return self._crossing(force, displacements[first : first + 2], forces[first : first + 2])

    def _crossing(self, force: float, bracket: Array, forces: Array, rounds: int = 40) -> float:
        """Return the displacement [LU] at which a force [FU] is carried, within a bracket of less and more force.

        Each round evaluates the secant's displacement and others on both sides of it, which bracket the force more
        closely if the curve is straight there. A force outside those of the bracket gives its nearer end.

        Args:
            force: that is searched for [FU].
            bracket: two rising displacements [LU].
            forces: at these [FU].
            rounds: most of them.
        """
        sides = np.asarray([-0.5, -0.1, -0.01, -1e-4, 0.0, 1e-4, 0.01, 0.1, 0.5])  # from the secant, over the bracket
        straight = 1e-13 * float(np.abs(forces).max())  # round-off of the difference of the forces
        for _ in range(rounds):
            low, high = bracket.tolist()
            if not forces[0] < force < forces[1] or np.ptp(forces) <= straight:
                break
            secant = low + (high - low) * (force - forces[0]) / (forces[1] - forces[0])
            trials = np.clip(secant + (high - low) * sides, low, high)
            displacements = np.concatenate([[low], trials, [high]])
            carried = np.concatenate([forces[:1], self.held(trials), forces[1:]])
            first = min(int(np.flatnonzero(carried < force)[-1]), displacements.size - 2)
            bracket, forces = displacements[first : first + 2], carried[first : first + 2]
        return float(np.interp(force, forces, bracket))
