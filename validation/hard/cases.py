"""Scenes whose particles feel their opposite only, and the exact answer to each: `FoldedPairs`.

The ranges are 0.015 and 0.03 spacings, so that the next particle is exp(−33) away. What a class varies is
ratio = steepest rise of the pair's force / (k/2): above 1 pairs snap. The contact radius is the place x where a pair
would have the largest tension, h(x) = G_m − r0 + d: G_m = G(r_m), or where pairs have snapped the gap at which they do.
"""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from validation.doors import IN_TIME, law_table
from validation.hard.judge import Case, Expected
from validation.hard.surfaces import power_of
from validation.hard.units import Scene
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats, PairInteraction

REPULSION, ATTRACTION = (0.011, 0.015), (0.01, 0.03)
"""Amplitude [FU LU] and range [LU]."""
LAW = PairInteraction.of(*REPULSION, *ATTRACTION)
STEEPEST = LAW.steepest_rise
"""[FU/LU]"""
TENSION = LAW.largest_tension
"""Largest tension of a pair [FU]."""
CORE = float(LAW.force(0.0))
"""Force of a pair at no distance [FU]."""
PAPER_NUMBERS = (0.18, 0.13, 0.09, 0.26)
PAPER_LAW = law_table(*PAPER_NUMBERS)
"""The paper's kind of contact: ranges near the spacing, so that particles feel several opposite ones."""
PAPER_BODIES: Scene = {
    "particles": 200, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 1000.0}, "bulk_stiffness": 0.83,
}  # fmt: skip
"""Those of pull_off.toml."""
CAPACITY = 0.9
"""Share of the core's force up to which a case counts as solvable."""
LOOKS = 4000
"""Displacements at which a force is first searched for."""
PAIRS = "independent pairs with their folds"
Numbers = dict[str, float]


