"""What the plate does, and what particles carry along its path."""

from __future__ import annotations

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
