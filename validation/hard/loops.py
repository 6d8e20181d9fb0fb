"""Loops of contacts that snap: the force at every row of a path, where particles snap, the area, and the path's F_A."""

from __future__ import annotations

import math

import numpy as np

from validation.doors import Run
from validation.hard.cases import ATTRACTION, PairCase, reach, shaped
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats
from validation.row import Reference, Row, absolute, at_most
from validation.study import Bench, Findings, Refused, Study, over_claim, said

NAME = "loops"
RATIOS, FULL_RATIOS = (1.5, 10.0), (1.1, 1.5, 3.0, 10.0, 30.0)
DEEPEST = 0.01
"""[LU]"""
WIDTHS = {"as wide as the range": 1.0, "a tenth of the range": 0.1}
"""Rows of the path over the longest range."""
KIND, PARTICLES = "parabola", 21
FORCE = 1e-3
"""Of the largest force: the tolerance of the scene."""
PUNCH, SHARP, SIDE = 3, 1e-4, 0.01
"""Equal pairs, the tolerance at which their snaps are looked at, and how near over the longest range."""
NEAR = 1e-3
"""A row this near to a snap, over the width of a row, may be on either side of it."""


def measure(bench: Bench) -> Findings:
    """Both widths of rows for each ratio."""
    checks: list[Row] = []
    for ratio in FULL_RATIOS if bench.full else RATIOS:
        case = PairCase("path", ratio, shaped(KIND, PARTICLES, reach(ratio)), PARTICLES, 0.0)
        pairs = case.exact()
        fold = pairs.fold
        assert fold is not None
        lowest = -(max(fold.gap_off, fold.gap_on) + 2.0 * ATTRACTION[1])
        for words, width in WIDTHS.items():
            steps = round((DEEPEST - lowest) / (width * ATTRACTION[1]))
            way = {"from": lowest, "to": DEEPEST, "steps": steps}
            scene = case.scene() | {"experiment": {"kind": "path", "displacements": way}}
            found = bench.run(f"path_{ratio:g}_{width:g}", scene)
            checks += _rows(f"ratio {ratio:g}, rows {words}", found, pairs)
        checks.append(_beside_snaps(bench, ratio))
    return Findings(checks)


def _beside_snaps(bench: Bench, ratio: float) -> Row:
    """Equal pairs at rows just before and just behind each of their two snaps, there and back."""
    case = PairCase("snaps", ratio, shaped("flat_punch", PUNCH, 0.0), PUNCH, 0.0, SHARP)
    pairs = case.exact()
    assert pairs.fold is not None
    off, on = (pairs.interaction.force_free_distance() - gap for gap in (pairs.fold.gap_off, pairs.fold.gap_on))
    side = SIDE * ATTRACTION[1]
    there = [off - 2.0 * ATTRACTION[1], off - side, off + side, on - side, on + side, max(on, 0.0) + DEEPEST]
    scene = case.scene() | {"experiment": {"kind": "path", "displacements": [*there, *there[-2::-1]]}}
    found = bench.run(f"snaps_{ratio:g}", scene)
    value = math.nan
    if not isinstance(found, Refused):
        d, force = np.asarray(found.curve.displacement), np.asarray(found.curve.force)
        exact = np.concatenate([pairs.loading(d[:6]), pairs.unloading(d[6:], there[-1])])
        value = float(np.max(np.abs(force - exact))) / float(np.max(np.abs(exact)))
    name = f"force off over the largest, worst row {SIDE:g} of the range beside snap-in and snap-off, ratio {ratio:g}"
    return at_most(name, value, SHARP, "independent pairs with their folds", said("where a pair snaps", found))


def _rows(words: str, found: Run | Refused, pairs: FoldedPairs) -> list[Row]:
    source = "independent pairs with their folds"
    if isinstance(found, Refused):
        return [at_most(f"path, {words}", float("nan"), 0.0, source, said("–", found))]
    curve = found.curve
    d, force = np.asarray(curve.displacement), np.asarray(curve.force)
    back = int(np.argmax(d)) + 1
    exact = np.concatenate([pairs.loading(d[:back]), pairs.unloading(d[back:], DEEPEST)])
    scale = float(np.max(np.abs(exact)))
    sure = _snap_distance(d, pairs) >= NEAR * abs(float(d[1] - d[0]))
    off = float(np.max(np.abs(force - exact)[sure])) / scale
    area, true = (
        float(np.trapezoid(values[:back], d[:back]) + np.trapezoid(values[back - 1 :], d[back - 1 :]))
        for values in (force, exact)
    )
    rows = [
        at_most(f"force off over the largest, worst row, {words}", off, FORCE, source, "the tolerance asked for"),
        Row(
            f"dissipated energy, {words}",
            area,
            Reference(true, source + ", at the same rows"),
            absolute(
                FORCE * max(abs(true), scale * abs(float(d[1] - d[0]))),
                "the tolerance asked for, of the area or, where rows miss the loop, of a force over a row",
            ),
            unit="FU·LU",
        ),
    ]
    if "adhesion_force" in found.results:
        largest = -float(np.min(pairs.unloading(np.linspace(float(d[-1]), DEEPEST, 20000), DEEPEST)))
        over = over_claim(found, "adhesion_force", largest)
        rows.append(at_most(f"F_A of the path off over its claim, {words}", over, 1.0, source, "what is claimed"))
    return rows


def _snap_distance(d: Floats, pairs: FoldedPairs) -> Floats:
    """How far [LU] each row is from a snap of a pair: too near, it may be on either side."""
    assert pairs.fold is not None
    places = np.concatenate(
        [
            pairs.interaction.force_free_distance() + pairs.heights - gap
            for gap in (pairs.fold.gap_on, pairs.fold.gap_off)
        ]
    )
    return np.asarray(np.min(np.abs(d[:, None] - places[None, :]), axis=1))


LOOPS = Study(
    NAME,
    "Snap-in, snap-off and the dissipated energy",
    "A path with load steps as wide as the range passes the instabilities: if particles are then in the wrong "
    "state, the force and the dissipated energy are wrong without notice.",
    measure,
)
