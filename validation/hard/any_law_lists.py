"""Fixed lists of scenes for the judge of `any_law`: classes that once failed, each as a whole.

- dashpots: Kelvin and Voigt's body under given forces;
- times: Prony terms with times from 1e-6 to 1e20 times the history, and impacts;
- pressures: p(r) of bodies that relax, growing, held, receding and touched again, beside rings in three dimensions;
- paths: forces along JKR paths that begin in contact and need not cross F = 0, at three tolerances.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from validation.hard.any_law_draws import drawn, under_force
from validation.hard.plane_bodies import Scene
from validation.hard.plane_draws import Drawn, Pressure
from validation.hard.relaxing_draws import history, marked, plain, profile_of
from validation.references.impact import Adhesive
from validation.references.receding_edge import equilibrium
from validation.references.relaxing import Flat, KelvinVoigt, Legs, Material, Power, sphere
from validation.references.rings import Floats, Rings

SEED, COUNT = 20261127, 100
RINGS, STEPS, BEYOND = 500, 150, 1.25
"""Rings under 1.25 of the largest contact, steps of a leg."""
NEAR = 0.8
"""Part of the radius beyond which they are not compared."""
RELAXED, JUMPING = 1e-3, 1e-2
"""Relative errors of their pressures; where q jumps at the edge inside of a ring."""
TOLERANCES = (1e-3, 1e-4, 1e-5)
EXAMPLE = Legs(((0.0, 0.0), (0.3, 10.0), (1.0, 10.0), (2.0, 3.0)))
"""A force that once gave a peak_force of 2.6e36."""
WAY = Legs(((0.0, 0.0), (0.1, 1.0), (1.0, 1.0), (1.2, 0.85), (1.3, 0.85), (1.7, -0.3), (2.1, -0.3), (2.6, 0.8)))
"""Growing, held, receding, held, parted, touched again: displacement [over the largest]."""


def dashpots() -> Iterator[tuple[str, Drawn]]:
    """The example, and random ones."""
    law = KelvinVoigt(Power(4.0, 1e-8), 1.0)
    exact, pressures = under_force(law, EXAMPLE)
    scene = plain({"kind": "power", "exponent": 4.0, "radius": 100.0, "height": 1.0}, 1.3, 1e-3)
    scene |= history(law, EXAMPLE, by_force=True)
    yield "example", Drawn("dashpots", "example", scene, exact, {}, False, 1e-7, pressures)
    for i in range(COUNT - 1):
        yield f"dashpot_{i}", drawn(np.random.default_rng((SEED, i)), "dashpot")


def times() -> Iterator[tuple[str, Drawn]]:
    """Histories and impacts."""
    for i in range(COUNT):
        yield f"times_{i}", drawn(np.random.default_rng((SEED, i)), "times" if i % 5 < 3 else "long impact")


def pressures() -> Iterator[tuple[str, Drawn]]:
    """Sphere, cone and punch; one term, three terms, a dashpot."""
    bodies: dict[str, Power | Flat] = {"sphere": sphere(50.0), "cone": Power(1.0, 0.05), "punch": Flat(10.0)}
    laws = {"one term": Material(((0.6, 0.5),)), "three terms": Material(((0.5, 0.05), (0.3, 0.5), (0.1, 5.0)))}
    for name, body in bodies.items():
        depth = 0.5 if isinstance(body, Flat) else body.depth(10.0)
        d = Legs(tuple((t, depth * y) for t, y in WAY.points))
        for words, law in ({} | laws | {"dashpot": 0.2}).items():
            if isinstance(law, float) and isinstance(body, Flat):
                continue
            made = law if isinstance(law, Material) else KelvinVoigt(body, law)  # type: ignore[arg-type]
            for per in (20.0, 60.0):
                scene = plain(profile_of(body, 10.0), 10.0 / per, 1e-3) | history(made, d)
                slack = RELAXED if isinstance(law, Material) else JUMPING
                yield f"{name}_{words}_{per:.0f}".replace(" ", "_"), Drawn(
                    f"{words}, {name}", "rings", scene, {}, {}, False, slack, of_rings(body, made, d), slack
                )  # fmt: skip


def of_rings(body: Power | Flat, law: Material | KelvinVoigt, d: Legs) -> dict[str, Pressure]:
    """p(r) of the states that have a name; a ring is as wide as no other near the edge of a punch."""
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
            found[names[after]] = _between(rings.r, rings.pressure, rings.radius)
    return found


def _between(r: Floats, p: Floats, edge: float) -> Pressure:
    """Between rings; nan near the edge and the axis."""
    inside = r < edge

    def pressure(at: float) -> float:
        if at > 1.01 * edge:
            return 0.0
        return math.nan if at < r[12] or at > NEAR * edge else float(np.interp(at**2, r[inside] ** 2, p[inside]))

    return pressure


def paths() -> Iterator[tuple[str, Drawn]]:
    """One sphere in SI and random bodies."""
    rng = np.random.default_rng(SEED)
    for i in range(12):
        body = sphere(1.0) if i == 0 else Power(float(rng.uniform(1.0, 4.0)), float(10.0 ** rng.uniform(-2.0, 0.0)))
        a = 0.1 if i == 0 else float(10.0 ** rng.uniform(-2.0, 0.0))
        contact = Adhesive(body, 5e-5 if i == 0 else body.depth(a) ** 2 / (2.0 * math.pi * a))
        low = contact.displacement(contact.grips)
        ends = (0.05, 0.003) if i == 0 else (body.depth(2.5 * a), float(rng.uniform(0.3 * low, 0.5 * body.depth(a))))
        way = {"from": ends[0], "to": ends[1], "steps": 10, "return": False}
        for tolerance in TOLERANCES:
            scene: Scene = plain(profile_of(body, a), a / 40.0, tolerance)
            if i == 0:
                scene["bodies"] |= {"spacing": "auto"}
                scene["bodies"].pop("bulk_stiffness")
                scene["material"] = {"contact_modulus": 1e6, "length_unit": 1e-3, "force_unit": 1.0}
            scene |= {"adhesion": {"work_of_adhesion": contact.work},
                      "experiment": {"kind": "path", "start": "contact", "displacements": way}}  # fmt: skip
            group, words = f"JKR, path {tolerance:.0e}", f"n = {body.exponent:.3g}"
            yield f"path_{i}_{tolerance:.0e}", Drawn(
                group, words, scene, {}, {}, False, 1e-9, force=_force(contact)
            )  # fmt: skip


def _force(contact: Adhesive) -> Pressure:
    return lambda d: contact.force(equilibrium(contact, d))


LISTS: dict[str, Callable[[], Iterator[tuple[str, Drawn]]]] = {
    "dashpots": dashpots, "times": times, "pressures": pressures, "paths": paths,
}  # fmt: skip
