"""Claim: Maugis's equations, Dugdale's contact of any body by quadrature, and boundary elements agree, each to its own
accuracy, and have the limits of Derjaguin, Muller and Toporov and of Johnson, Kendall and Roberts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import astuple
from decimal import Decimal, localcontext
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad, simpson
from scipy.special import ellipkm1

from validation.references.axisymmetric import Body
from validation.references.dugdale import Cohesive
from validation.references.dugdale_elements import Elements, pressed_down
from validation.references.interaction import Floats
from validation.references.maugis import LAMBDA_OVER_TABOR, Reduced, of_tabor

TABOR = (0.01, 0.03, 0.1, 0.3, 0.5, 1.0, 3.0, 10.0, 30.0, 100.0)
LAND = 1.0
PARABOLA = Body(lambda r: r, lambda _: 1.0)
CONE = Body(lambda _: 1.0, lambda _: 0.0)
QUARTIC = Body(lambda r: 4.0 * r**3, lambda r: 12.0 * r**2)
WORN = Body(lambda r: r if r >= LAND else 0.0, lambda r: float(r >= LAND), (LAND,), (LAND,))
TIP = Body(lambda r: float(r >= LAND), lambda _: 0.0, (LAND,), (1.0,))
BODIES: dict[str, tuple[Body, Callable[[Floats], Floats]]] = {
    "parabola": (PARABOLA, lambda r: 0.5 * r**2),
    "cone": (CONE, lambda r: r),
    "power 4": (QUARTIC, lambda r: r**4),
    "land, then parabola": (WORN, lambda r: np.maximum(0.0, 0.5 * (r**2 - LAND**2))),
    "land, then cone": (TIP, lambda r: np.maximum(0.0, r - LAND)),
}
UNITS = 40
"""Digits in which Maugis's own form loses enough of them and keeps the rest."""


def paraboloid(mu: float) -> Cohesive:
    """R = E* = W = 1."""
    one = of_tabor(mu)
    return Cohesive(PARABOLA, 1.0, 1.0, one.reach, 1.5 * one.unit_radius)


def tip_of(body: Body, mu: float) -> Cohesive:
    """E* = W = 1, of a unit length."""
    return Cohesive(body, 1.0, 1.0, 1.0 / mu, 1.0)


def sine_and_cosine(x: Decimal) -> tuple[Decimal, Decimal]:
    """By their series, to the digits of the context."""
    terms, term, n = [Decimal(0), Decimal(0)], Decimal(1), 0
    while abs(term) > Decimal(10) ** -(UNITS + 5):
        terms[n % 2] += term if n % 4 < 2 else -term
        n += 1
        term *= x / n
    return terms[1], terms[0]


@pytest.mark.parametrize("parameter", [0.01, 1.0, 100.0])
@pytest.mark.parametrize("t", [1e-5, 0.01, 0.8, 1.5, 0.5 * math.pi - 1e-6])
def test_maugis_s_own_form_in_many_digits(parameter: float, t: float) -> None:
    one = Reduced(parameter).state(t)
    with localcontext() as context:
        context.prec = UNITS
        L, angle = Decimal(parameter), Decimal(t)
        sin, cos = sine_and_cosine(angle)
        m, r = 1 / cos, sin / cos
        square, linear = L / 2 * (r + (m**2 - 2) * angle), 4 * L**2 / 3 * (r * angle - m + 1)
        a = 2 / (linear + (linear**2 + 4 * square).sqrt())
        load, displacement = a**3 - L * a**2 * (r + m**2 * angle), a**2 - 4 * L / 3 * a * r
        scales = a**3 + L * a**2 * m**2 * angle, a**2 + 4 * L / 3 * a * r
    assert one.a == pytest.approx(float(a), rel=1e-14)
    assert one.c == pytest.approx(float(m * a), rel=1e-14)
    assert one.load == pytest.approx(float(load), abs=1e-14 * float(scales[0]), rel=0.0)
    assert one.displacement == pytest.approx(float(displacement), abs=1e-14 * float(scales[1]), rel=0.0)


