"""The references of pressures, dashpots and receding edges agree with closed forms and with each other."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from validation.hard.expected_in_time import crept, marked, of_lines
from validation.hard.relaxing import EXAMPLE, WAYS
from validation.references.dashpots import Pressed
from validation.references.impact import Adhesive
from validation.references.line_load import lines
from validation.references.receding_edge import Receding, path
from validation.references.recovering import Prony, Retarded
from validation.references.relaxing import Flat, Indentation, KelvinVoigt, Legs, Material, Power, integral, sphere
from validation.references.rings import Rings

RING, LINE = 5e-4, 2e-5
"""Relative errors of rings and of lines."""
RINGS, STEPS, BEYOND, NEAR = 500, 150, 1.25, 0.8
"""Rings under 1.25 of the largest contact, steps of a leg, part of the radius beyond which they are not compared."""
RELAXED, JUMPING = 1e-3, 1e-2
"""Relative errors of the pressures of rings; where q jumps at the edge inside of a ring."""
SOLID = Material(((0.6, 1.0),))
GROWING = Legs(((0.0, 0.0), (0.1, 0.01), (3.0, 0.01)))


@pytest.mark.parametrize(("profile", "force", "radii", "pressures"), [
    (lambda r: 0.5 * r**2, 4.0 / 3.0, (0.1, 0.8), [2.0 / math.pi * math.sqrt(1.0 - r * r) for r in (0.1, 0.8)]),
    (lambda r: 2.0 / math.pi * r, 1.0, (0.3, 0.8), [math.acosh(1.0 / r) / math.pi for r in (0.3, 0.8)]),
    (lambda r: 0.0 * r, 2.0, (0.1, 0.8), [1.0 / math.pi / math.sqrt(1.0 - r * r) for r in (0.1, 0.8)]),
], ids=["Hertz", "cone", "punch"])  # fmt: skip
def test_rings_are_elastic(profile, force, radii, pressures):
    edges = np.sin(np.linspace(0.0, 0.5 * math.pi, 401))
    rings = Rings(edges, profile)
    rings.step(1.0, 0.0)
    assert rings.force == pytest.approx(force, rel=1e-5)
    assert np.interp(radii, rings.r, rings.pressure) == pytest.approx(pressures, rel=RING)


def test_pressure_under_the_apex_of_a_relaxing_sphere():
    """p(0) = (2/pi R) int E(t - s) a'(s) ds; 27.432 kPa of R = 1 mm, E* = 1 MPa after 3 s."""
    for line, t in zip(lines(Prony(SOLID), sphere(1.0).depth, 0.12, GROWING, [0.1, 3.0]), (0.1, 3.0), strict=True):
        exact = 2.0 / math.pi * integral(lambda a, t=t: SOLID.relaxed(t - a * a / 0.1), 0.0, 0.1)
        assert line.pressure(0.0) == pytest.approx(exact, rel=LINE)
        assert line.force == pytest.approx(Indentation(sphere(1.0), SOLID, GROWING).force(t), rel=LINE)
    assert line.pressure(0.0) == pytest.approx(0.027432, abs=1e-6)


def test_pressure_under_the_apex_of_a_dashpot():
    """p(0) = (2E*/pi R) (a + T a')."""
    (line,) = lines(Retarded(0.3), sphere(1.0).depth, 0.12, Legs(((0.0, 0.0), (1.0, 0.01))), [1.0])
    assert line.pressure(0.0) == pytest.approx(2.0 / math.pi * (0.1 + 0.3 * 0.05), rel=LINE)


def of_rings(body, law, d):
    """p(r) of the states that have a name between rings, as wide as no other near the edge of a punch; nan beside it
    and the axis."""
    if isinstance(body, Flat):
        edges, heights = body.end * np.sin(np.linspace(0.0, 0.5 * math.pi, RINGS + 1)), lambda r: 0.0 * r
    else:
        edges = BEYOND * body.radius(max(d.values)) * np.linspace(0.0, 1.0, RINGS + 1)
        heights = lambda r: body.factor * r**body.exponent  # noqa: E731
    relaxing = {"terms": law.terms} if isinstance(law, Material) else {"retardation": law.time}
    rings, found = Rings(edges, heights, **relaxing), {}
    names = {t: name for name, t in marked(d).items()}
    for before, after in pairwise(d.times):
        rings.follow(d, np.linspace(before, after, STEPS + 1).tolist())
        if after in names and rings.force > 0.0:
            found[names[after]] = between(rings.r, rings.pressure, rings.radius)
    return found


