"""Random histories of bodies that relax, with their numbers: one maximum by quadrature, several by springs with events.

A history of the displacement has one maximum or several, from touch or from afar, and ends in contact or not; one of
the force rises, is held and falls. The body is a paraboloid, a cone or a power, the material a Prony series of up to
three arms, which may relax to nothing, or Kelvin and Voigt's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import groupby, pairwise

import numpy as np

from validation.hard.plane_bodies import Scene
from validation.hard.plane_draws import Drawn, Pressure
from validation.references.creeping import Creeping
from validation.references.line_load import Line, lines
from validation.references.recovering import Followed, Prony, Retarded, evenly, followed
from validation.references.relaxing import (
    Flat,
    Indentation,
    KelvinVoigt,
    Legs,
    Material,
    Power,
    has_one_maximum,
    smooth,
)

GROUPS = {"one maximum": 0.3, "sawtooth": 0.35, "force": 0.35}
NARROW, WIDE = 8.0, 60.0
"""Particles in the contact."""
RETARDED, FLUID = 0.15, 0.2
"""Shares of Kelvin and Voigt's material, and of those that relax to nothing."""
WITH_UNITS, AUTOMATIC = 0.35, 0.25
"""Shares of scenes with units, and with the program's own spacing."""
SCALES = {"L": 1e-6, "F": 1e-6, "E": 1e-12, "T": 1e-3, "P": 1e6, "S": 1.0, "1": 1.0}
"""Of scenes with units, in SI."""
PER_LEG, SPRINGS = 60, 1000
"""Samples of a leg, and springs, of the reference with events."""
EXACT, SAMPLED, JUMPING = 1e-7, 5e-5, 2e-4
"""Relative errors of a quadrature, of ∫F dd of samples, and of that where a pressure jumps at the edge."""
LINES = 5e-5
"""Relative error of a pressure of a line load, against rings."""
NAMES = {1: "loading", -1: "unloading", 0: "holding"}
PER_CREEP = 120
"""Displacements of a leg of forces, closer where it begins."""
MORE, OFTENER = 5, 2
"""Springs and samples that many times as many where a pressure jumps at the edge."""
Law = Material | KelvinVoigt


def profile_of(body: Power | Flat, radius: float) -> Scene:
    """Its table of a scene [LU]."""
    if isinstance(body, Flat):
        return {"kind": "flat_punch", "radius": body.end}
    n = body.exponent
    if n == 2.0:
        return {"kind": "parabola", "radius": 0.5 / body.factor}
    if n == 1.0:
        return {"kind": "cone", "slope": body.factor}
    return {"kind": "power", "exponent": n, "radius": radius, "height": body.factor * radius**n}


def terms_of(law: Law) -> Scene:
    """[viscoelasticity]."""
    if isinstance(law, KelvinVoigt):
        return {"retardation_time": law.time}
    return {"terms": [{"share": share, "time": time} for share, time in law.terms]}


def plain(profile: Scene, spacing: float, tolerance: float) -> Scene:
    """A scene of model units without its experiment, E* = 1 FU/LU²."""
    bodies = {"particles": "auto", "spacing": spacing, "bulk_stiffness": spacing, "reduction": "mdr",
              "lower": "rigid_plane", "profile": profile}  # fmt: skip
    return {"bodies": bodies, "accuracy": {"tolerance": tolerance}}


def exact_of_path(body: Power | Flat, law: Law, d: Legs) -> tuple[dict[str, float], float]:
    """The numbers of a displacement over time, and their relative error."""
    values = d.values
    found = {"peak_displacement": max(values), "displacement": values[-1]}
    if has_one_maximum(d) and isinstance(law, Material) and isinstance(body, Power):
        one = Indentation(body, law, d)
        end, last = one.end, d.times[-1]
        found |= {"peak_force": one.peak[1], "force": one.force(last)}
        if last < end:
            return found | {"contact_radius": one.radius(last)}, EXACT
        return found | {"dissipated_energy": one.work, "contact_time": end - one.start}, EXACT
    rule = Prony(law) if isinstance(law, Material) else Retarded(law.time, law.modulus)
    jumps = not isinstance(law, Material)
    cells, per_leg = (MORE * SPRINGS, OFTENER * PER_LEG) if jumps else (SPRINGS, PER_LEG)
    path = followed(rule, body.depth, width_of(body, max(values), 1.0001), d, evenly(d, per_leg), cells)
    found |= {"peak_force": _top(path, d), "force": float(path.force[-1])}
    least = JUMPING if jumps else SAMPLED
    if path.radius[-1] > 0.0:
        return found, least
    return found | {"dissipated_energy": float(path.work[-1]), "contact_time": path.last - path.first}, least


