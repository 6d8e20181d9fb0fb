"""Random scenes under Dugdale's law with their numbers by quadrature: loads, tensions, pull-offs, paths of any profile.

The Tabor parameter is that of a paraboloid with the height of the body at the radius without a load of JKR's contact.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from validation.hard.plane_bodies import Scene, sampled, smooth_body
from validation.hard.plane_draws import Drawn, Pressure, written
from validation.references.axisymmetric import Body, Contact, with_rest_radius
from validation.references.dugdale import Cohesive, State

SHAPES = ("parabola", "cone", "power", "circle", "ellipsoid")
TABLE = "table"
"""Of a paraboloid or a sphere."""
ROUND = ("parabola", "circle", "ellipsoid", TABLE)
"""Those with a curvature at the apex."""
KINDS = ("load", "tension", "pull_off", "pull_off", "path", "path")
TABOR = (0.01, 100.0)
NARROW, WIDE = 5.0, 60.0
"""Particles in the radius without a load."""
POINTS, MOST_POINTS = (20.0, 100.0), 3000
"""Points of a table in that radius."""
WITH_UNITS, AUTOMATIC = 0.35, 0.25
"""Shares of scenes with units, and with the program's own spacing."""
STEPS = (8.0, 200.0)
MAIN = {
    "load": ("displacement", "contact_radius", "cohesive_radius"),
    "pull_off": ("adhesion_force", "zero_load_radius", "cohesive_radius"),
    "path": (),
}
"""Numbers that must be there, or be missing with a word; others are compared where they are."""
Made = tuple[str, Scene, dict[str, Any], float]
"""Its kind, the experiment, the numbers, the largest radius that the body must have."""


def scene_of(seed: int, number: int) -> Drawn | None:
    """The scene of that number; None where a contact would cover the body."""
    try:
        return drawn(np.random.default_rng((seed, number)))
    except ValueError:
        return None


def drawn(rng: np.random.Generator) -> Drawn | None:
    """A random scene and its numbers."""
    shape = str(rng.choice((*SHAPES, TABLE)))
    radius, slope = (float(10.0 ** rng.uniform(*ends)) for ends in ((0.0, 2.0), (-4.0, -2.0)))
    kind = str(rng.choice(("parabola", "circle"))) if shape == TABLE else shape
    profile, body = smooth_body(kind, radius, slope, rng)
    mu = float(np.exp(rng.uniform(*np.log(TABOR))))
    contact = cohesive(body, radius, mu)
    group = str(rng.choice(KINDS))
    made = _path(rng, contact) if group == "path" else _held(rng, contact, group)
    experiment, exact, widest = made[1:]
    free = contact.free.a
    spacing = free / math.exp(rng.uniform(math.log(NARROW), math.log(WIDE)))
    if shape == TABLE:
        inside = math.exp(rng.uniform(*np.log(POINTS)))
        reach = 1.35 * widest
        profile = sampled(body, max(free / inside, reach / MOST_POINTS), reach, None)
    if shape in ROUND and shape != TABLE:
        apex = body.bend(0.0)
        exact["tabor_parameter"] = math.cbrt(contact.work**2 / apex) / contact.reach
    tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
    automatic, units = rng.random() < AUTOMATIC, rng.random() < WITH_UNITS
    adhesion = {"adhesion": {"work_of_adhesion": contact.work, "range": contact.reach}}
    words = f"{shape}, {group}, mu = {mu:.3g}"
    return written(rng, group, words, profile, spacing, automatic, units, tolerance, Contact(body), experiment, exact,
                   adhesion)  # fmt: skip


def cohesive(body: Body, radius: float, mu: float) -> Cohesive:
    """The contact of E* = 1 whose radius without a load would be that of JKR, at a Tabor parameter."""
    work = with_rest_radius(body, 1.0, radius).work
    curvature = 0.5 * radius**2 / body.height(radius)
    return Cohesive(body, 1.0, work, math.cbrt(curvature * work**2) / mu, radius)


