"""The undeformed shape of a body, as a law needs it, and positions of particles on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.numerics import ROUND_OFF

Array = NDArray[np.float64]


def positions_within(reach: float, spacing: float, phase: float) -> Array:
    """Return all x = (i + φ) s, (n,) [LU], with |x| ≤ reach [LU], rising; empty where none is within.

    i are integers, φ is the `phase`, relative to the `spacing` s [LU].
    """
    first, last = math.ceil(-reach / spacing - phase), math.floor(reach / spacing - phase)
    return np.asarray(spacing * (np.arange(first, last + 1) + phase), dtype=np.float64)


class Profile(Protocol):
    """The undeformed shape of the upper body."""

    def height(self, x: Array) -> Array:
        """Return the height above the apex, (…) [LU], at positions x of any shape, (…) [LU]."""

    @property
    def reach(self) -> float:
        """Half-width [LU] of the body; infinite for an unbounded one."""

    @property
    def kinks(self) -> tuple[float, ...]:
        """Positions > 0 [LU], rising, at which the slope of the profile jumps; empty without any."""

    def __hash__(self) -> int:
        """Return a hash that is equal for equal bodies, so that they share one cached law."""


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A profile given by its heights at positions, linear between them.

    It replaces a measured profile, whose transform takes long: a predictor evaluates it thousands of times.

    Attributes:
        positions: rising, from 0 on, (n,) [LU].
        heights: at these positions, (n,) [LU].
        kinks: positions at which the slope jumps [LU].
    """

    positions: Array
    heights: Array
    kinks: tuple[float, ...] = ()

    def height(self, x: Array) -> Array:
        """Return heights (…) [LU] at positions x, (…) [LU], by |x|: linear in the table, and its last one beyond it."""
        return np.interp(np.abs(x), self.positions, self.heights)

    @property
    def reach(self) -> float:
        """Half-width [LU] of the body: the last position of the table."""
        return float(self.positions[-1])


@dataclass(frozen=True, eq=False)
class Splined(Tabulated):
    """A tabulated profile, interpolated by a cubic spline between kinks: a parabola to 1e-12 of its height."""

    @cached_property
    def _curve(self) -> Any:
        """Height [LU] over x ≥ 0 [LU] through the table, a `PPoly` of a cubic spline between each two kinks.

        A kink within three positions of an end of the table is smoothed.
        """
        from scipy.interpolate import CubicSpline, PPoly

        end = self.positions.size - 1
        kinks = [kink for kink in np.searchsorted(self.positions, self.kinks).tolist() if 3 < kink < end - 3]
        parts = [slice(first, last + 1) for first, last in pairwise([0, *kinks, end])]
        cubics = [CubicSpline(self.positions[part], self.heights[part]).c for part in parts]
        return PPoly(np.concatenate(cubics, axis=1), self.positions)

    def height(self, x: Array) -> Array:
        """Return heights (…) [LU] at positions x, (…) [LU], by |x|: cubic in the table, and its last one beyond it."""
        return np.asarray(self._curve(np.minimum(np.abs(x), self.reach)))


def tabulated(profile: Profile, spacing: float, kind: type[Tabulated] = Tabulated) -> Tabulated:
    """Return a table, of the class `kind`, of a profile of finite half-width: at 0, at 1000 positions up to the
    half-width, and at and near its first 100 kinks. It has all kinks of the profile.

    The 1000 are in geometric progression from 0.01 spacings on. Linear interpolation then has an error of 1e-4 of the
    height of a parabola, for a half-width of 0.1 to 1e10 spacings; closer to the apex than 0.01 spacings the profile is
    a line.

    Args:
        profile: whose heights are tabulated.
        spacing: of the particles [LU].
        kind: class of the table.
    """
    x = beside_kinks(np.concatenate([[0.0], np.geomspace(0.01 * spacing, profile.reach, 1000)]), profile.kinks)
    return kind(x, profile.height(x), profile.kinks)


def beside_kinks(positions: Array, kinks: Sequence[float], points: int = 60, most_kinks: int = 100) -> Array:
    """Return rising positions (n,) [LU]: the given ones, and more at and on both sides of kinks, without repetition.

    At a kink g rises as a root. None is added beyond the last position.

    Args:
        positions: rising [LU].
        kinks: positions of kinks [LU].
        points: number of positions on each side of a kink, from 1e-9 to a tenth of its position away, in geometric
            progression.
        most_kinks: number of kinks, the first ones, that get them.
    """
    end = float(positions[-1])
    distances = np.append(0.0, np.geomspace(ROUND_OFF, 0.1, points))
    near = [kink * (1.0 + sign * distances) for kink in kinks[:most_kinks] for sign in (1.0, -1.0)]
    x = np.unique(np.concatenate([positions, *near]))
    return x[x <= end]