def _top(path: Followed, d: Legs) -> float:
    """The largest force: a sample at a corner, or of a parabola between samples of one leg."""
    i = int(np.argmax(path.force))
    if i in (0, path.force.size - 1) or float(path.times[i]) in d.times:
        return float(path.force[i])
    before, here, after = (float(y) for y in path.force[i - 1 : i + 2])
    bend = before - 2.0 * here + after
    return here - (after - before) ** 2 / (8.0 * bend) if bend < 0.0 else here


def exact_of_creep(body: Power, material: Material, force: Legs) -> dict[str, float]:
    """The numbers of a force over time that rises, is held and falls."""
    one, last = Creeping(body, material, force), force.times[-1]
    end = one.displacement(last)
    found = {"peak_force": max(force.values), "peak_displacement": one.peak_displacement, "displacement": end,
             "force": force.values[-1]}  # fmt: skip
    if force.values[-1] > 0.0:
        return found | {"contact_radius": one.radius(last)}
    corners = sorted({*force.times, one.turn})
    lost = -sum(
        force.rate(0.5 * (low + high)) * smooth(one.displacement, low, high, 24) for low, high in pairwise(corners)
    )
    return found | {"dissipated_energy": lost, "contact_time": last - force.times[0]}


def scene_of(seed: int, number: int) -> Drawn | None:
    """The history of that number; None where the radius has several maxima under a force."""
    rng = np.random.default_rng((seed, number))
    body, radius = random_body(rng)
    group = str(rng.choice(list(GROUPS), p=list(GROUPS.values())))
    duration = float(10.0 ** rng.uniform(-1.0, 1.0))
    retarded = group != "force" and rng.random() < RETARDED
    law: Law = KelvinVoigt(body, duration * float(10.0 ** rng.uniform(-2.0, 0.0))) if retarded else _material(
        rng, duration)  # fmt: skip
    slack = EXACT
    if group == "force":
        assert isinstance(law, Material)
        legs = _forces(rng, body.volume(radius), duration)
        if not _has_one_maximum(Creeping(body, law, legs)):
            return None
        exact, path = exact_of_creep(body, law, legs), crept(body, law, legs)
    else:
        drawn = rise_and_fall if group == "one maximum" else sawtooth
        legs = path = drawn(rng, body.depth(radius), duration)
        exact, slack = exact_of_path(body, law, legs)
    more, pressures = of_lines(body, law, path, legs)
    exact = more | exact  # what is exact stays
    arms = f"{len(law.terms)} arms" if isinstance(law, Material) else "retarded"
    words = f"{body.exponent:.3g}, {group}, {arms}"
    spacing = radius / math.exp(rng.uniform(math.log(NARROW), math.log(WIDE)))
    tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
    one = plain(profile_of(body, radius), spacing, tolerance) | history(law, legs, by_force=group == "force")
    free, units = rng.random() < AUTOMATIC, rng.random() < WITH_UNITS
    if free or units:
        return in_units(group, words, one, exact, slack, free, pressures)
    return Drawn(group, words, one, exact, {}, False, slack, pressures, LINES)


def crept(body: Power, material: Material, force: Legs) -> Legs:
    """The displacements of a force over time."""
    one = Creeping(body, material, force)
    times = [a + (b - a) * (i / PER_CREEP) ** 2 for a, b in pairwise(force.times) for i in range(PER_CREEP)]
    return Legs(tuple((t, one.displacement(t)) for t in [*times, force.times[-1]]))


def marked(given: Legs) -> dict[str, float]:
    """When the states of a history are that have a name: the ends of its phases, the last one the final one."""
    kinds = [int(np.sign(b - a)) for a, b in pairwise(given.values)]
    found: dict[str, float] = {}
    counts = dict.fromkeys(NAMES.values(), 0)
    for kind, same in groupby(range(len(kinds)), key=kinds.__getitem__):
        counts[NAMES[kind]] += 1
        number = counts[NAMES[kind]]
        found[f"after_{NAMES[kind]}" + (f"_{number}" if number > 1 else "")] = given.times[list(same)[-1] + 1]
    return found | {"final": found.popitem()[1]}


