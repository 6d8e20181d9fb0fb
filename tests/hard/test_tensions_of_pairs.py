"""Claim: where pairs snap, or nearly do, F_A is that of the highest force maximum, within its uncertainty.

Reference: `folded_pairs` of validation, each pair inverted with its folds, unloaded from the run's deepest state. A
"ratio" is a pair's greatest negative stiffness over its springs in series: towards 1, F(d) has a maximum for each pair
that separates, as narrow as (1 - ratio)^(3/2) ranges. Above it pairs snap: between a maximum and the next the
force of a sharp body passes 0, and soft springs follow the attraction far out.

A dynamic tension within the tolerance of F_A is held with a warning, and one beyond it is not held at all.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import RunError, read_scene, run
from tests.scenes import chains
from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import PairInteraction

NUMBERS = (0.011, 0.015, 0.01, 0.03)
LAW = PairInteraction.of(*NUMBERS)
"""Short against the spacing, so that a particle feels its opposite alone."""
PROFILES: dict[str, dict[str, Any]] = {
    "flat punch": {"kind": "flat_punch", "radius": 5.0},
    "blunt": {"kind": "parabola", "radius": 1000.0},
    "sharp": {"kind": "parabola", "radius": 50.0},
    "very sharp": {"kind": "parabola", "radius": 10.0},
    "cone": {"kind": "cone", "slope": 0.02},
    "power": {"kind": "power", "exponent": 4.0, "radius": 30.0, "height": 0.5},
}
PRELOAD = 0.19
NARROW_CLAIM = 1e-6
"""Least claim that is looked at, over the force: the reference's law has no cutoff and no table."""
CARRIED = 1e-3
"""Relative difference of F_A where the highest maximum carries the tension; measured 4e-5 and 1e-6."""
BESIDE, EVEN = 7, 2.0
"""Load steps on either side of the maximum, and the ratio of the ways that they take; one of them is the maximum."""
APART = 0.03
"""Tension over F_A of bodies that are pulled apart."""
SLOW = [("flat punch", 30.0), ("cone", 1.05), ("sharp", 1.05), ("sharp", 3.0), ("cone", 3.0)]
CASES = [
    ("blunt", 0.999, 1e-4), ("power", 0.999, 1e-4), ("flat punch", 3.0, 1e-2),
    *(pytest.param(name, ratio, 1e-2, marks=pytest.mark.slow) for name, ratio in SLOW),
]  # fmt: skip


@pytest.mark.parametrize(("profile", "ratio", "tolerance"), CASES)
def test_adhesion_force_is_that_of_the_highest_maximum(profile: str, ratio: float, tolerance: float) -> None:
    stiffness = 2.0 * float(LAW.force_slope(LAW.extremum_distance(2))) / ratio
    asked = read_scene(chains(
        1.0, stiffness, NUMBERS, bodies={"profile": PROFILES[profile], "reduction": "geike_popov"},
        accuracy={"tolerance": tolerance}, experiment={"kind": "pull_off", "preload": PRELOAD},
    ))  # fmt: skip
    done = run(asked)
    pairs = FoldedPairs(LAW, stiffness, asked.bodies.height(done.profiles["zero_load"].x))
    assert pairs.ratio == pytest.approx(ratio)
    d, force = done.curve.displacement, done.curve.force
    deepest = d[done.curve.branch == "loading"][-1]
    exact, _ = pairs.adhesion(float(pairs.loading(deepest)))
    found = done.results.adhesion_force
    assert abs(found.value - exact) <= max(found.uncertainty, NARROW_CLAIM * exact)
    assert abs(found.value - exact) <= tolerance * exact or {"uncertain", "tolerance"} & set(done.warnings)
    if ratio > 1.0:
        assert -force.min() <= found.value + found.uncertainty
        assert abs(force[-1]) <= APART * found.value
        places = np.unique(d)
        top = int(np.searchsorted(places, d[force.argmin()]))
        before, after = places[top] - places[max(0, top - BESIDE)], places[top + BESIDE] - places[top]
        assert before <= EVEN * after


def test_a_tension_in_time_is_carried_by_the_next_maximum_where_pairs_nearly_snap() -> None:
    """With the drag of a smooth contact the plate swung past it: 1.5 % too small, 270 times the claim."""
    case = PairCase("maximum", 0.99, shaped("parabola", 21, reach(0.99)), 21, 1.5 * TENSION, 1e-4, dynamic=True)
    exact, _ = case.pairs.adhesion(case.preload)
    found = run({"title": "maximum"} | case.scene()).results.adhesion_force
    assert abs(found.value - exact) <= min(found.uncertainty, CARRIED * exact)


TOLERANCE, PARTICLES, RADIUS, STIFFNESS = 1e-3, 40, 100.0, 0.83
NEAR = (0.018, 0.03, 0.009, 0.06)


def largest_tension() -> float:
    x = np.arange(PARTICLES) - 0.5 * (PARTICLES - 1)
    law = PairInteraction.of(*NEAR)
    pairs = FoldedPairs(law, STIFFNESS, x**2 / (2.0 * RADIUS))
    return pairs.adhesion(float(pairs.loading(0.05)))[0]


@pytest.mark.parametrize("share", [0.99999, 1.0 + 2.0 * TOLERANCE])
def test_a_tension_in_time_is_doubted_near_the_pull_off_force_and_lost_beyond_it(share: float, tmp_path: Path) -> None:
    tables = chains(
        RADIUS, STIFFNESS, NEAR, bodies={"particles": PARTICLES}, damping={"coefficient": "auto"}, plate={},
        accuracy={"tolerance": TOLERANCE},
        experiment={"kind": "load", "method": "dynamic", "force": -share * largest_tension()},
    )  # fmt: skip
    if share > 1.0:
        with pytest.raises(RunError, match="does not sustain"):
            run(tables, tmp_path, figures=False)
    else:
        assert "near_pull_off" in run(tables).warnings
