"""Dugdale's law on the rigid plane, from the contact of Derjaguin, Muller and Toporov to that of Johnson, Kendall and
Roberts: `[adhesion] range`.

A paraboloid is held against Maugis's own equations, a cone, a power of 4 and flattened tips against boundary elements,
which share neither the MDR nor Abel's transforms with the program, and random scenes of every profile against
quadratures.

python -m validation.hard.cohesive SEED COUNT FOLDER      random scenes: a summary, and FOLDER/found.json
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from validation.doors import Run
from validation.hard.cohesive_draws import MAIN, cohesive, scene_of
from validation.hard.kinks import on_plane
from validation.hard.plane_bodies import Scene, sampled
from validation.hard.random_plane import Found, judge, main, outside, rows
from validation.references.axisymmetric import Body
from validation.references.dugdale import Cohesive
from validation.references.dugdale_elements import Elements
from validation.references.interaction import Floats
from validation.references.maugis import Paraboloid, State, of_tabor
from validation.row import Row, at_most
from validation.study import Bench, Findings, Refused, Study, said

NAME = "cohesive"
SEED, QUICK, FULL = 20261125, 20, 200
"""The date as the seed."""
TABOR = (0.01, 0.03, 0.1, 0.3, 0.5, 1.0, 3.0, 10.0, 30.0, 100.0)
ASKED, FINE = 1e-3, 1e-5
"""Relative error that is asked for, also of πWR, and the tolerance at which 0.109/λ² is to be seen."""
RADIUS, WORK = 1000.0, 5e-3
"""R [LU], W [FU/LU] of the paraboloid; E* = 1 FU/LU²."""
PARTICLES, STEPS, DENSE = 30.0, 60, 200
"""In a₁ = (3πWR²/4E*)^(1/3), steps of a path, and those of its end."""
ASIDE = (0.937, 1.043)
"""Where that end begins and ends, over the displacement at which the bodies part, which is in none of its middles."""
SOFT, EXCESS = 10.0, 0.1092
"""λ from which F_A/F_JKR − 1 is EXCESS/λ², to a share of 1/λ^NEXT."""
NEXT = 1.5
DMT = 2e-3
"""What F_A may be off 2πWR at µ = 0.01."""
ELEMENTS = 100
"""Annuli between two corners; with half as many and third order the errors are known, and below 1e-5 without them."""
LAND, SLOPE, POINTS = 10.0, 0.02, 4001
"""b [LU], the slope there, and the points of a table up to REACH."""
REACH = 200.0
SHARPNESS, FULL_SHARPNESS = (1.0,), (0.1, 1.0, 5.0)
"""Tabor parameters of the shapes."""
MAUGIS, THREE_D, QUADRATURE = "Maugis's equations", "boundary elements", "Dugdale's contact by quadrature"


def measure(bench: Bench) -> Findings:
    """The paraboloid, the shapes, random scenes."""
    known = conducted(bench, SEED, FULL if bench.full else QUICK)
    return Findings([*_paraboloids(bench), *_shapes(bench), *rows(known, SEED, QUADRATURE)])


def scene(profile: Scene, contact: Cohesive | Paraboloid, spacing: float, tolerance: float, experiment: Scene) -> Scene:
    """Of model units, E* = 1 FU/LU²."""
    one = on_plane(profile, spacing, tolerance, contact.work)
    return one | {"adhesion": one["adhesion"] | {"range": contact.reach}, "experiment": experiment}


def _paraboloids(bench: Bench) -> list[Row]:
    """Marks, the curve, and both limits, of every µ."""
    found: list[Row] = []
    for mu in TABOR:
        one, words = of_tabor(mu, RADIUS, 1.0, WORK), f"paraboloid, µ = {mu:g}"
        profile, spacing = {"kind": "parabola", "radius": RADIUS}, one.unit_radius / PARTICLES
        pull = {"kind": "pull_off", "preload": one.unit_force}
        pulled = bench.run(f"pull_{mu:g}", scene(profile, one, spacing, ASKED, pull))
        critical, free = one.state(one.reduced.critical), one.state(one.reduced.free)
        exact = {"adhesion_force": -critical.load, "zero_load_radius": free.a, "cohesive_radius": free.c}
        found += [_off(f"{words}: {name}", pulled, name, value) for name, value in exact.items()]
        found += _along(bench, one, words, profile, spacing, mu)
        found += _limits(bench, one, words, profile, spacing, mu, pulled)
    return found


def _along(bench: Bench, one: Paraboloid, words: str, profile: Scene, spacing: float, mu: float) -> list[Row]:
    """The unloading from a contact of twice a₁ to beyond the last state; where it ends."""
    last = one.state(one.reduced.snap_out)
    start, near, end = (
        one.state(one.reduced.of_radius(2.0)).displacement,
        0.95 * last.displacement,
        1.05 * last.displacement,
    )
    way = [*np.linspace(start, near, STEPS, endpoint=False).tolist(), *np.linspace(near, end, DENSE).tolist()]
    run = bench.run(f"path_{mu:g}", scene(profile, one, spacing, ASKED, {"kind": "path", "displacements": way}))
    marks = _off(f"{words}: fixed_grips_displacement", run, "fixed_grips_displacement", last.displacement)

    def of(a: float, c: float) -> State:
        reduced = one.reduced
        return one.state(reduced.of_radius(a / one.unit_radius) if a > 0.0 else reduced.alone(c / one.unit_radius))

    return [*_compared(words, run, of, one.unit_force, MAUGIS), marks]


def _limits(
    bench: Bench, one: Paraboloid, words: str, profile: Scene, spacing: float, mu: float, pulled: Run | Refused
) -> list[Row]:
    """DMT's force, and how fast JKR's is reached."""
    parameter = one.reduced.parameter
    if mu == TABOR[0]:
        force = _value(pulled, "adhesion_force") / one.unit_force
        return [at_most(f"{words}: F_A over that of DMT, 2πWR, less 1", abs(0.5 * force - 1.0), DMT, "DMT")]
    if parameter < SOFT:
        return []
    pull = {"kind": "pull_off", "preload": one.unit_force}
    run = bench.run(f"fine_{mu:g}", scene(profile, one, spacing, FINE, pull))
    excess = (_value(run, "adhesion_force") / (1.5 * one.unit_force) - 1.0) * parameter**2
    off = abs(excess / EXCESS - 1.0)
    limited = said(f"the next order; F_A to {FINE:g}", run)
    return [at_most(f"{words}: (F_A/F_JKR − 1) λ² over {EXCESS:g}, less 1", off, parameter**-NEXT, MAUGIS, limited)]


@dataclass(frozen=True)
class Shape:
    """A profile of a scene, the body that it is, its height, and a radius of its contacts [LU]."""

    profile: Scene
    body: Body
    height: Callable[[Floats], Floats]
    radius: float = LAND


def shapes() -> dict[str, Shape]:
    """A cone, a power of 4, and flattened tips as tables, with a parabola or a cone beyond the land."""
    end = LAND / SLOPE
    cone = Body(lambda _: SLOPE, lambda _: 0.0)
    quartic = Body(lambda r: SLOPE * (r / LAND) ** 3, lambda r: 3.0 * SLOPE * r**2 / LAND**3)
    worn = Body(lambda r: r / end if r >= LAND else 0.0, lambda r: float(r >= LAND) / end, (LAND,), (SLOPE,))
    tip = Body(lambda r: SLOPE if r >= LAND else 0.0, lambda _: 0.0, (LAND,), (SLOPE,))
    pitch = REACH / (POINTS - 1)
    return {
        "cone": Shape({"kind": "cone", "slope": SLOPE}, cone, lambda r: SLOPE * r),
        "power 4": Shape(
            {"kind": "power", "exponent": 4.0, "radius": LAND, "height": 0.25 * SLOPE * LAND},
            quartic,
            lambda r: 0.25 * SLOPE * LAND * (r / LAND) ** 4,
        ),
        "land, then parabola": Shape(
            sampled(worn, pitch, REACH, None), worn, lambda r: np.maximum(0.0, 0.5 * (r**2 - LAND**2) / end), 1.4 * LAND
        ),
        "land, then cone": Shape(
            sampled(tip, pitch, REACH, None), tip, lambda r: np.maximum(0.0, SLOPE * (r - LAND)), 1.4 * LAND
        ),
    }


def _shapes(bench: Bench) -> list[Row]:
    """The unloading of each shape beside boundary elements."""
    found: list[Row] = []
    for name, shape in shapes().items():
        for mu in FULL_SHARPNESS if bench.full else SHARPNESS:
            contact, words = cohesive(shape.body, shape.radius, mu), f"{name}, µ = {mu:g}"
            elements = Elements(shape.height, 1.0, contact.stress, contact.reach, shape.body.kinks, ELEMENTS)
            last = contact.snap_out
            start = contact.state(1.5 * contact.free.a).displacement
            way = {"from": start, "to": min(last.displacement, -contact.reach) * 1.1, "steps": STEPS, "return": False}
            experiment = {"kind": "path", "displacements": way}
            spacing = contact.free.a / PARTICLES
            run = bench.run(f"{name}_{mu:g}", scene(shape.profile, contact, spacing, ASKED, experiment))

            def of(a: float, c: float, elements: Elements = elements, contact: Cohesive = contact) -> State:
                if a == 0.0:
                    zone = contact.alone(c)
                    return State(0.0, c, zone.force, zone.displacement)
                half, whole = (replace(elements, count=count).solved(a) for count in (ELEMENTS // 2, ELEMENTS))
                return State(
                    a, *(y + (y - x) / 7.0 for x, y in ((half.c, whole.c), (half.force, whole.force),
                                                        (half.displacement, whole.displacement)))
                )  # fmt: skip

            found += _compared(words, run, of, -contact.critical.force, THREE_D)
    return found


def _compared(
    words: str, run: Run | Refused, of: Callable[[float, float], State], unit: float, source: str
) -> list[Row]:
    """F(a) over a force, c(a) and d(a) of each point of a curve; c and d over themselves and the range's own."""
    names = ("F(a) over πWR" if source == MAUGIS else "F(a) over F_A", "c(a)", "d(a)")
    limited, worst = said("what is asked", run), dict.fromkeys(names, 0.0)
    if isinstance(run, Refused) or "cohesive_radius" not in run.curve:
        return [at_most(f"{words}: {name} along the curve", math.nan, ASKED, source, limited) for name in names]
    curve: Any = run.curve
    held = [i for i, c in enumerate(curve["cohesive_radius"]) if c > 0.0]
    deepest = max(abs(float(curve["displacement"][i])) for i in held)
    for i in held:
        a, c = float(curve["contact_radius"][i]), float(curve["cohesive_radius"][i])
        exact = of(a, c)
        errors = (
            abs(float(curve["force"][i]) - exact.load) / unit,
            abs(c / exact.c - 1.0),
            abs(float(curve["displacement"][i]) - exact.displacement) / deepest,
        )
        worst = {name: max(before, off) for (name, before), off in zip(worst.items(), errors, strict=True)}
    points = f"{len(held)} points"
    return [at_most(f"{words}: {name} along the curve", off, ASKED, source, points) for name, off in worst.items()]