@dataclass(frozen=True)
class PairCase:
    """One scene.

    Attributes:
        name: of its run.
        ratio: see above.
        profile: table of the scene, spacing 1.
        particles: per body.
        preload: [FU].
        tolerance: asked for.
        dynamic: by a plate in time.
        more: further tables, or other ones.
    """

    name: str
    ratio: float
    profile: Scene
    particles: int
    preload: float = 0.0
    tolerance: float = 1e-3
    dynamic: bool = False
    more: Scene = field(default_factory=dict)

    @property
    def stiffness(self) -> float:
        """k [FU/LU]."""
        return 2.0 * STEEPEST / self.ratio

    @property
    def method(self) -> str:
        """Of its experiment."""
        return "dynamic" if self.dynamic else "quasistatic"

    def scene(self) -> Scene:
        """What is run: a pull-off, unless `more` has another experiment."""
        bodies = {"particles": self.particles, "spacing": 1.0, "profile": self.profile, "reduction": "geike_popov",
                  "bulk_stiffness": self.stiffness}  # fmt: skip
        experiment = {"kind": "pull_off", "method": self.method, "preload": self.preload}
        own = {"bodies": bodies, "interaction": law_table(*REPULSION, *ATTRACTION), "experiment": experiment,
               "accuracy": {"tolerance": self.tolerance}}  # fmt: skip
        return own | (IN_TIME if self.dynamic else {}) | self.more

    def judged(self, group: str, words: str, numbers: Numbers) -> Case:
        """The scene with what it has."""
        return Case(self.name, group, words, self.scene(), Expected(numbers))

    @cached_property
    def pairs(self) -> FoldedPairs:
        """The same pairs in closed form."""
        return FoldedPairs(LAW, self.stiffness, heights(self.profile, self.particles))

    def solvable(self) -> bool:
        """Whether there is a state under the preload, and no pair of it is pressed near its core's force."""
        try:
            top = self.pairs.deepest(self.preload)
        except ValueError:
            return False
        gap = np.array([LAW.force_free_distance() + np.min(self.pairs.heights) - top])
        joined = np.array([self.pairs.fold is None or gap[0] <= self.pairs.fold.gap_on])
        return float(LAW.force(self.pairs.distance(gap, joined))[0]) < CAPACITY * CORE

    def pulled(self) -> Numbers:
        """What a pull-off has."""
        tension, place = self.pairs.adhesion(self.preload)
        zero = self.unloaded(0.0, self.pairs.deepest(self.preload))
        return {"adhesion_force": tension} | self.radii(critical_radius=place, zero_load_radius=zero)

    def passed(self, deepest: float) -> Numbers:
        """What a path there and back has."""
        lost = self.pairs.loop_area(deepest)
        return self.pulled() | ({"dissipated_energy": lost} if lost > 0.0 else {})

    def loaded(self, load: float) -> Numbers:
        """What a load has; a tension after no compression."""
        place = self.pairs.deepest(max(load, 0.0))
        place = self.unloaded(load, place) if load < 0.0 else place
        return {"displacement": place} | self.radii(joining=load >= 0.0, contact_radius=place)

    def unloaded(self, force: float, top: float) -> float:
        """The first displacement [LU] at which a body drawn back from `top` [LU] carries `force` [FU]."""
        pairs = self.pairs
        far = 0.0 if pairs.fold is None else pairs.fold.gap_off
        places = np.linspace(top, -np.ptp(pairs.heights) - far - 12.0 * ATTRACTION[1], LOOKS)
        below = int(np.argmax(pairs.unloading(places, top) <= force))
        ends = places[below - 1], places[below]
        return float(brentq(lambda d: pairs.unloading(d, top) - force, *ends, xtol=1e-15) if below else top)

    def radii(self, joining: bool = False, inside: float = 0.0, **places: float) -> Numbers:
        """Radii [LU] at displacements [LU]; `joining`: of a body on its way in.

        None so far from the chain's end or nearer: `inside` [LU].
        """
        half, fold = 0.5 * (self.particles - 1) - inside, self.pairs.fold
        if self.profile["kind"] == "flat_punch":
            return dict.fromkeys(places, 0.5 * self.particles)
        gap = float(self.pairs.gap(LAW.extremum_distance(1)))
        if fold is not None:
            gap = min(gap, fold.gap_on) if joining else fold.gap_off
        found = {name: _place(self.profile, gap - LAW.force_free_distance() + d) for name, d in places.items()}
        return {name: radius for name, radius in found.items() if (inside or radius > 0.0) and radius < half}


def reach(ratio: float) -> float:
    """Height over the apex [LU] beyond which a particle of a contact that is just touched carries nothing to speak of.

    Twelve ranges, and with snaps the stretch at which the last of them happens.
    """
    fold = FoldedPairs(LAW, 2.0 * STEEPEST / ratio, np.zeros(1)).fold
    return 12.0 * ATTRACTION[1] + (0.0 if fold is None else max(fold.gap_off, fold.gap_on))


def shaped(kind: str, particles: int, edge: float) -> Scene:
    """Table of a profile whose last particle is `edge` [LU] above the apex."""
    half = 0.5 * (particles - 1)
    match kind:
        case "flat_punch":
            return {"kind": kind, "radius": 0.5 * particles}
        case "parabola":
            return {"kind": kind, "radius": half**2 / (2.0 * edge)}
        case "cone":
            return {"kind": kind, "slope": edge / half}
    return {"kind": "power", "exponent": 6.0, "radius": half, "height": edge}


def heights(profile: Scene, particles: int) -> Floats:
    """Heights over the apex of a chain of spacing 1, shape (particles,) [LU]."""
    one = power_of(profile)
    return np.asarray(one.factor * np.abs(np.arange(particles) - 0.5 * (particles - 1)) ** one.exponent)


def _place(profile: Scene, height: float) -> float:
    """The place [LU] at which a profile is `height` [LU] above its apex."""
    one = power_of(profile)
    return math.pow(max(height, 0.0) / one.factor, 1.0 / one.exponent)
