"""Bodies that relax, pushed in and drawn out over time: `[viscoelasticity]` with the experiment `history`.

Peaks, curves and the end of contact of a triangle and a trapezoid are held against Lee, Radok and Ting, those of a
sawtooth, whose surface recovers and is touched again, against springs with events in their own time, creep against the
compliance, pressures against line loads, and random histories against all of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from validation.hard.draws import history, terms_of
from validation.hard.expected import looked_up
from validation.hard.expected_in_time import ALONG, Law
from validation.hard.judge import Case, judged
from validation.hard.random_plane import RELAXING as RANDOM
from validation.hard.random_plane import TING, random_rows
from validation.hard.surfaces import power
from validation.hard.units import Scene, Units
from validation.references.relaxing import Flat, Indentation, KelvinVoigt, Legs, Material, Power
from validation.row import Row, at_least
from validation.study import Bench, Findings, Refused, Study

RADIUS, DEPTH = 30.0, 1.0
"""a and d of the deepest contact [LU]; E* = 1 FU/LU²."""
PARTICLES, FINE = 31.7, 4.0
"""In a; how much finer the lattice is from which an order is had."""
PUNCHED = 1e-9
"""What a force on a punch may be off."""
ORDER = 1.7
"""Of 2: where the edge is between two particles changes the errors of both lattices."""
STEPS = 400
"""Of a leg, with which an order in the spacing is not hidden by that in the steps."""
MATERIALS = {
    "standard solid": Material(((0.5, 1.0),)),
    "Maxwell": Material(((1.0, 1.0),)),
    "three arms": Material(((0.3, 0.2), (0.3, 1.0), (0.2, 10.0))),
}
RETARDED = (0.1, 0.3)
"""Retardation times [TU]."""
TRIANGLE = Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, 0.0)))
WAYS = {
    "triangle": TRIANGLE,
    "trapezoid": Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, DEPTH), (3.0, 0.0))),
    "sawtooth": Legs(((0.0, 0.0), (1.0, 1.0), (1.5, 0.0), (2.5, 0.9), (3.0, 0.3), (4.0, 0.3), (5.0, -1.0))),
    "touched again": Legs(
        ((0.0, 0.0), (0.1, 1.0), (1.0, 1.0), (1.2, 0.85), (1.3, 0.85), (1.7, -0.3), (2.1, -0.3), (2.6, 0.8))
    ),
}
FORCES = {
    "force held": Legs(((0.0, 0.0), (1.0, 1.0), (3.0, 1.0))),
    "force held and removed": Legs(((0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.0))),
}
HELD = Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, DEPTH), (3.0, 0.5 * DEPTH)))
EXAMPLE = Legs(((0.0, 0.0), (0.3, 10.0), (1.0, 10.0), (2.0, 3.0)))
"""A force on dashpots that once gave a peak_force of 2.6e36."""
FREE = Units(length=1e-6, stress=1e6, time=1e-3, texts=True, automatic=True)
EVENTS = "springs with events in their own time"
SOURCES = {"sawtooth": EVENTS, "touched": EVENTS, "force": "the creep compliance",
           "punch": "E(t) and C(t)", "Kelvin": "the closed form"}  # fmt: skip


def bodies(radius: float, depth: float) -> dict[str, Power]:
    """Of one contact radius at one depth."""
    made = {"sphere": Power(2.0, 1.0), "cone": Power(1.0, 1.0), "power 3": Power(3.0, 1.0)}
    return {name: replace(one, factor=depth / one.depth(radius)) for name, one in made.items()}


def case(name: str, group: str, words: str, body: Power | Flat, law: Law, experiment: Scene) -> Case:
    """A history with PARTICLES in the deepest contact."""
    solid = power(body, RADIUS)
    spacing = 1.0 if isinstance(body, Flat) else RADIUS / PARTICLES
    scene = solid.tables(spacing) | {"viscoelasticity": terms_of(law)} | experiment
    return looked_up(f"{name}_{words}", group, words, solid, scene)


def cases(full: bool) -> Iterator[Case]:
    """Every body on every material, or each once; with the spacing given and with the program's own, in SI."""
    named = [*bodies(RADIUS, DEPTH).items()]
    pairs = [*(product if full else zip)(named, MATERIALS.items())]
    for name, d in WAYS.items():
        for (b, body), (m, law) in pairs:
            one = case(name, f"{name}, spacing given", f"{b}, {m}", body, law, history(d))
            yield one
            yield replace(one, name=f"{one.name}_free", group=f"{name}, automatic spacing", units=FREE)
    for name, shares in FORCES.items():
        for (b, body), (m, law) in pairs:
            force = Legs(tuple((t, share * 0.5 * body.volume(RADIUS)) for t, share in shares.points))
            yield case(name, name, f"{b}, {m}", body, law, history(force, by_force=True))
    for m, law in MATERIALS.items():
        for name, by_force in {"punch": False, "punch, force given": True}.items():
            yield case(name, name, m, Flat(RADIUS), law, history(HELD, by_force))
    for b, body in named:
        for time in RETARDED:
            yield case(
                "retarded", "Kelvin and Voigt", f"{b}, T = {time:g}", body, KelvinVoigt(body, time), history(TRIANGLE)
            )
    dashpots = KelvinVoigt(Power(4.0, 1e-8), 1.0)
    yield case("example", "Kelvin and Voigt, force given", "example", dashpots.body, dashpots, history(EXAMPLE, True))


def measure(bench: Bench) -> Findings:
    """Each kind of history, then random ones."""
    rows: list[Row] = []
    for words, judge in judged(bench, cases(bench.full)).items():
        source = next((source for word, source in SOURCES.items() if words.startswith(word)), TING)
        rows += judge.rows(words, source)
        rows += [judge.curve(words, column, PUNCHED if words == "punch" else ALONG, source)
                 for column in judge.along if "automatic" not in words]  # fmt: skip
        if "spacing given" in words:
            rows.append(judge.near(words, "peak_force", ALONG, source))
    rows += [_order(bench, name, law) for name, law in MATERIALS.items()]
    return Findings([*rows, *random_rows(bench, RANDOM, TING)])


def _order(bench: Bench, name: str, law: Material) -> Row:
    """In the spacing, of a sphere."""
    body, off = bodies(RADIUS, DEPTH)["sphere"], []
    exact, solid = Indentation(body, law, TRIANGLE), power(body, RADIUS)
    for finer in (1.0, FINE):
        scene = solid.tables(RADIUS / (PARTICLES * finer)) | {"viscoelasticity": terms_of(law)}
        run = bench.run(f"order_{name}_{finer:g}", scene | history(TRIANGLE, steps=STEPS))
        if isinstance(run, Refused):
            off.append(math.nan)
            continue
        each = [float(F) - exact.force(float(t)) for t, F in zip(run.curve["time"], run.curve["force"], strict=True)]
        off.append(float(np.sqrt(np.mean(np.square(each)))))
    order = math.log(off[0] / off[1]) / math.log(FINE)
    return at_least(f"sphere, {name}: order of the force in the spacing", order, ORDER, TING)


RELAXING = Study(
    "relaxing",
    "Viscoelastic bodies",
    "In histories of a displacement or a force the contact grows, is held, shrinks, ends and begins anew while the "
    "surface recovers. Are forces, displacements, contact times and dissipated energies those of Ting's theory and of"
    " the creep compliance?",
    measure,
)
