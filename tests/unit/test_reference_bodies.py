"""Claim: the references of rigid bodies on an elastic half-space, by quadrature and by boundary elements, agree with
each other and with closed forms (Hertz, JKR, Maugis); energies are the work of forces."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import simpson

from validation.references.axisymmetric import Body, Contact, lost_on_path, with_rest_radius
from validation.references.dugdale import Cohesive
from validation.references.dugdale_elements import Elements
from validation.references.indenters import jkr
from validation.references.interaction import Floats
from validation.references.maugis import of_tabor
from validation.references.mdr import ReducedContact

PARABOLA = Body(lambda r: r, lambda _: 1.0)
QUARTIC = Body(lambda r: 4.0 * r**3, lambda r: 12.0 * r**2)
WORN = Body(lambda r: r if r >= 1.0 else 0.0, lambda r: float(r >= 1.0), (1.0,), (1.0,))
TIP = Body(lambda r: float(r >= 1.0), lambda _: 0.0, (1.0,), (1.0,))
HEIGHTS: dict[str, tuple[Body, Callable[[Floats], Floats]]] = {
    "parabola": (PARABOLA, lambda r: 0.5 * r**2),
    "power 4": (QUARTIC, lambda r: r**4),
    "land, then parabola": (WORN, lambda r: np.maximum(0.0, 0.5 * (r**2 - 1.0))),
    "land, then cone": (TIP, lambda r: np.maximum(0.0, r - 1.0)),
}


def tip_of(body: Body, mu: float) -> Cohesive:
    """E* = W = 1, of a unit length."""
    return Cohesive(body, 1.0, 1.0, 1.0 / mu, 1.0)


def test_a_sphere_is_jkr_s_and_hertz_s() -> None:
    contact, pressed = with_rest_radius(PARABOLA, 1.0, 0.7), Contact(PARABOLA)
    work = 2.0 * 0.7**3 / (9.0 * math.pi)
    by_slope, indenter = ReducedContact(PARABOLA.slope, 1.0, work), jkr(1.0, 1.0, work)
    assert contact.work == pytest.approx(work, rel=1e-12)
    assert -contact.force(contact.critical(0.7)) == pytest.approx(1.5 * math.pi * work, rel=1e-12)
    assert -contact.force(contact.fixed_grips(0.7)) == pytest.approx(5.0 / 6.0 * math.pi * work, rel=1e-9)
    assert contact.pressed_radius(0.0, 0.7) == pytest.approx(0.7, rel=1e-12)
    for one in (by_slope, indenter):
        assert one.pull_off_force() == pytest.approx(1.5 * math.pi * work, rel=1e-12)
        assert one.zero_load_radius() == pytest.approx(0.7, rel=1e-12)
        assert one.snap_in_radius() == pytest.approx(math.cbrt(2.0 * math.pi * work), rel=1e-12)
        assert float(one.force(one.radius_under(1.0))) == pytest.approx(1.0, rel=1e-12)
    assert pressed.peak_pressure(0.5) == pytest.approx(1.0 / math.pi, rel=1e-9)
    assert pressed.pressure(0.3, 0.5) == pytest.approx(0.8 / math.pi, rel=1e-6)
    assert by_slope.pressure(0.3, 0.5) == pytest.approx(contact.pressure(0.3, 0.5), rel=1e-6)


@pytest.mark.parametrize("body", [PARABOLA, WORN, TIP])
def test_an_energy_is_the_work_of_the_force_and_a_loop_loses_that_of_its_jumps(body: Body) -> None:
    contact = with_rest_radius(body, 1.0, 1.5)
    into, last = contact.touch_radius(1.5), contact.fixed_grips(1.5)
    u = np.linspace(0.0, 1.0, 801)
    held = [contact.radius_at(float(d), 1.5) for d in contact.displacement(last) * (1.0 - (1.0 - u[1:-1:4]) ** 2)]
    d, force = np.array([(contact.displacement(a), contact.force(a)) for a in sorted([*held, into, last])]).T
    lost, jumps, first, final = lost_on_path(contact, [-1.0, 0.1, -3.0], "approach", 1.5)
    assert (jumps, first, final) == (2, False, False)
    assert lost == pytest.approx(-float(np.trapezoid(force, d)), rel=1e-3)
    assert lost_on_path(contact, [0.1, 0.5 * float(d[0]), 0.1], "approach", 1.5)[0] == 0.0


@pytest.mark.parametrize("mu", [0.01, 0.5, 1.0, 100.0])
def test_a_paraboloid_by_quadrature_is_maugis_s(mu: float) -> None:
    exact = of_tabor(mu)
    unit = exact.unit_radius
    body = Cohesive(PARABOLA, 1.0, 1.0, exact.reach, 1.5 * unit)
    marks = (
        (body.critical, exact.reduced.critical),
        (body.free, exact.reduced.free),
        (body.snap_out, exact.reduced.snap_out),
        *((body.state(a * unit), exact.reduced.of_radius(a)) for a in (0.0, 0.3, 1.0, 5.0)),
    )
    for found, reduced in marks:
        wanted = exact.state(reduced)
        assert (found.a, found.c) == pytest.approx((wanted.a, wanted.c), rel=0.0, abs=1e-10 * max(unit, wanted.c))
        assert found.displacement == pytest.approx(wanted.displacement, rel=1e-10, abs=1e-10 * unit**2)
        assert found.force == pytest.approx(wanted.load, rel=1e-10, abs=1e-10 * exact.unit_force)
    assert (body.fold is not None) == exact.reduced.has_fold == (mu > 0.84)


@pytest.mark.parametrize(("name", "mu", "a"), [(name, 0.1, 1.7) for name in HEIGHTS] + [("power 4", 5.0, 0.5)])
def test_boundary_elements_come_near_as_the_third_power(name: str, mu: float, a: float) -> None:
    body, height = HEIGHTS[name]
    one = tip_of(body, mu)
    exact = one.state(a)
    solved = [Elements(height, 1.0, mu, 1.0 / mu, body.kinks, count).solved(a) for count in (50, 100, 200)]
    off = np.array([[found.force - exact.force, found.c - exact.c, found.displacement - exact.displacement]
                    for found in solved])  # fmt: skip
    forces = max(math.pi, abs(exact.force))
    assert np.abs(off[-1]) == pytest.approx(0.0, abs=1e-5 * forces)
    assert abs(off[-1, 0] - (off[-1, 0] - off[-2, 0]) / -7.0) < 1e-6 * forces  # what third order leaves
    assert off[1, 1] / off[2, 1] == pytest.approx(8.0, rel=0.05)
    assert all(found.violation() <= 0.0 for found in solved)
    if not body.kinks:
        ends, middle = solved[-1].ends, slice(60, 140)
        r = np.sqrt(0.5 * (ends[1:] ** 2 + ends[:-1] ** 2))[middle]
        pressures = [one.pressure(float(place), exact) for place in r]
        assert solved[-1].pressures[middle] == pytest.approx(pressures, abs=2e-3 * max(map(abs, pressures)))


@pytest.mark.parametrize("body", [QUARTIC, WORN])
def test_the_zone_before_contact_goes_over_into_the_contact(body: Body) -> None:
    one = tip_of(body, 0.3)
    narrow, touching = one.narrowest, one.state(0.0)
    assert one.fold is None
    assert vars(one.alone(touching.c)) == pytest.approx(vars(touching), rel=1e-10)
    assert vars(one.state(1e-7)) == pytest.approx(vars(touching), rel=1e-6, abs=2e-7)
    middle, width = 0.5 * (narrow + touching.c), 1e-4 * touching.c
    wide, close = (one.alone(middle + side * width) for side in (1.0, -1.0))
    work = (one.energy(wide) - one.energy(close)) / (wide.displacement - close.displacement)
    assert work == pytest.approx(one.alone(middle).force, rel=1e-6)
    assert one.snap_out == one.alone(narrow)
    assert min(one.alone(narrow * k).displacement for k in (0.97, 1.03)) > one.snap_out.displacement


@pytest.mark.parametrize(("body", "mu"), [(PARABOLA, 3.0), (WORN, 0.3)])
def test_a_state_is_found_by_its_force_and_displacement_and_a_loop_loses_its_area(body: Body, mu: float) -> None:
    one = tip_of(body, mu)
    for state in (one.state(1.8), one.free, one.under(0.5 * one.critical.force)):
        there = one.at(state.displacement)
        assert there is not None
        assert (one.under(state.force).a, there.a) == pytest.approx((state.a, state.a), rel=1e-9)
    last = one.snap_out
    assert one.at(1.0001 * last.displacement) is None
    u, width = np.linspace(0.0, 1.0, 17), -one.reach - last.displacement
    forces = np.array([(one.at(float(last.displacement + width * x**2)) or last).force for x in u])
    assert one.touched is not None
    lost = one.energy(last) - one.energy(one.touched)
    assert lost == pytest.approx(-float(simpson(forces * 2.0 * width * u, u)), rel=1e-4)
