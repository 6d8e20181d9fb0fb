"""Fig. 7 and its exponents: F_A and a₀ over R, by regression of logarithms with Student's confidence interval.

Closed form where only opposite particles meet: F_A ∝ √R and a₀ ∝ √R exactly, whatever the law (`independent_pairs`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import linregress, t

from validation.doors import Quantity, Scene
from validation.figures import Panel, Series, figure
from validation.page import agreement, measured, number, share, worst_deviation
from validation.paper.scenes import HALF_DIGIT, IN_PLACE, TABLE_1, changed, independent_pairs, local, with_radius
from validation.row import Evidence, Reference, Row, absolute, claim
from validation.study import Bench, Findings, Rows, Runs, Scenes, Study, found

RADII = (500.0, 1000.0, 1600.0, 2000.0, 3000.0, 4000.0)
"""R [LU], those of Table 1 among them."""
LOCAL_RADII = (4000.0, 8000.0, 16000.0, 32000.0)
"""R [LU] in the local limit; large, so that the wide spacing resolves the edge."""
CONFIDENCE = 0.95
LARGEST_SPREAD = 1e-3
"""Of an exponent: a regression that scatters more shows no power of R."""
QUANTITIES = {"adhesion_force": "F_A", "zero_load_radius": "a_0", "critical_radius": "a_cr"}
THEORY = {
    "adhesion_force": "JKR 1, Barquins 1/3", "zero_load_radius": "JKR 2/3, Barquins 2/3", "critical_radius": "JKR 2/3"
}  # fmt: skip
ALIKE = "the errors of the runs are alike and cancel in the slope, the uncertainty takes each at its worst"
HALVED = "the claim is what halving the rows beside the largest tension changed, not what that left"
DIGITS = "the digits of Table 1 fix an exponent no better"


def chain_run(radius: float) -> str:
    """Name of the pull-off of the paper's chain with that R, as long as its contact needs."""
    return f"pull_off_long_R{radius:g}"


def local_run(radius: float) -> str:
    """Name of the pull-off in the local limit with that R."""
    return f"local_R{radius:g}"


def chain_scenes(paper: Scene) -> Scenes:
    """Pull-offs over R of the paper's chain."""
    return {chain_run(R): changed(with_radius(paper, R), "bodies.particles=auto") for R in RADII}


def local_scenes(paper: Scene) -> Scenes:
    """Pull-offs over R in the local limit."""
    return {local_run(radius): with_radius(local(paper), radius) for radius in LOCAL_RADII}


def all_scenes(paper: Scene) -> Scenes:
    """Those of both."""
    return local_scenes(paper) | chain_scenes(paper)


@dataclass(frozen=True)
class Fit:
    """An exponent, and its uncertainty: half the confidence interval and what the runs claim."""

    exponent: float
    spread: float


def fitted(radii: Sequence[float], found_values: Sequence[Quantity]) -> Fit:
    """ln value = exponent · ln R + constant, least squares; δp = t s + Σ |c_i| claim_i/value_i."""
    x = np.log(radii)
    values = np.array([one.value for one in found_values])
    claims = np.array([one.uncertainty for one in found_values]) / values
    result = linregress(x, np.log(values))
    weights = np.abs(x - x.mean()) / float(np.sum((x - x.mean()) ** 2))
    half_width = float(t.ppf(0.5 + 0.5 * CONFIDENCE, len(radii) - 2)) * float(result.stderr)
    return Fit(float(result.slope), half_width + float(weights @ claims))


def exponents(
    row: Rows, is_printed: bool, radii: Sequence[float], name: Callable[[float], str], words: str
) -> list[Row]:
    """Exponents of F_A, a_0 and a_cr, and of what Eq. (9) makes of them: γ ∝ F_A/R, E* ∝ F_A R/a_0³."""
    on = [name(R) for R in radii]
    fits = {q: fitted(radii, [found(row.runs[run], q) for run in on]) for q in QUANTITIES}
    digits = print_resolution() if is_printed else dict.fromkeys(QUANTITIES, 0.0)
    source = "Sections 3.3 and 4: the square root of R" if is_printed else "closed form of independent pairs"
    kind: Evidence = "printed value" if is_printed else "closed form"
    limit = f"{'digits of Table 1; ' if is_printed else ''}interval of the fit, what the runs claim"
    checks = [
        row(f"exponent of {QUANTITIES[q]} over R {words} ({THEORY[q]})", fit.exponent, Reference(0.5, source, kind),
            absolute(digits[q] + min(fit.spread, LARGEST_SPREAD), limit), uncertainty=fit.spread, on=on,
            wide=DIGITS if is_printed else ALIKE)
        for q, fit in fits.items()
    ]  # fmt: skip
    force, radius = checks[:2]
    derived = (
        ("γ", force.value - 1.0, force.uncertainty, force.bound.size, -0.5, "γ depends on R, by Eq. (9) as R^{-1/2}"),
        ("E*", force.value + 1.0 - 3.0 * radius.value, force.uncertainty + 3.0 * radius.uncertainty,
         force.bound.size + 3.0 * radius.bound.size, 0.0, "the modulus does not depend on R"),
    )  # fmt: skip
    return checks + [
        row(f"exponent of {symbol} by Eq. (9) over R {words}", value,
            Reference(reference, f"Section 4: {said}", "paper's words"),
            absolute(tolerance, f"{limit}; follows from F_A and a_0"), uncertainty=spread, on=on, standing="repeats",
            wide=DIGITS if is_printed else ALIKE)
        for symbol, value, spread, tolerance, reference, said in derived
    ]  # fmt: skip


