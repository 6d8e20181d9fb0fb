"""Numbers far apart: radii, particles, neighbour and tangential stiffnesses, each with an exact answer.

A flat punch of equal pairs has F_A = N f_max whatever the springs between neighbours and along x, which no relative
motion stretches; and a rigid plane carries F = k Σ max(0, d − h_i).
"""

from collections.abc import Iterator

import numpy as np

from validation.hard.cases import TENSION, PairCase, shaped
from validation.hard.judge import Case, Expected, judged
from validation.hard.units import Scene
from validation.row import Row, tables_beside
from validation.study import Bench, Lines, Study, claim_row

RADII = (1.0, 1e3, 1e6, 1e9)
FORMS = tables_beside(__file__)
PLANE = 1e-5
"""Relative: a hundredth of the tolerance; without neighbours the plane is exact."""
WIDTH = 10.3
"""Half-width of a contact over the spacing; no particle is at its edge."""
RATIO, PUNCH = 0.3, 10


def on_plane(full: bool) -> Iterator[Case]:
    """F of a displacement, by the radius and by the number of particles."""
    shapes: dict[str, tuple[Scene, int, float]] = {
        f"R = {R:g} LU": ({"kind": "parabola", "radius": R}, 61, WIDTH**2 / R) for R in RADII
    }
    for count in FORMS["full" if full else "short"]["counts"]:
        shapes[f"N = {count}"] = {"kind": "flat_punch", "radius": 0.5 * count}, count, 0.1
    for words, (profile, count, d) in shapes.items():
        x = np.arange(count) - 0.5 * (count - 1)
        heights = x**2 / profile["radius"] if profile["kind"] == "parabola" else 0.0 * x
        force = 0.5 * np.sum(np.maximum(0.0, d - heights))
        bodies = {"particles": count, "spacing": 1.0, "profile": profile, "bulk_stiffness": 0.5, "lower": "rigid_plane"}
        scene = {"bodies": bodies, "experiment": {"kind": "path", "displacements": [d]}}
        yield Case(words, words, words, scene, Expected({"largest_force": force}))


def measure(bench: Bench) -> Lines:
    """One row for each extreme."""
    source = "Σ k (d − x²/R), N k d"
    for words, judge in judged(bench, on_plane(bench.full)).items():
        yield judge.near(f"on a plane, {words}", "largest_force", PLANE, source)
    yield from _springs(bench)


def _springs(bench: Bench) -> Iterator[Row]:
    """F_A of a punch with neighbour springs; d of it under a tension with another stiffness along x."""
    case = PairCase("springs", RATIO, shaped("flat_punch", PUNCH, 0.0), PUNCH, TENSION)
    scene, load = case.scene(), -0.5 * PUNCH * TENSION
    held = {"horizontal": {}, "experiment": {"kind": "load", "method": "quasistatic", "force": load}}
    for factor in FORMS["full" if bench.full else "short"]["stiffnesses"]:
        k = factor * case.stiffness
        bodies = {"bodies": scene["bodies"] | {"bulk_stiffness_tangential": k}}
        kinds = {
            "neighbour": ({"neighbours": {"stiffness": k}}, "adhesion_force", PUNCH * TENSION),
            "tangential": (held | bodies, "displacement", case.unloaded(load, 0.05)),
        }
        for kind, (tables, name, exact) in kinds.items():
            words = f"{name} of a punch off over its claim, {kind} springs of {factor:g} k"
            run = bench.run(f"{kind}_{factor:g}", scene | tables)
            yield claim_row(words, run, name, exact, "N times one pair")


EXTREMES = Study(
    "extremes",
    "Springs of 1e-6 to 1e6 times the bulk stiffness, radii to 1e9 LU, 3 to 10⁶ particles",
    "With parameters of very different magnitude one may be lost in round-off, or a minimiser may stop too early."
    " Are forces and displacements the exact ones?",
    measure,
)
