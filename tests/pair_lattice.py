"""A row of independent pairs, exactly, folds included: F(d) = sum_i f(r_i), r_i - 2 f(r_i)/k = r0 + h_i - d.

Without neighbour springs, and where a particle feels only its opposite, each pair has the undeformed gap G = r - 2 f/k.
Where f'(r) > k/2 somewhere (the ratio 2 f'/k exceeds 1), G(r) folds back: coming near, a pair snaps on at the minimum
of G beyond the steepest tension, going apart it lets go at the maximum before it. The state of a pair then depends on
the way, that of the row on which pairs are stuck: all that came nearer than `snap_on` and not further than `snap_off`
since. A pair brings back, per round, the area of its loop, the integral of f dG along both branches.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

from validation.references.interaction import Floats, PairInteraction

REACH = 45.0
"""Ranges beyond the steepest tension at which a pair counts as force-free: exp(-45) = 3e-20."""
GRID = 40_001
"""Distances from which the inversion of G(r) starts."""
NEWTON_STEPS = 6
LEAST_SLOPE = 1e-9
"""Slope of G(r) below which Newton's step is left out: at the fold itself the start is good to round-off."""
SMOOTH_PLACES, PLACES, ROUNDS = 4000, 60, 6
"""Places at which a tension is looked for first, where nothing snaps and between two snaps, and how often again."""
SAME = 1e-12
"""Displacements nearer than this, over the range, are one [-]."""


