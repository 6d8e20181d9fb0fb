"""Random scenes on the rigid plane with their numbers by quadrature: loads, tensions, pull-offs, paths, slip.

All numbers are those of the body itself (`references.axisymmetric`); a table's are of the body that its points were
taken from. In a part of the scenes everything is given with units, and compared in SI.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from validation.hard.plane_bodies import KINKED, SMOOTH, Scene, elastic, kinked_body, sampled, smooth_body, with_units
from validation.references.axisymmetric import Body, Contact, Slipping, lost_on_path, with_rest_radius

SHARES = {"kinked": 0.22, "loop": 0.22, "tangential": 0.12, "smooth": 0.44}
"""Groups of scenes: tables with kinks in any experiment; adhesive paths of any profile; friction; all others."""
NARROW, WIDE = 5.0, 60.0
"""Particles in a₀."""
WITH_UNITS, AUTOMATIC = 0.35, 0.25
"""Shares of scenes with units, and with the program's own spacing."""
DIGITS = (None, None, 9, 7)
"""Of the heights in a table; None: all of them."""
POINTS = (5.0, 60.0)
"""Points of a table from the axis to the kink."""
MOST_POINTS = 3000
REFERENCE = 1e-8
"""Relative error of the quadratures."""
Pressure = Callable[[float], float]
SAMPLED = "sampled"
"""A table of a paraboloid."""


@dataclass(frozen=True)
class Drawn:
    """A scene, its numbers [in units of its own lengths and E*], what turns them into SI, and their relative error.

    `pressures` are p(r) by the name of the state, `force` is F of every load step by its displacement; numbers that
    are inf must be absent.
    """

    group: str
    words: str
    scene: Scene
    exact: Mapping[str, float]
    scales: Mapping[str, float]
    in_si: bool
    reference_error: float = REFERENCE
    pressures: Mapping[str, Pressure] = field(default_factory=dict)
    pressure_error: float = REFERENCE
    force: Pressure | None = None


def scene_of(seed: int, number: int) -> Drawn | None:
    """The scene of that number; None where its edge would jump, or a contact would cover the body."""
    try:
        return drawn(np.random.default_rng((seed, number)))
    except ValueError:
        return None


def drawn(rng: np.random.Generator) -> Drawn | None:
    """A random scene and its numbers; None where its edge would jump. Raises ValueError where it covers the body."""
    group = str(rng.choice(list(SHARES), p=list(SHARES.values())))
    kinked = group == "kinked" or (group != "smooth" and rng.random() < 0.25)
    shape = str(rng.choice(KINKED if kinked else (*SMOOTH, SAMPLED)))
    radius, slope = (float(10.0 ** rng.uniform(*ends)) for ends in ((0.0, 2.0), (-4.0, -1.5)))
    table, b = None, radius
    if kinked:
        b = radius * float(rng.uniform(0.2, 0.95))
        body = kinked_body(shape, b, slope, rng)
    else:
        table, body = smooth_body("parabola" if shape == SAMPLED else shape, radius, slope, rng)
    adhesive = group == "loop" or (group != "tangential" and rng.random() < 0.7)
    punch = math.isfinite(body.end)
    pressed = Contact(body)
    if punch:
        contact = Contact(body, 1.0, slope**2 * radius) if adhesive else pressed
    else:
        contact = with_rest_radius(body, 1.0, radius) if adhesive else pressed
    if adhesive and not contact.has_one_edge(radius):
        return None
    made = _experiment(rng, group, contact, body, radius, slope, adhesive)
    if made is None:
        return None
    kind, experiment, exact, widest, tables = made
    per = math.exp(rng.uniform(math.log(NARROW), math.log(WIDE)))
    spacing: float | None = radius / per
    if punch:  # the radius is a whole number of half spacings
        spacing = 2.0 * radius / round(2.0 * per)
    if kinked or shape == SAMPLED:
        inside = math.exp(rng.uniform(math.log(POINTS[0]), math.log(POINTS[1])))
        inside = round(inside) if rng.random() < 0.5 else inside
        reach = 1.35 * widest
        pitch = max(b / inside, reach / MOST_POINTS)
        table = sampled(body, pitch, reach, DIGITS[int(rng.integers(len(DIGITS)))])
    assert table is not None
    words = f"{shape}, {'adhesive ' if adhesive else ''}{kind}"
    tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
    automatic, units = rng.random() < AUTOMATIC, rng.random() < WITH_UNITS
    return written(rng, group, words, table, spacing, automatic, units, tolerance, contact, experiment, exact, tables)


