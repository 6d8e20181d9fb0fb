"""Pairs that snap in closed form, against what is known without them, and against the Newton solver."""

from __future__ import annotations

import numpy as np
import pytest

from validation.references.boltzmann_pairs import BoltzmannPairs
from validation.references.folded_pairs import FoldedPairs
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import trace

LAW = PairInteraction(Exponential(0.011, 0.015), Exponential(0.01, 0.03))
STEEPEST = float(LAW.force_slope(np.array(LAW.extremum_distance(2))))
TENSION = -float(LAW.force(np.array(LAW.extremum_distance(1))))
HEIGHTS = (np.arange(21) - 10.0) ** 2 / 200.0
EXACT = 1e-8
"""Relative: minimum found by looks 1e-9 of the range apart; integrals; the solver's residual."""
KT, THERMAL = 2e-7, 3e-3
"""A low temperature [FU LU], and by how much over the range the anharmonic share then moves d."""


@pytest.mark.parametrize("ratio", [0.3, 0.99, 1.01, 3.0])
def test_a_punch_has_the_tension_of_its_pairs(ratio: float) -> None:
    pairs = FoldedPairs(LAW, 2.0 * STEEPEST / ratio, np.zeros(7))
    assert pairs.adhesion(0.1)[0] == pytest.approx(7.0 * TENSION, rel=EXACT)


def test_without_snaps_it_is_the_sum_that_the_integral_stands_for() -> None:
    radius = 2000.0
    x = np.arange(401) - 200.0
    pairs = FoldedPairs(LAW, 5.0, x**2 / (2.0 * radius))
    integral = IndependentPairs(LAW, 5.0, radius)
    assert pairs.adhesion(0.1)[0] == pytest.approx(integral.adhesion_force(), rel=1e-6)  # lattice: edge of 5 spacings
    assert pairs.fold is None
    assert pairs.loop_area(0.01) == 0.0


@pytest.mark.parametrize("ratio", [3.0, 30.0])
def test_the_newton_solver_snaps_at_the_same_places(ratio: float) -> None:
    pairs = FoldedPairs(LAW, 2.0 * STEEPEST / ratio, HEIGHTS)
    model = ChainModel(21, pairs.bulk_stiffness, LAW, heights=HEIGHTS)
    there = np.linspace(-0.3, 0.0, 31)
    path = np.concatenate([there, there[-2::-1]])
    force = np.array([state.force for state in trace(model, path)])
    exact = np.concatenate([pairs.loading(there), pairs.unloading(there[-2::-1], 0.0)])
    assert np.max(np.abs(force - exact)) < EXACT * np.max(np.abs(exact))


@pytest.mark.slow
def test_the_area_of_the_loop_is_the_integral_of_the_force() -> None:
    pairs = FoldedPairs(LAW, 2.0 * STEEPEST / 3.0, HEIGHTS)
    there = np.linspace(-1.0, 0.0, 200_001)
    area = np.trapezoid(pairs.loading(there) - pairs.unloading(there, 0.0), there)
    assert area == pytest.approx(pairs.loop_area(0.0), rel=1e-3)  # 22 jumps of the force, each within a step of 5e-6


def test_no_preload_beyond_the_core() -> None:
    pairs = FoldedPairs(LAW, 5.0, np.zeros(3))
    core = 3.0 * float(LAW.force(np.array(0.0)))
    assert float(pairs.loading(pairs.deepest(0.9 * core))) == pytest.approx(0.9 * core)
    with pytest.raises(ValueError, match="core"):
        pairs.deepest(1.01 * core)


def test_cold_pairs_are_at_rest() -> None:
    """And warm ones softer: the mean is that of a harmonic well only while kT is small."""
    pairs = FoldedPairs(LAW, 5.0, HEIGHTS)
    rest = pairs.deepest(0.1)
    mean, spread = BoltzmannPairs(LAW, 5.0, HEIGHTS, KT).displacement(0.1, rest, 4e-3)
    stiffness = (float(pairs.loading(rest + 1e-6)) - float(pairs.loading(rest - 1e-6))) / 2e-6
    assert mean == pytest.approx(rest, abs=THERMAL * LAW.longest_range)
    assert spread == pytest.approx(np.sqrt(KT / stiffness), rel=0.02)  # anharmonic share