def width_of(body: Power | Flat, d: float, more: float) -> float:
    """Of the springs, so much more than the contact has at most [length]."""
    return body.end if isinstance(body, Flat) else more * body.radius(d)


def of_lines(body: Power | Flat, law: Law, d: Legs, given: Legs) -> tuple[dict[str, float], dict[str, Pressure]]:
    """The pressures of the states that have a name, and the numbers that rest on what the springs then are.

    Where a displacement first begins to fall dF/dd is (2 E* a d' - flow)/d' of the leg after, and 2 E* a without the
    creep of the moment before; dashpots have a jump of F there, and no slope.
    """
    rule = Prony(law) if isinstance(law, Material) else Retarded(law.time, law.modulus)
    names, width = marked(given), width_of(body, max(d.values), 1.02)
    at = lines(rule, body.depth, width, d, sorted(names.values()), body.exponent)
    states = dict(zip(names, at, strict=True))
    last = states["final"]
    exact: dict[str, float] = {}
    if d is not given and given.values[-1] == 0.0:  # a body without a force that it is pressed by does not touch
        states["final"] = last = Line(np.zeros(0), np.zeros(0))
    if last.edge:
        force = last.force if d is given else given.values[-1]
        exact |= {"contact_radius": last.edge, "mean_pressure": force / (math.pi * last.edge**2),
                  "central_pressure": last.pressure(0.0), "peak_pressure": last.peak}  # fmt: skip
    kinds = [int(np.sign(b - a)) for a, b in pairwise(given.values)]
    if kinds[-1] == 0 and d is given:
        before = next((i for i in range(len(kinds), 0, -1) if kinds[i - 1]), 0)
        first = next((one.force for name, one in states.items() if names[name] == given.times[before]), 0.0)
        exact["relaxation"] = abs(last.force - first)
    falls = kinds.index(-1) if -1 in kinds else 0
    corner = next((one for name, one in states.items() if names[name] == given.times[falls]), None)
    if falls and corner and corner.edge and d is given:
        exact |= _slopes(law, corner, given, falls)
    return exact, {name: one.pressure for name, one in states.items() if one.edge}


def _slopes(law: Law, corner: Line, d: Legs, falls: int) -> dict[str, float]:
    if not isinstance(law, Material):
        return {"unloading_stiffness": math.inf, "creep_corrected_stiffness": math.inf}
    own = 2.0 * law.modulus * corner.edge
    rate = (d.values[falls + 1] - d.values[falls]) / (d.times[falls + 1] - d.times[falls])
    return {"unloading_stiffness": own - corner.flow / rate, "creep_corrected_stiffness": own}


def history(law: Law, legs: Legs, by_force: bool = False, **more: float) -> Scene:
    """[viscoelasticity] and [experiment]."""
    key = "force" if by_force else "displacement"
    points = [list(point) for point in legs.points]
    return {"viscoelasticity": terms_of(law), "experiment": {"kind": "history", key: points} | more}


def _has_one_maximum(one: Creeping) -> bool:
    """Whether t_1 only falls."""
    times = np.linspace(one.turn, one.force.times[-1], 12)
    before = [one.before(float(t)) for t in times]
    return all(x >= y for x, y in pairwise(before))


def random_body(rng: np.random.Generator) -> tuple[Power, float]:
    """A body, and the radius of its contact without relaxation [LU]."""
    n = float(rng.choice([2.0, 1.0, 3.0, float(rng.uniform(1.2, 4.0))]))
    radius, slope = (float(10.0 ** rng.uniform(*ends)) for ends in ((0.0, 2.0), (-4.0, -1.5)))
    return Power(n, slope * radius ** (1.0 - n) / n), radius


def _material(rng: np.random.Generator, duration: float) -> Material:
    arms = int(rng.integers(1, 4))
    shares = rng.dirichlet(np.ones(arms)) * (1.0 if rng.random() < FLUID else float(rng.uniform(0.05, 0.98)))
    times = duration * np.sort(10.0 ** rng.uniform(-1.5, 1.5, arms))
    return Material(tuple((float(p), float(tau)) for p, tau in zip(shares, times, strict=True)))


