"""A viscoelastic body, by a Prony series or with dashpots: the law of its contact, and its particles (`memory`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.memory import Array, Edges, Memory, edges_of
from contact1d.workflow.laws.numerics import ROUND_OFF
from contact1d.workflow.laws.pairs import Independent, on_plane
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.radius import Given, InTension, ToTheEdge
from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Scene, Viscoelasticity

SUDDEN = 1e-6
"""Time over the shortest relaxation time, within which a load step is instantaneous."""


@dataclass(frozen=True, eq=False)
class Relaxing(Independent):
    """The contact of a viscoelastic body; its curve F(d) is the instantaneous one.

    Attributes:
        material: springs, arms and dashpots of the body.
    """

    in_time = True
    is_lossless = False
    rules = (ToTheEdge, InTension, Given)
    file = "retardation.cells"
    closed_forms = ("relaxing",)
    exact = closed_forms

    material: Viscoelasticity = field(default_factory=Viscoelasticity)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Return whether the scene has [viscoelasticity]."""
        return scene.viscoelasticity is not None

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Self:
        """Return the law of springs with the material of a scene."""
        law: Self = on_plane(cls, profile, scene.bodies.spacing, scene.bulk_stiffness, scene.the(Viscoelasticity))
        return law

    @classmethod
    def series(cls, scene: Scene) -> tuple[tuple[float, float], ...]:
        """Return the Prony series of a scene: shares, and their relaxation times [TU]."""
        return tuple((term.share, term.time) for term in scene.the(Viscoelasticity).terms or ())

    @classmethod
    def shortest_time(cls, scene: Scene) -> float:
        """Return the shortest relaxation or retardation time of a scene [TU]."""
        return scene.the(Viscoelasticity).shortest_time

    @classmethod
    def jumps(cls, scene: Scene) -> bool:
        """Return whether the scene has dashpots without a spring in series, whose force jumps with the velocity."""
        return scene.the(Viscoelasticity).resists_jumps

    def untouched_radius(self, displacement: float) -> float:
        """Return the contact radius [LU] of the undeformed profile at a displacement [LU]."""
        return self.half_width(displacement, self.rest)

    def creep(self, time: float) -> float:
        """Return the displacement a time [TU] after a load over the instantaneous one, in 200 steps of one spring.

        1 of dashpots, which have no instantaneous displacement.
        """
        if self.material.retardation_time or time <= 0.0:
            return 1.0
        count = np.ones(1)
        spring = Memory(self.material, Edges(0.0 * count, count, 0.0 * count))
        moments = time * np.geomspace(SUDDEN * min(1.0, self.material.shortest_time / time), 1.0, 200)
        for step in np.diff(moments, prepend=0.0).tolist():
            displacement, velocity = spring.under(1.0, 1.0, count, step)
            spring.go(displacement, step, velocity)
        return spring.displacement

    def sticking(self, mass: float, velocity: float, time: float) -> tuple[str, str] | None:
        """Return why a body sticks after an impact, and the remedy; None where it rebounds.

        Dashpots, T dF/dd, stop a body where F = M v/T, and it then creeps out at the velocity d/T. A material that
        flows, so that twice the time is twice the creep, has no energy left for a rebound.
        """
        least_restitution = 1e-5  # with less a body creeps out for too long to be followed
        most_creep = 1.96  # in twice the time: a fluid has 2; measured, a sphere with 1.95 rebounds
        if retarded := self.material.retardation_time:
            out = self.displacement_at(mass * velocity / retarded) / retarded
            creeps = out < least_restitution * velocity
            return ("creeps out on its dashpots", "a shorter retardation_time") if creeps else None
        flows = self.creep(2.0 * time) > most_creep * self.creep(time)
        return ("flows", "longer times of terms") if flows else None

    def particles(self, x: Array, deepest: float) -> RelaxingSprings:
        """Return the viscoelastic springs at positions x, (n,) [LU]."""
        return RelaxingSprings(self, x, deepest)

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """Return w and r of cells (`memory`) at positions x, (n,) [LU], with their powers of a length, for dashpots."""
        if not self.material.retardation_time:
            return {}
        edges = edges_of(body, x, self.spacing)
        return {"width": (1, edges.widths), "rise": (1, edges.rises)}


