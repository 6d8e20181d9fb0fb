"""The adhesive power law is JKR for n = 2 and the cone of Maugis and Barquins for n = 1; its extrema are extrema."""

from __future__ import annotations

import pytest

from contact1d.analysis.theory.adhesive_power import AdhesivePower
from contact1d.analysis.theory.jkr import Jkr
from contact1d.analysis.theory.sneddon import AdhesiveCone
from validation.references.mdr import ReducedContact

E, W, R = 2.0, 0.03, 70.0
ROUND_OFF = 1e-12
QUADRATURE = 1e-8
STEP, FLAT = 1e-4, 1e-6
"""Relative step beside an extremum, and what a rounding of the difference may hide, over its value."""


def test_a_paraboloid_is_jkrs() -> None:
    body, jkr = AdhesivePower(0.5 / R, 2.0, E, W), Jkr(R, E, W)
    assert body.pull_off_force() == pytest.approx(jkr.pull_off_force(), rel=ROUND_OFF)
    assert body.zero_load_radius() == pytest.approx(jkr.zero_load_radius(), rel=ROUND_OFF)
    assert body.critical_radius() == pytest.approx(jkr.critical_radius(), rel=ROUND_OFF)
    assert body.fixed_grips_radius() == pytest.approx(jkr.critical_radius_fixed_grips(), rel=ROUND_OFF)
    for force in (-2.0, 0.0, 5.0):
        assert body.contact_radius(force) == pytest.approx(float(jkr.contact_radius(force)), rel=ROUND_OFF)
        a = body.contact_radius(force)
        assert body.radius_at(float(jkr.displacement(a))) == pytest.approx(a, rel=ROUND_OFF)


def test_a_cone_is_that_of_maugis_and_barquins() -> None:
    body, cone = AdhesivePower(0.1, 1.0, E, W), AdhesiveCone(0.1, E, W)
    assert body.pull_off_force() == pytest.approx(cone.pull_off_force(), rel=ROUND_OFF)
    assert body.force(9.0) == pytest.approx(float(cone.force(9.0)), rel=ROUND_OFF)
    assert body.displacement(9.0) == pytest.approx(float(cone.displacement(9.0)), rel=ROUND_OFF)


@pytest.mark.parametrize("n", [1.0, 1.5, 3.0, 4.0])
def test_any_power_is_the_reduction_s(n: float) -> None:
    c = 1e-2
    body, reduced = AdhesivePower(c, n, E, W), ReducedContact(lambda r: n * c * r ** (n - 1.0), E, W)
    for a in (0.5, 2.0, 6.0):
        assert body.displacement(a) == pytest.approx(reduced.displacement(a), rel=QUADRATURE)
        assert body.force(a) == pytest.approx(reduced.force(a), rel=QUADRATURE)
    assert body.force(body.zero_load_radius()) == pytest.approx(0.0, abs=ROUND_OFF * body.pull_off_force())
    for curve, a in ((body.force, body.critical_radius()), (body.displacement, body.fixed_grips_radius())):
        assert min(curve(a * (1.0 - STEP)), curve(a * (1.0 + STEP))) > curve(a)
        assert curve(a * (1.0 + STEP)) == pytest.approx(curve(a), rel=FLAT)


def test_what_is_no_contact_is_refused() -> None:
    body = AdhesivePower(0.5 / R, 2.0, E, W)
    with pytest.raises(ValueError, match="exceeds the pull-off force"):
        body.contact_radius(-1.01 * body.pull_off_force())
    with pytest.raises(ValueError, match="the bodies part at"):
        body.radius_at(2.0 * body.displacement(body.fixed_grips_radius()))
    with pytest.raises(ValueError, match="must be positive"):
        AdhesivePower(1.0, 2.0, E, 0.0)
