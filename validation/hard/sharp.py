"""Random sharp scenes: few particles, ratio 0.3 to 3, all of load, pull_off and path, at rest and in time.

The references are independent pairs with their folds. The contact radius is the place x where a pair would have the
largest tension, h(x) = G_m - r0 + d: G_m = G(r_m), or where pairs have snapped the gap at which they do so.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import brentq

from validation.hard.cases import ATTRACTION, LAW, TENSION, PairCase, reach, shaped
from validation.hard.claims import Tally
from validation.references.folded_pairs import FoldedPairs
from validation.study import Bench, Findings, Study

NAME = "sharp"
QUICK, FULL = 20, 100
SEED = 3
REFERENCE = 1e-8
"""Relative error of the closed forms' roots."""
SHAPES = ("flat_punch", "parabola", "cone", "power")
IN_TIME, CALM = 0.3, 0.97
"""Share of the scenes that are run in time, and the largest ratio there but for a path: behind a snap a plate under a
load lands where its momentum takes it."""
LOOKS = 4000


def measure(bench: Bench) -> Findings:
    """Three rows: claims, tolerances, refusals."""
    rng, tally = np.random.default_rng(SEED), Tally()
    wanted = FULL if bench.full else QUICK
    while sum(tally.scenes.values()) < wanted:
        case, group, exact = drawn(rng, sum(tally.scenes.values()))
        if case.solvable() and _fits(case):
            tally.add(case.name, group, bench.run(case.name, case.scene()), exact(), REFERENCE)
    checks = tally.checks(NAME, "independent pairs with their folds")
    return Findings(checks, tally.drawn())


def drawn(rng: np.random.Generator, number: int) -> tuple[PairCase, str, Callable[[], dict[str, float]]]:
    """A scene, its group, and what gives its numbers."""
    kind = str(rng.choice(["load", "pull_off", "path"]))
    timed = bool(rng.random() < IN_TIME)
    highest = CALM if timed and kind != "path" else 3.0
    ratio = float(np.exp(rng.uniform(math.log(0.3), math.log(highest))))
    particles, shape = int(rng.integers(3, 13)), str(rng.choice(SHAPES))
    profile = shaped(shape, particles, reach(ratio) * float(rng.uniform(1.0, 2.0)))
    preload = TENSION * float(10.0 ** rng.uniform(-1.0, 1.0))
    tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
    case = PairCase(f"sharp_{number}", ratio, profile, particles, preload, tolerance, timed and kind != "path")
    group = f"{kind} {'in time' if timed else 'at rest'}"
    if kind == "load":
        tension = bool(rng.random() < 0.5)
        load = -float(rng.uniform(0.1, 0.95)) * case.exact().adhesion(0.0)[0] if tension else preload
        method = "dynamic" if timed else "quasistatic"
        case = _with(case, {"experiment": {"kind": "load", "method": method, "force": load}})
        return case, group, lambda: _loaded(case, load)
    if kind == "path" and case.solvable():
        pairs = case.exact()
        deepest, lowest = pairs.deepest(preload), -(reach(ratio) + float(np.ptp(pairs.heights)))
        steps = int(rng.integers(20, 80))
        way = {"from": lowest, "to": deepest, "steps": steps}
        method = "dynamic" if timed else "quasistatic"
        tables: dict[str, Any] = {"experiment": {"kind": "path", "method": method, "displacements": way}}
        case = _with(case, tables | ({"damping": {"coefficient": "auto"}} if timed else {}))
        return case, group, lambda: _passed(case, deepest)
    return case, group, lambda: _pulled(case)


def _fits(case: PairCase) -> bool:
    """Whether the contact ends on its chain; a flat punch does so wherever it ends."""
    return case.profile["kind"] == "flat_punch" or bool(
        _radii(case, {"deepest": case.exact().deepest(case.preload)}, inside=0.5)
    )


def _with(case: PairCase, tables: dict[str, Any]) -> PairCase:
    return PairCase(
        case.name, case.ratio, case.profile, case.particles, case.preload, case.tolerance, case.dynamic, tables
    )


def _pulled(case: PairCase) -> dict[str, float]:
    pairs = case.exact()
    top = pairs.deepest(case.preload)
    tension, place = pairs.adhesion(case.preload)
    zero = _unloaded(pairs, 0.0, top)
    return {"adhesion_force": tension} | _radii(case, {"critical_radius": place, "zero_load_radius": zero})


def _passed(case: PairCase, deepest: float) -> dict[str, float]:
    pairs = case.exact()
    found = _pulled(case) | {"dissipated_energy": pairs.loop_area(deepest)}
    return found if found["dissipated_energy"] > 0.0 else {k: v for k, v in found.items() if k != "dissipated_energy"}


def _loaded(case: PairCase, load: float) -> dict[str, float]:
    pairs = case.exact()
    place = pairs.deepest(max(load, 0.0))
    if load < 0.0:
        return {"displacement": (place := _unloaded(pairs, load, place))} | _radii(case, {"contact_radius": place})
    return {"displacement": place} | _radii(case, {"contact_radius": place}, joining=True)


def _unloaded(pairs: FoldedPairs, force: float, top: float) -> float:
    """The first displacement [LU] at which a body drawn back from `top` [LU] carries `force` [FU]."""
    fold = pairs.fold
    far = 0.0 if fold is None else fold.gap_off
    places = np.linspace(top, -float(np.ptp(pairs.heights)) - far - 12.0 * ATTRACTION[1], LOOKS)
    below = int(np.argmax(pairs.unloading(places, top) <= force))
    if below == 0:
        return float(top)
    return float(brentq(lambda d: float(pairs.unloading(d, top)) - force, places[below - 1], places[below], xtol=1e-15))


def _radii(case: PairCase, places: dict[str, float], joining: bool = False, inside: float = 0.0) -> dict[str, float]:
    """Radii [LU] at displacements [LU]; `joining`: of a body on its way in.

    None so far from the chain's end or nearer: `inside` [LU].
    """
    pairs, half = case.exact(), 0.5 * (case.particles - 1) - inside
    if case.profile["kind"] == "flat_punch":
        return dict.fromkeys(places, 0.5 * case.particles)
    gap = float(pairs.gap(LAW.extremum_distance(1)))
    if pairs.fold is not None:
        gap = min(gap, pairs.fold.gap_on) if joining else pairs.fold.gap_off
    found = {}
    for name, place in places.items():
        height = gap - LAW.force_free_distance() + place
        radius = _inverse(case.profile, height)
        if (inside or radius > 0.0) and radius < half:
            found[name] = radius
    return found


def _inverse(profile: dict[str, Any], height: float) -> float:
    """The place [LU] at which a profile is `height` [LU] above its apex."""
    if height <= 0.0:
        return 0.0
    match profile["kind"]:
        case "parabola":
            return math.sqrt(2.0 * float(profile["radius"]) * height)
        case "cone":
            return height / float(profile["slope"])
    return float(profile["radius"]) * math.pow(height / float(profile["height"]), 1.0 / float(profile["exponent"]))


SHARP = Study(
    NAME,
    "Random sharp scenes",
    "With few particles and pairs about to snap a search may find the wrong force maximum. Is every result of a "
    "hundred random scenes within its uncertainty?",
    measure,
)