@dataclass(frozen=True, eq=False)
class RelaxingSprings(Particles):
    """The particles of a viscoelastic body on a rigid plane."""

    law: Relaxing

    dense = 4
    apart = 0.0

    @property
    def shares_edges(self) -> bool:
        """Whether there are dashpots; without, the line load falls to 0 at an edge."""
        return bool(self.law.material.retardation_time)

    @cached_property
    def _cells(self) -> tuple[Edges, NDArray[np.intp], Array]:
        """Cells without repetition by rising height, the index of each particle's cell, and particles per cell."""
        columns = vars(edges_of(self.shape, self.x, self.law.spacing)).values()
        cells, indices = np.unique(np.stack([*columns]), axis=1, return_inverse=True)
        return Edges(*cells), indices, np.bincount(indices).astype(np.float64)

    def held(self, displacements: Array) -> Array:
        """Return the instantaneous force F, (m,) [FU], of an untouched body at displacements (m,) [LU]."""
        cells, _, counts = self._cells
        return np.asarray(self.law.stiffness * (np.maximum(displacements[:, None] - cells.heights, 0.0) @ counts))

    def durations(self, times: Array) -> Array:
        """Return the durations of load steps, (m,) [TU], that end at times (m,) [TU]; the first is instantaneous."""
        return np.diff(times, prepend=times[0] - SUDDEN * self.law.material.shortest_time)

    def displacements_under(self, times: Array, forces: Array) -> tuple[Array, Array]:
        """Return displacements and velocities (m,) [LU, LU/TU] under forces (m,) [FU] ≥ 0 at times (m,) [TU]."""
        cells, _, counts = self._cells
        memory, before, states = Memory(self.law.material, cells), 0.0, []
        for force, time in zip((forces / self.law.stiffness).tolist(), self.durations(times).tolist(), strict=True):
            displacement, velocity = memory.under(force, before, counts, time)
            memory.go(displacement, time, velocity)
            states.append((displacement, velocity))
            before = force
        displacements, velocities = zip(*states, strict=True)
        return np.asarray(displacements), np.asarray(velocities)

    def force_in_time(self) -> Callable[[float, float, float], float]:
        """Return the force [FU] on a body that has just touched, as a function to be called state by state.

        Its arguments are the next displacement [LU], the time until then [TU] and the velocity there [LU/TU].
        """
        cells, _, counts = self._cells
        memory = Memory(self.law.material, cells)

        def force(displacement: float, time: float, velocity: float) -> float:
            pressed, _ = memory.pressed(displacement, time, velocity)
            memory.go(displacement, time, velocity)
            return self.law.stiffness * float(pressed @ counts)

        return force

    def prescribed(self, path: Path) -> dict[str, Array]:
        """Return the displacements, durations and final velocities of load steps, (m,) [LU, TU, LU/TU]."""
        spent, velocity = self.durations(path.time), path.velocity
        if velocity is None:
            velocity = np.diff(path.displacement, prepend=0.0) / spent
        return {"displacement": path.displacement, "duration": spent, "velocity": velocity}

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the forces of load steps and their contact edges, each step in its duration."""
        cells, indices, counts = self._cells
        memory, spacing = Memory(self.law.material, cells), self.law.spacing
        displacements, spent, velocities = (columns[name] for name in ("displacement", "duration", "velocity"))
        forces, margin = np.empty((2, displacements.size, counts.size))
        steps = zip(displacements.tolist(), spent.tolist(), velocities.tolist(), strict=True)
        for i, step in enumerate(steps):
            forces[i], margin[i] = memory.pressed(*step)
            memory.go(*step)
        forces *= self.law.stiffness
        edge, doubt = self._edges(margin)
        # Over a surface that has not recovered overlaps are no straight lines.
        doubt = np.maximum(doubt, 0.1 * spacing * _returned(edge))
        if self.shares_edges:
            # An edge with a jump, compared with rings, is off by a third of this share of the spacing at most.
            doubt += np.abs(0.5 * spacing * memory.width(margin, counts) - edge) + 0.02 * spacing * (edge > 0.0)
        zone = (edge, edge, self._jumps(edge, displacements, velocities), doubt, self._layers(edge, spent, velocities))
        return Followed(self.x, forces @ counts, lambda state: forces[state][indices], zone=zone)

    def checked(self, path: Path, finer: int) -> Path:
        """Return the path itself: its load steps have their times."""
        return path

    def energies(self, path: Path) -> tuple[float, float]:
        """Return the energy of springs and arms, of separated particles too, and the loss in dashpots [FU·LU]."""
        cells, _, counts = self._cells
        stored, lost = Memory(self.law.material, cells).along(*self.prescribed(path).values())
        return self.law.stiffness * float(stored @ counts), self.law.stiffness * float(lost @ counts)

    def _jumps(self, edge: Array, displacement: Array, velocity: Array) -> Array:
        """Return the line load just inside the edge, (m,) [FU/LU], that of dashpots where the edge does not recede."""
        retarded, law = self.law.material.retardation_time or 0.0, self.law
        push = displacement - law.profile.height(edge) + retarded * velocity
        resolved = push > 1e-6 * np.abs(displacement)  # less is round-off of the edge
        grows = (edge > 0.0) & (velocity >= 0.0) & resolved & (retarded > 0.0)
        return np.where(grows, law.stiffness / law.spacing * push, 0.0)

    def _layers(self, edge: Array, spent: Array, velocity: Array) -> Array:
        """Return the line load of arms, (m,) [FU/LU], in a layer a′ τ < spacing at a growing edge."""
        stiffness, spacing = self.law.stiffness, self.law.spacing
        grown = np.maximum(np.diff(edge, prepend=0.0), 0.0) / spent / spacing
        arms = (term.share * term.time * np.exp(-term.time * grown) for term in self.law.material.terms or ())
        return np.asarray(stiffness / spacing * np.maximum(velocity, 0.0) * sum(arms) * (grown > 0.0))

    @cached_property
    def _outline(self) -> tuple[Array, Array]:
        """Heights of the body [LU], rising, and their positions [LU], 20 for each particle."""
        x = np.linspace(0.0, float(np.abs(self.x).max()), 20 * self.x.size)
        return np.asarray(self.law.profile.height(x), dtype=np.float64), x

    def _positions(self, heights: Array) -> Array:
        """Return the positions of heights on the body, (m,) [LU], by one secant step from linear interpolation."""
        known, x = self._outline
        guess, shape = np.interp(heights, known, x), self.law.profile
        cell = np.clip(np.searchsorted(known, heights), 1, x.size - 1)
        rise, width = known[cell] - known[cell - 1], x[cell] - x[cell - 1]
        missed = np.divide(heights - shape.height(guess), rise, out=np.zeros_like(guess), where=rise > 0.0)
        return np.clip(guess + width * missed, x[cell - 1], x[cell])

    def _edges(self, margin: Array) -> tuple[Array, Array]:
        """Return a, (m,) [LU], of states with overlaps (m, n) [LU], and its error [LU].

        The overlap falls to 0 at a, linearly over the height. At a growing contact it has a kink at a, so that the next
        two free particles show it; at a shrinking one the last particle and the next are nearer. Another particle in
        place of one of the two gives the error.
        """
        heights, touching = self._cells[0].heights, margin > 0.0
        end = heights.size - 1
        last = end - np.argmax(touching[:, ::-1], axis=1)
        states, after = np.arange(last.size), np.minimum(last + 1, end)

        def crossing(first: NDArray[np.intp], second: NDArray[np.intp]) -> Array:
            inner, outer = margin[states, first], margin[states, second]
            share = np.divide(inner, inner - outer, out=np.zeros_like(inner), where=inner > outer)
            height = heights[first] + share * (heights[second] - heights[first])
            return self._positions(np.clip(height, heights[last], heights[after]))

        ahead, across = crossing(after, np.minimum(last + 2, end)), crossing(last, after)
        beyond, behind = crossing(after, np.minimum(last + 3, end)), crossing(np.maximum(last - 1, 0), after)
        shrinks, touches = np.append(False, ahead[1:] < ahead[:-1]), touching.any(axis=1)
        pairs = np.where(shrinks, across, ahead), np.where(shrinks, behind, beyond)
        edge, check = (np.where(last == end, min(self.law.profile.reach, self._reach), radius) for radius in pairs)
        return np.where(touches, edge, 0.0), np.abs(edge - check) * touches


def _returned(edge: Array) -> NDArray[np.bool_]:
    """Return in which states, (m,), an edge has receded and grown again, but not yet to its largest radius."""
    returned, most, least = np.zeros(edge.size, dtype=bool), 0.0, 0.0
    for i, radius in enumerate(edge.tolist()):
        if radius >= most * (1.0 - ROUND_OFF):
            most = least = radius
        least = min(least, radius)
        returned[i] = radius > least * (1.0 + ROUND_OFF)
    return returned
