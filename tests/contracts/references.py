"""What a combination has by closed forms and solvers of `validation/references`, which share no code with the program.

Pressures are those of the reported state: deepest of a path, without a load of a pull-off, the last of others.
"""

import math
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

from tests.contracts.members import (
    DEPTH,
    END,
    EXPERIMENTS,
    LAWS,
    LOAD,
    MODULUS,
    PROFILES,
    PUNCH,
    RANGE,
    TURNS,
    WORK,
    Combination,
)
from validation.hard.expected import marks
from validation.hard.surfaces import surface
from validation.references import impact
from validation.references.axisymmetric import Body, Contact, Slipping
from validation.references.creeping import Creeping
from validation.references.dashpots import Pressed
from validation.references.dugdale import Cohesive
from validation.references.receding_edge import Receding
from validation.references.relaxing import Indentation, KelvinVoigt, Legs, Material, Power, Punch

Numbers = dict[str, float]
MASS, SPEED, GUESS = 10.0, 0.3, 20.0
SURFACES = {
    kind: surface(GUESS, kind, **{name: getattr(number, "value", number) for name, number in numbers.items()})
    for kind, numbers in PROFILES.items()
    if kind not in ("table", "flat")
}
SURFACES["table"] = SURFACES["parabola"]
BODIES: dict[str, Body] = {kind: one.body for kind, one in SURFACES.items()}
"""Slopes and bends, of each profile."""
POWERS: dict[str, Power] = {
    kind: power for kind in ("parabola", "cone", "power", "table") if isinstance(power := SURFACES[kind].power, Power)
}
"""Those that are a power of r."""
SHARES = tuple((one["share"], one["time"].value) for one in LAWS["prony"]["viscoelasticity"]["terms"])
MATERIAL = Material(SHARES, MODULUS)
RETARDATION = LAWS["kelvin_voigt"]["viscoelasticity"]["retardation_time"].value
DEPTHS = Legs(tuple((t, DEPTH * share) for t, share in TURNS))
FORCES = Legs(tuple((t, LOAD * max(share, 0.0)) for t, share in TURNS))


def state(contact: Contact, a: float, d: float) -> Numbers:
    """Of a contact with a and d."""
    found = {"contact_radius": a, "displacement": d, "force": contact.force_at(a, d)}
    found["mean_pressure"] = found["force"] / (math.pi * a * a)
    if not contact.work:
        found["contact_stiffness"] = 2.0 * contact.modulus * a
    found["adhesion_energy"] = math.pi * a * a * contact.work
    found["central_pressure"] = contact.central_pressure(a, d)
    if not math.isfinite(contact.body.end) and not contact.work:
        found["peak_pressure"] = contact.peak_pressure(a, d)
    return {name: value for name, value in found.items() if value}


def largest(found: Numbers) -> Numbers:
    """The state as a path names it."""
    names = {"contact_radius": "largest_radius", "force": "largest_force"}
    return {names.get(name, name): value for name, value in found.items() if name != "displacement"}


def elastic(one: Combination, work: float = 0.0) -> Numbers:
    """Galin's and Sneddon's contact, and JKR's of any body."""
    contact = Contact(BODIES[one.profile], MODULUS, work)
    deep = contact.radius_at(DEPTH, GUESS), DEPTH
    if one.experiment in ("load", "hold a force"):
        return state(contact, *contact.under(LOAD, GUESS))
    if one.experiment == "hold":
        return state(contact, *deep)
    if one.experiment.startswith("path"):
        return {} if work else largest(state(contact, *deep))
    if one.experiment == "history":
        gone = {} if work else {"dissipated_energy": 0.0, "contact_time": 1.0 + 1.0 + 2.0 / 3.0}
        return {"peak_force": contact.force_at(*deep)} | gone
    if one.experiment == "history of a force":
        return {"peak_displacement": contact.under(LOAD, GUESS)[1], "dissipated_energy": 0.0, "contact_time": END}
    if one.experiment == "impact":
        return bounced(contact)
    found = pulled_off(contact) if one.experiment.startswith("pull_off") else {}
    return {name: value for name, value in found.items() if one.method == "quasistatic" or name != "work_of_separation"}


def bounced(contact: Contact) -> Numbers:
    """Energy balance of an impact: ½ m v² = E(a) − E at first contact, less what is lost under fixed grips."""
    energy, touch, start, lost = 0.5 * MASS * SPEED**2, 1e-3, 0.0, 0.0
    if contact.work:
        touch = contact.touch_radius(GUESS)
        start = contact.energy(touch, 0.0)
        lost = contact.energy(contact.fixed_grips(GUESS)) - start
    a = min(3.0 * GUESS, contact.body.end)
    least = max(contact.displacement(a), 0.0)
    if contact.energy(a, least) < start + energy:  # up to the end of a body
        d = brentq(lambda d: contact.energy(a, d) - start - energy, least, GUESS, xtol=1e-12)
    else:
        a = brentq(lambda a: contact.energy(a) - start - energy, touch, a, xtol=1e-12)
        d = contact.displacement(a)
    found = {"peak_force": contact.force_at(a, d), "peak_displacement": d, "peak_contact_radius": a}
    lost = min(lost, energy)
    return found | {"restitution": math.sqrt(1.0 - lost / energy), "dissipated_energy": lost}


def pulled_off(contact: Contact) -> Numbers:
    """F_A, a_cr, a₀, the work from there to separation, and the pressure there."""
    found = marks(contact, GUESS)
    if contact.body.flat:
        return found
    free, d = contact.under(0.0, GUESS)
    middle = state(contact, free, d)
    return found | ({"central_pressure": middle["central_pressure"]} if "central_pressure" in middle else {})


