"""Section 4: the mean pressure F/πa² at R = 1000, a = 35, by the run's own force and by Eq. (8).

The bulk stiffness, which the paper does not print, decides how near the curve is to JKR's; curves of other stiffnesses,
the interaction found anew for each (`workflow.identify.estimated`), show by how much.
"""

import math
from functools import cache

import numpy as np

from validation.doors import Quantity, Scene, estimated
from validation.figures import Array
from validation.paper.fig8 import ASKED, DEEPEST, LENGTHENED, SAME, STEPS, branch
from validation.paper.scenes import FIRST_ROW, READ, TABLE_1, changed, curve_scene, jkr_reduced
from validation.paper.table1 import pull_off_run, scales
from validation.row import Reference, absolute, printed, relative
from validation.study import Bench, Findings, Rows, Runs, Scenes, Study, found

PLACE, PRINTED, DIGIT = 35.0, 800.0, 50.0
"""Contact radius [LU]; "about 800 MPa"; half of its last digit [MPa]."""
STIFFNESSES = (0.83, 0.9, 1.1)
"""Other bulk stiffnesses [FU/LU]."""


CURVE = LENGTHENED[SAME]
"""The curve of the paper's chain."""


def stiffness_run(stiffness: float) -> str:
    """Name of the curve with that bulk stiffness."""
    return f"curve_stiffness{stiffness:g}"


@cache  # asked for twice
def softened(paper: Scene, stiffness: float) -> Scene:
    """The paper's scene with another bulk stiffness and the first row's F_A and a₀."""
    return estimated(changed(paper, f"bodies.bulk_stiffness={stiffness}"), FIRST_ROW)


def pressure_scenes(paper: Scene) -> Scenes:
    """The first row's pull-off, its curve, and those of other stiffnesses."""
    others = {stiffness_run(k): curve_scene(softened(paper, k), DEEPEST, STEPS) for k in STIFFNESSES}
    return {pull_off_run(TABLE_1[0].radius): paper, CURVE: curve_scene(paper, DEEPEST, STEPS)} | others


def _stable(runs: Runs, name: str) -> tuple[Array, Array]:
    """a [LU], rising, and F [FU] of the stable branch."""
    force, a = branch(runs[name])[1:3]
    stable = slice(0, int(np.argmin(force)) + 1)
    order = np.argsort(a[stable])
    return a[stable][order], force[stable][order]


def judge_pressure(bench: Bench) -> Findings:
    """Mean pressure over the contact radius, by the run and by Eq. (8)."""
    runs = bench.runs
    row, first = Rows(runs), TABLE_1[0]
    pull_off = pull_off_run(first.radius)
    units = scales(runs, first.radius)
    mega = 1e-6 * units.force / units.length**2
    force_scale, radius_scale = (found(runs[pull_off], q).value for q in ("adhesion_force", "zero_load_radius"))
    a, force = _stable(runs, CURVE)
    pressure = force / (math.pi * a**2) * mega

    def at_place(a: Array, force: Array) -> float:
        return float(np.interp(PLACE, a, force) / (math.pi * PLACE**2) * mega)

    ours = at_place(a, force)
    bend = abs(ours - at_place(a[::2], force[::2]))
    reduced = float(jkr_reduced(PLACE / radius_scale))
    by_law = force_scale * reduced / (math.pi * PLACE**2) * mega
    spread = ours * (units.force_uncertainty / units.force + 2.0 * units.length_uncertainty / units.length) + bend
    place = f"at R = {first.radius:g} LU, a = {PLACE:g} LU"
    paper = printed(PRINTED, "Section 4: about 800 MPa")
    checks = [
        row(f"mean pressure {place}, by the run's own force", Quantity(ours, spread, "MPa"), paper,
            absolute(DIGIT, "print: one digit"), on=[CURVE, pull_off], despite=READ),
        row("the same over that of Eq. (8) with the run's F_A and a_0", ours / by_law,
            Reference(1.0, "Eq. (8); bound as for the curves of Fig. 8, over F/F_A here", "set bound"),
            relative(ASKED / reduced,
                     "range of the interaction: the curve is near JKR's and not on it; chosen by the stiffness"),
            uncertainty=spread / by_law, on=[CURVE, pull_off], despite=READ),
        row(f"mean pressure {place}, by Eq. (8) with the run's F_A and a_0", Quantity(by_law, spread, "MPa"), paper,
            absolute(DIGIT, "print: one digit; F_A and a_0 are those of Table 1"), on=pull_off,
            standing="by construction"),
    ]  # fmt: skip
    others = [at_place(*_stable(runs, stiffness_run(k))) for k in STIFFNESSES]
    said = ", ".join(f"{value:.0f} MPa with {k:g}" for k, value in zip(STIFFNESSES, others, strict=True))
    finding = (
        f"At a = {PLACE:g} LU, {1e9 * PLACE * units.length:.0f} nm, the run carries a mean pressure of {ours:.0f} MPa "
        f"(largest of the curve: {pressure.max():.0f} MPa). It depends on the bulk stiffness, which the paper does not "
        f"print: with the interaction found anew each time it is {said} FU/LU. The stiffness of 1 FU/LU was chosen by "
        "the nearness of the curve to JKR's."
    )
    return Findings(checks, text=finding)


MEAN_PRESSURE_STUDY = Study(
    "mean_pressure",
    "The mean pressure at R = 1000 LU, a = 35 LU",
    "For R = 1000 and a = 35 the mean pressure is about 800 MPa.",
    judge_pressure,
    pressure_scenes,
)
