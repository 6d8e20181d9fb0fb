"""Paths of few steps: closed loops of an adhesive contact.

An adhesive loop loses −E(a_in) where the bodies touch, at d = 0, and E(a_fg) where they part under fixed grips. Steps
that are as wide as the loop see these jumps at their ends alone, or not at all. A 0 is then no answer: a loss is stated
with what it may be off by, or is named as not known.
"""

from collections.abc import Iterator
from itertools import product

from validation.hard.expected import looked_up
from validation.hard.judge import Case, judged
from validation.hard.surfaces import surface
from validation.references.axisymmetric import with_rest_radius
from validation.row import at_most, tables_beside
from validation.study import LONGEST, Bench, Lines, Study

RADIUS, SLOPE = 10.0, 0.01
"""a₀ and the slope there of every contact [LU]."""
SHAPES = {
    "cone": surface(RADIUS, "cone", slope=SLOPE),
    "parabola": surface(RADIUS, "parabola", radius=RADIUS / SLOPE),
    "power": surface(RADIUS, "power", exponent=3.0, radius=RADIUS, height=SLOPE * RADIUS / 3.0),
}
LOADS = (2.0, 50.0)
"""Compression at the other end over F_A: beside the work of a large one the loss is small."""
SPACING = 0.7
SOURCE, LOST = "the energies of the jumps by quadrature", ("dissipated_energy", "instability_energy")


def measure(bench: Bench) -> Lines:
    """Loops of every shape; a row each of losses that are no number."""
    for words, judge in judged(bench, cases(bench.full)).items():
        none = [n.label for n in judge.numbers if n.name in LOST and n.reference and abs(n.value) <= n.uncertainty]
        unseen = f"{words}: losses reported as less than their uncertainty"
        yield from judge.rows(words, SOURCE)
        yield at_most(unseen, len(none), 0.0, SOURCE, ", ".join(none)[:LONGEST] or "–")


def cases(full: bool) -> Iterator[Case]:
    """Out of the contact and back, or in and out, in different numbers of steps."""
    form = tables_beside(__file__)["full" if full else "short"]
    for name, turn in product(form["shapes"], form["turns"]):
        solid = SHAPES[name]
        contact = with_rest_radius(solid.body, 1.0, RADIUS)
        apart = turn * contact.displacement(contact.fixed_grips(RADIUS))
        for words, start, load in product(("out", "in"), ("approach", "contact"), LOADS):
            deep = contact.displacement(contact.pressed_radius(-load * contact.force(contact.critical(RADIUS)), RADIUS))
            first, last = (deep, apart) if words == "out" else (apart, deep)
            group = f"{name}, {words} to {turn:g} of fixed grips from {start}, {load:g} F_A"
            for steps in form["steps"]:
                way = {"from": first, "to": last, "steps": steps, "return": True}
                tables = {"adhesion": {"work_of_adhesion": contact.work},
                          "experiment": {"kind": "path", "start": start, "displacements": way}}  # fmt: skip
                run = f"{name}_{turn:g}_{start}_{words}_{load:g}_{steps}"
                yield looked_up(run, group, f"{steps} steps", solid, solid.tables(SPACING) | tables)


COARSE_PATHS = Study(
    "coarse_paths",
    "Paths of few steps",
    "Load steps as long as a loop is wide show no dissipated energy at all. Is the dissipated energy within its "
    "uncertainty, or reported as unknown?",
    measure,
)
