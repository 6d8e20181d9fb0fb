"""Similarity: lengths × s and energies × e are the same physics, F_A s/e and a/s the same numbers."""

from __future__ import annotations

from typing import Any

from validation.hard.cases import TENSION, PairCase, reach, shaped
from validation.row import Row, at_most
from validation.study import Bench, Findings, Refused, Study, said
from validation.study import found as result

NAME = "similarity"
LENGTHS = (1e-9, 1e-6, 1e-3, 1e3, 1e6)
ENERGIES = (1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9)
RATIO, PARTICLES = 0.5, 21
EQUAL = 1e-5
"""Relative: a hundredth of the tolerance of 1e-3. The numbers of a scaled scene are rounded anew, and the minimiser
stops elsewhere within its own share of the tolerance."""
BY_FORCE = {"quasistatic": False, "dynamic": True}


def measure(bench: Bench) -> Findings:
    """F_A and a_cr of every scaled scene against those of the scene as it is, which the closed form judges."""
    checks: list[Row] = []
    for method, dynamic in BY_FORCE.items():
        case = PairCase("base", RATIO, shaped("parabola", PARTICLES, reach(RATIO)), PARTICLES, TENSION, 1e-3, dynamic)
        exact = case.exact().adhesion(case.preload)[0]
        equal = EQUAL if not dynamic else 1e-2
        for what, factors in (("lengths", LENGTHS), ("energies", ENERGIES)):
            for factor in factors if bench.full or not dynamic else factors[::2]:
                s, e = (factor, 1.0) if what == "lengths" else (1.0, factor)
                run = bench.run(f"{method}_{what}_{factor:g}", scaled(case.scene(), s, e))
                off = float("nan")
                if isinstance(run, Refused):
                    off = 0.0 if run.before else off
                else:
                    off = abs(result(run, "adhesion_force").value * s / e / exact - 1.0)
                checks.append(
                    at_most(
                        f"F_A·s/e off, {what} × {factor:g}, {method}",
                        off,
                        equal,
                        "independent pairs, not scaled",
                        said("rounding; dynamic: the tolerance of the bracket", run),
                    )
                )
    return Findings(checks)


def scaled(scene: dict[str, Any], s: float, e: float) -> dict[str, Any]:
    """The scene with all lengths × s and all energies × e; masses as they are."""
    bodies = dict(scene["bodies"])
    profile = {key: value * s if key in ("radius", "height") else value for key, value in bodies["profile"].items()}
    bodies |= {
        "spacing": bodies["spacing"] * s,
        "profile": profile,
        "bulk_stiffness": bodies["bulk_stiffness"] * e / s**2,
    }
    law = {
        term: {"amplitude": values["amplitude"] * e, "range": values["range"] * s}
        for term, values in scene["interaction"].items()
    }
    experiment = scene["experiment"] | {"preload": scene["experiment"]["preload"] * e / s}
    return scene | {"bodies": bodies, "interaction": law, "experiment": experiment}


SIMILARITY = Study(
    NAME,
    "Similarity: lengths × 1e-9 … 1e6, energies × 1e-9 … 1e9",
    "An absolute threshold in a program gives different reduced results for metres and nanometres. The same "
    "results, or an error before the run.",
    measure,
)
