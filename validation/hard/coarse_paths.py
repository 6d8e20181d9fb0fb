"""Paths of few steps: closed loops of an adhesive contact, and cycles with slip that are small against the sliding one.

An adhesive loop loses −E(a_in) where the bodies touch, at d = 0, and E(a_fg) where they part under fixed grips. Steps
that are as wide as the loop see these jumps at their ends alone, or not at all. A cycle along x of a small amplitude
slips in an annulus that may be narrower than a spacing. In both a 0 is no answer: a loss is stated with what it may be
off by, or is named as not known. Forces are those of the contact at every step, whatever a path does not pass.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from validation.hard.expected import looked_up
from validation.hard.judge import Case, Function, Judge, judged
from validation.hard.surfaces import Surface, power, surface
from validation.hard.units import Units
from validation.references.axisymmetric import Contact, Slipping, with_rest_radius
from validation.references.impact import Adhesive
from validation.references.receding_edge import equilibrium
from validation.references.relaxing import Power, sphere
from validation.row import Row, at_most
from validation.study import LONGEST, Bench, Findings, Study

RADIUS, SLOPE = 10.0, 0.01
"""a₀ and the slope there of every contact [LU]."""
SHAPES = {
    "cone": surface(RADIUS, "cone", slope=SLOPE),
    "parabola": surface(RADIUS, "parabola", radius=RADIUS / SLOPE),
    "power": surface(RADIUS, "power", exponent=3.0, radius=RADIUS, height=SLOPE * RADIUS / 3.0),
}
STEPS, FULL_STEPS = (1, 3, 12), (1, 2, 3, 4, 6, 9, 14, 25, 60)
TURNS, FULL_TURNS = (0.5, 1.3), (0.5, 0.95, 1.05, 1.3, 3.0)
"""The farthest displacement apart over that of fixed grips: below 1 the contact is held."""
LOADS = (2.0, 50.0)
"""Compression at the other end over F_A: beside the work of a large one the loss is small."""
SPACING = 0.7
AMPLITUDES, FULL_AMPLITUDES = (0.003, 0.1, 0.7), (1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 0.7, 0.99, 1.2)
"""Of a cycle over the displacement of full sliding."""
FRICTION, RATIO = 0.3, 0.85
BODIES, FULL_BODIES, TOLERANCES = 2, 12, (1e-3, 1e-4, 1e-5)
"""Whose forces are compared at every step, and at which tolerances."""
SOURCE, LOST = "the energies of the jumps by quadrature", ("dissipated_energy", "instability_energy")


def measure(bench: Bench) -> Findings:
    """Loops of every shape, cycles, and forces."""
    rows: list[Row] = []
    for words, judge in judged(bench, cases(bench.full)).items():
        rows += judge.rows(words, SOURCE)
        if words.endswith("F_A"):
            rows.append(_unseen(words, judge))
    return Findings(rows)


def _unseen(words: str, judge: Judge) -> Row:
    """A row of losses that are no number."""
    none = [n.label for n in judge.numbers if n.name in LOST and n.reference and abs(n.value) <= n.uncertainty]
    words = f"{words}: losses reported as less than their uncertainty"
    return at_most(words, len(none), 0.0, SOURCE, ", ".join(none)[:LONGEST] or "–")


def cases(full: bool) -> Iterator[Case]:
    """All of them."""
    shapes = SHAPES if full else {name: SHAPES[name] for name in ("cone", "parabola")}
    for (name, solid), turn in product(shapes.items(), FULL_TURNS if full else TURNS):
        for out, start, load in product((True, False), ("approach", "contact"), LOADS):
            yield from _loops(name, solid, turn, out, start, load, FULL_STEPS if full else STEPS)
    for name, solid in shapes.items():
        contact = Contact(solid.body)
        sliding = Slipping(contact, RADIUS, FRICTION, RATIO).sliding
        scene = solid.tables(SPACING) | {"friction": {"coefficient": FRICTION}}
        scene["bodies"]["bulk_stiffness_tangential"] = RATIO * SPACING
        for share in FULL_AMPLITUDES if full else AMPLITUDES:
            cycles = {"amplitude": share * sliding, "number": 2, "points": 16}
            experiment = {"kind": "tangential", "normal_force": contact.force(RADIUS), "cycles": cycles}
            yield looked_up(f"{name}_cycle_{share:g}", f"{name}, cycles with slip", f"{share:g} u*", solid,
                            scene | {"experiment": experiment})  # fmt: skip
    yield from _forces(FULL_BODIES if full else BODIES)


def _loops(
    name: str, solid: Surface, turn: float, out: bool, start: str, load: float, every: tuple[int, ...]
) -> Iterator[Case]:
    """Out of the contact and back, or in and out, in different numbers of steps."""
    contact, words = with_rest_radius(solid.body, 1.0, RADIUS), "out" if out else "in"
    apart = turn * contact.displacement(contact.fixed_grips(RADIUS))
    deep = contact.displacement(contact.pressed_radius(-load * contact.force(contact.critical(RADIUS)), RADIUS))
    ends = {"from": deep if out else apart, "to": apart if out else deep}
    group = f"{name}, {words} to {turn:g} of fixed grips from {start}, {load:g} F_A"
    for steps in every:
        experiment = {"kind": "path", "start": start, "displacements": ends | {"steps": steps, "return": True}}
        scene = solid.tables(SPACING) | {"adhesion": {"work_of_adhesion": contact.work}, "experiment": experiment}
        yield looked_up(f"{name}_{turn:g}_{start}_{words}_{load:g}_{steps}", group, f"{steps} steps", solid, scene)


def _forces(count: int) -> Iterator[Case]:
    """One sphere in SI and random bodies, from contact to where F = 0 need not be passed."""
    rng = np.random.default_rng(20261127)
    for i in range(count):
        body = sphere(1.0) if i == 0 else Power(float(rng.uniform(1.0, 4.0)), float(10.0 ** rng.uniform(-2.0, 0.0)))
        a = 0.1 if i == 0 else float(10.0 ** rng.uniform(-2.0, 0.0))
        contact, solid = Adhesive(body, 5e-5 if i == 0 else body.depth(a) ** 2 / (2.0 * np.pi * a)), power(body, a)
        low = contact.displacement(contact.grips)
        ends = (0.05, 0.003) if i == 0 else (body.depth(2.5 * a), float(rng.uniform(0.3 * low, 0.5 * body.depth(a))))
        way = {"from": ends[0], "to": ends[1], "steps": 10, "return": False}
        tables = {"adhesion": {"work_of_adhesion": contact.work},
                  "experiment": {"kind": "path", "start": "contact", "displacements": way}}  # fmt: skip
        for tolerance in TOLERANCES:
            one = looked_up(
                f"forces_{i}_{tolerance:g}", f"forces along a path to {tolerance:g}", f"z ~ r^{body.exponent:.3g}",
                solid, solid.tables(a / 40.0, tolerance) | tables, Units(1e-3, 1e6, automatic=i == 0),
            )  # fmt: skip
            yield replace(one, expected=replace(one.expected, force=_force(contact)))


def _force(contact: Adhesive) -> Function:
    return lambda d: contact.force(equilibrium(contact, d))


COARSE_PATHS = Study(
    "coarse_paths",
    "Paths of few steps and cycles of small amplitude",
    "Load steps as long as a loop is wide, or a slip zone narrower than the spacing, show no dissipated energy at "
    "all. Is the dissipated energy within its uncertainty, or reported as unknown?",
    measure,
)
