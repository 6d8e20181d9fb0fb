"""The work of adhesion that an interaction implies: what it takes to part two chains, as energy per area of the body.

One particle parts from the row of opposite ones, s apart, by the work w = ∫ −f dr from its force-free distance on, so
that a length of chain holds w/s. Where the edge of a contact of radius a recedes by da, both ends of the chain part by
da, and the ring 2πa da of the body's surface parts:

    mdr:           2 (w/s) da = W 2πa da                          W = w/(π s a)
    geike_popov:   two equal spheres, half as wide as the image   W = 4w/(π s a),   a the image's

JKR's body has one W for every a, and the chain one w/s: they are alike at one radius only, that of the run. How far the
two are apart is told by the force, F_A = (3/2) πWR_e, R_e = R with the MDR and R/2 for the two spheres.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from contact1d.potentials import DoubleExponential
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.estimate import row_force
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import FORCE, LINE_PRESSURE, Quantity

RADII = ("zero_load_radius", "contact_radius")
"""Results that W is taken at, the first that a run has."""
WIDER = {"mdr": 1.0, "geike_popov": 4.0}
"""W π s a/w."""
EFFECTIVE = {"mdr": 1.0, "geike_popov": 0.5}
"""R_e/R."""
TAIL, POINTS = 1e-10, 8000
"""Force at the last distance over that at the force-free one, and how many distances."""
LINE = "w/s: w = ∫ −f dr parts one particle from the opposite row, s is the spacing; energy per length of chain"
FORMULAS = {
    "mdr": {
        "separation_energy": LINE,
        "work_of_adhesion": "W = w/(π s a), a the contact radius: where it shrinks by da, two lengths da of chain and "
        "the ring 2πa da of the body's surface part (mdr). Uncertain by what F_A = (3/2)πWR has instead",
    },
    "geike_popov": {
        "separation_energy": LINE,
        "work_of_adhesion": "W = 4w/(π s a), a the image's half-width, twice the contact radius of the two equal "
        "spheres that geike_popov stands for: where it shrinks by da, two lengths da of chain and the ring "
        "(π/2)a da of their surface part. Uncertain by what F_A = (3/4)πWR has instead",
    },
}
"""How the numbers are made, by reduction."""


def with_implied(scene: Scene, settings: Settings, outcome: Outcome) -> Outcome:
    """The outcome of a run, and what its interaction implies; that counts as prescribed, as the interaction is."""
    found = implied(scene, settings, outcome.quantities)
    return replace(outcome, derived={**outcome.derived, **found})


def implied(scene: Scene, settings: Settings, found: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """`separation_energy`, w/s [FU], and of a sphere `work_of_adhesion` [FU/LU]; nothing without an attraction.

    Args:
        scene: that ran.
        settings: that it ran with.
        found: its results; without a radius there is no W.
    """
    if settings.law is None or settings.law.attraction is None:
        return {}
    work, error = _work(settings.law, scene.bodies.spacing)
    line = work / scene.bodies.spacing
    quantities = {"separation_energy": Quantity(line, error / scene.bodies.spacing, FORCE)}
    radius = next((found[name] for name in RADII if name in found), None)
    curvature = scene.bodies.profile.curvature_radius
    if radius is None or curvature is None or not radius.value > 0.0:
        return quantities
    reduction = scene.bodies.reduction
    energy = WIDER[reduction] * line / (math.pi * radius.value)
    tension = found["adhesion_force"].value if "adhesion_force" in found else settings.estimate.pull_off_force()
    by_force = tension / (1.5 * math.pi * EFFECTIVE[reduction] * curvature)
    spread = abs(energy - by_force) + energy * (radius.uncertainty / radius.value + error / work)
    return quantities | {"work_of_adhesion": Quantity(energy, spread, LINE_PRESSURE)}


def formulas(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, dict[str, str]]:
    """For results.json, `formulas`: in words, how a number was made that has more than one reading."""
    said = {name: text for name, text in FORMULAS[scene.bodies.reduction].items() if name in quantities}
    return {"formulas": said} if said else {}


@lru_cache(maxsize=16)  # scenes run one after the other mostly share their law
def _work(law: DoubleExponential, spacing: float) -> tuple[float, float]:
    """w [FU·LU] by the trapezoid, and what its step leaves open: the difference from twice the step."""
    end = law.cutoff_for(TAIL)
    r = np.linspace(end / POINTS, end, POINTS)
    force = row_force(law, r, spacing, end)

    def work(values: NDArray[np.float64], step: float) -> float:
        inwards = np.cumsum(0.5 * (values[1:] + values[:-1])[::-1]) * step
        return float(max(-inwards.min(), 0.0))

    fine = work(force, end / POINTS)
    return fine, abs(fine - work(force[1::2], 2.0 * end / POINTS))
