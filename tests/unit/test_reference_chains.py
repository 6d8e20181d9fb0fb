"""Claim: the references of particles under a normal load (minimiser, pull-off, pairs that snap, pairs in the limit of
many) agree with closed forms and with each other."""

import numpy as np
import pytest
from scipy.optimize import brentq

from validation.references.folded_pairs import FoldedPairs
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off
from validation.references.solver import trace
from validation.references.tension_radius import band_limited_radius, state_radius

SOLVER = 1e-9
"""Forces: the descent stops at 1e-10 k a per particle, then polishes; brentq stops at 1e-14 LU."""
EXACT = 1e-8
"""Relative: minima found by looks 1e-9 of the range apart; integrals; the solver's residual."""

PAPERLIKE = PairInteraction.of(0.18, 0.13, 0.09, 0.26)
NARROW = PairInteraction.of(0.18 / 75.0, 0.015, 0.09 / 75.0, 0.03)
SNAPPING = PairInteraction.of(0.011, 0.015, 0.01, 0.03)
STEEPEST = float(SNAPPING.force_slope(np.array(SNAPPING.extremum_distance(2))))
HEIGHTS = (np.arange(21) - 10.0) ** 2 / 200.0


def test_an_aligned_pair_buckles_where_theory_says() -> None:
    k, k_t = 0.83, 0.2
    critical = brentq(lambda r: 2.0 * float(PAPERLIKE.force(np.array(r))) / r - k_t, 0.2, 0.36)
    gap = critical - 2.0 * float(PAPERLIKE.force(np.array(critical))) / k
    d = PAPERLIKE.force_free_distance() - gap
    model = ChainModel(1, k, PAPERLIKE, heights=np.zeros(1), horizontal=True, tangential_stiffness=k_t)
    before, after = trace(model, [d - 1e-3, d + 1e-2])
    assert np.all(before.upper[:, 0] == 0.0)
    assert after.upper[0, 0] > 0.01
    assert after.lower[0, 0] == pytest.approx(-after.upper[0, 0], abs=SOLVER)


def test_a_pull_off_has_the_closed_form_of_independent_pairs() -> None:
    """The chain ends at 1e-9; polynomials of three and of nine points and a band-limited one between the particles."""
    exact, model = IndependentPairs(NARROW, 0.83, 4000.0), ChainModel(200, 0.83, NARROW, radius=4000.0)
    result = pull_off(model, preload=0.01)
    assert result.adhesion_force == pytest.approx(exact.adhesion_force(), rel=1e-9)
    assert result.preload == pytest.approx(0.01, rel=EXACT)
    assert result.zero_load.force == pytest.approx(0.0, abs=EXACT * 0.01)
    assert result.critical.pair_force[:, 1].sum() == pytest.approx(result.critical.force, rel=EXACT)
    for state, radius, known in (
        (result.zero_load, result.zero_load_radius, exact.zero_load_radius()),
        (result.critical, result.critical_radius, exact.critical_radius()),
    ):
        assert radius == pytest.approx(known, rel=3e-3)
        assert state_radius(model, state, 9) == pytest.approx(known, rel=2e-6)
        assert band_limited_radius(model.places(), state.pair_force[:, 1]) == pytest.approx(known, rel=3e-8)


def test_the_newton_solver_snaps_and_pulls_off_as_pairs_with_folds() -> None:
    pairs = FoldedPairs(SNAPPING, 2.0 * STEEPEST / 3.0, HEIGHTS)
    model = ChainModel(21, pairs.bulk_stiffness, SNAPPING, heights=HEIGHTS)
    there = np.linspace(-0.3, 0.0, 31)
    force = np.array([state.force for state in trace(model, np.concatenate([there, there[-2::-1]]))])
    exact = np.concatenate([pairs.loading(there), pairs.unloading(there[-2::-1], 0.0)])
    assert np.max(np.abs(force - exact)) < EXACT * np.max(np.abs(exact))
    assert pull_off(model, 0.1, step=2e-3).adhesion_force == pytest.approx(pairs.adhesion(0.1)[0], rel=1e-6)