Numbers = dict[str, Any]
"""By name, and p(r) by the names of states."""
Made = tuple[str, Scene, Numbers, float, Scene] | None


def _experiment(
    rng: np.random.Generator, group: str, contact: Contact, body: Body, radius: float, slope: float, adhesive: bool
) -> Made:
    if group == "tangential":
        return _tangential(rng, contact, radius, slope)
    if group == "loop":
        return _loop(rng, contact, radius, slope)
    if adhesive:
        kind = str(rng.choice(["load", "tension", "pull_off", "pull_off", "path"]))
        return _adhesive(rng, kind, contact, radius, slope)
    return _pressed(rng, contact, radius, slope)


def pressures(contact: Contact, **states: tuple[float, float]) -> dict[str, Pressure]:
    """p(r) of states (a, d) whose body has no kink inside, by their names among the numbers."""
    body = contact.body

    def of(a: float, d: float) -> Pressure:
        middle = contact.central_pressure(a, d) if math.isinf(body.end) else d / (math.pi * a) * contact.modulus
        return lambda r: 0.0 if r >= a else contact.pressure(r, a, d) if r else middle

    rough = any(jump for jump in body.jumps)
    return {} if rough else {name: of(*state) for name, state in states.items()}


def _state(contact: Contact, a: float, d: float | None = None) -> Numbers:
    """p(0) and the largest pressure of a state; inf where there is none."""
    if math.isfinite(contact.body.end):  # its edge has no bound
        return {"peak_pressure": math.inf} if contact.work == 0.0 else {}
    return {"central_pressure": contact.central_pressure(a, d), "peak_pressure": contact.peak_pressure(a, d)}


def _pressed(rng: np.random.Generator, contact: Contact, radius: float, slope: float) -> Made:
    exact: Numbers
    a = radius * float(10.0 ** rng.uniform(-0.1, 0.5))
    d = contact.displacement(a)
    if math.isfinite(contact.body.end):
        a, d = radius, slope * radius * float(10.0 ** rng.uniform(-1.0, 0.0))
    force = contact.force_at(a, d)
    exact = {"mean_pressure": force / (math.pi * a * a), "contact_stiffness": 2.0 * contact.modulus * a}
    exact |= _state(contact, a, d)
    if rng.random() < 0.5:
        exact |= pressures(contact, final=(a, d)) | {"force": force}
        return "load", {"kind": "load", "force": force}, exact | {"displacement": d, "contact_radius": a}, a, {}
    steps = round(math.exp(rng.uniform(0.0, math.log(60.0))))
    closed = bool(rng.random() < 0.5)
    way = {"from": d * float(rng.choice([0.0, -0.5, 0.3])), "to": d, "steps": steps, "return": closed}
    exact |= {"largest_force": force, "largest_radius": a}
    exact |= {"dissipated_energy": 0.0} if closed else {}
    return "path", {"kind": "path", "displacements": way}, exact, a, {}


def _unit(contact: Contact, radius: float) -> float:
    if math.isfinite(contact.body.end):
        return -contact.force_at(radius, contact.displacement(radius))
    return -contact.force(contact.critical(radius))


def _marks(contact: Contact, radius: float) -> Numbers:
    """F_A and the radii; separation's work, from the largest contact without a load to fixed grips."""
    critical, last = contact.critical(radius), contact.fixed_grips(radius)
    if math.isfinite(contact.body.end):
        unit = _unit(contact, radius)
        work = unit**2 / (4.0 * contact.modulus * radius)
        return {"adhesion_force": unit, "critical_radius": radius, "zero_load_radius": radius,
                "work_of_separation": work}  # fmt: skip
    rest = contact.pressed_radius(0.0, radius)
    return {
        "adhesion_force": -contact.force(critical),
        "critical_radius": critical,
        "zero_load_radius": rest,
        "work_of_separation": contact.energy(last) - contact.energy(rest),
        "adhesion_energy": math.pi * rest**2 * contact.work,
    }


