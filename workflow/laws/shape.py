"""The undeformed shape of a body, as a law asks for it, and positions of particles on it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
NEAREST, WIDEST, BESIDE, MOST_KINKS = 1e-9, 0.1, 60, 100
"""Distances from a kink over its own position between which positions are added in geometric progression, how many on
each side, and at how many kinks."""
PLACES, NEAR = 1000, 0.01
"""Positions at which a profile is tabulated, and the first one beyond its apex over the spacing."""


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

    @property
    def kinks(self) -> tuple[float, ...]:
        """Positions [LU] at which its slope jumps."""

    def __hash__(self) -> int:
        """The same for equal bodies, which share their estimate."""


@dataclass(frozen=True, eq=False)
class Tabulated:
    """A profile given by its `heights` [LU] at ascending `places` [LU] from 0, linear between them.

    For a measured one, whose transform takes long: a predictor asks thousands of times.
    """

    places: Array
    heights: Array
    kinks: tuple[float, ...] = ()

    def height(self, x: Array) -> Array:
        """Height [LU] at x [LU]."""
        return np.interp(np.abs(x), self.places, self.heights)

    @property
    def reach(self) -> float:
        """Half-width [LU] of the body."""
        return float(self.places[-1])


@dataclass(frozen=True, eq=False)
class Splined(Tabulated):
    """The same by cubics, each stretch between kinks by its own: of a parabola to 1e-12 of its height."""

    @cached_property
    def _curve(self) -> Any:
        from scipy.interpolate import CubicSpline, PPoly

        kinks = [int(at) for at in np.searchsorted(self.places, self.kinks) if 3 < at < self.places.size - 4]
        parts = [slice(first, last + 1) for first, last in pairwise([0, *kinks, self.places.size - 1])]
        cubics = [CubicSpline(self.places[part], self.heights[part]).c for part in parts]
        return PPoly(np.concatenate(cubics, axis=1), self.places)

    def height(self, x: Array) -> Array:
        """Height [LU] at x [LU]."""
        return np.asarray(self._curve(np.minimum(np.abs(x), self.reach)))


def tabulated(profile: Profile, spacing: float, kind: type[Tabulated] = Tabulated) -> Tabulated:
    """The profile, which must be finite, at positions in geometric series: those of a parabola to 1e-4 of its height.

    That holds for a reach of 0.1 to 1e10 spacings [LU]; closer to the apex than NEAR spacings it is a line.
    """
    places = beside_kinks(np.concatenate([[0.0], np.geomspace(NEAR * spacing, profile.reach, PLACES)]), profile)
    return kind(places, profile.height(places), profile.kinks)


def beside_kinks(places: Array, profile: Profile) -> Array:
    """Rising positions [LU] with the kinks of a profile, and others ever nearer to them: g rises as a root there."""
    most = float(places[-1])
    near = np.append(0.0, np.geomspace(NEAREST, WIDEST, BESIDE))
    found = [one * (1.0 + sign * near) for one in profile.kinks[:MOST_KINKS] for sign in (1.0, -1.0)]
    every = np.unique(np.concatenate([places, *found]))
    return np.asarray(every[every <= most])
