"""Stiffness ratio from 0.3 to 100: smooth contacts, those about to snap, and those that snap, by both methods."""

from __future__ import annotations

import math

import numpy as np

from validation.doors import Run
from validation.figures import Panel, Series, figure
from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.row import Row, at_most, worst
from validation.study import Bench, Findings, Refused, Study, over_claim
from validation.study import found as result

NAME = "stiffness"
RATIOS = (0.3, 0.7, 0.9, 0.99, 1.01, 1.5, 3.0, 10.0, 100.0)
FULL_RATIOS = (
    0.3,
    0.5,
    0.7,
    0.8,
    0.9,
    0.95,
    0.99,
    0.999,
    1.001,
    1.01,
    1.1,
    1.5,
    2.0,
    3.0,
    5.0,
    10.0,
    20.0,
    30.0,
    50.0,
    100.0,
)
DYNAMIC_RATIOS, FULL_DYNAMIC = (0.3, 0.9, 3.0), (0.3, 0.7, 0.9, 0.99, 1.01, 1.5, 3.0, 10.0, 30.0, 100.0)
"""In time a tension that passes one tooth is carried by the next that is higher: the highest counts there as well."""
TOLERANCES = (1e-2, 1e-3, 1e-4)
SHAPES = {
    "flat punch of 3": ("flat_punch", 3),
    "flat punch of 10": ("flat_punch", 10),
    "cone of 9": ("cone", 9),
    "parabola of 21": ("parabola", 21),
    "power of 40": ("power", 40),
    "parabola of 200": ("parabola", 200),
}
REFERENCE = 1e-9
"""Relative error of the closed form's largest tension."""
SOURCE = "independent pairs with their folds, F_A by bisection and Newton's method"


def cases(full: bool) -> list[PairCase]:
    """Every shape at every ratio in the long form, every second in the quick one; the tolerance goes round."""
    listed = []
    for i, ratio in enumerate(FULL_RATIOS if full else RATIOS):
        for j, shape in enumerate(SHAPES):
            wide = j == len(SHAPES) - 1
            if not full and ((i + j) % 2 or (wide and ratio > 1.0)):
                continue
            listed.append(_case(shape, ratio, TOLERANCES[(i + 2 * j) % len(TOLERANCES)], dynamic=False))
    shapes = ("flat punch of 10", "parabola of 21", "power of 40") if full else ("flat punch of 3", "parabola of 21")
    for i, ratio in enumerate(FULL_DYNAMIC if full else DYNAMIC_RATIOS):
        for j, shape in enumerate(shapes):
            tolerance = TOLERANCES[(i + 2 * j) % len(TOLERANCES) if full else 0]
            listed.append(_case(shape, ratio, tolerance, dynamic=True))
    return listed


def _case(shape: str, ratio: float, tolerance: float, dynamic: bool) -> PairCase:
    kind, particles = SHAPES[shape]
    profile = shaped(kind, particles, reach(ratio))
    name = f"{shape.replace(' ', '_')}_{ratio:g}_{tolerance:g}" + ("_dynamic" if dynamic else "")
    return PairCase(name, ratio, profile, particles, 1.5 * TENSION, tolerance, dynamic)


def measure(bench: Bench) -> Findings:
    """F_A of every case over its claim, ratio by ratio; over the tolerance where that is claimed; refusals."""
    claims: dict[tuple[bool, float], list[float]] = {}
    tolerances: dict[float, list[float]] = {}
    errors: list[tuple[float, float]] = []
    refused, solvable = 0, 0
    for case in cases(bench.full):
        if not case.solvable():
            continue
        solvable += 1
        found = bench.run(case.name, case.scene())
        if isinstance(found, Refused):
            refused += 1
            continue
        exact = case.exact().adhesion(case.preload)[0]
        claims.setdefault((case.dynamic, case.ratio), []).append(over_claim(found, "adhesion_force", exact, REFERENCE))
        off = _over_tolerance(found, exact, case.tolerance)
        tolerances.setdefault(case.tolerance, []).append(off)
        errors.append((case.ratio, _relative(found, exact)))
    checks = [_claim_row(dynamic, ratio, values) for (dynamic, ratio), values in sorted(claims.items())]
    checks += [
        at_most(
            f"F_A off over the tolerance {tolerance:g} where no warning says so",
            worst(values),
            1.0,
            SOURCE,
            "the tolerance asked for",
        )
        for tolerance, values in sorted(tolerances.items())
    ]
    share = refused / solvable if solvable else math.nan
    checks.append(
        at_most(
            f"share refused of {solvable} cases that have a stable way below 0.9 of the core's force",
            share,
            0.05,
            "what is asked: 95 % must run",
            "statistics of so many cases",
            "set bound",
        )
    )
    x, y = np.array(errors).T
    return Findings(
        checks,
        figure(
            "Error of F_A over the stiffness ratio; dashed: the widest tolerance",
            Panel(
                "stiffness ratio",
                "relative error of $F_A$",
                [Series("runs", x, np.maximum(y, REFERENCE))],
                log="xy",
                bound=max(TOLERANCES),
            ),
        ),
    )


def _claim_row(dynamic: bool, ratio: float, values: list[float]) -> Row:
    method = "dynamic" if dynamic else "quasistatic"
    return at_most(
        f"F_A off over its claim, ratio {ratio:g}, {method}", worst(values), 1.0, SOURCE, "what the run claims"
    )


def _over_tolerance(found: Run, exact: float, tolerance: float) -> float:
    """Error over the tolerance that was asked for; 0 where the run says that it is not reached."""
    return 0.0 if "tolerance" in found.warnings else max(0.0, _relative(found, exact) - REFERENCE) / tolerance


def _relative(found: Run, exact: float) -> float:
    return abs(result(found, "adhesion_force").value / exact - 1.0)


STIFFNESS = Study(
    NAME,
    "Stiffness ratio 0.3 to 100",
    "Below 1 no pair snaps, and close to 1 the force has a kink that a coarse path misses; above 1 the force has "
    "many maxima, of which the highest is F_A. Sharp and blunt bodies, 3 to 200 particles, tolerances 1e-2 to "
    "1e-4, both methods.",
    measure,
)