def test_a_wide_zone_is_dmt_s_and_a_narrow_one_jkr_s() -> None:
    assert -Reduced(LAMBDA_OVER_TABOR * 0.01).critical.load == pytest.approx(2.0, rel=2e-3)
    rigid, soft = Reduced(1e-4), Reduced(1e4)
    assert -rigid.critical.load == pytest.approx(2.0, rel=1e-5)
    assert rigid.free.a == pytest.approx(math.cbrt(2.0), rel=1e-4)
    assert soft.free.a == pytest.approx(math.cbrt(6.0), rel=1e-8)
    assert -soft.critical.load == pytest.approx(1.5, rel=1e-8)
    assert -soft.snap_out.load == pytest.approx(5.0 / 6.0, rel=1e-8)


@pytest.mark.parametrize("parameter", [10.0, 30.0, 100.0])
def test_the_pull_off_force_comes_near_jkr_s_as_the_square(parameter: float) -> None:
    """0.10920 is the limit; the next order is about −0.1/λ of it at λ = 10."""
    excess = (-Reduced(parameter).critical.load / 1.5 - 1.0) * parameter**2
    assert excess == pytest.approx(0.1092, rel=1.0 / parameter**1.5)


@pytest.mark.parametrize("mu", TABOR)
def test_a_paraboloid_by_quadrature_is_maugis_s(mu: float) -> None:
    exact, body = of_tabor(mu), paraboloid(mu)
    marks = (
        (body.critical, exact.reduced.critical),
        (body.free, exact.reduced.free),
        (body.snap_out, exact.reduced.snap_out),
        *((body.state(a * exact.unit_radius), exact.reduced.of_radius(a)) for a in (0.0, 0.3, 1.0, 5.0)),
    )
    unit = exact.unit_radius
    for found, reduced in marks:
        wanted = exact.state(reduced)
        assert (found.a, found.c) == pytest.approx((wanted.a, wanted.c), rel=0.0, abs=1e-10 * max(unit, wanted.c))
        assert found.displacement == pytest.approx(wanted.displacement, rel=1e-10, abs=1e-10 * unit**2)
        assert found.force == pytest.approx(wanted.load, rel=1e-10, abs=1e-10 * exact.unit_force)
    assert (body.fold is not None) == exact.reduced.has_fold == (mu > 0.84)


@pytest.mark.parametrize(("body", "mu"), [(PARABOLA, 0.1), (QUARTIC, 5.0)])
def test_the_surface_under_the_pressure_has_no_gap_in_contact_and_the_range_at_c(body: Body, mu: float) -> None:
    """u(r) = (4/πE*) ∫ p s K(k)/(r + s) ds, 1 − k² = ((r − s)/(r + s))²: no transform at all."""
    one, a = tip_of(body, mu), 0.8
    state = one.state(a)

    def pressure(s: float) -> float:
        return one.pressure(s, state) if s < a else -one.stress

    def down(r: float) -> float:
        def ring(s: float) -> float:
            return 4.0 / math.pi * pressure(s) * s / (r + s) * float(ellipkm1(((r - s) / (r + s)) ** 2))

        ends = sorted({0.0, a, state.c, *([r] if r < state.c else [])})
        pieces = (quad(ring, low, high, epsrel=1e-7, limit=200)[0] for low, high in pairwise(ends))
        return float(sum(pieces))

    def gap(r: float) -> float:
        return body.height(r) - state.displacement + down(r)

    assert gap(0.6) == pytest.approx(0.0, abs=1e-6 * one.reach)
    assert gap(state.c) == pytest.approx(one.reach, rel=1e-6)
    assert 0.0 < gap(0.5 * (a + state.c)) < one.reach < gap(1.1 * state.c)


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize(("mu", "a"), [(0.1, 1.7), (5.0, 0.5)])
def test_boundary_elements_come_near_as_the_third_power(name: str, mu: float, a: float) -> None:
    body, height = BODIES[name]
    exact = tip_of(body, mu).state(a)
    solved = [Elements(height, 1.0, mu, 1.0 / mu, body.kinks, count).solved(a) for count in (50, 100, 200)]
    errors = np.array(
        [[one.force - exact.force, one.c - exact.c, one.displacement - exact.displacement] for one in solved]
    )
    forces = max(math.pi, abs(exact.force))
    assert np.abs(errors[-1]) == pytest.approx(0.0, abs=1e-5 * forces)
    assert abs(errors[-1, 1]) < 2e-6 * exact.c
    assert abs(errors[-1, 0] - (errors[-1, 0] - errors[-2, 0]) / -7.0) < 1e-6 * forces  # what third order leaves
    assert errors[1, 1] / errors[2, 1] == pytest.approx(8.0, rel=0.05)
    assert all(one.violation() <= 0.0 for one in solved)


