"""A viscoelastic body, by a Prony series or with dashpots: the law of its contact, and its particles (`memory`)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.memory import Edges, Memory, edges_of
from contact1d.workflow.laws.numerics import ROUND_OFF
from contact1d.workflow.laws.pairs import Independent, on_plane
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, Followed, Path
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
        """Return the law of one-sided springs on a rigid plane under a profile, with the material of a scene.

        Equal arguments give the same instance.
        """
        law: Self = on_plane(cls, profile, scene.bodies.spacing, scene.bulk_stiffness, scene.relaxation)
        return law

    @classmethod
    def series(cls, scene: Scene) -> tuple[tuple[float, float], ...]:
        """Return the Prony series of a scene as pairs: share of the modulus (relative), relaxation time [TU].

        Empty of a body with dashpots.
        """
        return tuple((term.share, term.time) for term in scene.relaxation.terms)

    @classmethod
    def shortest_time(cls, scene: Scene) -> float:
        """Return the shortest relaxation time [TU] of a scene's Prony series, or its retardation time where it has
        dashpots.
        """
        return scene.relaxation.shortest_time

    @classmethod
    def jumps(cls, scene: Scene) -> bool:
        """Return whether the scene has a retardation time: dashpots without a spring in series, whose force jumps with
        velocity.
        """
        return scene.relaxation.resists_jumps

    def untouched_radius(self, displacement: float) -> float:
        """Return the contact radius [LU] of the undeformed profile at a displacement [LU], as in a first loading.

        One spacing at a displacement of 0 or less; the half-width of the body at most.
        """
        return self.half_width(displacement, self.rest)

    def creep(self, time: float) -> float:
        """Return the displacement of a spring a time [TU] after a constant load was applied, over the initial one.

        It is computed in 200 steps; 1 for a time of 0 or less, and of dashpots, which have no instantaneous
        displacement.
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
        """Return (why a body sticks after an impact, the remedy) as texts; None where it rebounds.

        With dashpots, whose force is T dF/dt, a body stops where the elastic F = M v/T, at a displacement d, and then
        creeps out at the velocity d/T: it sticks where this is below 1e-5 of v. With a Prony series it sticks where the
        creep in twice the `time` is more than 1.96 times that in the `time`: such a material flows.

        Args:
            mass: M of the body [MU].
            velocity: v of impact [LU/TU].
            time: that the impact of the elastic body lasts [TU].
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
        """Return the viscoelastic springs at positions x, (n,) [LU]; `deepest`: largest expected displacement [LU]."""
        return RelaxingSprings(self, x, deepest)

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """Return {"width": (1, w), "rise": (1, r)}, (n,) [LU]: heights over which the cells of particles touch.

        At positions x, (n,) [LU], of a `body` as LAMMPS has it; r is the part of w on the side of the axis, 1 the power
        of a length. {} without dashpots.
        """
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
        """Whether the material has dashpots: then the cell at an edge carries the load of its part in contact.

        Without them the line load falls to 0 at an edge.
        """
        return bool(self.law.material.retardation_time)

    @cached_property
    def _cells(self) -> tuple[Edges, NDArray[np.intp], Array]:
        """(Cells by rising height without repetition, (k,); index of each particle's cell, (n,); number of particles of
        each, (k,)).
        """
        columns = vars(edges_of(self.shape, self.x, self.law.spacing)).values()
        cells, indices = np.unique(np.stack([*columns]), axis=1, return_inverse=True)
        return Edges(*cells), indices, np.bincount(indices).astype(np.float64)

    def held(self, displacements: Array) -> Array:
        """Return the instantaneous elastic force F, (m,) [FU], compression positive, of an untouched body.

        `displacements`: (m,) [LU]; F is 0 at 0 and below.
        """
        cells, _, counts = self._cells
        return self.law.stiffness * (np.maximum(displacements[:, None] - cells.heights, 0.0) @ counts)

    def durations(self, times: Array) -> Array:
        """Return the durations of load steps, (m,) [TU], that end at `times`, (m,) [TU].

        The first is instantaneous, 1e-6 of the shortest relaxation or retardation time, whatever its time.
        """
        return np.diff(times, prepend=times[0] - SUDDEN * self.law.material.shortest_time)

    def displacements_under(self, times: Array, forces: Array) -> tuple[Array, Array]:
        """Return (displacements [LU], final velocities [LU/TU]), (m,) each, under forces (m,) [FU] ≥ 0 at times (m,)
        [TU].

        The body begins untouched; the first load is applied at once. Compression is positive.
        """
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
        """Return a function of the force F [FU] ≥ 0, compression positive, on an untouched body at displacement 0.

        It is called state by state with (next displacement [LU], time until then [TU], velocity there [LU/TU]), and
        remembers the state.
        """
        cells, _, counts = self._cells
        memory = Memory(self.law.material, cells)

        def force(displacement: float, time: float, velocity: float) -> float:
            """Return F [FU] ≥ 0 after a load step, and move the body."""
            pressed, _ = memory.pressed(displacement, time, velocity)
            memory.go(displacement, time, velocity)
            return self.law.stiffness * float(pressed @ counts)

        return force

    def prescribed(self, path: Path) -> dict[str, Array]:
        """Return the columns of load steps by name, (m,) each: "displacement" [LU], "duration" [TU] and final
        "velocity" [LU/TU].

        Without velocities in the path they are the mean ones of the load steps, the first from displacement 0 on.
        """
        spent, velocity = self.durations(path.time), path.velocity
        if velocity is None:
            velocity = np.diff(path.displacement, prepend=0.0) / spent
        return {"displacement": path.displacement, "duration": spent, "velocity": velocity}

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the forces of load steps by their columns "displacement" [LU], "duration" [TU] and "velocity" [LU/TU],
        (m,) each.

        They are the sums over the particles, (m,) [FU] ≥ 0, compression positive, and a function of the index of a load
        step that gives those of each particle, (n,). The body begins untouched. `zone` has, (m,) each, the contact
        radius twice, the jump of the line load at it, its error, and the line load in a thin layer inside of it,
        lengths in LU and line loads in FU/LU.
        """
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

    def energies(self, path: Path) -> tuple[float, float]:
        """Return (energy of springs and arms at the end of a path, energy dissipated along it), both [FU·LU].

        The body begins untouched. Energy is dissipated in dashpots, those of the Prony series included; particles that
        have separated are included in both.
        """
        cells, _, counts = self._cells
        stored, lost = Memory(self.law.material, cells).along(*self.prescribed(path).values())
        return self.law.stiffness * float(stored @ counts), self.law.stiffness * float(lost @ counts)

    def _jumps(self, edge: Array, displacement: Array, velocity: Array) -> Array:
        """Return the line load just inside the edge, (m,) [FU/LU] ≥ 0, that dashpots parallel to the springs cause.

        0 of a Prony series, without contact, where the body moves back, velocity < 0, and where the load is less than
        that of 1e-6 of the displacement, which is round-off.

        Args:
            edge: contact radius, (m,) [LU].
            displacement: of the body, (m,) [LU].
            velocity: of the body, (m,) [LU/TU].
        """
        retarded, law = self.law.material.retardation_time or 0.0, self.law
        push = displacement - law.profile.height(edge) + retarded * velocity
        resolved = push > 1e-6 * np.abs(displacement)  # less is round-off of the edge
        grows = (edge > 0.0) & (velocity >= 0.0) & resolved & (retarded > 0.0)
        return np.where(grows, law.modulus * push, 0.0)

    def _layers(self, edge: Array, spent: Array, velocity: Array) -> Array:
        """Return the line load of the Prony series, (m,) [FU/LU] ≥ 0, just inside a growing contact edge.

        0 at another edge, where the body moves back, and with dashpots. An arm has its load in a layer a′ τ behind the
        edge; only layers thinner than about a spacing count.

        Args:
            edge: contact radius a, (m,) [LU].
            spent: durations of the load steps, (m,) [TU].
            velocity: of the body, (m,) [LU/TU].
        """
        grown = np.maximum(np.diff(edge, prepend=0.0), 0.0) / spent / self.law.spacing
        arms = (term.share * term.time * np.exp(-term.time * grown) for term in self.law.material.terms)
        return self.law.modulus * np.maximum(velocity, 0.0) * sum(arms) * (grown > 0.0)

    @cached_property
    def _outline(self) -> tuple[Array, Array]:
        """(Heights of the body [LU], rising; their positions [LU] from 0 to the last particle), both (20 n,) for n
        particles.
        """
        x = np.linspace(0.0, float(np.abs(self.x).max()), 20 * self.x.size)
        return self.law.profile.height(x), x

    def _positions(self, heights: Array) -> Array:
        """Return the positions ≥ 0, (m,) [LU], of heights on the body, (m,) [LU]: linear, and one secant step.

        None is beyond the last particle.
        """
        known, x = self._outline
        guess, shape = np.interp(heights, known, x), self.law.profile
        cell = np.clip(np.searchsorted(known, heights), 1, x.size - 1)
        rise, width = known[cell] - known[cell - 1], x[cell] - x[cell - 1]
        missed = np.divide(heights - shape.height(guess), rise, out=np.zeros_like(guess), where=rise > 0.0)
        return np.clip(guess + width * missed, x[cell - 1], x[cell])

    def _edges(self, margin: Array) -> tuple[Array, Array]:
        """Return (contact radii a, their errors), both (m,) [LU] ≥ 0, of states with overlaps `margin`, (m, n) [LU].

        Both are 0 without contact. Where the last particle touches, the radius is the half-width of body or chain, with
        the error 0. Else the overlap falls to 0 at a, linearly over the height. At a growing contact it has a kink at
        a, so that the next two free particles show it; at a shrinking one the last particle and the next are nearer.
        Another particle in place of one of the two gives the error.
        """
        heights, touching = self._cells[0].heights, margin > 0.0
        end = heights.size - 1
        last = end - np.argmax(touching[:, ::-1], axis=1)
        states, after = np.arange(last.size), np.minimum(last + 1, end)

        def crossing(first: NDArray[np.intp], second: NDArray[np.intp]) -> Array:
            """Return the position, (m,) [LU], at which the overlap is 0 on a line over the height through two
            particles.

            It lies between the last particle that touches and the next.
            """
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
    """Return in which states, (m,), an edge has grown since its least radius and is not yet at its largest one again.

    `edge`: contact radius, (m,) [LU].
    """
    returned, most, least = np.zeros(edge.size, dtype=bool), 0.0, 0.0
    for i, radius in enumerate(edge.tolist()):
        if radius >= most * (1.0 - ROUND_OFF):
            most = least = radius
        least = min(least, radius)
        returned[i] = radius > least * (1.0 + ROUND_OFF)
    return returned
