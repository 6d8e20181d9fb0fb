"""The generator of random scenes on the rigid plane: a class is how often each law, experiment and profile is drawn.

All are drawn in units of the model with E* = 1, with a radius of the contact and a slope there over decades; a part is
written in SI, a part leaves the spacing to the program. What a scene has is looked up in `expected`.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from validation.hard.expected import deepest, expected
from validation.hard.judge import Case
from validation.hard.surfaces import KINKED, Surface, kinked_body, smooth
from validation.hard.units import Scene, random_units
from validation.references import impact
from validation.references.axisymmetric import Contact, with_rest_radius
from validation.references.dugdale import Cohesive
from validation.references.relaxing import KelvinVoigt, Legs, Material, Power

SAMPLED = "sampled"
"""A table of a paraboloid."""
POWERS = ("parabola", "cone", "cubic", "power")
RADII, SLOPES, TOLERANCES = (0.0, 2.0), (-4.0, -1.5), (-4.0, -2.0)
"""Decades of the contact radius [LU], the slope there, the tolerance."""
PARTICLES, PARTICLES_IN_TIME = (5.0, 60.0), (8.0, 60.0)
"""In that radius."""
DIGITS = (None, None, 9, 7)
"""Of the heights in a table; None: all of them."""
POINTS, MOST_POINTS = (5.0, 60.0), 3000
"""Points of a table from the axis to the kink."""
TABOR, STEPS = (0.01, 100.0), (1.0, 150.0)
Random = np.random.Generator


@dataclass(frozen=True)
class RandomClass:
    """Random scenes: seed, how many in the short and the long form, "law, experiment" and profiles by their shares.

    Attributes:
        kinked: share of the profiles that are tables of bodies with kinks.
    """

    name: str
    seed: int
    quick: int
    full: int
    kinds: Mapping[str, float]
    shapes: Sequence[str] = POWERS
    kinked: float = 0.0

    def cases(self, count: int) -> Iterator[Case]:
        """So many of them, those left out that have no single edge or would cover their body."""
        number = made = 0
        while made < count:
            rng = np.random.default_rng((self.seed, number))
            number += 1
            with suppress(ValueError):
                case = drawn(rng, self, f"{self.name}_{self.seed}_{number - 1}")
                made += 1
                yield case


def decades(rng: Random, low: float, high: float) -> float:
    """A power of ten."""
    return float(10.0 ** rng.uniform(low, high))


def between(rng: Random, ends: tuple[float, float]) -> float:
    """A number between two, evenly by its logarithm."""
    return math.exp(rng.uniform(*np.log(ends)))


def drawn(rng: Random, of: RandomClass, name: str) -> Case:
    """A scene of a class and its numbers. Raises ValueError where its edge would jump or a contact cover the body."""
    shares = np.array([*of.kinds.values()])
    kind = str(rng.choice([*of.kinds], p=shares / shares.sum()))
    law, experiment = kind.split(", ")
    in_time = experiment in OVER_TIME
    kinked = not in_time and rng.random() < of.kinked
    shape = str(rng.choice(KINKED if kinked else of.shapes))
    radius, slope = decades(rng, *RADII), decades(rng, *SLOPES)
    b = radius * rng.uniform(0.2, 0.95) if kinked else radius
    solid = smooth("parabola" if kinked or shape == SAMPLED else shape, radius, slope, rng)
    solid = replace(solid, body=kinked_body(shape, b, slope, rng)) if kinked else solid
    per = between(rng, PARTICLES_IN_TIME if in_time else PARTICLES)
    spacing = 2.0 * radius / round(2.0 * per) if solid.punch else radius / per  # a whole number of half spacings
    scene = solid.tables(spacing, decades(rng, *TOLERANCES))
    if in_time:
        scene |= OVER_TIME[experiment](rng, solid, law)
    else:
        scales = CONTACTS[law](rng, solid)
        scene |= scales.tables | AT_REST[experiment](rng, scales)
    digits = None
    if kinked or shape == SAMPLED:
        inside = between(rng, POINTS)
        inside = round(inside) if rng.random() < 0.5 else inside
        reach = 1.35 * _widest(solid, scene)
        digits = DIGITS[int(rng.integers(len(DIGITS)))]
        solid = solid.sampled(max(b / inside, reach / MOST_POINTS), reach, digits)
        scene["bodies"]["profile"] = solid.profile
    if experiment == "tangential":
        scene["bodies"]["bulk_stiffness_tangential"] = spacing * rng.uniform(0.67, 1.0)
    units = random_units(rng)
    if digits:  # in other units a table would have all digits, and no run could know of the rounding
        units = replace(units, texts=False, automatic=False)
    if units.automatic and (in_time or experiment == "tangential"):
        units = replace(units, texts=True)
    return Case(name, kind, f"{shape}, {kind}", scene, expected(solid, scene), units)


@dataclass(frozen=True)
class Scales:
    """What experiments are drawn by: a contact, its pull-off force or its load, the displacements at which bodies part,
    rest and touch, that under a load, and the tables of its law."""

    unit: float
    limit: float
    rest: float
    under: Callable[[float], float]
    tables: Scene
    adhesive: bool = True


def _elastic(rng: Random, solid: Surface) -> Scales:
    contact, a = Contact(solid.body), solid.radius
    d = a * decades(rng, -4.0, -2.0) if solid.punch else contact.displacement(a)
    return Scales(contact.force_at(a, d), -0.5 * d, 0.3 * d, lambda force: deepest(contact, {"force": force}, a)[1], {},
                  adhesive=False)  # fmt: skip


def _friction(rng: Random, solid: Surface) -> Scales:
    if solid.punch:
        raise ValueError("no annulus of slip")
    return replace(_elastic(rng, solid), tables={"friction": {"coefficient": rng.uniform(0.05, 1.0)}},
                   limit=Contact(solid.body).displacement(solid.radius))  # fmt: skip


def _jkr(rng: Random, solid: Surface) -> Scales:
    """The contact whose radius without a load is about that of the surface."""
    a, body = solid.radius, solid.body
    contact = Contact(body, 1.0, a * decades(rng, -8.0, -3.0)) if solid.punch else with_rest_radius(body, 1.0, a)
    if not contact.has_one_edge(a):
        raise ValueError("the edge jumps")
    tension = contact.force(contact.fixed_grips(a) if solid.punch else contact.critical(a))
    rest = 0.0 if solid.punch else contact.displacement(contact.pressed_radius(0.0, a))
    return Scales(-tension, contact.displacement(contact.fixed_grips(a)), rest,
                  lambda force: deepest(contact, {"force": force}, a)[1],
                  {"adhesion": {"work_of_adhesion": contact.work}})  # fmt: skip


def cohesive(solid: Surface, mu: float) -> Cohesive:
    """The contact of E* = 1 whose radius without a load would be that of JKR, at a Tabor parameter.

    It is that of a paraboloid with the height of the body at this radius.
    """
    radius, work = solid.radius, with_rest_radius(solid.body, 1.0, solid.radius).work
    curvature = 0.5 * radius**2 / solid.body.height(radius)
    return Cohesive(solid.body, 1.0, work, math.cbrt(curvature * work**2) / mu, radius)


def _maugis(rng: Random, solid: Surface) -> Scales:
    if solid.punch:
        raise ValueError("no flank under an attraction with a range")
    one = cohesive(solid, between(rng, TABOR))
    limit = min(one.snap_out.displacement, -one.reach)
    return Scales(-one.critical.force, limit, one.free.displacement, lambda force: one.under(force).displacement,
                  {"adhesion": {"work_of_adhesion": one.work, "range": one.reach}})  # fmt: skip


def _widest(solid: Surface, scene: Scene) -> float:
    """The largest contact radius of a scene, and its attraction's edge [LU]."""
    adhesion, experiment = scene.get("adhesion", {}), scene["experiment"]
    contact = Contact(solid.body, 1.0, adhesion.get("work_of_adhesion", 0.0))
    a = max(solid.radius, deepest(contact, experiment, solid.radius)[0])
    if "range" not in adhesion:
        return a
    return Cohesive(solid.body, 1.0, contact.work, adhesion["range"], solid.radius).state(a).c


