"""Claim: the map of adhesion names a theory that holds there, and its docstring says what its conventions cost.

Second source: Maugis and Dugdale at the same Tabor number, and Hertz's compression with units.
"""

from __future__ import annotations

import math

import pytest

from contact1d.analysis.theory.adhesion import (
    DMT_TABOR,
    HERTZ_ADHESION_SHARE,
    JKR_TABOR,
    Dmt,
    MaugisDugdale,
    Theory,
    valid_theory,
)
from contact1d.analysis.theory.indenters import PowerLaw
from validation.references.mdr import edge_elongation

ROUND_OFF = 1e-12
RADIUS, MODULUS, ADHESION, RANGE = 3.0, 7.0, 0.2, 0.01
JKR_RADIUS, JKR_PULL_OFF = 0.0085, 0.004
"""Relative: what JKR misses at mu = 5 (measured 0.0075 at zero load, 0.0033)."""
DMT_RADIUS, DMT_PULL_OFF = 0.065, 0.032
"""Relative: what DMT misses at mu = 0.1 (measured 0.063 at zero load, 0.030)."""


@pytest.mark.parametrize(
    ("tabor", "load", "theory"),
    [
        (1e-3, 0.0, Theory.RIGID),
        (1e-3, -1.99, Theory.RIGID),
        (1e-3, -2.01, Theory.APART),
        (0.08, 0.0, Theory.DMT),
        (0.08, 39.0, Theory.DMT),
        (0.08, 41.0, Theory.HERTZ),
        (1.0, 0.0, Theory.MAUGIS),
        (1.0, -1.57, Theory.MAUGIS),
        (1.0, -1.59, Theory.APART),  # its pull-off force is 1.582
        (1.0, 900.0, Theory.MAUGIS),
        (1.0, 1100.0, Theory.HERTZ),
        (6.0, 0.0, Theory.JKR),
        (6.0, -1.499, Theory.JKR),
        (6.0, -1.501, Theory.MAUGIS),  # JKR holds no more than 3/2, a finite range a little
        (6.0, -1.6, Theory.APART),
        (50.0, 2500.0, Theory.JKR),
        (50.0, 2540.0, Theory.HERTZ),
    ],
)
def test_zones(tabor: float, load: float, theory: Theory) -> None:
    verdict = valid_theory(tabor, load)
    assert verdict.theory is theory
    assert any(character.isdigit() for character in verdict.reason)


def test_tabor_number_is_a_stretch_over_the_range() -> None:
    mu = MaugisDugdale(RADIUS, MODULUS, ADHESION, RANGE).tabor
    assert mu == pytest.approx((RADIUS * ADHESION**2 / (MODULUS**2 * RANGE**3)) ** (1.0 / 3.0), rel=ROUND_OFF)
    for sphere, factor in ((PowerLaw.sphere, 3.898), (Dmt, 3.246)):
        stretch = edge_elongation(sphere(RADIUS, MODULUS, ADHESION).zero_load_radius(), MODULUS, ADHESION)
        assert stretch / RANGE == pytest.approx(factor * mu, rel=2e-4)  # printed with four digits
    with pytest.raises(ValueError, match="positive"):
        MaugisDugdale(RADIUS, MODULUS, ADHESION, 0.0)


@pytest.mark.parametrize(("tabor", "load"), [(0.01, 40.0), (100.0, 2520.0)])
def test_hertz_boundary(tabor: float, load: float) -> None:
    """2/N for DMT and [3 + sqrt(6N+9)]/N for JKR reach 5 % at 40 and at 2520."""
    assert valid_theory(tabor, load * (1.0 + ROUND_OFF)).theory is Theory.HERTZ
    assert valid_theory(tabor, load * (1.0 - ROUND_OFF)).theory is not Theory.HERTZ
    miss = 1.0 - (1.0 / (1.0 + HERTZ_ADHESION_SHARE)) ** (1.0 / 3.0)
    assert miss == pytest.approx(0.016, abs=5e-4)  # of the radius, as the docstring says


def test_rigid_boundary_is_hertz_under_the_whole_load() -> None:
    sphere, load = Dmt(RADIUS, MODULUS, ADHESION), 1.7
    compression = sphere.displacement(sphere.contact_radius(load * math.pi * ADHESION * RADIUS))
    for share, rigid in ((0.04999, True), (0.05001, False)):
        mu = MaugisDugdale(RADIUS, MODULUS, ADHESION, compression / share).tabor
        assert (valid_theory(mu, load).theory is Theory.RIGID) == rigid


@pytest.mark.parametrize("load", [0.0, 1.0, 10.0, 100.0])
def test_what_the_vertical_lines_cost(load: float) -> None:
    unit = 1.0, 0.75, 1.0 / math.pi
    jkr, dmt = PowerLaw.sphere(*unit), Dmt(*unit)
    soft, stiff = MaugisDugdale.reduced(JKR_TABOR), MaugisDugdale.reduced(DMT_TABOR)
    assert 0.0 < jkr.contact_radius(load) / soft.contact_radius(load) - 1.0 < JKR_RADIUS
    assert 0.0 < 1.0 - dmt.contact_radius(load) / stiff.contact_radius(load) < DMT_RADIUS
    assert 0.0 < 1.0 - 1.5 / soft.pull_off_force() < JKR_PULL_OFF
    assert 0.0 < 2.0 / stiff.pull_off_force() - 1.0 < DMT_PULL_OFF


def test_what_is_refused() -> None:
    for tabor, load in ((0.0, 1.0), (math.nan, 1.0), (1.0, math.inf)):
        with pytest.raises(ValueError, match="positive"):
            valid_theory(tabor, load)
