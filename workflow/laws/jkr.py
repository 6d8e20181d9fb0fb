"""JKR's contact of any axisymmetric body on a rigid plane, before LAMMPS runs, and as a law of each particle's own.

With the transformed profile g(x), independent springs E* per length, and the rule of Heß for the spring at the edge a

    h(x) = g(x) − Δl(x),    Δl(x) = √(2π x W/E*),    d = h(a),    F = 2 E* ∫₀ᵃ (d − g) dx

h falls to its minimum, the pull-off under fixed grips, and rises from there on. A position x, once in contact, stays so
for d > H(x) = min h(y) over y ≥ x: the contact edge recedes from outside. H is a length for each position, so that each
particle is in contact or not by its own height; only whether there is a contact at all is one state for all.

A particle represents its cell, x ± s/2, of which the edge leaves a share φ. With q = (d − H₋)/(H₊ − H₋) over the cell

    φ = q + κ q (1 − q),    f = k φ [d − g(x) + c (1 − φ)],    c = g(x) − g(x − s/2)

c takes the force at the middle of that share, κ is such that φ = 1/2 where the edge is at x: of second order in s.
Sources: V. L. Popov, M. Heß, Method of Dimensionality Reduction in Contact Mechanics and Friction (2015), chapter 4.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.law import FARTHEST_RATIO, SOFTEST_SHARE, Law, stopped_at
from contact1d.workflow.laws.pairs import springs
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.radius import Clinging, Held, RadiusRule
from contact1d.workflow.laws.shape import Profile, beside_kinks
from contact1d.workflow.scene import Adhesion, Scene

Array = NDArray[np.float64]
PLACES = 4000
"""Positions between which the predictor is straight."""
FIRST, SEEN = 1e-3, 30.0
"""The first of them over the last, to a power at which the least h is so many times further out than the first."""
ROUNDS, LOOKS = 4, 41
"""How often the least h is looked for between the neighbours of the best place, and at how many."""
BEYOND = 1.2
"""Width of what is known of the contact over what the experiment needs."""
SPANNED = 0.9
"""Radius of a contact over where its body ends, from which it spans the body."""
RISE = 1e-9
"""Rise of h before its least value over its depth that counts as one."""
NARROWEST = 1e-12
"""Heights in which a particle separates that does so at once, over the spacing: no formula may divide by 0."""
NEAR_AN_END = 0.1
"""Place of the middle of a cell between its ends, as h sees it, beyond which its bend would turn the share around."""
BENDS, WHOLE = 401, 1.0 - 1e-9
"""Values of κ that are tried for the cell of the limit point, and share from which on it is held as a whole. The rest
of the share is an error of the force: at a kink between two cells all lattices have the same one, so none shows it."""
TOUCH = 1e-9
"""Distance over the spacing at which bodies touch: round-off of a displacement of 0."""


def elongation(x: Array, modulus: float, work: float) -> Array:
    """Δl(x) = √(2π x W/E*) [LU] at positions x ≥ 0 [LU]; E* [FU/LU²], W [FU/LU]."""
    return np.asarray(np.sqrt(2.0 * math.pi * work / modulus * x))


def _from_share(share: float, middle: float) -> tuple[float, float]:
    """q and κ of a cell of which this share is held up to the limit point: φ(q) is the share there.

    `middle`: the height at which half of the rest separates, over the heights of that rest; κ is such that φ is then
    half way between the share and 1.
    """
    bend = np.linspace(-1.0, 1.0, BENDS)
    start = 2.0 * share / (1.0 + bend + np.sqrt((1.0 + bend) ** 2 - 4.0 * bend * share))
    q = start + (1.0 - start) * middle
    best = int(np.argmin(np.abs(q * (1.0 + bend * (1.0 - q)) - 0.5 * (1.0 + share))))
    return float(min(start[best], WHOLE)), float(bend[best])


@dataclass(frozen=True)
class Cells:
    """The cell of each particle of a chain; arrays (n,) [LU], and `bend` without a unit.

    Attributes:
        heights: g(x) of the particle.
        hold: height at which its cell is separated.
        width: below that, heights over which it separates.
        fall: c of the module's docstring.
        bend: κ.
    """

    heights: Array
    hold: Array
    width: Array
    fall: Array
    bend: Array

    def shares(self, displacements: Array) -> Array:
        """φ of each particle at displacements (m,) [LU] of a contact that is held, (m, n)."""
        heights = self.heights - displacements[:, None]
        q = np.clip((self.hold - heights) / self.width, 0.0, 1.0)
        return np.asarray(q * (1.0 + self.bend * (1.0 - q)))

    def lengths(self, displacements: Array) -> Array:
        """f/k [LU] of each particle at displacements (m,) [LU] of a contact that is held, (m, n)."""
        share = self.shares(displacements)
        return np.asarray(share * (displacements[:, None] - self.heights + self.fall * (1.0 - share)))

    def forces(self, displacements: Array, stiffness: float) -> Array:
        """F [FU] at displacements (m,) [LU] of a contact that is held; `stiffness` of a particle [FU/LU]."""
        return np.asarray(stiffness * self.lengths(displacements).sum(axis=1))


@dataclass(frozen=True)
class Jkr(Law):
    """JKR's own curve by quadrature, in place of independent pairs.

    Attributes:
        work: W [FU/LU].
        known: the greatest position up to which it is known [LU].
    """

    is_lossless = False
    rules: ClassVar[tuple[type[RadiusRule], ...]] = (Clinging, Held)
    file = "adhesion.cells"
    beside: ClassVar[tuple[str, ...]] = ("adhesive", "transition", "dmt")
    exact: ClassVar[tuple[str, ...]] = ("adhesive",)

    work: float = field(kw_only=True)
    known: float = field(kw_only=True)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Of [adhesion]; without W a contact is that of springs."""
        return scene.work_of_adhesion > 0.0

    @classmethod
    def attracts(cls, scene: Scene) -> bool:
        """Always."""
        return True

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """The assumed one."""
        return assumed

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Law:
        """Known as far as the experiment needs.

        Raises:
            SettingsError: the contact would be as wide as the body, or its edge would jump.
        """
        given, load = max([0.0, *scene.experiment.places()]), scene.experiment.compression or 0.0
        spacing, stiffness = scene.bodies.spacing, scene.bulk_stiffness
        common = *springs(spacing, stiffness), profile, spacing, stiffness
        law, wanted, known = None, given, spacing
        while law is None or not (law.known == profile.reach or law.is_beyond(wanted, load)):
            law = Jkr(*common, work=scene.the(Adhesion).work, known=min(known, profile.reach))
            wanted = max(given, stopped_at(scene, law))
            known *= 2.0
        found = cls.from_jkr(law, scene, wanted, load)
        if scene.bodies.own_count is None:
            widest = float(found.radii(np.asarray([max(wanted, found.displacement_at(load))]))[0])
            if widest > SPANNED * profile.reach:
                raise SettingsError(
                    f"the adhesive contact would cover the body, which ends at {profile.reach:.6g} LU: JKR's theory is "
                    "for a contact much smaller than the body. Lower adhesion.work_of_adhesion, the load or the "
                    "displacement"
                )
        found.require_one_edge()
        return found

    @classmethod
    def from_jkr(cls, jkr: Jkr, scene: Scene, wanted: float, load: float) -> Jkr:
        """The law whose limit this is, as far as a displacement [LU] and a load [FU] need."""
        return jkr

    def particles(self, x: Array, deepest: float) -> Particles:
        """See `Law`."""
        return JkrCells(self, x, deepest)

    def extent(self, deepest: float, half: float) -> float:
        """See `Law`: all of a chain."""
        return half

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """See `Law`."""
        cells = self.cells(x, body)
        return {"hold": (1, cells.hold), "width": (1, cells.width), "fall": (1, cells.fall), "bend": (0, cells.bend)}

    def strained(self, displacement: float) -> float:
        """See `Law`: a punch that adheres and carries nothing is not deep, and its springs hold it up to its limit."""
        return max(displacement, -self.fixed_grips[1])

    @property
    def modulus(self) -> float:
        """E* [FU/LU²]."""
        return self.stiffness / self.spacing

    @cached_property
    def _grid(self) -> tuple[Array, Array, Array, int]:
        """Positions x [LU], h(x) [LU], F of a contact up to there [FU], and the index of the least h."""

        def opened(at: Array) -> Array:
            return np.asarray(self.profile.height(at) - elongation(at, self.modulus, self.work))

        for level in (1, 2, 3, 4):
            inner = np.geomspace(FIRST**level * self.known, self.known, level * PLACES)
            x = beside_kinks(np.append(0.0, inner), self.profile)
            least = int(np.argmin(opened(x)))
            if x[least] > SEEN * inner[0]:
                break
        near, at = x, least
        for _ in range(ROUNDS):
            near = np.linspace(near[max(at - 1, 0)], near[min(at + 1, near.size - 1)], LOOKS)
            at = int(np.argmin(opened(near)))
        x = np.unique(np.append(x, near[at]))
        g, h = self.profile.height(x), opened(x)
        area = np.concatenate([[0.0], np.cumsum(0.5 * (g[1:] + g[:-1]) * np.diff(x))])
        if self.known == self.profile.reach:  # beyond its end a body is as wide as it is
            far = h[-1:] + FARTHEST_RATIO * self.spacing
            x, h, area = np.append(x, x[-1:]), np.append(h, far), np.append(area, area[-1:])
        return x, h, 2.0 * self.modulus * (x * h - area), int(np.argmin(h))

    @property
    def deepest_known(self) -> float:
        """See `Law`."""
        return self.end[1] if self.known < self.profile.reach else math.inf

    @property
    def end(self) -> tuple[float, float, float]:
        """Radius [LU], displacement [LU] and force [FU] of the widest contact that is known."""
        x, h, force, _ = self._grid
        last = int(np.searchsorted(x, x[-1]))
        return float(x[last]), float(h[last]), float(force[last])

    @cached_property
    def fixed_grips(self) -> tuple[float, float]:
        """(radius, displacement) [LU] at pull-off under fixed grips."""
        x, h, _, least = self._grid
        return float(x[least]), float(h[least])

    def is_beyond(self, wanted: float, load: float) -> bool:
        """Whether it is known well beyond fixed grips, a displacement [LU] and a load [FU], and to its own tension."""
        least = BEYOND * self.fixed_grips[0], BEYOND * wanted, max(BEYOND * load, self.pull_off_force())
        return all(known > needed for known, needed in zip(self.end, least, strict=True))

    def require_one_edge(self) -> None:
        """Refuse a profile whose h falls again beyond its least value.

        Raises:
            SettingsError: with the position.
        """
        x, h, _, least = self._grid
        rising = np.diff(h[least:])
        if (rising < -RISE * abs(float(h[least]))).any():
            at = float(x[least + int(np.argmax(rising < 0.0))])
            raise SettingsError(
                f"the contact edge would jump at x = {at:.4g} LU, where the profile is too flat for this work of "
                "adhesion: smooth the profile, or lower adhesion.work_of_adhesion"
            )

    def cells(self, x: Array, body: Profile) -> Cells:
        """The cells of particles at positions x, (n,) [LU], of `body`."""
        at, half = np.abs(x), 0.5 * self.spacing
        heights, narrowest = body.height(at), NARROWEST * self.spacing
        least = self.fixed_grips[0]

        def threshold(place: Array) -> Array:
            outer = np.minimum(np.maximum(place, least), body.reach)
            return np.asarray(body.height(outer) - elongation(outer, self.modulus, self.work))

        inner, own, outer = (threshold(at + part * half) for part in (-1.0, 0.0, 1.0))
        width = np.maximum(outer - inner, narrowest)
        middle = np.clip((own - inner) / width, NEAR_AN_END, 1.0 - NEAR_AN_END)
        bend = np.clip((0.5 - middle) / (middle * (1.0 - middle)), -1.0, 1.0)
        bend = np.where(outer - inner > narrowest, bend, 0.0)
        fall = heights - body.height(np.abs(at - half))
        for i in np.flatnonzero((at - half < least) & (least < at + half)):
            share, middle = (least - at[i] + half) / (2.0 * half), threshold(0.5 * (least + at[i : i + 1] + half))[0]
            rise = max(outer[i] - inner[i], narrowest)
            start, bend[i] = _from_share(share, float(np.clip((middle - inner[i]) / rise, 0.0, 1.0)))
            width[i] = rise / (1.0 - start)
            inner[i] = outer[i] - width[i]
            if share < WHOLE:
                held = body.height(np.abs(0.5 * (at[i : i + 1] - half + least)))[0]
                fall[i] = (heights[i] - held) / (1.0 - share)
        return Cells(heights, heights - inner, width, fall, bend)

    def energy(self, displacement: float, radius: float) -> float:
        """U(d, a) = E* ∫_0^a (d − g)² dx − πa²W [FU·LU], 0 of bodies apart; ∂U/∂a = 0 in equilibrium."""
        x = np.linspace(0.0, radius, PLACES)
        elastic = self.modulus * float(np.trapezoid((displacement - self.profile.height(x)) ** 2, x))
        return elastic - math.pi * radius**2 * self.work

    def contact_forces(self, displacements: Array) -> Array:
        """F(d) [FU] of a contact that is held at each of the displacements [LU]; 0 where none is."""
        _, h, force, least = self._grid
        return np.asarray(np.interp(displacements, h[least:], force[least:], left=0.0))

    def half_widths(self, displacements: Array, gap: float) -> Array:
        """a(d) [LU] of a contact that is held, at least a spacing; all `gap`s are the edge."""
        return np.maximum(self.spacing, self.radii(displacements))

    def radii(self, displacements: Array) -> Array:
        """The same without regard to the spacing: the body's own contact."""
        x, h, _, least = self._grid
        return np.asarray(np.interp(displacements, h[least:], x[least:]))

    @cached_property
    def _rising(self) -> tuple[Array, Array]:
        """Displacements [LU] and forces [FU] from the force maximum on."""
        _, h, force, least = self._grid
        top = least + int(np.argmin(force[least:]))
        return h[top:], force[top:]

    def pull_off_force(self) -> float:
        """F_A [FU]."""
        return max(0.0, -float(self._rising[1][0]))

    def displacement_at(self, force: float) -> float:
        """Displacement [LU] at which a contact carries a force [FU]; that of the force maximum if none does."""
        places, forces = self._rising
        return float(np.interp(force, forces, places))

    def _stiffness_under(self, force: float) -> float:
        """dF/dd [FU/LU] under a force [FU]; a tension above SOFTEST_SHARE of the largest counts as that."""
        places, forces = self._rising
        return float(np.interp(max(force, -SOFTEST_SHARE * self.pull_off_force()), forces, np.gradient(forces, places)))

    def parted(self, share: float) -> float:
        """Displacement [LU] of pull-off under fixed grips, where the tensile force vanishes at once."""
        return self.fixed_grips[1]

    def tooth(self, particles: int) -> float:
        """Infinite: with a range of zero and fractions of cells the force has one maximum."""
        return math.inf