def _load(rng: Random, one: Scales) -> Scene:
    """From 0.01 to 100 times the unit."""
    force = one.unit * decades(rng, -2.0, 2.0 if one.adhesive else 0.5)
    return {"experiment": {"kind": "load", "force": force}}


def _tension(rng: Random, one: Scales) -> Scene:
    return {"experiment": {"kind": "load", "force": -one.unit * rng.uniform(0.1, 0.95)}}


def _pull_off(rng: Random, one: Scales) -> Scene:
    return {"experiment": {"kind": "pull_off", "preload": one.unit * decades(rng, -1.0, 2.5)}}


def _path(rng: Random, one: Scales) -> Scene:
    """Coarse and fine, in and out or one way, from afar or in contact, beyond separation or not."""
    deep = one.under(one.unit * decades(rng, -1.5, 1.5 if one.adhesive else 0.5))
    apart = one.limit * rng.uniform(1.02, 3.0)
    if rng.random() < 0.4:
        share = rng.uniform(0.02, 1.0)
        apart = one.limit * share if rng.random() < 0.5 else one.limit + share * (max(one.rest, 0.0) - one.limit)
    if one.adhesive and rng.random() < 0.1:
        deep = 0.3 * abs(apart) * rng.random()
    if deep - apart < 1e-3 * abs(one.limit):
        raise ValueError("no way")
    ends = (apart, deep) if rng.random() < 0.6 else (deep, apart)
    steps, closed = round(between(rng, STEPS)), rng.random() < 0.7
    way = {"from": ends[0], "to": ends[1], "steps": steps, "return": closed}
    start = str(rng.choice(["approach", "approach", "contact"])) if one.adhesive else "approach"
    ranged = "range" in one.tables.get("adhesion", {})
    return {"experiment": {"kind": "path", "displacements": way} | ({} if ranged else {"start": start})}


