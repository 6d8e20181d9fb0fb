"""Loops of contacts that snap: the force at every row of a path, where particles snap, the area, and the path's F_A."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from validation.doors import Run
from validation.hard.cases import ATTRACTION, LAW, PAIRS, PairCase, reach, shaped
from validation.hard.units import Scene
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats
from validation.row import Reference, Row, absolute, at_most
from validation.study import Bench, Findings, Refused, Study, claim_row, said

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
    rows: list[Row] = []
    for ratio in FULL_RATIOS if bench.full else RATIOS:
        case = PairCase("path", ratio, shaped(KIND, PARTICLES, reach(ratio)), PARTICLES)
        fold = case.pairs.fold
        assert fold is not None
        lowest = -(max(fold.gap_off, fold.gap_on) + 2.0 * ATTRACTION[1])
        for words, width in WIDTHS.items():
            way = {"from": lowest, "to": DEEPEST, "steps": round((DEEPEST - lowest) / (width * ATTRACTION[1]))}
            run = bench.run(f"path_{ratio:g}_{width:g}", _scene(case, way))
            rows += _rows(f"ratio {ratio:g}, rows {words}", run, case.pairs)
        rows.append(_beside_snaps(bench, ratio))
    return Findings(rows)


def _scene(case: PairCase, way: Any) -> Scene:
    return case.scene() | {"experiment": {"kind": "path", "displacements": way}}


def _columns(run: Run, pairs: FoldedPairs) -> tuple[Floats, Floats, Floats, int]:
    """Displacements, forces, those of the pairs, and how many rows there are until the deepest."""
    d, force = np.asarray(run.curve.displacement), np.asarray(run.curve.force)
    back = int(np.argmax(d)) + 1
    exact = np.concatenate([pairs.loading(d[:back]), pairs.unloading(d[back:], float(d.max()))])
    return d, force, exact, back


def _beside_snaps(bench: Bench, ratio: float) -> Row:
    """Equal pairs at rows just before and just behind each of their two snaps, there and back."""
    case = PairCase("snaps", ratio, shaped("flat_punch", PUNCH, 0.0), PUNCH, 0.0, SHARP)
    fold, side, value = case.pairs.fold, SIDE * ATTRACTION[1], math.nan
    assert fold is not None
    off, on = (LAW.force_free_distance() - gap for gap in (fold.gap_off, fold.gap_on))
    there = [off - 2.0 * ATTRACTION[1], off - side, off + side, on - side, on + side, max(on, 0.0) + DEEPEST]
    run = bench.run(f"snaps_{ratio:g}", _scene(case, [*there, *there[-2::-1]]))
    if not isinstance(run, Refused):
        _, force, exact, _ = _columns(run, case.pairs)
        value = float(np.max(np.abs(force - exact)) / np.max(np.abs(exact)))
    name = f"force off over the largest, worst row {SIDE:g} of the range beside snap-in and snap-off, ratio {ratio:g}"
    return at_most(name, value, SHARP, PAIRS, said("where a pair snaps", run))


def _rows(words: str, run: Run | Refused, pairs: FoldedPairs) -> list[Row]:
    if isinstance(run, Refused):
        return [at_most(f"path, {words}", math.nan, 0.0, PAIRS, said("–", run))]
    d, force, exact, back = _columns(run, pairs)
    scale, width = float(np.max(np.abs(exact))), abs(float(d[1] - d[0]))
    sure = _snap_distance(d, pairs) >= NEAR * width
    off = float(np.max(np.abs(force - exact)[sure])) / scale
    area, true = (
        float(np.trapezoid(values[:back], d[:back]) + np.trapezoid(values[back - 1 :], d[back - 1 :]))
        for values in (force, exact)
    )
    limit = "the tolerance asked for, of the area or, where rows miss the loop, of a force over a row"
    rows = [
        at_most(f"force off over the largest, worst row, {words}", off, FORCE, PAIRS, "the tolerance asked for"),
        Row(f"dissipated energy, {words}", area, Reference(true, f"{PAIRS}, at the same rows"),
            absolute(FORCE * max(abs(true), scale * width), limit), unit="FU·LU"),
    ]  # fmt: skip
    if "adhesion_force" in run.results:
        largest = -float(np.min(pairs.unloading(np.linspace(float(d[-1]), DEEPEST, 20000), DEEPEST)))
        rows.append(claim_row(f"F_A of the path off over its claim, {words}", run, "adhesion_force", largest, PAIRS))
    return rows


def _snap_distance(d: Floats, pairs: FoldedPairs) -> Floats:
    """How far [LU] each row is from a snap of a pair: too near, it may be on either side."""
    assert pairs.fold is not None
    gaps = np.array([[pairs.fold.gap_on], [pairs.fold.gap_off]])
    places = (LAW.force_free_distance() + pairs.heights - gaps).ravel()
    return np.asarray(np.min(np.abs(d[:, None] - places), axis=1))


LOOPS = Study(
    "loops",
    "Snap-in, snap-out and the dissipated energy",
    "A path with load steps as long as the range of the interaction passes the instabilities: if particles are then "
    "in the wrong state, the force and the dissipated energy are wrong without a warning.",
    measure,
)
