"""Claim: the references of particles under a normal load (energies, minimiser, pull-off, pairs that snap, pairs in the
limit of many, pairs under heat) are derivatives of one another, and agree with closed forms and with each other."""

import numpy as np
import pytest
from scipy.optimize import brentq

from validation.references.boltzmann_pairs import BoltzmannPairs
from validation.references.energy import EnergySurface
from validation.references.folded_pairs import FoldedPairs
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.newton import Descent, minimise
from validation.references.pull_off import pull_off
from validation.references.solver import trace
from validation.references.tension_radius import band_limited_radius, state_radius, tension_radius

STEP, DIFFERENCE = 1e-5, 2e-8
"""Of central differences, whose truncation and round-off are both some 1e-9 FU for energies of about 1."""
ROUND_OFF = 1e-13
"""Sums of some hundred terms of order 1."""
SOLVER = 1e-9
"""Forces: the descent stops at 1e-10 k a per particle, then polishes; brentq stops at 1e-14 LU."""
EXACT = 1e-8
"""Relative: minima found by looks 1e-9 of the range apart; integrals; the solver's residual."""

PAPERLIKE = PairInteraction.of(0.18, 0.13, 0.09, 0.26)
WIDE = PairInteraction.of(3.0, 1.0, 1.0, 2.0)
NARROW = PairInteraction.of(0.18 / 75.0, 0.015, 0.09 / 75.0, 0.03)
SNAPPING = PairInteraction.of(0.011, 0.015, 0.01, 0.03)
STEEPEST = float(SNAPPING.force_slope(np.array(SNAPPING.extremum_distance(2))))
HEIGHTS = (np.arange(21) - 10.0) ** 2 / 200.0


def strongest(law: PairInteraction) -> float:
    """The largest tension of a pair."""
    return -float(law.force(np.array(law.extremum_distance(1))))


def test_force_and_slope_are_derivatives_with_roots_at_the_special_distances() -> None:
    r, law = np.linspace(0.05, 1.4, 28), PAPERLIKE
    force = -(law.energy(r + STEP) - law.energy(r - STEP)) / (2 * STEP)
    slope = (law.force(r + STEP) - law.force(r - STEP)) / (2 * STEP)
    np.testing.assert_allclose(law.force(r), force, atol=DIFFERENCE)
    np.testing.assert_allclose(law.force_slope(r), slope, atol=10 * DIFFERENCE)
    free, tense, steep = (np.array(law.extremum_distance(order)) for order in range(3))
    assert max(abs(law.force(free)), abs(law.force_slope(tense))) < ROUND_OFF
    assert law.force_slope(r).max() <= law.force_slope(steep)
    with pytest.raises(ValueError, match="further"):
        PairInteraction(Exponential(1.0, 0.2), Exponential(0.1, 0.1))


@pytest.mark.parametrize(
    ("law", "particles", "freedom"),
    [(PAPERLIKE, 9, (0.0, False, None)), (WIDE, 9, (0.3, True, 0.4)), (WIDE, 2, (0.3, True, None))],
)
def test_gradient_and_hessian_are_derivatives(
    law: PairInteraction, particles: int, freedom: tuple[float, bool, float | None]
) -> None:
    k_n, horizontal, k_t = freedom
    surface = EnergySurface(
        ChainModel(particles, 0.83, law, 20.0, None, 1.0, k_n, horizontal, tangential_stiffness=k_t)
    )
    u, size = 0.02 * np.random.default_rng(7).standard_normal(surface.dofs), surface.dofs
    _, gradient = surface.energy_gradient(u, 0.05)
    hessian = np.zeros((size, size))
    for offset, row in enumerate(surface.hessian(u, 0.05)):
        np.fill_diagonal(hessian[offset:], row[: size - offset])
        np.fill_diagonal(hessian[:, offset:], row[: size - offset])
    for i, unit in enumerate(np.eye(size)):
        upper, lower = surface.energy_gradient(u + STEP * unit, 0.05), surface.energy_gradient(u - STEP * unit, 0.05)
        assert abs((upper[0] - lower[0]) / (2 * STEP) - gradient[i]) < DIFFERENCE
        np.testing.assert_allclose((upper[1] - lower[1]) / (2 * STEP), hessian[:, i], atol=10 * DIFFERENCE)


def test_every_pair_within_reach_is_counted_once_and_springs_rest_undeformed() -> None:
    model = ChainModel(40, 0.83, PAPERLIKE, radius=1000.0, neighbour_stiffness=3.0)
    surface, still = EnergySurface(model), np.zeros(80)
    x, gap = model.places(), model.undeformed_gap(0.3)
    r = np.hypot(x[None, :] - x[:, None], gap[None, :])
    assert abs(surface.energy_gradient(still, 0.3)[0] - float(np.sum(PAPERLIKE.energy(r)))) < ROUND_OFF
    force = np.sum(PAPERLIKE.force(r) * gap[None, :] / r, axis=0)
    np.testing.assert_allclose(surface.pair_force(still, 0.3)[:, 1], force, atol=ROUND_OFF)


@pytest.mark.parametrize("horizontal", [False, True])
def test_an_equilibrium_balances_and_its_force_is_the_slope_of_its_energy(horizontal: bool) -> None:
    model = ChainModel(80, 0.83, PAPERLIKE, radius=300.0, neighbour_stiffness=0.3, horizontal=horizontal)
    surface, step = EnergySurface(model), 1e-4
    states = trace(model, [-0.5, 0.1 - step, 0.1, 0.1 + step])
    for state in states:
        assert state.force == pytest.approx(float(np.sum(state.pair_force[:, 1])), abs=SOLVER)
        assert np.sum(0.83 * state.lower[:, 1]) == pytest.approx(-state.force, abs=SOLVER)
        u = np.stack([state.lower, state.upper], axis=1)[:, :, 1 - horizontal :].ravel()
        assert np.max(np.abs(surface.energy_gradient(u, state.displacement)[1])) < SOLVER
    slope = (states[3].energy - states[1].energy) / (2 * step)
    assert slope == pytest.approx(states[2].force, abs=1e-6)  # central difference: step^2 F''/6 with F'' ~ 30 FU/LU^2


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


