"""Claim: where pairs snap, a path has the same states whether its rows are narrow or as wide as the range.

Reference: `folded_pairs` of validation, each pair with its folds, at the same displacements; and the energy lost
in a round, one loop for each pair that snaps.
"""

from typing import Any

import numpy as np
import pytest

from contact1d import Run, run
from tests.scenes import chains
from validation.hard.cases import LAW as CASES_LAW
from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import PairInteraction

RANGE = 0.03
NUMBERS = (0.0024, 0.015, 0.0012, RANGE)
LAW = PairInteraction.of(*NUMBERS)
RADIUS, COUNT = 100.0, 20
ROWS = 1e-3
"""Largest difference of a force from the reference's over the largest; measured 1e-4: the law's tail, residuals."""
AREA = 1e-3
"""Of the loop over the same rows; measured 1e-4."""
DEEPEST = 0.1
SHARP, BESIDE = 1e-4, 0.01
"""The tolerance, and bound, where snaps are looked at, and how near rows are to them over the range."""


@pytest.mark.parametrize(("ratio", "wide"), [(1.5, 1.0), (6.0, 3.0), pytest.param(30.0, 1.0, marks=pytest.mark.slow)])
def test_every_row_is_on_its_branch(ratio: float, wide: float) -> None:
    stiffness = 2.0 * float(LAW.force_slope(LAW.extremum_distance(2))) / ratio
    places = np.arange(COUNT) - 0.5 * (COUNT - 1)
    pairs = FoldedPairs(LAW, stiffness, places**2 / (2.0 * RADIUS))
    assert pairs.fold is not None
    steps = round((DEEPEST + pairs.fold.gap_off + 2.0 * RANGE) / (wide * RANGE)) + 1
    way = {"from": DEEPEST - steps * wide * RANGE, "to": DEEPEST, "steps": steps, "return": True}
    path = {"kind": "path", "displacements": way}
    found = run(chains(RADIUS, stiffness, NUMBERS, bodies={"particles": COUNT}, experiment=path)).curve
    d, force = found.displacement, found.force
    exact = np.array([
        float(pairs.loading(place) if phase == "loading" else pairs.unloading(place, DEEPEST))
        for place, phase in zip(d, found.branch, strict=True)
    ])  # fmt: skip
    assert np.abs(force - exact).max() < ROWS * np.abs(exact).max()
    loop, true = np.trapezoid(force, d), np.trapezoid(exact, d)
    assert abs(loop - true) < AREA * np.trapezoid(np.abs(exact), d[0] + np.cumsum(np.abs(np.diff(d, prepend=d[0]))))


def path_of(case: PairCase, **path: Any) -> Run:
    tables = {"title": "rows"} | case.scene() | {"experiment": {"kind": "path"} | path}
    return run(tables)


@pytest.mark.parametrize("ratio", [1.1, 10.0])
def test_pairs_snap_between_two_rows_just_beside_it(ratio: float) -> None:
    """Equal pairs, just before and just behind where they snap on and off, there and back."""
    case = PairCase("snaps", ratio, shaped("flat_punch", 3, 0.0), 3, 0.0, SHARP)
    pairs, side = case.pairs, BESIDE * RANGE
    assert pairs.fold is not None
    off, on = (CASES_LAW.force_free_distance() - gap for gap in (pairs.fold.gap_off, pairs.fold.gap_on))
    there = [off - 2.0 * RANGE, off - side, off + side, on - side, on + side, max(on, 0.0) + 0.01]
    found = path_of(case, displacements=[*there, *there[-2::-1]]).curve.force
    exact = [*pairs.loading(np.array(there)), *pairs.unloading(np.array(there[-2::-1]), there[-1])]
    assert found == pytest.approx(exact, abs=SHARP * np.abs(exact).max())


def test_a_sharp_maximum_between_two_rows_is_within_the_claim() -> None:
    """Polynomials through wide rows agree with each other by chance: the claim was up to 460 times too small."""
    ratio = 0.74
    case = PairCase("rows", ratio, shaped("flat_punch", 6, 1.5 * reach(ratio)), 6, TENSION, 1e-3)
    pairs = case.pairs
    way = {"from": -reach(ratio), "to": pairs.deepest(TENSION), "steps": 33}
    found = path_of(case, displacements=way).results.adhesion_force
    exact, _ = pairs.adhesion(TENSION)
    assert abs(found.value - exact) <= found.uncertainty <= 0.5 * exact


def test_a_path_begins_on_the_branch_that_the_scene_names() -> None:
    """From afar, or with start = "contact" back from the largest displacement: pairs have two states between."""
    ratio, first = 8.0, -0.02
    case = PairCase("start", ratio, shaped("parabola", 40, reach(ratio)), 40, 0.0)
    deepest, exact = 0.06, case.pairs
    states = {"approach": exact.loading(first), "contact": exact.unloading(first, deepest)}
    top, found = max(abs(float(one)) for one in states.values()), {}
    for start, force in states.items():
        rows = [first, 0.5 * (first + deepest), deepest]
        done = path_of(case, displacements=rows, start=start).curve
        found[start] = float(done.force[0])
        assert done.displacement == pytest.approx(rows, abs=1e-12)
        assert found[start] == pytest.approx(float(force), abs=1e-3 * top)
    assert abs(found["approach"] - found["contact"]) > 0.05 * top
