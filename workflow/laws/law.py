"""The interface of all contact laws, and the curve of independent opposite pairs under the undeformed profile.

A particle on each side, each on its spring k, at the actual distance r have the undeformed gap

    G(r) = r − 2 f(r)/k,       f(r) = Σ_j f_pair(√(r² + (js)²)) r/√(r² + (js)²)

with f the force of a whole straight row of opposite particles. F(d) = Σ_i f(r_i) with G(r_i) = r₀ + h(x_i) − d, where
h is the profile. This predictor chooses chain lengths, first steps and time scales; no result depends on it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import tops
from contact1d.workflow.laws.numerics import value_at
from contact1d.workflow.laws.radius import Compressed, InTension, RadiusRule, ToTheEdge
from contact1d.workflow.laws.shape import Array, Profile, Tabulated
from contact1d.workflow.scene import Impact, Scene

if TYPE_CHECKING:
    from contact1d.workflow.laws.particles import Particles

FARTHEST_RATIO = 1e9
"""Largest displacement over cutoff and spacing: LAMMPS limits the number of bins, and coordinates lose digits."""
DIFFERENCE = 1e-3
"""Step of a finite difference over the displacement; of a stiffness, over that since the interaction begins."""
SOFTEST_SHARE = 0.998
"""Tension over the force maximum at which a contact counts as softest: at the maximum itself its stiffness is 0."""


class NotCarriedError(ValueError):
    """A load that exceeds the force at every displacement.

    Attributes:
        most: largest force that was found [FU], compression positive.
    """

    def __init__(self, most: float) -> None:
        """Store the largest force `most` [FU], compression positive."""
        super().__init__(most)
        self.most = most


@dataclass(frozen=True, eq=False)
class Law(ABC):
    """The contact law of one body: its force–displacement curve, and what the rest of the program asks of any law.

    A new law derives from this class, or from `Independent` (springs on a rigid plane), and has `applies`, `of` and
    `particles`; every other method has a default, that of an elastic contact without attraction. Scenes that run one
    after the other share an instance with its cached results. Displacements d [LU] and forces F [FU] are positive in
    compression; the undeformed gap is the distance [LU] that two opposite surfaces would have without deformation.

    Attributes:
        in_time: whether forces depend on the rate of loading.
        is_lossless: whether a closed path dissipates no energy.
        rules: definitions of the contact radius: of a plane body, of bodies that attract each other, of others.
        table: class that tabulates a profile whose transform takes long.
        file: name of the deck's file with the `columns` of the particles; "" without one.
        closed_forms: families of closed forms (`body.theory`) that may be printed with a run.
        exact: those of them that solve this law exactly, so that a run must agree with them.
        gap: undeformed gap G [LU] over a grid of distances, rising, made monotone where pairs would snap.
        force: force [FU] of one particle on that grid, compression positive.
        rest: distance r₀ [LU] of the apexes at displacement 0.
        profile: shape of the upper body.
        spacing: distance of neighbouring particles [LU].
        stiffness: contact stiffness of one particle [FU/LU], both springs in series.
        snaps: whether pairs snap: G(r) falls somewhere, so that loading and unloading differ.
        bend: |d²G/dr²| at the limit point of a joined pair [1/LU]; 0 where none snaps.
        outer: where pairs snap, the gap of an approaching pair, made monotone from outside [LU]; else None.
    """

    in_time: ClassVar[bool] = False
    is_lossless: ClassVar[bool] = True
    rules: ClassVar[tuple[type[RadiusRule], ...]] = (ToTheEdge, InTension, Compressed)
    table: ClassVar[type[Tabulated]] = Tabulated
    file: ClassVar[str] = ""
    closed_forms: ClassVar[tuple[str, ...]] = ()
    exact: ClassVar[tuple[str, ...]] = ()

    gap: Array
    force: Array
    rest: float
    profile: Profile
    spacing: float
    stiffness: float
    snaps: bool = False
    bend: float = 0.0
    outer: Array | None = None

    @property
    def parameters(self) -> dict[str, Any]:
        """{name: value} of the fields of the dataclass, to make another law of; without cached results."""
        return {entry.name: getattr(self, entry.name) for entry in fields(self)}

    def __getstate__(self) -> dict[str, Any]:
        """Return what is pickled: the fields alone, since cached results hold functions, which cannot be pickled."""
        return self.parameters

    @property
    def modulus(self) -> float:
        """Plane-strain modulus E* [FU/LU²] of springs on a rigid plane: stiffness of a particle over the spacing."""
        return self.stiffness / self.spacing

    @classmethod
    @abstractmethod
    def applies(cls, scene: Scene) -> bool:
        """Return whether a scene has what this law is for; the first law in `laws.LAWS` that applies is the law of the
        scene.

        Maugis: adhesion with a range; Receding: adhesion with a rate; Jkr: any adhesion; Relaxing: [viscoelasticity];
        Frictional: [friction]; Independent: always True.
        """

    @classmethod
    @abstractmethod
    def of(cls, scene: Scene, profile: Profile) -> Law:
        """Return the law of a scene whose lower body is a rigid plane, an instance for an upper body of this profile.

        Raises:
            SettingsError: an adhesive contact would be wider than 0.9 of a body without a vertical edge, its attraction
                would exceed the body, its edge would jump, or its range or rate changes nothing that is resolved. Laws
                without adhesion raise nothing.
        """

    @abstractmethod
    def particles(self, x: Array, deepest: float) -> Particles:
        """Return the particles at rising positions x, (n,) [LU]; `deepest`: largest expected displacement [LU]."""

    @classmethod
    def attracts(cls, scene: Scene) -> bool:
        """Return whether the bodies attract each other: by default whether [interaction] has an attraction."""
        return bool(scene.interaction and scene.interaction.attraction)

    @classmethod
    def rule(cls, scene: Scene) -> type[RadiusRule]:
        """Return the class that defines the contact radius of a scene.

        `rules[0]` of a plane profile, else `rules[1]` of bodies that attract each other, else `rules[2]`; by
        default ToTheEdge, InTension (radius of the largest tension) and Compressed.
        """
        return cls.rules[0 if scene.bodies.profile.is_plane else 1 if cls.attracts(scene) else 2]

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """Return the range h₀ of the attraction [LU]; by default 0, that of no attraction.

        Jkr and Receding, whose attraction has no range, give `assumed` [LU], Maugis that of the scene. Independent
        gives that of Lennard-Jones surfaces with the same force-free distance, 0 on a rigid plane and without
        attraction.
        """
        return 0.0

    def extent(self, deepest: float, half: float) -> float:
        """Return the half-width [LU] of the reduced model at a displacement `deepest` [LU], below 0 as at 0.

        It is the half-width within which the undeformed gap is less than the range of the forces (`cutoff_gap`), and
        four spacings at least; `half`, the half-width of the chain [LU], is not used by this default.
        """
        return max(self.half_width(max(deepest, 0.0), self.cutoff_gap), 4.0 * self.spacing)

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """Return {}: by default LAMMPS needs no constants of each particle.

        A subclass returns them by name: (p, values (n,) in [LUᵖ]). `body`: the profile as LAMMPS has it; `x`: positions
        of the particles, (n,) [LU].
        """
        return {}

    def creep(self, time: float) -> float:
        """Return the displacement a time [TU] after a constant load was applied, over the initial one, dimensionless.

        By default 1 at any time, that of an elastic body.
        """
        return 1.0

    @classmethod
    def shortest_time(cls, scene: Scene) -> float | None:
        """Return the shortest relaxation time of a scene [TU].

        None (the default) where forces depend on the path alone.
        """
        return None

    @classmethod
    def series(cls, scene: Scene) -> tuple[tuple[float, float], ...]:
        """Return the Prony series of the modulus as pairs: share of the modulus (relative), relaxation time [TU].

        Empty by default, without relaxation.
        """
        return ()

    @classmethod
    def jumps(cls, scene: Scene) -> bool:
        """Return whether the force jumps where the velocity does, as that of dashpots; False by default."""
        return False

    def sticking(self, mass: float, velocity: float, time: float) -> tuple[str, str] | None:
        """Return (why a body sticks after an impact, the remedy) as texts; None where it rebounds, as by default.

        `mass` of the body [MU], impact `velocity` [LU/TU], `time` [TU] that the impact of the elastic body lasts.
        """
        return None

    @classmethod
    def cohesive_load(cls, scene: Scene, edge: float, reach: float) -> tuple[float, Callable[[Array], Array]]:
        """Return the force [FU] ≤ 0 of the attraction beyond the contact edge, and the tension that it causes inside.

        The tension [FU/LU²], positive, is a function of radii [LU], (n,). By default both are 0.

        Args:
            scene: whose attraction it is.
            edge: contact radius [LU].
            reach: radius up to which the attraction acts [LU].
        """
        return 0.0, np.zeros_like

    def largest_length_change(self, displacement: float) -> float:
        """Return the largest length change of a spring [LU] up to a displacement [LU].

        By default the displacement itself.
        """
        return displacement

    def untouched_radius(self, displacement: float) -> float | None:
        """Return the contact radius [LU] of a body at its first loading to a displacement [LU].

        None, as by default, where the radius follows from the forces of the particles.
        """
        return None

    def contact_force(self, displacement: float) -> float:
        """Return the normal force F [FU] of the whole body at one displacement [LU], both positive in compression.

        Where loading and unloading differ it is that in unloading; 0 of separated bodies.
        """
        return value_at(self.contact_forces, displacement)

    def contact_forces(self, displacements: Array) -> Array:
        """Return F(d), (m,) [FU], of the whole body at displacements (m,) [LU], both positive in compression.

        F = ∫ f dx/spacing over the width in which particles have a force, by the trapezoidal rule at 401 positions.
        Where pairs snap, the force f of a particle is that of a pair that has snapped in, as in unloading. 0 where no
        particle interacts; an undeformed gap below the least one of the law's grid has the force there.

        Raises:
            OverflowError: an unbounded body is too wide compared with its spacing.
        """
        half = self.half_widths(displacements, self.gap[-1])
        x = np.linspace(-half, half, 401)
        gap = self.rest + self.profile.height(x.ravel()).reshape(x.shape) - displacements
        # Along a body the next gap is near the last one, which is where `numpy.interp` looks first.
        per_particle = np.ascontiguousarray(np.interp(gap.T, self.gap, self.force, right=0.0).T)
        return np.asarray(np.trapezoid(per_particle, x, axis=0)) / self.spacing

    def energy(self, displacement: float, radius: float) -> float | None:
        """Return the energy [FU·LU] of a contact of a radius [LU] at a displacement [LU], relative to separated bodies.

        None, as by default, where the law has no such energy.
        """
        return None

    @cached_property
    def half_width(self) -> Callable[[float, float], float]:
        """Function (displacement d [LU], limit [LU]) → half-width [LU] within which the undeformed gap is below the
        limit at d.

        One spacing where the gap at the apex is not below the limit; the half-width of the body at most. Of an adhesive
        contact it is the same for any limit, one spacing at least: the contact radius of Jkr and Receding, and the
        radius up to which the attraction acts of Maugis. Results are cached.
        """
        return cache(lambda displacement, gap: value_at(partial(self.half_widths, gap=gap), displacement))

    def half_widths(self, displacements: Array, gap: float) -> Array:
        """Return the half-widths, (m,) [LU], within which the undeformed gap is below `gap` [LU] at displacements (m,)
        [LU].

        At most the half-width of the body; one spacing where even the gap at the apex is not below `gap`.

        Raises:
            OverflowError: an unbounded body is too wide compared with its spacing.
        """
        # A bracket is cut 12 times at 33 positions: a step of a bisection takes as long, and 60 give all digits.
        rounds, cuts = 12, 33
        height, reach = gap - self.rest + displacements, self.profile.reach
        inner, outer = np.zeros_like(height), np.full_like(height, min(self.spacing, reach))
        with np.errstate(over="ignore"):
            while (short := (outer < reach) & (self.profile.height(outer) < height)).any():
                inner[short], outer[short] = outer[short], np.minimum(2 * outer[short], reach)
        if np.isinf(outer).any():
            raise OverflowError("the body is too wide compared with its spacing")
        column = np.arange(len(height))
        for _ in range(rounds):
            x = np.linspace(inner, outer, cuts)
            cell = (self.profile.height(x[1:-1]) < height).sum(axis=0)
            inner, outer = x[cell, column], x[cell + 1, column]
        return np.where(height <= 0, self.spacing, outer)

    @property
    def deepest_known(self) -> float:
        """Displacement [LU] up to which F(d) is known: by default infinite.

        Of an adhesive contact it is the end of the computed curve.
        """
        return math.inf

    def stopped(self, energy: float) -> float:
        """Return the displacement [LU] at which the work ∫₀ᵈ F dd of the contact is an `energy` ≥ 0 [FU·LU].

        The integral is by the trapezoidal rule at 200 displacements. 0 for an energy of 0; infinite where the work up
        to `deepest_known`, the end of the known F(d), is less.

        Raises:
            OverflowError: an unbounded body is too wide compared with its spacing.
        """
        deepest, last = self.spacing, self.deepest_known

        def stored(displacement: float) -> float:
            """Return ∫₀ᵈ F dd [FU·LU] up to a displacement [LU], positive where compression prevails."""
            displacements = np.linspace(0.0, displacement, 200)
            return float(np.trapezoid(self.contact_forces(displacements), displacements))

        from scipy.optimize import brentq

        while stored(min(deepest, last)) < energy:
            if deepest >= last:
                return math.inf
            deepest *= 2.0
        deepest = min(deepest, last)  # a share of it, since the root is found to an absolute error
        return deepest * float(brentq(lambda share: stored(share * deepest) - energy, 0.0, 1.0))

    def radius_rate(self, displacement: float) -> float:
        """Return da/dd, dimensionless, of the contact radius at a displacement [LU], by a central difference over ± a
        thousandth of |d|, or of the spacing where that is larger.

        The radius is here that of the largest tension under the undeformed profile; on a rigid plane without adhesion
        that of the contact, of particles that only repel each other that of the cutoff. Of Jkr and Receding it is a(d),
        of Maugis the radius c(d) up to which the attraction acts. 0 where this is one spacing on both sides, as where
        the gap at the apex is larger, or the half-width of the body.
        """
        edge, step = float(self.gap[int(self.force.argmin())]), DIFFERENCE * max(abs(displacement), self.spacing)
        ends = self.half_widths(np.asarray([displacement - step, displacement + step]), edge)
        return float(ends[1] - ends[0]) / (2.0 * step)

    def pull_off_force(self) -> float:
        """Return the largest tension [FU] of the whole body by this predictor, positive; 0 without attraction."""
        return max(0.0, self._largest_tension[1])

    @cached_property
    def stiffness_under(self) -> Callable[[float], float]:
        """Function of the force [FU], compression positive → contact stiffness dF/dd [FU/LU] of the whole body; results
        are cached.

        For a tension above 0.998 of the largest one the stiffness at 0.998 of it, since it is 0 at the maximum. Without
        attraction a force of 0 or less gives 0 or NaN. Of laws without adhesion the function raises NotCarriedError for
        a compression that the body cannot carry.
        """
        return cache(self._stiffness_under)

    def _stiffness_under(self, force: float) -> float:
        """Return dF/dd [FU/LU] of the whole body under a force [FU], compression positive.

        For a tension above 0.998 of the largest one the stiffness at 0.998 of it. Without attraction a force of 0 or
        less gives 0 or NaN.

        Raises:
            NotCarriedError: F(d) does not reach a force > 0 before the particles coincide.
        """
        if force > 0.0:
            deepest = self.displacement_at(force)
            step = DIFFERENCE * (deepest - self._apart)
            return (self.contact_force(deepest) - self.contact_force(deepest - step)) / step
        displacements, forces = self._tensions
        peak = int(forces.argmin())
        stiffness = np.gradient(forces, displacements)[peak:]
        return float(np.interp(max(force, SOFTEST_SHARE * forces[peak]), forces[peak:], stiffness))

    @cached_property
    def maxima_distance(self) -> Callable[[int], float]:
        """Function of the number of particles → least distance [LU] in displacement of two neighbouring maxima of the
        tension.

        Infinite for one maximum or none. Where particles separate one by one, F(d) summed over them has a maximum for
        each. Results are cached.
        """
        return cache(self._maxima_distance)

    @cached_property
    def displacement_at(self) -> Callable[[float], float]:
        """Function of a force ≥ 0 [FU], compression positive → displacement [LU] at which the rising F(d) reaches it.

        For 0 without attraction it is that at which the interaction begins, or less. The search ends at some 10¹²
        spacings or distances r₀, whichever is larger, and gives this end for any larger force. Results are cached. The
        function raises NotCarriedError where the particles of a finite body coincide before F(d) reaches the force, and
        OverflowError where the spacing is too small compared with the body.
        """
        return cache(self._displacement_at)

    def _maxima_distance(self, particles: int) -> float:
        """Return the least distance [LU] in displacement of two neighbouring maxima of the tension of a chain of
        `particles`.

        Infinite for one maximum or none. The tension must fall by 1e-4 of its largest value between two of them.

        Raises:
            NotCarriedError, OverflowError: no displacement with F = 0 is found.
        """
        least_fall = 1e-4  # of the tension between two maxima, over the largest one
        x: Array = self.spacing * (np.arange(particles, dtype=np.float64) - 0.5 * (particles - 1))
        zero = self.displacement_at(0.0)
        displacements = np.linspace(zero, self._apart, 2000)
        tension = np.zeros_like(displacements)
        heights, counts = np.unique(self.profile.height(x), return_counts=True)
        felt = heights < zero - self._apart
        for height, count in zip(heights[felt].tolist(), counts[felt].tolist(), strict=True):
            tension -= count * np.interp(self.rest + height - displacements, self.gap, self.force, right=0.0)
        peaks = tops(tension.tolist(), least_fall * float(tension.max()))
        return float(np.min(np.abs(np.diff(displacements[peaks])), initial=math.inf))

    @cached_property
    def snap(self) -> tuple[float, float]:
        """(Undeformed gap [LU] at which a pair that has snapped in snaps out, tension [FU] ≥ 0 that is lost there).

        Where no pair snaps, the gap at which forces end (`cutoff_gap`) and 0.
        """
        level = _level_cells(self.gap)
        if level.size == 0 or not self.snaps:
            return self.cutoff_gap, 0.0
        return float(self.gap[level[0]]), float(self.force[level[-1] + 1] - self.force[level[0]])

    @property
    def joins(self) -> float:
        """Undeformed gap [LU] below which an approaching pair has snapped in; `cutoff_gap`, where forces end, if none
        snaps.
        """
        if self.outer is None:
            return self.cutoff_gap
        level = _level_cells(self.outer)
        return float(self.outer[level[0]]) if level.size else self.cutoff_gap

    @property
    def cutoff_gap(self) -> float:
        """Undeformed gap [LU] beyond which a particle has no force; 0 on a rigid plane, not including adhesion."""
        return float(self.gap[-1])

    def premature_detachment(self, move: float, force: float) -> float:
        """Return by how much of the gap [LU], ≥ 0, a pair that has snapped in separates too early in increments `move`
        [LU].

        0 where no pair snaps. A move h puts such a pair h further apart before it relaxes. That is beyond the unstable
        position next to it, which is 2 √(2 e/|G″|) away at a gap e before the fold of G(r), up to e = h² |G″|/8. The
        residual `force` of a relaxation, a norm F of the forces [FU], adds to h: it alone detaches the pair at e = 20
        F/K, K the contact stiffness of one pair.
        """
        if self.bend == 0.0:
            return 0.0
        # Force at which a relaxed pair separates over the norm F; measured: 17 and 18 at tolerances of 1e-2 and 1e-3.
        unrelaxed = 20.0
        residual = unrelaxed * force / self.stiffness
        return 0.125 * self.bend * (move + math.sqrt(8.0 * residual / self.bend)) ** 2

    def stuck_stiffness(self, displacement: float) -> float:
        """Return the stiffness [FU/LU] of all pairs in contact at a displacement [LU], as if none separated; of one at
        least.

        Pairs are in contact up to the gap of their snap-out, or where none snaps up to the gap of the largest tension;
        on a rigid plane up to the gap 0, and of particles that only repel each other up to the cutoff. Of an adhesive
        contact those within its radius count.
        """
        separation = self.snap[0] if self.snaps else float(self.gap[self.force.argmin()])
        width = 2.0 * self.half_width(displacement, separation)
        return max(1.0, width / self.spacing) * self.stiffness

    def parted(self, share: float) -> float:
        """Return the displacement [LU] below that of the force maximum at which, in further separation, the tension
        first falls below `share` of its maximum.

        `share`: relative, 0 … 1. The displacement is one of 400 from the onset of the interaction to F = 0; where the
        tension is below `share` at none of them, as for 0, and without attraction it is that of the onset.
        """
        displacements, forces = self._tensions
        peak = int(forces.argmin())
        fallen = forces[:peak] > share * forces[peak]
        return float(displacements[:peak][fallen][-1]) if fallen.any() else float(displacements[0])

    @property
    def _apart(self) -> float:
        """Displacement [LU] below which F = 0: r₀ less the gap at which forces end."""
        return self.rest - self.cutoff_gap

    @cached_property
    def _coincidence(self) -> float:
        """Displacement [LU] at which each particle of a finite body coincides with its opposite one, the outermost pair
        at last.
        """
        return self.rest - float(self.gap[0]) + value_at(self.profile.height, self.profile.reach)

    @cached_property
    def _largest_tension(self) -> tuple[float, float]:
        """(Displacement [LU], tension −F [FU]) where the tension is largest: > 0, or without attraction 0 or less.

        By a scan of 40 displacements from the onset of the interaction to r₀, and a second one of 40 around its best.
        """
        low, high = self._apart, self.rest
        for _ in range(2):
            displacements, step = np.linspace(low, high, 40, retstep=True)
            forces = self.contact_forces(displacements)
            peak = int(forces.argmin())
            low, high = float(displacements[peak] - step), float(displacements[peak] + step)
        return float(displacements[peak]), -float(forces[peak])

    @cached_property
    def _tensions(self) -> tuple[Array, Array]:
        """Displacements [LU], rising from the onset of the interaction to F = 0, and F [FU] there, (400,) each.

        F is negative in tension. Without attraction F is 0 at all displacements, which need not rise.
        """
        displacements = np.linspace(self._apart, self.displacement_at(0.0), 400)
        return displacements, self.contact_forces(displacements)

    def _displacement_at(self, force: float) -> float:
        """Return the displacement [LU] at which F(d) rises to a force ≥ 0 [FU], compression positive.

        For 0 without attraction it is that at which the interaction begins, or less. For a force that is not reached
        within some 10¹² spacings or distances r₀ it is the end of this search.

        Raises:
            NotCarriedError: the particles of a finite body coincide before F(d) reaches the force.
            OverflowError: the spacing is too small compared with the body.
        """
        if self.spacing**2 == 0.0:
            raise OverflowError("the spacing is too small compared with the body")
        low = self._largest_tension[0]  # where the force begins to rise
        high = max(self.spacing, 2 * self.rest)
        # No deck holds a displacement beyond this one (`model.chain.require_travel`).
        farthest = 1e12 * max(self.spacing, self.rest)
        while (reached := self.contact_force(high)) < force and high < farthest:
            if self.profile.reach < np.inf and high > self._coincidence:
                raise NotCarriedError(reached)
            high *= 2
        # After 5 cuts at 17 positions the force is straight in the bracket to 1e-10. `scipy.optimize.brentq` would do
        # as well, but its import takes a quarter of the time of a whole small run.
        cuts, points = 5, 17
        for _ in range(cuts):
            displacements = np.linspace(low, high, points)
            forces = self.contact_forces(displacements)
            cell = int(np.clip(np.searchsorted(forces, force), 1, points - 1))
            low, high = float(displacements[cell - 1]), float(displacements[cell])
        return float(np.interp(force, forces, displacements))


def _level_cells(gap: Array, flatness: float = 1e-6) -> NDArray[np.intp]:
    """Return the rising indices i of cells i … i + 1 in which a `gap` made monotone, (n,) [LU], is level: a pair snaps
    there.

    Empty where it is level nowhere. `flatness`: rise of the gap in a cell over the mean rise (relative), below which it
    counts as level.
    """
    rises = np.diff(gap)
    return np.flatnonzero(rises < flatness * rises.mean())


def stopped_at(scene: Scene, law: Law, softer: float = 1.0) -> float:
    """Return the displacement [LU] at which a body that hits the plane is at rest: ∫F dd = ½ M v² · `softer`.

    0 of an experiment without an impact; infinite where the work up to the end of the known F(d) is less. F is that of
    the elastic body; `softer`, a factor, is how many times softer the actual one is.

    Raises:
        StopIteration: an impact without a plate.
        AssertionError: one with an automatic mass M.
        OverflowError: an unbounded body is too wide compared with its spacing.
    """
    if not isinstance(scene.experiment, Impact):
        return 0.0
    return law.stopped(0.5 * softer * scene.impact_mass * scene.experiment.velocity**2)
