"""The reduced model: particles that know their own spring and what is opposite, and nothing of their neighbours.

    springs on a rigid plane    f = k max(0, d − h(x))
    pairs of opposite chains    f = f(r),  G(r) = r₀ + h(x) − d, on the branch that a pair came by
    cells that adhere           f = k φ [d − g(x) + c (1 − φ)], while the contact is held (`adhesion`)
    cells with an attraction    f = ∫ q dx over the cell, where the contact is on its curve (`cohesive`)
    springs with a memory       f = k (part u + Σ share s_j) ≥ 0  (`relaxing`)
    springs with a slider       s ← clip(s + k_t Δu, ±μ f)

It follows any path of displacements with the memory that its particles have, all positions at once. No result
depends on it: it is a predictor, and it gives the discretisation error (`shifted`, `resized`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, ClassVar, cast

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.analysis.shear import slip
from contact1d.workflow.model.adhesion import AdhesiveEstimate, Cells
from contact1d.workflow.model.cohesive import APART, CohesiveEstimate, RatedEstimate
from contact1d.workflow.model.dugdale import Zone
from contact1d.workflow.model.friction import Sliders, sliders_of
from contact1d.workflow.model.motion import inertia
from contact1d.workflow.model.pairs import ContactEstimate, places_within
from contact1d.workflow.model.pairs import Profile as Undeformed
from contact1d.workflow.model.relaxing import SUDDEN, Edges, Memory, edges_of
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene, Viscoelasticity

Array = NDArray[np.float64]
OVERREACH = 0.1
"""How far beyond the expected displacement a force is searched, over that displacement and a spacing."""
MARGIN = 1.5
"""Depth up to which particles of springs are counted, over the expected one: few carry a load deeper than many."""
FEWEST = 4.0
"""Least half-width up to which they are counted, over the spacing."""
ROUNDS, POINTS, SNAPPING = 5, 24, 10
"""How often the bracket of a displacement is cut, and at how many positions: so many times more at first where pairs
snap, and the force has many maxima."""
SIDES, LOOKS = np.asarray([-0.5, -0.1, -0.01, -1e-4, 0.0, 1e-4, 0.01, 0.1, 0.5]), 4
"""Looks for where a force is carried, each beside the secant's place by so much of the bracket, and how many."""
NEAREST = 1e-9
"""Distance from the limit point, over that to the largest displacement, from which positions are examined."""
LOOKS_BETWEEN, EDGE_STEP = 20, 0.01
"""Looks for a receding edge between two moments of a history, and its way from one load step to the next, over all."""
EDGE = 0.02
"""How far an edge with a jump may be off, over the spacing: measured beside rings, a third of it at most."""
AGAIN = 0.1
"""The same of one that comes back over a surface that has not recovered: margins are no straight lines there."""
JUMPS = 1e-6
"""Least overlap at an edge over the displacement that makes a jump there: less is round-off of the edge."""
TOUCH = 1e-9
"""Distance over the spacing at which bodies touch: round-off of a displacement of 0."""


@dataclass(frozen=True)
class Path:
    """What the plate does; arrays (m,).

    Attributes:
        displacement, along: [LU].
        time: [TU]; 0 where the states are equilibria.
        velocity: at the end of each load step [LU/TU]; None: displacements are straight between the states.
    """

    displacement: Array
    along: Array
    time: Array
    velocity: Array | None = None


@dataclass(frozen=True)
class History:
    """Displacements or forces over time, straight from one moment to the next; arrays (m,).

    Attributes:
        phases: names, of each moment.
        time: rising [TU].
        values: displacements [LU], or forces [FU] where `by_force`.
        marks: names under which the last states of phases are reported.
    """

    phases: tuple[str, ...]
    time: Array
    values: Array
    by_force: bool
    marks: Mapping[str, str]

    def denser(self, times: int) -> History:
        """The same with so many moments for each."""
        at = np.linspace(0.0, len(self.phases) - 1.0, (len(self.phases) - 1) * times + 1)
        time, values = (np.interp(at, np.arange(len(self.phases)), one) for one in (self.time, self.values))
        phases = tuple(self.phases[int(i)] for i in np.ceil(at - NEAREST))
        return replace(self, phases=phases, time=time, values=values)

    def path(self, model: Reduced) -> Path:
        """The displacements of the body [LU]."""
        found, velocity = model.carrying(self.time, self.values) if self.by_force else (self.values, None)
        return Path(found, np.zeros_like(found), self.time, velocity)


def path_of(displacement: Array) -> Path:
    """Equilibria at displacements (m,) [LU]."""
    none = np.zeros_like(displacement)
    return Path(displacement, none, none)


