"""Claim: bodies with kinks by quadrature have the closed forms of JKR, Ejike, Mindlin and the worn tip, and energies
that are the work of their forces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from validation.hard.surfaces import kinked_body, sampled
from validation.references.axisymmetric import Body, Contact, Slipping, lost_on_path, with_rest_radius
from validation.references.mindlin import mindlin_force, mindlin_loop_area, mindlin_stick_radius

RADIUS = 100.0
SPHERE = Body(lambda r: r / RADIUS, lambda _: 1.0 / RADIUS)
WORN = Body(lambda r: r / RADIUS if r >= 3.0 else 0.0, lambda r: float(r >= 3.0) / RADIUS, (3.0,), (0.03,))
TIP = Body(lambda r: 0.02 if r >= 3.0 else 0.0, lambda _: 0.0, (3.0,), (0.02,))


def test_a_sphere_is_jkr() -> None:
    contact = with_rest_radius(SPHERE, 1.0, 7.0)
    assert contact.work == pytest.approx(2.0 * 7.0**3 / (9.0 * math.pi * RADIUS**2), rel=1e-12)
    critical, last = contact.critical(7.0), contact.fixed_grips(7.0)
    assert -contact.force(critical) == pytest.approx(1.5 * math.pi * contact.work * RADIUS, rel=1e-12)
    assert -contact.force(last) == pytest.approx(5.0 / 6.0 * math.pi * contact.work * RADIUS, rel=1e-9)
    assert contact.pressed_radius(0.0, 7.0) == pytest.approx(7.0, rel=1e-12)
    pressed = Contact(SPHERE)
    assert pressed.peak_pressure(5.0) == pytest.approx(2.0 * 5.0 / (math.pi * RADIUS), rel=1e-9)
    assert pressed.pressure(3.0, 5.0) == pytest.approx(2.0 * 4.0 / (math.pi * RADIUS), rel=1e-6)


def test_a_worn_sphere_is_ejike_s() -> None:
    """d = (a/R) √(a² − b²), F = (2E*/3R) (2a² + b²) √(a² − b²)."""
    contact, a = Contact(WORN), 5.0
    root = math.sqrt(a**2 - 3.0**2)
    assert contact.displacement(a) == pytest.approx(a / RADIUS * root, rel=1e-12)
    assert contact.force(a) == pytest.approx(2.0 / (3.0 * RADIUS) * (2.0 * a**2 + 3.0**2) * root, rel=1e-12)
    assert contact.peak_pressure(a) == math.inf
    assert contact.central_pressure(a) == pytest.approx(contact.pressure(1e-3, a), rel=1e-6)


def test_a_worn_tip_parts_where_its_edge_comes_back_to_the_land() -> None:
    contact = Contact(TIP, 1.0, 1e-4)
    assert contact.critical(3.0) == contact.fixed_grips(3.0) == 3.0
    assert -contact.force(3.0) == pytest.approx(math.sqrt(8.0 * math.pi * 1e-4 * 3.0**3), rel=1e-12)


@pytest.mark.parametrize("body", [SPHERE, WORN, TIP])
def test_an_energy_is_the_work_of_the_force_and_a_loop_loses_that_of_its_jumps(body: Body) -> None:
    contact = with_rest_radius(body, 1.0, 5.0)
    change = contact.energy(5.001) - contact.energy(4.999)
    between = contact.displacement(5.001) - contact.displacement(4.999)
    assert change / between == pytest.approx(contact.force(5.0), abs=1e-5 * abs(contact.force(6.0)))
    into, last = contact.touch_radius(5.0), contact.fixed_grips(5.0)
    u = np.linspace(0.0, 1.0, 801)
    held = [contact.radius_at(float(d), 5.0) for d in contact.displacement(last) * (1.0 - (1.0 - u[1:-1:4]) ** 2)]
    d = np.array([contact.displacement(a) for a in sorted([*held, into, last])])
    force = np.array([contact.force(a) for a in sorted([*held, into, last])])
    lost, jumps, first, final = lost_on_path(contact, [-1.0, 0.1, -1.0], "approach", 5.0)
    assert (jumps, first, final) == (2, False, False)
    assert lost == pytest.approx(-float(np.trapezoid(force, d)), rel=1e-3)
    assert lost_on_path(contact, [0.1, 0.5 * float(d[0]), 0.1], "approach", 5.0)[0] == 0.0


def test_slip_is_mindlin_s() -> None:
    slipping = Slipping(Contact(SPHERE), 5.0, 0.3, 0.8)
    normal, u = slipping.contact.force(5.0), 0.4 * slipping.sliding
    assert slipping.force(u) == pytest.approx(float(mindlin_force(u, normal, 0.3, slipping.sliding)), rel=1e-10)
    assert slipping.stick(u) == pytest.approx(float(mindlin_stick_radius(u, 5.0, slipping.sliding)), rel=1e-10)
    assert 4.0 * slipping.loss(u) == pytest.approx(mindlin_loop_area(u, normal, 0.3, slipping.sliding), rel=1e-8)


@pytest.mark.parametrize("kind", ["land_cone", "worn_ball", "two_slopes", "two_radii", "rounded_punch", "steps"])
def test_a_table_has_the_heights_of_its_body(kind: str) -> None:
    body = kinked_body(kind, 3.0, 0.02, np.random.default_rng(1))
    table = sampled(body, 0.37, 9.0, None)
    assert table["z"][-1] == pytest.approx(body.height(table["r"][-1]), rel=1e-12)
    assert all(after >= before for before, after in zip(table["z"], table["z"][1:], strict=False))
    rise = (body.transformed(4.0001) - body.transformed(3.9999)) / 0.0002
    assert body.rise(4.0) == pytest.approx(4.0 * rise, rel=1e-6)
