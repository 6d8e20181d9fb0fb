"""Numbers far apart: radii, particles, plate masses, neighbour and tangential stiffnesses, each with an exact answer.

A flat punch of equal pairs has F_A = N f_max whatever the springs between neighbours and along x, which no relative
motion stretches; and a rigid plane carries F = k Σ max(0, d − h_i).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from validation.hard.cases import TENSION, PairCase, shaped
from validation.row import Row, at_most, so
from validation.study import Bench, Findings, Refused, Study, claim_row, found

RADII = (1.0, 1e3, 1e6, 1e9)
REFUSED_COUNTS = (1, 2)
"""Too few for a radius: refused before anything runs."""
COUNTS, FULL_COUNTS = (3, 1000, 100_000), (3, 30, 1000, 100_000, 1_000_000)
MASSES, FULL_MASSES = (1e-3, 1e3, 1e9), (1e-3, 1.0, 1e3, 1e6, 1e9)
STIFFNESSES, FULL_STIFFNESSES = (1e-6, 1e-3, 1e3, 1e6), (1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6)
PLANE = 1e-5
"""Relative: a hundredth of the tolerance; without neighbours the plane is exact."""
WIDTH = 10.3
"""Half-width of a contact over the spacing; no particle is at its edge."""
RATIO, PUNCH = 0.3, 10


def measure(bench: Bench) -> Findings:
    """One row for each extreme; a refusal before anything runs is an answer where the row says so."""
    places = np.arange(-30.0, 31.0)
    on_plane = []
    for radius in RADII:
        d = WIDTH**2 / radius
        exact = 0.5 * float(np.sum(np.maximum(0.0, d - places**2 / radius)))
        words, profile = f"R = {radius:g} LU", {"kind": "parabola", "radius": radius}
        on_plane.append((f"radius_{radius:g}", words, profile, 61, d, exact, "Σ k (d − x²/R)"))
    for count in FULL_COUNTS if bench.full else COUNTS:
        punch = {"kind": "flat_punch", "radius": 0.5 * count}
        on_plane.append((f"count_{count}", f"N = {count}", punch, count, 0.1, 0.5 * 0.1 * count, "N k d"))
    limit = "round-off, and the minimiser's share of the tolerance"
    rows = [
        at_most(f"force on a plane off, {words}", _off(bench, name, profile, count, d, exact), PLANE, source, limit)
        for name, words, profile, count, d, exact, source in on_plane
    ]
    springs = [row for kind in ("neighbour", "tangential") for row in _springs(bench, kind)]
    return Findings([*rows, _too_few(bench), *_masses(bench), *springs])


def _off(bench: Bench, name: str, profile: dict[str, Any], count: int, d: float, exact: float) -> float:
    bodies = {"particles": count, "spacing": 1.0, "profile": profile, "bulk_stiffness": 0.5, "lower": "rigid_plane"}
    run = bench.run(name, {"bodies": bodies, "experiment": {"kind": "path", "displacements": [d]}})
    return math.nan if isinstance(run, Refused) else abs(found(run, "largest_force").value / exact - 1.0)


def _too_few(bench: Bench) -> Row:
    """A body of one particle or two has no width that could be measured: a sentence before anything runs."""
    wrong = False
    for count in REFUSED_COUNTS:
        case = PairCase("few", RATIO, {"kind": "flat_punch", "radius": 0.5 * count}, count, TENSION)
        found = bench.run(f"few_{count}", case.scene())
        wrong |= not (isinstance(found, Refused) and found.before and "bodies.particles" in found.words)
    name = f"scenes of N in {REFUSED_COUNTS} that run, or end without naming bodies.particles"
    return so(name, wrong, "three particles make the least width")


def _masses(bench: Bench) -> Iterator[Row]:
    """d of a punch under a load, by the mass of the plate; a refusal beforehand is an answer."""
    case = PairCase("masses", RATIO, shaped("flat_punch", PUNCH, 0.0), PUNCH, 0.0, 1e-3, dynamic=True)
    load = 0.5 * PUNCH * TENSION
    exact = case.exact().deepest(load)
    for mass in FULL_MASSES if bench.full else MASSES:
        run = bench.run(
            f"mass_{mass:g}", case.scene() | {"plate": {"mass": mass}, "experiment": {"kind": "load", "force": load}}
        )
        words = f"d under a load off over its claim, plate of {mass:g} particle masses"
        row = claim_row(words, run, "displacement", exact, "independent pairs")
        yield replace(row, value=0.0) if isinstance(run, Refused) and run.before else row


def _springs(bench: Bench, kind: str) -> Iterator[Row]:
    """F_A of a punch with neighbour springs; d of it under a tension with another stiffness along x."""
    case = PairCase("springs", RATIO, shaped("flat_punch", PUNCH, 0.0), PUNCH, TENSION)
    load, pairs = -0.5 * PUNCH * TENSION, case.exact()
    tables: dict[str, Any]
    place = float(brentq(lambda d: float(pairs.loading(d)) - load, pairs.adhesion(0.0)[1], 0.05, xtol=1e-15))
    for factor in FULL_STIFFNESSES if bench.full else STIFFNESSES:
        scene = case.scene()
        if kind == "neighbour":
            tables, name, exact = (
                {"neighbours": {"stiffness": factor * case.stiffness}},
                "adhesion_force",
                PUNCH * TENSION,
            )
        else:
            bodies = scene["bodies"] | {"bulk_stiffness_tangential": factor * case.stiffness}
            experiment = {"kind": "load", "method": "quasistatic", "force": load}
            tables = {"bodies": bodies, "horizontal": {}, "experiment": experiment}
            name, exact = "displacement", place
        words = f"{name} of a punch off over its claim, {kind} springs of {factor:g} k"
        yield claim_row(words, bench.run(f"{kind}_{factor:g}", scene | tables), name, exact, "N times one pair")


EXTREMES = Study(
    "extremes",
    "Stiffness ratios 1e-6 to 1e6, radii to 1e9, 1 to 10⁶ particles, plate masses 1e-3 to 1e9",
    "With parameters of very different magnitude one may be lost in round-off, the time step may follow the wrong "
    "one, or a minimiser may stop too early.",
    measure,
)
