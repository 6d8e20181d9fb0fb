"""Section 4: Table 1. The first row is what the interaction is identified by; the others follow.

γ = F_A/3πR and E* = 3 F_A R/a₀³ (Eq. 9) with E* = 200 GPa, γ = 1 J/m² give LU ∝ R²/a₀³ and FU ∝ R LU/F_A
(`workflow.runs.scales`). A printed number is good to half its last digit; a prediction also has the first row's.
"""

from typing import Any

from validation import doors
from validation.doors import Quantity, Scene
from validation.paper.scenes import CONTACT_MODULUS, HALF_DIGIT, IN_PLACE, SURFACE_ENERGY, TABLE_1, with_radius
from validation.row import Known, printed, relative
from validation.study import Bench, Findings, Rows, Runs, Scenes, Study, found

GOES_WITH = {"a_0": (1, 0), "F_A": (0, 1), "one LU": (3, 0), "one FU": (3, 1)}
"""Powers of the first row's a₀ and F_A in a prediction."""
POWERS = {"a_0": 0.5, "one FU": 1.0}
"""Of R, in the model: a_0 ∝ √R whatever the law, and the force unit with R."""
AT_ODDS = {(1600.0, "a_0"), (1600.0, "one FU"), (2000.0, "one FU")}
"""Printed numbers that no law can have together with the first row's: see the finding."""
PRINTED_SCATTER = "0.32 %"
"""Largest deviation of F_A/√R from its mean in Table 1, F_A = 3πγR LU/FU, LU = 9πγR²/(a₀³E*)."""


def pull_off_run(radius: float) -> str:
    """Name of the pull-off of a row."""
    return f"pull_off_R{radius:g}"


def scenes(paper: Scene) -> Scenes:
    """One pull-off for each row."""
    return {pull_off_run(row.radius): with_radius(paper, row.radius) for row in TABLE_1}


def scales(runs: Runs, radius: float) -> Any:
    """LU and FU that a run with this R [LU] gives the paper's material."""
    results = runs[pull_off_run(radius)].results
    return doors.jkr_scales(
        results["adhesion_force"], results["zero_load_radius"], radius, CONTACT_MODULUS, SURFACE_ENERGY
    )


def judge(bench: Bench) -> Findings:
    """Every number of the table."""
    runs = bench.runs
    row, checks = Rows(runs), []
    basis = TABLE_1[0]
    rounding = (HALF_DIGIT["a_0"] / basis.zero_load_radius, HALF_DIGIT["F_A"] / basis.adhesion_force)
    basis_of = {"a_0": basis.zero_load_radius, "one FU": 1e6 * basis.force_unit}
    for entry in TABLE_1:
        name = pull_off_run(entry.radius)
        units = scales(runs, entry.radius)
        for symbol, value, expected in (
            ("a_0", found(runs[name], "zero_load_radius"), entry.zero_load_radius),
            ("F_A", found(runs[name], "adhesion_force"), entry.adhesion_force),
            ("one LU", Quantity(1e9 * units.length, 1e9 * units.length_uncertainty, "nm"), 1e9 * entry.length_unit),
            ("one FU", Quantity(1e6 * units.force, 1e6 * units.force_uncertainty, "µN"), 1e6 * entry.force_unit),
        ):
            fixed = entry is basis and symbol in ("a_0", "F_A")
            tolerance = HALF_DIGIT[symbol] / expected
            tolerance += 0.0 if fixed else sum(n * part for n, part in zip(GOES_WITH[symbol], rounding, strict=True))
            known = None
            if (entry.radius, symbol) in AT_ODDS:
                law = basis_of[symbol] * (entry.radius / basis.radius) ** POWERS[symbol]
                known = Known(
                    law, tolerance * law, "follows from the first row, since here a_0 scales with √R, one FU with R"
                )
            checks.append(
                row(f"{symbol}, R = {entry.radius:g} LU", value,
                    printed(expected, "Table 1, first row: identified by it" if fixed else "Table 1"),
                    relative(tolerance, "print, of this number" + ("" if fixed else " and of the first row")),
                    on=name, standing="by construction" if fixed else "judged", known=known)
            )  # fmt: skip
    finding = (
        "The interaction is identified by F_A and a_0 of the first row. The numbers of the other rows are predictions. "
        "Three of them no law can have: in the model a_0 and F_A go with the square root of R, and FU with R. Printed "
        "a_0 at R = 1600 LU is 1.2667 times the first, not 1.2649; one FU at R = 1600 LU is 1.5846 times the first, "
        "not 1.6; one FU at R = 2000 LU is 1.9897 times the first, not 2. The units are printed with more digits than "
        "F_A: what they say of it, F_A = 3πγR LU/FU, with LU by a_0, scatters about the square root of R by "
        f"{PRINTED_SCATTER}.\n\n{IN_PLACE}"
    )
    return Findings(checks, text=finding)


TABLE1 = Study(
    "table1",
    "Table 1: internal length and force",
    "For E* = 200 GPa and γ = 1 J/m² the length and the force unit follow from F_A and a_0 for every radius of "
    "curvature.",
    judge,
    scenes,
)