def _held(rng: Random, one: Scales) -> Scene:
    """A load that comes to rest in time, and a displacement that is held."""
    force = one.unit * decades(rng, -0.5, 0.5)
    tables = {"damping": {"coefficient": "auto"}}
    if rng.random() < 0.5:
        return tables | {"plate": {}, "experiment": {"kind": "load", "force": force}}
    return tables | {"experiment": {"kind": "hold", "displacement": one.under(force), "duration": 50.0}}


def _tangential(rng: Random, one: Scales) -> Scene:
    """Out, back, and cycles, from amplitudes that are small against full slip up to it."""
    u = one.tables["friction"]["coefficient"] * one.limit * decades(rng, -3.0, 0.2)
    steps, count, back = int(rng.integers(1, 20)), int(rng.integers(1, 4)), rng.random() < 0.5
    along: Scene = {"displacements": {"from": 0.0, "to": u, "steps": steps, "return": back}}
    if rng.random() < 0.5:
        along = {"cycles": {"amplitude": u, "number": count, "points": 4 * max(1, steps // 2)}}
    return {"experiment": {"kind": "tangential", "normal_force": one.unit} | along}


CONTACTS = {"elastic": _elastic, "JKR": _jkr, "Maugis": _maugis, "friction": _friction}
AT_REST = {"load": _load, "tension": _tension, "pull_off": _pull_off, "path": _path, "in time": _held,
           "tangential": _tangential}  # fmt: skip


def power_of(solid: Surface) -> Power:
    """A body that is no punch."""
    assert isinstance(solid.power, Power)
    return solid.power


def terms_of(law: Material | KelvinVoigt) -> Scene:
    """[viscoelasticity]."""
    if isinstance(law, KelvinVoigt):
        return {"retardation_time": law.time}
    return {"terms": [{"share": share, "time": time} for share, time in law.terms]}


def _law(rng: Random, solid: Surface, law: str, duration: float, fluid: float = 0.2) -> Scene:
    """The tables of a law whose times are as long as an experiment, or up to 1e20 times as long.

    `fluid`: share of the materials that relax to nothing.
    """
    radius = solid.radius
    if law in ("JKR", "rate"):
        a, body = radius * rng.uniform(0.3, 1.2), power_of(solid)
        rate = {"velocity": radius / duration * decades(rng, -0.5, 4.0), "exponent": rng.uniform(0.3, 1.0)}
        tables: Scene = {"work_of_adhesion": body.depth(a) ** 2 / (2.0 * math.pi * a)}
        return {"adhesion": tables | ({"rate": rate} if law == "rate" else {})}
    if law == "Kelvin–Voigt":
        return {"viscoelasticity": {"retardation_time": duration * decades(rng, -2.5, 0.0)}}
    if law == "elastic":
        return {}
    arms, far = int(rng.integers(1, 4)), law == "far Prony"
    flows = rng.random() < fluid and not far
    shares = rng.dirichlet(np.ones(arms)) * (1.0 if flows else rng.uniform(0.05, 0.98))
    times = duration * np.sort(10.0 ** rng.uniform(-1.5, 20.0 if far else 1.5, arms))
    return {"viscoelasticity": terms_of(Material(tuple(zip(shares.tolist(), times.tolist(), strict=True))))}


def legs(rng: Random, values: list[float], duration: float) -> Legs:
    """Values over time with legs of random lengths."""
    parts = rng.dirichlet(np.full(len(values) - 1, 2.0)) + 0.05
    return Legs(tuple(zip([0.0, *(duration * np.cumsum(parts) / parts.sum()).tolist()], values, strict=True)))


def _some(rng: Random, share: float, *values: float) -> list[float]:
    return [*values] if rng.random() < share else []


def _one_maximum(rng: Random, law: str) -> list[float]:
    """Held or not, with one or two rates of rising, and an end in contact or far outside."""
    out = 3.0 if law in ("JKR", "rate") else 0.5
    fall = rng.uniform(0.6, 0.9) if rng.random() < 0.25 else rng.uniform(-out, 0.0)
    values = [0.0 if rng.random() < 0.6 else -rng.uniform(0.05, 0.5)]
    values += [*_some(rng, 0.4, rng.uniform(0.2, 0.8)), 1.0, *_some(rng, 0.4, 1.0)]
    return [*values, *_some(rng, 0.85, fall)]


def _sawtooth(rng: Random, law: str) -> list[float]:
    """Several maxima, parts that are held, and an end in contact or outside."""
    values = [0.0 if rng.random() < 0.6 else -0.3]
    for _ in range(int(rng.integers(2, 4))):
        top = rng.uniform(0.3, 1.0)
        low = rng.uniform(-0.3, 0.6) * top
        values += [top, *_some(rng, 0.25, top), low, *_some(rng, 0.25, low)]
    return [*values, *_some(rng, 0.7, -rng.uniform(0.1, 1.0))]


def _forces(rng: Random, law: str) -> list[float]:
    """A rise of one or two rates, held or not, and a fall to nothing, to a part, or none."""
    values = [0.0, *_some(rng, 0.3, rng.uniform(0.2, 0.8)), 1.0, *_some(rng, 0.6, 1.0)]
    end = 0.0 if rng.random() < 0.6 else rng.uniform(0.1, 0.9)
    return [*values, *_some(rng, 1.0 if len(values) == 2 else 0.7, end)]


def history(legs: Legs, by_force: bool = False, **more: float) -> Scene:
    """[experiment]."""
    points = [list(point) for point in legs.points]
    return {"experiment": {"kind": "history", "force" if by_force else "displacement": points} | more}


def _history(values: Callable[[Random, str], list[float]], by_force: bool = False) -> Callable[..., Scene]:
    def made(rng: Random, solid: Surface, law: str) -> Scene:
        duration, a = decades(rng, -1.0, 1.0), solid.radius
        top = power_of(solid).volume(a) if by_force else 1e-3 * a if solid.punch else power_of(solid).depth(a)
        way = legs(rng, [top * value for value in values(rng, law)], duration)
        return _law(rng, solid, law, duration) | history(way, by_force)

    return made


def _impact(rng: Random, solid: Surface, law: str) -> Scene:
    """A mass, and a velocity with which an elastic body would have that radius at last."""
    body, mass = power_of(solid), decades(rng, -2.0, 2.0)
    velocity = float((body.depth(solid.radius) / impact.deepest(body, 1.0, mass, 1.0)) ** (1.0 + 0.5 / body.exponent))
    lasts = impact.elastic(body, 1.0, mass, velocity).contact_time
    experiment = {"kind": "impact", "velocity": velocity}
    return {"plate": {"mass": mass}, "experiment": experiment} | _law(rng, solid, law, lasts, fluid=0.0)


def _drawn_off(rng: Random, solid: Surface, law: str) -> Scene:
    """A pull-off at a velocity."""
    body, duration = power_of(solid), decades(rng, -1.0, 1.0)
    velocity = body.depth(solid.radius) / duration
    preload = body.volume(solid.radius) * decades(rng, -1.0, 0.7)
    experiment = {"kind": "pull_off", "preload": preload, "velocity": velocity}
    return _law(rng, solid, law, duration) | {"experiment": experiment}


OVER_TIME = {
    "one maximum": _history(_one_maximum), "sawtooth": _history(_sawtooth), "creep": _history(_forces, by_force=True),
    "impact": _impact, "drawn off": _drawn_off,
}  # fmt: skip
"""Of bodies that are powers of r, or punches."""
