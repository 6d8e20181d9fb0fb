"""Kinks: bodies whose slope jumps up inside the contact, given as tables, and tables of bodies whose shape is known.

A worn tip is flat out to b and a cone beyond; under tension it parts where its edge has come back to b, for a whole
range of the work of adhesion, F_A = √(8πE*Wb³). At b the pressure has no bound. A table is points of a body: what it
gives is to be within its uncertainty of the body's, whatever the distance of the points and wherever the kink is
between them.
"""

from collections.abc import Iterator

import numpy as np

from validation.hard.expected import looked_up, marks
from validation.hard.judge import Case, judged, rows_of
from validation.hard.surfaces import KINKED, Surface, kinked_body, pieces, surface
from validation.hard.units import Scene, Units
from validation.references.axisymmetric import Body, Contact, with_rest_radius
from validation.row import tables_beside
from validation.study import Bench, Lines, Study

SOURCE = "the MDR by quadrature of the body"
LAND, REACH, SLOPE = 10.0, 60.0, 0.02
"""b and where the table ends [LU], slope of the cone."""
FORMS = tables_beside(__file__)
BALL, WORN = 1e4, 200.0
"""R and radius of the worn land [µm]."""
BALLS = Units(length=1e-6, stress=115e9, texts=True, automatic=True)
LOADS = (50.0, 200.0)
"""[N]"""
ROUNDINGS = (None, 6, 5)
"""Digits of the largest height in a table of a paraboloid."""


WORN_TIP = pieces((0.0, 0.0, 0.0), (LAND, SLOPE, 0.0))
"""Flat to LAND, then a cone."""


def pressed(body: Body, a: float) -> Scene:
    """The load of a contact radius."""
    return {"experiment": {"kind": "load", "force": Contact(body).force(a)}}


def pulled(contact: Contact, preload: float = 0.0) -> Scene:
    """A pull-off from twice the largest tension, or a preload."""
    force = preload or 2.0 * marks(contact, LAND)["adhesion_force"]
    return {"adhesion": {"work_of_adhesion": contact.work}, "experiment": {"kind": "pull_off", "preload": force}}


def kinks(full: bool) -> Iterator[Case]:
    """Loads and pull-offs of the worn tip, at several distances of points and particles; then of other bodies."""
    body, form = WORN_TIP, FORMS["full" if full else "short"]
    for count in form["counts"]:
        tip, points = Surface({}, body, LAND).sampled(REACH / (count - 1), REACH), f"worn tip of {count} points"
        kinds = {"load": (f"tip_load_{count}", pressed(body, 1.7 * LAND))}
        for work in form["works"]:
            kinds[f"W = {work:g}"] = f"tip_{count}_{work:g}", pulled(Contact(body, 1.0, work))
        for words, (name, tables) in kinds.items():
            for share in form["per_land"]:
                scene = tip.tables(LAND / share) | tables
                yield looked_up(f"{name}_{share:g}", f"{points}, {words}", f"spacing b/{share:g}", tip, scene)
    rng = np.random.default_rng(11)
    for kind in KINKED[1:]:
        body = kinked_body(kind, LAND, SLOPE, rng)
        pull, load = pulled(with_rest_radius(body, 1.0, 1.4 * LAND)), pressed(body, 2.0 * LAND)
        for words, tables in {"pull-off": pull, "load": load}.items():
            for inside in form["inside"]:
                solid = Surface({}, body, LAND).sampled(LAND / inside, REACH)
                yield looked_up(f"{kind}_{words}_{inside:g}", f"{kind}, {words}", f"{inside:g} points to the kink",
                                solid, solid.tables(LAND / 17.0) | tables)  # fmt: skip


def tables(full: bool) -> Iterator[Case]:
    """Worn balls in SI at several distances of the points, and paraboloids with few digits."""
    ball = Surface({}, pieces((0.0, 0.0, 0.0), (WORN, WORN / BALL, 1.0 / BALL)), WORN)
    for pitch in FORMS["full" if full else "short"]["pitches"]:
        solid = ball.sampled(pitch, 3.0 * WORN)
        for newtons in LOADS:
            scene = solid.tables(1.0) | {"experiment": {"kind": "load", "force": newtons / BALLS.sizes["N"]}}
            yield looked_up(f"worn_{pitch:g}_{newtons:g}", f"worn ball, points every {pitch:g} µm", f"{newtons:g} N",
                            solid, scene, BALLS)  # fmt: skip
    paraboloid = surface(20.0, "parabola", radius=1000.0)
    held = with_rest_radius(paraboloid.body, 1.0, 20.0)
    for digits in ROUNDINGS:
        solid, group = paraboloid.sampled(1.0, 60.0, digits), f"paraboloid of 61 points with {digits or 'all'} digits"
        for words, more in {"load": pressed(solid.body, 20.0), "pull-off": pulled(held, 1.0)}.items():
            yield looked_up(f"rounded_{words}_{digits}", group, words, solid, solid.tables(0.5) | more)


def measure(bench: Bench) -> Lines:
    """Rows of each body with a kink."""
    return rows_of(judged(bench, kinks(bench.full)), SOURCE)


def measure_tables(bench: Bench) -> Lines:
    """Rows of each table."""
    return rows_of(judged(bench, tables(bench.full)), SOURCE)


CLASSES = (
    Study(
        "kinks",
        "Profiles whose slope jumps inside the contact",
        "At a kink the force maximum is at the same corner on every lattice, and the pressure has no bound. Are "
        "results within their uncertainties, and is no value reported for an infinite pressure?",
        measure,
    ),
    Study(
        "tables",
        "Tables of points of known bodies",
        "A table describes the body at its points only, with a limited number of digits. Are displacement, contact "
        "radius and pull-off force within their uncertainties of those of the body itself?",
        measure_tables,
    ),
)
