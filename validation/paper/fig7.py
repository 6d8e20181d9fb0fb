"""Fig. 7 and its exponents: F_A and a₀ over R, by regression of logarithms with Student's confidence interval.

Closed form where only opposite particles meet: F_A ∝ √R and a₀ ∝ √R exactly, whatever the law (`independent_pairs`).
"""

import math
from collections.abc import Callable, Sequence

from scipy.stats import t

from validation.doors import Quantity, Scene
from validation.figures import Panel, Series, figure
from validation.paper.scenes import HALF_DIGIT, IN_PLACE, TABLE_1, changed, independent_pairs, local, with_radius
from validation.paper.section2 import fitted_order
from validation.row import Evidence, Reference, Row, absolute, claim
from validation.study import Bench, Findings, Rows, Scenes, Study, found

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


def local_scenes(paper: Scene) -> Scenes:
    """Pull-offs over R in the local limit."""
    return {local_run(radius): with_radius(local(paper), radius) for radius in LOCAL_RADII}


def all_scenes(paper: Scene) -> Scenes:
    """These, and those of the paper's chain."""
    own = {chain_run(R): changed(with_radius(paper, R), "bodies.particles=auto") for R in RADII}
    return local_scenes(paper) | own


def fitted(radii: Sequence[float], found_values: Sequence[Quantity]) -> Quantity:
    """The exponent of ln value = exponent · ln R + constant by least squares.

    Its uncertainty is half the confidence interval and what the runs claim, δp = t s + Σ |c_i| claim_i/value_i.
    """
    claims = [one.uncertainty / one.value for one in found_values]
    slope, error, spread = fitted_order(radii, [one.value for one in found_values], claims)
    return Quantity(slope, t.ppf(0.5 + 0.5 * CONFIDENCE, len(radii) - 2) * error + spread, "1")


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
    wide = DIGITS if is_printed else ALIKE
    checks = [
        row(f"exponent of {QUANTITIES[q]} over R {words} ({THEORY[q]})", fit, Reference(0.5, source, kind),
            absolute(digits[q] + min(fit.uncertainty, LARGEST_SPREAD), limit), on=on, wide=wide)
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
            wide=wide)
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
    panels = []
    for quantity, words, powers in (
        (
            "adhesion_force",
            "adhesion force $F_A$ (FU)",
            {"JKR, 1": 1.0, "Barquins, 1/3": 1.0 / 3.0},
        ),
        ("zero_load_radius", "zero-load radius $a_0$ (LU)", {"JKR and Barquins, 2/3": 2.0 / 3.0}),
    ):
        own, pairs = (
            [found(runs[name(radius)], quantity).value for radius in radii]
            for name, radii in ((chain_run, RADII), (local_run, LOCAL_RADII))
        )
        shown = [Series("paper's chain", RADII, own), Series("local limit", LOCAL_RADII, pairs)]
        lines = [
            Series(label, RADII, [own[0] * (radius / RADII[0]) ** power for radius in RADII])
            for label, power in ({"square root": 0.5} | powers).items()
        ]
        panels.append(Panel("radius of curvature $R$ (LU)", words, shown, lines, log="xy"))
    figures = figure("Adhesion force and zero-load radius over R; lines: powers of theory", *panels)
    finding = (
        "F_A, a_0 and a_cr go with the square root of R, where JKR has 1 and 2/3 for F_A and a_0, Barquins 1/3 and "
        "2/3; uncertainties are 95 % intervals of the regression, and what the runs claim. What is left of a_0 and "
        "a_cr is due to neighbour springs, and to particles that are not opposite: `exponents` is without them.\n\n"
        f"{IN_PLACE}"
    )
    return Findings(checks, figures, text=finding)


def judge_exponents(bench: Bench) -> Findings:
    """Exponents and values in the local limit, beside the closed form."""
    row = Rows(bench.runs)
    slopes = exponents(row, False, LOCAL_RADII, local_run, "in the local limit")
    values = [
        row(f"{symbol} in the local limit, R = {radius:g} LU", found(row.runs[local_run(radius)], quantity),
            Reference(getattr(independent_pairs(scene), quantity)(), "closed form of independent pairs"),
            claim("what the run claims", scene.accuracy.tolerance), on=local_run(radius), wide=HALVED)
        for radius in LOCAL_RADII
        for scene in [with_radius(local(bench.paper), radius)]
        for quantity, symbol in QUANTITIES.items()
    ]  # fmt: skip
    finding = "Where only opposite particles meet, the exponents are 1/2 by the closed form, whatever the law."
    return Findings(slopes + values, text=finding)


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
