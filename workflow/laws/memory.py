"""Springs with a memory in time on a rigid plane: the material law stays local, since line force and displacement of a
circular contact are Abel transforms of its pressure and surface displacement (Popov and Heß 2015, chapter 7).

    f = k (part u + Σ share_j s_j),   s_j′ = u′ − s_j/time_j             Prony series of the instantaneous modulus
    f = k (u + T u′)                                                    Kelvin and Voigt

In contact u = d − g(x). A particle separates where f would be below 0; then its surface recovers with f = 0, and may be
touched again. Over a load step of the time Δ in which u changes at a constant rate

    s_j ← s_j e^(−Δ/τ) + Δu τ/Δ (1 − e^(−Δ/τ))

A dashpot carries a load up to the contact edge: a particle has the force of the part φ of its cell that touches. With
w = g(x + s/2) − g(x − s/2), the height over which a cell of the length s comes to touch, and r = g(x) − g(x − s/2)

    φ = (r + min(overlap, u + T u′))/w within 0…1,    f = k φ [u + T u′ + (1 − φ) r]

Exact for one circular contact of a body with a constant Poisson's ratio (Lee and Radok 1960, Ting 1966).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

import numpy as np

from contact1d.workflow.laws.numerics import NARROWEST
from contact1d.workflow.laws.shape import Array, Profile
from contact1d.workflow.scene import Viscoelasticity


@dataclass(frozen=True)
class Edges:
    """Heights over which the cells of particles come to touch a plane; arrays (n,).

    Attributes:
        heights: g(x) of the particle, undeformed [LU].
        widths: w, height over which its cell comes to touch [LU].
        rises: r, the part of w on the side of the axis [LU].
    """

    heights: Array
    widths: Array
    rises: Array


def edges_of(profile: Profile, x: Array, spacing: float) -> Edges:
    """Return the cells of particles at positions x, (n,) [LU], one spacing [LU] wide: heights, widths and rises, (n,)
    each.

    Heights are those of the profile at x, widths the heights over which the cells come to touch a plane, rises the part
    of these on the side of the axis [LU]. The body ends at its half-width, where the profile does not rise further.
    Where it rises by less than 1e-12 spacings within a cell, width and rise are both 1e-12 spacings, so that the cell
    touches as a whole.
    """
    radius, half = np.abs(x), 0.5 * spacing
    inner, heights, outer = (
        profile.height(np.minimum(np.maximum(radius + part * half, 0.0), profile.reach)) for part in (-1.0, 0.0, 1.0)
    )
    least = NARROWEST * spacing
    flat = outer - inner < least  # the cell touches as a whole
    return Edges(heights, np.where(flat, least, outer - inner), np.where(flat, least, heights - inner))


Ahead = tuple[float, Array, Array, Array]
"""Stiffness of a load step over k, u of free surfaces (n,) [LU], decay and gain of each arm after a time."""


class Memory:
    """The state of viscoelastic particles: surface displacements, and lengths of the springs in the Maxwell elements
    (arms) of a Prony series.

    Displacements d and surface displacements u are positive in compression.

    Attributes:
        displacement: d of the body [LU].
        surface: u of each particle, (n,) [LU].
        outer: u in the untouched part of its cell, into which the contact may grow, (n,) [LU].
        arms: s_j, length of the spring of each Maxwell element, (arms, n) [LU]; (0, n) with dashpots.
    """

    def __init__(self, law: Viscoelasticity, cells: Edges) -> None:
        """Begin with an untouched body of the material `law`, at displacement 0 and with undeformed surfaces.

        `cells`: of the particles.
        """
        terms = law.terms
        self._lasting, self._retarded, self._cells = law.lasting, law.retardation_time or 0.0, cells
        self._share, self._time = (np.asarray([getattr(term, key) for term in terms]) for key in ("share", "time"))
        self.arms = np.zeros((len(terms), cells.heights.size))
        self.displacement, self.surface, self.outer = 0.0, *np.zeros((2, cells.heights.size))
        self._touching = np.zeros(cells.heights.size, dtype=bool)
        self._known: tuple[float, Ahead] | None = None

    def _ahead(self, time: float) -> Ahead:
        """Return (stiffness over the instantaneous one, u of free surfaces (n,) [LU], decay and gain of each arm) after
        a time [TU].

        The stiffness is that against a displacement at a constant rate in this time; u is the displacement of a surface
        without a load; arms are the Maxwell elements of a Prony series. The result is kept until the body moves or
        another time is given.
        """
        if self._known is None or self._known[0] != time:
            self._known = time, self._after(time)
        return self._known[1]

    def _after(self, time: float) -> Ahead:
        """Return (stiffness over the instantaneous one, u of free surfaces (n,) [LU], decay and gain of each arm) after
        a time [TU].

        The stiffness is that against a displacement at a constant rate in this time; u is the displacement of a surface
        without a load. Decay e^(−t/τ) and gain (1 − e^(−t/τ)) τ/t are (arms,), of each Maxwell element in the Prony
        series. With dashpots parallel to the springs the stiffness is 1, and decay and gain are empty.
        """
        if self._retarded:
            no_arms = np.empty(0)
            return 1.0, self.outer * np.exp(-time / self._retarded), no_arms, no_arms
        age = time / self._time
        decay, gain = np.exp(-age), -np.expm1(-age) / age
        response = self._lasting + float(self._share @ gain)
        past = (self._share * decay) @ self.arms - float(self._share @ gain) * self.surface
        return response, -past / response, decay, gain

    def pressed(self, displacement: float, time: float, velocity: float) -> tuple[Array, Array]:
        """Return (forces over the stiffness, overlaps) at the end of a load step, both (n,) [LU], compression positive.

        The step goes to a displacement [LU] in a time [TU] and ends with a velocity [LU/TU], which is used with
        dashpots only; the state is not changed. Forces are ≥ 0. Overlaps of particles that do not touch are ≤ 0, so
        that they show the contact edge; with dashpots a cell may touch in part at an overlap ≤ 0.
        """
        response, free, *_ = self._ahead(time)
        return self._forces(displacement, self._retarded * velocity, response, free)

    def _forces(self, displacement: float, drag: float, response: float, free: Array) -> tuple[Array, Array]:
        """Return (forces over the stiffness ≥ 0, overlaps), both (n,) [LU], at a displacement [LU], compression
        positive.

        An overlap is the depth of the body's profile below the plane less the displacement of a free surface, with
        dashpots that depth plus drag where this is smaller. It is negative of particles that do not touch.

        Args:
            displacement: of the body [LU].
            drag: retardation time × velocity of the body [LU]; 0 without dashpots.
            response: stiffness of the load step, relative; not used with dashpots.
            free: displacements u of free surfaces, (n,) [LU].
        """
        overlap = displacement - self._cells.heights
        if not self._retarded:
            return response * np.maximum(overlap - free, 0.0), overlap - free
        push, rise = overlap + drag, self._cells.rises
        margin = np.minimum(overlap - free, push)
        part = self._part(margin)
        return part * (push + (1.0 - part) * rise), margin

    def _part(self, margin: Array) -> Array:
        """Return the part φ of each cell that touches the plane, (…, n) in 0 … 1, at overlaps (…, n) [LU]."""
        return np.clip((self._cells.rises + margin) / self._cells.widths, 0.0, 1.0)

    def under(self, load: float, before: float, counts: Array, time: float) -> tuple[float, float]:
        """Return (displacement [LU], velocity [LU/TU]) after a time [TU] in which the load changes at a constant rate.

        Compression is positive; the state is not changed. For a load of 0 the displacement is the largest one without a
        force. The velocity is the mean one of the step, with dashpots that at its end. Dashpots are integrated in two
        implicit stages, of second order and stable for any step (R. Alexander, SIAM J. Numer. Anal. 14 (1977) 1006).

        Args:
            load: at the end, ≥ 0, over the stiffness of a particle [LU].
            before: at the beginning, over the stiffness [LU]; used with dashpots only.
            counts: number of particles of each cell, (n,).
            time: until the end [TU].
        """
        if not self._retarded:
            displacement = self._carrying(load, counts, time, self.displacement, time)
            return displacement, (displacement - self.displacement) / time
        stage = 1.0 - 0.5**0.5
        part = stage * time
        first = self._carrying(before + stage * (load - before), counts, part, self.displacement, part)
        start = self.displacement + (time - part) * (first - self.displacement) / part
        displacement = self._carrying(load, counts, time, start, part)
        return displacement, (displacement - start) / part

    def _carrying(self, load: float, counts: Array, time: float, start: float, stage_time: float) -> float:
        """Return the displacement [LU] that carries a load [LU] after a time [TU].

        For a load of 0 it is the largest one without a force. The force rises with the displacement, as a parabola
        between any two displacements at which a cell begins or ends to touch. The state is not changed.

        Args:
            load: ≥ 0, over the stiffness of a particle [LU].
            counts: number of particles of each cell, (n,).
            time: until then, in which free surfaces recover [TU].
            start: displacement from which the body moves [LU].
            stage_time: in which it moves, at a constant velocity [TU].
        """
        response, free, *_ = self._ahead(time)
        rate, cells = self._retarded / stage_time, self._cells

        def excess(displacement: float) -> float:
            """Return the sum of forces over the stiffness of a particle, less the load [LU], at a displacement [LU]."""
            forces, _ = self._forces(displacement, rate * (displacement - start), response, free)
            return float(forces @ counts) - load

        ends = cells.heights + free
        if self._retarded:  # the smaller one of overlap and push decides
            margins = [part * cells.widths - cells.rises for part in (0.0, 1.0)]
            pushed = [(cells.heights + rate * start + margin) / (1.0 + rate) for margin in margins]
            ends = np.concatenate([*(ends + margin for margin in margins), *pushed, start - free / rate])
        ends = np.unique(ends)
        first = bisect_right(ends, 0.0, key=excess)
        if first == 0:
            return float(ends[0])
        low = float(ends[first - 1])
        high = float(ends[first]) if first < ends.size else low + load / response
        begin, middle, end = (excess(low + part * (high - low)) for part in (0.0, 0.5, 1.0))
        if begin >= 0.0:  # the end of an interval without force may have one of round-off
            return low if middle > 0.0 else high
        bend, slope = 2.0 * (begin - 2.0 * middle + end), 4.0 * middle - 3.0 * begin - end
        root = math.sqrt(max(slope * slope - 4.0 * bend * begin, 0.0))
        return low + (high - low) * min(max(-2.0 * begin / (slope + root), 0.0), 1.0)

    def width(self, margin: Array, counts: Array) -> Array:
        """Return the number of cells that touch the plane, (…), parts of cells included, at overlaps (…, n) [LU].

        `counts`: number of particles of each cell, (n,).
        """
        return self._part(margin) @ counts

    def go(self, displacement: float, time: float, velocity: float) -> None:
        """Move the body to a displacement [LU] in a time [TU], with a final velocity [LU/TU]; this changes the state in
        place.

        Surfaces move at a constant rate within the step. The velocity is used with dashpots only.
        """
        _, free, decay, gain = self._ahead(time)
        overlap = displacement - self._cells.heights
        if self._retarded:
            touching = self._forces(displacement, self._retarded * velocity, 1.0, free)[1] > 0.0
            recovered = self._recovered(displacement, time, velocity)
            after, self.outer = np.where(touching, overlap, recovered), np.where(touching, free, recovered)
            self._touching = touching
        else:
            after = np.maximum(overlap, free)
            self.arms = decay[:, None] * self.arms + gain[:, None] * (after - self.surface)
        self.displacement, self.surface, self._known = displacement, after, None

    def _recovered(self, displacement: float, time: float, velocity: float) -> Array:
        """Return the surface displacements u, (n,) [LU], of a free surface at the end of a load step of a body with
        dashpots.

        They hold for particles that are free throughout or separate within the step. The step takes a time [TU] and
        ends at a displacement [LU] with a velocity [LU/TU].
        """
        kept = np.exp(-time / self._retarded)
        if velocity >= 0.0:
            return np.asarray(self.surface * kept)
        separated = np.minimum(self.surface, -self._retarded * velocity)  # u where f = 0
        since = np.exp(np.minimum((separated - displacement + self._cells.heights) / (self._retarded * velocity), 0.0))
        return np.where(self._touching, separated * since, self.surface * kept)

    def along(self, displacements: Array, times: Array, velocities: Array) -> tuple[Array, Array]:
        """Return (energies stored after the last load step, energies dissipated in all of them), (n,) each [LU²].

        Both are over the stiffness of a particle. Arguments, (m,), are of load steps: displacements [LU], durations
        [TU] and final velocities [LU/TU]; the state is changed to that after the last one. A Maxwell element of a Prony
        series dissipates ∫ share s²/τ dt with the length of its spring s = α + (s₀ − α) e^(−t/τ), α = u′τ; a dashpot
        parallel to a spring T ∫ u′² dt: where a cell touches, at the velocity of the body, on a free surface the energy
        of its spring.
        """
        before, states = self.displacement, [self._state]
        for step in zip(displacements.tolist(), times.tolist(), velocities.tolist(), strict=True):
            self.go(*step)
            states.append(self._state)
        surface, outer, touching, *arms = (np.stack(column) for column in zip(*states, strict=True))
        duration, moved = times[:, None], np.diff(np.append(before, displacements))[:, None]
        lost = np.zeros(surface.shape[1])
        for share, time, arm in zip(self._share, self._time, arms, strict=True):
            age = duration / time
            steady = np.diff(surface, axis=0) / age
            start, faded = arm[:-1] - steady, -np.expm1(-age)
            exact = steady**2 * age + 2.0 * steady * start * faded + 0.5 * start**2 * faded * (2.0 - faded)
            short = age / 3.0 * (arm[:-1] ** 2 + arm[:-1] * arm[1:] + arm[1:] ** 2)
            # In a short time s is straight, and the exponential would lose digits.
            lost += share * np.where(age < 1e-4, short, exact).sum(axis=0)
        if self._retarded:
            free, drag = outer[:-1] * np.exp(-duration / self._retarded), self._retarded * velocities[:, None]
            end = displacements[:, None] - self._cells.heights
            begins, ends = (np.minimum(overlap - free, overlap + drag) for overlap in (end - moved, end))
            separated = np.where(touching[:-1], np.minimum(surface[:-1], np.maximum(-drag, 0.0)), surface[:-1])
            released = np.where(ends > 0.0, 0.0, 0.5 * (separated**2 - surface[1:] ** 2))
            part = 0.5 * (self._part(begins) + self._part(ends))
            lost += np.sum(self._retarded * moved**2 / duration * part + released, axis=0)
        return 0.5 * (self._lasting * self.surface**2 + self._share @ self.arms**2), lost

    @property
    def _state(self) -> tuple[Array, ...]:
        """The arrays of this state, (n,) each: surface displacements [LU] of the cells and of their untouched parts,
        whether cells touch, and the length [LU] of the spring of each Maxwell element. They are not copies.
        """
        return self.surface, self.outer, self._touching, *self.arms
