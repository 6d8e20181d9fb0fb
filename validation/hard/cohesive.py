"""Dugdale's law on the rigid plane, from the contact of Derjaguin, Muller and Toporov to that of Johnson, Kendall and
Roberts: `[adhesion] range`.

A paraboloid is held against Maugis's own equations, a cone, a power of 4 and flattened tips against boundary elements,
which share neither the MDR nor Abel's transforms with the program, and random scenes of every profile against
quadratures.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np

from validation.doors import Run
from validation.hard import random_plane
from validation.hard.draws import cohesive
from validation.hard.kinks import LAND, SLOPE, WORN_TIP
from validation.hard.surfaces import Surface, pieces, surface
from validation.hard.units import Scene
from validation.references.dugdale import Cohesive
from validation.references.dugdale_elements import Elements
from validation.references.interaction import Floats
from validation.references.maugis import Paraboloid, State, of_tabor
from validation.row import Row, at_most, worst
from validation.study import Bench, Lines, Refused, Study, found, said

TABOR = (0.01, 0.03, 0.1, 0.3, 0.5, 1.0, 3.0, 10.0, 30.0, 100.0)
ASKED, FINE = 1e-3, 1e-5
"""Relative error that is asked for, also of πWR, and the tolerance at which 0.109/λ² is to be seen."""
RADIUS, WORK = 1000.0, 5e-3
"""R [LU], W [FU/LU] of the paraboloid; E* = 1 FU/LU²."""
PARTICLES, STEPS, DENSE = 30.0, 60, 200
"""In a₁ = (3πWR²/4E*)^(1/3), steps of a path, and those of its end, from 0.95 to 1.05 of where bodies part."""
SOFT, EXCESS = 10.0, 0.1092
"""λ from which F_A/F_JKR − 1 is EXCESS/λ², to a share of 1/λ^NEXT."""
NEXT = 1.5
DMT = 2e-3
"""What F_A may be off 2πWR at µ = 0.01."""
ELEMENTS = 100
"""Annuli between two corners; with half as many and third order the errors are known, and below 1e-5 without them."""
PITCH, REACH = 0.05, 200.0
"""Of the points of a table [LU]."""
SHARPNESS, FULL_SHARPNESS = (1.0,), (0.1, 1.0, 5.0)
"""Tabor parameters of the shapes."""
MAUGIS, THREE_D, QUADRATURE = "Maugis's equations", "boundary elements", "Dugdale's contact by quadrature"


def measure(bench: Bench) -> Lines:
    """The paraboloid, the shapes, random scenes."""
    for mu in TABOR:
        yield from _paraboloid(bench, mu)
    for (name, solid), mu in product(shapes().items(), FULL_SHARPNESS if bench.full else SHARPNESS):
        yield from _shape(bench, name, mu, *solid)
    yield from random_plane.random_rows(bench, random_plane.COHESIVE, QUADRATURE)


def scene(solid: Surface, contact: Cohesive | Paraboloid, spacing: float, tolerance: float, experiment: Scene) -> Scene:
    """Of model units, E* = 1 FU/LU²."""
    adhesion = {"work_of_adhesion": contact.work, "range": contact.reach}
    return solid.tables(spacing, tolerance) | {"adhesion": adhesion, "experiment": experiment}


def _paraboloid(bench: Bench, mu: float) -> Lines:
    """Marks, the curve from a contact of twice a₁ to where it ends, and both limits, of one µ."""
    one, words, solid = (
        of_tabor(mu, RADIUS, 1.0, WORK),
        f"paraboloid, µ = {mu:g}",
        surface(1.0, "parabola", radius=RADIUS),
    )
    reduced, spacing = one.reduced, one.unit_radius / PARTICLES
    critical, free, last = one.state(reduced.critical), one.state(reduced.free), one.state(reduced.snap_out)
    pull = {"kind": "pull_off", "preload": one.unit_force}
    pulled = bench.run(f"pull_{mu:g}", scene(solid, one, spacing, ASKED, pull))
    start, near, end = (
        one.state(reduced.of_radius(2.0)).displacement,
        0.95 * last.displacement,
        1.05 * last.displacement,
    )
    way = [*np.linspace(start, near, STEPS, endpoint=False).tolist(), *np.linspace(near, end, DENSE).tolist()]
    path = bench.run(f"path_{mu:g}", scene(solid, one, spacing, ASKED, {"kind": "path", "displacements": way}))

    def of(a: float, c: float) -> State:
        return one.state(reduced.of_radius(a / one.unit_radius) if a > 0.0 else reduced.alone(c / one.unit_radius))

    exact = {"adhesion_force": -critical.load, "zero_load_radius": free.a, "cohesive_radius": free.c}
    for name, value in exact.items():
        yield _off(words, pulled, name, value)
    yield from _compared(words, path, of, one.unit_force, MAUGIS)
    yield _off(words, path, "fixed_grips_displacement", last.displacement)
    if mu == TABOR[0]:
        off = abs(0.5 * _value(pulled, "adhesion_force") / one.unit_force - 1.0)
        yield at_most(f"{words}: F_A over that of DMT, 2πWR, less 1", off, DMT, "DMT")
    if reduced.parameter >= SOFT:
        run = bench.run(f"fine_{mu:g}", scene(solid, one, spacing, FINE, pull))
        excess = (_value(run, "adhesion_force") / (1.5 * one.unit_force) - 1.0) * reduced.parameter**2
        name, limited = f"{words}: (F_A/F_JKR − 1) λ² over {EXCESS:g}, less 1", f"the next order; F_A to {FINE:g}"
        yield at_most(name, abs(excess / EXCESS - 1.0), reduced.parameter**-NEXT, MAUGIS, said(limited, run))


def shapes() -> dict[str, tuple[Surface, Callable[[Floats], Floats]]]:
    """A cone, a power of 4, and flattened tips as tables, with a parabola or a cone beyond the land; their heights."""
    end, rise = LAND / SLOPE, 0.25 * SLOPE * LAND
    ball = pieces((0.0, 0.0, 0.0), (LAND, SLOPE, SLOPE / LAND))
    worn, tip = (Surface({}, body, 1.4 * LAND).sampled(PITCH, REACH) for body in (ball, WORN_TIP))
    return {
        "cone": (surface(LAND, "cone", slope=SLOPE), lambda r: SLOPE * r),
        "power 4": (surface(LAND, "power", exponent=4.0, radius=LAND, height=rise), lambda r: rise * (r / LAND) ** 4),
        "land, then parabola": (worn, lambda r: np.maximum(0.0, 0.5 * (r**2 - LAND**2) / end)),
        "land, then cone": (tip, lambda r: np.maximum(0.0, SLOPE * (r - LAND))),
    }


def _shape(bench: Bench, name: str, mu: float, solid: Surface, height: Callable[[Floats], Floats]) -> list[Row]:
    """The unloading of a shape beside boundary elements."""
    contact = cohesive(solid, mu)
    elements = Elements(height, 1.0, contact.stress, contact.reach, solid.body.kinks, ELEMENTS)
    start, last = contact.state(1.5 * contact.free.a).displacement, contact.snap_out.displacement
    way = {"from": start, "to": min(last, -contact.reach) * 1.1, "steps": STEPS, "return": False}
    experiment = {"kind": "path", "displacements": way}
    run = bench.run(f"{name}_{mu:g}", scene(solid, contact, contact.free.a / PARTICLES, ASKED, experiment))

    def of(a: float, c: float) -> State:
        if a == 0.0:
            zone = contact.alone(c)
            return State(0.0, c, zone.force, zone.displacement)
        half, whole = (replace(elements, count=count).solved(a) for count in (ELEMENTS // 2, ELEMENTS))
        pairs = ((half.c, whole.c), (half.force, whole.force), (half.displacement, whole.displacement))
        return State(a, *(y + (y - x) / 7.0 for x, y in pairs))

    return _compared(f"{name}, µ = {mu:g}", run, of, -contact.critical.force, THREE_D)


def _compared(words: str, run: Run | Refused, of: Callable[[float, float], State], unit: float, by: str) -> list[Row]:
    """F(a) over a force, c(a) and d(a) of each point of a curve; c and d over themselves and the range's own."""
    names, limited = ("F(a) over πWR" if by == MAUGIS else "F(a) over F_A", "c(a)", "d(a)"), said("what is asked", run)
    off = []
    if not isinstance(run, Refused) and "cohesive_radius" in run.curve:
        curve: Any = run.curve
        columns = [np.asarray(curve[key]) for key in ("contact_radius", "cohesive_radius", "force", "displacement")]
        held = np.stack(columns, axis=1)[columns[1] > 0.0]
        deepest = np.abs(held[:, 3]).max()
        for a, c, force, d in held.tolist():
            exact = of(a, c)
            off.append((abs(force - exact.load) / unit, abs(c / exact.c - 1.0), abs(d - exact.displacement) / deepest))
        limited = f"{len(off)} points"
    values = map(worst, zip(*off, strict=True)) if off else [math.nan] * 3
    return [at_most(f"{words}: {name} along the curve", value, ASKED, by, limited)
            for name, value in zip(names, values, strict=True)]  # fmt: skip


def _off(words: str, run: Run | Refused, name: str, exact: float) -> Row:
    """The relative error of a result."""
    return at_most(f"{words}: {name}", abs(_value(run, name) / exact - 1.0), ASKED, MAUGIS, said("what is asked", run))


def _value(run: Run | Refused, name: str) -> float:
    """A result, NaN where there is none."""
    return math.nan if isinstance(run, Refused) else found(run, name).value


COHESIVE = Study(
    "cohesive",
    "Dugdale's attraction of finite range, from DMT to JKR",
    "An attraction of finite range makes contacts that are neither DMT's nor JKR's. Are forces, radii and curves "
    "those of Maugis's equations, of boundary elements and of quadratures, for any profile, from one limit to the "
    "other?",
    measure,
)
