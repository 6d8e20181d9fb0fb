"""Claim: particles snap, and loading and unloading differ, where the springs are softer than the contact.

Reference: `folded_pairs` of validation, the undeformed gap G(r) = r − 2 f(r)/k, which folds where f′ > k/2: there
the curve depends on the path. Below, r(G) is unique, and so is F(d). Between the branches lies an energy ∮F dd: n
independent pairs lose n times the area between the fold's two jumps.

What limits the tolerance: for stiff springs the residual force at which a minimisation stops. For soft ones the area is
a sum of trapezia over rows between which particles jump; a jump is missed by half an increment on average.
"""

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Run, run
from tests.scenes import chains
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import PairInteraction

Array = NDArray[np.float64]

COINCIDE = 1e-5
"""Force between the branches over the largest tension; measured 1e-7: residual forces."""
DIFFER = 0.5
"""The same for springs of a quarter of the critical stiffness; measured 0.97."""
AREA = 0.01
"""Relative, of the energy lost in a round; measured 2e-3: some thirty particles jump, each up to an increment late."""
NOTHING = 1e-3
"""Claimed for an area that is none, over the work of the way there: residual forces and what the table leaves."""
LAW = (0.0024, 0.015, 0.0012, 0.03)
"""Ranges short against the spacing, so that every particle feels its opposite alone."""
RADIUS, DEEPEST = 500.0, 0.1


def pairs(stiffness: float, places: Array) -> FoldedPairs:
    law = PairInteraction.of(*LAW)
    return FoldedPairs(law, stiffness, places**2 / (2.0 * RADIUS))


CRITICAL_STIFFNESS = pairs(1.0, np.zeros(1)).ratio
"""Bulk stiffness below which a pair folds [FU/LU]."""


def round_trip(stiffness: float, lowest: float, steps: int) -> tuple[Run, Array, Array, Array]:
    """A closed path: displacements, rising, and the forces at these in loading and unloading."""
    displacements = {"from": lowest, "to": DEEPEST, "steps": steps, "return": True}
    path = {"kind": "path", "method": "quasistatic", "displacements": displacements}
    done = run(chains(RADIUS, stiffness, LAW, experiment=path))
    there, back = (done.curve.branch == name for name in ("loading", "unloading"))
    d, force = done.curve.displacement, done.curve.force
    assert d[there][:-1] == pytest.approx(d[back][::-1], abs=1e-12)
    return done, d[there], force[there], np.append(force[back][::-1], force[there][-1])


def test_stiff_springs_have_one_curve() -> None:
    done, d, there, back = round_trip(1.2 * CRITICAL_STIFFNESS, -0.15, 10)
    energy = done.results.dissipated_energy
    assert np.abs(there - back).max() < COINCIDE * -back.min()
    assert abs(energy.value) <= energy.uncertainty < NOTHING * np.trapezoid(np.abs(there), d)


def test_soft_springs_have_two() -> None:
    """And the energy between the curves is that of the particles that snapped on and off again."""
    stiffness = 0.25 * CRITICAL_STIFFNESS
    done, d, there, back = round_trip(stiffness, -0.4, 100)
    lost, energy = pairs(stiffness, done.profiles["deepest"].x).loop_area(DEEPEST), done.results.dissipated_energy
    assert np.all(there - back > -COINCIDE * -back.min())
    assert (there - back).max() > DIFFER * -back.min()
    assert np.trapezoid(there - back, d) == pytest.approx(lost, rel=AREA)
    assert energy.unit == "FU·LU"
    assert energy.value == pytest.approx(lost, rel=AREA)
    assert abs(energy.value - lost) <= energy.uncertainty < 0.1 * energy.value
