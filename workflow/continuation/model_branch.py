"""The reduced model in place of LAMMPS: driven by the same script and evaluated by the same reader.

A leg is a part of the path between two turns of the loading, numbered from 0 on. Displacements d [LU] and forces F [FU]
are positive in compression.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.continuation.trace import Trace, of_model
from contact1d.workflow.deck.steps import last_steps
from contact1d.workflow.laws.numerics import value_at
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, History, Path
from contact1d.workflow.model.free import impact, swing
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

MOST_NUMBERS = 2_000_000
"""Largest number of forces that are computed in a path with dense positions."""
UNSEEN = ""
"""Phase of states that lead to the first state of a path and are not read."""


class ModelBranch:
    """The states of the model, with positions of the required density; they are computed together at the end.

    A leg is a part of the path between two turns of the loading. Displacements and forces are positive in compression.

    Attributes:
        scene, settings: of the contact.
        model: the particles.
        dense: positions for each step that the scene gives.
        shift: of the displacements that it gives [LU].
        phases: name of the phase of each state; "" for states that lead to the first one and are not read.
        legs: how often the loading has turned before each state, from 0 on; −1 for a hold without a move before.
        marks: names under which states are reported, by the number of the state.
        wanted: force [FU] that a state was to carry, by its number.
        peaks: numbers of the states at force maxima.
        given: what is prescribed, "displacement" or "force" over time.
    """

    def __init__(self, scene: Scene, settings: Settings, model: Particles, dense: int, shift: float) -> None:
        """Begin with no states and the bodies apart.

        `dense`: positions for each step that the scene gives; `shift`: of the displacements that it gives [LU].
        """
        self.scene, self.settings, self.model, self.dense, self.shift = scene, settings, model, dense, shift
        self._phase, self._leg = "", -1
        self._rises: bool | None = None
        self.given = "displacement"
        self.phases: list[str] = []
        self.legs: list[int] = []
        self._paths: list[Path] = []
        self._beyond = np.empty(0)
        self.marks: dict[int, list[str]] = {}
        self.wanted: dict[int, float] = {}
        self.peaks: list[int] = []

    @property
    def scale(self) -> float:
        """The expected force maximum (largest tension) by the contact law [FU], positive; 0 without attraction."""
        return self.settings.law.pull_off_force()

    def begin(self, name: str) -> None:
        """Begin a phase of this name with the next state; a repeated name gets no number here."""
        self._phase = name

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | Array | None = None) -> None:
        """Go to displacements [LU] plus `shift`, compression positive, with dense positions between them, all at x = 0.

        They are `dense` for each step, fewer where that would need more than 2·10⁶ forces; with one for each step it
        goes to positions `along` x [LU] as well. Without earlier states the path begins at the first displacement. The
        loading rises if the last displacement is at least that of the state before.
        """
        wanted = np.asarray(positions, dtype=np.float64) + self.shift
        before = self._displacement if self.phases else float(wanted[0])
        self._turn(float(wanted[-1]) >= before)
        between = min(self.dense, max(1, MOST_NUMBERS // max(1, wanted.size * self.model.x.size)))
        if between == 1:
            self._add(wanted, along)
            return
        if not self.phases:
            self._add(wanted[:1])
            wanted = wanted[1:]
        dense, leading = self._between(np.append(self._displacement, wanted), between)
        phase = self._phase
        if self.phases[-1] == UNSEEN:  # positions before the first state of a path are not read
            self._phase = UNSEEN
            self._add(dense[:leading])
            dense = dense[leading:]
        self._phase = phase
        self._add(dense)

    def _between(self, ends: Array, count: int) -> tuple[Array, int]:
        """Return (displacements [LU], number of those before the end of the first step) for steps between `ends` [LU].

        There are `count` equal parts in each step, to its end, and one displacement on either side of each jump of the
        force that it passes; the first end is not among them.
        """
        near = 1e-6 * self.model.law.spacing  # the distance from a jump
        jumps = np.asarray([jump + side for jump in self.model.jumps for side in (-near, near)] + [*self.model.corners])
        steps, step = np.arange(ends.size), np.diff(ends)
        passed = np.divide(
            jumps - ends[:-1, None], step[:, None], out=np.zeros((step.size, jumps.size)), where=step[:, None] != 0.0
        )
        inside = (passed > 0.0) & (passed < 1.0)
        shares = np.union1d(np.arange(1, count * step.size + 1) / count, (steps[:-1, None] + passed)[inside])
        return np.interp(shares, steps, ends), int(np.count_nonzero(shares < 1.0))

    def reach(self, force: float, scale: float, steps: int = 8) -> None:
        """Go in `steps` equal steps to the displacement at which the model carries a force [FU], compression positive.

        It is the largest such displacement in unloading. A tension that is never carried leads to the force maximum,
        too large a force to the end of the search, a tenth beyond the largest expected displacement. `scale` is
        ignored: the model needs no tolerance. A first call begins at displacement 0.
        """
        end, begun = self.model.displacement_at(force), bool(self.phases)
        start = self._displacement if begun else 0.0
        self._turn(end > start)
        self._add(np.linspace(start, end, steps + 1)[begun:])
        self.wanted[self.last] = force

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a displacement [LU], or a force [FU] on a free plate, for a time [TU]: add the first and the last state.

        Their times are 0 and `duration`; under a displacement both are at it. Under a force (compression positive) they
        are after the first timestep, from rest, and after the time, of plate and particles on the reduced model (both
        in equilibrium after more than 20 000 timesteps); a compressive force is applied at displacement 0, a tension
        at F = 0, to which load steps lead. Nothing is added where both are None; the displacement has priority.
        """
        if displacement is not None:
            self._add(np.asarray([displacement, displacement]), time=(0.0, duration))
        elif force is not None:
            start = 0.0
            if force < 0.0:
                self.reach(0.0, self.scale)
                start = self._displacement
            self._add(swing(self.scene, self.settings, self.model, start, force, duration), time=(0.0, duration))

    def follow(self, history: History) -> None:
        """Go through the displacements [LU] or forces [FU] of a history over time [TU], with dense steps.

        All states are one part of the path, whatever the turns of the loading; displacements are not shifted.

        Mark the last state of each phase that has a mark.
        """
        history = history.denser(self.dense)
        self._leg += 1
        self.given = "force" if history.by_force else self.given
        self._add_path(history.phases, history.path(self.model))
        ends = last_steps(history.phases)
        self.marks |= {ends[phase]: [mark] for phase, mark in history.marks.items() if phase in ends}

    def fly(self, velocity: float) -> None:
        """Move freely from displacement 0 with an impact velocity [LU/TU], positive in approach, up to the rebound.

        The states are added in a phase "impact". They end when the bodies have separated, when the body moves down
        again, or after 20 000 states.
        """
        path = impact(self.scene, self.settings, self.model, velocity, self.dense)
        self._leg += 1
        self._add_path(["impact"] * path.time.size, path)

    def maximum(self, coarse: int = 24, dense: int = 100, nearest: int = 3) -> None:
        """Unload to the force maximum (largest tension), with dense positions about it; the last state is at it.

        The positions beyond it are kept for `open`. There must be a state before.

        Args:
            coarse: positions of the unloading for a contact without a range of the interaction.
            dense: for one with a range; twice as many where pairs snap.
            nearest: number of last states before a limit point, of which that with the largest tension is the
                maximum.
        """
        self._turn(False)
        zero, apart = self._displacement, self.model.apart
        end = zero + (1.0 - 1e-9) * (apart - zero)  # just before the limit point
        if self.settings.forces.range:
            positions = np.linspace(zero, end, dense * (2 if self.settings.snaps else 1))[1:]
        else:
            positions = self.model.unloading(zero, end, coarse)
        peak, step = self._peak(np.append(zero, positions), end)
        about = np.clip(peak + step * np.arange(-3.0, 4.0), end, zero)
        positions = np.unique(np.append(positions, about))[::-1]
        positions = positions[positions < zero]
        last = int(np.count_nonzero(positions >= peak)) if peak < zero else 0
        if (near := positions[max(last - nearest, 0) : last]).size:
            tensions = -self.model.held(near)  # a chain may lose a part at the limit point, the maximum of its law
            loses = tensions[-1] < (1.0 - self.settings.tolerance) * tensions.max()
            if loses or self.model.critical_displacement is None:
                last -= near.size - 1 - int(np.argmax(tensions))
        self._add(positions[:last])
        self._beyond = positions[last:]
        self.peaks.append(self.last)

    def _peak(self, positions: Array, end: float, zooms: int = 2, fine: int = 30) -> tuple[float, float]:
        """Return (displacement of the force maximum, distance of dense positions about it), both [LU].

        Where the law knows the former, it is that, within `end` [LU] and the first of the falling `positions` [LU].
        Else it is the position of the largest tension, and where the curve is not smooth the best of `fine` ones
        between its neighbours, `zooms` times. A smooth curve is not refined. That of an interaction has the distance 0:
        forces of the model are linear between the points of a grid, whose corners would move the maximum. Where the
        curve has a corner there, it is shorter by the tolerance.
        """
        zero, top = float(positions[0]), int(np.argmin(self.model.held(positions)))
        low, high = float(positions[min(top + 1, positions.size - 1)]), float(positions[max(top - 1, 0)])
        peak, step, known = float(positions[top]), (high - low) / 64.0, self.model.critical_displacement
        if known is not None:
            return min(max(known, end), zero), step
        if self.settings.is_smooth:
            return peak, 0.0 if self.settings.forces.range else step
        corners = [corner for corner in self.model.corners if low < corner < high]
        for _ in range(zooms):
            closer, width = np.linspace(high, low, fine, retstep=True)
            closer = np.append(closer, corners)
            peak = float(closer[int(np.argmin(self.model.held(closer)))])
            low, high = max(peak - abs(width), end), min(peak + abs(width), zero)
        return peak, self.settings.tolerance * step if peak in corners else step  # a polynomial has no corner

    def mark(self, name: str) -> None:
        """Report the last state under a name; a state may have several names."""
        self.marks.setdefault(self.last, []).append(name)

    def open(self) -> None:
        """Pull the bodies apart: add the states beyond the force maximum, and two of separated bodies.

        Those beyond the maximum are the positions that `maximum` has left, none without it. There must be a state
        before.
        """
        apart, deepest = self.model.apart, float(self.path.displacement.max())
        self._add(np.append(self._beyond, apart - np.asarray([1e-4, 0.05]) * (deepest - apart)))
        self._beyond = np.empty(0)

    @property
    def last(self) -> int:
        """The number of the last state, from 0 on, over all states; −1 without states."""
        return len(self.phases) - 1

    def held(self, state: int) -> float:
        """Return F [FU], compression positive, of a state by its number, as in unloading from the deepest one."""
        return value_at(self.model.held, self.path.displacement[state])

    @property
    def path(self) -> Path:
        """The path of all states, also of those that are not read: displacements, positions along x [LU], times [TU].

        Velocities [LU/TU] are None where that of any state is unknown.

        Raises:
            ValueError: there are no states.
        """
        names = ("displacement", "along", "time")
        d, along, time = (np.concatenate([getattr(path, name) for path in self._paths]) for name in names)
        velocities = [path.velocity for path in self._paths if path.velocity is not None]
        known = len(velocities) == len(self._paths)
        return Path(d, along, time, np.concatenate(velocities) if known else None)

    @property
    def _displacement(self) -> float:
        """Displacement [LU] of the last state; IndexError without states."""
        return float(self._paths[-1].displacement[-1])

    def trace(self, whole: bool = False) -> Trace:
        """Return the states with forces and contact radii of the reduced model, from which results are read.

        Without `whole`, states that lead to the first one of the scene are left out. Forces are computed at each call.

        Raises:
            ValueError: there are no states.
        """
        phases, legs, path = self.phases, self.legs, self.path
        rule = radius_rule(self.scene, self.settings.tolerance)
        trace = of_model(phases, legs, path, self.model.follow(path), rule, self.model)
        trace = replace(trace, given=self.given)
        return trace if whole else trace.chosen([i for i, name in enumerate(phases) if name != UNSEEN])

    def _turn(self, rises: bool) -> None:
        """Record whether the displacement rises next; where that changes, a new part of the path begins.

        So it does at the first call.
        """
        self._leg += rises != self._rises
        self._rises = rises

    def _add(
        self, positions: Array, along: Sequence[float] | Array | None = None, time: Sequence[float] | None = None
    ) -> None:
        """Add states at displacements [LU], in the current phase and direction of loading.

        `along`: positions along x [LU], `time` [TU], one for each; None: 0.
        """
        none = np.zeros(len(positions))
        columns = (none if column is None else np.asarray(column, dtype=np.float64) for column in (along, time))
        self._add_path([self._phase] * none.size, Path(positions, *columns))

    def _add_path(self, phases: Sequence[str], path: Path) -> None:
        """Add the states of a path, in the current direction of loading, each with the name of its phase."""
        if phases:
            self._paths.append(path)
            self.phases += phases
            self.legs += [self._leg] * len(phases)


Script = Callable[[ModelBranch], object]
"""A function that moves a contact."""
