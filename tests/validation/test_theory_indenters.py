"""Claim: the closed forms of rigid indenters (Sneddon, Galin, JKR, Maugis and Barquins, Kendall) are right.

Second source: `validation.references.mdr`, quadratures of the profile's slope with Hess' rule that know no closed form.
Limits: n = 2 and a << R are Hertz.
"""

import math

import numpy as np
import pytest

from contact1d.analysis.theory.indenters import Contact, Ellipsoid, FlatPunch, PowerLaw
from validation.references.hertz import hertz_contact_radius, hertz_force, hertz_peak_pressure
from validation.references.mdr import ReducedContact

ROUND_OFF = 1e-12
QUADRATURE = 1e-10
"""Relative: nested adaptive quadratures, each asked for 1e-12; the sphere's force also cancels (R/a)^2 digits."""
PRESSURE = 1e-8
"""Relative: the quadrature of a pressure is asked for 1e-9."""
EDGE = 1e-6
"""Relative: Hertz's part, of the order of the distance from the edge, which is 1e-7 a."""

MODULUS, RADIUS, ADHESION, SLOPE, HEIGHT = 7.0, 3.0, 0.2, 0.3, 2.0
EDGES = (0.05, 0.3, 0.8)
JKR = PowerLaw.sphere(RADIUS, MODULUS, ADHESION)
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
    *(pytest.param(power_law(n), id=f"r^{n:g}") for n in (1.0, 2.7, 9.0)),
    *(pytest.param(power_law(n, ADHESION), id=f"adhesive r^{n:g}") for n in (1.0, 2.0, 4.0)),
    pytest.param(ellipsoid(RADIUS), id="sphere"),
    pytest.param(ellipsoid(HEIGHT), id="ellipsoid"),
]


@pytest.mark.parametrize("pair", SHAPES)
def test_closed_form_is_the_reduced_contact_and_inverts_it(pair: tuple[Contact, ReducedContact]) -> None:
    closed, reduced = pair
    scale = abs(closed.force(EDGES[-1]))
    for a in EDGES:
        assert reduced.displacement(a) == pytest.approx(closed.displacement(a), rel=QUADRATURE)
        assert reduced.force(a) == pytest.approx(closed.force(a), rel=QUADRATURE, abs=QUADRATURE * scale)
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


@pytest.mark.parametrize(("n", "work"), [(1.0, 0.0), (2.0, ADHESION), (1.0, ADHESION)])
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


def test_paraboloid_is_hertz_and_its_pressures_are_those_on_the_axis() -> None:
    ball, d = PowerLaw.sphere(RADIUS, MODULUS), 0.02
    a = ball.radius_at(d)
    assert a == pytest.approx(float(hertz_contact_radius(d, RADIUS)), rel=ROUND_OFF)
    assert ball.force(a) == pytest.approx(float(hertz_force(d, RADIUS, MODULUS)), rel=ROUND_OFF)
    assert ball.peak_pressure(a) == pytest.approx(float(hertz_peak_pressure(d, RADIUS, MODULUS)), rel=ROUND_OFF)
    for closed, reduced in (power_law(4.0), ellipsoid(HEIGHT)):
        assert closed.central_pressure(0.8) == pytest.approx(reduced.pressure(1e-5, 0.8), rel=1e-2)


def test_flat_punch_is_kendall() -> None:
    a, d = 0.5, FLAT_END.displacement(0.5)
    punch = FlatPunch(a, MODULUS, ADHESION)
    assert FLAT_END.force(a) == pytest.approx(-punch.pull_off_force(), rel=QUADRATURE)
    assert FLAT_END.force(a) == pytest.approx(punch.stiffness * d, rel=QUADRATURE)
    assert FLAT_END.pressure(0.2, a) == pytest.approx(float(punch.pressure(0.2, d)), rel=PRESSURE)


def test_what_is_refused() -> None:
    for wrong, words in (
        (lambda: PowerLaw(1.0, 0.5, MODULUS), "at least 1"),
        (lambda: PowerLaw(1.0, 2.0, MODULUS, -1.0), "not be negative"),
        (lambda: Ellipsoid(1.0, 0.0, MODULUS), "half_axis must be positive"),
        (lambda: FlatPunch(1.0, math.nan), "contact_modulus"),
        (lambda: FlatPunch(1.0, MODULUS, -1.0), "work_of_adhesion"),
        (lambda: power_law(3.0)[0].pressure(np.zeros(1), 1.0), "exponents 1 and 2"),
    ):
        with pytest.raises(ValueError, match=words):
            wrong()
