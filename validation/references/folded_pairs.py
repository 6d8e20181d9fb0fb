"""Independent pairs that may snap, exactly: each on one of two branches of G = r - 2 f(r)/k, with its own history.

G is the undeformed gap of a pair, r its distance, k the spring of a particle on either body. Where f rises more than
k/2 per length, G(r) has a largest value G_off at r_off and a least one G_on at r_on > r_off. A pair is joined
(r <= r_off) from where its gap first fell to G_on until it rises to G_off, and free (r >= r_on) otherwise. With the
heights h_i of the upper body over its apex G_i = r0 + h_i - d, and F(d) = sum_i f(r_i) on the branch of each pair.
What a snap frees is lost: a pair's energy V(r) + (k/4)(r - G)^2 before it less that behind it, so the loop there and
back has the area sum_i (drop at G_on + drop at G_off). Holds where a particle feels its opposite only: no neighbour
springs, ranges far below the spacing.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from validation.references.interaction import PairInteraction
from validation.references.numerics import Floats, Pair

Flags = NDArray[np.bool_]
TAIL = 40.0
"""A pair further apart than the force-free distance and this many ranges carries nothing: exp(-40) = 4e-18."""
HALVINGS, NEWTON = 25, 8
"""Of the interval that holds a distance, and steps of Newton's method in it: at the round-off but for the last 1e-9 of
the range before a snap, where they halve the distance to the double root."""
LOOK, FEWEST, MOST = 0.25, 4, 400
"""Distance of the first looks between two snaps over the shortest range, and how many there are at least and most; the
largest tension among them is then refined."""
KINKS, KINK = 7, 0.2
"""Further looks where a pair is near its steepest tension, and how near over the shortest range: close to a ratio of 1
it passes there within a share of the way only."""
SIDE = 1e-12
"""Distance from a snap over the longest range at which the state before it is taken."""


@dataclass(frozen=True)
class Fold:
    """Where a pair snaps: joined ones apart at (r_off, G_off), free ones together at (r_on, G_on) [LU]."""

    r_off: float
    gap_off: float
    r_on: float
    gap_on: float


@dataclass(frozen=True, eq=False)
class FoldedPairs:
    """Pairs with given heights.

    Args:
        interaction: of an opposite pair.
        bulk_stiffness: k of a particle on either body [FU/LU].
        heights: of the upper particles over the apex, shape (N,) [LU].
    """

    interaction: PairInteraction
    bulk_stiffness: float
    heights: Floats

    @cached_property
    def ratio(self) -> float:
        """Steepest rise of the pair's force over k/2: above 1 a pair snaps."""
        return self.interaction.steepest_rise / (0.5 * self.bulk_stiffness)

    @cached_property
    def fold(self) -> Fold | None:
        """Where pairs snap; None where they do not."""
        if self.ratio <= 1.0:
            return None

        def rise(r: float) -> float:
            return 1.0 - 2.0 * float(self.interaction.force_slope(r)) / self.bulk_stiffness

        middle, far = self.interaction.extremum_distance(2), self.interaction.longest_range * TAIL
        while rise(middle + far) <= 0.0:
            far *= 2.0
        r_off = brentq(rise, 0.0, middle, xtol=1e-16, rtol=1e-15)
        r_on = brentq(rise, middle, middle + far, xtol=1e-16, rtol=1e-15)
        return Fold(r_off, float(self.gap(r_off)), r_on, float(self.gap(r_on)))

    def gap(self, distance: Floats | float) -> Floats:
        """Return G = r - 2 f(r)/k [LU], shape of `distance` r [LU]."""
        r = np.asarray(distance)
        return r - 2.0 * self.interaction.force(r) / self.bulk_stiffness

    def distance(self, gap: Floats, joined: Flags) -> Floats:
        """Return r(G) of each pair on its branch [LU].

        Args:
            gap: G, shape (N,) [LU].
            joined: which pairs are on the near branch, shape (N,), bool.

        Raises:
            ValueError: if a gap is below that at which the finite core gives way.
        """
        if np.any(gap < self.gap(0.0)):
            raise ValueError("the gap is so small that the particles are pushed through each other")
        fold = self.fold
        low = np.zeros_like(gap) if fold is None else np.where(joined, 0.0, fold.r_on)
        far = np.maximum(gap, self._rest) + 2.0 * self.interaction.largest_tension / self.bulk_stiffness
        high = far if fold is None else np.where(joined, fold.r_off, np.maximum(far, fold.r_on))
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            below = self.gap(middle) < gap
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        r = 0.5 * (low + high)
        for _ in range(NEWTON):
            rise = 1.0 - 2.0 * self.interaction.force_slope(r) / self.bulk_stiffness
            step = (self.gap(r) - gap) / np.where(rise > 0.0, rise, math.inf)
            r = np.clip(r - step, low, high)
        return np.asarray(r)

    def loading(self, displacement: Floats | float) -> Floats:
        """Return F(d) of a body that comes from afar [FU], shape of `displacement`; zero at the force-free distance."""
        gap = self._gaps(displacement)
        return self._force(gap, self._joined(gap))

    def unloading(self, displacement: Floats | float, deepest: float) -> Floats:
        """Return F(d) of a body that was at `deepest` [LU] and is drawn back to `displacement` [LU], in [FU]."""
        gap, fold = self._gaps(displacement), self.fold
        joined = self._joined(self._gaps(deepest))
        return self._force(gap, joined & (gap <= (math.inf if fold is None else fold.gap_off)))

    def deepest(self, preload: float) -> float:
        """Return the first d at which a body that comes from afar carries `preload` >= 0 [FU], in [LU].

        Raises:
            ValueError: if the finite core gives way before.
        """
        low, high = np.min(self.heights), self._rest + np.min(self.heights) - float(self.gap(0.0))
        side = SIDE * self.interaction.longest_range
        for first, last in self._between(low, high, None if self.fold is None else self.fold.gap_on):
            places = self._looks(first + side, last - side)
            reached = np.flatnonzero(self.loading(places) >= preload)
            if reached.size and reached[0] == 0:
                return float(places[0])
            if reached.size:
                ends = places[reached[0] - 1], places[reached[0]]
                return float(brentq(lambda d: self.loading(d) - preload, *ends, xtol=1e-15))
        raise ValueError("the finite core gives way before the preload is carried")

    def adhesion(self, preload: float) -> Pair:
        """Return the largest tension on the way back from `preload` [FU], and its d [LU]: just before a snap or smooth.

        Raises:
            ValueError: as `deepest`.
        """
        top, fold = self.deepest(preload), self.fold
        far = TAIL * self.interaction.longest_range + (0.0 if fold is None else fold.gap_off)
        bottom = min(top, self._rest) - np.ptp(self.heights) - far
        side = SIDE * self.interaction.longest_range
        parts = self._between(bottom, top, None if fold is None else fold.gap_off)
        return max(self._largest(first + side, last, top) for first, last in parts)

    def loop_area(self, deepest: float) -> float:
        """Return the work lost on the way from afar to `deepest` [LU] and back [FU LU]."""
        fold = self.fold
        if fold is None:
            return 0.0
        count = self._alike[1] @ self._joined(self._gaps(deepest))
        gaps, before = np.array([fold.gap_on, fold.gap_off]), np.array([False, True])
        lost = self._energy(gaps, self.distance(gaps, before)) - self._energy(gaps, self.distance(gaps, ~before))
        return float(count * lost.sum())

    @property
    def _rest(self) -> float:
        return self.interaction.force_free_distance()

    @cached_property
    def _alike(self) -> tuple[Floats, Floats]:
        """The heights that differ, and how many particles have each."""
        heights, counts = np.unique(self.heights, return_counts=True)
        return heights, counts.astype(np.float64)

    def _gaps(self, displacement: Floats | float) -> Floats:
        return self._rest + self._alike[0] - np.asarray(displacement, dtype=np.float64)[..., None]

    def _joined(self, gap: Floats) -> Flags:
        return gap <= (-math.inf if self.fold is None else self.fold.gap_on)

    def _force(self, gap: Floats, joined: Flags) -> Floats:
        return self.interaction.force(self.distance(gap, joined)) @ self._alike[1]

    def _energy(self, gap: Floats, distance: Floats) -> Floats:
        return self.interaction.energy(distance) + 0.25 * self.bulk_stiffness * (distance - gap) ** 2

    def _between(self, first: float, last: float, snap: float | None) -> list[Pair]:
        """The stretches of a way that are parted by the snaps of its pairs at the gap `snap`."""
        places = [] if snap is None else (self._rest + self._alike[0] - snap).tolist()
        return list(pairwise([first, *sorted(d for d in places if first < d < last), last]))

    def _looks(self, first: float, last: float) -> Floats:
        wanted = math.ceil((last - first) / (LOOK * self.interaction.shortest_range))
        even = np.linspace(first, last, min(max(wanted, FEWEST), MOST))
        return np.union1d(even, self._kinks[(self._kinks > first) & (self._kinks < last)])

    @cached_property
    def _kinks(self) -> Floats:
        """Displacements at which a pair passes the steepest part of its force [LU]."""
        width = KINK * self.interaction.shortest_range
        r = self.interaction.extremum_distance(2) + width * np.linspace(-1.0, 1.0, KINKS) ** 3
        if self.fold is not None:
            r = r[(r < self.fold.r_off) | (r > self.fold.r_on)]
        return (self._rest + self._alike[0][:, None] - self.gap(r)[None, :]).ravel()

    def _largest(self, first: float, last: float, top: float) -> Pair:
        """The largest tension between two snaps, and its place."""
        places = self._looks(first, last)
        tension = -self.unloading(places, top)
        i = int(np.argmax(tension))
        found = minimize_scalar(
            lambda d: self.unloading(d, top),
            bounds=(places[max(i - 1, 0)], places[min(i + 1, places.size - 1)]),
            method="bounded",
            options={"xatol": 1e-9 * self.interaction.longest_range},
        )
        return max((float(tension[i]), float(places[i])), (-float(found.fun), float(found.x)))
