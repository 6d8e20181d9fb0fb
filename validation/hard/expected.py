"""What a scene on the rigid plane has, looked up in `validation/references` by its profile, law and experiment.

Scenes are in units of their model with E* = 1 FU/LU². Bodies of any profile are elastic, adhere at any range, or slip;
those that take time, in their material or at an adhesive edge, are powers of r or punches.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

from validation.hard import expected_in_time
from validation.hard.judge import Case, Expected
from validation.hard.surfaces import ROUND, Surface
from validation.hard.units import MODEL, Scene, Units
from validation.references.axisymmetric import Contact, Slipping, lost_on_path
from validation.references.dugdale import Cohesive, State
from validation.references.numerics import Function, Pair

Numbers = dict[str, Any]
"""By name, and p(r) by the names of states."""
OF_ALL_COHESIVE = {
    "load": ("displacement", "contact_radius", "cohesive_radius"),
    "pull_off": ("adhesion_force", "zero_load_radius", "cohesive_radius"),
    "path": (),
}
"""Numbers that must be there, or be missing with a word; others are compared where they are."""


def law_of(scene: Scene) -> str:
    """The law of a scene."""
    adhesion, relaxing = scene.get("adhesion", {}), scene.get("viscoelasticity", {})
    if relaxing:
        return "Prony" if "terms" in relaxing else "Kelvin–Voigt"
    if adhesion:
        return "rate" if "rate" in adhesion else "Maugis" if "range" in adhesion else "JKR"
    return "friction" if "friction" in scene else "elastic"


def expected(surface: Surface, scene: Scene) -> Expected:
    """The numbers and pressures of a scene. Raises ValueError where a contact would cover the body."""
    law, experiment = law_of(scene), scene["experiment"]
    kind = experiment["kind"]
    if law in ("Prony", "Kelvin–Voigt", "rate") or kind in ("history", "impact"):
        return expected_in_time.expected(surface, scene)
    if law == "Maugis":
        adhesion = scene["adhesion"]
        contact = Cohesive(surface.body, 1.0, adhesion["work_of_adhesion"], adhesion["range"], surface.radius)
        return _split(_cohesive(contact, surface, experiment), OF_ALL_COHESIVE[kind])
    adherent = Contact(surface.body, 1.0, scene.get("adhesion", {}).get("work_of_adhesion", 0.0))
    if kind == "tangential":
        bodies = scene["bodies"]
        ratio = bodies["bulk_stiffness_tangential"] / bodies["bulk_stiffness"]
        return _tangential(adherent, surface, experiment, scene["friction"]["coefficient"], ratio)
    if kind == "pull_off":
        found = marks(adherent, surface.radius) | {"preload": experiment["preload"]}
        if not surface.punch:
            rest, edge = found["zero_load_radius"], found["critical_radius"]
            states = {"zero_load": (rest, adherent.displacement(rest)), "critical": (edge, adherent.displacement(edge))}
            found |= middle_and_peak(adherent, *states["zero_load"]) | pressures(adherent, **states)
        return _split(found)
    if kind == "path" and adherent.work:
        return _split(_loop(adherent, surface.radius, experiment))
    a, d = deepest(adherent, experiment, surface.radius)
    found = state(adherent, a, d)
    if kind == "path":
        way = points_of(experiment["displacements"])
        found |= {"largest_force": adherent.force_at(a, d), "largest_radius": a}
        return _split(found | ({"dissipated_energy": 0.0} if way[0] == way[-1] else {}))
    found |= {"displacement": d, "contact_radius": a, "force": adherent.force_at(a, d)}
    return _split(found | pressures(adherent, final=(a, d)))


def looked_up(name: str, group: str, words: str, surface: Surface, scene: Scene, units: Units = MODEL) -> Case:
    """A scene with what it has."""
    return Case(name, group, words, scene, expected(surface, scene), units)


def _split(found: Numbers, needed: tuple[str, ...] | None = None) -> Expected:
    curves = {name: value for name, value in found.items() if callable(value)}
    numbers = {name: value for name, value in found.items() if name not in curves}
    return Expected(numbers, pressures=curves, needed=needed)


def points_of(displacements: Scene | Sequence[float]) -> list[float]:
    """The load steps of a path."""
    if not isinstance(displacements, dict):
        return list(displacements)
    first, last, steps = (displacements[key] for key in ("from", "to", "steps"))
    there = [first + (last - first) * i / steps for i in range(steps + 1)]
    return there + there[-2::-1] if displacements.get("return", True) else there


def deepest(contact: Contact, experiment: Scene, guess: float) -> Pair:
    """a and d of the largest load of an experiment."""
    punch = math.isfinite(contact.body.end)
    for name in ("force", "preload", "normal_force"):
        if name in experiment:
            a = contact.pressed_radius(experiment[name], guess)
            return a, 0.5 * experiment[name] / (contact.modulus * a) if punch else contact.displacement(a)
    d = experiment.get("displacement") or max(points_of(experiment["displacements"]))
    return contact.body.end if punch else contact.radius_at(d, guess), d


def pressures(contact: Contact, **states: Pair) -> dict[str, Function]:
    """p(r) of states (a, d) whose body has no kink inside, by their names among the numbers."""
    body = contact.body

    def of(a: float, d: float) -> Function:
        middle = contact.central_pressure(a, d) if math.isinf(body.end) else d / (math.pi * a) * contact.modulus
        return lambda r: 0.0 if r >= a else contact.pressure(r, a, d) if r else middle

    return {} if any(body.jumps) else {name: of(*state) for name, state in states.items()}


def middle_and_peak(contact: Contact, a: float, d: float) -> Numbers:
    """p(0) and the largest pressure of a state; inf where there is none."""
    if math.isfinite(contact.body.end):  # its edge has no bound
        return {} if contact.work else {"peak_pressure": math.inf}
    return {"central_pressure": contact.central_pressure(a, d), "peak_pressure": contact.peak_pressure(a, d)}


def state(contact: Contact, a: float, d: float) -> Numbers:
    """Of a contact of radius a under a displacement d, but for these two and the force."""
    found = {"mean_pressure": contact.force_at(a, d) / (math.pi * a * a)} | middle_and_peak(contact, a, d)
    stiffness = {"contact_stiffness": 2.0 * contact.modulus * a}
    return found | ({"adhesion_energy": math.pi * a * a * contact.work} if contact.work else stiffness)


def marks(contact: Contact, guess: float) -> Numbers:
    """F_A and the radii; separation's work, from the largest contact without a load to fixed grips."""
    if contact.body.flat:
        a = contact.body.end
        force = -contact.force_at(a, contact.displacement(a))
        return {"adhesion_force": force, "critical_radius": a, "zero_load_radius": a,
                "work_of_separation": force**2 / (4.0 * contact.modulus * a)}  # fmt: skip
    critical, (rest, depth) = contact.critical(guess), contact.under(0.0, guess)
    return {
        "adhesion_force": -contact.force(critical), "critical_radius": critical, "zero_load_radius": rest,
        "work_of_separation": contact.energy(contact.fixed_grips(guess)) - contact.energy(rest, depth),
        "adhesion_energy": math.pi * rest**2 * contact.work,
    }  # fmt: skip