@dataclass(frozen=True, eq=False)
class JkrCells(Particles):
    """The cells of a chain on a rigid plane, which adhere from touch to where fixed grips lose all of it at once."""

    law: Jkr
    shares_edges = True

    @cached_property
    def _cells(self) -> Cells:
        return self.law.cells(self.x, self.shape)

    @cached_property
    def _once(self) -> tuple[Cells, NDArray[np.intp]]:
        """The cells of which both sides have one, each once, and how many there are."""
        _, first, count = np.unique(np.abs(self.x), return_index=True, return_counts=True)
        return Cells(*(column[first] for column in vars(self._cells).values())), count

    @property
    def apart(self) -> float:
        """Where fixed grips lose the contact [LU]."""
        return self.law.fixed_grips[1]

    def held(self, displacements: Array) -> Array:
        """F [FU] while it is held."""
        cells, count = self._once
        return np.asarray(self.law.stiffness * (cells.lengths(displacements) @ count))

    @property
    def limits(self) -> tuple[float, ...]:
        """There."""
        return (self.apart,)

    @property
    def jumps(self) -> tuple[float, ...]:
        """There, and at touch."""
        return (self.apart, 0.0)

    def _holds(self, displacements: Array) -> NDArray[np.bool_]:
        """Whether there is a contact at each of the displacements of a path, (m,)."""
        held, now, apart = np.zeros(displacements.size, dtype=bool), False, self.apart
        for i, displacement in enumerate(displacements.tolist()):
            now = displacement >= -TOUCH * self.law.spacing or (now and displacement >= apart)
            held[i] = now
        return held

    def energies(self, path: Path) -> tuple[float, float]:
        """U(d, a) of JKR; what it jumps by where the contact is made, at touch, or lost, under fixed grips."""
        held = self._holds(path.displacement)

        def energy(displacement: float) -> float:
            return self.law.energy(displacement, float(self.law.radii(np.asarray([displacement]))[0]))

        made, lost = (np.count_nonzero(np.diff(held.astype(int), prepend=0) == way) for way in (1, -1))
        end = energy(float(path.displacement[-1])) if held[-1] else 0.0
        return end, lost * energy(self.apart) - made * energy(0.0)

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Nothing is felt before touch; see `Particles.carried`."""
        displacements = columns["displacement"]
        held = self._holds(displacements)
        total = np.where(held, self.held(displacements), 0.0)

        def force(state: int) -> Array:
            lengths = self._cells.lengths(displacements[state : state + 1])[0]
            return np.asarray(self.law.stiffness * lengths * held[state])

        return Followed(self.x, total, force)