def test_a_descent_leaps_over_no_barrier() -> None:
    descent = Descent(0.05, 1e-10, np.ones(1))
    for start in (0.01, 1.5, 1.6, 6.2):  # Newton's own step from 1.5 would be 14
        found = minimise(lambda u: (float(np.cos(u[0])), -np.sin(u)), lambda u: np.array([-np.cos(u)]),
                         np.array([start]), descent)  # fmt: skip
        np.testing.assert_allclose(found, [np.pi], atol=SOLVER)


def test_a_pull_off_has_the_closed_form_of_independent_pairs() -> None:
    """The chain ends at 1e-9; polynomials of three and of nine points and a band-limited one between the particles."""
    exact, model = IndependentPairs(NARROW, 0.83, 4000.0), ChainModel(200, 0.83, NARROW, radius=4000.0)
    result = pull_off(model, preload=0.01)
    assert result.adhesion_force == pytest.approx(exact.adhesion_force(), rel=1e-9)
    assert result.preload == pytest.approx(0.01, rel=EXACT)
    assert result.zero_load.force == pytest.approx(0.0, abs=EXACT * 0.01)
    for state, radius, known in (
        (result.zero_load, result.zero_load_radius, exact.zero_load_radius()),
        (result.critical, result.critical_radius, exact.critical_radius()),
    ):
        assert radius == pytest.approx(known, rel=3e-3)
        assert state_radius(model, state, 9) == pytest.approx(known, rel=2e-6)
        assert band_limited_radius(model.places(), state.pair_force[:, 1]) == pytest.approx(known, rel=3e-8)


def test_a_radius_is_found_exactly_in_a_parabola_and_needs_tension_inside_the_chain() -> None:
    x = np.linspace(-10.0, 10.0, 21)
    assert tension_radius(x, np.minimum((x - 4.3) ** 2, (x + 4.1) ** 2) - 2.0) == pytest.approx(4.2, abs=1e-13)
    assert np.isnan(tension_radius(x, np.ones(21)))
    with pytest.raises(ValueError, match="too short"):
        tension_radius(x, -np.abs(x))


@pytest.mark.parametrize("ratio", [0.3, 0.99, 1.01, 3.0])
def test_pairs_of_a_punch_let_go_at_the_largest_tension(ratio: float) -> None:
    pairs = FoldedPairs(SNAPPING, 2.0 * STEEPEST / ratio, np.zeros(7))
    assert pairs.adhesion(0.1)[0] == pytest.approx(7.0 * strongest(SNAPPING), rel=EXACT)


def test_the_newton_solver_snaps_and_pulls_off_as_pairs_with_folds() -> None:
    pairs = FoldedPairs(SNAPPING, 2.0 * STEEPEST / 3.0, HEIGHTS)
    model = ChainModel(21, pairs.bulk_stiffness, SNAPPING, heights=HEIGHTS)
    there = np.linspace(-0.3, 0.0, 31)
    force = np.array([state.force for state in trace(model, np.concatenate([there, there[-2::-1]]))])
    exact = np.concatenate([pairs.loading(there), pairs.unloading(there[-2::-1], 0.0)])
    assert np.max(np.abs(force - exact)) < EXACT * np.max(np.abs(exact))
    assert pull_off(model, 0.1, step=2e-3).adhesion_force == pytest.approx(pairs.adhesion(0.1)[0], rel=1e-6)


def test_pairs_that_do_not_snap_are_the_integral_of_many() -> None:
    x, integral = np.arange(401) - 200.0, IndependentPairs(SNAPPING, 5.0, 2000.0)
    pairs = FoldedPairs(SNAPPING, 5.0, x**2 / 4000.0)
    assert pairs.adhesion(0.1)[0] == pytest.approx(integral.adhesion_force(), rel=1e-6)  # lattice: edge of 5 spacings
    assert pairs.fold is None
    assert pairs.loop_area(0.01) == 0.0
    core = 401.0 * float(SNAPPING.force(np.array(0.0)))
    with pytest.raises(ValueError, match="core"):
        pairs.deepest(core)


def test_a_loop_has_the_area_between_its_ways() -> None:
    pairs = FoldedPairs(SNAPPING, 2.0 * STEEPEST / 3.0, np.zeros(1))
    d = np.linspace(-0.3, 0.01, 40_001)
    area = np.trapezoid(pairs.loading(d) - pairs.unloading(d, 0.01), d)
    assert area == pytest.approx(pairs.loop_area(0.01), rel=1e-2)  # two jumps, each within a step


def test_cold_pairs_are_at_rest() -> None:
    """And warm ones softer: the mean is that of a harmonic well only while kT is small."""
    pairs, temperature = FoldedPairs(SNAPPING, 5.0, HEIGHTS), 2e-7
    rest = pairs.deepest(0.1)
    mean, spread = BoltzmannPairs(SNAPPING, 5.0, HEIGHTS, temperature).displacement(0.1, rest, 4e-3)
    stiffness = (float(pairs.loading(rest + 1e-6)) - float(pairs.loading(rest - 1e-6))) / 2e-6
    assert mean == pytest.approx(rest, abs=3e-3 * SNAPPING.longest_range)
    assert spread == pytest.approx(np.sqrt(temperature / stiffness), rel=0.02)  # anharmonic share
