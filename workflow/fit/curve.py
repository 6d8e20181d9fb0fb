"""A measured force curve: positions and forces of an approach and a retraction, and where it jumps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
JUMP = 6.0
"""Change of the force between neighbouring points over its usual spread that counts as a jump."""
PART_OF_JUMP, SHARE_OF_JUMP = 3.0, 0.2
"""The same for a point beside it that belongs to it, a jump that takes several points, and its change over the largest
one: close to the fold a contact softens, which is no jump.
"""
NEIGHBOURS = 15
"""Points whose usual change of the force is no jump."""
BESIDE = 3
"""Points beside a jump that are not compared: there the force is no smooth function of the parameters."""


@dataclass(frozen=True)
class Segment:
    """One way of a curve, in the order of time.

    Attributes:
        points: indices into the curve.
        jump: the last point before and the first one after a jump of the force, in `points`; None: no jump.
        approaches: whether the bodies approach.
    """

    points: Indices
    jump: tuple[int, int] | None
    approaches: bool

    def _sides(self, beside: int = 0) -> tuple[Indices, Indices]:
        """The points before and after the jump, but for so many beside it; without one there are none."""
        before, after = self.jump or (-1, self.points.size)
        return self.points[: max(0, before + 1 - beside)], self.points[after + beside :]

    @property
    def held(self) -> Indices:
        """Points of a contact that holds; without a jump none is known to."""
        return self._sides()[self.approaches]

    @property
    def apart(self) -> Indices:
        """Points of bodies that are known to be apart."""
        return self._sides()[not self.approaches]

    @property
    def compared(self) -> Indices:
        """Points that a model is compared with: all but those at the jump and beside it."""
        return self.points if self.jump is None else np.concatenate(self._sides(BESIDE))


@dataclass(frozen=True)
class ForceCurve:
    """Positions z [LU] and forces F [FU], compression positive, (n,) each, and the line of each point in its file.

    `turn` is the number of points of the approach, which come first.
    """

    positions: Array
    forces: Array
    turn: int
    lines: NDArray[np.int_]

    @cached_property
    def segments(self) -> tuple[Segment, Segment]:
        """Approach and retraction."""
        every = np.arange(self.positions.size)
        approach, retraction = every[: self.turn], every[self.turn :]
        return (
            Segment(approach, self._jump(approach, -1.0), True),
            Segment(retraction, self._jump(retraction, 1.0), False),
        )

    def _jump(self, points: Indices, sign: float) -> tuple[int, int] | None:
        """The largest change of the force of this sign from one point to the next, if it is one."""
        change = sign * np.diff(self.forces[points])
        change -= median_filter(change, NEIGHBOURS, mode="nearest")  # what the contact's stiffness does
        spread = 1.4826 * float(np.median(np.abs(change)))
        at = int(np.argmax(change))
        if not change[at] > JUMP * max(spread, 1e-12 * float(np.ptp(self.forces))):
            return None
        first, last, part = at, at, max(PART_OF_JUMP * spread, SHARE_OF_JUMP * change[at])
        while first > 0 and change[first - 1] > part:
            first -= 1
        while last < change.size - 1 and change[last + 1] > part:
            last += 1
        return first, last + 1

    @property
    def depth(self) -> float:
        """Range of the positions [LU]."""
        return float(np.ptp(self.positions))

    @cached_property
    def baseline(self) -> float:
        """The force [FU] of bodies apart: of points that are known to be, else of the first fifth of the approach."""
        apart = np.concatenate([one.apart for one in self.segments])
        if apart.size < 10:
            apart = np.arange(max(3, self.turn // 5))
        return float(np.median(self.forces[apart]))