@dataclass(frozen=True)
class Followed:
    """What particles at x (n,) [LU] carry along a path of m displacements.

    Attributes:
        x: positions [LU].
        total: force of all, (m,) [FU].
        force: of each at one of the displacements, by its number, (n,) [FU].
        shear: the same along x; None where nothing is prescribed there.
        zone: what a `ZonedProfile` knows of each state, (m,); None where particles tell where they end.
    """

    x: Array
    total: Array
    force: Callable[[int], Array]
    shear: Callable[[int], Array] | None = None
    zone: tuple[Array, ...] | None = None


@dataclass(frozen=True, eq=False)
class Reduced(ABC):
    """The particles of a chain.

    Attributes:
        estimate: the body, its spacing and stiffness.
        x: positions of the particles [LU], rising.
        deepest: largest displacement that is expected [LU].
        body: the same body as the deck has it, where `estimate` has it between points of a table.
    """

    estimate: ContactEstimate
    x: Array
    deepest: float
    body: Undeformed | None = field(default=None, kw_only=True)

    dense: ClassVar[int] = 16
    """Positions in one step of a path that show what its steps miss."""
    in_time: ClassVar[bool] = False
    """Whether forces depend on how fast a path is gone."""

    @property
    def shape(self) -> Undeformed:
        """What the particles are of."""
        return self.body or self.estimate.profile

    @property
    def shares_edges(self) -> bool:
        """Whether the cells at an edge of the contact have the part of its load that is inside of it."""
        return False

    @abstractmethod
    def follow(self, path: Path) -> Followed:
        """Forces along a path that begins apart."""

    @abstractmethod
    def held(self, displacements: Array) -> Array:
        """F [FU] at displacements (m,) [LU] of a contact that is unloaded from deeper."""

    @property
    @abstractmethod
    def apart(self) -> float:
        """Displacement [LU] below which nothing is felt."""

    def planned(self, path: Path, profiles: Callable[[int], Profile]) -> Array:
        """Forces along a path [FU], (m,), to compare a deck with; `profiles` of its states."""
        return self.follow(path).total

    def energies(self, path: Path) -> tuple[float, float] | None:
        """What springs and surfaces store at the end of a path on a rigid plane, and what was lost on it [FU·LU].

        Found without a force. None where this is not known.
        """
        return None

    def refined(self, history: History) -> History:
        """With further moments where a contact needs them."""
        return history

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
        return self.apart

    @property
    def limits(self) -> tuple[float, ...]:
        """Limit points [LU], at which a contact that is unloaded is lost at once; none where its force falls to 0."""
        return ()

    @property
    def jumps(self) -> tuple[float, ...]:
        """Displacements [LU] at which the force jumps, on the way in or out."""
        return self.limits

    @property
    def critical_radius(self) -> float | None:
        """Contact radius [LU] at the force maximum, likewise."""
        return None

    def unloading(self, start: float, end: float, count: int) -> Array:
        """Displacements [LU] of load steps of a contact that is unloaded, after the first one."""
        return np.linspace(start, end, count + 1)[1:]

    def work(self, start: float, every: int) -> float | None:
        """∫ −F dd [FU·LU] of a contact that is unloaded from a displacement [LU], where its curve is known.

        Of every so manieth point of the curve alone.
        """
        return None

    def radii(self, displacements: Array) -> Array | None:
        """Contact radii [LU] of a contact that is unloaded, where particles need not tell them."""
        return None

    def shifted(self, phase: float) -> Reduced:
        """The same with the apex `phase` spacings off a particle."""
        return replace(self, x=places_within(self._reach, self.estimate.spacing, phase))

    def resized(self, factor: float) -> Reduced:
        """The same body with its particles `factor` times as far apart."""
        own = self.estimate
        other = replace(own, spacing=factor * own.spacing, stiffness=factor * own.stiffness, force=factor * own.force)
        phase = 0.5 if self.x.size % 2 == 0 else 0.0
        return replace(self, estimate=other, x=places_within(self._reach, other.spacing, phase))

    @property
    def _reach(self) -> float:
        return float(self.x[-1]) + 0.5 * self.estimate.spacing

    def displacement_at(self, force: float) -> float:
        """Largest displacement [LU] at which a force [FU] is carried; that of the force maximum if none is."""
        low, high = self.apart, self.deepest + OVERREACH * (abs(self.deepest) + self.estimate.spacing)
        points = POINTS * (SNAPPING if self.estimate.snaps else 1)
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
        for _ in range(LOOKS):
            low, high = (float(one) for one in places)
            if not forces[0] < force < forces[1]:
                break
            secant = low + (high - low) * (force - forces[0]) / (forces[1] - forces[0])
            beside = np.clip(secant + (high - low) * SIDES, low, high)
            every = np.concatenate([[low], beside, [high]])
            found = np.concatenate([forces[:1], self.held(beside), forces[1:]])
            first = min(int(np.flatnonzero(found < force)[-1]), every.size - 2)
            places, forces = every[first : first + 2], found[first : first + 2]
        return float(np.interp(force, forces, places))


