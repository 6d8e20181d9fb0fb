"""Random scenes that no other generator has: rate and JKR histories, dashpots under a force, punches, far-off times.

All are drawn in units of the model with E* = 1, and a part of them is written in SI over many decades.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from validation.hard.impact_draws import numbers
from validation.hard.plane_bodies import Scene
from validation.hard.plane_draws import Drawn, Pressure
from validation.hard.plane_draws import pressures as pressures_at
from validation.hard.relaxing_draws import (
    EXACT,
    LINES,
    exact_of_path,
    history,
    in_legs,
    marked,
    of_lines,
    plain,
    profile_of,
    random_body,
    rise_and_fall,
    sawtooth,
    terms_of,
)
from validation.references.axisymmetric import Body, Contact
from validation.references.dashpots import Pressed
from validation.references.impact import Adhesive, deepest, elastic, relaxing
from validation.references.receding_edge import Path, Receding, path
from validation.references.relaxing import Flat, KelvinVoigt, Legs, Material, Power

SHARES = {"rate": 0.2, "pull_off": 0.15, "jkr": 0.1, "dashpot": 0.2, "punch": 0.1, "times": 0.15, "long impact": 0.1}
NARROW, WIDE = 8.0, 60.0
IN_SI, AUTOMATIC = 0.5, 0.25
DECADES = {"L": (-9.0, -2.0), "P": (3.0, 12.0), "T": (-9.0, 7.0)}
UNITS = {"radius": "L", "height": "L", "spacing": "L", "displacement": "L", "preload": "F", "force": "F", "time": "T",
         "retardation_time": "T", "velocity": "V", "mass": "M", "work_of_adhesion": "W"}  # fmt: skip
TEXTS = {"L": "m", "F": "N", "T": "s", "V": "m/s", "M": "kg", "W": "J/m²"}
EDGE, MOTION = 1e-8, 1e-7
Made = tuple[Scene, dict[str, float], dict[str, Pressure], float, str]
"""Tables, numbers, pressures, relative error, words."""


def scene_of(seed: int, number: int) -> Drawn:
    """The scene of that number."""
    rng = np.random.default_rng((seed, number))
    return drawn(rng, str(rng.choice(list(SHARES), p=list(SHARES.values()))))


def drawn(rng: np.random.Generator, group: str) -> Drawn:
    """A random scene of a group."""
    body, radius = random_body(rng)
    tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
    made = {"rate": _rate, "jkr": _rate, "pull_off": _drawn_off, "dashpot": dashpot, "punch": _punch,
            "times": far_times, "long impact": long_impact}[group]  # fmt: skip
    if group == "jkr":
        tables, exact, pressures, slack, words = _rate(rng, body, radius, at_once=True)
    else:
        tables, exact, pressures, slack, words = made(rng, body, radius)
    per = math.exp(rng.uniform(math.log(NARROW), math.log(WIDE)))
    shape: Power | Flat = Flat(radius) if group == "punch" else body
    spacing = 2.0 * radius / round(2.0 * per) if group == "punch" else radius / per
    one = plain(profile_of(shape, radius), spacing, tolerance) | tables
    lines = LINES if pressures and "viscoelasticity" in one else EDGE
    words = f"n = {body.exponent:.3g}, {words}"
    return written(rng, Drawn(group, words, one, exact, {}, False, slack, pressures, lines))


def written(rng: np.random.Generator, one: Drawn) -> Drawn:
    """The same scene, in a part of the cases in SI, and of these some with the program's own spacing."""
    if rng.random() > IN_SI:
        return one
    L, P, T = (float(10.0 ** rng.uniform(*DECADES[name])) for name in "LPT")
    scales = {"L": L, "P": P, "T": T, "F": P * L * L, "E": P * L**3, "S": P * L, "1": 1.0, "V": L / T, "W": P * L,
              "M": P * L * T * T}  # fmt: skip
    bodies = {name: value for name, value in one.scene["bodies"].items() if name != "bulk_stiffness"}
    if rng.random() < AUTOMATIC:
        bodies["spacing"] = "auto"
    scene = _in_si(one.scene | {"bodies": bodies}, scales) | {"material": {"contact_modulus": f"{P!r} Pa"}}
    return replace(one, scene=scene, scales=scales, in_si=True)


def _in_si(node: Mapping[str, Any], scales: Mapping[str, float]) -> Scene:
    def text(value: float, unit: str) -> str:
        return f"{value * scales[unit]!r} {TEXTS[unit]}"

    found: Scene = {}
    for name, value in node.items():
        if isinstance(value, Mapping):
            found[name] = _in_si(value, scales)
        elif name in ("displacement", "force") and isinstance(value, list):
            found[name] = [[text(t, "T"), text(v, UNITS[name])] for t, v in value]
        elif isinstance(value, list):
            found[name] = [_in_si(one, scales) if isinstance(one, Mapping) else one for one in value]
        else:
            found[name] = text(value, UNITS[name]) if name in UNITS and isinstance(value, float) else value
    return found


