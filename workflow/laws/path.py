"""Paths and histories of the plate, and the forces of particles along them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.numerics import ROUND_OFF

if TYPE_CHECKING:
    from contact1d.workflow.laws.particles import Particles

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Path:
    """States of the plate along its path; arrays (m,).

    Attributes:
        displacement, along: normal displacement, compression positive, and tangential one, along +x [LU].
        time: time of each state [TU]; 0 where the states are equilibria.
        velocity: normal velocity at the end of each load step [LU/TU]; None: displacements are straight between the
            states.
    """

    displacement: Array
    along: Array
    time: Array
    velocity: Array | None = None


@dataclass(frozen=True)
class History:
    """Displacements or forces over time, straight from one moment to the next; arrays (m,).

    Attributes:
        phases: name of the phase of each moment.
        time: times, rising [TU].
        values: displacements [LU], or forces [FU] where `by_force`; compression positive.
        by_force: whether the force is prescribed.
        marks: {name of a phase: name under which its last state is reported}.
    """

    phases: tuple[str, ...]
    time: Array
    values: Array
    by_force: bool
    marks: Mapping[str, str]

    def denser(self, times: int) -> History:
        """Return this history with each of its intervals divided into `times` equal ones, values by linear
        interpolation.

        A moment that is added belongs to the phase of the next one of its own.
        """
        return self.resampled(np.linspace(0.0, len(self.phases) - 1.0, (len(self.phases) - 1) * times + 1))

    def resampled(self, moments: Array) -> History:
        """Return this history at other rising `moments`, (k,), given as indices of its own; values by linear
        interpolation.

        1.5 is midway between its second and third moment; it belongs to the phase of the third. Marks remain.
        """
        known = np.arange(len(self.phases))
        time, values = (np.interp(moments, known, column) for column in (self.time, self.values))
        return replace(
            self, phases=tuple(self.phases[int(i)] for i in np.ceil(moments - ROUND_OFF)), time=time, values=values
        )

    def refined_at(self, displacements: Sequence[float], aside: float = 1e-6) -> History:
        """Return this history, of displacements, with further moments around each passage of one of `displacements`.

        In each interval that passes one [LU], where a force jumps, there are two: before and after the passage, by
        `aside` of the interval (relative). An interval that ends there has the first one only, and one that begins
        there none.
        """
        moments = [np.arange(float(len(self.phases)))]
        for displacement in displacements:
            before, after = self.values[:-1] - displacement, self.values[1:] - displacement
            passed = np.flatnonzero((before * after <= 0.0) & (before != 0.0))
            passage = passed + before[passed] / (before[passed] - after[passed])
            moments += [passage - aside, np.minimum(passage + aside, passed + 1.0)]
        return self.resampled(np.unique(np.concatenate(moments)))

    def path(self, model: Particles) -> Path:
        """Return the path of the body over the times of this history, without tangential displacement.

        Its displacements are the values, without velocities. Under prescribed forces displacements are those that the
        particles `model` compute; velocities, too, of a viscoelastic body, and else None.
        """
        displacement, velocity = self.values, None
        if self.by_force:
            displacement, velocity = model.displacements_under(self.time, self.values)
        return Path(displacement, np.zeros_like(displacement), self.time, velocity)


def path_of(displacement: Array) -> Path:
    """Return a path of equilibria at displacements (m,) [LU], without tangential displacement or velocity, all at time
    0.
    """
    zeros = np.zeros_like(displacement)
    return Path(displacement, zeros, zeros)


@dataclass(frozen=True)
class Followed:
    """Forces of particles along a path of m displacements.

    Attributes:
        x: positions of the particles [LU], (n,).
        total: sum of their normal forces, (m,) [FU], compression positive.
        force: function of the index of a displacement: the normal force of each particle there, (n,) [FU].
        shear: function of that index: tangential forces (n,) [FU]; None where no tangential path is prescribed.
        zone: for each state, (m,) each, contact radius a [LU], radius of the attraction [LU], jump of the line load at
            a [FU/LU]; of a viscoelastic body also the error of a [LU] and the line load of a thin layer inside of it
            [FU/LU]. None where the particles' forces show the edge.
        round_off: of the force of one particle, beyond that of its position, (m,) [FU].
    """

    x: Array
    total: Array
    force: Callable[[int], Array]
    shear: Callable[[int], Array] | None = None
    zone: tuple[Array, ...] | None = None
    round_off: Array | float = 0.0


def legs(displacements: Array) -> list[slice]:
    """Return the monotonic parts of a path of displacements, (m,) [LU], as slices in order that together cover it.

    Empty for an empty path. A displacement at which the direction turns belongs to the part before; equal ones in
    succession are no turn.
    """
    directions = np.sign(np.diff(displacements))
    moves = np.flatnonzero(directions)
    turns = moves[1:][directions[moves[1:]] != directions[moves[:-1]]] + 1
    edges = [0, *turns.tolist(), len(displacements)]
    return [slice(first, last) for first, last in pairwise(edges) if last > first]


def equilibria(path: Path, apart: float, jumps: Sequence[float], spacing: float, finer: int) -> Path:
    """Return a path of equilibria that begins with separated bodies, dense enough for an integral of the work along it.

    It begins just below the smaller one of `apart` and 0; smaller displacements of `path` are raised to this start.
    Without tangential displacements each monotonic part goes evenly from one end to the other, with about 80 · `finer`
    states times its share of the whole range of displacement: 160 · `finer` for a way there and back. Each passage of a
    jump has up to 60 more, 30 on each side, within one spacing and inside of the part. With any tangential displacement
    it goes through all states of `path`: 32 · `finer` states for each step that changes the normal displacement, the
    one from the start included, `finer` for each other step, and none near jumps. Times are 0, velocities None.

    Args:
        path: of a run; it is not changed.
        apart: displacement [LU] below which the force is 0.
        jumps: displacements [LU] at which the force jumps.
        spacing: of the particles [LU].
        finer: factor on the number of states, not on those near jumps.
    """
    start = min(0.0, apart) - ROUND_OFF * spacing  # apart
    displacements = np.append(start, np.maximum(path.displacement, start))
    if path.along.any():
        # 32 states in a step that changes the load; between others forces are straight lines.
        counts = np.where(np.diff(displacements) != 0.0, 32, 1) * finer
        steps, along = np.arange(displacements.size), np.append(path.along[:1], path.along)
        moments = [step + np.arange(1, count + 1) / count for step, count in enumerate(counts)]
        states = np.append(0.0, np.concatenate(moments))
        return Path(np.interp(states, steps, displacements), np.interp(states, steps, along), np.zeros_like(states))
    # 80 states over all of the displacement, and 30 in geometric progression on both sides of each jump.
    distances = spacing * np.geomspace(ROUND_OFF, 1.0, 30)
    near = np.asarray([jump + side for jump in jumps for side in (-distances, distances)]).ravel()
    ends = displacements[[0, *(leg.stop - 1 for leg in legs(displacements))]].tolist()
    parts, total = [displacements[:1]], float(np.ptp(displacements)) or 1.0
    for first, last in pairwise(ends):
        count = math.ceil(80 * finer * abs(last - first) / total) + 1
        between = near[(near > min(first, last)) & (near < max(first, last))]
        leg = np.unique(np.concatenate([np.linspace(first, last, count + 1), between]))
        parts.append((leg if last > first else leg[::-1])[1:])
    return path_of(np.concatenate(parts))
