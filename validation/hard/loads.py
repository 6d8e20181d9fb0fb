"""Loads close to F_A, where d − d_cr = √(2 (F_A − |F|)/F″): held below it, not held above, by both methods."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from validation.hard.cases import PAIRS, PairCase, reach, shaped
from validation.row import Reference, Row, absolute, at_most
from validation.study import Bench, Findings, Refused, Study, found, over_claim

RATIO, PARTICLES, TOLERANCE = 0.5, 41, 1e-3
BELOW = (1e-2, 1e-3, 1e-4, 1e-5)
ABOVE = (1e-2, 3e-3)
"""Beyond the tolerance: the bodies part."""
UNSURE = (1e-4, 3e-5, 1e-5)
"""Within the tolerance above F_A: nobody can know, so that parting is right and being held needs a warning."""
EXPONENT = 0.05
"""The square root is the first term: at 1e-2 the next one is a few percent of d − d_cr."""


def measure(bench: Bench) -> Findings:
    """d under each load below F_A over its claim, the exponent of d − d_cr, and what becomes of loads above."""
    profile = shaped("parabola", PARTICLES, reach(RATIO))
    cases = [PairCase("load", RATIO, profile, PARTICLES, 0.0, TOLERANCE, dynamic) for dynamic in (False, True)]
    return Findings([row for case in cases for row in _rows(bench, case)])


def _rows(bench: Bench, case: PairCase) -> Iterator[Row]:
    largest, place = case.pairs.adhesion(0.0)
    method, near = case.method, list[tuple[float, float]]()
    words = f"under (1 − {{:g}}) F_A, {method}; within the tolerance of F_A a named warning does as well"
    runs = {share: bench.run(f"{method}_{share:+g}", case.scene() | {"experiment": {
        "kind": "load", "method": method, "force": -largest * (1.0 + share)}})
        for share in (*(-share for share in BELOW), *ABOVE, *UNSURE)}  # fmt: skip
    for share in BELOW:
        run = runs[-share]
        over = over_claim(run, "displacement", case.unloaded(-largest * (1.0 - share), 0.05))
        if not isinstance(run, Refused):
            over = 0.0 if share < TOLERANCE and run.warnings and over > 1.0 else over
            near.append((share, found(run, "displacement").value - place))
        yield at_most(f"d off over its claim {words.format(share)}", over, 1.0, PAIRS, "what the run claims")
    known = [pair for pair in near if pair[0] >= TOLERANCE / 10.0 and pair[1] > 0.0]
    x, y = np.log(known or [(1.0, 1.0)]).T
    slope = float(np.polyfit(x, y, 1)[0]) if len(known) > 1 else math.nan
    yield Row(f"exponent of d − d_cr over 1 − F/F_A, {method}", slope, Reference(0.5, "the fold: square root"),
              absolute(EXPONENT, "next term of the fold"))  # fmt: skip
    held = sum(not isinstance(runs[share], Refused) for share in ABOVE)
    unsure = [runs[share] for share in UNSURE]
    silent = sum(not isinstance(run, Refused) and not run.warnings for run in unsure)
    source = f"independent pairs: F_A = {largest:.6g} FU"
    yield at_most(f"loads held of (1 + {ABOVE[0]:g}) and (1 + {ABOVE[1]:g}) F_A, {method}", held, 0.0, source,
                  "beyond the tolerance there is no state")  # fmt: skip
    yield at_most(f"loads held without a warning of (1 + 1e-4 … 1e-5) F_A, {method}", silent, 0.0, source,
                  "within the tolerance a warning is all that can be asked")  # fmt: skip


LOADS = Study(
    "loads",
    "Tensile loads of (1 ± 1e-5 … 1e-2) F_A",
    "The contact stiffness vanishes with the square root of the distance from F_A, so that a small error of the force"
    " is a large one of the displacement, and a slowly moving state looks like an equilibrium.",
    measure,
)