def marks(contact: Cohesive) -> dict[str, float]:
    """What an unloading to separation has."""
    critical, free, last = contact.critical, contact.free, contact.snap_out
    return {
        "adhesion_force": -critical.force,
        "critical_radius": critical.a,
        "zero_load_radius": free.a,
        "fixed_grips_displacement": last.displacement,
        "work_of_separation": contact.energy(last) - contact.energy(free),
    }


def _pressure(contact: Cohesive, state: State) -> Pressure:
    """p(r), the tension of the zone beyond the contact."""
    middle = contact.central_pressure(state)
    return lambda r: -contact.stress if r >= state.a else contact.pressure(r, state) if r else middle


def _state(contact: Cohesive, state: State, name: str, mean: bool = True) -> dict[str, Any]:
    """The numbers of one state in contact."""
    found: dict[str, Any] = {name: _pressure(contact, state)}
    if mean:
        found |= {"displacement": state.displacement, "contact_radius": state.a, "cohesive_radius": state.c,
                  "mean_pressure": state.force / (math.pi * state.a**2), "force": state.force}  # fmt: skip
    middle = contact.central_pressure(state)
    return found | ({"central_pressure": middle} if math.isfinite(middle) else {})


def _held(rng: np.random.Generator, contact: Cohesive, group: str) -> Made:
    """A load, a tension, a pull-off."""
    unit = -contact.critical.force
    if group == "pull_off":
        force = unit * float(10.0 ** rng.uniform(-1.0, 2.5))
        exact: dict[str, Any] = marks(contact)
        exact.pop("fixed_grips_displacement")  # of a path alone
        exact |= {"cohesive_radius": contact.free.c, "preload": force}
        exact |= _state(contact, contact.free, "zero_load", mean=False) | {
            "critical": _pressure(contact, contact.critical)
        }
        return group, {"kind": group, "preload": force}, exact, contact.under(force).c
    force = unit * float(10.0 ** rng.uniform(-2.0, 2.0) if group == "load" else -rng.uniform(0.1, 0.95))
    state = contact.under(force)
    return "load", {"kind": "load", "force": force}, _state(contact, state, "final"), max(state.c, contact.free.c)


def _path(rng: np.random.Generator, contact: Cohesive) -> Made:
    """From a compression to beyond separation or not, there and back or one way."""
    pressed = contact.under(-contact.critical.force * float(10.0 ** rng.uniform(-1.5, 1.5)))
    last, meet = contact.snap_out.displacement, -contact.reach
    if rng.random() < 0.7:
        apart = min(last, meet) * float(rng.uniform(1.02, 2.0))
    else:
        apart = meet + float(rng.uniform(0.05, 0.95)) * (contact.free.displacement - meet)
    closed, outwards = bool(rng.random() < 0.6), bool(rng.random() < 0.6)
    ends = (pressed.displacement, apart) if outwards else (apart, pressed.displacement)
    steps = round(math.exp(rng.uniform(*np.log(STEPS))))
    way = {"from": ends[0], "to": ends[1], "steps": steps, "return": closed}
    exact = _along(contact, ends, closed, apart < last)
    return "path", {"kind": "path", "displacements": way}, exact, max(pressed.c, contact.free.c)


def _along(contact: Cohesive, ends: tuple[float, float], closed: bool, parts: bool) -> dict[str, float]:
    """The marks that the last unloading passes, and what jumps lose."""
    exact, outwards = {}, ends[1] < ends[0]
    touched, last = contact.touched, contact.snap_out
    into = contact.energy(touched) if touched else 0.0
    if closed:
        exact["dissipated_energy"] = contact.energy(last) - into if parts else 0.0
    elif parts:
        exact["instability_energy"] = contact.energy(last) if outwards else -into
    if not (closed or outwards):
        return exact
    low, high, found = min(ends), max(ends), marks(contact)
    if not parts:
        found.pop("work_of_separation")
    if not parts or contact.energy(last) == 0.0:  # a force that falls to 0 steadily
        found.pop("fixed_grips_displacement")
    passed = {"adhesion_force": contact.critical, "critical_radius": contact.critical, "zero_load_radius": contact.free}
    for name, state in passed.items():
        if not low < state.displacement < high:
            found.pop(name)
    return exact | found