def contact_of(body: Power, work: float = 0.0) -> Contact:
    """The same body, whose pressure is had by quadrature."""
    n, c = body.exponent, body.factor
    return Contact(Body(lambda r: n * c * r ** (n - 1.0), lambda r: n * (n - 1.0) * c * r ** (n - 2.0)), 1.0, work)


def pressures_of(body: Power, a: float, d: float, name: str) -> tuple[dict[str, float], dict[str, Pressure]]:
    """p(0), the largest and p(r) of an edge with a jump of q, or without."""
    one = contact_of(body)
    middle = one.central_pressure(a, d)
    jump = d - body.depth(a)
    peak = math.inf if jump > 1e-9 * abs(d) else one.peak_pressure(a, d)
    return {"central_pressure": middle, "peak_pressure": peak}, pressures_at(one, **{name: (a, d)})


def _adhering(rng: np.random.Generator, body: Power, radius: float, at_once: bool = False) -> tuple[Receding, Scene]:
    contact = Adhesive(body, body.depth(radius) ** 2 / (2.0 * math.pi * radius))
    if at_once:
        return Receding(contact, math.inf, 1.0), {"work_of_adhesion": contact.work}
    speed, exponent = float(10.0 ** rng.uniform(-3.0, 1.0)), float(rng.uniform(0.3, 1.0))
    rate = {"velocity": speed, "exponent": exponent}
    return Receding(contact, speed, exponent), {"work_of_adhesion": contact.work, "rate": rate}


def _rate(rng: np.random.Generator, body: Power, radius: float, at_once: bool = False) -> Made:
    """A displacement that rises, is held or not, falls to a part or beyond separation, and may rise again."""
    one, adhesion = _adhering(rng, body, radius, at_once)
    contact = one.contact
    top = contact.displacement(contact.touch * float(rng.uniform(1.1, 3.0)))
    apart = contact.displacement(contact.grips)
    speed = (1.0 if at_once else one.speed) * body.depth(radius) / radius * float(10.0 ** rng.uniform(-3.0, 0.5))
    beyond = 0.0 if at_once else (speed / one.speed * radius / body.depth(radius)) ** one.exponent
    reach = (top - apart) * (1.0 + beyond)
    values = [float(rng.choice([0.0, 0.3 * apart])), top]
    values += [top] if rng.random() < 0.3 else []
    parts = bool(rng.random() < 0.5)
    drop = float(rng.uniform(5.0, 20.0)) * reach if parts else float(rng.uniform(0.1, 0.9)) * (top - apart)
    values.append(top - drop)
    values += [top * float(rng.uniform(0.7, 1.2))] if not parts and rng.random() < 0.3 else []
    d = in_legs([0.0] + [max(abs(b - a), 0.1 * top) / speed for a, b in pairwise(values)], values)
    way = path(one, d)
    exact, pressures = _numbers(one, way, d)
    tables = {"adhesion": adhesion, "experiment": {"kind": "history", "displacement": [list(p) for p in d.points]}}
    return tables, exact, pressures, EDGE, f"{'parts' if parts else 'stays'}, {len(values) - 1} legs"


def _numbers(one: Receding, way: Path, d: Legs) -> tuple[dict[str, float], dict[str, Pressure]]:
    body = one.contact.body
    pressures: dict[str, Pressure] = {}
    _, last, a, force = way.states[-1]
    exact = {"peak_force": max(s[3] for s in way.states), "peak_displacement": max(d.values), "displacement": last,
             "force": force}  # fmt: skip
    if a:
        exact |= {"contact_radius": a, "mean_pressure": force / (math.pi * a * a),
                  "adhesion_energy": math.pi * a * a * one.contact.work}  # fmt: skip
        exact |= pressures_of(body, a, last, "final")[0]
    elif math.isfinite(way.lost):
        exact["contact_time"] = way.lost - way.touched
        exact |= {"dissipated_energy": way.work} if d.values[0] < 0.0 else {}
    for name, t in marked(d).items():
        state = next(s for s in way.states if s[0] == t)
        if state[2]:
            pressures |= pressures_of(body, state[2], state[1], name)[1]
    return exact, pressures


def _drawn_off(rng: np.random.Generator, body: Power, radius: float) -> Made:
    """A pull-off at a velocity, with all that its unloading has."""
    one, adhesion = _adhering(rng, body, radius)
    velocity = one.speed * body.depth(radius) / radius * float(10.0 ** rng.uniform(-4.0, 0.5))
    preload = body.volume(radius) * float(10.0 ** rng.uniform(-1.0, 0.7))
    force, edge, top_a = *one.pull_off(preload, velocity), one.pressed(preload)
    top = one.contact.displacement(top_a)
    rest, d_rest, work = one.separated(top_a, velocity)
    exact = {"adhesion_force": force, "critical_radius": edge, "preload": preload, "zero_load_radius": rest,
             "work_of_separation": work, "adhesion_energy": math.pi * rest**2 * one.contact.work}  # fmt: skip
    more, pressures = pressures_of(body, rest, d_rest, "zero_load")
    assert top > d_rest
    tables = {"adhesion": adhesion, "experiment": {"kind": "pull_off", "preload": preload, "velocity": velocity}}
    return tables, exact | more, pressures, MOTION, f"V/v_0 = {velocity / one.speed:.1g}"


