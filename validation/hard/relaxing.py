"""Bodies that relax, pushed in and drawn out over time: `[viscoelasticity]` with the experiment `history`.

Peaks, curves and the end of contact of a triangle and a trapezoid are held against Lee, Radok and Ting, those of a
sawtooth, whose surface recovers and is touched again, against springs with events in their own time, creep against the
compliance, pressures against line loads, and random histories against all of them.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from validation.hard import expected, expected_in_time, random_plane, surfaces, units
from validation.hard.draws import history, terms_of
from validation.hard.judge import Case, judged
from validation.references.relaxing import Flat, Indentation, KelvinVoigt, Legs, Material, Power
from validation.row import Row, at_least, tables_beside
from validation.study import Bench, Lines, Refused, Study

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
TABLES = tables_beside(__file__)
MATERIALS = {name: Material(tuple(map(tuple, terms))) for name, terms in TABLES["materials"].items()}
WAYS, FORCES, OTHERS = (
    {name: Legs(tuple(map(tuple, points))) for name, points in TABLES[key].items()}
    for key in ("ways", "forces", "others")
)
TRIANGLE = WAYS["triangle"]
RETARDED = (0.1, 0.3)
"""Retardation times [TU]."""
FREE = units.Units(length=1e-6, stress=1e6, time=1e-3, texts=True, automatic=True)
EVENTS = "springs with events in their own time"
TING = random_plane.TING
SOURCES = {"sawtooth": EVENTS, "touched": EVENTS, "force": "the creep compliance",
           "punch": "E(t) and C(t)", "Kelvin": "the closed form"}  # fmt: skip


def bodies(radius: float, depth: float) -> dict[str, Power]:
    """Of one contact radius at one depth."""
    made = {"sphere": Power(2.0, 1.0), "cone": Power(1.0, 1.0), "power 3": Power(3.0, 1.0)}
    return {name: replace(one, factor=depth / one.depth(radius)) for name, one in made.items()}


def case(
    name: str, group: str, words: str, body: Power | Flat, law: expected_in_time.Law, experiment: units.Scene
) -> Case:
    """A history with PARTICLES in the deepest contact."""
    solid = surfaces.power(body, RADIUS)
    spacing = 1.0 if isinstance(body, Flat) else RADIUS / PARTICLES
    scene = solid.tables(spacing) | {"viscoelasticity": terms_of(law)} | experiment
    return expected.looked_up(f"{name}_{words}", group, words, solid, scene)


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
            yield case(name, name, m, Flat(RADIUS), law, history(OTHERS["held"], by_force))
    for b, body in named:
        for time in RETARDED:
            yield case(
                "retarded", "Kelvin and Voigt", f"{b}, T = {time:g}", body, KelvinVoigt(body, time), history(TRIANGLE)
            )
    dashpots = KelvinVoigt(Power(4.0, 1e-8), 1.0)
    yield case(
        "example", "Kelvin and Voigt, force given", "example", dashpots.body, dashpots, history(OTHERS["example"], True)
    )


def measure(bench: Bench) -> Lines:
    """Each kind of history, then random ones."""
    for words, judge in judged(bench, cases(bench.full)).items():
        source = next((source for word, source in SOURCES.items() if words.startswith(word)), TING)
        yield from judge.rows(words, source)
        for column in judge.along if "automatic" not in words else ():
            yield judge.curve(words, column, PUNCHED if words == "punch" else expected_in_time.ALONG, source)
        if "spacing given" in words:
            yield judge.near(words, "peak_force", expected_in_time.ALONG, source)
    for name, law in MATERIALS.items():
        yield _order(bench, name, law)
    yield from random_plane.random_rows(bench, random_plane.RELAXING, TING)


def _order(bench: Bench, name: str, law: Material) -> Row:
    """In the spacing, of a sphere."""
    body, off = bodies(RADIUS, DEPTH)["sphere"], []
    exact, solid = Indentation(body, law, TRIANGLE), surfaces.power(body, RADIUS)
    for finer in (1.0, FINE):
        scene = solid.tables(RADIUS / (PARTICLES * finer)) | {"viscoelasticity": terms_of(law)}
        run = bench.run(f"order_{name}_{finer:g}", scene | history(TRIANGLE, steps=STEPS))
        if isinstance(run, Refused):
            off.append(math.nan)
            continue
        each = [float(F) - exact.force(float(t)) for t, F in zip(run.curve["time"], run.curve["force"], strict=True)]
        off.append(np.sqrt(np.mean(np.square(each))))
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
