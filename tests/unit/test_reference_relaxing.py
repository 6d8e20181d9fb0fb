"""Claim: the references of relaxing half-spaces, by quadrature and by springs with events, agree with each other, and
those of impacts and of a receding edge with the closed forms and published numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from validation.references.creeping import Creeping
from validation.references.impact import Adhesive, elastic, kelvin_voigt, relaxing
from validation.references.receding_edge import Receding
from validation.references.recovering import Prony, Retarded, evenly, followed
from validation.references.relaxing import Indentation, KelvinVoigt, Legs, Material, Power, Punch, sphere

SOLID, FLUID = Material(((0.5, 1.0),)), Material(((1.0, 1.0),))
THREE = Material(((0.3, 0.2), (0.3, 1.0), (0.2, 10.0)))
BODIES = pytest.mark.parametrize("body", [sphere(1.0), Power(1.0, 0.1), Power(3.0, 0.3)], ids=["sphere", "cone", "3"])
TRIANGLE = Legs(((0.0, 0.0), (1.0, 0.1), (2.0, 0.0)))
STEP, SINCE = Legs(((0.0, 0.0), (1e-4, 0.2), (5.0, 0.2))), 5.0 - 0.5e-4
"""A steep leg, and the time since its middle: a step but for the square of its length."""
CELLS = 1000
"""Springs: the error is about 1/(4 CELLS^2)."""


@pytest.mark.parametrize("material", [SOLID, FLUID, THREE])
def test_creep_undoes_relaxation(material: Material):
    for t in (0.3, 2.0):
        past = quad(lambda s, t=t: material.relaxed(t - s) * material.creep_rate(s), 0.0, t, epsabs=0.0, epsrel=1e-12)
        assert past[0] + material.relaxed(t) * material.creep(0.0) == pytest.approx(1.0, rel=1e-12)
        assert quad(material.creep, 0.0, t)[0] == pytest.approx(material.yielded(t), rel=1e-12)
        assert quad(material.relaxed, 0.0, t)[0] == pytest.approx(material.impulse(t), rel=1e-12)


@pytest.mark.parametrize(
    ("material", "body"), [(SOLID, Power(3.0, 0.3)), (FLUID, sphere(1.0)), (THREE, Power(1.0, 0.1))]
)
def test_ting_and_springs(material: Material, body: Power):
    exact = Indentation(body, material, TRIANGLE)
    found = followed(Prony(material), body.depth, body.radius(0.1001), TRIANGLE, evenly(TRIANGLE, 30), CELLS)
    assert max(abs(exact.force(t) - F) for t, F in zip(found.times, found.force, strict=True)) < 1e-6 * exact.peak[1]
    assert found.last == pytest.approx(exact.end, rel=1e-12)
    assert exact.work == pytest.approx(found.work[-1], rel=1e-4)
    assert found.touches == 1


def test_a_sphere_that_is_pushed_in():
    """F = (4/3) sqrt(R) int E(t - s) d(d^1.5)."""
    exact = Indentation(sphere(2.0), THREE, Legs(((0.0, -0.1), (1.0, 0.1))))
    start, rate = exact.start, 0.2
    past = quad(lambda s: THREE.relaxed(1.0 - s) * 1.5 * math.sqrt(rate * (s - start)) * rate, start, 1.0, epsrel=1e-12)
    assert start == pytest.approx(0.5, rel=1e-14)
    assert exact.force(1.0) == pytest.approx(4.0 / 3.0 * math.sqrt(2.0) * past[0], rel=1e-9)
    assert math.isinf(exact.end)


def test_touching_again_has_order_two_in_the_springs():
    saw = Legs(((0.0, 0.0), (1.0, 0.1), (1.5, 0.0), (2.5, 0.09), (3.0, 0.03), (4.0, 0.03), (5.0, -0.1)))
    body = sphere(1.0)
    coarse, fine = (
        followed(Prony(THREE), body.depth, body.radius(0.1001), saw, evenly(saw, 8), n) for n in (500, 1000)
    )
    assert np.abs(coarse.force - fine.force).max() < 3e-6 * fine.force.max()
    assert fine.touches >= 2
    assert coarse.last == pytest.approx(fine.last, rel=1e-12)


def test_a_force_and_its_approach():
    """The displacement under a force, given to springs, has that force, but for its straight pieces."""
    body, force = sphere(1.0), Legs(((0.0, 0.0), (1.0, 0.05), (2.0, 0.05), (3.0, 0.0)))
    exact = Creeping(body, SOLID, force)
    off = []
    for count in (20, 40):
        share = np.linspace(0.0, 1.0, count + 1)
        turn = exact.turn
        times = np.concatenate([turn * 0.5 * (1.0 - np.cos(math.pi * share)), turn + (2.99 - turn) * share[1:]])
        d = Legs(tuple((float(t), exact.displacement(float(t)) if t > 0.0 else 0.0) for t in times))
        found = followed(Prony(SOLID), body.depth, body.radius(1.001 * max(d.values)), d, d.times, CELLS)
        off.append(max(abs(F - force(t)) for t, F in zip(found.times, found.force, strict=True)))
    assert off[1] < 6e-3 * 0.05
    assert off[0] / off[1] > 3.0


def test_punch():
    punch = Punch(2.0, SOLID)
    assert punch.displacement(STEP, 5.0) == pytest.approx(0.2 / 4.0 * SOLID.creep(SINCE), rel=1e-8)
    assert punch.force(STEP, 5.0) == pytest.approx(4.0 * 0.2 * SOLID.relaxed(SINCE), rel=1e-8)


def test_kelvin_and_voigt_by_springs():
    """A pressure that jumps at the edge: of first order in the springs."""
    law, body = KelvinVoigt(sphere(1.0), 0.3), sphere(1.0)
    found = followed(Retarded(0.3), body.depth, body.radius(0.1001), TRIANGLE, evenly(TRIANGLE, 8), 20 * CELLS)
    work = quad(lambda d: law.force(d, 0.1) - law.force(d, -0.1), 0.0, 0.1, limit=200)[0]
    assert found.work[-1] == pytest.approx(work, rel=1e-3)
    for t, d, F in zip(found.times, found.displacement, found.force, strict=True):
        assert pytest.approx(law.force(d, 0.1 if t <= 1.0 else -0.1), abs=2e-5 * found.force.max()) == F
    assert found.last == pytest.approx(2.0 - 0.3, rel=1e-12)


@pytest.mark.parametrize(("time", "restitution"), [(0.1, 0.8327), (0.3, 0.6091), (1.0, 0.2808)])
def test_impact_on_kelvin_and_voigt(time: float, restitution: float):
    assert kelvin_voigt(KelvinVoigt(sphere(1.0), time), 1.0, 1.0).restitution == pytest.approx(restitution, abs=5e-5)


@BODIES
def test_elastic_impact(body: Power):
    closed, motion = elastic(body, 2.0, 3.0, 0.5), kelvin_voigt(KelvinVoigt(body, 0.0, 2.0), 3.0, 0.5)
    for name, value in vars(closed).items():
        assert getattr(motion, name) == pytest.approx(value, rel=1e-8)


def test_impact_on_a_solid_that_does_not_relax_in_time():
    """Slow arms: elastic with E_0."""
    slow, stiff = relaxing(sphere(1.0), Material(((0.5, 1e6),)), 1.0, 1.0), elastic(sphere(1.0), 1.0, 1.0, 1.0)
    for name, value in vars(stiff).items():
        assert getattr(slow, name) == pytest.approx(value, rel=2e-6)


def test_impact_and_springs():
    """The motion of the reference, given to springs, has the force m d''."""
    one = relaxing(sphere(1.0), SOLID, 1.0, 1.0)
    coarse, fine = _bounced(200), _bounced(400)
    assert one.restitution == pytest.approx(fine + (fine - coarse) / 3.0, abs=1e-5)


def _bounced(steps: int) -> float:
    """e by leap-frog of a chain of springs, whose surface recovers within each step, in 1/steps of a time unit."""
    h, x, d, v, F, t = 1.0 / steps, (np.arange(800) + 0.5) / 600.0, 0.0, 1.0, 0.0, 0.0
    share, tau = SOLID.terms[0]
    fade, gain = math.exp(-h / tau), -tau / h * math.expm1(-h / tau)
    u, s = np.zeros(x.size), np.zeros(x.size)
    while F > 1e-9 or t < 1.0:
        v -= 0.5 * h * F
        d += h * v
        free = share * (gain * u - fade * s) / (SOLID.rest + share * gain)
        new = np.maximum(d - x**2, free)
        s, u = fade * s + gain * (new - u), new
        F = float((SOLID.rest * u + share * s).clip(0.0).sum() / 300.0)
        v -= 0.5 * h * F
        t += h
    return -v


def test_loss_of_an_adhesive_impact():
    one = Adhesive(sphere(1.0), 0.01)
    assert one.lost == pytest.approx(7.0922 * 0.01 ** (5.0 / 3.0), rel=1e-5)
    assert one.lost_by_force == pytest.approx(one.lost, rel=1e-10)
    fast = one.impact(1.0, 1e3 * one.sticking_velocity(1.0))
    assert fast.restitution == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("velocity", "ratio"), [(1e-4, 1.0065), (1e-2, 1.1000), (1.0, 2.2848)])
def test_pull_off_at_a_velocity(velocity: float, ratio: float):
    """v_0 = E* = R = 1, W = 0.01, n = 0.6, and again by an explicit rule."""
    contact = Adhesive(sphere(1.0), 0.01)
    force, _ = Receding(contact, 1.0, 0.6).pull_off(0.1, velocity)
    assert force / (1.5 * math.pi * 0.01) == pytest.approx(ratio, abs=5e-5)


def test_duration_of_an_adhesive_impact():
    """By leap-frog in time, the radius by Newton's method."""
    one, step = Adhesive(sphere(1.0), 1e-3), 2e-3
    velocity = 1.5 * one.sticking_velocity(1.0)
    d, v, a, t, least = 0.0, velocity, one.touch, 0.0, one.displacement(one.grips)
    while d > least:
        v -= 0.5 * step * one.force(a)
        last, d, t = d, d + step * v, t + step
        for _ in range(20):
            a = max(a + (max(d, least) - one.displacement(a)) / one.slope(a), one.grips * (1.0 + 1e-9))
        v -= 0.5 * step * one.force(a)
    t -= step * (least - d) / (last - d)
    exact = one.impact(1.0, velocity)
    assert t == pytest.approx(exact.contact_time, rel=1e-6)
    assert -v / velocity == pytest.approx(exact.restitution, rel=1e-3)