@dataclass(frozen=True, eq=False)
class Springs(Reduced):
    """Pairs of opposite particles, and springs on a rigid plane, which are pairs without a memory."""

    @cached_property
    def heights(self) -> tuple[Array, NDArray[np.intp]]:
        """Undeformed gaps at displacement 0 [LU], each once, and which is whose."""
        gaps = self.estimate.rest + self.shape.height(np.abs(self.x))
        found, own = np.unique(gaps, return_inverse=True)
        return found, own

    @property
    def apart(self) -> float:
        """Where nothing is felt any more [LU]."""
        return self.estimate.rest - float(self.estimate.gap[-1])

    def held(self, displacements: Array) -> Array:
        """On the branch of joined pairs [FU]."""
        heights, own = self.heights
        each = self._forces(heights - displacements[:, None], np.ones(heights.size, dtype=bool))
        return np.asarray(each @ np.bincount(own))

    def follow(self, path: Path) -> Followed:
        """A pair that has snapped together stays so up to where it snaps apart; see `Reduced.follow`."""
        (heights, own), displacements = self.heights, path.displacement
        counts = np.bincount(own)
        joined = np.zeros(heights.size, dtype=bool)
        total, memory = np.empty(displacements.size), []
        for leg in legs(displacements):
            total[leg] = self._forces(heights - displacements[leg, None], joined) @ counts
            memory += [joined] * (leg.stop - leg.start)
            last = heights - displacements[leg.stop - 1]
            joined = (joined | (last < self.estimate.joins)) & (last < self.estimate.snap[0])

        def force(state: int) -> Array:
            return np.asarray(self._forces(heights - displacements[state], memory[state])[own])

        return Followed(self.x, total, force)

    def energies(self, path: Path) -> tuple[float, float]:
        """½ k Σ u²; nothing is lost."""
        heights, own = self.heights
        pressed = np.maximum(path.displacement[-1] - heights, 0.0)
        return 0.5 * self.estimate.stiffness * float(pressed**2 @ np.bincount(own)), 0.0

    def _forces(self, gaps: Array, joined: NDArray[np.bool_]) -> Array:
        estimate = self.estimate
        inner = np.interp(gaps, estimate.gap, estimate.force, right=0.0)
        if not estimate.snaps or joined.all():
            return np.asarray(inner)
        assert estimate.outer is not None
        return np.where(joined, inner, np.interp(gaps, estimate.outer, estimate.force, right=0.0))


@dataclass(frozen=True, eq=False)
class AdheringCells(Reduced):
    """The cells of a chain on a rigid plane, which adhere from touch to where fixed grips lose all of it at once."""

    estimate: AdhesiveEstimate

    @property
    def shares_edges(self) -> bool:
        """Always."""
        return True

    @cached_property
    def _cells(self) -> Cells:
        return self.estimate.cells(self.x, self.shape)

    @cached_property
    def _once(self) -> tuple[Cells, NDArray[np.intp]]:
        """The cells of which both sides have one, each once, and how many there are."""
        _, first, count = np.unique(np.abs(self.x), return_index=True, return_counts=True)
        return Cells(*(column[first] for column in vars(self._cells).values())), count

    @property
    def apart(self) -> float:
        """Where fixed grips lose the contact [LU]."""
        return self.estimate.fixed_grips[1]

    def held(self, displacements: Array) -> Array:
        """F [FU] while it is held."""
        cells, count = self._once
        return np.asarray(self.estimate.stiffness * (cells.lengths(displacements) @ count))

    @property
    def limits(self) -> tuple[float, ...]:
        """There."""
        return (self.apart,)

    @property
    def jumps(self) -> tuple[float, ...]:
        """There, and at touch."""
        return (self.apart, 0.0)

    def _holds(self, displacements: Array) -> NDArray[np.bool_]:
        """Whether there is a contact at each of the displacements of a path, (m,)."""
        held, now, apart = np.zeros(displacements.size, dtype=bool), False, self.apart
        for i, displacement in enumerate(displacements.tolist()):
            now = displacement >= -TOUCH * self.estimate.spacing or (now and displacement >= apart)
            held[i] = now
        return held

    def energies(self, path: Path) -> tuple[float, float]:
        """U(d, a) of JKR; what it jumps by where the contact is made, at touch, or lost, under fixed grips."""
        held = self._holds(path.displacement)

        def energy(displacement: float) -> float:
            return self.estimate.energy(displacement, float(self.estimate.radii(np.asarray([displacement]))[0])) or 0.0

        made, lost = (np.count_nonzero(np.diff(held.astype(int), prepend=0) == way) for way in (1, -1))
        end = energy(float(path.displacement[-1])) if held[-1] else 0.0
        return end, lost * energy(self.apart) - made * energy(0.0)

    def follow(self, path: Path) -> Followed:
        """Nothing is felt before touch; see `Reduced.follow`."""
        displacements = path.displacement
        held = self._holds(displacements)
        total = np.where(held, self.held(displacements), 0.0)

        def force(state: int) -> Array:
            lengths = self._cells.lengths(displacements[state : state + 1])[0]
            return np.asarray(self.estimate.stiffness * lengths * held[state])

        return Followed(self.x, total, force)


