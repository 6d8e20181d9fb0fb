"""Springs with a memory in time on a rigid plane: the material law stays local, since line force and displacement of a
circular contact are Abel transforms of its pressure and surface displacement (Popov and Heß 2015, chapter 7).

    f = k (part u + Σ share_j s_j),   s_j′ = u′ − s_j/time_j             Prony's series of the instantaneous modulus
    f = k (u + T u′)                                                    Kelvin and Voigt

In contact u = d − g(x); a particle leaves where f would be below 0, and then its surface comes back with f = 0, and may
be touched again. Over a load step of the time Δ along which u changes evenly

    s_j ← s_j e^(−Δ/τ) + Δu τ/Δ (1 − e^(−Δ/τ))

A dashpot pushes at the edge of the contact, too: a particle has the force of the part φ of its cell that touches. With
w = g(x + s/2) − g(x − s/2), the height over which a cell of the length s comes to touch, and r = g(x) − g(x − s/2)

    φ = (r + min(overlap, u + T u′))/w within 0…1,    f = k φ [u + T u′ + (1 − φ) r]

Exact for one circular contact of a body with a constant Poisson's ratio (Lee and Radok 1960, Ting 1966).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.shape import Profile
from contact1d.workflow.scene import Viscoelasticity

Array = NDArray[np.float64]
NARROWEST = 1e-12
"""Height over which a cell comes to touch at once, over the spacing: no formula may divide by 0."""
SHORT = 1e-4
"""Time over that of an arm in which its length is straight: the digits of an exponential are lost."""
STAGE = 1.0 - 0.5**0.5
"""Part of a step at which the first of its two stages is."""


@dataclass(frozen=True)
class Edges:
    """How the cells of particles come to touch a plane; arrays (n,).

    Attributes:
        heights: g(x) of the particle, undeformed [LU].
        widths: w, height over which its cell comes to touch [LU].
        rises: r, how much of that lies nearer to the axis than the particle [LU].
    """

    heights: Array
    widths: Array
    rises: Array


def edges_of(profile: Profile, x: Array, spacing: float) -> Edges:
    """The cells of particles at positions x, (n,) [LU], of a body; it ends where the last of its cells does."""
    at, half = np.abs(x), 0.5 * spacing
    inner, heights, outer = (
        profile.height(np.minimum(np.maximum(at + part * half, 0.0), profile.reach)) for part in (-1.0, 0.0, 1.0)
    )
    least = NARROWEST * spacing
    flat = outer - inner < least  # touches as a whole, with its first touch
    return Edges(heights, np.where(flat, least, outer - inner), np.where(flat, least, heights - inner))


Ahead = tuple[float, Array, Array, Array]
"""Response, free surfaces (n,) [LU], decay and gain of each arm after a time."""


class Memory:
    """The state of particles in time: how far each surface is pressed in, and what its arms remember.

    Attributes:
        place: displacement of the body [LU].
        surface: u of each particle, (n,) [LU].
        outer: u where its cell is untouched, so that the contact may grow into it, (n,) [LU].
        arms: s_j, (arms, n) [LU].
    """

    def __init__(self, law: Viscoelasticity, cells: Edges) -> None:
        """Untouched, above particles at undeformed heights."""
        terms = law.terms or ()
        self._lasting, self._retarded, self._cells = law.lasting, law.retardation_time or 0.0, cells
        self._share, self._time = (np.asarray([getattr(term, key) for term in terms]) for key in ("share", "time"))
        self.arms = np.zeros((len(terms), cells.heights.size))
        self.place, self.surface, self.outer = 0.0, *np.zeros((2, cells.heights.size))
        self._held = np.zeros(cells.heights.size, dtype=bool)
        self._known: tuple[float, Ahead] | None = None

    def _ahead(self, time: float) -> Ahead:
        """What is ahead of this state after a time [TU]; kept until it moves."""
        if self._known is None or self._known[0] != time:
            self._known = time, self._after(time)
        return self._known[1]

    def _after(self, time: float) -> Ahead:
        if self._retarded:
            none = np.empty(0)
            return 1.0, self.outer * np.exp(-time / self._retarded), none, none
        age = time / self._time
        decay, gain = np.exp(-age), -np.expm1(-age) / age
        response = self._lasting + float(self._share @ gain)
        past = (self._share * decay) @ self.arms - float(self._share @ gain) * self.surface
        return response, -past / response, decay, gain

    def pressed(self, place: float, time: float, velocity: float) -> tuple[Array, Array]:
        """Forces over stiffness as the body comes to a displacement [LU] after a time [TU], with a velocity [LU/TU].

        And its overlaps, which go on below 0 where nothing touches, so that they tell where the contact ends. Both (n,)
        [LU].
        """
        response, free, *_ = self._ahead(time)
        return self._forces(place, self._retarded * velocity, response, free)

    def _forces(self, place: float, drag: float, response: float, free: Array) -> tuple[Array, Array]:
        overlap = place - self._cells.heights
        if not self._retarded:
            return response * np.maximum(overlap - free, 0.0), overlap - free
        push, rise = overlap + drag, self._cells.rises
        margin = np.minimum(overlap - free, push)
        part = self._part(margin)
        return part * (push + (1.0 - part) * rise), margin

    def _part(self, margin: Array) -> Array:
        """φ of the module's docstring at overlaps (…, n) [LU]."""
        return np.clip((self._cells.rises + margin) / self._cells.widths, 0.0, 1.0)

    def under(self, load: float, before: float, counts: Array, time: float) -> tuple[float, float]:
        """Displacement [LU] and velocity [LU/TU] after a time [TU] in which a load ≥ 0 over stiffness changes evenly.

        `before`: the load until now [LU]; `counts`: particles of each kind. Dashpots follow in two implicit stages, of
        the second order and stable for any step (R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006).
        """
        if not self._retarded:
            place = self._carrying(load, counts, time, self.place, time)
            return place, (place - self.place) / time
        part = STAGE * time
        first = self._carrying(before + STAGE * (load - before), counts, part, self.place, part)
        start = self.place + (time - part) * (first - self.place) / part
        place = self._carrying(load, counts, time, start, part)
        return place, (place - start) / part

    def _carrying(self, load: float, counts: Array, time: float, start: float, way_time: float) -> float:
        """The displacement [LU] that carries a load after a time [TU], with the velocity from `start` on in `way_time`.

        The largest under none. Forces rise with it, a parabola from where a cell begins or ends to touch to the next.
        """
        response, free, *_ = self._ahead(time)
        rate, cells = self._retarded / way_time, self._cells

        def excess(place: float) -> float:
            return float(self._forces(place, rate * (place - start), response, free)[0] @ counts) - load

        ends = cells.heights + free
        if self._retarded:  # either of overlap and push may decide
            over = [part * cells.widths - cells.rises for part in (0.0, 1.0)]
            pushed = [(cells.heights + rate * start + one) / (1.0 + rate) for one in over]
            ends = np.concatenate([*(ends + one for one in over), *pushed, start - free / rate])
        ends = np.unique(ends)
        first = bisect_right(ends, 0.0, key=excess)
        if first == 0:
            return float(ends[0])
        low = float(ends[first - 1])
        high = float(ends[first]) if first < ends.size else low + load / response
        begin, middle, end = (excess(low + part * (high - low)) for part in (0.0, 0.5, 1.0))
        if begin >= 0.0:  # the end of a part that bears nothing may bear round-off
            return low if middle > 0.0 else high
        bend, slope = 2.0 * (begin - 2.0 * middle + end), 4.0 * middle - 3.0 * begin - end
        root = math.sqrt(max(slope * slope - 4.0 * bend * begin, 0.0))
        return low + (high - low) * min(max(-2.0 * begin / (slope + root), 0.0), 1.0)

    def width(self, margin: Array, counts: Array) -> Array:
        """How many cells touch at overlaps (…, n) [LU], `counts` of each."""
        return np.asarray(self._part(margin) @ counts)

    def go(self, place: float, time: float, velocity: float) -> None:
        """Bring the body to a displacement [LU] with a velocity [LU/TU], evenly over a time [TU]."""
        _, free, decay, gain = self._ahead(time)
        if self._retarded:
            held = self._forces(place, self._retarded * velocity, 1.0, free)[1] > 0.0
            recovered = self._recovered(place, time, velocity)
            after, self.outer = np.where(held, place - self._cells.heights, recovered), np.where(held, free, recovered)
            self._held = held
        else:
            after = np.maximum(place - self._cells.heights, free)
            self.arms = decay[:, None] * self.arms + gain[:, None] * (after - self.surface)
        self.place, self.surface, self._known = place, after, None

    def _recovered(self, place: float, time: float, velocity: float) -> Array:
        """u of surfaces that are free at the end of a step, some of them since they were left within it."""
        kept = np.exp(-time / self._retarded)
        if velocity >= 0.0:
            return np.asarray(self.surface * kept)
        left = np.minimum(self.surface, -self._retarded * velocity)  # where f = 0
        since = np.exp(np.minimum((left - place + self._cells.heights) / (self._retarded * velocity), 0.0))
        return np.asarray(np.where(self._held, left * since, self.surface * kept))

    def along(self, places: Array, times: Array, velocities: Array) -> tuple[Array, Array]:
        """What is stored after load steps (m,), as of `go`, and what dashpots lose in them, over the stiffness.

        Both (n,) [LU²]. Of an arm ∫ share s²/τ dt with s = α + (s₀ − α) e^(−t/τ), α = u′τ. Beside a spring T ∫ u′² dt:
        of the part of a cell that touches at the velocity of the body, of a free surface what its spring gives.
        """
        before, passed = self.place, [self._now]
        for step in zip(places.tolist(), times.tolist(), velocities.tolist(), strict=True):
            self.go(*step)
            passed.append(self._now)
        surface, outer, held, *arms = (np.stack(one) for one in zip(*passed, strict=True))
        duration, moved = times[:, None], np.diff(np.append(before, places))[:, None]
        lost = np.zeros(surface.shape[1])
        for share, time, arm in zip(self._share, self._time, arms, strict=True):
            age = duration / time
            steady = np.diff(surface, axis=0) / age
            start, faded = arm[:-1] - steady, -np.expm1(-age)
            exact = steady**2 * age + 2.0 * steady * start * faded + 0.5 * start**2 * faded * (2.0 - faded)
            short = age / 3.0 * (arm[:-1] ** 2 + arm[:-1] * arm[1:] + arm[1:] ** 2)
            lost += share * np.where(age < SHORT, short, exact).sum(axis=0)
        if self._retarded:
            free, drag = outer[:-1] * np.exp(-duration / self._retarded), self._retarded * velocities[:, None]
            end = places[:, None] - self._cells.heights
            begins, ends = (np.minimum(overlap - free, overlap + drag) for overlap in (end - moved, end))
            left = np.where(held[:-1], np.minimum(surface[:-1], np.maximum(-drag, 0.0)), surface[:-1])
            given = np.where(ends > 0.0, 0.0, 0.5 * (left**2 - surface[1:] ** 2))
            touching = 0.5 * (self._part(begins) + self._part(ends))
            lost += np.sum(self._retarded * moved**2 / duration * touching + given, axis=0)
        return np.asarray(0.5 * (self._lasting * self.surface**2 + self._share @ self.arms**2)), lost

    @property
    def _now(self) -> tuple[Array, ...]:
        return self.surface, self.outer, self._held, *self.arms
