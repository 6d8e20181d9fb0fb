"""Claim: the closed forms of rigid indenters (Sneddon, Galin, JKR, Maugis and Barquins, Kendall) are right.

Second source: `validation.references.mdr`, quadratures of the profile's slope with Hess' rule that know no closed form.
That the rule itself is right is tested by energies: what a contact releases per area that opens at a fixed displacement
is W. Limits: n = 2 and a << R are Hertz. Numerics: the pressure integrates to the force.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d.analysis.theory.indenters import Contact, Ellipsoid, FlatPunch, PowerLaw, galin_factor
from validation.references.hertz import hertz_contact_radius, hertz_force, hertz_peak_pressure
from validation.references.mdr import ReducedContact, edge_elongation

ROUND_OFF = 1e-12
QUADRATURE = 1e-10
"""Relative: nested adaptive quadratures, each asked for 1e-12; the sphere's force also cancels (R/a)^2 digits."""
PRESSURE = 1e-8
"""Relative: the quadrature of a pressure is asked for 1e-9."""
PRESSURE_SUM = 1e-7
"""Relative: a quadrature over pressures, whose own round-off grows towards the edge."""
DIFFERENCE = 1e-7
"""Relative: central differences with a step of 1e-4 of the contact radius."""
EDGE = 1e-6
"""Relative: Hertz's part, of the order of the distance from the edge, which is 1e-7 a."""

MODULUS, RADIUS, ADHESION, SLOPE, HEIGHT = 7.0, 3.0, 0.2, 0.3, 2.0
EDGES = (0.05, 0.3, 0.8)
JKR = PowerLaw.sphere(RADIUS, MODULUS, ADHESION)
PARABOLA = ReducedContact(lambda r: r / RADIUS, MODULUS, ADHESION)
CONE = ReducedContact(lambda r: SLOPE, MODULUS, ADHESION)
FLAT_END = ReducedContact(lambda r: 0.0, MODULUS, ADHESION)


def power_law(exponent: float, work: float = 0.0) -> tuple[PowerLaw, ReducedContact]:
    """The same indenter z = 0.2 r^n twice: closed form and quadrature."""

    def slope(r: float) -> float:
        return 0.2 * exponent * r ** (exponent - 1.0)

    return PowerLaw(0.2, exponent, MODULUS, work), ReducedContact(slope, MODULUS, work)


def ellipsoid(height: float) -> tuple[Ellipsoid, ReducedContact]:
    """The whole ellipsoid twice; a sphere where it is as high as wide."""
    shape = ReducedContact(lambda r: height / RADIUS * r / math.sqrt(RADIUS**2 - r**2), MODULUS)
    return Ellipsoid(RADIUS, height, MODULUS), shape


SHAPES = [
    *(pytest.param(power_law(n), id=f"r^{n:g}") for n in (1.0, 1.5, 2.0, 2.7, 4.0, 9.0)),
    *(pytest.param(power_law(n, ADHESION), id=f"adhesive r^{n:g}") for n in (1.0, 1.5, 2.0, 3.0, 4.0)),
    pytest.param(ellipsoid(RADIUS), id="sphere"),
    pytest.param(ellipsoid(HEIGHT), id="ellipsoid"),
]


@pytest.mark.parametrize("pair", SHAPES)
def test_closed_form_is_the_reduced_contact(pair: tuple[Contact, ReducedContact]) -> None:
    closed, reduced = pair
    scale = abs(closed.force(EDGES[-1]))
    for a in EDGES:
        assert reduced.displacement(a) == pytest.approx(closed.displacement(a), rel=QUADRATURE)
        assert reduced.force(a) == pytest.approx(closed.force(a), rel=QUADRATURE, abs=QUADRATURE * scale)


@pytest.mark.parametrize("pair", SHAPES)
def test_radius_inverts_force_and_displacement(pair: tuple[Contact, ReducedContact]) -> None:
    closed = pair[0]
    beyond = max(closed.critical_radius(), closed.fixed_grips_radius())
    for a in (beyond + edge for edge in EDGES):
        assert closed.contact_radius(closed.force(a)) == pytest.approx(a, rel=ROUND_OFF)
        assert closed.radius_at(closed.displacement(a)) == pytest.approx(a, rel=ROUND_OFF)
    assert closed.force(closed.zero_load_radius()) == pytest.approx(0.0, abs=ROUND_OFF)
    with pytest.raises(ValueError, match="exceeds the pull-off force"):
        closed.contact_radius(-1.01 * closed.pull_off_force() - 1e-6)
    with pytest.raises(ValueError, match="the bodies separate at"):
        closed.radius_at(closed.displacement(closed.fixed_grips_radius()) - 0.1)


