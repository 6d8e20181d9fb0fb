"""What a scene has whose bodies or adhesive edge take time, and an impact; bodies are powers of r, or punches.

One maximum of a displacement is by quadrature, several by springs with events in their own time, forces by the creep
compliance; pressures are those of line loads.
"""

import math
from collections.abc import Mapping
from functools import partial
from itertools import groupby, pairwise

import numpy as np
from scipy.interpolate import PchipInterpolator

from validation.hard.judge import Curve, Expected
from validation.hard.surfaces import Surface, power
from validation.hard.units import Scene
from validation.references import axisymmetric, creeping, dashpots, impact, line_load
from validation.references.numerics import Floats, Function
from validation.references.receding_edge import Path, Receding, path
from validation.references.recovering import Followed, Prony, Retarded, evenly, followed
from validation.references.relaxing import (
    Flat,
    Indentation,
    KelvinVoigt,
    Legs,
    Material,
    Power,
    Punch,
    has_one_maximum,
)

PER_LEG, SPRINGS = 60, 1000
"""Samples of a leg, and springs, of the reference with events."""
MORE, OFTENER = 5, 2
"""Springs and samples that many times as many where a pressure jumps at the edge."""
EXACT, SAMPLED, JUMPING = 1e-7, 5e-5, 2e-4
"""Relative errors of a quadrature, of ∫F dd of samples, and of that where a pressure jumps at the edge."""
LINES, EDGE = 5e-5, 1e-8
"""Relative errors of a pressure of a line load, against rings, and of numbers of an edge."""
PER_CREEP = 120
"""Displacements of a leg of forces, closer where it begins."""
ALONG, FEWEST = 5e-4, 0.25
"""What a force may be off along a curve, over the peak: of a sphere with 29 particles in a 4e-4, of a power n
(n + 1)/3 of that; the contact radius over the largest from which on displacements are compared: their error goes with
1/a."""
NAMES = {1: "loading", -1: "unloading", 0: "holding"}
Law = Material | KelvinVoigt
Numbers = dict[str, float]
Pressures = Mapping[str, Function]
_each = partial(np.vectorize, otypes=[float])


def expected(surface: Surface, scene: Scene) -> Expected:
    """The numbers of a history, an impact, a pull-off at a velocity."""
    body, experiment, adhesion = surface.power, scene["experiment"], scene.get("adhesion", {})
    table, kind, by_force = scene.get("viscoelasticity", {}), experiment["kind"], "force" in experiment
    given = Legs(tuple(map(tuple, experiment["force" if by_force else "displacement"] if kind == "history" else ())))
    if adhesion:
        assert isinstance(body, Power)
        contact = impact.Adhesive(body, adhesion["work_of_adhesion"])
        rate = adhesion.get("rate", {"velocity": math.inf, "exponent": 1.0})
        edge = Receding(contact, rate["velocity"], rate["exponent"])
        if kind == "pull_off":
            return _pulled(edge, experiment["preload"], experiment["velocity"])
        if kind == "history":
            return _receded(edge, given)
        return _bounced(body, contact, scene["plate"]["mass"], experiment["velocity"])
    law: Law = Material(tuple((one["share"], one["time"]) for one in table.get("terms", [])))
    if "retardation_time" in table:
        assert isinstance(body, Power)
        law = KelvinVoigt(body, table["retardation_time"])
    if kind == "impact":
        return _bounced(body, law, scene["plate"]["mass"], experiment["velocity"])
    if not by_force:
        return _pressed_in(body, law, given, scene["bodies"]["spacing"])
    if isinstance(body, Flat):
        assert isinstance(law, Material)
        return _punched(Punch(body.end, law), given)
    if isinstance(law, KelvinVoigt):
        return _under_force(law, given)
    return _crept(body, law, given)


def _bounced(body: Power | Flat, law: Law | impact.Adhesive, mass: float, velocity: float) -> Expected:
    """An impact; adhesive bodies stick below a velocity."""
    assert isinstance(body, Power)
    if isinstance(law, KelvinVoigt):
        found = impact.kelvin_voigt(law, mass, velocity)
    elif isinstance(law, Material):
        found = impact.relaxing(body, law, mass, velocity) if law.terms else impact.elastic(body, 1.0, mass, velocity)
    elif velocity > law.sticking_velocity(mass):
        found = law.impact(mass, velocity)
    else:
        lost = {"restitution": 0.0, "dissipated_energy": 0.5 * mass * velocity**2, "contact_time": math.inf}
        return Expected(lost, EXACT)
    return Expected(vars(found) | {"dissipated_energy": found.lost(mass, velocity)}, EXACT)


