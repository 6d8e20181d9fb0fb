"""Loads close to F_A, where d − d_cr = √(2 (F_A − |F|)/F″): held below it, not held above, by both methods."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from validation.hard.cases import PairCase, reach, shaped
from validation.row import Reference, Row, absolute, at_most
from validation.study import Bench, Findings, Refused, Study, over_claim
from validation.study import found as result

NAME = "loads"
RATIO, PARTICLES, TOLERANCE = 0.5, 41, 1e-3
BELOW = (1e-2, 1e-3, 1e-4, 1e-5)
ABOVE = (1e-2, 3e-3)
"""Beyond the tolerance: the bodies part."""
UNSURE = (1e-4, 3e-5, 1e-5)
"""Within the tolerance above F_A: nobody can know, so that parting is right and being held needs a warning."""
METHODS = ("quasistatic", "dynamic")
EXPONENT = 0.05
"""The square root is the first term: at 1e-2 the next one is a few percent of d − d_cr."""
SOURCE = "independent pairs: root of F(d) above d_cr"


def _case(method: str, share: float) -> PairCase:
    name = f"{method}_{share:+.0e}"
    return PairCase(
        name, RATIO, shaped("parabola", PARTICLES, reach(RATIO)), PARTICLES, 0.0, TOLERANCE, method == "dynamic"
    )


def measure(bench: Bench) -> Findings:
    """d under each load below F_A over its claim, the exponent of d − d_cr, and what becomes of loads above."""
    pairs = _case("quasistatic", 0.0).exact()
    largest, place = pairs.adhesion(0.0)
    checks: list[Row] = []
    for method in METHODS:
        shares, ways, off = [], [], []
        for share in BELOW:
            found = bench.run(f"{method}_below_{share:g}", _scene(method, -largest * (1.0 - share)))
            if isinstance(found, Refused):
                off.append(float("nan"))
                continue
            load = -largest * (1.0 - share)
            exact = float(brentq(lambda d, f=load: float(pairs.unloading(d, 0.05)) - f, place, 0.02, xtol=1e-15))
            over = over_claim(found, "displacement", exact)
            off.append(0.0 if share < TOLERANCE and found.warnings and over > 1.0 else over)
            shares.append(share)
            ways.append(result(found, "displacement").value - place)
        checks += [
            at_most(
                f"d off over its claim under (1 − {share:g}) F_A, {method}; within the tolerance of F_A a "
                "named warning does as well",
                value,
                1.0,
                SOURCE,
                "what the run claims",
            )
            for share, value in zip(BELOW, off, strict=True)
        ]
        known = [(s, w) for s, w in zip(shares, ways, strict=True) if s >= TOLERANCE / 10.0 and w > 0.0]
        x, y = np.log(np.array(known or [(1.0, 1.0)])).T
        slope = float("nan") if len(known) < 2 else float(np.polyfit(x, y, 1)[0])
        checks.append(
            Row(
                f"exponent of d − d_cr over 1 − F/F_A, {method}",
                slope,
                Reference(0.5, "the fold: square root"),
                absolute(EXPONENT, "next term of the fold"),
            )
        )
        checks += _above(bench, method, largest)
    return Findings(checks)


def _scene(method: str, force: float) -> dict[str, object]:
    case = _case(method, 0.0)
    return case.scene() | {"experiment": {"kind": "load", "method": method, "force": force}}


def _above(bench: Bench, method: str, largest: float) -> list[Row]:
    held, silent = 0, 0
    for share in ABOVE:
        held += not isinstance(
            bench.run(f"{method}_above_{share:g}", _scene(method, -largest * (1.0 + share))), Refused
        )
    for share in UNSURE:
        found = bench.run(f"{method}_above_{share:g}", _scene(method, -largest * (1.0 + share)))
        silent += not isinstance(found, Refused) and not found.warnings
    said = f"independent pairs: F_A = {largest:.6g} FU"
    return [
        at_most(
            f"loads held of (1 + {ABOVE[0]:g}) and (1 + {ABOVE[1]:g}) F_A, {method}",
            held,
            0.0,
            said,
            "beyond the tolerance there is no state",
        ),
        at_most(
            f"loads held without a warning of (1 + 1e-4 … 1e-5) F_A, {method}",
            silent,
            0.0,
            said,
            "within the tolerance a warning is all that can be asked",
        ),
    ]


LOADS = Study(
    NAME,
    "Loads of (1 ± 1e-5 … 1e-2) F_A",
    "The contact stiffness vanishes with the square root of the distance from F_A, so that a small error of the "
    "force is a large one of the displacement, and a creeping state looks like an equilibrium.",
    measure,
)
