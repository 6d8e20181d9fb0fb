"""Compression up to and past the core, and aligned pairs that buckle sideways.

A pair at the distance r that repels with f is pushed sideways by f u/r for an offset u of its particles, and held by
both springs in series, k_t/2: unstable where k_t < 2 f/r.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.optimize import brentq

from validation.doors import Contact, Displace, Run, contact_of
from validation.hard.cases import CORE, LAW, PairCase, shaped
from validation.row import at_most
from validation.study import Bench, Findings, Refused, Study, claim_row

CORE_CLASS, BUCKLING = "core", "buckling"
RATIO, PUNCH = 0.5, 10
SHARES, PAST = (0.1, 0.5, 0.85), (1.02, 10.0)
BUCKLED = (0.9, 0.98, 1.02, 1.1)
"""Force of a pair over that at which it buckles."""
PATIENCE, HANGING = 20, ("LAMMPS", "time limit", "nothing was said")
"""For a refusal [s], and words of one that came too late."""
TANGENTIAL = 4.0
"""Tangential stiffness [FU/LU]: a pair then buckles at a third of its core's force."""
PUSH = 1e-5
"""Offset that is given to the pairs [LU]."""


def measure_core(bench: Bench) -> Findings:
    """d under shares of what N cores carry over its claim; loads past that are refused in words of this program."""
    rows = []
    for method in ("quasistatic", "dynamic"):
        case = PairCase("core", RATIO, shaped("flat_punch", PUNCH, 0.0), PUNCH, 0.0, 1e-3, method == "dynamic")

        def pressed(share: float, bench: Bench, case: PairCase = case, method: str = method) -> Run | Refused:
            experiment = {"kind": "load", "force": share * PUNCH * CORE, "method": method}
            return bench.run(f"{method}_{share:g}", case.scene() | {"experiment": experiment})

        for share in SHARES:
            words = f"d off over its claim at {share:g} of the core's force, {method}"
            exact = case.exact().deepest(share * PUNCH * CORE)
            rows.append(claim_row(words, pressed(share, bench), "displacement", exact, "independent pairs"))
        soon = replace(bench, patience=PATIENCE)
        ends = [pressed(share, soon) for share in PAST]
        bad = sum(not isinstance(end, Refused) or any(word in end.words for word in HANGING) for end in ends)
        words = f"loads of {PAST} core forces that are held, hang, or end in words of LAMMPS, {method}"
        rows.append(at_most(words, bad, 0.0, "the core carries no more"))
    return Findings(rows)


def measure_buckling(bench: Bench) -> Findings:
    """Pairs that are pushed aside a little: below the critical force they come back, above it they go on."""
    critical = float(brentq(lambda r: 2.0 * float(LAW.force(np.array(r))) / r - TANGENTIAL, 1e-4, 0.023))
    most = float(LAW.force(np.array(critical)))
    checks = []
    for share in BUCKLED:
        r = float(brentq(lambda r, f=share * most: float(LAW.force(np.array(r))) - f, 1e-5, 0.0236, xtol=1e-16))
        case = PairCase("buckling", RATIO, shaped("flat_punch", 3, 0.0), 3, 0.0)
        d = LAW.force_free_distance() - (r - 2.0 * share * most / case.stiffness)
        bodies = case.scene()["bodies"] | {"bulk_stiffness_tangential": TANGENTIAL}
        tables: dict[str, Any] = case.scene() | {
            "bodies": bodies,
            "horizontal": {},
            "experiment": {"kind": "path", "displacements": [d]},
        }
        with contact_of(tables, bench.folder / f"pushed_{share:g}") as contact:
            offset = _pushed(contact, d)
        stays = share < 1.0
        value = offset / PUSH if stays else PUSH / max(offset, 1e-300)
        words = "left of the push" if stays else "push over where it ends"
        checks.append(
            at_most(
                f"{words}, pair at {share:g} of the force at which it buckles",
                value,
                0.5,
                "k_t = 2 f/r",
                "where the minimiser stops: some of the push",
            )
        )
    return Findings(checks)


def _pushed(contact: Contact, d: float) -> float:
    """How far particles are in the end from where they stood aligned at the displacement d [LU], after a push.

    Sideways or in height: pairs that buckle may slip past each other until they are aligned again.
    """
    contact.begin("loading")
    moves = math.ceil(d / contact.settings.increments.longest_move)
    for i in range(moves):  # in one move they would pass each other
        contact.row(Displace(d * (i + 1) / moves))
    contact.finish()
    before = contact.session.atoms("x")["x"][:6]
    contact.session.execute(f"displace_atoms upper move {PUSH!r} 0 0 units box\n", phase="pushed")
    contact.session.execute("min_style fire\nminimize 0.0 1e-13 20000 20000\n")
    return float(np.max(np.abs(contact.session.atoms("x")["x"][:6] - before)))


CLASSES = (
    Study(
        CORE_CLASS,
        "Compression up to and past the core",
        "The repulsive core is finite: beyond its maximum force one body passes through the other.",
        measure_core,
    ),
    Study(
        BUCKLING,
        "Buckling of aligned chains",
        "Aligned chains under load are in unstable equilibrium, which exact symmetry preserves without a perturbation.",
        measure_buckling,
    ),
)
