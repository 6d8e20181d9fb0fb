"""Random impacts, and pull-offs at a velocity, with their numbers by motions of few variables."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from validation.hard.plane_bodies import Scene
from validation.hard.plane_draws import Drawn
from validation.hard.relaxing_draws import plain, profile_of, random_body, terms_of
from validation.references.impact import Adhesive, Bounce, deepest, elastic, kelvin_voigt, relaxing
from validation.references.receding_edge import Receding
from validation.references.relaxing import KelvinVoigt, Material, Power

GROUPS = {"elastic": 0.1, "retarded": 0.2, "relaxing": 0.3, "adhesive": 0.2, "edge": 0.2}
NARROW, WIDE = 8.0, 60.0
"""Particles in the contact."""
WITH_UNITS, AUTOMATIC = 0.35, 0.25
"""Shares of scenes with units, and with the program's own spacing."""
REFERENCE = 1e-7
"""Relative error of the references."""
SCALES = {"L": 1e-6, "F": 1e-6, "E": 1e-12, "T": 1e-3, "1": 1.0}
"""Of scenes with units, in SI: E* = 1 MPa, micrometres, milliseconds, milligrams."""
UNITS = {"mass": "mg", "velocity": "mm/s", "radius": "µm", "height": "µm", "spacing": "µm", "time": "ms",
         "retardation_time": "ms", "preload": "µN", "work_of_adhesion": "J/m²"}  # fmt: skip


def scene_of(seed: int, number: int) -> Drawn:
    """The scene of that number."""
    rng = np.random.default_rng((seed, number))
    group = str(rng.choice(list(GROUPS), p=list(GROUPS.values())))
    body, radius = random_body(rng)
    tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
    spacing = radius / math.exp(rng.uniform(math.log(NARROW), math.log(WIDE)))
    one = plain(profile_of(body, radius), spacing, tolerance)
    if group == "edge":
        tables, exact = _edge(rng, body, radius)
    else:
        tables, exact = _hit(rng, group, body, radius)
    free, units = rng.random() < AUTOMATIC, rng.random() < WITH_UNITS
    one |= tables
    if free or units:
        bodies = {name: value for name, value in one["bodies"].items() if name != "bulk_stiffness"}
        one = _in_units(one | {"bodies": bodies}) | {"material": {"contact_modulus": "1.0 MPa"}}
        if free:
            one["bodies"]["spacing"] = "auto"
    return Drawn(group, f"n = {body.exponent:.3g}, {group}", one, exact, SCALES, free or units, REFERENCE)


def _in_units(node: Scene) -> Scene:
    """Texts for numbers that have units."""
    found: Scene = {}
    for name, value in node.items():
        if isinstance(value, Mapping):
            found[name] = _in_units(dict(value))
        elif isinstance(value, list):
            found[name] = [_in_units(one) for one in value]
        else:
            found[name] = f"{value!r} {UNITS[name]}" if name in UNITS and isinstance(value, float) else value
    return found


def _hit(rng: np.random.Generator, group: str, body: Power, radius: float) -> tuple[Scene, dict[str, float]]:
    """A mass and a velocity with which an elastic body would have that radius at last."""
    mass = float(10.0 ** rng.uniform(-2.0, 2.0))
    depth = body.depth(radius)
    velocity = 1.0 / deepest(body, 1.0, mass, 1.0) * depth  # by similarity, then exactly
    for _ in range(60):
        velocity *= (depth / deepest(body, 1.0, mass, velocity)) ** 1.2
    lasts = elastic(body, 1.0, mass, velocity).contact_time
    tables: Scene = {"plate": {"mass": mass}}
    if group == "retarded":
        law = KelvinVoigt(body, lasts * float(10.0 ** rng.uniform(-2.5, 0.0)))
        tables["viscoelasticity"], made = terms_of(law), kelvin_voigt(law, mass, velocity)
    elif group == "relaxing":
        arms = int(rng.integers(1, 4))
        shares = rng.dirichlet(np.ones(arms)) * float(rng.uniform(0.05, 1.0))
        times = lasts * np.sort(10.0 ** rng.uniform(-1.0, 1.5, arms))
        material = Material(tuple((float(p), float(tau)) for p, tau in zip(shares, times, strict=True)))
        tables["viscoelasticity"], made = terms_of(material), relaxing(body, material, mass, velocity)
    elif group == "adhesive":
        # W with which the contact without a displacement has a part of the radius.
        a = radius * float(rng.uniform(0.2, 0.8))
        contact = Adhesive(body, body.depth(a) ** 2 / (2.0 * math.pi * a))
        tables["adhesion"] = {"work_of_adhesion": contact.work}
        velocity = contact.sticking_velocity(mass) * float(
            rng.uniform(0.3, 0.95) if rng.random() < 0.2 else 10.0 ** rng.uniform(0.02, 1.3)
        )
        if velocity < contact.sticking_velocity(mass):
            tables["experiment"] = {"kind": "impact", "velocity": velocity}
            return tables, {"restitution": 0.0, "dissipated_energy": 0.5 * mass * velocity**2, "contact_time": math.inf}
        made = contact.impact(mass, velocity)
    else:
        made = elastic(body, 1.0, mass, velocity)
    tables["experiment"] = {"kind": "impact", "velocity": velocity}
    return tables, numbers(made, mass, velocity)


def numbers(one: Bounce, mass: float, velocity: float) -> dict[str, float]:
    """What the program reports of it."""
    return vars(one) | {"dissipated_energy": one.lost(mass, velocity)}


def _edge(rng: np.random.Generator, body: Power, radius: float) -> tuple[Scene, dict[str, float]]:
    """A pull-off at a velocity."""
    contact = Adhesive(body, body.depth(radius) ** 2 / (2.0 * math.pi * radius))
    speed, exponent = float(10.0 ** rng.uniform(-3.0, 1.0)), float(rng.uniform(0.3, 1.0))
    velocity = speed * body.depth(radius) / radius * float(10.0 ** rng.uniform(-4.0, 0.5))
    preload = contact.modulus * body.volume(radius) * float(10.0 ** rng.uniform(-1.0, 0.7))
    force, edge = Receding(contact, speed, exponent).pull_off(preload, velocity)
    tables = {
        "adhesion": {"work_of_adhesion": contact.work, "rate": {"velocity": speed, "exponent": exponent}},
        "experiment": {"kind": "pull_off", "preload": preload, "velocity": velocity},
    }
    return tables, {"adhesion_force": force, "critical_radius": edge}
