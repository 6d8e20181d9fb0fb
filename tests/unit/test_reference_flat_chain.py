"""Claim: one particle of a flat chain is Prandtl's and Tomlinson's; of many, each slides over wells at a common height.

The first hangs under a constant load, the others at a height that no slip changes: what is between falls as 1/N.
"""

from __future__ import annotations

import numpy as np
import pytest

from validation.references.flat_chain import FlatChain
from validation.references.incommensurate import shared_corrugation
from validation.references.prandtl_tomlinson import corrugation, slow_friction

LAW = (1.0, 0.5, 0.5, 1.0)
LOAD, NORMAL = 0.2, 1.0
EXACT = 1e-3
"""A particle: places at which its slip is looked for."""
WITHOUT_END = 2e-3
"""What follows 1/N in five and eight particles."""


def chain(count: int, below: int, stiffness: float) -> FlatChain:
    return FlatChain(LAW, 1.0, count, below, LOAD, NORMAL, stiffness)


@pytest.mark.parametrize("stiffness", [0.03, 0.06])
def test_one_particle_is_that_of_prandtl_and_tomlinson(stiffness: float) -> None:
    expected = slow_friction(corrugation(LAW, 1.0, LOAD), stiffness)
    assert chain(1, 1, stiffness).friction() == pytest.approx(expected, rel=EXACT)


@pytest.mark.slow
def test_what_the_plate_gives_way_to_each_slip_falls_as_the_number_of_particles() -> None:
    few, more = (chain(*pair, 0.03).friction() for pair in ((5, 8), (8, 13)))
    expected = slow_friction(shared_corrugation(LAW, 1.0, LOAD, NORMAL, 0.03), 0.03)
    assert few < more < expected
    without_end = (8.0 * more - 5.0 * few) / 3.0
    assert without_end == pytest.approx(expected, rel=WITHOUT_END)


def test_the_row_pulls_as_its_energy_falls() -> None:
    """Forces and their derivatives against differences of the law's energy, and of each other."""
    A, a, B, b = LAW
    x, z, step = np.array([0.2, 0.7]), np.array([0.6, 0.8]), 1e-6
    one = chain(2, 3, 0.03)
    places = np.arange(-45, 46)

    def energy(at: float, height: float) -> float:
        r = np.hypot(at - places, height)
        return float(np.sum(A * np.exp(-r / a) - B * np.exp(-r / b)))

    along, up, xx, zz, xz = one._row(x, z)
    for i in range(2):
        assert along[i] == pytest.approx((energy(x[i] + step, z[i]) - energy(x[i] - step, z[i])) / (2 * step), rel=1e-6)
        assert up[i] == pytest.approx((energy(x[i], z[i] + step) - energy(x[i], z[i] - step)) / (2 * step), rel=1e-6)
    right, left = one._row(x + step, z), one._row(x - step, z)
    above, beneath = one._row(x, z + step), one._row(x, z - step)
    assert xx == pytest.approx((right[0] - left[0]) / (2 * step), rel=1e-5)
    assert xz == pytest.approx((above[0] - beneath[0]) / (2 * step), rel=1e-5)
    assert zz == pytest.approx((above[1] - beneath[1]) / (2 * step), rel=1e-5)