def _of_edge(body: Power, work: float, a: float, d: float, name: str) -> tuple[Numbers, Pressures]:
    """p(0), the largest pressure and p(r) of an edge with a jump of q, or without."""
    contact = axisymmetric.Contact(power(body, a).body, 1.0, work)
    middle = contact.central_pressure(a, d)
    peak = math.inf if d - body.depth(a) > 1e-9 * abs(d) else contact.peak_pressure(a, d)
    at = {name: lambda r: 0.0 if r >= a else contact.pressure(r, a, d) if r else middle}
    return {"central_pressure": middle, "peak_pressure": peak}, at


def _pulled(edge: Receding, preload: float, velocity: float) -> Expected:
    """A pull-off at a velocity, with all that its unloading has."""
    start, work = edge.pressed(preload), edge.contact.work
    force, critical = edge.largest(start, velocity)
    rest, d, separation = edge.separated(start, velocity)
    numbers = {"adhesion_force": force, "critical_radius": critical, "preload": preload, "zero_load_radius": rest,
               "work_of_separation": separation, "adhesion_energy": math.pi * rest**2 * work}  # fmt: skip
    more, pressures = _of_edge(edge.contact.body, work, rest, d, "zero_load")
    return Expected(numbers | more, EXACT, pressures, EDGE)


def _receded(edge: Receding, d: Legs) -> Expected:
    """A displacement over time of an edge with a speed, or without."""
    way, body, work = path(edge, d), edge.contact.body, edge.contact.work
    _, last, a, force = way.states[-1]
    numbers: Numbers = {"peak_force": max(one[3] for one in way.states), "peak_displacement": max(d.values),
                        "displacement": last, "force": force}  # fmt: skip
    pressures: dict[str, Function] = {}
    if a:
        numbers |= {"contact_radius": a, "mean_pressure": force / (math.pi * a * a),
                    "adhesion_energy": math.pi * a * a * work} | _of_edge(body, work, a, last, "final")[0]  # fmt: skip
    elif math.isfinite(way.lost):
        numbers["contact_time"] = way.lost - way.touched
        numbers |= {"dissipated_energy": way.work} if d.values[0] < 0.0 else {}
    for name, t in marked(d).items():
        _, at, radius, _ = next(one for one in way.states if one[0] == t)
        pressures |= _of_edge(body, work, radius, at, name)[1] if radius else {}
    return Expected(numbers, EDGE, pressures, EDGE, curves={"force": _withdrawn(edge, way, d)})


def _withdrawn(edge: Receding, way: Path, d: Legs) -> Curve:
    """F over the largest tension while the displacement falls, nan elsewhere."""
    t, _, radii, force = (np.array(column) for column in zip(*way.states, strict=True))
    _, first = np.unique(t, return_index=True)
    edge_at = PchipInterpolator(t[first], radii[first])

    def values(times: Floats) -> Floats:
        a = edge_at(times)
        falls = np.array([d.rate(time) < 0.0 for time in times])
        drawn = [edge.force(*one) if one[0] > 0.0 else 0.0 for one in zip(a, map(d, times), strict=True)]
        return np.where(falls, drawn, math.nan)

    return Curve("time", values, -force.min() or 1.0)


def _largest(path: Followed, d: Legs) -> float:
    """The largest force: a sample at a corner, or of a parabola between samples of one leg."""
    i = int(np.argmax(path.force))
    if i in (0, path.force.size - 1) or path.times[i] in d.times:
        return float(path.force[i])
    before, here, after = path.force[i - 1 : i + 2].tolist()
    bend = before - 2.0 * here + after
    return float(here - (after - before) ** 2 / (8.0 * bend) if bend < 0.0 else here)