@dataclass(frozen=True, eq=False)
class CohesiveCells(Reduced):
    """The cells of a chain on a rigid plane that attracts over a range."""

    estimate: CohesiveEstimate

    @property
    def shares_edges(self) -> bool:
        """Always."""
        return True

    @property
    def apart(self) -> float:
        """Where a contact that is unloaded feels nothing any more [LU]."""
        return float(self.estimate.held.displacement[0])

    def held(self, displacements: Array) -> Array:
        """F [FU] of a contact that is unloaded."""
        return self.estimate.contact_forces(displacements)

    @property
    def limits(self) -> tuple[float, ...]:
        """Where it jumps [LU]."""
        return self.estimate.limits

    def unloading(self, start: float, end: float, count: int) -> Array:
        """Evenly in the radius, since a stiff contact is lost on a small part of the way, and beyond it in d."""
        own = self.estimate.held
        touching = own.edge > 0.0
        a, d = own.edge[touching], own.displacement[touching]
        rows = np.interp(np.linspace(float(np.interp(start, d, a)), float(a[0]), count + 1)[1:], a, d)
        beyond = np.linspace(float(d[0]), end, count // 2 + 1)[1:] if d[0] > end else np.asarray([])
        return np.append(rows[(rows < start) & (rows > end)], np.append(beyond, [] if beyond.size else [end]))

    def work(self, start: float, every: int) -> float:
        """By the points of the curve, which has kinks where the bodies touch and jumps."""
        d, force = self.estimate.held.displacement, self.estimate.held.force
        last = int(np.searchsorted(d, start))
        at, own = np.append(d[:last], start), np.append(force[:last], np.interp(start, d, force))
        chosen = np.unique([*range(0, at.size, every), at.size - 1])
        return -float(np.trapezoid(own[chosen], at[chosen]))

    def radii(self, displacements: Array) -> Array:
        """See `Reduced.radii`."""
        return self.estimate.radii(displacements)

    @property
    def critical_radius(self) -> float:
        """See `Reduced.critical_radius`."""
        return self.estimate.critical_radius

    @property
    def jumps(self) -> tuple[float, ...]:
        """There, where a contact that is loaded jumps, and where the attraction begins."""
        return (*self.limits, *self.estimate.snaps_in, -self.estimate.range)

    def planned(self, path: Path, profiles: Callable[[int], Profile]) -> Array:
        """By the edges that the load steps of a deck have: beside each other their digits are few."""
        ends = np.asarray([[getattr(profiles(i), key) for key in ("edge", "reach")] for i in range(path.time.size)])
        edge, reach = ends.T
        return self.estimate.law.forces(edge, np.sqrt((reach - edge) * (reach + edge)), path.displacement)

    def energies(self, path: Path) -> tuple[float, float]:
        """U(a, c, d) of Maugis; what it jumps by from one place of the curve to another."""
        places = self.estimate.places(path.displacement).tolist()
        lost = sum(self.estimate.lost_between(*way) for way in pairwise([APART, *places]))
        return self.estimate.energy_at(places[-1]), lost

    def follow(self, path: Path) -> Followed:
        """From limit point to limit point of the curve; see `Reduced.follow`."""
        estimate = self.estimate
        zone = estimate.solved(path.displacement, estimate.places(path.displacement))
        cells = estimate.zones(self.x)
        return Followed(
            self.x, zone.force, lambda state: estimate.loads(cells, zone, state),
            zone=(zone.edge, zone.reach, np.zeros_like(zone.edge)),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class RatedCells(Reduced):
    """The cells of a chain on a rigid plane whose edge recedes at a finite speed."""

    estimate: RatedEstimate

    dense: ClassVar[int] = 4
    in_time: ClassVar[bool] = True

    @property
    def shares_edges(self) -> bool:
        """Always."""
        return True

    @property
    def apart(self) -> float:
        """Where fixed grips would lose a contact that takes its time [LU]."""
        return self.estimate.fixed_grips[1]

    @property
    def parted(self) -> None:
        """See `Reduced.parted`."""
        return

    def held(self, displacements: Array) -> Array:
        """F [FU] at rest."""
        edge = self.estimate.radii(displacements)
        forces = self.estimate.law.forces(edge, np.zeros_like(edge), displacements)
        return np.where(displacements >= self.apart, forces, 0.0)

    def zone(self, path: Path) -> Zone:
        """The edge and F of each state."""
        edge = self.estimate.edges(path.time, path.displacement)
        none = np.zeros_like(edge)
        return Zone(edge, edge, path.displacement, self.estimate.law.forces(edge, none, path.displacement))

    def energies(self, path: Path) -> tuple[float, float]:
        """U(d, a) of JKR; ∫ (G − W) 2πa da where the edge recedes, and what U jumps by at touch and separation."""
        estimate, zone = self.estimate, self.zone(path)
        a, d = zone.edge, zone.displacement
        opened = estimate.profile.height(a) - d
        excess = estimate.modulus * opened**2 - 2.0 * math.pi * a * estimate.work
        fell = np.minimum(np.diff(a), 0.0) * (a[1:] > 0.0)
        lost = -float(np.sum(0.5 * (excess[1:] + excess[:-1]) * fell))
        energies = [0.0, *(estimate.energy(float(d[i]), float(a[i])) or 0.0 for i in range(a.size))]
        jumps = np.flatnonzero(np.diff(a > 0.0, prepend=False))
        return energies[-1], lost + sum(energies[at] - energies[at + 1] for at in jumps.tolist())

    def refined(self, history: History) -> History:
        """With moments at equal ways of an edge that recedes."""
        steps = np.linspace(0.0, len(history.phases) - 1.0, (len(history.phases) - 1) * LOOKS_BETWEEN + 1)
        time, values = (np.interp(steps, np.arange(len(history.phases)), one) for one in (history.time, history.values))
        edge = self.estimate.edges(time, values)
        passed = np.append(0.0, np.cumsum(np.maximum(-np.diff(edge), 0.0))) / (float(edge.max()) or 1.0)
        more = np.interp(np.arange(EDGE_STEP, float(passed[-1]), EDGE_STEP), passed, steps)
        at = np.union1d(np.arange(float(len(history.phases))), more)
        phases = tuple(history.phases[int(i)] for i in np.ceil(at - NEAREST))
        time, values = (np.interp(at, np.arange(len(history.phases)), one) for one in (history.time, history.values))
        return replace(history, phases=phases, time=time, values=values)

    def follow(self, path: Path) -> Followed:
        """See `Reduced.follow`."""
        zone, cells = self.zone(path), self.estimate.zones(self.x)
        jumps = self.estimate.modulus * (zone.displacement - self.estimate.profile.height(zone.edge))
        return Followed(
            self.x, zone.force, lambda state: self.estimate.loads(cells, zone, state),
            zone=(zone.edge, zone.reach, jumps),
        )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Sliding(Springs):
    """Springs with a slider each, on a rigid plane; a path is of displacements and positions along x."""

    sliders: Sliders | None = None

    @property
    def chain(self) -> Sliders:
        """The sliders of these particles."""
        assert self.sliders is not None
        heights = np.asarray(self.shape.height(np.abs(self.x)), dtype=np.float64)
        scaled = self.estimate.stiffness / self.sliders.normal  # of a finer chain
        springs = {"normal": self.estimate.stiffness, "tangential": scaled * self.sliders.tangential}
        return replace(self.sliders, x=self.x, heights=heights, **springs)

    def energies(self, path: Path) -> tuple[float, float]:
        """½ Σ (k u² + s²/k_t); the work of slip."""
        forces, lost = self._slid(path)
        return super().energies(path)[0] + 0.5 * float(np.sum(forces[-1] ** 2)) / self.chain.tangential, lost

    def follow(self, path: Path) -> Followed:
        """Straight from one state to the next; see `Reduced.follow`."""
        forces, _ = self._slid(path)
        normal = [self.chain.normal_forces(depth) for depth in path.displacement.tolist()]
        total = np.asarray([each.sum() for each in normal])
        return Followed(self.x, total, normal.__getitem__, lambda state: -forces[state])

    def _slid(self, path: Path) -> tuple[list[Array], float]:
        """Tangential forces of the particles in each state [FU], and what slip has lost [FU·LU]."""
        chain, stops = self.chain, list(zip(path.displacement.tolist(), path.along.tolist(), strict=True))
        force = np.zeros_like(chain.heights)
        shears, lost = [force], 0.0
        for (before, start), (after, position) in pairwise(stops):
            old, new = (np.maximum(depth - chain.heights, 0.0) for depth in (before, after))
            touched = np.where(old > 0.0, 1.0, 0.0) if after == before else (new - old) / (after - before)
            limit, next_limit = (chain.coefficient * chain.normal * overlap for overlap in (old, new))
            pushed = chain.tangential * (position - start) * touched
            row = slip(force, pushed, limit, next_limit, chain.tangential)
            force, lost = row.force, lost + float(row.work.sum())
            shears.append(force)
        return shears, lost


@dataclass(frozen=True, eq=False)
class RelaxingSprings(Reduced):
    """The particles of a body that relaxes."""

    law: Viscoelasticity

    dense: ClassVar[int] = 4
    in_time: ClassVar[bool] = True

    @property
    def shares_edges(self) -> bool:
        """With dashpots; the line load of others falls to 0 at an edge."""
        return bool(self.law.retardation_time)

    @cached_property
    def _cells(self) -> tuple[Edges, NDArray[np.intp], Array]:
        """Cells that come to touch alike, each once, by rising height, which is whose, and how many of each."""
        every = vars(edges_of(self.shape, self.x, self.estimate.spacing))
        found, own = np.unique(np.stack([*every.values()]), axis=1, return_inverse=True)
        return Edges(*found), own, np.bincount(own).astype(np.float64)

    @property
    def apart(self) -> float:
        """Where a body that is untouched feels nothing [LU]."""
        return 0.0

    @property
    def parted(self) -> None:
        """See `Reduced.parted`."""
        return

    def held(self, displacements: Array) -> Array:
        """F [FU] of a body that has had no time."""
        cells, _, counts = self._cells
        return np.asarray(self.estimate.stiffness * (np.maximum(displacements[:, None] - cells.heights, 0.0) @ counts))

    def spent(self, times: Array) -> Array:
        """Durations (m,) [TU] of load steps that end at times (m,) [TU]; the first happens at once."""
        return np.diff(times, prepend=times[0] - SUDDEN * self.law.shortest_time)

    def carrying(self, times: Array, forces: Array) -> tuple[Array, Array]:
        """See `Reduced.carrying`; each follows from those before."""
        cells, _, counts = self._cells
        memory, before, found = Memory(self.law, cells), 0.0, []
        for force, time in zip((forces / self.estimate.stiffness).tolist(), self.spent(times).tolist(), strict=True):
            place, velocity = memory.under(force, before, counts, time)
            memory.go(place, time, velocity)
            found.append((place, velocity))
            before = force
        places, velocities = zip(*found, strict=True)
        return np.asarray(places), np.asarray(velocities)

    def feeling(self) -> Callable[[float, float, float], float]:
        """See `Reduced.feeling`."""
        cells, _, counts = self._cells
        memory = Memory(self.law, cells)

        def force(place: float, time: float, velocity: float) -> float:
            pressed, _ = memory.pressed(place, time, velocity)
            memory.go(place, time, velocity)
            return self.estimate.stiffness * float(pressed @ counts)

        return force

    def velocities(self, path: Path) -> Array:
        """Of the body at the end of each load step, (m,) [LU/TU]."""
        if path.velocity is not None:
            return path.velocity
        return np.diff(path.displacement, prepend=0.0) / self.spent(path.time)

    def follow(self, path: Path) -> Followed:
        """A load step from each state to the next, in the time between them; see `Reduced.follow`."""
        cells, own, counts = self._cells
        memory = Memory(self.law, cells)
        each, margin = np.empty((2, path.displacement.size, counts.size))
        columns = (path.displacement, self.spent(path.time), self.velocities(path))
        for i, (place, time, velocity) in enumerate(zip(*(one.tolist() for one in columns), strict=True)):
            each[i], margin[i] = memory.pressed(place, time, velocity)
            memory.go(place, time, velocity)
        each *= self.estimate.stiffness
        edge = self._edges(margin)
        doubt: Array = AGAIN * self.estimate.spacing * _returned(edge).astype(np.float64)
        if self.shares_edges:
            spacing = self.estimate.spacing
            doubt += np.abs(0.5 * spacing * memory.width(margin, counts) - edge) + EDGE * spacing * (edge > 0.0)
        zone = (edge, edge, self._jumps(edge, path.displacement, columns[2]), doubt)
        return Followed(self.x, each @ counts, lambda state: each[state][own], zone=zone)

    def energies(self, path: Path) -> tuple[float, float]:
        """Of springs and arms, those included whose particles have left; what dashpots lose."""
        cells, _, counts = self._cells
        memory, lost = Memory(self.law, cells), 0.0
        columns = (path.displacement, self.spent(path.time), self.velocities(path))
        for place, time, velocity in zip(*(one.tolist() for one in columns), strict=True):
            lost += float(memory.losing(place, time, velocity) @ counts)
            memory.go(place, time, velocity)
        stiffness = self.estimate.stiffness
        return stiffness * float(memory.stored @ counts), stiffness * lost

    def _jumps(self, edge: Array, displacement: Array, velocity: Array) -> Array:
        """The line load at an edge [FU/LU], what dashpots push where it does not recede."""
        retarded, estimate = self.law.retardation_time or 0.0, self.estimate
        push = displacement - estimate.profile.height(edge) + retarded * velocity
        grows = (edge > 0.0) & (velocity >= 0.0) & (push > JUMPS * np.abs(displacement)) & (retarded > 0.0)
        return np.where(grows, estimate.stiffness / estimate.spacing * push, 0.0)

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        """Heights [LU], rising, and where the body has them [LU]."""
        x = np.linspace(0.0, float(np.abs(self.x).max()), FINER * self.x.size)
        return np.asarray(self.estimate.profile.height(x), dtype=np.float64), x

    def _at(self, heights: Array) -> Array:
        """Where the body has heights (m,) [LU], by a secant from the straight line between two places [LU]."""
        known, x = self._places
        found, shape = np.interp(heights, known, x), self.estimate.profile
        cell = np.clip(np.searchsorted(known, heights), 1, x.size - 1)
        rise, wide = known[cell] - known[cell - 1], x[cell] - x[cell - 1]
        missed = np.divide(heights - shape.height(found), rise, out=np.zeros_like(found), where=rise > 0.0)
        return np.clip(found + wide * missed, x[cell - 1], x[cell])

    def _edges(self, margin: Array) -> Array:
        """a [LU] of states whose overlaps are (m, n) [LU], (m,): where these fall to 0, straight over the height.

        Where the contact grows the overlap has a kink at a, and only the next two free particles tell; where it
        shrinks, the last particle and the next are nearer.
        """
        heights, touching = self._cells[0].heights, margin > 0.0
        end = heights.size - 1
        last = end - np.argmax(touching[:, ::-1], axis=1)
        rows, after = np.arange(last.size), np.minimum(last + 1, end)

        def crossing(first: NDArray[np.intp], second: NDArray[np.intp]) -> Array:
            one, other = margin[rows, first], margin[rows, second]
            share = np.divide(one, one - other, out=np.zeros_like(one), where=one > other)
            place = heights[first] + share * (heights[second] - heights[first])
            return self._at(np.clip(place, heights[last], heights[after]))

        ahead, across = crossing(after, np.minimum(last + 2, end)), crossing(last, after)
        shrinks = np.append(False, ahead[1:] < ahead[:-1])
        reach = self.estimate.profile.reach
        inside = np.where(last == end, min(reach, self._reach), np.where(shrinks, across, ahead))
        return np.where(touching.any(axis=1), inside, 0.0)


def legs(displacements: Array) -> list[slice]:
    """Stretches of a path along which displacements do not turn."""
    ways = np.sign(np.diff(displacements))
    turns = [i + 1 for i in range(1, len(ways)) if ways[i] * ways[i - 1] < 0.0]
    edges = [0, *turns, len(displacements)]
    return [slice(first, last) for first, last in pairwise(edges) if last > first]


def _returned(edge: Array) -> NDArray[np.bool_]:
    """In which states an edge has receded, and grown since, but not yet as far as it was."""
    found, most, least = np.zeros(edge.size, dtype=bool), 0.0, 0.0
    for i, here in enumerate(edge.tolist()):
        if here >= most * (1.0 - NEAREST):
            most = least = here
        least = min(least, here)
        found[i] = here > least * (1.0 + NEAREST)
    return found


def reduced(scene: Scene, settings: Settings) -> Reduced:
    """The model of the particles that run, as far as the contact reaches."""
    return replace(_reduced(scene, settings), body=scene.bodies if scene.bodies.profile.slow else None)


def _reduced(scene: Scene, settings: Settings) -> Reduced:
    estimate, spacing = settings.estimate, settings.estimate.spacing
    deepest = settings.largest_displacement
    phase = 0.5 if settings.chains.upper % 2 == 0 else 0.0
    half = 0.5 * (settings.chains.upper - 1) * spacing
    if isinstance(estimate, CohesiveEstimate | RatedEstimate):
        kind: Any = CohesiveCells if isinstance(estimate, CohesiveEstimate) else RatedCells
        return cast("Reduced", kind(estimate, places_within(min(half, scene.bodies.reach), spacing, phase), deepest))
    if isinstance(estimate, AdhesiveEstimate) and estimate.attracts:
        reach = min(half, scene.bodies.reach)
        return AdheringCells(estimate, places_within(reach * (1.0 + 1e-12), spacing, phase), deepest)
    margin = 1.0 if settings.forces.range else MARGIN
    wide = estimate.half_width(max(margin * deepest, 0.0), estimate.felt)
    reach = min(max(wide, FEWEST * spacing), scene.bodies.reach)
    if scene.bodies.particles != "auto" or scene.bodies.own_count is not None:
        reach = min(reach, half * (1.0 + 1e-12))
    x = places_within(reach, spacing, phase)
    if scene.viscoelasticity:
        return RelaxingSprings(estimate, x, deepest, scene.viscoelasticity)
    return Sliding(estimate, x, deepest, sliders_of(scene, x)) if scene.friction else Springs(estimate, x, deepest)


FINER = 20
"""Places of a body for each of its particles, between which its heights are straight."""
MOST_STEPS = 20_000
"""Timesteps of a swing that is followed; a longer one ends in equilibrium."""


def swing(scene: Scene, settings: Settings, model: Reduced, start: float, load: float, duration: float) -> Array:
    """Displacements [LU] of a plate under a load [FU] after the first timestep, and after a time [TU], (2,).

        (M + N m) d″ = load − F(d) − c d′

    from rest at `start` [LU], with F(d) and limit points of the reduced model, in LAMMPS's own steps (velocity Verlet,
    drag half a step late).
    """
    total = sum(settings.steps_of(duration))
    if total > MOST_STEPS:
        return np.full(2, model.displacement_at(load))
    particle, plate = inertia(scene, settings)
    mass, drag, step = plate + settings.chains.upper * particle, settings.drag(), settings.motion.time_step
    path, place, velocity, feel = np.empty(total), start, 0.0, model.feeling()
    force = load - float(model.held(np.asarray([place]))[0])
    for i in range(total):
        velocity += 0.5 * step * force / mass
        place += step * velocity
        force = load - drag * velocity - feel(place, step, velocity + 0.5 * step * force / mass)
        velocity += 0.5 * step * force / mass
        path[i] = place
    return path[[0, total - 1]]


STRETCHES, COARSER = 60, 16
"""States of an impact in the time of a fall to the deepest displacement; timesteps of the model in each."""
FLIGHT = 3
"""States in free flight that show its velocity."""


def stretch(settings: Settings, velocity: float) -> int:
    """Timesteps from state to state of an impact at a velocity [LU/TU]."""
    return max(1, round(settings.largest_displacement / velocity / STRETCHES / settings.motion.time_step))


def is_over(displacement: Sequence[float], force: Sequence[float], flight: int = FLIGHT) -> bool:
    """Whether a body that has hit flies off, so many states long, or comes down again without having parted."""
    ways = np.sign(np.diff(displacement))
    parted = not any(force[-flight:]) and ways[-1] < 0.0
    return bool(parted or np.count_nonzero(np.diff(ways[ways != 0.0])) > 1)


def impact(scene: Scene, settings: Settings, model: Reduced, velocity: float, dense: int = 1) -> Path:
    """The model's states of an impact, from touch on at the times of a run, or `dense` ones for each.

    It takes longer timesteps: with `feeling` F, velocity Verlet of M d″ = −F.
    """
    assert scene.plate
    assert scene.plate.mass != "auto"
    each, time = max(1, COARSER // dense), stretch(settings, velocity) * settings.motion.time_step / dense
    step, feel, place, force, mass = time / each, model.feeling(), 0.0, 0.0, scene.plate.mass
    places, forces, velocities = [0.0], [0.0], [velocity]
    while len(places) < FLIGHT * dense or not is_over(places, forces, FLIGHT * dense):
        for _ in range(each):
            velocity -= 0.5 * step * force / mass
            before, place = place, place + step * velocity
            if model.limits and place < model.limits[0] <= before:  # the force ends there, within the step
                velocity -= step * force / mass * ((before - model.limits[0]) / (before - place) - 0.5)
            force = feel(place, step, velocity - 0.5 * step * force / mass)
            velocity -= 0.5 * step * force / mass
        places.append(place)
        forces.append(force)
        velocities.append(velocity)
        if len(places) > MOST_STEPS:
            break
    path = np.asarray(places)
    return Path(path, np.zeros_like(path), time * np.arange(float(path.size)), np.asarray(velocities))
