"""Claim: particles snap, and loading and unloading differ, where the springs are softer than the contact.

Reference (physics.md): a pair's undeformed gap is G(r) = r − 2 f(r)/k. Where f′ exceeds k/2 somewhere, G(r) falls back
on itself, a particle jumps, and the curve depends on the way; below, r(G) is unique, and so is F(d). The largest f′ of
V(r) = A exp(−r/a) − B exp(−r/b) lies at exp(−r/a + r/b) = (B a³)/(A b³) and is known in closed form. Between the
branches lies an energy ∮F dd: for independent pairs n particles lose n times the area between the fold's two jumps.

What limits the tolerance: for stiff springs the residual force at which a minimisation stops. For soft ones the area is
a sum of trapezia over rows between which particles jump; a jump is missed by half an increment on average.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.optimize import brentq

from contact1d import Run
from contact1d.workflow.continuation.state import State
from contact1d.workflow.units import Quantity
from tests.scenes import chains

RunTables = Callable[[dict[str, Any]], Run]
Array = NDArray[np.float64]

COINCIDE = 1e-5
"""Force between the branches over the largest tension; measured 1e-7: residual forces."""
DIFFER = 0.5
"""The same for springs of a quarter of the critical stiffness; measured 0.97."""
AREA = 0.01
"""Relative, of the energy lost in a round; measured 2e-3: some thirty particles jump, each up to an increment late."""
NOTHING = 1e-3
"""Claimed for an area that is none, over the work of the way there: residual forces and what the table leaves."""
A, RANGE_A, B, RANGE_B = 0.0024, 0.015, 0.0012, 0.03
"""Ranges short against the spacing, so that every particle feels its opposite alone."""


def force(r: Array | float) -> Array:
    """f(r) [FU], repulsion positive; [LU]."""
    return np.asarray(A / RANGE_A * np.exp(-np.asarray(r) / RANGE_A) - B / RANGE_B * np.exp(-np.asarray(r) / RANGE_B))


def steepness(r: float) -> float:
    """f′(r) [FU/LU]."""
    return float(-A / RANGE_A**2 * np.exp(-r / RANGE_A) + B / RANGE_B**2 * np.exp(-r / RANGE_B))


STEEPEST_PLACE = float(np.log(A * RANGE_B**3 / (B * RANGE_A**3)) / (1.0 / RANGE_A - 1.0 / RANGE_B))
CRITICAL_STIFFNESS = 2.0 * steepness(STEEPEST_PLACE)
"""Bulk stiffness below which a pair folds [FU/LU]."""


@dataclass(frozen=True)
class Fold:
    """Jumps of one pair: undeformed gaps at which it jumps on and off, and the area between the ways [FU·LU]."""

    on: float
    off: float
    area: float


def fold(stiffness: float) -> Fold:
    """The two places where dG/dr = 0, and ∮ f dG, since a pair passes its force on to its bulk."""

    def gap(r: float) -> float:
        return r - 2.0 * float(force(r)) / stiffness

    def slope(r: float) -> float:
        return 1.0 - 2.0 * steepness(r) / stiffness

    # G(r) rises to its maximum (off, coming from contact), falls to its minimum (on, coming from far), and rises again.
    near = float(brentq(slope, 0.2 * STEEPEST_PLACE, STEEPEST_PLACE))
    far = float(brentq(slope, STEEPEST_PLACE, 1.0))
    off, on = gap(near), gap(far)
    beyond = float(brentq(lambda r: gap(r) - off, far, 2.0))
    before = float(brentq(lambda r: gap(r) - on, 0.0, near))

    def work(start: float, end: float) -> float:
        return float(quad(lambda r: float(force(r)) * slope(r), start, end, epsabs=1e-14)[0])

    return Fold(on, off, work(far, beyond) - work(before, near))


def round_trip(
    run_tables: RunTables, stiffness: float, lowest: float, steps: int
) -> tuple[list[State], list[State], Quantity]:
    """Loading and unloading states of a path there and back, both by rising displacement, and what it dissipates."""
    displacements = {"from": lowest, "to": 0.1, "steps": steps, "return": True}
    path = {"kind": "path", "method": "quasistatic", "displacements": displacements}
    outcome = run_tables(chains(500.0, stiffness, (A, RANGE_A, B, RANGE_B), experiment=path)).outcome
    states = outcome.states
    loading = [state for state in states if state.phase == "loading"]
    unloading = [state for state in states if state.phase == "unloading"]
    return loading, [*unloading[::-1], loading[-1]], outcome.quantities["dissipated_energy"]


def test_stiff_springs_have_one_curve(run_tables: RunTables) -> None:
    loading, unloading, energy = round_trip(run_tables, 1.2 * CRITICAL_STIFFNESS, -0.15, 20)
    there, back = (np.array([state.force for state in branch]) for branch in (loading, unloading))
    assert [s.displacement for s in loading] == pytest.approx([s.displacement for s in unloading], abs=1e-12)
    assert np.abs(there - back).max() < COINCIDE * -back.min()
    assert abs(energy.value) <= energy.uncertainty
    assert energy.uncertainty < NOTHING * np.trapezoid(np.abs(there), [s.displacement for s in loading])


def test_soft_springs_have_two(run_tables: RunTables) -> None:
    """And the energy between the curves is that of the particles that snapped on and off again."""
    stiffness = 0.25 * CRITICAL_STIFFNESS
    pair = fold(stiffness)
    assert pair.off > pair.on
    loading, unloading, energy = round_trip(run_tables, stiffness, -0.4, 160)
    d = np.array([state.displacement for state in loading])
    there, back = (np.array([state.force for state in branch]) for branch in (loading, unloading))
    assert np.all(there - back > -COINCIDE * -back.min())
    assert (there - back).max() > DIFFER * -back.min()
    x = loading[-1].profile.x
    rest = float(np.log(A * RANGE_B / (B * RANGE_A)) / (1.0 / RANGE_A - 1.0 / RANGE_B))
    snapped = np.count_nonzero(rest + x**2 / 1000.0 - d[-1] < pair.on)
    assert np.trapezoid(there - back, d) == pytest.approx(snapped * pair.area, rel=AREA)
    assert energy.unit == "FU·LU"
    assert energy.value == pytest.approx(snapped * pair.area, rel=AREA)
    assert abs(energy.value - snapped * pair.area) <= energy.uncertainty < 0.1 * energy.value