def test_what_jkr_and_the_cone_of_maugis_and_barquins_are_known_for() -> None:
    assert JKR.pull_off_force() == pytest.approx(1.5 * math.pi * ADHESION * RADIUS, rel=ROUND_OFF)
    a_0 = math.cbrt(4.5 * math.pi * ADHESION * RADIUS**2 / MODULUS)
    assert JKR.zero_load_radius() == pytest.approx(a_0, rel=ROUND_OFF)
    assert JKR.critical_radius() == pytest.approx(math.cbrt(0.25) * a_0, rel=ROUND_OFF)
    assert JKR.fixed_grips_radius() == pytest.approx(math.cbrt(1.0 / 36.0) * a_0, rel=ROUND_OFF)
    assert JKR.force(JKR.fixed_grips_radius()) == pytest.approx(-5.0 / 9.0 * JKR.pull_off_force(), rel=ROUND_OFF)
    tip = PowerLaw(SLOPE, 1.0, MODULUS, ADHESION)
    assert tip.critical_radius() == pytest.approx(18.0 * ADHESION / (math.pi * MODULUS * SLOPE**2), rel=ROUND_OFF)
    assert tip.pull_off_force() == pytest.approx(54.0 * ADHESION**2 / (math.pi * MODULUS * SLOPE**3), rel=ROUND_OFF)


def ring_sum(pressure: Callable[[float], float], a: float) -> float:
    """Integral of 2 pi r p by r = a sin(phi), which takes a root or a pole at the edge away."""
    return float(
        quad(
            lambda phi: math.pi * a**2 * math.sin(2.0 * phi) * pressure(a * math.sin(phi)),
            1e-9, 0.5 * math.pi - 1e-6, epsrel=PRESSURE_SUM,
        )[0]
    )  # fmt: skip


@pytest.mark.parametrize("pair", [one for one in SHAPES if "adhesive" not in str(one.id)])
def test_reduced_pressure_integrates_to_the_force(pair: tuple[Contact, ReducedContact]) -> None:
    closed, reduced = pair
    assert ring_sum(lambda r: reduced.pressure(r, 0.8), 0.8) == pytest.approx(closed.force(0.8), rel=PRESSURE_SUM)


@pytest.mark.parametrize(("n", "work"), [(1.0, 0.0), (2.0, 0.0), (2.0, ADHESION), (1.0, ADHESION)])
def test_pressures_in_closed_form(n: float, work: float) -> None:
    a, (body, reduced) = 0.5, power_law(n, work)
    r = np.array([1e-3, 0.1, 0.3, 0.49])
    expected = [reduced.pressure(place, a) for place in r]
    assert body.pressure(r, a) == pytest.approx(expected, rel=PRESSURE, abs=PRESSURE * max(map(abs, expected)))
    assert body.pressure(np.array([0.5, 0.6]), a).tolist() == [0.0, 0.0]
    central = float(body.pressure(np.array([0.0]), a)[0])
    assert central == pytest.approx(body.central_pressure(a), rel=ROUND_OFF)
    inside = 1e-7 * a  # Irwin: K = lim -p sqrt(2 pi (a - r)) has K^2/2E* = W
    intensity = -float(body.pressure(np.array([a - inside]), a)[0]) * math.sqrt(2.0 * math.pi * inside)
    assert intensity**2 / (2.0 * MODULUS) == pytest.approx(work, rel=20.0 * EDGE, abs=EDGE)


@pytest.mark.parametrize("shape", [power_law(1.5), power_law(4.0), ellipsoid(RADIUS), ellipsoid(HEIGHT)])
def test_pressure_on_the_axis(shape: tuple[PowerLaw | Ellipsoid, ReducedContact]) -> None:
    closed, reduced = shape
    assert closed.central_pressure(0.8) == pytest.approx(reduced.pressure(1e-5, 0.8), rel=1e-2)  # of r^1.5 a kink


