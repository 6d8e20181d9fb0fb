"""The reference's pull-off against the closed form of independent pairs, and by roots under snapping."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import PullOff, pull_off
from validation.references.tension_radius import band_limited_radius, state_radius, tension_radius

SEARCH = 1e-8
"""Relative: the search stops at 1e-9."""
CHAIN_END = 1e-9
"""Relative: the tension beyond the end of a chain whose edge has a gap of 20 ranges."""
STENCIL_OF_3, STENCIL_OF_9 = 3e-3, 2e-6
"""Relative: interpolation of the pressure between particles, in a dip some 6 to 9 spacings wide."""
BAND_LIMITED = 3e-8
"""Relative, of the same dips: 1e-8 measured at the zero-load radius, 2e-10 at the critical one."""
FOLD = 1e-6
"""Relative: at a fold the force goes as the square root of the distance to it, which is located to 1e-10 LU."""

NARROW = PairInteraction(Exponential(0.18 / 75.0, 0.015), Exponential(0.09 / 75.0, 0.03))
PAPERLIKE = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))


RADIUS = 4000.0
"""Of the contact that the closed form is compared with [LU]."""


@pytest.fixture(scope="module")
def narrow() -> tuple[ChainModel, PullOff]:
    """A chain whose pairs feel nothing of each other, and its pull-off."""
    model = ChainModel(200, 0.83, NARROW, radius=RADIUS)
    return model, pull_off(model, preload=0.01)


def test_closed_form_of_independent_pairs(narrow: tuple[ChainModel, PullOff]) -> None:
    exact = IndependentPairs(NARROW, 0.83, RADIUS)
    model, result = narrow
    assert result.adhesion_force == pytest.approx(exact.adhesion_force(), rel=CHAIN_END)
    assert result.preload == pytest.approx(0.01, rel=SEARCH)
    assert result.zero_load.force == pytest.approx(0.0, abs=SEARCH * 0.01)
    assert result.zero_load_radius == pytest.approx(exact.zero_load_radius(), rel=STENCIL_OF_3)
    assert result.critical_radius == pytest.approx(exact.critical_radius(), rel=STENCIL_OF_3)
    assert state_radius(model, result.zero_load, 9) == pytest.approx(exact.zero_load_radius(), rel=STENCIL_OF_9)
    assert state_radius(model, result.critical, 9) == pytest.approx(exact.critical_radius(), rel=STENCIL_OF_9)


def test_band_limited_interpolation_finds_the_radius_of_the_closed_form(narrow: tuple[ChainModel, PullOff]) -> None:
    exact = IndependentPairs(NARROW, 0.83, RADIUS)
    model, result = narrow
    for state, known in ((result.zero_load, exact.zero_load_radius()), (result.critical, exact.critical_radius())):
        found = band_limited_radius(model.places(), state.pair_force[:, 1])
        assert found == pytest.approx(known, rel=BAND_LIMITED)


def test_band_limited_interpolation_needs_tension_inside_the_chain() -> None:
    x = np.linspace(-10.0, 10.0, 21)
    for pressure in (np.ones(21), -np.abs(x)):
        with pytest.raises(ValueError, match="inside the chain"):
            band_limited_radius(x, pressure)


def test_interpolated_radius_converges_with_the_stencil() -> None:
    exact = IndependentPairs(NARROW, 0.83, 12500.0)
    model = ChainModel(260, 0.83, NARROW, radius=12500.0)
    result = pull_off(model, preload=0.0)
    errors = [abs(state_radius(model, result.critical, n) / exact.critical_radius() - 1.0) for n in (3, 5, 7)]
    assert errors[0] > 5.0 * errors[1] > 25.0 * errors[2]


def test_result_does_not_depend_on_the_coarse_step() -> None:
    model = ChainModel(80, 0.83, PAPERLIKE, radius=200.0, neighbour_stiffness=0.3, horizontal=True)
    fine, coarse = pull_off(model, 0.3), pull_off(model, 0.3, step=0.03)
    assert coarse.adhesion_force == pytest.approx(fine.adhesion_force, rel=SEARCH)
    assert coarse.zero_load_radius == pytest.approx(fine.zero_load_radius, rel=SEARCH)
    assert coarse.critical_radius == pytest.approx(fine.critical_radius, rel=10 * SEARCH)  # at a flat maximum


def test_one_pair_holds_the_largest_tension_of_its_law() -> None:
    for k in (0.83, 0.05):  # without and with a snap
        model = ChainModel(3, k, PAPERLIKE, heights=np.array([50.0, 0.0, 50.0]), spacing=12.0)
        strongest = -float(PAPERLIKE.force(np.array(PAPERLIKE.extremum_distance(1))))
        assert pull_off(model, 0.02).adhesion_force == pytest.approx(strongest, rel=SEARCH)


def _held_by_roots(law: PairInteraction, k: float, gaps: np.ndarray) -> float:
    """Return the force of pairs that were all in contact once: each stays on the inner branch up to its fold."""
    fold = brentq(
        lambda r: float(law.force_slope(np.array(r))) - 0.5 * k, law.extremum_distance(1), law.extremum_distance(2)
    )

    def gap(r: float) -> float:
        return r - 2.0 * float(law.force(np.array(r))) / k

    total = 0.0
    for g in gaps:
        inner = (1e-9, fold) if g <= gap(fold) else (law.extremum_distance(2), 5.0)
        total += float(law.force(np.array(brentq(lambda r, g=g: gap(r) - g, *inner, xtol=1e-15))))
    return total


@pytest.mark.slow
def test_snapping_pairs_by_root_finding() -> None:
    k = 0.2
    law = PairInteraction(Exponential(0.18 / 75.0, 0.008), Exponential(0.09 / 75.0, 0.016))
    model = ChainModel(61, k, law, radius=1500.0)
    result = pull_off(model, preload=0.01, step=2e-4)
    around = np.linspace(-3e-3, 3e-3, 2001) + result.critical.displacement
    forces = [_held_by_roots(law, k, model.undeformed_gap(d)) for d in around]
    assert result.adhesion_force >= -min(forces) * (1.0 - FOLD)
    there = _held_by_roots(law, k, model.undeformed_gap(result.critical.displacement))
    assert -result.adhesion_force == pytest.approx(there, rel=FOLD)


def test_parabola_is_found_exactly_and_shape_errors_are_refused() -> None:
    x = np.linspace(-10.0, 10.0, 21)
    pressure = np.minimum((x - 4.3) ** 2, (x + 4.1) ** 2) - 2.0
    assert tension_radius(x, pressure) == pytest.approx(4.2, abs=1e-13)
    assert np.isnan(tension_radius(x, np.ones(21)))
    with pytest.raises(ValueError, match="too short"):
        tension_radius(x, -np.abs(x))


@pytest.mark.slow
def test_what_cannot_be_pulled_off_is_refused() -> None:
    with pytest.raises(ValueError, match="attraction"):
        pull_off(ChainModel(9, 1.0, radius=10.0, rigid_plane=True), 1.0)
    with pytest.raises(RuntimeError, match="preload"):
        pull_off(ChainModel(5, 1.0, PAPERLIKE, radius=100.0, horizontal=True), 100.0)
