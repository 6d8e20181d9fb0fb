"""A body that relaxes, by Prony's series or with dashpots: the law of its contact, and its particles (`memory`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.memory import Array, Edges, Memory, edges_of
from contact1d.workflow.laws.pairs import Independent, on_plane
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.radius import Given, InTension, ToTheEdge
from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Scene, Viscoelasticity

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


@dataclass(frozen=True, eq=False)
class Relaxing(Independent):
    """A body that relaxes; by itself the curve at once.

    Attributes:
        material: its springs, arms and dashpots.
    """

    in_time = True
    is_lossless = False
    rules = (ToTheEdge, InTension, Given)
    file = "retardation.cells"
    beside = ("relaxing",)
    exact = beside

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

    @classmethod
    def series(cls, scene: Scene) -> tuple[tuple[float, float], ...]:
        """See `Law`."""
        return tuple((term.share, term.time) for term in scene.the(Viscoelasticity).terms or ())

    @classmethod
    def soonest(cls, scene: Scene) -> float:
        """See `Law`."""
        return scene.the(Viscoelasticity).shortest_time

    @classmethod
    def jumps(cls, scene: Scene) -> bool:
        """See `Law`; of dashpots it does."""
        return scene.the(Viscoelasticity).resists_jumps

    def untouched_radius(self, displacement: float) -> float:
        """See `Law`: that of the displacement."""
        return self.half_width(displacement, self.rest)

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
        edges = edges_of(body, x, self.spacing)
        return {"width": (1, edges.widths), "rise": (1, edges.rises)}


@dataclass(frozen=True, eq=False)
class RelaxingSprings(Particles):
    """The particles of a body that relaxes."""

    law: Relaxing

    dense = 4
    apart = 0.0

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
        edge, doubt = self._edges(margin)
        doubt = np.maximum(doubt, AGAIN * self.law.spacing * _returned(edge))
        if self.shares_edges:
            spacing = self.law.spacing
            doubt += np.abs(0.5 * spacing * memory.width(margin, counts) - edge) + EDGE * spacing * (edge > 0.0)
        zone = (edge, edge, self._jumps(edge, displacement, velocities), doubt, self._layers(edge, spent, velocities))
        return Followed(self.x, each @ counts, lambda state: each[state][own], zone=zone)

    def checked(self, path: Path, finer: int) -> Path:
        """Return the path itself: its load steps have their times."""
        return path

    def energies(self, path: Path) -> tuple[float, float]:
        """Of springs and arms, those included whose particles have left; what dashpots lose."""
        cells, _, counts = self._cells
        places, times, velocities = self.prescribed(path).values()
        stored, lost = Memory(self.law.material, cells).along(places, times, velocities)
        return self.law.stiffness * float(stored @ counts), self.law.stiffness * float(lost @ counts)

    def _jumps(self, edge: Array, displacement: Array, velocity: Array) -> Array:
        """The line load at an edge [FU/LU], what dashpots push where it does not recede."""
        retarded, estimate = self.law.material.retardation_time or 0.0, self.law
        push = displacement - estimate.profile.height(edge) + retarded * velocity
        grows = (edge > 0.0) & (velocity >= 0.0) & (push > JUMPS * np.abs(displacement)) & (retarded > 0.0)
        return np.where(grows, estimate.stiffness / estimate.spacing * push, 0.0)

    def _layers(self, edge: Array, spent: Array, velocity: Array) -> Array:
        """What arms push in a layer at an edge that grows [FU/LU], where it is narrower than the spacing, a′ τ."""
        stiffness, spacing = self.law.stiffness, self.law.spacing
        grown = np.maximum(np.diff(edge, prepend=0.0), 0.0) / spent / spacing
        arms = (one.share * one.time * np.exp(-one.time * grown) for one in self.law.material.terms or ())
        return np.asarray(stiffness / spacing * np.maximum(velocity, 0.0) * sum(arms) * (grown > 0.0))

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

    def _edges(self, margin: Array) -> tuple[Array, Array]:
        """a [LU] of states whose overlaps are (m, n) [LU], (m,): where these fall to 0, straight over the height.

        Where the contact grows the overlap has a kink at a, and only the next two free particles tell; where it
        shrinks, the last particle and the next are nearer. Another particle in place of one of two tells the error.
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
        beyond, behind = crossing(after, np.minimum(last + 3, end)), crossing(np.maximum(last - 1, 0), after)
        shrinks, touches = np.append(False, ahead[1:] < ahead[:-1]), touching.any(axis=1)
        edge, other = np.where(shrinks, across, ahead), np.where(shrinks, behind, beyond)
        edge, other = (np.where(last == end, min(self.law.profile.reach, self._reach), one) for one in (edge, other))
        return np.where(touches, edge, 0.0), np.abs(edge - other) * touches


def _returned(edge: Array) -> NDArray[np.bool_]:
    """In which states an edge has receded, and grown since, but not yet as far as it was."""
    found, most, least = np.zeros(edge.size, dtype=bool), 0.0, 0.0
    for i, here in enumerate(edge.tolist()):
        if here >= most * (1.0 - NEAREST):
            most = least = here
        least = min(least, here)
        found[i] = here > least * (1.0 + NEAREST)
    return found
