"""What every contact law answers; by itself the curve of independent opposite pairs under the undeformed profile.

A particle on each side, each on its spring k, at the actual distance r have the undeformed gap

    G(r) = r − 2 f(r)/k,       f(r) = Σ_j f_pair(√(r² + (js)²)) r/√(r² + (js)²)

with f the force of a whole straight row of opposite particles. F(d) = Σ_i f(r_i) with G(r_i) = r₀ + h(x_i) − d, where
h is the profile. This chooses chain lengths, first steps and time scales; no result depends on it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import tops
from contact1d.workflow.laws.radius import Compressed, InTension, RadiusRule, ToTheEdge
from contact1d.workflow.laws.shape import Profile, Tabulated
from contact1d.workflow.scene import Impact, Scene

if TYPE_CHECKING:
    from contact1d.workflow.laws.particles import Particles

Array = NDArray[np.float64]
FEWEST = 4.0
"""Least half-width up to which particles are counted, over the spacing."""
CONTACT_POINTS = 401
BRANCH_POINTS, COARSE_POINTS = 400, 40
FARTHEST = 1e12
"""Displacement over spacing and force-free distance beyond which none is sought: no deck holds it
(`model.chain.require_travel`)."""
FARTHEST_RATIO = 1e9
"""Displacement over cutoff and spacing: LAMMPS limits the number of bins, and coordinates lose digits."""
CUTS, PARTS = 5, 17
"""How often the bracket of a displacement is cut, and at how many positions: then the force is straight in it to 1e-10.
`scipy.optimize.brentq` would do it too, but its import takes a quarter of the time of a whole small run."""
DIFFERENCE = 1e-3
"""Difference of two displacements whose forces give a stiffness, over the way since the bodies feel each other."""
FLATNESS = 1e-6
"""Rise of a gap over the mean one below which the grid is level there: made monotone, where a pair snaps."""
SOFTEST_SHARE = 0.998
"""Tension over the largest one at which a contact counts as softest: at the largest itself it has no stiffness left."""
TEETH_POINTS, TOOTH = 2000, 1e-4
"""Displacements at which the force of a chain is summed, and the fall between two of its maxima over the largest."""
UNRELAXED = 20.0
"""Force at which a relaxed pair separates over the norm at which a relaxation stops; measured: 17 and 18, at
tolerances of 1e-2 and 1e-3."""
ROUNDS, EDGES = 12, 33
"""How often a bracket is cut, and at how many positions: a bisection's step takes as long, and 60 give all digits."""
STOPPING = 200
"""Displacements at which the force is looked at up to where a body stops."""


class NotCarriedError(ValueError):
    """A load that exceeds the force at every displacement; `most` is the largest force [FU]."""

    def __init__(self, most: float) -> None:
        """Keep it."""
        super().__init__(most)
        self.most = most


