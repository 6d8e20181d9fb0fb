"""The JKR contact of any axisymmetric body on a rigid plane, as a curve and as a law of each particle.

With the transformed profile g(x), independent springs E* per length, and Heß's rule for the spring at the edge a

    h(x) = g(x) − Δl(x),    Δl(x) = √(2π x W/E*),    d = h(a),    F = 2 E* ∫₀ᵃ (d − g) dx

h falls to its minimum, the pull-off under fixed grips, and rises beyond it. A position x that has been in contact stays
in contact for d > H(x) = min h(y) over y ≥ x: the contact edge recedes from outside. H is a length for each position:
a particle is in contact or not by its own height. Only whether there is any contact is a state of the chain.

A particle represents its cell, x ± s/2, of which a share φ is in contact. With q = (d − H₋)/(H₊ − H₋) over the cell

    φ = q + κ q (1 − q),    f = k φ [d − g(x) + c (1 − φ)],    c = g(x) − g(x − s/2)

c gives the force at the middle of that share, κ makes φ = 1/2 where the edge is at x: of second order in s.
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
from contact1d.workflow.laws.numerics import NARROWEST, ROUND_OFF, value_at
from contact1d.workflow.laws.pairs import springs
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, Followed, Path
from contact1d.workflow.laws.radius import Clinging, Held, RadiusRule
from contact1d.workflow.laws.shape import Profile, beside_kinks
from contact1d.workflow.scene import Adhesion, Scene

POINTS = 4000
"""Positions at which h and F are tabulated, and those of the integral of an energy."""
WHOLE = 1.0 - 1e-9
"""Share from which on the cell of the limit point is in contact as a whole. The rest of the share is an error of the
force: at a kink between two cells all lattices have the same one, so that none shows it."""


def elongation(x: Array, modulus: float, work: float) -> Array:
    """Return Δl(x) = √(2π x W/E*), (n,) [LU], at positions x ≥ 0, (n,) [LU].

    `modulus`: E* [FU/LU²]; `work`: work of adhesion W [FU/LU].
    """
    return np.sqrt(2.0 * math.pi * work / modulus * x)


def _from_share(share: float, middle: float) -> tuple[float, float]:
    """Return (q, κ), dimensionless, of a cell of which the `share` φ = q + κ q (1 − q) is in contact at its limit
    point.

    q is 1 − 1e-9 at most. κ is that one of 401 even values in −1 … 1 with which φ is nearest to (`share` + 1)/2 at the
    height `middle`.

    Args:
        share: of the cell, 0 … 1.
        middle: the height at which half of the rest of the cell separates, over the heights of that rest, 0 … 1.
    """
    bend = np.linspace(-1.0, 1.0, 401)
    start = 2.0 * share / (1.0 + bend + np.sqrt((1.0 + bend) ** 2 - 4.0 * bend * share))
    q = start + (1.0 - start) * middle
    best = int(np.argmin(np.abs(q * (1.0 + bend * (1.0 - q)) - 0.5 * (1.0 + share))))
    return float(min(start[best], WHOLE)), float(bend[best])


@dataclass(frozen=True)
class Cells:
    """The cell of each particle of a chain; arrays (n,).

    Attributes:
        heights: g(x) of the particle [LU].
        hold: height g − d [LU] above which its cell is separated.
        width: heights [LU] below that over which it separates.
        fall: c of the module's docstring [LU].
        bend: κ of the module's docstring, dimensionless.
    """

    heights: Array
    hold: Array
    width: Array
    fall: Array
    bend: Array

    def shares(self, displacements: Array) -> Array:
        """Return the share φ of each cell in contact, (m, n) in 0 … 1, at displacements (m,) [LU].

        Bodies are taken to be in contact, also below the displacement at which they separate.
        """
        heights = self.heights - displacements[:, None]
        q = np.clip((self.hold - heights) / self.width, 0.0, 1.0)
        return q * (1.0 + self.bend * (1.0 - q))

    def lengths(self, displacements: Array) -> Array:
        """Return the force over the stiffness of each particle, (m, n) [LU], at displacements (m,) [LU].

        Compression is positive. Bodies are taken to be in contact, also below the displacement at which they separate.
        """
        share = self.shares(displacements)
        return share * (displacements[:, None] - self.heights + self.fall * (1.0 - share))


@dataclass(frozen=True)
class Jkr(Law):
    """The JKR contact of a body, by quadrature.

    Attributes:
        work: work of adhesion W [FU/LU].
        known: largest contact radius up to which the curve is computed [LU].
    """

    is_lossless = False
    rules: ClassVar[tuple[type[RadiusRule], ...]] = (Clinging, Held)
    file = "adhesion.cells"
    closed_forms = ("adhesive", "transition", "dmt")
    exact: ClassVar[tuple[str, ...]] = ("adhesive",)

    work: float = field(kw_only=True)
    known: float = field(kw_only=True)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Return whether the scene has [adhesion] with a work of adhesion > 0."""
        return scene.work_of_adhesion > 0.0

    @classmethod
    def attracts(cls, scene: Scene) -> bool:
        """Return True: adhesion is an attraction."""
        return True

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """Return the `assumed` range [LU], since JKR's attraction has none."""
        return assumed

    @classmethod
    def of(cls, scene: Scene, profile: Profile) -> Law:
        """Return the law of a scene with adhesion, with its curve computed as far as the experiment needs.

        It is an instance of the class on which this is called: Jkr, Receding or Maugis.

        Raises:
            SettingsError: the contact would be wider than 0.9 of a body without a vertical edge, its contact edge would
                jump (not of Maugis), Maugis' attraction would exceed the body, or the range or rate of a subclass
                cannot be resolved.
        """
        covered = 0.9  # radius of a contact that covers its body, over where the body ends
        given, load = max([0.0, *scene.experiment.places()]), scene.experiment.compression or 0.0
        spacing, stiffness = scene.bodies.spacing, scene.bulk_stiffness
        common = *springs(spacing, stiffness), profile, spacing, stiffness
        law, wanted, known = None, given, spacing
        while law is None or not (law.known == profile.reach or law.is_beyond(wanted, load)):
            law = Jkr(*common, work=scene.the(Adhesion).work, known=min(known, profile.reach))
            wanted = max(given, stopped_at(scene, law))
            known *= 2.0
        adhesive = cls.from_jkr(law, scene, wanted, load)
        if scene.bodies.own_count is None:
            widest = value_at(adhesive.radii, max(wanted, adhesive.displacement_at(load)))
            if widest > covered * profile.reach:
                raise SettingsError(
                    f"the adhesive contact would cover the body, which ends at {profile.reach:.6g} LU: JKR's theory is "
                    "for a contact much smaller than the body. Lower adhesion.work_of_adhesion, the load or the "
                    "displacement"
                )
        adhesive.require_one_edge()
        return adhesive

    @classmethod
    def from_jkr(cls, jkr: Jkr, scene: Scene, wanted: float, load: float) -> Jkr:
        """Return the law of this class that has the given JKR contact as its limit; here `jkr` itself, other arguments
        unused.

        Maugis computes it up to a displacement `wanted` [LU] and a load [FU], compression positive.
        """
        return jkr

    def particles(self, x: Array, deepest: float) -> Particles:
        """Return the adhesive cells at positions x, (n,) [LU]; `deepest`: largest expected displacement [LU]."""
        return JkrCells(self, x, deepest)

    def extent(self, deepest: float, half: float) -> float:
        """Return `half`, the half-width [LU] of the whole chain, at any displacement: adhesion may reach its end."""
        return half

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """Return constants of the cells of particles at positions x, (n,) [LU], by name: (p, values (n,) in [LUᵖ]).

        "hold": height less displacement above which a cell is separated; "width": heights below that over which it
        separates; "fall": rise of the profile over the inner half of the cell, each with p = 1; "bend", p = 0: κ of φ =
        q + κ q (1 − q), the share in contact. `body`: the profile as LAMMPS has it.
        """
        cells = self.cells(x, body)
        return {"hold": (1, cells.hold), "width": (1, cells.width), "fall": (1, cells.fall), "bend": (0, cells.bend)}

    def largest_length_change(self, displacement: float) -> float:
        """Return the largest length change of a spring [LU] up to a displacement [LU].

        It is the displacement, or the magnitude of that of pull-off under fixed grips where this is larger.
        """
        return max(displacement, -self.fixed_grips[1])

    def opened(self, x: Array, body: Profile | None = None) -> Array:
        """Return the displacement h = g − Δl, (n,) [LU], in equilibrium at contact radii x, (n,) [LU].

        g is the transformed profile of the `body`, by default that of the law.
        """
        return (body or self.profile).height(x) - elongation(x, self.modulus, self.work)

    @cached_property
    def _grid(self) -> tuple[Array, Array, Array, int]:
        """(Contact radii x [LU], displacements h(x) [LU] and forces F(x) [FU] in equilibrium at these, the index of the
        least h).

        Radii rise from 0 to the largest one that is computed; compression is positive. Where the contact may be as wide
        as the body, the last two radii are the same, with a far larger h at the last.
        """

        # The first position lies so many decades inside that the least h is far (30 times) outside of it.
        for level in (1, 2, 3, 4):
            inner = np.geomspace(1e-3**level * self.known, self.known, level * POINTS)
            x = beside_kinks(np.append(0.0, inner), self.profile.kinks)
            least = int(np.argmin(self.opened(x)))
            if x[least] > 30.0 * inner[0]:
                break
        near, best = x, least
        for _ in range(4):  # between the neighbours of the best position
            near = np.linspace(near[max(best - 1, 0)], near[min(best + 1, near.size - 1)], 41)
            best = int(np.argmin(self.opened(near)))
        x = np.unique(np.append(x, near[best]))
        g, h = self.profile.height(x), self.opened(x)
        area = np.concatenate([[0.0], np.cumsum(0.5 * (g[1:] + g[:-1]) * np.diff(x))])
        if self.known == self.profile.reach:  # a contact gets no wider than the body
            far = h[-1:] + FARTHEST_RATIO * self.spacing
            x, h, area = np.append(x, x[-1:]), np.append(h, far), np.append(area, area[-1:])
        return x, h, 2.0 * self.modulus * (x * h - area), int(np.argmin(h))

    @property
    def deepest_known(self) -> float:
        """Displacement [LU] up to which F(d) is known, the end of the curve; infinite where the contact may cover the
        body.
        """
        return self.end[1] if self.known < self.profile.reach else math.inf

    @property
    def end(self) -> tuple[float, float, float]:
        """(Radius [LU], displacement [LU], force [FU]) of the widest contact that is computed.

        Displacement and force are positive in compression.
        """
        x, h, force, _ = self._grid
        last = int(np.searchsorted(x, x[-1]))
        return float(x[last]), float(h[last]), float(force[last])

    @cached_property
    def fixed_grips(self) -> tuple[float, float]:
        """(Contact radius, displacement) [LU] at pull-off under fixed grips; the latter is negative in tension.

        Of Maugis it is the state in which a contact that is unloaded is lost, with the radius 0 where that is not in
        contact.
        """
        x, h, _, least = self._grid
        return float(x[least]), float(h[least])

    def is_beyond(self, wanted: float, load: float, margin: float = 1.2) -> bool:
        """Return whether the computed curve goes well beyond pull-off, a displacement `wanted` [LU] and a `load` [FU].

        `margin`: factor by which its last radius, displacement and force must exceed the radius at pull-off under fixed
        grips, `wanted` and `load`; the last force must also exceed the pull-off force, without this factor.
        """
        least = margin * self.fixed_grips[0], margin * wanted, max(margin * load, self.pull_off_force())
        return all(known > needed for known, needed in zip(self.end, least, strict=True))

    def require_one_edge(self) -> None:
        """Raise an error for a profile whose h(x), displacement over contact radius, falls again beyond its minimum.

        There the contact edge would jump.

        Raises:
            SettingsError: with the position.
        """
        x, h, _, least = self._grid
        rising = np.diff(h[least:])
        if (rising < -ROUND_OFF * abs(float(h[least]))).any():
            position = float(x[least + int(np.argmax(rising < 0.0))])
            raise SettingsError(
                f"the contact edge would jump at x = {position:.4g} LU, where the profile is too flat for this work of "
                "adhesion: smooth the profile, or lower adhesion.work_of_adhesion"
            )

    def cells(self, x: Array, body: Profile) -> Cells:
        """Return the cells of particles of a `body` at positions x, (n,) [LU], one spacing wide each; arrays (n,).

        A cell separates over heights of 1e-12 spacings at least. That with the contact edge of pull-off under fixed
        grips separates up to this edge, and the rest of it at once.
        """
        radius, half = np.abs(x), 0.5 * self.spacing
        heights, narrowest = body.height(radius), NARROWEST * self.spacing
        least = self.fixed_grips[0]

        def threshold(position: Array) -> Array:
            """Return H, (n,) [LU]: the least displacement at which a position x, (n,) [LU], that was in contact still
            is.

            It is h = g − Δl at x, or at pull-off under fixed grips where x is inside of that.
            """
            outer = np.minimum(np.maximum(position, least), body.reach)
            return self.opened(outer, body)

        inner, center, outer = (threshold(radius + part * half) for part in (-1.0, 0.0, 1.0))
        width = np.maximum(outer - inner, narrowest)
        # Nearer to an end than a tenth, κ would make φ fall with q.
        middle = np.clip((center - inner) / width, 0.1, 0.9)
        bend = np.clip((0.5 - middle) / (middle * (1.0 - middle)), -1.0, 1.0)
        bend = np.where(outer - inner > narrowest, bend, 0.0)
        fall = heights - body.height(np.abs(radius - half))
        for i in np.flatnonzero((radius - half < least) & (least < radius + half)):
            position = radius[i : i + 1]
            share, middle = (least - radius[i] + half) / (2.0 * half), threshold(0.5 * (least + position + half))[0]
            rise = max(outer[i] - inner[i], narrowest)
            start, bend[i] = _from_share(share, float(np.clip((middle - inner[i]) / rise, 0.0, 1.0)))
            width[i] = rise / (1.0 - start)
            inner[i] = outer[i] - width[i]
            if share < WHOLE:
                held = body.height(np.abs(0.5 * (position - half + least)))[0]
                fall[i] = (heights[i] - held) / (1.0 - share)
        return Cells(heights, heights - inner, width, fall, bend)

    def energy(self, displacement: float, radius: float) -> float:
        """Return U(d, a) = E* ∫₀ᵃ (d − g)² dx − πa²W [FU·LU] at a displacement d and a `radius` a [LU].

        It is 0 of separated bodies, a = 0; ∂U/∂a = 0 in equilibrium. The integral is by the trapezoidal rule.
        """
        x = np.linspace(0.0, radius, POINTS)
        elastic = self.modulus * float(np.trapezoid((displacement - self.profile.height(x)) ** 2, x))
        return elastic - math.pi * radius**2 * self.work

    def contact_forces(self, displacements: Array) -> Array:
        """Return F(d), (m,) [FU], of bodies in contact at displacements (m,) [LU], compression positive, linear in the
        curve.

        0 below the displacement of pull-off under fixed grips; beyond the computed curve the force at its end. Of
        Maugis it is F in unloading, 0 below the displacement at which the contact is lost.
        """
        _, h, force, least = self._grid
        return np.interp(displacements, h[least:], force[least:], left=0.0)

    def half_widths(self, displacements: Array, gap: float) -> Array:
        """Return the contact radii a(d) of bodies in contact, (m,) [LU], at displacements (m,) [LU]; one spacing at
        least.

        They are the same for any `gap`, which is not used.
        """
        return np.maximum(self.spacing, self.radii(displacements))

    def radii(self, displacements: Array) -> Array:
        """Return the contact radii a(d) of the continuous body, (m,) [LU], at displacements (m,) [LU], linear in the
        curve.

        Below pull-off under fixed grips it is the radius there, beyond the computed curve that at its end. Of Maugis it
        is a(d) in unloading, 0 where the bodies attract each other without contact.
        """
        x, h, _, least = self._grid
        return np.interp(displacements, h[least:], x[least:])

    @cached_property
    def _rising(self) -> tuple[Array, Array]:
        """(Displacements [LU], forces [FU]), (k,) each, from the force maximum to the end of the curve; both rise.

        Forces are positive in compression; the first one is the largest tension.
        """
        _, h, force, least = self._grid
        peak = least + int(np.argmin(force[least:]))
        return h[peak:], force[peak:]

    def pull_off_force(self) -> float:
        """Return the pull-off force F_A [FU], positive: the largest tension on the computed curve."""
        return max(0.0, -float(self._rising[1][0]))

    def displacement_at(self, force: float) -> float:
        """Return the displacement [LU] at which a contact carries a force [FU], compression positive.

        Of a tension above the pull-off force, the displacement of this force; of a force beyond the computed curve, its
        end.
        """
        displacements, forces = self._rising
        return float(np.interp(force, forces, displacements))

    def _stiffness_under(self, force: float) -> float:
        """Return dF/dd [FU/LU] under a force [FU], compression positive; beyond the computed curve that at its end.

        For a tension above 0.998 of the pull-off force the stiffness at 0.998 of it.
        """
        displacements, forces = self._rising
        slopes = np.gradient(forces, displacements)
        return float(np.interp(max(force, -SOFTEST_SHARE * self.pull_off_force()), forces, slopes))

    def parted(self, share: float) -> float:
        """Return the displacement [LU] of pull-off under fixed grips, where the tension vanishes at once, for any
        `share`.

        Of Maugis it is that at which a contact that is unloaded is lost.
        """
        return self.fixed_grips[1]

    def maxima_distance(self, particles: int) -> float:
        """Return infinity for any number of particles: the force has one maximum."""
        return math.inf


