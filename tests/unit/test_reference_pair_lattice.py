"""The lattice of pairs against the closed form of a continuum of them, and against a single pair's own folds."""

from __future__ import annotations

import numpy as np
import pytest

from tests.pair_lattice import PairLattice
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction

LAW = PairInteraction(Exponential(0.0024, 0.015), Exponential(0.0012, 0.03))
STEEPEST = float(LAW.force_slope(np.asarray(LAW.extremum_distance(2))))
CONTINUUM = 1e-9
"""A sum over many particles converges exponentially to the integral; measured 1e-12."""
JUMP = 1e-6
"""Distance from a jump at which a force is that of its side."""


def test_many_pairs_that_do_not_snap_are_the_closed_form() -> None:
    stiffness, radius = 2.0 * STEEPEST / 0.5, 20_000.0
    x = np.arange(-150.0, 151.0)
    lattice = PairLattice(LAW, stiffness, x**2 / (2.0 * radius))
    assert not lattice.snaps
    exact = IndependentPairs(LAW, stiffness, radius)
    tension, place = lattice.pull_off(0.1)
    assert tension == pytest.approx(exact.adhesion_force(), rel=CONTINUUM)
    assert lattice.force(place, lattice.stuck_after(0.1)) == pytest.approx(-tension, rel=CONTINUUM)


def test_a_pair_that_snaps_jumps_at_both_folds() -> None:
    pair = PairLattice(LAW, 2.0 * STEEPEST / 3.0, np.zeros(1))
    assert pair.ratio == pytest.approx(3.0)
    rest = LAW.force_free_distance()
    on, off = rest - pair.snap_on, rest - pair.snap_off
    assert off < on
    stuck = pair.stuck_after(on + JUMP)
    assert stuck.all()
    assert not pair.stuck_after(on - JUMP).any()
    near, far = (pair.force(off + side * JUMP, stuck) for side in (1.0, -1.0))
    assert near < 3.0 * far < 0.0
    assert pair.pull_off(0.0)[0] == pytest.approx(-float(LAW.force(np.asarray(LAW.extremum_distance(1)))), rel=1e-9)


@pytest.mark.slow
def test_a_round_loses_the_area_between_the_ways() -> None:
    pair = PairLattice(LAW, 2.0 * STEEPEST / 3.0, np.zeros(1))
    d = np.linspace(-1.0, 0.01, 200_001)
    there = [pair.force(at, pair.stuck_after(at)) for at in d[::20]]
    back = [pair.force(at, pair.stuck_after(0.01)) for at in d[::20]]
    area = float(np.trapezoid(np.asarray(there) - np.asarray(back), d[::20]))
    assert area == pytest.approx(pair.lost_in_a_round(0.01), rel=1e-2)  # two jumps within one of 10,000 steps