@dataclass(frozen=True, eq=False)
class Law(ABC):
    """The contact of a body. Successive scenes share it with its cached results.

    Attributes:
        in_time: whether forces depend on how fast a path is gone.
        is_lossless: whether a closed path loses nothing.
        rules: what the contact radius is: of a body with an edge, of bodies that attract each other, of others.
        table: what a profile that takes long is tabulated as.
        file: of the columns that the deck has of each particle; "" without.
        beside: families of closed forms (`body.theory`) that may be printed beside a run; of another law none is.
        exact: those of them that are the law's own, so that a run must agree with them.
        gap: undeformed gap G [LU] over a grid of distances, made monotone where pairs would snap.
        force: force [FU] of one particle on that grid.
        rest: distance r₀ [LU] of the apexes at displacement 0.
        profile: the upper body's shape.
        spacing: [LU].
        stiffness: contact stiffness of one particle [FU/LU], both springs in series.
        snaps: whether pairs snap: G(r) falls somewhere, so that loading and unloading differ.
        bend: |d²G/dr²| at the limit point of a joined pair [1/LU]; 0 where none snaps.
        outer: where pairs snap, the gap made monotone from outside [LU]: on it a pair comes near.
    """

    in_time: ClassVar[bool] = False
    is_lossless: ClassVar[bool] = True
    rules: ClassVar[tuple[type[RadiusRule], ...]] = (ToTheEdge, InTension, Compressed)
    table: ClassVar[type[Tabulated]] = Tabulated
    file: ClassVar[str] = ""
    beside: ClassVar[tuple[str, ...]] = ()
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

    def __getstate__(self) -> dict[str, Any]:
        """What goes to another process: not what was found before, which keeps functions."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @classmethod
    @abstractmethod
    def applies(cls, scene: Scene) -> bool:
        """Whether it is the law of a scene, of those that no law before it in `laws.LAWS` has."""

    @classmethod
    @abstractmethod
    def of(cls, scene: Scene, profile: Profile) -> Law:
        """The law of a scene on a rigid plane, of a body of a profile.

        Raises:
            SettingsError: the body has no such contact.
        """

    @abstractmethod
    def particles(self, x: Array, deepest: float) -> Particles:
        """Particles at rising positions [LU]; `deepest`: largest displacement that is expected [LU]."""

    @classmethod
    def attracts(cls, scene: Scene) -> bool:
        """Whether the bodies of a scene hold each other."""
        return bool(scene.interaction and scene.interaction.attraction)

    @classmethod
    def rule(cls, scene: Scene) -> type[RadiusRule]:
        """What the contact radius of a scene is."""
        return cls.rules[0 if scene.bodies.profile.has_edge else 1 if cls.attracts(scene) else 2]

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """h₀ of an attraction [LU], `assumed` of one that has none by its law; 0 without an attraction."""
        return 0.0

    def extent(self, deepest: float, half: float) -> float:
        """Half-width [LU] up to which particles count, of a chain's `half`, at a displacement [LU]."""
        return max(self.half_width(max(deepest, 0.0), self.felt), FEWEST * self.spacing)

    def columns(self, body: Profile, x: Array) -> Mapping[str, tuple[int, Array]]:
        """What the deck has of each particle of a body at positions x [LU]: by name, as powers of a length."""
        return {}

    def creep(self, time: float) -> float:
        """Displacement after a time [TU] under a load, over that at once."""
        return 1.0

    @classmethod
    def soonest(cls, scene: Scene) -> float | None:
        """Time [TU] within which forces of a scene change after its rates have; None where they only follow a path."""
        return None

    @classmethod
    def series(cls, scene: Scene) -> tuple[tuple[float, float], ...]:
        """Shares of a modulus that relaxes in time, and their times [TU]."""
        return ()

    @classmethod
    def jumps(cls, scene: Scene) -> bool:
        """Whether the force jumps where the velocity does."""
        return False

    def sticking(self, mass: float, velocity: float, time: float) -> tuple[str, str] | None:
        """Why a body sticks that hits the plane, and the remedy; None of one that comes back.

        `mass` [MU], `velocity` [LU/TU], `time` of the impact of the elastic body [TU].
        """
        return None

    @classmethod
    def drawn(cls, scene: Scene, edge: float, reach: float) -> tuple[float, Callable[[Array], Array]]:
        """Force [FU] of an attraction beyond the edge of a contact, and the tension inside [FU/LU²] that it brings."""
        return 0.0, np.zeros_like

    def strained(self, displacement: float) -> float:
        """Length [LU] by which springs are pressed or pulled at most, of a contact as deep as this [LU]."""
        return displacement

    def untouched_radius(self, displacement: float) -> float | None:
        """Contact radius [LU] at the largest displacement [LU] of an untouched body; None: its particles tell it."""
        return None

    def contact_force(self, displacement: float) -> float:
        """F(d) [FU], compression positive."""
        return float(self.contact_forces(np.asarray([displacement]))[0])

    def contact_forces(self, displacements: Array) -> Array:
        """F(d) [FU] at each of the displacements [LU], compression positive."""
        half = self.half_widths(displacements, self.gap[-1])
        x = np.linspace(-half, half, CONTACT_POINTS)
        gap = self.rest + self.profile.height(x.ravel()).reshape(x.shape) - displacements
        # Along a body the next gap is near the last one, which is where `numpy.interp` looks first.
        per_particle = np.ascontiguousarray(np.interp(gap.T, self.gap, self.force, right=0.0).T)
        return np.asarray(np.trapezoid(per_particle, x, axis=0)) / self.spacing

    def energy(self, displacement: float, radius: float) -> float | None:
        """Energy of a contact [FU·LU] of radius [LU] at a displacement [LU], without that of bodies apart, if known."""
        return None

    @cached_property
    def half_width(self) -> Callable[[float, float], float]:
        """`half_widths` at one displacement."""
        return cache(lambda displacement, gap: float(self.half_widths(np.asarray([displacement]), gap)[0]))

    def half_widths(self, displacements: Array, gap: float) -> Array:
        """Half-widths [LU] within which the undeformed gap is below `gap` [LU] at these displacements [LU].

        At most the body's own.
        """
        height, reach = gap - self.rest + displacements, self.profile.reach
        inner, outer = np.zeros_like(height), np.full_like(height, min(self.spacing, reach))
        with np.errstate(over="ignore"):
            while (short := (outer < reach) & (self.profile.height(outer) < height)).any():
                inner[short], outer[short] = outer[short], np.minimum(2 * outer[short], reach)
        if np.isinf(outer).any():
            raise OverflowError("the body is too wide compared with its spacing")
        column = np.arange(len(height))
        for _ in range(ROUNDS):
            places = np.linspace(inner, outer, EDGES)
            cell = (self.profile.height(places[1:-1]) < height).sum(axis=0)
            inner, outer = places[cell, column], places[cell + 1, column]
        return np.where(height <= 0, self.spacing, outer)

    @property
    def deepest_known(self) -> float:
        """Displacement [LU] up to which F is known; a contact that covers its body only gets deeper."""
        return math.inf

    def stopped(self, energy: float) -> float:
        """Displacement [LU] at which ∫F dd is an energy [FU·LU]; infinite where that lies beyond what is known."""
        deepest, last = self.spacing, self.deepest_known

        def stored(displacement: float) -> float:
            places = np.linspace(0.0, displacement, STOPPING)
            return float(np.trapezoid(self.contact_forces(places), places))

        from scipy.optimize import brentq

        while stored(min(deepest, last)) < energy:
            if deepest >= last:
                return math.inf
            deepest *= 2.0
        deepest = min(deepest, last)  # a share of it, since the root is found to an absolute error
        return deepest * float(brentq(lambda share: stored(share * deepest) - energy, 0.0, 1.0))

    def radius_rate(self, displacement: float) -> float:
        """da/dd at a displacement [LU]."""
        edge, step = float(self.gap[int(self.force.argmin())]), DIFFERENCE * max(abs(displacement), self.spacing)
        ends = self.half_widths(np.asarray([displacement - step, displacement + step]), edge)
        return float(ends[1] - ends[0]) / (2.0 * step)

    def pull_off_force(self) -> float:
        """Largest tension of the predictor [FU]; 0 without attraction."""
        return max(0.0, self._largest_tension[1])

    @cached_property
    def stiffness_under(self) -> Callable[[float], float]:
        """Contact stiffness dF/dd [FU/LU] under a force [FU]; above SOFTEST_SHARE of the force maximum: there."""
        return cache(self._stiffness_under)

    def _stiffness_under(self, force: float) -> float:
        if force > 0.0:
            deepest = self.displacement_at(force)
            step = DIFFERENCE * (deepest - self._apart)
            return (self.contact_force(deepest) - self.contact_force(deepest - step)) / step
        places, forces = self._tensions
        top = int(forces.argmin())
        stiffness = np.gradient(forces, places)[top:]
        return float(np.interp(max(force, SOFTEST_SHARE * forces[top]), forces[top:], stiffness))

    @cached_property
    def tooth(self) -> Callable[[int], float]:
        """Least distance [LU] of two maxima of the force, between which it falls by TOOTH of the largest; inf for one.

        Summed over the particles of a chain of so many: where they separate one by one, F(d) has a maximum for each.
        """
        return cache(self._tooth)

    @cached_property
    def displacement_at(self) -> Callable[[float], float]:
        """Displacement [LU] at which F(d) reaches a compressive force [FU] ≥ 0.

        Raises:
            NotCarriedError: the particles coincide before it does.
            OverflowError: the spacing is too small compared with the body.
        """
        return cache(self._displacement_at)

    def _tooth(self, particles: int) -> float:
        x: Array = self.spacing * (np.arange(particles, dtype=np.float64) - 0.5 * (particles - 1))
        zero = self.displacement_at(0.0)
        places = np.linspace(zero, self._apart, TEETH_POINTS)
        tension = np.zeros_like(places)
        heights, counts = np.unique(self.profile.height(x), return_counts=True)
        felt = heights < zero - self._apart
        for height, count in zip(heights[felt].tolist(), counts[felt].tolist(), strict=True):
            tension -= count * np.interp(self.rest + height - places, self.gap, self.force, right=0.0)
        found = tops(tension.tolist(), TOOTH * float(tension.max()))
        return float(np.min(np.abs(np.diff(places[found])), initial=math.inf))

    @cached_property
    def snap(self) -> tuple[float, float]:
        """(undeformed gap [LU] at the snap-out of a pair, tension [FU] that it loses then); the end, 0 if none does."""
        rises = np.diff(self.gap)
        level = np.flatnonzero(rises < FLATNESS * rises.mean())
        if level.size == 0 or not self.snaps:
            return float(self.gap[-1]), 0.0
        return float(self.gap[level[0]]), float(self.force[level[-1] + 1] - self.force[level[0]])

    @property
    def joins(self) -> float:
        """Undeformed gap [LU] below which an approaching pair has snapped in; where none snaps, any gap."""
        if self.outer is None:
            return float(self.gap[-1])
        level = np.flatnonzero(np.diff(self.outer) < FLATNESS * np.diff(self.outer).mean())
        return float(self.outer[level[0]]) if level.size else float(self.gap[-1])

    @property
    def felt(self) -> float:
        """Undeformed gap [LU] beyond which nothing is felt."""
        return float(self.gap[-1])

    def let_go_early(self, move: float, force: float) -> float:
        """Premature detachment [LU] of a pair under displacement increments `move` [LU].

        A move h puts a joined pair h further apart before it relaxes. That is beyond the unstable position next to it,
        which is 2 √(2 e/|G″|) away at a gap e before the fold of G(r), up to e = h² |G″|/8. What a relaxation to a norm
        F of the forces [FU] leaves adds to h: it is lost at e = UNRELAXED · 2F/k itself.
        """
        if self.bend == 0.0:
            return 0.0
        left = UNRELAXED * force / self.stiffness
        return 0.125 * self.bend * (move + math.sqrt(8.0 * left / self.bend)) ** 2

    def stuck_stiffness(self, displacement: float) -> float:
        """Contact stiffness [FU/LU] of all pairs that are in contact at a displacement [LU]; one at least."""
        lets_go = self.snap[0] if self.snaps else float(self.gap[self.force.argmin()])
        width = 2.0 * self.half_width(displacement, lets_go)
        return max(1.0, width / self.spacing) * self.stiffness

    def parted(self, share: float) -> float:
        """Displacement [LU] beyond the force maximum at which the tension has fallen to this share of it."""
        places, forces = self._tensions
        top = int(forces.argmin())
        gone = forces[:top] > share * forces[top]
        return float(places[:top][gone][-1]) if gone.any() else float(places[0])

    @property
    def _apart(self) -> float:
        """Displacement [LU] up to which nothing is felt."""
        return self.rest - float(self.gap[-1])

    @cached_property
    def _all_the_way(self) -> float:
        """Displacement [LU] at which each particle of a finite body coincides with its opposite one."""
        return self.rest - float(self.gap[0]) + float(self.profile.height(np.asarray([self.profile.reach]))[0])

    @cached_property
    def _largest_tension(self) -> tuple[float, float]:
        """(displacement [LU], tension [FU]) where the tension is largest, found in two passes."""
        low, high = self._apart, self.rest
        for _ in range(2):
            places, step = np.linspace(low, high, COARSE_POINTS, retstep=True)
            forces = self.contact_forces(places)
            top = int(forces.argmin())
            low, high = float(places[top] - step), float(places[top] + step)
        return float(places[top]), -float(forces[top])

    @cached_property
    def _tensions(self) -> tuple[Array, Array]:
        """Displacements [LU] from where nothing is felt to F = 0, and forces [FU]."""
        places = np.linspace(self._apart, self.displacement_at(0.0), BRANCH_POINTS)
        return places, self.contact_forces(places)

    def _displacement_at(self, force: float) -> float:
        if self.spacing**2 == 0.0:
            raise OverflowError("the spacing is too small compared with the body")
        low = self._largest_tension[0]  # where the force begins to rise
        high = max(self.spacing, 2 * self.rest)
        farthest = FARTHEST * max(self.spacing, self.rest)
        while (reached := self.contact_force(high)) < force and high < farthest:
            if self.profile.reach < np.inf and high > self._all_the_way:
                raise NotCarriedError(reached)
            high *= 2
        for _ in range(CUTS):
            places = np.linspace(low, high, PARTS)
            forces = self.contact_forces(places)
            cell = int(np.clip(np.searchsorted(forces, force), 1, PARTS - 1))
            low, high = float(places[cell - 1]), float(places[cell])
        return float(np.interp(force, forces, places))


def stopped_at(scene: Scene, law: Law, softer: float = 1.0) -> float:
    """Displacement [LU] at which a body that hits the plane is at rest: ∫F dd = ½ M v²; 0 without a velocity.

    F is that of the elastic body, or so many times less. Infinite where that lies beyond what is known of the contact.
    """
    if not isinstance(scene.experiment, Impact):
        return 0.0
    assert scene.plate
    assert scene.plate.mass != "auto"
    return law.stopped(0.5 * softer * scene.plate.mass * scene.experiment.velocity**2)
