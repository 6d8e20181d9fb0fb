"""What the plate does, and what particles carry along its path."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from contact1d.workflow.laws.particles import Particles

Array = NDArray[np.float64]
NEAREST, ASIDE = 1e-9, 1e-6
"""Part of a step that is round-off, and that is beside a jump."""
EACH_STEP, EACH_LEG, BESIDE = 32, 80, 30
"""States in a step of a tangential path that changes the load, and in all of the displacement of others, between which
forces are straight lines; on both sides of a jump."""


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
        return self.at(np.linspace(0.0, len(self.phases) - 1.0, (len(self.phases) - 1) * times + 1))

    def at(self, moments: Array) -> History:
        """The same at rising moments, whole numbers of which are those of this history."""
        known = np.arange(len(self.phases))
        time, values = (np.interp(moments, known, one) for one in (self.time, self.values))
        return replace(
            self, phases=tuple(self.phases[int(i)] for i in np.ceil(moments - NEAREST)), time=time, values=values
        )

    def beside(self, places: Sequence[float]) -> History:
        """With moments on both sides of where displacements pass certain places [LU]: a force jumps there."""
        found = [np.arange(float(len(self.phases)))]
        for place in places:
            before, after = self.values[:-1] - place, self.values[1:] - place
            passed = np.flatnonzero((before * after <= 0.0) & (before != 0.0))
            at = passed + before[passed] / (before[passed] - after[passed])
            found += [at - ASIDE, np.minimum(at + ASIDE, passed + 1.0)]
        return self.at(np.unique(np.concatenate(found)))

    def path(self, model: Particles) -> Path:
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
        round_off: of the force of one particle, beyond that of its position, (m,) [FU].
    """

    x: Array
    total: Array
    force: Callable[[int], Array]
    shear: Callable[[int], Array] | None = None
    zone: tuple[Array, ...] | None = None
    round_off: Array | float = 0.0


def legs(displacements: Array) -> list[slice]:
    """Stretches of a path along which displacements do not turn."""
    ways = np.sign(np.diff(displacements))
    moves = np.flatnonzero(ways)
    turns = moves[1:][ways[moves[1:]] != ways[moves[:-1]]] + 1
    edges = [0, *turns.tolist(), len(displacements)]
    return [slice(first, last) for first, last in pairwise(edges) if last > first]


def equilibria(path: Path, apart: float, jumps: Sequence[float], spacing: float, finer: int) -> Path:
    """Return equilibria along a path from apart on, with as many states as the work along it needs.

    In a step that changes the load, `along` given, EACH_STEP states; else EACH_LEG over all of the displacement, and
    BESIDE in geometric progression on both sides of each jump; times `finer`.

    Args:
        path: of a run.
        apart: displacement [LU] below which nothing is felt.
        jumps: displacements [LU] at which the force jumps.
        spacing: of the particles [LU].
        finer: so many times as many.
    """
    start = min(0.0, apart) - NEAREST * spacing  # below that nothing is felt
    places = np.append(start, np.maximum(path.displacement, start))
    if path.along.any():
        each = np.where(np.diff(places) != 0.0, EACH_STEP, 1) * finer
        steps, moved = np.arange(places.size), np.append(path.along[:1], path.along)
        at = np.append(0.0, np.concatenate([step + np.arange(1, count + 1) / count for step, count in enumerate(each)]))
        return Path(np.interp(at, steps, places), np.interp(at, steps, moved), np.zeros_like(at))
    distances = spacing * np.geomspace(NEAREST, 1.0, BESIDE)
    near = np.asarray([jump + side for jump in jumps for side in (-distances, distances)]).ravel()
    ends = places[[0, *(leg.stop - 1 for leg in legs(places))]].tolist()
    passed, whole = [places[:1]], float(np.ptp(places)) or 1.0
    for start, end in pairwise(ends):
        count = math.ceil(EACH_LEG * finer * abs(end - start) / whole) + 1
        between = near[(near > min(start, end)) & (near < max(start, end))]
        leg = np.unique(np.concatenate([np.linspace(start, end, count + 1), between]))
        passed.append((leg if end > start else leg[::-1])[1:])
    return path_of(np.concatenate(passed))