def _adhesive(rng: np.random.Generator, kind: str, contact: Contact, radius: float, slope: float) -> Made:
    exact: Numbers
    unit, punch = _unit(contact, radius), math.isfinite(contact.body.end)
    if kind == "path":
        return _loop(rng, contact, radius, slope, opened=True)
    if kind == "pull_off":
        force = unit * float(10.0 ** rng.uniform(-1.0, 2.5))
        widest = contact.pressed_radius(force, radius)
        exact = _marks(contact, radius)
        exact["preload"] = force
        if not punch:
            rest, edge = exact["zero_load_radius"], exact["critical_radius"]
            states = {"zero_load": (rest, contact.displacement(rest)), "critical": (edge, contact.displacement(edge))}
            exact |= _state(contact, rest) | pressures(contact, **states)
        return kind, {"kind": kind, "preload": force}, exact, widest, {}
    outer = -contact.force_at(radius, contact.displacement(radius)) if punch else -contact.force(
        contact.softest_outer(radius))  # fmt: skip
    force = unit * float(10.0 ** rng.uniform(-2.0, 2.0)) if kind == "load" else -outer * float(rng.uniform(0.1, 0.95))
    a = contact.pressed_radius(force, radius)
    d = 0.5 * force / (contact.modulus * a) if punch else contact.displacement(a)
    exact = {"displacement": d, "contact_radius": a, "mean_pressure": force / (math.pi * a * a),
             "adhesion_energy": math.pi * a * a * contact.work}  # fmt: skip
    exact |= {} if punch else _state(contact, a)
    exact |= pressures(contact, final=(a, d)) | {"force": force}
    return kind, {"kind": "load", "force": force}, exact, max(a, radius), {}


def _loop(rng: np.random.Generator, contact: Contact, radius: float, slope: float, opened: bool = False) -> Made:
    """A path of an adhesive contact: coarse and fine, from afar or in contact, beyond separation or not."""
    punch = math.isfinite(contact.body.end)
    unit = _unit(contact, radius)
    limit = contact.displacement(contact.fixed_grips(radius))
    if punch:
        rest, deepest = 0.0, -limit * float(10.0 ** rng.uniform(-1.5, 0.5))
    else:
        load = unit * float(10.0 ** rng.uniform(-1.5, 1.5))
        rest, deepest = (contact.displacement(contact.pressed_radius(f, radius)) for f in (0.0, load))
    draw = rng.random()
    if draw < 0.6:
        apart = limit * float(rng.uniform(1.02, 3.0))
    elif draw < 0.8:
        apart = limit * float(rng.uniform(0.02, 0.98))
    else:
        apart = limit + float(rng.uniform(0.05, 1.0)) * (max(rest, 0.0) - limit)
    if rng.random() < 0.1 and apart < 0.0:
        deepest = -0.3 * apart * float(rng.random())
    if deepest - apart < 1e-3 * abs(limit):
        return None
    closed, start = (not opened and rng.random() < 0.75), str(rng.choice(["approach", "approach", "contact"]))
    inwards = bool(rng.random() < 0.6)
    steps = round(math.exp(rng.uniform(0.0, math.log(60.0))))
    ends = (apart, deepest) if inwards else (deepest, apart)
    way = {"from": ends[0], "to": ends[1], "steps": steps, "return": bool(closed)}
    there = [ends[0] + (ends[1] - ends[0]) * i / steps for i in range(steps + 1)]
    points = there + there[-2::-1] if closed else there
    lost, jumps, first, last = lost_on_path(contact, points, start, radius)
    exact = {}
    if closed and first == last:
        exact["dissipated_energy"] = lost
    elif jumps:
        exact["instability_energy"] = lost
    if (jumps or first) and any(q < p for p, q in pairwise(points)):
        exact |= _marks_of(contact, radius, points, first)
    widest = radius if punch else max(radius, contact.radius_at(deepest, radius))
    experiment = {"kind": "path", "displacements": way} | ({} if start == "approach" else {"start": start})
    return f"{'closed' if closed else 'open'} path from {start}", experiment, exact, widest, {}


def _marks_of(contact: Contact, radius: float, points: list[float], first: bool) -> Numbers:
    """The marks that the last unloading passes, of those that touch as it begins."""
    turn = len(points) - 1
    while points[turn] >= points[turn - 1]:
        turn -= 1
        if turn == 0:
            return {}
    top = turn
    while top > 0 and points[top] < points[top - 1]:
        top -= 1
    high, low = points[top], points[turn]
    if not (high > 0.0 or (first and top == 0)):
        return {}
    marks, limit = _marks(contact, radius), contact.displacement(contact.fixed_grips(radius))
    if low > limit:
        punch = math.isfinite(contact.body.end)
        peak = limit if punch else contact.displacement(marks["critical_radius"])
        rest = 0.0 if punch else contact.displacement(marks["zero_load_radius"])
        marks.pop("work_of_separation")
        if punch or low >= peak or high <= peak:
            marks.pop("adhesion_force"), marks.pop("critical_radius")
        if low >= rest or high <= rest:
            marks.pop("zero_load_radius"), marks.pop("adhesion_energy", None)
        return marks
    if high <= contact.displacement(marks["critical_radius"]):
        return {}
    if math.isfinite(contact.body.end) or high <= contact.displacement(marks["zero_load_radius"]):
        return {}
    return marks | {"fixed_grips_displacement": limit}