def print_resolution() -> dict[str, float]:
    """How well the digits of Table 1 fix an exponent between its first and last R: Σ rounding/value over ln(R₂/R₁).

    a_cr is not in the table; it is taken for as well known as a₀.
    """
    ends, width = (TABLE_1[0], TABLE_1[-1]), math.log(TABLE_1[-1].radius / TABLE_1[0].radius)
    force = sum(HALF_DIGIT["F_A"] / row.adhesion_force for row in ends) / width
    radius = sum(HALF_DIGIT["a_0"] / row.zero_load_radius for row in ends) / width
    return {"adhesion_force": force, "zero_load_radius": radius, "critical_radius": radius}


def judge_fig7(bench: Bench) -> Findings:
    """Exponents of the paper's chain, beside JKR's and Barquins'."""
    runs = bench.runs
    checks = exponents(Rows(runs), True, RADII, chain_run, "from 500 to 4000 LU")
    series = {
        q: [
            Series("paper's chain", np.array(RADII), _values(runs, chain_run, RADII, q)),
            Series("local limit", np.array(LOCAL_RADII), _values(runs, local_run, LOCAL_RADII, q)),
        ]
        for q in ("adhesion_force", "zero_load_radius")
    }
    powers = ({"square root": 0.5, "JKR, 1": 1.0, "Barquins, 1/3": 1.0 / 3.0},
              {"square root": 0.5, "JKR and Barquins, 2/3": 2.0 / 3.0})  # fmt: skip
    panels = [
        Panel("radius of curvature $R$ (LU)", words, shown, [
            Series(label, shown[0].x, shown[0].y[0] * (shown[0].x / shown[0].x[0]) ** power)
            for label, power in lines.items()
        ], log="xy")
        for words, shown, lines in zip(
            ("adhesion force $F_A$ (FU)", "zero-load radius $a_0$ (LU)"), series.values(), powers, strict=True
        )
    ]  # fmt: skip
    figures = figure("Adhesion force and zero-load radius over R; lines: powers of theory", *panels)
    force, radius, critical, energy, modulus = checks
    finding = (
        f"F_A goes with the power {_said(force)} of R, a_0 with {_said(radius)} and a_cr with {_said(critical)}; by "
        "Eq. "
        f"(9) γ goes with {_said(energy)} and E* with {_said(modulus)} (95 % intervals of the regression, and what the "
        f"runs claim). Held against the square root, R^{{-1/2}} and R^0: {agreement(checks)}. "
        f"{_departures(checks[:3])} JKR has 1 and 2/3 for F_A "
        f"and a_0, Barquins 1/3 and 2/3: {_far(force, (1.0, 1.0 / 3.0))} and {_far(radius, (2.0 / 3.0,))} of these "
        f"uncertainties away at least.\n\n{IN_PLACE}"
    )
    return Findings(checks, figures, text=finding)


def _departures(checks: Sequence[Row]) -> str:
    off = [f"{c.name.split()[2]} by {number(c.value - 0.5, 2)}" for c in checks if c.off > c.uncertainty]
    if not off:
        return "None of the first three departs from 1/2 by more than that."
    why = "neighbour springs, and particles that are not opposite"
    return f"Beyond these intervals depart from 1/2 {', '.join(off)}: {why}."


def _said(check: Row) -> str:
    return measured(check.value, check.uncertainty, "1")


def _far(check: Row, others: Sequence[float]) -> str:
    return number(min(abs(check.value - other) for other in others) / check.uncertainty, 2)


def judge_exponents(bench: Bench) -> Findings:
    """Exponents and values in the local limit, beside the closed form."""
    paper, runs = bench.paper, bench.runs
    row = Rows(runs)
    slopes = exponents(row, False, LOCAL_RADII, local_run, "in the local limit")
    values: list[Row] = []
    for radius in LOCAL_RADII:
        scene = with_radius(local(paper), radius)
        law = independent_pairs(scene)
        for quantity, symbol, expected in (
            ("adhesion_force", "F_A", law.adhesion_force()),
            ("zero_load_radius", "a_0", law.zero_load_radius()),
            ("critical_radius", "a_cr", law.critical_radius()),
        ):
            ours = found(runs[local_run(radius)], quantity)
            values.append(
                row(f"{symbol} in the local limit, R = {radius:g} LU", ours,
                    Reference(expected, "closed form of independent pairs"),
                    claim("what the run claims", scene.accuracy.tolerance), on=[local_run(radius)], wide=HALVED)
            )  # fmt: skip
    finding = (
        "Where only opposite particles meet, the exponents are 1/2 by the closed form, whatever the law; the runs have "
        f"{', '.join(number(check.value, 5) for check in slopes[:3])} for F_A, a_0 and a_cr: {agreement(slopes)}. The "
        f"values themselves agree with the closed form within {share(worst_deviation(values))}: {agreement(values)}."
    )
    return Findings(slopes + values, text=finding)


def _values(runs: Runs, name: Callable[[float], str], radii: Sequence[float], quantity: str) -> NDArray[np.float64]:
    return np.array([found(runs[name(radius)], quantity).value for radius in radii])


FIG7 = Study(
    "fig7",
    "Fig. 7: adhesion force and zero-load radius over R",
    "F_A and a_0 both go with the square root of R, while JKR (3D) has the exponents 1 and 2/3 and Barquins (2D) 1/3 "
    "and 2/3.",
    judge_fig7,
    all_scenes,
)
EXPONENTS = Study(
    "exponents",
    "Exponents of F_A, a_0 and a_cr over R where only opposite particles interact",
    "F_A ∝ √R and a_0 ∝ √R, so that the work of adhesion that is identified depends on R, and the modulus does not.",
    judge_exponents,
    local_scenes,
)
