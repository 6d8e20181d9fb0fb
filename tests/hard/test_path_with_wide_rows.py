"""Claim: where pairs snap, a path has the same states whether its rows are narrow or as wide as the range.

Reference: `tests.pair_lattice`, each pair with its folds, at the same displacements; and the energy lost
in a round, one loop for each pair that snaps.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import read_scene, run
from tests.pair_lattice import PairLattice
from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.references.interaction import Exponential, PairInteraction

RANGE = 0.03
LAW = PairInteraction(Exponential(0.0024, 0.015), Exponential(0.0012, RANGE))
TOLERANCE = 1e-3
ROWS = 2e-3
"""Largest difference of a force from the reference's over the largest; measured 1e-4: the law's tail, residuals."""
AREA = 1e-3
"""Of the loop over the same rows; measured 1e-4."""
DEEPEST = 0.1
BEFORE = 1e-3
"""A row over the range, before the snap."""


def scene(ratio: float, wide: float, method: str = "quasistatic") -> dict[str, Any]:
    stiffness = 2.0 * float(LAW.force_slope(LAW.extremum_distance(2))) / ratio
    pair = PairLattice(LAW, stiffness, np.zeros(1))
    steps = round((DEEPEST + pair.snap_off + 2.0 * RANGE) / (wide * RANGE)) + 1
    return {
        "title": f"{ratio}, rows {wide}",
        "bodies": {
            "particles": 20, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0},
            "bulk_stiffness": stiffness,
        },
        "interaction": {
            "repulsion": {"amplitude": 0.0024, "range": 0.015}, "attraction": {"amplitude": 0.0012, "range": RANGE},
        },
        "accuracy": {"tolerance": TOLERANCE},
        "experiment": {
            "kind": "path", "method": method,
            "displacements": {"from": DEEPEST - steps * wide * RANGE, "to": DEEPEST, "steps": steps, "return": True},
        },
    }  # fmt: skip


@pytest.mark.parametrize(("ratio", "wide"), [(1.2, 0.5), (1.2, 3.0), (6.0, 3.0)])
def test_every_row_is_on_its_branch(tmp_path: Path, ratio: float, wide: float) -> None:
    asked = read_scene(scene(ratio, wide))
    states = run(asked, tmp_path, figures=False).outcome.states
    pairs = PairLattice(LAW, float(asked.bulk_stiffness), asked.bodies.height(states[0].profile.x))
    stuck = pairs.stuck_after(DEEPEST)
    d, force = (np.array([getattr(state, name) for state in states]) for name in ("displacement", "force"))
    exact = np.array([
        pairs.force(s.displacement, pairs.stuck_after(s.displacement) if s.phase == "loading" else stuck)
        for s in states
    ])  # fmt: skip
    assert np.abs(force - exact).max() < ROWS * np.abs(exact).max()
    loop, true = np.trapezoid(force, d), np.trapezoid(exact, d)
    assert abs(loop - true) < AREA * np.trapezoid(np.abs(exact), d[0] + np.cumsum(np.abs(np.diff(d, prepend=d[0]))))


@pytest.mark.parametrize(
    ("kind", "particles", "ratio", "steps"),
    [("power", 3, 0.94, 33), ("flat_punch", 6, 0.74, 33)],
)
def test_a_sharp_maximum_between_two_rows_is_within_the_claim(
    kind: str, particles: int, ratio: float, steps: int, tmp_path: Path
) -> None:
    """Polynomials through wide rows agree with each other by chance: the claim was up to 460 times too small."""
    case = PairCase("rows", ratio, shaped(kind, particles, 1.5 * reach(ratio)), particles, TENSION, 1e-3)
    pairs = case.exact()
    way = {"from": -reach(ratio), "to": pairs.deepest(TENSION), "steps": steps}
    scene = read_scene({"title": "rows"} | case.scene() | {"experiment": {"kind": "path", "displacements": way}})
    found = run(scene, tmp_path / "run", figures=False).results.adhesion_force
    exact, _ = pairs.adhesion(TENSION)
    assert abs(found.value - exact) <= found.uncertainty
    assert found.uncertainty <= 0.5 * exact


@pytest.mark.parametrize(("ratio", "wide"), [(3.0, 0.1), (10.0, 1.0)])
def test_pairs_that_are_drawn_apart_hold_until_their_snap(ratio: float, wide: float, tmp_path: Path) -> None:
    """A body that is moved with its particles puts a pair behind the top that still holds it: up to 2 % of a range."""
    case = PairCase("hold", ratio, shaped("flat_punch", 3, 0.0), 3, 0.0, TOLERANCE)
    pairs = case.exact()
    assert pairs.fold is not None
    off = pairs.interaction.force_free_distance() - pairs.fold.gap_off
    rows = [off + BEFORE * RANGE + i * wide * RANGE for i in range(6)]
    scene = {"title": "hold"} | case.scene() | {"experiment": {"kind": "path", "displacements": [DEEPEST, *rows[::-1]]}}
    held = run(scene, tmp_path / "run", figures=False).curve.force[-1]
    assert held == pytest.approx(float(pairs.unloading(np.array([rows[0]]), DEEPEST)[0]), rel=ROWS)


@pytest.mark.parametrize(("ratio", "first"), [(2.0, -0.05), (2.0, 0.02), (8.0, -0.02)])
def test_a_path_begins_on_the_branch_that_the_scene_names(ratio: float, first: float, tmp_path: Path) -> None:
    """From afar, or with start = "contact" back from the largest displacement: pairs have two states between."""
    case = PairCase("start", ratio, shaped("parabola", 40, reach(ratio)), 40, 0.0)
    deepest, exact = 0.06, case.exact()
    states = {"approach": exact.loading(first), "contact": exact.unloading(first, deepest)}
    top, found = max(abs(float(one)) for one in states.values()), {}
    for start, force in states.items():
        path = {"kind": "path", "displacements": [first, 0.5 * (first + deepest), deepest], "start": start}
        done = run(case.scene() | {"title": start, "experiment": path}, tmp_path / start, figures=False)
        found[start] = float(done.curve.force[0])
        assert done.curve.displacement == pytest.approx(path["displacements"], abs=1e-12)
        assert found[start] == pytest.approx(float(force), abs=1e-3 * top)
    assert abs(found["approach"] - found["contact"]) > 0.05 * top
