"""Springs with a memory in time on a rigid plane: the material law stays local, since line force and displacement of a
circular contact are Abel transforms of its pressure and surface displacement (Popov and Heß 2015, chapter 7).

    f = k (part u + Σ share_j s_j),   s_j′ = u′ − s_j/time_j             Prony's series of the instantaneous modulus
    f = k (u + T u′)                                                    Kelvin and Voigt

In contact u = d − g(x); a particle leaves where f would be below 0, and then its surface comes back with f = 0, and may
be touched again. Over a load step of the time Δ along which u changes evenly

    s_j ← s_j e^(−Δ/τ) + Δu τ/Δ (1 − e^(−Δ/τ))

A dashpot pushes at the edge of the contact, too: a particle has the force of the part φ of its cell that touches. With
w = g(x + s/2) − g(x − s/2), the height over which a cell of the length s comes to touch, and r = g(x) − g(x − s/2)

    φ = (r + min(overlap, u + T u′))/w within 0…1,    f = k φ [u + T u′ + (1 − φ) r]

Exact for one circular contact of a body with a constant Poisson's ratio (Lee and Radok 1960, Ting 1966).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.pairs import Independent, on_plane
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Scene, Viscoelasticity

Array = NDArray[np.float64]
NARROWEST = 1e-12
"""Height over which a cell comes to touch at once, over the spacing: no formula may divide by 0."""
SHORT = 1e-4
"""Time over that of an arm in which its length is straight: the digits of an exponential are lost."""
STAGE = 1.0 - 0.5**0.5
"""Part of a step at which the first of its two stages is."""
LEAST_BACK = 1e-5
"""Restitution that is followed: with less a body creeps out for so long that it counts as stuck."""
FLOWS = 1.96
"""Creep over that of half the time, up to which a body comes back: 2 of a fluid. Measured of a sphere: 1.95 does."""
SUDDEN, MOMENTS = 1e-6, 200
"""Time over the shortest one of a body in which something happens at once; steps of the creep of one spring."""
EDGE = 0.02
"""How far an edge with a jump may be off, over the spacing: measured beside rings, a third of it at most."""
AGAIN = 0.1
"""The same of one that comes back over a surface that has not recovered: margins are no straight lines there."""
JUMPS = 1e-6
"""Least overlap at an edge over the displacement that makes a jump there: less is round-off of the edge."""
FINER = 20
"""Places of a body for each of its particles, between which its heights are straight."""
NEAREST = 1e-9
"""Distance from the limit point, over that to the largest displacement, from which positions are examined."""


@dataclass(frozen=True)
class Edges:
    """How the cells of particles come to touch a plane; arrays (n,).

    Attributes:
        heights: g(x) of the particle, undeformed [LU].
        widths: w, height over which its cell comes to touch [LU].
        rises: r, how much of that lies nearer to the axis than the particle [LU].
    """

    heights: Array
    widths: Array
    rises: Array


def edges_of(profile: Profile, x: Array, spacing: float) -> Edges:
    """The cells of particles at positions x, (n,) [LU], of a body; it ends where the last of its cells does."""
    at, half = np.abs(x), 0.5 * spacing
    inner, heights, outer = (
        profile.height(np.minimum(np.maximum(at + part * half, 0.0), profile.reach)) for part in (-1.0, 0.0, 1.0)
    )
    least = NARROWEST * spacing
    flat = outer - inner < least  # touches as a whole, with its first touch
    return Edges(heights, np.where(flat, least, outer - inner), np.where(flat, least, heights - inner))


class Memory:
    """The state of particles in time: how far each surface is pressed in, and what its arms remember.

    Attributes:
        place: displacement of the body [LU].
        surface: u of each particle, (n,) [LU].
        outer: u where its cell is untouched, so that the contact may grow into it, (n,) [LU].
        arms: s_j, (arms, n) [LU].
    """

    def __init__(self, law: Viscoelasticity, cells: Edges) -> None:
        """Untouched, above particles at undeformed heights."""
        terms = law.terms or ()
        self._lasting, self._retarded, self._cells = law.lasting, law.retardation_time or 0.0, cells
        self._share, self._time = (np.asarray([getattr(term, key) for term in terms]) for key in ("share", "time"))
        self.arms = np.zeros((len(terms), cells.heights.size))
        self.place, self.surface, self.outer = 0.0, *np.zeros((2, cells.heights.size))
        self._held = np.zeros(cells.heights.size, dtype=bool)

    def _ahead(self, time: float) -> tuple[float, Array, Array, Array]:
        """Response, free surfaces (n,) [LU], decay and gain of each arm after a time [TU]."""
        if self._retarded:
            none = np.empty(0)
            return 1.0, self.outer * np.exp(-time / self._retarded), none, none
        age = time / self._time
        decay, gain = np.exp(-age), -np.expm1(-age) / age
        response = self._lasting + float(self._share @ gain)
        past = (self._share * decay) @ self.arms - float(self._share @ gain) * self.surface
        return response, -past / response, decay, gain

    def pressed(self, place: float, time: float, velocity: float) -> tuple[Array, Array]:
        """Forces over stiffness as the body comes to a displacement [LU] after a time [TU], with a velocity [LU/TU].

        And its overlaps, which go on below 0 where nothing touches, so that they tell where the contact ends. Both (n,)
        [LU].
        """
        response, free, *_ = self._ahead(time)
        return self._forces(place, self._retarded * velocity, response, free)

    def _forces(self, place: float, drag: float, response: float, free: Array) -> tuple[Array, Array]:
        overlap = place - self._cells.heights
        if not self._retarded:
            return response * np.maximum(overlap - free, 0.0), overlap - free
        push, rise = overlap + drag, self._cells.rises
        margin = np.minimum(overlap - free, push)
        part = self._part(margin)
        return part * (push + (1.0 - part) * rise), margin

    def _part(self, margin: Array) -> Array:
        """φ of the module's docstring at overlaps (…, n) [LU]."""
        return np.clip((self._cells.rises + margin) / self._cells.widths, 0.0, 1.0)

    def under(self, load: float, before: float, counts: Array, time: float) -> tuple[float, float]:
        """Displacement [LU] and velocity [LU/TU] after a time [TU] in which a load ≥ 0 over stiffness changes evenly.

        `before`: the load until now [LU]; `counts`: particles of each kind. Dashpots follow in two implicit stages, of
        the second order and stable for any step (R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006).
        """
        if not self._retarded:
            place = self._carrying(load, counts, time, self.place, time)
            return place, (place - self.place) / time
        part = STAGE * time
        first = self._carrying(before + STAGE * (load - before), counts, part, self.place, part)
        start = self.place + (time - part) * (first - self.place) / part
        place = self._carrying(load, counts, time, start, part)
        return place, (place - start) / part

    def _carrying(self, load: float, counts: Array, time: float, start: float, way_time: float) -> float:
        """The displacement [LU] that carries a load after a time [TU], with the velocity from `start` on in `way_time`.

        The largest under none. Forces rise with it, a parabola from where a cell begins or ends to touch to the next.
        """
        response, free, *_ = self._ahead(time)
        rate, cells = self._retarded / way_time, self._cells

        def excess(place: float) -> float:
            return float(self._forces(place, rate * (place - start), response, free)[0] @ counts) - load

        ends = cells.heights + free
        if self._retarded:  # either of overlap and push may decide
            over = [part * cells.widths - cells.rises for part in (0.0, 1.0)]
            pushed = [(cells.heights + rate * start + one) / (1.0 + rate) for one in over]
            ends = np.concatenate([*(ends + one for one in over), *pushed, start - free / rate])
        ends = np.unique(ends)
        first = bisect_right(ends, 0.0, key=excess)
        if first == 0:
            return float(ends[0])
        low = float(ends[first - 1])
        high = float(ends[first]) if first < ends.size else low + load / response
        begin, middle, end = (excess(low + part * (high - low)) for part in (0.0, 0.5, 1.0))
        if begin >= 0.0:
            return low
        bend, slope = 2.0 * (begin - 2.0 * middle + end), 4.0 * middle - 3.0 * begin - end
        root = math.sqrt(max(slope * slope - 4.0 * bend * begin, 0.0))
        return low + (high - low) * min(max(-2.0 * begin / (slope + root), 0.0), 1.0)

    def width(self, margin: Array, counts: Array) -> Array:
        """How many cells touch at overlaps (…, n) [LU], `counts` of each."""
        return np.asarray(self._part(margin) @ counts)

    def go(self, place: float, time: float, velocity: float) -> None:
        """Bring the body to a displacement [LU] with a velocity [LU/TU], evenly over a time [TU]."""
        _, free, decay, gain = self._ahead(time)
        if self._retarded:
            held = self._forces(place, self._retarded * velocity, 1.0, free)[1] > 0.0
            recovered = self._recovered(place, time, velocity)
            after, self.outer = np.where(held, place - self._cells.heights, recovered), np.where(held, free, recovered)
            self._held = held
        else:
            after = np.maximum(place - self._cells.heights, free)
            self.arms = decay[:, None] * self.arms + gain[:, None] * (after - self.surface)
        self.place, self.surface = place, after

    def _left(self, velocity: float) -> Array:
        """u at which a body that moves off at a velocity [LU/TU] leaves the surfaces that it has held, where f = 0."""
        return np.minimum(self.surface, max(-self._retarded * velocity, 0.0))

    def _recovered(self, place: float, time: float, velocity: float) -> Array:
        """u of surfaces that are free at the end of a step, some of them since they were left within it."""
        left, kept = self._left(velocity), np.exp(-time / self._retarded)
        if velocity >= 0.0:
            return np.asarray(self.surface * kept)
        since = np.exp(np.minimum((left - place + self._cells.heights) / (self._retarded * velocity), 0.0))
        return np.asarray(np.where(self._held, left * since, self.surface * kept))

    @property
    def stored(self) -> Array:
        """½ (part u² + Σ share_j s_j²), (n,) [LU²]: energies over the stiffness."""
        return np.asarray(0.5 * (self._lasting * self.surface**2 + self._share @ self.arms**2))

    def losing(self, place: float, time: float, velocity: float) -> Array:
        """What dashpots lose as `go` does that, over the stiffness, (n,) [LU²].

        Of an arm ∫ share s²/τ dt with s = α + (s₀ − α) e^(−t/τ), α = u′τ. Beside a spring T ∫ u′² dt: of the part of a
        cell that touches at the velocity of the body, of a free surface what its spring gives.
        """
        _, free, decay, gain = self._ahead(time)
        if self._retarded:
            margins = [self._forces(at, self._retarded * velocity, 1.0, free)[1] for at in (self.place, place)]
            before, part = (self._part(margin) for margin in margins)
            left = np.where(self._held, self._left(velocity), self.surface)
            given = np.where(margins[1] > 0.0, 0.0, 0.5 * (left**2 - self._recovered(place, time, velocity) ** 2))
            mean = (place - self.place) / time
            return np.asarray(self._retarded * mean**2 * time * 0.5 * (before + part) + given)
        age = (time / self._time)[:, None]
        steady = (np.maximum(place - self._cells.heights, free) - self.surface) / age
        start, faded = self.arms - steady, gain[:, None] * age
        exact = steady**2 * age + 2.0 * steady * start * faded + 0.5 * start**2 * faded * (1.0 + decay[:, None])
        after = decay[:, None] * self.arms + gain[:, None] * steady * age
        short = age / 3.0 * (self.arms**2 + self.arms * after + after**2)
        return np.asarray(self._share @ np.where(age < SHORT, short, exact))


