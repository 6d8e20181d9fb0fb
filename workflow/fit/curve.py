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
BESIDE_JUMP = 3
"""Points to each side of a jump that are not compared: there the force is no smooth function of the parameters."""


@dataclass(frozen=True)
class Segment:
    """The approach or the retraction of a curve, in the order of time.

    Attributes:
        points: indices of its points in the curve, (n,).
        jump: positions in `points` of the last point before and the first one after a jump of the force; None: no jump.
        approaches: whether the bodies approach.
    """

    points: Indices
    jump: tuple[int, int] | None
    approaches: bool

    def _sides(self, margin: int = 0) -> tuple[Indices, Indices]:
        """Return the indices in the curve of points (before, after) the jump, without the `margin` points next to it.

        Both are empty without a jump.
        """
        before, after = self.jump or (-1, self.points.size)
        return self.points[: max(0, before + 1 - margin)], self.points[after + margin :]

    @property
    def held(self) -> Indices:
        """Indices in the curve of points at which the bodies are certainly in contact; empty without a jump."""
        return self._sides()[self.approaches]

    @property
    def apart(self) -> Indices:
        """Indices in the curve of points at which the bodies are certainly apart; empty without a jump."""
        return self._sides()[not self.approaches]

    @property
    def compared(self) -> Indices:
        """Indices in the curve of points that a model is compared with: all but the jump and three points beside it."""
        return self.points if self.jump is None else np.concatenate(self._sides(BESIDE_JUMP))


@dataclass(frozen=True)
class ForceCurve:
    """Positions z [LU], rising towards the sample, and forces F [FU], compression positive, (n,), in the order of time.

    Attributes:
        positions, forces: z and F.
        turn: number of points of the approach, which come first.
        lines: line of each point in its file, (n,).
    """

    positions: Array
    forces: Array
    turn: int
    lines: NDArray[np.int_]

    @cached_property
    def segments(self) -> tuple[Segment, Segment]:
        """The (approach, retraction) of the curve, each with its jump of the force: a snap-in, a snap-out."""
        approach, retraction = np.split(np.arange(self.positions.size), [self.turn])
        return (
            Segment(approach, self._jump(approach, -1.0), True),
            Segment(retraction, self._jump(retraction, 1.0), False),
        )

    def _jump(self, points: Indices, sign: float) -> tuple[int, int] | None:
        """Return positions in `points`: of the last before a jump of the force and of the first after it.

        None without a jump. `sign`: that of the change of the force, −1 for a snap-in and 1 for a snap-out. A jump is
        more than six times as large as the usual change between neighbours.
        """
        change = sign * np.diff(self.forces[points])
        change -= median_filter(change, 15, mode="nearest")  # less the usual change, due to the contact stiffness
        spread = 1.4826 * float(np.median(np.abs(change)))
        peak = int(np.argmax(change))
        if not change[peak] > JUMP * max(spread, 1e-12 * float(np.ptp(self.forces))):
            return None
        # A jump may take several points: a neighbour belongs to it whose change is half of JUMP and a fifth of the
        # largest one, since close to the fold a contact softens, which is no jump.
        first, last, least = peak, peak, max(0.5 * JUMP * spread, 0.2 * change[peak])
        while first > 0 and change[first - 1] > least:
            first -= 1
        while last < change.size - 1 and change[last + 1] > least:
            last += 1
        return first, last + 1

    @property
    def depth(self) -> float:
        """The range of the positions, largest less least [LU]."""
        return float(np.ptp(self.positions))

    @cached_property
    def baseline(self) -> float:
        """The median force [FU] where the bodies are certainly apart, else of the first fifth of the approach.

        The latter where fewer than ten points are certainly apart.
        """
        apart = np.concatenate([segment.apart for segment in self.segments])
        if apart.size < 10:
            apart = np.arange(max(3, self.turn // 5))
        return float(np.median(self.forces[apart]))