def _loop(contact: Contact, guess: float, experiment: Scene) -> Numbers:
    """What a path of an adhesive contact loses, and the marks of its last unloading."""
    points = points_of(experiment["displacements"])
    lost, jumps, first, last = lost_on_path(contact, points, experiment.get("start", "approach"), guess)
    found: Numbers = {}
    if points[0] == points[-1] and first == last:
        found["dissipated_energy"] = lost
    elif jumps:
        found["instability_energy"] = lost
    if (jumps or first) and any(q < p for p, q in pairwise(points)):
        found |= _marks_of(contact, guess, points, first)
    return found


def _marks_of(contact: Contact, guess: float, points: list[float], first: bool) -> Numbers:
    """The marks that the last unloading passes, of those that touch as it begins."""
    turn = len(points) - 1
    while points[turn] >= points[turn - 1]:
        turn -= 1
        if turn == 0:
            return {}
    top = turn
    while top > 0 and points[top] < points[top - 1]:
        top -= 1
    if not (points[top] > 0.0 or (first and top == 0)):
        return {}
    limit, found = contact.displacement(contact.fixed_grips(guess)), marks(contact, guess)
    if math.isfinite(contact.body.end):
        ends = {"adhesion_force": limit, "critical_radius": limit, "zero_load_radius": 0.0}
        return {} if points[turn] <= limit else _passed(found, ends, points[turn], points[top], limit)
    peak, rest = (contact.displacement(found[name]) for name in ("critical_radius", "zero_load_radius"))
    passed = {"adhesion_force": peak, "critical_radius": peak, "zero_load_radius": rest, "adhesion_energy": rest}
    return _passed(found | {"fixed_grips_displacement": limit}, passed, points[turn], points[top], limit)