def _off(words: str, run: Run | Refused, name: str, exact: float) -> Row:
    """The relative error of a result."""
    return at_most(words, abs(_value(run, name) / exact - 1.0), ASKED, MAUGIS, said("what is asked", run))


def _value(run: Run | Refused, name: str) -> float:
    """A result, NaN where there is none."""
    return run.results[name].value if not isinstance(run, Refused) and name in run.results else math.nan


def conducted(bench: Bench, seed: int, count: int, tell: Callable[[str], None] = lambda _: None) -> Found:
    """`count` random scenes of a seed; numbers that need not be there are judged where they are."""
    found, number, made = Found(), 0, 0
    while made < count:
        if (one := scene_of(seed, number)) is not None:
            name = f"cohesive_{seed}_{number}"
            run = bench.run(name, one.scene)
            there = {} if isinstance(run, Refused) else run.results
            asked = {*there, *MAIN[one.scene["experiment"]["kind"]]}
            judge(found, name, replace(one, exact={n: v for n, v in one.exact.items() if n in asked}), run)
            made += 1
            if made % 25 == 0:
                tell(f"{made} scenes, {len(found.numbers)} numbers, {len(outside(found))} outside")
        number += 1
    return found


COHESIVE = Study(
    NAME,
    "Dugdale's law between the limits",
    "A range of the adhesion makes contacts that are neither DMT's nor JKR's. Are forces, radii and curves those of "
    "Maugis's equations, of boundary elements and of quadratures, for any profile, from one limit to the other?",
    measure,
)


if __name__ == "__main__":
    main(conducted)