def between(r, p, edge):
    inside = r < edge

    def pressure(at):
        if at > 1.01 * edge:
            return 0.0
        return math.nan if at < r[12] or at > NEAR * edge else float(np.interp(at**2, r[inside] ** 2, p[inside]))

    return pressure


@pytest.mark.parametrize(
    ("body", "law"),
    [
        (Flat(10.0), Material(((0.6, 0.5),))),
        (Power(1.0, 0.05), Material(((0.5, 0.05), (0.3, 0.5), (0.1, 5.0)))),
        (sphere(50.0), 0.2),
    ],
)
def test_lines_are_rings(body, law):
    """Growing, held, receding, held, and touched again."""
    made = KelvinVoigt(body, law) if isinstance(law, float) else law
    depth = 0.5 if isinstance(body, Flat) else body.depth(10.0)
    d = Legs(tuple((t, depth * y) for t, y in WAYS["touched again"].points))
    of_springs, rings = of_lines(body, made, d, d)[1], of_rings(body, made, d)
    assert rings.keys() == of_springs.keys()
    compared = 0
    for state, pressure in rings.items():
        for r in np.linspace(0.0, 10.0, 40):
            if math.isfinite(p := pressure(float(r))):
                assert of_springs[state](float(r)) == pytest.approx(p, rel=JUMPING if made is not law else RELAXED)
                compared += 1
    assert compared > 50
    assert marked(d)["final"] == d.times[-1]


def test_dashpots_under_a_force():
    """The displacement that a force gives has that force in springs."""
    law = KelvinVoigt(Power(4.0, 1e-8), 1.0)
    one = Pressed(law, EXAMPLE)
    times = [a + (b - a) * (i / 400) ** 2 for a, b in pairwise(EXAMPLE.times) for i in range(400)] + [2.0]
    d = Legs(tuple((t, one.displacement(t)) for t in times))
    found = lines(Retarded(1.0), law.body.depth, 1.02 * law.body.radius(max(d.values)), d, [1.0, 2.0], 4.0)
    assert [line.force for line in found] == pytest.approx([10.0, 3.0], rel=5e-3)


def test_a_receding_edge_loses_what_it_opens():
    """int F dd = int G 2 pi a da - U of a pull; a jump of an edge without a speed loses Johnson and Pollock's."""
    contact = Adhesive(sphere(1.0), 0.01)
    d = Legs(((0.0, -0.1), (1.0, 0.1), (3.0, -0.3)))
    assert path(Receding(contact, math.inf, 1.0), d).work == pytest.approx(contact.lost, rel=1e-9)
    slow = path(Receding(contact, 1e5, 1.0), d)
    assert slow.work == pytest.approx(contact.lost, rel=1e-3)
    one = Receding(contact, 1.0, 0.6)
    start = one.pressed(0.1)
    rest, displacement, work = one.separated(start, 1e-2)
    solution, top = one.drawn(start, 1e-2), contact.displacement(start)
    ends = [top - displacement, *(t for t in solution.t if t > top - displacement)]
    t = np.concatenate([np.linspace(*two, 200) for two in pairwise(ends)])
    a = solution.sol(t)[0]
    opened = -np.trapezoid((a**2 - top + t) ** 2, a)  # G 2 pi a = E* (g - d)^2
    stored, left = (r * d**2 - 2 / 3 * d * r**3 + r**5 / 5 for r, d in ((rest, displacement), (a[-1], top - t[-1])))
    assert work == pytest.approx(opened - stored + left, rel=2e-5)


def test_a_creeping_body_is_under_its_force():
    force = Legs(((0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.4)))
    d = crept(sphere(1.0), SOLID, force)
    found = lines(Prony(SOLID), sphere(1.0).depth, 1.02 * math.sqrt(max(d.values)), d, [1.0, 2.0, 3.0])
    assert [line.force for line in found] == pytest.approx([1.0, 1.0, 0.4], rel=1e-3)