def maugis(one: Combination) -> Numbers:
    """Dugdale's contact of any body."""
    contact = Cohesive(BODIES[one.profile], MODULUS, WORK, RANGE, GUESS)
    if one.experiment == "load":
        s = contact.under(LOAD)
        pressure = {"central_pressure": contact.central_pressure(s)} if one.profile != "cone" else {}
        return {"contact_radius": s.a, "displacement": s.displacement, "cohesive_radius": s.c} | pressure
    if one.experiment in ("pull_off", "pull_off twice"):
        free, critical = contact.free, contact.critical
        radii = {"critical_radius": critical.a, "zero_load_radius": free.a, "cohesive_radius": free.c}
        return radii | {"adhesion_force": -critical.force}
    s = contact.at(DEPTH)
    assert s is not None
    if one.experiment.startswith("path"):
        return {"central_pressure": contact.central_pressure(s)} if one.profile != "cone" else {}
    return {"peak_force": s.force} if one.experiment == "history" else {}


def rated(one: Combination) -> Numbers:
    """An edge that recedes at a finite speed."""
    if one.profile not in POWERS or one.experiment == "history":
        return {}
    receding = Receding(impact.Adhesive(POWERS[one.profile], WORK, MODULUS), 1.0, 0.6)
    force, critical = receding.pull_off(LOAD, 0.01)
    free, d, work = receding.separated(receding.pressed(LOAD), 0.01)
    found = {"adhesion_force": force, "critical_radius": critical, "zero_load_radius": free, "work_of_separation": work}
    return found | {"central_pressure": Contact(BODIES[one.profile], MODULUS, WORK).central_pressure(free, d)}


def prony(one: Combination) -> Numbers:
    """Lee, Radok and Ting; a punch by superposition."""
    if one.profile == "flat_punch":
        punch = Punch(PUNCH, MATERIAL)
        if one.experiment == "history":
            return {"peak_force": punch.force(DEPTHS, TURNS[1][0])}
        times = np.linspace(1.0, END, 4001)
        return (
            {"peak_displacement": max(punch.displacement(FORCES, t) for t in times)}
            if "force" in one.experiment
            else {}
        )
    if one.profile not in POWERS:
        return {}
    body = POWERS[one.profile]
    if one.experiment == "impact":
        return vars(impact.relaxing(body, MATERIAL, MASS, SPEED)).copy()
    if one.experiment == "history":
        pressed = Indentation(body, MATERIAL, DEPTHS)
        return {"peak_force": pressed.peak[1], "dissipated_energy": pressed.work, "contact_time": pressed.end}
    return {"peak_displacement": Creeping(body, MATERIAL, FORCES).peak_displacement}


def kelvin_voigt(one: Combination) -> Numbers:
    """Dashpots beside springs."""
    if one.profile not in POWERS:
        return {}
    law = KelvinVoigt(POWERS[one.profile], RETARDATION, MODULUS)
    if one.experiment == "impact":
        return vars(impact.kelvin_voigt(law, MASS, SPEED)).copy()
    if one.experiment == "history of a force":
        pressed = Pressed(law, FORCES)
        return {"peak_displacement": pressed.displacement(pressed.turn), "dissipated_energy": pressed.lost}
    last = TURNS[2][0] + (DEPTH / (1.5 * DEPTH) - RETARDATION) * (END - TURNS[2][0])  # d + T d' = 0
    work = 0.0
    for low, high, rate in ((0.0, 1.0, DEPTH), (2.0, last, -1.5 * DEPTH)):
        work += rate * quad(lambda t, rate=rate: law.force(DEPTHS(t), rate), low, high, epsabs=1e-12, limit=200)[0]
    return {"peak_force": law.force(DEPTH, DEPTH), "dissipated_energy": work}


def friction(one: Combination) -> Numbers:
    """Cattaneo, Mindlin, Jaeger and Ciavarella; after a turn by Masing's rule."""
    contact = Contact(BODIES[one.profile], MODULUS)
    if one.experiment == "impact obliquely":
        return {name: value for name, value in bounced(contact).items() if name != "dissipated_energy"}
    a = contact.under(LOAD, GUESS)[0]
    if one.profile == "flat_punch":
        return {"contact_radius": a}
    found = {"contact_radius": a, "contact_stiffness": 2.0 * MODULUS * a}
    slipping = Slipping(contact, a, LAWS["friction"]["friction"]["coefficient"], 1.0)
    if one.experiment == "tangential":
        *_, most, last = (u.value for u in EXPERIMENTS[one.experiment]["displacements"])
        half = 0.5 * (most - last)
        return found | {
            "tangential_force": slipping.force(most) - 2.0 * slipping.force(half), "stick_radius": slipping.stick(half)
        }  # fmt: skip
    most = EXPERIMENTS[one.experiment]["cycles"]["amplitude"].value
    area = 8.0 * quad(slipping.force, 0.0, most, epsabs=1e-12)[0] - 4.0 * most * slipping.force(most)
    return found | {"dissipated_energy_per_cycle": area}


REFERENCES: dict[str, Callable[[Combination], Numbers]] = {
    "elastic": elastic, "jkr": lambda one: elastic(one, WORK), "maugis": maugis, "rate": rated, "prony": prony,
    "kelvin_voigt": kelvin_voigt, "friction": friction, "restitution": lambda one: {"restitution": 0.7},
}  # fmt: skip
"""By the law of a combination; none of particles that interact, whose numbers are those of one lattice."""


@cache
def expected(one: Combination) -> dict[str, Any]:
    """Numbers by name; empty where no reference is known."""
    return REFERENCES[one.law](one) if one.law in REFERENCES else {}