def _tangential(rng: np.random.Generator, contact: Contact, radius: float, slope: float) -> Made:
    """Out, back, and cycles, from amplitudes that are small against u* up to full slip."""
    if math.isfinite(contact.body.end):
        return None
    friction, ratio = float(rng.uniform(0.05, 1.0)), float(rng.uniform(0.67, 1.0))
    slipping = Slipping(contact, radius, friction, ratio)
    force = contact.force(radius)
    u = slipping.sliding * float(10.0 ** rng.uniform(-3.0, 0.1))
    exact: Numbers = {"contact_radius": radius, "normal_force": force} | _state(contact, radius)
    exact |= pressures(contact, farthest=(radius, contact.displacement(radius)))
    tables = {"friction": {"coefficient": friction}, "ratio": ratio}
    kind = str(rng.choice(["out", "back", "cycles", "cycles"]))
    if kind == "cycles":
        count, points = int(rng.integers(1, 4)), 4 * int(rng.integers(1, 12))
        along: Scene = {"cycles": {"amplitude": u, "number": count, "points": points}}
        first = slipping.loss(u)
        exact |= {"tangential_force": slipping.force(u), "stick_radius": slipping.stick(u)}
        exact |= {"dissipated_energy": (1.0 + 4.0 * count) * first, "dissipated_energy_per_cycle": 4.0 * first}
    elif kind == "out":
        along = {"displacements": {"from": 0.0, "to": u, "steps": int(rng.integers(1, 20)), "return": False}}
        exact |= {"tangential_force": slipping.force(u), "stick_radius": slipping.stick(u),
                  "dissipated_energy": slipping.loss(u)}  # fmt: skip
    else:
        along = {"displacements": {"from": 0.0, "to": u, "steps": int(rng.integers(1, 20)), "return": True}}
        half = 0.5 * u
        exact |= {"tangential_force": slipping.force(u) - 2.0 * slipping.force(half),
                  "stick_radius": slipping.stick(half),
                  "dissipated_energy": slipping.loss(u) + 2.0 * slipping.loss(half)}  # fmt: skip
    return f"tangential, {kind}", {"kind": "tangential", "normal_force": force} | along, exact, radius, tables


def written(
    rng: np.random.Generator, group: str, words: str, table: Scene, spacing: float | None, automatic: bool,
    units: bool, tolerance: float, contact: Contact, experiment: Scene, exact: Numbers, tables: Scene,
) -> Drawn:  # fmt: skip
    """The scene, with units or without; among the numbers there are p(r) by the names of states."""
    length, modulus = float(10.0 ** rng.uniform(-9.0, -3.0)), float(10.0 ** rng.uniform(6.0, 11.0))
    tables = dict(tables)
    ratio = tables.pop("ratio", None)
    bodies: Scene = {"particles": "auto", "reduction": "mdr", "lower": "rigid_plane", "profile": table}
    if contact.work > 0.0:
        tables["adhesion"] = {"work_of_adhesion": contact.work}
    scene = {"bodies": bodies, "accuracy": {"tolerance": tolerance}} | tables | {"experiment": experiment}
    if not units:
        length, modulus = 1e-6, 1e9
        if automatic and ratio is None:
            bodies |= {"spacing": "auto"}
            scene["material"] = {"contact_modulus": modulus, "length_unit": length, "force_unit": 1e-3}
        else:
            bodies |= {"spacing": spacing, "bulk_stiffness": spacing}
            bodies |= {} if ratio is None else {"bulk_stiffness_tangential": ratio * (spacing or 0.0)}
    else:
        bodies["spacing"] = "auto" if automatic else spacing
        scene = with_units(scene, length, modulus)
        scene["material"] = {"contact_modulus": f"{modulus!r} Pa"} if ratio is None else elastic(modulus, ratio)
    force = modulus * length**2
    scales = {"L": length, "F": force, "P": modulus, "S": modulus * length, "E": force * length, "1": 1.0}
    found = {name: value for name, value in exact.items() if callable(value)}
    numbers = {name: value for name, value in exact.items() if name not in found}
    return Drawn(group, words, scene, numbers, scales, units, pressures=found)
