"""The undeformed shape of a body, as an estimate asks for it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PLACES, NEAR = 1000, 0.01
"""Places at which a profile is tabulated, and the first one beyond its apex over the spacing."""


def places_within(reach: float, spacing: float, phase: float) -> Array:
    """All x = (i + φ) s with |x| ≤ reach [LU] in order, i a whole number: of particles whose apex is φ s off one."""
    first, last = math.ceil(-reach / spacing - phase), math.floor(reach / spacing - phase)
    return np.asarray(spacing * (np.arange(first, last + 1) + phase), dtype=np.float64)


class Profile(Protocol):
    """The undeformed shape of the upper body."""

    def height(self, x: Array) -> Array:
        """Height [LU] at x [LU]."""

    @property
    def reach(self) -> float:
        """Half-width [LU] of the body."""

    def __hash__(self) -> int:
        """The same for equal bodies, which share their estimate."""


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A profile that was asked once for its `heights` [LU] at rising `places` [LU] from 0, with straight lines between.

    For a measured one, whose transform takes long: an estimate asks thousands of times.
    """

    places: Array
    heights: Array

    def height(self, x: Array) -> Array:
        """Height [LU] at x [LU]."""
        return np.interp(np.abs(x), self.places, self.heights)

    @property
    def reach(self) -> float:
        """Half-width [LU] of the body."""
        return float(self.places[-1])


def tabulated(profile: Profile, spacing: float) -> Tabulated:
    """The profile, which must have an end, at places in a geometric row: those of a parabola within 1e-4 of its height.

    That holds for a reach of 0.1 to 1e10 spacings [LU]; nearer to the apex than NEAR spacings it is a line.
    """
    places = np.concatenate([[0.0], np.geomspace(NEAR * spacing, profile.reach, PLACES)])
    return Tabulated(places, profile.height(places))