def test_paraboloid_and_shallow_sphere_are_hertz() -> None:
    ball, whole = PowerLaw.sphere(RADIUS, MODULUS), Ellipsoid(RADIUS, RADIUS, MODULUS)
    for d in (1e-3, 0.02, 0.1):
        a = ball.radius_at(d)
        assert a == pytest.approx(float(hertz_contact_radius(d, RADIUS)), rel=ROUND_OFF)
        assert ball.force(a) == pytest.approx(float(hertz_force(d, RADIUS, MODULUS)), rel=ROUND_OFF)
        assert ball.peak_pressure(a) == pytest.approx(float(hertz_peak_pressure(d, RADIUS, MODULUS)), rel=ROUND_OFF)
    excess = [whole.force(a) / ball.force(a) - 1.0 for a in (0.03, 0.06)]
    assert excess[1] == pytest.approx(4.0 * excess[0], rel=1e-3)  # next order: (a/R)^2
    assert excess[0] == pytest.approx(0.4 * 0.01**2, rel=1e-3)  # 1 + (2/5)(a/R)^2 from the series of artanh


def test_flat_punch_is_kendall_and_the_limit_of_a_steep_power_law() -> None:
    """z = (r/a)^n for n -> infinity rises at r = a only: F = 2 E* a d."""
    a, d = 0.5, FLAT_END.displacement(0.5)
    punch = FlatPunch(a, MODULUS, ADHESION)
    assert d == -edge_elongation(a, MODULUS, ADHESION)
    assert FLAT_END.force(a) == pytest.approx(-punch.pull_off_force(), rel=QUADRATURE)
    assert FLAT_END.force(a) == pytest.approx(punch.stiffness * d, rel=QUADRATURE)
    assert FLAT_END.pressure(0.2, a) == pytest.approx(float(punch.pressure(0.2, d)), rel=PRESSURE)
    steep = PowerLaw(0.02 / (galin_factor(1e3) * a**1e3), 1e3, MODULUS)
    edge = steep.radius_at(0.02)
    assert edge == pytest.approx(a, rel=ROUND_OFF)
    assert steep.force(edge) == pytest.approx(2.0 * MODULUS * edge * 0.02, rel=2e-3)  # 1/n


@pytest.mark.parametrize("contact", [PARABOLA, CONE, FLAT_END], ids=["parabola", "cone", "punch"])
def test_what_opens_releases_the_work_of_adhesion(contact: ReducedContact) -> None:
    """At fixed d the springs hold U(a, d) = E* int_0^a (d-g)^2 dx, and dU/da = 2 pi a W at the radius of the rule."""
    a = 0.8
    d, step = contact.displacement(a), 1e-4 * a
    slope = (energy(contact.profile, a + step, d) - energy(contact.profile, a - step, d)) / (2.0 * step)
    assert slope == pytest.approx(2.0 * math.pi * a * ADHESION, rel=DIFFERENCE)


def energy(profile: Callable[[float], float], a: float, d: float) -> float:
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

    change = whole(a + step) - whole(a - step)
    path = contact.displacement(a + step) - contact.displacement(a - step)
    assert change == pytest.approx(contact.force(a) * path, rel=10.0 * DIFFERENCE)


def test_what_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 1"):
        PowerLaw(1.0, 0.5, MODULUS)
    with pytest.raises(ValueError, match="not negative"):
        PowerLaw(1.0, 2.0, MODULUS, -1.0)
    with pytest.raises(ValueError, match="radius must be positive"):
        PowerLaw.sphere(-1.0, MODULUS)
    with pytest.raises(ValueError, match="half_axis must be positive"):
        Ellipsoid(1.0, 0.0, MODULUS)
    with pytest.raises(ValueError, match="coefficient"):
        PowerLaw(0.0, 1.0, MODULUS)
    with pytest.raises(ValueError, match="contact_modulus"):
        FlatPunch(1.0, math.nan)
    with pytest.raises(ValueError, match="never rises"):
        ReducedContact(lambda r: 0.0, MODULUS).contact_radius(0.1)
    with pytest.raises(ValueError, match="two contact radii"):
        PARABOLA.contact_radius(0.1)