@dataclass(frozen=True, eq=False)
class JkrCells(Particles):
    """The cells of a chain on a rigid plane, which adhere from touch to pull-off under fixed grips, all at once."""

    law: Jkr
    shares_edges = True

    @cached_property
    def _cells(self) -> Cells:
        """Cells of these particles, (n,) each, of the body as LAMMPS has it."""
        return self.law.cells(self.x, self.shape)

    @cached_property
    def _once(self) -> tuple[Cells, NDArray[np.intp]]:
        """(Cells of particles at different distances from the axis, rising, (k,) each; the number of particles at each,
        (k,)).
        """
        _, first, count = np.unique(np.abs(self.x), return_index=True, return_counts=True)
        return Cells(*(column[first] for column in vars(self._cells).values())), count

    @property
    def apart(self) -> float:
        """Displacement [LU] of pull-off under fixed grips, below which the contact is lost."""
        return self.law.fixed_grips[1]

    def held(self, displacements: Array) -> Array:
        """Return the sum of the forces of the cells, (m,) [FU], at displacements (m,) [LU], compression positive.

        Bodies are taken to be in contact at any displacement, also below pull-off under fixed grips, where none is
        stable.
        """
        cells, count = self._once
        return self.law.stiffness * (cells.lengths(displacements) @ count)

    @property
    def limits(self) -> tuple[float, ...]:
        """Displacement [LU] of pull-off under fixed grips, the only limit point; one entry."""
        return (self.apart,)

    @property
    def jumps(self) -> tuple[float, ...]:
        """Displacements [LU] at which the force jumps: of pull-off under fixed grips and of the first touch, 0."""
        return (self.apart, 0.0)

    @property
    def corners(self) -> tuple[float, ...]:
        """The displacement [LU] at which the contact edge leaves the end of the body; empty of an unbounded one."""
        reach = self.law.profile.reach
        return tuple(self.law.opened(np.asarray([reach])).tolist()) if reach < math.inf else ()

    def _holds(self, displacements: Array) -> NDArray[np.bool_]:
        """Return whether the bodies are in contact at each displacement [LU] of a path, (m,), that begins with
        separated bodies.

        Contact begins at displacement 0, within 1e-9 spacings, and ends below pull-off under fixed grips.
        """
        held, touching, apart = np.zeros(displacements.size, dtype=bool), False, self.apart
        for i, displacement in enumerate(displacements.tolist()):
            touching = displacement >= -ROUND_OFF * self.law.spacing or (touching and displacement >= apart)
            held[i] = touching
        return held

    def energies(self, path: Path) -> tuple[float, float]:
        """Return (U(d, a) of JKR at the end of a path, energy lost along it), both [FU·LU].

        The path begins with separated bodies, whose U is 0. Energy is lost in the jumps of U at each touch and at each
        pull-off under fixed grips.
        """
        held = self._holds(path.displacement)

        def energy(displacement: float) -> float:
            """Return U [FU·LU] of bodies in contact at a displacement [LU], with the contact radius in equilibrium."""
            return self.law.energy(displacement, value_at(self.law.radii, displacement))

        made, lost = (np.count_nonzero(np.diff(held.astype(int), prepend=0) == change) for change in (1, -1))
        end = energy(float(path.displacement[-1])) if held[-1] else 0.0
        return end, lost * energy(self.apart) - made * energy(0.0)

    def carried(self, columns: Mapping[str, Array]) -> Followed:
        """Return the normal forces of load steps at the column "displacement", (m,) [LU]; other columns are not used.

        They are the sums over the particles, (m,) [FU], compression positive, and a function of the index of a load
        step that gives those of each particle. The path begins with separated bodies. Forces are 0 before the first
        touch and from pull-off to the next touch.
        """
        displacements = columns["displacement"]
        held = self._holds(displacements)
        total = np.where(held, self.held(displacements), 0.0)

        def force(state: int) -> Array:
            """Return the force of each particle, (n,) [FU], compression positive, in the state of index `state`; 0
            without contact.
            """
            lengths = self._cells.lengths(displacements[state : state + 1])[0]
            return np.asarray(self.law.stiffness * lengths * held[state])

        return Followed(self.x, total, force)
