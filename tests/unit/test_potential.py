"""The two-exponential law: force and stiffness as its derivatives, its force-free distance and its cutoff."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from contact1d.potentials import DoubleExponential, Exponential

ALONE = DoubleExponential(Exponential(0.18, 0.13))
ATTRACTING = [
    DoubleExponential(Exponential(0.18, 0.13), Exponential(0.09, 0.26)),
    DoubleExponential(Exponential(40.0, 0.03), Exponential(1e-3, 3.0)),
]
LAWS = [*ATTRACTING, ALONE]

DIFFERENCE = 1e-8
"""Central differences with a step h of the range: truncation h²/6 = 2e-11, round-off 2e-16/h = 2e-11; with margin."""
STEP = 1e-5
ROUND_OFF = 1e-13
QUADRATURE = 1e-9
"""scipy's quad is asked for this."""


@pytest.mark.parametrize("law", LAWS)
def test_force_and_stiffness_are_derivatives_and_the_energy_is_the_work_from_far_away(law: DoubleExponential) -> None:
    """f = −V′ and V″ = −f′, against central differences, from the core to the tail; V(r) = ∫_r^∞ f."""
    shortest, terms = law.repulsion.range, [term for term in (law.repulsion, law.attraction) if term]
    r = np.linspace(0.01 * shortest, 6.0 * law.longest_range, 60).reshape(2, 30)  # of any shape
    h = STEP * shortest

    def slope(function: Callable[[Any], Any]) -> Any:
        return (function(r + h) - function(r - h)) / (2.0 * h)

    for found, by_difference, order in (
        (law.force(r), -slope(law.energy), 1),
        (law.stiffness(r), -slope(law.force), 2),
    ):
        size = sum(term.amplitude * np.exp(-r / term.range) / term.range**order for term in terms)
        assert found.shape == r.shape
        assert (np.abs(found - by_difference) <= DIFFERENCE * size).all()
    ends = 50.0 * law.longest_range
    assert float(law.energy(ends)) == pytest.approx(0.0, abs=ROUND_OFF)
    for start in (0.0, 0.36, 1.0):
        work, _ = quad(lambda s: float(law.force(s)), start, ends, epsabs=QUADRATURE, epsrel=QUADRATURE, limit=500)
        assert float(law.energy(start)) == pytest.approx(work, abs=10 * QUADRATURE)


@pytest.mark.parametrize("law", ATTRACTING)
def test_force_free_distance_is_the_only_root(law: DoubleExponential) -> None:
    """Against a bracketing root finder; the law repels before it and attracts behind it."""

    found = law.force_free_distance()
    root = brentq(law.force, 0.0, 20.0 * law.longest_range, xtol=1e-15, rtol=4 * np.finfo(float).eps)
    assert found == pytest.approx(root, rel=ROUND_OFF)
    assert (law.force(np.linspace(0.0, 0.999 * found, 50)) > 0).all()
    assert (law.force(np.linspace(1.001 * found, 10 * found, 50)) < 0).all()


def test_a_law_without_attraction_is_force_free_nowhere_and_ends_at_a_share_of_its_force_at_0() -> None:
    with pytest.raises(ValueError, match="no force-free distance"):
        ALONE.force_free_distance()
    assert ALONE.longest_range == 0.13
    assert float(ALONE.force(ALONE.cutoff_for(1e-6))) == pytest.approx(1e-6 * 0.18 / 0.13, rel=1e-12)


def test_terms_that_do_not_fit_are_refused() -> None:
    """An attraction of a shorter range, or one as strong as the repulsion at r = 0."""
    for attraction, words in (((0.09, 0.13), "must reach further"), ((0.36, 0.26), "must prevail at r = 0")):
        with pytest.raises(ValueError, match=words):
            DoubleExponential(Exponential(0.18, 0.13), Exponential(*attraction))
