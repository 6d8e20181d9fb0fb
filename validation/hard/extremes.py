"""Numbers far apart: radii, particles, plate masses, neighbour and tangential stiffnesses, each with an exact answer.

A flat punch of equal pairs has F_A = N f_max whatever the springs between neighbours and along x, which no relative
motion stretches; and a rigid plane carries F = k Σ max(0, d − h_i).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.optimize import brentq

from validation.figures import Panel, Series, figure
from validation.hard.cases import TENSION, PairCase, shaped
from validation.row import Row, at_most
from validation.study import Bench, Findings, Refused, Study, over_claim, said
from validation.study import found as result

NAME = "extremes"
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
    checks: list[Row] = []
    for radius in RADII:
        d = WIDTH**2 / radius
        places = np.arange(-30.0, 31.0)
        exact = 0.5 * float(np.sum(np.maximum(0.0, d - places**2 / radius)))
        off = _on_plane(bench, f"radius_{radius:g}", {"kind": "parabola", "radius": radius}, 61, d, exact)
        checks.append(
            at_most(
                f"force on a plane off, R = {radius:g} LU",
                off,
                PLANE,
                "Σ k (d − x²/R)",
                "round-off, and the minimiser's share of the tolerance",
            )
        )
    for count in FULL_COUNTS if bench.full else COUNTS:
        punch = {"kind": "flat_punch", "radius": 0.5 * count}
        off = _on_plane(bench, f"count_{count}", punch, count, 0.1, 0.5 * 0.1 * count)
        checks.append(
            at_most(
                f"force on a plane off, N = {count}",
                off,
                PLANE,
                "N k d",
                "round-off, and the minimiser's share of the tolerance",
            )
        )
    checks.append(_too_few(bench))
    drawn = [_masses(bench, checks)]
    drawn += [_springs(bench, checks, kind) for kind in ("neighbour", "tangential")]
    return Findings(
        checks,
        figure(
            "Error over claim far from the usual numbers; dashed: the bound",
            Panel("plate over particle mass, or stiffness over k", "error over claim", drawn, log="xy", bound=1.0),
        ),
    )


def _on_plane(bench: Bench, name: str, profile: dict[str, Any], count: int, d: float, exact: float) -> float:
    found = bench.run(
        name,
        {
            "bodies": {
                "particles": count,
                "spacing": 1.0,
                "profile": profile,
                "bulk_stiffness": 0.5,
                "lower": "rigid_plane",
            },
            "experiment": {"kind": "path", "displacements": [d]},
        },
    )
    return math.nan if isinstance(found, Refused) else abs(result(found, "largest_force").value / exact - 1.0)


def _too_few(bench: Bench) -> Row:
    """A body of one particle or two has no width that could be measured: a sentence before anything runs."""
    wrong = 0
    for count in REFUSED_COUNTS:
        case = PairCase("few", RATIO, {"kind": "flat_punch", "radius": 0.5 * count}, count, TENSION)
        found = bench.run(f"few_{count}", case.scene())
        wrong += not (isinstance(found, Refused) and found.before and "bodies.particles" in found.words)
    name = f"scenes of N in {REFUSED_COUNTS} that run, or end without naming bodies.particles"
    return at_most(name, wrong, 0.0, "three particles make the least width", evidence="set bound")


def _masses(bench: Bench, checks: list[Row]) -> Series:
    case = PairCase("masses", RATIO, shaped("flat_punch", PUNCH, 0.0), PUNCH, 0.0, 1e-3, dynamic=True)
    load = 0.5 * PUNCH * TENSION
    exact = case.exact().deepest(load)
    found = []
    for mass in FULL_MASSES if bench.full else MASSES:
        scene = case.scene() | {"plate": {"mass": mass}, "experiment": {"kind": "load", "force": load}}
        run = bench.run(f"mass_{mass:g}", scene)
        said_before = isinstance(run, Refused) and run.before
        over = math.nan if isinstance(run, Refused) else over_claim(run, "displacement", exact)
        over = 0.0 if said_before else over
        found.append((mass, over))
        checks.append(
            at_most(
                f"d under a load off over its claim, plate of {mass:g} particle masses",
                over,
                1.0,
                "independent pairs",
                said("what the run claims", run),
            )
        )
    return Series("mass of the plate", *np.array([(m, max(o, 1e-6)) for m, o in found if o == o]).T)


def _springs(bench: Bench, checks: list[Row], kind: str) -> Series:
    """F_A of a punch with neighbour springs; d of it under a tension with another stiffness along x."""
    case = PairCase("springs", RATIO, shaped("flat_punch", PUNCH, 0.0), PUNCH, TENSION)
    load = -0.5 * PUNCH * TENSION
    pairs = case.exact()
    place = float(brentq(lambda d: float(pairs.loading(d)) - load, pairs.adhesion(0.0)[1], 0.05, xtol=1e-15))
    found = []
    for factor in FULL_STIFFNESSES if bench.full else STIFFNESSES:
        scene = case.scene()
        if kind == "neighbour":
            run = bench.run(f"neighbour_{factor:g}", scene | {"neighbours": {"stiffness": factor * case.stiffness}})
            name, exact = "adhesion_force", PUNCH * TENSION
        else:
            bodies = scene["bodies"] | {"bulk_stiffness_tangential": factor * case.stiffness}
            experiment = {"kind": "load", "method": "quasistatic", "force": load}
            run = bench.run(
                f"tangential_{factor:g}", scene | {"bodies": bodies, "horizontal": {}, "experiment": experiment}
            )
            name, exact = "displacement", place
        over = math.nan if isinstance(run, Refused) else over_claim(run, name, exact)
        found.append((factor, over))
        checks.append(
            at_most(
                f"{name} of a punch off over its claim, {kind} springs of {factor:g} k",
                over,
                1.0,
                "N times one pair",
                said("what the run claims", run),
            )
        )
    return Series(f"{kind} springs", *np.array([(f, max(o, 1e-6)) for f, o in found if o == o]).T)


EXTREMES = Study(
    NAME,
    "Stiffness ratios 1e-6 to 1e6, radii to 1e9, 1 to 10⁶ particles, plate masses 1e-3 to 1e9",
    "Where numbers are far apart one of them is lost in the other's rounding, a time step is chosen for the wrong one, "
    "or a minimiser stops too early.",
    measure,
)