@dataclass(frozen=True, eq=False)
class Relaxing(Independent):
    """A body that relaxes; by itself the curve at once.

    Attributes:
        material: its springs, arms and dashpots.
    """

    in_time: ClassVar[bool] = True
    tells_edges: ClassVar[bool] = True
    is_lossless: ClassVar[bool] = False
    touched: ClassVar[bool] = True
    file: ClassVar[str] = "retardation.cells"

    material: Viscoelasticity = field(default_factory=Viscoelasticity)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Of [viscoelasticity]."""
        return scene.viscoelasticity is not None

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Self:
        """See `Law`."""
        found: Self = on_plane(cls, profile, scene.bodies.spacing, scene.bulk_stiffness, scene.the(Viscoelasticity))
        return found

    def creep(self, time: float) -> float:
        """See `Law`; 1 beside a dashpot, which lets nothing happen at once."""
        if self.material.retardation_time or time <= 0.0:
            return 1.0
        alone = np.ones(1)
        spring = Memory(self.material, Edges(0.0 * alone, alone, 0.0 * alone))
        moments = time * np.geomspace(SUDDEN * min(1.0, self.material.shortest_time / time), 1.0, MOMENTS)
        for step in np.diff(moments, prepend=0.0).tolist():
            place, velocity = spring.under(1.0, 1.0, alone, step)
            spring.go(place, step, velocity)
        return spring.place

    def sticking(self, mass: float, velocity: float, time: float) -> tuple[str, str] | None:
        """See `Law`.

        Dashpots, T dF/dd, stop a body by themselves, where F = M v/T, and it creeps out with d/T; and one that flows,
        so that twice the time is twice the creep, loses what would bring it back.
        """
        if retarded := self.material.retardation_time:
            out = self.displacement_at(mass * velocity / retarded) / retarded
            return ("creeps out on its dashpots", "a shorter retardation_time") if out < LEAST_BACK * velocity else None
        flows = self.creep(2.0 * time) > FLOWS * self.creep(time)
        return ("flows", "longer times of terms") if flows else None

    def particles(self, x: Array, deepest: float) -> RelaxingSprings:
        """See `Law`."""
        return RelaxingSprings(self, x, deepest)

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """See `Law`; of dashpots."""
        if not self.material.retardation_time:
            return {}
        edges = edges_of(self.profile, x, self.spacing)
        return {"width": (1, edges.widths), "rise": (1, edges.rises)}


@dataclass(frozen=True, eq=False)
class RelaxingSprings(Particles):
    """The particles of a body that relaxes."""

    law: Relaxing

    dense: ClassVar[int] = 4

    @property
    def shares_edges(self) -> bool:
        """With dashpots; the line load of others falls to 0 at an edge."""
        return bool(self.law.material.retardation_time)

    @cached_property
    def _cells(self) -> tuple[Edges, NDArray[np.intp], Array]:
        """Cells that come to touch alike, each once, by rising height, which is whose, and how many of each."""
        every = vars(edges_of(self.shape, self.x, self.law.spacing))
        found, own = np.unique(np.stack([*every.values()]), axis=1, return_inverse=True)
        return Edges(*found), own, np.bincount(own).astype(np.float64)

    @property
    def apart(self) -> float:
        """Where a body that is untouched feels nothing [LU]."""
        return 0.0

    @property
    def parted(self) -> None:
        """See `Particles.parted`."""
        return

    def held(self, displacements: Array) -> Array:
        """F [FU] of a body that has had no time."""
        cells, _, counts = self._cells
        return np.asarray(self.law.stiffness * (np.maximum(displacements[:, None] - cells.heights, 0.0) @ counts))

    def spent(self, times: Array) -> Array:
        """Durations (m,) [TU] of load steps that end at times (m,) [TU]; the first happens at once."""
        return np.diff(times, prepend=times[0] - SUDDEN * self.law.material.shortest_time)

    def carrying(self, times: Array, forces: Array) -> tuple[Array, Array]:
        """See `Particles.carrying`; each follows from those before."""
        cells, _, counts = self._cells
        memory, before, found = Memory(self.law.material, cells), 0.0, []
        for force, time in zip((forces / self.law.stiffness).tolist(), self.spent(times).tolist(), strict=True):
            place, velocity = memory.under(force, before, counts, time)
            memory.go(place, time, velocity)
            found.append((place, velocity))
            before = force
        places, velocities = zip(*found, strict=True)
        return np.asarray(places), np.asarray(velocities)

    def feeling(self) -> Callable[[float, float, float], float]:
        """See `Particles.feeling`."""
        cells, _, counts = self._cells
        memory = Memory(self.law.material, cells)

        def force(place: float, time: float, velocity: float) -> float:
            pressed, _ = memory.pressed(place, time, velocity)
            memory.go(place, time, velocity)
            return self.law.stiffness * float(pressed @ counts)

        return force

    def prescribed(self, path: Path) -> dict[str, Array]:
        """With the time that each load step takes and the velocity of the body at its end."""
        spent, velocity = self.spent(path.time), path.velocity
        if velocity is None:
            velocity = np.diff(path.displacement, prepend=0.0) / spent
        return {"displacement": path.displacement, "duration": spent, "velocity": velocity}

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """A load step from each state to the next, in the time between them; see `Particles.carried`."""
        cells, own, counts = self._cells
        memory = Memory(self.law.material, cells)
        displacement, spent, velocities = (columns[name] for name in ("displacement", "duration", "velocity"))
        each, margin = np.empty((2, displacement.size, counts.size))
        moves = zip(displacement.tolist(), spent.tolist(), velocities.tolist(), strict=True)
        for i, (place, time, velocity) in enumerate(moves):
            each[i], margin[i] = memory.pressed(place, time, velocity)
            memory.go(place, time, velocity)
        each *= self.law.stiffness
        edge = self._edges(margin)
        doubt: Array = AGAIN * self.law.spacing * _returned(edge).astype(np.float64)
        if self.shares_edges:
            spacing = self.law.spacing
            doubt += np.abs(0.5 * spacing * memory.width(margin, counts) - edge) + EDGE * spacing * (edge > 0.0)
        zone = (edge, edge, self._jumps(edge, displacement, velocities), doubt)
        return Followed(self.x, each @ counts, lambda state: each[state][own], zone=zone)

    def energies(self, path: Path) -> tuple[float, float]:
        """Of springs and arms, those included whose particles have left; what dashpots lose."""
        cells, _, counts = self._cells
        memory, lost = Memory(self.law.material, cells), 0.0
        columns = self.prescribed(path).values()
        for place, time, velocity in zip(*(one.tolist() for one in columns), strict=True):
            lost += float(memory.losing(place, time, velocity) @ counts)
            memory.go(place, time, velocity)
        stiffness = self.law.stiffness
        return stiffness * float(memory.stored @ counts), stiffness * lost

    def _jumps(self, edge: Array, displacement: Array, velocity: Array) -> Array:
        """The line load at an edge [FU/LU], what dashpots push where it does not recede."""
        retarded, estimate = self.law.material.retardation_time or 0.0, self.law
        push = displacement - estimate.profile.height(edge) + retarded * velocity
        grows = (edge > 0.0) & (velocity >= 0.0) & (push > JUMPS * np.abs(displacement)) & (retarded > 0.0)
        return np.where(grows, estimate.stiffness / estimate.spacing * push, 0.0)

    @cached_property
    def _places(self) -> tuple[Array, Array]:
        """Heights [LU], rising, and where the body has them [LU]."""
        x = np.linspace(0.0, float(np.abs(self.x).max()), FINER * self.x.size)
        return np.asarray(self.law.profile.height(x), dtype=np.float64), x

    def _at(self, heights: Array) -> Array:
        """Where the body has heights (m,) [LU], by a secant from the straight line between two places [LU]."""
        known, x = self._places
        found, shape = np.interp(heights, known, x), self.law.profile
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
        reach = self.law.profile.reach
        inside = np.where(last == end, min(reach, self._reach), np.where(shrinks, across, ahead))
        return np.where(touching.any(axis=1), inside, 0.0)


def _returned(edge: Array) -> NDArray[np.bool_]:
    """In which states an edge has receded, and grown since, but not yet as far as it was."""
    found, most, least = np.zeros(edge.size, dtype=bool), 0.0, 0.0
    for i, here in enumerate(edge.tolist()):
        if here >= most * (1.0 - NEAREST):
            most = least = here
        least = min(least, here)
        found[i] = here > least * (1.0 + NEAREST)
    return found
