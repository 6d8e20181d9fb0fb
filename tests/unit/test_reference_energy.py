"""The reference's pair law and energy: every derivative against differences of the energy."""

from __future__ import annotations

import numpy as np
import pytest

from validation.references.energy import EnergySurface
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel

STEP = 1e-5
DIFFERENCE = 2e-8
"""Central differences: truncation STEP^2 f'''/6 and round-off 1e-16 U/STEP are both some 1e-9 FU for energies ~ 1."""
ROUND_OFF = 1e-13
"""Sums of some hundred terms of order 1."""

ADHESIVE = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
WIDE = PairInteraction(Exponential(3.0, 1.0), Exponential(1.0, 2.0))


def _dense(band: np.ndarray) -> np.ndarray:
    size = band.shape[1]
    full = np.zeros((size, size))
    for offset, row in enumerate(band):
        below = np.diag(row[: size - offset], -offset)
        full += below if offset == 0 else below + below.T
    return full


def _models() -> list[ChainModel]:
    return [
        ChainModel(9, 0.83, law, radius=20.0, neighbour_stiffness=k_n, horizontal=horizontal, tangential_stiffness=k_t)
        for law in (ADHESIVE, WIDE)
        for k_n in (0.0, 0.3)
        for horizontal, k_t in ((False, None), (True, None), (True, 0.4))
    ]


@pytest.mark.parametrize("law", [ADHESIVE, WIDE])
def test_force_and_slope_are_derivatives(law: PairInteraction) -> None:
    r = np.linspace(0.05, 1.4, 28)
    force = -(law.energy(r + STEP) - law.energy(r - STEP)) / (2 * STEP)
    slope = (law.force(r + STEP) - law.force(r - STEP)) / (2 * STEP)
    np.testing.assert_allclose(law.force(r), force, atol=DIFFERENCE)
    np.testing.assert_allclose(law.force_slope(r), slope, atol=10 * DIFFERENCE)  # divided by a range of 0.13 once more


def test_special_distances_are_extrema() -> None:
    assert abs(ADHESIVE.force(np.array(ADHESIVE.force_free_distance()))) < ROUND_OFF
    assert abs(ADHESIVE.force_slope(np.array(ADHESIVE.extremum_distance(1)))) < ROUND_OFF
    r = np.linspace(0.3, 2.0, 2001)
    assert ADHESIVE.force(r).min() >= ADHESIVE.force(np.array(ADHESIVE.extremum_distance(1)))
    assert ADHESIVE.force_slope(r).max() <= ADHESIVE.force_slope(np.array(ADHESIVE.extremum_distance(2)))


@pytest.mark.parametrize("model", _models())
def test_gradient_and_hessian_are_derivatives(model: ChainModel) -> None:
    surface = EnergySurface(model)
    generator = np.random.default_rng(7)
    u = 0.02 * generator.standard_normal(surface.dofs)
    d = 0.05
    _, gradient = surface.energy_gradient(u, d)
    hessian = _dense(surface.hessian(u, d))
    for i, unit in enumerate(np.eye(surface.dofs)):
        upper, lower = surface.energy_gradient(u + STEP * unit, d), surface.energy_gradient(u - STEP * unit, d)
        assert abs((upper[0] - lower[0]) / (2 * STEP) - gradient[i]) < DIFFERENCE
        np.testing.assert_allclose((upper[1] - lower[1]) / (2 * STEP), hessian[:, i], atol=10 * DIFFERENCE)


@pytest.mark.parametrize("particles", [1, 2, 3])
def test_shortest_chains(particles: int) -> None:
    model = ChainModel(particles, 0.83, ADHESIVE, radius=20.0, neighbour_stiffness=0.3, horizontal=True)
    surface = EnergySurface(model)
    u = 0.02 * np.random.default_rng(1).standard_normal(surface.dofs)
    hessian = _dense(surface.hessian(u, 0.1))
    columns = [
        (surface.energy_gradient(u + STEP * e, 0.1)[1] - surface.energy_gradient(u - STEP * e, 0.1)[1]) / (2 * STEP)
        for e in np.eye(surface.dofs)
    ]
    np.testing.assert_allclose(np.array(columns), hessian, atol=10 * DIFFERENCE)


def test_every_pair_within_reach_is_counted_once() -> None:
    model = ChainModel(40, 0.83, ADHESIVE, radius=1000.0)
    surface = EnergySurface(model)
    x, gap = model.places(), model.undeformed_gap(0.3)
    r = np.hypot(x[None, :] - x[:, None], gap[None, :])
    energy, _ = surface.energy_gradient(np.zeros(surface.dofs), 0.3)
    assert abs(energy - float(np.sum(ADHESIVE.energy(r)))) < ROUND_OFF
    force = np.sum(ADHESIVE.force(r) * gap[None, :] / r, axis=0)
    np.testing.assert_allclose(surface.pair_force(np.zeros(surface.dofs), 0.3)[:, 1], force, atol=ROUND_OFF)


def test_neighbour_springs_rest_on_the_undeformed_profile() -> None:
    model = ChainModel(5, 1.0, ADHESIVE, radius=2.0, neighbour_stiffness=3.0)
    far = EnergySurface(model).energy_gradient(np.zeros(10), -100.0)
    assert far[0] == pytest.approx(0.0, abs=ROUND_OFF)
    np.testing.assert_allclose(far[1], 0.0, atol=ROUND_OFF)


def test_wrong_laws_are_refused() -> None:
    with pytest.raises(ValueError, match="further"):
        PairInteraction(Exponential(1.0, 0.2), Exponential(0.1, 0.1))
    with pytest.raises(ValueError, match="stronger"):
        PairInteraction(Exponential(0.1, 0.1), Exponential(1.0, 0.2))
