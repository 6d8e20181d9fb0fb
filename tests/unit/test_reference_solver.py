"""The reference solver against per-pair root finding, known folds, and what must hold in any equilibrium."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from validation.references.energy import EnergySurface
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.newton import Descent, is_stable, minimise
from validation.references.solver import trace

SOLVER = 1e-9
"""Forces: the descent stops at 1e-10 k a per particle, then polishes; brentq stops at 1e-14 LU."""
OTHER_PAIRS = 1e-10
"""exp(-25): what particles feel from others than their opposite at a range of 0.04 LU."""

PAPERLIKE = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
NARROW = PairInteraction(Exponential(0.18 / 42.25, 0.02), Exponential(0.09 / 42.25, 0.04))
WIDE = PairInteraction(Exponential(0.18, 0.5), Exponential(0.09, 1.0))
WIDEST = PairInteraction(Exponential(0.18, 1.0), Exponential(0.09, 2.0))


def _by_roots(law: PairInteraction, k: float, gaps: np.ndarray) -> np.ndarray:
    return np.array([brentq(lambda r, g=g: r - 2 * law.force(np.array(r)) / k - g, 1e-6, 20.0) for g in gaps])


@pytest.mark.parametrize("displacement", [-0.1, 0.0, 0.05, 0.1])
def test_independent_pairs_by_root_finding(displacement: float) -> None:
    model = ChainModel(60, 0.83, NARROW, radius=4000.0)
    state = trace(model, [displacement])[0]
    distance = _by_roots(NARROW, 0.83, model.undeformed_gap(displacement))
    np.testing.assert_allclose(state.pair_force[:, 1], NARROW.force(distance), atol=OTHER_PAIRS)
    assert state.force == pytest.approx(float(np.sum(NARROW.force(distance))), abs=60 * OTHER_PAIRS)
    assert state.smallest_distance == pytest.approx(distance.min(), abs=OTHER_PAIRS)


@pytest.mark.parametrize("law", [PAPERLIKE, WIDE, WIDEST])
@pytest.mark.parametrize("k_n", [0.0, 0.3])
@pytest.mark.parametrize("horizontal", [False, True])
def test_forces_balance_and_the_state_is_stable(law: PairInteraction, k_n: float, horizontal: bool) -> None:
    model = ChainModel(80, 0.83, law, radius=300.0, neighbour_stiffness=k_n, horizontal=horizontal)
    surface = EnergySurface(model)
    for state in trace(model, [-0.5, 0.0, 0.2]):
        assert state.force == pytest.approx(float(np.sum(state.pair_force[:, 1])), abs=SOLVER)
        assert np.sum(0.83 * state.lower[:, 1]) == pytest.approx(-state.force, abs=SOLVER)
        u = np.stack([state.lower, state.upper], axis=1)[:, :, 1 - horizontal :].ravel()
        assert np.max(np.abs(surface.energy_gradient(u, state.displacement)[1])) < SOLVER
        assert is_stable(surface.hessian(u, state.displacement))


def test_force_is_the_slope_of_the_energy_along_the_path() -> None:
    model = ChainModel(80, 0.83, PAPERLIKE, radius=300.0, neighbour_stiffness=0.3, horizontal=True)
    step = 1e-4
    before, here, after = trace(model, [0.1 - step, 0.1, 0.1 + step])
    slope = (after.energy - before.energy) / (2 * step)
    assert slope == pytest.approx(here.force, abs=1e-6)  # central difference: step^2 F''/6 with F'' ~ 30 FU/LU^2


def _fold_gaps(k: float) -> tuple[float, float]:
    """Return the undeformed gaps of jump-out and jump-in of one pair: f'(r) = k/2."""

    def excess(r: float) -> float:
        return float(PAPERLIKE.force_slope(np.array(r))) - 0.5 * k

    steepest = PAPERLIKE.extremum_distance(2)
    roots = np.array([brentq(excess, PAPERLIKE.extremum_distance(1), steepest), brentq(excess, steepest, 5.0)])
    gaps = roots - 2.0 * PAPERLIKE.force(roots) / k
    return float(gaps[0]), float(gaps[1])


def test_a_pair_snaps_at_its_folds_and_not_before() -> None:
    k, margin = 0.04, 1e-6
    model = ChainModel(1, k, PAPERLIKE, heights=np.zeros(1))
    out_gap, in_gap = _fold_gaps(k)
    assert out_gap > in_gap + 0.05
    touch = PAPERLIKE.force_free_distance()
    d_in, d_out = touch - in_gap, touch - out_gap
    path = [*np.linspace(d_out - 0.5, d_in - margin, 40), d_in + margin, 0.5, d_out + margin, d_out - margin]
    states = trace(model, path)
    steepest = PAPERLIKE.extremum_distance(2)
    assert states[39].smallest_distance > steepest
    assert states[40].smallest_distance < steepest
    assert states[42].smallest_distance < steepest
    assert states[43].smallest_distance > steepest


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


def test_a_saddle_is_left_downhill() -> None:
    def double_well(u: np.ndarray) -> tuple[float, np.ndarray]:
        return float(0.25 * u[0] ** 4 - 0.5 * u[0] ** 2 + 0.5 * u[1] ** 2), np.array([u[0] ** 3 - u[0], u[1]])

    def curvature(u: np.ndarray) -> np.ndarray:
        return np.array([[3.0 * u[0] ** 2 - 1.0, 1.0], [0.0, 0.0]])

    for side in (1.0, -1.0):
        descent = Descent(step_limit=0.05, gradient_tolerance=1e-10, preferred=np.array([side, 0.3]))
        end = minimise(double_well, curvature, np.array([0.0, 0.4]), descent)
        np.testing.assert_allclose(end, [side, 0.0], atol=SOLVER)


def test_steps_do_not_leap_over_a_barrier() -> None:
    def waves(u: np.ndarray) -> tuple[float, np.ndarray]:
        return float(np.cos(u[0])), -np.sin(u)

    def curvature(u: np.ndarray) -> np.ndarray:
        return np.array([-np.cos(u)])

    descent = Descent(step_limit=0.05, gradient_tolerance=1e-10, preferred=np.ones(1))
    for start in (0.01, 1.5, 1.6, 6.2):  # Newton's own step from 1.5 would be 14
        np.testing.assert_allclose(minimise(waves, curvature, np.array([start]), descent), [np.pi], atol=SOLVER)


def test_a_broken_energy_is_an_error() -> None:
    descent = Descent(step_limit=0.05, gradient_tolerance=1e-10, preferred=np.ones(1))
    with pytest.raises(RuntimeError, match="downhill"):
        minimise(lambda u: (float("nan"), np.ones(1)), lambda u: np.ones((1, 1)), np.zeros(1), descent)
