"""A measured force curve: positions and forces of its segments, and where the force jumps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label, median_filter

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
JUMP = 6.0
"""Change of the force between neighbouring points over its usual spread that counts as a jump."""
BESIDE_JUMP = 3
"""Points to each side of a jump that are not compared: there the force is no smooth function of the parameters."""
APPROACH, HOLD, RETRACT = SEGMENTS = ("approach", "hold", "retract")
"""The names of segments, in the order of time. A hold is at the largest force or displacement."""
NOUNS = {APPROACH: "approach", HOLD: "hold", RETRACT: "retraction"}
"""The names of segments in texts."""


@dataclass(frozen=True)
class Segment:
    """The approach, the hold or the retraction of a curve, in the order of time.

    Attributes:
        name: "approach", "hold" or "retract".
        points: indices of its points in the curve, (n,).
        jump: positions in `points` of the last point before and the first one after a jump of the force; None: no jump.
        change: the same of the change between contact and bodies apart where no jump is seen: from a contact model, or
            the end of a retraction that ends in contact; None: it is not known.
    """

    name: str
    points: Indices
    jump: tuple[int, int] | None
    change: tuple[int, int] | None = None

    def _sides(self, margin: int = 0) -> tuple[Indices, Indices]:
        """Return the rising indices in the curve of the points (before, after) the jump, or the change, of the force.

        Points within it are in neither; `margin` further points are left out on each side. Both are empty without any.
        """
        before, after = self.jump or self.change or (-1, self.points.size)
        return self.points[: max(0, before + 1 - margin)], self.points[after + margin :]

    @property
    def held(self) -> Indices:
        """Indices in the curve, rising, of the points certainly in contact: after the snap-in, or before the snap-out.

        Points within the jump of the force are left out. Empty without a jump.
        """
        return self._sides()[self.name == APPROACH]

    @property
    def apart(self) -> Indices:
        """Indices in the curve, rising, of the points certainly apart: before the snap-in, or after the snap-out.

        Points within the jump of the force are left out. Empty without a jump.
        """
        return self._sides()[self.name == RETRACT]

    @property
    def compared(self) -> Indices:
        """Indices in the curve, rising, of the points that a model is compared with.

        All points without a jump or change of the force; else without those within it and the three next to it on each
        side.
        """
        return np.concatenate(self._sides(BESIDE_JUMP)) if self.is_decided else self.points

    @property
    def ends_in_contact(self) -> bool:
        """Whether its last point is certainly in contact: a retraction without baseline."""
        return self.change == (self.points.size - 1, self.points.size)

    @property
    def is_decided(self) -> bool:
        """Whether it is known which points are in contact."""
        return self.jump is not None or self.change is not None


@dataclass(frozen=True)
class ForceCurve:
    """Positions z [LU], rising towards the sample, and forces F [FU], compression positive, (n,), in the order of time.

    In a fit LU and FU are m and N. The points are those of an approach, a hold and a retraction, in this order; each of
    them may be missing, but not both approach and retraction.

    Attributes:
        positions, forces: z and F.
        kinds: index in `SEGMENTS` of the segment of each point, (n,), not falling.
        lines: line of each point in its file, (n,).
        times: of each point [s], (n,), rising; None where they are not known.
        level: force [FU] of bodies apart, known from another segment; None: by this curve.
        changes: of segments by name, as in `Segment`.
    """

    positions: Array
    forces: Array
    kinds: NDArray[np.int_]
    lines: NDArray[np.int_]
    times: Array | None = None
    level: float | None = None
    changes: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    def of(self, name: str) -> Indices:
        """Return the indices of the points of a segment, (m,): of "approach", "hold" or "retract"; maybe empty."""
        return np.flatnonzero(self.kinds == SEGMENTS.index(name))

    def only(self, *names: str) -> ForceCurve:
        """Return the curve of some segments alone, such as "approach" and "retract", without the hold."""
        points = np.flatnonzero(np.isin(self.kinds, [SEGMENTS.index(name) for name in names]))
        times = None if self.times is None else self.times[points]
        columns = (self.positions[points], self.forces[points], self.kinds[points], self.lines[points])
        return ForceCurve(*columns, times, self.baseline)

    @cached_property
    def segments(self) -> tuple[Segment, ...]:
        """The segments of the curve in the order of time, as far as it has them, each with its jump, if any; cached.

        The jump of the approach is a snap-in, at which the force falls; that of the retraction is a snap-out, at which
        it rises. A hold has none.
        """
        segments = []
        for name, sign in ((APPROACH, -1.0), (HOLD, 0.0), (RETRACT, 1.0)):
            if (points := self.of(name)).size:
                change = self.changes.get(name)
                if name == RETRACT and self._is_held(points):
                    change = points.size - 1, points.size
                segments.append(Segment(name, points, self._jump(points, sign) if sign else None, change))
        return tuple(segments)

    def _is_held(self, points: Indices) -> bool:
        """Return whether the last point of a retraction is certainly in contact; `points`: its indices in the curve.

        The mean of its last three forces is then farther from the level of bodies apart than ten standard deviations of
        the noise, and than a third of the largest tension. Without a known level, and without an approach, they change
        by as much within the last tenth.
        """
        forces = self.forces[points]
        noise = 1.4826 * float(np.median(np.abs(np.diff(forces)))) / math.sqrt(2.0)
        end = float(forces[-3:].mean())
        approach = self.of(APPROACH)
        level = self.level
        if level is None:
            apart = approach[: max(3, approach.size // 5)]
            level = float(np.median(self.forces[apart] if apart.size else forces[-max(6, points.size // 10) : -3]))
        return abs(end - level) > max(10.0 * noise, (level - float(forces.min())) / 3.0)

    def _jump(self, points: Indices, sign: float) -> tuple[int, int] | None:
        """Return positions in `points` of the largest jump of the force: (last point before it, first point after it).

        None without a jump. A jump is a change between neighbouring points that, with and without the running median of
        15 changes, is more than six times the usual one, 1.4826 times the median magnitude of all such differences.
        Changes next to
        it belong to it that are three times the usual one and a fifth of the largest, so that it may take several
        points.

        Args:
            points: indices in the curve, at least two.
            sign: sign of the change of the force: −1 for a snap-in, 1 for a snap-out.
        """
        whole = sign * np.diff(self.forces[points])
        change = whole - median_filter(whole, 15, mode="nearest")  # less the usual change, due to the contact stiffness
        spread = 1.4826 * float(np.median(np.abs(change)))
        peak = int(np.argmax(change))
        if not min(change[peak], whole[peak]) > JUMP * max(spread, 1e-12 * float(np.ptp(self.forces))):
            return None
        # A jump may take several points: a neighbour belongs to it whose change is half of JUMP and a fifth of the
        # largest one, since close to the fold a contact softens, which is no jump.
        runs, _ = label(change > max(0.5 * JUMP * spread, 0.2 * change[peak]))
        jump = np.flatnonzero(runs == runs[peak])
        return int(jump[0]), int(jump[-1]) + 1

    @property
    def depth(self) -> float:
        """The range of all positions, largest less least [LU]."""
        return float(np.ptp(self.positions))

    @cached_property
    def baseline(self) -> float:
        """The median force [FU] of the points certainly apart, those before a snap-in or after a snap-out; cached.

        With fewer than ten of these, it is a known level, else that of the first fifth of the approach, or of the last
        fifth of the retraction where there is no approach; three points at least.
        """
        apart = np.concatenate([segment.apart for segment in self.segments])
        if apart.size < 10 and self.level is not None:
            return self.level
        if apart.size < 10:
            points, fifth = self.segments[0].points, max(3, self.segments[0].points.size // 5)
            apart = points[:fifth] if self.segments[0].name == APPROACH else points[-fifth:]
        return float(np.median(self.forces[apart]))
