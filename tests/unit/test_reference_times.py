"""Claim: the references of half-spaces that take time (quadrature, springs with events, rings in three dimensions)
agree with each other; those of impacts and of a receding edge have closed forms and published numbers."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from validation.references.creeping import Creeping
from validation.references.impact import Adhesive, elastic, kelvin_voigt, relaxing
from validation.references.line_load import lines
from validation.references.receding_edge import Receding, path
from validation.references.recovering import Prony, Retarded
from validation.references.relaxing import Indentation, KelvinVoigt, Legs, Material, Power, sphere
from validation.references.rings import Rings

SPHERE, CONE, CUBIC = sphere(1.0), Power(1.0, 0.1), Power(3.0, 0.3)
WAY = Legs(((0.0, 0.0), (0.1, 1.0), (1.0, 1.0), (1.2, 0.85), (1.3, 0.85), (1.7, -0.3), (2.1, -0.3), (2.6, 0.8)))
"""Growing, held, receding, held, parted, touched again: displacement [over the largest]."""
CELLS = 1000
"""Springs: the error is about 1/(4 CELLS^2)."""


@pytest.mark.parametrize("material", [Material(((1.0, 1.0),)), Material(((0.3, 0.2), (0.3, 1.0), (0.2, 10.0)))])
def test_creep_undoes_relaxation(material: Material) -> None:
    for t in (0.3, 2.0):
        past = quad(lambda s, t=t: material.relaxed(t - s) * material.creep_rate(s), 0.0, t, epsabs=0.0, epsrel=1e-12)
        assert past[0] + material.relaxed(t) * material.creep(0.0) == pytest.approx(1.0, rel=1e-12)
        assert quad(material.creep, 0.0, t)[0] == pytest.approx(material.yielded(t), rel=1e-12)
        assert quad(material.relaxed, 0.0, t)[0] == pytest.approx(material.impulse(t), rel=1e-12)


@pytest.mark.parametrize(
    ("body", "law", "near"),
    [(Power(1.0, 0.05), Material(((0.5, 0.05), (0.3, 0.5), (0.1, 5.0))), 1e-3), (sphere(50.0), 0.2, 1e-2)],
)
def test_springs_are_rings_where_a_body_recedes_and_touches_again(
    body: Power, law: Material | float, near: float
) -> None:
    d = Legs(tuple((t, body.depth(10.0) * y) for t, y in WAY.points))
    springs, relaxing = (
        (Retarded(law), {"retardation": law}) if isinstance(law, float) else (Prony(law), {"terms": law.terms})
    )
    rings = Rings(np.linspace(0.0, 11.0, 111), lambda r: body.factor * r**body.exponent, **relaxing)
    ends = [t for t in d.times[1:] if d(t) > 0.0]
    found = dict(zip(ends, lines(springs, body.depth, 10.2, d, ends, body.exponent, CELLS), strict=True))
    for start, stop in pairwise(d.times):
        rings.follow(d, np.linspace(start, stop, 81).tolist())
        if stop in ends:
            line = found[stop]
            assert rings.force == pytest.approx(line.force, rel=near)
            inside = [line.edge * share for share in (0.3, 0.5, 0.7)]
            pressures = np.interp(inside, rings.r, rings.pressure)
            assert pressures == pytest.approx([line.pressure(r) for r in inside], rel=near)


def test_pressure_under_the_apex_of_a_sphere() -> None:
    """p(0) = (2/πR) ∫ E(t − s) a′(s) ds, and (2E*/πR) (a + T a′); 27.432 kPa of R = 1 mm, E* = 1 MPa after 3 s."""
    solid, growing = Material(((0.6, 1.0),)), Legs(((0.0, 0.0), (0.1, 0.01), (3.0, 0.01)))
    (line,) = lines(Prony(solid), SPHERE.depth, 0.12, growing, [3.0])
    assert line.pressure(0.0) == pytest.approx(0.027432, abs=1e-6)
    assert line.force == pytest.approx(Indentation(SPHERE, solid, growing).force(3.0), rel=2e-5)
    (line,) = lines(Retarded(0.3), SPHERE.depth, 0.12, Legs(((0.0, 0.0), (1.0, 0.01))), [1.0])
    assert line.pressure(0.0) == pytest.approx(2.0 / math.pi * (0.1 + 0.3 * 0.05), rel=2e-5)
    assert line.peak >= line.pressure(0.0)


def test_the_displacement_of_a_force_has_that_force_in_springs() -> None:
    """Also while it falls; straight lines between times, closer at the first touch."""
    solid, pressed = Material(((0.5, 1.0),)), Legs(((0.0, 0.0), (1.0, 10.0), (2.0, 3.0)))
    exact = Creeping(SPHERE, solid, pressed)
    times = np.append(np.linspace(0.0, 1.0, 41) ** 2, np.linspace(1.025, 2.0, 40)).tolist()
    d = Legs(tuple((t, exact.displacement(t) if t > 0.0 else 0.0) for t in times))
    (line,) = lines(Prony(solid), SPHERE.depth, 1.02 * SPHERE.radius(max(d.values)), d, [2.0], 2.0, 400)
    assert line.force == pytest.approx(3.0, rel=1e-3)


@pytest.mark.parametrize(("time", "restitution"), [(0.1, 0.8327), (1.0, 0.2808)])
def test_impact_on_kelvin_and_voigt(time: float, restitution: float) -> None:
    assert kelvin_voigt(KelvinVoigt(SPHERE, time), 1.0, 1.0).restitution == pytest.approx(restitution, abs=5e-5)


@pytest.mark.parametrize("body", [SPHERE, CONE, CUBIC])
def test_an_impact_without_losses_is_elastic(body: Power) -> None:
    closed, motion = elastic(body, 2.0, 3.0, 0.5), kelvin_voigt(KelvinVoigt(body, 0.0, 2.0), 3.0, 0.5)
    slow = relaxing(body, Material(((0.5, 1e6),), 2.0), 3.0, 0.5)
    for name, value in vars(closed).items():
        assert getattr(motion, name) == pytest.approx(value, rel=1e-8)
        assert getattr(slow, name) == pytest.approx(value, rel=1e-5)


@pytest.mark.parametrize(("velocity", "ratio"), [(1e-4, 1.0065), (1e-2, 1.1000), (1.0, 2.2848)])
def test_pull_off_at_a_velocity(velocity: float, ratio: float) -> None:
    """v_0 = E* = R = 1, W = 0.01, n = 0.6, and again by an explicit rule."""
    force, _ = Receding(Adhesive(SPHERE, 0.01), 1.0, 0.6).pull_off(0.1, velocity)
    assert force / (1.5 * math.pi * 0.01) == pytest.approx(ratio, abs=5e-5)


def test_a_jump_loses_johnson_and_pollock_s_energy_also_where_the_edge_is_nearly_at_rest() -> None:
    contact, d = Adhesive(SPHERE, 0.01), Legs(((0.0, -0.1), (1.0, 0.1), (3.0, -0.3)))
    assert contact.lost == pytest.approx(7.0922 * 0.01 ** (5.0 / 3.0), rel=1e-5)
    assert path(Receding(contact, math.inf, 1.0), d).work == pytest.approx(contact.lost, rel=1e-9)
    assert path(Receding(contact, 1e5, 1.0), d).work == pytest.approx(contact.lost, rel=1e-3)
    velocity = 1.5 * contact.sticking_velocity(1.0)
    assert contact.impact(1.0, velocity).restitution == pytest.approx(math.sqrt(5.0) / 3.0, rel=1e-12)
