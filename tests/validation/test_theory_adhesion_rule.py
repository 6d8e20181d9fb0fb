"""Claim: with the rule of Hess the reduced contact is the 3D one with adhesion: JKR, Kendall's punch, the cone.

The quadratures of `validation.references.mdr` against closed forms that don't use them. That the rule itself is right
is tested by energies: what a contact releases per area that opens at a fixed displacement is W.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from contact1d.analysis.theory.jkr import Jkr
from contact1d.analysis.theory.sneddon import AdhesiveCone, FlatPunch
from validation.references.mdr import ReducedContact, edge_elongation

ROUND_OFF = 1e-12
QUADRATURE = 1e-10
"""Relative: nested adaptive quadratures, each asked for 1e-12."""
PRESSURE = 1e-8
"""Relative: the quadrature of a pressure is asked for 1e-9."""
DIFFERENCE = 1e-7
"""Relative: central differences with a step of 1e-4 of the contact radius."""
RADIUS, MODULUS, ADHESION, SLOPE = 3.0, 7.0, 0.2, 0.3
SPHERE = Jkr(RADIUS, MODULUS, ADHESION)
TIP = AdhesiveCone(SLOPE, MODULUS, ADHESION)
PARABOLA = ReducedContact(lambda r: r / RADIUS, MODULUS, ADHESION)
CONE = ReducedContact(lambda r: SLOPE, MODULUS, ADHESION)
FLAT = ReducedContact(lambda r: 0.0, MODULUS, ADHESION)


@pytest.mark.parametrize("ratio", [0.35, 0.63, 1.0, 2.0])
def test_parabola_is_jkr(ratio: float) -> None:
    a = ratio * SPHERE.zero_load_radius()
    assert PARABOLA.displacement(a) == pytest.approx(float(SPHERE.displacement(a)), rel=QUADRATURE)
    assert PARABOLA.force(a) == pytest.approx(float(SPHERE.force(a)), rel=QUADRATURE, abs=QUADRATURE)
    for place in (0.01, 0.5, 0.99):
        assert PARABOLA.pressure(place * a, a) == pytest.approx(float(SPHERE.stress(place * a, a)), rel=PRESSURE)


def test_flat_punch_is_kendall() -> None:
    a = 0.5
    punch = FlatPunch(a, MODULUS)
    d = FLAT.displacement(a)
    assert d == -edge_elongation(a, MODULUS, ADHESION)
    assert FLAT.force(a) == pytest.approx(-punch.pull_off_force(ADHESION), rel=QUADRATURE)
    assert FLAT.force(a) == pytest.approx(float(punch.force(d)), rel=QUADRATURE)
    assert FLAT.energy(a) == pytest.approx(float(punch.energy(d)), rel=QUADRATURE)
    assert FLAT.pressure(0.2, a) == pytest.approx(float(punch.pressure(0.2, d)), rel=PRESSURE)


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_cone_is_maugis_and_barquins(ratio: float) -> None:
    a = ratio * TIP.critical_radius()
    assert CONE.displacement(a) == pytest.approx(float(TIP.displacement(a)), rel=QUADRATURE)
    assert CONE.force(a) == pytest.approx(float(TIP.force(a)), rel=QUADRATURE)


def test_cone_pulls_off_where_its_force_is_lowest() -> None:
    lowest = minimize_scalar(lambda a: float(TIP.force(a)), bounds=(0.0, 5.0 * TIP.critical_radius()), method="bounded")
    assert -lowest.fun == pytest.approx(TIP.pull_off_force(), rel=1e-9)  # the search stops at 1e-5 in a
    assert float(TIP.force(TIP.critical_radius())) == pytest.approx(-TIP.pull_off_force(), rel=ROUND_OFF)


@pytest.mark.parametrize("contact", [PARABOLA, CONE, FLAT], ids=["parabola", "cone", "punch"])
def test_what_opens_releases_the_work_of_adhesion(contact: ReducedContact) -> None:
    """At fixed d the springs hold U(a, d) = E* int_0^a (d-g)^2 dx, and dU/da = 2 pi a W at the radius of the rule."""
    a = 0.8
    d, step = contact.displacement(a), 1e-4 * a
    slope = (_energy(contact.profile, a + step, d) - _energy(contact.profile, a - step, d)) / (2.0 * step)
    assert slope == pytest.approx(2.0 * math.pi * a * ADHESION, rel=DIFFERENCE)


def _energy(profile: Callable[[float], float], a: float, d: float) -> float:
    """E* int_0^a (d-g)^2 dx by a Gauss rule of its own: the profiles are polynomials."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    values = [(d - profile(0.5 * a * (1.0 + node))) ** 2 for node in nodes]
    return 0.5 * a * MODULUS * float(weights @ np.array(values))


@pytest.mark.parametrize("contact", [PARABOLA, CONE], ids=["parabola", "cone"])
def test_force_is_conjugate_to_the_displacement_of_the_whole_energy(contact: ReducedContact) -> None:
    """E(a) = U(a) - pi a^2 W along the equilibria: dE/da = F dd/da."""
    a, step = 0.8, 1e-4

    def whole(edge: float) -> float:
        return contact.energy(edge) - math.pi * edge**2 * ADHESION

    energy = whole(a + step) - whole(a - step)
    path = contact.displacement(a + step) - contact.displacement(a - step)
    assert energy == pytest.approx(contact.force(a) * path, rel=10.0 * DIFFERENCE)


def test_what_is_refused() -> None:
    with pytest.raises(ValueError, match="two contact radii"):
        PARABOLA.contact_radius(0.1)
    with pytest.raises(ValueError, match="slope"):
        AdhesiveCone(0.0, MODULUS, ADHESION)