def _pressed_in(body: Power | Flat, law: Law, d: Legs, spacing: float) -> Expected:
    """A displacement over time; where a pressure jumps at the edge, a particle more or less is 2 E* T d′ s."""
    rule, jumps, width = _springs(law), isinstance(law, KelvinVoigt), _width(body, max(d.values), 1.0001)
    found = {"peak_displacement": max(d.values), "displacement": d.values[-1]}
    error, scale = EXACT, 0.0

    def values(times: Floats) -> Floats:
        return followed(rule, body.depth, width, d, sorted({*times.tolist()}), SPRINGS).force[
            np.unique(times, return_inverse=True)[1]]  # fmt: skip

    if has_one_maximum(d) and isinstance(law, Material) and isinstance(body, Power):
        one = Indentation(body, law, d)
        found |= {"peak_force": one.peak[1], "force": one.force(d.times[-1])}
        if d.times[-1] < one.end:
            found["contact_radius"] = one.radius(d.times[-1])
        else:
            found |= {"dissipated_energy": one.work, "contact_time": one.end - one.start}
        values = _each(one.force)
    else:
        cells, per_leg = (MORE * SPRINGS, OFTENER * PER_LEG) if jumps else (SPRINGS, PER_LEG)
        way, error = followed(rule, body.depth, width, d, evenly(d, per_leg), cells), JUMPING if jumps else SAMPLED
        found |= {"peak_force": _largest(way, d), "force": way.force[-1]}
        if not way.radius[-1]:
            found |= {"dissipated_energy": way.work[-1], "contact_time": way.last - way.first}
    if isinstance(law, KelvinVoigt) and has_one_maximum(d):
        dashpot, before = law, 1e-12 * d.times[-1]
        scale = 2.0 * law.time * max(map(d.rate, d.times)) * spacing / ALONG
        values = _each(lambda t: dashpot.force(d(t), d.rate(t - before)))
    elif isinstance(body, Flat) and isinstance(law, Material):
        punch = Punch(body.end, law)
        values = _each(lambda t: max(0.0, punch.force(d, t)))
    more, pressures = of_lines(body, law, d, d)
    curve = Curve("time", values, scale + found["peak_force"])
    return Expected(more | found, error, pressures, LINES, curves={"force": curve})


def _springs(law: Law) -> Prony | Retarded:
    return Prony(law) if isinstance(law, Material) else Retarded(law.time, law.modulus)


def _width(body: Power | Flat, d: float, more: float) -> float:
    """Of the springs, so much more than the contact has at most [length]."""
    return body.end if isinstance(body, Flat) else more * body.radius(d)


def _crept(body: Power, material: Material, force: Legs) -> Expected:
    """A force over time that rises, is held and falls. Raises ValueError where its radius has several maxima."""
    one, last = creeping.Creeping(body, material, force), force.times[-1]
    before = [one.before(t) for t in np.linspace(one.turn, last, 12).tolist()]
    if any(x < y for x, y in pairwise(before)):
        raise ValueError("the contact radius has several maxima")
    found = {"peak_force": max(force.values), "peak_displacement": one.peak_displacement,
             "displacement": one.displacement(last), "force": force.values[-1]}  # fmt: skip
    if force.values[-1] > 0.0:
        found["contact_radius"] = one.radius(last)
    else:
        found |= {"dissipated_energy": force.work(one.displacement, one.turn), "contact_time": last - force.times[0]}
    times = [a + (b - a) * (i / PER_CREEP) ** 2 for a, b in pairwise(force.times) for i in range(PER_CREEP)]
    more, pressures = of_lines(body, material, Legs(tuple((t, one.displacement(t)) for t in [*times, last])), force)
    curve = Curve("time", _each(one.displacement), one.peak_displacement, FEWEST * one.radius(one.turn))
    return Expected(more | found, EXACT, pressures, LINES, curves={"displacement": curve})


def _punched(punch: Punch, force: Legs) -> Expected:
    """A flat punch under a force is the creep compliance itself."""
    top = max(punch.displacement(force, t) for t in evenly(force, 400))
    found = {"displacement": punch.displacement(force, force.times[-1]), "peak_displacement": top}
    places = _each(lambda t: punch.displacement(force, t))
    return Expected(found, 1e-6, curves={"displacement": Curve("time", places, top)})