@pytest.mark.parametrize("name", BODIES)
def test_an_active_set_at_a_displacement_finds_the_same_contact(name: str) -> None:
    body, height = BODIES[name]
    one, a = tip_of(body, 1.0), 1.7
    problem = Elements(height, 1.0, 1.0, 1.0, body.kinks)
    found = problem.at(one.state(a).displacement, 0.8 * a, 1.2 * a)
    assert found.a == pytest.approx(a, rel=1e-5)
    touching = problem.contact_set(
        found.displacement,
        np.concatenate([found.ends, found.a + (found.c - found.a) * np.linspace(0.0, 1.0, 200)[1:] ** 2]),
    )
    edge = found.ends.size - 1
    assert touching[: edge - 1].all()
    assert not touching[edge:].any()


@pytest.mark.parametrize("body", [PARABOLA, QUARTIC, WORN, TIP])
def test_the_zone_before_contact_goes_over_into_the_contact(body: Body) -> None:
    one = tip_of(body, 0.3)
    narrow, touching = one.narrowest, one.state(0.0)
    assert one.fold is None
    assert astuple(one.alone(touching.c)) == pytest.approx(astuple(touching), rel=1e-10)
    assert astuple(one.state(1e-7)) == pytest.approx(astuple(touching), rel=1e-6, abs=2e-7)
    for c in (narrow, 0.5 * (narrow + touching.c), touching.c):
        zone = one.alone(c)
        down = -one.stress * pressed_down(np.array([0.0, c]), np.array([c]))[:, 0]
        gaps = np.array([0.0, body.height(c)]) - zone.displacement + down
        assert gaps[1] == pytest.approx(one.reach, rel=1e-12)
        assert gaps[0] == pytest.approx(0.0, abs=1e-12) if c == touching.c else gaps[0] > 0.0
    middle, width = 0.5 * (narrow + touching.c), 1e-4 * touching.c
    wide, close = (one.alone(middle + side * width) for side in (1.0, -1.0))
    work = (one.energy(wide) - one.energy(close)) / (wide.displacement - close.displacement)
    assert work == pytest.approx(one.alone(middle).force, rel=1e-6)
    assert one.snap_out == one.alone(narrow)
    assert one.snap_out.displacement < -one.reach
    assert min(one.alone(narrow * k).displacement for k in (0.97, 1.03)) > one.snap_out.displacement


@pytest.mark.parametrize("mu", [0.3, 3.0])
@pytest.mark.parametrize("body", [PARABOLA, WORN])
def test_a_state_is_found_by_its_force_and_displacement_and_a_loop_loses_its_area(body: Body, mu: float) -> None:
    one = tip_of(body, mu)
    for state in (one.state(1.8), one.free, one.under(0.5 * one.critical.force)):
        assert one.at(state.displacement) is not None
        assert one.under(state.force).a == pytest.approx(state.a, rel=1e-9)
        assert one.at(state.displacement).a == pytest.approx(state.a, rel=1e-9)  # type: ignore[union-attr]
    last = one.snap_out
    assert one.at(1.0001 * last.displacement) is None
    u = np.linspace(0.0, 1.0, 17)
    width = -one.reach - last.displacement
    forces = np.array([(one.at(float(last.displacement + width * x**2)) or last).force for x in u])
    assert one.touched is not None
    lost = one.energy(last) - one.energy(one.touched)
    assert lost == pytest.approx(-float(simpson(forces * 2.0 * width * u, u)), rel=1e-4)
