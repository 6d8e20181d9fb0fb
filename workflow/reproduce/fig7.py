"""Fig. 7 and its exponents: F_A and a₀ over R, by regression of logarithms with Student's confidence interval.

Closed form where only opposite particles meet: F_A ∝ √R and a₀ ∝ √R exactly, whatever the law (`independent_pairs`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.stats import linregress, t

from contact1d.workflow.reproduce.check import Check
from contact1d.workflow.reproduce.figures import Series, save, scaling_figure
from contact1d.workflow.reproduce.oracles import independent_pairs
from contact1d.workflow.reproduce.page import share
from contact1d.workflow.reproduce.paper import local, with_radius
from contact1d.workflow.reproduce.runs import found
from contact1d.workflow.reproduce.study import Findings, Runs, Scenes, Study, checker
from contact1d.workflow.scene import Scene

RADII = (500.0, 1000.0, 1600.0, 2000.0, 3000.0, 4000.0)
"""R [LU] of the paper's chain, those of Table 1 among them."""
LOCAL_RADII = (4000.0, 8000.0, 16000.0, 32000.0)
"""R [LU] in the local limit; large, so that the wide spacing resolves the edge."""
EXPONENT = 0.5
ASKED = 0.005
"""How well the exponents are asked for in the local limit."""
PRINTED = 0.01
"""How far from 1/2 the exponents of a chain whose non-opposite particles meet may be."""
CONFIDENCE = 0.95
QUANTITIES = {"adhesion_force": "F_A", "zero_load_radius": "a_0"}


def paper_run(radius: float) -> str:
    """Name of the pull-off of the paper's chain with that R."""
    return f"pull_off_R{radius:g}"


def local_run(radius: float) -> str:
    """Name of the pull-off in the local limit with that R."""
    return f"local_R{radius:g}"


def paper_scenes(paper: Scene) -> Scenes:
    """Pull-offs over R of the paper's chain."""
    return {paper_run(radius): with_radius(paper, radius) for radius in RADII}


def local_scenes(paper: Scene) -> Scenes:
    """Pull-offs over R in the local limit."""
    return {local_run(radius): with_radius(local(paper), radius) for radius in LOCAL_RADII}


@dataclass(frozen=True)
class Fit:
    """An exponent, the half-width of its confidence interval, and the largest deviation from the line."""

    exponent: float
    half_width: float


def fitted(radii: Sequence[float], values: Sequence[float]) -> Fit:
    """ln value = exponent · ln R + constant, least squares."""
    result = linregress(np.log(radii), np.log(values))
    factor = float(t.ppf(0.5 + 0.5 * CONFIDENCE, len(radii) - 2))
    return Fit(float(result.slope), factor * float(result.stderr))


def judge_fig7(paper: Scene, runs: Runs, folder: Path) -> Findings:
    """Exponents of the paper's chain, beside JKR's and Barquins'."""
    row = checker("fig7")
    fits = {q: fitted(RADII, [found(runs[paper_run(r)], q).value for r in RADII]) for q in QUANTITIES}
    theory = {"adhesion_force": "JKR 1, Barquins 1/3", "zero_load_radius": "JKR 2/3, Barquins 2/3"}
    checks = [
        row(f"exponent of {QUANTITIES[q]} over R from 500 to 4000 LU ({theory[q]})", fit.exponent, fit.half_width, "1",
            EXPONENT, "Fig. 7 of the paper, both as the square root of R", "printed value", PRINTED,
            "non-opposite particles, neighbour springs, lattice", comparison="absolute", paper=EXPONENT)
        for q, fit in fits.items()
    ]  # fmt: skip
    series = {
        q: [
            Series("paper's chain", np.array(RADII), _values(runs, paper_run, RADII, q)),
            Series("local limit", np.array(LOCAL_RADII), _values(runs, local_run, LOCAL_RADII, q)),
        ]
        for q in QUANTITIES
    }
    save(scaling_figure(series["adhesion_force"], series["zero_load_radius"]), folder / "fig7.png")
    force, radius = fits["adhesion_force"], fits["zero_load_radius"]
    finding = (
        f"F_A goes with the power {force.exponent:.4f} ± {force.half_width:.4f} of R and a_0 with "
        f"{radius.exponent:.4f} ± {radius.half_width:.4f} (95 % intervals of the regression): the square root of both, "
        "as the paper finds, and neither JKR's nor Barquins' exponents."
    )
    return Findings(finding, checks, {"fig7.png": "Adhesion force and zero-load radius over R; lines: square root"})


def judge_exponents(paper: Scene, runs: Runs, folder: Path) -> Findings:
    """Exponents and values in the local limit, beside the closed form."""
    row = checker("exponents")
    checks: list[Check] = []
    for quantity, symbol in QUANTITIES.items():
        fit = fitted(LOCAL_RADII, [found(runs[local_run(r)], quantity).value for r in LOCAL_RADII])
        checks.append(
            row(f"exponent of {symbol} over R in the local limit", fit.exponent, fit.half_width, "1", EXPONENT,
                "closed form of independent pairs", "closed form", ASKED, "lattice", comparison="absolute",
                paper=EXPONENT)
        )  # fmt: skip
    for radius in LOCAL_RADII:
        law = independent_pairs(with_radius(local(paper), radius))
        for quantity, symbol, unit, expected in (
            ("adhesion_force", "F_A", "FU", law.adhesion_force()),
            ("zero_load_radius", "a_0", "LU", law.zero_load_radius()),
            ("critical_radius", "a_cr", "LU", law.critical_radius()),
        ):
            ours = found(runs[local_run(radius)], quantity)
            checks.append(
                row(f"{symbol} in the local limit, R = {radius:g} LU", ours.value, ours.uncertainty, unit, expected,
                    "closed form of independent pairs", "closed form", 1e-3, "tolerance of the run, lattice")
            )  # fmt: skip
    worst = max(abs(check.value / check.reference - 1.0) for check in checks[2:])
    finding = (
        "Where only opposite particles meet, the exponents are 1/2 by the closed form, whatever the law; the runs have "
        f"{checks[0].value:.5f} and {checks[1].value:.5f}, and F_A, a_0 and a_cr themselves agree with the closed form "
        f"within {share(worst)}."
    )
    return Findings(finding, checks, {})


def _values(runs: Runs, name: object, radii: Sequence[float], quantity: str) -> NDArray[np.float64]:
    assert callable(name)
    return np.array([found(runs[name(radius)], quantity).value for radius in radii])


FIG7 = Study(
    "fig7",
    "Fig. 7: adhesion force and zero-load radius over R",
    "F_A and a_0 both go with the square root of R, while JKR (3D) has the exponents 1 and 2/3 and Barquins (2D) 1/3 "
    "and 2/3.",
    lambda paper: local_scenes(paper) | paper_scenes(paper),
    judge_fig7,
)
EXPONENTS = Study(
    "exponents",
    "The exponents in the local limit",
    "F_A ∝ √R and a_0 ∝ √R, so that the work of adhesion that is identified depends on R, and the modulus does not.",
    local_scenes,
    judge_exponents,
)
