"""One chain on a rigid plane against its closed sum and against a general non-negative least-squares solver."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from contact1d.analysis.theory.winkler import rigid_plane_sum, winkler_force
from validation.references.model import ChainModel
from validation.references.rigid_plane import contact_on_rigid_plane
from validation.references.solver import trace

ROUND_OFF = 1e-12
"""Linear systems of at most 200 equations with a condition of at most 1e4."""


def _by_least_squares(gap: np.ndarray, k: float, k_n: float) -> np.ndarray:
    """Minimise u K u / 2 over w = u + g >= 0 as |L^T w - L^-1 K g|^2 with K = L L^T."""
    size = gap.size
    stretch = np.diff(np.eye(size), axis=0)
    stiffness = k * np.eye(size) + k_n * stretch.T @ stretch
    root = np.linalg.cholesky(stiffness)
    height, _ = nnls(root.T, np.linalg.solve(root, stiffness @ gap))
    return np.asarray(height - gap)


@pytest.mark.parametrize("k_n", [0.0, 0.3, 50.0])
@pytest.mark.parametrize("kind", ["parabola", "rough", "flat"])
def test_contact_by_a_general_quadratic_solver(k_n: float, kind: str) -> None:
    x = np.arange(61) - 30.0
    gap = {
        "parabola": x**2 / 400.0 - 0.6,
        "rough": np.random.default_rng(3).standard_normal(61),
        "flat": np.full(61, -0.2),
    }[kind]
    lift, reaction = contact_on_rigid_plane(gap, 0.83, k_n)
    np.testing.assert_allclose(lift, _by_least_squares(gap, 0.83, k_n), atol=ROUND_OFF)
    assert np.all(reaction >= 0.0)
    assert np.all(gap + lift >= -ROUND_OFF)
    assert np.max(np.abs(reaction * (gap + lift))) < ROUND_OFF


@pytest.mark.parametrize("displacement", [-0.1, 0.0, 0.05, 0.7])
def test_chain_without_neighbours_is_the_sum_over_particles(displacement: float) -> None:
    model = ChainModel(200, 0.83, radius=1000.0, rigid_plane=True)
    state = trace(model, [displacement])[0]
    assert state.force == pytest.approx(rigid_plane_sum(displacement, model.places(), 1000.0, 0.83), abs=ROUND_OFF)
    assert state.force == pytest.approx(float(np.sum(state.pair_force[:, 1])), abs=ROUND_OFF)
    assert state.smallest_distance == pytest.approx(max(0.0, model.undeformed_gap(displacement).min()))


def test_sum_tends_to_the_integral_with_the_square_of_the_spacing() -> None:
    """Euler and Maclaurin with particles on both edges, where the slope jumps by c_n w/R: -c_n s^2 w/6R, no more."""
    width, radius, c_n = 32.0, 1000.0, 0.83
    d = width**2 / (2.0 * radius)
    exact = float(winkler_force(d, radius, c_n))
    for spacing in (2.0, 1.0, 0.5, 0.25):
        places = spacing * np.arange(-200.0, 201.0)
        error = rigid_plane_sum(d, places, radius, c_n * spacing) - exact
        assert error == pytest.approx(-c_n * spacing**2 * width / (6.0 * radius), abs=ROUND_OFF)


def test_neighbour_springs_stiffen_the_contact_and_drop_out_of_a_flat() -> None:
    soft = trace(ChainModel(100, 0.83, radius=500.0, rigid_plane=True), [0.5])[0]
    stiff = trace(ChainModel(100, 0.83, radius=500.0, rigid_plane=True, neighbour_stiffness=5.0), [0.5])[0]
    assert stiff.force > soft.force
    for k_n in (0.0, 0.3):
        flat = ChainModel(10, 0.83, heights=np.zeros(10), rigid_plane=True, neighbour_stiffness=k_n)
        assert trace(flat, [0.4])[0].force == pytest.approx(10 * 0.83 * 0.4, abs=ROUND_OFF)


def test_single_particle() -> None:
    model = ChainModel(1, 2.0, heights=np.zeros(1), rigid_plane=True, neighbour_stiffness=1.0)
    assert [state.force for state in trace(model, [-1.0, 0.5])] == [0.0, 1.0]