def _passed(found: Numbers, places: Numbers, low: float, high: float, limit: float) -> Numbers:
    """Those of the marks whose displacements an unloading passes; the work of separation needs both its ends."""
    gone = {name for name, d in places.items() if not low < d < high}
    if low > limit:
        gone |= {"work_of_separation", "fixed_grips_displacement"}
    if "zero_load_radius" in gone:
        gone.add("work_of_separation")
    return {name: value for name, value in found.items() if name not in gone}


def _tangential(contact: Contact, surface: Surface, experiment: Scene, friction: float, ratio: float) -> Expected:
    """Out, back by Masing's rule, and cycles."""
    a, d = deepest(contact, experiment, surface.radius)
    slipping = Slipping(contact, a, friction, ratio)
    found = {"contact_radius": a, "normal_force": experiment["normal_force"]} | middle_and_peak(contact, a, d)
    found |= pressures(contact, farthest=(a, d))
    if "cycles" in experiment:
        u, count = experiment["cycles"]["amplitude"], experiment["cycles"]["number"]
        loss = slipping.loss(u)
        return _split(found | {
            "tangential_force": slipping.force(u), "stick_radius": slipping.stick(u),
            "dissipated_energy": (1.0 + 4.0 * count) * loss, "dissipated_energy_per_cycle": 4.0 * loss,
        })  # fmt: skip
    way = points_of(experiment["displacements"])
    most, half = max(way), 0.5 * (max(way) - way[-1])
    found |= {
        "tangential_force": slipping.force(most) - 2.0 * slipping.force(half),
        "stick_radius": slipping.stick(half or most),
        "dissipated_energy": slipping.loss(most) + (2.0 * slipping.loss(half) if half else 0.0),
    }
    return replace(_split(found), largest={"tangential_force": slipping.force(most)})


def _cohesive(contact: Cohesive, surface: Surface, experiment: Scene) -> Numbers:
    """A load, a pull-off, a path under Dugdale's law; μ of a body with a curvature."""
    found: Numbers = {}
    if surface.profile["kind"] in ROUND:
        found["tabor_parameter"] = math.cbrt(contact.work**2 / contact.body.bend(0.0)) / contact.reach
    if experiment["kind"] == "path":
        way = experiment["displacements"]
        return found | _along(contact, (way["from"], way["to"]), way["return"])
    if experiment["kind"] == "load":
        at = contact.under(experiment["force"])
        found |= {"displacement": at.displacement, "contact_radius": at.a, "cohesive_radius": at.c,
                  "mean_pressure": at.force / (math.pi * at.a**2), "force": at.force,
                  "final": _pressure(contact, at)}  # fmt: skip
    else:
        at = contact.free
        found |= cohesive_marks(contact)
        found.pop("fixed_grips_displacement")  # of a path alone
        found |= {"cohesive_radius": at.c, "preload": experiment["preload"], "zero_load": _pressure(contact, at),
                  "critical": _pressure(contact, contact.critical)}  # fmt: skip
    middle = contact.central_pressure(at)
    return found | ({"central_pressure": middle} if math.isfinite(middle) else {})


def cohesive_marks(contact: Cohesive) -> Numbers:
    """What an unloading to separation has under Dugdale's law."""
    critical, free, last = contact.critical, contact.free, contact.snap_out
    return {
        "adhesion_force": -critical.force, "critical_radius": critical.a, "zero_load_radius": free.a,
        "fixed_grips_displacement": last.displacement,
        "work_of_separation": contact.energy(last) - contact.energy(free),
    }  # fmt: skip


def _pressure(contact: Cohesive, at: State) -> Function:
    """p(r), the tension of the zone beyond the contact."""
    middle = contact.central_pressure(at)
    return lambda r: -contact.stress if r >= at.a else contact.pressure(r, at) if r else middle


def _along(contact: Cohesive, ends: Pair, closed: bool) -> Numbers:
    """The marks that the last unloading passes, and what jumps lose."""
    exact, outwards = {}, ends[1] < ends[0]
    touched, last, (low, high) = contact.touched, contact.snap_out, sorted(ends)
    parts = low < last.displacement
    into = contact.energy(touched) if touched else 0.0
    if closed:
        exact["dissipated_energy"] = contact.energy(last) - into if parts else 0.0
    elif parts:
        exact["instability_energy"] = contact.energy(last) if outwards else -into
    if not (closed or outwards):
        return exact
    found = cohesive_marks(contact)
    if contact.energy(last) == 0.0:  # a force that falls to 0 steadily
        found.pop("fixed_grips_displacement")
    critical, rest = contact.critical.displacement, contact.free.displacement
    passed = {"adhesion_force": critical, "critical_radius": critical, "zero_load_radius": rest}
    return exact | _passed(found, passed, low, high, last.displacement)