@dataclass(frozen=True, eq=False)
class PairLattice:
    """Pairs under a profile.

    Args:
        interaction: of an opposite pair; must have an attraction.
        bulk_stiffness: k of a particle on either body [FU/LU].
        heights: h of the undeformed upper particles over the apex, shape (n,) [LU].
    """

    interaction: PairInteraction
    bulk_stiffness: float
    heights: Floats

    @cached_property
    def ratio(self) -> float:
        """Greatest negative stiffness of a pair over the springs in series, k/2: above 1 it snaps."""
        steepest = self.interaction.force_slope(np.asarray(self._steepest))
        return float(steepest) / (0.5 * self.bulk_stiffness)

    @property
    def snaps(self) -> bool:
        """Whether G(r) folds."""
        return self.ratio > 1.0

    @cached_property
    def folds(self) -> tuple[float, float]:
        """Distances at which a stuck pair lets go and a free one snaps on [LU]; the steepest place if none does."""
        if not self.snaps:
            return self._steepest, self._steepest
        end = self._steepest + REACH * self.interaction.longest_range
        near, far = (
            brentq(lambda r: float(self._gap_slope(np.asarray(r))), *ends, xtol=1e-15)
            for ends in ((0.0, self._steepest), (self._steepest, end))
        )
        return float(near), float(far)

    @property
    def snap_off(self) -> float:
        """Undeformed gap at which a stuck pair lets go [LU]."""
        return float(self.gap(np.asarray(self.folds[0])))

    @property
    def snap_on(self) -> float:
        """Undeformed gap at which a free pair snaps on [LU]."""
        return float(self.gap(np.asarray(self.folds[1])))

    def gap(self, distance: Floats) -> Floats:
        """G = r - 2 f(r)/k [LU], shape of `distance` r [LU]."""
        return np.asarray(distance - 2.0 * self.interaction.force(distance) / self.bulk_stiffness)

    def stuck_after(self, displacement: float) -> NDArray[np.bool_]:
        """Which pairs are stuck after an approach from far away to this displacement [LU], (n,)."""
        if not self.snaps:
            return np.ones(self.heights.shape, dtype=bool)
        return np.asarray(self._gaps(displacement) < self.snap_on)

    def force(self, displacement: float, stuck: NDArray[np.bool_]) -> float:
        """F(d) [FU], compression positive; of the `stuck` pairs those that d [LU] draws too far apart have let go."""
        return float(self._forces(np.asarray([displacement]), stuck)[0])

    def preloaded(self, force: float) -> float:
        """Displacement [LU] at which the approach comes to a compressive force [FU]."""
        high = self.interaction.longest_range
        while self.force(high, self.stuck_after(high)) < force:
            high *= 1.5
        return float(brentq(lambda d: self.force(d, self.stuck_after(d)) - force, -high, high, xtol=1e-15))

    def pull_off(self, deepest: float) -> tuple[float, float]:
        """(largest tension [FU], its displacement [LU]) while the bodies part after an approach to `deepest` [LU]."""
        stuck = self.stuck_after(deepest)
        apart = self.interaction.force_free_distance() + float(self.heights.min())
        apart -= max(self.snap_off, self.snap_on) + REACH * self.interaction.longest_range
        ends = [deepest, apart]
        if self.snaps:
            lets_go = self.interaction.force_free_distance() + self.heights[stuck] - self.snap_off
            ends = [deepest, *sorted({float(d) for d in lets_go if d < deepest}, reverse=True), apart]
        best = (0.0, deepest)
        for high, low in pairwise(ends):
            if high - low > SAME * self.interaction.longest_range:
                best = max(best, self._largest_between(low, high, stuck))
        return best

    def lost_in_a_round(self, deepest: float) -> float:
        """Energy [FU LU] that a round from far away to `deepest` [LU] and back brings: one loop for each stuck pair."""
        if not self.snaps:
            return 0.0
        near, far = self.folds
        end = far + REACH * self.interaction.longest_range
        beyond = brentq(lambda r: float(self.gap(np.asarray(r))) - self.snap_off, far, end, xtol=1e-15)
        before = brentq(lambda r: float(self.gap(np.asarray(r))) - self.snap_on, 0.0, near, xtol=1e-15)

        def work(start: float, stop: float) -> float:
            def power(r: float) -> float:
                return float(self.interaction.force(np.asarray(r)) * self._gap_slope(np.asarray(r)))

            return float(quad(power, start, stop, epsabs=1e-15)[0])

        return int(self.stuck_after(deepest).sum()) * (work(far, beyond) - work(before, near))

    @property
    def _steepest(self) -> float:
        return self.interaction.extremum_distance(2)

    def _gap_slope(self, distance: Floats) -> Floats:
        return np.asarray(1.0 - 2.0 * self.interaction.force_slope(distance) / self.bulk_stiffness)

    def _gaps(self, displacement: float | Floats) -> Floats:
        return np.asarray(self.interaction.force_free_distance() + self.heights - np.asarray(displacement)[..., None])

    @cached_property
    def _branches(self) -> tuple[tuple[Floats, Floats], tuple[Floats, Floats]]:
        """(G, r) of stuck pairs and of free ones, both rising, with most points at the folds."""
        (near, far), end = self.folds, self._steepest + REACH * self.interaction.longest_range
        share = np.linspace(0.0, 1.0, GRID)
        stuck, free = near * (1.0 - (1.0 - share) ** 3), far + (end - far) * share**3
        if not self.snaps:
            stuck = free = np.concatenate([stuck, free[1:]])
        return (self.gap(stuck), stuck), (self.gap(free), free)

    def _forces(self, displacements: Floats, stuck: NDArray[np.bool_]) -> Floats:
        gaps = self._gaps(displacements)
        held = stuck & (gaps <= self.snap_off) if self.snaps else np.ones(gaps.shape, dtype=bool)
        (near_gap, near), (far_gap, far) = self._branches
        r = np.where(held, np.interp(gaps, near_gap, near), np.interp(gaps, far_gap, far))
        lowest, highest = np.where(held, near[0], far[0]), np.where(held, near[-1], far[-1])
        longest = 1e-3 * self.interaction.shortest_range
        for _ in range(NEWTON_STEPS):
            slope = self._gap_slope(r)
            flat = np.abs(slope) < LEAST_SLOPE
            step = np.where(flat, 0.0, (self.gap(r) - gaps) / np.where(flat, 1.0, slope))
            r = np.clip(r - np.clip(step, -longest, longest), lowest, highest)
        return np.asarray(np.where(~held & (gaps > far_gap[-1]), 0.0, self.interaction.force(r)).sum(axis=-1))

    def _largest_between(self, low: float, high: float, stuck: NDArray[np.bool_]) -> tuple[float, float]:
        """The same between two displacements, the lower one of which the last of the stuck pairs just reaches."""
        held = stuck & (self._gaps(0.5 * (low + high)) <= self.snap_off) if self.snaps else stuck
        best, places = (0.0, high), PLACES if self.snaps else SMOOTH_PLACES
        for _ in range(ROUNDS):
            d = np.linspace(high, low, places)
            inner = d if not self.snaps else np.maximum(d, low + SAME * self.interaction.longest_range)
            tension = -self._forces(inner, held)
            top = int(tension.argmax())
            best = max(best, (float(tension[top]), float(d[top])))
            low, high, places = float(d[min(top + 1, places - 1)]), float(d[max(top - 1, 0)]), PLACES
        return best