def in_legs(lengths: Sequence[float], values: Sequence[float]) -> Legs:
    """Values over time, from how long each leg lasts; the first length is the start."""
    return Legs(tuple(zip(np.cumsum(lengths).tolist(), values, strict=True)))


def _lengths(rng: np.random.Generator, count: int, duration: float) -> list[float]:
    parts = rng.dirichlet(np.full(count, 2.0)) + 0.05
    return [0.0, *(duration * np.cumsum(parts) / parts.sum()).tolist()]


def rise_and_fall(rng: np.random.Generator, depth: float, duration: float) -> Legs:
    """One maximum, held or not, with one or two rates of rising, and an end in contact or far outside."""
    start = 0.0 if rng.random() < 0.6 else -depth * float(rng.uniform(0.05, 0.5))
    values = [start]
    if rng.random() < 0.4:
        values.append(depth * float(rng.uniform(0.2, 0.8)))
    values.append(depth)
    if rng.random() < 0.4:
        values.append(depth)
    if rng.random() < 0.85:
        values.append(depth * float(rng.uniform(0.6, 0.9) if rng.random() < 0.25 else rng.uniform(-0.5, 0.0)))
    times = _lengths(rng, len(values) - 1, duration)
    return Legs(tuple(zip(times, values, strict=True)))


def sawtooth(rng: np.random.Generator, depth: float, duration: float) -> Legs:
    """Several maxima, parts that are held, and an end in contact or outside."""
    values = [0.0 if rng.random() < 0.6 else -0.3 * depth]
    for _ in range(int(rng.integers(2, 4))):
        values.append(depth * float(rng.uniform(0.3, 1.0)))
        if rng.random() < 0.25:
            values.append(values[-1])
        values.append(depth * float(rng.uniform(-0.3, 0.6)) * min(1.0, values[-1] / depth))
        if rng.random() < 0.25:
            values.append(values[-1])
    if rng.random() < 0.7:
        values.append(-depth * float(rng.uniform(0.1, 1.0)))
    times = _lengths(rng, len(values) - 1, duration)
    return Legs(tuple(zip(times, values, strict=True)))


def _forces(rng: np.random.Generator, force: float, duration: float) -> Legs:
    """A rise of one or two rates, held or not, and a fall to nothing, to a part, or none."""
    values = [0.0]
    if rng.random() < 0.3:
        values.append(force * float(rng.uniform(0.2, 0.8)))
    values.append(force)
    if rng.random() < 0.6:
        values.append(force)
    if rng.random() < 0.7 or len(values) == 2:
        values.append(0.0 if rng.random() < 0.6 else force * float(rng.uniform(0.1, 0.9)))
    return Legs(tuple(zip(_lengths(rng, len(values) - 1, duration), values, strict=True)))


def in_units(group: str, words: str, one: Scene, exact: Mapping[str, float], slack: float, free: bool,
             pressures: Mapping[str, Pressure] | None = None) -> Drawn:  # fmt: skip
    """The same in micrometres, micronewtons and milliseconds of a contact modulus of 1 MPa; with its own spacing."""
    bodies = {name: value for name, value in one["bodies"].items() if name != "bulk_stiffness"}
    bodies["spacing"] = "auto" if free else f"{bodies['spacing']!r} µm"
    lengths = {name for name in ("radius", "height") if name in bodies["profile"]}
    bodies["profile"] = {name: f"{v!r} µm" if name in lengths else v for name, v in bodies["profile"].items()}
    key, unit = ("force", "µN") if "force" in one["experiment"] else ("displacement", "µm")
    legs = [[f"{t!r} ms", f"{value!r} {unit}"] for t, value in one["experiment"][key]]
    law = one["viscoelasticity"]
    if "terms" in law:
        law = {"terms": [term | {"time": f"{term['time']!r} ms"} for term in law["terms"]]}
    else:
        law = {"retardation_time": f"{law['retardation_time']!r} ms"}
    tables = {"bodies": bodies, "material": {"contact_modulus": "1.0 MPa"}, "viscoelasticity": law,
              "experiment": {"kind": "history", key: legs}}  # fmt: skip
    return Drawn(group, words, one | tables, exact, SCALES, True, slack, pressures or {}, LINES)
