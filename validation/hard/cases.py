"""Scenes whose particles feel their opposite only, and the exact answer to each: `FoldedPairs`.

The ranges are 0.015 and 0.03 spacings, so that the next particle is exp(−33) away. What a class varies is
ratio = steepest rise of the pair's force / (k/2): above 1 pairs snap.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.stats import chi2

from validation.doors import IN_TIME, law_table
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats, PairInteraction

REPULSION, ATTRACTION = (0.011, 0.015), (0.01, 0.03)
"""Amplitude [FU LU] and range [LU]."""
LAW = PairInteraction.of(*REPULSION, *ATTRACTION)
STEEPEST = float(LAW.force_slope(np.array(max(LAW.extremum_distance(2), 0.0))))
"""[FU/LU]"""
TENSION = float(-LAW.force(np.array(LAW.extremum_distance(1))))
"""Largest tension of a pair [FU]."""
CORE = float(LAW.force(np.array(0.0)))
"""Force of a pair at no distance [FU]."""
PAPER_NUMBERS = (0.18, 0.13, 0.09, 0.26)
PAPER_LAW = law_table(*PAPER_NUMBERS)
"""The paper's kind of contact: ranges near the spacing, so that particles feel several opposite ones."""
BODIES = {"particles": 12, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 40.0}, "bulk_stiffness": 0.83}
"""A few particles, for decks under the hand."""
CAPACITY = 0.9
"""Share of the core's force up to which a case counts as solvable."""


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
    profile: dict[str, Any]
    particles: int
    preload: float
    tolerance: float = 1e-3
    dynamic: bool = False
    more: dict[str, Any] = field(default_factory=dict)

    @property
    def stiffness(self) -> float:
        """k [FU/LU]."""
        return 2.0 * STEEPEST / self.ratio

    def scene(self) -> dict[str, Any]:
        """What is run: a pull-off, unless `more` has another experiment."""
        method = "dynamic" if self.dynamic else "quasistatic"
        return (
            {
                "bodies": {
                    "particles": self.particles,
                    "spacing": 1.0,
                    "profile": self.profile,
                    "reduction": "geike_popov",  # as drawn: `heights`
                    "bulk_stiffness": self.stiffness,
                },
                "interaction": law_table(*REPULSION, *ATTRACTION),
                "accuracy": {"tolerance": self.tolerance},
                "experiment": {"kind": "pull_off", "method": method, "preload": self.preload},
            }
            | (IN_TIME if self.dynamic else {})
            | self.more
        )

    def exact(self) -> FoldedPairs:
        """The same pairs in closed form."""
        return FoldedPairs(LAW, self.stiffness, heights(self.profile, self.particles))

    def solvable(self) -> bool:
        """Whether the deepest pair carries less than 0.9 of what its core can on the way to the preload."""
        pairs = self.exact()
        try:
            top = pairs.deepest(self.preload)
        except ValueError:
            return False
        gap = np.array([LAW.force_free_distance() + float(np.min(pairs.heights)) - top])
        joined = np.array([pairs.fold is None or gap[0] <= pairs.fold.gap_on])
        return float(LAW.force(pairs.distance(gap, joined))[0]) < CAPACITY * CORE


def reach(ratio: float) -> float:
    """Height over the apex [LU] beyond which a particle of a contact that is just touched carries nothing to speak of.

    Twelve ranges, and with snaps the stretch at which the last of them happens.
    """
    fold = FoldedPairs(LAW, 2.0 * STEEPEST / ratio, np.zeros(1)).fold
    return 12.0 * ATTRACTION[1] + (0.0 if fold is None else max(fold.gap_off, fold.gap_on))


def shaped(kind: str, particles: int, edge: float) -> dict[str, Any]:
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


def heights(profile: dict[str, Any], particles: int) -> Floats:
    """Heights over the apex of a chain of spacing 1, shape (particles,) [LU]; written apart from the program's own.

    Raises:
        ValueError: for another kind than flat_punch, parabola, cone and power.
    """
    x = np.abs(np.arange(particles) - 0.5 * (particles - 1))
    match profile["kind"]:
        case "flat_punch":
            return np.zeros(particles)
        case "parabola":
            return np.asarray(x**2 / (2.0 * profile["radius"]))
        case "cone":
            return np.asarray(profile["slope"] * x)
        case "power":
            return np.asarray(profile["height"] * (x / profile["radius"]) ** profile["exponent"])
    raise ValueError(f"no heights for a {profile['kind']}")


SIGMAS = 4.0
"""Standard errors of the sample: one row in 16 000 fails by chance, and the seeds are fixed."""
CHANCE = 1e-4
"""Of a row that judges a chi-square."""
BLOCKS = 20


def chi_square_bound(count: int) -> float:
    """χ² of `count` block means, whose own errors are known from BLOCKS blocks only: each is an F-variable."""
    return float(chi2.ppf(1.0 - CHANCE, count)) * (BLOCKS - 1) / (BLOCKS - 3)


def block_mean(samples: Floats) -> tuple[Floats, Floats]:
    """Mean and standard error of each column, from blocks."""
    blocks = np.array([block.mean(axis=0) for block in np.array_split(samples, BLOCKS)])
    return samples.mean(axis=0), blocks.std(axis=0, ddof=1) / math.sqrt(BLOCKS)