def _under_force(law: KelvinVoigt, force: Legs) -> Expected:
    """Dashpots; a slope of unloading there is none, where a jump of the force is one of the rate."""
    one, last = dashpots.Pressed(law, force), force.times[-1]
    pressures: dict[str, Function] = {}
    end = one.displacement(last)
    deepest = one.displacement(min(one.turn, last))
    found = {"peak_force": max(force.values), "force": force.values[-1], "displacement": end,
             "peak_displacement": deepest, "creep_corrected_stiffness": math.inf}  # fmt: skip
    for name, t in marked(force).items():
        if force(t) > 0.0:
            a = one.radius(t)
            d = law.body.depth(a) + (law.time * one.rate(t) if t <= one.turn else 0.0)
            more, at = _of_edge(law.body, 0.0, a, d, name)
            pressures |= at
            found |= more | {"contact_radius": a, "mean_pressure": force(t) / (math.pi * a * a)} if t == last else {}
    if force.values[-1] == 0.0:
        found |= {"contact_time": last - force.times[0], "dissipated_energy": one.lost}
    elif force.values[-1] == force.values[-2]:
        found["relaxation"] = end - one.displacement(force.times[-2])
    return Expected(found, EXACT, pressures)


def marked(given: Legs) -> dict[str, float]:
    """When the states of a history are that have a name: the ends of its phases, the last one the final one."""
    kinds = [int(np.sign(b - a)) for a, b in pairwise(given.values)]
    found = {}
    counts = dict.fromkeys(NAMES.values(), 0)
    for kind, same in groupby(range(len(kinds)), key=kinds.__getitem__):
        counts[NAMES[kind]] += 1
        number = counts[NAMES[kind]]
        found[f"after_{NAMES[kind]}" + (f"_{number}" if number > 1 else "")] = given.times[list(same)[-1] + 1]
    return found | {"final": found.popitem()[1]}


def of_lines(body: Power | Flat, law: Law, d: Legs, given: Legs) -> tuple[Numbers, Pressures]:
    """The pressures of the states that have a name, and the numbers that rest on what the springs then are.

    Where a displacement first begins to fall dF/dd is (2 E* a d' - flow)/d' of the leg after, and 2 E* a without the
    creep of the moment before; dashpots have a jump of F there, and no slope.
    """
    names, width = marked(given), _width(body, max(d.values), 1.02)
    at = line_load.lines(_springs(law), body.depth, width, d, sorted(names.values()), body.exponent)
    states = dict(zip(names, at, strict=True))
    last = states["final"]
    found: Numbers = {}
    if d is not given and given.values[-1] == 0.0:  # a body without a force that it is pressed by does not touch
        states["final"] = last = line_load.Line(np.zeros(0), np.zeros(0))
    if last.edge:
        force = last.force if d is given else given.values[-1]
        found |= {"contact_radius": last.edge, "mean_pressure": force / (math.pi * last.edge**2),
                  "central_pressure": last.pressure(0.0), "peak_pressure": last.peak}  # fmt: skip
    kinds = [int(np.sign(b - a)) for a, b in pairwise(given.values)]
    if kinds[-1] == 0 and d is given:
        before = next((i for i in range(len(kinds), 0, -1) if kinds[i - 1]), 0)
        first = next((one.force for name, one in states.items() if names[name] == given.times[before]), 0.0)
        found["relaxation"] = abs(last.force - first)
    falls = kinds.index(-1) if -1 in kinds else 0
    corner = next((one for name, one in states.items() if names[name] == given.times[falls]), None)
    if falls and corner and corner.edge and d is given:
        found |= _slopes(law, corner, given, falls)
    return found, {name: one.pressure for name, one in states.items() if one.edge}


def _slopes(law: Law, corner: line_load.Line, d: Legs, falls: int) -> Numbers:
    if not isinstance(law, Material):
        return {"unloading_stiffness": math.inf, "creep_corrected_stiffness": math.inf}
    own = 2.0 * law.modulus * corner.edge
    rate = (d.values[falls + 1] - d.values[falls]) / (d.times[falls + 1] - d.times[falls])
    return {"unloading_stiffness": own - corner.flow / rate, "creep_corrected_stiffness": own}