def dashpot(rng: np.random.Generator, body: Power, radius: float) -> Made:
    """Kelvin and Voigt's body under a force that grows, is held or not, and falls or not."""
    force, duration = body.volume(radius), float(10.0 ** rng.uniform(-1.0, 1.0))
    law = KelvinVoigt(body, duration * float(10.0 ** rng.uniform(-2.5, 1.5)))
    values = [0.0, force]
    values += [force] if rng.random() < 0.6 else []
    if rng.random() < 0.7:
        values.append(0.0 if rng.random() < 0.4 else force * float(rng.uniform(0.1, 0.9)))
    legs = in_legs([0.0, *(rng.dirichlet(np.full(len(values) - 1, 2.0)) + 0.05) * duration], values)
    exact, pressures = under_force(law, legs)
    return history(law, legs, by_force=True), exact, pressures, EXACT, f"T = {law.time / duration:.1e} of it"


def under_force(law: KelvinVoigt, force: Legs) -> tuple[dict[str, float], dict[str, Pressure]]:
    """All numbers; a slope of unloading there is none, where a jump of the force is one of the rate."""
    one, last = Pressed(law, force), force.times[-1]
    pressures: dict[str, Pressure] = {}
    end = one.displacement(last)
    deepest_d = one.displacement(min(one.turn, last))
    exact = {"peak_force": max(force.values), "force": force.values[-1], "displacement": end,
             "peak_displacement": deepest_d, "creep_corrected_stiffness": math.inf}  # fmt: skip
    for name, t in marked(force).items():
        if force(t) > 0.0:
            a = one.radius(t)
            d = law.body.depth(a) + (law.time * one.rate(t) if t <= one.turn else 0.0)
            more, p = pressures_of(law.body, a, d, name)
            pressures |= p
            exact |= more | {"contact_radius": a, "mean_pressure": force(t) / (math.pi * a * a)} if t == last else {}
    if force.values[-1] == 0.0:
        exact |= {"contact_time": last - force.times[0], "dissipated_energy": one.lost}
    elif force.values[-1] == force.values[-2]:
        exact["relaxation"] = end - one.displacement(force.times[-2])
    return exact, pressures


def _punch(rng: np.random.Generator, body: Power, radius: float) -> Made:
    """A flat punch on a body that relaxes."""
    duration, depth = float(10.0 ** rng.uniform(-1.0, 1.0)), radius * float(10.0 ** rng.uniform(-4.0, -2.0))
    legs = (rise_and_fall if rng.random() < 0.6 else sawtooth)(rng, depth, duration)
    times = duration * 10.0 ** rng.uniform(-1.5, 1.5, 2)
    law = Material(tuple((float(rng.uniform(0.05, 0.45)), float(t)) for t in times))
    exact, slack = exact_of_path(Flat(radius), law, legs)
    more, pressures = of_lines(Flat(radius), law, legs, legs)
    return history(law, legs), exact | more, pressures, slack, "punch"


def far_times(rng: np.random.Generator, body: Power, radius: float) -> Made:
    """Prony terms with times from 1e-6 to 1e20 times the history."""
    legs = rise_and_fall(rng, body.depth(radius), float(10.0 ** rng.uniform(-1.0, 1.0)))
    law = _far(rng, legs.times[-1], -6.0)
    exact, slack = exact_of_path(body, law, legs)
    more, pressures = of_lines(body, law, legs, legs)
    return history(law, legs), more | exact, pressures, max(slack, MOTION), f"times {_times(law, legs.times[-1])}"


def long_impact(rng: np.random.Generator, body: Power, radius: float) -> Made:
    """An impact with relaxation times up to 1e20 times as long."""
    mass = float(10.0 ** rng.uniform(-2.0, 2.0))
    depth = body.depth(radius)
    power = 1.0 + 0.5 / body.exponent
    velocity = (depth / deepest(body, 1.0, mass, 1.0)) ** power
    lasts = elastic(body, 1.0, mass, velocity).contact_time
    law = _far(rng, lasts, -1.0)
    tables = {"plate": {"mass": mass}, "viscoelasticity": terms_of(law),
              "experiment": {"kind": "impact", "velocity": velocity}}  # fmt: skip
    exact = numbers(relaxing(body, law, mass, velocity), mass, velocity)
    return tables, exact, {}, MOTION, f"times {_times(law, lasts)}"


def _far(rng: np.random.Generator, duration: float, least: float) -> Material:
    arms = int(rng.integers(1, 5))
    shares = rng.dirichlet(np.ones(arms)) * float(rng.uniform(0.05, 0.95))
    times = duration * np.sort(10.0 ** rng.uniform(least, 20.0 if rng.random() < 0.6 else 3.0, arms))
    return Material(tuple((float(p), float(tau)) for p, tau in zip(shares, times, strict=True)))


def _times(law: Material, duration: float) -> str:
    return ", ".join(f"{tau / duration:.0e}" for _, tau in law.terms)
